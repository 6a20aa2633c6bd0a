"""Saving of the environment's bodies in files."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import json
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, cast

from ravemj.core.arguments import checked_kind
from ravemj.core.output import new_file
from ravemj.engine.simulation.world import DEFAULT_GRAVITY
from ravemj.engine.snapshot import snapshot
from ravemj.errors import ArgumentError, Diagnostics, UnsupportedError, send_warnings
from ravemj.model.scene import KinBody, Scene, View
from ravemj.rave.enums import SelectionOptions
from ravemj.rave.env.base import EnvironmentPart

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml.geom_writer import MeshFormat
    from ravemj.formats.writers import ModelFormat
    from ravemj.rave.infos import EnvironmentBaseInfo

SaveArguments = str | Mapping[str, str] | Sequence[tuple[str, str]]
"""What ``Save`` is told beside the selection: the name of a body, or texts by name, of which some may come twice."""

_CHOICES: dict[SelectionOptions, Callable[[KinBody, Sequence[str]], bool]] = {
    SelectionOptions.NoRobots: lambda body, targets: not body.is_robot,
    SelectionOptions.Robots: lambda body, targets: body.is_robot,
    SelectionOptions.Everything: lambda body, targets: True,
    SelectionOptions.Body: lambda body, targets: body.name in targets,
    SelectionOptions.AllExceptBody: lambda body, targets: body.name not in targets,
}
_PARTS: dict[str, Callable[[KinBody], KinBody]] = {
    "geometry": lambda body: replace(body, links=tuple(replace(link, geometries=()) for link in body.links)),
    "sensors": lambda body: replace(body, sensors=()),
    "manipulators": lambda body: replace(body, manipulators=()),
}
_VALUES = {"skipwrite": tuple(_PARTS), "format": ("collada", "openrave"), "meshes": ("stl", "obj")}


class Saving(EnvironmentPart):
    """Saves models."""

    SelectionOptions = SelectionOptions

    def Save(
        self,
        filename: str | os.PathLike[str],
        options: int = SelectionOptions.Everything,
        atts: SaveArguments | None = None,
    ) -> None:
        """Write bodies to a file, as they are now: with their values, poses, limits, colours and disabled links.

        Args:
            filename: The file. It gets COLLADA 1.5 with OpenRAVE's extras, whatever its name; one that ends in ``.zae``
                gets a zip archive of it, one in ``.json`` OpenRAVE's JSON. ``Load`` reads all of them.
            options: Which bodies, a ``SelectionOptions``.
            atts: The name of a body, for ``SelectionOptions.Body`` and ``AllExceptBody``, or a dict or pairs of

                * ``target``: a body; several pairs name several;
                * ``skipwrite``: words for what is left out: ``geometry``, ``sensors``, ``manipulators``;
                * ``format``: ``openrave`` for OpenRAVE XML, with meshes in the folder ``meshes`` beside the file;
                * ``meshes``: the kind of these, ``stl`` or ``obj``.

        Raises:
            openrave_exception: there is no such body, or an argument is wrong.
            OutputError: the file cannot be written, or a name cannot stand in it; nothing is changed then.

        Example:
            >>> env.Load("models/env.xml")
            True
            >>> env.Save("scene.dae")
            >>> env.Save("robot.zae", env.SelectionOptions.Body, env.GetRobots()[0].GetName())
        """
        from ravemj.formats.writers import save  # noqa: PLC0415 - slow to import, and rarely wanted

        checked_kind(filename, (str, os.PathLike), "Save: filename", "a path")
        path = os.fspath(filename)
        if path.lower().endswith(".msgpack"):
            raise UnsupportedError("Save", "MessagePack files")
        given = _checked(atts)
        self._check_alive()
        if path.lower().endswith(".json"):
            self._save_json(path, options, given)
            return
        with self._simulation.lock:
            bodies = [snapshot(body) for body in self._simulation.bodies]
            view, gravity = self._simulation.view, self._simulation.gravity
        bodies = _chosen(bodies, options, [value for name, value in given if name == "target"])
        for part in (part for name, value in given if name == "skipwrite" for part in value.split()):
            bodies = [_PARTS[part](body) for body in bodies]
        is_lone_body = len(bodies) == 1 and view == View()
        scene = Scene(tuple(bodies), None if is_lone_body else view, None if gravity == DEFAULT_GRAVITY else gravity)
        named = dict(given)
        diagnostics = Diagnostics()
        save(
            path,
            scene,
            diagnostics,
            cast("ModelFormat", named.get("format", "collada")),
            cast("MeshFormat", named.get("meshes", "stl")),
        )
        send_warnings(diagnostics)

    def _save_json(self, path: str, options: int, given: Sequence[tuple[str, str]]) -> None:
        """Write what ``ExtractInfo`` says about bodies."""
        others = [name for name, _ in given if name != "target"]
        if others:
            raise ArgumentError(f"Save: atts: {others[0]} has no meaning for JSON files, which take target alone")
        with self._simulation.lock:
            info = self.ExtractInfo()
            chosen = _chosen([body.scene for body in self._simulation.bodies], options, [name for _, name in given])
        names = [body.name for body in chosen]
        info._vBodyInfos = [one for one in info._vBodyInfos if one._name in names]
        with new_file(path) as file:
            file.write_text(json.dumps(info.SerializeJSON()), encoding="utf-8")

    def ExtractInfo(self) -> "EnvironmentBaseInfo":
        """Return the description of the environment; see ``Described``."""
        raise NotImplementedError


def _checked(atts: SaveArguments | None) -> list[tuple[str, str]]:
    """Return the arguments as pairs.

    Raises:
        ArgumentError: One of them is unknown.
    """
    if isinstance(atts, str):
        return [("target", atts)]
    pairs = list((atts.items() if isinstance(atts, Mapping) else atts) or ())
    for pair in cast("list[Sequence[object]]", pairs):
        if len(pair) != 2 or not all(isinstance(text, str) for text in pair):
            raise ArgumentError(f"Save: atts: {pair!r} is no pair of a name and a text")
    for name, value in pairs:
        known = _VALUES.get(name)
        if known is None and name != "target":
            raise ArgumentError(f"Save: atts: nothing reads '{name}'; there are target, {', '.join(_VALUES)}")
        for word in value.split() if known else ():
            if word not in (known or ()):
                raise ArgumentError(f"Save: atts: {name} is '{value}'; known are {', '.join(known or ())}")
    return pairs


def _chosen(bodies: Sequence[KinBody], options: int, targets: Sequence[str]) -> list[KinBody]:
    """Return the bodies that are selected.

    Raises:
        ArgumentError: There is no such selection, or no body of a name.
    """
    if options not in _CHOICES:
        raise ArgumentError(f"Save: options: {options!r} is no SelectionOptions")
    names = [body.name for body in bodies]
    missing = [target for target in targets if target not in names]
    if missing:
        raise ArgumentError(f"Save: atts: there is no body '{missing[0]}'; there are {', '.join(names) or 'none'}")
    selection = SelectionOptions(options)
    if selection == SelectionOptions.Body and not targets:
        raise ArgumentError("Save: atts: SelectionOptions.Body needs the name of a body")
    return [body for body in bodies if _CHOICES[selection](body, targets)]

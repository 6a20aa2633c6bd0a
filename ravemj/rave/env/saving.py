"""Saves the bodies of an environment to files."""

import os
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, cast

from ravemj.core.arguments import checked_kind
from ravemj.core.output import temporary_folder
from ravemj.core.transforms import ZERO
from ravemj.engine.simulation.world import DEFAULT_GRAVITY
from ravemj.engine.snapshot import snapshot
from ravemj.errors import ArgumentError, Diagnostics, UnsupportedError, send_warnings
from ravemj.model.scene import Inertial, KinBody, Scene, View
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.enums import SelectionOptions
from ravemj.rave.env.contents import selects
from ravemj.rave.env.description import Description
from ravemj.rave.env.json_files import is_json, save_json

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml.geom_writer import MeshFormat
    from ravemj.formats.writers import ModelFormat

SaveArguments = str | Mapping[str, str] | Sequence[tuple[str, str]]
"""The argument ``atts`` of ``Save``: the name of a body, or texts by name; in pairs a name may occur twice."""

_WITH_SENSORS = (SelectionOptions.Everything, SelectionOptions.AllExceptBody)
"""Selections that the sensors belong to which no robot carries."""

_NO_MASS = Inertial(1e-10, ZERO, ((1e-7, 0.0, 0.0), (0.0, 1e-7, 0.0), (0.0, 0.0, 1e-7)))  # as without <rigid_body>


def _without_shapes(body: KinBody) -> KinBody:
    return replace(body, links=tuple(replace(link, geometries=(), groups=()) for link in body.links))


_PARTS: dict[str, Callable[[KinBody], KinBody]] = {
    "geometry": _without_shapes,
    "visual": _without_shapes,
    "physics": lambda body: replace(body, links=tuple(replace(link, inertial=_NO_MASS) for link in body.links)),
    "readable": lambda body: body,  # ravemj writes none
    "sensors": lambda body: replace(body, sensors=()),
    "manipulators": lambda body: replace(body, manipulators=()),
}
_NO_EFFECT = {
    "forcewrite": "a body that its file does not give as it is now stands in the file itself, with everything",
    "ignoreexternaluri": "a body stands in the file itself where 'externalref' does not name it",
    "reusesimilar": "each body is written by itself",
}
"""Options of OpenRAVE that do not change what ``Load`` reads back, with the reason that a warning gives."""

_FILE_TYPES = {"collada": ".dae", "json": ".json"}

_VALUES = {
    "skipwrite": tuple(_PARTS),
    "format": ("collada", "openrave", "json"),
    "meshes": ("stl", "obj"),
    "openravescheme": ("openrave",),
}


class Saving(Description):
    """The methods that save models."""

    def Save(
        self,
        filename: str | os.PathLike[str],
        options: int = SelectionOptions.Everything,
        atts: SaveArguments | None = None,
    ) -> None:
        """Write bodies to a file in their current state: joint values, poses, limits, colours, disabled links.

        Args:
            filename: The file. The format is COLLADA 1.5 with OpenRAVE's extensions; with the suffix ``.zae`` a zip
                archive of that, with the suffix ``.json`` OpenRAVE's JSON. ``Load`` reads all of them.
            options: The choice of bodies, a ``SelectionOptions``. ``Everything`` and ``AllExceptBody`` include the
                sensors that no robot carries.
            atts: The name of a body, for ``SelectionOptions.Body`` and ``AllExceptBody``; or a dict or pairs of

                * ``target``: the name of a body; several pairs name several bodies;
                * ``skipwrite``: the parts to leave out: ``geometry`` or ``visual``, ``physics`` (masses),
                  ``sensors``, ``manipulators``, ``readable``;
                * ``format``: ``openrave`` for OpenRAVE XML, with meshes in the folder ``meshes`` beside the file,
                  ``collada`` or ``json``;
                * ``externalref``: names of bodies, or ``*`` for all. In COLLADA they become references to the COLLADA
                  files that they were read from, with their poses, joint values and grabbed bodies. A body with other
                  changes is written to the new file itself, with a warning (``not-referred``);
                * ``openravescheme``: ``openrave`` makes references to files in the folders of ``OPENRAVE_DATA`` start
                  with ``openrave:/``, so that they lead there wherever the new file lies;
                * ``meshes``: the format of the meshes, ``stl`` or ``obj``.

        Raises:
            openrave_exception: there is no such body, or an argument is wrong.
            OutputError: the file cannot be written, or its format does not allow a name. An existing file stays as it
                is.

        Example:
            >>> env.Load("models/env.xml")
            True
            >>> env.Save("scene.dae")
            >>> env.Save("robot.zae", env.SelectionOptions.Body, env.GetRobots()[0].GetName())
        """
        from ravemj.formats.writers import external_bodies, save  # noqa: PLC0415 - slow to import, and rarely wanted

        checked_kind(filename, (str, os.PathLike), "Save: filename", "a path")
        path = os.fspath(filename)
        if path.lower().endswith(".msgpack"):
            raise UnsupportedError("Save", "MessagePack files")
        given = _checked(atts)
        named = dict(given)
        skipped = [part for name, value in given if name == "skipwrite" for part in value.split()]
        self._check_alive()
        with self._simulation.lock:
            bodies = [
                replace(snapshot(body), description=self.wrap(body).GetDescription())
                for body in self._simulation.bodies
            ]
            view, gravity = self._simulation.view, self._simulation.gravity
            sensors = tuple(sensor.description for sensor in self._sensors)
        if options not in _WITH_SENSORS or "sensors" in skipped:
            sensors = ()
        bodies = _chosen(bodies, options, [value for name, value in given if name == "target"])
        names = [body.name for body in bodies]
        if named.get("format") == "json" or ("format" not in named and is_json(path)):
            content = Scene(tuple(bodies), view, sensors=sensors)
            save_json(self.ExtractInfo(), path, content, skipped)
            return
        kind = cast("ModelFormat", named.get("format", "collada"))
        if self._metre != 1 and kind == "collada":
            raise UnsupportedError("Save", "COLLADA files in other units than the metre")
        bodies = [replace(one, grabs=tuple(grab for grab in one.grabs if grab.body in names)) for one in bodies]
        diagnostics = Diagnostics()
        references = _external_names(given, names) if kind == "collada" else set[str]()
        external = external_bodies(path, Scene(tuple(bodies)), references, diagnostics, named.get("openravescheme"))
        for part in skipped:
            bodies = [body if body.name in external else _PARTS[part](body) for body in bodies]
        shown = None if len(bodies) == 1 and view == View() else view
        gravity = None if gravity == DEFAULT_GRAVITY else gravity
        scene = Scene(tuple(bodies), shown, gravity, sensors, self.GetDescription())
        save(path, scene, diagnostics, kind, cast("MeshFormat", named.get("meshes", "stl")), external)
        send_warnings(diagnostics)

    def WriteToMemory(
        self, filetype: str, options: int = SelectionOptions.Everything, atts: SaveArguments | None = None
    ) -> bytes:
        """Return the content that ``Save`` writes to a file.

        Args:
            filetype: ``collada``, or ``json`` for OpenRAVE's JSON.
            options: As for ``Save``.
            atts: As for ``Save``.

        Raises:
            openrave_exception: there is no such type, or an argument is wrong; see ``Save``.
        """
        if filetype not in _FILE_TYPES:
            known = ", ".join(_FILE_TYPES)
            raise ArgumentError(f"WriteToMemory: filetype is {filetype!r}; there are {known}")
        with temporary_folder() as folder:
            path = Path(folder, f"scene{_FILE_TYPES[filetype]}")
            self.Save(path, options, atts)
            return path.read_bytes()


def _checked(atts: SaveArguments | None) -> list[tuple[str, str]]:
    """Return the arguments as pairs of texts."""
    if isinstance(atts, str):
        return [("target", atts)]
    pairs = list((atts.items() if isinstance(atts, Mapping) else atts) or ())
    for pair in cast("list[Sequence[object]]", pairs):
        if len(pair) != 2 or not all(isinstance(text, str) for text in pair):
            raise ArgumentError(f"Save: atts: {pair!r} is not a pair of a name and a text")
    for name, value in pairs:
        if name in _NO_EFFECT:
            diagnostics = Diagnostics()
            diagnostics.warn("ignored-option", f"Save: '{name}' has no effect: {_NO_EFFECT[name]}", FROM_SCRIPT)
            send_warnings(diagnostics)
        elif name not in ("target", "externalref"):
            _check_words(name, value)
    return pairs


def _check_words(name: str, value: str) -> None:
    if name not in _VALUES:
        raise ArgumentError(f"Save: atts: nothing reads '{name}'; there are target, externalref, {', '.join(_VALUES)}")
    for word in value.split():
        if word not in _VALUES[name]:
            raise ArgumentError(f"Save: atts: {name} is '{value}'; known are {', '.join(_VALUES[name])}")


def _external_names(given: Sequence[tuple[str, str]], names: Collection[str]) -> set[str]:
    """Return the names of the bodies that the option ``externalref`` names."""
    asked = {word for name, value in given if name == "externalref" for word in value.split()}
    missing = sorted(asked - {"*", *names})
    if missing:
        raise ArgumentError(f"Save: atts: externalref names '{missing[0]}'; saved are {', '.join(names) or 'none'}")
    return set(names) if "*" in asked else asked


def _chosen(bodies: Sequence[KinBody], options: int, targets: Sequence[str]) -> list[KinBody]:
    """Return the bodies that are selected."""
    if options not in set(SelectionOptions):
        raise ArgumentError(f"Save: options: {options!r} is no SelectionOptions")
    names = [body.name for body in bodies]
    missing = [target for target in targets if target not in names]
    if missing:
        raise ArgumentError(f"Save: atts: there is no body '{missing[0]}'; there are {', '.join(names) or 'none'}")
    if options == SelectionOptions.Body and not targets:
        raise ArgumentError("Save: atts: SelectionOptions.Body needs the name of a body")
    return [body for body in bodies if selects(options, targets, body)]

"""Methods that save environments, and OpenRAVE's JSON files."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import json
import os
from collections import Counter
from collections.abc import Callable, Collection, Generator, Iterable, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ravemj.core.arguments import checked_kind
from ravemj.core.output import new_file, temporary_folder
from ravemj.core.transforms import ZERO
from ravemj.engine.simulation.world import DEFAULT_GRAVITY
from ravemj.engine.snapshot import snapshot
from ravemj.errors import (
    ArgumentError,
    Diagnostics,
    OutputError,
    RavemjError,
    Source,
    SourceError,
    UnsupportedError,
    send_warnings,
)
from ravemj.formats.data_folders import existing
from ravemj.formats.limits import json_bytes
from ravemj.formats.suffixes import SUFFIXES, format_of
from ravemj.model import scene
from ravemj.model.scene import Inertial, KinBody, Scene, View
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.enums import SelectionOptions
from ravemj.rave.env.contents import selects
from ravemj.rave.env.description import Description
from ravemj.rave.infos import EnvironmentBaseInfo, KinBodyInfo

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml.geom_writer import MeshFormat
    from ravemj.formats.writers import ModelFormat


_Given = Callable[[KinBodyInfo], None]


def save_json(
    info: EnvironmentBaseInfo, path: str, content: scene.Scene, skipped: Sequence[str], diagnostics: Diagnostics
) -> None:
    """Write bodies and environment properties to a JSON file; ``skipped`` are words of ``skipwrite``.

    The info is changed. JSON cannot store the view and sensors without a robot; ``diagnostics`` receive warnings about
    them.

    Raises:
        OutputError: the file cannot be written, or a number is not finite. An existing file stays as it is.
    """
    names = {body.name for body in content.bodies}
    info._vBodyInfos = [body for body in info._vBodyInfos if body._name in names]
    for body in info._vBodyInfos:
        body._vGrabbedInfos = [grab for grab in body._vGrabbedInfos if cast("Any", grab)._grabbedname in names]
        for word in skipped:
            _SKIPS[word](body)
    if content.view not in (None, View()):
        message = "background and camera are left out: JSON has no place for them"
        diagnostics.warn("not-written", message, Source(path), "OpenRAVE XML keeps them")
    if content.sensors:
        names_of_sensors = ", ".join(sensor.name for sensor in content.sensors)
        message = f"sensors that no robot carries are left out: {names_of_sensors}; JSON has no place for them"
        diagnostics.warn("not-written", message, Source(path), "OpenRAVE XML and COLLADA keep them")
    _warn_of_losses(diagnostics, path, content.bodies)
    try:
        text = json.dumps(info.SerializeJSON(), allow_nan=False)
    except ValueError as error:
        raise OutputError(f"cannot write {path}: a number is not finite, and JSON has no word for it") from error
    with new_file(path) as file:
        file.write_text(text + "\n", encoding="utf-8", newline="\n")


@contextmanager
def placed_errors(path: str) -> Generator[None]:
    """Context manager that converts errors about values into errors that name the file."""
    try:
        yield
    except SourceError:
        raise
    except RavemjError as error:
        raise SourceError(str(error), Source(path)) from error
    except (ArithmeticError, RecursionError) as error:
        raise SourceError("a number in the file is too large or too small to compute with", Source(path)) from error
    except (TypeError, ValueError, LookupError) as error:  # a hundred places convert values; any can meet a wrong type
        raise SourceError(f"a value in the file is of a wrong kind: {error}", Source(path)) from error


def read_json(path: str) -> tuple[str, dict[str, Any]]:
    """Search a file as ``Load`` does; return its path and its JSON object.

    Raises:
        SourceError: The file is missing or broken.
    """
    file = existing(path)
    return file, _parsed(file)


def _parsed(path: str) -> dict[str, Any]:
    """Parse the JSON object of a file, which must have a list of bodies."""
    try:
        content = json.loads(json_bytes(path).decode("utf-8-sig"), parse_constant=_refuse)
    except json.JSONDecodeError as error:
        raise SourceError(f"not well-formed JSON: {error.msg}", Source(path, error.lineno)) from error
    except RecursionError as error:
        raise SourceError("the values are nested too deeply", Source(path)) from error
    except (OSError, ValueError) as error:  # also bytes that are no UTF-8
        raise SourceError(f"cannot be read: {error}", Source(path)) from error
    bodies = cast("dict[str, Any]", content).get("bodies") if isinstance(content, dict) else None
    if not isinstance(bodies, list):
        message = 'the file has no list of bodies ("bodies"), which OpenRAVE\'s JSON has'
        raise SourceError(message, Source(path))
    return cast("dict[str, Any]", content)


def _warn_of_losses(diagnostics: Diagnostics, path: str, bodies: Iterable[scene.KinBody]) -> None:
    """Warn about properties of bodies that OpenRAVE's JSON cannot store."""
    for body in bodies:
        count = Counter(link.name for link in body.links)
        if any(count[body.links[index].name] > 1 for index in body.referenced_links):
            message = f"several links of '{body.name}' have no name, and JSON refers to links by names"
            raise OutputError(f"cannot write {path}: {message}; give each link a name of its own")
        if not body.joined_links_adjacent:
            message = f"JSON cannot store that joined links of '{body.name}' can collide; they are adjacent in the file"
            diagnostics.warn("not-written", message, Source(path))
        if body.description:
            message = f"JSON cannot store the description of '{body.name}'; it is left out"
            diagnostics.warn("not-written", message, Source(path), "COLLADA keeps it")
        drawn = [part for link in body.links for part in link.geometries if part.display is not None]
        if drawn:
            message = f"JSON cannot store the meshes that '{body.name}' draws in place of its shapes; they are left out"
            diagnostics.warn("not-written", message, Source(path))


def _refuse(word: str) -> None:
    raise ValueError(f"{word} is not a number in JSON")


def _skip_geometry(body: KinBodyInfo) -> None:
    for link in body._vLinkInfos:
        link._vgeometryinfos, link._mapExtraGeometries = [], {}


def _skip_masses(body: KinBodyInfo) -> None:
    for link in body._vLinkInfos:
        link._mass, link._tMassFrame, link._vinertiamoments = 1e-10, np.eye(4), np.full(3, 1e-7)


_SKIPS: dict[str, _Given] = {
    "geometry": _skip_geometry,
    "visual": _skip_geometry,
    "physics": _skip_masses,
    "readable": lambda body: None,
    "sensors": lambda body: setattr(body, "_vAttachedSensorInfos", []),
    "manipulators": lambda body: setattr(body, "_vManipInfos", []),
}


SaveArguments = str | Mapping[str, str] | Sequence[tuple[str, str]]
"""Argument ``atts`` of ``Save``: the name of a body, or options by name; as pairs, an option may be repeated."""

_WITH_SENSORS = (SelectionOptions.Everything, SelectionOptions.AllExceptBody)
"""Options with which ``Save`` also saves sensors that are not attached to robots."""

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
"""Save options of OpenRAVE that do not change what ``Load`` reads back, and the reasons given in warnings."""

_IN_MEMORY = ("collada", "json")
_VALUES = {
    "skipwrite": tuple(_PARTS),
    "format": ("collada", "openrave", "urdf", "json"),
    "meshes": ("stl", "obj"),
    "openravescheme": ("openrave",),
}


class Saving(Description):
    """Methods that save environments."""

    _internal = ("write",)

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
        diagnostics = Diagnostics()
        self.write(filename, options, atts, diagnostics)
        send_warnings(diagnostics)

    def write(
        self,
        filename: str | os.PathLike[str],
        options: int,
        atts: SaveArguments | None,
        diagnostics: Diagnostics,
    ) -> None:
        """Save as ``Save`` does, and add the warnings to ``diagnostics``."""
        from ravemj.formats.writers import external_bodies, save  # noqa: PLC0415 - slow to import, and rarely wanted

        checked_kind(filename, (str, os.PathLike), "Save: filename", "a path")
        path = os.fspath(filename)
        if path.lower().endswith(".msgpack"):
            raise UnsupportedError("Save", "MessagePack files")
        given = _checked(atts, diagnostics)
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
        if named.get("format") == "json" or ("format" not in named and format_of(path) == "json"):
            content = Scene(tuple(bodies), view, sensors=sensors)
            save_json(self.ExtractInfo(), path, content, skipped, diagnostics)
            return
        usual = "urdf" if format_of(path) == "urdf" else "collada"
        kind = cast("ModelFormat", named.get("format", usual))
        if self._metre != 1 and kind == "collada":
            raise UnsupportedError("Save", "COLLADA files in other units than the metre")
        bodies = [replace(body, grabs=tuple(grab for grab in body.grabs if grab.body in names)) for body in bodies]
        references = _external_names(given, names) if kind == "collada" else set[str]()
        external = external_bodies(path, Scene(tuple(bodies)), references, diagnostics, named.get("openravescheme"))
        for part in skipped:
            bodies = [body if body.name in external else _PARTS[part](body) for body in bodies]
        shown = None if len(bodies) == 1 and view == View() else view
        gravity = None if gravity == DEFAULT_GRAVITY else gravity
        scene = Scene(tuple(bodies), shown, gravity, sensors, self.GetDescription())
        save(path, scene, diagnostics, kind, cast("MeshFormat", named.get("meshes", "stl")), external)

    def WriteToMemory(
        self, filetype: str, options: int = SelectionOptions.Everything, atts: SaveArguments | None = None
    ) -> bytes:
        """Return the file content that ``Save`` would write.

        Args:
            filetype: ``collada``, or ``json`` for OpenRAVE's JSON.
            options: As for ``Save``.
            atts: As for ``Save``.

        Raises:
            openrave_exception: there is no such type, or an argument is wrong; see ``Save``.
        """
        if filetype not in _IN_MEMORY:
            known = ", ".join(_IN_MEMORY)
            raise ArgumentError(f"WriteToMemory: filetype is {filetype!r}; there are {known}")
        with temporary_folder() as folder:
            path = Path(folder, f"scene{SUFFIXES[filetype][0]}")
            self.Save(path, options, atts)
            return path.read_bytes()


def _checked(atts: SaveArguments | None, diagnostics: Diagnostics) -> list[tuple[str, str]]:
    """Return the save options as pairs of name and value; if ``atts`` is a string, it is the value of ``target``."""
    if isinstance(atts, str):
        return [("target", atts)]
    pairs = list((atts.items() if isinstance(atts, Mapping) else atts) or ())
    for pair in cast("list[Sequence[object]]", pairs):
        if len(pair) != 2 or not all(isinstance(text, str) for text in pair):
            raise ArgumentError(f"Save: atts: {pair!r} is not a pair of a name and a text")
    for name, value in pairs:
        if name in _NO_EFFECT:
            diagnostics.warn("ignored-option", f"Save: '{name}' has no effect: {_NO_EFFECT[name]}", FROM_SCRIPT)
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
    """Return the names of the bodies to save as references, from the option ``externalref``; ``*`` means all."""
    asked = {word for name, value in given if name == "externalref" for word in value.split()}
    missing = sorted(asked - {"*", *names})
    if missing:
        raise ArgumentError(f"Save: atts: externalref names '{missing[0]}'; saved are {', '.join(names) or 'none'}")
    return set(names) if "*" in asked else asked


def _chosen(bodies: Sequence[KinBody], options: int, targets: Sequence[str]) -> list[KinBody]:
    if options not in set(SelectionOptions):
        raise ArgumentError(f"Save: options: {options!r} is no SelectionOptions")
    names = [body.name for body in bodies]
    missing = [target for target in targets if target not in names]
    if missing:
        raise ArgumentError(f"Save: atts: there is no body '{missing[0]}'; there are {', '.join(names) or 'none'}")
    if options == SelectionOptions.Body and not targets:
        raise ArgumentError("Save: atts: SelectionOptions.Body needs the name of a body")
    return [body for body in bodies if selects(options, targets, body)]

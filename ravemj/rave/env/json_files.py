"""Saves and loads environments in OpenRAVE's JSON format, which infos write and read."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import json
import os
from collections.abc import Callable, Collection, Generator, Iterable, Sequence
from contextlib import contextmanager
from typing import Any, cast

import numpy as np

from ravemj.core.output import new_file
from ravemj.errors import Diagnostics, OutputError, RavemjError, Source, SourceError, send_warnings
from ravemj.model import scene
from ravemj.model.scene import View
from ravemj.rave.env.description import Description
from ravemj.rave.infos import EnvironmentBaseInfo, KinBodyInfo
from ravemj.rave.kinbody import KinBody

SUFFIX = ".json"

_Given = Callable[[KinBodyInfo], None]


def is_json(path: str) -> bool:
    """Return whether a file is JSON, by the suffix of its name."""
    return path.lower().endswith(SUFFIX)


class JsonFiles(Description):
    """Saves and loads environments in OpenRAVE's JSON."""

    def _save_json(
        self, path: str, names: Collection[str], skipped: Sequence[str], sensors: Sequence[scene.AttachedSensor]
    ) -> None:
        """Write bodies and the properties of the environment to a file.

        Args:
            path: The file.
            names: The names of the bodies.
            skipped: The parts to leave out, words of ``skipwrite``.
            sensors: The sensors that no robot carries; JSON has no place for them.

        Raises:
            OutputError: The file cannot be written, or a number is not finite. An existing file stays as it is.
        """
        info = self.ExtractInfo()
        info._vBodyInfos = [body for body in info._vBodyInfos if body._name in names]
        for body in info._vBodyInfos:
            body._vGrabbedInfos = [grab for grab in body._vGrabbedInfos if cast("Any", grab)._grabbedname in names]
            for word in skipped:
                _SKIPS[word](body)
        diagnostics = Diagnostics()
        if self._simulation.view not in (None, View()):
            message = "background and camera are left out: JSON has no place for them"
            diagnostics.warn("not-written", message, Source(path), "OpenRAVE XML keeps them")
        if sensors:
            names_of_sensors = ", ".join(sensor.name for sensor in sensors)
            message = f"sensors that no robot carries are left out: {names_of_sensors}; JSON has no place for them"
            diagnostics.warn("not-written", message, Source(path), "OpenRAVE XML and COLLADA keep them")
        _warn_of_losses(
            diagnostics, path, [body.simulation_state.scene for body in self.GetBodies() if body.GetName() in names]
        )
        send_warnings(diagnostics)
        try:
            text = json.dumps(info.SerializeJSON(), allow_nan=False)
        except ValueError as error:
            raise OutputError(f"cannot write {path}: a number is not finite, and JSON has no word for it") from error
        with new_file(path) as file:
            file.write_text(text + "\n", encoding="utf-8", newline="\n")

    def _load_json(self, path: str) -> None:
        """Load the environment of a file; see ``LoadJSON``.

        Raises:
            SourceError: The file is missing or broken. Bodies before the error are in the environment.
        """
        self._check_alive()
        content = self._content(path)
        with _placed_errors(path):
            self.LoadJSON(content)

    def _body_of_json(self, path: str, into: KinBody | None, *, is_robot: bool) -> KinBody:
        """Return the first body of a file, without adding it.

        Args:
            path: The file.
            into: An existing body to replace, or None for a new one.
            is_robot: Whether to make a robot, whatever the file says.

        Raises:
            SourceError: The file is missing or broken, or has no body.
        """
        content = self._content(path)
        info = EnvironmentBaseInfo()
        with _placed_errors(path):
            self._read_json(info, content)
            if not info._vBodyInfos:
                raise SourceError("there is no body in it", Source(path))
            first = info._vBodyInfos[0]
            first._uri = f"file:{os.path.abspath(path)}"
            first._isRobot = into.IsRobot() if into is not None else first._isRobot or is_robot
            body = self._new_body(is_robot=first._isRobot) if into is None else into
            body.InitFromKinBodyInfo(first)
        return body

    def _content(self, path: str) -> dict[str, Any]:
        """Return the content of a file, and note that it was read.

        Raises:
            SourceError: The file is missing or broken.
        """
        from ravemj.formats.readers import find  # noqa: PLC0415 - slow to import

        found = find(path)
        if found is None:
            raise SourceError("there is no such file", Source(path), "check the path, or set OPENRAVE_DATA")
        content = _parsed(found)
        self._files[found] = None
        return content


@contextmanager
def _placed_errors(path: str) -> Generator[None]:
    """Turn errors about values into errors that name the file."""
    try:
        yield
    except SourceError:
        raise
    except RavemjError as error:
        raise SourceError(str(error), Source(path)) from error
    except (ArithmeticError, RecursionError) as error:
        raise SourceError("a number in the file is too large to compute with", Source(path)) from error
    except (TypeError, ValueError, LookupError) as error:  # a hundred places convert values; any can meet a wrong type
        raise SourceError(f"a value in the file is of a wrong kind: {error}", Source(path)) from error


def _parsed(path: str) -> dict[str, Any]:
    """Return the JSON object in a file.

    Raises:
        SourceError: The file cannot be read, or does not contain an object with a list of bodies.
    """
    try:
        with open(path, encoding="utf-8") as file:
            content = json.load(file, parse_constant=_refuse)
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
        if not body.joined_links_adjacent:
            message = f"JSON cannot store that joined links of '{body.name}' can collide; they are adjacent in the file"
            diagnostics.warn("not-written", message, Source(path))
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

"""Saves and loads environments in OpenRAVE's JSON format, which infos write and read."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import json
from collections import Counter
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import contextmanager
from typing import Any, cast

import numpy as np

from ravemj.core.output import new_file
from ravemj.errors import Diagnostics, OutputError, RavemjError, Source, SourceError
from ravemj.formats.data_folders import existing
from ravemj.formats.limits import json_bytes
from ravemj.model import scene
from ravemj.model.scene import View
from ravemj.rave.infos import EnvironmentBaseInfo, KinBodyInfo

SUFFIX = ".json"

_Given = Callable[[KinBodyInfo], None]


def is_json(path: str) -> bool:
    """Return whether a file is JSON, by the suffix of its name."""
    return path.lower().endswith(SUFFIX)


def save_json(
    info: EnvironmentBaseInfo, path: str, content: scene.Scene, skipped: Sequence[str], diagnostics: Diagnostics
) -> None:
    """Write bodies and the properties of their environment to a file; ``skipped`` are words of ``skipwrite``.

    The info is changed. JSON has no place for the view and for sensors that no robot carries; ``diagnostics`` get
    warnings that they are left out.

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


def read_json(path: str) -> tuple[str, dict[str, Any]]:
    """Return the path of a file that is looked for as ``Load`` does, and the object that it holds.

    Raises:
        SourceError: The file is missing or broken.
    """
    found = existing(path)
    return found, _parsed(found)


def _parsed(path: str) -> dict[str, Any]:
    """Return the JSON object in a file, which has a list of bodies."""
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

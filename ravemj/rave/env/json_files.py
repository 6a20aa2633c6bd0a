"""Files in OpenRAVE's JSON: an environment as infos write and read it."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import json
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import contextmanager
from typing import Any, cast

import numpy as np

from ravemj.core.output import new_file
from ravemj.errors import Diagnostics, OutputError, RavemjError, Source, SourceError, send_warnings
from ravemj.model import scene
from ravemj.model.scene import View
from ravemj.rave.infos import EnvironmentBaseInfo, KinBodyInfo

SUFFIX = ".json"

_Given = Callable[[KinBodyInfo], None]


def is_json(path: str) -> bool:
    """Tell whether a file holds JSON, by the end of its name."""
    return path.lower().endswith(SUFFIX)


def save_json(
    info: EnvironmentBaseInfo, path: str, bodies: Sequence[scene.KinBody], view: View, skipped: Sequence[str]
) -> None:
    """Write bodies, with what else there is to say about their environment.

    Args:
        info: The environment; it is changed.
        path: The file.
        bodies: The bodies.
        view: Background and camera, of which a warning says that they are left out.
        skipped: What is left out, words of ``skipwrite``.

    Raises:
        OutputError: The file cannot be written, or a number is not finite; nothing is changed then.
    """
    names = {body.name for body in bodies}
    info._vBodyInfos = [body for body in info._vBodyInfos if body._name in names]
    for body in info._vBodyInfos:
        body._vGrabbedInfos = [grab for grab in body._vGrabbedInfos if cast("Any", grab)._grabbedname in names]
        for word in skipped:
            _SKIPS[word](body)
    diagnostics = Diagnostics()
    if view != View():
        message = "background and camera are left out: JSON has no place for them"
        diagnostics.warn("not-written", message, Source(path), "OpenRAVE XML keeps them")
    _warn_of_losses(diagnostics, path, bodies)
    send_warnings(diagnostics)
    try:
        text = json.dumps(info.SerializeJSON(), allow_nan=False)
    except ValueError as error:
        raise OutputError(f"cannot write {path}: a number is not finite, and JSON has no word for it") from error
    with new_file(path) as file:
        file.write_text(text + "\n", encoding="utf-8", newline="\n")


@contextmanager
def placed_errors(path: str) -> Generator[None]:
    """Let errors about values name the file that they stand in."""
    try:
        yield
    except SourceError:
        raise
    except RavemjError as error:
        raise SourceError(str(error), Source(path)) from error
    except (ArithmeticError, RecursionError) as error:
        raise SourceError("a number in the file is too large to compute with", Source(path)) from error
    except (TypeError, ValueError, LookupError) as error:  # values of wrong kinds, in any of a hundred places
        raise SourceError(f"a value in the file is of a wrong kind: {error}", Source(path)) from error


def read_json(path: str) -> tuple[str, dict[str, Any]]:
    """Return the path of a file that is looked for as ``Load`` does, and the object that it holds.

    Raises:
        SourceError: The file is missing or broken.
    """
    from ravemj.formats.readers import find  # noqa: PLC0415 - slow to import

    found = find(path)
    if found is None:
        raise SourceError("there is no such file", Source(path), "check the path, or set OPENRAVE_DATA")
    return found, _parsed(found)


def _parsed(path: str) -> dict[str, Any]:
    """Return the object that a file holds.

    Raises:
        SourceError: There is none.
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
        message = "OpenRAVE's JSON is an object with a list of bodies, and here is none"
        raise SourceError(message, Source(path))
    return cast("dict[str, Any]", content)


def _warn_of_losses(diagnostics: Diagnostics, path: str, bodies: Iterable[scene.KinBody]) -> None:
    """Warn of what OpenRAVE's JSON cannot say of bodies."""
    for body in bodies:
        if not body.joined_links_adjacent:
            message = f"that links of '{body.name}' can collide at their joints is left out; JSON cannot say it"
            diagnostics.warn("not-written", message, Source(path))
        drawn = [part for link in body.links for part in link.geometries if part.display is not None]
        if drawn:
            message = f"meshes that '{body.name}' draws in place of its shapes are left out; JSON cannot say them"
            diagnostics.warn("not-written", message, Source(path))


def _refuse(word: str) -> None:
    raise ValueError(f"{word} is no number in JSON")


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

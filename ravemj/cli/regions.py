"""Goal regions of the command line: region files, and regions near a point."""

import argparse
import json
import math
from typing import Any, cast

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, RavemjError, Source, SourceError
from ravemj.formats.limits import json_bytes
from ravemj.rave import Environment, Region
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator

_KEYS = ("T0_w", "Tw_e", "Bw", "lean", "frame", "name", "preshape")
_FIELDS = "T0_w, Tw_e (4x4, or w,x,y,z and x,y,z), Bw (6x2), lean [rad], frame, name, preshape"
_HINT = f"an object with {_FIELDS}; or a list of these"
_ANY, _TURN = [-math.inf, math.inf], [-math.pi, math.pi]


def goal_regions(env: Environment, arm: Manipulator, options: argparse.Namespace) -> list[Region]:
    """Return the goal regions of the options; none if the goal is of another kind.

    Raises:
        ArgumentError: an option is missing, or ``--near`` is not a point.
        SourceError: the file contains no regions.
    """
    if options.region is not None:
        return read_regions(options.region, env)
    if options.near is None:
        if options.within is not None:
            raise ArgumentError("--within says how far from a point; give the point as --near x,y,z")
        return []
    if len(options.near) != 3:
        raise ArgumentError(f"--near: found {len(options.near)} numbers, expected x,y,z")
    T_world_w = np.eye(4)
    T_world_w[:3, 3] = options.near
    far = 0.01 if options.within is None else options.within
    place = [[-far, far]] * 3
    if options.upright is None:
        return [Region(T_world_w, Bw=[*place, _TURN, _TURN, _TURN], name="near")]
    return [_upright(arm, T_world_w, place, options.upright, "near")]


def upright(arm: Manipulator, degrees: float) -> Region:
    """Return the region of tool poses at any position with a limited tilt from the present pose [degrees]."""
    return _upright(arm, np.eye(4), [_ANY] * 3, degrees, "upright")


def _upright(arm: Manipulator, T_world_w: Floats, place: list[list[float]], degrees: float, name: str) -> Region:
    T_w_tool = arm.GetTransform()
    T_w_tool[:3, 3] = 0
    return Region(T_world_w, T_w_tool, [*place, [0, 0], [0, 0], _TURN], lean=math.radians(degrees), name=name)


def read_regions(path: str, env: Environment) -> list[Region]:
    """Read the regions of a JSON file.

    Raises:
        SourceError: the file cannot be read, or does not contain regions.
    """
    try:
        content: Any = json.loads(json_bytes(path))
    except OSError as error:
        raise SourceError(f"cannot read the file: {(error.strerror or str(error)).lower()}", Source(path)) from None
    except (RecursionError, ValueError) as error:
        raise SourceError(f"not JSON: {error}", Source(path), _HINT) from None
    several = cast("list[object]", content) if isinstance(content, list) else [content]
    if not several:
        raise SourceError("the list of regions is empty", Source(path), _HINT)
    return [_region(region, f"region {number}", path, env) for number, region in enumerate(several)]


def _region(given: object, name: str, path: str, env: Environment) -> Region:
    if not isinstance(given, dict):
        raise SourceError(f"{name} is {json.dumps(given)[:40]}", Source(path), _HINT)
    fields = cast("dict[str, Any]", given)
    unknown = fields.keys() - set(_KEYS)
    if unknown:
        raise SourceError(f"{name}: there is no field '{min(unknown)}'", Source(path), _HINT)
    try:
        known: dict[str, Any] = {"name": name, **{key: value for key, value in fields.items() if value is not None}}
        known["name"] = str(known["name"])
        if "frame" in known:
            known["frame"] = _frame(str(known["frame"]), env)
        for key in known.keys() & {"T0_w", "Tw_e", "Bw"}:
            known[key] = np.array(known[key], dtype=float)
        return Region(**known)
    except (RavemjError, TypeError, ValueError) as error:
        reason = error.message if isinstance(error, RavemjError) else str(error)
        raise SourceError(f"{name}: {reason}", Source(path), _HINT) from None


def _frame(text: str, env: Environment) -> KinBody | Link:
    """Return the body ``BODY`` or the link ``BODY/LINK`` that ``text`` names; raise if there is none."""
    body = env.GetKinBody(text)
    if body is not None:
        return body
    name, _, link = text.rpartition("/")
    body = env.GetKinBody(name)
    wanted = None if body is None else body.GetLink(link)
    if wanted is None:
        names = ", ".join(other.GetName() for other in env.GetBodies())
        raise ArgumentError(
            f"frame: there is no body or link '{text}'; write BODY or BODY/LINK; the bodies are {names}"
        )
    return wanted

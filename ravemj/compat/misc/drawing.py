"""Drawings of axes, circles and IK goals in an environment."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers, checked_transform
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.rave.env.viewing import GraphHandle
from ravemj.rave.environment import Environment
from ravemj.rave.specification import IkParameterization

_FRAMES = {
    IkParameterizationType.Transform6D,
    IkParameterizationType.Rotation3D,
    IkParameterizationType.Translation3D,
    IkParameterizationType.Lookat3D,
}
_LINES = {
    IkParameterizationType.Direction3D,
    IkParameterizationType.Ray4D,
    IkParameterizationType.TranslationDirection5D,
}
_AXIS_COLOURS = {"rgb": np.eye(3), "cmy": 1 - np.eye(3)}


def DrawAxes(
    env: Environment,
    target: Any,  # noqa: ANN401 - a body, a name, a matrix, a list of these
    dist: float = 1.0,
    linewidth: float = 1,
    colormode: str = "rgb",
    coloradd: ArrayLike | None = None,
) -> object:
    """Draw the three axes of a frame, in red, green and blue.

    Args:
        env: The environment.
        target: A pose (4x4, or [w, x, y, z, tx, ty, tz]), the name of a body, something with ``GetTransform``, a list
            of these, or None for the world.
        dist: Length of the axes [m].
        linewidth: Width of the lines [pixels].
        colormode: ``'rgb'`` or ``'cmy'``.
        coloradd: Colour that is added to each, shape (3,).

    Returns:
        The handle of the lines, which disappear with it; a list of handles for a list; None without a viewer.

    Example:
        >>> handle = misc.DrawAxes(env, robot.GetActiveManipulator(), dist=0.2)
    """
    if isinstance(target, list) and not _is_pose(target):  # pyright: ignore[reportUnknownArgumentType]
        return [DrawAxes(env, pose, dist, linewidth, colormode, coloradd) for pose in target]  # pyright: ignore[reportUnknownVariableType]
    T = _transform(env, target)
    colours = _AXIS_COLOURS[colormode] + (0 if coloradd is None else checked_numbers(coloradd, "coloradd"))
    origin = T[:3, 3]
    points = np.array([point for axis in T[:3, :3].T for point in (origin, origin + dist * axis)])
    return env.drawlinelist(points, linewidth, colors=np.clip(np.repeat(colours, 2, axis=0), 0, 1))


def DrawCircle(
    env: Environment,
    center: ArrayLike,
    normal: ArrayLike,
    radius: float,
    linewidth: float = 1,
    colors: ArrayLike | None = None,
) -> object:
    """Draw a circle; return the handle of the line.

    Args:
        env: The environment.
        center: The centre [m], shape (3,).
        normal: The normal of its plane, shape (3,).
        radius: Radius [m].
        linewidth: Width of the line [pixels].
        colors: Red, green and blue from 0 to 1; by default black.
    """
    right, up = np.linalg.svd(checked_numbers(normal, "normal").reshape(1, 3))[2][1:]
    angles = np.linspace(0, 2 * np.pi, 65)
    points = checked_numbers(center, "center") + radius * (
        np.outer(np.cos(angles), right) + np.outer(np.sin(angles), up)
    )
    return env.drawlinestrip(points, linewidth, colors=np.array((0, 0, 0) if colors is None else colors))


def DrawIkparam(
    env: Environment,
    ikparam: IkParameterization,
    dist: float = 1.0,
    linewidth: float = 1,
    coloradd: ArrayLike | None = None,
) -> object:
    """Draw an IK goal: axes at its position, or a line along its direction.

    Args:
        env: The environment.
        ikparam: The goal.
        dist: Length of axes and lines [m].
        linewidth: Width of the lines [pixels].
        coloradd: Colour that is added, shape (3,).

    Returns:
        The handle of the lines.
    """
    kind, values = ikparam.GetType(), ikparam.GetValues()
    if kind in _FRAMES:
        rotation = values[:4] if len(values) > 3 else [1, 0, 0, 0]
        origin = [0, 0, 0] if kind == IkParameterizationType.Rotation3D else values[-3:]
        return DrawAxes(env, [*rotation, *origin], dist, linewidth, coloradd=coloradd)
    if kind not in _LINES:
        raise ArgumentError(f"ikparam: its type is {kind.name}, which cannot be drawn")
    start = values[3:] if len(values) > 3 else np.zeros(3)
    colour = np.array([1.0, 0, 0]) + (0 if coloradd is None else checked_numbers(coloradd, "coloradd"))
    return env.drawlinelist(np.array([start, start + dist * values[:3]]), linewidth, colors=np.clip(colour, 0, 1))


def DrawIkparam2(
    env: Environment,
    ikparam: IkParameterization,
    dist: float = 1.0,
    linewidth: float = 1,
    coloradd: ArrayLike | None = None,
) -> list[object]:
    """Draw like ``DrawIkparam``; return a list of handles."""
    return [DrawIkparam(env, ikparam, dist, linewidth, coloradd)]


def _is_pose(target: object) -> bool:
    """Return whether ``target`` is a single pose (7, 3x4 or 4x4 numbers), not a list of targets."""
    try:
        return np.shape(np.array(target, dtype=np.float64)) in {(7,), (3, 4), (4, 4)}
    except (TypeError, ValueError):
        return False


def _transform(env: Environment, target: Any) -> Floats:  # noqa: ANN401 - as of DrawAxes
    if target is None:
        return np.eye(4)
    thing: Any = env.GetKinBody(target) if isinstance(target, str) else target
    if thing is None:
        raise ArgumentError(f"target: there is no body '{target}'")
    if hasattr(thing, "GetTransform"):
        return thing.GetTransform()
    return checked_transform(thing, "target")


def DrawLabel(
    env: Environment,
    label: str = "Label",
    worldPosition: ArrayLike = (0, 0, 0),
    color: ArrayLike = (0, 0, 0, 1),
    height: float = 0.05,
) -> GraphHandle | None:
    """Draw a text beside a point; see ``env.drawlabel``.

    Args:
        env: The environment.
        label: The text.
        worldPosition: The point [m], shape (3,).
        color: Colour of the point, which is drawn, too: red, green, blue and opacity from 0 to 1.
        height: Not used.

    Returns:
        The handle that keeps the text; None without a viewer.
    """
    return env.drawlabel(label, worldPosition, color, height)

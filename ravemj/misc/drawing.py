"""Axes and circles, drawn into an environment."""

from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from ravemj.arrays import checked_numbers, checked_transform
from ravemj.errors import ArgumentError
from ravemj.transforms import Floats

_AXIS_COLOURS = {"rgb": np.eye(3), "cmy": 1 - np.eye(3)}


class HasTransform(Protocol):
    """A body, a link, a manipulator, a sensor."""

    def GetTransform(self) -> Floats:
        """Return the pose in the world, shape (4, 4)."""
        ...


class Canvas(Protocol):
    """An environment, as far as drawing is concerned."""

    def GetKinBody(self, name: str) -> HasTransform | None:
        """Return the body of that name, or None."""
        ...

    def drawlinelist(self, points: ArrayLike, linewidth: float, colors: ArrayLike) -> object:
        """Draw lines between pairs of points."""
        ...

    def drawlinestrip(self, points: ArrayLike, linewidth: float, colors: ArrayLike) -> object:
        """Draw a line through points."""
        ...


def DrawAxes(
    env: Canvas,
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
        return [DrawAxes(env, one, dist, linewidth, colormode, coloradd) for one in target]  # pyright: ignore[reportUnknownVariableType]
    T = _transform(env, target)
    colours = _AXIS_COLOURS[colormode] + (0 if coloradd is None else checked_numbers(coloradd, "coloradd"))
    origin = T[:3, 3]
    points = np.array([point for axis in T[:3, :3].T for point in (origin, origin + dist * axis)])
    return env.drawlinelist(points, linewidth, colors=np.clip(np.repeat(colours, 2, axis=0), 0, 1))


def DrawCircle(
    env: Canvas,
    center: ArrayLike,
    normal: ArrayLike,
    radius: float,
    linewidth: float = 1,
    colors: ArrayLike = (0, 0, 0),
) -> object:
    """Draw a circle; returns the handle of the line.

    Args:
        env: The environment.
        center: Its centre [m], shape (3,).
        normal: The axis that it goes around, shape (3,).
        radius: Radius [m].
        linewidth: Width of the line [pixels].
        colors: Red, green and blue from 0 to 1.
    """
    right, up = np.linalg.svd(checked_numbers(normal, "normal").reshape(1, 3))[2][1:]
    angles = np.linspace(0, 2 * np.pi, 65)
    points = checked_numbers(center, "center") + radius * (
        np.outer(np.cos(angles), right) + np.outer(np.sin(angles), up)
    )
    return env.drawlinestrip(points, linewidth, colors=np.array(colors))


def _is_pose(target: object) -> bool:
    """Tell the numbers of one pose from a list of targets."""
    try:
        return np.shape(np.array(target, dtype=np.float64)) in {(7,), (3, 4), (4, 4)}
    except (TypeError, ValueError):
        return False


def _transform(env: Canvas, target: Any) -> Floats:  # noqa: ANN401 - as of DrawAxes
    if target is None:
        return np.eye(4)
    thing: Any = env.GetKinBody(target) if isinstance(target, str) else target
    if thing is None:
        raise ArgumentError(f"target: there is no body '{target}'")
    if hasattr(thing, "GetTransform"):
        return thing.GetTransform()
    return checked_transform(thing, "target")

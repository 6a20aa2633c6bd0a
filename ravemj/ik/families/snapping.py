"""Nominal geometry: snap nearly intersecting, parallel or perpendicular axes.

Files have four to six digits, so that axes designed to intersect miss by micrometres. A family is derived from the
nominal geometry; its solutions are the starts of Newton's method on the true geometry if the two differ.
"""

from dataclasses import replace

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.families.blocks import common_point
from ravemj.ik.vectors import Bools, Floats, Screw, constant

TOLERANCE = 1e-5
"""Maximum length, divided by the reach, and maximum sine of an angle that are snapped to 0."""


def nominal(chain: Chain) -> Chain:
    """Return a chain with exact parallels, right angles and intersections; lengths are divided by the reach."""
    axes = _aligned(chain.axes)
    points = _joined(axes, chain.points / chain.reach, chain.prismatic)
    tool = chain.T_base_tool.copy()
    tool[:3, 3] /= chain.reach
    return replace(chain, axes=axes, points=points, T_base_tool=tool)


def _aligned(axes: Floats) -> Floats:
    """Make nearly parallel axes parallel, and nearly perpendicular neighbouring axes perpendicular."""
    done = np.eye(3)[:0]
    for axis in axes:
        parallel = [other for other in done if np.linalg.norm(np.cross(axis, other)) < TOLERANCE]
        crossing = [other for other in done if abs(axis @ other) < TOLERANCE]
        if parallel:
            axis = np.copysign(1.0, axis @ parallel[0]) * parallel[0]  # noqa: PLW2901
        else:
            for other in crossing[-1:]:
                axis = axis - (axis @ other) * other  # noqa: PLW2901
            axis = axis / np.linalg.norm(axis)  # noqa: PLW2901
        done = np.vstack([done, axis])
    return done


def _joined(axes: Floats, points: Floats, prismatic: Bools) -> Floats:
    """Return points on the axes, moved so that each revolute axis intersects earlier axes that it nearly intersects."""
    points = points.copy()
    screws: list[Screw] = []
    for index, axis in enumerate(axes):
        screw = Screw(constant(axis), constant(points[index]), bool(prismatic[index]))
        for before in (screws[-2:], screws[-1:]):
            if screw.prismatic or any(other.prismatic for other in before) or not before:
                continue
            centre = common_point(before, TOLERANCE) if len(before) == 2 else _nearest(before[0], screw)
            if centre is not None and _distance(centre, screw) < TOLERANCE:
                points[index] = centre
                screw = Screw(constant(axis), constant(centre))
                break
        screws.append(screw)
    return points


def _nearest(first: Screw, other: Screw) -> Floats | None:
    """Return the point on the axis of ``first`` nearest to the axis of ``other``; None if the axes are parallel."""
    a, b, away = first.axis.ravel(), other.axis.ravel(), (other.point - first.point).ravel()
    square = 1 - (a @ b) ** 2
    if square < TOLERANCE**2:
        return None
    return first.point.ravel() + (away @ a - (a @ b) * (away @ b)) / square * a


def _distance(point: Floats, screw: Screw) -> float:
    return float(np.linalg.norm(np.cross(screw.axis.ravel(), point - screw.point.ravel())))

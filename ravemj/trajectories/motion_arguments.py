"""Motions in all forms that users may pass to viewers, videos, pages and commands."""

import contextlib
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol, TypeAlias

import numpy as np

from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import ArgumentError, SourceError
from ravemj.trajectories import serialization
from ravemj.trajectories.body_motion import BodyMotion
from ravemj.trajectories.joint_trajectory_files import is_joint_trajectory, read_joint_trajectory
from ravemj.trajectories.motion import Motion
from ravemj.trajectories.motion_reading import MOTION_SUFFIXES, MotionTable, problems_in, read_table
from ravemj.trajectories.waypoints import Waypoints

_EXPECTED = (
    "a Motion, a trajectory of OpenRAVE, rows of time and joint values, or the path of a file with either of these"
)


class _SampledTrajectory(Protocol):
    """Protocol of the API's trajectories, which this module must not import."""

    @property
    def waypoints(self) -> Waypoints: ...


MotionLike: TypeAlias = Motion | BodyMotion | _SampledTrajectory | str | os.PathLike[str] | Iterable[Any]
"""The forms of a motion that ``body_motion`` accepts."""


def body_motion(simulation: Simulation, given: MotionLike, body: BodyState | None = None) -> BodyMotion:
    """Return the motion of bodies in any of the accepted forms.

    Args:
        simulation: The world of the bodies.
        given: A ``Motion``; a trajectory, which names its bodies and is copied; rows (time, joint values) or
            (time, value, value, …), [s] and [rad or m]; the pair of times, shape (N,), and joint values,
            shape (N, dof); or the path of a ``.csv`` or ``.npz`` table, of a ``JointTrajectory``, or of OpenRAVE's
            file of a trajectory.
        body: The moving body. By default it is the first robot with joints; for a table whose columns have names, it is
            the first robot that has all these joints.

    Raises:
        ArgumentError: the motion has none of these forms, or does not fit the body.
        SourceError: the file cannot be read, or names other joints.
    """
    if isinstance(given, BodyMotion):
        return given
    if body is not None and not simulation.holds(body):
        raise ArgumentError(f"robot: '{body.scene.name}' is not in this environment")
    if isinstance(given, str | os.PathLike):
        return followed_file(simulation, read_motion_file(simulation, os.fspath(given), body))
    waypoints = getattr(given, "waypoints", None)
    if isinstance(waypoints, Waypoints):
        return _from_waypoints(simulation, Waypoints(waypoints.groups, waypoints.data.copy()), body)
    body = body or first_robot(simulation)
    return BodyMotion.of_motion(body, given if isinstance(given, Motion) else _from_rows(given, body.dof))


def first_robot(simulation: Simulation) -> BodyState:
    """Return the default moving body: the first robot with joints.

    Raises:
        ArgumentError: no robot has joints.
    """
    return _robots(simulation)[0]


def _robots(simulation: Simulation) -> list[BodyState]:
    robots = [body for body in simulation.bodies if body.scene.is_robot and body.dof]
    if not robots:
        names = ", ".join(body.scene.name for body in simulation.bodies)
        raise ArgumentError(f"there is no robot with joints to move; the bodies are: {names or 'none'}")
    return robots


def _from_waypoints(simulation: Simulation, waypoints: Waypoints, body: BodyState | None) -> BodyMotion:
    motion = BodyMotion.of_waypoints(simulation, waypoints)
    if body is not None and body not in motion.bodies:
        names = ", ".join(moved.scene.name for moved in motion.bodies)
        raise ArgumentError(f"the trajectory does not move '{body.scene.name}', but {names}")
    return motion


def _from_rows(given: Any, dof: int) -> Motion:  # noqa: ANN401 - whatever users give
    try:
        rows = list(given)
        with contextlib.suppress(ValueError):  # numpy gives no dimension for rows of different lengths
            if len(rows) == 2 and np.ndim(rows[1]) == 2:
                return Motion(rows[0], rows[1])
        table = np.atleast_2d([np.hstack(row) for row in rows])
    except (TypeError, ValueError):
        table = np.empty((0, 0))
    if not table.size or table.dtype.kind not in "iuf":
        raise ArgumentError(f"motion: found {_described(given)}, expected {_EXPECTED}")
    if table.shape[1] == dof:
        raise ArgumentError(f"motion: found rows of {dof} numbers, expected the time and then {dof} joint values")
    return Motion(table[:, 0], table[:, 1:])


def _described(given: object) -> str:
    if given is None or isinstance(given, int | float):
        return str(given)
    kind = type(given)
    return f"a {f'{kind.__module__}.{kind.__qualname__}'.removeprefix('builtins.')}"


class MotionFile(NamedTuple):
    """Motion read from a file.

    Attributes:
        file: The path.
        motion: A ``Motion`` of all DOFs of the body, or a trajectory, which names its bodies.
        body: The moving body; None if a trajectory names it.
        dofs: The DOF indices of a ``Motion``.
    """

    file: str
    motion: Motion | Waypoints
    body: BodyState | None
    dofs: list[int]


def read_motion_file(
    simulation: Simulation, file: str, body: BodyState | None, names: Mapping[str, str] | None = None
) -> MotionFile:
    """Read the motion of a file in any form.

    Args:
        simulation: The world of the bodies.
        file: The path.
        body: The moving body; None as for ``body_motion``.
        names: Joint names of the body by names in a ``JointTrajectory``, if they differ.

    Raises:
        ArgumentError: there is no robot.
        SourceError: the file cannot be read, or names other joints.
    """
    with problems_in(file):
        if is_joint_trajectory(file):
            points = read_joint_trajectory(file).renamed(names or {})
            body = body or _named_robot(simulation, points.joint_names)
            return MotionFile(file, points.waypoints(body.scene.name, body.scene.dof_names), body, [])
        if Path(file).suffix.lower() not in MOTION_SUFFIXES:
            return MotionFile(file, serialization.read(Path(file).read_bytes()).waypoints, body, [])
    table = read_table(file)
    columns = list((table.names or {}).values())
    body = body or _named_robot(simulation, columns)
    _refuse_other_robots(simulation, table, body)
    motion = table.for_joints(body.scene.dof_names, body.kinematics.values())
    columns = [body.scene.dof_names.index(name) for name in columns]
    return MotionFile(file, motion, body, columns or list(range(body.dof)))


def followed_file(simulation: Simulation, read: MotionFile) -> BodyMotion:
    """Return the motion of bodies from a motion file.

    Raises:
        SourceError: the motion does not fit the bodies.
    """
    with problems_in(read.file):
        if isinstance(read.motion, Motion):
            return BodyMotion.of_motion(read.body or first_robot(simulation), read.motion)
        return _from_waypoints(simulation, read.motion, read.body)


def _named_robot(simulation: Simulation, names: Sequence[str]) -> BodyState:
    """Return the robot with the most joints in ``names``; the first one if there are several."""
    return max(_robots(simulation), key=lambda robot: len(set(names).intersection(robot.scene.dof_names)))


def _refuse_other_robots(simulation: Simulation, table: MotionTable, body: BodyState) -> None:
    for number, name in (table.names or {}).items():
        owners = [other for other in simulation.bodies if name in other.scene.dof_names]
        if owners and body not in owners:
            mistake = f"column {number} is named '{name}', which is a joint of '{owners[0].scene.name}'"
            raise SourceError(f"{mistake}, not of '{body.scene.name}'", table.source, "a table moves one robot")

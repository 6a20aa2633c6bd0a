"""Joint trajectories in ROS's form: ``trajectory_msgs/JointTrajectory``."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.trajectories.conversion import nobody
from ravemj.trajectories.groups import DELTATIME, INTERPOLATIONS, JOINTS, Group
from ravemj.trajectories.motion import finite_array
from ravemj.trajectories.motion_reading import did_you_mean
from ravemj.trajectories.waypoints import Waypoints

ANGLE_OR_LENGTH = "rad or m"
"""Unit of a joint of unknown type, as in ROS's messages."""

_INTERPOLATIONS = ("linear", "cubic", "quintic")
"""Interpolations of ROS controllers between points with no, one and two derivatives."""


@dataclass(frozen=True, eq=False, init=False, slots=True)
class JointTrajectory:
    """Waypoints of a motion for a robot controller, as ``robot.to_joint_trajectory`` returns them.

    Between the points, controllers of ROS follow quintic polynomials if there are velocities and accelerations, cubic
    ones if there are velocities only, else straight lines. ``robot.from_joint_trajectory`` does the same.

    Args:
        joint_names: (n,) different names.
        times: (N,) seconds from the start of the motion, N >= 1, not negative, strictly increasing.
        positions: (N, n) joint values [rad or m].
        velocities: (N, n) velocities [rad/s or m/s], or None.
        accelerations: (N, n) accelerations [rad/s^2 or m/s^2], or None; they need velocities.
        units: (n,) units of the positions, ``rad`` or ``m`` each; by default unknown.

    Raises:
        ArgumentError: A shape does not fit, something is not a finite number, names repeat, or times do not increase.

    Example:
        >>> points = ravemj.JointTrajectory(["shoulder", "elbow"], [0, 2], [[0, 0], [0.5, -0.3]])
    """

    joint_names: tuple[str, ...]
    times: Floats
    positions: Floats
    velocities: Floats | None
    accelerations: Floats | None
    units: tuple[str, ...]

    def __init__(
        self,
        joint_names: Sequence[str],
        times: ArrayLike,
        positions: ArrayLike,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        units: Sequence[str] = (),
    ) -> None:
        names = tuple(joint_names)
        seconds = finite_array(times, "times", "(N,)", 1)
        shape = len(seconds), len(names)
        if len(set(names)) < len(names):
            raise ArgumentError(f"joint_names: '{max(names, key=names.count)}' is there twice")
        late = np.flatnonzero(np.diff(seconds, prepend=-1.0) <= 0)
        if not len(seconds) or seconds[0] < 0 or late.size:
            first_wrong = "none" if not len(seconds) else f"{seconds[late[0] if late.size else 0]:g} s"
            place = f" at point {late[0]}" if late.size else ""
            raise ArgumentError(
                f"times: found {first_wrong}{place}, expected times that start at 0 or later and increase"
            )
        if accelerations is not None and velocities is None:
            raise ArgumentError("accelerations: need velocities, and there are none")
        object.__setattr__(self, "joint_names", names)
        object.__setattr__(self, "times", seconds)
        rows = {"positions": positions, "velocities": velocities, "accelerations": accelerations}
        for name, numbers in rows.items():
            array = None if numbers is None else finite_array(numbers, name, "(N, n)", 2)
            if array is not None and array.shape != shape:
                raise ArgumentError(f"{name}: found shape {array.shape}, expected {shape}: points and joints")
            object.__setattr__(self, name, array)
        object.__setattr__(self, "units", tuple(units) or (ANGLE_OR_LENGTH,) * len(names))

    @property
    def duration(self) -> float:
        """Time of the last point [s]."""
        return float(self.times[-1])

    def renamed(self, names: Mapping[str, str]) -> "JointTrajectory":
        """Return the same motion with renamed joints: ``names`` maps old names to new ones.

        Raises:
            ArgumentError: Two joints would have the same name.
        """
        return replace(self, joint_names=[names.get(name, name) for name in self.joint_names])  # pyright: ignore

    def waypoints(self, body_name: str, dof_names: Sequence[str]) -> Waypoints:
        """Return the motion as waypoints with the interpolation of ROS controllers.

        Args:
            body_name: Name of the moving body.
            dof_names: Names of its DOFs.

        Raises:
            ArgumentError: The body does not have one of the joints.
        """
        for name in self.joint_names:
            if name not in dof_names:
                raise ArgumentError(f"'{name}' is not a joint of '{body_name}'; {did_you_mean(name, dof_names)}")
        orders = [rows for rows in (self.positions, self.velocities, self.accelerations) if rows is not None]
        count, highest = len(self.joint_names), INTERPOLATIONS.index(_INTERPOLATIONS[len(orders) - 1])
        joints = " ".join([body_name, *(str(list(dof_names).index(name)) for name in self.joint_names)])
        groups = [
            Group(f"{JOINTS[order]} {joints}", order * count, count, INTERPOLATIONS[highest - order])
            for order in range(len(orders))
        ]
        groups.append(Group(DELTATIME, len(orders) * count, 1, ""))
        made = Waypoints(groups)
        rows = np.column_stack([*orders, np.diff(self.times, prepend=0.0)])
        made.insert(0, rows.ravel(), groups, overwrite=False, find_body=nobody)
        return made

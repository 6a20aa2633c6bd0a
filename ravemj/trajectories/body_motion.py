"""Bodies that follow a motion or a trajectory, as viewers play them, with grabs and releases."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import ArgumentError
from ravemj.trajectories import extraction
from ravemj.trajectories.groups import AFFINE, JOINTS, Group
from ravemj.trajectories.motion import Motion, number_of_frames, positive
from ravemj.trajectories.waypoints import Waypoints


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """Motion of bodies over time.

    Attributes:
        bodies: The moving bodies.
        duration: The end time [s]; the motion starts at 0.
        place: Sets the configurations of the bodies at a time [s], clamped to joint limits.
        rows: Joint values of each body at the rows of the motion or the waypoints of the trajectory, shape (N, dof).
    """

    bodies: tuple[BodyState, ...]
    duration: float
    place: Callable[[float], None]
    rows: tuple[Floats, ...]

    @classmethod
    def of_motion(cls, body: BodyState, motion: Motion) -> "BodyMotion":
        """Drive a body along the joint values of a motion, clamped to the body's limits.

        Raises:
            ArgumentError: the number of joints differs from the body's.
        """
        name, dof = body.scene.name, body.kinematics.dof
        if motion.dof != dof:
            raise ArgumentError(f"the motion has {motion.dof} joints, and '{name}' has {dof} DOFs")
        start, end, duration = float(motion.times[0]), float(motion.times[-1]), motion.duration

        def place(time: float) -> None:
            set_within_limits(body, motion.sample(start + time if time < duration else end))

        return cls((body,), duration, place, (motion.values,))

    @classmethod
    def of_waypoints(cls, simulation: Simulation, waypoints: Waypoints) -> "BodyMotion":
        """Drive all bodies of a trajectory along it; the trajectory is not copied.

        Raises:
            ArgumentError: it has no waypoints or times, names no existing body, or names joints that a body does not
                have.
        """
        waypoints.sample(0.0, restamped=True)
        groups = [group for group in waypoints.groups if group.kind in {JOINTS[0], AFFINE[0]}]
        named = [simulation.body(name) for name in extraction.used_bodies(groups)]
        bodies = tuple(body for body in named if body is not None)
        if not bodies:
            raise ArgumentError("the trajectory moves no body of this environment")
        dofs = {body: extraction.used_indices(groups, body.scene.name)[0] for body in bodies}
        for body in bodies:
            if any(not 0 <= dof < body.kinematics.dof for dof in dofs[body]):
                raise ArgumentError(f"the trajectory names joints that '{body.scene.name}' does not have")

        def place(time: float) -> None:
            numbers = waypoints.sample(time, restamped=True)
            for body in bodies:
                _place(body, dofs[body], groups, numbers)

        rows = tuple(_rows(body, dofs[body], groups, waypoints) for body in bodies)
        return cls(bodies, waypoints.duration(), place, rows)

    def frame_times(self, fps: float) -> Iterator[float]:
        """Yield the time [s] of each frame of a video; the last frame is the end."""
        last = number_of_frames(self.duration, fps) - 1
        return (self.duration if frame == last else frame / fps for frame in range(last + 1))

    def rescaled(self, duration: float) -> "BodyMotion":
        """Return the same motion with another duration [s].

        Raises:
            ArgumentError: the motion has only one row, or the duration is not positive.
        """
        if not self.duration:
            raise ArgumentError("a motion of one row has no duration that could be rescaled")
        rate = self.duration / positive(duration, "duration")

        def place(time: float) -> None:
            self.place(time * rate)

        return replace(self, duration=duration, place=place)


def _rows(body: BodyState, dofs: list[int], groups: list[Group], waypoints: Waypoints) -> Floats:
    """Return the joint values of a body at the waypoints; joints not in the trajectory keep their present values."""
    rows = np.tile(body.kinematics.values(), (len(waypoints), 1))
    for row, numbers in zip(rows, waypoints.data, strict=True):
        values = extraction.joint_values(groups, numbers, body.scene.name, dofs, 0)
        if values is not None:
            row[dofs] = values
    return rows


def _place(body: BodyState, dofs: list[int], groups: list[Group], numbers: Floats) -> None:
    name = body.scene.name
    values = extraction.joint_values(groups, numbers, name, dofs, 0)
    if values is not None:
        configuration = body.kinematics.values()
        configuration[dofs] = values
        set_within_limits(body, configuration)
    pose = extraction.pose(groups, numbers, name, body.pose())
    if pose is not None:
        body.set_pose(pose)


def set_within_limits(body: BodyState, values: Floats) -> None:
    """Set the joint values of a body, shape (dof,), clamped to the limits of joints that are not circular."""
    kinematics = body.kinematics
    if len(values) != kinematics.dof:
        raise ArgumentError(f"'{body.scene.name}' has {kinematics.dof} DOFs, and no more {len(values)}")
    body.set_values(kinematics.limits.clamp(values))


class GrabChange(NamedTuple):
    """Grab or release of a body.

    Attributes:
        time: Time since the start of the trajectory [s].
        link: Index of the grabbing link.
        body: ``GetEnvironmentBodyIndex()`` of the body; negative for a release.
    """

    time: float
    link: int
    body: int


def grab_changes(waypoints: Waypoints, robot_name: str) -> list[GrabChange]:
    """Return the grabs and releases in a trajectory, in the order of time.

    A group ``grab ROBOT LINK …`` has a value for each link index: the index of a body to grab with this link, the
    negative index of a body to release, or 0 for no change.
    """
    times = waypoints.times()
    changes: list[GrabChange] = []
    for group in waypoints.groups:
        if group.kind != "grab" or group.body != robot_name:
            continue
        links = [int(word) for word in group.name.split()[2:] if word.isdecimal()]
        bodies = waypoints.data[:, group.columns][:, : len(links)].round().astype(int)
        changes += [
            GrabChange(float(times[row]), links[column], int(bodies[row, column]))
            for row, column in zip(*np.nonzero(bodies), strict=True)
        ]
    return sorted(changes, key=lambda change: change.time)

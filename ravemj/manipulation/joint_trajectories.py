"""Motions as waypoints for a robot controller, with all checks before they are sent."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.model.limits import Limits
from ravemj.model.scene import Axis
from ravemj.planning.retiming import segments
from ravemj.planning.retiming.polynomials import Cubic
from ravemj.planning.retiming.segments import RetimingError
from ravemj.planning.retiming.spline import Spline
from ravemj.planning.space import Coordinates
from ravemj.planning.verification import EXACT
from ravemj.trajectories.conversion import FindBody, nobody
from ravemj.trajectories.groups import AFFINE, JOINTS, Group, joint_indices
from ravemj.trajectories.interpolation import differentiated, value
from ravemj.trajectories.joint_trajectory import JointTrajectory
from ravemj.trajectories.motion import Motion
from ravemj.trajectories.waypoints import Waypoints

LARGEST_LEAP = 0.01
"""Maximum distance of a motion's first point from the measured state [rad or m]."""

_ROUNDING = 1e-4
"""Relative rounding tolerance of velocity and acceleration limits."""

_REST = 1e-3
"""Speed that counts as rest [rad/s or m/s]."""

_SHORT = 1e-6
"""Duration [s] below which derivatives of a segment are meaningless."""

_DEVIATION = 0.01
"""Maximum deviation of a retimed motion from the straight lines between its waypoints [rad or m]."""

_WITH_ACCELERATIONS = ("quartic", "quintic", "sextic")
"""Interpolations that also depend on accelerations at the waypoints."""

_RATES = ("velocity", "acceleration", "jerk")


@dataclass(frozen=True)
class Joints:
    """Moving joints of a body.

    Attributes:
        body: The body.
        dofs: The DOF indices of the joints.
    """

    body: BodyState
    dofs: Sequence[int]

    @property
    def axes(self) -> list[Axis]:
        """The axes of the joints."""
        return [self.body.scene.dof_axes[dof] for dof in self.dofs]

    @property
    def names(self) -> list[str]:
        """The names of the joints."""
        return [self.body.scene.dof_names[dof] for dof in self.dofs]

    @property
    def units(self) -> list[str]:
        """The units of the joint values."""
        joints = [(joint, axis) for joint in self.body.scene.joints for axis in range(len(joint.axes))]
        return ["m" if joints[dof][0].slides(joints[dof][1]) else "rad" for dof in self.dofs]

    @property
    def turn(self) -> Floats:
        """A full turn of each joint without limits, else 0 [rad], shape (n,)."""
        return np.array([2 * np.pi if axis.circular else 0.0 for axis in self.axes])

    def limits(self) -> segments.PathLimits:
        """Return the limits of the joints."""
        bounds, axes = Limits(self.axes), self.axes
        rates = [np.array([getattr(axis, f"max_{name}") for axis in axes]) for name in _RATES]
        coordinates = Coordinates(np.zeros(len(axes), dtype=bool))  # linear interpolation takes the longer arc
        return segments.PathLimits(coordinates, bounds.lower, bounds.upper, *rates)


def checked_points(
    active: Joints, motion: Motion | Waypoints, rate: float | None, state: Floats | None, *, moving: bool
) -> JointTrajectory:
    """Return the points of a motion, after all checks.

    Args:
        active: The joints to select from a ``Motion``, which has all DOFs of the body; a trajectory defines its own.
        motion: The motion. Linear motions are retimed from rest to rest; if ``moving``, their waypoints are the points,
            without velocities.
        rate: Points per second; None means at the waypoints.
        state: Measured values of all DOFs at the start, shape (dof,), or None.
        moving: Whether the motion may start and end with nonzero velocity.

    Raises:
        ArgumentError: A check fails; or the number of joints is wrong, the motion moves a base, another body or no
            joint of the body, has no times, or cannot be retimed.
    """
    joints, body = active, active.body
    if isinstance(motion, Motion):
        if motion.dof != body.dof:
            raise ArgumentError(f"the motion has {motion.dof} joints, and '{body.scene.name}' has {body.dof} DOFs")
        times, rows = motion.times - motion.times[0], motion.values[:, list(active.dofs)]
        points = _points_of_rows(joints, times, rows, rate, moving)
    else:
        joints, group = joints_of(body, motion)
        if group.interpolation == "linear":
            points = _points_of_rows(joints, motion.times(), motion.data[:, group.columns], rate, moving)
        else:
            points = sampled(joints, motion, group, rate, body.simulation.body)
    if state is not None:
        points = from_state(joints, points, state)
    check(joints, points, moving=moving)
    return points


def _points_of_rows(joints: Joints, times: Floats, rows: Floats, rate: float | None, moving: bool) -> JointTrajectory:
    _check_values(joints, times, rows)
    if moving:
        return JointTrajectory(joints.names, times, rows, None, None, joints.units)
    smooth = retimed(joints, rows)
    if rate is None:
        return smooth
    waypoints = smooth.waypoints(joints.body.scene.name, joints.body.scene.dof_names)
    return sampled(joints, waypoints, joints_of(joints.body, waypoints)[1], rate, nobody)


def joints_of(body: BodyState, waypoints: Waypoints) -> tuple[Joints, Group]:
    """Return the joints that a trajectory moves, and the group of their values.

    Raises:
        ArgumentError: It moves a base, another body, or no joint of the body, or grabs bodies.
    """
    name, own = body.scene.name, None
    for group in waypoints.groups:
        if group.kind == "grab" and waypoints.data[:, group.columns].any():
            raise ArgumentError("the trajectory grabs or releases bodies, which a JointTrajectory cannot say")
        moves = group.kind in {JOINTS[0], AFFINE[0]} and np.ptp(waypoints.data[:, group.columns], axis=0).any()
        if group.kind == JOINTS[0] and group.body == name:
            own = group
        elif moves:
            what = f"the base of '{name}'" if group.body == name else f"'{group.body}', too"
            raise ArgumentError(f"the trajectory moves {what}; a JointTrajectory moves joints of one robot")
    if own is None or not own.dof:
        raise ArgumentError(f"the trajectory moves no joint of '{name}'")
    return Joints(body, joint_indices(own)), own


def retimed(joints: Joints, rows: Floats) -> JointTrajectory:
    """Return a fast motion through waypoints within the limits, from rest to rest.

    The motion stops at waypoints only if it would otherwise deviate more than 0.01 rad or m from the straight lines
    between them.

    Args:
        joints: The joints.
        rows: The waypoints, shape (N, n) [rad or m].

    Raises:
        ArgumentError: No joint moves, or a moving joint has a limit of 0.
    """
    limits, steps = joints.limits(), np.abs(np.diff(rows, axis=0)).max(axis=1)
    rows = rows[np.append(True, steps > 0)]
    if len(rows) < 2:
        raise ArgumentError("the motion has no two different rows")
    try:
        timed = _without_stops(rows, limits) or segments.retime(Cubic(), rows, limits)
    except RetimingError as error:
        raise ArgumentError(f"the motion cannot be retimed within the limits: {error}") from None
    values, velocities = timed.orders[:2]
    return JointTrajectory(joints.names, np.cumsum(timed.deltas), values, velocities, None, joints.units)


def _without_stops(rows: Floats, limits: segments.PathLimits) -> segments.Timed | None:
    """Return a smooth motion through waypoints; None if it fails or deviates too far from straight lines."""
    try:
        timed = Spline().timed(rows, limits)
    except RetimingError:  # two rows, or a corner beyond a limit
        return None
    values, velocities = timed.orders[:2]
    steps, durations = np.diff(values, axis=0), timed.deltas[1:, None]
    squares = np.maximum((steps * steps).sum(axis=1, keepdims=True), 1e-300)
    for s in (0.25, 0.5, 0.75):  # of the way: the cubic polynomial, and the nearest point of the straight line
        moved = steps * (s * s * (3 - 2 * s))
        moved += (velocities[:-1] * (1 - s) - velocities[1:] * s) * (s * (1 - s)) * durations
        nearest = steps * np.clip((moved * steps).sum(axis=1, keepdims=True) / squares, 0.0, 1.0)
        if np.abs(moved - nearest).max(initial=0.0) > _DEVIATION:
            return None
    return timed


def sampled(
    joints: Joints, waypoints: Waypoints, group: Group, rate: float | None, find_body: FindBody
) -> JointTrajectory:
    """Return the points of a trajectory, with the derivatives of its interpolating polynomials.

    Args:
        joints: The moving joints.
        waypoints: The trajectory.
        group: The group of the joint values.
        rate: Points per second, and one at the end; None means one at each waypoint, with the derivatives needed for
            the interpolation.
        find_body: Finds the bodies whose circular joints take the shorter arc.

    Raises:
        ArgumentError: It has no times, no interpolation, or less than two waypoints.
    """
    pieces = _continuous(joints, waypoints, group, find_body)
    starts, last = np.array([start for start, _, _ in pieces]), pieces[-1][1]
    inner = starts if rate is None else np.arange(pieces[0][0], last - 0.5 / rate, 1 / rate)
    times = np.append(inner, last)
    indices: list[int] = (np.searchsorted(starts, times, side="right") - 1).tolist()
    orders: list[list[Floats]] = [[], [], []]
    for time, index in zip(times.tolist(), indices, strict=True):
        start, end, way = pieces[index]
        for values in orders:
            values.append(value(way, (time - start) / (end - start)))
            way = differentiated(way, end - start) if len(way) > 1 else np.zeros_like(way)
    positions, velocities, accelerations = (np.array(values) for values in orders)
    determined = rate is not None or group.interpolation in _WITH_ACCELERATIONS
    return JointTrajectory(
        joints.names, times, positions, velocities, accelerations if determined else None, joints.units
    )


def _continuous(
    joints: Joints, waypoints: Waypoints, group: Group, find_body: FindBody
) -> list[tuple[float, float, Floats]]:
    """Return start time, end time and polynomial of each segment; jumps by full turns between them are removed."""
    pieces = [piece for piece in waypoints.pieces([group], find_body) if piece[1] - piece[0] > _SHORT]
    if not pieces:
        raise ArgumentError("the trajectory has no two waypoints at different times")
    reached = pieces[0][2][0]
    for _, _, way in pieces:
        way[0] += joints.turn * np.rint((reached - way[0]) / (2 * np.pi))
        reached = value(way, 1.0)
    return pieces


def check(joints: Joints, points: JointTrajectory, *, moving: bool) -> None:
    """Check points against the limits of the joints, and that they are at rest at both ends unless ``moving``.

    Points without velocities are checked by the differences of their positions.

    Raises:
        ArgumentError: A check fails; the text names joint, time, value and limit.
    """
    _check_values(joints, points.times, points.positions)
    axes = joints.axes
    velocities, accelerations = points.velocities, points.accelerations
    if velocities is None:
        velocities = np.diff(points.positions, axis=0, prepend=points.positions[:1])
        velocities[1:] /= np.diff(points.times)[:, None]
    elif not moving:
        for end, row in (("start", 0), ("end", -1)):
            joint = int(np.abs(velocities[row]).argmax())
            if abs(velocities[row, joint]) > _REST:
                excess = f"moves at {velocities[row, joint]:.4g} {joints.units[joint]}/s at {points.times[row]:.4g} s"
                hint = f"the {end}, where it should be at rest; moving=True or --moving allows it"
                raise ArgumentError(f"joint '{joints.names[joint]}' {excess}, {hint}")
    _check_rates(joints, points.times, velocities, [axis.max_velocity for axis in axes], "/s")
    if accelerations is not None:
        _check_rates(joints, points.times, accelerations, [axis.max_acceleration for axis in axes], "/s^2")


class Excess(NamedTuple):
    """Largest violation of joint limits: the index of the row of values, and a description."""

    row: int
    text: str


def largest_excess(joints: Joints, values: Floats) -> Excess | None:
    """Return the largest violation of limits by joint values, shape (N, n); None if there is none."""
    limits = joints.limits()
    excess = np.maximum(values - limits.upper, limits.lower - values)
    row, joint = divmod(int(excess.argmax()), excess.shape[1])
    if not excess[row, joint] > EXACT * max(1.0, abs(values[row, joint])):
        return None
    unit, bounds = joints.units[joint], f"[{limits.lower[joint]:.6g}, {limits.upper[joint]:.6g}]"
    deviation = f"is at {values[row, joint]:.6g} {unit}, {excess[row, joint]:.3g} {unit} outside of its limits {bounds}"
    return Excess(row, f"joint '{joints.names[joint]}' {deviation}")


def _check_values(joints: Joints, times: Floats, values: Floats) -> None:
    beyond = largest_excess(joints, values)
    if beyond is not None:
        raise ArgumentError(f"{beyond.text}, at {times[beyond.row]:.4g} s")


def _check_rates(joints: Joints, times: Floats, rates: Floats, limits: Sequence[float], per_time: str) -> None:
    excess = np.abs(rates) - np.array(limits) * (1 + _ROUNDING)
    row, joint = divmod(int(excess.argmax()), excess.shape[1])
    if excess[row, joint] > 0:
        word = "a velocity" if per_time == "/s" else "an acceleration"
        unit = joints.units[joint] + per_time
        largest = f"{word} of {rates[row, joint]:.4g} {unit} at {times[row]:.4g} s"
        raise ArgumentError(f"joint '{joints.names[joint]}' has {largest}, and its limit is {limits[joint]:.4g} {unit}")


def from_state(joints: Joints, points: JointTrajectory, measured: Floats) -> JointTrajectory:
    """Shift continuous joints by full turns so that the motion starts at a measured state; return the points.

    Args:
        joints: The joints.
        points: The motion.
        measured: Values of all DOFs of the body [rad or m], shape (dof,).

    Raises:
        ArgumentError: The first point is farther than 0.01 rad or m from the state; the text names joint and values.
    """
    here = measured[list(joints.dofs)]
    turns = np.rint((here - points.positions[0]) / (2 * np.pi))
    shifted = points.positions + joints.turn * turns
    leap = np.abs(shifted[0] - here)
    joint = int(leap.argmax())
    if not leap[joint] <= LARGEST_LEAP:
        unit = joints.units[joint]
        deviation = f"starts at {shifted[0, joint]:.6g} {unit}, and the robot is at {here[joint]:.6g} {unit}"
        allowed = f"at most {LARGEST_LEAP} {unit} are allowed"
        raise ArgumentError(f"joint '{joints.names[joint]}' {deviation}, {leap[joint]:.3g} {unit} apart; {allowed}")
    return replace(points, positions=shifted)


def assumed_accelerations(joints: Joints) -> str:
    """Return a note on joints whose acceleration limits are defaults, not the model's; empty if there are none."""
    assumed = Axis((1.0, 0.0, 0.0)).max_acceleration
    names = [
        f"{name} ({unit}/s^2)"
        for name, unit, axis in zip(joints.names, joints.units, joints.axes, strict=True)
        if axis.max_acceleration == assumed
    ]
    return f"acceleration limits: {assumed:g}, assumed where a model gives none, of {', '.join(names)}" if names else ""

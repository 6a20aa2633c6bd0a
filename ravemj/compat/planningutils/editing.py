"""Operations on trajectories: conversion, reversal, segments, derivatives, merging."""

import math
import operator
from collections.abc import Sequence
from functools import reduce

import numpy as np

from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.groups import DELTATIME
from ravemj.trajectories.interpolation import HELD


def ConvertTrajectorySpecification(trajectory: Trajectory, spec: ConfigurationSpecification) -> None:
    """Change the layout of a trajectory in place; the bodies' present state supplies missing values.

    Args:
        trajectory: The trajectory.
        spec: The new layout.
    """
    rows = trajectory.GetAllWaypoints2D(spec)
    trajectory.Init(spec)
    trajectory.Insert(0, rows.ravel())


@also_named(trajectory="traj")
def ReverseTrajectory(traj: Trajectory) -> Trajectory:
    """Return the reversed trajectory.

    The times between waypoints are kept, and velocities change their sign. Velocities with the interpolation ``next``
    hold in the segment before their waypoint, and move to the waypoint at its other end. All other values stay at their
    waypoints, as in OpenRAVE.

    Example:
        >>> back = planningutils.ReverseTrajectory(traj)
    """
    spec = traj.GetConfigurationSpecification()
    rows = traj.GetAllWaypoints2D()[::-1]
    for group in spec.GetGroups():
        is_velocity = "_velocities" in group.name
        if group.kind == DELTATIME or (is_velocity and group.interpolation == "next"):
            # it belongs to the segment that ends at its waypoint
            rows[:, group.columns] = np.roll(rows[:, group.columns], 1, axis=0)
            rows[:1, group.columns] = 0
        if is_velocity:
            rows[:, group.columns] *= -1
    back = _made(traj, spec, rows)
    back.SetDescription(traj.GetDescription())
    return back


def MergeTrajectories(trajectories: Sequence[Trajectory]) -> Trajectory | None:
    """Merge trajectories into one that runs them simultaneously, with all their waypoints. Return it.

    Args:
        trajectories: Trajectories with times; each stays at its last waypoint after its end.

    Returns:
        A new trajectory; None if there are none.
    """
    if not trajectories:
        return None
    spec = reduce(operator.add, (traj.GetConfigurationSpecification() for traj in trajectories))
    times = np.unique(np.concatenate([np.cumsum(_deltas(traj)) for traj in trajectories]))
    rows = np.zeros((len(times), spec.GetDOF()))
    for traj in trajectories:
        samples = np.array([traj.Sample(time) for time in times.tolist()])
        own = traj.GetConfigurationSpecification()
        rows = own.ConvertDataFromPrevious(rows.ravel(), spec, samples.ravel(), len(times), None).reshape(rows.shape)
    rows[:, spec.GetGroupFromName(DELTATIME).offset] = np.diff(times, prepend=0)
    return _made(trajectories[0], spec, rows)


def _deltas(traj: Trajectory) -> Floats:
    column = traj.GetConfigurationSpecification().GetGroupFromName(DELTATIME).columns
    return traj.GetAllWaypoints2D()[:, column].ravel()


def _made(like: Trajectory, spec: ConfigurationSpecification, rows: Floats) -> Trajectory:
    made = Trajectory(like.GetEnv(), like.GetXMLId())
    made.Init(spec)
    made.Insert(0, rows.ravel())
    return made


def GetTrajectorySegment(trajectory: Trajectory, starttime: float, endtime: float) -> Trajectory:
    """Return a segment of a trajectory as a new one; its time starts at 0.

    Args:
        trajectory: A trajectory with times.
        starttime: Start of the segment [s], clipped to the trajectory.
        endtime: End of the segment [s]; the duration is 0 if it is before the start.

    Raises:
        ArgumentError: the segment starts at the end of the trajectory.

    Example:
        >>> part = planningutils.GetTrajectorySegment(trajectory, 0.02, 0.05)
    """
    checked_kind(trajectory, Trajectory, "GetTrajectorySegment: trajectory")
    duration = trajectory.GetDuration()
    start, end = max(0.0, float(starttime)), min(duration, float(endtime))
    if not start < duration or math.isnan(end):
        raise ArgumentError(
            f"starttime: is {starttime}, and should be before the end of the trajectory, {duration:g} s"
        )
    times = np.cumsum(_deltas(trajectory))
    inner = times[(times > start) & (times < end)].tolist()
    chosen = [start] if end == start else [start, *inner, end if end > start else start]
    spec = trajectory.GetConfigurationSpecification()
    rows = np.array([trajectory.Sample(time) for time in chosen])
    rows[:, spec.GetGroupFromName(DELTATIME).offset] = np.diff(chosen, prepend=chosen[0])
    return _made(trajectory, spec, rows)


def SegmentTrajectory(trajectory: Trajectory, starttime: float, endtime: float) -> None:
    """Reduce a trajectory to a segment in place; see ``GetTrajectorySegment``.

    Args:
        trajectory: Changed in place.
        starttime: Start of the segment [s].
        endtime: End of the segment [s].
    """
    trajectory.Swap(GetTrajectorySegment(trajectory, starttime, endtime))


def ComputeTrajectoryDerivatives(trajectory: Trajectory, maxderiv: int) -> None:
    """Add missing time derivatives to a trajectory.

    Args:
        trajectory: Changed in place; it has times.
        maxderiv: Highest order: 1 for velocities, 2 for accelerations and so on.

    Example:
        >>> planningutils.ComputeTrajectoryDerivatives(trajectory, 2)
    """
    checked_kind(trajectory, Trajectory, "ComputeTrajectoryDerivatives: trajectory")
    spec, elapsed = trajectory.GetConfigurationSpecification(), _deltas(trajectory)
    old = trajectory.GetConfigurationSpecification()
    for order in range(1, maxderiv + 1):
        spec.AddDerivativeGroups(order)
    rows = trajectory.GetAllWaypoints2D(spec)
    for order in range(maxderiv):
        for group in spec.GetTimeDerivativeSpecification(order).GetGroups():
            derivative = spec.FindTimeDerivativeGroup(group, True)
            if derivative is not None and old.FindCompatibleGroup(derivative, True) is None:
                lower = spec.GetGroupFromName(group.name)
                integral = spec.FindTimeIntegralGroup(lower, True)
                below = None if integral is None else rows[:, integral.columns]
                rates = _rates(rows[:, lower.columns], lower.interpolation, below, elapsed)
                rows[:, derivative.columns] = rates
    trajectory.Init(spec)
    trajectory.Insert(0, rows.ravel())


def _rates(values: Floats, interpolation: str, integral: Floats | None, elapsed: Floats) -> Floats:
    """Return the time derivatives of values at the waypoints, each at the end of the segment before it, shape (m, n).

    Args:
        values: Values at the waypoints, shape (m, n).
        interpolation: Interpolation of the values.
        integral: Integrals of the values at the waypoints, used for quadratic interpolation, or None.
        elapsed: Times since the previous waypoint [s], shape (m,).
    """
    rates = np.zeros_like(values)
    passed = np.flatnonzero(elapsed[1:] > 0) + 1
    time = elapsed[passed][:, None]
    if interpolation in HELD:
        return rates
    if interpolation == "quadratic" and integral is not None:
        step = integral[passed] - integral[passed - 1]
        rates[passed] = (4 * values[passed] + 2 * values[passed - 1]) / time - 6 * step / time**2
        if len(passed) and passed[0] == 1:
            rates[0] = 6 * step[0] / time[0] ** 2 - (4 * values[0] + 2 * values[1]) / time[0]
        return rates
    rates[passed] = (values[passed] - values[passed - 1]) / time
    return rates

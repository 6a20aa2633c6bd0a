"""Completes and limits the joint values and velocities that users give."""

from types import EllipsisType

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_first, checked_indices, checked_numbers, checked_vector
from ravemj.core.transforms import Floats
from ravemj.engine.kinematics import BodyKinematics
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, Diagnostic, send_warning
from ravemj.model.scene import KinBody
from ravemj.rave.enums import CheckLimitsAction

_VALUE_ROUNDING = 2e-10
"""Amount by which values may exceed joint limits without a warning when clamped [rad or m]; OpenRAVE's."""

_VELOCITY_ROUNDING = 1e-10
"""Tolerance of velocity limits [rad/s or m/s]."""


def full_values(
    body: KinBody, kinematics: BodyKinematics, values: ArrayLike, dofindices: "ArrayLike | EllipsisType | None"
) -> Floats:
    """Return a value for each DOF, in DOF order.

    Args:
        body: The body, for error messages.
        kinematics: The kinematics of the body, which has the values of the other DOFs.
        values: The values that the user gave.
        dofindices: The DOF indices of these values; None for all.

    Raises:
        ArgumentError: the number of values is wrong.
    """
    given, dof = checked_numbers(values, "SetDOFValues"), kinematics.dof
    if dofindices is None or dofindices is ...:
        if given.shape == (dof,):
            return given
        if dofindices is None and given.ndim == 1 and len(given) > dof:
            return given[:dof]  # random-api-238
        if dof:
            raise ArgumentError(
                f"SetDOFValues: values has shape {given.shape}, and '{body.name}' has {dof} DOFs: give {dof} "
                f"numbers, or dofindices"
            )
        return np.zeros(0)
    indices = checked_indices(dofindices, dof, "dofindices")
    if given.ndim != 1 or len(given) < len(indices):
        raise ArgumentError(f"SetDOFValues: values has shape {given.shape} for {len(indices)} dofindices")
    full = kinematics.values()
    full[indices] = given[: len(indices)]
    return full


def full_velocities(state: BodyState, velocities: ArrayLike, indices: "ArrayLike | None") -> Floats:
    """Return a velocity for each DOF, with OpenRAVE's error in the handling of indices.

    With k indices, each of the first k DOFs gets its given velocity, or keeps its own if no index names it. All other
    DOFs stop, whether an index names them or not.
    """
    dof = state.dof
    if indices is None:
        return checked_first(velocities, dof, "SetDOFVelocities") if dof else np.zeros(0)
    chosen = checked_indices(indices, dof)
    given = dict(zip(chosen.tolist(), checked_vector(velocities, len(chosen), "SetDOFVelocities"), strict=True))
    first = state.dynamics.dof_velocities(state.present_velocities)[: len(chosen)]
    full = np.zeros(dof)
    full[: len(first)] = [given.get(place, rate) for place, rate in enumerate(first)]  # random-api-117, dof-24
    return full


def settled_values(body: KinBody, kinematics: BodyKinematics, target: Floats, checklimits: int) -> Floats:
    """Return joint values with NaN replaced by current values, and limited as ``checklimits`` says.

    Args:
        body: The body, for error messages.
        kinematics: The kinematics of the body, which has limits and current values.
        target: Joint values [rad or m], shape (dof,).
        checklimits: A ``CheckLimitsAction``.

    Raises:
        ArgumentError: a value is infinite; with ``CheckLimitsThrow``, a value is outside its limits.
    """
    if np.isinf(target).any():
        raise ArgumentError(f"SetDOFValues: values are {target}, and should be finite")
    target = np.where(np.isnan(target), kinematics.values(), target)
    if checklimits == CheckLimitsAction.Nothing:
        return target
    limited = kinematics.limits.clamp(target)
    outside = np.flatnonzero(np.abs(target - limited) > _VALUE_ROUNDING)
    if len(outside):
        dof = int(outside[0])
        axis = body.dof_axes[dof]
        message = f"is set to {target[dof]:.6g}, outside its limits [{axis.lower:.6g}, {axis.upper:.6g}]"
        _report(body, dof, message, "; it stops at the limit", checklimits)
    return limited


def limited_velocities(body: KinBody, limits: Floats, velocities: Floats, checklimits: int) -> Floats:
    """Return joint velocities, limited as ``checklimits`` says.

    Args:
        body: The body, for error messages.
        limits: Velocity limits [rad/s or m/s], shape (dof,).
        velocities: Joint velocities, shape (dof,).
        checklimits: A ``CheckLimitsAction``.

    Raises:
        ArgumentError: with ``CheckLimitsThrow``, a velocity is outside its limits.
    """
    if checklimits == CheckLimitsAction.Nothing:
        return velocities
    if np.count_nonzero(np.abs(velocities) <= limits) == len(velocities):  # the usual case, and cheaper than clipping
        return velocities
    limited = np.clip(velocities, -limits, limits)
    outside = np.flatnonzero(np.abs(velocities - limited) > _VELOCITY_ROUNDING)
    if len(outside):
        dof = int(outside[0])
        message = f"should have velocity {velocities[dof]:.6g}, and its limit is {limits[dof]:.6g}"
        _report(body, dof, message, ", which it gets", checklimits)
    return limited


def _report(body: KinBody, dof: int, message: str, effect: str, checklimits: int) -> None:
    """Log a warning about a value outside its limits, raise an error, or do nothing, as ``checklimits`` says."""
    if checklimits == CheckLimitsAction.CheckLimitsSilent:
        return
    joint = body.joint_of_dof(dof)
    message = f"joint '{joint.name}' {message}"
    if checklimits == CheckLimitsAction.CheckLimitsThrow:
        raise ArgumentError(message)
    if checklimits != CheckLimitsAction.CheckLimits:
        raise ArgumentError(f"checklimits: is {checklimits!r}, and should be a CheckLimitsAction")
    send_warning(Diagnostic("warning", "value-outside-limits", message + effect, joint.source))

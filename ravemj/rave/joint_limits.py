"""Limits, weights and resolutions of a joint."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_indices, checked_numbers
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.model import scene
from ravemj.rave.member import Member


class JointLimits(Member):
    """Limits, weights and resolutions, one number for each axis of the joint. Setting them moves nothing."""

    @property
    def _scene(self) -> scene.Joint:
        body = self._state.scene
        first = len(body.joints)
        try:
            return body.joints[self._index] if self._index < first else body.passive_joints[self._index - first]
        except IndexError:
            raise self._gone("joint") from None

    def GetLimits(self) -> tuple[Floats, Floats]:
        """Return the lower and the upper limits [rad or m], each of shape (axes,); ±10000 for a circular joint."""
        return self._of_axes("lower"), self._of_axes("upper")

    def SetLimits(self, lower: ArrayLike, upper: ArrayLike) -> None:
        """Set the limits; a joint outside them stays there until it is next set.

        Args:
            lower: Lower limits [rad or m], shape (axes,).
            upper: Upper limits, shape (axes,).

        Raises:
            ArgumentError: there are too few or too many. Nothing has changed then.
        """
        self._set_axes("SetLimits", lower=lower, upper=upper)

    def GetVelocityLimits(self) -> tuple[Floats, Floats]:
        """Return the lowest and the highest velocities [rad/s or m/s], each of shape (axes,)."""
        limits = self._of_axes("max_velocity")
        return -limits, limits

    def SetVelocityLimits(self, maxlimits: ArrayLike) -> None:
        """Set ``maxlimits``, the velocity limits, the same in both directions [rad/s or m/s], shape (axes,)."""
        self._set_axes("SetVelocityLimits", max_velocity=maxlimits)

    def GetAccelerationLimits(self) -> Floats:
        """Return the acceleration limits, the same in both directions [rad/s^2 or m/s^2], shape (axes,)."""
        return self._of_axes("max_acceleration")

    def SetAccelerationLimits(self, maxlimits: ArrayLike) -> None:
        """Set ``maxlimits``, the acceleration limits, the same in both directions [rad/s^2 or m/s^2], shape (axes,)."""
        self._set_axes("SetAccelerationLimits", max_acceleration=maxlimits)

    def GetJerkLimits(self) -> Floats:
        """Return the jerk limits, the same in both directions [rad/s^3 or m/s^3], shape (axes,)."""
        return self._of_axes("max_jerk")

    def SetJerkLimits(self, maxlimits: ArrayLike) -> None:
        """Set ``maxlimits``, the jerk limits, the same in both directions [rad/s^3 or m/s^3], shape (axes,)."""
        self._set_axes("SetJerkLimits", max_jerk=maxlimits)

    def GetHardVelocityLimits(self) -> Floats:
        """Return the velocities that planners never exceed [rad/s or m/s], shape (axes,); 0 if none is set."""
        return self._of_axes("hard_max_velocity")

    def SetHardVelocityLimits(self, maxlimits: ArrayLike) -> None:
        """Set ``maxlimits``, the velocities that planners never exceed [rad/s or m/s], shape (axes,); 0: none."""
        self._set_axes("SetHardVelocityLimits", hard_max_velocity=maxlimits)

    def GetHardAccelerationLimits(self) -> Floats:
        """Return the accelerations never to exceed [rad/s^2 or m/s^2], shape (axes,); 0 if none is set."""
        return self._of_axes("hard_max_acceleration")

    def SetHardAccelerationLimits(self, maxlimits: ArrayLike) -> None:
        """Set ``maxlimits``, accelerations that planners never exceed [rad/s^2 or m/s^2], shape (axes,); 0: none."""
        self._set_axes("SetHardAccelerationLimits", hard_max_acceleration=maxlimits)

    def GetHardJerkLimits(self) -> Floats:
        """Return the jerks that planners never exceed [rad/s^3 or m/s^3], shape (axes,); 0 if none is set."""
        return self._of_axes("hard_max_jerk")

    def SetHardJerkLimits(self, maxlimits: ArrayLike) -> None:
        """Set ``maxlimits``, the jerks that planners never exceed [rad/s^3 or m/s^3], shape (axes,); 0: none."""
        self._set_axes("SetHardJerkLimits", hard_max_jerk=maxlimits)

    def GetTorqueLimits(self) -> Floats:
        """Return the torque or force limits [N m or N], shape (axes,); 0 where the file says nothing."""
        return self._of_axes("max_torque")

    def SetTorqueLimits(self, maxlimits: ArrayLike) -> None:
        """Set ``maxlimits``, the torque or force limits [N m or N], shape (axes,)."""
        self._set_axes("SetTorqueLimits", max_torque=maxlimits)

    def GetMaxVel(self, axis: int = 0) -> float:
        """Return the velocity limit of ``axis`` [rad/s or m/s]."""
        return self._axis(axis).max_velocity

    def GetMaxAccel(self, axis: int = 0) -> float:
        """Return the acceleration limit of ``axis`` [rad/s^2 or m/s^2]."""
        return self._axis(axis).max_acceleration

    def GetMaxJerk(self, axis: int = 0) -> float:
        """Return the jerk limit of ``axis`` [rad/s^3 or m/s^3]."""
        return self._axis(axis).max_jerk

    def GetHardMaxVel(self, axis: int = 0) -> float:
        """Return the velocity of ``axis`` that planners never exceed [rad/s or m/s]; 0 if none is set."""
        return self._axis(axis).hard_max_velocity

    def GetHardMaxAccel(self, axis: int = 0) -> float:
        """Return the acceleration of ``axis`` that planners never exceed [rad/s^2 or m/s^2]; 0 if none is set."""
        return self._axis(axis).hard_max_acceleration

    def GetHardMaxJerk(self, axis: int = 0) -> float:
        """Return the jerk of ``axis`` that planners never exceed [rad/s^3 or m/s^3]; 0 if none is set."""
        return self._axis(axis).hard_max_jerk

    def GetMaxTorque(self, axis: int = 0) -> float:
        """Return the torque or force limit of ``axis`` [N m or N]; 0 where the file says nothing."""
        return self._axis(axis).max_torque

    def GetWeights(self) -> Floats:
        """Return the weights in distances between configurations, shape (axes,)."""
        return self._of_axes("weight")

    def GetWeight(self, axis: int = 0) -> float:
        """Return the weight of ``axis`` in distances between configurations."""
        return self._axis(axis).weight

    def SetWeights(self, weights: ArrayLike) -> None:
        """Set the weights in distances between configurations, shape (axes,); all should be positive."""
        if not np.all(checked_numbers(weights, "SetWeights: weights") > 0):
            raise RavemjError(f"SetWeights: weights are {weights}, and should be positive", ErrorCode.Assert)
        self._set_axes("SetWeights", weight=weights)

    def GetResolutions(self) -> Floats:
        """Return the steps of planners [rad or m], shape (axes,)."""
        return self._of_axes("resolution")

    def GetResolution(self, axis: int) -> float:
        """Return the step of planners along ``axis`` [rad or m]."""
        return self._axis(axis).resolution

    def SetResolution(self, resolution: float) -> None:
        """Set the step of planners, the same for all axes.

        Args:
            resolution: Step [rad or m]; planners take one of their own where it is not positive.
        """
        self._set_axes("SetResolution", resolution=[resolution] * len(self._scene.axes))

    def _axis(self, axis: int) -> scene.Axis:
        """Return one axis of the joint.

        Raises:
            IndexError: the joint has no such axis.
        """
        checked_indices([axis], len(self._scene.axes), "axis")
        return self._scene.axes[axis]

    def _of_axes(self, field: str) -> Floats:
        return np.array([getattr(axis, field) for axis in self._scene.axes], dtype=np.float64)

    def _set_axes(self, caller: str, **fields: ArrayLike) -> None:
        """Set one or more fields of the axes, all or nothing."""
        axes = list(self._scene.axes)
        for field, values in fields.items():
            numbers = checked_numbers(values, f"{caller}: values")
            if numbers.shape != (len(axes),) or np.isnan(numbers).any():
                wanted = f"{len(axes)} numbers, one for each axis"
                message = f"{caller}: values are {numbers.tolist()}, and should be {wanted}"
                is_length = numbers.shape != (len(axes),)  # random-api-74
                raise ArgumentError(message, ErrorCode.Failed if is_length else ErrorCode.InvalidArguments)
            for index, number in enumerate(numbers.tolist()):
                changes: dict[str, Any] = {field: number}
                axes[index] = replace(axes[index], **changes)
        with self._state.simulation.lock:
            self._state.edit_joint(self._index, axes=tuple(axes))

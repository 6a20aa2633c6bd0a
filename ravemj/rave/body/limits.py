"""The number of DOFs, their limits, weights and resolutions."""

from types import EllipsisType

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_index
from ravemj.core.arrays import checked_indices, checked_numbers, checked_vector
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.model.joints import value_differences
from ravemj.model.limits import with_fields
from ravemj.model.scene import Joint


class Limits(ApiObject):
    """The number of DOFs, and their limits, weights and resolutions. Setting them does not move the body.

    It is the base class of the other topics of a body, and declares the state that they share.
    """

    _internal = ("simulation_state",)

    _state: BodyState
    _simulation: Simulation

    _known: tuple[tuple[Joint, ...], dict[str, Floats]] | None = None
    """A cache: the joints, and fields of all their axes as arrays, by name. A change replaces the tuple of joints, so
    the cache holds as long as the scene has this very tuple."""

    @property
    def simulation_state(self) -> BodyState:
        """The state of the body below OpenRAVE's API: its scene and its kinematics."""
        return self._state

    def _checked_link(self, index: int) -> int:
        return checked_index(index, len(self._state.scene.links), "linkindex")

    def GetDOF(self) -> int:
        """Return the number of degrees of freedom: the axes of all joints that are not passive.

        Example:
            >>> robot.GetDOF()
            2
        """
        return self._state.dof

    def GetDOFLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> tuple[Floats, Floats]:
        """Return the joint limits.

        Args:
            indices: Which DOFs, in which order; left out: all.

        Returns:
            Lower and upper limits [rad or m], each of shape (dof,); ±10000 for circular joints.

        Raises:
            IndexError: there is no such DOF.

        Example:
            >>> lower, upper = robot.GetDOFLimits()
            >>> middle = (lower + upper) / 2
        """
        return self._of_axes("lower", indices), self._of_axes("upper", indices)

    def SetDOFLimits(self, lower: ArrayLike, upper: ArrayLike, indices: "ArrayLike | None" = None) -> None:
        """Set joint limits. The body does not move, even if a joint is outside now; ``SetDOFValues`` applies limits.

        Args:
            lower: Lower limits [rad or m], one for each DOF or for each index.
            upper: Upper limits [rad or m], likewise.
            indices: The DOF indices of the limits; None for all.

        Raises:
            openrave_exception: the number of limits is wrong. The limits stay as they were.
            IndexError: there is no such DOF.
        """
        self._set_axes("SetDOFLimits", {"lower": lower, "upper": upper}, indices)

    def GetDOFVelocityLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the velocity limits [rad/s or m/s], shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("max_velocity", indices)

    GetDOFMaxVel = GetDOFVelocityLimits

    def SetDOFVelocityLimits(self, limits: ArrayLike) -> None:
        """Set the velocity limits [rad/s or m/s], shape (dof,)."""
        self._set_axes("SetDOFVelocityLimits", {"max_velocity": limits})

    def GetDOFAccelerationLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the acceleration limits [rad/s^2 or m/s^2], shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("max_acceleration", indices)

    GetDOFMaxAccel = GetDOFAccelerationLimits

    def SetDOFAccelerationLimits(self, limits: ArrayLike) -> None:
        """Set the acceleration limits [rad/s^2 or m/s^2], shape (dof,)."""
        self._set_axes("SetDOFAccelerationLimits", {"max_acceleration": limits})

    def GetDOFJerkLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the jerk limits [rad/s^3 or m/s^3], shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("max_jerk", indices)

    def SetDOFJerkLimits(self, limits: ArrayLike) -> None:
        """Set the jerk limits [rad/s^3 or m/s^3], shape (dof,)."""
        self._set_axes("SetDOFJerkLimits", {"max_jerk": limits})

    def GetDOFHardVelocityLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the hard velocity limits, see ``SetDOFHardVelocityLimits``, or those of the DOFs ``indices``."""
        return self._of_axes("hard_max_velocity", indices)

    def SetDOFHardVelocityLimits(self, limits: ArrayLike) -> None:
        """Set ``limits``, velocities that planners never exceed [rad/s or m/s], shape (dof,); 0 for none."""
        self._set_axes("SetDOFHardVelocityLimits", {"hard_max_velocity": limits})

    def GetDOFHardAccelerationLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the limits of ``SetDOFHardAccelerationLimits``, shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("hard_max_acceleration", indices)

    def SetDOFHardAccelerationLimits(self, limits: ArrayLike) -> None:
        """Set ``limits``, accelerations that planners never exceed [rad/s^2 or m/s^2], shape (dof,); 0 for none."""
        self._set_axes("SetDOFHardAccelerationLimits", {"hard_max_acceleration": limits})

    def GetDOFHardJerkLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the limits of ``SetDOFHardJerkLimits``, shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("hard_max_jerk", indices)

    def SetDOFHardJerkLimits(self, limits: ArrayLike) -> None:
        """Set ``limits``, jerks that planners never exceed [rad/s^3 or m/s^3], shape (dof,); 0 for none."""
        self._set_axes("SetDOFHardJerkLimits", {"hard_max_jerk": limits})

    def GetDOFDynamicAccelerationJerkLimits(
        self, dofPositions: ArrayLike, dofVelocities: ArrayLike
    ) -> tuple[Floats, Floats]:
        """Return limits that depend on the configuration. ravemj has none.

        Args:
            dofPositions: Joint values [rad or m], shape (dof,).
            dofVelocities: Joint velocities [rad/s or m/s], shape (dof,).

        Returns:
            Two empty arrays: the limits of ``GetDOFAccelerationLimits`` and ``GetDOFJerkLimits`` apply everywhere.
        """
        for values, name in ((dofPositions, "dofPositions"), (dofVelocities, "dofVelocities")):
            checked_vector(values, self.GetDOF(), f"GetDOFDynamicAccelerationJerkLimits: {name}")
        return np.zeros(0), np.zeros(0)

    def GetDOFTorqueLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the torque limits [N m or N], shape (dof,), or those of the DOFs ``indices``; 0 for an unknown one."""
        return self._of_axes("max_torque", indices)

    GetDOFMaxTorque = GetDOFTorqueLimits

    def SetDOFTorqueLimits(self, limits: ArrayLike) -> None:
        """Set the torque limits [N m, for sliders N], shape (dof,)."""
        self._set_axes("SetDOFTorqueLimits", {"max_torque": limits})

    def GetDOFWeights(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the weights in distances between configurations, shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("weight", indices)

    def SetDOFWeights(self, weights: ArrayLike) -> None:
        """Set the weights in distances between configurations.

        Args:
            weights: Weights, all positive, shape (dof,).

        Raises:
            openrave_exception: the number of weights is wrong (``Failed``), or one is not positive
                (``InvalidArguments``). The weights stay as they were.
        """
        self._set_axes("SetDOFWeights", {"weight": weights}, positive=True)

    def GetDOFResolutions(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the planners' steps [rad or m], shape (dof,), or those of the DOFs ``indices``."""
        return self._of_axes("resolution", indices)

    def SetDOFResolutions(self, resolutions: ArrayLike) -> None:
        """Set ``resolutions``, the steps in which planners test for collisions [rad or m], positive, shape (dof,)."""
        self._set_axes("SetDOFResolutions", {"resolution": resolutions}, positive=True)

    def _of_axes(self, field: str, indices: "ArrayLike | EllipsisType | None") -> Floats:
        scene = self._state.scene
        if self._known is None or self._known[0] is not scene.joints:
            self._known = (scene.joints, {})
        fields = self._known[1]
        values = fields.get(field)
        if values is None:
            fields[field] = values = np.array([getattr(axis, field) for axis in scene.dof_axes], dtype=np.float64)
        return values.copy() if indices is ... else values[checked_indices(indices, len(values))]

    def _set_axes(
        self, caller: str, fields: dict[str, ArrayLike], indices: "ArrayLike | None" = None, *, positive: bool = False
    ) -> None:
        """Set fields of axes. If one number is wrong, none is set."""
        dof = self.GetDOF()
        chosen = checked_indices(... if indices is None else indices, dof)
        given: dict[str, list[float]] = {}
        for name, values in fields.items():
            numbers = checked_numbers(values, f"{caller}: values")
            if numbers.ndim != 1 or (len(numbers) != len(chosen) and numbers.size + len(chosen) > 0):
                wanted = f"{dof} numbers, one for each DOF" if indices is None else f"{len(chosen)}, as many as indices"
                message = f"{caller}: values have shape {numbers.shape}, and should be {wanted}"
                raise ArgumentError(message, ErrorCode.Failed if indices is None else ErrorCode.Assert)
            if np.isnan(numbers).any():
                raise ArgumentError(f"{caller}: values are {numbers.tolist()}, and should be numbers")
            if positive and not (numbers > 0).all():
                raise ArgumentError(f"{caller}: values are {numbers.tolist()}, and should be positive")
            given[name] = numbers.tolist()
        with self._simulation.lock:
            self._state.edit_axes(with_fields(self._state.scene.dof_axes, chosen.tolist(), given))

    def SubtractDOFValues(
        self, values0: ArrayLike, values1: ArrayLike, indices: "ArrayLike | EllipsisType | None" = ...
    ) -> Floats:
        """Return the difference of joint values.

        Args:
            values0: Joint values [rad or m], one for each DOF or for each index.
            values1: The joint values to subtract, likewise.
            indices: The DOF indices of the values; by default all.

        Returns:
            ``values0 - values1``. For circular joints the difference is in [-pi, pi], except for joints on a static
            link, as in OpenRAVE.
        """
        chosen = checked_indices(indices, self.GetDOF())
        minuend, subtrahend = (checked_numbers(values, "SubtractDOFValues") for values in (values0, values1))
        if not len(minuend) == len(subtrahend) == len(chosen):
            message = (
                f"SubtractDOFValues: {len(minuend)} and {len(subtrahend)} values, and should be {len(chosen)} each"
            )
            raise ArgumentError(message, ErrorCode.Assert)
        return value_differences(self._state.scene, chosen.tolist(), minuend, subtrahend)

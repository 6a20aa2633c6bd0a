"""Active DOFs: the configuration space that planners and ``…Active…`` calls use."""

# ruff: noqa: D102 - the docstrings of the last methods come from a table

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_indices, checked_numbers, checked_vector
from ravemj.core.transforms import Floats, Ints, Vec3, wxyz_jacobian
from ravemj.engine.affine import AffineMotion
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.affine import Z_AXIS, DOFAffine, affine_values, pose_with_values
from ravemj.model.joints import wrapped_angle
from ravemj.rave.body.affine import AffineKind, affine_numbers, with_affine_settings
from ravemj.rave.body.collision import BodyCollision
from ravemj.rave.body.configuration import Configuration
from ravemj.rave.body.dynamics import Dynamics
from ravemj.rave.enums import CheckLimitsAction
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.trajectories.bodies import body_groups


class ActiveChoice(NamedTuple):
    """Which DOFs are active.

    Attributes:
        dofs: Indices of the joints' DOFs in the order of their values, in an array that is never changed; None: all.
        affine: The parts of the base's pose that come after them: ``DOFAffine`` as a plain number, which is faster.
        axis: Axis of ``DOFAffine.RotationAxis``.
    """

    dofs: Ints | None = None
    affine: int = 0
    axis: Vec3 = Z_AXIS


@with_affine_settings
class ActiveDofs(BodyCollision, Dynamics, Configuration):
    """The active DOFs of a robot: some of its joints, then parts of its base's pose, which move all of it."""

    active_choice: ActiveChoice
    """What ``SetActiveDOFs`` chose."""
    affine_kinds: dict[str, AffineKind]
    """Limits, resolutions and weights of the parts of the base's pose."""
    quaternion_limits: Floats
    """What ``SetAffineRotationQuatLimits`` took."""

    def SetActiveDOFs(self, dofindices: ArrayLike, affine: int = 0, rotationaxis: ArrayLike | None = None) -> None:
        """Choose the DOFs that ``SetActiveDOFValues``, trajectories and planners use.

        Args:
            dofindices: Joint DOFs, in the order in which their values will be given.
            affine: Parts of the base's pose that follow them: ``DOFAffine`` combined with ``|``, always in the order
                X, Y, Z, rotation.
            rotationaxis: Axis of ``DOFAffine.RotationAxis`` in the world; None: z.

        Raises:
            ArgumentError: there is no such DOF. Nothing has changed then.

        Example:
            >>> robot.SetActiveDOFs([1, 0])
            >>> robot.SetActiveDOFValues([0.1, 0.2])  # the second joint, then the first
            >>> robot.SetActiveDOFs([], DOFAffine.X | DOFAffine.Y | DOFAffine.RotationAxis, [0, 0, 1])
            >>> robot.SetActiveDOFValues([1.0, 2.0, 0.5])  # the base drives
        """
        try:
            dofs = checked_indices(dofindices, self.GetDOF(), "SetActiveDOFs: dofindices")
        except IndexError as error:
            raise ArgumentError(str(error)) from None
        axis = Z_AXIS
        if rotationaxis is not None:
            x, y, z = checked_vector(rotationaxis, 3, "SetActiveDOFs: rotationaxis").tolist()
            axis = (x, y, z)
            if affine & DOFAffine.RotationAxis and not any(axis):
                raise ArgumentError("SetActiveDOFs: rotationaxis is zero, and should point somewhere")
        self.active_choice = ActiveChoice(dofs, int(DOFAffine(int(affine))), axis)

    def GetActiveDOF(self) -> int:
        """Return the number of active values: all DOFs until ``SetActiveDOFs`` was called."""
        chosen = self.active_choice
        joints = self.GetDOF() if chosen.dofs is None else len(chosen.dofs)
        return joints + len(self._affine_numbers("weight")) if chosen.affine else joints

    def GetActiveDOFIndices(self) -> Ints:
        """Return the active joints' DOFs in the order of their values; affine ones are not among them."""
        chosen = self.active_choice.dofs
        return np.arange(self.GetDOF()) if chosen is None else chosen.copy()

    GetActiveJointIndices = GetActiveDOFIndices

    def _active_dofs(self) -> list[int]:
        return self.GetActiveDOFIndices().tolist()

    def GetAffineDOF(self) -> int:
        """Return the active parts of the base's pose, a ``DOFAffine``."""
        return self.active_choice.affine

    def GetAffineDOFIndex(self, index: int) -> int:
        """Return where the value of a part of the base's pose is among the active values.

        Args:
            index: The part, one ``DOFAffine``.

        Raises:
            ArgumentError: the part is not active.
        """
        affine = self.active_choice.affine
        if not index & affine:
            raise ArgumentError(f"GetAffineDOFIndex: {DOFAffine(index)!r} is not active")
        before = affine & (int(index) - 1) & int(DOFAffine.Transform)
        return len(self._active_dofs()) + sum(bool(before & part) for part in (1, 2, 4))

    def GetAffineRotationAxis(self) -> Floats:
        """Return the axis of ``DOFAffine.RotationAxis``, shape (3,)."""
        return np.array(self.active_choice.axis)

    def GetActiveDOFValues(self) -> Floats:
        """Return the active values: joints [rad or m], then the base's X, Y, Z [m] and rotation; shape (n,).

        Example:
            >>> robot.SetDOFValues([0.5, -0.5])
            >>> robot.SetActiveDOFs([1])
            >>> robot.GetActiveDOFValues()
            array([-0.5])
        """
        with self._simulation.lock:
            chosen, values = self.active_choice, self._state.kinematics.values()
            joints = values if chosen.dofs is None else values[chosen.dofs]
            if not chosen.affine:
                return joints
            return np.concatenate([joints, affine_values(self._state.pose(), chosen.affine, chosen.axis)])

    def SetActiveDOFValues(self, values: ArrayLike, checklimits: int = CheckLimitsAction.CheckLimits) -> None:
        """Set the active values: joints [rad or m], then the base's X, Y, Z [m] and rotation.

        Args:
            values: At least as many as there are active values; more are left out. NaN leaves a joint as it is.
            checklimits: What to do with joint values outside the limits, as in ``SetDOFValues``; those of the base
                are set as they are.

        Raises:
            ArgumentError: there are too few values, or one is infinite. Nothing has changed then.

        Example:
            >>> robot.SetActiveDOFs([1], ravemj.DOFAffine.X)
            >>> robot.SetActiveDOFValues([0.5, 2.0])  # the second joint to 0.5 rad, the base to x = 2 m
        """
        given = checked_numbers(values, "SetActiveDOFValues: values")
        count = self.GetActiveDOF()
        if given.ndim != 1 or len(given) < count:
            message = f"SetActiveDOFValues: values have shape {given.shape}, and should be {count} numbers"
            raise ArgumentError(message)
        choice = self.active_choice
        joints = self.GetDOF() if choice.dofs is None else len(choice.dofs)
        base = checked_vector(given[joints:count], count - joints, "SetActiveDOFValues: base's values")
        with self._simulation.lock:
            if joints:
                self.SetDOFValues(given[:joints], choice.dofs, checklimits)
            if choice.affine:
                self._state.set_pose(pose_with_values(self._state.pose(), base, choice.affine, choice.axis))

    def GetActiveDOFVelocities(self) -> Floats:
        """Return the velocities of the active values: of joints [rad/s or m/s], then of the base; shape (n,)."""
        with self._simulation.lock:
            joints = self.GetDOFVelocities(self._active_dofs())
            return np.concatenate([joints, self._affine_motion().rates(self._state.link_velocities()[0])])

    def SetActiveDOFVelocities(self, velocities: ArrayLike, checklimits: int = CheckLimitsAction.CheckLimits) -> None:
        """Set the velocities of the active values; the other DOFs keep theirs.

        Args:
            velocities: Those of the joints [rad/s or m/s], then those of the base's active parts.
            checklimits: What to do with joint velocities outside the limits, as in ``SetDOFVelocities``.

        Raises:
            ArgumentError: they are not as many as there are active values. Nothing has changed then.
        """
        given = checked_vector(velocities, self.GetActiveDOF(), "SetActiveDOFVelocities")
        joints = self._active_dofs()
        with self._simulation.lock:
            base = self._affine_motion().velocity(given[len(joints) :], self._state.link_velocities()[0])
            rates = self.GetDOFVelocities()
            rates[joints] = given[: len(joints)]
            self.SetDOFVelocities(rates, base[:3], base[3:], checklimits)

    def GetActiveDOFLimits(self) -> tuple[Floats, Floats]:
        """Return the lower and upper limits of the active values, shape (n,) each; the base has ±100 m, ±10000 rad."""
        lower, upper = self.GetDOFLimits(self.GetActiveDOFIndices())
        return self._with_affine(lower, "lower"), self._with_affine(upper, "upper")

    def GetActiveDOFMaxVel(self) -> Floats:
        """Return the velocity limits of the active values [rad/s or m/s], shape (n,)."""
        return self._with_affine(self.GetDOFVelocityLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFMaxAccel(self) -> Floats:
        """Return the acceleration limits of the active values, shape (n,); for the base its velocity limits."""
        return self._with_affine(self.GetDOFAccelerationLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFMaxJerk(self) -> Floats:
        """Return the jerk limits of the active values, shape (n,); for the base its velocity limits."""
        return self._with_affine(self.GetDOFJerkLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFHardMaxVel(self) -> Floats:
        """Return the velocities that planners never exceed, shape (n,); for the base its velocity limits."""
        return self._with_affine(self.GetDOFHardVelocityLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFHardMaxAccel(self) -> Floats:
        """Return the accelerations that planners never exceed, shape (n,); for the base its velocity limits."""
        return self._with_affine(self.GetDOFHardAccelerationLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFHardMaxJerk(self) -> Floats:
        """Return the jerks that planners never exceed, shape (n,); for the base its velocity limits."""
        return self._with_affine(self.GetDOFHardJerkLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFResolutions(self) -> Floats:
        """Return the steps of planners for the active values [rad or m], shape (n,)."""
        return self._with_affine(self.GetDOFResolutions(self._active_dofs()), "resolution")

    def GetActiveDOFWeights(self) -> Floats:
        """Return the weights of the active values in distances, shape (n,)."""
        return self._with_affine(self.GetDOFWeights(self._active_dofs()), "weight")

    def _with_affine(self, joints: Floats, name: str) -> Floats:
        return np.concatenate([joints, self._affine_numbers(name)]) if self.active_choice.affine else joints

    def _affine_numbers(self, name: str) -> Floats:
        """Return a setting of all active parts of the base's pose."""
        return affine_numbers(self.affine_kinds, self.active_choice.affine, self.active_choice.axis, name)

    def GetActiveConfigurationSpecification(self, interpolation: str = "") -> ConfigurationSpecification:
        """Return the layout of the active values, as trajectories of them have it.

        Args:
            interpolation: How they change between waypoints, for instance ``linear``.

        Example:
            >>> trajectory = ravemj.RaveCreateTrajectory(env, "")
            >>> trajectory.Init(robot.GetActiveConfigurationSpecification("linear"))
        """
        groups = body_groups(self._state.scene.name, self._active_dofs(), self.active_choice.affine, interpolation)
        return ConfigurationSpecification.of(groups)

    def SubtractActiveDOFValues(self, values0: ArrayLike, values1: ArrayLike) -> Floats:
        """Return the difference of active values; circular joints and the base's angle go the shorter way round.

        Args:
            values0: Active values.
            values1: Active values to subtract.

        Returns:
            ``values0 - values1``, shape (n,).

        Raises:
            ArgumentError: they are not as many as there are active values.
        """
        count, joints = self.GetActiveDOF(), self._active_dofs()
        minuend, subtrahend = (checked_vector(one, count, "SubtractActiveDOFValues") for one in (values0, values1))
        difference = minuend - subtrahend
        split = len(joints)
        difference[:split] = self.SubtractDOFValues(minuend[:split], subtrahend[:split], joints)
        if self.active_choice.affine & DOFAffine.RotationAxis:
            difference[-1:] = wrapped_angle(difference[-1:])
        return difference

    def CalculateActiveJacobian(self, linkindex: int, offset: ArrayLike) -> Floats:
        """Return how a point of a link moves with the active values.

        Args:
            linkindex: Index of the link.
            offset: The point, in world coordinates [m], shape (3,).

        Returns:
            Derivative of the point's position in the world, shape (3, active dof).
        """
        point = checked_vector(offset, 3, "offset")
        link = self._checked_link(linkindex)
        with self._simulation.lock:
            joints = self._active_columns(self._state.dynamics.translation_jacobian(link, point))
            if not self.active_choice.affine:
                return joints
            return np.hstack([joints, self._affine_motion().translation_jacobian(point)])

    def _active_columns(self, jacobian: Floats) -> Floats:
        """Return the columns of the active joints."""
        chosen = self.active_choice.dofs
        return jacobian if chosen is None else jacobian.take(chosen, 1)

    def CalculateActiveAngularVelocityJacobian(self, linkindex: int) -> Floats:
        """Return the angular velocity of a link, in world axes, per unit of the active values' velocity.

        Args:
            linkindex: Index of the link.

        Returns:
            Shape (3, active dof).
        """
        with self._simulation.lock:
            joints = self._active_columns(self.ComputeJacobianAxisAngle(linkindex))
            if not self.active_choice.affine:
                return joints
            return np.hstack([joints, self._affine_motion().rotation_jacobian()])

    def CalculateActiveRotationJacobian(self, linkindex: int, quat: ArrayLike) -> Floats:
        """Return how a quaternion turns with a link.

        Args:
            linkindex: Index of the link.
            quat: The quaternion [w, x, y, z]: the link's orientation, or that of anything fixed to it.

        Returns:
            Its derivative by the active values, shape (4, active dof).
        """
        rates = wxyz_jacobian(checked_vector(quat, 4, "quat").tolist())
        return rates @ self.CalculateActiveAngularVelocityJacobian(linkindex)

    def GetAffineRotationQuatLimits(self) -> Floats:
        """Return how far the base may turn: a quaternion [w, x, y, z] times the largest angle from it, shape (4,)."""
        return self.quaternion_limits.copy()

    def SetAffineRotationQuatLimits(self, quatangle: ArrayLike) -> None:
        """Set how far the base may turn; as in OpenRAVE it is only kept, and active limits stay -1 and 1.

        Args:
            quatangle: A quaternion [w, x, y, z] times the largest angle from it [rad], shape (4,).
        """
        self.quaternion_limits = checked_vector(quatangle, 4, "SetAffineRotationQuatLimits: quatangle")

    def _affine_motion(self) -> AffineMotion:
        choice = self.active_choice
        return AffineMotion(self._state.pose(), choice.affine, choice.axis)

    def active_dofs(self) -> tuple[int, ...]:
        """Return the active joints' DOFs."""
        return tuple(self._active_dofs())

    def moves_as_a_whole(self) -> bool:
        """Return whether active DOFs move the robot's base."""
        return bool(self.active_choice.affine)

    # Settings of the affine DOFs, with bodies and docstrings from the table in ``affine``

    def GetAffineTranslationLimits(self) -> tuple[Floats, Floats]: ...
    def SetAffineTranslationLimits(self, lower: ArrayLike, upper: ArrayLike) -> None: ...
    def GetAffineTranslationMaxVels(self) -> Floats: ...
    def SetAffineTranslationMaxVels(self, vels: ArrayLike) -> None: ...
    def GetAffineTranslationResolution(self) -> Floats: ...
    def SetAffineTranslationResolution(self, resolution: ArrayLike) -> None: ...
    def GetAffineTranslationWeights(self) -> Floats: ...
    def SetAffineTranslationWeights(self, weights: ArrayLike) -> None: ...
    def GetAffineRotationAxisLimits(self) -> tuple[Floats, Floats]: ...
    def SetAffineRotationAxisLimits(self, lower: ArrayLike, upper: ArrayLike) -> None: ...
    def GetAffineRotationAxisMaxVels(self) -> Floats: ...
    def SetAffineRotationAxisMaxVels(self, velocity: ArrayLike) -> None: ...
    def GetAffineRotationAxisResolution(self) -> Floats: ...
    def SetAffineRotationAxisResolution(self, resolution: ArrayLike) -> None: ...
    def GetAffineRotationAxisWeights(self) -> Floats: ...
    def SetAffineRotationAxisWeights(self, weights: ArrayLike) -> None: ...
    def GetAffineRotation3DLimits(self) -> tuple[Floats, Floats]: ...
    def SetAffineRotation3DLimits(self, lower: ArrayLike, upper: ArrayLike) -> None: ...
    def GetAffineRotation3DMaxVels(self) -> Floats: ...
    def SetAffineRotation3DMaxVels(self, velocity: ArrayLike) -> None: ...
    def GetAffineRotation3DResolution(self) -> Floats: ...
    def SetAffineRotation3DResolution(self, resolution: ArrayLike) -> None: ...
    def GetAffineRotation3DWeights(self) -> Floats: ...
    def SetAffineRotation3DWeights(self, weights: ArrayLike) -> None: ...
    def GetAffineRotationQuatMaxVels(self) -> Floats: ...
    def SetAffineRotationQuatMaxVels(self, velocity: ArrayLike) -> None: ...
    def GetAffineRotationQuatResolution(self) -> Floats: ...
    def SetAffineRotationQuatResolution(self, resolution: ArrayLike) -> None: ...
    def GetAffineRotationQuatWeights(self) -> Floats: ...
    def SetAffineRotationQuatWeights(self, weights: ArrayLike) -> None: ...

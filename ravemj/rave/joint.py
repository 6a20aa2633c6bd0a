"""Joints of a body."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_indices, checked_number, checked_numbers, checked_vector
from ravemj.core.transforms import Floats, Ints, Pose, conjugate, pose_of, rotate
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions import quatRotateDirection
from ravemj.model import scene
from ravemj.model.joints import (
    directions_at,
    measured_values,
    relative_pose,
    reported_anchor,
    subtracts_in_turns,
    wrapped_angle,
)
from ravemj.model.manipulators import joint_dofs
from ravemj.model.mimic import Equations, leaders
from ravemj.model.scene import Parameters
from ravemj.rave.enums import JointType
from ravemj.rave.infos import JointInfo
from ravemj.rave.infos.joint import type_of
from ravemj.rave.link import Link
from ravemj.rave.member import Member


class Joint(Member):
    """Joint between two links; ``body.GetJoints()`` returns the joints."""

    _internal = ("renumber",)

    Type = JointType

    def GetType(self) -> JointType:
        """Return the kind of joint."""
        return type_of(self._scene.kind)

    def GetJointIndex(self) -> int:
        """Return the joint's index in ``body.GetJoints()``; -1 for a passive joint."""
        return self._index if self.IsActive() else -1

    def GetDOFIndex(self) -> int:
        """Return the index of the joint's first DOF value; -1 for a passive joint.

        Example:
            >>> index = robot.GetJoint("Joint1").GetDOFIndex()
            >>> robot.SetDOFValues([0.5], [index])
        """
        if not self.IsActive():
            return -1
        return sum(len(joint.axes) for joint in self._state.scene.joints[: self._index])

    def GetDOF(self) -> int:
        """Return the joint's number of axes; passive joints have axes, too."""
        return len(self._scene.axes)

    def GetValues(self) -> Floats:
        """Return the joint's values [rad or m], shape (axes,)."""
        with self._state.simulation.lock:
            if not self.IsActive():
                return self._state.kinematics.passive_values(self._index - len(self._state.scene.joints))
            return self._own(self._state.kinematics.values())

    def GetValue(self, axis: int = 0) -> float:
        """Return the joint's value about or along ``axis`` [rad or m]."""
        return float(self.GetValues()[axis])

    def GetVelocities(self) -> Floats:
        """Return the joint velocities [rad/s or m/s], computed from the link velocities, shape (axes,)."""
        with self._state.simulation.lock:
            velocities, dynamics = self._state.present_velocities, self._state.dynamics
            if self.IsActive():
                return self._own(dynamics.dof_velocities(velocities))
            return dynamics.joint_velocities(velocities, [self._scene])[0]

    def _own(self, values: Floats) -> Floats:
        """Return this active joint's entries of a vector over all DOFs, shape (axes,)."""
        first = self._state.kinematics.first_dofs[self._index]
        return values[first : first + self.GetDOF()]

    def GetVelocity(self, axis: int = 0) -> float:
        """Return the joint's velocity about or along ``axis`` [rad/s or m/s]."""
        return float(self.GetVelocities()[axis])

    def AddTorque(self, torques: ArrayLike) -> bool:
        """Apply torques to the joint during the next simulation step, in addition to earlier ones.

        Args:
            torques: A torque for each axis [N m; N for prismatic axes].

        Returns:
            Whether the environment has a physics engine that moves bodies.
        """
        return self._parent.GetEnv().GetPhysicsEngine().AddJointTorque(self, torques)

    def SubtractValue(self, value0: float, value1: float, axis: int = 0) -> float:
        """Return the difference of two joint values.

        Args:
            value0: A value [rad or m].
            value1: The value to subtract.
            axis: The index of the axis.

        Returns:
            ``value0 - value1``; for a circular joint wrapped to [-pi, pi], except, as in OpenRAVE, if its parent link
            is static.
        """
        difference = float(value0) - float(value1)
        in_turns = self._axis(axis).circular and subtracts_in_turns(self._state.scene, self._scene)
        return float(wrapped_angle(difference)) if in_turns else difference

    def SubtractValues(self, values0: ArrayLike, values1: ArrayLike) -> Floats:
        """Return the differences of the values of all axes, as ``SubtractValue``.

        Args:
            values0: Values [rad or m], shape (axes,).
            values1: Values to subtract, shape (axes,).

        Returns:
            Differences, shape (axes,).
        """
        count = self.GetDOF()
        pairs = zip(*(checked_vector(values, count, "SubtractValues") for values in (values0, values1)), strict=True)
        return np.array([self.SubtractValue(first, second, axis) for axis, (first, second) in enumerate(pairs)])

    def GetWrapOffset(self, axis: int = 0) -> float:
        """Return the reference value of ``SetWrapOffset`` for ``axis`` [rad]; values are within half a turn of it."""
        return self._axis(axis).wrap_offset

    def SetWrapOffset(self, offset: float, axis: int = 0) -> None:
        """Shift the joint value by full turns to within half a turn of a reference value. The links do not move.

        Args:
            offset: The reference value [rad].
            axis: The index of the axis.
        """
        chosen = checked_number(offset, "SetWrapOffset: offset")
        changed = replace(self._axis(axis), wrap_offset=chosen)
        with self._state.simulation.lock:
            axes = list(self._scene.axes)
            axes[axis] = changed
            self._state.edit_joint(self._index, axes=tuple(axes))
            if self.IsActive() and self.IsRevolute(axis):
                values = self._state.kinematics.values()
                dof = self.GetDOFIndex() + axis
                values[dof] -= 2 * np.pi * np.round((values[dof] - chosen) / (2 * np.pi))
                self._state.set_values(values, clamp_mimic=False)

    def IsActive(self) -> bool:
        """Return whether the joint has its own DOFs: it is enabled and not a mimic joint."""
        return self._index < len(self._state.scene.joints)

    def IsRevolute(self, axis: int = 0) -> bool:
        """Return whether an axis is revolute; as in OpenRAVE, a spherical joint has no revolute axis."""
        return 0 <= axis < len(self._scene.axes) and self._scene.kind != "spherical" and not self._scene.slides(axis)

    def IsPrismatic(self, axis: int = 0) -> bool:
        """Return whether an axis is prismatic."""
        return 0 <= axis < len(self._scene.axes) and self._scene.slides(axis)

    def IsCircular(self, axis: int = 0) -> bool:
        """Return whether the joint rotates about ``axis`` without limits."""
        return self._axis(axis).circular

    def IsStatic(self) -> bool:
        """Return whether the limits allow no motion. A joint with such limits at the creation of the body is a weld."""
        return not self._scene.has_room

    def IsMimic(self, axis: int = -1) -> bool:
        """Return whether an axis mimics other joints; -1 means any axis."""
        return self._scene.mimic is not None and axis <= 0

    def GetMimicEquation(self, axis: int = 0, itype: int = 0, format: str = "") -> str:  # OpenRAVE's names
        """Return the mimic equation of the joint, as in the file.

        Args:
            axis: The index of the axis; only the first one can mimic.
            itype: 0 the position, 1 the partial derivatives for velocities, 2 those for accelerations.
            format: Notation of the equation; only the empty string is supported.

        Returns:
            The equation, with the names of joints; empty if the joint is not a mimic joint.
        """
        del format
        mimic = self._scene.mimic
        if mimic is None or axis != 0:
            return ""
        return (mimic.position, mimic.velocity, mimic.acceleration)[itype]

    def GetMimicDOFIndices(self, axis: int = 0) -> Ints:
        """Return the DOFs in the mimic equation of ``axis``; as in OpenRAVE, not those of other mimic joints in it."""
        mimic = self._scene.mimic
        if mimic is None or axis or mimic.expression is None:
            return np.array([], dtype=np.int_)
        active = [leader for leader in leaders(mimic.expression) if leader < len(self._state.scene.joints)]
        dofs = {dof for leader in active for dof in joint_dofs(self._state.scene, leader)}
        return np.array(sorted(dofs), dtype=np.int_)

    def SetMimicEquations(self, axis: int, poseq: str, veleq: str = "", acceleq: str = "") -> None:
        """Set the mimic equations of the joint. Its value changes only when joint values are next set.

        A joint that becomes a mimic joint loses its DOF, and later DOFs are renumbered; a joint that ceases to be one
        gets the last DOF. All DOFs become active again.

        Args:
            axis: The index of the axis; only the first one can mimic.
            poseq: The equation, with the names of joints, for instance ``2*lead + 0.1``; '' ends the mimicry.
            veleq: The partial derivatives for velocities, stored for ``GetMimicEquation`` only, since velocities are
                computed from ``poseq``.
            acceleq: The partial derivatives for accelerations, also only stored.

        Raises:
            openrave_exception: the equation is invalid, or is for a second axis. Nothing changes then.

        Example:
            >>> body.GetJoint("finger2").SetMimicEquations(0, "-finger1")
        """
        if axis:
            message = f"SetMimicEquations: axis is {axis}; only the first axis of '{self._scene.name}' can follow"
            raise RavemjError(message, ErrorCode.NotImplemented)
        if self._scene.mimic is None and not poseq:
            return
        with self._state.simulation.lock:
            self._parent.set_following(self._index, Equations(poseq, veleq, acceleq))

    def renumber(self, index: int) -> None:
        """Set the joint's new index in the list of active, then passive joints."""
        self._index = index

    def GetAnchor(self) -> Floats:
        """Return a point on the joint axis in the world for the present link poses [m], shape (3,)."""
        return self._T_world_parent() @ (*reported_anchor(self._scene), 1.0)

    def GetAxis(self, axis: int = 0) -> Floats:
        """Return the direction of an axis in the world for the present link poses, shape (3,).

        The second axis of a ``Hinge2`` turns with the first.
        """
        checked_indices([axis], len(self._scene.axes), "axis")
        values = self._shown_values() if axis else [0.0]
        return self._T_world_parent()[:, :3] @ directions_at(self._scene, values)[axis]

    def _T_world_parent(self) -> Floats:
        """Return the parent link's pose in the world, shape (3, 4)."""
        with self._state.simulation.lock:
            return self._state.link_transform(self._scene.parent)[:3]

    def GetHierarchyParentLink(self) -> Link:
        """Return the link of the joint that is nearer to the body's first link."""
        return Link(self._parent, self._state, self._scene.parent)

    def GetHierarchyChildLink(self) -> Link:
        """Return the link of the joint that is farther from the body's first link."""
        return Link(self._parent, self._state, self._scene.child)

    GetFirstAttached = GetHierarchyParentLink
    GetSecondAttached = GetHierarchyChildLink

    def GetInternalHierarchyAxis(self, axis: int = 0) -> Floats:
        """Return the direction of ``axis`` in the frame of ``GetInternalHierarchyLeftTransform``, shape (3,)."""
        return np.array(rotate(conjugate(self._left().wxyz), self._axis(axis).direction))

    def GetInternalHierarchyLeftTransform(self) -> Floats:
        """Return the pose of the joint frame in the parent link.

        The z axis of a hinge's frame is the hinge's axis; the frames of other joints are parallel to the link frame.
        The child is at ``left @ motion @ right``, where ``motion`` turns about or slides along the axis by the joint's
        value.

        Returns:
            ``T_parent_joint``, shape (4, 4).
        """
        return self._left().matrix()

    def GetInternalHierarchyRightTransform(self) -> Floats:
        """Return the pose of the child link in the joint's frame at the value 0.

        Returns:
            ``T_joint_child``, shape (4, 4).
        """
        return (self._left().inverse() @ relative_pose(self._scene, [0.0] * self.GetDOF())).matrix()

    def GetInternalHierarchyLeftTransformPose(self) -> Floats:
        """Return ``GetInternalHierarchyLeftTransform`` as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return self._left().numbers()

    def GetInternalHierarchyRightTransformPose(self) -> Floats:
        """Return ``GetInternalHierarchyRightTransform`` as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return pose_of(self.GetInternalHierarchyRightTransform()).numbers()

    def _left(self) -> Pose:
        if self._scene.kind != "hinge":
            return Pose(self._scene.anchor)
        w, x, y, z = quatRotateDirection((0.0, 0.0, 1.0), self._scene.axes[0].direction).tolist()
        return Pose(self._scene.anchor, (w, x, y, z))

    def _set_parameters(self, parameters: Parameters) -> None:
        self._state.edit_joint(self._index, parameters=parameters)

    def GetInfo(self) -> JointInfo:
        """Return a copy of the description of the joint at its present value."""
        with self._state.simulation.lock:
            return JointInfo.of(self._state.scene, self._index, self._shown_values())

    UpdateAndGetInfo = GetInfo

    def _shown_values(self) -> list[float]:
        """Return the joint values; if the body is outside of an environment, they are measured from the link poses."""
        if self._state.index:
            return self.GetValues().tolist()
        parent, child = (pose_of(self._state.link_transform(i)) for i in (self._scene.parent, self._scene.child))
        return list(measured_values(self._scene, parent.inverse() @ child))

    def _repr_html_(self) -> str:
        from ravemj.rave.tables import joint_table  # noqa: PLC0415 - html is slow to import

        return joint_table(self)

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:  # noqa: ANN401 - IPython's
        """Print the table of the axes in IPython; ``repr`` names only the joint."""
        from ravemj.rave.tables import joint_text, print_pretty  # noqa: PLC0415 - html is slow to import

        del cycle
        print_pretty(printer, self, joint_text(self))

    def __str__(self) -> str:
        place = f"({self.GetJointIndex()}), dof={self.GetDOFIndex()}"
        return f"<joint:{self.GetName()} {place}, parent={self._parent.GetName()}>"

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
        """Set the limits. A joint value outside them stays until it is next set.

        Args:
            lower: Lower limits [rad or m], shape (axes,).
            upper: Upper limits, shape (axes,).

        Raises:
            ArgumentError: the number of values is wrong. Nothing changes then.
        """
        self._set_axes("SetLimits", lower=lower, upper=upper)

    def GetVelocityLimits(self) -> tuple[Floats, Floats]:
        """Return the minimum and maximum velocities [rad/s or m/s], each of shape (axes,)."""
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
        """Return the accelerations that planners never exceed [rad/s^2 or m/s^2], shape (axes,); 0 if none is set."""
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
        """Return the torque or force limits [N m or N], shape (axes,); 0 if the file has none.

        Limits of motors are ignored.
        """
        return self._of_axes("own_torque")

    def SetTorqueLimits(self, maxlimits: ArrayLike) -> None:
        """Set ``maxlimits``, the torque or force limits [N m or N], shape (axes,)."""
        has_motor = bool(self._scene.axes[0].speed_torques) or self._scene.axes[0].joint_torque is not None
        self._set_axes("SetTorqueLimits", **{"joint_torque" if has_motor else "max_torque": maxlimits})

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
        """Return the torque or force limit of ``axis`` [N m or N]; 0 if the file has none.

        If the joint has a motor, the limit is that of the motor at the present speed.
        """
        limited = self._axis(axis)
        if not limited.speed_torques:
            return limited.max_torque
        speed = abs(float(self.GetVelocities()[axis]))
        curve = np.array(limited.speed_torques, dtype=float)
        return float(np.interp(speed, curve[:, 0], curve[:, 1]))

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
        """Return the step sizes of planners [rad or m], shape (axes,)."""
        return self._of_axes("resolution")

    def GetResolution(self, axis: int) -> float:
        """Return the step size of planners along ``axis`` [rad or m]."""
        return self._axis(axis).resolution

    def SetResolution(self, resolution: float) -> None:
        """Set the step size of planners, the same for all axes.

        Args:
            resolution: Step [rad or m]; if it is not positive, planners use their default.
        """
        self._set_axes("SetResolution", resolution=[resolution] * len(self._scene.axes))

    def _axis(self, axis: int) -> scene.Axis:
        """Return an axis of the joint.

        Raises:
            IndexError: the joint has no axis with this index.
        """
        checked_indices([axis], len(self._scene.axes), "axis")
        return self._scene.axes[axis]

    def _of_axes(self, field: str) -> Floats:
        return np.array([getattr(axis, field) for axis in self._scene.axes], dtype=np.float64)

    def _set_axes(self, caller: str, **fields: ArrayLike) -> None:
        """Set fields of the axes; on an error, none is changed."""
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

"""Configuration of a body (joint values, poses, velocities), Jacobians and dynamics."""

from collections.abc import Mapping, Sequence
from types import EllipsisType
from typing import TYPE_CHECKING, Literal, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import (
    FLOAT,
    checked_first,
    checked_indices,
    checked_numbers,
    checked_point,
    checked_rows,
    checked_transform,
    checked_transforms,
    checked_vector,
    checked_whole_numbers,
    finite_vector,
)
from ravemj.core.transforms import Floats, Ints, pose_of, wxyz_jacobian
from ravemj.engine.collision.moving import Among, batch_collides, batch_distances
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions import DOFAffine
from ravemj.rave.enums import CheckLimitsAction
from ravemj.rave.given_values import full_values, full_velocities, limited_velocities, settled_values
from ravemj.rave.kinbody.structure import BodyPart
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.trajectories.bodies import body_groups, configuration_values, split_configuration

if TYPE_CHECKING:
    pass


_UNLIMITED = int(CheckLimitsAction.Nothing)  # looking up a member of an enum takes as long as placing a pendulum


class BodyConfiguration(BodyPart):
    """Joint values, poses, velocities; Jacobians, Hessians, accelerations and inverse dynamics.

    Velocities move nothing without physics, but accelerations and inverse dynamics depend on them. As in OpenRAVE, the
    body stores the velocities of its links, and computes those of the DOFs from them. So set joint values first, then
    velocities.

    Methods whose names begin with ``batch_`` take arrays of joint values, and do not move the body. Apart from the
    result, they need little memory for any number of configurations. If the result itself is too large, pass the joint
    values in parts, or an ``out`` on disk (``numpy.memmap``).
    """

    _often_called = (
        "ComputeInverseDynamics",
        "ComputeJacobianAxisAngle",
        "ComputeJacobianTranslation",
        "GetDOFValues",
        "GetDOFVelocities",
        "SetDOFValues",
        "SetTransform",
    )

    def GetDOFValues(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the joint values.

        Args:
            indices: The DOF indices, in the order of the result; by default all. None and [] select no DOFs, as in
                OpenRAVE.

        Returns:
            A copy of the values [rad; m for sliders], shape (dof,), in the order of the joints in the file.

        Raises:
            IndexError: there is no such DOF.

        Example:
            >>> robot.SetDOFValues([0.5, -0.5])
            >>> robot.GetDOFValues()
            array([ 0.5, -0.5])
            >>> robot.GetDOFValues([1])  # the second joint only
            array([-0.5])
        """
        with self._simulation.lock:
            values = self._state.kinematics.values()
        return values if indices is ... else values[checked_indices(indices, len(values))]

    def SetDOFValues(
        self,
        values: ArrayLike,
        dofindices: "ArrayLike | EllipsisType | None" = ...,
        checklimits: int = CheckLimitsAction.CheckLimits,
    ) -> None:
        """Set joint values, and move all links to the poses of forward kinematics.

        The body moves at once, without dynamics, and viewers show it.

        Args:
            values: Joint values [rad; m for sliders], one for each DOF or for each index. NaN keeps the value of a
                joint; [] with indices keeps all values.
            dofindices: The DOF indices that ``values`` refer to; by default all DOFs. With None, values beyond the
                number of DOFs are ignored.
            checklimits: What to do with values outside the limits, a ``CheckLimitsAction``: by default they are
                moved to the limit with a warning. Circular joints have no limits.

        Raises:
            ArgumentError: the number of values is wrong, or one is infinite; with ``CheckLimitsThrow``, one is outside
                its limits. The body does not move.
            IndexError: there is no such DOF.

        Example:
            >>> robot.SetDOFValues([3.14 / 4, 3.14 / 4])
            >>> robot.SetDOFValues([1.57], [1])  # the second joint only
        """
        lock = self._simulation.lock
        try:
            lock.acquire()  # not in a ``with`` block, which takes twice as long; no method is called more often
            state = self._state
            kinematics = state.kinematics
            if (
                (dofindices is ... or dofindices is None)
                and type(values) is np.ndarray
                and values.dtype is FLOAT
                and values.ndim == 1
                and len(values) == kinematics.dof
            ):
                target = values
            elif dofindices is not None and dofindices is not ... and not np.size(values):
                checked_indices(dofindices, kinematics.dof, "dofindices")
                target = None  # random-api-145
            else:
                target = full_values(state.scene, kinematics, values, dofindices)
            if target is not None:
                if not kinematics.limits.contain(target):
                    target = settled_values(state.scene, kinematics, target, checklimits)
                state.will_move()
                kinematics.set_values(target, clamp_mimic=checklimits != _UNLIMITED)
                state.carry()
        except BaseException:
            lock.release_if_held()
            raise
        lock.release()

    @property
    def qpos_indices(self) -> Ints:
        """The index of each DOF in MuJoCo's ``qpos``, shape (dof,); -1 for the DOF of a weld.

        Raises:
            openrave_exception: the body is not in an environment.
        """
        with self._simulation.lock:
            if not self._simulation.holds(self._state):
                message = f"qpos_indices: '{self._state.scene.name}' is not in an environment; add it first"
                raise RavemjError(message, ErrorCode.NotInitialized)
            return self._simulation.compiled().qpos_indices(self._state)

    def GetTransform(self) -> Floats:
        """Return the pose of the body, which is the pose of its first link.

        Returns:
            A copy of ``T_world_link0``, shape (4, 4); the identity for a body without links.

        Example:
            >>> position = robot.GetTransform()[:3, 3]
            >>> x_axis = robot.GetTransform()[:3, 0]
        """
        with self._simulation.lock:
            return self._state.link_transform(0) if self._state.scene.links else np.eye(4)

    def GetTransformPose(self) -> Floats:
        """Return the body's pose as [w, x, y, z, tx, ty, tz]: unit quaternion and position [m], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def SetTransform(self, transform: ArrayLike) -> None:
        """Move the whole body. Joint values stay as they are.

        Grabbed bodies move along. A body outside of an environment can be moved as well.

        Args:
            transform: ``T_world_link0``, the new pose of the first link: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].

        Raises:
            ArgumentError: the transform is not rigid. The body does not move.

        Example:
            >>> T = body.GetTransform()
            >>> T[0:3, 3] = [1, 0, 0.5]
            >>> body.SetTransform(T)
        """
        checked = checked_transform(transform, "SetTransform: transform")
        with self._simulation.lock:
            self._state.set_transform(checked)

    def SetTransformWithDOFValues(
        self, transform: ArrayLike, values: ArrayLike, checklimits: int = CheckLimitsAction.CheckLimits
    ) -> None:
        """Set the pose of the first link and the joint values at once.

        Args:
            transform: ``T_world_link0``, as ``SetTransform`` takes it.
            values: Joint values [rad or m], shape (dof,).
            checklimits: As in ``SetDOFValues``.

        Raises:
            openrave_exception: the number of values is wrong. The body does not move.
        """
        checked = checked_transform(transform, "SetTransformWithDOFValues: transform")
        if np.size(values) != self.GetDOF():
            message = f"SetTransformWithDOFValues: there are {np.size(values)} values for {self.GetDOF()} DOFs"
            raise RavemjError(message, ErrorCode.Failed)
        with self._simulation.lock:
            self.SetDOFValues(values, None, checklimits)
            self._state.set_transform(checked)

    SetTransformWithJointValues = SetTransformWithDOFValues

    @overload
    def GetLinkTransformations(self, returndoflastvlaues: Literal[False] = False) -> list[Floats]: ...
    @overload
    def GetLinkTransformations(self, returndoflastvlaues: Literal[True]) -> tuple[list[Floats], Floats]: ...
    def GetLinkTransformations(self, returndoflastvlaues: bool = False) -> list[Floats] | tuple[list[Floats], Floats]:
        """Return the poses of all links in the world.

        Args:
            returndoflastvlaues: Whether to return the joint values as well, as ``SetLinkTransformations`` takes them
                (the spelling is OpenRAVE's). Those of sliders are 0, since poses determine them.

        Returns:
            ``T_world_link`` of shape (4, 4) for each link, in the order of ``GetLinks()``; copies.
        """
        with self._simulation.lock:
            transforms = list(self._state.link_transforms())
            if not returndoflastvlaues:
                return transforms
            slides = [joint.kind == "slider" for joint in self._state.scene.joints for _ in joint.axes]
            return transforms, np.where(slides, 0.0, self._state.kinematics.values())  # random-api-102

    def SetLinkTransformations(
        self, transforms: Sequence[ArrayLike], doflastsetvalues: ArrayLike | None = None
    ) -> None:
        """Set the pose of every link. Joints then have the values that fit the poses.

        Args:
            transforms: ``T_world_link`` for each link, in the order of ``GetLinks()``: 4x4, 3x4 or
                [w, x, y, z, tx, ty, tz] each.
            doflastsetvalues: Joint values as ``GetLinkTransformations(True)`` returns them, shape (dof,). A pose
                determines the angle of a hinge up to full turns; the hinge gets the angle nearest to this value, or by
                default nearest to its current value.

        Raises:
            openrave_exception: the number of poses differs from the number of links, a pose is not rigid, or joint
                values are given for a body outside of an environment. The body does not move.
        """
        count = len(self._state.scene.links)
        if len(transforms) != count:
            message = f"SetLinkTransformations: there are {len(transforms)} transforms, and should be {count}"
            raise RavemjError(message)
        checked = checked_transforms(transforms, "SetLinkTransformations: transforms")
        last = None
        if doflastsetvalues is not None and np.size(doflastsetvalues):
            last = checked_vector(doflastsetvalues, self.GetDOF(), "SetLinkTransformations: doflastsetvalues")
        with self._simulation.lock:
            self._state.place_links(checked, last)

    def link_transforms(self) -> Floats:
        """Return the poses of all links in one array, faster than ``GetLinkTransformations``.

        Returns:
            A copy of ``T_world_link`` in the order of ``GetLinks()``, shape (links, 4, 4).
        """
        with self._simulation.lock:
            return self._state.link_transforms()

    def GetUpdateStamp(self) -> int:
        """Return a counter that increases with every change of pose."""
        return self._state.stamp

    def GetConfigurationSpecification(self, interpolation: str = "") -> ConfigurationSpecification:
        """Return the layout of the body's configuration: its joint values, then its pose.

        Args:
            interpolation: The interpolation between waypoints, for instance ``linear``.
        """
        groups = body_groups(self._state.scene.name, range(self.GetDOF()), DOFAffine.Transform, interpolation)
        return ConfigurationSpecification.of(groups)

    def GetConfigurationSpecificationIndices(
        self, indices: ArrayLike, interpolation: str = ""
    ) -> ConfigurationSpecification:
        """Return the layout of the values of some joints.

        Args:
            indices: The DOF indices, in the order of the values.
            interpolation: The interpolation between waypoints, for instance ``linear``.

        Raises:
            ArgumentError: there is no such DOF.
        """
        chosen = checked_whole_numbers(indices, "indices").tolist()
        if any(not 0 <= index < self.GetDOF() for index in chosen):
            raise ArgumentError(f"indices: are {chosen}, and should be from 0 to {self.GetDOF() - 1}")
        return ConfigurationSpecification.of(body_groups(self._state.scene.name, chosen, 0, interpolation))

    def GetConfigurationValues(self) -> Floats:
        """Return the joint values, then the pose (x, y, z, qw, qx, qy, qz), shape (dof + 7,)."""
        with self._simulation.lock:
            return configuration_values(self.GetDOFValues(), self.GetTransform())

    def SetConfigurationValues(self, values: ArrayLike, checklimits: int = CheckLimitsAction.CheckLimits) -> None:
        """Set the joint values and the pose.

        Args:
            values: Joint values and pose as ``GetConfigurationValues`` returns them, shape (dof + 7,).
            checklimits: What to do with joint values outside the limits, as in ``SetDOFValues``.

        Raises:
            ArgumentError: the number of values is wrong.
        """
        joint_values, pose = split_configuration(checked_numbers(values, "values"), self.GetDOF())
        self.SetTransformWithDOFValues(pose.matrix(), joint_values, checklimits)

    def GetDOFVelocities(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the joint velocities, which follow from the velocities of the links.

        Args:
            indices: The DOF indices, in the order of the result; by default all. None and [] select no DOFs, as in
                OpenRAVE.

        Returns:
            A copy of the velocities [rad/s; m/s for sliders], shape (dof,).

        Raises:
            IndexError: there is no such DOF.
        """
        with self._simulation.lock:
            velocities = self._state.dynamics.dof_velocities(self._state.present_velocities)
        return velocities if indices is ... else velocities[checked_indices(indices, len(velocities))]

    def SetDOFVelocities(
        self,
        dofvelocities: ArrayLike,
        linear: "ArrayLike | None" = None,
        angular: "ArrayLike | None" = None,
        checklimits: int = CheckLimitsAction.CheckLimits,
        indices: "ArrayLike | None" = None,
    ) -> None:
        """Set the joint velocities. They determine the velocities of the links and of grabbed bodies.

        OpenRAVE has three forms: ``(dofvelocities)``, ``(dofvelocities, checklimits, indices)`` and
        ``(dofvelocities, linear, angular, checklimits)``. In the first two the base keeps its velocity.

        Args:
            dofvelocities: Velocities [rad/s; m/s for sliders], one for each DOF or for each index; without indices,
                further numbers are ignored.
            linear: The velocity of the first link's origin in world axes [m/s], shape (3,). A single number is taken as
                ``checklimits``.
            angular: The angular velocity of the first link in world axes [rad/s], shape (3,). If ``linear`` is a single
                number, this is taken as ``indices``.
            checklimits: What to do with values outside the velocity limits, a ``CheckLimitsAction``.
            indices: The DOF indices that ``dofvelocities`` refer to; by default all. ravemj repeats an error of
                OpenRAVE here: with k indices, only the first k DOFs are set; those not in ``indices`` keep their
                velocities. All other DOFs stop, even those in ``indices``. So pass all DOFs.

        Raises:
            ArgumentError: the number of velocities is wrong, or one is infinite; with ``CheckLimitsThrow``, one is
                outside its limits. The velocities do not change.
            IndexError: there is no such DOF.

        Example:
            >>> robot.SetDOFVelocities([0.5, -0.2])
            >>> robot.GetLinkVelocities()[2]
        """
        if linear is not None and np.ndim(linear) == 0:
            checklimits, indices = int(np.asarray(linear)), angular if indices is None else indices
            linear = angular = None
        with self._simulation.lock:
            velocities = self._state.link_velocities()
            base = np.zeros(6) if not len(velocities) else velocities[0]
            if linear is not None:
                base[:3] = checked_point(linear, "SetDOFVelocities: linear")
            if angular is not None:
                base[3:] = checked_point(angular, "SetDOFVelocities: angular")
            rates = full_velocities(self._state, dofvelocities, indices)
            rates = limited_velocities(self._state.scene, self.GetDOFVelocityLimits(), rates, checklimits)
            if len(velocities):
                self._state.set_link_velocities(self._state.dynamics.link_velocities(rates, base))

    def GetLinkVelocities(self) -> Floats:
        """Return the velocities of all links, in world axes.

        Returns:
            For each link the velocity of its origin [m/s], then its angular velocity [rad/s], shape (links, 6).
        """
        with self._simulation.lock:
            return self._state.link_velocities()

    def SetLinkVelocities(self, velocities: ArrayLike) -> None:
        """Set the velocities of all links, in world axes. The velocities of DOFs follow from the differences.

        Args:
            velocities: For each link the velocity of its origin [m/s], then its angular velocity [rad/s], shape
                (links, 6).

        Raises:
            ArgumentError: the shape is wrong, or a number is not finite. The velocities do not change.
        """
        shape = (len(self._state.scene.links), 6)
        checked = checked_numbers(velocities, "SetLinkVelocities")
        if checked.shape != shape or not np.isfinite(checked).all():
            raise ArgumentError(f"SetLinkVelocities: has shape {checked.shape}, and should be finite, of shape {shape}")
        with self._simulation.lock:
            self._state.set_link_velocities(checked)

    def SetVelocity(self, linear: ArrayLike, angular: ArrayLike) -> bool:
        """Set the velocity of the whole body, with its joints at rest.

        Args:
            linear: The velocity of the first link's origin in world axes [m/s], shape (3,).
            angular: The angular velocity in world axes [rad/s], shape (3,).

        Returns:
            False for a body without links.
        """
        moved = checked_vector(linear, 3, "SetVelocity: linear")
        turned = checked_vector(angular, 3, "SetVelocity: angular")
        if not self._state.scene.links:
            return False
        with self._simulation.lock:
            self._state.set_velocity(moved, turned)
        return True

    def GetCenterOfMass(self) -> Floats:
        """Return the body's centre of mass in the world [m], shape (3,)."""
        with self._simulation.lock:
            return self._state.inertias.center_of_mass(self._state.link_transforms())

    def com_jacobian(self) -> Floats:
        """Return the Jacobian of the body's centre of mass.

        Returns:
            The derivative of ``GetCenterOfMass()`` with respect to the DOF values, in world axes, shape (3, dof).
        """
        with self._simulation.lock:
            return self._state.dynamics.com_jacobian()

    def ComputeJacobianTranslation(
        self, linkindex: int, position: ArrayLike, indices: "ArrayLike | None" = None
    ) -> Floats:
        """Return the Jacobian of the position of a point on a link.

        Args:
            linkindex: Index of the link.
            position: The point in the world [m], shape (3,).
            indices: The DOF indices of the columns; None and [] select all. As in OpenRAVE, an index that is not a DOF
                gives a column of zeros.

        Returns:
            The derivative of the point's position with respect to the DOF values, in world axes, shape (3, dof).

        Raises:
            ArgumentError: there is no such link, or the point is not three finite numbers.

        Example:
            >>> tip = robot.GetLink("Arm1").GetTransform()[0:3, 3]
            >>> robot.ComputeJacobianTranslation(2, tip) @ robot.GetDOFVelocities()  # the tip's velocity
        """
        point, link = checked_point(position, "position"), self._checked_link(linkindex)
        lock = self._simulation.lock
        try:
            lock.acquire()  # as in ``SetDOFValues``
            jacobian = self._state.dynamics.translation_jacobian(link, point)
        except BaseException:
            lock.release_if_held()
            raise
        lock.release()
        return jacobian if indices is None else _columns(jacobian, indices)

    def ComputeJacobianAxisAngle(self, linkindex: int, indices: "ArrayLike | None" = None) -> Floats:
        """Return the Jacobian of a link's angular velocity.

        Args:
            linkindex: Index of the link.
            indices: The DOF indices of the columns, as in ``ComputeJacobianTranslation``.

        Returns:
            The derivative of the angular velocity with respect to the DOF velocities, in world axes, shape (3, dof).
        """
        link = self._checked_link(linkindex)
        with self._simulation.lock:
            jacobian = self._state.dynamics.rotation_jacobian(link)
        return jacobian if indices is None else _columns(jacobian, indices)

    def jacobians(
        self,
        links: ArrayLike,
        points: ArrayLike | None = None,
        indices: ArrayLike | None = None,
        *,
        base: bool = False,
    ) -> Floats:
        """Return the Jacobians of points on several links in one array, with one MuJoCo call per point.

        Args:
            links: Indices of the links, shape (k,).
            points: A point of each link in the world [m], shape (k, 3); by default the links' origins.
            indices: The DOF indices of the columns, each of an existing DOF; by default all.
            base: Whether six more columns follow: the velocity of the origin of the body's first link [m/s] and its
                angular velocity [rad/s], both in world axes.

        Returns:
            Shape (k, 6, columns). The first three rows are ``ComputeJacobianTranslation``, the others
            ``ComputeJacobianAxisAngle``, in world axes.

        Raises:
            ArgumentError: there is no such link, or the points are not finite or not as many as the links.
            IndexError: there is no such DOF.

        Example:
            >>> feet = [robot.GetLink(name).GetIndex() for name in ("LFoot", "RFoot")]
            >>> robot.jacobians(feet, base=True).shape
            (2, 6, 31)
        """
        chosen = [self._checked_link(link) for link in checked_whole_numbers(links, "links").tolist()]
        dofs = None if indices is None else checked_indices(indices, self.GetDOF(), "indices")
        given = None if points is None else np.ascontiguousarray(checked_rows(points, 3, "points"))
        if given is not None and len(given) != len(chosen):
            raise ArgumentError(f"points: are {len(given)}, and should be {len(chosen)}, one for each link")
        with self._simulation.lock:
            return self._state.dynamics.jacobians(chosen, given, dofs, base=base)

    def CalculateJacobian(self, linkindex: int, position: ArrayLike) -> Floats:
        """Return ``ComputeJacobianTranslation`` for all DOFs; older name.

        Args:
            linkindex: Index of the link.
            position: A point in the world [m], shape (3,).
        """
        return self.ComputeJacobianTranslation(linkindex, position)

    def CalculateAngularVelocityJacobian(self, linkindex: int) -> Floats:
        """Return ``ComputeJacobianAxisAngle(linkindex)`` for all DOFs, shape (3, dof); older name."""
        return self.ComputeJacobianAxisAngle(linkindex)

    def CalculateRotationJacobian(self, linkindex: int, quat: ArrayLike) -> Floats:
        """Return the Jacobian of a quaternion fixed to a link.

        Args:
            linkindex: Index of the link.
            quat: The quaternion [w, x, y, z]: the orientation of the link, or of anything fixed to it.

        Returns:
            The derivative of the quaternion with respect to the DOF values, shape (4, dof).
        """
        rates = wxyz_jacobian(checked_vector(quat, 4, "quat").tolist())
        return rates.dot(self.ComputeJacobianAxisAngle(linkindex))  # faster than @ for small matrices

    def ComputeHessianTranslation(
        self, linkindex: int, position: ArrayLike, indices: "ArrayLike | None" = None
    ) -> Floats:
        """Return the Hessian of the position of a point on a link.

        Args:
            linkindex: Index of the link.
            position: The point in the world [m], shape (3,).
            indices: The DOF indices, as in ``ComputeJacobianTranslation``.

        Returns:
            Shape (dof, 3, dof): ``[i, :, j]`` is the second derivative with respect to DOFs i and j. Contracted twice
            with the joint velocities, it is the velocity-dependent part of the point's acceleration.
        """
        return _both_columns(self._hessian(linkindex, position)[0], indices)

    def ComputeHessianAxisAngle(self, linkindex: int, indices: "ArrayLike | None" = None) -> Floats:
        """Return the derivatives of the Jacobian of a link's angular velocity, in OpenRAVE's symmetric form.

        Args:
            linkindex: Index of the link.
            indices: The DOF indices, as in ``ComputeJacobianTranslation``.

        Returns:
            Shape (dof, 3, dof): ``[i, :, j]`` is the derivative of the Jacobian's column j with respect to DOF i, plus
            that of column i with respect to DOF j. Contracted twice with the joint velocities, it is twice the
            velocity-dependent part of the angular acceleration.
        """
        derivatives = self._hessian(linkindex, np.zeros(3))[1]
        return _both_columns(derivatives + derivatives.transpose(2, 1, 0), indices)

    def _hessian(self, link: int, point: ArrayLike) -> tuple[Floats, Floats]:
        checked = self._checked_link(link), checked_vector(point, 3, "position")
        with self._simulation.lock:
            return self._state.dynamics.hessian(*checked)

    def GetLinkAccelerations(
        self, dofaccelerations: "ArrayLike | None", externalaccelerations: "Mapping[int, ArrayLike] | None" = None
    ) -> Floats:
        """Return the accelerations of the links for the current values and velocities, without gravity.

        A root link has no angular acceleration; its origin has the acceleration ``w x v``, the cross product of its
        angular and linear velocities. OpenRAVE's accelerations of mimic joints are wrong; ravemj's are correct.

        Args:
            dofaccelerations: Accelerations of the DOFs [rad/s^2; m/s^2 for sliders], shape (dof,); further numbers are
                ignored. None and [] stand for zeros.
            externalaccelerations: Additional accelerations of root links: link index to [linear, angular], six numbers
                in world axes.

        Returns:
            For each link the acceleration of its origin [m/s^2], then its angular acceleration [rad/s^2], in world
            axes, shape (links, 6).
        """
        accelerations = self._checked_accelerations(dofaccelerations, "GetLinkAccelerations")
        pushes = self._checked_pushes(externalaccelerations, "externalaccelerations")
        with self._simulation.lock:
            return self._state.dynamics.link_accelerations(self._state.present_velocities, accelerations, pushes)

    @overload
    def ComputeInverseDynamics(
        self,
        dofaccelerations: "ArrayLike | None",
        externalforcetorque: "Mapping[int, ArrayLike] | None" = None,
        returncomponents: Literal[False] = False,
    ) -> Floats: ...
    @overload
    def ComputeInverseDynamics(
        self,
        dofaccelerations: "ArrayLike | None",
        externalforcetorque: "Mapping[int, ArrayLike] | None" = None,
        *,
        returncomponents: Literal[True],
    ) -> tuple[Floats, Floats, Floats]: ...
    @overload
    def ComputeInverseDynamics(
        self,
        dofaccelerations: "ArrayLike | None",
        externalforcetorque: "Mapping[int, ArrayLike] | None",
        returncomponents: Literal[True],
    ) -> tuple[Floats, Floats, Floats]: ...
    def ComputeInverseDynamics(
        self,
        dofaccelerations: "ArrayLike | None",
        externalforcetorque: "Mapping[int, ArrayLike] | None" = None,
        returncomponents: bool = False,
    ) -> Floats | tuple[Floats, Floats, Floats]:
        """Return the joint torques that produce given accelerations.

        The torques are those for the current values and velocities, including the velocity of the base, and for the
        environment's gravity. They include the inertia of rotors and the friction of motors.

        OpenRAVE divides the forces of sliders by 2 pi, omits a part of the load of mimic joints, and does not support
        spherical joints. ravemj computes all of them correctly.

        Args:
            dofaccelerations: Accelerations [rad/s^2; m/s^2 for sliders], shape (dof,); further numbers are ignored.
                None and [] stand for zeros.
            externalforcetorque: External forces: link index to [force, torque], six numbers [N, N m] in world axes, at
                the link's centre of mass. As in OpenRAVE they are loads that the joints exert on the links, so an
                external push has the opposite sign.
            returncomponents: Whether to return the three components.

        Returns:
            Torques [N m; N for sliders], shape (dof,). As components, three such arrays that add up to the torques:
            those of the accelerations (``M qdd``), those of the joint velocities (Coriolis and centrifugal forces), and
            those of gravity, external forces and the velocity of the base.

        Raises:
            openrave_exception: a passive joint is neither a weld nor a mimic joint (``Assert``), so the torques of DOFs
                do not determine its motion. ``batch_inverse_dynamics`` treats it as fixed.

        Example:
            >>> robot.ComputeInverseDynamics([0, 0])  # torques that hold the robot against gravity
            >>> inertia, coriolis, gravity = robot.ComputeInverseDynamics([1, 0], None, True)
        """
        accelerations = self._checked_accelerations(dofaccelerations, "ComputeInverseDynamics")
        pushes = self._checked_pushes(externalforcetorque, "externalforcetorque")
        state, simulation = self._state, self._simulation
        lock = simulation.lock
        try:
            lock.acquire()  # as in ``SetDOFValues``
            dynamics = state.dynamics
            if dynamics.free_joint is not None:  # random api-5000-92; graph-5000-102 where it closes a loop
                raise _undetermined(dynamics.free_joint)
            needed = dynamics.inverse_components if returncomponents else dynamics.inverse
            torques = needed(state.present_velocities, accelerations, simulation.gravity, pushes)
        except BaseException:
            lock.release_if_held()
            raise
        lock.release()
        return torques

    def _checked_accelerations(self, accelerations: "ArrayLike | None", name: str) -> Floats:
        dof = self._state.dof
        if type(accelerations) is np.ndarray and accelerations.shape == (dof,):  # the usual case, and a cheap test
            return finite_vector(accelerations, dof, name)
        given = checked_numbers([] if accelerations is None else accelerations, f"{name}: dofaccelerations")
        if not given.size:
            return np.zeros(dof)
        if given.size < dof:
            raise IndexError(f"{name}: dofaccelerations: there are {given.size} for {dof} DOFs")
        return checked_first(given, dof, name)

    def _checked_pushes(self, pushes: "Mapping[int, ArrayLike] | None", name: str) -> dict[int, Floats]:
        if pushes is None:
            return {}
        checked_kind(pushes, (dict, Mapping), name, "a dictionary")  # dict first: a test against an ABC is slow
        return {self._checked_link(link): finite_vector(push, 6, name) for link, push in pushes.items()}

    def batch_link_transforms(self, values: ArrayLike, out: Floats | None = None) -> Floats:
        """Return the poses of all links for many configurations, several times faster than a loop.

        Joint limits are ignored, except those of mimic joints.

        Args:
            values: Joint values [rad; m for sliders], shape (N, dof).
            out: An array for the result, float64, shape (N, links, 4, 4); by default a new one.

        Returns:
            ``T_world_link`` in the order of ``GetLinks()``, shape (N, links, 4, 4).

        Raises:
            ArgumentError: a shape is wrong, or a value is not finite.

        Example:
            >>> lower, upper = robot.GetDOFLimits()
            >>> Q = numpy.random.uniform(lower, upper, (100_000, robot.GetDOF()))
            >>> tips = robot.batch_link_transforms(Q)[:, -1, :3, 3]
        """
        checked = checked_rows(values, self.GetDOF(), "values")
        result = _checked_out(out, (len(checked), len(self._state.scene.links), 4, 4))
        with self._simulation.lock:
            self._state.batch.link_transforms(checked, result)
        return result

    def batch_jacobians(
        self, values: ArrayLike, linkindex: int, position_in_link: ArrayLike, out: Floats | None = None
    ) -> Floats:
        """Return the Jacobians of a link for many configurations.

        Args:
            values: Joint values [rad; m for sliders], shape (N, dof).
            linkindex: Index of the link.
            position_in_link: The point of the link, in the link frame [m], shape (3,).
            out: An array for the result, float64, shape (N, 6, dof); by default a new one.

        Returns:
            Shape (N, 6, dof): the first three rows are ``ComputeJacobianTranslation``, the others
            ``ComputeJacobianAxisAngle``.

        Raises:
            ArgumentError: a shape is wrong, there is no such link, or a value is not finite.
        """
        checked = checked_rows(values, self.GetDOF(), "values")
        link = self._checked_link(linkindex)
        point = checked_vector(position_in_link, 3, "position_in_link")
        result = _checked_out(out, (len(checked), 6, self.GetDOF()))
        with self._simulation.lock:
            self._state.batch.jacobians(checked, link, point, result)
        return result

    def batch_inverse_dynamics(
        self, values: ArrayLike, velocities: ArrayLike, accelerations: ArrayLike, out: Floats | None = None
    ) -> Floats:
        """Return ``ComputeInverseDynamics`` for many values, velocities and accelerations, with the base at rest.

        Args:
            values: Joint values [rad; m for sliders], shape (N, dof).
            velocities: Joint velocities [rad/s or m/s], shape (N, dof).
            accelerations: Joint accelerations [rad/s^2 or m/s^2], shape (N, dof).
            out: An array for the result, float64, shape (N, dof); by default a new one.

        Returns:
            Torques [N m; N for sliders], shape (N, dof).

        Raises:
            ArgumentError: a shape is wrong, or a value is not finite.
        """
        given = {"values": values, "velocities": velocities, "accelerations": accelerations}
        checked = [checked_rows(numbers, self.GetDOF(), name) for name, numbers in given.items()]
        if len({len(numbers) for numbers in checked}) > 1:
            raise ArgumentError(
                f"values, velocities and accelerations have {[len(numbers) for numbers in checked]} rows; "
                f"give the same number of each"
            )
        result = _checked_out(out, checked[0].shape)
        with self._simulation.lock:
            state, gravity = self._state, np.array(self._simulation.gravity)
            state.batch.inverse_dynamics(checked[0], checked[1], checked[2], state.inertias, gravity, result)
        return result

    def batch_collides(self, values: ArrayLike, itself_too: bool = True) -> NDArray[np.bool_]:
        """Return for each configuration whether the body collides.

        Args:
            values: The joint values of the configurations [rad or m], shape (n, dof); limits are not checked.
            itself_too: Whether to test self-collisions.

        Returns:
            Whether the body collides, shape (n,). Afterwards the configuration of the body is restored. Options,
            geometry groups and callbacks of collision checkers have no effect, here and in the other ``batch_``
            methods.

        Example:
            >>> lower, upper = robot.GetDOFLimits()
            >>> samples = np.random.uniform(lower, upper, (1000, robot.GetDOF()))
            >>> free = samples[~robot.batch_collides(samples)]
        """
        rows = checked_rows(values, self.GetDOF(), "batch_collides: values")
        with self._simulation.lock:
            return batch_collides(self._state, rows, Among(itself=itself_too))

    def batch_self_collides(self, values: ArrayLike) -> NDArray[np.bool_]:
        """Return for each configuration whether the body collides with itself or its grabbed bodies.

        Args:
            values: The joint values of the configurations [rad or m], shape (n, dof); limits are not checked.

        Returns:
            Whether links of the body or its grabbed bodies collide with each other, shape (n,).
        """
        rows = checked_rows(values, self.GetDOF(), "batch_self_collides: values")
        with self._simulation.lock:
            return batch_collides(self._state, rows, Among(others=False))

    def batch_distances(self, values: ArrayLike, itself_too: bool = False) -> Floats:
        """Return for each configuration the distance between the body and the other bodies.

        Args:
            values: The joint values of the configurations [rad or m], shape (n, dof); limits are not checked.
            itself_too: Whether to include the distances of the link pairs of self-collision tests.

        Returns:
            The least distance [m], negative if geometries overlap, infinite if there are no other geometries, shape
            (n,). Afterwards the configuration of the body is restored.

        Example:
            >>> clearance = robot.batch_distances(trajectory_values).min()
        """
        rows = checked_rows(values, self.GetDOF(), "batch_distances: values")
        with self._simulation.lock:
            return batch_distances(self._state, rows, Among(itself=itself_too))


def _undetermined(joint: str) -> RavemjError:
    message = f"joint '{joint}' has no DOF and mimics no other, so no torques determine its motion"
    return RavemjError(f"ComputeInverseDynamics: {message}; batch_inverse_dynamics takes it as fixed", ErrorCode.Assert)


def _columns(jacobian: Floats, indices: "ArrayLike | None") -> Floats:
    """Return the columns of a Jacobian for DOF indices, along its last axis; zeros for an invalid index."""
    if indices is None:
        return jacobian
    chosen = checked_whole_numbers(indices, "indices")
    if not chosen.size:
        return jacobian
    count, plain = jacobian.shape[-1], chosen.tolist()
    if min(plain) >= 0 and max(plain) < count:
        return jacobian.take(chosen, -1)
    known = (chosen >= 0) & (chosen < count)
    columns = np.zeros((*jacobian.shape[:-1], len(chosen)))
    columns[..., known] = jacobian[..., chosen[known]]
    return columns


def _both_columns(hessian: Floats, indices: "ArrayLike | None") -> Floats:
    """Return the columns of a Hessian for DOF indices, along its first and last axis; see ``_columns``."""
    return hessian if indices is None else _columns(_columns(hessian, indices).T, indices).T


def _checked_out(out: Floats | None, shape: tuple[int, ...]) -> Floats:
    if out is None:
        return np.empty(shape)
    if out.shape != shape or out.dtype != np.float64:
        raise ArgumentError(f"out: has shape {out.shape} and numbers {out.dtype}, and should be float64 of {shape}")
    return out

"""The configuration of a body (joint values and pose) and its velocities."""

from collections.abc import Sequence
from types import EllipsisType
from typing import Literal, overload

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import (
    FLOAT,
    checked_indices,
    checked_numbers,
    checked_point,
    checked_transform,
    checked_transforms,
    checked_vector,
)
from ravemj.core.transforms import Floats, Ints, pose_of
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions import DOFAffine
from ravemj.rave.body.given_values import full_values, full_velocities, limited_velocities, settled_values
from ravemj.rave.body.limits import Limits
from ravemj.rave.enums import CheckLimitsAction
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.trajectories.bodies import body_groups, configuration_values, split_configuration

_UNLIMITED = int(CheckLimitsAction.Nothing)  # looking up a member of an enum takes as long as placing a pendulum


class Configuration(Limits):
    """Joint values, the poses of the body and of its links, and velocities.

    Velocities move nothing without physics, but accelerations and inverse dynamics depend on them. As in OpenRAVE, the
    body stores the velocities of its links, and computes those of the DOFs from them. So set joint values first, then
    velocities.
    """

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
            values: Joint values [rad; m for sliders], one for each DOF or for each index. NaN leaves a joint as it is;
                [] with indices leaves all joints as they are.
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
            lock.acquire()  # without ``with``, which takes twice as long, since nothing is called more often
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
                checked_indices(dofindices, kinematics.dof)
                target = None  # random-api-145
            else:
                target = full_values(state.scene, kinematics, values, dofindices)
            if target is not None:
                if not kinematics.limits.contain(target):
                    target = settled_values(state.scene, kinematics, target, checklimits)
                kinematics.set_values(target, clamp_mimic=checklimits != _UNLIMITED)
                state.moved()
        except BaseException:
            lock.release_if_held()
            raise
        lock.release()

    @property
    def qpos_indices(self) -> Ints:
        """The index of each DOF in MuJoCo's ``qpos``, shape (dof,); -1 for the DOF of a weld."""
        with self._simulation.lock:
            return self._simulation.compiled().qpos_indices(self._state)

    def GetTransform(self) -> Floats:
        """Return the pose of the body, which is that of its first link.

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
        """Return a number that grows with every change of pose."""
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
        chosen = checked_numbers(indices, "indices").astype(np.int_).tolist()
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
            indices: The DOF indices that ``dofvelocities`` refer to; by default all. OpenRAVE has a mistake here that
                ravemj repeats: with k indices, only the first k DOFs count. Those of them that no index names keep
                their velocities, and all other DOFs stop. So name all DOFs.

        Raises:
            ArgumentError: the number of velocities is wrong, or one is infinite; with ``CheckLimitsThrow``, one is
                outside its limits. The velocities stay as they were.
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
            ArgumentError: the shape is wrong, or a number is not finite. The velocities stay as they were.
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

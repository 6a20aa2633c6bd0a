"""The configuration of a body, joint values and poses, and its velocities."""

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
    """Joint values, the poses of the body and its links, both as one vector with its specification, and velocities.

    Velocities move nothing, but accelerations and inverse dynamics depend on them. The body keeps the velocities of its
    links and computes those of the DOFs from them, as OpenRAVE does. So set joint values first, then velocities.
    """

    def GetDOFValues(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the joint values.

        Args:
            indices: Which DOFs, in which order; left out: all. None and [] are no DOFs, as in OpenRAVE.

        Returns:
            Values [rad, for sliders m] in DOF order: that of the joints in the file, shape (dof,); a copy.

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
        """Set joint values and place all links by them: forward kinematics.

        The body moves at once, without dynamics, and viewers show it.

        Args:
            values: Joint values [rad, for sliders m], as many as there are DOFs, or as there are indices. NaN leaves
                a joint as it is, and [] with indices all of them.
            dofindices: Which DOFs to set, in which order; left out: all. With None further values do not count.
            checklimits: What to do with values outside the limits, a ``CheckLimitsAction``: by default they are
                moved to the limit with a warning. Circular joints have no limits.

        Raises:
            ArgumentError: the number of values is wrong or one is infinite; with ``CheckLimitsThrow``, one is outside
                its limits. Nothing has changed then.
            IndexError: there is no such DOF.

        Example:
            >>> robot.SetDOFValues([3.14 / 4, 3.14 / 4])
            >>> robot.SetDOFValues([1.57], [1])  # the second joint only
        """
        lock = self._simulation.lock
        lock.acquire()  # without ``with``, which takes twice as long, since nothing is called more often
        try:
            state = self._state
            kinematics = state.kinematics
            if (
                (dofindices is ... or dofindices is None)
                and type(values) is np.ndarray
                and values.dtype is FLOAT
                and values.shape == (kinematics.dof,)
            ):
                target = values
            elif dofindices is not None and dofindices is not ... and not np.size(values):
                checked_indices(dofindices, kinematics.dof)
                return  # random-api-145
            else:
                target = full_values(state.scene, kinematics, values, dofindices)
            if not kinematics.limits.contain(target):
                target = settled_values(state.scene, kinematics, target, checklimits)
            kinematics.set_values(target, clamp_mimic=checklimits != _UNLIMITED)
            state.moved()
        finally:
            lock.release()

    @property
    def qpos_indices(self) -> Ints:
        """Where each DOF is in MuJoCo's ``qpos``, shape (dof,); -1 for the DOF of a weld."""
        with self._simulation.lock:
            return self._simulation.compiled().qpos_indices(self._state)

    def GetTransform(self) -> Floats:
        """Return the body's pose: that of its first link, not of the file's origin.

        Returns:
            ``T_world_link0``, shape (4, 4); a copy. The identity for a body without links.

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
        """Move the whole body rigidly; joint values stay as they are.

        What the body holds moves along. A body that is not in the environment can be moved as well.

        Args:
            transform: ``T_world_link0``, the new pose of the first link: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].

        Raises:
            ArgumentError: this is no rigid transform. Nothing has moved then.

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
            openrave_exception: there are too few or too many values. Nothing has changed then.
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
            returndoflastvlaues: Whether to return the joint values, too, as ``SetLinkTransformations`` takes them
                (the spelling is OpenRAVE's). Those of sliders are 0, since poses show them without.

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
        """Put every link at a pose; joints get the values that the poses show.

        Args:
            transforms: ``T_world_link`` for each link, in the order of ``GetLinks()``: 4x4, 3x4 or 7 numbers each.
            doflastsetvalues: Joint values as ``GetLinkTransformations(True)`` returns them, shape (dof,): poses look
                alike full turns apart, and each hinge gets the value next to this one; left out: next to its present
                one.

        Raises:
            openrave_exception: there are more or fewer poses than links, one is not rigid, or joint values are given
                and the body is not in the environment. Nothing has moved then.
        """
        count = len(self._state.scene.links)
        if len(transforms) != count:
            message = f"SetLinkTransformations: there are {len(transforms)} transforms, and should be {count}"
            raise RavemjError(message)
        checked = np.array([checked_transform(one, "SetLinkTransformations: transforms") for one in transforms])
        last = None
        if doflastsetvalues is not None and np.size(doflastsetvalues):
            last = checked_vector(doflastsetvalues, self.GetDOF(), "SetLinkTransformations: doflastsetvalues")
        with self._simulation.lock:
            self._state.place_links(checked.reshape(-1, 4, 4), last)

    def link_transforms(self) -> Floats:
        """Return the poses of all links in one array: the fast form of ``GetLinkTransformations``.

        Returns:
            ``T_world_link`` in the order of ``GetLinks()``, shape (links, 4, 4); a copy.
        """
        with self._simulation.lock:
            return self._state.link_transforms()

    def GetUpdateStamp(self) -> int:
        """Return a number that grows with every change of pose."""
        return self._state.stamp

    def GetConfigurationSpecification(self, interpolation: str = "") -> ConfigurationSpecification:
        """Return the specification of the body's configuration: its joint values, then its pose.

        Args:
            interpolation: How they change between waypoints, for instance ``linear``.
        """
        groups = body_groups(self._state.scene.name, range(self.GetDOF()), DOFAffine.Transform, interpolation)
        return ConfigurationSpecification.of(groups)

    def GetConfigurationSpecificationIndices(
        self, indices: ArrayLike, interpolation: str = ""
    ) -> ConfigurationSpecification:
        """Return the specification of the values of some joints.

        Args:
            indices: Which DOFs, in which order.
            interpolation: How they change between waypoints, for instance ``linear``.

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
            values: As ``GetConfigurationValues`` returns them, shape (dof + 7,).
            checklimits: As for ``SetDOFValues``.

        Raises:
            ArgumentError: there are more or fewer values.
        """
        joint_values, pose = split_configuration(checked_numbers(values, "values"), self.GetDOF())
        self.SetTransformWithDOFValues(pose.matrix(), joint_values, checklimits)

    def GetDOFVelocities(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the joint velocities that the velocities of the links show.

        Args:
            indices: Which DOFs, in which order; left out: all. None and [] are no DOFs, as in OpenRAVE.

        Returns:
            Velocities [rad/s, for sliders m/s], shape (dof,); a copy.

        Raises:
            IndexError: there is no such DOF.
        """
        with self._simulation.lock:
            velocities = self._state.dynamics.dof_velocities(self._state.link_velocities())
        return velocities if indices is ... else velocities[checked_indices(indices, len(velocities))]

    def SetDOFVelocities(
        self,
        dofvelocities: ArrayLike,
        linear: "ArrayLike | None" = None,
        angular: "ArrayLike | None" = None,
        checklimits: int = CheckLimitsAction.CheckLimits,
        indices: "ArrayLike | None" = None,
    ) -> None:
        """Set the joint velocities: the links get the velocities that follow, and so does what they hold.

        OpenRAVE has three forms: ``(dofvelocities)``, ``(dofvelocities, checklimits, indices)`` and
        ``(dofvelocities, linear, angular, checklimits)``. In the first two the base keeps its velocity.

        Args:
            dofvelocities: Velocities [rad/s, for sliders m/s], as many as there are DOFs, or as there are indices;
                without indices further numbers do not count.
            linear: Velocity of the first link's origin in the world [m/s], shape (3,); a number is ``checklimits``.
            angular: Angular velocity of the first link in the world [rad/s], shape (3,); behind a number it is
                ``indices``.
            checklimits: What to do with values outside the velocity limits, a ``CheckLimitsAction``.
            indices: Which DOFs, in which order; None: all. As in OpenRAVE only the first DOFs count, as many as there
                are indices: of them those that are not chosen keep their velocities, and all others stop. So name all.

        Raises:
            ArgumentError: the number of velocities is wrong or one is infinite; with ``CheckLimitsThrow``, one is
                outside its limits. Nothing has changed then.
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
            For each link that of its origin [m/s] and the angular one [rad/s], shape (links, 6); a copy.
        """
        with self._simulation.lock:
            return self._state.link_velocities()

    def SetLinkVelocities(self, velocities: ArrayLike) -> None:
        """Set the velocities of all links, in world axes; those of the DOFs follow from the differences.

        Args:
            velocities: For each link that of its origin [m/s] and the angular one [rad/s], shape (links, 6).

        Raises:
            ArgumentError: the shape is wrong, or something is infinite. Nothing has changed then.
        """
        shape = (len(self._state.scene.links), 6)
        checked = checked_numbers(velocities, "SetLinkVelocities")
        if checked.shape != shape or not np.isfinite(checked).all():
            raise ArgumentError(f"SetLinkVelocities: has shape {checked.shape}, and should be finite, of shape {shape}")
        with self._simulation.lock:
            self._state.set_link_velocities(checked)

    def SetVelocity(self, linear: ArrayLike, angular: ArrayLike) -> bool:
        """Let the whole body move as one, with its joints at rest.

        Args:
            linear: Velocity of the first link's origin in the world [m/s], shape (3,).
            angular: Angular velocity in the world [rad/s], shape (3,).

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

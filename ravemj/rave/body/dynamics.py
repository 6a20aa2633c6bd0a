"""Jacobians and dynamics of a body, for its configuration and for many configurations at once."""

from collections.abc import Mapping
from typing import Literal, overload

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import (
    checked_first,
    checked_numbers,
    checked_point,
    checked_rows,
    checked_vector,
    checked_whole_numbers,
    finite_vector,
)
from ravemj.core.transforms import Floats, wxyz_jacobian
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.body.limits import Limits


class Dynamics(Limits):
    """Jacobians, Hessians, accelerations and inverse dynamics.

    Methods whose names begin with ``batch_`` take arrays of joint values, and do not move the body. Besides the result
    they need little memory, whatever the number of configurations is. If the result itself is too large, pass the
    joint values in parts, or an ``out`` that lies on disk (``numpy.memmap``).
    """

    def GetCenterOfMass(self) -> Floats:
        """Return the body's centre of mass in the world [m], shape (3,)."""
        with self._simulation.lock:
            return self._state.inertias.center_of_mass(self._state.link_transforms())

    def com_jacobian(self) -> Floats:
        """Return the Jacobian of the body's centre of mass.

        Returns:
            The derivative of ``GetCenterOfMass()`` by the DOF values, in world axes, shape (3, dof).
        """
        with self._simulation.lock:
            return self._state.dynamics.com_jacobian()

    def ComputeJacobianTranslation(
        self, linkindex: int, position: ArrayLike, indices: "ArrayLike | None" = None
    ) -> Floats:
        """Return the Jacobian of the position of a link's point.

        Args:
            linkindex: Index of the link.
            position: The point in the world [m], shape (3,).
            indices: The DOF indices of the columns; None and [] select all. As in OpenRAVE, an index that is not a DOF
                gives a column of zeros.

        Returns:
            The derivative of the point's position by the DOF values, in world axes, shape (3, dof).

        Raises:
            ArgumentError: there is no such link, or the point is not three finite numbers.

        Example:
            >>> tip = robot.GetLink("Arm1").GetTransform()[0:3, 3]
            >>> robot.ComputeJacobianTranslation(2, tip) @ robot.GetDOFVelocities()  # the tip's velocity
        """
        point, link = checked_point(position, "position"), self._checked_link(linkindex)
        with self._simulation.lock:
            jacobian = self._state.dynamics.translation_jacobian(link, point)
        return jacobian if indices is None else _columns(jacobian, indices)

    def ComputeJacobianAxisAngle(self, linkindex: int, indices: "ArrayLike | None" = None) -> Floats:
        """Return the Jacobian of a link's angular velocity.

        Args:
            linkindex: Index of the link.
            indices: The DOF indices of the columns, as in ``ComputeJacobianTranslation``.

        Returns:
            The derivative of the angular velocity by the DOF velocities, in world axes, shape (3, dof).
        """
        link = self._checked_link(linkindex)
        with self._simulation.lock:
            jacobian = self._state.dynamics.rotation_jacobian(link)
        return jacobian if indices is None else _columns(jacobian, indices)

    def CalculateJacobian(self, linkindex: int, position: ArrayLike) -> Floats:
        """Return ``ComputeJacobianTranslation`` for all DOFs; its older name.

        Args:
            linkindex: Index of the link.
            position: A point in the world [m], shape (3,).
        """
        return self.ComputeJacobianTranslation(linkindex, position)

    def CalculateAngularVelocityJacobian(self, linkindex: int) -> Floats:
        """Return ``ComputeJacobianAxisAngle(linkindex)``, for all DOFs, shape (3, dof); its older name."""
        return self.ComputeJacobianAxisAngle(linkindex)

    def CalculateRotationJacobian(self, linkindex: int, quat: ArrayLike) -> Floats:
        """Return the Jacobian of a quaternion that turns with a link.

        Args:
            linkindex: Index of the link.
            quat: The quaternion [w, x, y, z]: the orientation of the link, or of anything fixed to it.

        Returns:
            The derivative of the quaternion by the DOF values, shape (4, dof).
        """
        rates = wxyz_jacobian(checked_vector(quat, 4, "quat").tolist())
        return rates.dot(self.ComputeJacobianAxisAngle(linkindex))  # faster than @ for small matrices

    def ComputeHessianTranslation(
        self, linkindex: int, position: ArrayLike, indices: "ArrayLike | None" = None
    ) -> Floats:
        """Return the Hessian of the position of a link's point.

        Args:
            linkindex: Index of the link.
            position: The point in the world [m], shape (3,).
            indices: The DOF indices, as in ``ComputeJacobianTranslation``.

        Returns:
            Shape (dof, 3, dof): ``[i, :, j]`` is the second derivative by DOFs i and j. Contracted twice with the joint
            velocities, it is the velocity-dependent part of the point's acceleration.
        """
        return _both_columns(self._hessian(linkindex, position)[0], indices)

    def ComputeHessianAxisAngle(self, linkindex: int, indices: "ArrayLike | None" = None) -> Floats:
        """Return the derivatives of the Jacobian of a link's angular velocity, in OpenRAVE's symmetric form.

        Args:
            linkindex: Index of the link.
            indices: The DOF indices, as in ``ComputeJacobianTranslation``.

        Returns:
            Shape (dof, 3, dof): ``[i, :, j]`` is the derivative of the Jacobian's column j by DOF i plus that of
            column i by DOF j. Contracted twice with the joint velocities, it is twice the velocity-dependent part of
            the angular acceleration.
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

        A root link keeps its angular velocity, and its origin accelerates by ``w x v``. OpenRAVE computes wrong
        accelerations for mimic joints; ravemj does not.

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

        OpenRAVE divides the forces of sliders by 2 pi, leaves out a part of the load of mimic joints, and refuses
        spherical joints. ravemj computes all of them correctly.

        Args:
            dofaccelerations: Accelerations [rad/s^2; m/s^2 for sliders], shape (dof,); further numbers are ignored.
                None and [] stand for zeros.
            externalforcetorque: External forces: link index to [force, torque], six numbers [N, N m] in world axes, at
                the link's centre of mass. As in OpenRAVE they count as loads that the joints exert on the links, so
                a push from outside has the opposite sign.
            returncomponents: Whether to return the three components.

        Returns:
            Torques [N m; N for sliders], shape (dof,). As components, three such arrays that add up to the torques:
            those of the accelerations (``M qdd``), those of the joint velocities (Coriolis and centrifugal forces), and
            those of gravity, external forces and the velocity of the base.

        Raises:
            openrave_exception: a passive joint is neither a weld nor a mimic joint (``Assert``), so torques of DOFs do
                not determine its motion. ``batch_inverse_dynamics`` takes it as fixed.

        Example:
            >>> robot.ComputeInverseDynamics([0, 0])  # torques that hold the robot against gravity
            >>> inertia, coriolis, gravity = robot.ComputeInverseDynamics([1, 0], None, True)
        """
        accelerations = self._checked_accelerations(dofaccelerations, "ComputeInverseDynamics")
        pushes = self._checked_pushes(externalforcetorque, "externalforcetorque")
        for joint in self._state.scene.passive_joints:
            if joint.mimic is None and not joint.static:  # random api-5000-92; graph-5000-102 where it closes a loop
                message = f"joint '{joint.name}' has no DOF and mimics no other, so no torques determine its motion"
                raise RavemjError(
                    f"ComputeInverseDynamics: {message}; batch_inverse_dynamics takes it as fixed", ErrorCode.Assert
                )
        with self._simulation.lock:
            state, gravity = self._state, self._simulation.gravity
            if returncomponents:
                return state.dynamics.inverse_components(state.present_velocities, accelerations, gravity, pushes)
            return state.dynamics.inverse(state.present_velocities, accelerations, gravity, pushes)

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

        Joint limits do not count, except that mimic joints stop at theirs.

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


def _columns(jacobian: Floats, indices: "ArrayLike | None") -> Floats:
    """Return columns of a Jacobian, along its last axis; zeros for an index that is not a DOF."""
    if indices is None:
        return jacobian
    chosen = checked_whole_numbers(indices, "indices")
    if not chosen.size:
        return jacobian
    count = jacobian.shape[-1]
    known = (chosen >= 0) & (chosen < count)
    columns = np.zeros((*jacobian.shape[:-1], len(chosen)))
    columns[..., known] = jacobian[..., chosen[known]]
    return columns


def _both_columns(hessian: Floats, indices: "ArrayLike | None") -> Floats:
    """Return columns of a Hessian, along its first and its last axis; see ``_columns``."""
    return hessian if indices is None else _columns(_columns(hessian, indices).T, indices).T


def _checked_out(out: Floats | None, shape: tuple[int, ...]) -> Floats:
    if out is None:
        return np.empty(shape)
    if out.shape != shape or out.dtype != np.float64:
        raise ArgumentError(f"out: has shape {out.shape} and numbers {out.dtype}, and should be float64 of {shape}")
    return out

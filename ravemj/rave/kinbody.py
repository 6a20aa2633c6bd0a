"""Bodies and robots."""

import warnings
from collections.abc import Sequence
from types import EllipsisType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.adjacency import adjacent_pairs
from ravemj.arrays import checked_numbers, checked_vector
from ravemj.errors import ArgumentError, Diagnostic, RavemjWarning
from ravemj.rave.configured import Configured
from ravemj.rave.enums import CheckLimitsAction, JointType
from ravemj.rave.geometry import Geometry
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link
from ravemj.simulation import BodyState
from ravemj.transforms import Floats, Ints

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

ROUNDING = 2e-10
"""How far outside its limits [rad or m] OpenRAVE moves a value without a warning."""


class KinBody(Configured):
    """A body: links connected by joints. ``env.GetBodies()`` makes it.

    Example:
        >>> body.GetDOF()
        2
        >>> body.SetDOFValues([0.5, -0.5])
        >>> body.GetLink("Arm1").GetTransform()
    """

    CheckLimitsAction = CheckLimitsAction
    Geometry = Geometry
    Joint = Joint
    JointType = JointType
    Link = Link

    def __init__(self, env: "Environment", state: BodyState) -> None:
        self._env = env
        self._state = state
        self._simulation = state.simulation

    def GetName(self) -> str:
        """Return the body's name, unique in its environment."""
        return self._state.scene.name

    def GetEnv(self) -> "Environment":
        """Return the environment that the body is in."""
        return self._env

    def IsRobot(self) -> bool:
        """Return whether the body is a robot."""
        return self._state.scene.is_robot

    def GetDOF(self) -> int:
        """Return the number of degrees of freedom: the joint axes that ``SetDOFValues`` sets.

        Passive joints are not counted.
        """
        return len(self._state.scene.dof_axes)

    def GetDOFValues(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the joint values.

        Args:
            indices: Which DOFs, in which order; left out: all. None and [] are no DOFs, as in OpenRAVE.

        Returns:
            Values [rad, for sliders m] in DOF order: that of the joints in the file, shape (dof,); a copy.

        Raises:
            IndexError: there is no such DOF.
        """
        with self._simulation.lock:
            values = self._state.kinematics.values()
        return values if indices is ... else values[_checked_indices(indices, len(values))]

    def SetDOFValues(
        self,
        values: ArrayLike,
        dofindices: "ArrayLike | None" = None,
        checklimits: int = CheckLimitsAction.CheckLimits,
    ) -> None:
        """Set joint values and place all links by them: forward kinematics.

        It happens at once, without dynamics; viewers show it.

        Args:
            values: Joint values [rad, for sliders m], as many as there are DOFs, or as there are indices. NaN leaves
                a joint as it is.
            dofindices: Which DOFs to set, in which order; None: all.
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
        with self._simulation.lock:
            kinematics = self._state.kinematics
            target = self._full_values(values, dofindices)
            if not kinematics.within_limits(target.tolist()):
                target = self._settled(target, checklimits)
            kinematics.set_values(target, limit_followers=checklimits != CheckLimitsAction.Nothing)

    def _full_values(self, values: ArrayLike, dofindices: "ArrayLike | None") -> Floats:
        """Return one value for each DOF, in DOF order."""
        given = checked_numbers(values, "SetDOFValues")
        dof = self._state.kinematics.dof
        if dofindices is None:
            if given.shape != (dof,) and dof:
                raise ArgumentError(
                    f"SetDOFValues: values has shape {given.shape}, and '{self.GetName()}' has {dof} DOFs: give {dof} "
                    f"numbers, or dofindices"
                )
            return given[:dof]
        indices = _checked_indices(dofindices, dof)
        if given.ndim != 1 or len(given) < len(indices):
            raise ArgumentError(f"SetDOFValues: values has shape {given.shape} for {len(indices)} dofindices")
        full = self._state.kinematics.values()
        full[indices] = given[: len(indices)]
        return full

    def _settled(self, target: Floats, checklimits: int) -> Floats:
        """Replace NaN by the present values and, as ``checklimits`` says, values outside the limits."""
        kinematics = self._state.kinematics
        if np.isinf(target).any():
            raise ArgumentError(f"SetDOFValues: values are {target}, and should be finite")
        target = np.where(np.isnan(target), kinematics.values(), target)
        if checklimits == CheckLimitsAction.Nothing:
            return target
        limited = np.where(kinematics.circular, target, np.clip(target, kinematics.lower, kinematics.upper))
        outside = np.flatnonzero(np.abs(target - limited) > ROUNDING)
        if len(outside) and checklimits != CheckLimitsAction.CheckLimitsSilent:
            self._report_limits(target, outside[0], checklimits)
        return limited

    def _report_limits(self, target: Floats, dof: np.intp, checklimits: int) -> None:
        kinematics = self._state.kinematics
        joint = self.GetJointFromDOFIndex(int(dof))
        source = self._state.scene.joints[joint.GetJointIndex()].source
        limits = f"[{kinematics.lower[dof]:.6g}, {kinematics.upper[dof]:.6g}]"
        message = f"joint '{joint.GetName()}' is set to {target[dof]:.6g}, outside its limits {limits}"
        if checklimits == CheckLimitsAction.CheckLimitsThrow:
            raise ArgumentError(message)
        diagnostic = Diagnostic("warning", "value-outside-limits", f"{message}; it stops at the limit", source)
        warnings.warn(RavemjWarning(diagnostic), stacklevel=4)

    def GetDOFLimits(self, indices: "ArrayLike | EllipsisType | None" = ...) -> tuple[Floats, Floats]:
        """Return the joint limits.

        Args:
            indices: Which DOFs, in which order; left out: all.

        Returns:
            Lower and upper limits [rad or m], each of shape (dof,); ±10000 for circular joints.
        """
        axes = self._state.scene.dof_axes
        lower, upper = np.array([axis.lower for axis in axes]), np.array([axis.upper for axis in axes])
        if indices is ...:
            return lower, upper
        chosen = _checked_indices(indices, len(axes))
        return lower[chosen], upper[chosen]

    def GetTransform(self) -> Floats:
        """Return the body's pose: that of its first link, not of the file's origin.

        Returns:
            ``T_world_link0``, shape (4, 4); a copy.
        """
        with self._simulation.lock:
            return self._state.kinematics.link_transform(0)

    def GetLinkTransformations(self) -> list[Floats]:
        """Return the poses of all links in the world.

        Returns:
            ``T_world_link`` of shape (4, 4) for each link, in the order of ``GetLinks()``; copies.
        """
        with self._simulation.lock:
            return list(self._state.kinematics.link_transforms())

    def GetLinks(self, indices: Sequence[int] | None = None) -> list[Link]:
        """Return the links in the order of the file; the first one is the root.

        Args:
            indices: Which links; None: all.
        """
        links = [Link(self, self._state, index) for index in range(len(self._state.scene.links))]
        return links if indices is None else [links[index] for index in indices]

    def GetLink(self, name: str) -> Link | None:
        """Return the link of that name, or None."""
        return next((link for link in self.GetLinks() if link.GetName() == name), None)

    def GetJoints(self, indices: Sequence[int] | None = None) -> list[Joint]:
        """Return the joints that have DOFs, in DOF order.

        Args:
            indices: Which joints; None: all.
        """
        joints = [Joint(self, self._state, index) for index in range(len(self._state.scene.joints))]
        return joints if indices is None else [joints[index] for index in indices]

    def GetPassiveJoints(self) -> list[Joint]:
        """Return the joints that have no DOF."""
        body = self._state.scene
        first = len(body.joints)
        return [Joint(self, self._state, index) for index in range(first, first + len(body.passive_joints))]

    def GetJoint(self, name: str) -> Joint | None:
        """Return the joint of that name, passive or not, or None."""
        joints = (*self.GetJoints(), *self.GetPassiveJoints())
        return next((joint for joint in joints if joint.GetName() == name), None)

    def GetJointFromDOFIndex(self, dofindex: int) -> Joint:
        """Return the joint that a DOF belongs to.

        Args:
            dofindex: Position in the vectors of DOF values.

        Raises:
            IndexError: there is no such DOF.
        """
        _checked_indices(dofindex, self.GetDOF())
        return next(joint for joint in reversed(self.GetJoints()) if joint.GetDOFIndex() <= dofindex)

    def GetAdjacentLinks(self) -> set[tuple[int, int]]:
        """Return the pairs of links, by index, that self-collision leaves out."""
        return adjacent_pairs(self._state.scene)

    def GetCenterOfMass(self) -> Floats:
        """Return the body's centre of mass in the world [m], shape (3,)."""
        links = self._state.scene.links
        masses = np.array([link.inertial.mass for link in links])
        local = np.array([(*link.inertial.com, 1.0) for link in links])
        with self._simulation.lock:
            transforms = self._state.kinematics.link_transforms()
        return masses @ np.einsum("nij,nj->ni", transforms, local)[:, :3] / masses.sum()

    def GetDOFVelocities(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the joint velocities.

        Args:
            indices: Which DOFs, in which order; left out: all.

        Returns:
            Velocities [rad/s, for sliders m/s], shape (dof,); a copy.
        """
        velocities = self._state.dynamics.velocities.copy()
        return velocities if indices is ... else velocities[_checked_indices(indices, len(velocities))]

    def SetDOFVelocities(
        self,
        dofvelocities: ArrayLike,
        linear: "ArrayLike | int" = 0,
        angular: "ArrayLike | None" = None,
        checklimits: int = CheckLimitsAction.CheckLimits,
    ) -> None:
        """Set the joint velocities. Nothing moves by it; ``ComputeInverseDynamics`` uses them.

        Args:
            dofvelocities: Velocities [rad/s, for sliders m/s], shape (dof,).
            linear: Velocity of the base [m/s], which has to be zero; as in OpenRAVE, a number here is ``checklimits``.
            angular: Angular velocity of the base [rad/s], which has to be zero.
            checklimits: What to do with values outside the velocity limits, a ``CheckLimitsAction``.

        Raises:
            ArgumentError: the number of velocities is wrong, one is infinite, or the base should move.
        """
        velocities = checked_vector(dofvelocities, self.GetDOF(), "SetDOFVelocities")
        if angular is None:
            checklimits = int(np.asarray(linear).reshape(-1)[0]) if np.ndim(linear) == 0 else checklimits
        elif np.any(linear) or np.any(angular):
            raise ArgumentError("SetDOFVelocities: the base cannot move here; give zeros")
        if checklimits != CheckLimitsAction.Nothing:
            limits = np.array([axis.max_velocity for axis in self._state.scene.dof_axes])
            if checklimits == CheckLimitsAction.CheckLimitsThrow and np.any(np.abs(velocities) > limits):
                raise ArgumentError(f"SetDOFVelocities: {velocities} are outside the limits {limits}")
            velocities = np.clip(velocities, -limits, limits)
        with self._simulation.lock:
            self._state.dynamics.velocities = velocities

    def ComputeJacobianTranslation(self, linkindex: int, position: ArrayLike) -> Floats:
        """Return how a point of a link moves with the joint values.

        Args:
            linkindex: Index of the link.
            position: The point, in world coordinates [m], shape (3,).

        Returns:
            Derivative of the point's position in the world by the DOF values, shape (3, dof).
        """
        return self._jacobian(linkindex, position)[0]

    def ComputeJacobianAxisAngle(self, linkindex: int) -> Floats:
        """Return how a link turns with the joint values.

        Args:
            linkindex: Index of the link.

        Returns:
            Angular velocity of the link, in world axes, per unit of DOF velocity, shape (3, dof).
        """
        return self._jacobian(linkindex, np.zeros(3))[1]

    def _jacobian(self, link: int, point: ArrayLike) -> tuple[Floats, Floats]:
        count = len(self._state.scene.links)
        if not 0 <= link < count:
            raise ArgumentError(f"linkindex is {link}, and should be from 0 to {count - 1}")
        with self._simulation.lock:
            return self._state.dynamics.jacobian(link, checked_vector(point, 3, "position"))

    def ComputeInverseDynamics(self, dofaccelerations: "ArrayLike | None") -> Floats:
        """Return the joint torques that accelerate the body as wanted, with its base at rest.

        At the present values and velocities, against the environment's gravity. Sliders give forces, and joints that
        others follow carry these too: where OpenRAVE errs about both, this is right.

        Args:
            dofaccelerations: Accelerations [rad/s^2, for sliders m/s^2], shape (dof,); None: none.

        Returns:
            Torques [N m, for sliders N], shape (dof,).
        """
        dof = self.GetDOF()
        wanted = np.zeros(dof) if dofaccelerations is None else dofaccelerations
        accelerations = checked_vector(wanted, dof, "ComputeInverseDynamics")
        with self._simulation.lock:
            return self._state.dynamics.inverse(accelerations)

    @property
    def simulation_state(self) -> BodyState:
        """The body below the OpenRAVE API: its scene and its kinematics."""
        return self._state

    @property
    def qpos_indices(self) -> Ints:
        """Where each DOF is in MuJoCo's ``qpos``, shape (dof,); -1 for the DOF of a weld."""
        return self._state.kinematics.qpos_indices.copy()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, KinBody) and self._state is other._state

    def __hash__(self) -> int:
        return hash(id(self._state))

    def __repr__(self) -> str:
        return f"{self._env!r}.Get{'Robot' if self.IsRobot() else 'KinBody'}('{self.GetName()}')"

    def __str__(self) -> str:
        kind = "robot" if self.IsRobot() else "body"
        return f"<{kind}:{self.GetName()}, dof={self.GetDOF()}, links={len(self._state.scene.links)}>"


def _checked_indices(indices: "ArrayLike | EllipsisType | None", dof: int) -> Ints:
    """Return DOF indices as an array; None stands for none."""
    checked = np.array([] if indices is None else indices, dtype=np.int_).reshape(-1)
    if checked.size and not (checked.min() >= 0 and checked.max() < dof):
        raise IndexError(f"DOF indices are {checked.tolist()}, and should be from 0 to {dof - 1}")
    return checked

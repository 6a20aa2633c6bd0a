"""Joints of a body."""

from typing import TYPE_CHECKING

import numpy as np

from ravemj import scene
from ravemj.following import leaders
from ravemj.manipulators import joint_dofs
from ravemj.rave.enums import JointType
from ravemj.rave.link import Link
from ravemj.simulation import BodyState
from ravemj.transforms import Floats, Ints, add, rotate, scale, wxyz_from_axis_angle

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class Joint:
    """A joint between two links; ``body.GetJoints()`` makes it."""

    Type = JointType

    def __init__(self, parent: "KinBody", state: BodyState, index: int) -> None:
        self._parent = parent
        self._state = state
        self._index = index

    @property
    def _scene(self) -> scene.Joint:
        body = self._state.scene
        return (*body.joints, *body.passive_joints)[self._index]

    @property
    def _is_active(self) -> bool:
        return self._index < len(self._state.scene.joints)

    def GetName(self) -> str:
        """Return the joint's name."""
        return self._scene.name

    def GetParent(self) -> "KinBody":
        """Return the body that the joint belongs to."""
        return self._parent

    def GetType(self) -> JointType:
        """Return the kind of joint."""
        return JointType[self._scene.kind.capitalize()]

    def IsMimic(self, axis: int = 0) -> bool:
        """Return whether an axis follows other joints."""
        return self._scene.mimic is not None and axis == 0

    def GetMimicEquation(self, axis: int = 0, itype: int = 0, format: str = "") -> str:  # OpenRAVE's names
        """Return how the joint follows others, as the file has it.

        Args:
            axis: Which axis; only the first one can follow.
            itype: 0 the position, 1 the partial derivatives for velocities, 2 those for accelerations.
            format: OpenRAVE's choice of notation; only the plain one is known here.

        Returns:
            The equation, with the names of joints; empty for a joint that follows none.
        """
        del format
        mimic = self._scene.mimic
        if mimic is None or axis != 0:
            return ""
        return (mimic.position, mimic.velocity, mimic.acceleration)[itype]

    def GetMimicDOFIndices(self, axis: int = 0) -> Ints:
        """Return the DOFs in the joint's own equation; as in OpenRAVE, not those of other followers in it."""
        mimic = self._scene.mimic
        if mimic is None or axis or mimic.expression is None:
            return np.array([], dtype=np.int_)
        active = [leader for leader in leaders(mimic.expression) if leader < len(self._state.scene.joints)]
        dofs = {dof for leader in active for dof in joint_dofs(self._state.scene, leader)}
        return np.array(sorted(dofs), dtype=np.int_)

    def GetJointIndex(self) -> int:
        """Return the joint's position in ``body.GetJoints()``; -1 for a passive joint."""
        return self._index if self._is_active else -1

    def GetDOFIndex(self) -> int:
        """Return the joint's first position in the vectors of DOF values; -1 for a passive joint."""
        if not self._is_active:
            return -1
        return sum(len(joint.axes) for joint in self._state.scene.joints[: self._index])

    def GetDOF(self) -> int:
        """Return the joint's number of axes, also of a passive joint."""
        return len(self._scene.axes)

    def GetValues(self) -> Floats:
        """Return the joint's values [rad or m], shape (axes,)."""
        with self._state.simulation.lock:
            if not self._is_active:
                return self._state.kinematics.passive_values(self._index - len(self._state.scene.joints))
            first = self.GetDOFIndex()
            return self._state.kinematics.values()[first : first + self.GetDOF()]

    def GetValue(self, axis: int = 0) -> float:
        """Return the joint's value about or along one of its axes [rad or m]."""
        return float(self.GetValues()[axis])

    def GetVelocities(self) -> Floats:
        """Return the joint's velocities [rad/s or m/s] that those of its links show, shape (axes,)."""
        with self._state.simulation.lock:
            return self._state.dynamics.joint_velocities(self._state.link_velocities(), [self._scene])[0]

    def GetVelocity(self, axis: int = 0) -> float:
        """Return the joint's velocity about or along one of its axes [rad/s or m/s]."""
        return float(self.GetVelocities()[axis])

    def GetLimits(self) -> tuple[Floats, Floats]:
        """Return the lower and the upper limits [rad or m], each of shape (axes,); ±10000 for a circular joint."""
        axes = self._scene.axes
        return np.array([axis.lower for axis in axes]), np.array([axis.upper for axis in axes])

    def GetWeights(self) -> Floats:
        """Return the weights in distances between configurations, shape (axes,)."""
        return np.array([axis.weight for axis in self._scene.axes])

    def GetResolution(self, axis: int = 0) -> float:
        """Return the step of planners [rad or m]."""
        return self._scene.axes[axis].resolution

    def GetMaxVel(self, axis: int = 0) -> float:
        """Return the velocity limit [rad/s or m/s]."""
        return self._scene.axes[axis].max_velocity

    def GetMaxAccel(self, axis: int = 0) -> float:
        """Return the acceleration limit [rad/s^2 or m/s^2]."""
        return self._scene.axes[axis].max_acceleration

    def GetMaxTorque(self, axis: int = 0) -> float:
        """Return the torque or force limit [N m or N]; 0 where the file says nothing."""
        return self._scene.axes[axis].max_torque

    def IsCircular(self, axis: int) -> bool:
        """Return whether the joint turns without end."""
        return self._scene.axes[axis].circular

    def IsStatic(self) -> bool:
        """Return whether the joint is a weld: its limits leave no room."""
        return self._scene.static

    def GetAnchor(self) -> Floats:
        """Return a point on the axis in the world, as the links stand now [m], shape (3,)."""
        anchor = self._scene.anchor
        if self._scene.kind == "slider":  # OpenRAVE's is that of the value 0
            axis = self._scene.axes[0]
            anchor = add(anchor, scale(axis.direction, -axis.reference))
        return self._T_world_parent() @ (*anchor, 1.0)

    def GetAxis(self, axis: int = 0) -> Floats:
        """Return the direction of an axis in the world, as the links stand now, shape (3,).

        The second axis of a ``Hinge2`` turns with the first.
        """
        direction = self._scene.axes[axis].direction
        if axis and self._scene.kind == "hinge2":
            first = self._scene.axes[0]
            turned = self.GetValues()[0] - first.reference
            direction = rotate(wxyz_from_axis_angle(first.direction, turned), direction)
        return self._T_world_parent()[:, :3] @ direction

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

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Joint) and self._state is other._state and self._index == other._index

    def __hash__(self) -> int:
        return hash((id(self._state), self._index))

    def __repr__(self) -> str:
        return f"{self._parent!r}.GetJoint('{self.GetName()}')"

    def __str__(self) -> str:
        place = f"({self.GetJointIndex()}), dof={self.GetDOFIndex()}"
        return f"<joint:{self.GetName()} {place}, parent={self._parent.GetName()}>"

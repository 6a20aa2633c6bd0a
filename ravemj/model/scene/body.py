"""Bodies, manipulators and attached sensors."""

from dataclasses import dataclass

from ravemj.core.transforms import Pose, Vec3
from ravemj.errors import Source
from ravemj.model.scene.mechanism import Axis, Joint, Link
from ravemj.model.scene.record import Record
from ravemj.model.scene.sensors import SENSOR_COLOR, Device, Intrinsics, sensor_kind


@dataclass(frozen=True, slots=True, eq=False, repr=False, kw_only=True)
class Manipulator(Record):
    """Arm of a robot.

    Attributes:
        name: Its name.
        base: Index of the base link, or None.
        effector: Index of the link that carries the tool, or None.
        T_effector_tool: Pose of the tool in the effector.
        direction: Direction of the tool, a unit vector in its own frame.
        arm_dofs: DOFs of the joints from base to effector.
        gripper_joints: Indices of the active joints of the gripper.
        gripper_dofs: DOFs of the gripper joints.
        chucking_direction: Closing sign of each gripper DOF: 1, 0 or -1.
        source: The element that it comes from.
        gripper_name: Name of the gripper's description; may be empty.
        ik_solver: Name of the IK solver that the file requests, and numbers for it; may be empty.
    """

    name: str
    base: int | None
    effector: int | None
    T_effector_tool: Pose
    direction: Vec3
    arm_dofs: tuple[int, ...]
    gripper_joints: tuple[int, ...]
    gripper_dofs: tuple[int, ...]
    chucking_direction: tuple[float, ...]
    source: Source
    gripper_name: str = ""
    ik_solver: str = ""


@dataclass(frozen=True, slots=True, eq=False, repr=False, kw_only=True)
class AttachedSensor(Record):
    """Sensor on a link.

    Attributes:
        name: Its name.
        link: Index of the link that carries it, or None.
        T_link_sensor: Its pose in the link.
        type: OpenRAVE's name of the sensor type, or None for a frame without a device.
        device: Its constant properties; None for a frame or an unknown type.
        source: The element that it comes from.
        is_on: Whether it measures from the start.
        color: Colour in which viewers draw it.
    """

    name: str
    link: int | None
    T_link_sensor: Pose
    type: str | None
    device: Device | None
    source: Source
    is_on: bool = False
    color: Vec3 = SENSOR_COLOR

    @property
    def camera(self) -> Intrinsics | None:
        """Camera parameters if the sensor is a camera, else None."""
        return self.device if isinstance(self.device, Intrinsics) else None

    def problem(self) -> str | None:
        """Return the reason why the device's properties do not allow measurements, or None."""
        kind = sensor_kind(self.type or "")
        if kind is None or self.device is None or self.device == kind.device:
            return None
        return self.device.problem()


@dataclass(frozen=True, slots=True, eq=False, repr=False, kw_only=True)
class Grab(Record):
    """Grabbed body.

    Attributes:
        body: Name of the grabbed body in the same scene.
        link: Index of the grabbing link.
        T_link_body: Pose of the body in the link.
        ignored: Indices of the grabbing body's links whose collisions with the grabbed one are ignored.
    """

    body: str
    link: int
    T_link_body: Pose
    ignored: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class NamedConfiguration(Record):
    """Named configuration from a file.

    Attributes:
        name: Its name.
        values: Values by joint name [rad or m]; other joints do not change.
    """

    name: str
    values: tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True, eq=False, repr=False, kw_only=True)
class KinBody(Record):
    """Body: links connected by joints.

    Attributes:
        name: Its name, unique in an environment.
        is_robot: True for a ``<Robot>``.
        links: Links in the order of their first appearance; link 0 is the root.
        joints: Active joints in DOF order.
        passive_joints: Joints without a DOF.
        adjacent: Pairs of link indices that ``<adjacent>`` names.
        joined_links_adjacent: Whether links that a joint connects count as adjacent.
        manipulators: Arms.
        has_active_manipulator: Whether the first manipulator is active; False for robots that OpenRAVE rejects.
        sensors: Sensors on links.
        grabs: The bodies that it has grabbed after loading.
        description: A text for people.
        element: Id of the body in a COLLADA file that has several; else empty.
        configurations: Named configurations: the group states of an SRDF.
        source: The element that it comes from.
    """

    name: str
    is_robot: bool
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    passive_joints: tuple[Joint, ...]
    adjacent: tuple[tuple[int, int], ...] = ()
    joined_links_adjacent: bool = True
    manipulators: tuple[Manipulator, ...] = ()
    has_active_manipulator: bool = True
    sensors: tuple[AttachedSensor, ...] = ()
    grabs: tuple[Grab, ...] = ()
    description: str = ""
    element: str = ""
    configurations: tuple[NamedConfiguration, ...] = ()
    source: Source

    @property
    def all_joints(self) -> tuple[Joint, ...]:
        """Active joints in DOF order, then passive ones: the order of joint indices."""
        return (*self.joints, *self.passive_joints)

    @property
    def referenced_links(self) -> set[int]:
        """Indices of the links referred to by joints, adjacent pairs, manipulators, sensors or grabs."""
        links = {link for joint in self.all_joints for link in (joint.parent, joint.child)}
        links |= {link for pair in self.adjacent for link in pair}
        links |= {
            link
            for manipulator in self.manipulators
            for link in (manipulator.base, manipulator.effector)
            if link is not None
        }
        links |= {sensor.link for sensor in self.sensors if sensor.link is not None}
        return links | {link for grab in self.grabs for link in (grab.link, *grab.ignored)}

    @property
    def dof_axes(self) -> tuple[Axis, ...]:
        """The axes of all active joints, in DOF order."""
        return tuple(axis for joint in self.joints for axis in joint.axes)

    @property
    def dof_names(self) -> list[str]:
        """The name of each DOF: that of its joint, with the axis if the joint has several."""
        return [
            joint.name + (f", axis {axis}" if len(joint.axes) > 1 else "")
            for joint in self.joints
            for axis in range(len(joint.axes))
        ]

    def joint_of_dof(self, dof: int) -> Joint:
        """Return the joint that a DOF belongs to."""
        return [joint for joint in self.joints for _ in joint.axes][dof]

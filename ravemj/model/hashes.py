"""Hashes of body structures, independent of world poses and limits, and of names except those of gripper joints."""

from collections.abc import Iterable
from dataclasses import fields, is_dataclass
from typing import cast

from ravemj.core.transforms import Pose
from ravemj.model.joints import directions_at, relative_pose
from ravemj.model.manipulators import chain
from ravemj.model.scene import Geometry, Joint, KinBody, Manipulator, Mesh

DIGITS = 4
"""Number of decimals to which numbers are rounded before hashing, as in OpenRAVE."""


def of_body(body: KinBody) -> str:
    """Return the hash of the links, their shapes and masses, and the joints: 32 hexadecimal digits."""
    return _digest(_structure(body), _masses(body))


def text_of_body(body: KinBody) -> str:
    """Return the text that ``of_body`` hashes."""
    return repr(_plain((_structure(body), _masses(body))))


def _structure(body: KinBody) -> tuple[object, ...]:
    return _links(body), [_joint(joint) for joint in body.all_joints]


def _masses(body: KinBody) -> list[object]:
    return [(link.inertial.mass, link.inertial.com, link.inertial.inertia) for link in body.links]


def of_robot(body: KinBody) -> str:
    """Return the hash of a robot with its manipulators and sensors; as in OpenRAVE, it does not depend on masses."""
    tools = [(_tool(arm), _gripper(body, arm)) for arm in body.manipulators]
    return _digest(
        _structure(body), tools, [(sensor.link, sensor.T_link_sensor, sensor.type) for sensor in body.sensors]
    )


def of_arm(body: KinBody, arm: Manipulator) -> str:
    """Return the hash of the joints between base and effector, and of the tool."""
    return _digest(_way(body, arm), _tool(arm))


def of_inverse_kinematics(body: KinBody, arm: Manipulator, kind: str, *, tool: bool, direction: bool) -> str:
    """Return the hash of all inputs of an IK solver for a goal type.

    ``tool`` and ``direction``: whether to include the tool pose in the effector, and the tool direction.
    """
    placed = (arm.T_effector_tool,) if tool else ()
    return _digest(kind, _way(body, arm), placed, (arm.direction,) if direction else ())


def of_manipulator(body: KinBody, arm: Manipulator) -> str:
    """Return the hash of a manipulator, including the gripper."""
    return _digest(of_arm(body, arm), _gripper(body, arm))


def _gripper(body: KinBody, arm: Manipulator) -> tuple[object, ...]:
    """Return names and closing directions of the gripper joints; OpenRAVE hashes no other joint names."""
    return [body.joints[index].name for index in arm.gripper_joints], arm.chucking_direction


def _way(body: KinBody, arm: Manipulator) -> list[object]:
    """Return hashable records of the joints between an arm's base and effector."""
    if arm.base is None or arm.effector is None:
        return []
    joints = (*body.joints, *body.passive_joints)
    return [_joint(joints[index]) for index in chain(body, arm.base, arm.effector) or []]


def _tool(arm: Manipulator) -> tuple[object, ...]:
    return arm.base, arm.effector, arm.T_effector_tool, arm.direction, arm.arm_dofs


def _links(body: KinBody) -> list[object]:
    """Return the shapes of each link; for roots of the kinematic tree also the pose relative to the first link."""
    placed = {joint.child for joint in body.all_joints if joint.places_child}
    entries: list[object] = []
    for index, link in enumerate(body.links):
        at_root = None if index in placed else body.links[0].T_world_link.inverse() @ link.T_world_link
        entries.append((at_root, [_geometry(geometry) for geometry in link.geometries]))
    return entries


def _geometry(geometry: Geometry) -> tuple[object, ...]:
    return type(geometry.shape).__name__, geometry.shape, geometry.T_link_geometry


def _joint(joint: Joint) -> tuple[object, ...]:
    rest = [0.0] * len(joint.axes)
    moves: tuple[object, ...] = ()
    if not joint.static:
        anchor = None if joint.kind == "slider" else joint.anchor
        directions = None if joint.kind == "spherical" else directions_at(joint, rest)
        moves = (anchor, directions, [axis.circular for axis in joint.axes])
    mimic = None if joint.mimic is None else joint.mimic.position
    return joint.kind, joint.parent, joint.child, relative_pose(joint, rest), moves, joint.places_child, mimic


def of_text(text: str) -> str:
    """Return the hash of a text: 32 hexadecimal digits."""
    import hashlib  # noqa: PLC0415 - slow to import

    return hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()


def _digest(*parts: object) -> str:
    return of_text(repr(_plain(parts)))


def _plain(part: object) -> object:
    """Convert a value for hashing: round numbers, and map equal poses or meshes to equal results."""
    if isinstance(part, float):
        return round(part, DIGITS) + 0.0  # no negative zero
    if isinstance(part, Mesh):
        return part.digest
    if isinstance(part, Pose):
        sign = 1.0 if next((component for component in part.wxyz if abs(component) > 10**-DIGITS), 1.0) > 0 else -1.0
        return [_plain(number) for number in (*part.position, *(sign * component for component in part.wxyz))]
    if isinstance(part, tuple | list):
        return [_plain(member) for member in cast("Iterable[object]", part)]
    if is_dataclass(part):
        return [_plain(getattr(part, field.name)) for field in fields(part)]
    return part

"""Summary of a body, as numbers and lists that JSON can hold."""

import math
from collections.abc import Sequence

from ravemj.model.scene import AttachedSensor, Axis, Geometry, Joint, KinBody, Link, Manipulator, TriMesh

Summary = dict[str, object]


def summarize(body: KinBody) -> Summary:
    """Return a body with its links, joints, manipulators and sensors; SI units, quaternions as w x y z.

    Links and DOFs are referred to by their numbers; a number that is not finite is None.
    """
    first_dofs = dof_starts(body)
    return {
        "name": body.name,
        "is_robot": body.is_robot,
        "mass": _finite(sum(link.inertial.mass for link in body.links)),
        "dof": len(body.dof_axes),
        "links": [_link(index, link) for index, link in enumerate(body.links)],
        "joints": [_joint(joint, first) for joint, first in zip(body.joints, first_dofs, strict=True)],
        "passive_joints": [_joint(joint, None) for joint in body.passive_joints],
        "manipulators": [_manipulator(manipulator) for manipulator in body.manipulators],
        "sensors": [sensor_summary(sensor) for sensor in body.sensors],
    }


def dof_starts(body: KinBody) -> list[int]:
    """Return the first DOF of each active joint."""
    starts: list[int] = []
    dof = 0
    for joint in body.joints:
        starts.append(dof)
        dof += len(joint.axes)
    return starts


def _link(index: int, link: Link) -> Summary:
    return {
        "index": index,
        "name": link.name,
        "mass": _finite(link.inertial.mass),
        "com": _finite(link.inertial.com),
        "inertia": _finite(link.inertial.inertia),
        "static": link.static,
        "enabled": link.enabled,
        "position": _finite(link.T_world_link.position),
        "quaternion": _finite(link.T_world_link.wxyz),
        "geometries": [_geometry(geometry) for geometry in link.geometries],
    }


def _geometry(geometry: Geometry) -> Summary:
    shape = geometry.shape
    if isinstance(shape, TriMesh):
        sizes: Summary = {"vertices": len(shape.mesh.vertices), "triangles": len(shape.mesh.triangles)}
    else:
        sizes = {size.name: _finite(getattr(shape, size.name)) for size in shape.sizes()}
    return {"type": type(shape).__name__.lower(), "name": geometry.name, **sizes, "visible": geometry.visible}


def _joint(joint: Joint, first_dof: int | None) -> Summary:
    return {
        "name": joint.name,
        "type": joint.kind,
        "dofs": [] if first_dof is None else list(range(first_dof, first_dof + len(joint.axes))),
        "parent": joint.parent,
        "child": joint.child,
        "static": joint.static,
        "closes_loop": not joint.places_child,
        "anchor": _finite(joint.anchor),
        "axes": [_axis(axis) for axis in joint.axes],
        "follows": None if joint.mimic is None else joint.mimic.position,
    }


def _axis(axis: Axis) -> Summary:
    return {
        "direction": _finite(axis.direction),
        "value": _finite(axis.value),
        "lower": None if axis.circular else _finite(axis.lower),
        "upper": None if axis.circular else _finite(axis.upper),
        "circular": axis.circular,
        "max_velocity": _finite(axis.max_velocity),
        "max_acceleration": _finite(axis.max_acceleration),
        "max_torque": _finite(axis.max_torque),
        "weight": _finite(axis.weight),
        "resolution": _finite(axis.resolution),
    }


def _manipulator(manipulator: Manipulator) -> Summary:
    return {
        "name": manipulator.name,
        "base": manipulator.base,
        "effector": manipulator.effector,
        "arm_dofs": list(manipulator.arm_dofs),
        "gripper_dofs": list(manipulator.gripper_dofs),
        "chucking_direction": _finite(manipulator.chucking_direction),
        "tool_position": _finite(manipulator.T_effector_tool.position),
        "tool_quaternion": _finite(manipulator.T_effector_tool.wxyz),
        "direction": _finite(manipulator.direction),
    }


def sensor_summary(sensor: AttachedSensor) -> Summary:
    """Return a sensor; one that no robot carries is on no link, and its pose is that in the world."""
    camera = sensor.camera
    names = ("fx", "fy", "cx", "cy", "width", "height")
    return {
        "name": sensor.name,
        "link": sensor.link,
        "type": sensor.type,
        "position": _finite(sensor.T_link_sensor.position),
        "quaternion": _finite(sensor.T_link_sensor.wxyz),
        "camera": None if camera is None else {name: _finite(getattr(camera, name)) for name in names},
    }


def _finite(value: float | Sequence[object]) -> object:
    """Return a number, or the numbers in nested tuples, as JSON has them: None for one that is not finite."""
    if isinstance(value, Sequence):
        return [_finite(part) for part in value]  # pyright: ignore[reportArgumentType]
    return value if math.isfinite(value) else None

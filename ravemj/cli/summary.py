"""Summary of a body as JSON data."""

import math
from collections.abc import Sequence
from typing import cast

from ravemj.model.scene import AttachedSensor, Axis, Geometry, Joint, KinBody, Link, Manipulator, TriMesh

Summary = dict[str, object]

_OF_AXES = (
    "direction", "value", "lower", "upper", "circular",
    "max_velocity", "max_acceleration", "max_torque", "weight", "resolution",
)  # fmt: skip
_OF_CAMERAS = ("fx", "fy", "cx", "cy", "width", "height")


def summarize(body: KinBody) -> Summary:
    """Return a body with its links, joints, manipulators and sensors; SI units, quaternions as w x y z.

    Links and DOFs are referred to by index; numbers that are not finite are None.
    """
    first_dofs = dof_starts(body)
    summary = {
        "name": body.name,
        "is_robot": body.is_robot,
        "mass": sum(link.inertial.mass for link in body.links),
        "dof": len(body.dof_axes),
        "links": [_link(index, link) for index, link in enumerate(body.links)],
        "joints": [_joint(joint, first) for joint, first in zip(body.joints, first_dofs, strict=True)],
        "passive_joints": [_joint(joint, None) for joint in body.passive_joints],
        "configurations": {named.name: dict(named.values) for named in body.configurations},
        "manipulators": [_manipulator(manipulator) for manipulator in body.manipulators],
        "sensors": [sensor_summary(sensor) for sensor in body.sensors],
    }
    return cast("Summary", _finite(summary))


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
        "mass": link.inertial.mass,
        "com": link.inertial.com,
        "inertia": link.inertial.inertia,
        "static": link.static,
        "enabled": link.enabled,
        "position": link.T_world_link.position,
        "quaternion": link.T_world_link.wxyz,
        "geometries": [_geometry(geometry) for geometry in link.geometries],
    }


def _geometry(geometry: Geometry) -> Summary:
    shape = geometry.shape
    if isinstance(shape, TriMesh):
        sizes: Summary = {"vertices": len(shape.mesh.vertices), "triangles": len(shape.mesh.triangles)}
    else:
        sizes = {size.name: getattr(shape, size.name) for size in shape.sizes()}
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
        "anchor": joint.anchor,
        "axes": [_axis(axis) for axis in joint.axes],
        "follows": None if joint.mimic is None else joint.mimic.position,
    }


def _axis(axis: Axis) -> Summary:
    summary: Summary = {name: getattr(axis, name) for name in _OF_AXES}
    return {**summary, "lower": None, "upper": None} if axis.circular else summary


def _manipulator(manipulator: Manipulator) -> Summary:
    return {
        "name": manipulator.name,
        "base": manipulator.base,
        "effector": manipulator.effector,
        "arm_dofs": list(manipulator.arm_dofs),
        "gripper_dofs": list(manipulator.gripper_dofs),
        "chucking_direction": manipulator.chucking_direction,
        "tool_position": manipulator.T_effector_tool.position,
        "tool_quaternion": manipulator.T_effector_tool.wxyz,
        "direction": manipulator.direction,
    }


def sensor_summary(sensor: AttachedSensor) -> Summary:
    """Summarize a sensor; without a robot it has no link, and its pose is in the world."""
    camera = sensor.camera
    summary = {
        "name": sensor.name,
        "link": sensor.link,
        "type": sensor.type,
        "position": sensor.T_link_sensor.position,
        "quaternion": sensor.T_link_sensor.wxyz,
        "camera": None if camera is None else {name: getattr(camera, name) for name in _OF_CAMERAS},
    }
    return cast("Summary", _finite(summary))


def _finite(value: object) -> object:
    """Convert a value to JSON data: infinite numbers and NaN to None, tuples to lists."""
    if isinstance(value, dict):
        return {name: _finite(part) for name, part in cast("Summary", value).items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in cast("Sequence[object]", value)]
    return None if isinstance(value, float) and not math.isfinite(value) else value

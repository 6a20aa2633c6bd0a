"""Descriptions of bodies and robots."""

# JSON and users put anything into the fields that the functions of forms take.
# pyright: reportUnknownLambdaType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownMemberType=false

# The fields have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform
from ravemj.core.enumerations import NamedFlag
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, Diagnostics, send_warnings
from ravemj.model import scene
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.infos.base import IdentifiedInfo, info_class, json_field
from ravemj.rave.infos.connected import ConnectedBodyInfo, GrabbedInfo
from ravemj.rave.infos.joint import JointInfo
from ravemj.rave.infos.json import POSE, TEXT, Form, infos
from ravemj.rave.infos.link import LinkInfo
from ravemj.rave.infos.robot import AttachedSensorInfo, GripperInfo, ManipulatorInfo

if TYPE_CHECKING:
    from ravemj.model.builder import BodyBuilder

T = TypeVar("T")

_NEAR = 1e-12  # the rounding of numbers that went through a file


class ExtractInfoOptions(NamedFlag):
    """Options of ``body.ExtractInfo``."""

    Everything = 0
    SkipDOFValues = 1
    """Leave out the joint values."""


_DOF_VALUES = Form(
    lambda values, scale: [
        {"jointName": name, "value": float(value)} | ({"jointAxis": axis} if axis else {})
        for (name, axis), value in values
    ],
    lambda items, scale, present: [((one["jointName"], one.get("jointAxis", 0)), one["value"]) for one in items],
)


@info_class
class KinBodyInfo(IdentifiedInfo):
    """The description of a body.

    Attributes:
        _name: The name of the body.
        _vLinkInfos: The links, a list of ``LinkInfo``.
        _vJointInfos: The joints, a list of ``JointInfo``. Joints with DOFs stand in DOF order.
        _transform: ``T_world_link0``. The identity leaves all links at the poses of their infos.
        _dofValues: Joint values that replace ``JointInfo._vcurrentvalues``: a list of ((name, axis), value).
        _isRobot: Whether the body is a robot.
    """

    _called = "KinBody.KinBodyInfo"

    _id: str | None = json_field("id", TEXT, default="", optional=True, kw_only=True)
    _name: str = json_field("name", TEXT, default="", optional=True)
    _vLinkInfos: Sequence[LinkInfo] = json_field("links", infos(LinkInfo), default=[], optional=True)
    _vJointInfos: Sequence[JointInfo] = json_field("joints", infos(JointInfo), default=[], optional=True)
    _vGrabbedInfos: Sequence[object] = json_field("grabbed", infos(GrabbedInfo), default=[], optional=True)
    _transform: ArrayLike = json_field("transform", POSE, default=np.eye(4))
    _dofValues: Sequence[tuple[tuple[str, int], float]] = json_field(
        "dofValues", _DOF_VALUES, default=[], optional=True
    )
    _isRobot: bool = json_field("isRobot", default=False)
    _uri: str = ""
    _referenceUri: str = json_field("referenceUri", TEXT, default="", optional=True)

    def transform(self) -> Floats | None:
        """Return ``T_world_link0``, or None if the links stay at the poses of their infos."""
        T_world_link0 = checked_transform(self._transform, "KinBodyInfo._transform")
        return None if np.array_equal(T_world_link0, np.eye(4)) else T_world_link0

    def same_structure(self, other: "KinBodyInfo") -> bool:
        """Return whether two infos describe the same links and joints; poses and joint values do not count."""
        return _alike(self._standing().SerializeJSON(), other._standing().SerializeJSON())

    def _standing(self) -> "KinBodyInfo":
        """Return a copy of the info without poses, joint values and held bodies."""
        links = [replace(link, _t=np.eye(4)) for link in self._vLinkInfos]
        joints = [replace(joint, _vcurrentvalues=None) for joint in self._vJointInfos]
        return replace(
            self, _vLinkInfos=links, _vJointInfos=joints, _transform=np.eye(4), _dofValues=[], _vGrabbedInfos=[]
        )

    def values_by_axis(self) -> dict[tuple[str, int], float]:
        """Return the joint values of ``_dofValues`` by joint name and axis."""
        return {(str(name), int(axis)): float(value) for (name, axis), value in self._dofValues}


@info_class
class RobotBaseInfo(KinBodyInfo):
    """The description of a robot.

    Attributes:
        _vManipInfos: The manipulators, a list of ``ManipulatorInfo``.
        _vAttachedSensorInfos: The sensors, a list of ``AttachedSensorInfo``.
        _vConnectedBodyInfos: The bodies that can be connected to the robot, a list of ``ConnectedBodyInfo``.
        _vGripperInfos: The grippers, a list of ``GripperInfo``.
    """

    _called = "Robot.RobotBaseInfo"

    _isRobot: bool = json_field("isRobot", default=True)
    _vManipInfos: Sequence[ManipulatorInfo] = json_field("tools", infos(ManipulatorInfo), default=[], optional=True)
    _vAttachedSensorInfos: Sequence[AttachedSensorInfo] = json_field(
        "attachedSensors", infos(AttachedSensorInfo), default=[], optional=True
    )
    _vConnectedBodyInfos: Sequence[ConnectedBodyInfo] = json_field(
        "connectedBodies", infos(ConnectedBodyInfo), default=[], optional=True
    )
    _vGripperInfos: Sequence[GripperInfo] = json_field("gripperInfos", infos(GripperInfo), default=[], optional=True)


def _alike(first: object, second: object) -> bool:
    """Return whether two JSON values are equal, with a tolerance for numbers that went through a file."""
    if first == second:
        return True
    if isinstance(first, dict) and isinstance(second, dict):
        return first.keys() == second.keys() and all(_alike(first[key], second[key]) for key in first)
    if isinstance(first, list) and isinstance(second, list):
        return len(first) == len(second) and all(map(_alike, first, second))
    if isinstance(first, float | int) and isinstance(second, float | int):
        return math.isclose(first, second, rel_tol=_NEAR, abs_tol=_NEAR)
    return False


def body_of(info: KinBodyInfo, like: scene.KinBody) -> scene.KinBody:
    """Make the body that an info describes.

    Args:
        info: The description.
        like: An existing body, which says whether to make a robot, and gives the name if the info has none.

    Raises:
        RavemjError: a list of the info contains an object of another class, two links share a name, or the links and
            joints do not make a body.
    """
    from ravemj.model.builder import BodyBuilder, SensorBuilder  # noqa: PLC0415 - slow to import

    builder = BodyBuilder(is_robot=like.is_robot, source=FROM_SCRIPT, name=info._name or like.name)
    for one in _checked(info._vLinkInfos, LinkInfo):
        builder.links.append(one.link())
    names = [link.name for link in builder.links]
    named = [name for name in names if name]
    if len(set(named)) < len(named):
        raise ArgumentError(f"the links are called {', '.join(names)}; each link needs a name of its own, or none")
    for index, one in enumerate(info._vLinkInfos):
        builder.adjacent += [(index, other) for other in one.adjacent(names)]
    builder.joints = [one.joint(builder.links) for one in _checked(info._vJointInfos, JointInfo)]
    diagnostics = Diagnostics()
    builder.joint_values = _asked(builder, info.values_by_axis(), diagnostics)
    if isinstance(info, RobotBaseInfo) and like.is_robot:
        builder.manipulators = [one.manipulator() for one in _checked(info._vManipInfos, ManipulatorInfo)]
        sensors = _checked(info._vAttachedSensorInfos, AttachedSensorInfo)
        builder.sensors = [SensorBuilder(one.sensor(names)) for one in sensors]
    body = builder.freeze(diagnostics)
    if builder.refusal is not None:
        raise builder.refusal
    send_warnings(diagnostics)
    return body


def _checked(infos: Sequence[T], kind: type[T]) -> Sequence[T]:
    for info in infos:
        if not isinstance(info, kind):  # what users hand in
            raise ArgumentError(f"an info is of type {type(info).__name__}, and should be {kind.__name__}")
    return infos


def _asked(
    builder: "BodyBuilder", values: dict[tuple[str, int], float], diagnostics: Diagnostics
) -> list[float] | None:
    """Return the value of each DOF, or None if the info asks for no values."""
    active = [joint for joint in builder.joints if joint.active]
    known = {(joint.name, index) for joint in builder.joints for index in range(len(joint.axes))}
    for name, index in values.keys() - known:
        message = f"a value is left out: '{builder.name}' has no axis {index} of a joint '{name}'"
        diagnostics.warn("unknown-joint", message, FROM_SCRIPT)
    if not values:
        return None
    return [
        values.get((joint.name, index), axis.reference) for joint in active for index, axis in enumerate(joint.axes)
    ]

"""Descriptions of bodies, robots, environments and attached parts."""

# The fields have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false
# JSON and users put anything into the fields that the functions of forms take.
# pyright: reportUnknownLambdaType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownMemberType=false

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers, checked_transform
from ravemj.core.enumerations import NamedFlag
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import DEFAULT_GRAVITY
from ravemj.engine.simulation.body import GrabbedBody
from ravemj.errors import ArgumentError, Diagnostics, send_warnings
from ravemj.model import hashes, scene
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.enums import JointType
from ravemj.rave.infos.base import (
    POSE,
    TEXT,
    Entry,
    Form,
    IdentifiedInfo,
    Info,
    Json,
    info,
    info_class,
    infos,
    json_field,
    parameters,
    pose,
    vector,
)
from ravemj.rave.infos.joint import JointInfo
from ravemj.rave.infos.link import LinkInfo
from ravemj.rave.infos.sensor import CameraGeomData, SensorGeometry, device_of, geometry_of
from ravemj.rave.units import UnitInfo

if TYPE_CHECKING:
    from ravemj.model.builder import BodyBuilder
    from ravemj.model.manipulators import ManipulatorBuilder


@info_class
class ManipulatorInfo(IdentifiedInfo):
    """Description of a manipulator: a chain of links with a tool at its end.

    Attributes:
        _name: The name.
        _sBaseLinkName: The name of the link that the chain starts from.
        _sEffectorLinkName: The name of the link that carries the tool.
        _tLocalTool: ``T_effector_tool``, shape (4, 4).
        _vdirection: The direction in which the tool points, in the tool frame, shape (3,).
        _vGripperJointNames: The names of the gripper's joints.
        _vChuckingDirection: For each DOF of these joints the sign of closing; OpenRAVE 0.9 calls the field
            ``_vClosingDirection``.
        _sIkSolverXMLId: The name of the IK solver that ``GetIkSolver`` makes, as ``<iksolver>`` has it.
        _grippername: The name of the ``GripperInfo`` that describes the gripper.
    """

    _called = "Robot.ManipulatorInfo"

    _name: str | None = json_field("name", TEXT, default=None)
    _sBaseLinkName: str | None = json_field("baseLinkName", TEXT, default=None)
    _sEffectorLinkName: str | None = json_field("effectorLinkName", TEXT, default=None)
    _tLocalTool: ArrayLike = json_field("transform", POSE, default=np.eye(4))
    _vChuckingDirection: ArrayLike = json_field("chuckingDirections", default=[], optional=True)
    _vdirection: ArrayLike = json_field("direction", default=np.array([0.0, 0.0, 1.0]))
    _sIkSolverXMLId: str = json_field("ikSolverType", TEXT, default="")
    _vGripperJointNames: Sequence[str] = json_field("gripperJointNames", default=[], optional=True)
    _grippername: str = json_field("grippername", TEXT, default="")

    @property
    def _vClosingDirection(self) -> ArrayLike:
        return self._vChuckingDirection

    @_vClosingDirection.setter
    def _vClosingDirection(self, signs: ArrayLike) -> None:
        self._vChuckingDirection = signs

    @classmethod
    def of(cls, body: scene.KinBody, arm: scene.Manipulator) -> Self:
        """Return the description of an existing manipulator."""
        return cls(
            _name=arm.name,
            _sBaseLinkName="" if arm.base is None else body.links[arm.base].name,
            _sEffectorLinkName="" if arm.effector is None else body.links[arm.effector].name,
            _tLocalTool=arm.T_effector_tool.matrix(),
            _vChuckingDirection=np.array(arm.chucking_direction),
            _vdirection=np.array(arm.direction),
            _vGripperJointNames=[body.joints[joint].name for joint in arm.gripper_joints],
            _grippername=arm.gripper_name,
            _sIkSolverXMLId=arm.ik_solver,
        )

    def manipulator(self) -> "ManipulatorBuilder":
        """Make the manipulator that the fields describe.

        Raises:
            ArgumentError: the manipulator has no name, or a field has wrong numbers.
        """
        if not self._name:
            raise ArgumentError("ManipulatorInfo._name: is empty, and should name the manipulator")
        from ravemj.model.manipulators import ManipulatorBuilder  # noqa: PLC0415 - slow to import

        return ManipulatorBuilder(
            name=self._name,
            source=FROM_SCRIPT,
            base=self._sBaseLinkName or "",
            effector=self._sEffectorLinkName or "",
            T_effector_tool=pose(self._tLocalTool, "ManipulatorInfo._tLocalTool"),
            direction=vector(self._vdirection, "ManipulatorInfo._vdirection"),
            gripper_joints=list(self._vGripperJointNames),
            closing_direction=checked_numbers(self._vChuckingDirection, "_vChuckingDirection").ravel().tolist(),
            gripper_name=self._grippername or "",
            ik_solver=self._sIkSolverXMLId or "",
        )


@info_class
class AttachedSensorInfo(IdentifiedInfo):
    """Description of a sensor on a link.

    Attributes:
        _name: The name.
        _linkname: The name of the link that carries the sensor.
        _trelative: ``T_link_sensor``, shape (4, 4).
        _sensorname: OpenRAVE's name for the kind of sensor, for instance ``BaseCamera``; empty for a frame without a
            sensor.
        _sensorgeometry: The constant properties, for a camera a ``CameraGeomData``; None for OpenRAVE's defaults.
    """

    _called = "Robot.AttachedSensorInfo"

    _name: str | None = json_field("name", TEXT, default=None)
    _linkname: str | None = json_field("linkName", TEXT, default=None)
    _trelative: ArrayLike = json_field("transform", POSE, default=np.eye(4))
    _sensorname: str | None = json_field("type", TEXT, default=None)
    _sensorgeometry: SensorGeometry | None = json_field("", default=None)

    @classmethod
    def of(cls, body: scene.KinBody, sensor: scene.AttachedSensor) -> Self:
        """Return the description of an existing sensor."""
        return cls(
            _name=sensor.name,
            _linkname="" if sensor.link is None else body.links[sensor.link].name,
            _trelative=sensor.T_link_sensor.matrix(),
            _sensorname=sensor.type,
            _sensorgeometry=None if sensor.device is None else geometry_of(sensor.device),
        )

    def sensor(self, links: Sequence[str]) -> scene.AttachedSensor:
        """Make the sensor that the fields describe.

        Args:
            links: The names of the robot's links.

        Raises:
            ArgumentError: ``_sensorgeometry`` belongs to another kind of sensor, or has wrong numbers.
        """
        geometry, kind = self._sensorgeometry, scene.sensor_kind(self._sensorname or "")
        device = None if kind is None else kind.device
        if device is not None and geometry is not None:
            device = device_of(geometry, device)
            if device is None:
                message = f"is of type {type(geometry).__name__}, which does not describe {self._sensorname}"
                raise ArgumentError(f"AttachedSensorInfo._sensorgeometry: {message}")
        return scene.AttachedSensor(
            name=self._name or "",
            link=links.index(self._linkname) if self._linkname in links else None,
            T_link_sensor=pose(self._trelative, "AttachedSensorInfo._trelative"),
            type=self._sensorname or None,
            device=device,
            source=FROM_SCRIPT,
        )

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        kind = scene.sensor_kind(str((obj or {}).get("type", self._sensorname) or "BaseCamera"))
        described = CameraGeomData if kind is None else type(geometry_of(kind.device))
        return (*self._entries, Entry("sensorGeometry", "_sensorgeometry", info(described), optional=True))


@info_class
class GripperInfo(IdentifiedInfo):
    """Description of a gripper. Manipulators name it in ``ManipulatorInfo._grippername``.

    Attributes:
        _name: The name.
        _grippertype: The type of the gripper, any text.
        _gripperJointNames: The names of its joints.
    """

    _name: str | None = json_field("name", TEXT, default=None)
    _grippertype: str = json_field("grippertype", TEXT, default="")
    _gripperJointNames: Sequence[str] = json_field("gripperJointNames", default=[])


@info_class
class ConnectedBodyInfo(IdentifiedInfo):
    """Description of a body that can be connected to a link of a robot. Once connected, it is part of the robot.

    Attributes:
        _name: The name of the body. With an underscore, it is the prefix of the names of its parts.
        _linkname: The name of the robot's link that carries the body.
        _trelative: ``T_link_body``, shape (4, 4).
        _uri: The file that the description comes from; ravemj does not read it.
        _linkInfos: The links; the first one is fixed to the robot.
        _jointInfos: The joints.
        _manipulatorInfos: The manipulators.
        _attachedSensorInfos: The sensors.
        _gripperInfos: The grippers.
        _bIsActive: Whether the body is connected: 1 yes, 0 no, -1 undecided.
    """

    _name: str | None = json_field("name", TEXT, default=None)
    _linkname: str | None = json_field("linkName", TEXT, default=None)
    _uri: str = json_field("uri", TEXT, default="", optional=True)
    _trelative: ArrayLike = json_field("transform", POSE, default=np.eye(4))
    _linkInfos: Sequence[LinkInfo] = json_field("links", infos(LinkInfo), default=[], optional=True)
    _jointInfos: Sequence[JointInfo] = json_field("joints", infos(JointInfo), default=[], optional=True)
    _manipulatorInfos: Sequence[ManipulatorInfo] = json_field(
        "tools", infos(ManipulatorInfo), default=[], optional=True
    )
    _attachedSensorInfos: Sequence[AttachedSensorInfo] = json_field(
        "attachedSensors", infos(AttachedSensorInfo), default=[], optional=True
    )
    _gripperInfos: Sequence[GripperInfo] = json_field("gripperInfos", infos(GripperInfo), default=[], optional=True)
    _bIsActive: int = json_field("isActive", default=0)


@info_class
class GrabbedInfo(IdentifiedInfo):
    """Description of a grab; ``ResetGrabbed`` restores it.

    Attributes:
        _grabbedname: The name of the grabbed body.
        _robotlinkname: The name of the grabbing link.
        _trelative: ``T_link_body``, shape (4, 4).
        _setIgnoreRobotLinkNames: The names of the holder's links whose collisions with the body are ignored.
        _grabbedUserData: User data, any JSON value. ravemj only stores it.
    """

    _id: str | None = json_field("id", TEXT, default="", optional=True, kw_only=True)
    _grabbedname: str = json_field("grabbedName", TEXT, default="")
    _robotlinkname: str = json_field("robotLinkName", TEXT, default="")
    _trelative: Floats = json_field("transform", POSE, default=np.eye(4))
    _setIgnoreRobotLinkNames: Sequence[str] = json_field("ignoreRobotLinkNames", default=[], optional=True)
    _grabbedUserData: Any = json_field("grabbedUserData", default=None, optional=True)

    @classmethod
    def of(cls, holder: scene.KinBody, grab: GrabbedBody) -> Self:
        """Return the info of a body grabbed by ``holder``."""
        links = [link.name for link in holder.links]
        ignored = sorted(links[index] for index in grab.ignored)
        return cls(grab.body.scene.name, links[grab.link], grab.T_link_body.copy(), ignored)

    def GetGrabbedInfoHash(self) -> str:
        """Return a hash of the info, 32 hexadecimal digits; equal infos have equal hashes."""
        return hashes.of_text(repr(self.SerializeJSON()))


T = TypeVar("T")

_NEAR = 1e-12  # tolerance for numbers that went through a file


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
    lambda items, scale, present: [((item["jointName"], item.get("jointAxis", 0)), item["value"]) for item in items],
)


@info_class
class KinBodyInfo(IdentifiedInfo):
    """Description of a body.

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
        """Return whether two infos describe the same links and joints; poses and joint values are ignored."""
        return _alike(self._standing().SerializeJSON(), other._standing().SerializeJSON())

    def _standing(self) -> "KinBodyInfo":
        """Return a copy of the info with identity poses, and without joint values and grabbed bodies."""
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
    """Description of a robot.

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
        like: An existing body, which determines whether to make a robot, and the name if the info has none.

    Raises:
        RavemjError: a list of the info contains an object of another class, two links share a name, or the links and
            joints form no valid body.
    """
    from ravemj.model.builder import BodyBuilder, SensorBuilder  # noqa: PLC0415 - slow to import

    builder = BodyBuilder(is_robot=like.is_robot, source=FROM_SCRIPT, name=info._name or like.name)
    for link_info in _checked(info._vLinkInfos, LinkInfo):
        builder.links.append(link_info.link())
    names = [link.name for link in builder.links]
    named = [name for name in names if name]
    if len(set(named)) < len(named):
        raise ArgumentError(f"the links are called {', '.join(names)}; each link needs a name of its own, or none")
    for index, link_info in enumerate(info._vLinkInfos):
        builder.adjacent += [(index, other) for other in link_info.adjacent(names)]
    builder.joints = [joint_info.joint(builder.links) for joint_info in _checked(info._vJointInfos, JointInfo)]
    diagnostics = Diagnostics()
    builder.joint_values = _asked(builder, info.values_by_axis(), diagnostics)
    if isinstance(info, RobotBaseInfo) and like.is_robot:
        builder.manipulators = [
            manipulator_info.manipulator() for manipulator_info in _checked(info._vManipInfos, ManipulatorInfo)
        ]
        sensors = _checked(info._vAttachedSensorInfos, AttachedSensorInfo)
        builder.sensors = [SensorBuilder(sensor_info.sensor(names)) for sensor_info in sensors]
    body = builder.freeze(diagnostics)
    if builder.refusal is not None:
        raise builder.refusal
    send_warnings(diagnostics)
    return body


def _checked(infos: Sequence[T], kind: type[T]) -> Sequence[T]:
    for item in infos:
        if not isinstance(item, kind):  # what users hand in
            raise ArgumentError(f"an info is of type {type(item).__name__}, and should be {kind.__name__}")
    return infos


def _asked(
    builder: "BodyBuilder", values: dict[tuple[str, int], float], diagnostics: Diagnostics
) -> list[float] | None:
    """Return the value of each DOF from an info; None if it has no values. Warn of unknown joints."""
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


_LISTS = ("_vLinkInfos", "_vJointInfos", "_vManipInfos", "_vAttachedSensorInfos", "_vGripperInfos")
_WORD = re.compile(r"[^\W\d]\w*")

Rename = Callable[[str | None], str]


def with_connected(robot: RobotBaseInfo, bodies: Iterable[ConnectedBodyInfo]) -> RobotBaseInfo:
    """Return a robot with the parts of connected bodies added.

    The names of these parts start with the name of their body and an underscore.

    Raises:
        ArgumentError: the robot does not have the link that should carry a body, or a body has no links.
    """
    for body in bodies:
        robot = _with_one(robot, body)
    return robot


def only_parts_of(robot: RobotBaseInfo, own: RobotBaseInfo) -> RobotBaseInfo:
    """Return a robot reduced to the parts named in another description."""
    kept = {name: {part._name for part in getattr(own, name)} for name in _LISTS}
    parts = {name: [part for part in getattr(robot, name) if part._name in kept[name]] for name in _LISTS}
    joints = kept["_vJointInfos"]
    return replace(robot, **parts, _dofValues=[value for value in robot._dofValues if value[0][0] in joints])


def _with_one(robot: RobotBaseInfo, body: ConnectedBodyInfo) -> RobotBaseInfo:
    carrier = next((link for link in robot._vLinkInfos if link._name == body._linkname), None)
    if carrier is None or not body._linkInfos:
        raise ArgumentError(
            f"connected body '{body._name}': it needs links, and a link '{body._linkname}' of the robot"
        )
    relative = checked_transform(body._trelative, "ConnectedBodyInfo._trelative")
    T_robot_body = checked_transform(carrier._t, "LinkInfo._t") @ relative
    lists = (body._linkInfos, body._jointInfos, body._gripperInfos)
    names = {described._name for infos in lists for described in infos}

    def own(name: str | None) -> str:  # only the body's own parts get the prefix; they may refer to parts of the robot
        return f"{body._name}_{name}" if name in names else name or ""

    links = [
        replace(
            link,
            _name=own(link._name),
            _t=T_robot_body @ checked_transform(link._t, "LinkInfo._t"),
            _vForcedAdjacentLinks=[own(name) for name in link._vForcedAdjacentLinks],
        )
        for link in body._linkInfos
    ]
    joints = [_renamed(joint, own) for joint in body._jointInfos]
    arms = [
        replace(
            arm,
            _name=f"{body._name}_{arm._name}",
            _sBaseLinkName=own(arm._sBaseLinkName),
            _sEffectorLinkName=own(arm._sEffectorLinkName),
            _vGripperJointNames=[own(name) for name in arm._vGripperJointNames],
            _grippername=own(arm._grippername),
        )
        for arm in body._manipulatorInfos
    ]
    sensors = [
        replace(sensor, _name=f"{body._name}_{sensor._name}", _linkname=own(sensor._linkname))
        for sensor in body._attachedSensorInfos
    ]
    grippers = [
        replace(
            gripper, _name=own(gripper._name), _gripperJointNames=[own(name) for name in gripper._gripperJointNames]
        )
        for gripper in body._gripperInfos
    ]
    joints = [_weld(body, str(carrier._name), str(links[0]._name)), *joints]
    added = zip(_LISTS, (links, joints, arms, sensors, grippers), strict=True)
    return replace(robot, **{name: [*getattr(robot, name), *parts] for name, parts in added})


def _renamed(joint: JointInfo, own: Rename) -> JointInfo:
    # Equations contain the names of joints: each of these words gets the prefix, functions and numbers do not.
    mimic = [
        equations and [_WORD.sub(lambda word: own(word[0]), equation) for equation in equations]
        for equations in joint._vmimic
    ]
    linkname0, linkname1 = own(joint._linkname0), own(joint._linkname1)
    return replace(joint, _name=own(joint._name), _linkname0=linkname0, _linkname1=linkname1, _vmimic=mimic)


def _weld(body: ConnectedBodyInfo, carrier: str, root: str) -> JointInfo:
    """Return the fixed joint between a robot's link and a connected body, under OpenRAVE's name for it."""
    return JointInfo(
        _name=f"{body._name}___dummyconnectedbody__",
        _type=JointType.Prismatic,
        _linkname0=carrier,
        _linkname1=root,
        _vaxes=[np.array([0.0, 0.0, 1.0])],
        _bIsActive=False,
    )


def _read_units(value: Json, scale: float, present: UnitInfo) -> UnitInfo:
    del scale
    changed = replace(present)
    changed.DeserializeJSON(value)
    return changed


_UNITS = Form(lambda units, scale: units.SerializeJSON(), _read_units)
_BODIES = infos(KinBodyInfo, robot=RobotBaseInfo)


@info_class
class EnvironmentBaseInfo(Info):
    """Description of an environment.

    Attributes:
        _vBodyInfos: The bodies, a list of ``KinBodyInfo`` and ``RobotBaseInfo``.
        _gravity: The gravitational acceleration in the world frame [m/s^2], shape (3,).
        _description: Free text; ``_keywords`` is a list of words.
        _uInt64Parameters: Integers of the user by name.
        _unitInfo: The units, a ``UnitInfo``.
    """

    _vBodyInfos: Sequence[KinBodyInfo] = json_field("bodies", _BODIES, default=[], optional=True)
    _gravity: ArrayLike = json_field("gravity", default=np.array(DEFAULT_GRAVITY))
    _description: str = json_field("description", TEXT, default="", optional=True)
    _keywords: Sequence[str] = json_field("keywords", default=[])
    _uInt64Parameters: dict[str, int] = json_field("uint64Parameters", parameters("value"), default={}, optional=True)
    _unitInfo: UnitInfo = json_field("unitInfo", _UNITS, default=UnitInfo())
    _revision: int = 0

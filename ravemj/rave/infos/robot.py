"""Descriptions of manipulators and attached sensors."""

# The fields have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Sequence
from dataclasses import field
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.errors import ArgumentError
from ravemj.model import scene
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.infos.base import Info, identity, info_class, pose, vector
from ravemj.rave.infos.json import PLAIN, POSE, TEXT, Entry, Json, info
from ravemj.rave.infos.sensor import CameraGeomData, SensorGeometry
from ravemj.rave.infos.sensor_devices import device_of, geometry_of

if TYPE_CHECKING:
    from ravemj.model.manipulators import ManipulatorBuilder


def _ahead() -> ArrayLike:
    return np.array([0.0, 0.0, 1.0])


@info_class
class ManipulatorInfo(Info):
    """The description of a manipulator: a chain of links with a tool at its end.

    Attributes:
        _name: The name.
        _sBaseLinkName: The name of the link that the chain starts from.
        _sEffectorLinkName: The name of the link that carries the tool.
        _tLocalTool: ``T_effector_tool``, shape (4, 4).
        _vdirection: The direction in which the tool points, in the tool frame, shape (3,).
        _vGripperJointNames: The names of the gripper's joints.
        _vChuckingDirection: For each DOF of these joints the sign of closing; OpenRAVE 0.9 calls the field
            ``_vClosingDirection``.
        _sIkSolverXMLId: The name of an IK solver; not used.
        _grippername: The name of the ``GripperInfo`` that describes the gripper.
    """

    _called = "Robot.ManipulatorInfo"

    _name: str | None = None
    _sBaseLinkName: str | None = None
    _sEffectorLinkName: str | None = None
    _tLocalTool: ArrayLike = field(default_factory=identity)
    _vChuckingDirection: ArrayLike = field(default_factory=list[float])
    _vdirection: ArrayLike = field(default_factory=_ahead)
    _sIkSolverXMLId: str = ""
    _vGripperJointNames: Sequence[str] = field(default_factory=list[str])
    _grippername: str = ""
    _id: str | None = None

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
        )

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        del obj
        return _MANIPULATOR_JSON


_MANIPULATOR_JSON = (
    Entry("id", "_id", TEXT),
    Entry("name", "_name", TEXT),
    Entry("transform", "_tLocalTool", POSE),
    Entry("chuckingDirections", "_vChuckingDirection", PLAIN, optional=True),
    Entry("direction", "_vdirection", PLAIN),
    Entry("baseLinkName", "_sBaseLinkName", TEXT),
    Entry("effectorLinkName", "_sEffectorLinkName", TEXT),
    Entry("ikSolverType", "_sIkSolverXMLId", TEXT),
    Entry("gripperJointNames", "_vGripperJointNames", PLAIN, optional=True),
    Entry("grippername", "_grippername", TEXT),
)


@info_class
class AttachedSensorInfo(Info):
    """The description of a sensor on a link.

    Attributes:
        _name: The name.
        _linkname: The name of the link that carries the sensor.
        _trelative: ``T_link_sensor``, shape (4, 4).
        _sensorname: OpenRAVE's name for the kind of sensor, for instance ``BaseCamera``; empty for a frame without a
            sensor.
        _sensorgeometry: The constant properties, for a camera a ``CameraGeomData``; None for OpenRAVE's defaults.
    """

    _called = "Robot.AttachedSensorInfo"

    _name: str | None = None
    _linkname: str | None = None
    _trelative: ArrayLike = field(default_factory=identity)
    _sensorname: str | None = None
    _sensorgeometry: SensorGeometry | None = None
    _id: str | None = None

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
        return (*_SENSOR_JSON, Entry("sensorGeometry", "_sensorgeometry", info(described), optional=True))


_SENSOR_JSON = (
    Entry("id", "_id", TEXT),
    Entry("name", "_name", TEXT),
    Entry("linkName", "_linkname", TEXT),
    Entry("transform", "_trelative", POSE),
    Entry("type", "_sensorname", TEXT),
)


@info_class
class GripperInfo(Info):
    """The description of a gripper. Manipulators name it in ``ManipulatorInfo._grippername``.

    Attributes:
        _name: The name.
        _grippertype: The type of the gripper, any text.
        _gripperJointNames: The names of its joints.
    """

    _called = "GripperInfo"

    _id: str | None = None
    _name: str | None = None
    _grippertype: str = ""
    _gripperJointNames: Sequence[str] = field(default_factory=list[str])

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        del obj
        return _GRIPPER_JSON


_GRIPPER_JSON = (
    Entry("id", "_id", TEXT),
    Entry("name", "_name", TEXT),
    Entry("grippertype", "_grippertype", TEXT),
    Entry("gripperJointNames", "_gripperJointNames", PLAIN),
)

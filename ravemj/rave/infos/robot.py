"""Descriptions of manipulators and attached sensors."""

# The fields have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Sequence
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.errors import ArgumentError
from ravemj.model import scene
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.infos.base import IdentifiedInfo, info_class, json_field, pose, vector
from ravemj.rave.infos.json import POSE, TEXT, Entry, Json, info
from ravemj.rave.infos.sensor import CameraGeomData, SensorGeometry
from ravemj.rave.infos.sensor_devices import device_of, geometry_of

if TYPE_CHECKING:
    from ravemj.model.manipulators import ManipulatorBuilder


@info_class
class ManipulatorInfo(IdentifiedInfo):
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


@info_class
class AttachedSensorInfo(IdentifiedInfo):
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
    """The description of a gripper. Manipulators name it in ``ManipulatorInfo._grippername``.

    Attributes:
        _name: The name.
        _grippertype: The type of the gripper, any text.
        _gripperJointNames: The names of its joints.
    """

    _name: str | None = json_field("name", TEXT, default=None)
    _grippertype: str = json_field("grippertype", TEXT, default="")
    _gripperJointNames: Sequence[str] = json_field("gripperJointNames", default=[])

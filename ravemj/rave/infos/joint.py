"""Descriptions of joints, their motors and control hardware."""

# JSON and users may put any value into the fields that the functions of forms get.
# pyright: reportUnknownLambdaType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownMemberType=false
# The fields have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.core.enumerations import NamedInt
from ravemj.core.transforms import Vec3, add, conjugate, dot, rotate, scale
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.model import scene
from ravemj.model.joints import about, directions_at, reported_anchor, wxyz_from_rotation_vector
from ravemj.model.mimic import Equations
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.enums import JointType
from ravemj.rave.infos.base import (
    LENGTHS,
    PLAIN,
    TEXT,
    Entry,
    Form,
    Info,
    Json,
    ParameterFields,
    info,
    info_class,
    json_field,
    named,
    vector,
)

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml.actuator import GearedMotor
    from ravemj.model.builder import JointBuilder, LinkBuilder


class JointControlMode(NamedInt):
    """Hardware that drives a joint of a real robot."""

    JCM_None = 0
    JCM_RobotController = 1
    JCM_IO = 2
    JCM_ExternalDevice = 3


@info_class
class ElectricMotorActuatorInfo(Info):
    """Electric motor with a gear. Its maximum torque replaces ``JointInfo._vmaxtorque``.

    Attributes:
        gear_ratio: Motor turns per joint turn.
        max_instantaneous_torque: The peak torque of the motor [N m].
        max_speed_torque_points: Turns of the motor per second and its torque limits there [N m]; none means
            ``max_instantaneous_torque`` at any speed.
        nominal_torque: The continuous torque of the motor [N m], used in physics if the peak torque is 0.
        rotor_inertia: The inertia of the rotor [kg m^2].
        coloumb_friction: The Coulomb friction at the joint [N m]; the spelling is OpenRAVE's.
        viscous_friction: The viscous friction at the joint [N m s/rad].
    """

    model_type: str = ""
    gear_ratio: float = 0.0
    assigned_power_rating: float = 0.0
    max_speed: float = 0.0
    no_load_speed: float = 0.0
    stall_torque: float = 0.0
    max_instantaneous_torque: float = 0.0
    nominal_speed_torque_points: Sequence[tuple[float, float]] = json_field("nominalSpeedTorquePoints", default=[])
    max_speed_torque_points: Sequence[tuple[float, float]] = json_field("maxSpeedTorquePoints", default=[])
    nominal_torque: float = 0.0
    rotor_inertia: float = 0.0
    torque_constant: float = 0.0
    nominal_voltage: float = 0.0
    speed_constant: float = 0.0
    starting_current: float = 0.0
    terminal_resistance: float = 0.0
    coloumb_friction: float = 0.0
    viscous_friction: float = 0.0

    def motor(self) -> "GearedMotor":
        """Return the motor's torque limit, inertia and friction at the joint."""
        from ravemj.formats.openrave_xml.actuator import ACTUATOR_TAGS, motor_of  # noqa: PLC0415 - rarely wanted

        names = ACTUATOR_TAGS.keys() - {"max_speed_torque_point"}
        return motor_of({name: float(getattr(self, name)) for name in names}, self.max_speed_torque_points)


@info_class
class JointControlInfo_RobotController(Info):  # noqa: N801 - OpenRAVE's name
    """Controller of a joint of a real robot. ravemj only stores it, since it drives no hardware.

    Attributes:
        controllerType: The type of the controller.
        robotControllerAxisIndex: For each axis of the joint its number in the controller; -1 if it has none.
        robotControllerAxisMult: The factor from the joint's value to the controller's.
        robotControllerAxisOffset: The offset that is added after the factor.
        robotControllerAxisManufacturerCode: The manufacturer of each axis' drive.
        robotControllerAxisProductCode: The product code of each axis' drive.
    """

    controllerType: str = ""
    robotControllerAxisIndex: Sequence[int] = (-1, -1, -1)
    robotControllerAxisMult: Sequence[float] = (1.0, 1.0, 1.0)
    robotControllerAxisOffset: Sequence[float] = (0.0, 0.0, 0.0)
    robotControllerAxisManufacturerCode: Sequence[str] = ("", "", "")
    robotControllerAxisProductCode: Sequence[str] = ("", "", "")


@info_class
class JointControlInfo_IO(Info):  # noqa: N801 - OpenRAVE's name
    """Inputs and outputs that drive a joint, for instance of a gripper. ravemj only stores them.

    Attributes:
        deviceType: The type of the device.
        moveIONames: For each axis the names of the outputs that move it.
        upperLimitIONames: For each axis the names of the inputs of its upper limit switch.
        upperLimitSensorIsOn: The values of these inputs at the upper limit.
        lowerLimitIONames: For each axis the names of the inputs of its lower limit switch.
        lowerLimitSensorIsOn: The values of these inputs at the lower limit.
    """

    deviceType: str = ""
    moveIONames: Sequence[Sequence[str]] = ((), (), ())
    upperLimitIONames: Sequence[Sequence[str]] = ((), (), ())
    upperLimitSensorIsOn: Sequence[Sequence[int]] = ((), (), ())
    lowerLimitIONames: Sequence[Sequence[str]] = ((), (), ())
    lowerLimitSensorIsOn: Sequence[Sequence[int]] = ((), (), ())


@info_class
class JointControlInfo_ExternalDevice(Info):  # noqa: N801 - OpenRAVE's name
    """Other device that drives a joint. ravemj only stores it.

    Attributes:
        externalDeviceType: The type of the device.
    """

    externalDeviceType: str = ""


_KINDS: dict[JointType, scene.JointKind] = {
    JointType.Hinge: "hinge",
    JointType.Slider: "slider",
    JointType.Hinge2: "hinge2",
    JointType.Spherical: "spherical",
    JointType.RP: "rp",
    JointType.PR: "pr",
    JointType.PP: "pp",
}
_UNIT: tuple[Vec3, Vec3, Vec3] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


_SPECIAL_AXES = {JointType.Universal: 2, JointType.Hinge2: 2, JointType.Spherical: 3, JointType.Trajectory: 1}
_WORDS = named(
    {
        JointType(0): "",
        JointType.Revolute: "revolute",
        JointType.Prismatic: "prismatic",
        **{
            kind: kind.name.lower() for kind in (JointType.RR, JointType.RP, JointType.PR, JointType.PP, *_SPECIAL_AXES)
        },
    }
)
_CONTROL = named({mode: mode.name.removeprefix("JCM_") for mode in JointControlMode})
_MIMICS = Form(
    lambda mimics, scale: [{"equations": list(mimic) if mimic else ["", "", ""]} for mimic in mimics],
    lambda items, scale, present: [[*item["equations"], "", ""][:3] for item in items],
)
_VALUES = Form(PLAIN.write, PLAIN.read)
"""JSON conversion of joint values and their derivatives; those of prismatic joints are lengths."""


def _of_axes(key: str, of: str, default: float, form: Form = PLAIN) -> ArrayLike:
    """Declare an info field with one number per axis; ``of`` is the attribute of ``scene.Axis``."""
    return json_field(key, form, default=np.full(3, default), of=of)


@info_class
class JointInfo(ParameterFields):
    """Description of a joint between two links.

    Fields with one number for each axis may be longer than the number of axes.

    Attributes:
        _type: The type of the joint, a ``JointType``: Hinge, Slider, Hinge2, Spherical, RP, PR or PP.
        _name: The name.
        _linkname0: The name of the first link; anchor and axes are in its frame.
        _linkname1: The name of the second link.
        _vanchor: A point on the axis, in the frame of the first link [m], shape (3,).
        _vaxes: The directions of the axes in the frame of the first link, a list of vectors of shape (3,).
        _vcurrentvalues: The joint values at the link poses of the infos [rad or m]; None means 0.
        _vlowerlimit: Lower limits [rad or m]. A joint whose lower limits equal its upper limits is a weld.
        _vupperlimit: Upper limits [rad or m].
        _vmaxvel: Velocity limits [rad/s or m/s]; _vmaxaccel, _vmaxjerk, _vmaxtorque, _vweights and _vresolution
            likewise.
        _vhardmaxvel: Velocity limits that planners never exceed, 0 for none; _vhardmaxaccel and _vhardmaxjerk likewise.
        _voffsets: Centres of the intervals of one turn into which angles are wrapped [rad]; see
            ``Joint.SetWrapOffset``.
        _bIsCircular: Whether the axis rotates without limits.
        _bIsActive: Whether the joint has DOFs.
        _vmimic: The equations of a mimic joint: for each axis a list with those of position, velocity and acceleration.
        _infoElectricMotor: The motor, or None.
        _controlMode: The hardware that drives the joint, a ``JointControlMode``; ``_jci_robotcontroller``, ``_jci_io``
            and ``_jci_externaldevice`` have its details. ravemj only stores them.

    Example:
        >>> info = ravemj.KinBody.JointInfo()
        >>> info._type, info._name = ravemj.JointType.Hinge, "elbow"
        >>> info._linkname0, info._linkname1 = "upper", "lower"
        >>> info._vaxes, info._vlowerlimit, info._vupperlimit = [[0, 0, 1]], [-1], [1]
        >>> body.Init([upper, lower], [info])
        True
    """

    _called = "KinBody.JointInfo"

    _type: JointType = json_field("type", _WORDS, default=JointType(0))
    _name: str | None = json_field("name", TEXT, default=None)
    _linkname0: str | None = json_field("parentLinkName", TEXT, default=None)
    _linkname1: str | None = json_field("childLinkName", TEXT, default=None)
    _vanchor: ArrayLike = json_field("anchors", LENGTHS, default=np.zeros(3))
    _vaxes: Sequence[ArrayLike] = json_field("axes", default=[])
    _vcurrentvalues: ArrayLike | None = json_field("currentValues", _VALUES, default=None, optional=True)
    _vresolution: ArrayLike = _of_axes("resolutions", "resolution", 0.02)
    _vmaxvel: ArrayLike = _of_axes("maxVel", "max_velocity", 10.0, _VALUES)
    _vhardmaxvel: ArrayLike = _of_axes("hardMaxVel", "hard_max_velocity", 0.0, _VALUES)
    _vmaxaccel: ArrayLike = _of_axes("maxAccel", "max_acceleration", 50.0, _VALUES)
    _vhardmaxaccel: ArrayLike = _of_axes("hardMaxAccel", "hard_max_acceleration", 0.0, _VALUES)
    _vmaxjerk: ArrayLike = _of_axes("maxJerk", "max_jerk", 5e4, _VALUES)
    _vhardmaxjerk: ArrayLike = _of_axes("hardMaxJerk", "hard_max_jerk", 0.0, _VALUES)
    _vmaxtorque: ArrayLike = _of_axes("maxTorque", "max_torque", 0.0)
    _vmaxinertia: ArrayLike = _of_axes("maxInertia", "max_inertia", 0.0)
    _vweights: ArrayLike = _of_axes("weights", "weight", 1.0)
    _voffsets: ArrayLike = _of_axes("offsets", "wrap_offset", 0.0)
    _vlowerlimit: ArrayLike = _of_axes("lowerLimit", "lower", 0.0, _VALUES)
    _vupperlimit: ArrayLike = _of_axes("upperLimit", "upper", 0.0, _VALUES)
    _bIsCircular: ArrayLike = json_field("isCircular", default=[], of="circular")
    _bIsActive: bool = json_field("isActive", default=True)
    _vmimic: Sequence[Sequence[str] | None] = json_field("mimics", _MIMICS, default=[], optional=True)
    _infoElectricMotor: ElectricMotorActuatorInfo | None = json_field(
        "electricMotorActuator", info(ElectricMotorActuatorInfo), default=None, optional=True
    )
    _controlMode: JointControlMode = json_field("controlMode", _CONTROL, default=JointControlMode.JCM_None)
    _jci_robotcontroller: JointControlInfo_RobotController | None = json_field(
        "jointControlInfoRobotController", info(JointControlInfo_RobotController), default=None, optional=True
    )
    _jci_io: JointControlInfo_IO | None = json_field(
        "jointControlInfoIO", info(JointControlInfo_IO), default=None, optional=True
    )
    _jci_externaldevice: JointControlInfo_ExternalDevice | None = json_field(
        "jointControlInfoExternalDevice", info(JointControlInfo_ExternalDevice), default=None, optional=True
    )

    @classmethod
    def of(cls, body: scene.KinBody, index: int, values: Sequence[float]) -> Self:
        """Return the description of a joint at given joint values.

        Args:
            body: The body.
            index: The index of the joint among the active joints followed by the passive ones.
            values: The values of its axes [rad or m].
        """
        joint = body.all_joints[index]
        mimic = joint.mimic
        of_axes: dict[str, Any] = {
            entry.field: np.array([getattr(axis, _REPORTED.get(entry.of, entry.of)) for axis in joint.axes])
            for entry in cls._entries
            if entry.of
        }
        return cls(
            _type=type_of(joint.kind),
            _name=joint.name,
            _linkname0=body.links[joint.parent].name,
            _linkname1=body.links[joint.child].name,
            _vanchor=np.array(reported_anchor(joint)),
            _vaxes=[np.array(direction) for direction in _directions(body, joint, values)],
            _vcurrentvalues=np.array(values),
            _bIsActive=index < len(body.joints) or all(follower.mimic for follower in body.all_joints[index:]),
            _infoElectricMotor=_motor_of(joint.axes[0], is_slider=joint.kind == "slider"),
            _vmimic=[] if mimic is None else [[mimic.position, mimic.velocity, mimic.acceleration]],
            **of_axes,
        ).with_parameters(joint.parameters)

    def GetDOF(self) -> int:
        """Return the number of axes of a joint of this type; 0 if the type is not set.

        Raises:
            openrave_exception: OpenRAVE has no such type.
        """
        kind = JointType(self._type)
        return _SPECIAL_AXES[kind] if kind in _SPECIAL_AXES else int(kind) & 0xF

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        kind = JointType(self._type) if obj is None or not obj.get("type") else _WORDS.read(obj["type"], 1.0, None)
        form = LENGTHS if kind == JointType.Prismatic else PLAIN
        return [entry._replace(form=form) if entry.form is _VALUES else entry for entry in self._entries]

    def SerializeJSON(self, unitScale: float = 1.0, options: object = None) -> Json:
        """Return the joint in OpenRAVE's JSON format, see ``Info``. Its lists have one number for each axis.

        Args:
            unitScale: Multiplies all lengths; for a slider these include its limits.
            options: Not used.
        """
        written = super().SerializeJSON(unitScale, options)
        return written | {entry.key: written[entry.key][: self.GetDOF()] for entry in self._entries if entry.of}

    def named_values(self) -> list[tuple[tuple[str, int], float]]:
        """Return the current values, each as ((joint name, axis), value)."""
        values = np.ravel(() if self._vcurrentvalues is None else self._vcurrentvalues)
        return [((self._name or "", axis), float(value)) for axis, value in enumerate(values)]

    def joint(self, links: "Sequence[LinkBuilder]") -> "JointBuilder":
        """Make the joint that the fields describe.

        Args:
            links: The links of the body, which contain the two that the joint names.

        Raises:
            RavemjError: a named link is missing, a field has wrong numbers, or ravemj lacks the type of joint.
        """
        kind = _KINDS.get(JointType(self._type))
        if kind is None:
            message = (
                f"joint '{self._name}' has the type {JointType(self._type).name}; ravemj has {', '.join(scene.AXES)}"
            )
            raise RavemjError(message, ErrorCode.NotImplemented)
        names = [link.name for link in links]
        for name in (self._linkname0, self._linkname1):
            if names.count(name or "") != 1:
                message = f"names a link '{name}'; there are {', '.join(map(repr, names))}"
                raise ArgumentError(f"joint '{self._name}' {message}, and one of them should have that name")
        first, second = names.index(self._linkname0 or ""), names.index(self._linkname1 or "")
        values = self._per_axis("_vcurrentvalues", len(scene.AXES[kind]))
        axes = self._made_axes(kind, values)
        anchor = vector(self._vanchor, "JointInfo._vanchor")
        T_first_second = links[first].pose.inverse() @ links[second].pose
        # The builder expects the pose of the second link at value 0; infos have it at the current values.
        if kind == "spherical":
            T_first_second = about(anchor, wxyz_from_rotation_vector((values[0], values[1], values[2]))).inverse() @ (
                T_first_second
            )
        if kind == "slider":
            anchor = add(anchor, scale(axes[0].direction, values[0]))
        from ravemj.model.builder import JointBuilder  # noqa: PLC0415 - slow to import

        return JointBuilder(
            name=self._name or "",
            kind=kind,
            links=(first, second),
            T_first_second=T_first_second,
            anchor=anchor,
            axes=axes,
            enabled=bool(self._bIsActive),
            equations=self._equations(),
            parameters=self.parameters(),
            source=FROM_SCRIPT,
        )

    def _made_axes(self, kind: scene.JointKind, values: Sequence[float]) -> tuple[scene.Axis, ...]:
        count = len(values)
        directions = [vector(axis, "JointInfo._vaxes") for axis in self._vaxes[:count]]
        directions += [(0.0, 0.0, 1.0)] * (count - len(directions))
        motor = None if self._infoElectricMotor is None else self._infoElectricMotor.motor()
        columns = {entry.of: self._per_axis(entry.field, count) for entry in self._entries if entry.of}
        axes = list[scene.Axis]()
        for i, numbers in enumerate(zip(*columns.values(), strict=True)):
            fields: dict[str, Any] = dict(zip(columns, numbers, strict=True))
            fields["direction"] = _UNIT[i] if kind == "spherical" else _unit(directions[i])
            fields["reference"] = 0.0 if kind == "spherical" else values[i]
            fields["circular"] = bool(fields["circular"])
            if fields["circular"]:
                fields.update(lower=-scene.UNLIMITED, upper=scene.UNLIMITED)
            axis = scene.Axis(**fields)
            axes.append(axis if motor is None else motor.driven(axis, turns=kind != "slider"))
        return tuple(axes)

    def _per_axis(self, field: str, count: int) -> list[float]:
        """Return a field's numbers for ``count`` axes; missing ones have the default of new infos.

        Raises:
            ArgumentError: a number is NaN.
        """
        values = getattr(self, field)
        numbers = np.zeros(0) if values is None else checked_numbers(values, f"JointInfo.{field}").ravel()
        if np.isnan(numbers).any():
            raise ArgumentError(f"JointInfo.{field}: is {numbers.tolist()}, and should be numbers")
        return [*numbers[:count].tolist(), *[_DEFAULTS.get(field, 0.0)] * (count - len(numbers))]

    def _equations(self) -> Equations | None:
        first = self._vmimic[0] if self._vmimic else None
        return Equations(*map(str, first)) if first and any(first) else None


_DEFAULTS = {
    entry.field: float(next(iter(getattr(JointInfo(), entry.field)), 0.0)) for entry in JointInfo._entries if entry.of
}
"""Default values of new infos for each axis."""


_REPORTED = {"max_torque": "own_torque"}
"""Substitute attributes of axes for infos: the torque limit without the motor, which has an info of its own."""


def _motor_of(axis: scene.Axis, *, is_slider: bool) -> ElectricMotorActuatorInfo | None:
    """Return the motor of an axis as an equivalent motor with gear ratio 1; None if the axis has no motor."""
    if not (axis.armature or axis.speed_torques or axis.joint_torque is not None):
        return None
    turn = 1.0 if is_slider else 2 * math.pi
    points = [(speed / turn, torque) for speed, torque in axis.speed_torques]
    return ElectricMotorActuatorInfo(
        gear_ratio=1.0,
        max_instantaneous_torque=axis.max_torque,
        max_speed_torque_points=points,
        rotor_inertia=axis.armature,
        coloumb_friction=axis.coulomb_friction,
        viscous_friction=axis.viscous_friction,
    )


def type_of(kind: scene.JointKind) -> JointType:
    """Return OpenRAVE's joint type of a kind of joint in scenes."""
    return next(number for number, known in _KINDS.items() if known == kind)


def _unit(direction: Vec3) -> Vec3:
    length = math.sqrt(dot(direction, direction))
    if length == 0.0:
        raise ArgumentError("JointInfo._vaxes: an axis is 0 0 0, and should be a direction")
    return scale(direction, 1 / length)


def _directions(body: scene.KinBody, joint: scene.Joint, values: Sequence[float]) -> list[Vec3]:
    """Return the directions of a joint's axes at joint values, in the frame of its first link."""
    if joint.static and body.joints:  # the builder turns the axes of a weld into the frame of its second link
        return [rotate(conjugate(joint.T_parent_child.wxyz), axis.direction) for axis in joint.axes]
    return directions_at(joint, values)

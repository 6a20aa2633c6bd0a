"""Descriptions of what drives a joint: its electric motor, and the hardware that commands it."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ravemj.core.enumerations import NamedInt
from ravemj.rave.infos.base import Info, info_class, json_field

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml.actuator import Motor


class JointControlMode(NamedInt):
    """The hardware that drives a joint of a real robot."""

    JCM_None = 0
    JCM_RobotController = 1
    JCM_IO = 2
    JCM_ExternalDevice = 3


@info_class
class ElectricMotorActuatorInfo(Info):
    """An electric motor with a gear. Its maximum torque replaces ``JointInfo._vmaxtorque``.

    Attributes:
        gear_ratio: Turns of the motor for one turn of the joint.
        max_instantaneous_torque: The peak torque of the motor [N m].
        nominal_torque: The continuous torque of the motor [N m], used if the peak torque is 0.
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

    def motor(self) -> "Motor":
        """Return the torque limit, inertia and friction that the motor has at the joint."""
        from ravemj.formats.openrave_xml.actuator import ACTUATOR_TAGS, motor_of  # noqa: PLC0415 - rarely wanted

        return motor_of({name: float(getattr(self, name)) for name in ACTUATOR_TAGS})


@info_class
class JointControlInfo_RobotController(Info):  # noqa: N801 - OpenRAVE's name
    """The controller that drives a joint of a real robot. ravemj stores it only, since it drives no hardware.

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
    """The inputs and outputs that drive a joint, for instance that of a gripper. ravemj stores it only.

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
    """Another device that drives a joint. ravemj stores it only.

    Attributes:
        externalDeviceType: The type of the device.
    """

    externalDeviceType: str = ""

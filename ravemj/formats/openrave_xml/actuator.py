"""``<actuator>``: the motor of a joint, which gives the torque limit, the armature and friction."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ravemj.errors import SourceError
from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tags import Tag, reasons
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import number, numbers
from ravemj.model.scene import Axis


@dataclass(slots=True)
class _Data:
    """Reading state of an ``<actuator>``: numbers by tag, and points of its torque curve."""

    context: Context
    numbers: dict[str, float] = field(default_factory=dict[str, float])
    points: list[tuple[float, float]] = field(default_factory=list[tuple[float, float]])

    def read(self, element: Element) -> None:
        self.numbers[element.tag] = number(element, self.context.diagnostics)

    def add_point(self, element: Element) -> None:
        speed, torque = numbers(element, 2, self.context.diagnostics)
        self.points.append((speed, torque))


ACTUATOR_TAGS: dict[str, Tag[_Data]] = {
    "gear_ratio": Tag(_Data.read, "motor turns for each of the joint"),
    "nominal_torque": Tag(_Data.read, "limit of the torque [N m], where there is no other"),
    "max_instantaneous_torque": Tag(_Data.read, "limit of the torque [N m]"),
    "max_speed_torque_point": Tag(_Data.add_point, "turns of the motor per second and limit of the torque [N m] there"),
    "rotor_inertia": Tag(_Data.read, "[kg m²]; in inverse dynamics, and armature of actuators in MJCF"),
    "coloumb_friction": Tag(_Data.read, "[N m] at the joint, in inverse dynamics"),
    "viscous_friction": Tag(_Data.read, "[N m s/rad] at the joint, in inverse dynamics"),
}
ACTUATOR_ATTRIBUTES = {"type": "electric_motor; OpenRAVE refuses others"}
ACTUATOR_IGNORED = reasons(
    "no getter or simulation of ravemj uses it",
    "assigned_power_rating",
    "max_speed",
    "no_load_speed",
    "stall_torque",
    "nominal_speed_torque_point",
    "nominal_voltage",
    "torque_constant",
    "speed_constant",
    "terminal_resistance",
    "starting_current",
    "max_velocity",
    "max_acceleration",
)


class GearedMotor(NamedTuple):
    """A motor with its gear.

    Attributes:
        torque: Torque limit [N m], or None if it is not specified.
        points: Joint speeds [turns/s, m/s for sliders] and the torque limits [N m] at these; none if the limit is the
            same at any speed.
        inertia: Inertia of the rotor at the joint [kg m^2].
        coulomb_friction: Friction at any speed of the joint [N m]; as in OpenRAVE, not converted by the gear.
        viscous_friction: Friction per speed of the joint [N m s/rad].
    """

    torque: float | None
    points: tuple[tuple[float, float], ...]
    inertia: float
    coulomb_friction: float
    viscous_friction: float

    def driven(self, axis: Axis, *, turns: bool) -> Axis:
        """Return an axis, revolute if ``turns``, with the data of this motor, which override ``<maxtorque>``."""
        turn = 2 * math.pi if turns else 1.0
        torque = axis.max_torque if self.torque is None else self.torque
        return replace(
            axis,
            max_torque=torque,
            joint_torque=None if axis.max_torque == torque else axis.max_torque,
            speed_torques=tuple((speed * turn, limit) for speed, limit in self.points),
            armature=self.inertia,
            coulomb_friction=self.coulomb_friction,
            viscous_friction=self.viscous_friction,
        )


def read_motor(element: Element, context: Context) -> GearedMotor:
    """Read the motor of a joint.

    Raises:
        SourceError: it is not an electric motor.
    """
    context.check_attributes(element, ACTUATOR_ATTRIBUTES, {})
    kind = element.attributes.get("type", "electric_motor")
    if kind.lower() != "electric_motor":
        raise SourceError(f"OpenRAVE knows no actuator of type '{kind}'", element.source, "write electric_motor")
    motor = _Data(context)
    context.walk(element, ACTUATOR_TAGS, ACTUATOR_IGNORED, motor)
    return motor_of(motor.numbers, motor.points)


def motor_of(data: Mapping[str, float], points: Sequence[tuple[float, float]]) -> GearedMotor:
    """Return the motor with its gear; missing numbers are 0.

    Args:
        data: Numbers by tag.
        points: Motor speeds [turns/s] and the torque limits [N m] at these; none means the same limit at any speed.
    """
    gear_ratio = data.get("gear_ratio", 0.0)
    inertia = data.get("rotor_inertia", 0.0) * gear_ratio**2
    limits = (data.get(name, 0.0) for name in ("max_instantaneous_torque", "nominal_torque"))
    torque = next((limit * gear_ratio for limit in limits if limit > 0), None)
    slow = gear_ratio if gear_ratio > 0 else 1.0
    behind = tuple((float(speed) / slow, float(limit) * gear_ratio) for speed, limit in points)
    torque = behind[0][1] if behind else torque
    return GearedMotor(
        torque,
        behind if len(behind) > 1 else (),
        inertia,
        data.get("coloumb_friction", 0.0),
        data.get("viscous_friction", 0.0),
    )

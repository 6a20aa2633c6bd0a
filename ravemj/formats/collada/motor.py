"""Motors of joints, from the library of actuators."""

import math
from dataclasses import replace

from ravemj.formats.meshes.collada.document import Element, child, numbers
from ravemj.model.scene import Axis


def driven(axis: Axis, motor: Element) -> Axis:
    """Return an axis with the torque limit and the inertia of its motor, both behind the gear, and its friction."""
    gear = _number(motor, "gear_ratio")
    torques = (_number(motor, name) for name in ("max_instantaneous_torque", "nominal_torque"))
    torque = next((value * gear for value in torques if value > 0), axis.max_torque)
    return replace(
        axis,
        max_torque=torque,
        armature=_number(motor, "rotor_inertia") * gear**2,
        coulomb_friction=_number(motor, "coloumb_friction"),
        viscous_friction=_number(motor, "viscous_friction"),
    )


def _number(motor: Element, name: str) -> float:
    values = numbers(child(motor, name))
    return float(values[0]) if len(values) and math.isfinite(values[0]) else 0.0

"""Actuators, and the joint attributes that belong to them."""

from typing import Literal

from ravemj.errors import Diagnostics
from ravemj.formats.mjcf.lines import Attribute, XmlLines
from ravemj.model.scene import Axis, Joint

Actuators = Literal["position", "velocity", "torque"]


def joint_motor(axis: Axis, armature: float = 0.0) -> dict[str, Attribute | None]:
    """Return the MJCF joint attributes for an axis's motor; add ``armature`` [kg m^2 or kg] to its rotor inertia."""
    return {
        "armature": axis.armature + armature or None,
        "damping": axis.viscous_friction or None,
        "frictionloss": axis.coulomb_friction or None,
    }


def write_actuator(
    out: XmlLines, joint: Joint, name: str, index: int, kind: Actuators, gains: tuple[float, float, float]
) -> None:
    """Write the actuator of one axis of a joint; ``gains`` are stiffness, damping and armature."""
    axis, (kp, kv, armature) = joint.axes[index], gains
    torque = (-axis.max_torque, axis.max_torque) if axis.max_torque else None
    limits = None if axis.circular else (axis.lower, axis.upper)
    speed = (-axis.max_velocity, axis.max_velocity)
    forms: dict[Actuators, tuple[str, dict[str, Attribute | None]]] = {
        "torque": ("motor", {"ctrlrange": torque}),
        "velocity": ("velocity", {"kv": kv, "ctrlrange": speed, "forcerange": torque, "armature": armature or None}),
        "position": (
            "position",
            {"kp": kp, "kv": kv, "ctrlrange": limits, "forcerange": torque, "armature": armature or None},
        ),
    }
    tag, attributes = forms[kind]
    out.element(tag, joint.source, name=name, joint=name, **attributes)


def warn_of_ball(joint: Joint, diagnostics: Diagnostics) -> None:
    """Warn that a spherical joint gets no actuator."""
    message = f"joint '{joint.name}' is spherical, and gets no actuator"
    diagnostics.warn("no-actuator", message, joint.source)

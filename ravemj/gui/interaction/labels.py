"""What is written on the view about links, bodies and joints."""

import math
from collections.abc import Iterable

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.gui.interaction.joint_handle import joint_and_axis


def point_line(body: BodyState, link: int, position: Floats, normal: Floats) -> str:
    """Return a link's name, a point on it and the surface normal there, in the world [m]."""
    name = body.scene.links[link].name
    return f"{name}: (x, y, z) = ({_numbers(position)}), n = ({_numbers(normal)})"


def body_line(body: BodyState) -> str:
    """Return what a body is, and its name."""
    return f"{'Robot' if body.scene.is_robot else 'Body'} {body.scene.name}"


def joint_line(body: BodyState, dof: int) -> str:
    """Return the name of a joint, the index of a DOF of it, and its value [rad and degrees, for sliders m]."""
    joint, axis = joint_and_axis(body, dof)
    value = float(body.kinematics.values()[dof])
    which = f", axis {axis}" if len(joint.axes) > 1 else ""
    shown = f"{_number(value)} m" if joint.slides(axis) else f"{_number(value)} rad, {_angle(value)} deg"
    return f"Joint {joint.name}{which}, DOF {dof}: {shown}"


def _numbers(values: Floats) -> str:
    return ", ".join(map(_number, _floats(values)))


def _floats(values: Floats) -> Iterable[float]:
    return values.tolist()


def _number(value: float) -> str:
    return f"{round(value, 3) + 0.0:.3f}"  # 0.0 is for what would be shown as -0.000


def _angle(value: float) -> str:
    return f"{round(math.degrees(value), 1) + 0.0:.1f}"

"""The joint sliders of one body."""

import math
import random
from dataclasses import replace

import numpy as np

from ravemj.engine.simulation import BodyState
from ravemj.gui.interaction.control import Control
from ravemj.gui.interaction.dragging import set_dof
from ravemj.gui.interaction.joint_handle import joint_and_axis
from ravemj.model.limits import clamp

_WIDEST = {True: (1.0, "m"), False: (math.pi, "rad")}
"""Half the slider range and its unit, for joints with much wider limits; key: whether the joint is prismatic."""

_MUCH = 4.0
"""Factor of ``_WIDEST`` above which joint limits are much wider."""


_TOOLS = (
    ("zero", "Zero", "Bring all joints to 0, or as near as their limits go"),
    ("random", "Random", "Bring all joints to random values within their limits"),
    ("units", "Units", "Show angles in degrees, or in radians"),
    ("values", "Copy", "Copy the values as a line of Python"),
)


def controls(body: BodyState, *, in_degrees: bool) -> list[Control]:
    """Return the buttons above the sliders, and a slider for each DOF of a body."""
    values = enumerate(body.kinematics.values().tolist())
    sliders = (_slider(body, dof, value, in_degrees=in_degrees) for dof, value in values)
    buttons = [Control(name, label, text, group="joint tools") for name, text, label in _TOOLS]
    return [*buttons, *(slider for slider in sliders if slider.is_slider)]


def sweep_control(body: BodyState, dof: int, *, in_degrees: bool) -> Control:
    """Return a slider for the redundant joint of an arm, which moves while the hand stays."""
    slider = _slider(body, dof, float(body.kinematics.values()[dof]), in_degrees=in_degrees)
    return replace(slider, name="sweep", label=f"{slider.label}, hand stays")


def operate(body: BodyState, name: str, value: float) -> None:
    """Set the joint of a slider, or all joints to zero or to random values, within their limits."""
    if name.startswith("dof "):
        set_dof(body, int(name.removeprefix("dof ")), value)
        return
    values = np.zeros(body.dof)
    for dof, axis in enumerate(body.scene.dof_axes):
        slider = _slider(body, dof, 0.0)
        values[dof] = clamp(axis, random.uniform(slider.lower, slider.upper) if name == "random" else 0.0)
    body.set_values(values)


def values_line(body: BodyState) -> str:
    """Return a line of Python that sets the present joint values."""
    values = ", ".join(str(round(value, 6) + 0.0) for value in body.kinematics.values().tolist())
    return f"env.GetKinBody({body.scene.name!r}).SetDOFValues([{values}])"


def _slider(body: BodyState, dof: int, value: float, *, in_degrees: bool = False) -> Control:
    limits = body.scene.dof_axes[dof]
    joint, axis = joint_and_axis(body, dof)
    reach, unit = _WIDEST[joint.slides(axis)]
    shown, lower, upper = value, limits.lower, limits.upper
    if limits.circular:
        lower, upper, shown = -math.pi, math.pi, math.remainder(value, math.tau)
    elif not upper - lower <= _MUCH * 2 * reach:
        middle = min(max(0.0, lower + reach), upper - reach)
        lower, upper = middle - reach, middle + reach
    name = f"{joint.name}, axis {axis}" if len(joint.axes) > 1 else joint.name
    text = f"{value:z.3f} {unit}"  # z: -0.0001 is shown as 0.000
    if in_degrees and unit == "rad":
        text = f"{math.degrees(value):z.1f} deg"
    return Control(f"dof {dof}", name, text, shown, lower, upper, group="joints")

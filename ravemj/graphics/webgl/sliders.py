"""Sliders of a page: the joints of bodies, and the tree of links that the page moves by forward kinematics."""

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.world_model import WorldModel

_SAMPLES = 129
"""Number of slider values for which a page gets the values of joints that follow nonlinear mimic equations."""

_LINEAR = 1e-12
"""Deviation from a straight line [rad or m] below which a slider's table is reduced to its two ends."""

_FARTHEST = 2 * math.pi
"""Slider range to both sides for joints without limits [rad or m]; circular joints get half of it."""


class Slider(NamedTuple):
    """A joint value that the page changes.

    Attributes:
        name: The name of the DOF.
        unit: ``rad`` or ``m``.
        low: Minimum value.
        high: Maximum value.
        value: Initial value.
        tables: By MuJoCo's index of a joint: its positions at evenly spaced values from ``low`` to ``high``.
    """

    name: str
    unit: str
    low: float
    high: float
    value: float
    tables: dict[int, list[float]]


def mechanism(world: WorldModel, bodies: Sequence[BodyState]) -> dict[str, Any]:
    """Return the document of ``page/mechanism.js``: sliders, joints, and moving bodies, parents first.

    Joints of three DOFs have no sliders. Mimic joints of several joints are exact only if they are linear.
    """
    sliders = [slider for body in bodies for slider in _sliders(world, body, several=len(bodies) > 1)]
    driven = sorted({joint for slider in sliders for joint in slider.tables})
    moving = _moving(world.model, driven)
    return {
        "sliders": [
            {**slider._asdict(), "tables": [[driven.index(joint), table] for joint, table in slider.tables.items()]}
            for slider in sliders
        ],
        "joints": [_joint(world, joint) for joint in driven],
        "bodies": [_placed(world, body, moving, driven) for body in moving],
    }


def _sliders(world: WorldModel, body: BodyState, *, several: bool) -> Iterator[Slider]:
    """Yield a slider for each DOF that moves hinge or slide joints, with tables computed on a copy of the body.

    If there are ``several`` bodies, the names of the sliders start with the body's name.
    """
    copy = body.simulation.create(body.scene).own_kinematics
    first, values = world.part(body).qpos.start, body.kinematics.values()
    joints = {int(address): joint for joint, address in enumerate(world.model.jnt_qposadr)}
    plain = {int(joint) for joint in np.flatnonzero(world.model.jnt_type >= int(mujoco.mjtJoint.mjJNT_SLIDE))}
    for dof, (name, axis) in enumerate(zip(body.scene.dof_names, body.scene.dof_axes, strict=True)):
        reach = _FARTHEST / 2 if axis.circular else _FARTHEST
        low = min(max(float(copy.limits.lower[dof]), -reach), float(values[dof]))
        high = max(min(float(copy.limits.upper[dof]), reach), float(values[dof]))
        rows = np.tile(values, (_SAMPLES, 1))
        rows[:, dof] = np.linspace(low, high, _SAMPLES)
        positions: list[Floats] = []
        for row in rows:
            copy.set_values(row)
            positions.append(copy.qpos[copy.inner_qpos].copy())
        columns = np.array(positions)
        moved: list[int] = np.flatnonzero(np.ptp(columns, axis=0) > 0).tolist() if columns.size else []
        addresses = [(column, joints.get(first + column)) for column in moved]
        tables = {joint: _shortened(columns[:, column]) for column, joint in addresses if joint is not None}
        if tables and plain.issuperset(tables):
            unit = "m" if body.scene.joint_of_dof(dof).slides(0) else "rad"
            yield Slider(f"{body.scene.name} {name}" if several else name, unit, low, high, float(values[dof]), tables)


def _shortened(column: Floats) -> list[float]:
    """Return only the two ends of a column if its values are linear, else all values."""
    line: Floats = np.linspace(float(column[0]), float(column[-1]), len(column))
    return column[[0, -1]].tolist() if np.abs(column - line).max() < _LINEAR else column.tolist()


def _moving(model: mujoco.MjModel, joints: Sequence[int]) -> list[int]:
    """Return the bodies that the given joints move, in MuJoCo's order: parents first."""
    moving = {int(model.jnt_bodyid[joint]) for joint in joints}
    for body in range(1, model.nbody):
        if int(model.body_parentid[body]) in moving:
            moving.add(body)
    return sorted(moving)


def _joint(world: WorldModel, joint: int) -> dict[str, Any]:
    model, address = world.model, int(world.model.jnt_qposadr[joint])
    return {
        "slides": bool(model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE),
        "axis": model.jnt_axis[joint].tolist(),
        "anchor": model.jnt_pos[joint].tolist(),
        "start": float(model.qpos0[address]),
        "value": float(world.data.qpos[address]),
    }


def _placed(world: WorldModel, body: int, moving: Sequence[int], driven: Sequence[int]) -> dict[str, Any]:
    """Return a moving body as JSON data: its driven joints, and its pose in its moving parent, else in the world.

    The pose is that without joint motion or, if the body has no driven joints, the present one.
    """
    model, data = world.model, world.data
    first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
    joints = [joint for joint in range(first, first + count) if joint in driven]
    parent = int(model.body_parentid[body])
    position, quaternion = np.zeros(3), np.zeros(4)
    if joints:
        position, quaternion = model.body_pos[body].copy(), model.body_quat[body].copy()
        if parent not in moving:
            mujoco.mju_mulPose(
                position, quaternion, data.xpos[parent], data.xquat[parent], model.body_pos[body], model.body_quat[body]
            )
    else:  # where it is now, also if a joint that has no slider holds it
        inverse = np.zeros(3), np.zeros(4)
        mujoco.mju_negPose(*inverse, data.xpos[parent], data.xquat[parent])
        mujoco.mju_mulPose(position, quaternion, *inverse, data.xpos[body], data.xquat[body])
    return {
        "body": body,
        "parent": moving.index(parent) if parent in moving else -1,
        "position": position.tolist(),
        "quaternion": quaternion.tolist(),
        "joints": [driven.index(joint) for joint in joints],
    }

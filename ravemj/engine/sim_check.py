"""Check whether a translated model can be simulated, with reasons."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.geom_extents import box, colliding, lowest
from ravemj.engine.translation import Translation
from ravemj.formats.mjcf import legal_inertial
from ravemj.model.bounds import geometry_bounds
from ravemj.model.scene import Link

SECONDS = 2.0
"""Simulated time of the check [s]."""

HOLDS = {False: 0.01, True: 0.001}
"""Maximum error of a servo that holds a pose [rad]; for sliders [m]."""

_STEP = {False: 0.1, True: 0.01}
_OVERSHOOT, _ARRIVAL, _ARRIVED = 0.1, 0.5, 0.9
_ENERGY = 0.05
_SINKS = 0.005
_BOX = 0.01
_DIGITS = 6  # threshold for reported errors; smaller ones are rounding

_SLIDE = mujoco.mjtJoint.mjJNT_SLIDE


@dataclass(slots=True)
class Point:
    """Criterion of a check.

    Attributes:
        name: The criterion.
        value: The measured result, in words.
        missed: Reasons of a failure; empty if passed.
        notes: Harmless assumptions or omissions.
    """

    name: str
    value: str
    missed: list[str] = field(default_factory=list[str])
    notes: list[str] = field(default_factory=list[str])

    def as_json(self) -> dict[str, Any]:
        """Return the criterion as JSON data."""
        words = {"value": self.value, "missed": self.missed, "notes": self.notes}
        return {"point": self.name, "ok": not self.missed, **words}


def check(translation: Translation) -> Iterator[Point]:
    """Yield the results of all checks of a translated model, one by one; together they take seconds."""
    yield _names(translation)
    yield _numbers(translation)
    yield _shapes(translation)
    yield _touching(translation)
    yield _passive(translation)
    if translation.choices.actuators == "position" and translation.model.nu:
        yield _standing(translation) if _is_free(translation) else _holding(translation)
        yield _stepping(translation)


def summary(translation: Translation) -> str:
    """Return one line on how well servos hold the start pose, and which pairs were excluded; may be empty."""
    parts: list[str] = []
    if translation.choices.actuators == "position" and translation.model.nu:
        parts.append(_standing(translation).value if _is_free(translation) else _holding(translation).value)
    if translation.excluded:
        count = len(translation.excluded)
        touching = "1 pair that touches" if count == 1 else f"{count} pairs that touch"
        parts.append(f"{touching} at the start excluded")
    return "; ".join(parts)


def _is_free(translation: Translation) -> bool:
    """Return whether the first joint of a model is a free joint, so that its body can fall."""
    return bool(translation.model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE)


def _names(translation: Translation) -> Point:
    model = translation.model
    missing = [
        f"link '{link}' of '{body.name}' is missing"
        for body, names in zip(translation.bodies, translation.mjcf.names, strict=True)
        for link in names.links
        if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, link) < 0
    ]
    return Point("loads", f"{model.nbody - 1} bodies, {model.njnt} joints, {model.nu} actuators", missing)


def _numbers(translation: Translation) -> Point:
    """Compare total mass with the file; report changed inertias, missing torque limits, unconstrained mimic joints."""
    model, point = translation.model, Point("masses, limits, mimic", "")
    given = sum(link.inertial.mass for body in translation.bodies for link in body.links)
    total = float(model.body_mass.sum())
    for body in translation.bodies:
        for link in body.links:
            legal = legal_inertial(link.inertial)
            if legal is not link.inertial and link.inertial.mass > 0:
                point.notes.append(f"the inertia of '{link.name}' is the nearest legal one")
        for joint in body.joints:
            if any(not axis.max_torque for axis in joint.axes) and not joint.static:
                point.notes.append(f"joint '{joint.name}' has no effort: its actuator is not limited")
    if abs(total - given) > max(1e-6, 1e-6 * abs(given)):
        point.missed.append(f"the mass is {total:.6g} kg, not {given:.6g} kg")
    followers = sum(joint.equation is not None for body in translation.bodies for joint in body.all_joints)
    if model.neq < followers:
        point.missed.append(f"{followers - model.neq} of {followers} mimic joints have no equality")
    point.value = f"{total:.6g} kg, {model.neq} equalities"
    return point


def _shapes(translation: Translation) -> Point:
    """Compare the bounding boxes of each link's shapes and of its geoms in the model."""
    model, point = translation.model, Point("shapes", f"{translation.model.ngeom} geoms")
    if translation.choices.merge_fixed:
        point.notes.append("fixed links are merged: their shapes are not compared")
        return point
    for body, names in zip(translation.bodies, translation.mjcf.names, strict=True):
        for link, name in zip(body.links, names.links, strict=True):
            error = _shapes_off(model, link, name)
            if error is None:
                point.missed.append(f"nothing of '{link.name}' collides")
            elif error > _BOX:
                point.missed.append(f"what collides of '{link.name}' is off by {100 * error:.3g} % of its size")
    return point


def _shapes_off(model: mujoco.MjModel, link: Link, name: str) -> float | None:
    """Return the error of a link's bounding box relative to its diagonal; None without collision shapes."""
    wanted = [geometry_bounds(geometry, np.eye(4)) for geometry in link.geometries]
    wanted = [bounds for bounds in wanted if (bounds.high > bounds.low).any()]
    if not wanted:
        return 0.0
    of_link = model.geom_bodyid == model.body(name).id
    solid = [geom for geom in colliding(model).tolist() if of_link[geom]]
    if not solid:
        return None
    low, high = np.min([bounds.low for bounds in wanted], axis=0), np.max([bounds.high for bounds in wanted], axis=0)
    boxes = [box(model, geom, model.geom_pos[geom], _rotation(model.geom_quat[geom])) for geom in solid]
    first, last = np.min([bounds[0] for bounds in boxes], axis=0), np.max([bounds[1] for bounds in boxes], axis=0)
    return float(max(np.abs(first - low).max(), np.abs(last - high).max()) / np.linalg.norm(high - low))


def _rotation(wxyz: Floats) -> Floats:
    rows = np.zeros(9)
    mujoco.mju_quat2Mat(rows, wxyz)
    return rows.reshape(3, 3)


def _touching(translation: Translation) -> Point:
    model, data = translation.model, translation.home
    pairs = {tuple(sorted(model.body(body).name for body in model.geom_bodyid[touch.geom])) for touch in data.contact}
    excluded = len(translation.excluded)
    point = Point("self-collision", f"{excluded} pair{'' if excluded == 1 else 's'} excluded")
    point.missed = [f"'{first}' and '{second}' touch at the start" for first, second in sorted(pairs)]
    point.notes = [f"'{first}' and '{second}' touch at the start: excluded" for first, second in translation.excluded]
    if not translation.choices.self_collision:
        point.missed.append("self-collision is off")
    return point


def _passive(translation: Translation) -> Point:
    """Simulate without actuators, and check that the energy does not grow."""
    model, data = translation.model, translation.home
    flags, growth, kinetic = model.opt.disableflags, 0.0, 0.0
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION
    first = _energy(model, data).sum()
    for _ in range(round(SECONDS / model.opt.timestep)):
        mujoco.mj_step(model, data)
        energy = _energy(model, data)
        growth, kinetic = max(growth, float(energy.sum() - first)), max(kinetic, float(energy[1]))
    model.opt.disableflags = flags
    part = growth / kinetic if kinetic > 1e-9 else 0.0
    point = Point("without actuators", f"energy grows by {100 * part:.2g} % of the kinetic energy", _warnings(data))
    if part > _ENERGY:
        point.missed.append(f"energy grows by {100 * part:.3g} %")
    return point


def _energy(model: mujoco.MjModel, data: mujoco.MjData) -> Floats:
    """Return potential and kinetic energy [J]."""
    mujoco.mj_kinematics(model, data)  # a step ends before that
    mujoco.mj_comPos(model, data)
    mujoco.mj_makeM(model, data)
    mujoco.mj_energyPos(model, data)
    mujoco.mj_energyVel(model, data)
    return data.energy


def _warnings(data: mujoco.MjData) -> list[str]:
    counts = data.warning.number.tolist()
    return [f"MuJoCo warns: {mujoco.mjtWarning(kind).name}" for kind, count in enumerate(counts) if count]


def droop(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, tuple[float, bool]]:
    """Simulate servos at the start pose; return by name the error [rad or m], and whether the joint is a slider."""
    servos = _servos(model)
    joints = model.actuator_trnid[servos, 0]
    qpos = model.jnt_qposadr[joints]
    target = data.qpos[qpos].copy()
    for _ in range(round(SECONDS / model.opt.timestep)):
        mujoco.mj_step(model, data)
    errors = np.abs(data.qpos[qpos] - target)
    slides = model.jnt_type[joints] == _SLIDE
    names = [model.actuator(number).name for number in servos]
    return dict(zip(names, zip(errors.tolist(), slides.tolist(), strict=True), strict=True))


def _servos(model: mujoco.MjModel) -> list[int]:
    """Return the indices of position servos; other actuators may come from an MJCF fragment of the user."""
    return np.flatnonzero((model.actuator_trntype == 0) & (model.actuator_biasprm[:, 1] != 0)).tolist()


def holding_text(errors: dict[str, tuple[float, bool]]) -> str:
    """Return the largest errors in words, as in ``holds within 0.004 rad``."""
    parts = [
        f"{round(max(error for error, slides in errors.values() if slides is kind), _DIGITS):.2g} {unit}"
        for kind, unit in ((False, "rad"), (True, "m"))
        if any(slides is kind for _, slides in errors.values())
    ]
    return f"holds within {' and '.join(parts)}"


def _holding(translation: Translation) -> Point:
    data = translation.home
    errors = droop(translation.model, data)
    point = Point("holds", _or_unstable(holding_text(errors), data), _warnings(data))
    for name, (error, slides) in errors.items():
        if not error <= HOLDS[slides]:
            point.missed.append(f"joint '{name}' sags by {error:.3g} {'m' if slides else 'rad'}")
    return point


def _or_unstable(words: str, data: mujoco.MjData) -> str:
    return "does not hold: the simulation is unstable" if _warnings(data) else words


def _stepping(translation: Translation) -> Point:
    """Simulate a step response of each servo alone, away from the joint's nearer limit."""
    model, data = translation.model, translation.home
    droop(model, data)
    state = np.zeros(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    targets, worst, slowest = data.ctrl.copy(), 0.0, 0.0
    point = Point("steps", "")
    for number in _servos(model):
        mujoco.mj_setState(model, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
        data.ctrl[:] = targets
        size = _step_size(model, data, number)
        if size:
            over, arrival = _response(model, data, number, size)
            worst, slowest = max(worst, over), max(slowest, arrival)
            if not (over < _OVERSHOOT and arrival <= _ARRIVAL):
                name = model.actuator(number).name
                when = f"takes {arrival:.2g} s" if np.isfinite(arrival) else "does not arrive"
                point.missed.append(f"joint '{name}' overshoots by {100 * over:.2g} % and {when}")
    point.value = f"overshoot {100 * worst:.2g} %, arrival within {slowest:.2g} s"
    return point


def _step_size(model: mujoco.MjModel, data: mujoco.MjData, actuator: int) -> float:
    """Return the signed step for testing a joint's servo [rad or m]; 0 if the joint's limits are too narrow."""
    joint = int(model.actuator_trnid[actuator, 0])
    size = _STEP[bool(model.jnt_type[joint] == _SLIDE)]
    if not model.jnt_limited[joint]:
        return size
    lower, upper = model.jnt_range[joint].tolist()
    before = float(data.qpos[model.jnt_qposadr[joint]])
    size = -size if before - lower > upper - before else size
    return size if upper - lower > 2 * abs(size) else 0.0


def _response(model: mujoco.MjModel, data: mujoco.MjData, actuator: int, size: float) -> tuple[float, float]:
    """Return a servo's overshoot, as a fraction of the step, and 90 % rise time [s], infinite if not reached."""
    place = model.jnt_qposadr[model.actuator_trnid[actuator, 0]]
    before, over, arrival = float(data.qpos[place]), 0.0, np.inf
    data.ctrl[actuator] += size
    for number in range(round(_ARRIVAL / model.opt.timestep)):
        mujoco.mj_step(model, data)
        part = (float(data.qpos[place]) - before) / size
        over = max(over, part - 1.0)
        if part >= _ARRIVED and not np.isfinite(arrival):
            arrival = (number + 1) * model.opt.timestep
    return over, arrival


def _standing(translation: Translation) -> Point:
    """Simulate a robot with a free base standing on a floor at its lowest point."""
    height, _ = lowest(translation.model, translation.home)
    model = translation.on_floor(height)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    before = float(data.qpos[2])
    errors = droop(model, data)
    sunk = before - float(data.qpos[2])
    words = f"sinks by {1000 * sunk:.2g} mm, {holding_text(errors)}"
    point = Point("stands", _or_unstable(words, data), _warnings(data))
    if not abs(sunk) < _SINKS:
        point.missed.append(f"the base sinks by {1000 * sunk:.3g} mm")
    for name, (error, slides) in errors.items():
        if not error <= HOLDS[slides]:
            point.missed.append(f"joint '{name}' gives way by {error:.3g} {'m' if slides else 'rad'}")
    return point

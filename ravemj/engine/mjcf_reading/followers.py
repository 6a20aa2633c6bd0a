"""Conversion of equality constraints of joints and of fixed tendons to mimic joints."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import mujoco
import numpy as np

from ravemj.engine.mjcf_reading.trees import BodyTree
from ravemj.errors import Diagnostics
from ravemj.model.mimic import Equations
from ravemj.model.scene import Axis

_JOINT, _TENDON = int(mujoco.mjtEq.mjEQ_JOINT), int(mujoco.mjtEq.mjEQ_TENDON)
_ONE_AXIS = {int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)}
_SAMPLES = 33
_ROUNDING = 1e-9


class _Follower(NamedTuple):
    """Equation of a mimic joint: a polynomial in one leader's displacement, or linear in those of several leaders.

    Displacements are relative to ``ref``.
    """

    joint: int
    leaders: tuple[int, ...]
    offset: float
    coefficients: tuple[tuple[float, ...], ...]


def add_followers(model: mujoco.MjModel, trees: Sequence[BodyTree], diagnostics: Diagnostics) -> None:
    """Make mimic joints from the active equalities of a model; report unsupported ones once."""
    leaders: dict[int, tuple[int, ...]] = {}
    lost = 0
    for follower in _followers(model):
        tree = next((tree for tree in trees if follower.joint in tree.joints), None)
        if tree is None:  # a body restored from text, which has its equations
            continue
        kinds = {int(model.jnt_type[joint]) for joint in (follower.joint, *follower.leaders)}
        if not tree.joints.keys() >= {*follower.leaders} or not kinds <= _ONE_AXIS or _leads_back(follower, leaders):
            lost += 1
            continue
        leaders[follower.joint] = follower.leaders
        _follow(model, tree, follower)
    if lost:
        message = f"{lost} equalities of joints do not act: they join several bodies, or joints that follow already"
        diagnostics.warn("left-out", message, trees[0].builder.source, "these joints move on their own")


def _leads_back(follower: _Follower, leaders: dict[int, tuple[int, ...]]) -> bool:
    """Return whether a joint is already a mimic joint, or would depend on itself."""
    if follower.joint in leaders:
        return True
    pending, seen = [*follower.leaders], set[int]()
    while pending:
        joint = pending.pop()
        if joint == follower.joint:
            return True
        if joint not in seen:
            seen.add(joint)
            pending += leaders.get(joint, ())
    return False


def _followers(model: mujoco.MjModel) -> Iterator[_Follower]:
    for index in range(model.neq):
        if not model.eq_active0[index]:
            continue
        first, second = int(model.eq_obj1id[index]), int(model.eq_obj2id[index])
        polynomial = [float(part) for part in model.eq_data[index, :5]]
        if model.eq_type[index] == _JOINT:
            leaders = () if second < 0 else (second,)
            yield _Follower(first, leaders, polynomial[0], (tuple(polynomial[1:]),) if leaders else ())
        elif model.eq_type[index] == _TENDON:
            yield from _of_tendons(model, first, second, polynomial)


def _of_tendons(model: mujoco.MjModel, first: int, second: int, polynomial: list[float]) -> Iterator[_Follower]:
    """Yield the equation of two coupled fixed tendons, solved for the first joint of ``first``, if it is linear.

    ``second`` is -1 if there is no second tendon; ``polynomial`` contains MuJoCo's coefficients of the coupling.
    """
    own = _joints_of(model, first)
    other = {} if second < 0 else _joints_of(model, second)
    if own is None or other is None or not own or (other and any(polynomial[2:])):
        return
    follower, factor = next(iter(own.items()))
    terms = {joint: -value for joint, value in own.items() if joint != follower}
    for joint, value in other.items():
        terms[joint] = terms.get(joint, 0.0) + polynomial[1] * value
    if follower not in other:
        slopes = tuple((value / factor,) for value in terms.values())
        yield _Follower(follower, tuple(terms), polynomial[0] / factor, slopes)


def _joints_of(model: mujoco.MjModel, tendon: int) -> dict[int, float] | None:
    """Return the joints of a fixed tendon with their coefficients; None for a spatial one."""
    first = int(model.tendon_adr[tendon])
    wraps = range(first, first + int(model.tendon_num[tendon]))
    if any(model.wrap_type[wrap] != mujoco.mjtWrap.mjWRAP_JOINT for wrap in wraps):
        return None
    by_joint = {int(model.wrap_objid[wrap]): float(model.wrap_prm[wrap]) for wrap in wraps}
    return {joint: value for joint, value in by_joint.items() if value}


def _follow(model: mujoco.MjModel, tree: BodyTree, follower: _Follower) -> None:
    built = tree.joints[follower.joint]
    constant = _reference(model, follower.joint) + follower.offset
    terms: list[str] = []
    slopes: list[str] = []
    for leader, coefficients in zip(follower.leaders, follower.coefficients, strict=True):
        name, zero = tree.joints[leader].name, _reference(model, leader)
        moved = f"({name}-({zero!r}))" if zero else name
        powers = [(place + 1, value) for place, value in enumerate(coefficients) if value]
        terms += [_product(value, moved, power) for power, value in powers]
        derived = [_product(value * power, moved, power - 1) for power, value in powers]
        slopes.append(f"|{name} {'+'.join(derived) or '0'}")
    position = "+".join([*terms, *([f"({constant!r})"] if constant or not terms else [])])
    built.equations = Equations(position, " ".join(slopes), "")
    axis = built.axes[0]
    built.axes = (_with_room(axis, *_image(model, tree, follower, constant)),)


def _reference(model: mujoco.MjModel, joint: int) -> float:
    return float(model.qpos0[model.jnt_qposadr[joint]])


def _product(value: float, factor: str, power: int) -> str:
    factors = [f"({value!r})" if value < 0 else repr(value)]
    if power:
        factors.append(factor if power == 1 else f"{factor}^{power}")
    return "*".join(factors)


def _image(model: mujoco.MjModel, tree: BodyTree, follower: _Follower, constant: float) -> tuple[float, float]:
    """Return the range of a mimic joint within its leaders' limits; ``constant`` is the constant of its equation."""
    low = high = constant
    for leader, coefficients in zip(follower.leaders, follower.coefficients, strict=True):
        axis = tree.joints[leader].axes[0]
        moved = np.linspace(axis.lower, axis.upper, _SAMPLES) - _reference(model, leader)
        values = np.polynomial.polynomial.polyval(moved, (0.0, *coefficients))
        low, high = low + float(values.min()), high + float(values.max())
    return low, high


def _with_room(axis: Axis, low: float, high: float) -> Axis:
    """Return the axis of a mimic joint with limits that contain all its values, since MuJoCo does not clamp it."""
    if axis.circular or (axis.lower - _ROUNDING <= low and high <= axis.upper + _ROUNDING):
        return axis
    lower, upper = min(axis.lower, low), max(axis.upper, high)
    return replace(axis, lower=lower, upper=upper) if math.isfinite(lower + upper) else axis

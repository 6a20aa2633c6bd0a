"""Mimic joints: equations as expressions over a body's joints, and their evaluation."""

import math
from collections.abc import Callable, Sequence
from itertools import accumulate
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.core.graphs import topological_order
from ravemj.core.transforms import Floats
from ravemj.errors import Diagnostics, Source
from ravemj.model.scene import Joint, Mimic

if TYPE_CHECKING:
    from ravemj.model.expressions import Expression


class Equations(NamedTuple):
    """Mimic equations as written, with names of other joints; ``position`` may be empty."""

    position: str = ""
    velocity: str = ""
    acceleration: str = ""


class NamedJoint(NamedTuple):
    """Joint with the data that are needed to resolve mimic equations.

    Attributes:
        name: The name.
        dof: Number of DOFs; 0 for a passive joint.
        equations: Its mimic equations, or None.
        source: Its position in a file.
    """

    name: str
    dof: int
    equations: Equations | None
    source: Source


def resolve(joints: Sequence[NamedJoint], diagnostics: Diagnostics) -> dict[int, Mimic]:
    """Return the mimic relation of each mimic joint by index; empty if any equation is invalid, as in OpenRAVE.

    Joints are active ones in DOF order, then passive ones.
    """
    if not any(joint.equations for joint in joints):
        return {}
    from ravemj.model.expressions import (  # noqa: PLC0415 - rarely wanted
        ExpressionError,
        before_substitution,
        joint_variables,
        parse,
        substitute,
    )

    mimics: dict[int, Expression] = {}
    variables = joint_variables([joint.name for joint in joints])
    known = {f"joint{index}" for index, joint in enumerate(joints) if joint.dof <= 1}
    for index, joint in enumerate(joints):
        text = joint.equations.position if joint.equations is not None else ""
        if not text:
            continue
        try:
            mimics[index] = parse(substitute(text, variables), known)
        except ExpressionError as error:
            problem = before_substitution(error, text, variables).message
            hint = "without it, no joint of this body follows another"
            diagnostics.warn("bad-mimic", f"joint '{joint.name}' cannot follow: {problem}", joint.source, hint)
    if len(mimics) < sum(1 for joint in joints if joint.equations and joint.equations.position):
        return {}
    ends = list(accumulate(joint.dof for joint in joints))
    dofs = [range(end - joint.dof, end) for joint, end in zip(joints, ends, strict=True)]
    resolved: dict[int, Mimic] = {}
    for index, expression in mimics.items():
        joint, followed = joints[index], _followed(index, mimics)
        equations = joint.equations or Equations()
        if index in followed:
            message = f"joint '{joint.name}' follows itself through others; none of them moves"
            diagnostics.warn("bad-mimic", message, joint.source)
            resolved[index] = Mimic(*equations, None, ())
        else:
            resolved[index] = Mimic(
                *equations,
                expression,
                tuple(sorted({dof for followed_joint in followed for dof in dofs[followed_joint]})),
            )
    return resolved


def leaders(expression: "Expression") -> tuple[int, ...]:
    """Return the indices of the joints that an expression depends on."""
    return tuple(int(name.removeprefix("joint")) for name in expression.variables)


def _followed(index: int, mimics: "dict[int, Expression]") -> set[int]:
    """Return the joints on which mimic joint ``index`` depends, directly or indirectly."""
    pending, followed = [index], set[int]()
    while pending:
        current = pending.pop()
        fresh = set(leaders(mimics[current]) if current in mimics else ()) - followed
        followed |= fresh
        pending += fresh
    return followed


def evaluation_order(mimics: dict[int, Mimic]) -> list[int]:
    """Return the mimic joints in order of evaluation, without mimic joints that form a cycle."""
    moving = {index: mimic.expression for index, mimic in mimics.items() if mimic.expression is not None}
    return topological_order(moving, lambda index: [leader for leader in leaders(moving[index]) if leader in moving])


class Multiple(NamedTuple):
    """Equation ``slope * x + offset`` within limits, the form of nearly all mimic joints.

    Attributes:
        leader: The joint whose first value is x.
        slope: The factor of x.
        offset: The constant term.
        lower: Lower limit of the result [rad or m].
        upper: Upper limit of the result [rad or m].
    """

    leader: int
    slope: float
    offset: float
    lower: float
    upper: float

    def follow(self, x: float, clamp: bool = True) -> float:
        """Return the value of the mimic joint, within its limits if ``clamp``."""
        value = self.slope * x + self.offset
        if not clamp:
            return value
        value = self.lower if value < self.lower else value
        return self.upper if value > self.upper else value

    def follow_many(self, x: Floats) -> Floats:
        """Return the values of the mimic joint for many configurations, within its limits, shape (n,)."""
        return np.clip(self.slope * x + self.offset, self.lower, self.upper)


class MimicJoint(NamedTuple):
    """Joint whose value is a function of other joint values.

    Attributes:
        joint: Its index among active, then passive joints.
        expression: The function of ``joint0``, ``joint1``, …
        multiple: The affine form of ``expression`` in one joint, or None.
        evaluate: Evaluation of ``expression`` from the first values of all joints; None if ``multiple`` is given.
        lower: Its lower limit [rad or m].
        upper: Its upper limit; circular joints have none.
    """

    joint: int
    expression: "Expression"
    multiple: Multiple | None
    evaluate: Callable[[Sequence[float]], float] | None
    lower: float
    upper: float


class MimicJoints:
    """Mimic joints of a body, prepared for evaluation.

    Attributes:
        joints: The mimic joints in order of evaluation.
    """

    def __init__(self, joints: Sequence[Joint]) -> None:
        """Prepare the mimic joints in the list of active, then passive joints."""
        mimics = {i: joint.mimic for i, joint in enumerate(joints) if joint.mimic is not None and not joint.static}
        self.joints = [_prepared(index, joints) for index in evaluation_order(mimics)]

    def evaluate(self, values: list[float], *, clamp: bool = True) -> None:
        """Compute the values of the mimic joints from the others in place, within limits if ``clamp``.

        ``values`` has the first value of each joint [rad or m], active joints and then passive ones.
        """
        for index, _, multiple, evaluate, lower, upper in self.joints:
            if multiple is not None:
                values[index] = multiple.follow(values[multiple.leader], clamp=clamp)
            elif evaluate is not None:
                value = evaluate(values)
                values[index] = min(max(value, lower), upper) if clamp else value

    def evaluate_many(self, values: list[Floats]) -> None:
        """Compute the values of the mimic joints in place for N configurations; ``values`` are arrays (N,)."""
        for joint, expression, _, _, lower, upper in self.joints:
            named = {f"joint{leader}": values[leader] for leader in leaders(expression)}
            followed = np.broadcast_to(expression.evaluate_many(named), np.shape(values[joint]))
            values[joint] = np.clip(followed, lower, upper)


def _prepared(index: int, joints: Sequence[Joint]) -> MimicJoint:
    equation, axis = joints[index].equation, joints[index].axes[0]
    assert equation is not None
    limits = (-math.inf, math.inf) if axis.circular else (axis.lower, axis.upper)
    if equation.affine is None or len(equation.affine.slopes) != 1:
        compiled = equation.compiled([f"joint{number}" for number in range(len(joints))])
        return MimicJoint(index, equation, None, compiled, *limits)
    offset, ((name, slope),) = equation.affine.offset, equation.affine.slopes.items()
    leader = int(name.removeprefix("joint"))
    return MimicJoint(index, equation, Multiple(leader, slope, offset, *limits), None, *limits)

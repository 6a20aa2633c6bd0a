"""How the movers of a body follow its DOFs.

``qvel = P(q) dq/dt``: P is constant but for followers and spherical joints. By virtual work the generalised forces of
the DOFs are ``P^T`` times those of the movers.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ravemj.dynamics.tree import Tree
from ravemj.kinematics import WELDED, Ball, BodyKinematics, Follower
from ravemj.transforms import Floats, Ints, rows_from_wxyz

if TYPE_CHECKING:
    from ravemj.expressions import Expression

Gradient = dict[int, Floats]
Hessian = dict[tuple[int, int], Floats]

SMALL = 0.1
"""Below this angle [rad] series are exact where closed formulas lose digits."""


@dataclass(frozen=True, slots=True)
class Slopes:
    """P and its derivative at given joint values, of one configuration or of many (a last axis).

    Attributes:
        dof: How many DOFs there are.
        count: How many movers there are.
        dofs: The DOFs that move a mover one to one.
        movers: These movers.
        first: Further entries of P: mover, DOF, value.
        second: Entries of P's derivative: mover, the DOF that changes, the DOF of the column, value.
    """

    dof: int
    count: int
    dofs: Ints
    movers: Ints
    first: list[tuple[int, int, Floats]]
    second: list[tuple[int, int, int, Floats]]

    def forward(self, rates: Floats) -> Floats:
        """Return the movers' velocities of those of the DOFs, shape (dof, ...) to (movers, ...)."""
        moved = np.zeros((self.count, *rates.shape[1:]))
        moved[self.movers] = rates[self.dofs]
        for mover, dof, value in self.first:
            moved[mover] += value * rates[dof]
        return moved

    def backward(self, forces: Floats) -> Floats:
        """Return P^T times something, shape (movers, ...) to (dof, ...)."""
        collected = np.zeros((self.dof, *forces.shape[1:]))
        collected[self.dofs] = forces[self.movers]
        for mover, dof, value in self.first:
            collected[dof] += value * forces[mover]
        return collected

    def bend(self, rates: Floats) -> Floats:
        """Return the movers' accelerations while the DOFs keep their velocities, shape (dof, ...) to (movers, ...)."""
        bent = np.zeros((self.count, *rates.shape[1:]))
        for mover, along, dof, value in self.second:
            bent[mover] += value * rates[along] * rates[dof]
        return bent


class VelocityMap:
    """The map from DOF velocities to those of the movers, at any joint values."""

    def __init__(self, kinematics: BodyKinematics, tree: Tree) -> None:
        self._kinematics = kinematics
        mover_of = tree.mover_of_qpos(kinematics.model)
        dofs = np.flatnonzero(kinematics.qpos_indices != WELDED)
        movers = np.array([mover_of[qpos] for qpos in kinematics.qpos_indices[dofs].tolist()], dtype=int)
        self._one_to_one = kinematics.dof, tree.count, dofs, movers
        self._balls = [(ball, mover_of[ball.qpos.start]) for ball in kinematics.balls]
        self._followers = [
            (follower, mover_of.get(follower.qpos, WELDED), _Partials(self._expression(follower)))
            for follower in kinematics.followers
        ]
        self._plain = None if self._balls or self._followers else Slopes(*self._one_to_one, [], [])

    @property
    def is_constant(self) -> bool:
        """Whether P is the same at all joint values."""
        return self._plain is not None

    def _expression(self, follower: Follower) -> "Expression":
        body = self._kinematics.body
        expression = (*body.joints, *body.passive_joints)[follower.joint].equation
        assert expression is not None
        return expression

    def at(self, values: Floats, *, second: bool = True) -> Slopes:
        """Return P and its derivative.

        Args:
            values: Joint values [rad or m], shape (dof,) or (dof, N).
            second: Whether the derivative is wanted.
        """
        if self._plain is not None:
            return self._plain
        slopes = Slopes(*self._one_to_one, [], [])
        for ball, mover in self._balls:
            _add_ball(slopes, ball, mover, values[ball.dofs], second=second)
        self._add_followers(slopes, values, second=second)
        return slopes

    def _add_followers(self, slopes: Slopes, values: Floats, *, second: bool) -> None:
        kinematics = self._kinematics
        known = dict(enumerate(first_values(kinematics, values)))
        gradients: dict[int, Gradient] = {index: {dof: np.ones(())} for index, dof in enumerate(kinematics.first_dofs)}
        hessians: dict[int, Hessian] = {index: {} for index in gradients}
        for follower, mover, partials in self._followers:
            named = {name: known[_index(name)] for name in partials.names}
            known[follower.joint] = _value(partials.expression, named, values)
            gradient, hessian = partials.chain(named, values, gradients, hessians if second else None)
            gradients[follower.joint], hessians[follower.joint] = gradient, hessian
            if mover != WELDED:
                slopes.first.extend((mover, dof, value) for dof, value in gradient.items())
                slopes.second.extend((mover, *pair, value) for pair, value in hessian.items())


class _Partials:
    """An equation with its derivatives, which are made when they are first wanted."""

    def __init__(self, expression: "Expression") -> None:
        self.expression = expression
        self.names = expression.variables

    @cached_property
    def _first(self) -> "dict[str, Expression]":
        return {name: self.expression.derivative(name) for name in self.names}

    @cached_property
    def _second(self) -> "dict[tuple[str, str], Expression]":
        pairs = [(one, other) for one in self.names for other in self.names]
        return {(one, other): self._first[one].derivative(other) for one, other in pairs}

    def chain(
        self,
        named: dict[str, Floats],
        values: Floats,
        gradients: dict[int, Gradient],
        hessians: dict[int, Hessian] | None,
    ) -> tuple[Gradient, Hessian]:
        """Return the derivatives by the DOFs, from those of the joints that are followed."""
        gradient: Gradient = {}
        hessian: Hessian = {}
        moving = [name for name in self.names if _index(name) in gradients]
        for name in moving:
            slope = _value(self._first[name], named, values)
            for dof, value in gradients[_index(name)].items():
                gradient[dof] = gradient.get(dof, 0.0) + slope * value
            for pair, value in ({} if hessians is None else hessians[_index(name)]).items():
                hessian[pair] = hessian.get(pair, 0.0) + slope * value
        for one, other in self._second if hessians is not None else ():
            if one in moving and other in moving:
                curve = _value(self._second[one, other], named, values)
                for i, first in gradients[_index(one)].items():
                    for j, then in gradients[_index(other)].items():
                        hessian[i, j] = hessian.get((i, j), 0.0) + curve * first * then
        return gradient, hessian


def first_values(kinematics: BodyKinematics, values: Floats) -> list[Floats]:
    """Return the first value of each joint, active ones and then passive ones, for values of shape (dof, ...)."""
    passive = [np.full(values.shape[1:], first) for first in kinematics.first_values(np.zeros(kinematics.dof))]
    return [*(values[first] for first in kinematics.first_dofs), *passive[len(kinematics.first_dofs) :]]


def _index(name: str) -> int:
    return int(name.removeprefix("joint"))


def _value(expression: "Expression", named: dict[str, Floats], values: Floats) -> Floats:
    """Return an expression's value in one configuration, or in each of many."""
    wanted = {name: named[name] for name in expression.variables}
    if values.ndim > 1:
        return np.broadcast_to(expression.evaluate_many(wanted), values.shape[1:])
    return np.asarray(expression.evaluate({name: float(value) for name, value in wanted.items()}))


def _add_ball(slopes: Slopes, ball: Ball, mover: int, vector: Floats, *, second: bool) -> None:
    """Add the entries of a spherical joint, whose movers turn about the axes of the child link."""
    rest = np.array(rows_from_wxyz(ball.joint.T_parent_child.wxyz)).T
    rate, changes = rotation_rate(vector)
    first = ball.dofs.start
    for (row, column), value in _entries(np.tensordot(rest, rate, 1)):
        slopes.first.append((mover + row, first + column, value))
    for along, change in enumerate(changes if second else ()):
        for (row, column), value in _entries(np.tensordot(rest, change, 1)):
            slopes.second.append((mover + row, first + along, first + column, value))


def _entries(matrix: Floats) -> "list[tuple[tuple[int, int], Floats]]":
    return [((row, column), matrix[row, column]) for row in range(3) for column in range(3)]


def rotation_rate(vector: Floats) -> tuple[Floats, list[Floats]]:
    """Return the matrix that takes the rate of a rotation vector to the angular velocity in the turned axes.

    The right Jacobian of SO(3), I - a [v] + b [v]^2 with a = (1 - cos t) / t^2, b = (t - sin t) / t^3 and t = |v|.

    Args:
        vector: Shape (3, ...).

    Returns:
        The matrix, shape (3, 3, ...), and its derivatives by the three components of the vector.
    """
    square = (vector * vector).sum(axis=0)
    a, a_slope = _series(square, 2)
    b, b_slope = _series(square, 3)
    eye = np.eye(3).reshape(3, 3, *[1] * (vector.ndim - 1)) + 0 * square
    units = [_crossing(column) for column in eye.swapaxes(0, 1)]
    skew = _crossing(vector)
    twice = _product(skew, skew)
    changes = [
        2 * vector[i] * (b_slope * twice - a_slope * skew)
        - a * unit
        + b * (_product(unit, skew) + _product(skew, unit))
        for i, unit in enumerate(units)
    ]
    return eye - a * skew + b * twice, changes


def _series(square: Floats, first: int) -> tuple[Floats, Floats]:
    """Return the sum of (-1)^k s^k / (2k + first)! over k, and its derivative by s."""
    terms = [(-1) ** k / math.factorial(2 * k + first) for k in range(6)]
    small = np.polynomial.polynomial.polyval(square, terms)
    small_slope = np.polynomial.polynomial.polyval(square, [k * term for k, term in enumerate(terms)][1:])
    s = np.maximum(square, SMALL**2)
    t = np.sqrt(s)
    sine, cosine = np.sin(t), np.cos(t)
    if first == 2:
        large, large_slope = (1 - cosine) / s, (t * sine / 2 - (1 - cosine)) / s**2
    else:
        large, large_slope = (t - sine) / (s * t), ((1 - cosine) / 2 - 1.5 * (t - sine) / t) / s**2
    is_small = square < SMALL**2
    return np.where(is_small, small, large), np.where(is_small, small_slope, large_slope)


def _crossing(vector: Floats) -> Floats:
    """Return the matrix that takes the cross product with a vector, shape (3, 3, ...)."""
    x, y, z = vector
    zero = np.zeros_like(x)
    return np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]])


def _product(one: Floats, other: Floats) -> Floats:
    return np.einsum("ij...,jk...->ik...", one, other)

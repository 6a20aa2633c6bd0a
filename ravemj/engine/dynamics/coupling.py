"""Coupling of a body's velocity coordinates to its DOFs.

``qvel = P(q) dq/dt`` with the coupling matrix P, which is constant except for mimic joints with nonlinear equations and
for spherical joints. By virtual work the generalised forces of the DOFs are ``P^T`` times those of the coordinates.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats, Ints, rows_from_wxyz
from ravemj.engine.dynamics.tree import CoordinateTree
from ravemj.engine.kinematics import NO_QPOS, BodyKinematics, SphericalJoint

if TYPE_CHECKING:
    from ravemj.model.expressions import Expression

Gradient = dict[int, Floats]
Hessian = dict[tuple[int, int], Floats]

SMALL = 0.1
"""Angle [rad] below which series are used, since closed formulas lose accuracy."""


@dataclass(frozen=True, slots=True)
class Coupling:
    """Coupling matrix P and its derivative at given joint values, of one or many configurations (last axis)."""

    dof: int  # number of DOFs
    count: int  # number of velocity coordinates
    dofs: Ints  # the DOFs that equal a coordinate
    coordinates: Ints  # these coordinates
    first: list[tuple[int, int, Floats]]  # other entries of P: coordinate, DOF, value
    second: list[tuple[int, int, int, Floats]]  # of P's derivative: coordinate, DOF that changes, DOF of column, value

    def forward(self, rates: Floats) -> Floats:
        """Return P times the DOF velocities ``rates``, shape (dof, ...): the velocities of the coordinates."""
        moved = np.zeros((self.count, *rates.shape[1:]))
        moved[self.coordinates] = rates[self.dofs]
        for coordinate, dof, value in self.first:
            moved[coordinate] += value * rates[dof]
        return moved

    def backward(self, forces: Floats) -> Floats:
        """Return P^T times the coordinate forces ``forces``, shape (coordinates, ...): the forces on the DOFs."""
        collected = np.zeros((self.dof, *forces.shape[1:]))
        collected[self.dofs] = forces[self.coordinates]
        for coordinate, dof, value in self.first:
            collected[dof] += value * forces[coordinate]
        return collected

    def bias(self, rates: Floats) -> Floats:
        """Return the coordinates' accelerations at constant DOF velocities, dP/dt dq/dt, shape (coordinates, ...)."""
        bias = np.zeros((self.count, *rates.shape[1:]))
        for coordinate, along, dof, value in self.second:
            bias[coordinate] += value * rates[along] * rates[dof]
        return bias


class CouplingMap:
    """Coupling matrix of a body as a function of joint values."""

    def __init__(self, kinematics: BodyKinematics, tree: CoordinateTree) -> None:
        self._kinematics = kinematics
        dofs = np.flatnonzero(kinematics.qpos_indices != NO_QPOS)
        coordinates = np.array([tree.of_qpos[qpos] for qpos in kinematics.qpos_indices[dofs].tolist()], dtype=int)
        self._one_to_one = kinematics.dof, tree.count, dofs, coordinates
        self._spherical = [(spherical, tree.of_qpos[spherical.qpos.start]) for spherical in kinematics.spherical]
        self._mimic = [
            (mimic.joint, self._coordinate(tree, mimic.joint), _Partials(mimic.expression))
            for mimic in kinematics.mimic.joints
        ]
        is_affine = all(mimic.expression.affine is not None for mimic in kinematics.mimic.joints)
        self.constant: Coupling | None = None  # the coupling, if it is constant
        if is_affine and not self._spherical:
            self.constant = self._at(np.zeros(kinematics.dof), second=False)
        self.is_one_to_one = not (self._spherical or self._mimic)  # every velocity coordinate is that of one DOF

    def _coordinate(self, tree: CoordinateTree, joint: int) -> int:
        places = self._kinematics.joint_qpos[joint]
        return tree.of_qpos[places[0]] if places else NO_QPOS

    def at(self, values: Floats, *, second: bool = True) -> Coupling:
        """Return the coupling at joint values [rad or m], (dof,) or (dof, N); with its derivative if ``second``."""
        return self.constant or self._at(values, second=second)

    def _at(self, values: Floats, *, second: bool) -> Coupling:
        coupling = Coupling(*self._one_to_one, [], [])
        for joint, coordinate in self._spherical:
            _add_spherical(coupling, joint, coordinate, values[joint.dofs], second=second)
        self._add_mimic(coupling, values, second=second)
        return coupling

    def _add_mimic(self, coupling: Coupling, values: Floats, *, second: bool) -> None:
        kinematics = self._kinematics
        known = dict(enumerate(first_values(kinematics, values)))
        gradients: dict[int, Gradient] = {index: {dof: np.ones(())} for index, dof in enumerate(kinematics.first_dofs)}
        hessians: dict[int, Hessian] = {index: {} for index in gradients}
        for index, coordinate, partials in self._mimic:
            named = {name: known[_index(name)] for name in partials.names}
            known[index] = _value(partials.expression, named, values)
            gradient, hessian = partials.chain(named, values, gradients, hessians if second else None)
            gradients[index], hessians[index] = gradient, hessian
            if coordinate != NO_QPOS:
                coupling.first.extend((coordinate, dof, value) for dof, value in gradient.items())
                coupling.second.extend((coordinate, *pair, value) for pair, value in hessian.items())


class _Partials:
    """Mimic equation with its derivatives, computed on first use."""

    def __init__(self, expression: "Expression") -> None:
        self.expression = expression
        self.names = expression.variables

    @cached_property
    def _first(self) -> "dict[str, Expression]":
        return {name: self.expression.derivative(name) for name in self.names}

    @cached_property
    def _second(self) -> "dict[tuple[str, str], Expression]":
        pairs = [(first, other) for first in self.names for other in self.names]
        return {(first, other): self._first[first].derivative(other) for first, other in pairs}

    def chain(
        self,
        named: dict[str, Floats],
        values: Floats,
        gradients: dict[int, Gradient],
        hessians: dict[int, Hessian] | None,
    ) -> tuple[Gradient, Hessian]:
        """Return gradient and Hessian of a mimic joint with respect to the DOFs, by the chain rule over its leaders."""
        gradient: Gradient = {}
        hessian: Hessian = {}
        moving = [name for name in self.names if _index(name) in gradients]
        for name in moving:
            slope = _value(self._first[name], named, values)
            for dof, value in gradients[_index(name)].items():
                gradient[dof] = gradient.get(dof, 0.0) + slope * value
            for pair, value in ({} if hessians is None else hessians[_index(name)]).items():
                hessian[pair] = hessian.get(pair, 0.0) + slope * value
        for first_name, other in self._second if hessians is not None else ():
            if first_name in moving and other in moving:
                curve = _value(self._second[first_name, other], named, values)
                for i, first in gradients[_index(first_name)].items():
                    for j, then in gradients[_index(other)].items():
                        hessian[i, j] = hessian.get((i, j), 0.0) + curve * first * then
        return gradient, hessian


def first_values(kinematics: BodyKinematics, values: Floats) -> list[Floats]:
    """Return the value of the first axis of each joint, active joints first, for DOF values (dof, ...)."""
    passive = [np.full(values.shape[1:], first) for first in kinematics.first_values(np.zeros(kinematics.dof))]
    return [*(values[first] for first in kinematics.first_dofs), *passive[len(kinematics.first_dofs) :]]


def _index(name: str) -> int:
    return int(name.removeprefix("joint"))


def _value(expression: "Expression", named: dict[str, Floats], values: Floats) -> Floats:
    """Return an expression's value in one configuration, or in many if ``values`` has two axes."""
    wanted = {name: named[name] for name in expression.variables}
    if values.ndim > 1:
        return np.broadcast_to(expression.evaluate_many(wanted), values.shape[1:])
    return np.asarray(expression.evaluate({name: float(value) for name, value in wanted.items()}))


def _add_spherical(coupling: Coupling, joint: SphericalJoint, coordinate: int, vector: Floats, *, second: bool) -> None:
    """Add a spherical joint to a coupling; its MuJoCo velocities are about the axes of the child link."""
    rest = np.array(rows_from_wxyz(joint.joint.T_parent_child.wxyz)).T
    rate, changes = rotation_rate(vector)
    first = joint.dofs.start
    for (row, column), value in _entries(np.tensordot(rest, rate, 1)):
        coupling.first.append((coordinate + row, first + column, value))
    for along, change in enumerate(changes if second else ()):
        for (row, column), value in _entries(np.tensordot(rest, change, 1)):
            coupling.second.append((coordinate + row, first + along, first + column, value))


def _entries(matrix: Floats) -> "list[tuple[tuple[int, int], Floats]]":
    return [((row, column), matrix[row, column]) for row in range(3) for column in range(3)]


def rotation_rate(vector: Floats) -> tuple[Floats, list[Floats]]:
    """Return the right Jacobian of SO(3): angular velocity in rotated axes per rate of a rotation vector.

    It is I - a [v] + b [v]^2 with a = (1 - cos t) / t^2, b = (t - sin t) / t^3 and t = |v|. For a vector (3, ...) it
    has shape (3, 3, ...), and so have its derivatives by the vector's three components.
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
    """Return f(s), the sum of (-1)^k s^k / (2k + first)! over k, as in sin and cos of √s, and df/ds."""
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
    """Return the cross product matrix of a vector, shape (3, 3, ...)."""
    x, y, z = vector
    zero = np.zeros_like(x)
    return np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]])


def _product(first: Floats, other: Floats) -> Floats:
    return np.einsum("ij...,jk...->ik...", first, other)

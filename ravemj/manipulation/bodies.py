"""Moving bodies of a planning problem as one configuration: limits and collision checks."""

from collections.abc import Callable, Generator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from ravemj.core.blocks import block, restoring
from ravemj.core.transforms import Floats, Vec3
from ravemj.engine.affine import translation_columns
from ravemj.engine.collision.findings import Checker, Findings
from ravemj.engine.collision.moving import MovingTest, moved_world, moving_test
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.queries import MovedBy, body_and_others, itself, touching_region
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.engine.simulation.body import SavedConfiguration
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.affine import Z_AXIS, DOFAffine, RaveGetAffineDOF, affine_values, pose_with_values
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.planning.constrained_edges import ConstrainedEdges, Manifold
from ravemj.planning.edges import Allowed, Edges
from ravemj.planning.space import Coordinates, Space
from ravemj.trajectories.extraction import rotation_columns
from ravemj.trajectories.groups import AFFINE, IK, JOINTS, Group, affine_parts, ik_type, joint_indices

if TYPE_CHECKING:
    from ravemj.manipulation.certification import Certifier

FREE, ENV_COLLISION, SELF_COLLISION, USER = 0, 1, 2, 0x8000
"""Reasons for rejecting a configuration: bits of OpenRAVE's ``ConstraintFilterOptions``; ``USER``: user callbacks."""

ALL = 0xFFFF
"""All tests that a configuration of a path has to pass."""

_UNLIMITED = {"lower": -np.inf, "upper": np.inf, "max_jerk": np.inf}
"""Limits and other axis properties of values without a joint: IK goals, and poses without a body."""

_NO_BODY = "__dummy__"
"""Body name that ``RaveGetAffineConfigurationSpecification`` uses without a body."""

_RESOLUTION = 0.02
"""OpenRAVE's default for the step of collision tests along a value [rad or m]."""

_ROUND = np.pi  # samples of a circular joint are drawn from [-pi, pi], since the joint has no limits of its own

_FULL_TURN = 2 * np.pi
"""Sampling limits of rotation vectors [rad]. OpenRAVE's limit of 10000 would put hardly any sample near the start."""


@dataclass(frozen=True)
class Part:
    """Joints of one body, or its pose, as columns of a configuration.

    Attributes:
        body: The body.
        columns: The columns of a configuration that hold the joint values or the pose.
        dofs: The DOF indices of the joints; empty for a pose.
        affine: The components of the pose, bits of ``DOFAffine``; 0 for joints.
        axis: The axis of ``DOFAffine.RotationAxis``.
    """

    body: BodyState
    columns: slice
    dofs: tuple[int, ...]
    affine: int
    axis: Vec3


class Bodies:
    """The bodies of a planning problem: joints and poses, in the order of the groups of a configuration specification.

    Args:
        simulation: The world that contains the bodies.
        groups: Groups of joint values, of poses, and of goals of inverse kinematics. Goals do not move a body, nor do
            poses of ``__dummy__``, OpenRAVE's name for no body.
        checker: Returns the collision checker.

    Attributes:
        parts: The moving parts.
        bodies: The moving bodies.
        dof: The number of values of a configuration.

    Raises:
        ArgumentError: a group names a body that is not in the world, or a DOF that its body does not have.
    """

    def __init__(self, simulation: Simulation, groups: Sequence[Group], checker: Callable[[], Checker]) -> None:
        self._simulation, self._checker = simulation, checker
        self.lock = simulation.lock
        moving = [group for group in groups if group.kind in {JOINTS[0], AFFINE[0]} and not _is_unbound(group)]
        self.parts = [_part(simulation, group) for group in moving]
        self._unbound = [group for group in groups if _is_unbound(group)]
        self.dof = max((part.columns.stop for part in (*self.parts, *self._unbound)), default=0)
        self.bodies = list(dict.fromkeys(part.body for part in self.parts))
        self._free: set[BodyState] = set()  # bodies whose joints do not move, and which need no self-collision checks

    def numbers(self, name: str) -> Floats:
        """Return the field ``name`` of each joint's ``scene.Axis``, shape (n,); for poses and goals, 0 or no limit."""
        result = np.zeros(self.dof)
        for part in self.parts:
            axes = part.body.scene.dof_axes
            if part.dofs:
                result[part.columns] = [getattr(axes[dof], name) for dof in part.dofs]
        for group in self._unbound:
            result[group.columns] = _UNLIMITED.get(name, 0.0)
        return result

    def coordinates(self) -> Coordinates:
        """Return the type of each configuration value: circular angle, position or quaternion."""
        circular = np.zeros(self.dof, dtype=bool)
        translation: list[int] = []
        rotation: list[int] = []
        poses = [(part.columns, part.affine) for part in self.parts if not part.dofs]
        poses += [(group.columns, int(affine_parts(group)[0])) for group in self._unbound if group.kind == AFFINE[0]]
        for part in self.parts:
            if part.dofs:
                axes = part.body.scene.dof_axes
                circular[part.columns] = [axes[dof].circular for dof in part.dofs]
        for place, affine in poses:
            columns = range(place.start, place.stop)
            kind, turning = rotation_columns(Group(f"{AFFINE[0]} _ {affine}", 0, len(columns)))
            rotation += columns[turning] if kind else []
            translation += [column for column in columns if column not in rotation]
            if kind == DOFAffine.RotationAxis:
                circular[columns[-1]] = True
        for group in self._unbound:
            if group.kind == IK[0] and ik_type(group) == IkParameterizationType.Transform6D:
                rotation += range(group.offset, group.offset + 4)
                translation += range(group.offset + 4, group.offset + 7)
        return Coordinates(circular, tuple(translation), tuple(rotation))

    def described(self, column: int) -> str:
        """Return a description of the value in one column, such as ``joint 'elbow'``."""
        part = next((part for part in self.parts if column in range(self.dof)[part.columns]), None)
        if part is None:  # a goal of inverse kinematics, or a pose of no body
            return f"value {column}"
        index, scene = range(self.dof)[part.columns].index(column), part.body.scene
        if part.dofs:
            return f"joint '{scene.joint_of_dof(part.dofs[index]).name}'"
        return f"value {index} of the pose of '{scene.name}'"

    def near_others(self, space: Space, ends: Floats) -> Space:
        """Return a space that restricts the base position to a box around other bodies, starts and goals.

        Any path could be moved into this box without new collisions. Samples within OpenRAVE's base limits of 100 m are
        rarely near an obstacle.

        Args:
            space: The configuration space.
            ends: The starts and goals, shape (m, n).
        """
        moved = [part for part in self.parts if not part.dofs and translation_columns(part.affine)]
        if not moved or len(self.bodies) != 1:
            return space
        region = touching_region(self.bodies[0])
        lower, upper = space.lower.copy(), space.upper.copy()
        for part in moved:
            for column, axis in enumerate(translation_columns(part.affine), part.columns.start):
                low, high = ends[:, column].min(), ends[:, column].max()
                if region is not None:
                    low, high = min(low, region.low[axis]), max(high, region.high[axis])
                lower[column], upper[column] = max(low, lower[column]), min(high, upper[column])
        return replace(space, lower=lower, upper=upper)

    def values(self) -> Floats:
        """Return the current configuration, shape (n,)."""
        result = np.zeros(self.dof)
        with self._simulation.lock:
            for part in self.parts:
                if part.dofs:
                    result[part.columns] = part.body.kinematics.values()[list(part.dofs)]
                else:
                    result[part.columns] = affine_values(part.body.pose(), DOFAffine(part.affine), part.axis)
        return result

    def move(self, values: Floats) -> None:
        """Move the bodies to a configuration without checking limits. The caller holds the lock."""
        for part in self.parts:
            state = part.body
            if part.dofs:
                kinematics = state.kinematics
                full = kinematics.values()
                full[list(part.dofs)] = values[part.columns]
                state.set_values(full)
            else:
                state.set_pose(pose_with_values(state.pose(), values[part.columns], DOFAffine(part.affine), part.axis))

    @block
    def kept(self) -> Generator[None]:
        """Context manager that acquires the lock, and restores the configurations of bodies and grabbed bodies."""
        with self._simulation.lock:
            self._free.clear()
            held = [grab.body for state in self.bodies for grab in state.grabs]
            saved = [(state, state.configuration()) for state in [*self.bodies, *held]]
            stamps = [state.stamp for state, _ in saved]
            with restoring(lambda: _restore(saved, stamps)):
                yield

    def world(self) -> CollisionWorld | None:
        """Return the collision world at the present poses; None if a user's checker decides about collisions."""
        return self._simulation.collisions() if self._checker().is_plain else None

    def placement(self) -> Callable[[Floats], object]:
        """Return a function that moves the shapes of the collision world to a configuration.

        Use it within ``kept``, without other changes of the world; the bodies themselves may stay.
        """
        fast = moved_world(self.parts[0].body, self.parts[0].dofs) if self._are_joints_of_one else None
        return fast or self._move_world

    def _move_world(self, values: Floats) -> None:
        self.move(values)
        self.world()

    @property
    def _are_joints_of_one(self) -> bool:
        return len(self.parts) == 1 and bool(self.parts[0].dofs)

    def fast_test(self) -> MovingTest | None:
        """Return a fast collision test of configurations, or None if only ``move`` and ``collision`` can decide.

        Use it within ``kept``, without other changes of the world.
        """
        # User checkers and callbacks inspect the bodies, so these must be moved.
        if not self._checker().is_plain or not self._are_joints_of_one:
            return None
        return moving_test(self.parts[0].body, self.parts[0].dofs)

    def collision(self, told: list[Findings] | None = None) -> int:
        """Return the collision of the bodies at present: ``FREE``, ``ENV_COLLISION`` or ``SELF_COLLISION``.

        ``told`` receives the colliding geometries. Links not moved by any value are ignored, as with OpenRAVE's option
        ``ActiveDOFs``: the base of an arm touches the floor in every configuration.
        """
        checker = self._checker()
        with self._simulation.lock:
            world = checker.world()
            for body in self.bodies:
                moved = self.moved(body)
                if _hits(checker, world, body_and_others(world, body, moved), told):
                    return ENV_COLLISION
                if body in self._free:
                    continue
                if _hits(checker, world, itself(world, body, moved), told):
                    return SELF_COLLISION
                if not any(part.dofs for part in self.parts if part.body is body):
                    self._free.add(body)
        return FREE

    def collisions(self) -> list[Findings]:
        """Return the present collisions: of each body with itself, and with other bodies."""
        checker, all_findings = self._checker(), list[Findings]()
        with self._simulation.lock:
            world = checker.world()
            for body in self.bodies:
                moved = self.moved(body)
                tests = itself(world, body, moved), body_and_others(world, body, moved)
                all_findings += [checker.find(world, pairs) for pairs in tests]
        return [findings for findings in all_findings if findings.collisions]

    def beyond_limits(self, values: Floats) -> list[str]:
        """Return the names of joints whose values exceed their limits; circular joints have none."""
        names: list[str] = []
        for part in self.parts:
            for dof, value in zip(part.dofs, values[part.columns].tolist(), strict=True) if part.dofs else ():
                axis = part.body.scene.dof_axes[dof]
                if not (axis.circular or axis.lower <= value <= axis.upper):
                    names.append(part.body.scene.joint_of_dof(dof).name)
        return names

    def moved(self, body: BodyState) -> MovedBy | None:
        """Return the links of a body that its joints in the configuration move; None if the whole body moves."""
        parts = [part for part in self.parts if part.body is body]
        return MovedBy(tuple(dof for part in parts for dof in part.dofs)) if all(part.dofs for part in parts) else None


def _restore(saved: Sequence[tuple[BodyState, SavedConfiguration]], stamps: Sequence[int]) -> None:
    # The stamp tells caches that a body has moved. It is restored as well, since effectively nothing has moved.
    for (state, configuration), stamp in zip(saved, stamps, strict=True):
        state.restore(configuration)
        state.stamp = stamp


def _is_unbound(group: Group) -> bool:
    """Return whether the values of a configuration group move no body: an IK goal, or a pose without a body."""
    return group.kind == IK[0] or (group.kind == AFFINE[0] and group.body == _NO_BODY)


def _hits(checker: Checker, world: CollisionWorld, pairs: Pairs, told: list[Findings] | None) -> bool:
    if told is None:
        return checker.collides(world, pairs)
    told.append(checker.find(world, pairs))
    return bool(told[-1].collisions)


def _part(simulation: Simulation, group: Group) -> Part:
    body = simulation.body(group.body or "")
    if body is None:
        raise ArgumentError(f"group '{group.name}': there is no body '{group.body}'")
    if group.kind == JOINTS[0]:
        dofs = tuple(joint_indices(group))
        if any(not 0 <= dof < body.dof for dof in dofs):
            raise ArgumentError(f"group '{group.name}': '{group.body}' has {body.dof} DOFs")
        return Part(body, group.columns, dofs, 0, Z_AXIS)
    parts, axis = affine_parts(group)
    if RaveGetAffineDOF(parts) != group.dof:
        raise ArgumentError(f"group '{group.name}': has {group.dof} values, and should have {RaveGetAffineDOF(parts)}")
    return Part(body, group.columns, (), parts, axis)


Constraint = Callable[[Floats], bool]
"""User callback that returns whether a configuration is allowed. It is called with the bodies at the configuration."""


@dataclass
class Conditions:
    """Constraints on configurations of bodies.

    Attributes:
        bodies: The bodies; None if nothing collides.
        constraints: User callbacks that return whether a configuration is allowed.
        manifold: The manifold of a tool constraint, or None.
        proves: Whether each line that shortens a path must be certified.
    """

    bodies: Bodies | None = None
    constraints: list[Constraint] = field(default_factory=lambda: [])
    manifold: Manifold | None = None
    proves: bool = False

    def kept(self) -> AbstractContextManager[None]:
        """Context manager that acquires the lock, and restores the configurations of the bodies and grabbed bodies."""
        return nullcontext() if self.bodies is None else self.bodies.kept()

    def allowed(self) -> Allowed:
        """Return the test of a configuration. Use it within ``bodies.kept``, since it may move the bodies."""
        fast, manifold = None if self.bodies is None or self.constraints else self.bodies.fast_test(), self.manifold
        if fast is None:
            return lambda values: not self.violation(values)
        if manifold is not None:
            return lambda values: manifold.has(values) and not fast(values)
        return lambda values: not fast(values)

    def near_others(self, space: Space, ends: Floats) -> Space:
        """Return the part of a space to search for a path: ``Bodies.near_others``, or all of it with user callbacks."""
        return space if self.bodies is None or self.constraints else self.bodies.near_others(space, ends)

    def edges(self, space: Space, allowed: Allowed, step: float, ends: Sequence[Floats]) -> Edges:
        """Return the tests of edges, for use within ``kept``.

        Args:
            space: The configuration space.
            allowed: The test of single configurations.
            step: The step of trees, a weighted distance.
            ends: The starts and goals, at which shapes may touch.
        """
        certifier = self.certifier(ends) if self.proves else None
        proof = certifier and certifier.proves
        if self.manifold is None:
            return Edges(space, allowed, step, proof)
        return ConstrainedEdges(space, replace(self, manifold=None).allowed(), self.manifold, step, proof)

    def straight_edges(self, space: Space, ends: Sequence[Floats], *, certifies: bool) -> Edges:
        """Return the tests of straight edges, ignoring a constraint manifold; see ``edges``.

        If ``certifies``, the motion is certified later: shortcuts keep a clearance, so that the proof is likely to
        succeed.
        """
        fast = self.bodies.fast_test() if certifies and self.bodies is not None and not self.constraints else None
        make_certifier = cache(lambda: self.certifier(ends))  # on first use, since it takes as long as many tests
        certifier = make_certifier() if self.proves else None
        proof, clear = certifier and certifier.proves, None if fast is None else fast.with_clearance(ends)
        return Edges(space, self.allowed(), proof=proof, certifier=make_certifier, clear=clear)

    def certifier(self, ends: Sequence[Floats]) -> "Certifier | None":
        """Return the certifier of motions with given starts and goals, for use within ``kept``; None if impossible."""
        from ravemj.manipulation.certification import Certifier, UncertifiableError  # noqa: PLC0415 - rarely wanted

        try:
            return None if self.bodies is None else Certifier(self.bodies, ends)
        except UncertifiableError:
            return None

    def violation(self, values: Floats, options: int = ALL, told: list[Findings] | None = None) -> int:
        """Move the bodies to a configuration, and return the bit of the violated condition, or 0.

        ``options`` are the bits to test; ``told`` receives the colliding geometries.
        """
        if self.bodies is None:
            return FREE
        self.bodies.move(values)
        violated = self.bodies.collision(told) & options
        if violated or not options & USER:
            return violated
        keeps_all = all(constraint(values) for constraint in self.constraints)
        return FREE if keeps_all and (self.manifold is None or self.manifold.has(values)) else USER


def space_of(coordinates: Coordinates, lower: Floats, upper: Floats, weights: Floats, resolution: Floats) -> Space:
    """Return the configuration space for planners, from vectors of shape (n,); a resolution of 0 selects OpenRAVE's.

    Circular values are bounded, because planners sample between limits.
    """
    resolution = np.where(resolution > 0, resolution, _RESOLUTION)
    lower = np.where(coordinates.circular, -_ROUND, lower)
    upper = np.where(coordinates.circular, _ROUND, upper)
    if len(coordinates.rotation) == 3:
        columns = list(coordinates.rotation)
        lower[columns], upper[columns] = np.clip([lower[columns], upper[columns]], -_FULL_TURN, _FULL_TURN)
    return Space(coordinates, lower, upper, weights, resolution)

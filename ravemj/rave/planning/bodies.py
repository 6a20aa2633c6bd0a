"""The bodies that a planner moves: their configuration, its limits, its collisions."""

from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ravemj.core.transforms import Floats, Vec3
from ravemj.engine.affine import translation_columns
from ravemj.engine.collision.moving import moving_test
from ravemj.engine.collision.queries import MovedBy, body_and_others, itself
from ravemj.engine.collision.region import touching_region
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.affine import DOFAffine, affine_values, pose_with_values
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.planning.space import Coordinates, Space
from ravemj.rave.body.affine import affine_numbers, default_kinds
from ravemj.rave.collision import CollisionChecker
from ravemj.rave.report import CollisionReport
from ravemj.rave.robot import Robot
from ravemj.trajectories.extraction import rotation_columns
from ravemj.trajectories.groups import AFFINE, IK, JOINTS, Group, affine_parts, ik_type, joint_indices

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.kinbody import KinBody

FREE, ENV_COLLISION, SELF_COLLISION, USER = 0, 1, 2, 0x8000
"""Why a configuration is refused: bits of ``ConstraintFilterOptions``. ``USER`` is the bit of users' own functions."""

_UNLIMITED = {"lower": -np.inf, "upper": np.inf, "max_jerk": np.inf}
"""Limits of the values of a goal of inverse kinematics, and of a pose of no body. Callers have to set the limits that
are not listed here."""

_NO_BODY = "__dummy__"
"""The body that ``RaveGetAffineConfigurationSpecification`` names where it is given none."""

_RESOLUTION = 0.02
"""OpenRAVE's default for the step in which a value is tested for collisions [rad or m]."""

_ROUND = np.pi  # samples of a circular joint are drawn from [-pi, pi], since the joint has no limits of its own

_FULL_TURN = 2 * np.pi
"""Limits of rotation vectors, for samples [rad]: OpenRAVE's are 10000, where hardly a sample is near the start."""


@dataclass(frozen=True)
class _Part:
    """Some joints of one body, or its pose, as columns of a configuration.

    Attributes:
        body: The body.
        columns: The columns of a configuration that hold the values.
        dofs: The DOF indices of the joints; empty for a pose.
        affine: The components of the pose, bits of ``DOFAffine``; 0 for joints.
        axis: The axis of ``DOFAffine.RotationAxis``.
    """

    body: "KinBody"
    columns: slice
    dofs: tuple[int, ...]
    affine: int
    axis: Vec3


class Bodies:
    """The bodies of a planning problem: their joints and poses, in the order of a specification's groups.

    Args:
        env: The environment that contains the bodies.
        groups: Groups of joint values, of poses, and of goals of inverse kinematics. Goals move nothing, and neither do
            poses of ``__dummy__``, which stands for no body.

    Raises:
        ArgumentError: a group names a body that is not in the environment, or a DOF that its body does not have.
    """

    def __init__(self, env: "Environment", groups: Sequence[Group]) -> None:
        self._env = env
        self._simulation = env.simulation
        self.lock = env.simulation.lock
        moving = [group for group in groups if group.kind in {JOINTS[0], AFFINE[0]} and not _is_unbound(group)]
        self._parts = [_part(env, group) for group in moving]
        self._unbound = [group for group in groups if _is_unbound(group)]
        self._dof = max((one.columns.stop for one in (*self._parts, *self._unbound)), default=0)
        self.bodies = list(dict.fromkeys(part.body for part in self._parts))
        self._free: set[KinBody] = set()  # whose joints stay as they are, and have no self-collision

    def numbers(self, name: str) -> Floats:
        """Return one setting of each value, shape (n,).

        Settings are ``lower``, ``upper``, ``max_velocity``, ``max_acceleration``, ``max_jerk``, ``weight`` and
        ``resolution``.
        """
        result = np.zeros(self._dof)
        for part in self._parts:
            result[part.columns] = _numbers(part, name)
        for group in self._unbound:
            result[group.columns] = _UNLIMITED.get(name, 0.0)
        return result

    def coordinates(self) -> Coordinates:
        """Return which values of a configuration are circular angles, positions or quaternions."""
        circular = np.zeros(self._dof, dtype=bool)
        translation: list[int] = []
        rotation: list[int] = []
        poses = [(part.columns, part.affine) for part in self._parts if not part.dofs]
        poses += [(group.columns, int(affine_parts(group)[0])) for group in self._unbound if group.kind == AFFINE[0]]
        for part in self._parts:
            if part.dofs:
                axes = part.body.simulation_state.scene.dof_axes
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

    def described(self, group: Group, index: int) -> str:
        """Return the name of one value of a group, for error messages."""
        part = next(part for part in self._parts if part.columns == group.columns)
        if part.dofs:
            return f"joint '{part.body.GetJointFromDOFIndex(part.dofs[index]).GetName()}'"
        return f"value {index} of the pose of '{part.body.GetName()}'"

    def near_others(self, space: Space, ends: Floats) -> Space:
        """Return a space in which a base stays where it can touch other bodies, or between starts and goals.

        Every path elsewhere could be moved onto the border of this box. OpenRAVE's limits of a base are 100 m, where
        hardly a sample is near anything.

        Args:
            space: The configuration space.
            ends: The starts and goals, shape (m, n).
        """
        lower, upper = space.lower.copy(), space.upper.copy()
        for part in self._parts if len(self.bodies) == 1 else ():
            axes = [] if part.dofs else translation_columns(part.affine)
            region = touching_region(part.body.simulation_state) if axes else None
            for column, axis in enumerate(axes, part.columns.start):
                low, high = ends[:, column].min(), ends[:, column].max()
                if region is not None:
                    low, high = min(low, region.low[axis]), max(high, region.high[axis])
                lower[column], upper[column] = max(low, lower[column]), min(high, upper[column])
        return replace(space, lower=lower, upper=upper)

    def values(self) -> Floats:
        """Return the current configuration, shape (n,)."""
        result = np.zeros(self._dof)
        with self._simulation.lock:
            for part in self._parts:
                if part.dofs:
                    result[part.columns] = part.body.GetDOFValues(part.dofs)
                else:
                    pose = part.body.simulation_state.pose()
                    result[part.columns] = affine_values(pose, DOFAffine(part.affine), part.axis)
        return result

    def move(self, values: Floats) -> None:
        """Move the bodies to a configuration without checking limits. The caller holds the lock."""
        for part in self._parts:
            state = part.body.simulation_state
            if part.dofs:
                kinematics = state.kinematics
                full = kinematics.values()
                full[list(part.dofs)] = values[part.columns]
                state.set_values(full)
            else:
                state.set_pose(pose_with_values(state.pose(), values[part.columns], DOFAffine(part.affine), part.axis))

    @contextmanager
    def kept(self) -> Generator[None]:
        """Hold the lock; on leaving, restore the configurations of all bodies and of the bodies that they hold."""
        with self._simulation.lock:
            self._free.clear()
            states = [body.simulation_state for body in self.bodies]
            held = [grab.body for state in states for grab in state.grabs]
            saved = [(state, state.configuration()) for state in [*states, *held]]
            stamps = [state.stamp for state, _ in saved]
            try:
                yield
            finally:
                # The stamp tells caches that a body has moved. Nothing has, seen from outside, so it goes back as well.
                for (state, configuration), stamp in zip(saved, stamps, strict=True):
                    state.restore(configuration)
                    state.stamp = stamp

    def fast_test(self) -> Callable[[Floats], bool] | None:
        """Return a fast collision test for configurations, or None if only ``move`` and ``collision`` can tell.

        Use the test within ``kept``, and change nothing else in the world meanwhile.
        """
        # Checkers and callbacks of the user look at the bodies themselves, so these have to be moved.
        checker = self._env.GetCollisionChecker()
        is_plain = (
            type(checker) is CollisionChecker and not checker.groups.is_used and not self._env.collision_callbacks
        )
        if not is_plain or len(self._parts) != 1 or not self._parts[0].dofs:
            return None
        return moving_test(self._parts[0].body.simulation_state, self._parts[0].dofs)

    def collision(self, report: CollisionReport | None = None) -> int:
        """Return whether the bodies collide where they are: ``FREE``, ``ENV_COLLISION`` or ``SELF_COLLISION``.

        Links that no value moves do not count, as with OpenRAVE's option ``ActiveDOFs``: the base of an arm touches
        the floor in every configuration.
        """
        checker = self._env.GetCollisionChecker()
        with self._simulation.lock, checker.groups.world() as world:
            for body in self.bodies:
                state, moved = body.simulation_state, self._moved(body)
                if checker.answer(world, body_and_others(world, state, moved), report):
                    return ENV_COLLISION
                if body in self._free:
                    continue
                if checker.answer(world, itself(world, state, moved), report):
                    return SELF_COLLISION
                if not any(part.dofs for part in self._parts if part.body is body):
                    self._free.add(body)
        return FREE

    def _moved(self, body: "KinBody") -> MovedBy | None:
        """Return the links of a body that the values move, or None if they move all of it."""
        parts = [part for part in self._parts if part.body is body]
        return MovedBy(tuple(dof for part in parts for dof in part.dofs)) if all(part.dofs for part in parts) else None


def _is_unbound(group: Group) -> bool:
    """Return whether the values of a group move no body."""
    return group.kind == IK[0] or (group.kind == AFFINE[0] and group.body == _NO_BODY)


def _part(env: "Environment", group: Group) -> _Part:
    body = env.GetKinBody(group.body or "")
    if body is None:
        raise ArgumentError(f"group '{group.name}': there is no body '{group.body}'")
    if group.kind == JOINTS[0]:
        dofs = tuple(joint_indices(group))
        if any(not 0 <= dof < body.GetDOF() for dof in dofs):
            raise ArgumentError(f"group '{group.name}': '{group.body}' has {body.GetDOF()} DOFs")
        return _Part(body, group.columns, dofs, 0, (0.0, 0.0, 1.0))
    parts, axis = affine_parts(group)
    return _Part(body, group.columns, (), parts, axis)


def _numbers(part: _Part, name: str) -> Any:  # noqa: ANN401 - numbers
    body = part.body
    if not part.dofs:
        kinds = body.affine_kinds if isinstance(body, Robot) else default_kinds()
        # OpenRAVE has no accelerations and jerks of affine DOFs: its maximum velocities stand for them.
        names = {"max_acceleration": "max_velocity", "max_jerk": "max_velocity"}
        return affine_numbers(kinds, part.affine, part.axis, names.get(name, name))
    if name == "max_jerk":
        return body.GetDOFJerkLimits(part.dofs)
    axes = body.simulation_state.scene.dof_axes
    return [getattr(axes[dof], name) for dof in part.dofs]


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

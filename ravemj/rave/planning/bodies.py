"""The bodies that a planner moves: their configuration, its limits, its collisions."""

from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ravemj.core.transforms import Floats, Vec3
from ravemj.engine.collision.moving import moving_test
from ravemj.engine.collision.queries import MovedBy, body_and_others, itself
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
"""What is wrong with a configuration, as ``ConstraintFilterOptions`` numbers it."""

_JERK = 50000.0
"""OpenRAVE's limit of the jerks of joints [rad/s^3 or m/s^3], where nothing else is said."""

_UNLIMITED = {"lower": -np.inf, "upper": np.inf, "max_jerk": np.inf}
"""Limits of goals of inverse kinematics; speeds have to be given."""

_RESOLUTION = 0.02
"""Steps of values that have none [rad or m]: OpenRAVE's default."""

_ROUND = np.pi
"""Limits of angles that go round, for samples [rad]."""

_FULL_TURN = 2 * np.pi
"""Limits of rotation vectors, for samples [rad]: OpenRAVE's are 10000, where hardly a sample is near the start."""


@dataclass(frozen=True)
class _Part:
    """Some joints of a body, or a part of its pose.

    Attributes:
        body: The body.
        columns: Where the values are in a configuration.
        dofs: DOF indices; empty for a pose.
        affine: The parts of the pose, ``DOFAffine``.
        axis: Axis of ``DOFAffine.RotationAxis``.
    """

    body: "KinBody"
    columns: slice
    dofs: tuple[int, ...]
    affine: int
    axis: Vec3


class Bodies:
    """Joints and poses of bodies, in the order of groups of a specification.

    Args:
        env: Where the bodies are.
        groups: Groups of joint values, of poses, and of goals of inverse kinematics, which move nothing.

    Raises:
        ArgumentError: there is no such body.
    """

    def __init__(self, env: "Environment", groups: Sequence[Group]) -> None:
        self._env = env
        self._simulation = env.simulation
        self.lock = env.simulation.lock
        self._parts = [_part(env, group) for group in groups if group.kind in {JOINTS[0], AFFINE[0]}]
        self._goals = [group for group in groups if group.kind == IK[0]]
        self._dof = max((one.columns.stop for one in (*self._parts, *self._goals)), default=0)
        self.bodies = list(dict.fromkeys(part.body for part in self._parts))

    def numbers(self, name: str) -> Floats:
        """Return a setting of all values: ``lower``, ``upper``, ``max_velocity``, ``acceleration``, ``weight``, ..."""
        result = np.zeros(self._dof)
        for part in self._parts:
            result[part.columns] = _numbers(part, name)
        for group in self._goals:
            result[group.columns] = _UNLIMITED.get(name, 0.0)
        return result

    def coordinates(self) -> Coordinates:
        """Return what the values are."""
        circular = np.zeros(self._dof, dtype=bool)
        translation: list[int] = []
        rotation: list[int] = []
        for part in self._parts:
            columns = range(part.columns.start, part.columns.stop)
            if part.dofs:
                axes = part.body.simulation_state.scene.dof_axes
                circular[part.columns] = [axes[dof].circular for dof in part.dofs]
                continue
            kind, turning = rotation_columns(Group(f"{AFFINE[0]} _ {part.affine}", 0, len(columns)))
            rotation += columns[turning] if kind else []
            translation += [column for column in columns if column not in rotation]
            if kind == DOFAffine.RotationAxis:
                circular[columns[-1]] = True
        for group in self._goals:
            if ik_type(group) == IkParameterizationType.Transform6D:
                rotation += range(group.offset, group.offset + 4)
                translation += range(group.offset + 4, group.offset + 7)
        return Coordinates(circular, tuple(translation), tuple(rotation))

    def described(self, group: Group, index: int) -> str:
        """Return what a value of a group is."""
        part = next(part for part in self._parts if part.columns == group.columns)
        if part.dofs:
            return f"joint '{part.body.GetJointFromDOFIndex(part.dofs[index]).GetName()}'"
        return f"value {index} of the pose of '{part.body.GetName()}'"

    def values(self) -> Floats:
        """Return the present configuration."""
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
        """Go to a configuration, without a look at limits. The caller holds the lock."""
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
        """Have the lock and, afterwards, all bodies and what they hold where they were."""
        with self._simulation.lock:
            states = [body.simulation_state for body in self.bodies]
            held = [grab.body for state in states for grab in state.grabs]
            saved = [(state, state.configuration()) for state in [*states, *held]]
            stamps = [state.stamp for state, _ in saved]
            try:
                yield
            finally:
                for (state, configuration), stamp in zip(saved, stamps, strict=True):
                    state.restore(configuration)
                    state.stamp = stamp

    def fast_test(self) -> Callable[[Floats], bool] | None:
        """Return a fast test whether the bodies collide in a configuration, or None where ``move`` has to be called.

        It is for use within ``kept``; the world has to stay as it is meanwhile.
        """
        is_plain = type(self._env.GetCollisionChecker()) is CollisionChecker and not self._env.collision_callbacks
        if not is_plain or len(self._parts) != 1 or not self._parts[0].dofs:
            return None
        return moving_test(self._parts[0].body.simulation_state, self._parts[0].dofs)

    def collision(self, report: CollisionReport | None = None) -> int:
        """Return how the bodies collide as they are: ``FREE``, ``ENV_COLLISION`` or ``SELF_COLLISION``.

        As with OpenRAVE's option ``ActiveDOFs``, what the values do not move does not count: a base that stands on the
        floor touches it wherever the arm is.
        """
        checker, world = self._env.GetCollisionChecker(), self._simulation.collisions()
        for body in self.bodies:
            state, moved = body.simulation_state, self._moved(body)
            if checker.answer(world, body_and_others(world, state, moved), report):
                return ENV_COLLISION
            if checker.answer(world, itself(world, state, moved), report):
                return SELF_COLLISION
        return FREE

    def _moved(self, body: "KinBody") -> MovedBy | None:
        """Return what moves of a body; None: all of it."""
        parts = [part for part in self._parts if part.body is body]
        return MovedBy(tuple(dof for part in parts for dof in part.dofs)) if all(part.dofs for part in parts) else None


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
        names = {"max_acceleration": "max_velocity", "max_jerk": "max_velocity"}
        return affine_numbers(kinds, part.affine, part.axis, names.get(name, name))
    if name == "max_jerk":
        getter = getattr(body, "GetDOFJerkLimits", None)
        return getter(part.dofs) if getter else _JERK
    axes = body.simulation_state.scene.dof_axes
    return [getattr(axes[dof], name) for dof in part.dofs]


def space_of(coordinates: Coordinates, lower: Floats, upper: Floats, weights: Floats, resolution: Floats) -> Space:
    """Return a space for planners, which has to be bounded."""
    resolution = np.where(resolution > 0, resolution, _RESOLUTION)
    lower = np.where(coordinates.circular, -_ROUND, lower)
    upper = np.where(coordinates.circular, _ROUND, upper)
    if len(coordinates.rotation) == 3:
        columns = list(coordinates.rotation)
        lower[columns], upper[columns] = np.clip([lower[columns], upper[columns]], -_FULL_TURN, _FULL_TURN)
    return Space(coordinates, lower, upper, weights, resolution)

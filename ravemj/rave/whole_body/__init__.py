"""Whole-body inverse kinematics: several tasks of one robot at once, its base included."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import count as counting

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_number, checked_rows, checked_vector, checked_whole_numbers
from ravemj.core.transforms import Floats
from ravemj.engine.collision import queries
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions.affine import DOFAffine, affine_values
from ravemj.ik.tasks import Task as Goal
from ravemj.ik.whole_body import Descent, TaskRows, WeightedTask
from ravemj.ik.whole_body.levels import daqp
from ravemj.manipulation.whole_body import Keeper, Moving, polygon_edges
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.robot import Robot
from ravemj.rave.specification import ConfigurationSpecification, IkParameterization
from ravemj.rave.trajectory import Trajectory
from ravemj.rave.whole_body.limits import WholeBodyLimits, limits_of
from ravemj.rave.whole_body.targets import (
    Target,
    described,
    frame_of,
    frame_rows,
    target_of,
)
from ravemj.trajectories.bodies import body_groups

_ALL = int(DOFAffine.Transform)
_LONGEST = 0.5  # largest step of ``solve`` [rad or m]
_MOST_STEPS = 300
_CONTACT, _FRAME, _COM, _POSTURE = 1.0, 0.1, 0.1, 1e-7
_CONTACT_TOLERANCE = 1e-6
_TOUCHED = 1e-4  # tolerance of distances and supports [m]
_PRESSING = 1e-9
_AT_LIMIT = 1e-7


@dataclass(frozen=True)
class WholeBodyResult:
    """Result of ``WholeBodyIK.solve``, true if it converged.

    Attributes:
        converged: Whether all tasks are met, except for soft ones such as a posture.
        reason: ``met``, or the unmet tasks and the limits that block them.
        steps: Number of steps.
        residuals: Remaining error of each enabled task by name [m, rad, or difference of unit vectors].
        active_limits: Joints whose limits block the tasks.
        cost: Remaining weighted sum of squared errors.
    """

    converged: bool
    reason: str
    steps: int
    residuals: dict[str, Floats]
    active_limits: list[str]
    cost: float

    def __bool__(self) -> bool:
        """Return ``converged``."""
        return self.converged


class WholeBodyTask(ApiObject):
    """Task of a ``WholeBodyIK``, as its ``add_…`` methods return it. The attributes can be changed at any time."""

    _internal = ("task",)

    def __init__(
        self, task: WeightedTask, target: object, retarget: Callable[..., None], simulation: Simulation
    ) -> None:
        self.task, self._simulation = task, simulation
        self._target, self._retarget = target, retarget

    @property
    def name(self) -> str:
        """Name of the task in results."""
        return self.task.name

    @property
    def weight(self) -> float:
        """Weight of the squared error, relative to other tasks of the same priority."""
        return self.task.weight

    @weight.setter
    def weight(self, weight: float) -> None:
        self.task.weight = checked_number(weight, "weight", 0.0)

    @property
    def gain(self) -> float:
        """Fraction of the error that a step removes, 0 to 1."""
        return self.task.gain

    @gain.setter
    def gain(self, gain: float) -> None:
        self.task.gain = _checked_gain(gain)

    @property
    def priority(self) -> int:
        """Priority level: tasks with larger numbers do not affect those with smaller ones."""
        return self.task.priority

    @priority.setter
    def priority(self, priority: int) -> None:
        self.task.priority = _checked_priority(priority)

    @property
    def enabled(self) -> bool:
        """Whether the task is used."""
        return self.task.enabled

    @enabled.setter
    def enabled(self, enabled: bool) -> None:
        self.task.enabled = bool(enabled)

    @property
    def residual(self) -> Floats:
        """Error at the present configuration [m, rad, or difference of unit vectors]."""
        with self._simulation.lock:
            return self.task.rows().error.copy()

    @property
    def target(self) -> object:
        """The target as given. Assign a new one in any form that the ``add_…`` method accepts."""
        return self._target

    @target.setter
    def target(self, target: ArrayLike | IkParameterization | KinBody | Link) -> None:
        self._retarget(target)
        self._target = target

    def __repr__(self) -> str:
        return f"<WholeBodyTask {self.name!r}: weight {self.weight:g}, priority {self.priority}>"


class WholeBodyIK(ApiObject):
    """Whole-body IK of a robot's active DOFs: contacts, reaching, centre of mass and other tasks at once.

    Each step solves a quadratic program over small displacements: of the joints, and of the base as a twist. Tasks of
    one priority are weighted; with several priorities (extra ``wholebody``), a task never degrades one with a smaller
    number. Contacts are equality constraints.

    Example:
        >>> env = ravemj.load(ravemj.model_path("biped"))
        >>> ik = ravemj.WholeBodyIK(env.GetRobots()[0], base=True)
        >>> feet = ik.add_contact("left_foot"), ik.add_contact("right_foot")
        >>> hand = ik.add_reach("left_hand", [0.3, 0.2, 0.1])
        >>> ik.solve().reason
        'met'

    Attributes:
        limits: Limits that every step keeps.
        exact_contacts: Whether contacts are equality constraints; otherwise they are weighted like other tasks.
    """

    _often_called = ("step",)

    def __init__(self, robot: Robot, base: bool = False) -> None:
        """Use the present active DOFs of a robot.

        Args:
            robot: The robot, in an environment.
            base: Whether the base moves freely; by default only its active affine DOFs move.

        Raises:
            openrave_exception: the robot is not in an environment.
        """
        self._robot = checked_kind(robot, Robot, "WholeBodyIK: robot")
        choice = robot.active_choice
        self._affine, self._axis = (_ALL if base else choice.affine), choice.axis
        self._state = robot.simulation_state
        with self._state.simulation.lock:
            self._moving = Moving(self._state, robot.GetActiveDOFIndices(), self._affine, self._axis)
        self.limits = WholeBodyLimits()
        self._limits_for: object = None
        self._descent = Descent(self._moving, limits_of(self._moving, self.limits))
        self._tasks: list[WholeBodyTask] = []

    @property
    def exact_contacts(self) -> bool:
        """Whether contacts are equality constraints; otherwise they are weighted like other tasks."""
        return self._descent.exact_contacts

    @exact_contacts.setter
    def exact_contacts(self, exact: bool) -> None:
        self._descent.exact_contacts = bool(exact)

    @property
    def tasks(self) -> list[WholeBodyTask]:
        """The tasks, in the order of their addition."""
        return list(self._tasks)

    def add_contact(
        self,
        frame: Manipulator | Link | str,
        target: ArrayLike | None = None,
        *,
        weight: float = _CONTACT,
        priority: int = 1,
    ) -> WholeBodyTask:
        """Add a contact: keep the pose of a frame exactly, such as a foot on the ground.

        Args:
            frame: A manipulator, a link, or the name of one of these.
            target: ``T_world_frame``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz]; by default the present pose.
            weight: Weight of the task until it is reached.
            priority: Priority level of the task.

        Returns:
            The task, whose target and weight can be changed.

        Raises:
            ArgumentError: the frame does not exist, or the target is not a pose.
        """
        return self._add_frame(frame, target, weight, priority, is_contact=True)

    def add_reach(
        self,
        frame: Manipulator | Link | str,
        target: ArrayLike | IkParameterization | KinBody | Link,
        *,
        weight: float = _FRAME,
        priority: int = 1,
        gain: float = 1.0,
        rotation: bool = True,
    ) -> WholeBodyTask:
        """Add a task that moves a frame to a target.

        Args:
            frame: A manipulator, a link, or the name of one of these.
            target: A pose in the world: 4x4, 3x4 or [w, x, y, z, tx, ty, tz]; a point of three numbers; an
                ``IkParameterization`` of any type, in the world; or another body or its link, which the frame follows
                as it moves.
            weight: Weight of the task.
            priority: Priority level of the task.
            gain: Fraction of the error that a step removes, 0 to 1.
            rotation: Whether to reach the orientation of a pose or body, too.

        Returns:
            The task, whose target and weight can be changed.

        Raises:
            ArgumentError: the frame does not exist, or the target is invalid.

        Example:
            >>> ik.add_reach("right_hand", env.GetKinBody("ball"), rotation=False)
            <WholeBodyTask 'right_hand': weight 0.1, priority 1>
        """
        return self._add_frame(frame, target, weight, priority, gain=gain, rotation=rotation)

    def add_look_at(
        self,
        frame: Manipulator | Link | str,
        target: ArrayLike | KinBody | Link,
        *,
        weight: float = _FRAME,
        priority: int = 1,
    ) -> WholeBodyTask:
        """Add a task that points a frame at a target: the direction of a manipulator, the z axis of a link.

        Args:
            frame: A manipulator, a link, or the name of one of these.
            target: A point in the world [m], shape (3,), or a body or link to look at.
            weight: Weight of the task.
            priority: Priority level of the task.

        Returns:
            The task, whose target and weight can be changed.

        Raises:
            ArgumentError: the frame does not exist, or the target is invalid.
        """
        return self._add_frame(frame, target, weight, priority, rotation=False, goal=Goal.LOOK_AT)

    def _add_frame(  # noqa: PLR0913 - what tasks of frames differ in
        self,
        frame: Manipulator | Link | str,
        target: ArrayLike | IkParameterization | KinBody | Link | None,
        weight: float,
        priority: int,
        *,
        gain: float = 1.0,
        rotation: bool = True,
        is_contact: bool = False,
        goal: Goal | None = None,
    ) -> WholeBodyTask:
        placed = frame_of(self._robot, frame, "frame")

        def checked(target: ArrayLike | IkParameterization | KinBody | Link) -> Target:
            checked = target_of(self._robot, target, "target", rotation=rotation)
            if is_contact and checked.goal is not Goal.TRANSFORM:
                raise ArgumentError("target: a contact needs a pose, and this is none")
            return checked if goal is None else Target(goal, checked.numbers)

        with self._state.simulation.lock:
            number = self._moving.add_frame(placed.link, placed.T_link_frame)
            given = self._moving.frame(number)[0].copy() if target is None else target
            current = checked(given)

        def retarget(target: ArrayLike | IkParameterization | KinBody | Link) -> None:
            nonlocal current
            current = checked(target)

        measure = frame_rows(self._moving, number, placed.direction, lambda: current)
        name = self._new_name(placed.name)
        task = WeightedTask(
            name, measure, lambda error: f"{name} {described(current.goal, error)}", _checked_weight(weight)
        )
        task.priority, task.gain, task.is_contact = _checked_priority(priority), _checked_gain(gain), is_contact
        task.tolerance = _CONTACT_TOLERANCE if is_contact else task.tolerance
        return self._added(task, given, retarget)

    def add_com(
        self, target: ArrayLike | None = None, *, axes: str = "xyz", weight: float = _COM, priority: int = 1
    ) -> WholeBodyTask:
        """Add a task that moves the centre of mass of the robot and its grabbed bodies to a point.

        Args:
            target: The point in the world [m], as many numbers as ``axes``; by default the present one.
            axes: The controlled coordinates: ``xy``, ``z`` and so on.
            weight: Weight of the task.
            priority: Priority level of the task.

        Returns:
            The task, whose target and weight can be changed.

        Raises:
            ArgumentError: the axes are invalid, or the number of values is wrong.
        """
        if not axes or len(set(axes)) != len(axes) or set(axes) - set("xyz"):
            raise ArgumentError(f"add_com: axes are '{axes}', and should be some of x, y and z")
        rows = slice(None) if axes == "xyz" else ["xyz".index(axis) for axis in axes]
        with self._state.simulation.lock:
            present = self._moving.com()[0][rows].copy()
            wanted = present if target is None else checked_vector(target, len(axes), "target")

        def measure() -> TaskRows:
            com, jacobian = self._moving.com()
            return TaskRows(wanted - com[rows], jacobian[rows])

        def retarget(target: ArrayLike) -> None:
            nonlocal wanted
            wanted = checked_vector(target, len(axes), "target")

        return self._plain(
            "centre of mass",
            measure,
            lambda error: f"is {np.linalg.norm(error):.3g} m away",
            (weight, priority),
            wanted.copy(),
            retarget,
        )

    def add_posture(
        self, values: ArrayLike | None = None, *, weight: float = _POSTURE, priority: int = 1
    ) -> WholeBodyTask:
        """Add a soft task that pulls joints towards values; ``converged`` does not depend on it.

        Args:
            values: Values of the active joints [rad or m], shape (n,); by default the present ones.
            weight: Weight of the task; small, so that it only resolves the redundancy of other tasks.
            priority: Priority level of the task.

        Returns:
            The task, whose target and weight can be changed.

        Raises:
            ArgumentError: the number of values is wrong.
        """
        joints, width = len(self._moving.dofs), self._moving.count
        present = self._robot.GetDOFValues(self._moving.dofs)
        wanted = present if values is None else checked_vector(values, joints, "values")
        identity = np.eye(joints, width)

        def measure() -> TaskRows:
            return TaskRows(wanted - self._moving.values()[:joints], identity, is_identity=True)

        def retarget(target: ArrayLike) -> None:
            nonlocal wanted
            wanted = checked_vector(target, joints, "target")

        def describe(error: Floats) -> str:
            return f"is {np.linalg.norm(error):.3g} rad away"

        task = self._plain("posture", measure, describe, (weight, priority), wanted.copy(), retarget)
        task.task.tolerance = np.inf
        return task

    def add_joint_coupling(
        self, coefficients: Mapping[str, float], value: float = 0.0, *, weight: float = 1.0, priority: int = 1
    ) -> WholeBodyTask:
        """Add a task that keeps a linear combination of joint values at a value.

        Args:
            coefficients: Coefficients by name of active joints.
            value: The value of the sum [rad or m].
            weight: Weight of the task.
            priority: Priority level of the task.

        Returns:
            The task, whose target and weight can be changed.

        Raises:
            ArgumentError: a joint is not active, or there is none.

        Example:
            >>> ik.add_joint_coupling({"L_KNEE": 1.0, "R_KNEE": -1.0})  # both knees bend alike
            <WholeBodyTask 'L_KNEE and R_KNEE': weight 1, priority 1>
        """
        if not coefficients:
            raise ArgumentError("coefficients: are empty, and should name at least one active joint")
        row = np.zeros((1, self._moving.count))
        names = self._variable_names()
        for joint, coefficient in coefficients.items():
            if joint not in names:
                raise ArgumentError(f"coefficients: '{joint}' is no active joint; these are {', '.join(names)}")
            row[0, names.index(joint)] = checked_number(coefficient, f"coefficients: {joint}")
        wanted = checked_number(value, "value")

        def measure() -> TaskRows:
            return TaskRows(wanted - row @ self._moving.values(), row)

        def retarget(target: ArrayLike) -> None:
            nonlocal wanted
            wanted = float(checked_vector(np.atleast_1d(target), 1, "target")[0])

        def describe(error: Floats) -> str:
            return f"is off by {abs(float(error[0])):.3g}"

        return self._plain(" and ".join(coefficients), measure, describe, (weight, priority), wanted, retarget)

    def add_distance(self, other: KinBody | Link | None = None, *, minimum: float = 0.01, seen: float = 0.1) -> None:
        """Keep the robot and its grabbed bodies away from itself or an obstacle. Needs the extra ``wholebody``.

        Pairs of geometries that are too close at the start are moved apart.

        Args:
            other: A body, or a link of one; by default the link pairs of the robot's self-collision check.
            minimum: The minimum distance [m].
            seen: The distance below which pairs are considered [m].

        Raises:
            openrave_exception: ``daqp`` is not installed.
            ArgumentError: ``seen`` is not above ``minimum``.
        """
        daqp()
        least = checked_number(minimum, "minimum")
        if checked_number(seen, "seen") <= least:
            raise ArgumentError(f"seen: is {seen:g} m, and should be above minimum, {least:g} m")
        simulation, state = self._state.simulation, self._state
        against = None if other is None else _subject(other)

        def pairs() -> tuple[CollisionWorld, Pairs]:
            world = simulation.collisions()
            return world, queries.itself(world, state) if against is None else queries.each_other(world, state, against)

        self._moving.keepers.append(Keeper(pairs, least, float(seen)))

    def add_support(self, points: ArrayLike) -> None:
        """Keep the centre of mass above the convex hull of points. Needs the extra ``wholebody``.

        Args:
            points: Vertices of the support polygon in the world [m], shape (n, 2) or (n, 3); z is ignored.

        Raises:
            openrave_exception: ``daqp`` is not installed.
            ArgumentError: the points are on a line.
        """
        daqp()
        given = np.asarray(points, dtype=float)
        corners = checked_rows(given[:, :2] if given.ndim == 2 else given, 2, "points")
        try:
            self._moving.edges.append(polygon_edges(corners))
        except ValueError as error:
            raise ArgumentError(f"points: {error}") from None

    def remove(self, task: WholeBodyTask) -> None:
        """Remove a task.

        Args:
            task: One of ``tasks``.

        Raises:
            ArgumentError: it is not one of them.
        """
        if task not in self._tasks:
            raise ArgumentError(f"remove: {task!r} is no task of this WholeBodyIK")
        self._tasks.remove(task)
        self._descent.tasks.remove(task.task)

    def step(self, dt: float) -> None:
        """Move the robot towards the targets for a duration, within limits of values, velocities and accelerations.

        Args:
            dt: The duration [s].

        Raises:
            openrave_exception: there are several priorities, and ``daqp`` is not installed.

        Example:
            >>> while True:  # a control loop
            ...     ik.step(0.01)
        """
        seconds = _checked_time(dt, "dt")
        with self._state.simulation.lock:
            self._check()
            self._descent.step(seconds)

    def solve(self, max_steps: int = _MOST_STEPS) -> WholeBodyResult:
        """Move the robot until no step reduces the errors; velocity limits do not apply.

        An unreachable goal is not an error: the robot moves as close as possible, and the result gives the reason.

        Args:
            max_steps: Maximum number of steps.

        Returns:
            The result, true if all tasks are met.

        Raises:
            openrave_exception: there are several priorities, and ``daqp`` is not installed.
        """
        with self._state.simulation.lock:
            self._check()
            outcome = self._descent.solve(int(checked_number(max_steps, "max_steps", 1)), _LONGEST)
            self._descent.velocities[:] = 0.0
            limits = self._pressed_limits()
            unmet = [task.describe(task.residual) for task in self._descent.tasks if task.enabled and not task.is_met]
            unmet += self._violated()
        stop = "stopped improving" if outcome.stopped else "steps used up"
        reason = f"{stop}: {'; '.join([*unmet, *limits])}" if unmet else "met"
        residuals = {task.name: task.residual.copy() for task in self._descent.tasks if task.enabled}
        return WholeBodyResult(not unmet, reason, outcome.steps, residuals, limits, outcome.cost)

    def follow(self, duration: float, dt: float = 0.01, update: Callable[[float], object] | None = None) -> Trajectory:
        """Step for a duration, and return the motion.

        Args:
            duration: The duration [s], rounded to whole steps.
            dt: The time step [s].
            update: Called before each step with the time at its end [s], to set targets.

        Returns:
            A trajectory of the active DOFs, with a waypoint for the start and for each step.

        Raises:
            openrave_exception: there are several priorities, and ``daqp`` is not installed.

        Example:
            >>> hand = ik.add_reach("left_hand", start)
            >>> def rise(t):
            ...     hand.target = start + [0, 0, 0.1 * np.sin(t)]
            >>> motion = ik.follow(2.0, update=rise)
            >>> robot.GetController().SetPath(motion)
            True
        """
        seconds = _checked_time(dt, "dt")
        steps = max(round(_checked_time(duration, "duration") / seconds), 1)
        rows = [self._waypoint(0.0)]
        for number in range(1, steps + 1):
            if update is not None:
                update(number * seconds)
            self.step(seconds)
            rows.append(self._waypoint(seconds))
        groups = body_groups(self._state.scene.name, self._moving.dofs.tolist(), self._affine, "linear")
        spec = ConfigurationSpecification.of(groups)
        spec.AddDeltaTimeGroup()
        trajectory = Trajectory(self._robot.GetEnv(), "GenericTrajectory")
        trajectory.Init(spec)
        trajectory.Insert(0, np.concatenate(rows))
        return trajectory

    def _waypoint(self, dt: float) -> Floats:
        with self._state.simulation.lock:
            joints = self._state.kinematics.values()[self._moving.dofs]
            base = affine_values(self._state.pose(), self._affine, self._axis) if self._affine else np.zeros(0)
        return np.concatenate([joints, base, [dt]])

    def __repr__(self) -> str:
        variables = f"{len(self._moving.dofs)} joints" + " and the base" * bool(self._affine)
        return f"<WholeBodyIK of {self._robot.GetName()!r}: {variables}, {len(self._tasks)} tasks>"

    def _check(self) -> None:
        """Apply limits that users have changed.

        Raises:
            RavemjError: the robot's joints have changed.
            ArgumentError: a limit is invalid.
        """
        if not self._moving.is_current():
            text = f"'{self._state.scene.name}' has changed since WholeBodyIK was made; make it anew"
            raise RavemjError(text, ErrorCode.InvalidState)
        limits = self.limits
        now = self._state.scene, limits.values, limits.velocities, limits.accelerations, limits.base_velocity
        if self._limits_for != now:
            self._descent.limits = limits_of(self._moving, limits)
            self._limits_for = now

    def _added(self, task: WeightedTask, target: object, retarget: Callable[..., None]) -> WholeBodyTask:
        with self._state.simulation.lock:
            task.rows()
        self._descent.tasks.append(task)
        self._tasks.append(WholeBodyTask(task, target, retarget, self._state.simulation))
        return self._tasks[-1]

    def _plain(
        self,
        name: str,
        measure: Callable[[], TaskRows],
        describe: Callable[[Floats], str],
        counts: tuple[float, int],
        target: object,
        retarget: Callable[[ArrayLike], None],
    ) -> WholeBodyTask:
        name, (weight, priority) = self._new_name(name), counts
        task = WeightedTask(name, measure, lambda error: f"{name} {describe(error)}", _checked_weight(weight))
        task.priority = _checked_priority(priority)
        return self._added(task, target, retarget)

    def _new_name(self, name: str) -> str:
        known = {task.name for task in self._tasks}
        return next(
            candidate
            for number in counting(1)
            if (candidate := f"{name} {number}" if number > 1 else name) not in known
        )

    def _variable_names(self) -> list[str]:
        """Return a name for each active DOF; those of joints with several axes are numbered."""
        names: list[str] = []
        for dof in self._moving.dofs.tolist():
            joint = self._robot.GetJointFromDOFIndex(dof)
            axis = dof - joint.GetDOFIndex()
            names.append(f"{joint.GetName()} {axis}" if joint.GetDOF() > 1 else joint.GetName())
        return names

    def _pressed_limits(self) -> list[str]:
        """Return sentences that name the joints at a limit beyond which the cost would decrease."""
        limits, values, pull = self._descent.limits, self._moving.values(), self._descent.pressing()
        sentences: list[str] = []
        for index, name in enumerate(self._variable_names()):
            if pull[index] > _PRESSING and values[index] >= limits.upper[index] - _AT_LIMIT:
                sentences.append(f"{name} is at its upper limit")
            if pull[index] < -_PRESSING and values[index] <= limits.lower[index] + _AT_LIMIT:
                sentences.append(f"{name} is at its lower limit")
        return sentences

    def _violated(self) -> Sequence[str]:
        sentences: list[str] = []
        for keeper in self._moving.keepers:
            distance, names = self._moving.nearest(keeper)
            if distance < keeper.least - _TOUCHED:
                sentences.append(f"{names} are {distance:.3g} m apart, and should be {keeper.least:.3g} m")
        com = self._moving.com()[0]
        for normals, offsets in self._moving.edges:
            if (beyond := float((normals @ com[:2] - offsets).max())) > _TOUCHED:
                sentences.append(f"the centre of mass is {beyond:.3g} m outside of its support")
        return sentences


def _subject(thing: KinBody | Link) -> BodyState | tuple[BodyState, int]:
    checked_kind(thing, (KinBody, Link), "other")
    if isinstance(thing, Link):
        return thing.GetParent().simulation_state, thing.GetIndex()
    return thing.simulation_state


def _checked_weight(weight: float) -> float:
    return checked_number(weight, "weight", 0.0)


def _checked_priority(priority: int) -> int:
    (number,) = checked_whole_numbers([priority], "priority").tolist()
    return number


def _checked_gain(gain: float) -> float:
    if not 0 < (checked := checked_number(gain, "gain")) <= 1:
        raise ArgumentError(f"gain: is {gain:g}, and should be above 0 and at most 1")
    return checked


def _checked_time(seconds: float, name: str) -> float:
    if type(seconds) is float and 0 < seconds < np.inf:  # faster than any check
        return seconds
    if (checked := checked_number(seconds, name)) <= 0:
        raise ArgumentError(f"{name}: is {seconds:g} s, and should be above 0")
    return checked

"""Planned joint and tool motions and their execution: the module ``BaseManipulation``."""

import itertools
from collections import Counter
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from itertools import islice
from operator import is_not
from typing import TYPE_CHECKING, Any

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, Diagnostic, send_warning
from ravemj.manipulation.arm_search import ArmSearch
from ravemj.manipulation.bodies import Bodies, Conditions
from ravemj.manipulation.motions import follow_goals, free_configuration, jittered, place_for_others
from ravemj.manipulation.options import JitterMotion, JointMotion, StraightMotion, ToolMotion, UnsyncMotion
from ravemj.manipulation.refusals import Cause, RefusedError, Tally
from ravemj.manipulation.roots import FunctionRoots, Sampler
from ravemj.manipulation.tool import ToolConstraint
from ravemj.planning.space import Space
from ravemj.rave.enums import IkFilterOptions, IkReturnAction
from ravemj.rave.ikreturn import IkFailureInfo
from ravemj.rave.kinbody import KinBody
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.planning.end_waypoints import EndWaypoint
from ravemj.rave.planning.names import is_planner, needed_planner, retimed
from ravemj.rave.planning.parameters import check_movable
from ravemj.rave.planning.planner import PlannerStatus, PlanningError
from ravemj.rave.planning.region_goals import MotionSets, preshaped_dofs
from ravemj.rave.planning.values import Values, hand_of
from ravemj.rave.robot import Robot
from ravemj.rave.specification import ConfigurationSpecification, IkParameterization
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.bodies import body_groups
from ravemj.trajectories.groups import AFFINE, Group
from ravemj.trajectories.layout import count
from ravemj.trajectories.waypoints import Waypoints

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


_SAME = 1e-9
"""Tolerance of equal configurations [rad or m]."""

NO_SETS = MotionSets()

Postprocessing = tuple[str, str]
Options = Mapping[str, Any]
"""Options of a command, by name."""


def tool_constraints(options: Options) -> list[ToolConstraint]:
    """Return the tool constraints in the options of a motion; none if the tool is free."""
    given = [name for name in options if name.startswith("constraint")]
    if given and "constraintfreedoms" not in given:
        raise ArgumentError(f"{given[0]} needs constraintfreedoms, which say what the constraint holds")
    return [constraint_of(options)] if given and np.any(options["constraintfreedoms"]) else []


def constraint_of(options: Options) -> ToolConstraint:
    """Return the tool constraint in the options of a command."""
    frame = options.get("constraintmatrix", options.get("constraintpose", np.eye(4)))
    point = options.get("constrainttaskmatrix", options.get("constrainttaskpose"))
    return ToolConstraint(frame, point, options["constraintfreedoms"], options.get("constrainterrorthresh", 1e-3))


class Manipulation:
    """Plan and execute motions of one robot.

    Attributes:
        env: The environment of the robot.
        planner: The name of the path planner.
        maxvelmult: The factor of the velocity limits for motions along straight lines.
    """

    def __init__(self, env: "Environment") -> None:
        self.env = env
        self.planner = "birrt"
        self.maxvelmult = 1.0
        self._robot: Robot | None = None

    @property
    def robot(self) -> Robot:
        """The robot.

        Raises:
            ArgumentError: no robot was chosen, or it is no longer in the environment.
        """
        if self._robot is None or not self.env.simulation.holds(self._robot.simulation_state):
            raise ArgumentError("there is no robot; add the module with the name of one, or send SetRobot")
        return self._robot

    def choose(self, name: str) -> bool:
        """Select the robot by name, and return whether the environment has it."""
        robot = self.env.GetRobot(name)
        if robot is not None:
            self._robot = robot
        return robot is not None

    def choose_planner(self, name: str) -> None:
        """Select the path planner; an unknown name selects ``birrt``, as in OpenRAVE."""
        self.planner = name if is_planner(name) else "birrt"

    def groups(self, dofs: Sequence[int] | None = None) -> list[Group]:
        """Return the layout of some joints of the robot, by default of the active DOFs."""
        if dofs is None:
            return self.robot.GetActiveConfigurationSpecification().GetGroups()
        return body_groups(self.robot.simulation_state.scene.name, dofs, 0, "")

    def bodies_of(self, dofs: Sequence[int]) -> Bodies:
        """Return the moving bodies of a planning problem for some joints of the robot."""
        return Bodies(self.env.simulation, self.groups(dofs), self.env.GetCollisionChecker)

    def stated(self, dofs: Sequence[int] | None = None) -> Values:
        """Return a planning problem for some joints, by default the active DOFs.

        Raises:
            RavemjError: an active joint moves a static link (``InvalidState``).
        """
        if dofs is None:
            check_movable(self.robot)
        values = Values()
        values.state(self.env, self.groups(dofs))
        return values

    def move_joints(
        self,
        goals: Sequence[Floats],
        options: JointMotion,
        *,
        dofs: Sequence[int] | None = None,
        starts: Sequence[Floats] = (),
        postprocessing: Postprocessing | None = None,
        more: Sampler | None = None,
        sets: MotionSets = NO_SETS,
    ) -> Trajectory:
        """Return a motion of some joints to one of several goals.

        Args:
            goals: The goals, each of shape (n,); values outside the limits are set to the limits.
            options: The options of the motion.
            dofs: The DOF indices of the joints; None for the active DOFs.
            starts: The possible starts; by default the current configuration.
            postprocessing: The smoother and its parameters; by default OpenRAVE's.
            more: A source of further goals during planning.
            sets: Regions as goals, and constraints along the whole motion. If regions are among the constraints, the
                motion is a smooth curve through many configurations in these regions.

        Raises:
            PlanningError: no motion was found; the message says why.
            ArgumentError: a goal or start has another shape, or is not finite; or the step length is not positive.
        """
        if not options.steplength > 0:
            raise ArgumentError(f"steplength: is {options.steplength:g}, and should be more than 0")
        values = self.stated(dofs)
        _check(goals, starts, count(values.groups))
        if not (len(goals) or sets.goals):
            raise PlanningError("there is no goal: goal, goals, matrices and the like are all empty")
        values.goal_sampler = more
        sampled = options.goalsampleprob if isinstance(options, ToolMotion) else ToolMotion.goalsampleprob
        values.numbers["_nmaxiterations"] = options.maxiter
        values.numbers["_fsteplength"] = options.steplength
        values.certify = options.certify
        sets.state(values, lambda: hand_of(self.env, values, gripper=True), sampled)
        values.postprocessing = postprocessing or values.postprocessing
        space, conditions = values.space(), values.conditions
        self._warn_of_limits(conditions, space, goals)
        wanted = [
            [space.clamp(configuration) for configuration in some]
            for some in (starts or [values.vectors["_vinitialconfig"]], goals)
        ]
        moved = [jittered(conditions, space, some, options.jitter) for some in wanted]
        values.vectors |= {"_vinitialconfig": np.array(moved[0]).ravel(), "_vgoalconfig": np.array(moved[1]).ravel()}
        status = PlannerStatus("no attempt was allowed; give at least one try")
        for attempt in range(options.maxtries):
            values.numbers["_nrandomgeneratorseed"] = attempt
            traj = Trajectory(self.env, "")
            status = needed_planner(self.env, self.planner).run(values, traj)
            if status:
                if any(map(is_not, itertools.chain(*moved), itertools.chain(*wanted))):
                    self._join(traj, values.groups, wanted, moved)
                    if options.certify and not traj.certify().certified and options.certify == "required":
                        raise PlanningError(f"not certified from the start to the goal: {traj.certificate}")
                traj.start_index, traj.goal_index = status.start_index, status.goal_index
                return traj
        raise PlanningError(status.description, status=status)

    def _warn_of_limits(self, conditions: Conditions, space: Space, goals: Sequence[Floats]) -> None:
        """Warn of the first goal value that is outside its limits."""
        assert conditions.bodies is not None, "something moves"
        for goal in goals:
            away = np.abs(space.clamp(goal) - goal)
            if away.max(initial=0.0) > _SAME:
                number = int(away.argmax())
                limits = f"[{space.lower[number]:.6g}, {space.upper[number]:.6g}]"
                told = f"the goal has {conditions.bodies.described(number)} at {goal[number]:.6g}, outside its limits"
                message = f"{told} {limits}; the motion stops at the limit"
                source = self.robot.simulation_state.scene.source
                send_warning(Diagnostic("warning", "value-outside-limits", message, source))
                return

    def _join(
        self,
        traj: Trajectory,
        groups: Sequence[Group],
        wanted: Sequence[Sequence[Floats]],
        moved: Sequence[Sequence[Floats]],
    ) -> None:
        """Extend a motion to the original start and goal if the planner used jittered ones.

        ``wanted`` has the original starts and goals, ``moved`` the jittered ones.
        """
        spec = ConfigurationSpecification.of(groups)
        for end, (asked, used) in enumerate(zip(wanted, moved, strict=True)):
            place = traj.GetNumWaypoints() if end else 0
            reached = traj.GetWaypoint(-1 if end else 0, spec)
            nearest = int(np.argmin([np.abs(goal - reached).max() for goal in used]))
            is_it = np.abs(used[nearest] - reached).max() < _SAME  # and no goal that came later
            if is_it and (asked[nearest] != used[nearest]).any():
                rest = np.zeros(len(reached))
                new = EndWaypoint(traj, spec, asked[nearest], rest, place)
                has_pose = any(group.kind == AFFINE[0] for group in groups)
                retimer = "LinearTrajectoryRetimer" if has_pose else ""  # the only one for poses
                new.join(new.retimed((1.0, 1.0), retimer, ""))

    def straight(self, points: Floats, dofs: Sequence[int] | None = None) -> Trajectory:
        """Return the fastest motion of joints, by default the active DOFs, along straight lines between points (m, n).

        Raises:
            PlanningError: retiming fails.
        """
        traj = Trajectory(self.env, "")
        traj.set_waypoints(Waypoints(self.groups(dofs), points))
        status = retimed(traj, "LinearTrajectoryRetimer", (self.maxvelmult, 1.0))
        if not status:
            raise PlanningError(status.description)
        return traj

    def execute(self, traj: Trajectory) -> None:
        """Start a motion on the robot's controller; it begins with the next simulation step.

        Raises:
            PlanningError: the robot has no controller.
        """
        robot = self.robot
        controller = robot.GetController()
        if controller is None:
            raise PlanningError(f"robot '{robot.GetName()}' has no controller to execute the motion")
        if traj.GetNumWaypoints() > 1:
            controller.SetPath(traj)
            return
        values = robot.GetDOFValues()
        spec = traj.GetConfigurationSpecification()
        group = spec.FindCompatibleGroup(f"joint_values {robot.GetName()}")
        if group is not None:
            used, _ = spec.ExtractUsedIndices(robot)
            values[used] = spec.ExtractJointValues(traj.GetWaypoint(0), robot, used)
        controller.SetDesired(values)


def _check(goals: Sequence[Floats], starts: Sequence[Floats], dof: int) -> None:
    for configuration in [*goals, *starts]:
        if len(configuration) != dof or not np.isfinite(configuration).all():
            raise ArgumentError(f"a goal or start is {configuration.tolist()}, and should be {dof} finite numbers")


def _unreached(manip: Manipulator, goals: Sequence[IkParameterization]) -> str:
    """Describe by how much the first goal is out of reach, or that it collides."""
    shortfall = manip.search(goals[0], _CHECKED).shortfall()
    if not shortfall:
        return "without collisions for any of the goals"
    which = "for the goal, which" if len(goals) == 1 else f"for any of the {len(goals)} goals; the first"
    return f"{which} is out of reach: {shortfall}"


_CHECKED = int(IkFilterOptions.CheckEnvCollisions)


class BaseManipulation(Manipulation):
    """Plan motions of the active DOFs, of an arm, or of its tool."""

    def move_manipulator(self, goals: Sequence[Floats], options: JointMotion) -> Trajectory:
        """Return a motion of the active manipulator's arm to one of several goals, each of shape (arm dof,).

        Raises:
            PlanningError: no motion was found.
        """
        return self.move_joints(goals, options, dofs=self.arm().description.arm_dofs)

    def arm(self) -> Manipulator:
        """Return the active manipulator.

        Raises:
            PlanningError: the robot has no active manipulator.
        """
        manip = self.robot.GetActiveManipulator()
        if manip is None:
            raise PlanningError(f"robot '{self.robot.GetName()}' has no active manipulator")
        return manip

    def move_to_hand_position(
        self,
        goals: Sequence[IkParameterization],
        options: ToolMotion,
        *,
        starts: Sequence[Floats] = (),
        postprocessing: Postprocessing | None = None,
        sets: MotionSets = NO_SETS,
    ) -> Trajectory:
        """Return a motion of the arm that moves its tool to one of several goals.

        Args:
            goals: The goals of the tool.
            options: The effort of the search.
            starts: The possible starts of the arm; by default its current values.
            postprocessing: The smoother and its parameters; by default OpenRAVE's.
            sets: Regions as goals, and constraints along the whole motion.

        Raises:
            PlanningError: no motion was found.
            ArgumentError: a number of solutions is negative.
        """
        if not (goals or sets.goals):
            raise PlanningError("there is no goal: goal, goals, matrices and the like are all empty")
        seedik, goalsamples = options.seedik, options.goalsamples
        if min(seedik, goalsamples) < 0:
            raise ArgumentError(f"seedik is {seedik} and goalsamples {goalsamples}, and both should be 0 or more")
        manip = self._solvable() if goals else self.arm()
        gripper = preshaped_dofs(manip, sets.goals)
        present = self.robot.GetDOFValues()[gripper]
        stream = (np.append(row, present) for goal in goals for row in manip.search(goal, _CHECKED).every())
        solutions = list(islice(stream, min(seedik, goalsamples)))
        if not (solutions or sets.goals):
            raise _without_solutions(manip, goals)
        rest = islice(stream, goalsamples - len(solutions))
        more = Sampler(FunctionRoots(lambda: next(rest, None)), options.goalsampleprob)
        return self.move_joints(
            solutions,
            options,
            dofs=[*manip.description.arm_dofs, *gripper],
            starts=[np.append(row, present) for row in starts],
            postprocessing=postprocessing,
            more=more,
            sets=sets,
        )

    @contextmanager
    def holding(self, body: KinBody | str | None) -> Generator[KinBody | None]:
        """Context manager that grabs a body with the end effector, unless it is grabbed already.

        The body is given by itself or by its name.

        Raises:
            ArgumentError: the body does not exist.
        """
        held = self.env.GetKinBody(body) if isinstance(body, str) else body
        if body is not None and held is None:
            raise ArgumentError(f"holding: there is no body '{body}' in the environment")
        if held is None or self.robot.IsGrabbing(held) is not None:
            yield held
            return
        self.robot.Grab(held)
        try:
            yield held
        finally:
            self.robot.Release(held)

    def _solvable(self) -> Manipulator:
        manip = self.arm()
        if manip.GetIkSolver() is None:
            raise PlanningError(f"manipulator '{manip.GetName()}' has no solver of inverse kinematics (IK)")
        return manip

    def move_hand_straight(
        self,
        direction: Floats,
        options: StraightMotion,
        starteematrix: Floats | None = None,
    ) -> Trajectory:
        """Return a motion that moves the tool along a straight line as far as the arm can follow.

        Args:
            direction: The direction of the line in the world, of any length, shape (3,).
            options: The step size and the numbers of steps.
            starteematrix: ``T_world_tool`` at the start; by default the current pose.

        Raises:
            PlanningError: the arm can follow for less than ``minsteps`` steps.
        """
        length, stepsize = float(np.linalg.norm(direction)), options.stepsize
        if not (np.isfinite(length) and length > 0 and stepsize > 0):
            raise ArgumentError(f"direction {direction.tolist()} and stepsize {stepsize:g} should not be 0")
        manip = self._solvable()
        T_world_tool = manip.GetTransform() if starteematrix is None else starteematrix
        step = direction / length * stepsize
        present, reached = manip.GetArmDOFValues(), 0
        firsts = [present]
        if starteematrix is not None:
            firsts = _search(manip, T_world_tool, options.ignorefirstcollision < 0).every()
            firsts.sort(key=lambda row: float(np.abs(row - present).max()))

        def pose(number: int) -> tuple[Floats, bool]:
            T_world_goal = T_world_tool.copy()
            T_world_goal[:3, 3] += step * number
            return T_world_goal, number * stepsize > options.ignorefirstcollision

        for row in firsts:
            rows = self.follow(manip, pose, options.maxsteps, row)
            reached = max(reached, len(rows) - 1)
            if reached >= max(options.minsteps, 1):
                return self.straight(rows, manip.description.arm_dofs)
        raise PlanningError(f"the tool gets {reached} steps far, and should get {max(options.minsteps, 1)}")

    def follow(
        self, manip: Manipulator, pose: Callable[[int], tuple[Floats, bool]], count: int, first: Floats
    ) -> Floats:
        """Return joint values along tool poses without jumps, up to the first unreachable pose, shape (m, n).

        Args:
            manip: The manipulator.
            pose: Returns ``T_world_tool`` and whether collisions count, for a number from 1 to ``count``.
            count: The number of poses.
            first: The joint values to start from, shape (n,), which are the first row.
        """
        space = self.stated(manip.description.arm_dofs).space()
        return follow_goals(space, first, count, lambda number: _search(manip, *pose(number)))

    def move_unsync_joints(
        self,
        hand: Floats,
        indices: Sequence[int],
        options: UnsyncMotion,
    ) -> Trajectory:
        """Return a motion of the active DOFs to a configuration at which other joints can reach given values.

        Both motions are free of collisions; that of the other joints is not part of the result.

        Args:
            hand: The values for the other joints.
            indices: The DOF indices of the other joints.
            options: The options of the search.

        Raises:
            PlanningError: no motion was found.
        """
        maxdivision = options.maxdivision
        if not np.isfinite(hand).all() or maxdivision < 1:
            message = f"jointvalues are {hand.tolist()} in {maxdivision} divisions"
            raise ArgumentError(f"{message}, and should be finite numbers in 1 at least")
        values, others = self.stated(), self.bodies_of(indices)
        space, here = values.space(), values.vectors["_vinitialconfig"]
        for attempt in range(options.maxtries):
            goal = place_for_others(values.conditions, space, here, others, hand, maxdivision, attempt)
            if goal is None:
                continue
            if goal is here:
                return self.straight(here[None])
            motion = self._by(options.planner, lambda goal=goal: self.move_joints([goal], JointMotion()))
            if motion is not None:
                return motion
        raise PlanningError("there is no place where the joints can move to their values")

    def _by(self, planner: str, plan: Callable[[], Trajectory]) -> Trajectory | None:
        old, self.planner = self.planner, planner if is_planner(planner) else "birrt"
        try:
            return plan()
        except PlanningError:
            return None
        finally:
            self.planner = old

    def jitter_active(self, options: JitterMotion) -> tuple[Floats, Trajectory]:
        """Return a free configuration of the active DOFs near the current one, and the straight motion to it.

        Raises:
            PlanningError: none of the random configurations is free of collisions.
        """
        values = self.stated()
        here = values.vectors["_vinitialconfig"]
        free = free_configuration(values.conditions, values.space(), here, options.maxiter, options.jitter)
        if free is None:
            raise PlanningError(f"{options.maxiter} configurations within {options.jitter:g} are all in collision")
        return free, self.straight(here[None] if free is here else np.stack([here, free]))


_CAUSES = {
    IkReturnAction.RejectKinematics: Cause.REACH,
    IkReturnAction.RejectJointLimits: Cause.LIMITS,
    IkReturnAction.RejectSelfCollision: Cause.SELF_COLLISION,
    IkReturnAction.RejectCustomFilter: Cause.FILTER,
}
"""Failure causes by OpenRAVE's codes; any other code means a collision with another body."""


def _without_solutions(manip: Manipulator, goals: Sequence[IkParameterization]) -> PlanningError:
    """Return an error that counts the goals without IK solution by cause, and names two colliding links."""
    tally, pairs = Tally([""]), Counter[str]()
    for goal in goals:
        failures: list[IkFailureInfo] = []
        manip.FindIKSolutions(goal, _CHECKED, ikFailureAccumulator=failures)
        refusals: list[RefusedError] = []
        for failure in failures:
            first, second = failure.GetCollisionReport().plink1, failure.GetCollisionReport().plink2
            if first is not None and second is not None:
                pairs[f"link '{first.GetName()}' with link '{second.GetName()}'"] += 1
            cause = _CAUSES.get(failure.GetAction(), Cause.COLLISION)
            refusals.append(RefusedError(cause.value, cause=cause, values=failure.GetConfiguration()))
        tally.note(0, refusals or [RefusedError(Cause.REACH.value, cause=Cause.REACH)])
    example = f" (e.g. {pairs.most_common(1)[0][0]})" if pairs else ""
    reason = f"inverse kinematics (IK) has no solution {_unreached(manip, goals)}"
    status = PlannerStatus(f"{reason}: {tally.described()}{example}")
    status.tally = tally
    return PlanningError(status.description, status=status)


def _search(manip: Manipulator, T_world_tool: Floats, check: bool) -> ArmSearch:
    options = IkFilterOptions.CheckEnvCollisions if check else IkFilterOptions.IgnoreSelfCollisions
    return manip.search(T_world_tool, int(options))

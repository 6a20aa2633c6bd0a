"""Planners of hand motions: along a given hand trajectory, and to one of several grasps."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import ClassVar

import numpy as np

from ravemj.core.transforms import Floats, pose_of
from ravemj.errors import ArgumentError, RavemjError
from ravemj.geometry_functions import matrixFromPose, matrixFromPoses
from ravemj.manipulation.processing import flag
from ravemj.planning.edges import Edges
from ravemj.planning.projection import descend
from ravemj.planning.rrt import Budget, End, Problem, Search
from ravemj.planning.tracking import LARGEST_JUMP, track
from ravemj.rave.enums import PlannerStatusCode
from ravemj.rave.planning.path_planners import PathPlanner
from ravemj.rave.planning.planner import Planner, PlannerStatus
from ravemj.rave.planning.processing import post_process
from ravemj.rave.planning.values import CHAIN, Hand, Values, hand_of
from ravemj.rave.specification import ConfigurationSpecification, IkParameterization
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories import extraction
from ravemj.trajectories.groups import AFFINE

_MOST_GOALS = 100_000
"""Maximum number of goals of a hand trajectory. At half a millisecond each, these take a minute."""

_REACHED = 1e-6
"""Largest distance from a grasp at which it counts as reached [m and rad]."""


class WorkspaceTrajectoryTracker(Planner):
    """``WorkspaceTrajectoryTracker``: the hand follows a given trajectory without jumps of the joints.

    The trajectory is sampled in steps of ``_fsteplength`` [s]; each sample is a goal of inverse kinematics. The motion
    begins in the current configuration of the robot if this reaches the first goal and the motion can continue from it,
    else in another solution. A smoother would leave the given trajectory, so ``LinearTrajectoryRetimer`` retimes the
    result, unless the parameters name another planner.
    """

    _defaults: ClassVar[Mapping[str, str]] = {
        "maxdeviationangle": "0.47123889803846897",
        "maintaintiming": "0",
        "greedysearch": "0",
        "ignorefirstcollision": "0",
        "minimumcompletetime": "1e30",
    }

    def _prepare(self, values: Values) -> PlannerStatus | None:
        try:
            hand = hand_of(self._env, values)
            goals = self._goals(values, hand)[1]
        except RavemjError as error:
            return self._failed(error.message)
        if hand.manip.GetIkSolver() is None:
            return self._failed(f"manipulator '{hand.manip.GetName()}' has no solver of inverse kinematics (IK)")
        return None if goals else self._failed("the trajectory of the hand has no waypoints")

    def _goals(self, values: Values, hand: Hand) -> tuple[Floats, list[IkParameterization]]:
        """Return times [s] and tool goals along the trajectory of the hand; empty if it has no waypoints."""
        text = values.tags.get("workspacetrajectory", "")
        if not text:
            raise ArgumentError("there is no trajectory of the hand; give it as <workspacetrajectory>")
        traj = Trajectory(self._env, "").deserialize(text)
        if not traj.GetNumWaypoints():
            return np.zeros(0), []
        step = values.numbers["_fsteplength"]
        if not step * _MOST_GOALS > traj.GetDuration():
            raise ArgumentError(f"_fsteplength: is {step:g} s for {traj.GetDuration():g} s, and should be more")
        count = int(np.ceil(traj.GetDuration() / step - 1e-9))  # rounding shall not add a step of no length
        times = np.minimum(np.arange(count + 1) * step, traj.GetDuration())
        return times, [_goal(traj, time, hand) for time in times.tolist()]

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Follow the trajectory of the hand."""
        problem = self._prepare(values)
        if problem is not None:
            return problem
        hand = hand_of(self._env, values)
        times, goals = self._goals(values, hand)
        budget = Budget(len(goals), values.numbers["_nmaxplanningtime"] / 1000, self._proceed)
        ended: list[End] = []

        def solve(number: int, near: Floats) -> Sequence[Floats]:
            stopped = budget.end(number)
            if stopped is not None:
                ended.append(stopped)
                return []
            return self._solutions(values, hand, goals[number], near, check=self._is_checked(values, times[number]))

        with hand.tool.bodies.kept():
            start = values.configurations("_vinitialconfig")[0]
            path = track(values.space(), len(goals), start, solve, self._connection(values, hand, times))
        reached = float(times[len(path) - 1]) if len(path) else 0.0
        if len(path) < len(goals) and not (len(path) and reached >= values.tag("minimumcompletetime", 1e30)):
            why = ended[0].value if ended else "no solution of inverse kinematics (IK) continues the motion"
            status = self._failed(f"the hand gets to {reached:.6g} s of {times[-1]:.6g} s: {why}")
            status.jointValues = path[-1] if len(path) else start
            status.statusCode = PlannerStatusCode.Interrupted if End.interrupted in ended else status.statusCode
            return status
        return self._timed(values, traj, path, times[: len(path)])

    def _is_checked(self, values: Values, time: float) -> bool:
        """Return whether collisions count at a time [s]: from ``ignorefirstcollision`` on."""
        return time >= values.tag("ignorefirstcollision", 0.0)

    def _solutions(
        self, values: Values, hand: Hand, goal: IkParameterization, near: Floats, *, check: bool
    ) -> list[Floats]:
        """Return the configurations that reach a goal, nearest to ``near`` first; for greedy searches only one.

        If ``check``, they also satisfy the constraints and are free of collisions.
        """
        hand.tool.bodies.move(near)
        solutions: list[Floats] = []
        for row in hand.manip.FindIKSolutions(goal, 0):
            configuration = np.zeros(hand.tool.dof)
            configuration[hand.tool.columns] = row
            solutions.append(near + values.space().difference(configuration, near))
        if check:
            solutions = list(filter(values.conditions.allowed(), solutions))
        solutions.sort(key=lambda solution: values.space().distance(solution, near))
        return solutions[:1] if flag(values.tags, "greedysearch") else solutions

    def _connection(self, values: Values, hand: Hand, times: Floats) -> Callable[[int, Floats, Floats], bool]:
        """Return a test whether a joint-space line connects solutions of consecutive goals.

        The line is rejected if a joint jumps or is too fast, if the hand turns by more than ``maxdeviationangle`` in
        half of the line, or if the robot collides on it.
        """
        edges, largest_turn = (
            Edges(values.space(), values.conditions.allowed()),
            values.tag("maxdeviationangle", 0.15 * np.pi),
        )
        fastest = values.limits().velocity if flag(values.tags, "maintaintiming") else np.full(hand.tool.dof, np.inf)

        def connects(number: int, before: Floats, after: Floats) -> bool:
            step = edges.space.difference(after, before)
            elapsed = times[number] - times[number - 1]
            if np.abs(step).max() > LARGEST_JUMP or (np.abs(step) > fastest * elapsed * (1 + 1e-9)).any():
                return False
            turned = [
                hand.tool.motion(configuration)[0][:3, :3] for configuration in (before, before + step / 2, after)
            ]
            if max(_angle(turned[0], turned[1]), _angle(turned[1], turned[2])) > largest_turn:
                return False
            return not self._is_checked(values, times[number]) or edges.line(before, step)

        return connects

    def _timed(self, values: Values, traj: Trajectory, path: Floats, times: Floats) -> PlannerStatus:
        """Write a path into a trajectory, and retime it."""
        spec = ConfigurationSpecification.of(values.groups)
        keeps = flag(values.tags, "maintaintiming")
        if keeps or values.postprocessing == CHAIN:
            values = values.copied()
            values.postprocessing = "LinearTrajectoryRetimer", "<hastimestamps>1</hastimestamps>" if keeps else ""
        column = spec.AddDeltaTimeGroup()
        rows = np.zeros((len(path), spec.GetDOF()))
        for group in values.groups:
            rows[:, group.columns] = path[:, group.columns]
        rows[:, column] = np.diff(times, prepend=0.0)
        traj.Init(spec)
        traj.Insert(0, rows.ravel())
        problem = post_process(self._env, values, traj)
        return problem or self._solved(f"the hand follows {len(path)} goals to {times[-1]:.6g} s")


def _goal(traj: Trajectory, time: float, hand: Hand) -> IkParameterization:
    spec, row = traj.GetConfigurationSpecification(), traj.Sample(time) if len(traj) > 1 else traj.GetWaypoint(0)
    goal = spec.ExtractIkParameterization(row)
    if goal is not None:
        return goal
    if not any(group.kind == AFFINE[0] for group in spec.GetGroups()):
        raise ArgumentError(
            "the trajectory of the hand has neither poses (affine_transform) nor goals (ikparam_values)"
        )
    pose = extraction.pose(spec.GetGroups(), row, None, pose_of(hand.manip.GetTransform()))
    assert pose is not None, "there is such a group"
    return IkParameterization(matrixFromPose(pose.numbers()), IkParameterization.Type.Transform6D)


def _angle(rotation: Floats, other: Floats) -> float:
    return float(np.arccos(np.clip((np.trace(rotation.T @ other) - 1) / 2, -1.0, 1.0)))


class GraspGradient(PathPlanner):
    """``GraspGradient``: the hand descends the gradient of its distance to grasps, starting with the nearest.

    ``<target>`` names the body to grasp. ``<grasps>`` has the number of grasps, then seven numbers for each: the pose
    ``T_target_tool`` as quaternion (wxyz) and position [m].
    """

    _defaults: ClassVar[Mapping[str, str]] = {"graspdistthresh": "1.4", "numgradsamples": "5", "visgraspthresh": "0"}

    _needs_goal: ClassVar[bool] = False

    def _check(self, values: Values) -> None:
        hand_of(self._env, values)
        self._grasps(values)
        super()._check(values)

    def _grasps(self, values: Values) -> list[Floats]:
        """Return ``T_world_tool`` of each grasp."""
        name = values.tags.get("target", "")
        target = self._env.GetKinBody(name)
        if target is None:
            raise ArgumentError(f"<target>: there is no body '{name}'")
        try:
            count, *numbers = [float(word) for word in values.tags.get("grasps", "0").split()]
        except ValueError:
            count, numbers = 0.0, [0.0]
        if count < 1 or len(numbers) != 7 * count or not np.isfinite(numbers).all():
            raise ArgumentError("<grasps>: should be the number of grasps and 7 numbers for each, a pose in the target")
        T_world_target = target.GetTransform()
        return [T_world_target @ T_target_tool for T_target_tool in matrixFromPoses(np.reshape(numbers, (-1, 7)))]

    def _search(self, problem: Problem, values: Values) -> Search:
        start = problem.starts[0]
        hand = hand_of(self._env, values)
        errors = [hand.tool.to_pose(grasp) for grasp in self._grasps(values)]
        far = [float(np.linalg.norm(error(start)[0])) for error in errors]
        order: list[int] = np.argsort(far).tolist()
        near = [place for place in order if far[place] <= values.tag("graspdistthresh", 1.4)]
        tries = int(values.tag("numgradsamples", 5))
        wanted = [errors[place] for place in near]
        search = descend(problem.edges, start, wanted, _REACHED, problem.budget, problem.random, tries)
        return replace(search, goal=near[search.goal] if search.path is not None else -1)

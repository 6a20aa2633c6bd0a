"""Planners that find a path without collisions."""

import logging
from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.manipulation.motions import RefusedError, allowed_ends, find_path, refusal
from ravemj.planning.edges import Allowed
from ravemj.planning.ompl_search import OmplError, planner_classes, search_with_ompl
from ravemj.planning.problem import Problem
from ravemj.planning.randomized_astar import search_by_cost
from ravemj.planning.rrt import Budget, End, MoreGoals, Search, connect, explore, single
from ravemj.rave.enums import PlannerAction, PlannerStatusCode
from ravemj.rave.planning.planner import Planner, PlannerStatus
from ravemj.rave.planning.processing import post_process
from ravemj.rave.planning.values import Values
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.waypoints import Waypoints

_ITERATIONS = 10000
"""OpenRAVE's default for the maximum number of iterations."""

_SPACING = 10
"""The largest distance of the waypoints of a path that no planner processes, in step lengths."""


class PathPlanner(Planner):
    """A planner that finds a path without collisions from one of several starts to one of several goals."""

    _needs_goal: ClassVar[bool] = True
    _samples_goals: ClassVar[bool] = False
    """Whether a goal sampler can take the place of goals."""

    def __init__(self, *arguments: Any) -> None:  # noqa: ANN401 - passed on
        super().__init__(*arguments)
        self._search_made: Search | None = None

    @property
    def search(self) -> Search | None:
        """The last search with its trees, successful or not; None before the first one.

        Example:
            >>> for tree in planner.search.trees:
            ...     configurations, lines = tree.nodes(), tree.lines()
        """
        return self._search_made

    def _prepare(self, values: Values) -> PlannerStatus | None:
        with values.conditions.kept():
            problem = self._stated(values)
        return problem if isinstance(problem, PlannerStatus) else None

    def _check(self, values: Values) -> None:
        """Check the parameters; starts and goals come later."""
        values.check()

    def _stated(self, values: Values) -> Problem | PlannerStatus:
        """Return the problem, or why no start or goal is allowed. Use it within ``conditions.kept``."""
        try:
            self._check(values)
            starts, goals = values.configurations("_vinitialconfig"), values.configurations("_vgoalconfig")
        except ArgumentError as error:
            return self._failed(error.message)
        needs_goal = self._needs_goal and not (self._samples_goals and values.goal_sampler is not None)
        space, conditions = values.space(), values.conditions
        allowed = conditions.allowed()
        try:
            ends = allowed_ends(conditions, space, allowed, (list(starts), list(goals)), needs_goal=needs_goal)
        except RefusedError as error:
            status = self._failed(str(error))
            status.jointValues = error.values
            if error.findings is not None:
                status.report = self._env.GetCollisionChecker().report(error.findings)
            return status
        iterations = int(values.numbers["_nmaxiterations"]) or _ITERATIONS
        budget = Budget(iterations, values.numbers["_nmaxplanningtime"] / 1000, self._proceed)
        near = conditions.near_others(space, np.array([*ends[0], *ends[1]]))
        edges = conditions.edges(near, allowed, values.numbers["_fsteplength"])
        return Problem(edges, *ends, budget, values.random(), _more_goals(values, allowed))

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Find a path, and process it."""
        self._action = 0
        with values.conditions.kept():
            problem = self._stated(values)
            if isinstance(problem, PlannerStatus):
                return problem
            spacing = 0.0 if values.postprocessing[0] else _SPACING * values.numbers["_fsteplength"]
            search = find_path(problem, lambda problem: self._search(problem, values), spacing)
        self._search_made = search
        if search.path is None:
            return self._ended(search)
        traj.set_waypoints(Waypoints(values.groups, search.path))
        return self._processed(values, traj, search)

    @abstractmethod
    def _search(self, problem: Problem, values: Values) -> Search: ...

    def _ended(self, search: Search) -> PlannerStatus:
        size = sum(tree.count for tree in search.trees)
        grown = f", with {size} configurations" if search.trees else ""
        status = self._failed(f"{search.end.value} after {search.iterations} iterations{grown}")
        if search.end is End.interrupted:
            status.statusCode = PlannerStatusCode.Interrupted
        return status

    def _processed(self, values: Values, traj: Trajectory, search: Search) -> PlannerStatus:
        """Run the smoothers and retimers of the parameters on a path."""
        problem = post_process(self._env, values, traj)
        if problem is not None:
            return problem
        if self._action == PlannerAction.ReturnWithAnySolution:
            return PlannerStatus("a callback asked for any path", PlannerStatusCode.InterruptedWithSolution)
        return self._solved(f"found after {search.iterations} iterations")

    def _ends(self) -> tuple[int, int]:
        """Return the indices of the start and of the goal that the last path connects; -1 where there is none."""
        return (-1, -1) if self._search_made is None else (self._search_made.start, self._search_made.goal)

    _commands: ClassVar[Mapping[str, Callable[[Any, str], str]]] = {
        "GetGoalIndex": lambda self, _: str(self._ends()[1]),
        "GetInitGoalIndices": lambda self, _: "{} {}".format(*self._ends()),
        "GetInitIndex": lambda self, _: str(self._ends()[0]),
    }


class BiRrt(PathPlanner):
    """``birrt``: bidirectional RRT-Connect; trees from all starts and all goals grow towards each other."""

    _defaults: ClassVar[Mapping[str, str]] = {"minimumgoalpaths": "1"}
    _samples_goals: ClassVar[bool] = True

    def _search(self, problem: Problem, values: Values) -> Search:
        del values
        given = problem.edges, problem.starts, problem.goals, problem.budget, problem.random
        return connect(*given, problem.more)


class BasicRrt(PathPlanner):
    """``BasicRRT``: one tree grows from the starts; with the probability ``goalbias`` it grows towards a goal."""

    _defaults: ClassVar[Mapping[str, str]] = {"goalbias": "0.05", "nrrtextenttype": "0", "nminiterations": "0"}

    def _search(self, problem: Problem, values: Values) -> Search:
        bias = values.tag("goalbias", 0.05)
        return single(problem.edges, problem.starts, problem.goals, problem.budget, problem.random, bias)


class RaStar(PathPlanner):
    """``RA*``: a randomized A* that expands random neighbours, the most promising configuration first."""

    def _search(self, problem: Problem, values: Values) -> Search:
        del values
        return search_by_cost(problem.edges, problem.starts, problem.goals, problem.budget, problem.random)


class ExplorationRrt(PathPlanner):
    """``ExplorationRRT``: one tree explores the free space around the starts; its configurations are the result."""

    _defaults: ClassVar[Mapping[str, str]] = {"exploreprob": "0", "expectedsize": "100"}

    _needs_goal: ClassVar[bool] = False

    def _search(self, problem: Problem, values: Values) -> Search:
        size = int(values.tag("expectedsize", 100))
        tree = explore(problem.edges, problem.starts, size, problem.budget, problem.random)
        return Search(End.found, tree.nodes(), 0, -1, tree.count, (tree,))

    def _processed(self, values: Values, traj: Trajectory, search: Search) -> PlannerStatus:
        """Leave the configurations alone: they are the nodes of a tree, not a path to be smoothed."""
        return self._solved(f"{traj.GetNumWaypoints()} configurations")


def _more_goals(values: Values, allowed: Allowed) -> MoreGoals | None:
    """Return the goal sampler of the parameters, without goals that are not allowed."""
    if values.goal_sampler is None:
        return None
    sampler, space = values.goal_sampler, values.space()

    def next_goal() -> Floats | None:
        goal = sampler.sample()
        if goal is None or refusal(values.conditions, space, allowed, goal, "goal") is not None:
            return None
        return goal

    return MoreGoals(next_goal, sampler.probability)


_LOG = logging.getLogger("ravemj")

PREFIX = "ompl_"
"""The prefix of the names, in lower case."""


def is_ompl_planner(name: str) -> bool:
    """Return whether OMPL has a planner of a name. If OMPL is not installed, log how to install it."""
    classes = planner_classes()
    if classes is None:
        _LOG.warning("planner '%s' needs OMPL; install it: pip install \"ravemj[planning]\"", name)
        return False
    return name.lower().removeprefix(PREFIX) in classes


class OmplPlanner(PathPlanner):
    """A path planner of OMPL.

    Extra parameters of the planner are XML elements, such as ``<range>0.5</range>`` or ``<goal_bias>0.1</goal_bias>``.
    ``<time_limit>`` is the time it may take [s], as with or_ompl. Planners that look for the best path use all of their
    time or iterations.
    """

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Find a path, and process it."""
        try:
            return super().run(values, traj)
        except OmplError as error:
            return self._failed(str(error))

    def _check(self, values: Values) -> None:
        if values.conditions.manifold is not None:
            raise ArgumentError(f"{self._xmlid} knows no constraints of the tool; birrt does")
        super()._check(values)

    def _search(self, problem: Problem, values: Values) -> Search:
        classes = planner_classes()
        assert classes is not None, "there would be no planner"
        planner = classes[self._xmlid.lower().removeprefix(PREFIX)]
        budget, tags = problem.budget, values.tags
        if "time_limit" in tags:
            budget = replace(budget, seconds=values.tag("time_limit", 0.0))
        seed = int(problem.random.integers(2**31))
        return search_with_ompl(planner, problem.edges, problem.starts, problem.goals, budget, seed, tags)

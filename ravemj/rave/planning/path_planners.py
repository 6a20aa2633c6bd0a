"""Planners of collision-free paths."""

import logging
from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.manipulation.motions import find_path
from ravemj.manipulation.refusals import Blocked, RefusedError, allowed_ends, refusal
from ravemj.manipulation.roots import FIRST_ROOTS, Refuse, RootSource, Sampler
from ravemj.planning.ompl_search import OmplError, planner_classes, search_with_ompl
from ravemj.planning.randomized_astar import search_by_cost
from ravemj.planning.rrt import Budget, End, MoreRoots, Problem, Search, connect, explore, single
from ravemj.rave.enums import PlannerAction, PlannerStatusCode
from ravemj.rave.planning.planner import Planner, PlannerStatus
from ravemj.rave.planning.processing import post_process
from ravemj.rave.planning.values import CHAIN, Values
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.waypoints import Waypoints

_ITERATIONS = 10000
"""OpenRAVE's default for the maximum number of iterations."""

_SPACING = 10
"""Maximum distance between waypoints of a path without post-processing, in step lengths."""


_STRICT_ITERATIONS, _STRICT_EFFORT = 50, 4
"""Iteration limit of a search that certifies each edge: the minimum, and the factor on those of the first search."""


class PathPlanner(Planner):
    """Base class of planners of collision-free paths from one of several starts to one of several goals."""

    _needs_goal: ClassVar[bool] = True
    _samples_roots: ClassVar[bool] = False
    """Whether starts and goals are sampled during the search."""

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
            problem = self._stated(values, enough=1)
        return problem if isinstance(problem, PlannerStatus) else None

    def _check(self, values: Values) -> None:
        """Check the parameters except for starts and goals."""
        values.check()

    def _stated(self, values: Values, enough: int) -> Problem | PlannerStatus:
        """Return the problem, or the failure status if no start or no goal is valid. Call within ``conditions.kept``.

        ``enough`` is the number of starts and of goals to sample from regions.
        """
        try:
            self._check(values)
            starts, goals = values.configurations("_vinitialconfig"), values.configurations("_vgoalconfig")
        except ArgumentError as error:
            return self._failed(error.message)
        space, conditions = values.space(), values.conditions
        allowed, random = conditions.allowed(), values.random()

        def refuse(root: Floats) -> RefusedError | None:
            return refusal(conditions, space, allowed, root, "goal")

        def draw(source: RootSource) -> list[Floats]:
            return source.first(refuse, random, enough=enough)

        def ends(name: str, given: Floats, sampler: Sampler | None) -> list[Floats]:
            needed = (sampler is None or not self._samples_roots) and (name == "start" or self._needs_goal)
            roots = _with_first_roots(name, given, sampler, draw)
            return allowed_ends(conditions, space, allowed, name, roots, needed=needed)

        samplers = values.start_sampler, values.goal_sampler
        try:
            starts = ends("start", starts, samplers[0])  # before goals are sampled, which may take long
            goals = ends("goal", goals, samplers[1])
        except RefusedError as error:
            return self._refused(error)
        iterations = int(values.numbers["_nmaxiterations"]) or _ITERATIONS
        budget = Budget(iterations, values.numbers["_nmaxplanningtime"] / 1000, self._proceed)
        configurations = [*starts, *goals]
        near = conditions.near_others(space, np.array(configurations))
        edges = conditions.edges(near, allowed, values.numbers["_fsteplength"], configurations)
        more = [_further(sampler, refuse) for sampler in samplers]
        return Problem(edges, starts, goals, budget, random, more)

    def _refused(self, error: RefusedError) -> PlannerStatus:
        status = self._failed(str(error))
        status.jointValues = error.values
        if error.findings is not None:
            status.report = self._env.GetCollisionChecker().report(error.findings)
        status.tally = error.tally
        return status

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Find a path and post-process it."""
        self._action = 0
        search = self._found(values)
        if isinstance(search, PlannerStatus):
            return search
        status = self._completed(values, traj, search)
        return self._certified(values, traj, status) if status and values.certify else status

    def _found(self, values: Values, *, strict_iterations: int = 0) -> Search | PlannerStatus:
        """Return a search that found a path, or the status of the failure.

        ``strict_iterations`` is the maximum number of iterations of a search that certifies each edge; 0 means without
        certificates.
        """
        with values.conditions.kept():
            problem = self._stated(values, enough=FIRST_ROOTS)
            if isinstance(problem, PlannerStatus):
                return problem
            if strict_iterations:
                problem.edges.is_strict = True
                problem.budget.iterations = min(problem.budget.iterations, strict_iterations)
            problem.edges.allowed = blocked = Blocked(problem.edges.allowed)
            spacing = 0.0 if values.postprocessing[0] else _SPACING * values.numbers["_fsteplength"]
            search = find_path(problem, lambda problem: self._search(problem, values), spacing)
            stopped = "" if search.path is not None else blocked.most_frequent(values.conditions)
        self._search_made = search
        return search if search.path is not None else self._told(values, self._ended(search, stopped))

    def _told(self, values: Values, status: PlannerStatus) -> PlannerStatus:
        status.tally = None if values.goal_sampler is None else values.goal_sampler.source.tally
        return status

    def _completed(self, values: Values, traj: Trajectory, search: Search) -> PlannerStatus:
        """Write a found path into a trajectory, and post-process it."""
        assert search.path is not None, "it was found"
        traj.set_waypoints(Waypoints(values.groups, search.path))
        status = self._processed(values, traj, search)
        status.start_index = values.index_of(0, search.path[0])
        status.goal_index = values.index_of(1, search.path[-1])
        return self._told(values, status)

    def _certified(self, values: Values, traj: Trajectory, status: PlannerStatus) -> PlannerStatus:
        """Certify a motion, or replace it by one that can be certified; fail only if a certificate is required."""
        search = self._search_made
        if traj.is_certified():
            return status
        for alternative, others in self._alternatives(values, search) if traj.certificate is None else ():
            other = Trajectory(self._env, "")
            done = self._completed(others, other, alternative)
            if done and other.is_certified():
                traj.take(other)
                self._search_made = alternative
                return done
        self._search_made = search
        certificate = traj.certificate or traj.certify()
        return self._failed(str(certificate)) if values.certify == "required" else status

    def _alternatives(self, values: Values, search: Search | None) -> Iterator[tuple[Search, Values]]:
        """Yield other paths with post-processing parameters that admit only certified shortcuts.

        In the last path, the edges are certified, too.
        """
        assert search is not None, "it has found the motion"
        proving = replace(values, conditions=replace(values.conditions, proves=True))
        if values.postprocessing != CHAIN:
            yield search, proving
        most = max(_STRICT_ITERATIONS, _STRICT_EFFORT * search.iterations)
        search_ = self._found(proving, strict_iterations=most)
        if isinstance(search_, Search):
            yield search_, proving

    @abstractmethod
    def _search(self, problem: Problem, values: Values) -> Search: ...

    def _ended(self, search: Search, stopped: str) -> PlannerStatus:
        sizes = " and ".join(str(tree.count) for tree in search.trees)
        grown = f", with trees of {sizes} configurations" if len(search.trees) > 1 else ""
        grown = f", with {sizes} configurations" if len(search.trees) == 1 else grown
        blocked = f"; most lines were stopped by {stopped}" if stopped else ""
        hint = "; raise maxiter (_nmaxiterations) or steplength" if search.end is End.iterations else ""
        status = self._failed(f"{search.end.value} after {search.iterations} iterations{grown}{blocked}{hint}")
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
        """Return the indices of the start and the goal of the last path; -1 without a path."""
        return (-1, -1) if self._search_made is None else (self._search_made.start, self._search_made.goal)

    _commands: ClassVar[Mapping[str, Callable[[Any, str], str]]] = {
        "GetGoalIndex": lambda self, _: str(self._ends()[1]),
        "GetInitGoalIndices": lambda self, _: "{} {}".format(*self._ends()),
        "GetInitIndex": lambda self, _: str(self._ends()[0]),
    }


class BiRrt(PathPlanner):
    """``birrt``: bidirectional RRT-Connect; trees from all starts and all goals grow towards each other."""

    _defaults: ClassVar[Mapping[str, str]] = {"minimumgoalpaths": "1"}
    _samples_roots: ClassVar[bool] = True

    def _search(self, problem: Problem, values: Values) -> Search:
        del values
        given = problem.edges, problem.starts, problem.goals, problem.budget, problem.random
        return connect(*given, problem.more)


class BasicRrt(PathPlanner):
    """``BasicRRT``: one tree grows from the starts, with the probability ``goalbias`` towards a goal."""

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
        """Return the tree's configurations unchanged, since they are not a path to smooth."""
        return self._solved(f"{traj.GetNumWaypoints()} configurations")


def _with_first_roots(
    name: str, given: Floats, sampler: Sampler | None, draw: Callable[[RootSource], list[Floats]]
) -> list[Floats]:
    """Return the given starts or goals, and those that a sampler draws before the search.

    Raises:
        RefusedError: there is no ``name`` (start or goal), since no pose sampled from the regions can be reached.
    """
    roots = [*given, *([] if sampler is None else draw(sampler.source))]
    tally = None if sampler is None else sampler.source.tally
    if tally is not None and not roots:
        raise tally.error(f"no {name}")
    return roots


def _further(sampler: Sampler | None, refuse: Refuse) -> MoreRoots | None:
    """Return a source that samples starts or goals during the search, without refused ones; None without sampler."""
    return None if sampler is None else MoreRoots(lambda: sampler.source.next(refuse), sampler.probability)


_LOG = logging.getLogger("ravemj")

PREFIX = "ompl_"
"""Prefix of the names of OMPL's planners, in lower case."""


def is_ompl_planner(name: str) -> bool:
    """Return whether OMPL has a planner of this name. If OMPL is not installed, log how to install it."""
    classes = planner_classes()
    if classes is None:
        _LOG.warning("planner '%s' needs OMPL; install it: pip install \"ravemj[planning]\"", name)
        return False
    return name.lower().removeprefix(PREFIX) in classes


class OmplPlanner(PathPlanner):
    """A path planner of OMPL.

    Extra parameters of the planner are XML elements, such as ``<range>0.5</range>`` or ``<goal_bias>0.1</goal_bias>``.
    ``<time_limit>`` is the time limit [s], as with or_ompl. Optimizing planners use all of their time or iterations.
    """

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Find a path and post-process it."""
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

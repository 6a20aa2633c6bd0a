"""Planners that find a path without collisions."""

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.planning.constrained_edges import ConstrainedEdges, bent_path
from ravemj.planning.edges import Edges
from ravemj.planning.randomized_astar import search_by_cost
from ravemj.planning.rrt import Budget, End, MoreGoals, Search, connect, explore, single
from ravemj.planning.shortcuts import shorten
from ravemj.rave.enums import ConstraintFilterOptions, PlannerAction, PlannerStatusCode
from ravemj.rave.planning.bodies import USER
from ravemj.rave.planning.planner import Planner
from ravemj.rave.planning.processing import post_process
from ravemj.rave.planning.status import PlannerStatus
from ravemj.rave.planning.values import Values
from ravemj.rave.report import CollisionReport
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory

_ITERATIONS = 10000
"""OpenRAVE's default for the maximum number of iterations."""

_SHORTCUTS = 100
"""The maximum number of projection steps onto a constraint, as in OpenRAVE."""

_SPACING = 10
"""The largest distance of the waypoints of a path that no planner processes, in step lengths."""


class Query(NamedTuple):
    """What a search takes: the test of lines, the starts and goals without collisions, its limits, and the problem."""

    edges: Edges
    starts: Sequence[Floats]
    goals: Sequence[Floats]
    budget: Budget
    random: np.random.Generator
    values: Values


class PathPlanner(Planner):
    """A planner that finds a path without collisions from one of several starts to one of several goals."""

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
        try:
            values.check()
            starts, goals = self._starts_and_goals(values)
        except ArgumentError as error:
            return self._failed(error.message)
        assert values.bodies is not None, "something moves"
        endless = np.flatnonzero(~np.isfinite(values.space().lower) | ~np.isfinite(values.space().upper))
        if len(endless):
            return self._failed(f"{_described(values, int(endless[0]))} has no limits, and should have some")
        with values.bodies.kept():
            for name, candidates in (("start", starts), ("goal", goals)):
                if not len(candidates) and (name == "start" or self._needs_goal(values)):
                    return self._failed(f"there is no {name}")
                wrong = [self._wrong(values, name, one) for one in candidates]
                if wrong and None not in wrong:
                    return wrong[0]
        return None

    def _starts_and_goals(self, values: Values) -> tuple[Floats, Floats]:
        return values.configurations("_vinitialconfig"), values.configurations("_vgoalconfig")

    def _needs_goal(self, values: Values) -> bool:
        return values.goal_sampler is None

    def _wrong(self, values: Values, name: str, configuration: Floats) -> PlannerStatus | None:
        """Return why a start or a goal cannot be used, or None if it can. The bodies are moved."""
        space, report = values.space(), CollisionReport()
        if not np.isfinite(configuration).all():
            status = self._failed(f"{name}: {configuration.tolist()} should be finite numbers")
        elif (outside := space.outside(configuration)) is not None:
            limits = f"[{space.lower[outside]:g}, {space.upper[outside]:g}]"
            described = f"{_described(values, outside)} is {configuration[outside]:.6g}, outside its limits {limits}"
            status = self._failed(f"{name}: {described}")
        else:
            found = values.problem(configuration, int(ConstraintFilterOptions.RecommendedOptions))
            if not found:
                return None
            if found == USER:
                status = self._failed(f"{name}: {_off(values, configuration)}")
            else:
                values.problem(configuration, int(ConstraintFilterOptions.RecommendedOptions), report)
                status = self._failed(f"{name}: it collides: {_links(report)}")
                status.report = report
        status.jointValues = configuration
        return status

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Find a path, and process it."""
        problem = self._prepare(values)
        if problem is not None:
            return problem
        assert values.bodies is not None
        self._action = 0
        with values.bodies.kept():
            starts, goals = (
                [one for one in candidates if self._wrong(values, "", one) is None]
                for candidates in self._starts_and_goals(values)
            )
            edges, numbers = values.edges(np.array([*starts, *goals])), values.numbers
            iterations = int(numbers["_nmaxiterations"]) or _ITERATIONS
            budget = Budget(iterations, numbers["_nmaxplanningtime"] / 1000, self._proceed)
            random = values.random()
            search = self._search(Query(edges, starts, goals, budget, random, values))
            if isinstance(edges, ConstrainedEdges) and search.path is not None:
                search = _bent(edges, search, search.path, random)
        self._search_made = search
        if search.path is None:
            return self._ended(search)
        spaced = search.path if values.postprocessing[0] else _spaced(edges, search.path, numbers["_fsteplength"])
        spec = ConfigurationSpecification.of(values.groups)
        traj.Init(spec)
        traj.Insert(0, spaced.ravel())
        return self._processed(values, traj, search)

    @abstractmethod
    def _search(self, query: Query) -> Search: ...

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

    def _search(self, query: Query) -> Search:
        more, values = None, query.values
        if values.goal_sampler is not None:
            sample, probability = values.goal_sampler

            def next_goal() -> Floats | None:
                goal = sample()
                allowed = goal is not None and self._wrong(values, "goal", goal) is None
                return goal if allowed else None

            more = MoreGoals(next_goal, probability)
        return connect(query.edges, query.starts, query.goals, query.budget, query.random, more)


class BasicRrt(PathPlanner):
    """``BasicRRT``: one tree grows from the starts; with the probability ``goalbias`` it grows towards a goal."""

    _defaults: ClassVar[Mapping[str, str]] = {"goalbias": "0.05", "nrrtextenttype": "0", "nminiterations": "0"}

    def _needs_goal(self, values: Values) -> bool:
        return True

    def _search(self, query: Query) -> Search:
        bias = query.values.tag("goalbias", 0.05)
        return single(query.edges, query.starts, query.goals, query.budget, query.random, bias)


class RaStar(PathPlanner):
    """``RA*``: a randomized A* that expands random neighbours, the most promising configuration first."""

    def _needs_goal(self, values: Values) -> bool:
        return True

    def _search(self, query: Query) -> Search:
        return search_by_cost(query.edges, query.starts, query.goals, query.budget, query.random)


class ExplorationRrt(PathPlanner):
    """``ExplorationRRT``: one tree explores the free space around the starts; its configurations are the result."""

    _defaults: ClassVar[Mapping[str, str]] = {"exploreprob": "0", "expectedsize": "100"}

    def _needs_goal(self, values: Values) -> bool:
        return False

    def _search(self, query: Query) -> Search:
        size = int(query.values.tag("expectedsize", 100))
        tree = explore(query.edges, query.starts, size, query.budget, query.random)
        return Search(End.found, tree.nodes(), 0, -1, tree.count, (tree,))

    def _processed(self, values: Values, traj: Trajectory, search: Search) -> PlannerStatus:
        """Leave the configurations alone: they are the nodes of a tree, not a path to be smoothed."""
        return self._solved(f"{traj.GetNumWaypoints()} configurations")


def _bent(edges: ConstrainedEdges, search: Search, path: Floats, random: np.random.Generator) -> Search:
    """Return a search with the configurations along its path, after shortcuts: smoothers would leave the constraint."""
    bent = bent_path(edges, shorten(edges, path, _SHORTCUTS, random))
    return replace(search, path=bent, end=End.stuck if bent is None else search.end)


def _spaced(edges: Edges, path: Floats, step_length: float) -> Floats:
    """Return a path with additional waypoints on its lines, at most ``_SPACING`` step lengths apart."""
    space = edges.space
    rows = [path[:1]]
    for start, end in pairwise(path):
        far = space.distance(end, start)
        count = max(1, int(np.ceil(far / (_SPACING * step_length)))) if step_length > 0 else 1
        parts = np.arange(1, count)[:, None] / count
        rows += [start + parts * space.difference(end, start), end[None]]
    return np.concatenate(rows)


def _off(values: Values, configuration: Floats) -> str:
    """Return which constraint a configuration does not keep."""
    manifold = values.manifold
    if manifold is None or manifold.has(configuration):
        return "a constraint does not allow it"
    most = manifold.threshold
    return f"the tool is {manifold.off(configuration):.3g} off its constraint, and should be {most:g} at most"


def _links(report: CollisionReport) -> str:
    """Return the names of the colliding links, for error messages."""
    links = [link for link in (report.plink1, report.plink2) if link is not None]
    return " with ".join(f"link '{link.GetName()}' of '{link.GetParent().GetName()}'" for link in links)


def _described(values: Values, index: int) -> str:
    """Return the name of one value of a configuration, for error messages."""
    group = next(group for group in values.groups if group.offset <= index < group.offset + group.dof)
    assert values.bodies is not None
    return values.bodies.described(group, index - group.offset)

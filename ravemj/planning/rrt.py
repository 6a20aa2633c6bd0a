"""Planners that grow trees of configurations (RRT), and the problem that they solve."""

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import LINE, Edges
from ravemj.planning.space import Space

_FIRST_CAPACITY = 256


class Tree:
    """Configurations, ``count`` of them, each but the roots with a parent that a line leads to."""

    def __init__(self, space: Space, roots: Iterable[Floats] = ()) -> None:
        self._space = space
        self.count = 0
        self._nodes: Floats = np.empty((_FIRST_CAPACITY, len(space.lower)))
        self._parents: list[int] = []
        self._weights = space.weights
        for root in roots:
            self.add(root)

    def add(self, configuration: Floats, parent: int = -1) -> int:
        """Add a configuration; return its number. -1 as parent makes it a root."""
        if self.count == len(self._nodes):
            self._nodes = np.concatenate([self._nodes, np.empty(self._nodes.shape)])
        self._nodes[self.count] = configuration
        self._parents.append(parent)
        self.count += 1
        return self.count - 1

    def add_line(self, configurations: Floats, parent: int) -> int:
        """Add configurations, each a child of the one before, shape (m, n); return the number of the last one."""
        for configuration in configurations:
            parent = self.add(configuration, parent)
        return parent

    def node(self, number: int) -> Floats:
        """Return a configuration."""
        return self._nodes[number]

    def nearest(self, configuration: Floats) -> int:
        """Return the number of the configuration nearest to one, by weighted distance."""
        apart = self._space.difference(self._nodes[: self.count], configuration)
        apart = apart * self._weights
        return int(np.einsum("ij,ij->i", apart, apart).argmin())

    def branch(self, number: int) -> list[Floats]:
        """Return the configurations from one up to its root."""
        found: list[Floats] = []
        while number >= 0:
            found.append(self._nodes[number].copy())
            number = self._parents[number]
        return found

    def root(self, number: int) -> int:
        """Return the number of the root that a configuration hangs on."""
        while self._parents[number] >= 0:
            number = self._parents[number]
        return number

    def nodes(self) -> Floats:
        """Return all configurations, shape (count, n); a copy."""
        return self._nodes[: self.count].copy()

    def lines(self) -> list[tuple[int, int]]:
        """Return the numbers of each configuration that is no root, and of its parent."""
        return [(number, parent) for number, parent in enumerate(self._parents) if parent >= 0]


_PATIENCE = 20
"""After so many blocked lines of the smaller tree, the other one has a turn: perhaps it finds the way in."""

_WHOLE_LINES = 50
"""Number of blocked lines that are dropped. After them, trees keep the steps before what blocks a line.

Most problems are open: trees of long whole lines meet sooner, since a blocked line takes few tests. Narrow problems
need steps.
"""

_WHOLE_LENGTH = 0.15
"""Largest length of a whole line, relative to the diagonal of the space."""

_LONGEST = 4.0
"""Largest length of a whole line, a weighted distance: OpenRAVE's 100 steps of 0.04."""

_TURN = 1e-6
"""Largest difference of the directions [1] of two steps of one straight line."""

_SAME = 1e-9
"""Largest distance [rad or m] of two equal nodes of a path."""

_MOST_LINES = 16
"""Of straight lines from starts to goals that are tried before any tree is grown."""


class End(Enum):
    """Why a search ended."""

    found = "a path was found"
    iterations = "the iterations were used up"
    time = "the time was used up"
    interrupted = "a callback interrupted"
    no_goal = "there is no goal"
    stuck = "no step came nearer"


@dataclass
class Budget:
    """Termination limits of a search.

    Attributes:
        iterations: Maximum number of iterations.
        seconds: Time limit [s]; 0 means none.
        proceed: Callback before each iteration, with its number; returning False stops the search.
        started: Time at which the search began [s], of ``time.monotonic``.
    """

    iterations: int
    seconds: float = 0.0
    proceed: Callable[[int], bool] = lambda iteration: True
    started: float = field(default_factory=time.monotonic)

    def end(self, iteration: int) -> End | None:
        """Return why to stop before an iteration, or None."""
        if iteration >= self.iterations:
            return End.iterations
        if self.seconds > 0 and time.monotonic() - self.started > self.seconds:
            return End.time
        return None if self.proceed(iteration) else End.interrupted


@dataclass(frozen=True, slots=True)
class Search:
    """Result of a search.

    Attributes:
        end: Reason for its end.
        path: Waypoints of a path of straight lines, shape (m, n); None if no path was found.
        start: Index of the start of the path.
        goal: Index of the goal of the path.
        iterations: Number of iterations.
        trees: The trees, whose neighbouring nodes are a step apart at most.
    """

    end: End
    path: Floats | None
    start: int
    goal: int
    iterations: int
    trees: Sequence[Tree]


class MoreGoals(NamedTuple):
    """Source of further goals during a search.

    Attributes:
        sample: Function that returns a goal, or None if it has none at this time.
        probability: Probability of sampling a goal in an iteration.
    """

    sample: Callable[[], Floats | None]
    probability: float


@dataclass
class Problem:
    """A path planning problem.

    Attributes:
        edges: The test of configurations and of lines, in a space.
        starts: The possible starts, each of shape (n,), all allowed.
        goals: The possible goals, each of shape (n,), all allowed.
        budget: The limits of the search.
        random: The random numbers.
        more: A source of further goals; None for none.
    """

    edges: Edges
    starts: Sequence[Floats]
    goals: Sequence[Floats]
    budget: Budget
    random: np.random.Generator
    more: MoreGoals | None = None


def connect(
    edges: Edges,
    starts: Sequence[Floats],
    goals: Sequence[Floats],
    budget: Budget,
    random: np.random.Generator,
    more_goals: MoreGoals | None = None,
) -> Search:
    """Grow trees from starts and goals, which are allowed, towards each other.

    At first, lines that are blocked are dropped; later, the trees keep the steps before what blocks a line.
    """
    growth = _Growth(edges, starts, goals)
    stopped = budget.end(0)
    if stopped is None and (found := growth.straight(starts, goals)) is not None:
        return found
    iteration = 0
    while stopped is None:
        if more_goals is not None and (not growth.trees[1].count or random.random() < more_goals.probability):
            growth.add_goal(more_goals.sample())
        if growth.trees[1].count and (found := growth.grow(edges.space.sample(random), iteration + 1)) is not None:
            return found
        iteration += 1
        stopped = budget.end(iteration)
    if not growth.trees[1].count and stopped is End.iterations:
        stopped = End.no_goal
    return Search(stopped, None, -1, -1, iteration, growth.trees)


class _Growth:
    """Trees from starts and goals."""

    def __init__(self, edges: Edges, starts: Sequence[Floats], goals: Sequence[Floats]) -> None:
        self._edges = edges
        self.trees = Tree(edges.space, starts), Tree(edges.space, goals)
        self._goals = list(range(len(goals)))
        self._grown = self._blocked = self._lines_blocked = 0
        diagonal = float(np.linalg.norm(edges.space.weights * (edges.space.upper - edges.space.lower)))
        self._longest = min(max(LINE, _WHOLE_LENGTH * diagonal), _LONGEST)

    def add_goal(self, goal: Floats | None) -> None:
        """Add a further goal, if it is one."""
        if goal is not None:
            self._goals.append(self.trees[1].add(goal))

    def straight(self, starts: Sequence[Floats], goals: Sequence[Floats]) -> Search | None:
        """Return the path of one line, nearest ends first, or None."""
        space = self._edges.space
        pairs = [(space.distance(goal, start), s, g) for s, start in enumerate(starts) for g, goal in enumerate(goals)]
        for _, start, goal in sorted(pairs)[:_MOST_LINES]:
            if self._edges.line(starts[start], space.difference(goals[goal], starts[start])):
                return self._found(start, goal, 0)
        return None

    def grow(self, target: Floats, iteration: int) -> Search | None:
        """Grow the smaller tree towards a configuration, and the other to where it got; return the path, or None."""
        near, far = self.trees[self._grown], self.trees[1 - self._grown]
        whole = self._lines_blocked < _WHOLE_LINES
        longest = self._longest if whole else LINE
        added, is_blocked = _extend(self._edges, near, target, longest=longest, whole=whole)
        self._lines_blocked += is_blocked
        met = None if added is None else _reach(self._edges, far, near.node(added), whole=whole)
        if added is not None and met is not None:
            ends = (added, met) if self._grown == 0 else (met, added)
            return self._found(*ends, iteration)
        self._blocked = self._blocked + 1 if added is None else 0
        if near.count > far.count or self._blocked >= _PATIENCE:
            self._grown, self._blocked = 1 - self._grown, 0
        return None

    def _found(self, at_start: int, at_goal: int, iteration: int) -> Search:
        first, second = self.trees
        path = _path(self._edges, first.branch(at_start)[::-1] + second.branch(at_goal))
        start, goal = first.root(at_start), self._goals.index(second.root(at_goal))
        return Search(End.found, path, start, goal, iteration, self.trees)


def single(
    edges: Edges,
    starts: Sequence[Floats],
    goals: Sequence[Floats],
    budget: Budget,
    random: np.random.Generator,
    goal_bias: float,
) -> Search:
    """Grow one tree from the starts, now and then towards a goal: the basic RRT.

    Starts and goals are allowed. ``goal_bias`` is the part of the iterations in which the tree grows towards a goal.
    """
    tree = Tree(edges.space, starts)
    iteration = 0
    while (stopped := budget.end(iteration)) is None:
        to_goal = iteration == 0 or random.random() < goal_bias
        goal = int(random.integers(len(goals)))
        if to_goal:
            reached = _reach(edges, tree, goals[goal])
            if reached is not None:
                path = _path(edges, [*tree.branch(reached)[::-1], goals[goal]])
                return Search(End.found, path, tree.root(reached), goal, iteration + 1, (tree,))
        else:
            _extend(edges, tree, edges.space.sample(random))
        iteration += 1
    return Search(stopped, None, -1, -1, iteration, (tree,))


def explore(edges: Edges, starts: Sequence[Floats], size: int, budget: Budget, random: np.random.Generator) -> Tree:
    """Grow one tree from the starts until it has a size, one step in an iteration, without any goal."""
    tree = Tree(edges.space, starts)
    iteration = 0
    while tree.count < size and budget.end(iteration) is None:
        _extend(edges, tree, edges.space.sample(random), longest=edges.step)
        iteration += 1
    return tree


def _extend(
    edges: Edges, tree: Tree, target: Floats, *, longest: float = LINE, whole: bool = False
) -> tuple[int | None, bool]:
    """Grow a tree towards a configuration by one line.

    Returns:
        The last new node, or None if the first step is blocked; and whether the line is blocked.
    """
    nearest = tree.nearest(target)
    grown = edges.grow(tree.node(nearest), target, longest=longest, whole=whole)
    added = tree.add_line(grown.points, nearest) if len(grown.points) else None
    return added, grown.is_blocked


def _reach(edges: Edges, tree: Tree, target: Floats, *, whole: bool = False) -> int | None:
    """Grow a tree to a configuration, line by line; return the node there, or None if one is blocked on the way."""
    nearest = tree.nearest(target)
    while True:
        grown = edges.grow(tree.node(nearest), target, whole=whole)
        nearest = tree.add_line(grown.points, nearest)
        if grown.arrives or grown.is_blocked:
            return nearest if grown.arrives else None


def _path(edges: Edges, nodes: Sequence[Floats]) -> Floats:
    """Return a path through nodes of trees without those that are repeated, or on a straight line between others.

    A line has to be allowed without the nodes on it, too: it is tested at other configurations then.
    """
    space, path = edges.space, np.array(nodes)
    lengths = np.linalg.norm(space.difference(path[1:], path[:-1]), axis=1)
    path = np.concatenate([path[:1], path[1:][lengths > _SAME]])
    path[-1] = nodes[-1]
    if len(path) < 3:
        return path
    steps = space.difference(path[1:], path[:-1])
    directions = steps / np.linalg.norm(steps, axis=1, keepdims=True)
    turns = np.linalg.norm(np.diff(directions, axis=0), axis=1) > _TURN
    kept = [0]
    for first, last in pairwise([0, *(np.flatnonzero(turns) + 1).tolist(), len(steps)]):
        way = steps[first:last].sum(axis=0)
        is_short = np.allclose(space.difference(path[last], path[first]), way)  # else it would go the other way round
        is_line = is_short and last > first + 1 and edges.line(path[first], way)
        kept += [last] if is_line else range(first + 1, last + 1)
    return path[kept]


def without_repetitions(path: Floats) -> Floats:
    """Return a path without configurations that are the same as the one before."""
    kept = np.append(True, (np.diff(path, axis=0) != 0).any(axis=1))
    return path[kept]

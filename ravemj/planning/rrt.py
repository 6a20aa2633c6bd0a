"""RRT planners, and the planning problem that they solve."""

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


class SearchTree:
    """Tree of ``count`` configurations; each node except the roots is connected to its parent by an edge."""

    def __init__(self, space: Space, roots: Iterable[Floats] = ()) -> None:
        self._space = space
        self.count = 0
        self._nodes: Floats = np.empty((_FIRST_CAPACITY, len(space.lower)))
        self._parents: list[int] = []
        self._weights = space.weights
        for root in roots:
            self.add(root)

    def add(self, configuration: Floats, parent: int = -1) -> int:
        """Add a node and return its index; the parent -1 makes it a root."""
        if self.count == len(self._nodes):
            self._nodes = np.concatenate([self._nodes, np.empty(self._nodes.shape)])
        self._nodes[self.count] = configuration
        self._parents.append(parent)
        self.count += 1
        return self.count - 1

    def add_line(self, configurations: Floats, parent: int) -> int:
        """Add a chain of nodes, shape (m, n), to a parent; return the index of the last one."""
        for configuration in configurations:
            parent = self.add(configuration, parent)
        return parent

    def node(self, number: int) -> Floats:
        """Return the configuration of a node."""
        return self._nodes[number]

    def nearest(self, configuration: Floats) -> int:
        """Return the index of the nearest node, by weighted distance."""
        apart = self._space.difference(self._nodes[: self.count], configuration)
        apart = apart * self._weights
        return int(np.einsum("ij,ij->i", apart, apart).argmin())

    def branch(self, number: int) -> list[Floats]:
        """Return the configurations from a node to its root."""
        configurations: list[Floats] = []
        while number >= 0:
            configurations.append(self._nodes[number].copy())
            number = self._parents[number]
        return configurations

    def root(self, number: int) -> int:
        """Return the index of the root of a node."""
        while self._parents[number] >= 0:
            number = self._parents[number]
        return number

    def nodes(self) -> Floats:
        """Return a copy of all configurations, shape (count, n)."""
        return self._nodes[: self.count].copy()

    def lines(self) -> list[tuple[int, int]]:
        """Return the edges: the index of each node that is not a root, and of its parent."""
        return [(number, parent) for number, parent in enumerate(self._parents) if parent >= 0]


_PATIENCE = 20
"""Number of consecutive failures to grow the smaller tree after which the other tree grows."""

_WHOLE_LINES = 50
"""Number of blocked edges after which trees keep the part of an edge before an obstacle, instead of discarding it.

In open space, discarding is faster: a blocked edge takes few tests, and long edges connect the trees sooner. In
narrow passages, only parts of edges are free.
"""

_WHOLE_LENGTH = 0.15
"""Maximum length of an edge added as a whole, relative to the diagonal of the space."""

_LONGEST = 4.0
"""Maximum length of an edge added as a whole, a weighted distance: OpenRAVE's 100 steps of 0.04."""

_TURN = 1e-6
"""Maximum difference of the unit directions of two collinear edges."""

_SAME = 1e-9
"""Tolerance of equal nodes of a path [rad or m]."""

_MOST_LINES = 16
"""Maximum number of direct edges from starts to goals that are tested before any tree grows."""


class End(Enum):
    """Reason for the end of a search."""

    found = "a path was found"
    iterations = "the iterations were used up"
    time = "the time was used up"
    interrupted = "a callback interrupted"
    no_start = "there is no start"
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
        """Return the reason to stop before an iteration, or None."""
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
        start: Index, among the starts, of the first waypoint.
        goal: Index, among the goals, of the last waypoint.
        iterations: Number of iterations.
        trees: The trees; adjacent nodes are at most one step apart.
    """

    end: End
    path: Floats | None
    start: int
    goal: int
    iterations: int
    trees: Sequence[SearchTree]


class MoreRoots(NamedTuple):
    """Source of further starts or goals during a search.

    Attributes:
        sample: Function that returns a start or goal, or None if it has none at this time.
        probability: Probability of sampling one in an iteration.
    """

    sample: Callable[[], Floats | None]
    probability: float


@dataclass
class Problem:
    """A path planning problem.

    Attributes:
        edges: The tests of configurations and edges, with their space.
        starts: The possible starts, each of shape (n,), all allowed.
        goals: The possible goals, each of shape (n,), all allowed.
        budget: The limits of the search.
        random: The random numbers.
        more: The sources of further starts and of further goals; None if there is none.
    """

    edges: Edges
    starts: Sequence[Floats]
    goals: Sequence[Floats]
    budget: Budget
    random: np.random.Generator
    more: Sequence[MoreRoots | None] = (None, None)


def connect(
    edges: Edges,
    starts: Sequence[Floats],
    goals: Sequence[Floats],
    budget: Budget,
    random: np.random.Generator,
    more: Sequence[MoreRoots | None] = (None, None),
) -> Search:
    """RRT-Connect: grow trees from allowed starts and goals towards each other; ``more`` are sources of further ones.

    At first, blocked edges are discarded; later, the trees keep the steps before an obstacle.
    """
    growth = _TreeGrowth(edges, starts, goals)
    stopped = budget.end(0)
    if stopped is None and (path := growth.straight(starts, goals)) is not None:
        return path
    iteration = 0
    while stopped is None:
        for side, source in enumerate(more):
            if source is not None and (not growth.trees[side].count or random.random() < source.probability):
                growth.add_root(side, source.sample())
        has_both = all(tree.count for tree in growth.trees)
        if has_both and (path := growth.grow(edges.space.sample(random), iteration + 1)) is not None:
            return path
        iteration += 1
        stopped = budget.end(iteration)
    if stopped is End.iterations and not all(tree.count for tree in growth.trees):
        stopped = End.no_goal if growth.trees[0].count else End.no_start
    return Search(stopped, None, -1, -1, iteration, growth.trees)


class _TreeGrowth:
    """Bidirectional search: trees that grow from the starts and from the goals."""

    def __init__(self, edges: Edges, starts: Sequence[Floats], goals: Sequence[Floats]) -> None:
        self._edges = edges
        self.trees = SearchTree(edges.space, starts), SearchTree(edges.space, goals)
        self._roots = list(range(len(starts))), list(range(len(goals)))
        self._grown = self._blocked = self._lines_blocked = 0
        diagonal = float(np.linalg.norm(edges.space.weights * (edges.space.upper - edges.space.lower)))
        self._longest = min(max(LINE, _WHOLE_LENGTH * diagonal), _LONGEST)

    def add_root(self, side: int, root: Floats | None) -> None:
        """Add a further start (side 0) or goal (1), unless it is None."""
        if root is not None:
            self._roots[side].append(self.trees[side].add(root))

    def straight(self, starts: Sequence[Floats], goals: Sequence[Floats]) -> Search | None:
        """Return a path of one edge from a start to a goal, nearest pairs first; None if all edges are blocked."""
        space = self._edges.space
        pairs = [(space.distance(goal, start), s, g) for s, start in enumerate(starts) for g, goal in enumerate(goals)]
        for _, start, goal in sorted(pairs)[:_MOST_LINES]:
            if self._edges.line(starts[start], space.difference(goals[goal], starts[start])):
                return self._found(start, goal, 0)
        return None

    def grow(self, target: Floats, iteration: int) -> Search | None:
        """Grow the smaller tree towards a configuration, and the other to the new node; return a path if they meet."""
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
        start = self._roots[0].index(first.root(at_start))
        goal = self._roots[1].index(second.root(at_goal))
        return Search(End.found, path, start, goal, iteration, self.trees)


def single(
    edges: Edges,
    starts: Sequence[Floats],
    goals: Sequence[Floats],
    budget: Budget,
    random: np.random.Generator,
    goal_bias: float,
) -> Search:
    """Basic RRT: grow one tree from the starts, sometimes towards a goal.

    Starts and goals must be allowed. ``goal_bias`` is the probability of growing towards a goal in an iteration.
    """
    tree = SearchTree(edges.space, starts)
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


def explore(
    edges: Edges, starts: Sequence[Floats], size: int, budget: Budget, random: np.random.Generator
) -> SearchTree:
    """Grow one tree from the starts to a given size, one step per iteration, without a goal."""
    tree = SearchTree(edges.space, starts)
    iteration = 0
    while tree.count < size and budget.end(iteration) is None:
        _extend(edges, tree, edges.space.sample(random), longest=edges.step)
        iteration += 1
    return tree


def _extend(
    edges: Edges, tree: SearchTree, target: Floats, *, longest: float = LINE, whole: bool = False
) -> tuple[int | None, bool]:
    """Grow a tree by an edge from its nearest node towards a configuration.

    Returns:
        The last new node, or None if the first step is blocked; and whether the edge is blocked.
    """
    nearest = tree.nearest(target)
    grown = edges.grow(tree.node(nearest), target, longest=longest, whole=whole)
    added = tree.add_line(grown.points, nearest) if len(grown.points) else None
    return added, grown.is_blocked


def _reach(edges: Edges, tree: SearchTree, target: Floats, *, whole: bool = False) -> int | None:
    """Grow a tree edge by edge until it contains ``target``; return that node, or None if an edge is blocked."""
    nearest = tree.nearest(target)
    while True:
        grown = edges.grow(tree.node(nearest), target, whole=whole)
        nearest = tree.add_line(grown.points, nearest)
        if grown.arrives or grown.is_blocked:
            return nearest if grown.arrives else None


def _path(edges: Edges, nodes: Sequence[Floats]) -> Floats:
    """Return a path through tree nodes without repeated or collinear ones.

    A collinear node is removed only if the edge without it is allowed, since tests of that edge use other
    configurations than tests of its two parts.
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
        is_short = np.allclose(space.difference(path[last], path[first]), way)  # otherwise it would take the longer arc
        is_line = is_short and last > first + 1 and edges.line(path[first], way)
        kept += [last] if is_line else range(first + 1, last + 1)
    return path[kept]


def without_repetitions(path: Floats) -> Floats:
    """Return a path without repeated consecutive configurations."""
    kept = np.append(True, (np.diff(path, axis=0) != 0).any(axis=1))
    return path[kept]

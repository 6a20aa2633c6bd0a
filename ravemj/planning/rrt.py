"""Rapidly-exploring random trees.

``connect`` is RRT-Connect (J. Kuffner and S. LaValle, ICRA 2000) with balanced trees: the one that is grown is mostly
the smaller one, so that a tree in a narrow place is not fed in vain.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges
from ravemj.planning.trees import Tree

_PATIENCE = 20
"""After so many blocked lines of the smaller tree, the other one has a turn: perhaps it finds the way in."""

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
    """How long a search goes on.

    Attributes:
        iterations: How often at most a tree is grown.
        seconds: How long at most; 0: any time.
        proceed: Asked before each iteration, with its number, whether to go on.
        started: When it began.
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
    """How a search went.

    Attributes:
        end: Why it ended.
        path: The configurations that straight lines connect, shape (m, n); None: there is none.
        start: Which start it is from.
        goal: Which goal it leads to.
        iterations: How often a tree was grown.
        trees: The trees, for pictures.
    """

    end: End
    path: Floats | None
    start: int
    goal: int
    iterations: int
    trees: Sequence[Tree]


class MoreGoals(NamedTuple):
    """Goals that come while a search is under way.

    Attributes:
        sample: Returns one, or None if there is none now.
        probability: Part of the iterations in which it is asked.
    """

    sample: Callable[[], Floats | None]
    probability: float


def connect(
    edges: Edges,
    starts: Sequence[Floats],
    goals: Sequence[Floats],
    budget: Budget,
    random: np.random.Generator,
    more_goals: MoreGoals | None = None,
) -> Search:
    """Grow trees from starts and goals, which are allowed, towards each other."""
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
        self._grown = self._blocked = 0

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
        added = _extend(self._edges, near, target)
        met = None if added is None else _reach(self._edges, far, near.node(added))
        if added is not None and met is not None:
            ends = (added, met) if self._grown == 0 else (met, added)
            return self._found(*ends, iteration)
        self._blocked = self._blocked + 1 if added is None else 0
        if near.count > far.count or self._blocked >= _PATIENCE:
            self._grown, self._blocked = 1 - self._grown, 0
        return None

    def _found(self, at_start: int, at_goal: int, iteration: int) -> Search:
        first, second = self.trees
        path = np.array(first.branch(at_start)[::-1] + second.branch(at_goal))
        start, goal = first.root(at_start), self._goals.index(second.root(at_goal))
        return Search(End.found, without_repetitions(path), start, goal, iteration, self.trees)


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
                path = without_repetitions(np.array([*tree.branch(reached)[::-1], goals[goal]]))
                return Search(End.found, path, tree.root(reached), goal, iteration + 1, (tree,))
        else:
            _extend(edges, tree, edges.space.sample(random))
        iteration += 1
    return Search(stopped, None, -1, -1, iteration, (tree,))


def explore(edges: Edges, starts: Sequence[Floats], size: int, budget: Budget, random: np.random.Generator) -> Tree:
    """Grow one tree from the starts until it has a size, without any goal."""
    tree = Tree(edges.space, starts)
    iteration = 0
    while tree.count < size and budget.end(iteration) is None:
        _extend(edges, tree, edges.space.sample(random))
        iteration += 1
    return tree


def _extend(edges: Edges, tree: Tree, target: Floats) -> int | None:
    """Grow a tree towards a configuration by one line; return the new node, or None where it is blocked."""
    nearest = tree.nearest(target)
    start = tree.node(nearest)
    step, _ = edges.towards(start, target)
    return tree.add(start + step, nearest) if edges.line(start, step) else None


def _reach(edges: Edges, tree: Tree, target: Floats) -> int | None:
    """Grow a tree to a configuration; return the last node before it, or None where it is blocked on the way."""
    nearest = tree.nearest(target)
    while True:
        start = tree.node(nearest)
        step, is_last = edges.towards(start, target)
        if not edges.line(start, step):
            return None
        if is_last:
            return nearest
        nearest = tree.add(start + step, nearest)


def without_repetitions(path: Floats) -> Floats:
    """Return a path without configurations that are the same as the one before."""
    kept = np.append(True, (np.diff(path, axis=0) != 0).any(axis=1))
    return path[kept]

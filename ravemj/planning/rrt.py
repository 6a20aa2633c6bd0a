"""Rapidly-exploring random trees.

``connect`` is RRT-Connect (J. Kuffner and S. LaValle, ICRA 2000) with balanced trees: the one that is grown is always
the smaller one, so that a tree in a narrow place is not fed in vain.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges
from ravemj.planning.trees import Tree

RANGE = 1.0
"""How far [rad or m] one line of a tree goes at most."""

_MOST_LINES = 16
"""Of straight lines from starts to goals that are tried before any tree is grown."""


class End(Enum):
    """Why a search ended."""

    found = "a path was found"
    iterations = "the iterations were used up"
    time = "the time was used up"
    interrupted = "a callback interrupted"
    no_goal = "there is no goal"


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


class MoreGoals:
    """Goals that come while a search is under way; ``next`` returns one, or None if there is none now."""

    def __init__(self, sample: Callable[[], Floats | None], probability: float) -> None:
        self.sample, self.probability = sample, probability


def connect(
    edges: Edges,
    starts: Sequence[Floats],
    goals: Sequence[Floats],
    budget: Budget,
    random: np.random.Generator,
    more_goals: MoreGoals | None = None,
) -> Search:
    """Grow trees from starts and goals towards each other.

    Args:
        edges: Tests lines; starts and goals are allowed.
        starts: Where paths may start.
        goals: Where they may end.
        budget: How long to go on.
        random: Draws configurations.
        more_goals: Further goals.
    """
    space = edges.space
    trees = Tree(space), Tree(space)
    for tree, roots in zip(trees, (starts, goals), strict=True):
        for root in roots:
            tree.add(root)
    goal_roots = list(range(len(goals)))

    def found(at_start: int, at_goal: int, iteration: int) -> Search:
        path = np.array(trees[0].branch(at_start)[::-1] + trees[1].branch(at_goal))
        start, goal = trees[0].root(at_start), goal_roots.index(trees[1].root(at_goal))
        return Search(End.found, without_repetitions(path), start, goal, iteration, trees)

    stopped = budget.end(0)
    if stopped is None:
        line = _straight_line(edges, starts, goals)
        if line is not None:
            return found(*line, 0)
    iteration, grown = 0, 0
    while stopped is None:
        if more_goals is not None and (not trees[1].count or random.random() < more_goals.probability):
            new = more_goals.sample()
            if new is not None:
                goal_roots.append(trees[1].add(new))
        if trees[1].count:
            near, far = trees[grown], trees[1 - grown]
            added = _extend(edges, near, space.sample(random))
            if added is not None:
                met = _reach(edges, far, near.node(added))
                if met is not None:
                    return found(*((added, met) if grown == 0 else (met, added)), iteration + 1)
            if near.count > far.count:
                grown = 1 - grown
        iteration += 1
        stopped = budget.end(iteration)
    if not trees[1].count and stopped is End.iterations:
        stopped = End.no_goal
    return Search(stopped, None, -1, -1, iteration, trees)


def single(
    edges: Edges,
    starts: Sequence[Floats],
    goals: Sequence[Floats],
    budget: Budget,
    random: np.random.Generator,
    goal_bias: float,
) -> Search:
    """Grow one tree from the starts, now and then towards a goal: the basic RRT.

    Args:
        edges: Tests lines; starts and goals are allowed.
        starts: Where paths may start.
        goals: Where they may end.
        budget: How long to go on.
        random: Draws configurations.
        goal_bias: Part of the iterations in which the tree grows towards a goal.
    """
    tree = Tree(edges.space)
    for start in starts:
        tree.add(start)
    iteration = 0
    while (stopped := budget.end(iteration)) is None:
        to_goal = iteration == 0 or random.random() < goal_bias
        goal = int(random.integers(len(goals)))
        if to_goal:
            reached = _reach(edges, tree, goals[goal])
            if reached is not None:
                path = np.array([*tree.branch(reached)[::-1], goals[goal]])
                found = without_repetitions(path)
                return Search(End.found, found, tree.root(reached), goal, iteration + 1, (tree,))
        else:
            _extend(edges, tree, edges.space.sample(random))
        iteration += 1
    return Search(stopped, None, -1, -1, iteration, (tree,))


def explore(edges: Edges, starts: Sequence[Floats], size: int, budget: Budget, random: np.random.Generator) -> Tree:
    """Grow one tree from the starts until it has a size, without any goal."""
    tree = Tree(edges.space)
    for start in starts:
        tree.add(start)
    iteration = 0
    while tree.count < size and budget.end(iteration) is None:
        _extend(edges, tree, edges.space.sample(random))
        iteration += 1
    return tree


def _straight_line(edges: Edges, starts: Sequence[Floats], goals: Sequence[Floats]) -> tuple[int, int] | None:
    """Return a start and a goal that a straight line connects, nearest first, or None."""
    space = edges.space
    pairs = [(space.distance(goal, start), s, g) for s, start in enumerate(starts) for g, goal in enumerate(goals)]
    for _, start, goal in sorted(pairs)[:_MOST_LINES]:
        if edges.line(starts[start], space.difference(goals[goal], starts[start])):
            return start, goal
    return None


def _extend(edges: Edges, tree: Tree, target: Floats) -> int | None:
    """Grow a tree towards a configuration by one line; return the new node, or None where it is blocked."""
    nearest = tree.nearest(target)
    start = tree.node(nearest)
    step = edges.space.difference(target, start)
    far = math.sqrt(step.dot(step))
    if far > RANGE:
        step *= RANGE / far
    return tree.add(start + step, nearest) if edges.line(start, step) else None


def _reach(edges: Edges, tree: Tree, target: Floats) -> int | None:
    """Grow a tree to a configuration; return the last node before it, or None where it is blocked on the way."""
    nearest = tree.nearest(target)
    while True:
        start = tree.node(nearest)
        step = edges.space.difference(target, start)
        far = math.sqrt(step.dot(step))
        is_last = far <= RANGE
        if not is_last:
            step *= RANGE / far
        if not edges.line(start, step):
            return None
        if is_last:
            return nearest
        nearest = tree.add(start + step, nearest)


def without_repetitions(path: Floats) -> Floats:
    """Return a path without configurations that are the same as the one before."""
    kept = np.append(True, (np.diff(path, axis=0) != 0).any(axis=1))
    return path[kept]

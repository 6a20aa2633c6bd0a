"""Path planning problems."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges
from ravemj.planning.rrt import Budget, MoreGoals


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

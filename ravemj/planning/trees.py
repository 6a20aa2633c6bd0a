"""Trees of configurations that are connected by allowed lines."""

from collections.abc import Iterable

import numpy as np

from ravemj.core.transforms import Floats
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

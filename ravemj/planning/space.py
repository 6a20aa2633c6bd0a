"""Configuration spaces: joint values, and pose components of a base."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError

ON_LIMIT = 1e-12
"""Rounding tolerance of limits: absolute for values below 1 [rad or m], relative above."""


@dataclass(frozen=True, slots=True)
class Coordinates:
    """Types of the coordinates of a configuration.

    Attributes:
        circular: Whether each coordinate is a circular angle, shape (n,).
        translation: Columns of x, y, z of a base.
        rotation: Columns of a base's angle (one), rotation vector (three) or quaternion (four).
    """

    circular: NDArray[np.bool_]
    translation: tuple[int, ...] = ()
    rotation: tuple[int, ...] = ()

    def difference(self, configurations: Floats, others: Floats) -> Floats:
        """Return the shortest differences from ``others`` to configurations, shape (…, n)."""
        step = configurations - others
        if self.circular.any():
            angles = step[..., self.circular]
            step[..., self.circular] = angles - 2 * np.pi * np.round(angles / (2 * np.pi))
        if len(self.rotation) == 4:  # a quaternion and its negative are the same rotation
            columns = list(self.rotation)
            opposite = np.sum(configurations[..., columns] * others[..., columns], axis=-1, keepdims=True) < 0
            step[..., columns] = np.where(
                opposite, -configurations[..., columns] - others[..., columns], step[..., columns]
            )
        return step

    def outside(self, values: Floats, lower: Floats, upper: Floats, tolerance: float = ON_LIMIT) -> NDArray[np.bool_]:
        """Return whether each value, shape (…, n), is not finite or is outside its limits; circular values have none.

        ``tolerance`` is absolute for values below 1, and relative above.
        """
        slack = tolerance * np.maximum(1.0, np.abs(values))
        beyond = (values < lower - slack) | (values > upper + slack)
        return beyond & ~self.circular | ~np.isfinite(values)


_MOST_STEPS = 1_000_000
"""Maximum number of tests of a line; each takes about 10 µs."""


@dataclass(frozen=True, slots=True)
class Space:
    """Box-shaped configuration space with a weighted distance.

    Attributes:
        coordinates: The types of the coordinates.
        lower: Lower limits [rad or m], shape (n,).
        upper: Upper limits, shape (n,).
        weights: Weight of each value in distances, shape (n,).
        resolution: Maximum steps of edge tests, shape (n,).
    """

    coordinates: Coordinates
    lower: Floats
    upper: Floats
    weights: Floats
    resolution: Floats
    _is_plain: bool = field(init=False)

    def __post_init__(self) -> None:
        plain = not self.coordinates.circular.any() and len(self.coordinates.rotation) < 4
        object.__setattr__(self, "_is_plain", plain)

    def difference(self, configurations: Floats, others: Floats) -> Floats:
        """Return the shortest differences from ``others`` to configurations, shape (…, n)."""
        return configurations - others if self._is_plain else self.coordinates.difference(configurations, others)

    def distance(self, start: Floats, other: Floats) -> float:
        """Return the weighted distance of two configurations: the root of the sum of (weight * difference)^2."""
        return float(np.linalg.norm(self.weights * self.difference(start, other)))

    def clamp(self, configuration: Floats) -> Floats:
        """Return a configuration with each value clamped to its limits, except circular angles."""
        limited = np.minimum(np.maximum(configuration, self.lower), self.upper)
        return np.where(self.coordinates.circular, configuration, limited)

    def outside(self, configuration: Floats) -> int | None:
        """Return the index of the first value outside its limits, or None."""
        wrong = self.coordinates.outside(configuration, self.lower, self.upper)
        return int(wrong.argmax()) if wrong.any() else None

    def steps(self, difference: Floats) -> int:
        """Return the minimum number of equal steps of a line that keep the resolution; at least 1.

        Raises:
            ArgumentError: there are more than ``_MOST_STEPS``.
        """
        steps = np.abs(difference / self.resolution).max(initial=0.0)
        if not steps <= _MOST_STEPS:
            message = f"resolution: a line has {steps:.3g} steps of it, and should have {_MOST_STEPS} at most"
            raise ArgumentError(message)
        return max(1, int(np.ceil(steps - 1e-9)))

    def sample(self, random: np.random.Generator) -> Floats:
        """Return a random configuration within the limits."""
        return self.lower + (self.upper - self.lower) * random.random(len(self.lower))

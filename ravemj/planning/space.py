"""Spaces of configurations: joint values, and parts of the pose of a base."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats

ON_LIMIT = 1e-12
"""How far beyond a limit [rad or m], relative to its size, a value is still on it: rounding."""


@dataclass(frozen=True, slots=True)
class Coordinates:
    """What the numbers of a configuration are.

    Attributes:
        circular: For each, whether it is an angle that goes round, shape (n,).
        translation: Columns of x, y, z of a base.
        rotation: Columns of its angle (one), rotation vector (three) or quaternion (four).
    """

    circular: NDArray[np.bool_]
    translation: tuple[int, ...] = ()
    rotation: tuple[int, ...] = ()

    def difference(self, configurations: Floats, others: Floats) -> Floats:
        """Return how to get from the others to configurations, the short way round; shape (…, n)."""
        step = configurations - others
        if self.circular.any():
            angles = step[..., self.circular]
            step[..., self.circular] = angles - 2 * np.pi * np.round(angles / (2 * np.pi))
        if len(self.rotation) == 4:  # a quaternion and its negative are one rotation
            columns = list(self.rotation)
            opposite = np.sum(configurations[..., columns] * others[..., columns], axis=-1, keepdims=True) < 0
            step[..., columns] = np.where(
                opposite, -configurations[..., columns] - others[..., columns], step[..., columns]
            )
        return step

    def outside(self, values: Floats, lower: Floats, upper: Floats, tolerance: float = ON_LIMIT) -> NDArray[np.bool_]:
        """Return which values, shape (…, n), are outside their limits or not finite; circular ones have no limits.

        ``tolerance`` is how far beyond a limit a value may be, relative to its size above 1.
        """
        slack = tolerance * np.maximum(1.0, np.abs(values))
        beyond = (values < lower - slack) | (values > upper + slack)
        return beyond & ~self.circular | ~np.isfinite(values)


@dataclass(frozen=True, slots=True)
class Space:
    """A box of configurations, with a distance.

    Attributes:
        coordinates: What the numbers are.
        lower: Least values [rad or m], shape (n,).
        upper: Greatest values, shape (n,).
        weights: Of each number in distances, shape (n,).
        resolution: The largest steps in which lines are tested, shape (n,).
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
        """Return how to get from the others to configurations, the short way round; shape (…, n)."""
        return configurations - others if self._is_plain else self.coordinates.difference(configurations, others)

    def distance(self, one: Floats, other: Floats) -> float:
        """Return the weighted distance of two configurations: the root of the sum of (weight * difference)^2."""
        return float(np.linalg.norm(self.weights * self.difference(one, other)))

    def clamp(self, configuration: Floats) -> Floats:
        """Return the configuration with values outside the limits at them; circular ones stay."""
        limited = np.minimum(np.maximum(configuration, self.lower), self.upper)
        return np.where(self.coordinates.circular, configuration, limited)

    def outside(self, configuration: Floats) -> int | None:
        """Return the first number that is outside its limits, or None."""
        wrong = self.coordinates.outside(configuration, self.lower, self.upper)
        return int(wrong.argmax()) if wrong.any() else None

    def steps(self, difference: Floats) -> int:
        """Return into how many steps a line is divided so that none is longer than the resolution; at least 1."""
        return max(1, int(np.ceil(np.abs(difference / self.resolution).max(initial=0.0) - 1e-9)))

    def sample(self, random: np.random.Generator) -> Floats:
        """Return a random configuration within the limits."""
        return self.lower + (self.upper - self.lower) * random.random(len(self.lower))

"""Verification of a motion's limits and collisions at all times."""

from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Allowed
from ravemj.planning.retiming.segments import PathLimits

EXACT = 1e-9
"""Relative rounding tolerance of values, speeds and accelerations at their limits."""

_ROUNDING = 1e-12
"""Relative rounding error of values, subtracted from their differences over short times."""


class Samples(NamedTuple):
    """Samples of a motion.

    Attributes:
        times: The times [s], ascending, shape (m,).
        values: The values, shape (m, n).
        velocities: Velocities in the trajectory, shape (m, n), or None.
        accelerations: Accelerations in the trajectory, shape (m, n), or None.
        has_jumps: Whether velocities may jump between samples, as on straight lines.
    """

    times: Floats
    values: Floats
    velocities: Floats | None
    accelerations: Floats | None
    has_jumps: bool


def flaw(samples: Samples, limits: PathLimits, allowed: Allowed) -> str | None:
    """Return the first violation of a motion, or None.

    Speeds are checked from differences between samples and from the trajectory's velocities; accelerations likewise if
    velocities do not jump.
    """
    return (
        _outside(samples, limits)
        or _too_much(samples.times, _speeds(samples, limits), limits.velocity, "speed")
        or _too_much(samples.times, _accelerations(samples), limits.acceleration, "acceleration")
        or _not_allowed(samples, allowed)
    )


def _outside(samples: Samples, limits: PathLimits) -> str | None:
    values = samples.values
    for row, column in np.argwhere(limits.coordinates.outside(values, limits.lower, limits.upper, EXACT)):
        bounds = f"[{limits.lower[column]:g}, {limits.upper[column]:g}]"
        return f"value {column} is {values[row, column]:.9g} at {samples.times[row]:.6g} s, outside its limits {bounds}"
    return None


def _speeds(samples: Samples, limits: PathLimits) -> list[Floats]:
    elapsed = np.diff(samples.times)
    moved = np.abs(limits.coordinates.difference(samples.values[1:], samples.values[:-1]))
    moved = np.maximum(moved - _ROUNDING * np.maximum(1.0, np.abs(samples.values[1:])), 0.0)
    passed = elapsed > 0
    speeds = np.zeros_like(samples.values)
    speeds[1:][passed] = moved[passed] / elapsed[passed][:, None]
    speeds[1:][~passed] = np.where(moved[~passed] > 0, np.inf, 0.0)  # a jump
    return [speeds] if samples.velocities is None else [speeds, samples.velocities]


def _accelerations(samples: Samples) -> list[Floats]:
    if samples.has_jumps or samples.velocities is None:
        return []
    elapsed = np.diff(samples.times)
    passed = elapsed > 1e-6  # velocity differences over shorter times are rounding errors
    rates = np.zeros_like(samples.values)
    rates[1:][passed] = np.diff(samples.velocities, axis=0)[passed] / elapsed[passed][:, None]
    return [rates] if samples.accelerations is None else [rates, samples.accelerations]


def _too_much(times: Floats, candidates: list[Floats], bound: Floats, name: str) -> str | None:
    for numbers in candidates:
        wrong = ~(np.abs(numbers) <= bound + EXACT * np.maximum(1.0, bound))
        for row, column in np.argwhere(wrong):
            largest, most = abs(numbers[row, column]), bound[column]
            return (
                f"the {name} of value {column} is {largest:.9g} at {times[row]:.6g} s, and should be {most:g} at most"
            )
    return None


def _not_allowed(samples: Samples, allowed: Allowed) -> str | None:
    for time, values in zip(samples.times, samples.values, strict=True):
        if not allowed(values):
            return f"at {time:.6g} s it collides, or breaks a constraint"
    return None

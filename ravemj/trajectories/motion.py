"""Motions: joint values over time, piecewise linear."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.trajectories.interpolation import between

_SAME_FRAME = 1e-6  # fraction of a frame within which the end of a motion counts as a frame


@dataclass(frozen=True, eq=False, init=False, slots=True)
class Motion:
    """Joint values at given times, with linear interpolation.

    Args:
        times: (N,) seconds, N >= 1, strictly increasing.
        values: (N, dof) joint values [rad or m].

    Attributes:
        times: The times, as a read-only copy.
        values: The joint values, as a read-only copy.

    Raises:
        ArgumentError: A shape does not fit, something is not a finite number, or the times do not increase.
    """

    times: Floats
    values: Floats

    def __init__(self, times: ArrayLike, values: ArrayLike) -> None:
        rows = finite_array(values, "values", "(N, dof)", 2)
        seconds = finite_array(times, "times", "(N,)", 1)
        if not 1 <= len(seconds) == len(rows):
            raise ArgumentError(f"expected one time for each row of values, found {len(seconds)} and {len(rows)} rows")
        if not math.isfinite(float(seconds[-1]) - float(seconds[0])):
            raise ArgumentError(f"the times from {seconds[0]} to {seconds[-1]} span more than a float can hold")
        stuck = np.flatnonzero(seconds[1:] <= seconds[:-1])
        if stuck.size:
            before, after = seconds[stuck[0] : stuck[0] + 2]
            raise ArgumentError(f"times must increase, found {after} s after {before} s")
        object.__setattr__(self, "times", seconds)
        object.__setattr__(self, "values", rows)

    @classmethod
    def line(cls, start: ArrayLike, goal: ArrayLike, duration: float = 1.0) -> "Motion":
        """Return the straight motion in joint space at constant speed, starting at time 0.

        Args:
            start: (dof,) joint values at time 0 [rad or m].
            goal: (dof,) joint values at the end.
            duration: Duration of the motion [s], positive.

        Raises:
            ArgumentError: The shapes differ, or a value or the duration is invalid.
        """
        first, last = (finite_array(end, name, "(dof,)", 1) for end, name in ((start, "start"), (goal, "goal")))
        if first.shape != last.shape:
            raise ArgumentError(f"start and goal must have equally many values, found {len(first)} and {len(last)}")
        return cls((0.0, positive(duration, "duration")), (first, last))

    @property
    def duration(self) -> float:
        """Duration [s]; 0 for a single row."""
        return float(self.times[-1]) - float(self.times[0])

    @property
    def dof(self) -> int:
        """Number of joint values in a row."""
        return self.values.shape[1]

    def sample(self, t: float) -> Floats:
        """Return the (dof,) joint values at time t [s], clamped to the start and the end of the motion.

        Interpolated values are between those of the two adjacent rows, so they are within joint limits if the rows are.
        """
        if math.isnan(t):
            raise ArgumentError("expected a time in seconds, found nan")
        after = int(np.searchsorted(self.times, t, side="right"))
        if after in {0, len(self.times)}:
            return self.values[min(after, len(self.times) - 1)].copy()
        (t0, t1), (first, second) = self.times[after - 1 : after + 1], self.values[after - 1 : after + 1]
        return between((first, second), float((t - t0) / (t1 - t0)))

    def number_of_frames(self, fps: float) -> int:
        """Return the number of frames of ``frames(fps)``; see the function ``number_of_frames``."""
        return number_of_frames(self.duration, fps)

    def frames(self, fps: float) -> Iterator[Floats]:
        """Return an iterator over the (dof,) joint values of each frame of a video, one at a time.

        Frame k shows the time start + k/fps, and the last frame is exactly the end of the motion.

        Args:
            fps: Frames per second.
        """
        count = self.number_of_frames(fps)
        start = float(self.times[0])
        return (self.sample(start + k / fps) if k < count - 1 else self.values[-1].copy() for k in range(count))

    def rescaled(self, duration: float) -> "Motion":
        """Return the same path from the same start time with another ``duration`` [s].

        Raises:
            ArgumentError: The motion has only one row, or the duration is not positive.
        """
        if not self.duration:
            raise ArgumentError("a motion of one row has no duration that could be rescaled")
        start = self.times[0]
        return Motion(start + (self.times - start) / self.duration * positive(duration, "duration"), self.values)


def number_of_frames(duration: float, fps: float) -> int:
    """Return the number of frames of a video.

    Frames are 1/fps apart, from the start to the end. An end between frames gets an additional frame, so there are
    ceil(duration * fps) + 1 frames; a motion of zero duration has one frame.
    """
    steps = duration * positive(fps, "fps")
    if not math.isfinite(steps):
        raise ArgumentError(f"{duration} s at {fps} frames a second are too many frames")
    return max(1, math.ceil(steps - _SAME_FRAME)) + 1 if steps else 1


def positive(number: float, name: str) -> float:
    """Return a finite, positive number, or raise ``ArgumentError``."""
    if not (math.isfinite(number) and number > 0):
        raise ArgumentError(f"expected a {name} above 0, found {number}")
    return number


def finite_array(numbers: ArrayLike, name: str, shape: str, ndim: int) -> Floats:
    """Return a checked, read-only copy of numbers."""
    try:
        given = np.asarray(numbers)
    except ValueError as error:
        raise ArgumentError(f"expected {name} of shape {shape}, found rows of different lengths") from error
    if given.dtype.kind not in "iuf" or given.ndim != ndim:
        raise ArgumentError(f"expected {name} as numbers of shape {shape}, found {given.dtype} of shape {given.shape}")
    with np.errstate(over="ignore"):
        checked = np.array(given, dtype=np.float64, order="C")
    if not np.isfinite(checked).all():
        raise ArgumentError(f"expected finite {name}, found {checked[~np.isfinite(checked)][0]}")
    checked.flags.writeable = False
    return checked

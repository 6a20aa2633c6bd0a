"""Playback of a motion."""

import math

from ravemj.engine.simulation import Simulation
from ravemj.errors import ArgumentError
from ravemj.trajectories.body_motion import BodyMotion

STEP = 1 / 30
"""Time step of ``step`` [s]: one frame of a video."""

SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0)
"""Speeds through which the button cycles; scripts may set any other."""

_LONGEST_PAUSE = 0.5
"""Maximum time step between two frames [s]; if drawing or a script takes longer, the motion is delayed."""


class Playback:
    """Playback of a motion in a viewer, from ``viewer.play`` or ``viewer.playback``.

    A window or a page advances it while drawing; ``seek`` and ``step`` move the bodies immediately, also without a
    window. The methods are thread-safe.

    Example:
        >>> playback = viewer.play(ravemj.Motion.line([0, 0], [3.14, 0]))
        >>> playback.speed = 0.5
        >>> playback.seek(0.25)
        >>> robot.GetDOFValues()
        array([0.785, 0.   ])
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._motion: BodyMotion | None = None
        self._time = 0.0
        self._speed = 1.0
        self._playing = False
        self._last: float | None = None

    @property
    def motion(self) -> BodyMotion | None:
        """The motion, or None. Removing its body from the environment clears it."""
        with self._simulation.lock:
            if self._motion is not None and not all(map(self._simulation.holds, self._motion.bodies)):
                self.clear()
            return self._motion

    @property
    def duration(self) -> float:
        """Duration of the motion [s]; 0 if there is none."""
        motion = self.motion
        return 0.0 if motion is None else motion.duration

    @property
    def time(self) -> float:
        """Current time of the motion [s], from 0 to ``duration``."""
        return self._time

    @property
    def playing(self) -> bool:
        """Whether it is running; False at the end of the motion."""
        return self._playing

    @property
    def speed(self) -> float:
        """Playback speed; 1 is real time."""
        return self._speed

    @speed.setter
    def speed(self, speed: float) -> None:
        if not (math.isfinite(speed) and speed > 0):
            raise ArgumentError(f"speed: is {speed}, and should be above 0")
        with self._simulation.lock:
            self._speed = float(speed)

    def load(self, motion: BodyMotion) -> None:
        """Replace the motion, and go to its start."""
        with self._simulation.lock:
            self.pause()
            motion.place(0.0)
            self._motion, self._time = motion, 0.0

    def clear(self) -> None:
        """Remove the motion; the bodies keep their poses."""
        with self._simulation.lock:
            self.pause()
            self._motion, self._time = None, 0.0

    def play(self) -> None:
        """Start or resume; at the end, restart."""
        with self._simulation.lock:
            if self._time >= self.duration:
                self.seek(0.0)
            self._playing, self._last = self.duration > 0, None

    def pause(self) -> None:
        """Pause at the current time."""
        with self._simulation.lock:
            self._playing = False

    def seek(self, time: float) -> None:
        """Go to a time of the motion [s], clamped to its duration.

        Raises:
            ArgumentError: ``time`` is not a number.
        """
        if math.isnan(time):
            raise ArgumentError("time: is nan, and should be a number of seconds")
        with self._simulation.lock:
            self._time = min(max(float(time), 0.0), self.duration)
            if self._motion is not None:
                try:
                    self._motion.place(self._time)
                except Exception:
                    self._playing = False  # else the error would repeat with every frame
                    raise

    def step(self, count: int = 1) -> None:
        """Pause, and go forward by frames of 1/30 s; backward if the count is negative."""
        with self._simulation.lock:
            self.pause()
            self.seek(self._time + count * STEP)

    def advance(self, now: float) -> None:
        """Advance the motion if it runs; ``now`` [s] is from any monotonic clock. Called before each frame."""
        with self._simulation.lock:
            if self.motion is None or not self._playing:
                return
            elapsed = 0.0 if self._last is None else min(max(now - self._last, 0.0), _LONGEST_PAUSE)
            self._last = now
            if elapsed:
                self.seek(self._time + self._speed * elapsed)
                self._playing = self._playing and self._time < self.duration

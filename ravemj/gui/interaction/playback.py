"""A motion that is played, paused, and gone through by hand."""

import math

from ravemj.engine.simulation import Simulation
from ravemj.errors import ArgumentError
from ravemj.trajectories.body_motion import BodyMotion

STEP = 1 / 30
"""How far ``step`` goes [s]: a frame of a video."""

SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0)
"""What a button chooses from; scripts may choose any."""

_LONGEST_PAUSE = 0.5
"""Time that counts at most between two pictures [s]: where drawing or a script takes longer, the motion waits."""


class Playback:
    """Plays a motion in a viewer; ``viewer.play`` returns it, ``viewer.playback`` too.

    A window or a page lets it go on while it draws; ``seek`` and ``step`` move the bodies at once, with or without one.
    Its methods can be called in any thread.

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
        """What is played, or None; a body that is taken out of the world takes its motion along."""
        with self._simulation.lock:
            if self._motion is not None and not all(map(self._simulation.holds, self._motion.bodies)):
                self.clear()
            return self._motion

    @property
    def duration(self) -> float:
        """How long the motion is [s]; 0 where there is none."""
        motion = self.motion
        return 0.0 if motion is None else motion.duration

    @property
    def time(self) -> float:
        """Where in the motion the bodies are [s], from 0 to ``duration``."""
        return self._time

    @property
    def playing(self) -> bool:
        """Whether it goes on by itself; False once the end is reached."""
        return self._playing

    @property
    def speed(self) -> float:
        """Seconds of the motion in a second: 1 is real time, 0.5 half as fast."""
        return self._speed

    @speed.setter
    def speed(self, speed: float) -> None:
        if not (math.isfinite(speed) and speed > 0):
            raise ArgumentError(f"speed: is {speed}, and should be above 0")
        with self._simulation.lock:
            self._speed = float(speed)

    def load(self, motion: BodyMotion) -> None:
        """Take another motion, in place of the one before, and go to its start."""
        with self._simulation.lock:
            self.pause()
            motion.place(0.0)
            self._motion, self._time = motion, 0.0

    def clear(self) -> None:
        """Forget the motion; the bodies stay where they are."""
        with self._simulation.lock:
            self.pause()
            self._motion, self._time = None, 0.0

    def play(self) -> None:
        """Go on; from the end, go on from the start."""
        with self._simulation.lock:
            if self._time >= self.duration:
                self.seek(0.0)
            self._playing, self._last = self.duration > 0, None

    def pause(self) -> None:
        """Stop where the motion is now."""
        with self._simulation.lock:
            self._playing = False

    def seek(self, time: float) -> None:
        """Go to a time of the motion [s]; before the start and after the end, to these.

        Raises:
            ArgumentError: this is no number.
        """
        if math.isnan(time):
            raise ArgumentError("time: is nan, and should be a number of seconds")
        with self._simulation.lock:
            self._time = min(max(float(time), 0.0), self.duration)
            if self._motion is not None:
                try:
                    self._motion.place(self._time)
                except Exception:
                    self._playing = False  # what fails now would fail with every picture
                    raise

    def step(self, count: int = 1) -> None:
        """Pause, and go on by some frames of 1/30 s; back where the count is negative."""
        with self._simulation.lock:
            self.pause()
            self.seek(self._time + count * STEP)

    def advance(self, now: float) -> None:
        """Let time pass while it plays: before each picture, with the time [s] of any clock that never goes back."""
        with self._simulation.lock:
            if self.motion is None or not self._playing:
                return
            elapsed = 0.0 if self._last is None else min(max(now - self._last, 0.0), _LONGEST_PAUSE)
            self._last = now
            if elapsed:
                self.seek(self._time + self._speed * elapsed)
                self._playing = self._playing and self._time < self.duration

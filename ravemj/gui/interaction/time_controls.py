"""Controls of playback and of simulation time."""

import logging
import math

from ravemj.engine.simulation import Simulation
from ravemj.gui.interaction.control import Control
from ravemj.gui.interaction.notices import Notices
from ravemj.gui.interaction.playback import SPEEDS, Playback

_LOG = logging.getLogger("ravemj")

_OF_TIME = {"play": "run", "forward": "step"}
"""Controls of simulation time that the playback keys operate if there is no motion."""

_MEASURED = 0.5
"""Averaging time of the measured simulation speed [s]."""


class TimeControls:
    """Two rows of controls: one if there is a motion, one if simulation time can be controlled.

    Callers of its methods hold the simulation's lock.

    Attributes:
        playback: Playback of the motion.
    """

    def __init__(self, simulation: Simulation, notices: Notices) -> None:
        self.playback = Playback(simulation)
        self._simulation, self._notices = simulation, notices
        self._sample: tuple[float, int] | None = None
        self._factor = 0.0  # last measured ratio of simulation time to real time

    @property
    def appearance(self) -> object:
        """A key that changes when the controls must be redrawn."""
        playback, clock = self.playback, self._simulation.clock
        motion = playback.time, playback.duration, playback.playing, playback.speed
        if clock is None:
            return motion
        now = clock.now // 100_000 if clock.is_running else clock.now  # [us]; at most ten updates per second
        return motion, clock.is_running, now, clock.pace, self._factor, self._simulation.physics is None

    def advance(self, now: float) -> None:
        """Advance playback and measure the simulation speed; ``now`` is from ``time.monotonic``."""
        self.playback.advance(now)
        clock = self._simulation.clock
        if clock is None or not clock.is_running:
            self._sample, self._factor = None, 0.0
        elif self._sample is None:
            self._sample = now, clock.now
        elif now - self._sample[0] >= _MEASURED:
            before, start = self._sample
            self._sample, self._factor = (now, clock.now), (clock.now - start) / 1e6 / (now - before)

    def all(self) -> list[Control]:
        """Return the current controls."""
        return [*self._of_motion(), *self._of_time()]

    def _of_motion(self) -> list[Control]:
        playback = self.playback
        if not playback.duration > 0:
            return []
        clock = f"{playback.time:.2f} / {playback.duration:.2f} s"
        return [
            Control("back", "One frame back", group="playing"),
            Control("play", "Pause" if playback.playing else "Play", group="playing", is_on=playback.playing),
            Control("forward", "One frame forward", group="playing"),
            Control("seek", "Time", clock, playback.time, 0.0, playback.duration, group="playing"),
            Control("speed", "Speed", f"{playback.speed:g}x", group="playing"),
        ]

    def _of_time(self) -> list[Control]:
        clock = self._simulation.clock
        if clock is None or not (self._simulation.physics is not None or clock.is_running or clock.now > 0):
            return []
        label = "Stop simulation time" if clock.is_running else "Let simulation time pass"
        now = f"{clock.now / 1e6:.2f} s"
        pace = "max" if math.isinf(clock.pace) else f"{clock.pace:g}x"
        return [
            Control("run", label, group="time", is_on=clock.is_running),
            Control("step", "One step of simulation time", group="time"),
            Control(
                "clock",
                "Simulation time, and how fast it passes",
                f"{now}, {self._factor:.2f}x" if clock.is_running else now,
                group="time",
            ),
            Control("pace", "Seconds of simulation in a second", pace, group="time"),
        ]

    def operate(self, name: str, value: float) -> bool:
        """Press a button or set a slider; return False if it is not one of these controls."""
        has_motion = self.playback.duration > 0
        if not has_motion:
            name = _OF_TIME.get(name, name)
        names = {control.name for control in self.all()}
        if name in names:
            self._operate_motion(name, value)
            self._operate_time(name)
        elif names and name in {"slower", "faster"}:
            self._change_speed(has_motion=has_motion, is_faster=name == "faster")
        else:
            return False
        return True

    def _operate_motion(self, name: str, value: float) -> None:
        playback = self.playback
        if name == "play":
            (playback.pause if playback.playing else playback.play)()
        elif name in {"back", "forward"}:
            playback.step(1 if name == "forward" else -1)
        elif name == "seek":
            playback.pause()
            playback.seek(value)
        elif name == "speed":
            playback.speed = _after(playback.speed)

    def _operate_time(self, name: str) -> None:
        clock = self._simulation.clock
        if clock is None:
            return
        if name == "pace":
            clock.pace = _after(clock.pace)
        elif name == "run" and not clock.is_running:
            clock.resume()
        elif name in {"run", "step"}:
            clock.stop(wait=False)  # its thread may be waiting for the lock
        if name == "step":
            try:
                clock.step(clock.timestep)
            except Exception as error:  # of a user's module, say
                _LOG.exception("a step of simulation time failed")
                self._notices.say(f"The step failed: {error}")

    def _change_speed(self, *, has_motion: bool, is_faster: bool) -> None:
        """Select the next faster or slower speed, of the motion's playback or else of simulation time."""
        clock = self._simulation.clock
        speed = self.playback.speed if has_motion or clock is None else clock.pace
        others = [other for other in SPEEDS if (other > speed if is_faster else other < speed)]
        if not others:
            return
        chosen = min(others) if is_faster else max(others)
        if has_motion:
            self.playback.speed = chosen
        elif clock is not None:
            clock.pace = chosen


def _after(speed: float) -> float:
    """Return the next speed of the button; the slowest follows the fastest."""
    return next((other for other in SPEEDS if other > speed), SPEEDS[0])

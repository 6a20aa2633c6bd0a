"""The controls of a motion that is played, and those of simulation time."""

import math

from ravemj.gui.interaction.control import Control
from ravemj.gui.interaction.playback import SPEEDS, Playback
from ravemj.gui.interaction.simulation_time import SimulationTime

_OF_TIME = {"play": "run", "forward": "step"}
"""What keys for a motion do to simulation time where there is no motion."""


class TimeControls:
    """A row for a motion, and one for simulation time; each is there while there is something to control.

    Attributes:
        playback: The motion.
        simulation_time: Simulation time.
    """

    def __init__(self, playback: Playback, simulation_time: SimulationTime) -> None:
        self.playback = playback
        self.simulation_time = simulation_time

    @property
    def changes(self) -> int:
        """A number that grows with what is shown."""
        return self.playback.changes + self.simulation_time.changes

    def pass_time(self, now: float) -> None:
        """Let a motion that plays go on, and see how fast simulation time passes.

        Args:
            now: What ``time.monotonic`` says.
        """
        self.playback.advance(now)
        self.simulation_time.pass_time(now)

    def all(self) -> list[Control]:
        """Return the controls as they are now."""
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
        time = self.simulation_time
        if not time.is_shown:
            return []
        label = "Stop simulation time" if time.is_running else "Let simulation time pass"
        pace = "max" if math.isinf(time.pace) else f"{time.pace:g}x"
        return [
            Control("run", label, group="time", is_on=time.is_running),
            Control("step", "One step of simulation time", group="time"),
            Control("clock", "Simulation time, and how fast it passes", time.text, group="time"),
            Control("pace", "Seconds of simulation in a second", pace, group="time"),
        ]

    def operate(self, name: str, value: float) -> bool:
        """Press a button, or move a slider to a value; return False where it is none of these."""
        if not self.playback.duration > 0:
            name = _OF_TIME.get(name, name)
        names = {control.name for control in self.all()}
        if names:
            names |= {"slower", "faster"}
        if name not in names:
            return False
        if name in {"run", "step"}:
            getattr(self.simulation_time, name)()
        elif name == "pace":
            self.simulation_time.pace = _after(self.simulation_time.pace)
        elif name in {"slower", "faster"}:
            self._change_speed(is_faster=name == "faster")
        else:
            self._operate_motion(name, value)
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

    def _change_speed(self, *, is_faster: bool) -> None:
        """Let the motion go faster or slower, or simulation time where there is no motion."""
        has_motion = self.playback.duration > 0
        speed = self.playback.speed if has_motion else self.simulation_time.pace
        others = [other for other in SPEEDS if (other > speed if is_faster else other < speed)]
        if not others:
            return
        chosen = min(others) if is_faster else max(others)
        if has_motion:
            self.playback.speed = chosen
        else:
            self.simulation_time.pace = chosen


def _after(speed: float) -> float:
    """Return the speed that a button has after this one; the slowest after the fastest."""
    return next((other for other in SPEEDS if other > speed), SPEEDS[0])

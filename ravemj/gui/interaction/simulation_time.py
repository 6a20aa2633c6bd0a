"""Simulation time, as people see it pass, stop it and let it go on."""

import logging
import math

from ravemj.engine.simulation import Simulation
from ravemj.gui.interaction.notices import Notices

_LOG = logging.getLogger("ravemj")

_MEASURED = 0.5
"""Over how long it is measured how fast time passes [s]."""


class SimulationTime:
    """Simulation time: pause, step, and how fast it passes; all views of a viewer share it.

    The simulation is locked by who calls the methods.

    Attributes:
        factor: Seconds of simulation that have passed in a second, as measured last; 0 while time stands still.
        changes: How often what is shown may have changed.
    """

    def __init__(self, simulation: Simulation, notices: Notices) -> None:
        self._simulation, self._notices = simulation, notices
        self._sample: tuple[float, int] | None = None
        self._seen: object = None
        self.factor = 0.0
        self.changes = 0

    @property
    def is_shown(self) -> bool:
        """Whether there is something to be seen of it: physics, or time that has passed."""
        clock = self._simulation.clock
        return clock is not None and (self._simulation.physics is not None or clock.is_running or clock.now > 0)

    @property
    def is_running(self) -> bool:
        """Whether time passes by itself."""
        clock = self._simulation.clock
        return clock is not None and clock.is_running

    @property
    def pace(self) -> float:
        """Seconds of simulation that are wanted in a second."""
        clock = self._simulation.clock
        return 1.0 if clock is None else clock.pace

    @pace.setter
    def pace(self, pace: float) -> None:
        if self._simulation.clock is not None:
            self._simulation.clock.pace = pace
            self.changes += 1

    @property
    def text(self) -> str:
        """What time it is, and how fast it passes."""
        clock = self._simulation.clock
        now = 0.0 if clock is None else clock.now / 1e6
        return f"{now:.2f} s, {self.factor:.2f}x" if self.is_running else f"{now:.2f} s"

    def run(self) -> None:
        """Let time pass, or stand still if it passes."""
        clock = self._simulation.clock
        if clock is None:
            return
        if clock.is_running:
            clock.stop(wait=False)  # its thread may be waiting for the lock
        else:
            clock.resume()
        self.changes += 1

    def step(self) -> None:
        """Let time stand still, but for one step."""
        clock = self._simulation.clock
        if clock is None:
            return
        clock.stop(wait=False)
        try:
            clock.step(clock.timestep)
        except Exception as error:  # of a user's module, say
            _LOG.exception("a step of simulation time failed")
            self._notices.say(f"The step failed: {error}")
        self.changes += 1

    def pass_time(self, now: float) -> None:
        """See how fast time passes.

        Args:
            now: What ``time.monotonic`` says.
        """
        clock = self._simulation.clock
        if clock is None:
            return
        if not clock.is_running:
            self._sample, self.factor = None, 0.0
        elif self._sample is None:
            self._sample = now, clock.now
        elif now - self._sample[0] >= _MEASURED:
            before, start = self._sample
            self._sample, self.factor = (now, clock.now), (clock.now - start) / 1e6 / (now - before)
        seen = self.is_shown, self.is_running, math.floor(clock.now / 1e5), self.factor  # ten times in a second
        self.changes += self._seen not in (None, seen)
        self._seen = seen

"""The base class of the topics of ``Environment``."""

from typing import TYPE_CHECKING

from ravemj.core.api_object import ApiObject
from ravemj.engine.simulation import Simulation
from ravemj.errors import Diagnostic, ErrorCode, RavemjError, Source
from ravemj.graphics.simulation_renderer import SimulationRenderer

if TYPE_CHECKING:
    from ravemj.gui.viewers import Viewer


class EnvironmentPart(ApiObject):
    """The base class of the topics of ``Environment``, with the state that they share."""

    def __init__(self) -> None:
        self._simulation = Simulation()
        self._renderer = SimulationRenderer(self._simulation)
        self._viewers: list[Viewer] = []
        self._found: dict[Diagnostic, None] = {}  # ordered sets: loading a file again adds nothing
        self._files: dict[str, Source | None] = {}
        self._is_destroyed = False

    def _check_alive(self) -> None:
        """Raise an error if the environment has been destroyed."""
        if self._is_destroyed:
            raise RavemjError(f"{self!r} is destroyed; make a new Environment", ErrorCode.InvalidState)

    @property
    def _viewer(self) -> "Viewer | None":
        """The first viewer, which ``GetViewer`` returns, or None."""
        return self._viewers[0] if self._viewers else None

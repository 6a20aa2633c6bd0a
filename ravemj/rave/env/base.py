"""What the parts of an environment's API share."""

from typing import TYPE_CHECKING, cast

from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import Diagnostic, ErrorCode, RavemjError
from ravemj.graphics.simulation_renderer import SimulationRenderer
from ravemj.rave.interface import Annotations, UserData
from ravemj.rave.kinbody import KinBody
from ravemj.rave.robot import Robot

if TYPE_CHECKING:
    from ravemj.gui.viewers import Viewer
    from ravemj.rave.environment import Environment


class EnvironmentPart(UserData):
    """Part of the API of an environment; ``Environment`` joins the parts."""

    _internal = ("wrap",)

    def __init__(self) -> None:
        self._simulation = Simulation()
        self._renderer = SimulationRenderer(self._simulation)
        self._viewers: list[Viewer] = []
        self._found: dict[Diagnostic, None] = {}  # as ordered sets, which loading a file again does not let grow
        self._files: dict[str, None] = {}
        self._annotations = Annotations()
        self._is_destroyed = False

    def _check_alive(self) -> None:
        """Check that the environment was not destroyed.

        Raises:
            RavemjError: it was.
        """
        if self._is_destroyed:
            raise RavemjError(f"{self!r} is destroyed; make a new Environment", ErrorCode.InvalidState)

    @property
    def _viewer(self) -> "Viewer | None":
        """The first viewer, which ``GetViewer`` returns, or None."""
        return self._viewers[0] if self._viewers else None

    @property
    def _environment(self) -> "Environment":
        return cast("Environment", self)

    def wrap(self, state: BodyState) -> KinBody:
        """Return the one object that users have for a body."""
        with self._simulation.lock:
            if state.api_object is None:
                state.api_object = (Robot if state.scene.is_robot else KinBody)(self._environment, state)
            assert isinstance(state.api_object, KinBody)
            return state.api_object

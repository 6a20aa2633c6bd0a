"""Base class of the parts of ``Environment``."""

from collections.abc import Callable
from typing import TYPE_CHECKING, cast
from weakref import WeakValueDictionary

from ravemj.core.handles import Handle
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import Diagnostic, ErrorCode, RavemjError
from ravemj.graphics.simulation_renderer import SimulationRenderer
from ravemj.rave.interface import Annotations, UserData
from ravemj.rave.kinbody import KinBody
from ravemj.rave.module import Module
from ravemj.rave.robot import Robot
from ravemj.rave.sensors import Sensor

if TYPE_CHECKING:
    from ravemj.gui.viewers import Viewer
    from ravemj.rave.environment import Environment
    from ravemj.rave.module import Module


BodyCallback = Callable[[KinBody, int], object]
"""A function of a body, and 1 when it was added or 0 when it was removed."""


class BodyCallbackHandle(Handle):
    """Keeps a function registered; it is not called any more once this is closed or gone."""


class EnvironmentPart(UserData):
    """State that the parts of ``Environment`` share."""

    _internal = ("wrap",)

    def __init__(self) -> None:
        self._simulation = Simulation()
        self._renderer = SimulationRenderer(self._simulation)
        self._objects: WeakValueDictionary[BodyState, KinBody] = WeakValueDictionary()
        self._kept_objects: dict[BodyState, KinBody] = {}  # of bodies that are in the environment
        self._viewers: list[Viewer] = []
        self._found: dict[Diagnostic, None] = {}  # as ordered sets, which loading a file again does not let grow
        self._files: dict[str, None] = {}
        self._annotations = Annotations()
        self._body_callbacks: list[BodyCallback] = []
        self._modules: list[Module] = []
        self._sensors: list[Sensor] = []  # those that no robot carries
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
            found = self._kept_objects.get(state) or self._objects.get(state)
            if found is None:
                found = (Robot if state.scene.is_robot else KinBody)(self._environment, state)
                self._objects[state] = found
            if state.index:
                self._kept_objects[state] = found
            return found

    def _remove_all(self) -> None:
        """Take all bodies and sensors out of the environment."""
        for body in self._kept_objects.values():
            if isinstance(body, Robot):
                body.forget_sensors()
        for sensor in self._sensors:
            sensor.hide()
        self._sensors.clear()
        gone = [self.wrap(state) for state in self._simulation.bodies] if self._body_callbacks else []
        self._simulation.clear()
        self._kept_objects.clear()
        for body in gone:
            self._tell_of_body(body, 0)

    def _tell_of_body(self, body: KinBody, action: int) -> None:
        """Call the functions of ``RegisterBodyCallback``: 1, a body was added; 0, it was removed."""
        for callback in tuple(self._body_callbacks):
            callback(body, action)

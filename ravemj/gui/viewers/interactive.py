"""Common base of viewers: selection, callbacks and playback."""

import itertools
import logging
from collections.abc import Callable
from typing import Any

from ravemj.core.api_object import ApiObject
from ravemj.core.handles import Handle
from ravemj.engine.simulation import Simulation
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction import Hit, Interaction, Playback, ViewRay
from ravemj.gui.viewers.host import Body, Host
from ravemj.trajectories.motion_arguments import MotionLike, body_motion

_LOG = logging.getLogger("ravemj")

Callback = Callable[..., object]


class Callbacks:
    """Callbacks for one event, each active while its handle exists."""

    def __init__(self) -> None:
        self._functions: dict[int, Callback] = {}
        self._keys = itertools.count()

    def add(self, function: Callback) -> Handle:
        """Register a function.

        Raises:
            ArgumentError: it is not callable.
        """
        if not callable(function):
            raise ArgumentError(f"callback: {function!r} cannot be called")
        key = next(self._keys)
        self._functions[key] = function
        return Handle(self._functions.pop, key, None)

    def call(self, *arguments: object) -> list[object]:
        """Call all functions and return their results; exceptions are logged."""
        answers: list[object] = []
        for function in self._functions.copy().values():
            try:
                answers.append(function(*arguments))
            except Exception:
                _LOG.exception("a viewer's callback failed")
        return answers

    def __bool__(self) -> bool:
        return bool(self._functions)


class Interactive(ApiObject):
    """Common base of all viewers: interaction, selection and playback.

    Attributes:
        environment: Weak reference to the environment; OpenRAVE's scripts call ``GetEnv``.
        interaction: Handles pointer and keyboard events; see ``ravemj.gui.interaction``.
    """

    _internal = ("announce", "environment", "host")

    environment: Callable[[], Host | None] | None = None

    def __init__(self, simulation: Simulation, camera: Camera, size: tuple[int, int]) -> None:
        self._simulation = simulation
        self._selection_callbacks = Callbacks()
        self.interaction = Interaction.first_view(simulation, camera, size, self._may_select)

    def announce(self) -> None:
        """Show the address of the viewer, after it is added to an environment; windows have none."""

    def GetEnv(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the environment of the viewer."""
        return self.host()

    def host(self) -> Host | None:
        """Return the environment as a ``Host``; None if it no longer exists."""
        return None if self.environment is None else self.environment()

    def GetSelectedBody(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the selected body, or the body of the selected joint; None without a selection."""
        selection, env = self.interaction.selection, self.host()
        return None if selection is None or env is None else env.wrap(selection.body)

    def GetSelectedLink(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the clicked link of the selection; None without a selection."""
        selection, body = self.interaction.selection, self.GetSelectedBody()
        return None if selection is None or body is None else body.GetLinks()[selection.link]

    def GetSelectedJoint(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the selected joint; None if none is selected."""
        selection, body = self.interaction.selection, self.GetSelectedBody()
        if selection is None or body is None or selection.dof is None:
            return None
        return body.GetJointFromDOFIndex(selection.dof)

    def RegisterItemSelectionCallback(self, callback: Callback) -> Handle:
        """Register a callback for clicks that are about to select a link; it runs in the thread of the window.

        Args:
            callback: The function. Its arguments are the link, the point on it in the world [m], shape (3,), and the
                direction from the eye to it, a unit vector of shape (3,). If it returns True, as in OpenRAVE, the
                click counts as handled and nothing is selected.

        Returns:
            A handle; closing or dropping it unregisters the function.

        Raises:
            ArgumentError: it is not callable.

        Example:
            >>> handle = viewer.RegisterItemSelectionCallback(lambda link, point, direction: print(link.GetName()))
        """
        return self._selection_callbacks.add(callback)

    def _may_select(self, hit: Hit, ray: ViewRay) -> bool:
        env = self.host()
        if env is None or not self._selection_callbacks:
            return True
        link = env.wrap(hit.body).GetLinks()[hit.link]
        return not any(self._selection_callbacks.call(link, hit.position.copy(), ray.direction.copy()))

    @property
    def playback(self) -> Playback:
        """Playback state: current motion, time and speed."""
        return self.interaction.controls.playback

    def play(self, motion: MotionLike, *, robot: Body | None = None, speed: float = 1.0) -> Playback:
        """Play a motion, with controls for pausing, stepping, speed and time.

        This returns immediately. Windows and pages play in real time while they are shown. An offscreen viewer does
        not advance the motion; ``playback.seek`` sets its time.

        Args:
            motion: A ``Motion``, a trajectory with times, rows of time and joint values, or the path of a file. Joints
                stop at their limits.
            robot: The moving body; by default the first robot with joints, or the one whose joints a table names.
                Trajectories name their bodies.
            speed: Playback speed; 1 is real time.

        Returns:
            The playback, also available as ``viewer.playback``.

        Raises:
            ArgumentError: the motion does not fit the robot, or the trajectory has no times or moves no body of the
                environment. The previous motion continues then.

        Example:
            >>> viewer.play(ravemj.Motion.line([0, 0], [3.14, 0], duration=2))
            >>> viewer.playback.pause()
        """
        with self._simulation.lock:
            playback = self.playback
            followed = body_motion(self._simulation, motion, None if robot is None else robot.simulation_state)
            before, playback.speed = playback.speed, speed
            try:
                playback.load(followed)
            except Exception:
                playback.speed = before
                raise
            playback.play()
            return playback

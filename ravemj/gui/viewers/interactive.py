"""What every viewer has besides pictures: what people select in it, who is told, and what it plays."""

import itertools
import logging
import weakref
from collections.abc import Callable
from typing import Any, Protocol

from ravemj.core.api_object import ApiObject
from ravemj.core.handles import Handle
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction import Hit, Interaction, Playback, Ray
from ravemj.trajectories.motion_arguments import MotionLike, body_motion

_LOG = logging.getLogger("ravemj")

Callback = Callable[..., object]


class Callbacks:
    """Functions for one occasion, each for as long as its handle lives."""

    def __init__(self) -> None:
        self._functions: dict[int, Callback] = {}
        self._keys = itertools.count()

    def add(self, function: Callback) -> Handle:
        """Take a function up.

        Raises:
            ArgumentError: it cannot be called.
        """
        if not callable(function):
            raise ArgumentError(f"callback: {function!r} cannot be called")
        key = next(self._keys)
        self._functions[key] = function
        return Handle(self._functions.pop, key, None)

    def call(self, *arguments: object) -> list[object]:
        """Call all functions and return what they return; what they raise is logged."""
        answers: list[object] = []
        for function in self._functions.copy().values():
            try:
                answers.append(function(*arguments))
            except Exception:
                _LOG.exception("a viewer's callback failed")
        return answers

    def __bool__(self) -> bool:
        return bool(self._functions)


class _Body(Protocol):
    """A body of the API, which stands above viewers."""

    @property
    def simulation_state(self) -> BodyState: ...


class Interactive(ApiObject):
    """Part of every viewer: its mouse and keys, what they select, and a motion that it plays.

    Attributes:
        environment: What the viewer was made for; OpenRAVE's scripts ask ``GetEnv``.
        interaction: Takes events of mouse and keys; ``ravemj.gui.interaction`` says how.
    """

    _internal = ("announce", "environment")

    environment: "weakref.ref[Any] | None" = None

    def __init__(self, simulation: Simulation, camera: Camera, size: tuple[int, int]) -> None:
        self._simulation = simulation
        self._selection_callbacks = Callbacks()
        self.interaction = Interaction(simulation, camera, size, self._may_select)

    def announce(self) -> None:
        """Tell people where the viewer is, once it belongs to an environment; windows are seen by themselves."""

    def GetEnv(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the environment that the viewer was made for."""
        return None if self.environment is None else self.environment()

    def GetSelectedBody(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the body that the user selected, also by one of its joints; None if there is none."""
        selection, env = self.interaction.selection, self.GetEnv()
        return None if selection is None or env is None else env.wrap(selection.body)

    def GetSelectedLink(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the link that the user clicked on to select something; None if nothing is selected."""
        selection, body = self.interaction.selection, self.GetSelectedBody()
        return None if selection is None or body is None else body.GetLinks()[selection.link]

    def GetSelectedJoint(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the joint that the user selected; None if there is none."""
        selection, body = self.interaction.selection, self.GetSelectedBody()
        if selection is None or body is None or selection.dof is None:
            return None
        return body.GetJointFromDOFIndex(selection.dof)

    def RegisterItemSelectionCallback(self, callback: Callback) -> Handle:
        """Have a function called when the user is about to select a link, in the thread of the window.

        Args:
            callback: The function. Its arguments are the link, the point on it in the world [m], shape (3,), and the
                direction from the eye to it, a unit vector of shape (3,). Where it returns True, as in OpenRAVE, it
                has dealt with the click, and nothing is selected.

        Returns:
            A handle; the function is forgotten when it is closed or dropped.

        Raises:
            ArgumentError: this cannot be called.

        Example:
            >>> handle = viewer.RegisterItemSelectionCallback(lambda link, point, direction: print(link.GetName()))
        """
        return self._selection_callbacks.add(callback)

    def _may_select(self, hit: Hit, ray: Ray) -> bool:
        env = self.GetEnv()
        if env is None or not self._selection_callbacks:
            return True
        link = env.wrap(hit.body).GetLinks()[hit.link]
        return not any(self._selection_callbacks.call(link, hit.position.copy(), ray.direction.copy()))

    @property
    def playback(self) -> Playback:
        """The motion that is played, or was: where it is, how fast it goes."""
        return self.interaction.controls.playback

    def play(self, motion: MotionLike, *, robot: _Body | None = None, speed: float = 1.0) -> Playback:
        """Play a motion, and let people go through it: play and pause it, step, change the speed, drag its time.

        This returns at once. Windows and pages play in real time while they show it. Without either nothing plays by
        itself; ``playback.seek`` goes to any time.

        Args:
            motion: A ``Motion``, a trajectory with times, rows of time and joint values, or the path of a file. Joints
                stop at their limits.
            robot: The body that moves; by default the first robot with joints, or the one whose joints a table names.
                A trajectory names its bodies.
            speed: Seconds of the motion in a second.

        Returns:
            The playback, which is ``viewer.playback`` too.

        Raises:
            ArgumentError: the motion does not fit the robot, the trajectory moves no body that is there, or has no
                times. What was played before goes on then.

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

"""What a viewer plays."""

from typing import Protocol

from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction import Playback
from ravemj.gui.viewers.selection_callbacks import Selecting
from ravemj.trajectories.body_motion import BodyMotion
from ravemj.trajectories.motion import Motion
from ravemj.trajectories.waypoints import Waypoints


class _Trajectory(Protocol):
    """A trajectory of the API, which stands above viewers."""

    @property
    def waypoints(self) -> Waypoints: ...


class _Body(Protocol):
    """A body of the API, which stands above viewers."""

    @property
    def simulation_state(self) -> BodyState: ...


class Playing(Selecting):
    """Part of every viewer: a motion that it plays."""

    _simulation: Simulation

    @property
    def playback(self) -> Playback:
        """The motion that is played, or was: where it is, how fast it goes."""
        return self.interaction.controls.playback

    def play(self, motion: Motion | _Trajectory, *, robot: _Body | None = None, speed: float = 1.0) -> Playback:
        """Play a motion, and let people go through it: play and pause it, step, change the speed, drag its time.

        This returns at once. Windows and pages play in real time while they show it. Without either nothing plays by
        itself; ``playback.seek`` goes to any time.

        Args:
            motion: A ``Motion``, or a trajectory with times. Joints stop at their limits.
            robot: Which body follows a ``Motion``; None: the first robot with joints. A trajectory names its bodies.
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
            if isinstance(motion, Motion):
                body = self._first_robot() if robot is None else robot.simulation_state
                followed = BodyMotion.of_motion(body, motion)
            else:
                known = motion.waypoints
                followed = BodyMotion.of_waypoints(self._simulation, Waypoints(known.groups, known.data.copy()))
            before, playback.speed = playback.speed, speed
            try:
                playback.load(followed)
            except Exception:
                playback.speed = before
                raise
            playback.play()
            return playback

    def _first_robot(self) -> BodyState:
        for body in self._simulation.bodies:
            if body.scene.is_robot and body.scene.dof_axes:
                return body
        raise ArgumentError("there is no robot with joints to move")


def camera_line(camera: Camera) -> str:
    """Return the line of a script that sets a viewer's camera."""
    rows = ", ".join(str([round(number, 8) + 0.0 for number in row]) for row in camera.T_world_camera.tolist())
    return f"viewer.SetCamera([{rows}])"

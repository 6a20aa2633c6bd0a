"""Videos of a robot that follows a motion."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.errors import ArgumentError, Diagnostic, send_warning
from ravemj.graphics.rendering import Camera, three_quarter_view
from ravemj.graphics.rendering.checks import checked_colour
from ravemj.graphics.simulation_renderer import Format, Frame
from ravemj.rave.enums import CheckLimitsAction
from ravemj.trajectories.motion import Motion

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.kinbody import KinBody

_POSES_FOR_THE_VIEW = 17  # configurations along a motion that the camera has to see: enough for full turns of a joint


class Shot(NamedTuple):
    """The settings of a video: camera, background, size and quality of the frames, and frames per second."""

    camera: Camera
    background: tuple[float, float, float]
    form: Format
    fps: float


def record(  # noqa: PLR0913 - keyword arguments
    env: "Environment",
    path: str | os.PathLike[str],
    motion: Motion,
    *,
    robot: "KinBody | None" = None,
    width: int = 640,
    height: int = 480,
    fps: float = 30.0,
    camera: ArrayLike | None = None,
    background: ArrayLike | None = None,
    on_frame: Callable[[int], None] | None = None,
) -> Path:
    """Write a video of a robot that follows a motion. Afterwards the robot is at the end of the motion.

    Args:
        env: The environment.
        path: The video file, ``.mp4``, ``.avi``, ``.mpg``, ``.gif`` or ``.webp``; without a suffix, a folder for PNG
            frames.
        motion: Joint values over time. Values outside the limits are set to the limits, with a warning.
        robot: The body that moves; by default the first robot.
        width: The width of the frames [pixels].
        height: The height of the frames [pixels].
        fps: Frames per second.
        camera: ``T_world_camera``, 4x4, z forward and y down. The default is the viewer's, else the file's, else a view
            of the whole motion.
        background: Red, green, blue from 0 to 1. The default is the viewer's, else the file's, else white.
        on_frame: Called with the number of frames drawn so far.

    Returns:
        The path of the video.

    Raises:
        ArgumentError: an argument is wrong, or there is no robot.
        OutputError: the video cannot be written; no partial file is left behind.
        RenderingError: no renderer works on this machine.

    Example:
        >>> swing = ravemj.Motion.line([0, 0], [3.14, 0], duration=1.0)
        >>> ravemj.record(env, "swing.mp4", swing)
    """
    from ravemj.graphics.video import write_frames  # noqa: PLC0415 - slow to import

    body = moving_body(env) if robot is None else robot
    allowed = within_limits(body, motion)
    form = Format(width, height)
    shot = Shot(
        camera_for_motion(env, body, allowed, form.aspect) if camera is None else Camera.from_matrix(camera),
        env.background if background is None else checked_colour(background),
        form,
        fps,
    )
    return write_frames(path, draw_frames(env, body, allowed, shot), fps, on_frame=on_frame)


def draw_frames(env: "Environment", body: "KinBody", motion: Motion, shot: Shot) -> Iterator[Frame]:
    """Move a body along a motion, and yield the frames."""
    for values in motion.frames(shot.fps):
        with env:
            body.SetDOFValues(values, None, CheckLimitsAction.Nothing)
            frame = env.renderer.render(shot.camera, shot.background, shot.form)
        yield frame


def moving_body(env: "Environment") -> "KinBody":
    """Return the body that moves by default: the first robot with joints.

    Raises:
        ArgumentError: no robot has joints.
    """
    for robot in env.GetRobots():
        if robot.GetDOF():
            return robot
    names = ", ".join(body.GetName() for body in env.GetBodies())
    raise ArgumentError(f"there is no robot with joints to move; the bodies are: {names or 'none'}")


def within_limits(body: "KinBody", motion: Motion) -> Motion:
    """Return the motion with values outside the limits set to the limits; a warning names each such joint.

    Raises:
        ArgumentError: the motion has another number of joints than the body.
    """
    if motion.dof != body.GetDOF():
        raise ArgumentError(f"the motion has {motion.dof} joints, and '{body.GetName()}' has {body.GetDOF()} DOFs")
    lower, upper = body.GetDOFLimits()
    values = body.simulation_state.kinematics.limits.clamp(motion.values)
    for joint in body.GetJoints():
        dof = joint.GetDOFIndex()
        if np.any(values[:, dof] != motion.values[:, dof]):
            source = body.simulation_state.scene.joints[joint.GetJointIndex()].source
            message = (
                f"the motion takes joint '{joint.GetName()}' outside its limits "
                f"[{lower[dof]:.6g}, {upper[dof]:.6g}]; it stops at the limit"
            )
            diagnostic = Diagnostic("warning", "value-outside-limits", message, source)
            send_warning(diagnostic)
    return Motion(motion.times, values)


def camera_for_motion(env: "Environment", body: "KinBody", motion: Motion, aspect: float) -> Camera:
    """Return the viewer's camera, else the file's, else one that sees the whole motion of a body."""
    chosen = env.renderer.file_camera() if env.GetViewer() is None else env.default_camera()
    if chosen is not None:
        return chosen
    before = body.GetDOFValues()
    spheres = [env.renderer.bounding_sphere()]
    for step in range(_POSES_FOR_THE_VIEW):
        time = float(motion.times[0]) + motion.duration * step / (_POSES_FOR_THE_VIEW - 1)
        body.SetDOFValues(motion.sample(time), None, CheckLimitsAction.Nothing)
        spheres.append(env.renderer.bounding_sphere())
    body.SetDOFValues(before, None, CheckLimitsAction.Nothing)
    lowest = np.min([center - radius for center, radius in spheres], axis=0)
    highest = np.max([center + radius for center, radius in spheres], axis=0)
    center = (lowest + highest) / 2
    reach = max(float(np.linalg.norm(part - center)) + radius for part, radius in spheres)
    return three_quarter_view(center, reach, aspect)

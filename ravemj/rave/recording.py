"""Videos and interactive pages of a robot that follows a motion."""

import math
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, Diagnostic, send_warning
from ravemj.graphics.rendering import Camera, three_quarter_view
from ravemj.graphics.rendering.style import AS_USUAL, Look, LookChoices
from ravemj.graphics.shown_path import ShownPath
from ravemj.graphics.simulation_renderer import Format, Frame
from ravemj.graphics.webgl.animation import Animation, Appearance, Recording, animation_page
from ravemj.graphics.webgl.sliders import mechanism
from ravemj.trajectories.body_motion import BodyMotion
from ravemj.trajectories.motion_arguments import MotionLike, body_motion

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.kinbody import KinBody


_POSES_FOR_THE_VIEW = 17  # number of configurations that the camera has to see: enough for full turns of a joint


class Shot(NamedTuple):
    """Settings of a video: camera, appearance, size and quality of the frames, and frame rate."""

    camera: Camera
    look: Look
    form: Format
    fps: float


def record(  # noqa: PLR0913 - keyword arguments
    env: "Environment",
    path: str | os.PathLike[str],
    motion: MotionLike,
    *,
    robot: "KinBody | None" = None,
    width: int = 640,
    height: int = 480,
    fps: float = 30.0,
    camera: ArrayLike | None = None,
    background: ArrayLike | None = None,
    shadows: bool | None = None,
    floor: str = "auto",
    lights: Literal["studio", "model", "both"] = "both",
    on_frame: Callable[[int], None] | None = None,
) -> Path:
    """Write a video of a robot that follows a motion. Afterwards the robot is at the end of the motion.

    Args:
        env: The environment.
        path: The video file, ``.mp4``, ``.avi``, ``.mpg``, ``.gif`` or ``.webp``; without a suffix, a folder for PNG
            frames.
        motion: A ``Motion``; a trajectory of OpenRAVE with times; rows (time, value, value, …) or (time, values); the
            pair of times, shape (N,), and joint values, shape (N, dof); or the path of a ``.csv`` or ``.npz`` table, as
            ``write_motion`` writes it, or of a file of a trajectory. Joints stop at their limits, with a warning.
        robot: The body that moves; by default the first robot with joints, or the one whose joints a table names. A
            trajectory names its bodies.
        width: The width of the frames [pixels].
        height: The height of the frames [pixels].
        fps: Frames per second.
        camera: ``T_world_camera``, 4x4, z forward and y down. The default is the viewer's, else the file's, else a view
            of the whole motion.
        background: Red, green, blue from 0 to 1. The default is the viewer's, else the file's, else a gradient.
        shadows: Whether lights cast shadows; None: only with a graphics card, since without one they take most of the
            time.
        floor: ``on`` draws a floor with a grid below the bodies, ``off`` none; ``auto`` draws one if neither script nor
            file sets a background.
        lights: ``studio``, ``model`` (the model's own lights) or ``both``.
        on_frame: Called with the number of frames drawn so far.

    Returns:
        The path of the video; notebooks show it as the video.

    Raises:
        ArgumentError: an argument is wrong, or there is no robot.
        SourceError: the file of a motion cannot be read.
        OutputError: the video cannot be written; no partial file is left behind.
        RenderingError: no renderer works on this machine.

    Example:
        >>> swing = ravemj.Motion.line([0, 0], [3.14, 0], duration=1.0)
        >>> ravemj.record(env, "swing.mp4", swing)
    """
    from ravemj.graphics.video import write_frames  # noqa: PLC0415 - slow to import

    choices = LookChoices(shadows, floor, lights)
    followed = followed_motion(env, motion, robot)
    form = Format(width, height, shadows)
    shot = Shot(
        camera_for_motion(env, followed, form.aspect) if camera is None else Camera.from_matrix(camera),
        env.look(background, choices),
        form,
        fps,
    )
    return ShownPath(write_frames(path, draw_frames(env, followed, shot), fps, on_frame=on_frame))


def followed_motion(env: "Environment", motion: MotionLike, robot: "KinBody | None" = None) -> BodyMotion:
    """Return the motion of the bodies, with a warning for each joint that stops at a limit; see ``record``."""
    with env:
        followed = body_motion(env.simulation, motion, None if robot is None else robot.simulation_state)
        for body, rows in zip(followed.bodies, followed.rows, strict=True):
            _warn_of_limits(body, rows)
    return followed


def draw_frames(env: "Environment", motion: BodyMotion, shot: Shot) -> Iterator[Frame]:
    """Move bodies along a motion, and yield the frames."""
    with env:
        look = replace(shot.look, lowest=lowest_of_motion(env, motion)) if shot.look.floor else shot.look
    for time in motion.frame_times(shot.fps):
        with env:
            motion.place(time)
            frame = env.renderer.render(shot.camera, look, shot.form)
        yield frame


def _warn_of_limits(body: BodyState, rows: Floats) -> None:
    beyond = (body.kinematics.limits.clamp(rows) != rows).any(axis=0)
    for dof in np.flatnonzero(beyond).tolist():
        joint, axis = body.scene.joint_of_dof(dof), body.scene.dof_axes[dof]
        message = (
            f"the motion takes joint '{body.scene.dof_names[dof]}' outside its limits "
            f"[{axis.lower:.6g}, {axis.upper:.6g}]; it stops at the limit"
        )
        send_warning(Diagnostic("warning", "value-outside-limits", message, joint.source))


def camera_for_motion(env: "Environment", motion: BodyMotion, aspect: float) -> Camera:
    """Return the viewer's camera, else the file's, else one that sees the whole motion."""
    chosen = env.renderer.file_camera() if env.GetViewer() is None else env.default_camera()
    if chosen is not None:
        return chosen
    spheres = [env.renderer.bounding_sphere()]
    spheres += [env.renderer.bounding_sphere() for _ in _along(motion)]
    lowest = np.min([center - radius for center, radius in spheres], axis=0)
    highest = np.max([center + radius for center, radius in spheres], axis=0)
    center = (lowest + highest) / 2
    reach = max(float(np.linalg.norm(part - center)) + radius for part, radius in spheres)
    return three_quarter_view(center, reach, aspect)


def lowest_of_motion(env: "Environment", motion: BodyMotion) -> float:
    """Return the lowest z [m] of all visible geometry during a motion, for a floor that stays in place."""
    return min(env.renderer.lowest_point() for _ in _along(motion))


def _along(motion: BodyMotion) -> Iterator[None]:
    """Move the bodies to evenly spaced times of a motion, one per iteration, and restore them at the end."""
    before = [(body, body.pose(), body.kinematics.values()) for body in motion.bodies]
    for time in np.linspace(0.0, motion.duration, _POSES_FOR_THE_VIEW):
        motion.place(float(time))
        yield
    for body, pose, values in before:
        body.set_pose(pose)
        body.set_values(values)


_ASPECT = 4 / 3
"""Aspect ratio for which the initial camera is chosen; pages can have any."""

_LOWEST_FPS, _HIGHEST_FPS = 0.01, 1000


def animate(  # noqa: PLR0913 - those of ``Environment.animation``
    env: "Environment",
    motion: MotionLike | None,
    robot: "KinBody | None" = None,
    fps: float = 30.0,
    camera: ArrayLike | None = None,
    background: ArrayLike | None = None,
    choices: LookChoices = AS_USUAL,
    *,
    notes: Sequence[str] = (),
) -> Animation:
    """Return the interactive page of a motion; arguments as for ``Environment.animation``."""
    if not _LOWEST_FPS <= fps <= _HIGHEST_FPS:  # NaN is refused, too
        raise ArgumentError(f"expected from {_LOWEST_FPS} to {_HIGHEST_FPS} frames a second, found {fps}")
    with env:
        followed = None if motion is None else followed_motion(env, motion, robot)
        is_fitted = camera is None and env.GetViewer() is None and env.renderer.file_camera() is None
        if camera is not None:
            view = Camera.from_matrix(camera)
        elif followed is None:
            view = env.default_camera(_ASPECT)
        else:
            view = camera_for_motion(env, followed, _ASPECT)
        shown = followed.bodies if followed is not None else () if robot is None else (robot.simulation_state,)
        lowest = math.inf if followed is None else lowest_of_motion(env, followed)
        recording = _recorded(env, shown, followed, fps)
        title = ", ".join(body.scene.name for body in shown) or "ravemj"
        look = replace(env.look(background, choices), lowest=lowest)
        appearance = Appearance(view, 1.0 if is_fitted else _ASPECT, look, title, choices.shadows, tuple(notes))
        compiled, drawings = env.simulation.compiled(), env.simulation.drawings.primitives()
        moved = None
        if followed is None:
            bodies = [body for body in env.simulation.bodies if body.scene.joints] if robot is None else shown
            moved = mechanism(compiled, bodies)
        return Animation(animation_page(compiled.model, compiled.data, recording, appearance, drawings, moved))


def _recorded(env: "Environment", bodies: Sequence[BodyState], motion: BodyMotion | None, fps: float) -> Recording:
    """Play a motion and record the poses of all bodies at each frame; without motion, one frame."""
    rows: list[tuple[Floats, Floats, Floats]] = []
    for time in [0.0] if motion is None else motion.frame_times(fps):
        if motion is not None:
            motion.place(time)
        data = env.simulation.compiled().data
        values = [body.kinematics.values() for body in bodies]
        rows.append((data.xpos.copy(), data.xquat.copy(), np.concatenate([*values, np.zeros(0)])))
    joints = [joint for body in bodies for joint in body.scene.joints]
    return Recording(
        float(fps),
        np.array([row[0] for row in rows]),
        np.array([row[1] for row in rows]),
        np.array([row[2] for row in rows]),
        [(f"{body.scene.name} " if bodies[1:] else "") + name for body in bodies for name in body.scene.dof_names],
        ["m" if joint.slides(axis) else "rad" for joint in joints for axis in range(len(joint.axes))],
    )

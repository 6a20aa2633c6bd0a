"""Commands that draw: ``play``, ``render`` and ``doctor``."""

import argparse
import math
import os
import platform
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from ravemj.cli.console import console, progress, table
from ravemj.cli.models import load_model, moving_robot, named_robot, shown_sphere
from ravemj.cli.robot_motions import export, motion_file
from ravemj.core.output import check_file
from ravemj.core.signals import signals_raised
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering.camera import Camera, three_quarter_view
from ravemj.graphics.rendering.camera_file import read_camera
from ravemj.graphics.rendering.contexts import RAY, remedy, requested_backend
from ravemj.graphics.rendering.doctor import probe_backends
from ravemj.graphics.rendering.style import Look, LookChoices
from ravemj.graphics.simulation_renderer import Format, Frame
from ravemj.graphics.video import (
    STILL_FORMATS,
    VIDEO_FORMATS,
    check_picture,
    check_target,
    known_suffix,
    write_frames,
    write_picture,
)
from ravemj.gui.viewers import has_display
from ravemj.gui.viewers.window import WindowViewer
from ravemj.rave import Environment, KinBody, Robot
from ravemj.rave.recording import Shot, camera_for_motion, draw_frames, followed_motion
from ravemj.trajectories.body_motion import BodyMotion
from ravemj.trajectories.joint_trajectory_files import (
    JOINT_TRAJECTORY_SUFFIXES,
    check_joint_trajectory_file,
    is_joint_trajectory,
)
from ravemj.trajectories.motion import Motion, number_of_frames
from ravemj.trajectories.motion_arguments import MotionFile, followed_file

_MOST_FRAMES = 1_000_000  # nine hours at 30 frames per second: more is a typing mistake
PAGE = ".html"
"""Suffix of a page that plays a motion."""


def play(options: argparse.Namespace) -> int:
    """Play a motion: in a window, or into a video."""
    output: str | None = options.output
    if output is not None and is_joint_trajectory(output):
        return _play_to_robot(options)
    is_page = output is not None and known_suffix(output, [PAGE, *JOINT_TRAJECTORY_SUFFIXES, *VIDEO_FORMATS]) == PAGE
    if output is not None:
        (check_file if is_page else check_target)(output)
    camera = None if options.camera is None else read_camera(options.camera)
    env = load_model(options)
    motion = _motion(env, options)
    _check_length(motion, options.fps)
    if output is not None and is_page:
        write_page(output, env, motion, options, camera)
        return 0
    motion = followed_motion(env, motion)
    camera = camera or camera_for_motion(env, motion, options.size[0] / options.size[1])
    shot = Shot(camera, look_of(options, env), Format(*options.size, shadows=options.shadows), options.fps)
    if output is None and _play_in_window(env, motion, shot, options):
        return 0
    write_video(output or f"{Path(options.model).stem}.mp4", env, motion, shot)
    return 0


def _check_length(motion: BodyMotion, fps: float) -> None:
    """Raise if a video of the motion would have more than ``_MOST_FRAMES`` frames."""
    count = number_of_frames(motion.duration, fps)
    if count > _MOST_FRAMES:
        length = f"{motion.duration:g} s at {fps:g} frames a second are {count:.3g} frames"
        raise ArgumentError(f"{length}, and at most {_MOST_FRAMES:,} are drawn; give a smaller --duration or --fps")


def _motion(env: Environment, options: argparse.Namespace) -> BodyMotion:
    """Return the motion selected by the options, starting at the robot's present values."""
    if options.trajectory is not None:
        motion = followed_file(env.simulation, motion_file(env, options))
        return motion if options.duration is None else motion.rescaled(options.duration)
    robot, line = _line(env, options)
    return BodyMotion.of_motion(robot.simulation_state, line)


def _line(env: Environment, options: argparse.Namespace) -> tuple[Robot, Motion]:
    """Return the moving robot, and a straight-line joint motion from its present values to those of ``--to``."""
    robot = moving_robot(env, options.robot)
    start = robot.GetDOFValues()
    if options.to is None:
        goal = robot.simulation_state.kinematics.limits.clamp(np.array([math.pi] + [0.0] * (len(start) - 1)))
    else:
        goal = _checked_values("--to", options.to, robot)
    return robot, Motion.line(start, goal, options.duration or 1.0)


def _play_to_robot(options: argparse.Namespace) -> int:
    """Write the motion to a file for a robot controller; return the exit code."""
    check_joint_trajectory_file(options.output)
    env = load_model(options)
    if options.trajectory is not None:
        motion = motion_file(env, options)
    else:
        robot, line = _line(env, options)
        motion = MotionFile("", line, robot.simulation_state, list(range(robot.GetDOF())))
    export(env, motion, options)
    return 0


def _checked_values(option: str, values: list[float], body: KinBody) -> list[float]:
    """Return the joint values of an option; raise unless there is one for each DOF."""
    dof = body.GetDOF()
    if len(values) != dof:
        names = ", ".join(body.simulation_state.scene.dof_names)
        raise ArgumentError(
            f"{option}: found {len(values)}, expected {dof}: one for each DOF of '{body.GetName()}': {names}"
        )
    return values


def look_choices(options: argparse.Namespace) -> LookChoices:
    """Return the choices of shadows, floor and lights."""
    return LookChoices(options.shadows, options.floor, options.lights)


def look_of(options: argparse.Namespace, env: Environment) -> Look:
    """Return the look selected by the options."""
    return env.look(options.background, look_choices(options))


def picture_of(options: argparse.Namespace, env: Environment, camera: ArrayLike | None) -> Frame:
    """Render a picture according to the options."""
    look = {"shadows": options.shadows, "floor": options.floor, "lights": options.lights}
    return env.render(*options.size, camera=camera, background=options.background, **look)


def _play_in_window(env: Environment, motion: BodyMotion, shot: Shot, options: argparse.Namespace) -> bool:
    """Play in a window, and wait until it is closed; return False if no window can be opened."""
    if not has_display():
        return False
    env.SetViewer("window")
    viewer = env.GetViewer()
    if not isinstance(viewer, WindowViewer):
        return False
    viewer.SetCamera(shot.camera.T_world_camera)
    if shot.look.background is not None:
        viewer.SetBkgndColor(shot.look.background)
    viewer.choose_look(look_choices(options))
    viewer.play(motion)
    with signals_raised():  # Ctrl-C then leaves time to complete a file that is being saved
        viewer.wait()
    return True


def write_page(
    path: str,
    env: Environment,
    motion: BodyMotion,
    options: argparse.Namespace,
    camera: Camera | None,
    notes: Sequence[str] = (),
) -> None:
    """Write a page that plays a motion, and report it."""
    view = None if camera is None else camera.T_world_camera
    look = {"shadows": options.shadows, "floor": options.floor, "lights": options.lights}
    env.save_html(path, motion, fps=options.fps, camera=view, background=options.background, notes=notes, **look)
    print(f"wrote {os.path.abspath(path)} ({motion.duration:g} s; any browser plays it)")


def write_video(path: str, env: Environment, motion: BodyMotion, shot: Shot) -> None:
    """Write a video of a motion, and report it."""
    count = number_of_frames(motion.duration, shot.fps)
    with progress(f"drawing {path}", count) as advance:
        write_frames(path, draw_frames(env, motion, shot), shot.fps, on_frame=advance)
    explain_rays(env, shot.form)
    frames = f"{count} frames of {shot.form.width}x{shot.form.height} by {env.renderer.backend(shot.form)}"
    print(f"wrote {os.path.abspath(path)} ({motion.duration:g} s, {frames})")
    explain_shadows(env, shot.form)


def render(options: argparse.Namespace) -> int:
    """Draw a picture of a model, or write a page that moves its joints."""
    is_page = known_suffix(options.output, [PAGE, *STILL_FORMATS]) == PAGE
    (check_file if is_page else check_picture)(options.output)
    camera = None if options.camera is None else read_camera(options.camera)
    env = load_model(options)
    robot, (width, height) = named_robot(env, options.robot), options.size
    if options.q is not None:
        moved = moving_robot(env, options.robot)
        moved.SetDOFValues(_checked_values("--q", options.q, moved))
    if camera is None and robot is not None:
        camera = three_quarter_view(*shown_sphere(env, robot), width / height)
    matrix = None if camera is None else camera.T_world_camera
    if is_page:
        look = {"shadows": options.shadows, "floor": options.floor, "lights": options.lights}
        env.save_html(options.output, robot=robot, camera=matrix, background=options.background, **look)
        print(f"wrote {options.output} (any browser shows it, with a slider for each joint)")
        return 0
    write_picture(options.output, picture_of(options, env, matrix))
    explain_rays(env, Format(width, height, options.shadows is not False))
    print(f"wrote {options.output}")
    explain_nothing(env, matrix, Format(width, height, shadows=False))
    return 0


def explain_nothing(env: Environment, camera: ArrayLike | None, form: Format) -> None:
    """Warn that a picture shows no body."""
    view = env.default_camera(form.aspect) if camera is None else Camera.from_matrix(camera)
    if (env.renderer.segment(view, form) < 0).all():
        shapes = any(link.GetGeometries() for body in env.GetBodies() for link in body.GetLinks())
        reason = "turn the camera" if shapes else "the model has no shapes"
        print(f"ravemj: nothing is in view: {reason}", file=sys.stderr)


def explain_rays(env: Environment, form: Format) -> None:
    """Explain how to install OpenGL if a picture was ray-cast because it is missing."""
    if env.renderer.backend(form) == RAY and requested_backend() is None:
        print(f"ravemj: no OpenGL here, so rays drew the picture; faster: {remedy('egl')}", file=sys.stderr)


def explain_shadows(env: Environment, form: Format) -> None:
    """Explain why a video has no shadows, unless the user has chosen this."""
    if form.shadows is None and env.renderer.backend(form) != RAY and not env.renderer.has_shadows(form):
        print("no shadows, as OpenGL draws with the processor here; --shadows draws them")


def doctor(options: argparse.Namespace) -> int:
    """List the renderers that work on this machine, and how to install the others."""
    import mujoco  # noqa: PLC0415 - behind the modules that prepare it

    del options
    print(f"Python {platform.python_version()}, MuJoCo {mujoco.mj_versionString()}, {platform.platform()}")
    print(f"display: {'yes' if has_display() else 'none, so viewers have no window'}\n")
    rows = table("Rendering", "backend", "works", "why", "to install")
    for report in probe_backends():
        rows.add_row(
            report.name, "yes" if report.works else "no", report.detail, "" if report.works else report.install
        )
    console().print(rows)
    return 0

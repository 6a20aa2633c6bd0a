"""The command ``view``."""

import argparse
import contextlib
import os
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ravemj.cli.models import hold_bases, load_model, named_robot, shown_sphere
from ravemj.cli.reloading import Reloader
from ravemj.core.signals import signals_delayed, signals_raised
from ravemj.graphics.rendering import three_quarter_view
from ravemj.graphics.rendering.style import LookChoices
from ravemj.gui.viewers import Viewer, has_display
from ravemj.gui.viewers.window import WindowViewer
from ravemj.rave import Environment, Robot

if TYPE_CHECKING:
    from ravemj.gui.viewers.web import WebViewer

Worker: TypeAlias = "Callable[[WindowViewer | WebViewer], Callable[[], None]]"
"""Function of a viewer that returns another function, which is called periodically while the viewer is open."""

_LOOK = 0.1
"""Period of checks for changed files [s]."""

_TIMESTEP = 0.01
"""Time step of physics [s]."""

_ASPECT = 4 / 3
"""Aspect ratio (width / height) of the view for which the camera is placed."""


def view(options: argparse.Namespace) -> int:
    """Show a model until its window is closed, or its page is stopped by Ctrl-C."""
    env = load_model(options)
    show(env, named_robot(env, options.robot), options, lambda viewer: Reloader(env, viewer, options).update, _LOOK)
    return 0


def show(
    env: Environment,
    robot: Robot | None,
    options: argparse.Namespace,
    worker: Worker,
    period: float,
) -> None:
    """Show an environment in a window or a page until it is closed.

    Args:
        env: The environment; it is destroyed at the end.
        robot: The robot to look at; None: everything.
        options: The options of the command.
        worker: Called once with the viewer; returns the function to call periodically.
        period: Period of the calls [s].
    """
    try:
        window = None if options.web or not has_display() else _open_window(env, robot, options)
        if window is None:
            _serve(env, robot, options, worker, period)
        else:
            work = worker(window)
            with signals_raised():  # so that files being saved are completed
                _run_until_closed(window, work, period)
    finally:
        env.Destroy()


def _open_window(env: Environment, robot: Robot | None, options: argparse.Namespace) -> WindowViewer | None:
    """Open a window; return None if OpenGL is not available for it."""
    env.SetViewer("window")
    viewer = env.GetViewer()
    if not isinstance(viewer, WindowViewer):
        return None
    _arrange(viewer, env, robot, options)
    return viewer


def _arrange(viewer: Viewer, env: Environment, robot: Robot | None, options: argparse.Namespace) -> None:
    """Set title, selection and look, and start physics if requested.

    The camera shows ``robot`` obliquely. Without robot, the file's camera is kept; if there is none, the camera shows
    everything.
    """
    viewer.SetTitle(f"{os.path.basename(options.model)} - ravemj")
    if robot is not None or env.renderer.file_camera() is None:
        center, radius = shown_sphere(env, robot)
        camera = three_quarter_view(center, radius, _ASPECT)
        viewer.SetCamera(camera.T_world_camera, float(np.linalg.norm(center - camera.position)))
    if robot is not None:
        viewer.interaction.choose(robot.simulation_state)
    viewer.choose_look(LookChoices(options.shadows, options.floor, options.lights))
    if options.physics:
        hold_bases(env)
        env.SetPhysicsEngine("mujoco")
        env.StartSimulation(_TIMESTEP)


def _serve(
    env: Environment,
    robot: Robot | None,
    options: argparse.Namespace,
    worker: Worker,
    period: float,
) -> None:
    """Serve the web viewer, print its address, and wait for Ctrl-C."""
    from ravemj.gui.viewers.web.server import is_local  # noqa: PLC0415 - websockets is slow to import

    viewer = env.serve_viewer(options.host, options.port, options.token, options.embed)
    _arrange(viewer, env, robot, options)
    if not is_local(options.host):
        print(
            "ravemj: warning: browsers of other machines can come here; whoever knows the address sees and moves "
            "everything, adds models, and writes videos into this folder; nothing is encrypted on the way, so whoever "
            "listens there knows the address, too",
            file=sys.stderr,
        )
    work = worker(viewer)
    with contextlib.suppress(KeyboardInterrupt), signals_raised():  # so that pages show that it has ended
        print(viewer.url, flush=True)
        _run_until_closed(viewer, work, period)


def _run_until_closed(viewer: "WindowViewer | WebViewer", work: Callable[[], None], period: float) -> None:
    """Call ``work`` every ``period`` seconds until the viewer is closed."""
    while viewer.is_open:
        time.sleep(period)
        with signals_delayed():
            work()

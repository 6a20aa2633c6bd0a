"""The command ``view``."""

import argparse
import contextlib
import os
import sys
import time
from typing import TYPE_CHECKING

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

_LOOK = 0.1
"""Time between two checks for changed files and for a closed viewer [s]."""

_TIMESTEP = 0.01
"""Time of a step of physics [s]."""

_ASPECT = 4 / 3
"""Width of a view divided by its height."""


def view(options: argparse.Namespace) -> int:
    """Show a model until its window is closed, or its page is ended by Ctrl-C."""
    env = load_model(options)
    robot = named_robot(env, options.robot)
    try:
        window = None if options.web or not has_display() else _open_window(env, robot, options)
        if window is None:
            _serve(env, robot, options)
        else:
            reloader = Reloader(env, window, options)
            with signals_raised():  # so that what is being saved gets complete
                _attend(window, reloader)
    finally:
        env.Destroy()
    return 0


def _open_window(env: Environment, robot: Robot | None, options: argparse.Namespace) -> WindowViewer | None:
    """Open a window; None where there is no OpenGL for it."""
    env.SetViewer("window")
    viewer = env.GetViewer()
    if not isinstance(viewer, WindowViewer):
        return None
    _arrange(viewer, env, robot, options)
    return viewer


def _arrange(viewer: Viewer, env: Environment, robot: Robot | None, options: argparse.Namespace) -> None:
    """Show the name of the model, and from a corner the robot, or everything if the file has no camera."""
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


def _serve(env: Environment, robot: Robot | None, options: argparse.Namespace) -> None:
    """Serve the page, print its address, and wait for Ctrl-C, which is how it ends."""
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
    reloader = Reloader(env, viewer, options)
    with contextlib.suppress(KeyboardInterrupt), signals_raised():  # so that pages learn that it has ended
        print(viewer.url, flush=True)
        _attend(viewer, reloader)


def _attend(viewer: "WindowViewer | WebViewer", reloader: Reloader) -> None:
    """Wait until a viewer is closed; meanwhile read the model again when that is asked for."""
    while viewer.is_open:
        time.sleep(_LOOK)
        with signals_delayed():
            reloader.look()

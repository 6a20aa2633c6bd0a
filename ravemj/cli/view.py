"""The command ``view``."""

import argparse
import contextlib
import os
import sys
import time
from typing import TYPE_CHECKING

import numpy as np

from ravemj.cli.models import hold_bases, load_model
from ravemj.cli.reloading import Reloader
from ravemj.core.signals import signals_delayed, signals_raised
from ravemj.gui.viewers import Viewer, has_display
from ravemj.gui.viewers.window import WindowViewer
from ravemj.rave import Environment

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
    try:
        window = None if options.web or not has_display() else _open_window(env, options)
        if window is None:
            _serve(env, options)
        else:
            reloader = Reloader(env, window, options.model, watches=options.watch)
            with signals_raised():  # so that what is being saved gets complete
                _attend(window, reloader)
    finally:
        env.Destroy()
    return 0


def _open_window(env: Environment, options: argparse.Namespace) -> WindowViewer | None:
    """Open a window; None where there is no OpenGL for it."""
    env.SetViewer("window")
    viewer = env.GetViewer()
    if not isinstance(viewer, WindowViewer):
        return None
    _arrange(env, viewer, options)
    return viewer


def _arrange(env: Environment, viewer: Viewer, options: argparse.Namespace) -> None:
    """Show the name of the model, the floor, and everything from a corner where the file has no camera."""
    viewer.SetTitle(f"{os.path.basename(options.model)} - ravemj")
    if env.renderer.file_camera() is None:
        camera = env.renderer.camera_for_stills(_ASPECT)
        center, _ = env.renderer.bounding_sphere()
        viewer.SetCamera(camera.T_world_camera, float(np.linalg.norm(center - camera.position)))
    viewer.interaction.controls.display.shown |= {"floor"}
    if options.physics:
        hold_bases(env)
        env.SetPhysicsEngine("mujoco")
        env.StartSimulation(_TIMESTEP)


def _serve(env: Environment, options: argparse.Namespace) -> None:
    """Serve the page, print its address, and wait for Ctrl-C, which is how it ends."""
    from ravemj.gui.viewers.web.server import is_local  # noqa: PLC0415 - websockets is slow to import

    viewer = env.serve_viewer(options.host, options.port, options.token, options.embed)
    _arrange(env, viewer, options)
    if not is_local(options.host):
        print(
            "ravemj: warning: browsers of other machines can come here; whoever knows the address sees and moves "
            "everything, adds models, and writes videos into this folder; nothing is encrypted on the way, so whoever "
            "listens there knows the address, too",
            file=sys.stderr,
        )
    reloader = Reloader(env, viewer, options.model, watches=options.watch)
    with contextlib.suppress(KeyboardInterrupt), signals_raised():  # so that pages learn that it has ended
        print(viewer.url, flush=True)
        _attend(viewer, reloader)


def _attend(viewer: "WindowViewer | WebViewer", reloader: Reloader) -> None:
    """Wait until a viewer is closed; meanwhile read the model again when that is asked for."""
    while viewer.is_open:
        time.sleep(_LOOK)
        with signals_delayed():
            reloader.look()

"""The command ``view``."""

import argparse
import sys

from ravemj.cli.models import load_model
from ravemj.gui.viewers import Viewer, has_display
from ravemj.gui.viewers.window import WindowViewer
from ravemj.rave import Environment


def view(options: argparse.Namespace) -> int:
    """Show a model until its window is closed, or the command is interrupted."""
    env = load_model(options)
    try:
        viewer = None if options.web or not has_display() else _open_window(env)
        if viewer is None:
            viewer = _serve(env, options.host, options.port)
        viewer.main()
    finally:
        env.Destroy()
    return 0


def _open_window(env: Environment) -> WindowViewer | None:
    """Open a window; None where there is no OpenGL for it."""
    env.SetViewer("window")
    viewer = env.GetViewer()
    return viewer if isinstance(viewer, WindowViewer) else None


def _serve(env: Environment, host: str, port: int) -> Viewer:
    """Serve the page and print its address."""
    from ravemj.gui.viewers.web.server import is_local  # noqa: PLC0415 - websockets is slow to import

    viewer = env.serve_viewer(host, port)
    if not is_local(host):
        print(
            "ravemj: warning: browsers of other machines can come here; whoever knows the address sees and moves "
            "everything, and nothing is encrypted on the way",
            file=sys.stderr,
        )
    print(viewer.url, flush=True)
    return viewer

"""The command ``view``."""

import argparse
import contextlib
import sys

from ravemj.cli.models import load_model
from ravemj.core.signals import signals_raised
from ravemj.gui.viewers import has_display
from ravemj.gui.viewers.window import WindowViewer
from ravemj.rave import Environment


def view(options: argparse.Namespace) -> int:
    """Show a model until its window is closed, or its page is ended by Ctrl-C."""
    env = load_model(options)
    try:
        window = None if options.web or not has_display() else _open_window(env)
        if window is None:
            _serve(env, options.host, options.port)
        else:
            with signals_raised():  # so that what is being saved gets complete
                window.main()
    finally:
        env.Destroy()
    return 0


def _open_window(env: Environment) -> WindowViewer | None:
    """Open a window; None where there is no OpenGL for it."""
    env.SetViewer("window")
    viewer = env.GetViewer()
    return viewer if isinstance(viewer, WindowViewer) else None


def _serve(env: Environment, host: str, port: int) -> None:
    """Serve the page, print its address, and wait for Ctrl-C, which is how it ends."""
    from ravemj.gui.viewers.web.server import is_local  # noqa: PLC0415 - websockets is slow to import

    viewer = env.serve_viewer(host, port)
    if not is_local(host):
        print(
            "ravemj: warning: browsers of other machines can come here; whoever knows the address sees and moves "
            "everything, and nothing is encrypted on the way",
            file=sys.stderr,
        )
    with contextlib.suppress(KeyboardInterrupt), signals_raised():  # so that pages learn that it has ended
        print(viewer.url, flush=True)
        viewer.main()

"""Viewers of a simulation: in a window, in a browser, or offscreen.

The methods in ``CamelCase`` are OpenRAVE's.
"""

import logging
import os
import sys

from ravemj.engine.simulation import Simulation
from ravemj.errors import RenderingError
from ravemj.graphics.simulation_renderer import SimulationRenderer
from ravemj.gui.viewers import notebook
from ravemj.gui.viewers.viewer import Viewer

__all__ = ["VIEWERS", "Viewer", "has_display", "open_viewer"]

VIEWERS = ("window", "web", "qtcoin", "qtosg", "qtogre", "offscreen")
"""Names of viewers: ravemj's own, and OpenRAVE's, which scripts for OpenRAVE use."""

_LOG = logging.getLogger("ravemj")


def has_display() -> bool:
    """Return whether a window can be opened in this process."""
    if sys.platform == "darwin":  # GLFW requires the main thread on macOS
        return False
    return sys.platform == "win32" or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def open_viewer(simulation: Simulation, renderer: SimulationRenderer, name: str, show: bool) -> Viewer | None:
    """Open a viewer by a name of ``VIEWERS``; its kind is logged.

    ``window``, ``web`` (a page in a browser) and ``offscreen`` select this kind; OpenRAVE's names select the best kind
    that works on this machine. For an unknown name, an error is logged and None is returned.
    """
    if name not in VIEWERS:
        _LOG.error("there is no viewer '%s'; the viewers are: %s", name, ", ".join(VIEWERS))
        return None
    kind, reason = _choice(name) if show else ("offscreen", "")
    if kind == "web":
        if reason:
            _LOG.info("viewer '%s' is a page in a browser: %s", name, reason)
        return _open_page(simulation, renderer, name)
    if kind == "window":
        from ravemj.gui.viewers.window import WindowViewer  # noqa: PLC0415 - slow to import

        try:
            viewer = WindowViewer(simulation, renderer, name)
        except RenderingError as error:
            _LOG.warning("%s; pictures are drawn without a window", error)
        else:
            _LOG.info("viewer '%s' is a window", name)
            return viewer
    elif name == "window" and show:
        _LOG.warning("no window can be opened: %s; pictures are drawn without a window", reason)
    _LOG.info("viewer '%s' has no window", name)
    return Viewer(simulation, renderer, name)


def _choice(name: str) -> tuple[str, str]:
    """Return the kind of viewer to open for a name, and the reason if another kind was requested."""
    if name in ("web", "offscreen"):
        return name, ""
    if has_display():
        return "window", ""
    if sys.platform == "darwin":
        return "web", "windows would need the main thread on macOS"
    if name != "window" and notebook.in_notebook():
        return "web", "this is a notebook, and there is no display"
    return "offscreen", "there is no display"


def _open_page(simulation: Simulation, renderer: SimulationRenderer, name: str) -> Viewer:
    from ravemj.gui.viewers.web import WebViewer  # noqa: PLC0415 - websockets is slow to import

    return WebViewer(simulation, renderer, name, any_name=notebook.is_proxied())

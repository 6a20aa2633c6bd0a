"""A viewer in a browser: it sends pictures or geometry to pages and receives their input events."""

from ravemj.gui.viewers.web.viewer import WebViewer

__all__ = ["WebViewer"]

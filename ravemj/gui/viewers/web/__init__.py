"""A viewer in a browser: pictures drawn here, mouse and keys from there."""

from ravemj.gui.viewers.web.viewer import WebViewer

__all__ = ["WebViewer"]

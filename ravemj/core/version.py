"""The version of ravemj."""

__version__ = "0.1.0"

"""Base classes of OpenRAVE's that reload themselves; here they are plain classes.

>>> from openravepy import metaclass
>>> class Model(metaclass.AutoReloader):
...     pass
"""


class InstanceTracker:
    """A base class of old scripts; instances are not tracked."""


class AutoReloader(InstanceTracker):
    """A base class of old scripts; ``%autoreload`` of IPython reloads modules instead."""

"""Base classes of OpenRAVE's that reload themselves; here they are plain classes.

>>> from openravepy import metaclass
>>> class Model(metaclass.AutoReloader):
...     pass
"""


class InstanceTracker:
    """A class that is derived from in old scripts; instances are not tracked."""


class AutoReloader(InstanceTracker):
    """A class that is derived from in old scripts; ``%autoreload`` of IPython does what its name says."""

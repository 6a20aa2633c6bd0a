"""Base classes of OpenRAVE's that reload themselves; here they are plain classes.

>>> from openravepy import metaclass
>>> class Model(metaclass.AutoReloader):
...     pass
"""


class MetaInstanceTracker(type):
    """A metaclass of old scripts; instances are not tracked."""

    def __init__(cls, name: str, bases: tuple[type, ...], ns: dict[str, object]) -> None:
        super().__init__(name, bases, ns)


class MetaAutoReloader(MetaInstanceTracker):
    """A metaclass of old scripts; classes are not reloaded."""


class InstanceTracker:
    """A base class of old scripts; instances are not tracked."""


class AutoReloader(InstanceTracker):
    """A base class of old scripts; ``%autoreload`` of IPython reloads modules instead."""

    def change_class(self, new_class: type) -> None:
        """Make the object one of another class.

        Args:
            new_class: The class.
        """
        self.__class__ = new_class

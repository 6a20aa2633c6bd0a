"""OpenRAVE's self-reloading base classes; here they are plain classes.

>>> from openravepy import metaclass
>>> class Model(metaclass.AutoReloader):
...     pass
"""


class MetaInstanceTracker(type):
    """Metaclass of old scripts; instances are not tracked."""

    def __init__(cls, name: str, bases: tuple[type, ...], ns: dict[str, object]) -> None:
        super().__init__(name, bases, ns)


class MetaAutoReloader(MetaInstanceTracker):
    """Metaclass of old scripts; classes are not reloaded."""


class InstanceTracker:
    """Base class of old scripts; instances are not tracked."""


class AutoReloader(InstanceTracker):
    """Base class of old scripts; IPython's ``%autoreload`` reloads modules instead."""

    def change_class(self, new_class: type) -> None:
        """Change the class of the object.

        Args:
            new_class: The class.
        """
        self.__class__ = new_class

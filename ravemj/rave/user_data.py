"""User data: objects that scripts attach to bodies, other interfaces and environments."""

# ruff: noqa: D417 - the functions are methods of classes that have no base in common, and take self

from typing import Any, Protocol


class Annotations:
    """The description and the user data of one object."""

    def __init__(self) -> None:
        self.description = ""
        self.data: dict[str, Any] = {}


class Annotated(Protocol):
    """An object with annotations: an environment or an interface. The functions below are its methods."""

    annotations: Annotations


def SetUserData(self: Annotated, key: Any = "", data: Any = ...) -> None:  # noqa: ANN401 - any object of the user's
    """Attach an object of the user: ``SetUserData(data)`` or ``SetUserData(key, data)``.

    The object lives as long as what it is attached to. ``GetUserData`` returns it.

    Args:
        key: The name; or the object itself, if it is the only argument.
        data: The object.
    """
    name, attached = ("", key) if data is ... else (key, data)
    self.annotations.data[str(name)] = attached


def GetUserData(self: Annotated, key: str = "") -> Any:  # noqa: ANN401 - any object of the user's
    """Return the object that ``SetUserData`` attached under the name ``key``, or None."""
    return self.annotations.data.get(key)


def RemoveUserData(self: Annotated, key: str = "") -> bool:
    """Remove the object that is attached under the name ``key``, and return whether there was one."""
    return self.annotations.data.pop(key, None) is not None

"""What users attach to objects of an environment, and to the environment itself."""

# ruff: noqa: D417 - the functions are methods of classes that have no base in common, and take self

from typing import Any, Protocol


class Annotations:
    """What users attach to an object: a description and data of their own, under names."""

    def __init__(self) -> None:
        self.description = ""
        self.data: dict[str, Any] = {}


class Annotated(Protocol):
    """What keeps annotations: an environment, or an object of one, of which the functions below are methods."""

    annotations: Annotations


def SetUserData(self: Annotated, key: Any = "", data: Any = ...) -> None:  # noqa: ANN401 - any object of the user's
    """Attach an object of your own: ``SetUserData(data)`` or ``SetUserData(key, data)``.

    It stays as long as this one does. ``GetUserData`` returns it.

    Args:
        key: The name, or the object where it is the only argument.
        data: The object.
    """
    name, attached = ("", key) if data is ... else (key, data)
    self.annotations.data[str(name)] = attached


def GetUserData(self: Annotated, key: str = "") -> Any:  # noqa: ANN401 - any object of the user's
    """Return what ``SetUserData`` attached under that name, or None.

    Args:
        key: The name; left out: the one without a name.
    """
    return self.annotations.data.get(key)


def RemoveUserData(self: Annotated, key: str = "") -> bool:
    """Forget what is attached under a name; return whether there was something.

    Args:
        key: The name; left out: the one without a name.
    """
    return self.annotations.data.pop(key, None) is not None

"""User data: objects that scripts attach to bodies, other interfaces and environments."""

from typing import Any

from ravemj.core.api_object import ApiObject


class Annotations:
    """The description and the user data of one object."""

    def __init__(self) -> None:
        self.description = ""
        self.data: dict[str, Any] = {}


class UserData(ApiObject):
    """The methods of objects that store user data."""

    _annotations: Annotations

    def SetUserData(self, key: Any = "", data: Any = ...) -> None:  # noqa: ANN401 - any object of the user's
        """Attach an object of the user: ``SetUserData(data)`` or ``SetUserData(key, data)``.

        The object lives as long as what it is attached to. ``GetUserData`` returns it.

        Args:
            key: The name; or the object itself, if it is the only argument.
            data: The object.
        """
        name, attached = ("", key) if data is ... else (key, data)
        self._annotations.data[str(name)] = attached

    def GetUserData(self, key: str = "") -> Any:  # noqa: ANN401 - any object of the user's
        """Return the object that ``SetUserData`` attached under a name, or None.

        Args:
            key: The name; without one, the object that has no name.
        """
        return self._annotations.data.get(key)

    def RemoveUserData(self, key: str = "") -> bool:
        """Remove the object that is attached under a name, and return whether there was one.

        Args:
            key: The name; without one, the object that has no name.
        """
        return self._annotations.data.pop(key, None) is not None

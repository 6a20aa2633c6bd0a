"""What users attach to objects of an environment, and to the environment itself."""

from typing import Any

from ravemj.core.api_object import ApiObject


class Annotations:
    """What users attach to an object: a description and data of their own, under names."""

    def __init__(self) -> None:
        self.description = ""
        self.data: dict[str, Any] = {}


class UserData(ApiObject):
    """Keeps data of users."""

    _annotations: Annotations

    def SetUserData(self, key: Any = "", data: Any = ...) -> None:  # noqa: ANN401 - any object of the user's
        """Attach an object of your own: ``SetUserData(data)`` or ``SetUserData(key, data)``.

        It stays as long as the body does. ``GetUserData`` returns it.

        Args:
            key: The name, or the object where it is the only argument.
            data: The object.
        """
        name, attached = ("", key) if data is ... else (key, data)
        self._annotations.data[str(name)] = attached

    def GetUserData(self, key: str = "") -> Any:  # noqa: ANN401 - any object of the user's
        """Return what ``SetUserData`` attached under that name, or None.

        Args:
            key: The name; left out: the one without a name.
        """
        return self._annotations.data.get(key)

    def RemoveUserData(self, key: str = "") -> bool:
        """Forget what is attached under a name; return whether there was something.

        Args:
            key: The name; left out: the one without a name.
        """
        return self._annotations.data.pop(key, None) is not None

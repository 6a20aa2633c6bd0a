"""Things that users keep with objects."""

from typing import overload


class UserData:
    """Keeps what users give it, under names."""

    def __init__(self) -> None:
        self._user_data: dict[str, object] = {}

    @overload
    def SetUserData(self, key: object, /) -> None: ...
    @overload
    def SetUserData(self, key: str, data: object, /) -> None: ...
    def SetUserData(self, key: object, *data: object) -> None:
        """Keep something: ``SetUserData(thing)``, or ``SetUserData(name, thing)`` for more than one."""
        if data:
            self._user_data[str(key)] = data[0]
        else:
            self._user_data[""] = key

    def GetUserData(self, key: str = "") -> object:
        """Return what was kept under that name, or None."""
        return self._user_data.get(key)

    def RemoveUserData(self, key: str = "") -> bool:
        """Forget what was kept under that name; return whether there was anything."""
        return self._user_data.pop(key, None) is not None

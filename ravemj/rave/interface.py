"""The base class of all objects of an environment."""

from collections.abc import Callable, Mapping
from copy import copy
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

from ravemj.core.arguments import checked_kind
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.enums import InterfaceType
from ravemj.rave.env.base import EnvironmentPart
from ravemj.rave.readables import ReadableInterface
from ravemj.rave.user_data import Annotations, GetUserData, RemoveUserData, SetUserData

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


Command = Callable[[str], str | None]
"""What runs a command: takes its arguments as text, and returns the answer, or None if it failed."""


class Interface(ReadableInterface):
    """An object of an environment: a body, a controller, a physics engine, a trajectory, ...

    OpenRAVE calls them interfaces, since its plugins make them.
    """

    _internal = ("annotations",)
    annotations: Annotations
    _env: "Environment"
    _interface_type: InterfaceType
    _commands: ClassVar[Mapping[str, Callable[[Any, str], str]]] = {}

    def GetEnv(self) -> "Environment":
        """Return the environment that the object was made for, also before it is added.

        Example:
            >>> robot.GetEnv() == env
            True
        """
        return self._env

    def GetInterfaceType(self) -> InterfaceType:
        """Return the kind of object."""
        return self._interface_type

    def GetXMLId(self) -> str:
        """Return OpenRAVE's name of the implementation, as it was spelt when the object was made."""
        return ""

    def GetPluginName(self) -> str:
        """Return where the implementation comes from."""
        return "ravemj"

    def GetDescription(self) -> str:
        """Return the text of ``SetDescription``."""
        return self.annotations.description

    def SetDescription(self, description: str) -> None:
        """Attach the text ``description``."""
        self.annotations.description = str(description)

    SetUserData = SetUserData
    GetUserData = GetUserData
    RemoveUserData = RemoveUserData

    def Clone(self, ref: Any, cloningoptions: int = 0) -> None:  # noqa: ANN401 - another object of its class
        """Take over the description and the data of users that another object of the same class has.

        Bodies, trajectories, collision checkers, physics engines and sensors take over what they are, too. A copy of a
        controller has no robot yet, one of a module was not started.

        Args:
            ref: The other object.
            cloningoptions: OpenRAVE's; ignored.
        """
        del cloningoptions
        checked_kind(ref, type(self), "Clone: ref")
        self.annotations = copy(ref.annotations)
        self.annotations.data = dict(ref.annotations.data)
        self._readables = ref.GetReadableInterfaces()

    def SupportsJSONCommand(self, cmd: str) -> bool:
        """Return whether ``SendJSONCommand`` knows the command ``cmd``: it knows none."""
        del cmd
        return False

    def SendJSONCommand(self, cmd: str, input: Any, releasegil: bool = False, lockenv: bool = False) -> Any:  # noqa: ANN401 - JSON
        """Refuse to return the answer to a command of OpenRAVE's plugins in JSON; there are none.

        Args:
            cmd: The name of the command.
            input: Its arguments.
            releasegil: Not used.
            lockenv: Not used.

        Raises:
            openrave_exception: always (``CommandNotSupported``).
        """
        message = f"{type(self).__name__} knows no JSON command '{cmd}'"
        raise RavemjError(message, ErrorCode.CommandNotSupported)

    def SupportsCommand(self, cmd: str) -> bool:
        """Return whether ``SendCommand`` knows the command ``cmd``; upper and lower case are the same."""
        return cmd.lower() in {"help", *map(str.lower, self._known_commands())}

    def SendCommand(self, cmd: str, releasegil: bool = False, lockenv: bool = False) -> str | None:
        """Run a command of OpenRAVE's plugins by its text.

        Args:
            cmd: The name of the command, and behind a blank its arguments. ``help`` lists the commands.
            releasegil: Not used.
            lockenv: Not used.

        Returns:
            Its answer; None if it failed.

        Raises:
            openrave_exception: ``cmd`` is empty, or the arguments are wrong (``InvalidArguments``); the command is not
                known (``CommandNotSupported``).
        """
        del releasegil, lockenv
        name, *arguments = checked_kind(cmd, str, "SendCommand: cmd", "a text").split(maxsplit=1) or [""]
        if not name:
            raise ArgumentError("SendCommand: cmd is empty, and should be the name of a command")
        if name.lower() == "help":
            return self._help()
        commands = self._known_commands()
        for known, run in commands.items():
            if known.lower() == name.lower():
                return run(" ".join(arguments))
        message = f"{self.GetXMLId() or type(self).__name__} knows no command '{name}', only "
        raise RavemjError(message + ", ".join(["help", *commands]), ErrorCode.CommandNotSupported)

    def _known_commands(self) -> Mapping[str, Command]:
        """Return what runs the commands, by their names."""
        return {name: partial(run, self) for name, run in self._commands.items()}

    def _help(self) -> str:
        return "\n".join(["help", *self._commands])


def checked_environment(env: "Environment", caller: str) -> "Environment":
    """Return the environment that a user gave.

    Raises:
        ArgumentError: it is something else.
    """
    if not isinstance(env, EnvironmentPart):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise ArgumentError(f"{caller}: env is {env!r}, and should be an Environment")
    return env

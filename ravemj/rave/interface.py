"""The base class of all objects of an environment, and modules."""

# ruff: noqa: D417 - the functions become methods of classes without a common base, and take self

import inspect
from collections.abc import Callable, Mapping
from copy import copy
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, cast

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.engine.simulation import Simulation
from ravemj.errors import ArgumentError, Diagnostic, ErrorCode, RavemjError, Source, UnsupportedError
from ravemj.graphics.simulation_renderer import SimulationRenderer
from ravemj.rave.enums import InterfaceType

if TYPE_CHECKING:
    from ravemj.gui.viewers import Viewer
    from ravemj.rave.environment import Environment


class Annotations:
    """Description and user data of one object."""

    def __init__(self) -> None:
        self.description = ""
        self.data: dict[str, Any] = {}


class Annotated(Protocol):
    """Protocol of objects with annotations: environments and interfaces. The functions below become its methods."""

    annotations: Annotations


def SetUserData(self: Annotated, key: Any = "", data: Any = ...) -> None:  # noqa: ANN401 - any object of the user's
    """Attach an object of the user: ``SetUserData(data)`` or ``SetUserData(key, data)``.

    This environment or interface keeps the object alive. ``GetUserData`` returns it.

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
    """Remove the object attached under the name ``key``, and return whether it existed."""
    return self.annotations.data.pop(key, None) is not None


class Readable(ApiObject):
    """Value with an id; ``stringreaders.CreateStringReadable`` makes one from a string."""

    def __init__(self, id: str, data: Any = "") -> None:  # noqa: ANN401 - what JSON can hold
        self._id = str(id)
        self._data = data

    def GetXMLId(self) -> str:
        """Return the id."""
        return self._id

    def SerializeXML(self, options: int = 0) -> str:
        """Return the value as an XML element whose tag is the id; ``options`` has no effect."""
        from xml.sax.saxutils import escape  # noqa: PLC0415 - imports urllib, which is slow

        del options
        return f"<{self._id}>{escape(str(self._data))}</{self._id}>"

    def SerializeJSON(self, unitScale: float = 1.0, options: int = 0) -> Any:  # noqa: ANN401 - what JSON can hold
        """Return the value.

        Args:
            unitScale: Not used.
            options: Not used.
        """
        del unitScale, options
        return self._data

    def DeserializeJSON(self, obj: Any, unitScale: float = 1.0) -> None:  # noqa: ANN401 - what JSON can hold
        """Set the value.

        Args:
            obj: The value.
            unitScale: Not used.
        """
        del unitScale
        self._data = obj

    def __repr__(self) -> str:
        return f"stringreaders.CreateStringReadable({self._id!r}, {self._data!r})"


class ReadableInterface(ApiObject):
    """Base class of objects with values under ids."""

    _readables: dict[str, Readable] | None = None

    def GetReadableInterface(self, id: str) -> Readable | None:
        """Return the value under ``id``, or None."""
        return (self._readables or {}).get(id)

    def GetReadableInterfaces(self) -> dict[str, Readable]:
        """Return all values by id."""
        return dict(self._readables or {})

    def SetReadableInterface(self, id: str, readable: Readable | None) -> None:
        """Attach a value.

        Args:
            id: The id.
            readable: The value; None removes the value of that id.
        """
        kept = {key: entry for key, entry in (self._readables or {}).items() if key != id}
        self._readables = kept if readable is None else kept | {id: readable}


class stringreaders:  # noqa: N801 - OpenRAVE's name
    """Constructors of readables: named values that are stored with a body or another interface."""

    @staticmethod
    def CreateStringReadable(id: str, data: str) -> Readable:
        """Return a string as a readable value.

        Args:
            id: The id.
            data: The string.
        """
        return Readable(id, str(data))


class xmlreaders:  # noqa: N801 - OpenRAVE's name
    """The constructors of ``stringreaders`` under OpenRAVE's older names."""

    @staticmethod
    def CreateStringXMLReadable(xmlid: str, data: str) -> Readable:
        """Return a string as a readable value.

        Args:
            xmlid: The id.
            data: The string.
        """
        return Readable(xmlid, str(data))


class SerializableData(ApiObject):
    """String that scripts attach and read back.

    Args:
        data: The text.
    """

    def __init__(self, data: str = "") -> None:
        self._data = data

    def Serialize(self, options: int = 0) -> str:
        """Return the text; ``options`` has no effect."""
        del options
        return self._data

    def Deserialize(self, data: str) -> None:
        """Set the text to ``data``."""
        self._data = data

    def Close(self) -> None:
        """Clear the text."""
        self._data = ""

    close = Close


class EnvironmentPart(ApiObject):
    """Base class of the mixins of ``Environment``, with their shared state."""

    def __init__(self) -> None:
        self._simulation = Simulation()
        self._renderer = SimulationRenderer(self._simulation)
        self._viewers: list[Viewer] = []
        self._found: dict[Diagnostic, None] = {}  # ordered sets: loading a file again adds nothing
        self._files: dict[str, Source | None] = {}
        self._unread = ""  # why the last Read… gave None
        self._is_destroyed = False

    @property
    def _environment(self) -> "Environment":
        return cast("Environment", self)

    def _check_alive(self) -> None:
        if self._is_destroyed:
            raise RavemjError(f"{self!r} is destroyed; make a new Environment", ErrorCode.InvalidState)

    @property
    def _viewer(self) -> "Viewer | None":
        """The first viewer, which ``GetViewer`` returns, or None."""
        return self._viewers[0] if self._viewers else None


Command = Callable[[str], str | None]
"""Handler of a command: takes the arguments as text, and returns the answer, or None on failure."""


class Interface(ReadableInterface):
    """Base class of the objects of an environment: bodies, controllers, physics engines, trajectories, ...

    OpenRAVE calls them interfaces, since plugins provide them.
    """

    _internal = ("annotations",)
    _interface_type: InterfaceType
    _xmlid = ""
    _commands: ClassVar[Mapping[str, Callable[[Any, str], str]]] = {}

    def __init__(self, env: "Environment", xmlid: str) -> None:
        self._env = env
        self._xmlid = xmlid
        self.annotations = Annotations()

    def GetEnv(self) -> "Environment":
        """Return the environment for which the object was made, even before it is added.

        Example:
            >>> robot.GetEnv() == env
            True
        """
        return self._env

    def GetInterfaceType(self) -> InterfaceType:
        """Return the kind of object."""
        return self._interface_type

    def GetXMLId(self) -> str:
        """Return OpenRAVE's name of the implementation, as it was spelled when the object was made."""
        return self._xmlid

    def GetPluginName(self) -> str:
        """Return the name of the plugin that provides the implementation."""
        return "ravemj"

    def GetDescription(self) -> str:
        """Return the text of ``SetDescription``."""
        return self.annotations.description

    def SetDescription(self, description: str) -> None:
        """Set ``description``, free text."""
        self.annotations.description = str(description)

    SetUserData = SetUserData
    GetUserData = GetUserData
    RemoveUserData = RemoveUserData

    def Clone(self, ref: Any, cloningoptions: int = 0) -> None:  # noqa: ANN401 - another object of its class
        """Copy the description and the user data of another object of the same class.

        Bodies, trajectories, collision checkers, physics engines and sensors also copy their content. A copy of a
        controller has no robot, and a copy of a module is not started.

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
        """Return False: ``SendJSONCommand`` knows no command ``cmd``."""
        del cmd
        return False

    def SendJSONCommand(self, cmd: str, input: Any, releasegil: bool = False, lockenv: bool = False) -> Any:  # noqa: ANN401 - JSON
        """Return no answer, but raise an error: OpenRAVE plugins' JSON commands are not supported.

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
        """Return whether ``SendCommand`` knows the command ``cmd``, in any letter case."""
        return cmd.lower() in {"help", *map(str.lower, self._known_commands())}

    def SendCommand(self, cmd: str, releasegil: bool = False, lockenv: bool = False) -> str | None:
        """Run a text command of an OpenRAVE plugin.

        Args:
            cmd: The name of the command, a space, and its arguments. ``help`` lists the commands.
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
        return {name: partial(run, self) for name, run in self._commands.items()}

    def _help(self) -> str:
        return "\n".join(["help", *self._commands])


def asked_for(env: "Environment", name: str, caller: str, missing: Mapping[str, str] = {}) -> list[str]:
    """Split the name given to a ``RaveCreate…`` function into words: the type, then its arguments.

    Args:
        env: The environment.
        name: The name; if it is empty, the type is an empty string.
        caller: The function.
        missing: OpenRAVE's types that ravemj lacks, in lower case, with the missing feature.

    Raises:
        ArgumentError: the environment is not an ``Environment``, or the name is not a string.
        UnsupportedError: the type is not supported.
    """
    checked_environment(env, caller)
    words = checked_kind(name, str, f"{caller}: name", "a text").split() or [""]
    if words[0].lower() in missing:
        raise UnsupportedError(f"{caller.removeprefix('RaveCreate').lower()} '{words[0]}'", missing[words[0].lower()])
    return words


def checked_environment(env: "Environment", caller: str) -> "Environment":
    """Return the environment that a user passed, after a type check.

    Raises:
        ArgumentError: it is not an ``Environment``.
    """
    if not isinstance(env, EnvironmentPart):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise ArgumentError(f"{caller}: env is {env!r}, and should be an Environment")
    return env


class Module(Interface):
    """Base class of objects that execute commands; ``RaveCreateModule`` makes modules.

    Args:
        env: The environment.
        xmlid: The name of the module.
        start: Called with the arguments of ``env.Add`` when the module is added.
        commands: The functions that execute commands, by the names of the commands.

    Example:
        >>> module = RaveCreateModule(env, "BaseManipulation")
        >>> env.Add(module, True, robot.GetName())
        >>> module.SendCommand("MoveActiveJoints goal 0.1 0.2 execute 0 outputtraj")[:12]
        '<trajectory '
    """

    _interface_type = InterfaceType.module
    _internal = ("end", "start")

    def __init__(
        self, env: "Environment", xmlid: str, start: Callable[[str], None], commands: Mapping[str, Command]
    ) -> None:
        super().__init__(env, xmlid)
        self.start = start
        self._by_name = commands

    def Destroy(self) -> None:
        """Remove the module from the environment."""
        self._env.Remove(self)

    def end(self) -> None:
        """End the module's work. The environment calls this when it removes the module."""

    def SimulationStep(self, timeelapsed: float) -> bool:
        """Advance by ``timeelapsed`` [s] and return whether anything was done; ``env.StepSimulation`` calls this."""
        del timeelapsed
        return False

    def _known_commands(self) -> Mapping[str, Command]:
        return self._by_name

    def _help(self) -> str:
        entries = {"help": "List the commands.", **{name: _purpose(command) for name, command in self._by_name.items()}}
        return "\n".join(f"\n{name}\n{'~' * len(name)}\n\n{purpose}\n" for name, purpose in entries.items())


def _purpose(command: Command) -> str:
    return (inspect.getdoc(command) or "").partition("\n")[0]

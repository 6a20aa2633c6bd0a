"""Modules: objects of an environment that take commands."""

import inspect
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from ravemj.rave.enums import InterfaceType
from ravemj.rave.interface import Command, Interface
from ravemj.rave.user_data import Annotations

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class Module(Interface):
    """An object that takes commands; ``RaveCreateModule`` makes it.

    Args:
        env: The environment.
        xmlid: The name of the module.
        start: Called with the arguments with which the module is added.
        commands: What runs commands, by their names.

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
        self._env = env
        self._xmlid = xmlid
        self.annotations = Annotations()
        self.start = start
        self._by_name = commands

    def GetXMLId(self) -> str:
        """Return the name of the module, as it was spelled when it was made."""
        return self._xmlid

    def Destroy(self) -> None:
        """Take the module out of the environment."""
        self._env.Remove(self)

    def end(self) -> None:
        """End what the module does; the environment calls this when it removes it."""

    def SimulationStep(self, timeelapsed: float) -> bool:
        """Take note that simulation time has passed; ``env.StepSimulation`` calls this for modules that were added.

        Args:
            timeelapsed: How long [s].

        Returns:
            Whether something was done.
        """
        del timeelapsed
        return False

    def _known_commands(self) -> Mapping[str, Command]:
        return self._by_name

    def _help(self) -> str:
        entries = {"help": "Lists the commands.", **{name: _purpose(one) for name, one in self._by_name.items()}}
        return "\n".join(f"\n{name}\n{'~' * len(name)}\n\n{purpose}\n" for name, purpose in entries.items())


def _purpose(command: Command) -> str:
    return (inspect.getdoc(command) or "").partition("\n")[0]

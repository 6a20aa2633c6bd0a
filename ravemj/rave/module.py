"""Modules: objects of an environment that execute commands."""

import inspect
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from ravemj.rave.enums import InterfaceType
from ravemj.rave.interface import Command, Interface

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class Module(Interface):
    """An object that executes commands. ``RaveCreateModule`` makes modules.

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
        """End the work of the module. The environment calls this when it removes the module."""

    def SimulationStep(self, timeelapsed: float) -> bool:
        """Advance by ``timeelapsed`` [s] and return whether anything was done; ``env.StepSimulation`` calls this."""
        del timeelapsed
        return False

    def _known_commands(self) -> Mapping[str, Command]:
        return self._by_name

    def _help(self) -> str:
        entries = {"help": "Lists the commands.", **{name: _purpose(one) for name, one in self._by_name.items()}}
        return "\n".join(f"\n{name}\n{'~' * len(name)}\n\n{purpose}\n" for name, purpose in entries.items())


def _purpose(command: Command) -> str:
    return (inspect.getdoc(command) or "").partition("\n")[0]

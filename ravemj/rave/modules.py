"""Modules: objects that take commands as text."""

from typing import TYPE_CHECKING

from ravemj.rave.enums import InterfaceType
from ravemj.rave.interface import Annotations, Interface

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class Module(Interface):
    """Takes commands as text; ``RaveCreateModule`` makes it, ``env.Add`` starts it."""

    _interface_type = InterfaceType.module
    _internal = ("begin",)

    def __init__(self, env: "Environment", name: str) -> None:
        self._env = env
        self._annotations = Annotations()
        self._name = name

    def GetXMLId(self) -> str:
        """Return the name of the module, as it was spelt when it was made."""
        return self._name

    def begin(self, args: str) -> int:
        """Begin; return 0, which stands for success.

        Args:
            args: What ``env.AddModule`` was given.
        """
        del args
        return 0

    def SimulationStep(self, timeelapsed: float) -> bool:
        """Take note that simulation time has passed; ``env.StepSimulation`` calls this for modules that were added.

        Args:
            timeelapsed: How long [s].

        Returns:
            Whether something was done.
        """
        del timeelapsed
        return False

    def Destroy(self) -> None:
        """End what the module does."""

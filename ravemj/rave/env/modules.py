"""Modules: programs of OpenRAVE's plugins, of which ravemj has none."""

from ravemj.errors import ArgumentError
from ravemj.rave.env.base import EnvironmentPart


class Modules(EnvironmentPart):
    """Takes no modules, and says so."""

    def AddModule(self, module: object, args: str = "") -> int:
        """Refuse a module: there is none, since ``RaveCreateModule`` makes none; it never returns.

        Args:
            module: What ``RaveCreateModule`` returned.
            args: What the module starts with.

        Raises:
            openrave_exception: always.
        """
        del args
        if module is None:
            message = "module is None, as RaveCreateModule returns for names that no plugin has"
        else:
            message = f"module is a {type(module).__name__}, and should be what RaveCreateModule returned"
        raise ArgumentError(f"AddModule: {message}")

    LoadProblem = AddModule

    def GetModules(self) -> list[object]:
        """Return the modules that were added: none."""
        return []

    GetLoadedProblems = GetModules

    def RemoveProblem(self, module: object) -> bool:
        """Remove a module; the older name of ``Remove``.

        Returns:
            False: it was not there.
        """
        return self._environment.Remove(module)

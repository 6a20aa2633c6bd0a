"""Base class of the helpers."""

import weakref
from collections.abc import Iterable
from typing import Any, TypeVar

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.transforms import Floats
from ravemj.rave.environment import Environment
from ravemj.rave.interface import Module
from ravemj.rave.modules.base_manipulation import Manipulation
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.serialization import AS_TEXT

Thing = TypeVar("Thing")


class Helper(ApiObject):
    """Planning helper of one robot; its module stays in the environment as long as the helper exists.

    Attributes:
        prob: The module, which offers the helper's methods as text commands.
        robot: The robot.
        args: Arguments of the module.
    """

    def __init__(
        self,
        robot: Robot,
        plannername: str | None,
        maxvelmult: float | None,
        module: Module,
        manipulation: Manipulation,
    ) -> None:
        self.robot = checked_kind(robot, Robot, "robot")
        self.prob, self._manipulation = module, manipulation
        words = [robot.GetName(), *(["planner", plannername] if plannername else [])]
        self.args = " ".join([*words, *(["maxvelmult", f"{maxvelmult:.15e}"] if maxvelmult is not None else [])])
        env: Environment = robot.GetEnv()
        env.Add(module, True, self.args)
        manipulation.choose(robot.GetName())
        weakref.finalize(self, env.Remove, module).atexit = False

    def SetRobot(self, robot: Robot) -> bool:
        """Set another robot.

        Args:
            robot: The robot.
        """
        self.robot = checked_kind(robot, Robot, "robot")
        return self._manipulation.choose(robot.GetName())

    def clone(self, envother: Environment) -> Any:  # noqa: ANN401 - of the same class
        """Return a helper of this class for the robot of the same name in another environment.

        Args:
            envother: The environment.
        """
        robot = envother.GetRobot(self.robot.GetName())
        return type(self)(robot)  # pyright: ignore - the classes take a robot

    Clone = clone

    def _done(
        self,
        traj: Trajectory,
        execute: bool | None,
        outputtraj: bool | None,
        outputtrajobj: bool | None,
        reply: str = "",
    ) -> Trajectory | str:
        """Execute a motion unless ``execute`` is False; return it as trajectory or text if requested, else ``reply``.

        The reply is that of OpenRAVE's module: an empty string, or "1" for motions to tool poses; never None.
        """
        if execute is None or execute:
            self._manipulation.execute(traj)
        if outputtrajobj:
            return traj
        return traj.serialize(AS_TEXT).decode() if outputtraj else reply

    def _pair(
        self,
        motion: tuple[Floats, Trajectory],
        execute: bool | None,
        outputtraj: bool | None,
        outputfinal: bool | None,
        outputtrajobj: bool | None,
    ) -> tuple[Floats | None, Trajectory | str | None]:
        """Execute a motion unless ``execute`` is False; return final values and motion, each None if not requested."""
        final, traj = motion
        return final if outputfinal else None, self._done(traj, execute, outputtraj, outputtrajobj) or None


def given(**options: Any) -> dict[str, Any]:  # noqa: ANN401 - options of any kind
    """Return the options that are not None."""
    return {name: value for name, value in options.items() if value is not None}


def several(values: Iterable[Thing] | None, name: str) -> list[Thing]:
    """Convert an option to a list; None becomes an empty list.

    Raises:
        ArgumentError: the option is not iterable.
    """
    if values is None:
        return []
    checked_kind(values, Iterable, name, "a list")
    return list(values)

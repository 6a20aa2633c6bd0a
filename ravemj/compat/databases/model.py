"""What all models of ``openravepy.databases`` have in common."""

from typing import ClassVar, NoReturn

from ravemj.compat.refusal import lacking
from ravemj.core.signatures import show_as_written
from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.rave.environment import Environment
from ravemj.rave.robot import Robot

_BUILDING = "building of databases"


@lacking(
    _BUILDING,
    """
    autogenerateparams(options) generate(*arguments **named) generatepcg() getfilename(read) getversion()
    preprocess() show(options) @CreateOptionParser(useManipulator)
    @InitializeFromParser(Model parser env args robotatts defaultviewer allowkinbody)
    @RunFromParser(Model parser env args robotatts defaultviewer allowkinbody **named)
    """,
)
class DatabaseGenerator:
    """A model that is computed once for a robot.

    Args:
        robot: The robot; its active manipulator is the model's.
        arguments: What models of OpenRAVE's take besides.
        named: The same, by name.
    """

    capability: ClassVar[str] = _BUILDING
    """What ravemj lacks to compute it."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        show_as_written(cls)

    def __init__(self, robot: Robot, *arguments: object, **named: object) -> None:
        del arguments, named
        self.robot = robot
        self.manip = robot.GetActiveManipulator()

    @property
    def env(self) -> Environment:
        """The robot's environment."""
        return self.robot.GetEnv()

    def load(self) -> bool:
        """Return whether there is something to use: False."""
        return False

    def has(self) -> bool:
        """Return whether there is something to use."""
        return self.load()

    def autogenerate(self, options: object = None) -> None:
        """Compute the model.

        Raises:
            UnsupportedError: ravemj lacks what that takes; ``capability`` says what.
        """
        raise UnsupportedError(f"{type(self).__name__}.autogenerate", self.capability)

    def save(self, params: object = None) -> None:
        """Refuse to write what is not there.

        Raises:
            UnsupportedError: ravemj lacks what computing the model takes.
        """
        raise UnsupportedError(f"{type(self).__name__}.save", self.capability)

    def clone(self, envother: Environment) -> "DatabaseGenerator":
        """Return the model for the robot of the same name in another environment."""
        robot = envother.GetRobot(self.robot.GetName())
        if robot is None:
            raise ArgumentError(f"clone: envother has no robot '{self.robot.GetName()}'")
        return type(self)(robot)

    def __getattr__(self, name: str) -> NoReturn:
        """Say what is missing, for all other methods that OpenRAVE's model has."""
        if name.startswith("_"):
            raise AttributeError(name)
        raise UnsupportedError(f"{type(self).__name__}.{name}", self.capability)

"""Base class of the models of ``openravepy.databases``."""

from typing import ClassVar, NoReturn

from ravemj.compat.refusal import lacking
from ravemj.core.api_object import published
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
    """Model that is precomputed for a robot.

    Args:
        robot: The robot; its active manipulator is the model's.
        arguments: Further arguments of OpenRAVE's models.
        named: Further arguments by name.
    """

    capability: ClassVar[str] = _BUILDING
    """Name of the missing capability, for the error that ravemj cannot compute the model."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        published(cls, __name__)

    def __init__(self, robot: Robot, *arguments: object, **named: object) -> None:
        del arguments, named
        self.robot = robot
        self.manip = robot.GetActiveManipulator()

    @property
    def env(self) -> Environment:
        """The robot's environment."""
        return self.robot.GetEnv()

    def load(self) -> bool:
        """Return False: no data is stored."""
        return False

    def has(self) -> bool:
        """Return whether the model has data."""
        return self.load()

    def autogenerate(self, options: object = None) -> None:
        """Compute the model.

        Raises:
            UnsupportedError: ravemj cannot compute it; see ``capability``.
        """
        raise UnsupportedError(f"{type(self).__name__}.autogenerate", self.capability)

    def save(self, params: object = None) -> None:
        """Raise an error, since there is no data.

        Raises:
            UnsupportedError: always; ravemj cannot compute the model.
        """
        raise UnsupportedError(f"{type(self).__name__}.save", self.capability)

    def clone(self, envother: Environment) -> "DatabaseGenerator":
        """Return the model for the robot of the same name in another environment."""
        robot = envother.GetRobot(self.robot.GetName())
        if robot is None:
            raise ArgumentError(f"clone: envother has no robot '{self.robot.GetName()}'")
        return type(self)(robot)

    def __getattr__(self, name: str) -> NoReturn:
        """Raise an error with the missing capability, for all other methods of OpenRAVE's model."""
        if name.startswith("_"):
            raise AttributeError(name)
        raise UnsupportedError(f"{type(self).__name__}.{name}", self.capability)


published(DatabaseGenerator, __name__)

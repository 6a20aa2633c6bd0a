"""What all models of ``openravepy.databases`` have in common."""

from collections.abc import Callable, Mapping
from inspect import Parameter, Signature
from typing import ClassVar, NoReturn, TypeVar

from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.rave.environment import Environment
from ravemj.rave.robot import Robot

_BUILDING = "building of databases"


def refusing(name: str, capability: str, arguments: str) -> Callable[..., NoReturn]:
    """Return a function that says what is missing.

    Args:
        name: What users call it.
        capability: What ravemj lacks.
        arguments: The names of its arguments, which completion shows; ``*`` and ``**`` before a name take the rest.
    """

    def refuse(*given: object, **named: object) -> NoReturn:
        raise UnsupportedError(name, capability)

    kinds = {0: Parameter.POSITIONAL_OR_KEYWORD, 1: Parameter.VAR_POSITIONAL, 2: Parameter.VAR_KEYWORD}
    shown = [Parameter(word.lstrip("*"), kinds[word.count("*")]) for word in arguments.split()]
    vars(refuse).update(__signature__=Signature(shown), capability=capability)
    refuse.__name__, refuse.__qualname__ = name.rpartition(".")[2], name
    refuse.__doc__ = f"Raise ``UnsupportedError``: ravemj has no {capability} yet."
    return refuse


Model = TypeVar("Model", bound="DatabaseGenerator")


def lacking(
    capability: str, methods: Mapping[str, str], static: Mapping[str, str] | None = None
) -> Callable[[type[Model]], type[Model]]:
    """Give a class the methods of OpenRAVE's model that need what ravemj lacks; each raises ``UnsupportedError``.

    Args:
        capability: What ravemj lacks.
        methods: The names of their arguments behind ``self``, by the methods' names; see ``refusing``.
        static: The same of static methods.
    """

    def complete(model: type[Model]) -> type[Model]:
        model.capability = capability
        for name, arguments in methods.items():
            setattr(model, name, refusing(f"{model.__name__}.{name}", capability, f"self {arguments}"))
        for name, arguments in (static or {}).items():
            setattr(model, name, staticmethod(refusing(f"{model.__name__}.{name}", capability, arguments)))
        return model

    return complete


_PARSER = "parser env args robotatts defaultviewer allowkinbody"


@lacking(
    _BUILDING,
    {
        "autogenerateparams": "options",
        "generate": "*arguments **named",
        "generatepcg": "",
        "getfilename": "read",
        "getversion": "",
        "preprocess": "",
        "show": "options",
    },
    static={
        "CreateOptionParser": "useManipulator",
        "InitializeFromParser": f"Model {_PARSER}",
        "RunFromParser": f"Model {_PARSER} **named",
    },
)
class DatabaseGenerator:
    """A model that is computed once for a robot.

    Args:
        robot: The robot; its active manipulator is the model's.
        arguments: What models of OpenRAVE's take besides.
        named: The same, by name.
    """

    capability: ClassVar[str]
    """What ravemj lacks to compute it."""

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

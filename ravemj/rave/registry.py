"""OpenRAVE's functions that make bodies and trajectories."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.model.scene import KinBody as SceneBody
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.collision import RaveCreateCollisionChecker
from ravemj.rave.controllers import RaveCreateController
from ravemj.rave.enums import InterfaceType
from ravemj.rave.environment import Environment
from ravemj.rave.iksolver import RaveCreateIkSolver
from ravemj.rave.interface import Interface, asked_for
from ravemj.rave.kinbody import KinBody
from ravemj.rave.modules import MODULES, RaveCreateModule
from ravemj.rave.physics import RaveCreatePhysicsEngine
from ravemj.rave.planning import RaveCreatePlanner
from ravemj.rave.planning.names import PLANNERS
from ravemj.rave.robot import Robot
from ravemj.rave.samplers import SAMPLERS, RaveCreateSpaceSampler
from ravemj.rave.sensors import KIND_NAMES, RaveCreateSensor
from ravemj.rave.trajectory import KIND, Trajectory

if TYPE_CHECKING:
    from ravemj.gui.viewers import Viewer


def RaveCreateKinBody(env: Environment, name: str = "") -> KinBody | None:
    """Make a body without links; ``InitFromBoxes`` and the like fill it, ``env.Add`` adds it.

    Args:
        env: The environment that it is for.
        name: OpenRAVE's name of the kind of body, which is empty.

    Returns:
        The body; None for an unknown kind.

    Example:
        >>> body = ravemj.RaveCreateKinBody(env, "")
        >>> body.InitFromBoxes([[0, 0, 0, 0.1, 0.2, 0.3]])
        True
        >>> body.SetName("box")
        >>> env.Add(body)
    """
    return None if asked_for(env, name, "RaveCreateKinBody")[0] else _empty(env, is_robot=False)


def RaveCreateRobot(env: Environment, name: str = "") -> Robot | None:
    """Make a robot without links; see ``RaveCreateKinBody``.

    Args:
        env: The environment that it is for.
        name: OpenRAVE's name of the kind of robot: empty or ``GenericRobot``.

    Returns:
        The robot; None for an unknown kind.
    """
    kind = asked_for(env, name, "RaveCreateRobot")[0].lower()
    robot = _empty(env, is_robot=True) if kind in {"", "genericrobot"} else None
    return robot if isinstance(robot, Robot) else None


def _empty(env: Environment, *, is_robot: bool) -> KinBody:
    scene = SceneBody(name="", is_robot=is_robot, links=(), joints=(), passive_joints=(), source=FROM_SCRIPT)
    return env.wrap(env.simulation.create(scene))


def RaveCreateTrajectory(env: Environment, name: str = "") -> Trajectory | None:
    """Make a trajectory.

    Args:
        env: The environment with the robots that the trajectory may refer to.
        name: ``GenericTrajectory``, the only type, in any letter case; empty: that one.

    Returns:
        The trajectory, or None where there is no such type.

    Example:
        >>> trajectory = RaveCreateTrajectory(env, "")
        >>> trajectory.Init(robot.GetConfigurationSpecification("linear"))
    """
    xmlid = asked_for(env, name, "RaveCreateTrajectory")[0] or KIND
    return Trajectory(env, xmlid) if xmlid.lower() == KIND.lower() else None


SENSOR_SYSTEMS = "sensor systems"


class PluginInfo(ApiObject):
    """A plugin of OpenRAVE; ravemj has none.

    Attributes:
        interfacenames: The kind and the name of each interface that the plugin makes.
        version: Its version.
    """

    interfacenames: tuple[tuple[InterfaceType, str], ...] = ()
    version = ""


class SensorSystem(Interface):
    """A source of measured poses for bodies; ravemj has none."""

    _interface_type = InterfaceType.sensorsystem

    def __init__(self, *args: object, **kwargs: object) -> None:
        raise UnsupportedError("SensorSystem", SENSOR_SYSTEMS)


class ManageData(ApiObject):
    """The data of a sensor system about a body. ravemj has none, so ``body.GetManageData()`` is None."""

    def __init__(self, *args: object, **kwargs: object) -> None:
        raise UnsupportedError("ManageData", SENSOR_SYSTEMS)

    def GetSystem(self) -> NoReturn:
        """Refuse to return anything, since there is no sensor system."""
        raise UnsupportedError("ManageData", SENSOR_SYSTEMS)

    GetData = GetOffsetLink = IsPresent = IsEnabled = IsLocked = GetSystem

    def Lock(self, dolock: bool) -> NoReturn:
        """Refuse to return anything, since there is no sensor system; ``dolock`` is not used."""
        raise UnsupportedError("ManageData.Lock", SENSOR_SYSTEMS)


def RaveCreateSensorSystem(env: Environment, name: str) -> None:
    """Refuse to make a sensor system.

    Args:
        env: The environment.
        name: Its name.

    Raises:
        UnsupportedError: always.
    """
    raise UnsupportedError(f"sensor system '{name}'", SENSOR_SYSTEMS)


def RaveCreateViewer(env: Environment, name: str) -> "Viewer | None":
    """Attach another viewer to the environment; ``env.Remove`` closes it.

    Args:
        env: The environment.
        name: A name of ``env.SetViewer``.

    Returns:
        The viewer; None for an unknown name.
    """
    kind = asked_for(env, name, "RaveCreateViewer")[0].lower()
    return env.open_viewer(kind, show=True) if kind in _viewer_names() else None


def _viewer_names() -> list[str]:
    from ravemj.gui.viewers import VIEWERS  # noqa: PLC0415 - slow to import

    return list(VIEWERS)


_MAKERS: dict[InterfaceType, tuple[Callable[["Environment", str], object], Sequence[str]]] = {
    InterfaceType.collisionchecker: (RaveCreateCollisionChecker, ("ode", "bullet", "fcl_", "pqp")),
    InterfaceType.controller: (RaveCreateController, ("IdealController", "IdealVelocityController", "odevelocity")),
    InterfaceType.iksolver: (RaveCreateIkSolver, ("ikfast",)),
    InterfaceType.kinbody: (RaveCreateKinBody, ("",)),
    InterfaceType.module: (RaveCreateModule, MODULES),
    InterfaceType.physicsengine: (RaveCreatePhysicsEngine, ("GenericPhysicsEngine", "ode", "bullet", "mujoco")),
    InterfaceType.planner: (RaveCreatePlanner, tuple(PLANNERS)),
    InterfaceType.robot: (RaveCreateRobot, ("GenericRobot",)),
    InterfaceType.sensor: (RaveCreateSensor, KIND_NAMES),
    InterfaceType.sensorsystem: (RaveCreateSensorSystem, ()),
    InterfaceType.spacesampler: (RaveCreateSpaceSampler, SAMPLERS),
    InterfaceType.trajectory: (RaveCreateTrajectory, ("GenericTrajectory",)),
    InterfaceType.viewer: (RaveCreateViewer, ()),
}
"""The function that makes each kind of interface, and the names that it knows; viewers are asked for theirs."""


def RaveGetLoadedInterfaces() -> dict[InterfaceType, list[str]]:
    """Return the names that the ``RaveCreate…`` function of each kind of interface knows."""
    names = {kind: list(known) for kind, (_, known) in _MAKERS.items()}
    return {kind: names.get(kind, []) for kind in InterfaceType} | {InterfaceType.viewer: _viewer_names()}


def RaveHasInterface(type: InterfaceType, name: str) -> bool:  # OpenRAVE's names of the arguments
    """Return whether ``RaveCreateInterface`` makes something of a kind and name.

    Args:
        type: The kind.
        name: The name; letter case does not matter.
    """
    known = RaveGetLoadedInterfaces()[InterfaceType(type)]
    return checked_kind(name, str, "RaveHasInterface: name", "a text").lower() in {one.lower() for one in known}


def RaveCreateInterface(env: Environment, type: InterfaceType, name: str) -> Any:  # noqa: ANN401 - of any kind
    """Make an object of any kind: a body, a controller, a trajectory, ...

    Args:
        env: The environment.
        type: The kind.
        name: The name, as the ``RaveCreate…`` function of that kind takes it.

    Returns:
        The object; None for an unknown name.

    Example:
        >>> trajectory = ravemj.RaveCreateInterface(env, ravemj.InterfaceType.trajectory, "")
    """
    return _MAKERS[InterfaceType(type)][0](env, name)


def RaveClone(ref: Interface, cloningoptions: int = 0, cloneenv: Environment | None = None) -> Any:  # noqa: ANN401 - of the same kind
    """Return a copy of an interface, which is not added to the environment.

    The copy has the same kind and name, and the state that its ``Clone`` copies.

    Args:
        ref: The interface.
        cloningoptions: Not used.
        cloneenv: The environment of the copy; by default that of ``ref``.

    Raises:
        openrave_exception: no function makes an interface of this kind and name.

    Example:
        >>> copy = ravemj.RaveClone(robot, 0)
        >>> copy.SetName("twin")
        >>> env.Add(copy)
    """
    env = checked_kind(ref, Interface, "RaveClone: ref").GetEnv() if cloneenv is None else cloneenv
    copy = RaveCreateInterface(env, ref.GetInterfaceType(), ref.GetXMLId())
    if copy is None:
        raise ArgumentError(f"RaveClone: nothing makes another {type(ref).__name__} '{ref.GetXMLId()}'")
    copy.Clone(ref, cloningoptions)
    return copy

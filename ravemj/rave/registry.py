"""OpenRAVE's factory functions of bodies, trajectories and viewers."""

import logging
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.geometry_functions.ik_types import GOAL_TYPES
from ravemj.model.scene import KinBody as SceneBody
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.collision import RaveCreateCollisionChecker
from ravemj.rave.controllers import CONTROLLERS, RaveCreateController
from ravemj.rave.enums import InterfaceType
from ravemj.rave.environment import Environment
from ravemj.rave.iksolver import IkSolver
from ravemj.rave.interface import Interface, asked_for
from ravemj.rave.kinbody import KinBody
from ravemj.rave.modules import MODULES, RaveCreateModule
from ravemj.rave.physics import RaveCreatePhysicsEngine
from ravemj.rave.planning import RaveCreatePlanner
from ravemj.rave.planning.names import PLANNERS
from ravemj.rave.robot import Robot
from ravemj.rave.samplers import SAMPLERS, RaveCreateSpaceSampler
from ravemj.rave.sensors import KIND_NAMES, RaveCreateSensor
from ravemj.rave.solver_names import numbers_in
from ravemj.rave.trajectory import KIND, Trajectory

if TYPE_CHECKING:
    from ravemj.gui.viewers import Viewer

_LOG = logging.getLogger("ravemj")


def RaveCreateKinBody(env: Environment, name: str = "") -> KinBody | None:
    """Make a body without links; ``InitFromBoxes`` and similar methods fill it, ``env.Add`` adds it.

    Args:
        env: The environment of the body.
        name: OpenRAVE's type of body; only the empty string is known.

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


def RaveCreateIkSolver(env: Environment, name: str) -> IkSolver | None:
    """Make an IK solver; ``manip.SetIkSolver`` assigns it to an arm.

    Args:
        env: The environment.
        name: ``ikfast``, the goal type, and optionally the steps of free joints [rad or m], for example
            ``ikfast Transform6D 0.05``. A name from ``InverseKinematicsModel.getikname`` contains the goal type.

    Returns:
        The solver; None with a logged warning if the name contains no goal type.

    Raises:
        UnsupportedError: no solver supports goals of that type.

    Example:
        >>> solver = RaveCreateIkSolver(env, "ikfast Translation3D")
        >>> manip.SetIkSolver(solver)
        True
    """
    words = asked_for(env, name, "RaveCreateIkSolver")
    if len(words) > 1 and words[0].lower() == "ikfast":
        kind = next((goal_type for goal_type in GOAL_TYPES if goal_type.name in words[1].split(".")), None)
        steps = numbers_in(words[2:])
        if kind is not None and steps is not None:
            return IkSolver(env, name, kind, steps=steps or None)
    _LOG.warning("there is no solver '%s': its name should be 'ikfast' and a type of goal, then steps", name)
    return None


def RaveCreateRobot(env: Environment, name: str = "") -> Robot | None:
    """Make a robot without links; see ``RaveCreateKinBody``.

    Args:
        env: The environment of the robot.
        name: OpenRAVE's type of robot: empty or ``GenericRobot``; ``CollisionMapRobot`` makes a plain robot and logs a
            warning.

    Returns:
        The robot; None for an unknown kind.
    """
    kind = asked_for(env, name, "RaveCreateRobot")[0].lower()
    if kind == "collisionmaprobot":
        _LOG.warning("RaveCreateRobot: '%s' is a plain robot here, without maps of collisions", name)
    robot = _empty(env, is_robot=True) if kind in {"", "genericrobot", "collisionmaprobot"} else None
    return robot if isinstance(robot, Robot) else None


def _empty(env: Environment, *, is_robot: bool) -> KinBody:
    scene = SceneBody(name="", is_robot=is_robot, links=(), joints=(), passive_joints=(), source=FROM_SCRIPT)
    return env.wrap(env.simulation.create(scene))


def RaveCreateTrajectory(env: Environment, name: str = "") -> Trajectory | None:
    """Make a trajectory.

    Args:
        env: The environment with the robots that the trajectory may refer to.
        name: ``GenericTrajectory``, the only type, in any letter case, or empty.

    Returns:
        The trajectory, or None for an unknown type.

    Example:
        >>> trajectory = RaveCreateTrajectory(env, "")
        >>> trajectory.Init(robot.GetConfigurationSpecification("linear"))
    """
    xmlid = asked_for(env, name, "RaveCreateTrajectory")[0] or KIND
    return Trajectory(env, xmlid) if xmlid.lower() == KIND.lower() else None


SENSOR_SYSTEMS = "sensor systems"


class PluginInfo(ApiObject):
    """Description of an OpenRAVE plugin; ravemj has none.

    Attributes:
        interfacenames: The kind and the name of each interface that the plugin makes.
        version: Its version.
    """

    interfacenames: tuple[tuple[InterfaceType, str], ...] = ()
    version = ""


class SensorSystem(Interface):
    """Source of measured body poses; ravemj has none."""

    _interface_type = InterfaceType.sensorsystem

    def __init__(self, *args: object, **kwargs: object) -> None:
        raise UnsupportedError("SensorSystem", SENSOR_SYSTEMS)


class ManageData(ApiObject):
    """Data of a sensor system about a body. ravemj has none, so ``body.GetManageData()`` is None."""

    def __init__(self, *args: object, **kwargs: object) -> None:
        raise UnsupportedError("ManageData", SENSOR_SYSTEMS)

    def GetSystem(self) -> NoReturn:
        """Return nothing: raise an error, since there is no sensor system."""
        raise UnsupportedError("ManageData", SENSOR_SYSTEMS)

    GetData = GetOffsetLink = IsPresent = IsEnabled = IsLocked = GetSystem

    def Lock(self, dolock: bool) -> NoReturn:
        """Return nothing: raise an error, since there is no sensor system; ``dolock`` is not used."""
        raise UnsupportedError("ManageData.Lock", SENSOR_SYSTEMS)


def RaveCreateSensorSystem(env: Environment, name: str) -> None:
    """Return None, as for a name that OpenRAVE does not know, and log a warning: sensor systems are not supported.

    Args:
        env: The environment.
        name: The name of the sensor system.
    """
    asked_for(env, name, "RaveCreateSensorSystem")
    _LOG.warning("there is no sensor system '%s': ravemj has none", name)


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
    InterfaceType.collisionchecker: (RaveCreateCollisionChecker, ("ode", "bullet", "fcl_", "pqp", "mujoco")),
    InterfaceType.controller: (RaveCreateController, CONTROLLERS),
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
"""Factory and known names of each interface type; `RaveGetLoadedInterfaces` determines the names of viewers."""


def RaveGetLoadedInterfaces() -> dict[InterfaceType, list[str]]:
    """Return the names that the ``RaveCreate…`` function of each interface type knows."""
    names = {kind: list(known) for kind, (_, known) in _MAKERS.items()}
    return {kind: names.get(kind, []) for kind in InterfaceType} | {InterfaceType.viewer: _viewer_names()}


def RaveHasInterface(type: InterfaceType, name: str) -> bool:  # OpenRAVE's names of the arguments
    """Return whether ``RaveCreateInterface`` supports a type and name.

    Args:
        type: The interface type.
        name: The name; letter case does not matter.
    """
    known = RaveGetLoadedInterfaces()[InterfaceType(type)]
    return checked_kind(name, str, "RaveHasInterface: name", "a text").lower() in {
        known_name.lower() for known_name in known
    }


def RaveCreateInterface(env: Environment, type: InterfaceType, name: str) -> Any:  # noqa: ANN401 - of any kind
    """Make an object of an interface type: a body, a controller, a trajectory, ...

    Args:
        env: The environment.
        type: The interface type.
        name: The name, the argument of the type's ``RaveCreate…`` function.

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
        openrave_exception: interfaces of this type and name cannot be made.

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

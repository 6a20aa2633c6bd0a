"""Interfaces by their kind: which there are, making one, copying one."""

from typing import TYPE_CHECKING, Any, NoReturn

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.errors import UnsupportedError
from ravemj.rave.collision import CollisionChecker, RaveCreateCollisionChecker
from ravemj.rave.controllers import RaveCreateController
from ravemj.rave.creation import RaveCreateKinBody, RaveCreateRobot, RaveCreateTrajectory
from ravemj.rave.enums import InterfaceType
from ravemj.rave.iksolver import RaveCreateIkSolver
from ravemj.rave.interface import Interface
from ravemj.rave.kinbody import KinBody
from ravemj.rave.physics import PhysicsEngine, RaveCreatePhysicsEngine
from ravemj.rave.planning import RaveCreatePlanner
from ravemj.rave.plugins import (
    RaveCreateModule,
    RaveCreateViewer,
    RaveGetLoadedInterfaces,
)
from ravemj.rave.samplers import RaveCreateSpaceSampler
from ravemj.rave.sensors import RaveCreateSensor, Sensor
from ravemj.rave.trajectory import Trajectory

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

SENSOR_SYSTEMS = "sensor systems"


class PluginInfo(ApiObject):
    """A plugin; there are none.

    Attributes:
        interfacenames: What it makes, a list of kind and name.
        version: Its version.
    """

    interfacenames: tuple[tuple[InterfaceType, str], ...] = ()
    version = ""


class SensorSystem(Interface):
    """Feeds bodies with measurements of the real world; there is none here."""

    _interface_type = InterfaceType.sensorsystem

    def __init__(self, *args: object, **kwargs: object) -> None:
        raise UnsupportedError("SensorSystem", SENSOR_SYSTEMS)


class ManageData(ApiObject):
    """What a sensor system keeps about a body; there is none here, and ``body.GetManageData()`` is None."""

    def __init__(self, *args: object, **kwargs: object) -> None:
        raise UnsupportedError("ManageData", SENSOR_SYSTEMS)

    def GetSystem(self) -> NoReturn:
        """Refuse to return the sensor system, as there is no sensor system."""
        raise UnsupportedError("ManageData.GetSystem", SENSOR_SYSTEMS)

    def GetData(self) -> NoReturn:
        """Refuse to return what was measured, as there is no sensor system."""
        raise UnsupportedError("ManageData.GetData", SENSOR_SYSTEMS)

    def GetOffsetLink(self) -> NoReturn:
        """Refuse to return the link that is measured, as there is no sensor system."""
        raise UnsupportedError("ManageData.GetOffsetLink", SENSOR_SYSTEMS)

    def IsPresent(self) -> NoReturn:
        """Refuse to return whether the body is seen, as there is no sensor system."""
        raise UnsupportedError("ManageData.IsPresent", SENSOR_SYSTEMS)

    def IsEnabled(self) -> NoReturn:
        """Refuse to return whether the body is followed, as there is no sensor system."""
        raise UnsupportedError("ManageData.IsEnabled", SENSOR_SYSTEMS)

    def IsLocked(self) -> NoReturn:
        """Refuse to return whether the body is kept, as there is no sensor system."""
        raise UnsupportedError("ManageData.IsLocked", SENSOR_SYSTEMS)

    def Lock(self, dolock: bool) -> NoReturn:
        """Refuse to return whether the body is kept now, as there is no sensor system.

        Args:
            dolock: Whether to keep it.
        """
        raise UnsupportedError("ManageData.Lock", SENSOR_SYSTEMS)


def RaveCreateSensorSystem(env: "Environment", name: str) -> None:
    """Refuse to make a sensor system.

    Args:
        env: The environment.
        name: Its name.

    Raises:
        UnsupportedError: always.
    """
    raise UnsupportedError(f"sensor system '{name}'", SENSOR_SYSTEMS)


_MAKERS = {
    InterfaceType.collisionchecker: RaveCreateCollisionChecker,
    InterfaceType.controller: RaveCreateController,
    InterfaceType.iksolver: RaveCreateIkSolver,
    InterfaceType.kinbody: RaveCreateKinBody,
    InterfaceType.module: RaveCreateModule,
    InterfaceType.physicsengine: RaveCreatePhysicsEngine,
    InterfaceType.planner: RaveCreatePlanner,
    InterfaceType.robot: RaveCreateRobot,
    InterfaceType.sensor: RaveCreateSensor,
    InterfaceType.sensorsystem: RaveCreateSensorSystem,
    InterfaceType.spacesampler: RaveCreateSpaceSampler,
    InterfaceType.trajectory: RaveCreateTrajectory,
    InterfaceType.viewer: RaveCreateViewer,
}


def RaveHasInterface(type: InterfaceType, name: str) -> bool:  # OpenRAVE's names of the arguments
    """Return whether ``RaveCreateInterface`` makes something of a kind and name.

    Args:
        type: The kind.
        name: The name; upper and lower case are the same.
    """
    known = RaveGetLoadedInterfaces()[InterfaceType(type)]
    return checked_kind(name, str, "RaveHasInterface: name", "a text").lower() in {one.lower() for one in known}


def RaveCreateInterface(env: "Environment", type: InterfaceType, name: str) -> Any:  # noqa: ANN401 - of any kind
    """Make an object of any kind: a body, a controller, a trajectory, ...

    Args:
        env: The environment that it is for.
        type: The kind.
        name: Its name, as ``RaveCreate…`` of that kind takes it.

    Returns:
        The object; None for an unknown name.

    Example:
        >>> trajectory = ravemj.RaveCreateInterface(env, ravemj.InterfaceType.trajectory, "")
    """
    return _MAKERS[InterfaceType(type)](env, name)


def RaveClone(ref: Interface, cloningoptions: int = 0, cloneenv: "Environment | None" = None) -> Any:  # noqa: ANN401 - of the same kind
    """Return a copy of a body, a sensor, a trajectory, a collision checker or a physics engine, which is not added.

    Args:
        ref: What to copy.
        cloningoptions: OpenRAVE's; ignored.
        cloneenv: The environment of the copy; None: that of ``ref``.

    Raises:
        UnsupportedError: it is something else.

    Example:
        >>> copy = ravemj.RaveClone(robot, 0)
        >>> copy.SetName("twin")
        >>> env.Add(copy)
    """
    env = checked_kind(ref, Interface, "RaveClone: ref").GetEnv() if cloneenv is None else cloneenv
    if isinstance(ref, PhysicsEngine):
        engine = RaveCreatePhysicsEngine(env, ref.GetXMLId())
        assert engine is not None
        engine.SetGravity(ref.GetGravity())
        return engine
    if isinstance(ref, CollisionChecker):
        checker = CollisionChecker(env, ref.GetXMLId())
        checker.SetCollisionOptions(ref.GetCollisionOptions())
        checker.SetTolerance(ref.GetTolerance())
        return checker
    if isinstance(ref, Trajectory):
        trajectory = RaveCreateTrajectory(env, ref.GetXMLId())
        assert trajectory is not None
        trajectory.Clone(ref, cloningoptions)
        return trajectory
    if isinstance(ref, KinBody):
        body = RaveCreateRobot(env) if ref.IsRobot() else RaveCreateKinBody(env)
        assert body is not None
        body.Clone(ref, cloningoptions)
        return body
    if isinstance(ref, Sensor):
        sensor = Sensor(env, ref.description)
        sensor.Clone(ref, cloningoptions)
        return sensor
    raise UnsupportedError(f"RaveClone of a {type(ref).__name__}", "copies of such objects")

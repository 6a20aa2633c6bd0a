"""Makes, lists and copies interfaces by kind and name."""

from typing import TYPE_CHECKING, Any, NoReturn

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.rave.collision import RaveCreateCollisionChecker
from ravemj.rave.controllers import RaveCreateController
from ravemj.rave.creation import RaveCreateKinBody, RaveCreateRobot, RaveCreateTrajectory
from ravemj.rave.enums import InterfaceType
from ravemj.rave.iksolver import RaveCreateIkSolver
from ravemj.rave.interface import Interface
from ravemj.rave.physics import RaveCreatePhysicsEngine
from ravemj.rave.planning import RaveCreatePlanner
from ravemj.rave.plugins import (
    RaveCreateModule,
    RaveCreateViewer,
    RaveGetLoadedInterfaces,
)
from ravemj.rave.samplers import RaveCreateSpaceSampler
from ravemj.rave.sensors import RaveCreateSensor

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

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
        name: The name; letter case does not matter.
    """
    known = RaveGetLoadedInterfaces()[InterfaceType(type)]
    return checked_kind(name, str, "RaveHasInterface: name", "a text").lower() in {one.lower() for one in known}


def RaveCreateInterface(env: "Environment", type: InterfaceType, name: str) -> Any:  # noqa: ANN401 - of any kind
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
    return _MAKERS[InterfaceType(type)](env, name)


def RaveClone(ref: Interface, cloningoptions: int = 0, cloneenv: "Environment | None" = None) -> Any:  # noqa: ANN401 - of the same kind
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

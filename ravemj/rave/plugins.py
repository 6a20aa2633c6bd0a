"""``RaveCreate…`` of what OpenRAVE's plugins provide and ravemj does not: None, or which capability is missing."""

import logging
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from ravemj.core.arguments import checked_kind
from ravemj.errors import UnsupportedError
from ravemj.geometry_functions.ik_parameterization import INVERSE_KINEMATICS
from ravemj.rave.enums import InterfaceType
from ravemj.rave.environment import Environment
from ravemj.rave.interface import checked_environment
from ravemj.rave.modules import Module
from ravemj.rave.planning import PLANNING, Planner
from ravemj.rave.samplers import SAMPLERS
from ravemj.rave.sensors import SENSING, Sensor

if TYPE_CHECKING:
    from ravemj.gui.viewers import Viewer

_GRASPING = "planning of grasps"

_LOG = logging.getLogger("ravemj")

MISSING: Mapping[InterfaceType, Mapping[str, str]] = MappingProxyType(
    {
        InterfaceType.planner: {
            "basicrrt": PLANNING,
            "birrt": PLANNING,
            "constraintparabolicsmoother": PLANNING,
            "cubictrajectoryretimer": PLANNING,
            "explorationrrt": PLANNING,
            "graspgradient": _GRASPING,
            "grasper": _GRASPING,
            "linearsmoother": PLANNING,
            "lineartrajectoryretimer": PLANNING,
            "parabolicsmoother": PLANNING,
            "parabolictrajectoryretimer": PLANNING,
            "ra*": PLANNING,
            "rastar": PLANNING,
            "shortcut_linear": PLANNING,
            "workspacetrajectorytracker": PLANNING,
        },
        InterfaceType.module: {
            "basemanipulation": PLANNING,
            "grasper": _GRASPING,
            "ikfast": INVERSE_KINEMATICS,
            "logging": "saving of scenes by a module",
            "taskcaging": PLANNING,
            "taskmanipulation": PLANNING,
            "visualfeedback": "visual feedback",
        },
        InterfaceType.iksolver: {
            "genericiksolver": INVERSE_KINEMATICS,
            "ikfast": INVERSE_KINEMATICS,
        },
        InterfaceType.sensor: {
            "basecamera": SENSING,
            "baseflashlidar3d": SENSING,
            "baseforce6d": SENSING,
            "baseimu": SENSING,
            "basejointencoder": SENSING,
            "baselaser2d": SENSING,
            "baseodometry": SENSING,
            "basetactile": SENSING,
        },
    }
)
"""Names of OpenRAVE's own plugins, in lower case, with what ravemj lacks to have them."""


def RaveCreateModule(env: Environment, name: str) -> Module | None:
    """Make a module, which takes commands; ``env.AddModule`` starts it.

    Args:
        env: The environment.
        name: ``viewerrecorder``, which writes videos.

    Returns:
        The module; None, as in OpenRAVE, where no plugin has one of that name; a warning is logged.

    Raises:
        UnsupportedError: the module is one of OpenRAVE's own.

    Example:
        >>> RaveCreateModule(env, "urdf") is None
        True
    """
    if checked_kind(name, str, "RaveCreateModule: name", "a text").lower() == "viewerrecorder":
        from ravemj.rave.viewer_recorder import ViewerRecorder  # noqa: PLC0415 - rarely wanted

        return ViewerRecorder(checked_environment(env, "RaveCreateModule"), name)
    return _refuse(env, InterfaceType.module, name)


RaveCreateProblem = RaveCreateModule


def RaveCreatePlanner(env: Environment, name: str) -> Planner | None:
    """Refuse to make a planner; return None where OpenRAVE does not know the name either.

    Args:
        env: The environment.
        name: The name.

    Raises:
        UnsupportedError: the planner is one of OpenRAVE's own.
    """
    return _refuse(env, InterfaceType.planner, name)


def RaveCreateIkSolver(env: Environment, name: str) -> None:
    """Refuse to make a solver of inverse kinematics; return None where OpenRAVE does not know the name either.

    Args:
        env: The environment.
        name: The name.

    Raises:
        UnsupportedError: the solver is one of OpenRAVE's own.
    """
    return _refuse(env, InterfaceType.iksolver, name)


def RaveCreateSensor(env: Environment, name: str) -> Sensor | None:
    """Refuse to make a sensor; return None where OpenRAVE does not know the name either.

    Args:
        env: The environment.
        name: The name.

    Raises:
        UnsupportedError: the sensor is one of OpenRAVE's own.
    """
    return _refuse(env, InterfaceType.sensor, name)


def RaveCreateViewer(env: Environment, name: str) -> "Viewer | None":
    """Attach a viewer to the environment, beside those that it has; ``env.Remove`` closes it.

    Args:
        env: The environment.
        name: As for ``env.SetViewer``.

    Returns:
        The viewer, or None for a name that is no viewer's.
    """
    from ravemj.gui.viewers import VIEWERS  # noqa: PLC0415 - slow to import

    if name.lower() not in VIEWERS:
        return None
    return env.open_viewer(name.lower(), show=True)


def RaveGetLoadedInterfaces() -> dict[InterfaceType, list[str]]:
    """Return the names that ``RaveCreate…`` of each kind makes something for."""
    from ravemj.gui.viewers import VIEWERS  # noqa: PLC0415 - slow to import

    made: dict[InterfaceType, list[str]] = {
        InterfaceType.collisionchecker: ["ode", "bullet", "fcl_", "pqp"],
        InterfaceType.controller: ["IdealController", "IdealVelocityController", "odevelocity"],
        InterfaceType.kinbody: [""],
        InterfaceType.module: ["viewerrecorder"],
        InterfaceType.physicsengine: ["GenericPhysicsEngine", "ode", "bullet", "mujoco"],
        InterfaceType.robot: ["GenericRobot"],
        InterfaceType.trajectory: ["GenericTrajectory"],
        InterfaceType.spacesampler: list(SAMPLERS),
        InterfaceType.viewer: list(VIEWERS),
    }
    return {kind: made.get(kind, []) for kind in InterfaceType}


def _refuse(env: Environment, kind: InterfaceType, name: str) -> None:
    """Return None with a warning, or say what is missing."""
    checked_environment(env, f"RaveCreate, {kind.name}")
    checked_kind(name, str, f"RaveCreate, {kind.name}: name", "a text")
    words = name.split() or [""]
    capability = MISSING[kind].get(words[0].lower())
    if capability is not None:
        raise UnsupportedError(f"{kind.name} '{words[0]}'", capability)
    _LOG.warning("there is no %s '%s'", kind.name, name)

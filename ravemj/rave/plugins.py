"""``RaveCreate…`` of what OpenRAVE's plugins provide and ravemj does not: None, or which capability is missing."""

import logging
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from ravemj.core.arguments import checked_kind
from ravemj.errors import UnsupportedError
from ravemj.rave.enums import InterfaceType
from ravemj.rave.environment import Environment
from ravemj.rave.interface import checked_environment
from ravemj.rave.modules import MODULES, Module, made_module
from ravemj.rave.planning.names import PLANNERS
from ravemj.rave.samplers import SAMPLERS
from ravemj.rave.sensors import KIND_NAMES

if TYPE_CHECKING:
    from ravemj.gui.viewers import Viewer

_GRASPING = "planning of grasps"

_LOG = logging.getLogger("ravemj")

MISSING: Mapping[InterfaceType, Mapping[str, str]] = MappingProxyType(
    {
        InterfaceType.module: {
            "grasper": _GRASPING,
            "ikfast": "compiling of solvers of inverse kinematics",
            "taskcaging": "caging of handles",
            "visualfeedback": "visual feedback",
        },
    }
)
"""Names of OpenRAVE's own plugins, in lower case, with what ravemj lacks to have them."""


def RaveCreateModule(env: Environment, name: str) -> Module | None:
    """Make a module, an object that takes commands; ``env.Add`` adds it.

    Args:
        env: The environment.
        name: ``BaseManipulation``, ``TaskManipulation``, ``viewerrecorder``, which writes videos, or ``logging``, which
            saves scenes; in any letter case.

    Returns:
        The module; None, as in OpenRAVE, where no plugin has a module of that name: a warning is logged.

    Raises:
        UnsupportedError: the module is another one of OpenRAVE's own.

    Example:
        >>> module = RaveCreateModule(env, "BaseManipulation")
        >>> env.Add(module, True, robot.GetName())
        >>> RaveCreateModule(env, "urdf") is None
        True
    """
    return made_module(env, name) or _refuse(env, InterfaceType.module, name)


RaveCreateProblem = RaveCreateModule


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
        InterfaceType.iksolver: ["ikfast"],
        InterfaceType.kinbody: [""],
        InterfaceType.physicsengine: ["GenericPhysicsEngine", "ode", "bullet", "mujoco"],
        InterfaceType.module: list(MODULES),
        InterfaceType.planner: list(PLANNERS),
        InterfaceType.robot: ["GenericRobot"],
        InterfaceType.trajectory: ["GenericTrajectory"],
        InterfaceType.spacesampler: list(SAMPLERS),
        InterfaceType.sensor: list(KIND_NAMES),
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

"""Makes modules and viewers, and refuses what OpenRAVE's plugins provide and ravemj lacks."""

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
"""Interfaces of OpenRAVE that ravemj lacks: their names in lower case, and the missing feature."""


def RaveCreateModule(env: Environment, name: str) -> Module | None:
    """Make a module, an object that executes commands; ``env.Add`` adds it to the environment.

    Args:
        env: The environment.
        name: ``BaseManipulation``, ``TaskManipulation``, ``viewerrecorder``, which writes videos, or ``logging``, which
            saves scenes; in any letter case.

    Returns:
        The module; None with a logged warning if no plugin of OpenRAVE has a module of that name.

    Raises:
        UnsupportedError: OpenRAVE has this module, and ravemj does not.

    Example:
        >>> module = RaveCreateModule(env, "BaseManipulation")
        >>> env.Add(module, True, robot.GetName())
        >>> RaveCreateModule(env, "urdf") is None
        True
    """
    return made_module(env, name) or _refuse(env, InterfaceType.module, name)


RaveCreateProblem = RaveCreateModule


def RaveCreateViewer(env: Environment, name: str) -> "Viewer | None":
    """Attach another viewer to the environment; ``env.Remove`` closes it.

    Args:
        env: The environment.
        name: A name of ``env.SetViewer``.

    Returns:
        The viewer; None for an unknown name.
    """
    from ravemj.gui.viewers import VIEWERS  # noqa: PLC0415 - slow to import

    if name.lower() not in VIEWERS:
        return None
    return env.open_viewer(name.lower(), show=True)


def RaveGetLoadedInterfaces() -> dict[InterfaceType, list[str]]:
    """Return the names that the ``RaveCreate…`` function of each kind of interface knows."""
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
    """Return None with a logged warning, or raise an error for a feature that ravemj lacks."""
    checked_environment(env, f"RaveCreate, {kind.name}")
    checked_kind(name, str, f"RaveCreate, {kind.name}: name", "a text")
    words = name.split() or [""]
    capability = MISSING[kind].get(words[0].lower())
    if capability is not None:
        raise UnsupportedError(f"{kind.name} '{words[0]}'", capability)
    _LOG.warning("there is no %s '%s'", kind.name, name)

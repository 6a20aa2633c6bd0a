"""Modules, under OpenRAVE's names: they plan and execute motions.

``motions`` plans and executes a motion; ``base_manipulation`` and ``task_manipulation`` are the motions of the modules
of these names. ``commands`` offers them as text commands.
"""

import logging
from collections.abc import Mapping
from typing import TYPE_CHECKING

from ravemj.rave.interface import Command, Module, asked_for
from ravemj.rave.modules.base_manipulation import BaseManipulation
from ravemj.rave.modules.commands import BASE_COMMANDS, TASK_COMMANDS, Tokens, commands_of, scene_module
from ravemj.rave.modules.motions import Manipulation
from ravemj.rave.modules.task_manipulation import TaskManipulation

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

__all__ = ["MODULES", "Module", "RaveCreateModule", "RaveCreateProblem", "base_module", "task_module"]

_LOG = logging.getLogger("ravemj")

MODULES = ("BaseManipulation", "TaskManipulation", "logging", "urdf", "viewerrecorder")
"""Names of the modules."""

MISSING: Mapping[str, str] = {
    "grasper": "planning of grasps",
    "ikfast": "compiling of solvers of inverse kinematics",
    "taskcaging": "caging of handles",
    "visualfeedback": "visual feedback",
}
"""Modules of OpenRAVE that ravemj lacks: their names in lower case, and the missing feature."""


def base_module(env: "Environment", xmlid: str = "BaseManipulation") -> tuple[Module, BaseManipulation]:
    """Make a module that moves arms; return it, and the object that plans its motions."""
    manipulation = BaseManipulation(env)
    return _module(env, xmlid, manipulation, commands_of(manipulation, BASE_COMMANDS)), manipulation


def task_module(env: "Environment", xmlid: str = "TaskManipulation") -> tuple[Module, TaskManipulation]:
    """Make a module that moves grippers; return it, and the object that plans its motions."""
    manipulation = TaskManipulation(env)
    return _module(env, xmlid, manipulation, commands_of(manipulation, TASK_COMMANDS)), manipulation


def RaveCreateModule(env: "Environment", name: str) -> Module | None:
    """Make a module, an object that executes commands; ``env.Add`` adds it to the environment.

    Args:
        env: The environment.
        name: ``BaseManipulation``, ``TaskManipulation``, ``viewerrecorder``, which writes videos, ``logging``, which
            saves scenes, or ``urdf``, which loads robots of ROS as the plugin or_urdf does; in any letter case.

    Returns:
        The module; None with a logged warning if no plugin of OpenRAVE has a module of that name.

    Raises:
        UnsupportedError: OpenRAVE has this module, and ravemj does not.

    Example:
        >>> module = RaveCreateModule(env, "BaseManipulation")
        >>> env.Add(module, True, robot.GetName())
        >>> RaveCreateModule(env, "mymodule") is None
        True
    """
    word = asked_for(env, name, "RaveCreateModule", MISSING)[0]
    match word.lower():
        case "basemanipulation":
            return base_module(env, word)[0]
        case "taskmanipulation":
            return task_module(env, word)[0]
        case "logging":
            return scene_module(env, word)
        case "viewerrecorder":
            from ravemj.rave.viewer_recorder import ViewerRecorder  # noqa: PLC0415 - rarely wanted

            return ViewerRecorder(env, word)
        case "urdf":
            from ravemj.rave.modules.urdf import urdf_module  # noqa: PLC0415 - rarely wanted

            return urdf_module(env, word)
        case _:
            _LOG.warning("there is no module '%s'", name)
            return None


RaveCreateProblem = RaveCreateModule


def _module(env: "Environment", xmlid: str, manipulation: Manipulation, commands: dict[str, Command]) -> Module:
    def start(arguments: str) -> None:
        tokens = Tokens(arguments)
        if tokens and not manipulation.choose(name := tokens.next()):
            _LOG.warning("module %s: there is no robot '%s'", xmlid, name)
        while tokens:
            name = tokens.next().lower()
            if name == "planner":
                manipulation.choose_planner(tokens.next("a planner"))
            elif name == "maxvelmult":
                manipulation.maxvelmult = tokens.number()
            else:
                _LOG.warning("module %s: unknown argument '%s'; it takes a robot, planner, maxvelmult", xmlid, name)

    return Module(env, xmlid, start, commands)

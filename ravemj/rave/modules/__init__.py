"""Modules under OpenRAVE's names, which plan and execute motions.

``motions`` plans and executes a motion; ``base_manipulation`` and ``task_manipulation`` are the motions of the modules
of these names. ``commands`` offers them as text commands. ``grasper`` simulates grasps; ``grasper_commands`` are its
commands.
"""

import logging
from collections.abc import Mapping
from typing import TYPE_CHECKING

from ravemj.rave.interface import Command, Module, asked_for
from ravemj.rave.modules.base_manipulation import BaseManipulation, Manipulation
from ravemj.rave.modules.commands import BASE_COMMANDS, TASK_COMMANDS, Tokens, commands_of, scene_module
from ravemj.rave.modules.grasper import GraspSimulation
from ravemj.rave.modules.grasper_commands import GRASPER_COMMANDS
from ravemj.rave.modules.task_manipulation import TaskManipulation

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

__all__ = ["MODULES", "Module", "RaveCreateModule", "RaveCreateProblem", "base_module", "grasper_module", "task_module"]

_LOG = logging.getLogger("ravemj")

MODULES = ("BaseManipulation", "Grasper", "TaskManipulation", "ikfast", "logging", "urdf", "viewerrecorder")
"""Names of the modules that ``RaveCreateModule`` makes."""

MISSING: Mapping[str, str] = {
    "taskcaging": "caging of handles",
    "visualfeedback": "visual feedback",
}
"""OpenRAVE's modules that ravemj lacks: names in lower case, with the missing feature."""


def base_module(env: "Environment", xmlid: str = "BaseManipulation") -> tuple[Module, BaseManipulation]:
    """Make a module that moves arms; return it with its motion planner."""
    manipulation = BaseManipulation(env)
    return _module(env, xmlid, manipulation, commands_of(manipulation, BASE_COMMANDS)), manipulation


def task_module(env: "Environment", xmlid: str = "TaskManipulation") -> tuple[Module, TaskManipulation]:
    """Make a module that moves grippers; return it with its motion planner."""
    manipulation = TaskManipulation(env)
    return _module(env, xmlid, manipulation, commands_of(manipulation, TASK_COMMANDS)), manipulation


def grasper_module(env: "Environment", xmlid: str = "Grasper") -> tuple[Module, GraspSimulation]:
    """Make a module that simulates grasps; return it with its ``GraspSimulation``."""
    simulation = GraspSimulation(env)
    return _module(env, xmlid, simulation, commands_of(simulation, GRASPER_COMMANDS)), simulation


_ROBOT_MODULES = {
    "basemanipulation": base_module,
    "taskmanipulation": task_module,
    "grasper": grasper_module,
}


def RaveCreateModule(env: "Environment", name: str) -> Module | None:
    """Make a module, an object that executes commands; ``env.Add`` adds it to the environment.

    Args:
        env: The environment.
        name: ``BaseManipulation``, ``TaskManipulation``, ``Grasper``, ``viewerrecorder``, which writes videos,
            ``logging``, which saves scenes, ``urdf``, which loads robots of ROS as the plugin or_urdf does, or
            ``ikfast``, which assigns IK solvers to arms; in any letter case.

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
    if word.lower() in _ROBOT_MODULES:
        return _ROBOT_MODULES[word.lower()](env, word)[0]
    match word.lower():
        case "logging":
            module = scene_module(env, word)
        case "viewerrecorder":
            from ravemj.rave.viewer_recorder import ViewerRecorder  # noqa: PLC0415 - rarely wanted

            module = ViewerRecorder(env, word)
        case "urdf":
            from ravemj.rave.modules.urdf import urdf_module  # noqa: PLC0415 - rarely wanted

            module = urdf_module(env, word)
        case "ikfast":
            from ravemj.rave.modules.ikfast import ikfast_module  # noqa: PLC0415 - rarely wanted

            module = ikfast_module(env, word)
        case _:
            _LOG.warning("there is no module '%s'", name)
            module = None
    return module


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

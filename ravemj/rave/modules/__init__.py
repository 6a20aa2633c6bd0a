"""Modules, under OpenRAVE's names: they plan and execute motions.

``motions`` plans and executes a motion; ``base_manipulation`` and ``task_manipulation`` are the motions of the modules
of these names. ``commands`` offers them as text commands, which ``tokens`` parses.
"""

import logging
from typing import TYPE_CHECKING

from ravemj.core.arguments import checked_kind
from ravemj.rave.interface import checked_environment
from ravemj.rave.module import Command, Module
from ravemj.rave.modules.base_manipulation import BaseManipulation
from ravemj.rave.modules.commands import BaseCommands, TaskCommands, answering
from ravemj.rave.modules.motions import Manipulation
from ravemj.rave.modules.scene_saver import scene_module
from ravemj.rave.modules.task_manipulation import TaskManipulation
from ravemj.rave.modules.tokens import Tokens

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

__all__ = ["MODULES", "Module", "base_module", "made_module", "task_module"]

_LOG = logging.getLogger("ravemj")

MODULES = ("BaseManipulation", "TaskManipulation", "logging", "viewerrecorder")
"""Names of the modules."""


def base_module(env: "Environment", xmlid: str = "BaseManipulation") -> tuple[Module, BaseManipulation]:
    """Make a module that moves arms; return it, and the object that plans its motions."""
    manipulation = BaseManipulation(env)
    return _module(env, xmlid, manipulation, answering(BaseCommands(manipulation).named())), manipulation


def task_module(env: "Environment", xmlid: str = "TaskManipulation") -> tuple[Module, TaskManipulation]:
    """Make a module that moves grippers; return it, and the object that plans its motions."""
    manipulation = TaskManipulation(env)
    return _module(env, xmlid, manipulation, answering(TaskCommands(manipulation).named())), manipulation


def made_module(env: "Environment", name: str) -> Module | None:
    """Return a new module of a name, in any letter case, or None."""
    checked_environment(env, "RaveCreateModule")
    word = next(iter(checked_kind(name, str, "RaveCreateModule: name", "a text").split()), "")
    if word.lower() == "viewerrecorder":
        from ravemj.rave.viewer_recorder import ViewerRecorder  # noqa: PLC0415 - rarely wanted

        return ViewerRecorder(env, word)
    if word.lower() == "logging":
        return scene_module(env, word)
    make = {"basemanipulation": base_module, "taskmanipulation": task_module}.get(word.lower())
    return None if make is None else make(env, word)[0]


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

"""The module ``ikfast`` of OpenRAVE's plugin ikfastsolvers, with which old scripts assign IK solvers to arms."""

import logging
from typing import NoReturn

from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType
from ravemj.rave.environment import Environment
from ravemj.rave.iksolver import IkSolver
from ravemj.rave.interface import Module
from ravemj.rave.solver_names import numbers_in

_LOG = logging.getLogger("ravemj")
_INSTEAD = "databases.inversekinematics.InverseKinematicsModel(robot, iktype=…).load() derives a solver"


def ikfast_module(env: Environment, xmlid: str) -> Module:
    """Make a module that assigns IK solvers to the active manipulators of robots; none is compiled."""

    def load_solver(arguments: str) -> str | None:
        """Assign an IK solver to the active manipulator: ``LoadIKFastSolver ROBOT TYPE [STEPS OF FREE JOINTS]``."""
        name, *rest = arguments.split() or [""]
        robot = env.GetRobot(name)
        if robot is None or not rest:
            raise ArgumentError(
                f"LoadIKFastSolver: is '{arguments}', and should be the name of a robot and a type of goal"
            )
        manipulator = robot.GetActiveManipulator()
        if manipulator is None:
            _LOG.warning("LoadIKFastSolver: '%s' has no active manipulator", name)
            return None
        kind = _type(rest[0])
        solver = IkSolver(env, f"ikfast {kind.name}", kind, steps=numbers_in(rest[1:]) or None)
        return "" if manipulator.SetIkSolver(solver) else None

    def add_library(arguments: str) -> NoReturn:
        """Refuse a compiled solver."""
        raise UnsupportedError(f"AddIkLibrary {arguments} ({_INSTEAD})", "loading of compiled solvers")

    def time_library(arguments: str) -> NoReturn:
        """Refuse to time a compiled solver."""
        remedy = "time manipulator.FindIKSolutions, or manipulator.batch_solutions for many goals"
        raise UnsupportedError(f"PerfTiming {arguments} ({remedy})", "timing of compiled solvers")

    commands = {"LoadIKFastSolver": load_solver, "AddIkLibrary": add_library, "PerfTiming": time_library}
    return Module(env, xmlid, lambda arguments: None, commands)


def _type(word: str) -> IkParameterizationType:
    """Return the goal type of a number or a name."""
    for kind in GOAL_TYPES:
        if word in {kind.name, str(int(kind))}:
            return kind
    raise ArgumentError(f"LoadIKFastSolver: the type of goal is '{word}', and should be an IkParameterizationType")

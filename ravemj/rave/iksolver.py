"""Solvers of inverse kinematics as objects of an environment."""

import logging
import operator
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_vector
from ravemj.core.handles import Handle
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType
from ravemj.rave.enums import InterfaceType
from ravemj.rave.ik_search import IkSearch
from ravemj.rave.ik_validation import Filter, FilterFunction, solution
from ravemj.rave.ikreturn import IkReturn
from ravemj.rave.interface import asked_for
from ravemj.rave.specification import IkParameterization

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.robot import Robot

_LOG = logging.getLogger("ravemj")
_NEAR = 1e-4
"""Squared distance from the goal of a configuration that ``CallFilters`` takes."""


class IkSolver(IkSearch):
    """Finds joint values that take the tool of one arm to goals of one type; ``manip.GetIkSolver()`` returns it.

    Goals of its own methods are in the frame of the arm's base.
    """

    _interface_type = InterfaceType.iksolver
    _internal = ("copy_for",)

    def Supports(self, iktype: IkParameterizationType) -> bool:
        """Return whether the solver answers goals of the type ``iktype``."""
        return iktype == self.kind

    def copy_for(self, robot: "Robot") -> "IkSolver":
        """Return a solver for the same arm of another robot like this, with the default steps of free joints."""
        copy = IkSolver(robot.GetEnv(), self._xmlid, self.kind, self.arm_solver.free)
        copy.arm_solver = self.arm_solver.copy()
        copy.attach(robot, self._arm_name)
        return copy

    # Free joints

    def GetNumFreeParameters(self) -> int:
        """Return how many joints are sampled, since the arm has more than the goal needs."""
        return len(self.derived().free)

    def GetFreeParameters(self) -> Floats:
        """Return where the free joints of the robot are in their ranges, from 0 to 1, shape (k,)."""
        solver, values = self.derived(), self._configuration()
        free = list(solver.free)
        lower, upper = solver.chain.lower[free], solver.chain.upper[free]
        width = upper - lower
        return np.divide(values[free] - lower, width, out=np.zeros(len(free)), where=width > 0)

    # Filters

    def RegisterCustomFilter(self, priority: int, callback: FilterFunction) -> Handle:
        """Let a function of yours accept or reject solutions.

        Args:
            priority: Functions of higher priority are asked first; those above 0 before collisions are tested.
            callback: ``callback(values, manipulator, ikparam)`` returns an ``IkReturnAction`` (``Success`` keeps the
                solution, ``Reject`` goes on to the next, ``Quit`` ends the search), an ``IkReturn`` whose solution
                takes the place of this one, or None, which rejects. ``ikparam`` is in the frame of the arm's base; the
                robot stands in the solution, and its active DOFs are those of the arm.

        Returns:
            A handle; the function is asked until it is closed or gone.

        Example:
            >>> def elbow_up(values, manipulator, ikparam):
            ...     return IkReturnAction.Success if values[2] > 0 else IkReturnAction.Reject
            >>> handle = manip.GetIkSolver().RegisterCustomFilter(0, elbow_up)
        """
        if not callable(callback):
            raise ArgumentError(f"RegisterCustomFilter: callback is {callback!r}, and should be a function")
        entry = Filter(int(priority), callback)
        self._filters.append(entry)
        return Handle(self._filters.remove, entry)

    def CallFilters(self, ikparam: IkParameterization) -> IkReturn:
        """Ask all filters about the configuration in which the robot is.

        Args:
            ikparam: The goal, in the frame of the arm's base, where the tool is within 0.01 (m or rad).

        Returns:
            The configuration as a solution, with what the filters attach; or that they reject it.

        Raises:
            ArgumentError: the tool is elsewhere.
        """
        goal = checked_kind(ikparam, IkParameterization, "CallFilters: ikparam")
        here = self._arm.GetIkParameterization(goal, False)
        if here.ComputeDistanceSqr(goal) > _NEAR:
            raise ArgumentError("CallFilters: ikparam is not where the tool is; it is relative to the arm's base")
        row = self._configuration()
        answer = solution(row)
        with self._validator(goal, 0, None).moving_robot() as validator:
            return answer if validator.passes(validator.filters, row, answer) else validator.failure()

    # Search

    def Solve(self, ikparam: IkParameterization, q0: ArrayLike | None, *arguments: object, **named: object) -> IkReturn:
        """Return the solution nearest to a configuration: ``Solve(ikparam, q0, [freeparameters,] filteroptions)``.

        Args:
            ikparam: The goal, in the frame of the arm's base.
            q0: The configuration, shape (n,); None: the present one.
            arguments: Values of the free joints as shares of their ranges, then ``IkFilterOptions``.
            named: The same by name.
        """
        goal = checked_kind(ikparam, IkParameterization, "Solve: ikparam")
        free, options = split_options("Solve", arguments, named)
        seed = None if q0 is None else checked_vector(q0, self.derived().chain.dof, "Solve: q0")
        with self._env.simulation.lock:
            return self.find_one(goal, free, options, seed=seed)

    def SolveAll(self, ikparam: IkParameterization, *arguments: object, **named: object) -> list[IkReturn]:
        """Return all solutions: ``SolveAll(ikparam, [freeparameters,] filteroptions)``; see ``Solve``."""
        goal = checked_kind(ikparam, IkParameterization, "SolveAll: ikparam")
        free, options = split_options("SolveAll", arguments, named)
        with self._env.simulation.lock:
            return self.find_all(goal, free, options)

    def __repr__(self) -> str:
        return f"RaveCreateIkSolver({self._env!r}, {self._xmlid!r})"


_OPTIONS = "filteroptions"


def split_options(
    caller: str, arguments: Sequence[object], named: Mapping[str, object], free_name: str = "freeparameters"
) -> tuple[ArrayLike | None, int]:
    """Return values of free joints, or None, and ``IkFilterOptions`` of a call: ``([freeparameters,] filteroptions)``.

    Raises:
        TypeError: the options are missing, or there is something else.
    """
    names = [free_name, _OPTIONS] if len(arguments) > 1 or free_name in named else [_OPTIONS]
    given = dict(zip([name for name in names if name not in named], arguments, strict=False)) | dict(named)
    unknown = given.keys() - {free_name, _OPTIONS}
    if unknown:
        raise TypeError(f"{caller}: has no argument {', '.join(unknown)}")
    if _OPTIONS not in given or len(given) != len(arguments) + len(named):
        raise TypeError(f"{caller}: takes param, the goal, [{free_name},] {_OPTIONS}; see IkFilterOptions")
    options = given[_OPTIONS]
    try:
        number = operator.index(cast("int", options))
    except TypeError:
        raise TypeError(f"{caller}: {_OPTIONS} are {options!r}, and should be IkFilterOptions or 0") from None
    return cast("ArrayLike | None", given.get(free_name)), number


def RaveCreateIkSolver(env: "Environment", name: str) -> IkSolver | None:
    """Make a solver of inverse kinematics; ``manip.SetIkSolver`` gives it an arm.

    Args:
        env: The environment.
        name: ``ikfast`` and a word in which the type of goal stands, as ``InverseKinematicsModel.getikname`` returns
            it; what follows are the steps of free joints [rad or m]. ``ikfast Transform6D 0.05``

    Returns:
        The solver; None, and a warning is logged, where the name says no type of goal.

    Raises:
        UnsupportedError: no solver answers goals of that type.

    Example:
        >>> solver = RaveCreateIkSolver(env, "ikfast Translation3D")
        >>> manip.SetIkSolver(solver)
        True
    """
    words = asked_for(env, name, "RaveCreateIkSolver")
    if len(words) > 1 and words[0].lower() == "ikfast":
        kind = next((one for one in GOAL_TYPES if one.name in words[1].split(".")), None)
        steps = _numbers_in(words[2:])
        if kind is not None and steps is not None:
            return IkSolver(env, name, kind, steps=steps or None)
    _LOG.warning("there is no solver '%s': its name should be 'ikfast' and a type of goal, then steps", name)
    return None


def _numbers_in(words: Sequence[str]) -> list[float] | None:
    try:
        return [float(word) for word in words]
    except ValueError:
        return None

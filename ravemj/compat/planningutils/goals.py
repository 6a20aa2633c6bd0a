"""Configurations that reach goals of inverse kinematics, one after the other."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from collections.abc import Sequence
from typing import Any

import numpy as np

from ravemj.core.api_object import ApiObject
from ravemj.core.transforms import Floats
from ravemj.rave.enums import IkFilterOptions
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.specification import IkParameterization


class ManipulatorIKGoalSampler(ApiObject):
    """Gives joint values of an arm that reach any of several goals.

    Args:
        manip: The arm.
        parameterizations: The goals.
        nummaxsamples: How many solutions of each goal are given at most.
        nummaxtries: For OpenRAVE.
        jitter: For OpenRAVE.
        searchfreeparameters: For OpenRAVE.
        ikfilteroptions: Which solutions count, ``IkFilterOptions``.
        freevalues: For OpenRAVE.
    """

    def __init__(
        self,
        manip: Manipulator,
        parameterizations: Sequence[IkParameterization],
        nummaxsamples: int = 20,
        nummaxtries: int = 10,
        jitter: float = 0,
        searchfreeparameters: bool = True,
        ikfilteroptions: int = IkFilterOptions.CheckEnvCollisions,
        freevalues: object = None,
    ) -> None:
        del nummaxtries, jitter, searchfreeparameters, freevalues
        self._manip = manip
        self._options = int(ikfilteroptions)
        self._goals = list(enumerate(parameterizations))
        self._most = nummaxsamples
        self._ready: list[tuple[int, Any]] = []
        self._given: list[int] = []

    def Sample(self, ikreturn: bool = False, releasegil: bool = False) -> Any:  # noqa: ANN401 - two kinds of answer
        """Return the next solution, in the order of ``manip.GetArmIndices()``; None when there is none left.

        Args:
            ikreturn: Whether to return an ``IkReturn`` in its place.
            releasegil: Not used.
        """
        del releasegil
        while not self._ready and self._goals:
            index, goal = self._goals.pop(0)
            found = self._manip.FindIKSolutions(goal, self._options, ikreturn=True)
            self._ready = [(index, one) for one in found[: self._most]]
        if not self._ready:
            return None
        index, solution = self._ready.pop(0)
        self._given.append(index)
        return solution if ikreturn else _values(solution)

    def SampleAll(self, maxsamples: int = 0, maxchecksamples: int = 0, releasegil: bool = False) -> list[Any]:
        """Return the solutions that are left, as ``IkReturn``.

        Args:
            maxsamples: How many at most; 0: all.
            maxchecksamples: For OpenRAVE.
            releasegil: Not used.
        """
        del maxchecksamples, releasegil
        found: list[Any] = []
        while (not maxsamples or len(found) < maxsamples) and (one := self.Sample(ikreturn=True)) is not None:
            found.append(one)
        return found

    def GetIkParameterizationIndex(self, index: int) -> int:
        """Return which goal a solution was for.

        Args:
            index: The number of the solution, in the order in which they were given.
        """
        return self._given[index]


def _values(solution: Any) -> Floats:  # noqa: ANN401 - IkReturn, or values
    getter = getattr(solution, "GetSolution", None)
    return np.asarray(getter() if getter else solution)

"""Samples of IK solutions of goals."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.rave.enums import IkFilterOptions
from ravemj.rave.ikreturn import IkReturn
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.specification import IkParameterization


class ManipulatorIKGoalSampler(ApiObject):
    """Sampler of an arm's joint values that reach any of several goals.

    Args:
        manip: The arm.
        parameterizations: The goals.
        nummaxsamples: Maximum number of solutions of each goal.
        nummaxtries: Number of attempts to displace a goal.
        jitter: Maximum random displacement [m], along each axis, of a goal without solution; 0 for none.
        searchfreeparameters: Not used.
        ikfilteroptions: The tests of solutions, ``IkFilterOptions``.
        freevalues: Values of the arm's free joints, as for ``FindIKSolutions``; None or [] searches all.
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
        freevalues: ArrayLike | None = None,
    ) -> None:
        del searchfreeparameters
        self._manip = manip
        free = [] if freevalues is None or not np.size(freevalues) else [freevalues]
        self._arguments = [*free, int(ikfilteroptions)]
        self._jitter, self._tries = jitter, nummaxtries if jitter > 0 else 0
        self._random = np.random.default_rng(0)
        self._goals = list(enumerate(parameterizations))
        self._most = nummaxsamples
        self._ready: list[tuple[int, IkReturn]] = []
        self._given: list[int] = []

    def Sample(self, ikreturn: bool = False, releasegil: bool = False) -> Any:  # noqa: ANN401 - two kinds of answer
        """Return the next solution, in the order of ``manip.GetArmIndices()``; None after the last one.

        Args:
            ikreturn: Whether to return an ``IkReturn`` instead.
            releasegil: Not used.
        """
        del releasegil
        while not self._ready and self._goals:
            index, goal = self._goals.pop(0)
            self._ready = [(index, row) for row in self._solutions(goal)[: self._most]]
        if not self._ready:
            return None
        index, solution = self._ready.pop(0)
        self._given.append(index)
        return solution if ikreturn else solution.GetSolution()

    def _solutions(self, goal: IkParameterization) -> list[IkReturn]:
        """Return the IK solutions of a goal; if it has none, of the first randomly displaced goal that has any."""
        solutions: Any = self._manip.FindIKSolutions(goal, *self._arguments, ikreturn=True)
        for _ in range(self._tries):
            if len(solutions):
                break
            aside = np.eye(4)
            aside[:3, 3] = self._random.uniform(-self._jitter, self._jitter, 3)
            solutions = self._manip.FindIKSolutions(goal.Transform(aside), *self._arguments, ikreturn=True)
        return solutions

    def SampleAll(self, maxsamples: int = 0, maxchecksamples: int = 0, releasegil: bool = False) -> list[IkReturn]:
        """Return the remaining solutions as ``IkReturn``.

        Args:
            maxsamples: Maximum number; 0 means all.
            maxchecksamples: Not used.
            releasegil: Not used.
        """
        del maxchecksamples, releasegil
        samples: list[IkReturn] = []
        while (not maxsamples or len(samples) < maxsamples) and (sample := self.Sample(ikreturn=True)) is not None:
            samples.append(sample)
        return samples

    def GetIkParameterizationIndex(self, index: int) -> int:
        """Return the index of the goal of a solution.

        Args:
            index: The index of the solution, in the order of sampling.
        """
        return self._given[index]

"""Samplers: sequences of points that cover a space."""

from collections.abc import Callable
from operator import index
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ravemj.core.arguments import also_named, checked_index
from ravemj.core.enumerations import NamedInt
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions.sequences import halton
from ravemj.rave.enums import InterfaceType, Interval
from ravemj.rave.interface import Interface, asked_for

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class SampleDataType(NamedInt):
    """The kind of numbers that a sampler returns."""

    Real = 1
    Uint32 = 2


class SpaceSampler(Interface):
    """A sequence of points in a space; ``RaveCreateSpaceSampler`` makes samplers.

    Real numbers are from 0 to 1, except for those of bodies and robots.

    Example:
        >>> sampler = ravemj.RaveCreateSpaceSampler(env, "halton")
        >>> sampler.SetSpaceDOF(2)
        >>> sampler.SampleSequence2D(ravemj.SampleDataType.Real, 3)
        array([[0.        , 0.        ],
               [0.5       , 0.33333333],
               [0.25      , 0.66666667]])
    """

    _interface_type = InterfaceType.spacesampler

    def __init__(self, env: "Environment", name: str, sequence: "_Random") -> None:
        super().__init__(env, name)
        self._sequence = sequence

    def SetSeed(self, seed: int) -> None:
        """Restart the sequence: equal values of ``seed`` give equal sequences. Halton's sequence is not restarted."""
        self._sequence.start(checked_index(seed, 2**32, "SetSeed: seed"))

    def SetSpaceDOF(self, dof: int) -> None:
        """Set the number of dimensions, ``dof``.

        Raises:
            openrave_exception: the number is less than 1, or differs from the DOFs of the sampled body.
        """
        if index(dof) < 1:
            raise ArgumentError(f"SetSpaceDOF: dof is {dof}, and should be at least 1")
        self._sequence.set_dof(index(dof))

    def GetDOF(self) -> int:
        """Return the number of dimensions."""
        return self._sequence.dof()

    GetNumberOfValues = GetDOF

    @also_named(seed="type")
    def Supports(self, type: SampleDataType) -> bool:
        """Return whether the sampler returns numbers of ``type``, a ``SampleDataType``."""
        return SampleDataType(type) in self._sequence.kinds

    @also_named(seed="type")
    def GetLimits(self, type: SampleDataType) -> tuple[Floats, Floats]:
        """Return the minima and maxima of numbers of ``type``, a ``SampleDataType``, shape (dof,) each."""
        self._check(type, "GetLimits")
        return self._sequence.limits()

    def SampleSequence(
        self, type: SampleDataType, num: int, interval: int = Interval.Closed
    ) -> Floats | NDArray[np.uint32]:
        """Return the next points of the sequence in one row, shape (num * dof,).

        Args:
            type: The kind of numbers, a ``SampleDataType``.
            num: The number of points.
            interval: Which of the limits belong to the space, an ``Interval``; not used, since samples hardly ever hit
                a limit.
        """
        return self.SampleSequence2D(type, num, interval).ravel()

    def SampleSequence2D(
        self, type: SampleDataType, num: int, interval: int = Interval.Closed
    ) -> Floats | NDArray[np.uint32]:
        """Return the next points of the sequence, shape (num, dof).

        Args:
            type: The kind of numbers, a ``SampleDataType``.
            num: The number of points.
            interval: Which of the limits belong to the space, an ``Interval``; not used, since samples hardly ever hit
                a limit.

        Raises:
            openrave_exception: the sampler does not return this kind of numbers (``NotImplemented``).
        """
        del interval
        self._check(type, "SampleSequence")
        if index(num) < 0:
            raise ArgumentError(f"SampleSequence: num is {num}, and should not be negative")
        whole = SampleDataType(type) == SampleDataType.Uint32
        return self._sequence.integers(index(num)) if whole else self._sequence.reals(index(num))

    def SampleSequenceOneReal(self, interval: int = Interval.Closed) -> float:
        """Return the next number of a one-dimensional sequence; ``interval`` is not used.

        Raises:
            openrave_exception: the sequence has more than one dimension (``InvalidState``).
        """
        return float(self._one(SampleDataType.Real, interval))

    def SampleSequenceOneUInt32(self) -> int:
        """Return the next integer of a one-dimensional sequence; see ``SampleSequenceOneReal``."""
        return int(self._one(SampleDataType.Uint32, Interval.Closed))

    def _one(self, type: SampleDataType, interval: int) -> float:
        if self.GetDOF() != 1 or isinstance(self._sequence, _Halton):
            message = f"'{self._xmlid}' gives points of {self.GetDOF()} dimensions; call SampleSequence2D"
            raise RavemjError(message, ErrorCode.InvalidState)
        return self.SampleSequence(type, 1, interval)[0]

    def SampleComplete(self, type: SampleDataType, num: int, interval: int = Interval.Closed) -> Floats:
        """Return no points, shape (num, dof), but raise an error: no sampler covers its space completely.

        Args:
            type: The kind of numbers, a ``SampleDataType``.
            num: The number of points.
            interval: Not used.

        Raises:
            openrave_exception: always (``NotImplemented``).
        """
        raise RavemjError(f"'{self._xmlid}' has no complete samples", ErrorCode.NotImplemented)

    SampleComplete2D = SampleComplete

    def _check(self, type: SampleDataType, caller: str) -> None:
        if not self.Supports(type):
            message = f"{caller}: '{self._xmlid}' gives no numbers of type {SampleDataType(type).name}"
            raise RavemjError(message, ErrorCode.NotImplemented)


class _Random:
    """Independent, uniformly distributed samples of the standard Mersenne Twister, seeded as in OpenRAVE."""

    kinds = frozenset(SampleDataType)
    """Kinds of numbers that the sampler generates."""

    def __init__(self) -> None:
        self._generator = np.random.RandomState()  # newer generators seed in another way
        self._dof = 1

    def dof(self) -> int:
        return self._dof

    def set_dof(self, dof: int) -> None:
        self._dof = dof

    def limits(self) -> tuple[Floats, Floats]:
        """Return the minima and maxima of real numbers, shape (dof,) each."""
        return np.zeros(self._dof), np.ones(self._dof)

    def start(self, seed: int) -> None:
        self._generator.seed(seed)

    def reals(self, count: int) -> Floats:
        """Return the next ``count`` samples, shape (count, dof)."""
        lower, upper = self.limits()
        return lower + (upper - lower) * (self.integers(count) / 2**32)

    def integers(self, count: int) -> NDArray[np.uint32]:
        """Return the next ``count`` samples as integers, shape (count, dof)."""
        return self._generator.randint(0, 2**32, (count, self.dof()), dtype=np.uint32)


class _Halton(_Random):
    """Halton's low-discrepancy sequence in the bases 2, 3, 5, ...: deterministic and evenly spread."""

    kinds = frozenset({SampleDataType.Real})
    _next = 0

    def set_dof(self, dof: int) -> None:
        self._dof, self._next = dof, 0

    def start(self, seed: int) -> None:
        pass

    def reals(self, count: int) -> Floats:
        points = halton(self._next, count, self._dof)
        self._next += count
        return points


class _Configurations(_Random):
    """Random configurations within limits: of all DOFs of a body, or of the active DOFs of a robot."""

    kinds = frozenset({SampleDataType.Real})

    def __init__(self, limits: Callable[[], tuple[Floats, Floats]]) -> None:
        super().__init__()
        self.limits = limits

    def dof(self) -> int:
        return len(self.limits()[0])

    def set_dof(self, dof: int) -> None:
        if dof != self.dof():
            message = f"SetSpaceDOF: dof is {dof}, and the body has {self.dof()}"
            raise ArgumentError(message, ErrorCode.Assert)


SAMPLERS = ("MT19937", "Halton", "BodyConfiguration", "RobotConfiguration")
"""Names of all samplers."""


def RaveCreateSpaceSampler(env: "Environment", name: str) -> SpaceSampler | None:
    """Make a sampler.

    Args:
        env: The environment.
        name: ``MT19937``: random numbers. ``Halton``: Halton's sequence. ``BodyConfiguration body`` and
            ``RobotConfiguration robot``: random joint values of the body of that name, and values of the robot's
            active DOFs, within their limits.

    Returns:
        The sampler; None for an unknown name.

    Raises:
        openrave_exception: there is no such body or robot.
    """
    kind, *arguments = asked_for(env, name, "RaveCreateSpaceSampler")
    match kind.lower():
        case "mt19937":
            return SpaceSampler(env, kind, _Random())
        case "halton":
            return SpaceSampler(env, kind, _Halton())
        case "bodyconfiguration" if body := env.GetKinBody(" ".join(arguments)):
            return SpaceSampler(env, kind, _Configurations(body.GetDOFLimits))
        case "robotconfiguration" if robot := env.GetRobot(" ".join(arguments)):
            return SpaceSampler(env, kind, _Configurations(robot.GetActiveDOFLimits))
        case "bodyconfiguration" | "robotconfiguration":
            raise ArgumentError(f"RaveCreateSpaceSampler: '{name}' should end in the name of a body or robot")
        case _:
            return None

"""Collision certificates of motions, as shown to users."""

import math
from dataclasses import dataclass

import numpy as np

from ravemj.core.transforms import Vec3


@dataclass(frozen=True)
class CertifiedSpan:
    """Time span of a motion, and the pair of shapes that is undecided, exempt from the proof, or nearest during it.

    Undecided means neither proven free of collisions nor exempt.

    Attributes:
        start: Start time [s].
        end: End time [s].
        pair: The links of the shapes, as ``link 'forearm' of 'puma'``.
    """

    start: float
    end: float
    pair: tuple[str, str]

    def __str__(self) -> str:
        return f"{' and '.join(self.pair)} from {self.start:.3f} to {self.end:.3f} s"


@dataclass(frozen=True)
class Certificate:
    """Proof that a motion is free of collisions at all times, not only at tested ones.

    It holds for the scene at the time of the proof, with MuJoCo's shapes; non-convex meshes are their triangles.
    Constraints and user collision checkers are not covered.

    Attributes:
        certified: Whether the motion is proven free of collisions, apart from ``exempt``.
        undecided: Spans without proof: shapes touch, or come closer than 0.1 mm.
        exempt: Spans in which shapes that touch at the start or goal are ignored: until they are 2 mm apart.
        smallest_gap: Lower bound of the distances between bodies during the motion [m]; infinite if there are none.
            Link pairs of one body are ignored, since they are close by design.
        nearest: The time and pair of the smallest distance, as a span of zero length; None if nothing was near.
        reason: Reason why no proof was possible; empty otherwise.
        nearest_points: The nearest points of both shapes at the smallest distance, in the world [m]; None if nothing
            was near.
    """

    certified: bool
    undecided: tuple[CertifiedSpan, ...] = ()
    exempt: tuple[CertifiedSpan, ...] = ()
    smallest_gap: float = 0.0
    nearest: CertifiedSpan | None = None
    reason: str = ""
    nearest_points: tuple[Vec3, Vec3] | None = None

    def __str__(self) -> str:
        if self.reason:
            return f"not certified: {self.reason}"
        has_others = math.isfinite(self.smallest_gap)
        gap = f"smallest gap {_rounded(1000 * self.smallest_gap)} mm" if has_others else "there are no other bodies"
        if self.nearest is not None:
            gap += f" at {self.nearest.start:.3f} s, {' and '.join(self.nearest.pair)}"
        exempt = f"; touching at the ends: {'; '.join(map(str, self.exempt))}" if self.exempt else ""
        if self.certified:
            return f"certified: {gap}{exempt}"
        first, *others = self.undecided
        more = f" and {len(others)} more" if others else ""
        return f"not certified: {first}{more} may touch{exempt}"


def _rounded(number: float) -> str:
    """Return a number as text with two significant digits and without exponent."""
    return np.format_float_positional(number, precision=2, fractional=False, trim="-")

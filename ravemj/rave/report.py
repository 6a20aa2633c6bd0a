"""Reports of collision checks: pairs, contacts, distances."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.core.api_object import ApiObject
from ravemj.core.transforms import Floats

if TYPE_CHECKING:
    from ravemj.rave.geometry import Geometry
    from ravemj.rave.link import Link

FAR = 1e20
"""The distance in a report without any distance [m]; the number is OpenRAVE's."""


@dataclass(slots=True)
class Contact:
    """Contact point of two geometries, or hit of a ray.

    Attributes:
        pos: The point in the world [m], shape (3,).
        norm: The unit normal in the world, shape (3,). It points from the second geometry to the first; at the hit of a
            ray it points outwards.
        depth: The penetration depth [m]; for a ray, the distance of the hit.
    """

    pos: Floats = field(default_factory=lambda: np.zeros(3))
    norm: Floats = field(default_factory=lambda: np.zeros(3))
    depth: float = 0.0


class Part(NamedTuple):
    """Link and geometry on one side of a colliding pair, as API objects."""

    link: "Link"
    geometry: "Geometry"

    def names(self) -> tuple[str, str, str]:
        """Return the names of the body, the link and the geometry."""
        return self.link.GetParent().GetName(), self.link.GetName(), self.geometry.GetName()


class CollisionPairInfo(ApiObject):
    """Two colliding links, the two nearest links, or a link that a ray hits.

    Attributes:
        contacts: The contact points, a list of ``Contact``.
        collides: Whether the links collide; False for the nearest links.
    """

    __slots__ = ("collides", "contacts", "first", "second")  # slots show on the class, as OpenRAVE's properties do

    def __init__(
        self,
        first: Part,
        second: Part | None,
        contacts: Iterable[tuple[Floats, Floats, float]] = (),
        *,
        collides: bool = True,
    ) -> None:
        self.first, self.second, self.collides = first, second, collides
        self.contacts = [Contact(*contact) for contact in contacts]

    @property
    def bodyLinkGeom1Name(self) -> str:
        """The names of the first body, link and geometry, joined by spaces."""
        return " ".join(self.ExtractFirstBodyLinkGeomNames())

    @property
    def bodyLinkGeom2Name(self) -> str:
        """The names of the second body, link and geometry, joined by spaces; empty for a ray."""
        return " ".join(self.ExtractSecondBodyLinkGeomNames()) if self.second else ""

    def ExtractFirstBodyLinkGeomNames(self) -> tuple[str, str, str]:
        """Return the names of the first body, link and geometry."""
        return self.first.names()

    def ExtractSecondBodyLinkGeomNames(self) -> tuple[str, str, str]:
        """Return the names of the second body, link and geometry."""
        return self.second.names() if self.second else ("", "", "")

    def __str__(self) -> str:
        names = (":".join(filter(None, part.names())) for part in (self.first, self.second) if part)
        return f"({')x('.join(names)}) contacts={len(self.contacts)}"

    def __repr__(self) -> str:
        return f"<collision:{self}>"


class CollisionReport(ApiObject):
    """The result of a collision check. The check fills the report that it is given.

    Newer versions of OpenRAVE have ``collisionInfos``; older ones have ``plink1``, ``plink2``, ``contacts``,
    ``vLinkColliding`` and ``numCols``. A report has both. The first of two links belongs to the first argument of the
    check.

    Attributes:
        collisionInfos: The colliding pairs; without ``CollisionOptions.AllLinkCollisions`` only the first one. If
            nothing collides and ``CollisionOptions.Distance`` is set, the nearest pair.
        minDistance: The smallest distance [m] if ``CollisionOptions.Distance`` is set; 0 in collision. For a ray, the
            distance of the hit.
        numWithinTol: The number of pairs within the tolerance if ``CollisionOptions.UseTolerance`` is set.
        nKeepPrevious: If it is 1, the report keeps the pairs of earlier checks.
        options: The options of the check.

    Example:
        >>> report = ravemj.CollisionReport()
        >>> env.CheckCollision(robot, report)
        True
        >>> print(report.plink1, report.plink2)
        <link:Arm1 (1), parent=Pendulum> <link:base (0), parent=table>
    """

    __slots__ = ("collisionInfos", "minDistance", "nKeepPrevious", "numWithinTol", "options")

    def __init__(self) -> None:
        self.nKeepPrevious = 0
        self.Reset()

    def Reset(self, coloptions: int = 0) -> None:
        """Clear the report, unless ``nKeepPrevious`` is set; ``coloptions`` are the options of the next check."""
        self.options = int(coloptions)
        if not self.nKeepPrevious:
            self.collisionInfos: list[CollisionPairInfo] = []
            self.minDistance = FAR
            self.numWithinTol = 0

    @property
    def contacts(self) -> list[Contact]:
        """The contact points of all pairs."""
        return [contact for info in self.collisionInfos for contact in info.contacts]

    @property
    def numCols(self) -> int:
        """The number of colliding pairs."""
        return sum(info.collides for info in self.collisionInfos)

    @property
    def plink1(self) -> "Link | None":
        """The first link of the first pair, or None."""
        first = self._first_pair()[0]
        return first and first.link

    @property
    def plink2(self) -> "Link | None":
        """The second link of the first pair, or None."""
        second = self._first_pair()[1]
        return second and second.link

    @property
    def pgeom1(self) -> "Geometry | None":
        """The first geometry of the first pair, or None."""
        first = self._first_pair()[0]
        return first and first.geometry

    @property
    def pgeom2(self) -> "Geometry | None":
        """The second geometry of the first pair, or None."""
        second = self._first_pair()[1]
        return second and second.geometry

    def _first_pair(self) -> tuple[Part | None, Part | None]:
        return next(((info.first, info.second) for info in self.collisionInfos), (None, None))

    @property
    def vLinkColliding(self) -> "list[tuple[Link, Link | None]]":
        """The pairs of links that collide."""
        colliding = [info for info in self.collisionInfos if info.collides]
        return [(info.first.link, info.second.link if info.second else None) for info in colliding]

    def __str__(self) -> str:
        return "\n".join(map(str, self.collisionInfos)) or "[]"  # as OpenRAVE prints an empty report

    def __repr__(self) -> str:
        return f"<report:{self}>"

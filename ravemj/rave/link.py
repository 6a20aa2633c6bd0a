"""Links of a body."""

from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats, pose_of
from ravemj.model import chains
from ravemj.rave.enums import GeometryType
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import GeometryInfo, LinkInfo
from ravemj.rave.links.collision import LinkCollision
from ravemj.rave.links.loads import LinkLoads
from ravemj.rave.links.mass import LinkMass
from ravemj.rave.links.parameters import LinkParameters
from ravemj.rave.link_geometries import LinkShapes

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class Link(LinkCollision, LinkMass, LinkShapes, LinkParameters, LinkLoads):
    """A rigid part of a body; ``body.GetLinks()`` makes it."""

    Geometry = Geometry
    GeometryInfo = GeometryInfo
    GeomType = GeometryType
    GeomProperties = Geometry
    LinkInfo = LinkInfo

    def GetName(self) -> str:
        """Return the link's name."""
        return self._scene.name

    def GetIndex(self) -> int:
        """Return the link's position in ``body.GetLinks()``."""
        return self._index

    def GetParent(self, returnexist: bool = False) -> "KinBody":
        """Return the body that the link belongs to.

        Args:
            returnexist: Not used: the body always exists.
        """
        del returnexist
        return self._parent

    def GetTransform(self) -> Floats:
        """Return the link's pose in the world.

        Returns:
            ``T_world_link``, shape (4, 4); a copy.
        """
        with self._state.simulation.lock:
            return self._state.link_transform(self._index)

    def GetVelocity(self) -> Floats:
        """Return the link's velocity, in world axes.

        Returns:
            That of its origin [m/s] and the angular one [rad/s], shape (6,); a copy.
        """
        with self._state.simulation.lock:
            return self._state.link_velocities()[self._index]

    def SetVelocity(self, linear: ArrayLike, angular: ArrayLike) -> None:
        """Set the velocity of this link alone; those of the DOFs are read off the differences between links.

        Args:
            linear: Velocity of its origin in the world [m/s], shape (3,).
            angular: Angular velocity in the world [rad/s], shape (3,).
        """
        moved, turned = checked_vector(linear, 3, "linear"), checked_vector(angular, 3, "angular")
        with self._state.simulation.lock:
            velocities = self._state.link_velocities()
            velocities[self._index] = (*moved, *turned)
            self._state.set_link_velocities(velocities)

    def GetTransformPose(self) -> Floats:
        """Return the link's pose as [w, x, y, z, tx, ty, tz]: unit quaternion and position [m], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def SetTransform(self, transform: ArrayLike) -> None:
        """Move this link only; the joints at it get the values that the poses of the links show.

        The next ``SetDOFValues`` puts all links where the joint values say.

        Args:
            transform: ``T_world_link``: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].

        Raises:
            ArgumentError: this is no rigid transform. Nothing has moved then.
        """
        checked = checked_transform(transform, "SetTransform: transform")
        with self._state.simulation.lock:
            transforms = self._state.link_transforms()
            transforms[self._index] = checked
            self._state.place_links(transforms)

    def IsStatic(self) -> bool:
        """Return whether the link is called static, by its file or by ``SetStatic``."""
        return self._scene.static

    def SetStatic(self, bStatic: bool) -> None:
        """Call the link static or not. What moves it stays as it is.

        Args:
            bStatic: Whether it is static.
        """
        with self._state.simulation.lock:
            self._state.edit_link(self._index, static=bool(bStatic))

    def GetParentLinks(self) -> "list[Link]":
        """Return the links that joints hang this one on."""
        return [self._other(link) for link in chains.parents(self._state.scene, self._index)]

    def IsParentLink(self, link: "Link") -> bool:
        """Return whether a joint hangs this link on another one.

        Args:
            link: The other link.
        """
        return link in self.GetParentLinks()

    def GetRigidlyAttachedLinks(self) -> "list[Link]":
        """Return the links that never move against this one; this one is the first."""
        return [self._other(link) for link in chains.rigidly_attached(self._state.scene, self._index)]

    def IsRigidlyAttached(self, link: "Link") -> bool:
        """Return whether another link never moves against this one.

        Args:
            link: The other link.
        """
        return link in self.GetRigidlyAttachedLinks()

    def _other(self, index: int) -> "Link":
        return Link(self._parent, self._state, index)

    def GetInfo(self) -> LinkInfo:
        """Return the description of the link as it stands, a copy."""
        with self._state.simulation.lock:
            enabled = self._state.link_enabled[self._index]
            return LinkInfo.of(self._state.scene, self._index, self.GetTransform(), enabled=enabled)

    UpdateAndGetInfo = GetInfo

    def UpdateInfo(self) -> None:
        """Do nothing: ``GetInfo`` always gives the present state."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Link) and self._state is other._state and self._index == other._index

    def __hash__(self) -> int:
        return hash((id(self._state), self._index))

    def __repr__(self) -> str:
        return f"{self._parent.GetEnv()!r}.GetKinBody({self._parent.GetName()!r}).GetLink({self.GetName()!r})"

    def __str__(self) -> str:
        return f"<link:{self.GetName()} ({self._index}), parent={self._parent.GetName()}>"

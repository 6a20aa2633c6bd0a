"""Links and joints of a body."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, cast

from ravemj.core.arrays import checked_indices
from ravemj.model.adjacency import adjacent_pairs
from ravemj.rave.body.base import BodyPart
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class Mechanism(BodyPart):
    """Links, joints and how they hang together."""

    _links: tuple[Link, ...] = ()

    @property
    def _body(self) -> "KinBody":
        return cast("KinBody", self)

    def GetLinks(self, indices: Sequence[int] | None = None) -> list[Link]:
        """Return the links in the order of the file; the first one is the root.

        Args:
            indices: Which links; None: all.

        Example:
            >>> [link.GetName() for link in robot.GetLinks()]
            ['Base', 'Arm0', 'Arm1']
        """
        links = self._all_links()
        if indices is None:
            return list(links)
        return [links[index] for index in checked_indices(indices, len(links), "indices").tolist()]

    def _all_links(self) -> tuple[Link, ...]:
        """Return the links, which are made once: they are numbers of links, whatever the body is built of."""
        count = len(self._state.scene.links)
        if len(self._links) != count:
            self._links = tuple(Link(self._body, self._state, index) for index in range(count))
        return self._links

    def GetLink(self, name: str) -> Link | None:
        """Return the link of that name, or None.

        Example:
            >>> T_world_link = robot.GetLink("Arm1").GetTransform()
            >>> robot.GetLink("no such link") is None
            True
        """
        for link, scene in zip(self._all_links(), self._state.scene.links, strict=True):
            if scene.name == name:
                return link
        return None

    def GetJoints(self, indices: Sequence[int] | None = None) -> list[Joint]:
        """Return the joints that have DOFs, in DOF order.

        Args:
            indices: Which joints; None: all.
        """
        joints = [Joint(self._body, self._state, index) for index in range(len(self._state.scene.joints))]
        return [joints[index] for index in checked_indices(... if indices is None else indices, len(joints), "indices")]

    def GetPassiveJoints(self) -> list[Joint]:
        """Return the joints that have no DOF."""
        body = self._state.scene
        first = len(body.joints)
        return [Joint(self._body, self._state, index) for index in range(first, first + len(body.passive_joints))]

    def GetJoint(self, name: str) -> Joint | None:
        """Return the joint of that name, passive or not, or None.

        Example:
            >>> robot.GetJoint("Joint1").GetDOFIndex()
            1
            >>> robot.GetJoint("no such joint") is None
            True
        """
        joints = (*self.GetJoints(), *self.GetPassiveJoints())
        return next((joint for joint in joints if joint.GetName() == name), None)

    def GetJointFromDOFIndex(self, dofindex: int) -> Joint:
        """Return the joint that a DOF belongs to.

        Args:
            dofindex: Position in the vectors of DOF values.

        Raises:
            IndexError: there is no such DOF.
        """
        checked_indices(dofindex, self.GetDOF())
        return next(joint for joint in reversed(self.GetJoints()) if joint.GetDOFIndex() <= dofindex)

    def GetAdjacentLinks(self) -> set[tuple[int, int]]:
        """Return the pairs of links, by index, that self-collision leaves out."""
        return adjacent_pairs(self._state.scene)

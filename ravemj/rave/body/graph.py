"""How the links and joints of a body hang together."""

from typing import Literal, overload

from ravemj.errors import ArgumentError
from ravemj.model import chains, hashes
from ravemj.rave.body.structure import Mechanism
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link


class Graph(Mechanism):
    """What moves what, the way between links, and hashes of the structure."""

    def GetJointIndex(self, name: str) -> int:
        """Return the place in ``GetJoints()`` of the joint of that name, or -1."""
        return next((joint.GetJointIndex() for joint in self.GetJoints() if joint.GetName() == name), -1)

    def IsDOFRevolute(self, dofindex: int) -> bool:
        """Return whether a DOF turns.

        Args:
            dofindex: Index of the DOF.
        """
        return self.GetJointFromDOFIndex(dofindex).IsRevolute()

    def IsDOFPrismatic(self, dofindex: int) -> bool:
        """Return whether a DOF slides.

        Args:
            dofindex: Index of the DOF.
        """
        return self.GetJointFromDOFIndex(dofindex).IsPrismatic()

    def IsDOFInChain(self, linkindex1: int, linkindex2: int, dofindex: int) -> bool:
        """Return whether a DOF moves two links against each other.

        Args:
            linkindex1: Index of a link.
            linkindex2: Index of the other link.
            dofindex: Index of the DOF.
        """
        first, second = self.DoesDOFAffectLink(dofindex, linkindex1), self.DoesDOFAffectLink(dofindex, linkindex2)
        return first != second

    def DoesAffect(self, jointindex: int, linkindex: int) -> int:
        """Return 1 if a joint moves a link, directly or through joints that follow it, else 0.

        Args:
            jointindex: Index of the joint, not of a DOF.
            linkindex: Index of the link.

        Raises:
            ArgumentError: there is no such joint or link.
        """
        joints = self.GetJoints()
        _check(jointindex, len(joints), "jointindex")
        return self.DoesDOFAffectLink(joints[jointindex].GetDOFIndex(), linkindex)

    def DoesDOFAffectLink(self, dofindex: int, linkindex: int) -> int:
        """Return 1 if a DOF moves a link, directly or through joints that follow it, else 0.

        Args:
            dofindex: Index of the DOF.
            linkindex: Index of the link.

        Raises:
            ArgumentError: there is no such DOF or link.
        """
        _check(dofindex, self.GetDOF(), "dofindex")
        self._check_link(linkindex)
        return int(dofindex in chains.dofs_moving(self._state.scene, linkindex))

    @overload
    def GetChain(self, linkindex1: int, linkindex2: int, returnjoints: Literal[True] = True) -> list[Joint]: ...
    @overload
    def GetChain(self, linkindex1: int, linkindex2: int, returnjoints: Literal[False]) -> list[Link]: ...
    def GetChain(self, linkindex1: int, linkindex2: int, returnjoints: bool = True) -> list[Joint] | list[Link]:
        """Return the shortest way from one link to another.

        Args:
            linkindex1: Index of the link to start from.
            linkindex2: Index of the link to reach.
            returnjoints: Whether to return the joints on the way, passive ones too; else the links, both ends
                included.

        Returns:
            Joints or links in order; none where no joints lead there, or the links are the same.

        Raises:
            ArgumentError: there is no such link.

        Example:
            >>> [joint.GetName() for joint in robot.GetChain(0, 2)]
        """
        self._check_link(linkindex1)
        self._check_link(linkindex2)
        links, joints = chains.chain(self._state.scene, linkindex1, linkindex2)
        if not returnjoints:
            return self.GetLinks(links)
        return [Joint(self._body, self._state, index) for index in joints]

    def GetDependencyOrderedJoints(self) -> list[Joint]:
        """Return the joints that have DOFs, each behind those that move it."""
        return self.GetJoints(chains.dependency_order(self._state.scene))

    def GetClosedLoops(self) -> list[list[tuple[Link, Joint]]]:
        """Return the closed loops of links: each is a list of links, each with the joint that leads to the next."""
        links = self.GetLinks()
        return [
            [(links[link], Joint(self._body, self._state, joint)) for link, joint in loop]
            for loop in chains.closed_loops(self._state.scene)
        ]

    def GetRigidlyAttachedLinks(self, linkindex: int) -> list[Link]:
        """Return a link and those that never move against it; the link is the first.

        Args:
            linkindex: Index of the link.
        """
        self._check_link(linkindex)
        return self.GetLinks(chains.rigidly_attached(self._state.scene, linkindex))

    def GetKinematicsGeometryHash(self) -> str:
        """Return a text that is the same for bodies of the same links, shapes and joints: 32 hexadecimal digits.

        Pose, joint values, limits and names do not matter.
        """
        return hashes.of_body(self._state.scene)

    GetStructureHash = GetKinematicsGeometryHash

    def _check_link(self, index: int) -> None:
        _check(index, len(self._state.scene.links), "linkindex")


def _check(index: int, count: int, name: str) -> None:
    if not 0 <= index < count:
        raise ArgumentError(f"{name} is {index}, and should be from 0 to {count - 1}")

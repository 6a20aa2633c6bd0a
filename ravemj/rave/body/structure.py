"""The structure of a body: links, joints, how they are connected, mass; and where it comes from."""

import itertools
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, cast, overload

from ravemj.core.arguments import checked_index
from ravemj.core.arrays import checked_indices
from ravemj.errors import ArgumentError
from ravemj.model import chains, hashes
from ravemj.model.chains import adjacent_pairs
from ravemj.model.mimic import Equations
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.body.limits import Limits
from ravemj.rave.joint import Joint
from ravemj.rave.link import Link

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody

_ARCHIVE = ".zae"
"""The suffix of archives of COLLADA documents."""

_NO_FILES = frozenset({FROM_SCRIPT.file, "data"})
"""Sources of bodies that were read from no file; ``data`` is what readers call a text."""


class Structure(Limits):
    """Links and joints: which there are, what moves what, the path between links, mass, hashes, file and id.

    OpenRAVE's ids, revisions and reference files belong to databases of models, which ravemj has none of: they are what
    scripts set, or empty.
    """

    _links: tuple[Link, ...] = ()
    _joints: tuple[Joint, ...] = ()
    _places: tuple[object, dict[str, int]] = (None, {})

    _uri: str | None = None
    """What ``InitFrom…`` was given; None: the file that the body was read from."""

    _id = ""

    @property
    def _body(self) -> "KinBody":
        return cast("KinBody", self)

    def GetName(self) -> str:
        """Return the body's name, unique in its environment.

        Example:
            >>> [body.GetName() for body in env.GetBodies()]
            ['Pendulum']
        """
        return self._state.scene.name

    def GetLinks(self, indices: Sequence[int] | None = None) -> list[Link]:
        """Return the links in the order of the file; the first one is the root.

        Args:
            indices: The link indices; by default all.

        Example:
            >>> [link.GetName() for link in robot.GetLinks()]
            ['Base', 'Arm0', 'Arm1']
        """
        links = self._all_links()
        if indices is None:
            return list(links)
        return [links[index] for index in checked_indices(indices, len(links), "indices").tolist()]

    def _all_links(self) -> tuple[Link, ...]:
        """Return the links. They are made once, since they only hold an index, valid whatever the body is."""
        count = len(self._state.scene.links)
        if len(self._links) != count:
            self._links = tuple(Link(self._body, self._state, index) for index in range(count))
        return self._links

    def GetLink(self, name: str) -> Link | None:
        """Return the link of a name, or None.

        Example:
            >>> T_world_link = robot.GetLink("Arm1").GetTransform()
            >>> robot.GetLink("no such link") is None
            True
        """
        scenes = self._state.scene.links
        if self._places[0] is not scenes:  # the first of several that have a name, hence backwards
            self._places = (scenes, {scenes[index].name: index for index in reversed(range(len(scenes)))})
        index = self._places[1].get(name)
        return None if index is None else self._all_links()[index]

    def GetJoints(self, indices: Sequence[int] | None = None) -> list[Joint]:
        """Return the joints that have DOFs, in DOF order, or those of ``indices``."""
        joints = self._all_joints()[: len(self._state.scene.joints)]
        if indices is None:
            return list(joints)
        return [joints[index] for index in checked_indices(indices, len(joints), "indices").tolist()]

    def _all_joints(self) -> tuple[Joint, ...]:
        """Return the joints that have DOFs, then the passive ones; like the links, they are made once."""
        body = self._state.scene
        count = len(body.joints) + len(body.passive_joints)
        if len(self._joints) != count:
            self._joints = tuple(Joint(self._body, self._state, index) for index in range(count))
        return self._joints

    def set_following(self, index: int, equations: Equations) -> None:
        """Make a joint a mimic joint, or an ordinary one; see ``Joint.SetMimicEquations``.

        Args:
            index: The index of the joint among the active joints followed by the passive ones.
            equations: The mimic equations.
        """
        from ravemj.model.following import with_equations  # noqa: PLC0415 - slow to import, and rarely wanted

        scene, order = with_equations(self._state.scene, index, equations)
        joints = self._all_joints()
        self._state.remake(scene)
        self._joints = tuple(joints[before] for before in order)
        for place, joint in enumerate(self._joints):
            joint.renumber(place)

    def GetPassiveJoints(self) -> list[Joint]:
        """Return the joints that have no DOF."""
        return list(self._all_joints()[len(self._state.scene.joints) :])

    def GetJoint(self, name: str) -> Joint | None:
        """Return the joint of that name, passive or not, or None.

        Example:
            >>> robot.GetJoint("Joint1").GetDOFIndex()
            1
            >>> robot.GetJoint("no such joint") is None
            True
        """
        return next((joint for joint in self._all_joints() if joint.GetName() == name), None)

    def GetJointFromDOFIndex(self, dofindex: int) -> Joint:
        """Return the joint that the DOF ``dofindex`` belongs to.

        Raises:
            IndexError: there is no such DOF.
        """
        dofs = checked_indices(dofindex, self.GetDOF(), "dofindex").tolist()
        if len(dofs) != 1:
            raise ArgumentError(f"GetJointFromDOFIndex: dofindex: are {dofs}, and should be one number")
        joints = self._state.scene.joints
        behind = itertools.accumulate(len(joint.axes) for joint in joints)  # the DOF behind each joint
        return self._all_joints()[next(index for index, end in enumerate(behind) if dofs[0] < end)]

    def GetAdjacentLinks(self) -> set[tuple[int, int]]:
        """Return the pairs of links, by index, that self-collision checks ignore."""
        return set(adjacent_pairs(self._state.scene))

    def GetJointIndex(self, name: str) -> int:
        """Return the index in ``GetJoints()`` of the joint of a name, or -1."""
        return next((joint.GetJointIndex() for joint in self.GetJoints() if joint.GetName() == name), -1)

    def IsDOFRevolute(self, dofindex: int) -> bool:
        """Return whether the DOF ``dofindex`` is an angle."""
        return self.GetJointFromDOFIndex(dofindex).IsRevolute()

    def IsDOFPrismatic(self, dofindex: int) -> bool:
        """Return whether the DOF ``dofindex`` is a length."""
        return self.GetJointFromDOFIndex(dofindex).IsPrismatic()

    def IsDOFInChain(self, linkindex1: int, linkindex2: int, dofindex: int) -> bool:
        """Return whether a DOF moves two links relative to each other.

        Args:
            linkindex1: Index of a link.
            linkindex2: Index of the other link.
            dofindex: Index of the DOF.
        """
        first, second = self.DoesDOFAffectLink(dofindex, linkindex1), self.DoesDOFAffectLink(dofindex, linkindex2)
        return first != second

    def DoesAffect(self, jointindex: int, linkindex: int) -> int:
        """Return 1 if a joint moves a link, directly or through mimic joints, else 0.

        Args:
            jointindex: Index of the joint, not of a DOF.
            linkindex: Index of the link.

        Raises:
            ArgumentError: there is no such joint or link.
        """
        joints = self.GetJoints()
        checked_index(jointindex, len(joints), "jointindex")
        return self.DoesDOFAffectLink(joints[jointindex].GetDOFIndex(), linkindex)

    def DoesDOFAffectLink(self, dofindex: int, linkindex: int) -> int:
        """Return 1 if a DOF moves a link, directly or through mimic joints, else 0.

        Args:
            dofindex: Index of the DOF.
            linkindex: Index of the link.

        Raises:
            ArgumentError: there is no such DOF or link.
        """
        checked_index(dofindex, self.GetDOF(), "dofindex")
        self._checked_link(linkindex)
        return int(dofindex in chains.dofs_moving(self._state.scene, linkindex))

    @overload
    def GetChain(self, linkindex1: int, linkindex2: int, returnjoints: Literal[True] = True) -> list[Joint]: ...
    @overload
    def GetChain(self, linkindex1: int, linkindex2: int, returnjoints: Literal[False]) -> list[Link]: ...
    def GetChain(self, linkindex1: int, linkindex2: int, returnjoints: bool = True) -> list[Joint] | list[Link]:
        """Return the chain of joints, or of links, from one link to another.

        Args:
            linkindex1: Index of the link to start from.
            linkindex2: Index of the link to reach.
            returnjoints: Whether to return the joints of the chain, including passive ones; otherwise its links,
                including both ends.

        Returns:
            Joints or links in order. The list is empty if no joints connect the links, or if they are the same.

        Raises:
            ArgumentError: there is no such link.

        Example:
            >>> [joint.GetName() for joint in robot.GetChain(0, 2)]
        """
        self._checked_link(linkindex1)
        self._checked_link(linkindex2)
        links, joints = chains.chain(self._state.scene, linkindex1, linkindex2)
        if not returnjoints:
            return self.GetLinks(links)
        every = self._all_joints()
        return [every[index] for index in joints]

    def GetDependencyOrderedJoints(self) -> list[Joint]:
        """Return the joints that have DOFs, each one after those that move it."""
        return self.GetJoints(chains.dependency_order(self._state.scene))

    def GetClosedLoops(self) -> list[list[tuple[Link, Joint]]]:
        """Return the closed loops of links: each is a list of links, each with the joint that leads to the next."""
        links, joints = self._all_links(), self._all_joints()
        return [
            [(links[link], joints[joint]) for link, joint in loop] for loop in chains.closed_loops(self._state.scene)
        ]

    def GetRigidlyAttachedLinks(self, linkindex: int) -> list[Link]:
        """Return the link of index ``linkindex``, then all links that no joint moves relative to it."""
        self._checked_link(linkindex)
        return self.GetLinks(chains.rigidly_attached(self._state.scene, linkindex))

    def GetKinematicsGeometryHash(self) -> str:
        """Return a hash of the body's links, geometries and joints, 32 hexadecimal digits.

        Pose, joint values, limits and names do not matter.
        """
        return self._state.made_once(hashes.of_body, self._state.scene)

    GetStructureHash = GetKinematicsGeometryHash

    def GetMass(self) -> float:
        """Return the mass of all links [kg]."""
        return sum(link.GetMass() for link in self.GetLinks())

    def IsVisible(self) -> bool:
        """Return whether any geometry of the body is drawn."""
        return any(link.IsVisible() for link in self.GetLinks())

    def SetVisible(self, visible: bool) -> bool:
        """Draw all geometries of the body, or none. Collision checks do not depend on it.

        Args:
            visible: Whether to draw them.

        Returns:
            Whether the visibility of any geometry has changed.
        """
        with self._simulation.lock:
            return any([link.SetVisible(visible) for link in self.GetLinks()])

    def GetURI(self) -> str:
        """Return the file that the body was read from, as ``file:/path``; empty for a body made in code.

        For ``InitFromBoxes`` and its like, it is their argument ``uri``.
        """
        if self._uri is not None:
            return self._uri
        file = self._state.scene.source.file
        archive, inside, _ = file.partition(_ARCHIVE + "/")  # documents in archives are sources of their own
        return "" if file in _NO_FILES else f"file:{os.path.abspath(archive + _ARCHIVE if inside else file)}"

    GetXMLFilename = GetURI

    def GetReferenceURI(self) -> str:
        """Return the file that the body refers to in OpenRAVE's JSON. It is empty, since ravemj reads no such files."""
        return ""

    def GetAssociatedFileEntries(self) -> None:
        """Return None. In OpenRAVE these are the files of a database that the body comes from."""

    def GetId(self) -> str:
        """Return the id that ``SetId`` set; empty in a new body."""
        return self._id

    def SetId(self, id: str) -> None:  # OpenRAVE's name of the argument
        """Set the text ``id``, for scripts that use ids. The environment identifies bodies by name."""
        self._id = str(id)

    def GetRevisionId(self) -> int:
        """Return 0. In OpenRAVE this is the revision of the body in a database."""
        return 0

    def GetLastModifiedAtUS(self) -> int:
        """Return 0. In OpenRAVE this is the time of the last change in a database."""
        return 0

    def GetManageData(self) -> None:
        """Return None, since ravemj has no sensor systems."""

    def serialize(self, options: int) -> str:
        """Return a text that determines links, geometries and joints of the body; ``options`` has no effect.

        ``GetKinematicsGeometryHash`` is the hash of this text. OpenRAVE writes another text.
        """
        del options
        return hashes.text_of_body(self._state.scene)

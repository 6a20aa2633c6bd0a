"""Tree of links and joints of a URDF."""

from collections.abc import Iterable, Iterator, Mapping

from ravemj.errors import Source, SourceError
from ravemj.formats.urdf.joint import UrdfJoint


class RobotTree:
    """Link tree of a URDF.

    Attributes:
        links: Source of each link by its name, in the order of the file.
        joints: The joints by name, in the order of the file, without floating joints.
        above: Parent joint of a link, by the link's name.
        below: Child joints of a link, by the link's name.
        floating: The floating joints, by their child links.
        roots: Names of the links without a parent joint.
        followers: Names of the mimic joints.
    """

    def __init__(
        self, links: Mapping[str, Source], joints: Iterable[UrdfJoint], floating: Mapping[str, UrdfJoint]
    ) -> None:
        """Build the tree from links and joints; floating joints are not part of it.

        Raises:
            SourceError: two joints carry the same link, or joints form a loop.
        """
        self.links = links
        self.floating = floating
        self.joints = {joint.name: joint for joint in joints}
        self.above: dict[str, UrdfJoint] = {}
        self.below: dict[str, list[UrdfJoint]] = {name: [] for name in links}
        self.followers: set[str] = set()
        for joint in self.joints.values():
            other = self.above.setdefault(joint.child, joint)
            if other is not joint:
                message = f"link '{joint.child}' is the child of two joints, '{other.name}' in line "
                message += f"{other.element.source.line} and '{joint.name}'"
                raise SourceError(message, joint.element.source, "URDF has no closed loops; leave out one of them")
            self.below[joint.parent].append(joint)
        self.roots = [name for name in links if name not in self.above]
        reached = {link for root in self.roots for link in self.descendants(root)}
        for joint in self.joints.values():
            if joint.child not in reached:
                message = f"joint '{joint.name}' and those that carry it make a loop, so nothing carries them"
                raise SourceError(message, joint.element.source, "exchange parent and child of one of them")

    def descendants(self, link: str) -> list[str]:
        """Return a link and its descendants, parents before children."""
        names = [link]
        for name in names:
            names += [joint.child for joint in self.below[name]]
        return names

    def path(self, link: str, base: str | None = None) -> list[UrdfJoint] | None:
        """Return the joints from a base, by default a root, to a link; None if the link is not below the base."""
        joints: list[UrdfJoint] = []
        while link != base and link in self.above:
            joints.append(self.above[link])
            link = joints[-1].parent
        return joints[::-1] if base in {None, link} else None

    def is_dof(self, joint: UrdfJoint) -> bool:
        """Return whether a joint moves and is not a mimic joint."""
        return joint.type != "fixed" and joint.name not in self.followers

    def dofs_below(self, link: str) -> Iterator[UrdfJoint]:
        """Yield the joints with a DOF below a link."""
        for name in self.descendants(link):
            yield from filter(self.is_dof, self.below[name])

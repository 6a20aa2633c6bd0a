"""Link trees of a body; each becomes a kinematics model."""

from typing import NamedTuple

from ravemj.model.scene import KinBody


class Tree(NamedTuple):
    """A root link and its descendants.

    Attributes:
        number: Its number in the document.
        root: The root link, which has no parent joint.
        links: The links, parents before children.
        joints: The joints, including those that close loops, by their index in ``KinBody.all_joints``.
        placing: For each link, its child joints in the tree.
    """

    number: int
    root: int
    links: tuple[int, ...]
    joints: tuple[int, ...]
    placing: dict[int, list[int]]

    @property
    def model(self) -> str:
        """The id of the kinematics model."""
        return f"kmodel{self.number}"


def trees_of(body: KinBody, first: int) -> list[Tree]:
    """Return the trees of a body, numbered from ``first``; an empty tree for a body without links."""
    joints = body.all_joints
    placing: dict[int, list[int]] = {}
    on_link: dict[int, list[int]] = {}
    placed: set[int] = set()
    for index, joint in enumerate(joints):
        on_link.setdefault(joint.parent, []).append(index)
        if joint.places_child:
            placing.setdefault(joint.parent, []).append(index)
            placed.add(joint.child)
    trees: list[Tree] = []
    for root in (link for link in range(len(body.links)) if link not in placed):
        links = [root]
        for link in links:  # grows meanwhile
            links += [joints[index].child for index in placing.get(link, ())]
        own = sorted(index for link in links for index in on_link.get(link, ()))
        trees.append(Tree(first + len(trees), root, tuple(links), tuple(own), placing))
    return trees or [Tree(first, 0, (), (), {})]

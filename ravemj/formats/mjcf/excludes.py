"""``<exclude>``: the pairs of links that MuJoCo would test for collisions and OpenRAVE does not.

MuJoCo ignores pairs within a weld group, whose links no joint separates, and pairs of a group and its parent group,
except the world's. Excluding only the other pairs keeps the text small: its size is linear in the number of links.
Only movable links without a joint between them are excluded pair by pair.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import combinations, product

from ravemj.core.graphs import Pair, connected_components, ordered_pair
from ravemj.model.scene import KinBody

_WORLD = -1

_Cells = dict[int, list[int]]
"""Links by weld group."""


@dataclass(slots=True)
class WeldGroups:
    """The links of a body by MuJoCo's weld groups.

    Attributes:
        group: For each link the first link of its weld group; negative for links fixed to the world.
        carrier: For each moving group its parent group.
        solid: Links with collision geometry.
    """

    group: dict[int, int] = field(default_factory=lambda: {})
    carrier: dict[int, int] = field(default_factory=lambda: {})
    solid: list[int] = field(default_factory=lambda: [])

    def add(self, link: int, parent: int | None, *, moves: bool, solid: bool) -> None:
        """Add a link after its parent.

        Args:
            link: Its index.
            parent: Index of its parent link, or None for the world.
            moves: Whether a MuJoCo joint connects them.
            solid: Whether it has collision geometry.
        """
        carrier = _WORLD if parent is None else self.group[parent]
        self.group[link] = link if moves else carrier
        if moves:
            self.carrier[link] = carrier
        if solid:
            self.solid.append(link)

    def are_tested(self, first: int, second: int) -> bool:
        """Return whether MuJoCo tests the links of two groups against each other."""
        if first == second:
            return False
        if _WORLD in (first, second):
            return True
        return self.carrier[first] != second and self.carrier[second] != first

    def tested_pairs(self, first: Mapping[int, list[int]], second: Mapping[int, list[int]]) -> Iterator[Pair]:
        """Yield the pairs of links of two collections, sorted by group, that MuJoCo tests."""
        for group, other in product(first, second):
            if self.are_tested(group, other):
                for link, partner in product(first[group], second[other]):
                    yield ordered_pair(link, partner)


def excluded_pairs(body: KinBody, welds: WeldGroups) -> list[Pair]:
    """Return the pairs of links to be excluded from MuJoCo's collision tests.

    Args:
        body: The body.
        welds: The weld groups of its links.

    Returns:
        Pairs of link indices, the smaller one first, sorted.
    """
    if len(welds.solid) < 2:
        return []
    joints = body.all_joints
    count = len(body.links)
    solid = set(welds.solid)
    named = [(link, other) for link, other in body.adjacent if link in solid and other in solid]
    pairs = {(link, other) for link, other in named if welds.are_tested(welds.group[link], welds.group[other])}
    if not body.joined_links_adjacent:
        return sorted(pairs)
    rigid = connected_components(count, ((joint.parent, joint.child) for joint in joints if joint.static))
    parts = _cells(rigid, welds)
    joined = {ordered_pair(rigid[joint.parent], rigid[joint.child]) for joint in joints}
    for first_part, other in joined | {(part, part) for part in parts}:
        pairs.update(welds.tested_pairs(parts.get(first_part, {}), parts.get(other, {})))
    trees = _cells(connected_components(count, ((joint.parent, joint.child) for joint in joints)), welds).values()
    moving = [tree for tree in trees if tree.keys() != {_WORLD}]
    fixed = {_WORLD: [link for tree in trees if tree.keys() == {_WORLD} for link in tree[_WORLD]]}
    for first_part, other in (*combinations(moving, 2), *product(moving, [fixed])):
        pairs.update(welds.tested_pairs(first_part, other))
    return sorted(pairs)


def _cells(labels: list[int], welds: WeldGroups) -> dict[int, _Cells]:
    """Return the links with collision geometry by connected component (``labels``), then by weld group."""
    cells: dict[int, _Cells] = {}
    for link in welds.solid:
        cells.setdefault(labels[link], {}).setdefault(welds.group[link], []).append(link)
    return cells

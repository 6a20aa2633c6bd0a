"""Graph of a body's links and joints: chains, loops, rigid parts, adjacent links.

Joint indices count active joints, then passive ones.
"""

import itertools

from ravemj.core.caching import cached_property
from ravemj.core.graphs import Pair, ShortestPaths, connected_components, nodes_between, ordered_pair
from ravemj.model.scene import KinBody, Manipulator


class Connections:
    """Tables of the links that joints connect, cached because scripts query them in loops.

    Attributes:
        joints: The joints.
        dofs: For each active joint its DOFs.
    """

    def __init__(self, body: KinBody) -> None:
        self.joints = body.all_joints
        self._joined_by = body.joints, body.passive_joints  # stored, so that their ``id`` is not reused
        self._count = len(body.links)
        ends = list(itertools.accumulate((len(joint.axes) for joint in body.joints), initial=0))
        self.dofs = [tuple(range(*pair)) for pair in itertools.pairwise(ends)]
        self._between: dict[int, set[int]] = {}
        self._above: dict[int, tuple[int, ...]] = {}
        self._moving: dict[int, frozenset[int]] = {}

    @cached_property
    def ends(self) -> list[Pair]:
        """Parent and child of each joint."""
        return [(joint.parent, joint.child) for joint in self.joints]

    @cached_property
    def paths(self) -> ShortestPaths:
        """Shortest paths between all links."""
        return ShortestPaths(self._count, self.ends)

    @cached_property
    def close_pairs(self) -> frozenset[Pair]:
        """Pairs of links that are connected by a joint, or by a shortest path with at most one moving joint."""
        near = self.paths.light_pairs([not joint.static for joint in self.joints])
        return frozenset(itertools.starmap(ordered_pair, self.ends)).union(near)

    @cached_property
    def parts(self) -> list[int]:
        """For each link, the first link of its connected component."""
        return connected_components(self._count, self.ends)

    @cached_property
    def _placing(self) -> dict[int, int]:
        """Joint index by link, for each link that is the child of a joint in the kinematic tree."""
        return {joint.child: index for index, joint in enumerate(self.joints) if joint.places_child}

    def between(self, link: int) -> set[int]:
        """Return the links on simple paths from link 0 to a link."""
        if link not in self._between:
            self._between[link] = nodes_between(self.ends, self._count, 0, link)
        return self._between[link]

    def above(self, link: int) -> tuple[int, ...]:
        """Return the joints from a link up the kinematic tree to its root, the nearest first."""
        if link not in self._above:
            above: list[int] = []
            at = link
            while at in self._placing:
                above.append(self._placing[at])
                at = self.joints[above[-1]].parent
            self._above[link] = tuple(above)
        return self._above[link]

    def moving(self, link: int) -> frozenset[int]:
        """Return the DOFs that move a link, also through mimic joints."""
        if link not in self._moving:
            dofs: set[int] = set()
            for index in self.above(link):
                mimic = self.joints[index].mimic
                if mimic is not None:
                    dofs.update(mimic.dofs)
                elif index < len(self.dofs):
                    dofs.update(self.dofs[index])
            self._moving[link] = frozenset(dofs)
        return self._moving[link]


_MOST_BODIES = 16
_known: dict[tuple[int, int, int], Connections] = {}
"""Connections of bodies, cached by the identity of their joints; few, since the cache keeps joints alive."""


def connections(body: KinBody) -> Connections:
    """Return the connections of a body's links, cached as long as the joints are the same."""
    key = id(body.joints), id(body.passive_joints), len(body.links)
    graph = _known.get(key)
    if graph is None:
        if len(_known) >= _MOST_BODIES:
            _known.clear()
        graph = _known[key] = Connections(body)
    return graph


def joint_dofs(body: KinBody, joint: int) -> tuple[int, ...]:
    """Return the DOFs of an active joint."""
    return connections(body).dofs[joint]


def parents(body: KinBody, link: int) -> list[int]:
    """Return the parent links of a link."""
    return list(dict.fromkeys(joint.parent for joint in body.all_joints if joint.child == link))


def rigidly_attached(body: KinBody, link: int) -> list[int]:
    """Return a link, then the links connected to it by welds."""
    welds = ((joint.parent, joint.child) for joint in body.all_joints if joint.static)
    parts = connected_components(len(body.links), welds)
    return [link, *(other for other, part in enumerate(parts) if part == parts[link] and other != link)]


def chain(body: KinBody, first: int, last: int) -> tuple[list[int], list[int]]:
    """Return the shortest path from one link to another.

    Returns:
        The links on the path, including both ends, and the joints between them; empty if there is no path, or the links
        are equal.
    """
    ends, joints = connections(body).ends, connections(body).paths.path(first, last)
    links = [first]
    for joint in joints:
        links.append(sum(ends[joint]) - links[-1])
    return (links, joints) if joints else ([], [])


def joints_above(body: KinBody, link: int) -> tuple[int, ...]:
    """Return the joints from a link up the kinematic tree to its root, the nearest first."""
    return connections(body).above(link)


def dofs_moving(body: KinBody, link: int) -> frozenset[int]:
    """Return the DOFs that move a link, also through mimic joints."""
    return connections(body).moving(link)


def dependency_order(body: KinBody) -> list[int]:
    """Return the active joints in the order from the root, so that each follows the joints that move its links."""

    def depth(index: int) -> tuple[int, int, int]:
        joint = body.joints[index]
        near, far = sorted(len(joints_above(body, link)) for link in (joint.parent, joint.child))
        return near, far, index

    return sorted(range(len(body.joints)), key=depth)


def closed_loops(body: KinBody) -> list[list[tuple[int, int]]]:
    """Return the kinematic loop of each loop-closing joint: its links, each with the joint to the next link."""
    joints, loops = body.all_joints, list[list[tuple[int, int]]]()
    for index, joint in enumerate(joints):
        if joint.places_child:
            continue
        up, down = list(joints_above(body, joint.child)), list(joints_above(body, joint.parent))
        while up and down and up[-1] == down[-1]:  # above the lowest common ancestor
            del up[-1], down[-1]
        links = [joint.child, *(joints[climbed].parent for climbed in up)]
        if links[-1] == (joints[down[-1]].parent if down else joint.parent):  # otherwise both have different roots
            links += [joints[climbed].child for climbed in reversed(down)]
            loops.append(list(zip(links, [*up, *reversed(down), index], strict=True)))
    return loops


def links_beyond(body: KinBody, manipulator: Manipulator) -> list[int]:
    """Return the end effector of a manipulator, links fixed to it, their descendants, and links that move with it.

    A link moves with the effector if all DOFs that move the effector also move it, possibly through mimic joints.
    """
    if manipulator.effector is None:
        return []
    known = connections(body)
    fixed = set(rigidly_attached(body, manipulator.effector))
    from_fixed = {index for index, joint in enumerate(known.joints) if joint.parent in fixed}
    moving = known.moving(manipulator.effector) | set(manipulator.arm_dofs)

    def takes_part(link: int) -> bool:
        hangs = link in fixed or not from_fixed.isdisjoint(known.above(link))
        return hangs or (bool(moving) and moving <= known.moving(link))

    return [link for link in range(len(body.links)) if takes_part(link)]


def joints_beyond(body: KinBody, manipulator: Manipulator) -> list[int]:
    """Return the active joints between links beyond a manipulator's arm."""
    beyond = set(links_beyond(body, manipulator))
    return [
        index
        for index, joint in enumerate(body.joints)
        if joint.parent in beyond and not set(joint_dofs(body, index)) & set(manipulator.arm_dofs)
    ]


def independent_links(body: KinBody, manipulator: Manipulator) -> list[int]:
    """Return the links that are moved neither by the arm nor by the gripper."""
    own = {*manipulator.arm_dofs, *manipulator.gripper_dofs}
    return [link for link in range(len(body.links)) if not dofs_moving(body, link) & own]


def separate_pairs(body: KinBody) -> list[Pair]:
    """Return the sorted pairs of links that are not adjacent, the smaller index first; see ``adjacent_pairs``."""
    known = connections(body)
    groups: dict[int, list[int]] = {}
    for link, moved in enumerate(body.links):
        if moved.geometries:
            groups.setdefault(known.parts[link] if body.joined_links_adjacent else 0, []).append(link)
    left_out = {*body.adjacent, *(known.close_pairs if body.joined_links_adjacent else ())}
    pairs = (pair for group in groups.values() for pair in itertools.combinations(group, 2))
    return sorted(pair for pair in pairs if pair not in left_out)


def adjacent_pairs(body: KinBody) -> frozenset[Pair]:
    """Return the pairs of adjacent links, which OpenRAVE's self-collision check ignores.

    These are pairs connected by a joint, or by a shortest path with at most one moving joint, unconnected pairs, pairs
    declared by ``<adjacent>``, and pairs with a link without shapes. If a body's ``joined_links_adjacent`` is False,
    the first three kinds are not adjacent.

    Returns:
        Pairs of link indices, the smaller one first.
    """
    pairs = frozenset(itertools.combinations(range(len(body.links)), 2))
    return pairs.difference(separate_pairs(body)).union(body.adjacent if pairs else ())

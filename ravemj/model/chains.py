"""The graph of links and joints of a body: chains, loops, rigid parts.

Joints are counted as in a body's list: active ones, then passive ones.
"""

from collections import deque
from collections.abc import Callable

from ravemj.core.graphs import ShortestPaths
from ravemj.model.scene import Joint, KinBody, Manipulator


def joint_dofs(body: KinBody, joint: int) -> tuple[int, ...]:
    """Return the DOFs of an active joint."""
    first = sum(len(other.axes) for other in body.joints[:joint])
    return tuple(range(first, first + len(body.joints[joint].axes)))


def parents(body: KinBody, link: int) -> list[int]:
    """Return the links that joints hang a link on."""
    return list(dict.fromkeys(joint.parent for joint in body.all_joints if joint.child == link))


def rigidly_attached(body: KinBody, link: int) -> list[int]:
    """Return a link and those that welds fix to it; the link is the first."""
    reached = _search(body, link, lambda joint: joint.static)
    return [link, *sorted(reached.keys() - {link})]


def chain(body: KinBody, first: int, last: int) -> tuple[list[int], list[int]]:
    """Return the shortest way from one link to another.

    Returns:
        The links on it, both ends included, and the joints between them; none where there is no way, or no need of one.
    """
    ends = [(joint.parent, joint.child) for joint in body.all_joints]
    joints = ShortestPaths(len(body.links), ends).path(first, last)
    links = [first]
    for joint in joints:
        links.append(sum(ends[joint]) - links[-1])
    return (links, joints) if joints else ([], [])


def _search(body: KinBody, start: int, passes: Callable[[Joint], bool]) -> dict[int, tuple[int, int]]:
    """Walk the graph breadth first; return for each link the joint and the link that it was reached by."""
    neighbours: dict[int, list[tuple[int, int]]] = {}
    for index, joint in enumerate(body.all_joints):
        if passes(joint):
            neighbours.setdefault(joint.parent, []).append((index, joint.child))
            neighbours.setdefault(joint.child, []).append((index, joint.parent))
    reached = {start: (-1, start)}
    queue = deque([start])
    while queue:
        link = queue.popleft()
        for joint, other in neighbours.get(link, ()):
            if other not in reached:
                reached[other] = (joint, link)
                queue.append(other)
    return reached


def _way_back(reached: dict[int, tuple[int, int]], first: int, last: int) -> tuple[list[int], list[int]]:
    links, joints = [last], list[int]()
    while links[-1] != first:
        joint, link = reached[links[-1]]
        joints.append(joint)
        links.append(link)
    return links[::-1], joints[::-1]


def joints_above(body: KinBody, link: int) -> list[int]:
    """Return the joints that place a link and the links that it hangs on, the nearest first."""
    joints = body.all_joints
    placing = {joint.child: index for index, joint in enumerate(joints) if joint.places_child}
    above: list[int] = []
    while link in placing:
        above.append(placing[link])
        link = joints[placing[link]].parent
    return above


def dofs_moving(body: KinBody, link: int) -> set[int]:
    """Return the DOFs that move a link, also through joints that follow them."""
    joints = body.all_joints
    moving: set[int] = set()
    for index in joints_above(body, link):
        mimic = joints[index].mimic
        if mimic is not None:
            moving.update(mimic.dofs)
        elif index < len(body.joints):
            moving.update(joint_dofs(body, index))
    return moving


def dependency_order(body: KinBody) -> list[int]:
    """Return the active joints, each behind those that move the links at it; else those nearer to the root first."""

    def depth(index: int) -> tuple[int, int, int]:
        joint = body.joints[index]
        near, far = sorted(len(joints_above(body, link)) for link in (joint.parent, joint.child))
        return near, far, index

    return sorted(range(len(body.joints)), key=depth)


def closed_loops(body: KinBody) -> list[list[tuple[int, int]]]:
    """Return for each joint that closes a loop the loop: links, each with the joint that leads on from it."""
    loops: list[list[tuple[int, int]]] = []
    for index, joint in enumerate(body.all_joints):
        if not joint.places_child:
            reached = _search(body, joint.child, lambda other: other.places_child)
            if joint.parent in reached:
                links, joints = _way_back(reached, joint.child, joint.parent)
                loops.append(list(zip(links, [*joints, index], strict=True)))
    return loops


def links_beyond(body: KinBody, manipulator: Manipulator) -> list[int]:
    """Return the effector of a manipulator, what is fixed to it, what hangs on these, and what moves with it.

    A link moves with the effector if all DOFs that move the effector move it, also through joints that follow them.
    """
    if manipulator.effector is None:
        return []
    joints = body.all_joints
    fixed = set(rigidly_attached(body, manipulator.effector))
    moving = dofs_moving(body, manipulator.effector) | set(manipulator.arm_dofs)

    def hangs(link: int) -> bool:
        return link in fixed or any(joints[index].parent in fixed for index in joints_above(body, link))

    def follows(link: int) -> bool:
        return bool(moving) and moving <= dofs_moving(body, link)

    return [link for link in range(len(body.links)) if hangs(link) or follows(link)]


def joints_beyond(body: KinBody, manipulator: Manipulator) -> list[int]:
    """Return the active joints between the links beyond a manipulator's arm."""
    beyond = set(links_beyond(body, manipulator))
    return [
        index
        for index, joint in enumerate(body.joints)
        if joint.parent in beyond and not set(joint_dofs(body, index)) & set(manipulator.arm_dofs)
    ]


def independent_links(body: KinBody, manipulator: Manipulator) -> list[int]:
    """Return the links that neither the arm nor the gripper of a manipulator moves."""
    own = {*manipulator.arm_dofs, *manipulator.gripper_dofs}
    return [link for link in range(len(body.links)) if not dofs_moving(body, link) & own]

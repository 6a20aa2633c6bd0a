"""Manipulators of robots without an SRDF, guessed from the link tree and names."""

import re

from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.urdf import GUESSES
from ravemj.formats.urdf.joint import UrdfJoint
from ravemj.formats.urdf.tree import RobotTree
from ravemj.model.manipulators import ManipulatorBuilder

_TOOLS = (
    "tool 0", "tcp", "end effector", "eef", "ee", "tool frame", "tool", "attachment", "flange", "palm", "gripper",
    "hand", "jaw",
)  # fmt: skip
"""Words in names of tool links, the most reliable first."""

_WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_LEAST_DOFS, _MOST_ARMS = 3, 8


def guess(
    tree: RobotTree,
    root: Element,
    context: Context,
    reason: str = "no SRDF describes the arms",
    hint: str = "--srdf FILE gives the robot's own",
) -> list[ManipulatorBuilder]:
    """Return guessed manipulators: links with the name of a tool after three or more DOFs.

    If no link has the name of a tool, the ends of the longest chains are used. Joints beyond the tool belong to the
    gripper. A note names the guessed manipulators, with ``reason`` and ``hint``.
    """
    named = [(rank, link) for link in tree.links if (rank := _rank(link)) is not None]
    arms = _arms([link for _, link in sorted(named, key=lambda pair: pair[0])], tree) or _arms(_longest(tree), tree)
    if arms:
        counts = [f"'{arm.name}' ({len(_dofs(arm.effector, tree))} joints)" for arm in arms]
        noun = "a guessed manipulator" if len(arms) == 1 else "guessed manipulators"
        context.diagnostics.note(GUESSES, f"{reason}; {noun}: {', '.join(counts)}", root.source, hint)
    return arms


def _arms(tools: list[str], tree: RobotTree) -> list[ManipulatorBuilder]:
    """Return an arm for each tool link, in file order; of tools with the same last joint, only the first gets one."""
    arms: dict[str, ManipulatorBuilder] = {}  # by the last joint
    dofs = {link: _dofs(link, tree) for link in tools}
    for link in tools:
        if len(dofs[link]) < _LEAST_DOFS or dofs[link][-1].name in arms or _is_beyond(link, dofs, tree):
            continue
        last = dofs[link][-1]
        gripper = [joint.name for joint in tree.dofs_below(last.child)]
        arms[last.name] = ManipulatorBuilder(link, tree.links[link], base_of(tree, link), link, gripper_joints=gripper)
    places = {link: place for place, link in enumerate(tree.links)}
    return sorted([*arms.values()][:_MOST_ARMS], key=lambda arm: places[arm.effector])


def _rank(link: str) -> int | None:
    """Return the index in `_TOOLS` of the first tool word in a link's name; None if there is none."""
    words = f" {' '.join(_WORDS.findall(link)).lower()} "
    return next((rank for rank, tool in enumerate(_TOOLS) if f" {tool} " in words), None)


def _longest(tree: RobotTree) -> list[str]:
    """Return the last moving link of each chain; the chain with the most DOFs comes first."""
    ends = [link for link, joint in tree.above.items() if tree.is_dof(joint) and not any(tree.dofs_below(link))]
    return sorted(ends, key=lambda link: -len(_dofs(link, tree)))


def _dofs(link: str, tree: RobotTree) -> list[UrdfJoint]:
    """Return the movable joints from the base of an arm to the link ``link``."""
    return [joint for joint in tree.path(link, base_of(tree, link)) or [] if tree.is_dof(joint)]


def base_of(tree: RobotTree, link: str) -> str:
    """Return the base of an arm: the nearest branching ancestor above at least three DOFs; else the root."""
    count = 0
    while link in tree.above:
        joint = tree.above[link]
        link = joint.parent
        count += tree.is_dof(joint)
        branches = [branch for branch in tree.below[link] if tree.is_dof(branch) or any(tree.dofs_below(branch.child))]
        if count >= _LEAST_DOFS and len(branches) > 1:
            break
    return link


def _is_beyond(link: str, dofs: dict[str, list[UrdfJoint]], tree: RobotTree) -> bool:
    """Return whether a link is below the tool of another arm, and moved by joints of that arm's gripper."""
    above = {joint.parent for joint in tree.path(link) or []} & dofs.keys()
    return any(len(dofs[other]) >= _LEAST_DOFS and dofs[other][-1] is not dofs[link][-1] for other in above)

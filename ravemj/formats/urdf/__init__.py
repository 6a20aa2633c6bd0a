"""Reader of URDF and SRDF, the robot formats of ROS.

``robot`` traverses a document and fills a ``BodyBuilder``; ``link``, ``shapes`` and ``joint`` each read one kind of
element, ``packages`` finds the files of URIs, ``srdf`` reads the second file of MoveIt and or_urdf, and ``arms``
guesses manipulators if there is none. The interpretation is that of urdfdom, the parser of ROS; if urdfdom refuses a
mistake that leaves the robot usable, the robot is read and the mistake is reported.
"""

from typing import TYPE_CHECKING

from ravemj.errors import SourceError

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml.tree import Element

GIVEN = {
    "srdf": "of a URDF: its SRDF, a file or a text; by default the one beside it; `none`: neither that nor guesses",
    "state": "of a URDF: the group state of its SRDF that gives the joint values",
    "packages": "of a URDF: folders of packages, `NAME=FOLDER`; several are separated as in PATH",
    "args": "of a xacro: its arguments, `name:=value`, separated by blanks",
    "like": "of a URDF: `or_urdf` sorts links and joints by name, and makes no robot without an SRDF that is named",
}
"""Attributes that a caller may pass with a URDF, with their meanings."""

OR_URDF = "or_urdf"
"""OpenRAVE's plugin for URDF; scripts expect bodies with its properties from its module."""

GUESSES = "guessed-manipulators"
"""Code of the note that names guessed manipulators; commands print the note."""


def is_urdf(root: "Element") -> bool:
    """Return whether a ``<robot>`` element is a robot of URDF, not of OpenRAVE.

    In a URDF, a joint has a ``<parent link="…">``, or there are links and no ``<kinbody>``.
    """
    if root.tag != "robot":
        return False
    joints = (child for child in root.children if child.tag == "joint")
    if any("link" in part.attributes for joint in joints for part in joint.children if part.tag == "parent"):
        return True
    tags = {child.tag for child in root.children}
    return "link" in tags and "kinbody" not in tags


def check_robot(root: "Element") -> None:
    """Refuse a ``<robot>`` that belongs neither to URDF nor to OpenRAVE.

    Raises:
        SourceError: it is a xacro, or the root of an SRDF.
    """
    tags = {child.spelled for child in root.children} if root.spelled == "robot" else set[str]()
    if any(tag.startswith("xacro:") for tag in tags):
        raise SourceError("this is a xacro, and only a file that its user opens is expanded", root.source)
    if tags & _SRDF_TAGS and not tags & {"link", "kinbody", "KinBody", "Robot"}:
        hint = f"open its URDF with --srdf {root.source.file}"
        raise SourceError("this is an SRDF, which belongs to a URDF", root.source, hint)


_SRDF_TAGS = {"group", "disable_collisions", "group_state", "end_effector"}

"""Writer of SRDF: manipulators as groups and end effectors, named configurations, pairs of links that may touch."""

from collections.abc import Callable, Sequence

from ravemj.formats.xml_text import XmlText
from ravemj.model.chains import adjacent_pairs
from ravemj.model.scene import KinBody, Link, Manipulator, NoShape


def srdf_text(
    body: KinBody,
    links: Sequence[str],
    joints: Sequence[str],
    arms: Sequence[Manipulator],
    lose: Callable[[str, str], None],
) -> str:
    """Return the SRDF of a body.

    Args:
        body: The body.
        links: Names of its links in the URDF; effectors of ``arms`` may be additional links of the URDF.
        joints: Names of its joints in the URDF.
        arms: Its manipulators.
        lose: Receives the kind of each omitted property, and a name.
    """
    out = XmlText()
    with out.inside("robot", name=body.name):
        for arm in arms:
            _arm(out, arm, links, joints, lose)
        for state in body.configurations:
            if arms:
                with out.inside("group_state", name=state.name, group=arms[0].name):
                    for joint, value in state.values:
                        out.element("joint", name=joint, value=value)
            else:
                lose("SRDF's states belong to manipulators; a configuration is left out", state.name)
        collides = [_collides(link) for link in body.links]
        for first, second in sorted(adjacent_pairs(body)):
            if collides[first] and collides[second]:
                out.element("disable_collisions", link1=links[first], link2=links[second], reason="Default")
    return out.document()


def _collides(link: Link) -> bool:
    shapes = [geometry.shape for geometry in link.geometries if not isinstance(geometry.shape, NoShape)]
    return any(shape.solids() or len(shape.triangulated().triangles) for shape in shapes)


def _arm(
    out: XmlText, arm: Manipulator, links: Sequence[str], joints: Sequence[str], lose: Callable[[str, str], None]
) -> None:
    if arm.base is None or arm.effector is None:
        lose("a manipulator without base or effector is left out", arm.name)
        return
    if arm.direction != (0.0, 0.0, 1.0):
        lose("the direction of a manipulator is left out; it is z", arm.name)
    if any(arm.chucking_direction):
        lose("the directions in which a gripper closes are left out", arm.name)
    with out.inside("group", name=arm.name):
        out.element("chain", base_link=links[arm.base], tip_link=links[arm.effector])
    if arm.gripper_joints:
        gripper = f"{arm.name}_gripper"
        with out.inside("group", name=gripper):
            for joint in arm.gripper_joints:
                out.element("joint", name=joints[joint])
        parent = {"parent_link": links[arm.effector], "parent_group": arm.name}
        out.element("end_effector", name=arm.name, group=gripper, **parent)

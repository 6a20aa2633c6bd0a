"""Tables of bodies and joints for notebooks. They are HTML without styles, so the notebook's theme sets the colours."""

from collections.abc import Iterable
from html import escape
from typing import TYPE_CHECKING

from ravemj.errors import RavemjError

if TYPE_CHECKING:
    from ravemj.rave.joint import Joint
    from ravemj.rave.kinbody import KinBody

Row = list[str]


def body_table(body: "KinBody") -> str:
    """Return a table of a body's DOFs with values and limits, and a folded table of its links with masses."""
    kind, links = "robot" if body.IsRobot() else "body", body.GetLinks()
    title = f"<b>{escape(body.GetName())}</b> ({kind}, {body.GetDOF()} DOF)"
    dofs = [row for joint in body.GetJoints() for row in _axes(joint)]
    masses = [[str(link.GetIndex()), escape(link.GetName()), f"{link.GetMass():.4g} kg"] for link in links]
    total = sum(link.GetMass() for link in links)
    folded = f"<details><summary>{len(links)} links, {total:.4g} kg</summary>"
    return f"{title}{_table(dofs)}{folded}{_table(masses, ('index', 'link', 'mass'))}</details>"


def joint_table(joint: "Joint") -> str:
    """Return a table of a joint's axes with values and limits."""
    body = joint.GetParent()
    title = f"<b>{escape(joint.GetName())}</b> ({joint.GetType().name}, joint of {escape(body.GetName())})"
    return f"{title}{_table(_axes(joint))}"


_HEADINGS = ("DOF", "joint", "value", "limits", "unit")


def _axes(joint: "Joint") -> Iterable[Row]:
    """Return a row for each axis of a joint."""
    try:
        values = [f"{value:.4g}" for value in joint.GetValues()]
    except RavemjError:  # a body outside of an environment has no joint values
        values = ["?"] * joint.GetDOF()
    first, (lower, upper) = joint.GetDOFIndex(), joint.GetLimits()
    for axis, value in enumerate(values):
        name = escape(joint.GetName()) + (f", axis {axis}" if len(values) > 1 else "")
        limits = "none" if joint.IsCircular(axis) else f"{lower[axis]:.4g} … {upper[axis]:.4g}"
        dof = "" if first < 0 else str(first + axis)
        yield [dof, name, value, limits, "m" if joint.IsPrismatic(axis) else "rad"]


def _table(rows: Iterable[Row], headings: Iterable[str] = _HEADINGS) -> str:
    """Return the HTML of a table whose cells are HTML already; an empty text for no rows."""
    head = "".join(f"<th>{heading}</th>" for heading in headings)
    body = "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>" if body else ""

"""Tables of environments, bodies and joints: HTML for notebooks, text for IPython in a terminal.

The HTML has no styles, so the notebook's theme sets the colours.
"""

from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

from ravemj.errors import RavemjError

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.joint import Joint
    from ravemj.rave.kinbody import KinBody

Row = list[str]


def body_table(body: "KinBody") -> str:
    """Return a table of a body's DOFs with values and limits, and a folded table of its links with masses."""
    title = f"<b>{escape(body.GetName())}</b> ({_kind(body)}, {body.GetDOF()} DOF)"
    dofs = [row for joint in body.GetJoints() for row in _axes(joint)]
    masses = [[str(link.GetIndex()), link.GetName(), f"{link.GetMass():.4g} kg"] for link in body.GetLinks()]
    folded = f"<details><summary>{_links(body)}</summary>"
    return f"{title}{_table(dofs)}{folded}{_table(masses, ('index', 'link', 'mass'))}</details>"


def body_text(body: "KinBody") -> str:
    """Return the table of a body's DOFs as text."""
    title = f"{body.GetName()} ({_kind(body)}, {body.GetDOF()} DOF, {_links(body)})"
    return "\n".join([title, *_aligned(_HEADINGS, [row for joint in body.GetJoints() for row in _axes(joint)])])


def _kind(body: "KinBody") -> str:
    return "robot" if body.IsRobot() else "body"


def _links(body: "KinBody") -> str:
    links = body.GetLinks()
    return f"{len(links)} link{'s' * (len(links) != 1)}, {sum(link.GetMass() for link in links):.4g} kg"


def joint_table(joint: "Joint") -> str:
    """Return a table of a joint's axes with values and limits."""
    body = joint.GetParent()
    title = f"<b>{escape(joint.GetName())}</b> ({joint.GetType().name}, joint of {escape(body.GetName())})"
    return f"{title}{_table(_axes(joint))}"


def joint_text(joint: "Joint") -> str:
    """Return the table of a joint's axes as text."""
    title = f"{joint.GetName()} ({joint.GetType().name}, joint of {joint.GetParent().GetName()})"
    return "\n".join([title, *_aligned(_HEADINGS, list(_axes(joint)))])


def environment_text(env: "Environment") -> str:
    """Return a table of the bodies of an environment as text."""
    rows = [[body.GetName(), _kind(body), str(body.GetDOF()), _links(body)] for body in env.GetBodies()]
    title = f"environment {env!r}: {len(rows) or 'no'} bod{'y' if len(rows) == 1 else 'ies'}"
    return "\n".join([title, *_aligned(("name", "kind", "DOF", "links"), rows)])


def print_pretty(printer: Any, thing: object, text: str) -> None:  # noqa: ANN401 - IPython's
    """Print a table in IPython; within a list or another container, print the ``repr``."""
    printer.text(text if len(printer.stack) == 1 else repr(thing))


def _aligned(headings: Sequence[str], rows: Sequence[Row]) -> list[str]:
    """Return the lines of a table with aligned columns; an empty list if there are no rows."""
    cells = [list(headings), *rows] if rows else []
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in cells]


_HEADINGS = ("DOF", "joint", "value", "limits", "unit")


def _axes(joint: "Joint") -> Iterable[Row]:
    try:
        values = [f"{value:.4g}" for value in joint.GetValues()]
    except RavemjError:  # a body outside of an environment has no joint values
        values = ["?"] * joint.GetDOF()
    first, (lower, upper) = joint.GetDOFIndex(), joint.GetLimits()
    for axis, value in enumerate(values):
        name = joint.GetName() + (f", axis {axis}" if len(values) > 1 else "")
        limits = "none" if joint.IsCircular(axis) else f"{lower[axis]:.4g} … {upper[axis]:.4g}"
        dof = "" if first < 0 else str(first + axis)
        yield [dof, name, value, limits, "m" if joint.IsPrismatic(axis) else "rad"]


def _table(rows: Iterable[Row], headings: Iterable[str] = _HEADINGS) -> str:
    """Return a table as HTML; an empty string if there are no rows."""
    head = "".join(f"<th>{heading}</th>" for heading in headings)
    body = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>" if body else ""

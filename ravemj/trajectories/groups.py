"""Groups of values in a configuration, and the information in their names.

A name is a kind and further words: ``joint_values BODY INDEX...``, ``affine_transform BODY PARTS [AXIS]``,
``ikparam_values TYPE``, ``deltatime``. The kinds of derivatives have names of their own.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from ravemj.core.transforms import Vec3
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.affine import Z_AXIS

_RATES = ("velocities", "accelerations", "jerks", "snaps", "crackles", "pops")
JOINTS = ("joint_values", *(f"joint_{rate}" for rate in _RATES))
AFFINE = ("affine_transform", *(f"affine_{rate}" for rate in _RATES))
IK = ("ikparam_values", *(f"ikparam_{rate}" for rate in _RATES))
FAMILIES = (JOINTS, AFFINE, IK)
"""Group kinds, each followed by the kinds of its time derivatives."""

DELTATIME = "deltatime"
INTERPOLATIONS = ("next", "linear", "quadratic", "cubic", "quartic", "quintic", "sextic")
"""Interpolations by increasing degree; each is the derivative of the next."""


@dataclass(repr=False)
class Group:
    """Group of related values in a configuration.

    Attributes:
        name: The kind of the values, then their body and further words, for instance ``joint_values BarrettWAM 0 1 2``.
        offset: The index of the first value in the configuration.
        dof: The number of values.
        interpolation: The interpolation between waypoints: ``previous``, ``next``, ``linear``, ``quadratic``,
            ``cubic``, ``quartic``, ``quintic``, ``sextic`` or ``max``; empty is ``next``.
    """

    name: str = ""
    offset: int = 0
    dof: int = 0
    interpolation: str = ""

    def __repr__(self) -> str:
        values = f"{self.name!r}, {self.offset}, {self.dof}, {self.interpolation!r}"
        return f"ConfigurationSpecification.Group({values})"

    @property
    def columns(self) -> slice:
        """Slice of the values in the last axis of data."""
        return slice(self.offset, self.offset + self.dof)

    @property
    def kind(self) -> str:
        """The first word of the name."""
        return next(iter(self.name.split()), "")

    @property
    def body(self) -> str | None:
        """The second word of the name."""
        words = self.name.split()
        return words[1] if len(words) > 1 else None


def shifted_name(name: str, steps: int) -> str | None:
    """Return the name of the group's derivative of order ``steps``, or integral if negative; None if there is none."""
    kind, *rest = name.split() or [""]
    for family in FAMILIES:
        if kind in family and 0 <= family.index(kind) + steps < len(family):
            return " ".join([family[family.index(kind) + steps], *rest])
    return None


def is_position(group: Group) -> bool:
    """Return whether the values are positions, not derivatives or times."""
    return any(group.kind == family[0] for family in FAMILIES)


def derived_interpolation(interpolation: str, order: int) -> str:
    """Return the interpolation of derivatives, given that of the values; empty if it is unknown."""
    if interpolation not in INTERPOLATIONS:
        return ""
    return INTERPOLATIONS[max(0, INTERPOLATIONS.index(interpolation) - order)]


def joint_indices(group: Group) -> list[int]:
    """Return the DOF index of each value; names without indices count from 0."""
    words = group.name.split()[2:]
    return _integers(words[: group.dof], group.name) if len(words) >= group.dof else list(range(group.dof))


def affine_parts(group: Group) -> tuple[int, Vec3]:
    """Return which pose components (``DOFAffine``) a group's values are, and the axis of a rotation about an axis.

    Raises:
        ArgumentError: the group's name does not say so.
    """
    words = group.name.split()[2:]
    if not words:
        raise ArgumentError(f"group '{group.name}': its name should end with the affine DOFs")
    if len(words) < 4:
        return _integers(words[:1], group.name)[0], Z_AXIS
    try:
        x, y, z = (float(word) for word in words[1:4])
    except ValueError:
        raise ArgumentError(f"group '{group.name}': its axis should be three numbers") from None
    return _integers(words[:1], group.name)[0], (x, y, z)


def ik_type(group: Group) -> int:
    """Return the number of the goal type of an IK group.

    Raises:
        ArgumentError: the name does not contain it.
    """
    words = group.name.split()[1:2]
    if not words:
        raise ArgumentError(f"group '{group.name}': its name should have the type of goal")
    return _integers(words, group.name)[0]


def _integers(words: Sequence[str], name: str) -> list[int]:
    try:
        return [int(word) for word in words]
    except ValueError:
        raise ArgumentError(f"group '{name}': what follows the body should be integers") from None

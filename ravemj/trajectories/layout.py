"""Operations on lists of groups: find, add, merge, derive.

The functions return new lists with copies of groups.
"""

from collections.abc import Sequence
from dataclasses import replace

from ravemj.errors import ArgumentError, ErrorCode
from ravemj.geometry_functions.affine import DOFAffine, RaveGetAffineDOF
from ravemj.trajectories.groups import (
    AFFINE,
    DELTATIME,
    FAMILIES,
    IK,
    INTERPOLATIONS,
    JOINTS,
    Group,
    affine_parts,
    derived_interpolation,
    is_position,
    joint_indices,
    shifted_name,
)


def copied(groups: Sequence[Group]) -> list[Group]:
    """Return copies."""
    return [replace(group) for group in groups]


def count(groups: Sequence[Group]) -> int:
    """Return the number of values of a configuration."""
    return max((group.offset + group.dof for group in groups), default=0)


def packed(groups: Sequence[Group]) -> list[Group]:
    """Return the groups in sequence, without gaps."""
    result: list[Group] = []
    for group in groups:
        result.append(replace(group, offset=count(result)))
    return result


def flaw(groups: Sequence[Group]) -> str | None:
    """Return the error in a layout (overlaps, gaps, empty groups, repeated names), or None."""
    end = 0
    for group in sorted(groups, key=lambda group: group.offset):
        if group.dof <= 0:
            return f"group '{group.name}' has {group.dof} values"
        if group.offset != end:
            return f"group '{group.name}' starts at {group.offset}, and should start at {end}"
        end += group.dof
    names = [group.name for group in groups]
    return next((f"there are two groups '{name}'" for name in names if names.count(name) > 1), None)


def equal(groups: Sequence[Group], others: Sequence[Group]) -> bool:
    """Return whether two layouts are equal; the order of the groups in their lists does not matter."""
    return sorted(groups, key=_place) == sorted(others, key=_place)


def _place(group: Group) -> tuple[int, str]:
    return group.offset, group.name


def find_prefix(groups: Sequence[Group], name: str) -> Group | None:
    """Return the group with the shortest name that starts with a prefix."""
    matching = (group for group in groups if group.name.startswith(name))
    return min(matching, key=lambda group: len(group.name), default=None)


def find_compatible(groups: Sequence[Group], name: str, exact: bool = False) -> Group | None:
    """Return the group ``name`` or, unless ``exact``, the most similar one of the same kind and body; else None."""
    for group in groups:
        if group.name == name:
            return group
    words = name.split()
    if exact or not words:
        return None
    scores = [_likeness(group.name.split(), words) for group in groups]
    best = max(scores, default=0)
    return groups[scores.index(best)] if best else None


def _likeness(words: list[str], wanted: list[str]) -> int:
    """Return the similarity of two group names, given as words; 0 for different kinds or bodies."""
    if words[:1] != wanted[:1]:
        return 0
    if len(words) < 2 or len(wanted) < 2:
        return 1
    if words[1] != wanted[1] and wanted[0] != "outputSignals":
        return 0
    same_body = int(words[1] == wanted[1])
    return 1 + same_body + sum(word in words[2:] for word in wanted[2:])


def find_shifted(groups: Sequence[Group], name: str, steps: int, exact: bool = False) -> Group | None:
    """Return the group with the derivative of order ``steps`` of group ``name``, or its integral if negative."""
    wanted = shifted_name(name, steps)
    return None if wanted is None else find_compatible(groups, wanted, exact)


def with_group(groups: Sequence[Group], added: Group) -> list[Group]:
    """Append a group to the layout, unless it is there already.

    Raises:
        ArgumentError: it has no name or size, or there is another group of its kind for the same body.
    """
    if not added.name.split() or added.dof < 0:
        raise ArgumentError(f"group '{added.name}' with {added.dof} values: should have a name and values", _ASSERT)
    for group in groups:
        if group.name == added.name:
            if group.dof != added.dof:
                raise ArgumentError(f"group '{added.name}' has {group.dof} values, not {added.dof}", _ASSERT)
            return copied(groups)
        if group.kind == added.kind and group.body is not None and group.body == added.body:
            raise ArgumentError(f"new group '{added.name}' conflicts with group '{group.name}'")
    return [*copied(groups), replace(added, offset=count(groups))]


_ASSERT = ErrorCode.Assert


def with_derivatives(groups: Sequence[Group], order: int, deltatime: bool) -> list[Group]:
    """Add the derivatives of all positions, and optionally the time since the last waypoint.

    Existing groups of derivatives are kept, or replaced if their sizes differ.
    """
    result = copied(groups)
    added: list[Group] = []
    for group in filter(is_position, groups):
        name = shifted_name(group.name, order) or ""
        new = Group(name, 0, group.dof, derived_interpolation(group.interpolation, order))
        present = find_compatible(result, name)
        if present is not None and present.dof == new.dof:
            present.name = name
            continue
        if present is not None:
            result.remove(present)
            result = packed(result)
        added.append(new)
    for group in added:
        result.append(replace(group, offset=count(result)))
    if deltatime and not any(group.kind == DELTATIME for group in result):
        result.append(Group(DELTATIME, count(result), 1))
    return result


def derived(groups: Sequence[Group], order: int) -> list[Group]:
    """Return the layout of the derivatives: groups of positions are renamed, interpolations reduced in degree."""
    return [
        replace(
            group,
            name=(shifted_name(group.name, order) or "") if is_position(group) else group.name,
            interpolation=derived_interpolation(group.interpolation, order),
        )
        for group in groups
    ]


def of_order(groups: Sequence[Group], order: int) -> list[Group]:
    """Return the groups of one derivative order, without gaps; 0 selects positions."""
    kinds = {family[order] for family in FAMILIES}
    return packed([group for group in groups if group.kind in kinds])


def without(groups: Sequence[Group], name: str, exact: bool) -> list[Group]:
    """Return the layout without the group ``name`` or, unless ``exact``, all whose names start with it; close gaps."""
    kept = [group for group in groups if not (group.name == name if exact else group.name.startswith(name))]
    return packed(kept) if len(kept) < len(groups) else copied(groups)


def merged(groups: Sequence[Group], others: Sequence[Group]) -> list[Group]:
    """Merge two layouts, without gaps.

    Groups of one kind and body become one: the group of ``groups``, extended by the additional values of the other,
    with the higher interpolation.

    Raises:
        ArgumentError: two groups of one kind cannot be merged.
    """
    result = copied(groups)
    added: list[Group] = []
    for other in others:
        present = find_compatible(result, other.name)
        if present is None:
            added.append(replace(other))
        elif present.name == other.name and present.dof != other.dof:
            raise ArgumentError(f"group '{other.name}' has {present.dof} values, and {other.dof}", _ASSERT)
        elif present.name == other.name or _widened(present, other):
            present.interpolation = _higher(present.interpolation, other.interpolation)
        else:
            added.append(replace(other))
    return packed([*result, *added])


def _widened(group: Group, other: Group) -> bool:
    """Add another group's values to a group, in place; return False if they are of different quantities."""
    of_joints = group.kind in JOINTS or group.kind in {"joint_torques", "grab"}
    if group.kind == "outputSignals":
        present = group.name.split()[1:]
        _append(group, [signal for signal in other.name.split()[1:] if signal not in present])
        return True
    if group.kind not in IK and group.kind not in AFFINE and not of_joints:
        raise ArgumentError(f"nobody knows how to merge group '{other.name}' into '{group.name}'")
    if group.kind in IK or group.body is None or group.body != other.body:
        return False
    if of_joints:
        present = joint_indices(group)
        _append(group, [str(index) for index in joint_indices(other) if index not in present])
    else:
        _widen_affine(group, other)
    return True


def _append(group: Group, words: list[str]) -> None:
    group.name = " ".join([group.name, *words])
    group.dof += len(words)


def _widen_affine(group: Group, other: Group) -> None:
    parts = affine_parts(group)[0] | affine_parts(other)[0]
    kinds = [kind for kind in (DOFAffine.RotationQuat, DOFAffine.Rotation3D, DOFAffine.RotationAxis) if parts & kind]
    parts = parts & ~int(DOFAffine.RotationMask) | (int(kinds[0]) if kinds else 0)
    words = group.name.split()
    group.name = " ".join([*words[:2], str(parts), *words[3:]])
    group.dof = RaveGetAffineDOF(parts)


def _higher(interpolation: str, other: str) -> str:
    if not interpolation or not other:
        return interpolation or other
    known = [name for name in (interpolation, other) if name in INTERPOLATIONS]
    return max(known, key=INTERPOLATIONS.index, default=interpolation)

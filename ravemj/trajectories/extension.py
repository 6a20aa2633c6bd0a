"""Extension of timed waypoints by one waypoint at either end."""

from collections.abc import Sequence

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.trajectories.conversion import FindBody
from ravemj.trajectories.groups import DELTATIME, Group, is_position
from ravemj.trajectories.layout import derived, find_compatible, packed, with_derivatives
from ravemj.trajectories.waypoints import Waypoints


class Extension:
    """A segment between one end of timed waypoints and a new waypoint.

    Args:
        path: The waypoints.
        groups: The layout of the new waypoint.
        values: The new waypoint, shape (dof,).
        velocities: The velocities at the new waypoint, shape (dof,).
        index: The index of the new waypoint: 0, or the number of waypoints.
        replaced: The number of existing waypoints at that end that the new one replaces.
        find_body: Finds the bodies of the groups.

    Attributes:
        interpolation: The interpolation of the positions in the path.

    Raises:
        ArgumentError: the path has no times or too few waypoints, or the index is not an end.
    """

    def __init__(
        self,
        path: Waypoints,
        groups: Sequence[Group],
        values: Floats,
        velocities: Floats,
        index: int,
        replaced: int,
        find_body: FindBody,
    ) -> None:
        time = find_compatible(path.groups, DELTATIME, exact=True)
        if time is None or not len(path):
            raise ArgumentError("trajectory: should have waypoints with times")
        self._path, self._find_body, self._time_column = path, find_body, time.offset
        self._groups, self._new = packed(groups), np.stack([values, velocities])
        self._is_first = index == 0
        if index not in {0, len(path), len(path) - replaced}:
            raise ArgumentError(f"index: is {index}, and should be 0 or {len(path)}: only the ends can be changed")
        self._anchor = replaced if self._is_first else len(path) - 1 - replaced  # the waypoint to connect with
        if not 0 <= self._anchor < len(path):
            raise ArgumentError(f"trajectory: has {len(path)} waypoints, which are too few")
        self.interpolation = next((group.interpolation for group in path.groups if is_position(group)), "")

    def segment(self) -> Waypoints:
        """Return the existing and the new waypoint of the segment, with velocities, without times."""
        anchor, groups = self._path.rows(self._anchor, self._anchor + 1), self._groups
        layouts = groups, derived(groups, 1)
        known = np.vstack([self._path.as_layout(anchor, layout, self._find_body) for layout in layouts])
        points = np.stack([self._new, known] if self._is_first else [known, self._new])
        layout = with_derivatives(groups, 1, deltatime=False)
        return Waypoints(layout, points.reshape(2, -1))

    def joined(self, segment: Waypoints) -> tuple[Waypoints, int]:
        """Return the path extended by a timed segment, and the index after the last inserted waypoint."""
        path, rows = self._path, segment.as_layout(segment.data, self._path.groups, self._find_body)
        if self._is_first:
            kept = path.rows(self._anchor, len(path))
            kept[0, self._time_column] = rows[-1, self._time_column]  # its segment now takes time
            data, behind = np.vstack([rows[:-1], kept]), len(rows) - 1
        else:
            data = np.vstack([path.rows(0, self._anchor + 1), rows[1:]])
            behind = len(data)
        return Waypoints(path.groups, data), behind

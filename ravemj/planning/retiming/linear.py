"""Straight lines at constant speed."""

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.retiming.segments import Limits, Rows, Segment


class Linear:
    """Drives each segment at the greatest speed of its slowest joint, and jumps to that of the next."""

    interpolation = "linear"
    order = 1
    merges = False

    def shortest(self, segment: Segment, limits: Limits) -> float:
        """Return the time of a segment [s]; the translation of a base counts as one distance, its rotation as one."""
        parts = limits.coordinates
        ways, speeds = np.abs(segment.step), limits.velocity
        if parts.translation or len(parts.rotation) > 1:
            ways, speeds = _of_base(segment.step, limits)
        moving = ways > 0
        with np.errstate(divide="ignore"):
            return float((ways[moving] / speeds[moving]).max(initial=0.0))

    def drive(self, segment: Segment, duration: float, limits: Limits) -> Rows:
        """Return the one row of a segment."""
        del limits
        velocity = segment.step / duration if duration > 0 else np.zeros_like(segment.step)
        return Rows(np.array([duration]), (segment.step[None], velocity[None]))


def _of_base(step: Floats, limits: Limits) -> tuple[Floats, Floats]:
    """Return the ways and speeds of a segment that moves a base: straight through space, and turning."""
    parts = limits.coordinates
    translation, rotation = list(parts.translation), list(parts.rotation)
    rest = [column for column in range(len(step)) if column not in parts.translation + parts.rotation]
    ways = [*np.abs(step[rest])]
    speeds = [*limits.velocity[rest]]
    for columns, way in ((translation, np.linalg.norm(step[translation])), (rotation, _angle(step[rotation]))):
        if columns:
            ways.append(way)
            speeds.append(limits.velocity[columns].min())
    return np.array(ways), np.array(speeds)


def _angle(step: Floats) -> float:
    """Return the angle of a difference of angles, rotation vectors or unit quaternions [rad]."""
    length = float(np.linalg.norm(step))
    return 4 * float(np.arcsin(min(1.0, length / 2))) if len(step) == 4 else length

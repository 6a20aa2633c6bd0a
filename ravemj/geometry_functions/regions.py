"""Task space regions: sets of tool poses between bounds of six coordinates.

After D. Berenson, S. Srinivasa and J. Kuffner, "Task Space Regions", IJRR 30(12), 2011.
"""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.errors import ArgumentError

AXES = ("x", "y", "z", "roll", "pitch", "yaw")

_TURN = 2 * math.pi
_LOCK = 1e-7
"""Cosine of the pitch below which roll and yaw rotate about one axis."""

_LENGTH, _PART, _ANGLE = 1e-9, 1e-6, 1e-6
"""Tolerances of a membership test: length [m], additional fraction of the poses' translations, and angle [rad]."""

_POINT_SHARE = 0.1
"""Minimum weight of a region in a union, relative to the mean width, so that point regions are sampled, too."""


@dataclass(frozen=True, slots=True)
class PoseSet:
    """The poses ``T0_w @ D @ Tw_e`` with ``D = translate(x, y, z) Rz(yaw) Ry(pitch) Rx(roll)`` within bounds.

    With ``lean``, ``D = translate(x, y, z) S Rz(yaw)``: S is a rotation about a horizontal axis of *w*, by the angle
    between the z axes of ``D`` and *w*. The coordinates roll and pitch are then x and y of the rotation vector of S.

    Attributes:
        T0_w: The frame *w* of the region, shape (4, 4).
        Tw_e: The tool in *w* if all coordinates are 0, shape (4, 4).
        lower: Lower bounds of x, y, z [m], roll, pitch, yaw [rad], shape (6,).
        upper: Upper bounds, shape (6,).
        lean: Maximum angle between the z axes [rad], which replaces the bounds of roll and pitch; None to use these.
    """

    T0_w: Floats
    Tw_e: Floats
    lower: Floats
    upper: Floats
    lean: float | None = None
    _Tw_0: Floats = field(init=False)
    _Te_w: Floats = field(init=False)
    _bounds: list[tuple[float, float]] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_Tw_0", inverse(self.T0_w))
        object.__setattr__(self, "_Te_w", inverse(self.Tw_e))
        bounds = list(zip(self.lower.tolist(), self.upper.tolist(), strict=True))
        object.__setattr__(self, "_bounds", bounds[:3] + [_at_most_a_turn(*interval) for interval in bounds[3:]])

    def moved(self, T_world_0: Floats) -> "PoseSet":
        """Return the same region relative to the world; ``T_world_0`` is the present pose of frame 0, shape (4, 4)."""
        return replace(self, T0_w=T_world_0 @ self.T0_w)

    def relative(self, T0_s: Floats) -> Floats:
        """Return ``D`` of a tool pose ``T0_s``, relative to frame 0 like ``T0_w``, shape (4, 4)."""
        return self._Tw_0 @ T0_s @ self._Te_w

    def coordinates(self, T0_s: Floats) -> Floats:
        """Return the six coordinates of a pose; of equivalent angle triples, the one nearest to the bounds."""
        return self._displaced(self.relative(T0_s))[0]

    def displacement(self, T0_s: Floats) -> Floats:
        """Return by how much each coordinate exceeds its bounds [m and rad], shape (6,); 0 inside."""
        return self._displaced(self.relative(T0_s))[1]

    def distance(self, T0_s: Floats) -> float:
        """Return the norm of the displacement, with equal weights of metres and radians."""
        return float(np.linalg.norm(self.displacement(T0_s)))

    def nearest(self, T0_s: Floats) -> Floats:
        """Return the pose in the region obtained by clipping the coordinates of another pose to the bounds."""
        coordinates, displacement = self._displaced(self.relative(T0_s))
        return self.poses((coordinates - displacement)[None])[0]

    def contains(self, T0_s: Floats) -> bool:
        """Return whether a pose is in the region, within tolerances."""
        displacement = np.abs(self.displacement(T0_s))
        lengths = (float(np.abs(T[:3, 3]).max()) for T in (T0_s, self.T0_w, self.Tw_e))
        return bool(displacement[:3].max() <= _LENGTH + _PART * sum(lengths) and displacement[3:].max() <= _ANGLE)

    def width(self) -> float:
        """Return the sum of the widths of the six intervals [m and rad].

        With ``lean``, the widths of roll and pitch are ``2 * lean`` each.
        """
        widths = [upper - lower for lower, upper in self._bounds]
        return sum(widths) if self.lean is None else sum(widths[:3]) + 4 * self.lean + widths[5]

    def poses(self, coordinates: Floats) -> Floats:
        """Return the poses at coordinates, shape (n, 4, 4)."""
        D = np.tile(np.eye(4), (len(coordinates), 1, 1))
        D[:, :3, 3] = coordinates[:, :3]
        D[:, :3, :3] = _turned(coordinates[:, 3:]) if self.lean is None else _leaning(coordinates[:, 3:])
        return self.T0_w @ D @ self.Tw_e

    def sample(self, random: np.random.Generator, count: int, *, over_rotations: bool = False) -> Floats:
        """Return random poses, shape (count, 4, 4).

        Args:
            random: The random generator.
            count: The number of poses.
            over_rotations: Whether to sample rotations uniformly, instead of their coordinates.

        Raises:
            ArgumentError: a length has no bounds.
        """
        for name, bounds in zip(AXES, self._bounds, strict=True):
            if not np.isfinite(bounds).all():
                raise ArgumentError(f"{name} of the region has no bounds, and a sample needs some")
        lower, upper = np.array(self._bounds).T
        numbers = random.random((count, 6))
        drawn = lower + (upper - lower) * numbers
        if self.lean is not None:
            cosine = 1 - numbers[:, 3] * (1 - math.cos(self.lean))
            angle = np.arccos(cosine) if over_rotations else self.lean * np.sqrt(numbers[:, 3])
            direction = _TURN * numbers[:, 4]
            drawn[:, 3], drawn[:, 4] = angle * np.cos(direction), angle * np.sin(direction)
        elif over_rotations:  # the density of the pitch is proportional to |cos pitch|
            first, last = _cosine_integral(lower[4]), _cosine_integral(upper[4])
            drawn[:, 4] = _inverse_cosine_integral(first + (last - first) * numbers[:, 4])
        return self.poses(drawn)

    def beyond(self, D: Floats) -> Floats:
        """Return by how much each coordinate of ``D`` exceeds its bounds, shape (6,)."""
        return self._displaced(D)[1]

    def error(self, D: Floats) -> tuple[Floats, Floats]:
        """Return the error of a pose relative to the region, and its negative derivative with respect to velocities.

        Args:
            D: ``relative`` of the pose, shape (4, 4).

        Returns:
            The error [m and rad], shape (6,), 0 inside the bounds; and its negative derivative with respect to the
            velocity of the origin of ``D`` and the angular velocity, in axes of *w*, shape (6, 6). Rows of zero errors
            are 0.
        """
        coordinates, displacement = self._displaced(D)
        rates = np.zeros((6, 6))
        rates[:3, :3] = np.eye(3)
        if self.lean is None:
            rates[3:, 3:] = _angle_rates(coordinates[4], coordinates[5])
        else:
            lean = float(np.hypot(displacement[3], displacement[4]))
            displacement = np.array([*displacement[:3], lean, 0.0, displacement[5]])
            rates[3:, 3:] = _lean_rates(D)
        rates[displacement == 0] = 0
        return -displacement, rates

    def _displaced(self, D: Floats) -> tuple[Floats, Floats]:
        """Return the coordinates of the relative pose ``D``, and by how much each exceeds its bounds.

        Of equivalent angles, those that exceed their bounds least are chosen.
        """
        if self.lean is not None:
            return self._leaned(D, self.lean)
        best, least = None, math.inf
        for angles in self._triples(D[:3, :3].tolist()):
            beyond = [_beyond(angle, *bounds) for angle, bounds in zip(angles, self._bounds[3:], strict=True)]
            square = sum(part * part for part in beyond)
            if square < least:
                best, least = (angles, beyond), square
        assert best is not None, "the angles are finite"
        return self._with_lengths(D, *best)

    def _with_lengths(self, D: Floats, angles: list[float], beyond: list[float]) -> tuple[Floats, Floats]:
        lengths = D[:3, 3].tolist()
        far = [_beyond(length, *bounds) for length, bounds in zip(lengths, self._bounds[:3], strict=True)]
        return np.array([*lengths, *angles]), np.array([*far, *beyond])

    def _triples(self, rows: list[list[float]]) -> list[list[float]]:
        """Return the two equivalent (roll, pitch, yaw) of a rotation, or one at gimbal lock.

        Each angle is shifted by full turns to be nearest to the middle of its bounds.
        """
        (r00, r01, _), (r10, r11, _), (r20, r21, r22) = rows
        cosine = math.hypot(r00, r10)
        pitch, rolls, pitches, yaws = math.atan2(-r20, cosine), *self._bounds[3:]
        if cosine < _LOCK:
            side = 1.0 if pitch > 0 else -1.0
            roll, yaw = _split(math.atan2(side * r01, r11), side, rolls, yaws)
            return [[roll, _near(pitch, *pitches), yaw]]
        roll, yaw = math.atan2(r21, r22), math.atan2(r10, r00)
        other = roll + math.pi, math.pi - pitch, yaw + math.pi
        return [[_near(a, *rolls), _near(b, *pitches), _near(c, *yaws)] for a, b, c in ((roll, pitch, yaw), other)]

    def _leaned(self, D: Floats, most: float) -> tuple[Floats, Floats]:
        x, y, z = D[:3, 2].tolist()
        level = math.hypot(x, y)
        angle = math.atan2(level, z)
        axis = (-y / level, x / level) if level > 0 else (1.0, 0.0)
        yaw = _near(math.atan2(D[1, 0] - D[0, 1], D[0, 0] + D[1, 1]), *self._bounds[5])
        beyond = max(0.0, angle - most)
        angles = [angle * axis[0], angle * axis[1], yaw]
        return self._with_lengths(D, angles, [beyond * axis[0], beyond * axis[1], _beyond(yaw, *self._bounds[5])])


def weights(regions: "list[PoseSet]") -> Floats:
    """Return the sampling probabilities of the regions of a union, shape (n,).

    As in the paper, they are proportional to the sums of widths, so that lines and planes are sampled often enough. The
    weight of a region is at least a tenth of the mean, so that points are sampled, too; if all regions are points, all
    weights are equal.
    """
    widths = np.array([region.width() for region in regions])
    mean = float(widths.mean())
    widths = np.maximum(widths, _POINT_SHARE * mean) if mean > 0 else np.ones(len(widths))
    return widths / widths.sum()


def _at_most_a_turn(lower: float, upper: float) -> tuple[float, float]:
    if not upper - lower < _TURN:
        middle = (lower + upper) / 2 if math.isfinite(lower + upper) else 0.0
        return middle - math.pi, middle + math.pi
    return lower, upper


def _near(angle: float, lower: float, upper: float) -> float:
    """Return the angle shifted by full turns to be nearest to the middle of the bounds."""
    return angle + _TURN * round(((lower + upper) / 2 - angle) / _TURN)


def _beyond(value: float, lower: float, upper: float) -> float:
    return value - upper if value > upper else value - lower if value < lower else 0.0


def _split(total: float, side: float, rolls: tuple[float, float], yaws: tuple[float, float]) -> tuple[float, float]:
    """Return roll and yaw nearest to their bounds with ``roll - side * yaw = total``, at a pitch of side * pi/2."""
    wide, wide_yaw = rolls[1] - rolls[0], yaws[1] - yaws[0]
    first = rolls[0] - side * (yaws[1] if side > 0 else yaws[0])
    last = first + wide + wide_yaw
    total = _near(total, first, last)
    inside = min(max(total, first), last)
    part = (inside - first) / (last - first) if last > first else 0.0
    roll = rolls[0] + part * wide
    yaw = yaws[1] - part * wide_yaw if side > 0 else yaws[0] + part * wide_yaw
    return roll + (total - inside) / 2, yaw - side * (total - inside) / 2


def _turned(angles: Floats) -> Floats:
    """Return the rotations Rz(yaw) Ry(pitch) Rx(roll), shape (n, 3, 3), for rows (roll, pitch, yaw)."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(angles).T, np.cos(angles).T
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.array(rows).transpose(2, 0, 1)


def _leaning(angles: Floats) -> Floats:
    """Return the rotations exp([x, y, 0]) Rz(yaw), shape (n, 3, 3), for rows (x, y, yaw)."""
    x, y, yaw = angles.T
    angle = np.hypot(x, y)
    scale = np.where(angle > 0, angle, 1.0)
    x, y, sine, cosine, zero = x / scale, y / scale, np.sin(angle), np.cos(angle), np.zeros(len(angles))
    rest = 1 - cosine
    rows = [
        [cosine + x * x * rest, x * y * rest, y * sine],
        [x * y * rest, cosine + y * y * rest, -x * sine],
        [-y * sine, x * sine, cosine],
    ]
    return np.array(rows).transpose(2, 0, 1) @ _turned(np.stack([zero, zero, yaw], axis=1))


def _angle_rates(pitch: float, yaw: float) -> Floats:
    """Return the matrix, (3, 3), from angular velocity in the region's frame *w* to roll, pitch and yaw rates."""
    cosine, sine = math.cos(pitch), math.sin(pitch)
    cosine = math.copysign(max(abs(cosine), _LOCK), cosine)
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c / cosine, s / cosine, 0], [-s, c, 0], [c * sine / cosine, s * sine / cosine, 1]])


def _lean_rates(D: Floats) -> Floats:
    """Return the matrix, (3, 3), from angular velocity to the rates of the lean angle (row 0) and of yaw (row 2).

    The angular velocity is in the region's frame *w*; row 1 is 0.
    """
    x, y, z = D[:3, 2].tolist()
    level = math.hypot(x, y) or 1.0
    over = max(1 + z, _LOCK)
    return np.array([[-y / level, x / level, 0], [0, 0, 0], [x / over, y / over, 1.0]])


def _cosine_integral(angle: float) -> float:
    """Return the integral of |cos| from 0 to an angle."""
    turns = math.floor(angle / math.pi + 0.5)
    return 2 * turns + math.sin(angle - turns * math.pi)


def _inverse_cosine_integral(values: Floats) -> Floats:
    turns = np.floor((values + 1) / 2)
    return turns * np.pi + np.arcsin(np.clip(values - 2 * turns, -1, 1))

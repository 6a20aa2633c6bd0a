"""Robot as the mechanism of whole-body inverse kinematics: frames, centre of mass, distances, displacements."""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats, Ints, Pose, Vec3, multiply, normalize
from ravemj.engine.affine import translation_columns
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.dynamics.stacked import WholeBodyRows
from ravemj.engine.simulation import BodyState
from ravemj.geometry_functions.affine import DOFAffine
from ravemj.ik.whole_body import Inequality, MotionLimits
from ravemj.model.scene import Axis

_ROTATION = int(DOFAffine.RotationMask)
_BASE = 6
_APPROACH = 0.5
"""Fraction of the remaining clearance that a step may use, since surfaces are curved."""


class Keeper(NamedTuple):
    """Minimum-distance constraint of geom pairs.

    Attributes:
        pairs: Returns the collision world and the geom pairs.
        least: Minimum distance [m].
        seen: Distance below which pairs are considered [m].
    """

    pairs: Callable[[], tuple[CollisionWorld, Pairs]]
    least: float
    seen: float


class Moving:
    """Variables of a robot, its active joints and a twist of its base, and derived quantities.

    A twist is the velocity of the origin of the first link and its angular velocity, in world axes, which avoids
    differences of angles for the base.
    """

    def __init__(self, body: BodyState, dofs: Ints, affine: int, axis: Vec3) -> None:
        """Store a robot, the DOF indices of the active joints, and the active affine DOFs with their axis."""
        self.body, self.dofs = body, dofs
        self._kinematics, self._dynamics = body.kinematics, body.dynamics
        self._translations = translation_columns(affine)
        self._angular = _angular(affine, axis)
        self._base = np.zeros((_BASE, len(self._translations) + self._angular.shape[1]))
        self._base[self._translations, range(len(self._translations))] = 1.0
        self._base[3:, len(self._translations) :] = self._angular
        self._is_free = self._base.shape[1] == _BASE
        self.count = len(dofs) + self._base.shape[1]
        self._all_dofs = None if np.array_equal(dofs, np.arange(body.dof)) else dofs
        self._frames: list[tuple[int, Floats]] = []
        self._rotations, self._offsets = np.zeros((0, 3, 3)), np.zeros((0, 3))
        self._ids: Ints = np.zeros(0, dtype=int)
        self._body_ids: list[int] = []
        self._poses, self._jacobians = np.zeros((0, 4, 4)), np.zeros((0, 6, self.count))
        self._rows = self._new_rows()
        self._stamp = self._com_stamp = -1
        self._com, self._com_jacobian = np.zeros(3), np.zeros((3, self.count))
        self._robot_com_jacobian = self._com_jacobian
        self.keepers: list[Keeper] = []
        self.edges: list[tuple[Floats, Floats]] = []

    def add_frame(self, link: int, T_link_frame: Floats) -> int:
        """Add a frame fixed to a link; return its index."""
        self._frames.append((link, T_link_frame))
        self._rotations = np.array([frame[:3, :3] for _, frame in self._frames])
        self._offsets = np.array([frame[:3, 3] for _, frame in self._frames])
        self._ids = self._kinematics.body_ids[[placed_link for placed_link, _ in self._frames]]
        self._body_ids = self._ids.tolist()
        self._poses = np.tile(np.eye(4), (len(self._frames), 1, 1))
        self._rows = self._new_rows()
        self._stamp = self._com_stamp = -1
        return len(self._frames) - 1

    def _new_rows(self) -> WholeBodyRows | None:
        """Return the buffer for all Jacobians at once; None if only parts of the base move, or joints are coupled."""
        has_base = self._base.shape[1] > 0
        if has_base and not self._is_free:
            return None
        return self._dynamics.whole_body_rows(len(self._frames), self.dofs, base=has_base)

    def frame(self, number: int) -> tuple[Floats, Floats]:
        """Return ``T_world_frame`` (4, 4) and the Jacobian (6, n): linear, then angular velocity."""
        if self._stamp != self._kinematics.stamp:
            self._follow_frames()
        return self._poses[number], self._jacobians[number]

    def _follow_frames(self) -> None:
        kinematics = self._kinematics
        kinematics.place()
        data = kinematics.data
        rotations = data.xmat.take(self._ids, 0).reshape(-1, 3, 3)
        self._poses[:, :3, :3] = rotations @ self._rotations
        places = data.xpos.take(self._ids, 0) + (rotations @ self._offsets[:, :, None])[:, :, 0]
        self._poses[:, :3, 3] = places
        if self._rows is None:
            self._jacobians = self.jacobians([link for link, _ in self._frames], places)
        else:
            rows = self._rows.filled(self._body_ids, places)
            self._jacobians, self._robot_com_jacobian = rows[:-3].reshape(len(places), 6, self.count), rows[-3:]
        self._stamp = kinematics.stamp

    def jacobians(self, links: Sequence[int], points: Floats) -> Floats:
        """Return the Jacobians of points (k, 3) fixed to links, shape (k, 6, n)."""
        has_base = self._base.shape[1] > 0
        jacobians = self._dynamics.jacobians(links, points, self._all_dofs, base=has_base)
        return self._chosen(jacobians) if has_base and not self._is_free else jacobians

    def _chosen(self, jacobians: Floats) -> Floats:
        return np.concatenate([jacobians[..., :-_BASE], jacobians[..., -_BASE:] @ self._base], axis=-1)

    def com(self) -> tuple[Floats, Floats]:
        """Return the centre of mass of the robot with grabbed bodies [m], shape (3,), and its Jacobian, (3, n)."""
        if self._com_stamp != self._kinematics.stamp:
            self._com, self._com_jacobian = self._weighed()
            self._com_stamp = self._kinematics.stamp
        return self._com, self._com_jacobian

    def _weighed(self) -> tuple[Floats, Floats]:
        if self._rows is None:
            com, jacobian = self._of_robot()
        else:
            if self._stamp != self._kinematics.stamp:
                self._follow_frames()
            com, jacobian = self._kinematics.data.subtree_com[0].copy(), self._robot_com_jacobian
        if not self.body.grabs:
            return com, jacobian
        mass = float(self.body.inertias.masses.sum())
        held = [(grab.link, *_weight(grab.body)) for grab in self.body.grabs]
        points = np.array([point for _, _, point in held])
        total = mass + sum(held_mass for _, held_mass, _ in held)
        moved = self.jacobians([link for link, _, _ in held], points)[:, :3]
        shares = np.array([held_mass for _, held_mass, _ in held]) / total
        return com * mass / total + shares @ points, jacobian * mass / total + np.tensordot(shares, moved, 1)

    def _of_robot(self) -> tuple[Floats, Floats]:
        """Return the centre of mass of the robot without grabbed bodies, and its Jacobian."""
        jacobian = self._dynamics.com_jacobian()
        com = self._kinematics.data.subtree_com[0].copy()
        if self._all_dofs is not None:
            jacobian = jacobian.take(self._all_dofs, 1)
        if self._base.shape[1]:
            x, y, z = (com - self._kinematics.position(0)).tolist()
            turning = np.array(((1.0, 0, 0, 0, z, -y), (0, 1.0, 0, -z, 0, x), (0, 0, 1.0, y, -x, 0)))
            jacobian = np.concatenate((jacobian, turning @ self._base), axis=1)
        return com, jacobian

    def limits(
        self, *, values: bool, velocities: bool, accelerations: bool, base_velocity: float | None
    ) -> MotionLimits:
        """Return the limits of the variables: the selected joint limits, and ``base_velocity`` for the twist."""
        base, all_axes = self._base.shape[1], self.body.scene.dof_axes
        axes: list[Axis] = [all_axes[dof] for dof in self.dofs.tolist()]
        free = np.full(len(axes), np.inf)
        self._lower = np.array([-np.inf if axis.circular or not values else axis.lower for axis in axes])
        self._upper = np.array([np.inf if axis.circular or not values else axis.upper for axis in axes])
        speeds = np.array([axis.max_velocity for axis in axes]) if velocities else free
        changes = np.array([axis.max_acceleration for axis in axes]) if accelerations else free

        endless = np.full(base, np.inf)
        base_speeds = endless if base_velocity is None else np.full(base, base_velocity)
        return MotionLimits(
            np.append(self._lower, -endless),
            np.append(self._upper, endless),
            np.append(speeds, base_speeds),
            np.append(changes, endless),
        )

    def is_current(self) -> bool:
        """Return whether the robot still has the same joints."""
        return self.body.kinematics is self._kinematics

    def values(self) -> Floats:
        """Return the values of the active joints, and 0 for each variable of the base, shape (n,)."""
        values, present = np.zeros(self.count), self._kinematics.values()
        values[: len(self.dofs)] = present if self._all_dofs is None else present[self.dofs]
        return values

    def move(self, displacement: Floats) -> None:
        """Move by a displacement, shape (n,): joints, then a twist of the base for a unit of time."""
        joints, pose = len(self.dofs), self.body.pose()  # before the joints move, since that updates all links
        values = self._kinematics.values()
        before = values if self._all_dofs is None else values[self.dofs]
        # Prevent rounding errors from exceeding a limit that held before.
        lowest, highest = np.minimum(self._lower, before), np.maximum(self._upper, before)
        ahead = np.minimum(np.maximum(before + displacement[:joints], lowest), highest)
        if self._all_dofs is None:
            values = ahead
        else:
            values[self.dofs] = ahead
        self.body.set_values(values, clamp_mimic=True)
        if self._base.shape[1]:
            twist = self._base.dot(displacement[joints:])
            self.body.set_pose(_moved(pose, twist.tolist()))

    def saved(self) -> Floats:
        """Return the configuration: joint values, position and orientation of the first link."""
        position, wxyz = self.body.pose()
        return np.concatenate([self._kinematics.values(), position, wxyz])

    def restore(self, configuration: Floats) -> None:
        """Restore a configuration."""
        self.body.set_values(configuration[:-7].copy())
        if self._base.shape[1]:
            x, y, z, *wxyz = configuration[-7:].tolist()
            self.body.set_pose(Pose((x, y, z), normalize((wxyz[0], wxyz[1], wxyz[2], wxyz[3]))))

    def inequalities(self) -> list[Inequality]:
        """Return the constraints of distances, and of the centre of mass over its support."""
        inequalities = [inequality for keeper in self.keepers if (inequality := self._distances(keeper)) is not None]
        for normals, offsets in self.edges:
            com, jacobian = self.com()
            inequalities.append(Inequality(-normals @ jacobian[:2], normals @ com[:2] - offsets))
        return inequalities

    def nearest(self, keeper: Keeper) -> tuple[float, str]:
        """Return the smallest distance of pairs [m], infinite if none is near, and the names of both links."""
        near = self._near(keeper)
        if not near:
            return math.inf, ""
        distance, owners, _ = min(near, key=lambda pair: pair[0])
        return distance, " and ".join(body.scene.links[link].name for body, link in owners)

    def _near(self, keeper: Keeper) -> list[tuple[float, tuple[tuple[BodyState, int], tuple[BodyState, int]], Floats]]:
        """Return distance, both links and the connecting segment, shape (6,), of each pair of geoms near each other."""
        world, pairs = keeper.pairs()
        near: list[tuple[float, tuple[tuple[BodyState, int], tuple[BodyState, int]], Floats]] = []
        for number in np.flatnonzero(pairs.gaps() < keeper.seen).tolist():
            first, second = pairs.geoms(number)
            distance, segment = world.shapes.closest(first, second, keeper.seen)
            if distance < keeper.seen:
                near.append((distance, (world.owner(first), world.owner(second)), segment))
        return near

    def _distances(self, keeper: Keeper) -> Inequality | None:
        """Return constraints that keep near pairs apart by the minimum distance; None if no pair is near."""
        near = self._near(keeper)
        if not near:
            return None
        rows = np.zeros((len(near), self.count))
        for index, (distance, owners, segment) in enumerate(near):
            apart = segment[3:] - segment[:3] if distance > 0 else segment[:3] - segment[3:]
            length = float(np.linalg.norm(apart))
            normal = apart / length if length else np.array([0.0, 0.0, 1.0])
            for (body, link), point, sign in zip(owners, (segment[:3], segment[3:]), (-1.0, 1.0), strict=True):
                link_of = _carrier(self.body, body, link)
                if link_of is not None:
                    rows[index] += sign * (normal @ self.jacobians([link_of], point[None])[0, :3])
        missing = np.array([keeper.least - distance for distance, _, _ in near])
        return Inequality(rows, np.where(missing > 0, missing, _APPROACH * missing))


def _carrier(robot: BodyState, body: BodyState, link: int) -> int | None:
    """Return ``link`` if ``body`` is the robot, else the robot's link that carries ``body``, or None."""
    if body is robot:
        return link
    return next((grab.link for grab in robot.grabs if grab.body.carries(body)), None)


def _weight(body: BodyState) -> tuple[float, Floats]:
    """Return the mass [kg] and the centre of mass [m] of a body with its grabbed bodies."""
    mass = float(body.inertias.masses.sum())
    moment = mass * np.nan_to_num(body.inertias.center_of_mass(body.link_transforms()))
    for grab in body.grabs:
        more, point = _weight(grab.body)
        mass, moment = mass + more, moment + more * point
    return mass, moment / mass if mass else body.link_transform(0)[:3, 3]


def _angular(affine: int, axis: Vec3) -> Floats:
    """Return the rotation axes of a base's affine DOFs as columns: none, one (``RotationAxis``) or all three."""
    if affine & int(DOFAffine.RotationAxis):
        return np.array(axis).reshape(3, 1) / np.linalg.norm(axis)
    return np.eye(3) if affine & _ROTATION else np.zeros((3, 0))


def _moved(pose: Pose, twist: Sequence[float]) -> Pose:
    """Return a pose after a twist: a displacement of its origin and a rotation vector, both in world axes."""
    (x, y, z), (dx, dy, dz, a, b, c) = pose.position, twist
    angle = math.sqrt(a * a + b * b + c * c)
    half = math.sin(angle / 2) / angle if angle > 1e-12 else 0.5
    turn = (math.cos(angle / 2), a * half, b * half, c * half)
    return Pose((x + dx, y + dy, z + dz), normalize(multiply(turn, pose.wxyz)))


def polygon_edges(points: Floats) -> tuple[Floats, Floats]:
    """Return outward normals (k, 2) and offsets (k,) of the convex hull of points (m, 2): inside, n . p <= offset.

    Raises:
        ValueError: the points are on a line.
    """
    hull = convex_hull(points)
    edges = np.array([second - first for first, second in pairwise([*hull, hull[0]])])
    lengths = np.linalg.norm(edges, axis=1)
    if len(hull) < 3 or lengths.min() == 0:
        raise ValueError("should not be on a line")
    normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / lengths[:, None]
    return normals, (normals * hull).sum(axis=1)


def convex_hull(points: Floats) -> Floats:
    """Return the vertices of the convex hull of points (m, 2), counter-clockwise (A. Andrew's monotone chain, 1979)."""
    ordered = sorted({(float(x), float(y)) for x, y in points})
    halves: list[list[tuple[float, float]]] = []
    for way in (ordered, ordered[::-1]):
        half: list[tuple[float, float]] = []
        for point in way:
            while len(half) > 1 and _turn(half[-2], half[-1], point) <= 0:
                half.pop()
            half.append(point)
        halves.append(half[:-1])
    return np.array([*halves[0], *halves[1]])


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

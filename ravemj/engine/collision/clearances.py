"""Proven lower bounds of distances between moving shapes, and safe joint travel.

A direction d separates two convex shapes A and B by s(d) = min over B of d x - max over A of d x, which is a lower
bound of their distance. MuJoCo's search for the nearest points gives good directions; the proof does not depend on it,
since s(d) is computed here from support functions. Non-convex shapes are inside of their hulls; if hulls are too close,
the triangles are measured.

Joint values that change by at most e_j move a point of a shape by at most t_n: from the joint j = 1 next to the shape
to the joint n next to the world, t_j = t_{j-1} + e_j (r_j + t_{j-1}) with t_0 = 0, where r_j is the largest distance of
the shape from the axis of the joint in the initial configuration; a prismatic joint adds e_j. (The joints can be
changed one after the other in this order, since the axes of joints not yet changed have not moved.)
"""

from collections.abc import Sequence
from typing import NamedTuple, Self

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints
from ravemj.engine.collision.shapes import ShapeTests

Bools = NDArray[np.bool_]

SLACK = 1e-7
"""Distance [m] below which nothing is proven, because of rounding errors."""

_FAR = 1e10  # m
_ONCE = 128  # configurations

_GEOM = mujoco.mjtGeom
_SPHERE, _CAPSULE, _CYLINDER = int(_GEOM.mjGEOM_SPHERE), int(_GEOM.mjGEOM_CAPSULE), int(_GEOM.mjGEOM_CYLINDER)
_BOX, _MESH = int(_GEOM.mjGEOM_BOX), int(_GEOM.mjGEOM_MESH)

_ONES = np.ones(3)  # a product with it is the fastest way to sum rows


class Chain(NamedTuple):
    """Indices of the joints that move a shape, ordered from the shape to the world."""

    joints: tuple[int, ...]

    def without(self, other: Self) -> int:
        """Return the number of leading joints that do not move the other shape."""
        shared = 0
        while shared < min(len(self.joints), len(other.joints)) and (
            self.joints[-1 - shared] == other.joints[-1 - shared]
        ):
            shared += 1
        return len(self.joints) - shared


class Tested(NamedTuple):
    """Test results of pairs of shapes in configurations; arrays have the shape (k,).

    Attributes:
        is_open: Whether contact is possible within the changes of the joints.
        travel: Maximum relative travel of the shapes [m].
        gaps: Proven lower bounds of the distances in the configuration [m].
        measured: Measured distances [m]; infinite if not measured.
    """

    is_open: Bools
    travel: Floats
    gaps: Floats
    measured: Floats


class _Cases(NamedTuple):
    """Tests: each of a pair of geoms in one configuration (``rows``), with the bounds known so far; see ``Tested``."""

    rows: Ints
    pairs: Ints
    needed: Floats  # gaps with which they cannot come too near [m]
    gaps: Floats
    measured: Floats

    def open_of(self, cases: Ints) -> Ints:
        """Return those of the tests ``cases``, given by index, with gaps that may be too small for the travel."""
        return cases[self.gaps[cases] <= self.needed[cases]]


class Clearances:
    """Clearance tests of pairs of shapes in many configurations.

    Args:
        model: The model of the world.
        data: Its state; ``take`` reads it, and ``test`` changes geom poses in it.
        shapes: Exact tests of two geoms.
        pairs: Both geoms of each pair, shape (n, 2).
        chains: The joints that move each geom, by MuJoCo's numbers; higher numbers are virtual joints of the bases.
        bases: The MuJoCo body at the origin of each moving base, which has two virtual joints: rotation and
            translation.
    """

    most = _ONCE
    """Maximum number of configurations per call."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        shapes: ShapeTests,
        pairs: Ints,
        chains: dict[int, Chain],
        bases: Sequence[int],
    ) -> None:
        self._model, self._data, self._shapes = model, data, shapes
        self._first, self._second = pairs.T
        self._bases = list(bases)
        slides = (model.jnt_type == mujoco.mjtJoint.mjJNT_SLIDE).tolist()
        self._slides = np.array([*slides, *([False, True] * len(bases)), True])  # the last is for no joint
        self._directions = np.full((len(pairs), 3), np.nan)
        self._supports = _Supports(model)
        concave = np.zeros(model.ngeom, dtype=bool)
        used = np.unique(pairs)
        concave[used] = [shapes.is_concave(geom) for geom in used.tolist()]
        self._concave = concave[self._first] | concave[self._second]
        self._find_chains(chains)
        joints = len(self._slides) - 1
        self._positions, self._rotations = np.zeros((_ONCE, model.ngeom, 3)), np.zeros((_ONCE, model.ngeom, 3, 3))
        self._anchors, self._axes = np.zeros((2, _ONCE, joints, 3))

    def _find_chains(self, chains: dict[int, Chain]) -> None:
        self._moving = np.array(sorted(chains), dtype=int)
        depth = max((len(chain.joints) for chain in chains.values()), default=0)
        self._joints = np.full((len(self._moving), depth), -1)
        for row, geom in enumerate(self._moving.tolist()):
            self._joints[row, : len(chains[geom].joints)] = chains[geom].joints
        rows = np.full(self._model.ngeom, -1)
        rows[self._moving] = np.arange(len(self._moving))
        self._rows = np.stack([rows[self._first], rows[self._second]])
        kinds = list(dict.fromkeys([Chain(()), *chains.values()]))
        depths = np.array([[kind.without(other) for other in kinds] for kind in kinds])
        numbers = np.zeros(self._model.ngeom, dtype=int)
        numbers[list(chains)] = [kinds.index(chain) for chain in chains.values()]
        first, second = numbers[self._first], numbers[self._second]
        self._depths = np.stack([depths[first, second], depths[second, first]])

    def take(self, slot: int) -> None:
        """Store the present state as configuration ``slot`` of the next ``test``."""
        model, data = self._model, self._data
        self._positions[slot], self._rotations[slot] = data.geom_xpos, data.geom_xmat.reshape(-1, 3, 3)
        self._anchors[slot, : model.njnt], self._axes[slot, : model.njnt] = data.xanchor, data.xaxis
        if self._bases:
            self._anchors[slot, model.njnt :] = np.repeat(data.xpos[self._bases], 2, axis=0)

    def test(self, changes: Floats, rows: Ints, pairs: Ints, apart: float = 0.0) -> Tested:
        """Test which pairs may come closer than a distance [m] while joints change.

        Each of the k tests is for one configuration and one pair.

        Args:
            changes: Maximum change of each joint [rad or m] in each configuration, shape (m, joints).
            rows: Index of the configuration of each test, ascending, shape (k,).
            pairs: Index of the pair of each test, shape (k,).
            apart: The distance.
        """
        first, second = self._first[pairs], self._second[pairs]
        places, begins = self._positions.reshape(-1, 3), rows * self._model.ngeom
        away = np.take(places, begins + second, axis=0) - np.take(
            places, begins + first, axis=0
        )  # faster than indexing
        centers = np.sqrt((away * away) @ _ONES)
        gaps = centers - (self._model.geom_rbound[first] + self._model.geom_rbound[second])
        travel = self._travel(changes, rows, pairs)
        needed = travel + (apart + SLACK)
        cases = _Cases(rows, pairs, needed, gaps, np.full(len(rows), np.inf))
        near = np.flatnonzero((gaps <= needed) & (needed <= centers))  # beyond, no distance would be enough
        if len(near):
            self._separate(cases, near[~np.isnan(self._directions[pairs[near], 0])])
            near = cases.open_of(near)
            self._measure(cases, _middles(near, pairs))  # whose directions may do for the others
            near = cases.open_of(near)
            self._separate(cases, near)
            near = cases.open_of(near)
            self._measure(cases, near[np.isinf(cases.measured[near])])
        return Tested(gaps <= needed, travel, gaps, cases.measured)

    def put_back(self) -> None:
        """Reset the geom poses to those given by the joint values."""
        mujoco.mj_kinematics(self._model, self._data)

    def _travel(self, changes: Floats, rows: Ints, pairs: Ints) -> Floats:
        """Return the maximum relative travel [m] of the geoms of each pair in its configuration (row), shape (k,)."""
        count, which = len(changes), self._rows[:, pairs]
        is_used = np.zeros(len(self._moving) + 1, dtype=bool)
        is_used[which] = True  # -1, in place of what does not move, is the last one
        used = np.flatnonzero(is_used[:-1])
        geoms, joints = self._moving[used], self._joints[used]
        away = self._positions[:count, geoms, None] - np.take(self._anchors[:count], joints, axis=1)
        along = np.einsum("cgjk,cgjk->cgj", away, np.take(self._axes[:count], joints, axis=1))
        square = np.einsum("cgjk,cgjk->cgj", away, away) - along * along
        lever = np.sqrt(np.maximum(square, 0.0)) + self._model.geom_rbound[geoms, None]
        change = np.column_stack([changes, np.zeros(count)])[:, joints]  # the joint -1 is none
        grows = ~self._slides[joints]
        lever[:, ~grows] = 1.0
        sums = np.zeros((joints.shape[1] + 1, count, len(geoms)))
        for depth in range(joints.shape[1]):
            sums[depth + 1] = sums[depth] + change[..., depth] * (lever[..., depth] + grows[:, depth] * sums[depth])
        places = np.zeros(len(is_used), dtype=int)
        places[used] = np.arange(len(used))
        first, second = (self._depths[:, pairs] * count + rows) * len(used) + places[which]
        flat = sums.ravel()
        return flat[first] + flat[second]

    def _separate(self, cases: _Cases, some: Ints, directions: Floats | None = None, *, exactly: bool = False) -> None:
        """Raise the gap bounds of the tests with the indices ``some`` by planes with the normals ``directions``.

        These are unit vectors or NaN, shape (k, 3); by default the directions of the last measurements. Unless
        ``exactly``, meshes are replaced by their bounding boxes.
        """
        if not len(some):
            return
        pairs, rows = cases.pairs[some], cases.rows[some]
        geoms, rows = np.concatenate([self._first[pairs], self._second[pairs]]), np.concatenate([rows, rows])
        directions = self._directions[pairs] if directions is None else directions
        positions, both = self._positions[rows, geoms], np.concatenate([directions, -directions])
        # Along d, the first shape ends at d c + h(d), and the second one begins at d c - h(-d).
        ends = (both * positions) @ _ONES + self._supports.of(
            geoms, both, self._rotations[rows, geoms], exactly=exactly
        )
        count = len(some)
        cases.gaps[some] = np.fmax(cases.gaps[some], -ends[:count] - ends[count:])

    def _measure(self, cases: _Cases, some: Ints) -> None:
        """Measure the distances in the tests with the indices ``some``, and raise their gap bounds."""
        model, data = self._model, self._data
        pairs = cases.pairs[some]
        first, second = self._first[pairs].tolist(), self._second[pairs].tolist()
        ways, present = np.zeros((len(some), 6)), -1
        distances: list[float] = []
        for row, geom, other, way in zip(cases.rows[some].tolist(), first, second, ways, strict=True):
            if row != present:
                self._place(row)
                present = row
            distances.append(mujoco.mj_geomDistance(model, data, geom, other, _FAR, way))
        far = np.array(distances)
        ways = ways[:, 3:] - ways[:, :3]
        lengths = np.sqrt((ways * ways).sum(axis=1))
        lengths[~((far > 0) & (lengths > 0))] = np.nan
        directions = self._directions[pairs] = ways / lengths[:, None]
        cases.measured[some] = far
        self._separate(cases, some, directions)
        near = cases.gaps[some] <= cases.needed[some]
        self._separate(cases, some[near], directions[near], exactly=True)
        if self._concave.any():
            near = cases.open_of(some)
            self._measure_triangles(cases, near[self._concave[cases.pairs[near]]])

    def _place(self, row: int) -> None:
        self._data.geom_xpos[...] = self._positions[row]
        self._data.geom_xmat[...] = self._rotations[row].reshape(-1, 9)

    def _measure_triangles(self, cases: _Cases, some: Ints) -> None:
        """Measure the distances in the tests ``some`` by the triangles of non-convex meshes; raise their gap bounds.

        It is used if the hulls are too close.
        """
        for case in some.tolist():
            self._place(int(cases.rows[case]))
            pair = cases.pairs[case]
            distance = self._shapes.distance(int(self._first[pair]), int(self._second[pair]))
            cases.measured[case] = distance
            cases.gaps[case] = max(cases.gaps[case], distance - SLACK)


def _middles(cases: Ints, pairs: Ints) -> Ints:
    """Return the middle one, by index, of each geom pair's undecided tests ``cases``."""
    order = np.argsort(pairs[cases], kind="stable")
    _, starts, counts = np.unique(pairs[cases][order], return_index=True, return_counts=True)
    return np.sort(cases[order[starts + counts // 2]])


class _Supports:
    """Support functions of geoms.

    For a direction l in the geom's frame, the support function of a sphere, capsule, cylinder or box is
    ``round + flat |l| + disc |l_xy|``; for the bounding box of a mesh, ``middle l`` is added.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        kinds, size = model.geom_type, model.geom_size
        sphere, capsule, cylinder, mesh = (kinds == kind for kind in (_SPHERE, _CAPSULE, _CYLINDER, _MESH))
        self._round = np.where(sphere | capsule, size[:, 0], 0.0)
        self._disc = np.where(cylinder, size[:, 0], 0.0)
        self._flat = np.where(mesh[:, None], model.geom_aabb[:, 3:], size)
        self._flat[sphere | capsule | cylinder] = 0.0
        self._flat[capsule | cylinder, 2] = size[capsule | cylinder, 1]
        self._middle = np.where(mesh[:, None], model.geom_aabb[:, :3], 0.0)
        self._is_mesh = mesh
        self._vertices = {geom: _hull(model, int(model.geom_dataid[geom])) for geom in np.flatnonzero(mesh).tolist()}

    def of(self, geoms: Ints, directions: Floats, rotations: Floats, *, exactly: bool) -> Floats:
        """Return the maximum of d·x over the points x of each geom, from its origin, for unit vectors d, shape (k, 3).

        Unless ``exactly``, meshes are replaced by their bounding boxes.
        """
        local = np.einsum("ki,kij->kj", directions, rotations)
        size = np.abs(local)
        reach = self._round[geoms] + self._disc[geoms] * np.hypot(size[:, 0], size[:, 1])
        reach += (size * self._flat[geoms] + local * self._middle[geoms]) @ _ONES
        for geom in np.unique(geoms[self._is_mesh[geoms]]).tolist() if exactly else ():
            rows = geoms == geom
            reach[rows] = (local[rows] @ self._vertices[geom].T).max(axis=1)
        return reach


def joints_above(model: mujoco.MjModel, body_id: int) -> list[int]:
    """Return the joints between a body and the world, the nearest first."""
    joints: list[int] = []
    while body_id:
        first, number = int(model.body_jntadr[body_id]), int(model.body_jntnum[body_id])
        joints += range(first + number - 1, first - 1, -1)
        body_id = int(model.body_parentid[body_id])
    return joints


def has_supports(model: mujoco.MjModel, geoms: Ints) -> bool:
    """Return whether the support functions of geoms are known; they are unknown for planes and height fields."""
    return bool(np.isin(model.geom_type[geoms], (_SPHERE, _CAPSULE, _CYLINDER, _BOX, _MESH)).all())


def _hull(model: mujoco.MjModel, mesh: int) -> Floats:
    """Return the vertices of the hull of a mesh, shape (n, 3)."""
    start = int(model.mesh_vertadr[mesh])
    vertices = model.mesh_vert[start : start + int(model.mesh_vertnum[mesh])].astype(float)
    graph = int(model.mesh_graphadr[mesh])
    if graph < 0:
        return vertices
    count = int(model.mesh_graph[graph])
    return vertices[model.mesh_graph[graph + 2 + count : graph + 2 + 2 * count]]

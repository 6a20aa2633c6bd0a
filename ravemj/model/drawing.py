"""Drawings that scripts add to a scene: arrays of points, lines and triangles, independent of renderers.

OpenRAVE's drawing calls (arrow, box, plane, mesh) become primitives of four kinds: points, spheres, lines and
triangles. ``Drawings`` stores them. Adding, changing and removing a drawing is a single operation on a dict, so any
thread and the garbage collector may do it without a lock.
"""

import itertools
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats, Ints

_TIP_OF_ARROW = 0.1
"""Length of an arrow's tip as a fraction of the arrow's length, as in OpenRAVE."""

_SIDES_OF_ARROW = 12
_SIDES_OF_CYLINDER = 32
_SHADES = 16
"""Number of pieces into which a line is divided, per unit of colour difference between its ends."""

_TEXTURE_CELLS = 64
"""Maximum number of cells along a side of a textured plane; finer textures are averaged."""

_BOX_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)
_BOX_FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


class PrimitiveBatch(NamedTuple):
    """Primitives of one kind, as arrays.

    Attributes:
        corners: Positions [m], shape (N, k, 3); k is 1 for points and spheres, 2 for lines, 3 for triangles.
        sizes: Width of points and lines [pixels], radius of spheres [m], unused for triangles, shape (N,).
        rgba: Colours in 0..1, shape (N, 4).
    """

    corners: Floats
    sizes: Floats
    rgba: Floats

    def placed(self, transform: Floats) -> "PrimitiveBatch":
        """Return the primitives transformed by a 4x4 matrix."""
        return self._replace(corners=self.corners @ transform[:3, :3].T + transform[:3, 3])


def _empty(corners: int) -> PrimitiveBatch:
    return PrimitiveBatch(np.empty((0, corners, 3)), np.empty(0), np.empty((0, 4)))


@dataclass(frozen=True, eq=False)
class Primitives:
    """Graphics primitives by kind, as input of renderers. Objects are compared by identity.

    Attributes:
        points: OpenGL points: squares that face the camera, unlit.
        spheres: Spheres, lit.
        lines: Segments of constant width on the screen, unlit.
        triangles: Flat triangles, lit and visible from both sides.
    """

    points: PrimitiveBatch = field(default_factory=lambda: _empty(1))
    spheres: PrimitiveBatch = field(default_factory=lambda: _empty(1))
    lines: PrimitiveBatch = field(default_factory=lambda: _empty(2))
    triangles: PrimitiveBatch = field(default_factory=lambda: _empty(3))

    @property
    def batches(self) -> tuple[PrimitiveBatch, PrimitiveBatch, PrimitiveBatch, PrimitiveBatch]:
        """Points, spheres, lines and triangles."""
        return self.points, self.spheres, self.lines, self.triangles

    def __len__(self) -> int:
        return sum(len(batch.sizes) for batch in self.batches)

    def placed(self, transform: Floats) -> "Primitives":
        """Return the primitives transformed by a 4x4 matrix."""
        return Primitives(*(batch.placed(transform) for batch in self.batches))

    def widened(self, factor: float) -> "Primitives":
        """Return the primitives with scaled screen widths, for pictures of higher resolution."""
        points, lines = (
            batch._replace(sizes=factor * np.maximum(batch.sizes, 1)) for batch in (self.points, self.lines)
        )
        return replace(self, points=points, lines=lines)

    def bounding_sphere(self) -> tuple[Floats, float]:
        """Return the centre (3,) and radius [m] of a bounding sphere; there must be at least one primitive."""
        corners = np.concatenate([batch.corners.reshape(-1, 3) for batch in self.batches])
        center = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
        largest = self.spheres.sizes.max(initial=0.0)
        return center, float(np.linalg.norm(corners - center, axis=1).max() + largest)


NOTHING = Primitives()


def points(positions: Floats, size: float, rgba: Floats) -> Primitives:
    """Return points (N, 3) of a size [pixels], with colours (N, 4)."""
    return Primitives(points=PrimitiveBatch(positions[:, None], np.full(len(positions), size), rgba))


def spheres(positions: Floats, radius: float, rgba: Floats) -> Primitives:
    """Return spheres around positions (N, 3), with colours (N, 4)."""
    return Primitives(spheres=PrimitiveBatch(positions[:, None], np.full(len(positions), radius), rgba))


def line_strip(positions: Floats, width: float, rgba: Floats) -> Primitives:
    """Return the polyline through positions (N, 3); colours (N, 4) are interpolated."""
    first = np.arange(len(positions) - 1)
    return _lines(positions, width, rgba, np.stack([first, first + 1], axis=1))


def line_list(positions: Floats, width: float, rgba: Floats) -> Primitives:
    """Return a line between each pair of positions (N, 3); an odd last position is ignored."""
    return _lines(positions, width, rgba, np.arange(len(positions) // 2 * 2).reshape(-1, 2))


def _lines(positions: Floats, width: float, rgba: Floats, ends: Ints) -> Primitives:
    """Return lines between points ``ends``, (N, 2); one with different end colours is divided into uniform pieces."""
    pieces = max(1, int(np.ceil(_SHADES * np.abs(np.diff(rgba[ends], axis=1)).max(initial=0))))
    cuts = np.arange(pieces + 1) / pieces
    at = positions[ends[:, 0], None] + cuts[:, None] * np.diff(positions[ends], axis=1)
    middles = 0.5 * (cuts[:-1] + cuts[1:])
    colors = rgba[ends[:, 0], None] + middles[:, None] * np.diff(rgba[ends], axis=1)
    corners = np.stack([at[:, :-1], at[:, 1:]], axis=2).reshape(-1, 2, 3)
    return Primitives(lines=PrimitiveBatch(corners, np.full(len(corners), width), colors.reshape(-1, 4)))


def mesh(positions: Floats, triangles: Ints, rgba: Floats) -> Primitives:
    """Return triangles (M, 3) of positions (N, 3); each has the mean colour (N, 4) of its vertices."""
    return _triangles(positions[triangles], rgba[triangles].mean(axis=1))


def _triangles(corners: Floats, rgba: Floats) -> Primitives:
    return Primitives(triangles=PrimitiveBatch(corners, np.zeros(len(corners)), rgba))


def arrow(start: Floats, end: Floats, radius: float, rgba: Floats) -> Primitives:
    """Return an arrow: a shaft of a radius [m] and a tip of twice its width; nothing if its length is zero."""
    along = end - start
    if not along.any():
        return NOTHING
    aside, across = radius * np.linalg.svd(along[None]).Vh[1:]
    turn = np.linspace(0, 2 * np.pi, _SIDES_OF_ARROW, endpoint=False)[:, None]
    ring = np.cos(turn) * aside + np.sin(turn) * across
    neck = end - _TIP_OF_ARROW * along
    outline = [start + 0 * ring, start + ring, neck + ring, neck + 2 * ring, end + 0 * ring]
    return _skin(outline, rgba)


def cylinder(radius: float, height: float, rgba: Floats) -> Primitives:
    """Return a cylinder along z around the origin; ``height`` is its full height [m]."""
    turn = np.linspace(0, 2 * np.pi, _SIDES_OF_CYLINDER, endpoint=False)
    ring = radius * np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    up = np.array([0.0, 0.0, height / 2])
    return _skin([0 * ring - up, ring - up, ring + up, 0 * ring + up], rgba)


def _skin(rings: list[Floats], rgba: Floats) -> Primitives:
    """Return the surface through rings of points, each (N, 3)."""
    corners = np.concatenate([_quads(inner, outer) for inner, outer in itertools.pairwise(rings)])
    return _triangles(corners, np.tile(rgba, (len(corners), 1)))


def _quads(ring: Floats, other: Floats) -> Floats:
    """Return the triangles, shape (n, 3, 3), between two rings of points (N, 3), without degenerate ones."""
    following, other_following = np.roll(ring, -1, axis=0), np.roll(other, -1, axis=0)
    corners = np.concatenate(
        [np.stack([ring, other, other_following], axis=1), np.stack([ring, other_following, following], axis=1)]
    )
    return corners[np.linalg.norm(_normals(corners), axis=1) > 0]


def _normals(corners: Floats) -> Floats:
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def box(center: Floats, extents: Floats, rgba: Floats) -> Primitives:
    """Return an axis-aligned box with half extents (3,) [m]."""
    faces = np.array(_BOX_FACES)[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
    return _triangles((center + _BOX_CORNERS * extents)[faces], np.tile(rgba, (len(faces), 1)))


def plane(transform: Floats, extents: Floats, texture: Floats) -> Primitives:
    """Return an image on a rectangle centred in the xy plane of a frame.

    Args:
        transform: Pose of the frame, shape (4, 4).
        extents: Half extents along x and y [m], shape (2,).
        texture: Colours (H, W, 4) in 0..1. Columns run along +x, rows along +y.
    """
    cells = _averaged(_averaged(texture, 0), 1)
    rows, columns = cells.shape[:2]
    grid = np.zeros((rows + 1, columns + 1, 3))
    grid[..., 0] = np.linspace(-extents[0], extents[0], columns + 1)
    grid[..., 1] = np.linspace(-extents[1], extents[1], rows + 1)[:, None]
    low, high = grid[:-1], grid[1:]
    corners = np.stack([low[:, :-1], low[:, 1:], high[:, 1:], low[:, :-1], high[:, 1:], high[:, :-1]], axis=2)
    rgba = np.repeat(cells.reshape(-1, 4), 2, axis=0)
    return _triangles(corners.reshape(-1, 3, 3), rgba).placed(transform)


def _averaged(texture: Floats, axis: int) -> Floats:
    """Reduce a texture along an axis to at most ``_TEXTURE_CELLS`` pixels, by averages."""
    count = texture.shape[axis]
    cells = min(count, _TEXTURE_CELLS)
    edges: Ints = np.arange(cells, dtype=np.int_) * count // cells
    sizes = np.diff(edges, append=count)
    return np.add.reduceat(texture, edges, axis=axis) / np.expand_dims(sizes, tuple({0, 1, 2} - {axis}))


class Drawing:
    """Drawing that can be moved and hidden.

    Attributes:
        state: Its primitives in the world; None while it is hidden. It is replaced as a whole, so readers need no lock.
        text: A label that viewers show at the first point, or empty.
    """

    def __init__(self, primitives: Primitives, text: str = "") -> None:
        self.text = text
        self._primitives = primitives
        self._transform = np.eye(4)
        self._shown = True
        self.state: Primitives | None = primitives

    def place(self, transform: Floats) -> None:
        """Set the pose of the drawing: a 4x4 transform of its original primitives."""
        self._transform = transform
        self._update()

    def show(self, shown: bool) -> None:
        """Show or hide the drawing."""
        self._shown = shown
        self._update()

    def _update(self) -> None:
        self.state = self._primitives.placed(self._transform) if self._shown else None


class Drawings:
    """All drawings of a scene."""

    def __init__(self) -> None:
        self._drawn: dict[int, Drawing] = {}
        self._keys = itertools.count()
        self._merged: tuple[tuple[Primitives, ...], Primitives] = ((), NOTHING)

    def add(self, primitives: Primitives, text: str = "") -> tuple[int, Drawing]:
        """Add a drawing with a label; return its key for ``remove``, and the drawing."""
        key, drawing = next(self._keys), Drawing(primitives, text)
        self._drawn[key] = drawing
        return key, drawing

    def remove(self, key: int) -> None:
        """Remove a drawing, if it still exists. Takes no lock, so finalizers may call it."""
        self._drawn.pop(key, None)

    def clear(self) -> None:
        """Remove all drawings."""
        self._drawn.clear()

    def primitives(self) -> Primitives:
        """Return the primitives of all visible drawings, cached until one changes."""
        states = [drawing.state for drawing in self._drawn.copy().values()]
        visible = tuple(state for state in states if state is not None)
        before, merged = self._merged
        if visible != before:
            merged = merge(visible)
            self._merged = (visible, merged)
        return merged

    def texts(self) -> list[tuple[Floats, str]]:
        """Return for each visible drawing with a label its position, shape (3,), and the label."""
        labels = [(drawing.state, drawing.text) for drawing in self._drawn.copy().values() if drawing.text]
        return [(state.points.corners[0, 0], text) for state, text in labels if state is not None]


def merge(parts: Iterable[Primitives]) -> Primitives:
    """Concatenate several sets of primitives."""
    by_kind = zip(NOTHING.batches, *(part.batches for part in parts), strict=True)
    return Primitives(
        *(PrimitiveBatch(*(np.concatenate(arrays) for arrays in zip(*kind, strict=True))) for kind in by_kind)
    )

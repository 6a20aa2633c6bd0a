"""Rasterization of drawings without OpenGL, for the ray caster.

Each primitive is tested against the pixels of its bounding rectangle, all primitives of a kind at once, so the cost
is proportional to the number of covered pixels.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints
from ravemj.graphics.rendering.camera import Camera, Pinhole
from ravemj.graphics.rendering.lights import Lights
from ravemj.model.drawing import PrimitiveBatch, Primitives

_AT_ONCE = 1 << 20
"""Maximum number of (primitive, pixel) pairs tested at once."""

_PIECE = 16.0
"""Length of the segments into which lines are divided [pixels], so that bounding rectangles stay small."""

_NEAREST = 1e-6
"""Near clipping depth of drawings [m]."""

_SLACK = 1e-9
"""Tolerance of barycentric coordinates, so that there are no gaps between adjacent triangles."""


class Fragments(NamedTuple):
    """Contributions of drawings to the colours of rays, in any order."""

    ray: Ints  # index of the ray, (N,)
    depth: Floats  # along the viewing direction, (N,) [m]
    color: Floats  # colour and opacity, (N, 4): 0..255 and 0..1

    def select(self, chosen: NDArray[np.bool_]) -> "Fragments":
        """Return the fragments that a mask selects, shape (N,)."""
        return Fragments(self.ray[chosen], self.depth[chosen], self.color[chosen])

    def between(self, start: int, stop: int) -> "Fragments":
        """Return the fragments of the rays ``start`` to ``stop - 1``, renumbered from 0."""
        some = self.select((self.ray >= start) & (self.ray < stop))
        return some._replace(ray=some.ray - start)

    def of_rays(self, rays: Ints, count: int) -> "Fragments":
        """Return the fragments of a subset of ``count`` rays, renumbered by the order of the subset."""
        place = np.full(count, -1)
        place[rays] = np.arange(len(rays))
        some = self.select(place[self.ray] >= 0)
        return some._replace(ray=place[some.ray])

    def over(self, colors: Floats) -> None:
        """Blend the fragments over the colours of the rays, shape (M, 3) in 0..255, from back to front."""
        nearest_wall = np.full(len(colors), np.inf)
        opaque = self.color[:, 3] >= 1
        np.minimum.at(nearest_wall, self.ray[opaque], self.depth[opaque])
        seen = self.select(self.depth <= nearest_wall[self.ray])
        order = np.lexsort((-seen.depth, seen.ray))
        ray, color = seen.ray[order], seen.color[order]
        starts = np.flatnonzero(np.diff(ray, prepend=-1))
        layer = np.arange(len(ray)) - np.repeat(starts, np.diff(starts, append=len(ray)))
        for number in range(int(layer.max(initial=-1)) + 1):
            here = np.flatnonzero(layer == number)
            alpha = color[here, 3:]
            colors[ray[here]] = alpha * color[here, :3] + (1 - alpha) * colors[ray[here]]


NO_FRAGMENTS = Fragments(np.empty(0, dtype=np.int_), np.empty(0), np.empty((0, 4)))


@dataclass
class Raster:
    """Rasterizer of the drawings of one picture."""

    camera: Camera
    size: tuple[int, int]  # columns and rows
    lights: Lights  # lights on triangles and spheres
    offset: tuple[float, float] = (0.0, 0.0)  # offset of rays from the pixel centres, right and down [pixels]
    ray_of_pixel: Ints | None = None  # index of the ray of each pixel, (H * W,), -1: none; None: its own number

    def fragments(self, primitives: Primitives) -> Fragments:
        """Return the fragments of drawings given in the world."""
        T_camera_world = np.eye(4)
        T_camera_world[:3, :3] = self.camera.rotation.T
        T_camera_world[:3, 3] = -self.camera.rotation.T @ self.camera.position
        points, spheres, lines, triangles = primitives.placed(T_camera_world).batches
        fragments = [*self._points(points), *self._spheres(spheres), *self._lines(lines), *self._triangles(triangles)]
        return (
            Fragments(*(np.concatenate(arrays) for arrays in zip(*fragments, strict=True)))
            if fragments
            else NO_FRAGMENTS
        )

    def _points(self, batch: PrimitiveBatch) -> Iterator[Fragments]:
        batch = _select(batch, batch.corners[:, 0, 2] > _NEAREST)
        center, half = self._project(batch.corners[:, 0]), 0.5 * np.maximum(batch.sizes, 1)[:, None]
        for owner, ray, _ in self._pairs(center - half, center + half):
            yield _flat(ray, batch.corners[owner, 0, 2], batch.rgba[owner])

    def _lines(self, batch: PrimitiveBatch) -> Iterator[Fragments]:
        batch = _select(batch, batch.corners[:, :, 2].max(axis=1) > _NEAREST)
        ends = _cut_off(batch.corners)
        start, along = self._project(ends[:, 0]), self._project(ends[:, 1]) - self._project(ends[:, 0])
        length = np.linalg.norm(along, axis=1)
        half = 0.5 * np.maximum(batch.sizes, 1)
        line, first, last = self._pieces(start, along, half)
        at_first, at_last = (start[line] + part[:, None] * along[line] for part in (first, last))
        reach = half[line, None]
        low, high = np.minimum(at_first, at_last) - reach, np.maximum(at_first, at_last) + reach
        for piece, ray, at in self._pairs(low, high):
            owner = line[piece]
            x, y = (at - start[owner]).T
            part = (x * along[owner, 0] + y * along[owner, 1]) / length[owner] ** 2
            aside = np.abs(x * along[owner, 1] - y * along[owner, 0]) / length[owner]
            hit = (aside <= half[owner]) & (part >= first[piece]) & (part < last[piece])
            owner, part = owner[hit], part[hit]
            depth = 1 / ((1 - part) / ends[owner, 0, 2] + part / ends[owner, 1, 2])
            yield _flat(ray[hit], depth, batch.rgba[owner])

    def _pieces(self, start: Floats, along: Floats, half: Floats) -> tuple[Ints, Floats, Floats]:
        """Cut the visible parts of screen lines into segments; return line index, start and end (0..1) of each.

        ``start`` and ``along`` are the lines' start points and vectors to their ends, ``half`` half their widths [px].
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            crossings = np.stack([-half[:, None] - start, self.size + half[:, None] - start]) / along
        first = np.nanmax(np.minimum(*crossings), axis=1, initial=0)
        last = np.nanmin(np.maximum(*crossings), axis=1, initial=1)
        length = np.linalg.norm(along, axis=1) * (last - first)
        count = np.where(length > 0, np.ceil(length / _PIECE), 0).astype(int)
        line, number = _numbered(count)
        step = (last - first)[line] / count[line]
        return line, first[line] + number * step, first[line] + (number + 1) * step

    def _spheres(self, batch: PrimitiveBatch) -> Iterator[Fragments]:
        center, radius = batch.corners[:, 0], batch.sizes
        batch = _select(batch, (center[:, 2] > -radius) & (np.linalg.norm(center, axis=1) > radius))
        center, radius = batch.corners[:, 0], batch.sizes
        for owner, ray, at in self._pairs(*self._around_spheres(center, radius)):
            direction = self._directions(at)
            square = np.einsum("ij,ij->i", direction, direction)
            middle = np.einsum("ij,ij->i", direction, center[owner]) / square
            half = (radius[owner] ** 2 - np.einsum("ij,ij->i", center[owner], center[owner])) / square + middle**2
            hit = (half >= 0) & (middle > 0)
            sphere = owner[hit]
            depth = middle[hit] - np.sqrt(half[hit])
            normals = (depth[:, None] * direction[hit] - center[sphere]) / radius[sphere, None]
            yield self._lit(ray[hit], depth, direction[hit], normals, batch.rgba[sphere])

    def _around_spheres(self, center: Floats, radius: Floats) -> tuple[Floats, Floats]:
        """Return the bounding rectangles on the screen; the whole screen for spheres cut by the camera plane."""
        x_or_y, depth, r = center[:, :2], center[:, 2:], radius[:, None]
        in_front = (depth > r)[:, 0]
        low, high = _whole_screen(len(radius))
        x_or_y, depth, r = x_or_y[in_front], depth[in_front], r[in_front]
        aside = r * np.sqrt(x_or_y**2 + depth**2 - r**2)
        focal, principal = np.array(self._pinhole).reshape(2, 2)
        low[in_front] = (x_or_y * depth - aside) / (depth**2 - r**2) * focal + principal
        high[in_front] = (x_or_y * depth + aside) / (depth**2 - r**2) * focal + principal
        return low, high

    def _triangles(self, batch: PrimitiveBatch) -> Iterator[Fragments]:
        batch = _select(batch, batch.corners[:, :, 2].max(axis=1) > _NEAREST)
        corners = batch.corners
        edge, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        facing, first, second = np.cross(other, edge), np.cross(corners[:, 0], other), np.cross(edge, corners[:, 0])
        volume = np.einsum("ij,ij->i", other, second)
        normals = facing / np.maximum(np.linalg.norm(facing, axis=1), np.finfo(float).tiny)[:, None]
        for owner, ray, at in self._pairs(*self._around_triangles(corners)):
            direction = self._directions(at)
            with np.errstate(divide="ignore", invalid="ignore"):
                scale = 1 / np.einsum("ij,ij->i", direction, facing[owner])
                u = np.einsum("ij,ij->i", direction, first[owner]) * scale
                v = np.einsum("ij,ij->i", direction, second[owner]) * scale
                depth = volume[owner] * scale
                hit = (u >= -_SLACK) & (v >= -_SLACK) & (u + v <= 1 + _SLACK) & (depth > 0)
            yield self._lit(ray[hit], depth[hit], direction[hit], normals[owner[hit]], batch.rgba[owner[hit]])

    def _around_triangles(self, corners: Floats) -> tuple[Floats, Floats]:
        """Return the bounding rectangles on the screen; the whole screen for triangles cut by the camera plane."""
        in_front = (corners[:, :, 2] > _NEAREST).all(axis=1)
        low, high = _whole_screen(len(corners))
        on_screen = self._project(corners[in_front])
        low[in_front], high[in_front] = on_screen.min(axis=1), on_screen.max(axis=1)
        return low, high

    @property
    def _pinhole(self) -> Pinhole:
        return self.camera.pinhole(*self.size)

    def _project(self, points: Floats) -> Floats:
        """Project points in the camera frame, shape (..., 3), to the screen, shape (..., 2) [pixels]."""
        focal, principal = np.array(self._pinhole).reshape(2, 2)
        return points[..., :2] / points[..., 2:] * focal + principal

    def _directions(self, at: Floats) -> Floats:
        """Return the rays through points of the screen, (N, 2), in the camera frame with depth 1, (N, 3)."""
        focal, principal = np.array(self._pinhole).reshape(2, 2)
        return np.column_stack([(at - principal) / focal, np.ones(len(at))])

    def _lit(self, ray: Ints, depth: Floats, directions: Floats, normals: Floats, rgba: Floats) -> Fragments:
        to_world = self.camera.rotation.T
        rays = directions @ to_world
        light, _ = self.lights.on(self.camera.position + depth[:, None] * rays, rays, normals @ to_world)
        return _flat(ray, depth, np.column_stack([np.minimum(rgba[:, :3] * light, 1), rgba[:, 3]]))

    def _pairs(self, low: Floats, high: Floats) -> Iterator[tuple[Ints, Ints, Floats]]:
        """Yield, in batches, all pairs of a rectangle and a pixel in it; ``low`` and ``high`` are corners, (N, 2) [px].

        A batch is: rectangle indices, ray indices of the pixels, and the pixel centres, shape (M, 2) [px].
        """
        center = 0.5 + np.array(self.offset)
        first = np.ceil(np.clip(low - center, 0, self.size)).astype(int)
        last = np.ceil(np.clip(high - center, 0, self.size)).astype(int)
        extents = np.maximum(last - first, 0)
        pixels = extents.prod(axis=1)
        some = np.flatnonzero(pixels)
        for chunk in np.split(some, np.flatnonzero(np.diff(np.cumsum(pixels[some]) // _AT_ONCE)) + 1):
            within, number = _numbered(pixels[chunk])
            owner = chunk[within]
            row, column = np.divmod(number, extents[owner, 0])
            row, column = row + first[owner, 1], column + first[owner, 0]
            ray = row * self.size[0] + column
            if self.ray_of_pixel is not None:
                ray = self.ray_of_pixel[ray]
                wanted = ray >= 0
                owner, ray, row, column = owner[wanted], ray[wanted], row[wanted], column[wanted]
            yield owner, ray, np.stack([column, row], axis=1) + center


def _whole_screen(count: int) -> tuple[Floats, Floats]:
    """Return bounds of ``count`` infinite rectangles: -inf and inf, shape (count, 2) each."""
    return np.full((count, 2), -np.inf), np.full((count, 2), np.inf)


def _select(batch: PrimitiveBatch, chosen: NDArray[np.bool_]) -> PrimitiveBatch:
    return PrimitiveBatch(*(array[chosen] for array in batch))


def _flat(ray: Ints, depth: Floats, rgba: Floats) -> Fragments:
    return Fragments(ray, depth, np.clip(rgba, 0, 1) * [255, 255, 255, 1])


def _numbered(counts: Ints) -> tuple[Ints, Ints]:
    """Return each index i repeated ``counts[i]`` times, and for each repetition its number, from 0."""
    index = np.repeat(np.arange(len(counts)), counts)
    first = np.cumsum(counts) - counts
    return index, np.arange(len(index)) - first[index]


def _cut_off(ends: Floats) -> Floats:
    """Clip lines in the camera frame, shape (N, 2, 3), at the near depth."""
    depth = ends[:, :, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        part = (_NEAREST - depth[:, 0]) / (depth[:, 1] - depth[:, 0])
        cut = ends[:, 0] + part[:, None] * (ends[:, 1] - ends[:, 0])
    return np.where((depth < _NEAREST)[:, :, None], cut[:, None], ends)

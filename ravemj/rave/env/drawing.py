"""Drawings of scripts: points, lines, arrows, boxes, planes, triangles and labels."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers, checked_transform, checked_vector
from ravemj.core.transforms import Floats, Ints
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.geometry_functions import AABB, OrientedBox
from ravemj.model import drawing
from ravemj.model.drawing import Primitives
from ravemj.rave.env.base import EnvironmentPart
from ravemj.rave.graph_handle import GraphHandle

_DEFAULT_COLOR = (1.0, 0.5, 0.5, 1.0)  # OpenRAVE's pink
_LABEL_POINT = 4.0
"""Size of the point of a label [pixels]."""


class Drawing(EnvironmentPart):
    """Drawings beside the bodies: points, lines, arrows, boxes, planes, triangles and labels.

    Colours are red, green and blue from 0 to 1, with alpha as an optional fourth number; the default is OpenRAVE's pink
    (1, 0.5, 0.5). Without a viewer, all methods check their arguments and return None, as in OpenRAVE. To have drawings
    in ``env.render()`` and in videos, ``env.SetViewer('offscreen')`` is enough.
    """

    def _draw(self, primitives: Primitives, text: str = "") -> GraphHandle | None:
        return None if self._viewer is None else GraphHandle(self._simulation.drawings, primitives, text)

    def plot3(
        self, points: ArrayLike, pointsize: float, colors: ArrayLike | None = None, drawstyle: int = 0
    ) -> GraphHandle | None:
        """Draw points.

        Args:
            points: One point (3,), or (N, 3), or a flat list of 3 N numbers, in the world [m].
            pointsize: The width on the screen [pixels]; with ``drawstyle=1`` the radius [m].
            colors: One colour for all, or one for each point: (3,), (4,), (N, 3) or (N, 4).
            drawstyle: 0 for points of constant size on the screen, 1 for spheres.

        Returns:
            The handle that keeps the drawing; None without a viewer.

        Raises:
            ArgumentError: there are no points, or a shape or a number is wrong.

        Example:
            >>> handle = env.plot3([[0, 0, 1], [0, 0.1, 1]], 6, [[1, 0, 0], [0, 0, 1]])
            >>> balls = env.plot3([0, 0, 1], 0.02, drawstyle=1)
        """
        positions = _checked_points(points)
        rgba = _checked_colors(colors, len(positions))
        size = _checked_size(pointsize, "pointsize")
        if drawstyle not in (0, 1):
            raise ArgumentError(f"drawstyle: is {drawstyle!r}, and should be 0 or 1")
        return self._draw((drawing.spheres if drawstyle else drawing.points)(positions, size, rgba))

    def drawlinestrip(
        self, points: ArrayLike, linewidth: float, colors: ArrayLike | None = None, drawstyle: int = 0
    ) -> GraphHandle | None:
        """Draw a line from each point to the next.

        Args:
            points: (N, 3) or a flat list, in the world [m].
            linewidth: The width on the screen [pixels].
            colors: One colour, or one for each point, with a gradient between them.
            drawstyle: Not used, as in OpenRAVE.

        Returns:
            The handle that keeps the drawing; None without a viewer.

        Raises:
            ArgumentError: there are no points, or a shape or a number is wrong.
        """
        del drawstyle
        return self._draw(drawing.line_strip(*_checked_lines(points, linewidth, colors)))

    def drawlinelist(
        self, points: ArrayLike, linewidth: float, colors: ArrayLike | None = None, drawstyle: int = 0
    ) -> GraphHandle | None:
        """Draw one line between the first two points, another between the next two, and so on.

        Args:
            points: (N, 3) or a flat list, in the world [m]. If N is odd, the last point is ignored.
            linewidth: The width on the screen [pixels].
            colors: One colour, or one for each point, with a gradient between them.
            drawstyle: Not used, as in OpenRAVE.

        Returns:
            The handle that keeps the drawing; None without a viewer.

        Raises:
            ArgumentError: there are no points, or a shape or a number is wrong.
        """
        del drawstyle
        return self._draw(drawing.line_list(*_checked_lines(points, linewidth, colors)))

    def drawarrow(
        self, p1: ArrayLike, p2: ArrayLike, linewidth: float = 0.002, color: ArrayLike | None = None
    ) -> GraphHandle | None:
        """Draw an arrow.

        Args:
            p1: The start, in the world [m], (3,).
            p2: The tip, in the world [m], (3,).
            linewidth: The radius of the shaft [m].
            color: One colour.

        Returns:
            The handle that keeps the drawing; None without a viewer.

        Raises:
            ArgumentError: a shape or a number is wrong.

        Example:
            >>> force = env.drawarrow([0, 0, 0], [0, 0, 0.5], linewidth=0.01, color=[1, 0, 0])
        """
        start, end = checked_vector(p1, 3, "p1"), checked_vector(p2, 3, "p2")
        rgba = _checked_colors(color, 1)[0]
        return self._draw(drawing.arrow(start, end, _checked_size(linewidth, "linewidth"), rgba))

    def drawbox(self, pos: ArrayLike, extents: ArrayLike, color: ArrayLike | None = None) -> GraphHandle | None:
        """Draw a box along the axes of the world.

        Args:
            pos: The centre, in the world [m], (3,).
            extents: The half extents [m], (3,).
            color: One colour.

        Returns:
            The handle that keeps the drawing; None without a viewer. ``SetTransform`` turns it.

        Raises:
            ArgumentError: a shape or a number is wrong.
        """
        center, half = checked_vector(pos, 3, "pos"), checked_vector(extents, 3, "extents")
        return self._draw(drawing.box(center, half, _checked_colors(color, 1)[0]))

    def drawboxarray(self, pos: ArrayLike, extents: ArrayLike, color: ArrayLike | None = None) -> GraphHandle | None:
        """Draw boxes of equal size along the axes of the world.

        Args:
            pos: The centres, in the world [m], (N, 3).
            extents: The half extents of each box [m], (3,).
            color: One colour.

        Returns:
            The handle that keeps the drawing; None without a viewer.
        """
        half, rgba = checked_vector(extents, 3, "extents"), _checked_colors(color, 1)[0]
        return self._draw(drawing.merge(drawing.box(center, half, rgba) for center in _checked_points(pos)))

    def drawaabb(
        self, aabb: AABB, transform: ArrayLike, color: ArrayLike | None = None, transparency: float = 0.0
    ) -> GraphHandle | None:
        """Draw a box that is axis-aligned in a given frame.

        Args:
            aabb: The box, along the axes of the frame.
            transform: ``T_world_frame``: 4x4, 3x4 or a pose.
            color: One colour.
            transparency: 0 is opaque, 1 invisible.

        Returns:
            The handle that keeps the drawing; None without a viewer.
        """
        rgba = _checked_colors(color, 1)[0]
        rgba[3] *= 1 - transparency
        return self._draw(
            drawing.box(aabb.pos(), aabb.extents(), rgba).placed(checked_transform(transform, "transform"))
        )

    def drawobb(
        self, obb: OrientedBox, color: ArrayLike | None = None, transparency: float = 0.0
    ) -> GraphHandle | None:
        """Draw an oriented box.

        Args:
            obb: The box.
            color: One colour.
            transparency: 0 is opaque, 1 invisible.

        Returns:
            The handle that keeps the drawing; None without a viewer.
        """
        return self.drawaabb(AABB((0, 0, 0), obb.extents()), obb.transform(), color, transparency)

    def drawlabel(
        self, label: str, worldPosition: ArrayLike, color: ArrayLike | None = None, height: float = 0.05
    ) -> GraphHandle | None:
        """Draw a point with a text beside it.

        Windows and pages show the text, in a font of fixed size; pictures and videos show the point only.

        Args:
            label: The text.
            worldPosition: The point [m], (3,).
            color: One colour, for the point.
            height: Not used.

        Returns:
            The handle that keeps the text; None without a viewer.

        Example:
            >>> handle = env.drawlabel("goal", [0.5, 0, 1])
        """
        del height
        position = _checked_points(checked_vector(worldPosition, 3, "worldPosition"))
        text = checked_kind(label, str, "drawlabel: label", "a text")
        return self._draw(drawing.points(position, _LABEL_POINT, _checked_colors(color, 1)), text)

    def drawplane(self, transform: ArrayLike, extents: ArrayLike, texture: ArrayLike) -> GraphHandle | None:
        """Draw an image on a rectangle, reduced to at most 64 x 64 cells.

        Args:
            transform: ``T_world_rectangle``: 4x4, 3x4 or a pose. The rectangle is centred at the origin of this frame,
                in its xy plane.
            extents: The half extents along x and y [m], (2,); a third number is ignored.
            texture: An image (H, W), (H, W, 1), (H, W, 3) or (H, W, 4): integers up to 255, or floats from 0 to 1.
                Columns run along x and rows along y.

        Returns:
            The handle that keeps the drawing; None without a viewer.

        Raises:
            ArgumentError: a shape or a number is wrong.
        """
        frame = checked_transform(transform, "transform")
        sides = checked_numbers(extents, "extents")
        half = checked_vector(sides[:2] if sides.shape == (3,) else sides, 2, "extents")
        return self._draw(drawing.plane(frame, half, _checked_texture(texture)))

    def drawtrimesh(
        self, points: ArrayLike, indices: ArrayLike | None = None, colors: ArrayLike | None = None
    ) -> GraphHandle | None:
        """Draw triangles, which are visible from both sides.

        Args:
            points: The vertices, (N, 3) or a flat list, in the world [m].
            indices: Three vertices for each triangle, (M, 3) or a flat list of integers. By default vertices 0, 1, 2
                make a triangle, then 3, 4, 5, and so on.
            colors: One colour, or one for each vertex: (3,), (4,), (N, 3) or (N, 4).

        Returns:
            The handle that keeps the drawing; None without a viewer.

        Raises:
            ArgumentError: there are no points, a shape or a number is wrong, or an index is out of range.
        """
        corners = _checked_points(points)
        rgba = _checked_colors(colors, len(corners))
        return self._draw(drawing.mesh(corners, _checked_triangles(indices, len(corners)), rgba))


def _checked_lines(points: ArrayLike, width: float, colors: ArrayLike | None) -> tuple[Floats, float, Floats]:
    positions = _checked_points(points)
    return positions, _checked_size(width, "linewidth"), _checked_colors(colors, len(positions))


def _checked_points(points: ArrayLike) -> Floats:
    numbers = checked_numbers(points, "points")
    if numbers.size == 0 or numbers.ndim > 2 or numbers.shape[-1] % 3 or (numbers.ndim == 2 and numbers.shape[1] != 3):
        raise ArgumentError(f"points: has shape {numbers.shape}, and should have shape (3,) or (N, 3), and N > 0")
    if not np.isfinite(numbers).all():
        raise ArgumentError("points: should be finite numbers")
    return numbers.reshape(-1, 3)


def _checked_colors(colors: ArrayLike | None, count: int) -> Floats:
    """Return as many colours with alpha, (count, 4)."""
    numbers = np.atleast_2d(checked_numbers(_DEFAULT_COLOR if colors is None else colors, "colors"))
    if numbers.ndim > 2 or numbers.shape[1] not in (3, 4) or len(numbers) not in (1, count):
        message = f"colors: has shape {numbers.shape}, and should be one colour or {count}, of 3 or 4 numbers each"
        raise ArgumentError(message, ErrorCode.Failed)
    if not np.isfinite(numbers).all():
        raise ArgumentError("colors: should be finite numbers")
    rgba = np.ones((count, 4))
    rgba[:, : numbers.shape[1]] = np.clip(numbers, 0, 1)
    return rgba


def _checked_size(size: float, name: str) -> float:
    (number,) = checked_vector(size, 1, name)
    if number < 0:
        raise ArgumentError(f"{name}: is {number:g}, and should not be negative")
    return float(number)


def _checked_triangles(indices: ArrayLike | None, count: int) -> Ints:
    if indices is None:
        return np.arange(count // 3 * 3).reshape(-1, 3)
    numbers = checked_numbers(indices, "indices")
    if numbers.ndim > 2 or numbers.shape[-1] % 3 or (numbers.ndim == 2 and numbers.shape[1] != 3):
        raise ArgumentError(f"indices: has shape {numbers.shape}, and should have shape (M, 3)")
    if not np.isin(numbers, np.arange(count)).all():
        raise ArgumentError(f"indices: should be integers from 0 to {count - 1}")
    return numbers.astype(np.int_).reshape(-1, 3)


def _checked_texture(texture: ArrayLike) -> Floats:
    """Return an image as colours with alpha, (H, W, 4) in 0..1."""
    numbers = checked_numbers(texture, "texture")
    if np.issubdtype(np.asarray(texture).dtype, np.integer):
        numbers /= 255
    image = numbers[:, :, None] if numbers.ndim == 2 else numbers
    if image.ndim != 3 or image.size == 0 or image.shape[2] not in (1, 3, 4) or not np.isfinite(image).all():
        raise ArgumentError(f"texture: has shape {numbers.shape}, and should be an image (H, W, 3) or (H, W, 4)")
    rgba = np.ones((*image.shape[:2], 4))
    rgba[:, :, :3] = image[:, :, :3]
    if image.shape[2] == 4:
        rgba[:, :, 3] = image[:, :, 3]
    return np.clip(rgba, 0, 1)

"""Viewers, pictures and drawings of an environment."""

import os
import weakref
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_integer, checked_kind
from ravemj.core.arrays import checked_numbers, checked_transform, checked_vector
from ravemj.core.handles import Handle
from ravemj.core.output import AnyPath, check_file
from ravemj.core.transforms import Floats, Ints
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.geometry_functions import AABB, OrientedBox
from ravemj.graphics.rendering import Camera
from ravemj.graphics.rendering.checks import checked_colour
from ravemj.graphics.rendering.style import AS_USUAL, Look, LookChoices
from ravemj.graphics.simulation_renderer import Format, Frame, SimulationRenderer
from ravemj.model import drawing
from ravemj.model.drawing import Drawings, Primitives
from ravemj.model.look import WHITE
from ravemj.rave.interface import EnvironmentPart

if TYPE_CHECKING:
    from pathlib import Path

    from ravemj.graphics.webgl.animation import Animation
    from ravemj.gui.viewers import Viewer
    from ravemj.gui.viewers.web import WebViewer
    from ravemj.rave.kinbody import KinBody
    from ravemj.trajectories.motion_arguments import MotionLike


_DEFAULT_COLOR = (1.0, 0.5, 0.5, 1.0)  # OpenRAVE's pink
_LABEL_POINT = 4.0
"""Size of the point beside a label [pixels]."""


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
    """Return a colour with alpha for each element, (count, 4)."""
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
    """Convert an image to colours with alpha, (H, W, 4), from 0 to 1."""
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


class GraphHandle(Handle):
    """Handle of a drawing, which disappears with the last reference to the handle.

    Example:
        >>> handle = env.plot3([0, 0, 1], 8)
        >>> handle.SetShow(False)
        >>> handle = None  # gone
    """

    _often_called = ("SetTransform",)

    def __init__(self, drawings: Drawings, primitives: Primitives, text: str = "") -> None:
        key, self._drawing = drawings.add(primitives, text)
        super().__init__(drawings.remove, key)

    def SetTransform(self, transform: ArrayLike) -> None:
        """Set the pose of the drawing relative to the original one.

        Args:
            transform: The rigid transform, in the world, of the points as they were first drawn: 4x4, 3x4, or a pose
                [w, x, y, z, tx, ty, tz]; the identity restores them.

        Raises:
            ArgumentError: the transform is not rigid.
        """
        self._drawing.place(checked_transform(transform, "SetTransform: transform"))

    def SetShow(self, show: bool) -> None:
        """Show the drawing if ``show``, else hide it."""
        self._drawing.show(bool(show))


class Viewing(EnvironmentPart):
    """Viewers, pictures (which do not need a viewer), and drawings of an environment.

    Drawings are points, lines, arrows, boxes, planes, triangles and labels. Colours are red, green and blue, 0 to 1,
    with alpha as an optional fourth number; the default is OpenRAVE's pink (1, 0.5, 0.5). Without a viewer, all methods
    check their arguments and return None, as in OpenRAVE. To have drawings in ``env.render()`` and in videos,
    ``env.SetViewer('offscreen')`` is enough.
    """

    _internal = ("look", "open_viewer", "own_background", "renderer")

    def SetViewer(self, viewername: str, showviewer: bool = True) -> bool:
        """Attach a viewer, which replaces earlier ones. ``RaveCreateViewer`` attaches additional viewers.

        With a display, a window opens; it shows every change while the script runs on. In a notebook, a page in the
        cell does so. Without either, as on a server, the viewer only draws pictures on request, so the same script runs
        there as well.

        The camera starts with the view of the loaded file, else with a view from above; ``GetViewer().SetCamera`` moves
        it.

        Args:
            viewername: ``'window'`` opens a window, or logs a warning if there is no display. ``'web'`` serves a page
                for a browser on this machine, at ``GetViewer().url``. ``'offscreen'`` does neither. OpenRAVE's names,
                such as ``'qtcoin'``, select a window if there is a display, else a page in a notebook, else
                ``'offscreen'``; the log says which. On macOS a page replaces windows. ``''`` removes the viewer.
            showviewer: False never opens a window.

        Returns:
            False for ``''``. True for every other name, as in OpenRAVE; an unknown name is logged as an error, and the
            earlier viewers stay.

        Example:
            >>> env.SetViewer("qtcoin")
            True
            >>> viewer = env.GetViewer()
            >>> viewer.SetBkgndColor([0.8, 0.85, 0.9])
        """
        from ravemj.gui.viewers import VIEWERS  # noqa: PLC0415 - slow to import

        if viewername:
            self._check_alive()
        if viewername in {"", *VIEWERS}:
            self._close_viewers()
        if viewername:
            self.open_viewer(viewername, showviewer)
        return bool(viewername)

    def open_viewer(self, name: str, show: bool) -> "Viewer | None":
        """Attach an additional viewer and return it; None for an unknown name."""
        from ravemj.gui.viewers import open_viewer  # noqa: PLC0415 - slow to import

        self._check_alive()
        viewer = open_viewer(self._simulation, self._renderer, name, show)
        if viewer is not None:
            self._attach(viewer)
            viewer.announce()
        return viewer

    def serve_viewer(
        self, host: str = "127.0.0.1", port: int = 0, token: str | None = None, embed: str | Iterable[str] = ()
    ) -> "WebViewer":
        """Attach a viewer for browsers, as ``SetViewer('web')`` does, at a given port.

        Args:
            host: The network interface to listen at, a name or an address. The default admits browsers of this machine
                only. Others admit other machines: whoever knows the address of the page can see and move everything,
                and the connection is not encrypted.
            port: The number of the port; 0 for any free port.
            token: The secret in the address, 8 to 64 letters, digits, ``-`` and ``_``; by default a new one. With a
                fixed port and a fixed token, an open page finds the viewer again after a restart.
            embed: Origins, such as ``https://lab.example``, whose pages may show the page in a frame, besides those of
                this machine and of VS Code. The variable ``RAVEMJ_EMBED`` adds further ones.

        Returns:
            The viewer; ``url`` is the address of its page.

        Raises:
            RenderingError: the port is not available. Earlier viewers stay.
            ArgumentError: the token has a wrong length, or other characters; or ``embed`` is not an origin.

        Example:
            >>> print(env.serve_viewer(port=8080).url)
        """
        from ravemj.gui.viewers.web import WebViewer  # noqa: PLC0415 - websockets is slow to import
        from ravemj.gui.viewers.web.embedding import checked_origins  # noqa: PLC0415

        self._check_alive()
        origins, number = checked_origins(embed), checked_integer(port, "serve_viewer: port")
        viewer = WebViewer(self._simulation, self._renderer, "web", host, number, token=token)
        viewer.server.allow_embedding(origins)
        self._close_viewers()
        self._attach(viewer)
        return viewer

    def _attach(self, viewer: "Viewer") -> None:
        viewer.environment = weakref.ref(self._environment)
        self._viewers.append(viewer)

    def _close_viewers(self) -> None:
        if self._viewers:
            self._simulation.drawings.clear()
        while self._viewers:
            self._viewers.pop().close()

    def SetDefaultViewer(self, showviewer: bool = True) -> bool:
        """Attach the viewer that the variable ``OPENRAVE_DEFAULT_VIEWER`` names, else a window or a page.

        Args:
            showviewer: False never opens a window.

        Returns:
            What ``SetViewer`` returns.
        """
        return self.SetViewer(os.environ.get("OPENRAVE_DEFAULT_VIEWER") or "qtcoin", showviewer)

    def GetViewer(self, name: str | None = None) -> "Viewer | None":
        """Return a viewer, or None.

        Args:
            name: The name given to ``SetViewer`` or ``RaveCreateViewer``; by default the first viewer is returned.

        Example:
            >>> viewer = env.GetViewer()
            >>> if viewer is not None:
            ...     viewer.SetBkgndColor([0.8, 0.85, 0.9])
        """
        return next((viewer for viewer in self._viewers if not name or name == viewer.GetXMLId()), None)

    def render(
        self,
        width: int = 640,
        height: int = 480,
        *,
        camera: ArrayLike | None = None,
        background: ArrayLike | None = None,
        shadows: bool | None = None,
        floor: str = "auto",
        lights: Literal["studio", "model", "both"] = "both",
    ) -> Frame:
        """Draw a picture, with or without a display.

        Args:
            width: The width of the picture [pixels].
            height: The height of the picture [pixels].
            camera: ``T_world_camera``, 4x4, z forward and y down. The default is the viewer's camera, else the file's,
                else a view of the whole scene.
            background: Red, green, blue from 0 to 1. The default is the viewer's, else the file's, else a gradient.
            shadows: Whether lights cast shadows; None: only if OpenGL draws the picture.
            floor: ``on`` draws a floor with a grid below the bodies, ``off`` none; ``auto`` draws one
                if neither script nor file sets a background.
            lights: ``studio``, ``model`` (the model's own lights) or ``both``.

        Returns:
            The picture, shape (height, width, 3), uint8, top row first.

        Raises:
            ArgumentError: the camera is not a rigid transform, the background is not a colour, or the floor or the
                lights are none of these.
            RenderingError: no renderer works on this machine; ``ravemj doctor`` says why.

        Example:
            >>> import imageio.v3
            >>> imageio.v3.imwrite("pendulum.png", env.render(640, 480))
        """
        self._check_alive()
        form = Format(width, height, shadows=shadows is not False)
        view = self.default_camera(form.aspect) if camera is None else Camera.from_matrix(camera)
        return self._renderer.render(view, self.look(background, LookChoices(shadows, floor, lights)), form)

    def look(self, background: ArrayLike | None = None, choices: LookChoices = AS_USUAL) -> Look:
        """Return background, floor and lights of pictures; the default background is the viewer's, else the file's.

        Raises:
            ArgumentError: the background is not a colour.
        """
        return choices.look(self.own_background if background is None else checked_colour(background))

    @property
    def own_background(self) -> tuple[float, float, float] | None:
        """Background set by the viewer or the file; None if neither sets one."""
        return self._simulation.view.background if self._viewer is None else self._viewer.own_background

    def animation(  # noqa: PLR0913 - keyword arguments
        self,
        motion: "MotionLike | None" = None,
        *,
        robot: "KinBody | None" = None,
        fps: float = 30.0,
        camera: ArrayLike | None = None,
        background: ArrayLike | None = None,
        shadows: bool | None = None,
        floor: str = "auto",
        lights: Literal["studio", "model", "both"] = "both",
        notes: Sequence[str] = (),
    ) -> "Animation":
        """Return an HTML page that plays a motion and can be turned and zoomed without a server.

        Notebooks show the page. It draws with WebGL, in the browser. Drawings of scripts are part of it, and do not
        move.

        Args:
            motion: In any form that ``record`` accepts: a ``Motion``, a trajectory, rows of time and joint values, or
                the path of a file. Joints stop at their limits, with a warning. Afterwards the robot is at the end of
                the motion. Without a motion, the page shows the scene as it is, with a slider for each joint.
            robot: The body that moves; by default the first robot with joints, or the one whose joints a table names.
                Without a motion, the body that has sliders; by default all bodies with joints.
            fps: Poses stored for each second. The page interpolates between them at the rate of the screen.
            camera: The first ``T_world_camera``, 4x4, z forward and y down. The default is the viewer's, else the
                file's, else a view of the whole motion.
            background: Red, green, blue from 0 to 1. The default is the viewer's, else the file's, else a gradient.
            shadows: Whether lights cast shadows; None: if the browser has time for them.
            floor: ``on`` draws a floor with a grid below the bodies, ``off`` none; ``auto`` draws one
                if neither script nor file sets a background.
            lights: ``studio``, ``model`` (the model's own lights) or ``both``.
            notes: Lines of text in a corner of the page.

        Returns:
            The page: ``save("swing.html")`` writes it, ``html`` is its text.

        Raises:
            ArgumentError: an argument is wrong, or there is no robot to move.

        Example:
            >>> swing = ravemj.Motion.line([0, 0], [3.14, 0], duration=1.0)
            >>> env.animation(swing).save("swing.html")
        """
        from ravemj.rave.recording import animate  # noqa: PLC0415 - few scripts want it

        self._check_alive()
        choices = LookChoices(shadows, floor, lights)
        return animate(self._environment, motion, robot, fps, camera, background, choices, notes=notes)

    def save_html(  # noqa: PLR0913 - keyword arguments
        self,
        path: AnyPath,
        motion: "MotionLike | None" = None,
        *,
        robot: "KinBody | None" = None,
        fps: float = 30.0,
        camera: ArrayLike | None = None,
        background: ArrayLike | None = None,
        shadows: bool | None = None,
        floor: str = "auto",
        lights: Literal["studio", "model", "both"] = "both",
        notes: Sequence[str] = (),
    ) -> "Path":
        """Write a motion, or the scene as it is, as one HTML file that needs neither a server nor a network.

        Args:
            path: The file.
            motion: See ``animation`` for this and the other arguments.
            robot: The body that moves.
            fps: Poses stored for each second.
            camera: The first ``T_world_camera``.
            background: Red, green, blue from 0 to 1.
            shadows: Whether lights cast shadows.
            floor: ``auto``, ``on`` or ``off``.
            lights: ``studio``, ``model`` or ``both``.
            notes: Lines of text in a corner of the page.

        Returns:
            The path.

        Raises:
            ArgumentError: an argument is wrong.
            OutputError: the file cannot be written; no partial file is left behind.
        """
        check_file(path)
        page = self.animation(
            motion,
            robot=robot,
            fps=fps,
            camera=camera,
            background=background,
            shadows=shadows,
            floor=floor,
            lights=lights,
            notes=notes,
        )
        return page.save(path)

    def default_camera(self, aspect: float = 4 / 3) -> Camera:
        """Return the default camera for pictures with the aspect ratio ``aspect``, width to height.

        It is the viewer's, else the file's, else one that shows the whole scene.
        """
        return self._renderer.camera_for_stills(aspect) if self._viewer is None else self._viewer.camera

    @property
    def background(self) -> tuple[float, float, float]:
        """The default background of pictures: the viewer's, else the file's, else white."""
        return self.own_background or WHITE

    @property
    def renderer(self) -> SimulationRenderer:
        """Renderer of the environment."""
        return self._renderer

    def _repr_png_(self) -> bytes:
        from ravemj.graphics.video import picture_bytes  # noqa: PLC0415 - only notebooks want it

        return picture_bytes(self.render(480, 360))

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

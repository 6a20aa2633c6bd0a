"""Viewers of an environment, and pictures."""

import os
import weakref
from collections.abc import Iterable
from typing import TYPE_CHECKING, cast

from numpy.typing import ArrayLike

from ravemj.core.output import AnyPath, check_file
from ravemj.graphics.rendering import Camera
from ravemj.graphics.rendering.checks import checked_colour
from ravemj.graphics.rendering.style import AS_USUAL, LightNames, Look, LookChoices
from ravemj.graphics.simulation_renderer import Format, Frame, SimulationRenderer
from ravemj.model.look import WHITE
from ravemj.rave.env.base import EnvironmentPart

if TYPE_CHECKING:
    from pathlib import Path

    from ravemj.graphics.webgl.animation import Animation
    from ravemj.gui.viewers import Viewer
    from ravemj.gui.viewers.web import WebViewer
    from ravemj.rave.environment import Environment
    from ravemj.rave.kinbody import KinBody
    from ravemj.trajectories.motion_arguments import MotionLike


class Viewing(EnvironmentPart):
    """The viewers of an environment, and pictures, which need no viewer."""

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
        origins = checked_origins(embed)
        viewer = WebViewer(self._simulation, self._renderer, "web", host, port, token=token)
        viewer.server.let_embed(origins)
        self._close_viewers()
        self._attach(viewer)
        return viewer

    def _attach(self, viewer: "Viewer") -> None:
        viewer.environment = weakref.ref(self)
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
        lights: LightNames = "both",
    ) -> Frame:
        """Draw a picture, with or without a display.

        Args:
            width: The width of the picture [pixels].
            height: The height of the picture [pixels].
            camera: ``T_world_camera``, 4x4, z forward and y down. The default is the viewer's camera, else the file's,
                else a view of the whole scene.
            background: Red, green, blue from 0 to 1. The default is the viewer's, else the file's, else a gradient.
            shadows: Whether lights cast shadows; None: if OpenGL draws.
            floor: ``on`` draws a floor with a grid below the bodies, ``off`` none; ``auto``: one where neither script
                nor file sets a background.
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
        """Return background, floor and lights of pictures; without a background, the viewer's, else the file's.

        Raises:
            ArgumentError: the background is not a colour.
        """
        return choices.look(self.own_background if background is None else checked_colour(background))

    @property
    def own_background(self) -> tuple[float, float, float] | None:
        """The background that the viewer or the file has; None where neither sets one."""
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
        lights: LightNames = "both",
    ) -> "Animation":
        """Return an HTML page that plays a motion and can be turned and zoomed without a server.

        Notebooks show the page. It draws with WebGL, in the browser. Drawings of scripts are part of it, and do not
        move.

        Args:
            motion: In any form that ``record`` accepts: a ``Motion``, a trajectory, rows of time and joint values, or
                the path of a file. Joints stop at their limits, with a warning. Afterwards the robot is at the end of
                the motion. Without a motion, the page shows the scene as it is.
            robot: The body that moves; by default the first robot with joints, or the one whose joints a table names.
            fps: Poses stored for each second. The page interpolates between them at the rate of the screen.
            camera: The first ``T_world_camera``, 4x4, z forward and y down. The default is the viewer's, else the
                file's, else a view of the whole motion.
            background: Red, green, blue from 0 to 1. The default is the viewer's, else the file's, else a gradient.
            shadows: Whether lights cast shadows; None: if the browser has time for them.
            floor: ``on`` draws a floor with a grid below the bodies, ``off`` none; ``auto``: one where neither script
                nor file sets a background.
            lights: ``studio``, ``model`` (the model's own lights) or ``both``.

        Returns:
            The page: ``save("swing.html")`` writes it, ``html`` is its text.

        Raises:
            ArgumentError: an argument is wrong, or there is no robot to move.

        Example:
            >>> swing = ravemj.Motion.line([0, 0], [3.14, 0], duration=1.0)
            >>> env.animation(swing).save("swing.html")
        """
        from ravemj.rave.animations import animate  # noqa: PLC0415 - few scripts want it

        self._check_alive()
        choices = LookChoices(shadows, floor, lights)
        return animate(cast("Environment", self), motion, robot, fps, camera, background, choices)

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
        lights: LightNames = "both",
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
        )
        return page.save(path)

    def default_camera(self, aspect: float = 4 / 3) -> Camera:
        """Return the default camera for pictures of an ``aspect`` of width to height.

        It is the viewer's, else the file's, else one that shows the whole scene.
        """
        return self._renderer.camera_for_stills(aspect) if self._viewer is None else self._viewer.camera

    @property
    def background(self) -> tuple[float, float, float]:
        """The default background of pictures: the viewer's, else the file's, else white."""
        return self.own_background or WHITE

    @property
    def renderer(self) -> SimulationRenderer:
        """The renderer of the environment."""
        return self._renderer

    def _repr_png_(self) -> bytes:
        """Return the picture that notebooks show for an environment."""
        from ravemj.graphics.video import picture_bytes  # noqa: PLC0415 - only notebooks want it

        return picture_bytes(self.render(480, 360))

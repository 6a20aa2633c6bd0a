"""Viewers and pictures."""

import os
import weakref
from typing import TYPE_CHECKING, cast

from numpy.typing import ArrayLike

from ravemj.core.output import AnyPath, check_file
from ravemj.graphics.rendering import Camera
from ravemj.graphics.simulation_renderer import Format, Frame, SimulationRenderer, checked_colour
from ravemj.rave.env.base import EnvironmentPart

if TYPE_CHECKING:
    from pathlib import Path

    from ravemj.graphics.webgl.animation import Animation
    from ravemj.gui.viewers import Viewer
    from ravemj.gui.viewers.web import WebViewer
    from ravemj.rave.environment import Environment
    from ravemj.rave.kinbody import KinBody
    from ravemj.trajectories.motion import Motion


class Viewing(EnvironmentPart):
    """Viewers of the environment, and pictures without one."""

    _internal = ("open_viewer", "renderer")

    def SetViewer(self, viewername: str, showviewer: bool = True) -> bool:
        """Attach a viewer, in place of those before; ``RaveCreateViewer`` attaches further ones.

        With a display a window opens and shows every change from then on, while the script goes on; in a notebook, a
        page in the cell does. Without either, as on a server, the viewer draws when it is asked for pictures, so that
        scripts run there just the same.

        The camera starts with the view that the loaded file asks for, else from above; ``GetViewer().SetCamera``
        moves it.

        Args:
            viewername: ``'window'``: a window; a warning says so where there is no display for it. ``'web'``: a page
                for a browser on this machine, at ``GetViewer().url``. ``'offscreen'``: neither. One of OpenRAVE's
                names, such as ``'qtcoin'``: a window if there is a display, else a page in a notebook, else neither;
                the log says which. On macOS the page stands for windows. ``''`` removes the viewer.
            showviewer: False: never a window.

        Returns:
            False for ``''``. True for every other name, as in OpenRAVE; a name that nobody knows is logged as an error,
            and the viewers before stay.

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
        """Attach a further viewer and return it; None for a name that is no viewer's."""
        from ravemj.gui.viewers import open_viewer  # noqa: PLC0415 - slow to import

        self._check_alive()
        viewer = open_viewer(self._simulation, self._renderer, name, show)
        if viewer is not None:
            self._attach(viewer)
        return viewer

    def serve_viewer(self, host: str = "127.0.0.1", port: int = 0, token: str | None = None) -> "WebViewer":
        """Attach a viewer for browsers, as ``SetViewer('web')`` does, at a port of your choice.

        Args:
            host: Name or address of the interface that browsers come to. Others than the default let those of other
                machines in: whoever knows the address of the page sees and moves everything, and nothing is encrypted.
            port: Number of the port; 0: any that is free.
            token: The secret in the address, so that a page finds a viewer again that was ended and started anew at
                the same port: 8 to 64 letters, digits, ``-`` and ``_``. None: a new one.

        Returns:
            The viewer; ``url`` is the address of its page.

        Raises:
            RenderingError: this port cannot be had; the viewers before stay.
            ArgumentError: the token is too short, or has other letters.

        Example:
            >>> print(env.serve_viewer(port=8080).url)
        """
        from ravemj.gui.viewers.web import WebViewer  # noqa: PLC0415 - websockets is slow to import

        self._check_alive()
        viewer = WebViewer(self._simulation, self._renderer, "web", host, port, token=token)
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
        """Attach the viewer that the variable ``OPENRAVE_DEFAULT_VIEWER`` names, else the best that works here.

        Args:
            showviewer: False: never a window.

        Returns:
            What ``SetViewer`` returns.
        """
        return self.SetViewer(os.environ.get("OPENRAVE_DEFAULT_VIEWER") or "qtcoin", showviewer)

    def GetViewer(self, name: str | None = None) -> "Viewer | None":
        """Return a viewer, or None where there is none.

        Args:
            name: None or empty: the first one. Else the first one that ``SetViewer`` or ``RaveCreateViewer`` made by
                this name.

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
    ) -> Frame:
        """Draw a picture, with or without a display.

        Args:
            width: Columns [pixels].
            height: Rows [pixels].
            camera: ``T_world_camera``, 4x4, z forward and y down; None: the viewer's camera if there is a viewer, else
                the file's, else a view of the whole scene.
            background: Red, green, blue from 0 to 1; None: the viewer's, else the file's, else white.

        Returns:
            The picture, shape (height, width, 3), uint8, top row first.

        Raises:
            ArgumentError: the camera is no rigid transform, or the background no colour.
            RenderingError: nothing can draw here; ``ravemj doctor`` says why.

        Example:
            >>> import imageio.v3
            >>> imageio.v3.imwrite("pendulum.png", env.render(640, 480))
        """
        self._check_alive()
        view = self.default_camera(width / height) if camera is None else Camera.from_matrix(camera)
        colour = self.background if background is None else checked_colour(background)
        return self._renderer.render(view, colour, Format(width, height, shadows=True))

    def animation(
        self,
        motion: "Motion | None" = None,
        *,
        robot: "KinBody | None" = None,
        fps: float = 30.0,
        camera: ArrayLike | None = None,
        background: ArrayLike | None = None,
    ) -> "Animation":
        """Return a page that plays a motion, and turns and zooms without a server; notebooks show it.

        The page draws with WebGL, in the browser. Drawings of scripts are in it and stand still.

        Args:
            motion: Joint values over time; values outside the limits are moved to them, with a warning. The robot
                stays at the motion's end. None: a still scene.
            robot: Which body moves; None: the first robot with joints.
            fps: Poses in a second; the page draws as many pictures as the screen shows, and mixes the poses.
            camera: ``T_world_camera`` at first, 4x4, z forward and y down; None: the viewer's, else the file's, else a
                view of the whole motion.
            background: Red, green, blue from 0 to 1; None: the viewer's, else the file's, else white.

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
        return animate(cast("Environment", self), motion, robot, fps, camera, background)

    def save_html(
        self,
        path: AnyPath,
        motion: "Motion | None" = None,
        *,
        robot: "KinBody | None" = None,
        fps: float = 30.0,
        camera: ArrayLike | None = None,
        background: ArrayLike | None = None,
    ) -> "Path":
        """Write a motion, or the scene as it is, as one HTML file that needs neither a server nor a network.

        Args:
            path: The file.
            motion: See ``animation``, as for the other arguments.
            robot: Which body moves.
            fps: Poses in a second.
            camera: ``T_world_camera`` at first.
            background: Red, green, blue from 0 to 1.

        Returns:
            The path.

        Raises:
            ArgumentError: an argument is wrong.
            OutputError: the file cannot be written; nothing is left behind then.
        """
        check_file(path)
        page = self.animation(motion, robot=robot, fps=fps, camera=camera, background=background)
        return page.save(path)

    def default_camera(self, aspect: float = 4 / 3) -> Camera:
        """Return the camera of pictures that name none: the viewer's, else the file's, else one that shows all.

        Args:
            aspect: Width of the picture divided by its height.
        """
        return self._renderer.camera_for_stills(aspect) if self._viewer is None else self._viewer.camera

    @property
    def background(self) -> tuple[float, float, float]:
        """The background of pictures that name none: the viewer's, else the file's, else white."""
        return self._simulation.view.background if self._viewer is None else self._viewer.background

    @property
    def renderer(self) -> SimulationRenderer:
        """The renderer of the environment."""
        return self._renderer

    def _repr_png_(self) -> bytes:
        """Return the picture that notebooks show for an environment."""
        from ravemj.graphics.video import png_bytes  # noqa: PLC0415 - only notebooks want it

        return png_bytes(self.render(480, 360))

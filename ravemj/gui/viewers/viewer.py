"""Base class of viewers, which is also the offscreen viewer."""

import contextlib
import math
import weakref
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import also_named
from ravemj.core.arrays import checked_vector
from ravemj.core.flags import Flag
from ravemj.core.handles import Handle
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import Simulation
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.graphics.rendering import Camera, CameraIntrinsics, Pinhole
from ravemj.graphics.rendering.checks import checked_colour
from ravemj.graphics.rendering.style import Look, LookChoices
from ravemj.graphics.simulation_renderer import Format, Frame, SimulationRenderer
from ravemj.gui.interaction import Resize
from ravemj.gui.viewers.interactive import Callback, Callbacks, Interactive
from ravemj.gui.viewers.recorder import Recorder
from ravemj.model.look import WHITE
from ravemj.model.scene import View

_SIZE = 640, 480
_LARGEST = 16384  # pixels along a side; a limit of graphics cards
_FIGURES = "SetFiguresInCamera"

_LARGEST_TEXT = 200  # points that letters are high; larger ones would fill the window

LOCKED, PATIENCE = "Locked by the script", 1.0
"""Message shown while a script holds the environment's lock, and the time until it appears [s]."""


class Viewer(Interactive):
    """A viewer of an environment, created by ``env.SetViewer`` and returned by ``env.GetViewer()``.

    This base class has no window: it renders on request. The camera follows OpenRAVE's convention: a 4x4 matrix
    ``T_world_camera`` whose columns are image right, image down, the viewing direction, and the position of the eye.

    Example:
        >>> viewer = env.GetViewer()
        >>> viewer.SetBkgndColor([0.8, 0.85, 0.9])
        >>> viewer.SetCamera([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
        >>> frame = viewer.render(640, 480)

    Attributes:
        environment: Weak reference to the environment; OpenRAVE's scripts call ``GetEnv``.
        interaction: Handles pointer and keyboard events of the window.
    """

    _internal = ("apply_loaded", "choose_look", "environment", "look", "own_background")

    def __init__(self, simulation: Simulation, renderer: SimulationRenderer, name: str) -> None:
        self._renderer = renderer
        self._name = name
        super().__init__(simulation, renderer.file_camera() or renderer.camera_from_above(), _SIZE)
        self._background = simulation.view.background  # None: nobody has set one
        self._choices = LookChoices()
        self._recorder = Recorder(self.interaction.controls.notices)
        self._user_lines: list[str] = []
        weakref.finalize(self, self._recorder.end)
        self._title = name
        self._size = _SIZE
        self._figures_in_camera = False
        self._thread_callbacks = Callbacks()
        self._image_callbacks = Callbacks()
        self._camera_of_nothing = None if simulation.bodies else self.camera
        self._ended = Flag()  # set when the window or the page is closed; offscreen, from the start
        self._ended.set()

    def GetXMLId(self) -> str:
        """Return the name passed to ``SetViewer``."""
        return self._name

    def GetName(self) -> str:
        """Return the viewer's title, by default the name passed to ``SetViewer``."""
        return self._title

    def SetName(self, title: str) -> None:
        """Set the title; a window shows it.

        Args:
            title: The title.
        """
        self._title = title = str(title)
        self._ask_window("set_window_title", title)

    def SetTitle(self, title: str) -> None:
        """Set the title, like ``SetName``.

        Args:
            title: The title.
        """
        self.SetName(title)

    @also_named(w="width", h="height")
    def SetSize(self, width: int, height: int) -> None:
        """Set the size of the window, and the default size of pictures.

        Args:
            width: Columns [pixels].
            height: Rows [pixels].

        Raises:
            ArgumentError: a size is not a number from 1 to 16384.
        """
        self._size = size = _checked_size(width, height, "SetSize")
        self.interaction.handle(Resize(*size))
        self._ask_window("set_window_size", *size)

    def Move(self, x: int, y: int) -> None:
        """Move the window; no effect without one.

        Args:
            x: New column of its left edge on the screen [pixels].
            y: New row of its upper edge on the screen [pixels].
        """

    def Show(self, showtype: int) -> None:
        """Hide or show the window; no effect without one.

        Args:
            showtype: 0 hides it, other values show it.
        """
        self._ask_window("show_window" if showtype else "hide_window")

    def _ask_window(self, function: str, *arguments: object) -> None:
        """Call a GLFW function in the window's thread; viewers without a window ignore it."""

    def SetTextSize(self, size: float) -> None:
        """Set the size of the text in the corner.

        Args:
            size: Height of the letters [points].

        Raises:
            ArgumentError: ``size`` is not a number from 1 to 200.
        """
        (height,) = checked_vector([size], 1, "SetTextSize").tolist()
        if not 1 <= height <= _LARGEST_TEXT:
            raise ArgumentError(f"SetTextSize: is {size}, and should be from 1 to {_LARGEST_TEXT} points")
        self.interaction.controls.notices.text_size = height

    def SetUserText(self, userText: str) -> None:
        """Show a text in the corner, in place of the previous one.

        Args:
            userText: The text; an empty one removes it.
        """
        notices = self.interaction.controls.notices
        for line in self._user_lines:
            notices.withdraw(line)
        self._user_lines = userText.splitlines()
        for line in self._user_lines:
            notices.say(line, math.inf)

    def RegisterCallback(self, properties: object, callback: Callback) -> Handle:
        """Register a callback for selections; deprecated form of ``RegisterItemSelectionCallback``.

        Args:
            properties: Not used.
            callback: A function of the link, the clicked point and the direction from the eye to it.

        Returns:
            A handle; closing or dropping it unregisters the function.
        """
        del properties
        return self.RegisterItemSelectionCallback(callback)

    @also_named(bShow="show")
    def main(self, show: bool = True, sig_thread_id: int = 0) -> int:
        """Block until the viewer is closed or ``quitmainloop`` is called; offscreen viewers return immediately.

        Args:
            show: False hides the window.
            sig_thread_id: Not used.

        Returns:
            0.
        """
        del sig_thread_id
        self.Show(int(show))
        self.wait()
        return 0

    def wait(self) -> None:
        """Block until the viewer is closed, by the user or by a script; offscreen viewers return immediately."""
        while not self._ended.wait(0.1):  # with a timeout, so that Ctrl-C is handled
            pass

    @property
    def is_open(self) -> bool:
        """Whether its window or page server is open."""
        return not self._ended.is_set()

    def quitmainloop(self) -> None:
        """End ``main``; a window closes."""

    def EnvironmentSync(self) -> None:
        """Block until the window shows the present state of the environment; nothing to do without a window."""

    def RegisterViewerThreadCallback(self, callback: Callback) -> Handle:
        """Register a callback in the thread of the window, for each iteration of its event loop.

        Args:
            callback: The function, without arguments.

        Returns:
            A handle; closing or dropping it unregisters the function.

        Raises:
            ArgumentError: ``callback`` is not callable.
        """
        return self._thread_callbacks.add(callback)

    def RegisterViewerImageCallback(self, callback: Callback) -> Handle:
        """Register a callback for each frame of the window, in its thread, and for each picture of ``render``.

        Args:
            callback: The function; its argument is the picture, (height, width, 3), uint8.

        Returns:
            A handle; closing or dropping it unregisters the function.

        Raises:
            ArgumentError: ``callback`` is not callable.
        """
        return self._image_callbacks.add(callback)

    def SupportsCommand(self, cmd: str) -> bool:
        """Return whether ``SendCommand`` supports a command.

        Args:
            cmd: Its name.
        """
        return cmd == _FIGURES

    def SendCommand(self, cmd: str, releasegil: bool = False, lockenv: bool = False) -> str:
        """Run a command of OpenRAVE's viewers; the only one is ``SetFiguresInCamera`` with 1 or 0.

        Args:
            cmd: Name and arguments. ``SetFiguresInCamera 1`` includes drawings in pictures of ``GetCameraImage``.
            releasegil: Not used.
            lockenv: Not used.

        Returns:
            An empty text.

        Raises:
            openrave_exception: the command is not supported (``CommandNotSupported``).
        """
        del releasegil, lockenv
        name, *arguments = cmd.split() or [""]
        if name != _FIGURES:
            raise RavemjError(f"the viewer knows no command '{name}', only {_FIGURES}", ErrorCode.CommandNotSupported)
        if arguments not in (["0"], ["1"]):
            raise ArgumentError(f"{_FIGURES}: is followed by '{' '.join(arguments)}', and should be by 0 or 1")
        self._figures_in_camera = arguments == ["1"]
        return ""

    def SetCamera(self, transform: ArrayLike, focalDistance: float = 0.0) -> None:
        """Set the camera.

        Args:
            transform: ``T_world_camera``, 4x4 or 3x4, or a pose [w, x, y, z, tx, ty, tz]. z looks forward, x is image
                right, y is image down. ``GetCameraTransform`` returns the same numbers.
            focalDistance: Distance [m] of the focus, about which the mouse orbits; no effect on pictures. 0 keeps the
                previous one.

        Raises:
            ArgumentError: ``transform`` is not rigid, or the distance is not finite.

        Example:
            >>> viewer.SetCamera(saved)  # what viewer.GetCameraTransform() printed
        """
        (distance,) = checked_vector([focalDistance], 1, "focalDistance").tolist()
        self.interaction.look_from(Camera.from_matrix(transform), max(distance, 0.0))

    def GetCameraTransform(self) -> Floats:
        """Return the camera's pose.

        Returns:
            ``T_world_camera``, shape (4, 4): columns image right, image down, viewing direction, eye; a copy.
        """
        return self.camera.T_world_camera.copy()

    def GetCameraDistanceToFocus(self) -> float:
        """Return the distance of the focus, about which the mouse orbits [m]; 0 if it is not set."""
        return self.interaction.view.distance

    def GetCameraIntrinsics(self) -> CameraIntrinsics:
        """Return the camera matrix for the viewer's size: ``GetCameraIntrinsics().K``, (3, 3) [pixels]."""
        fx, fy, cx, cy = self.camera.pinhole(*self._size)
        return CameraIntrinsics(np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]))

    def GetCameraImage(self, width: int, height: int, transform: ArrayLike, K: ArrayLike) -> Frame:
        """Render a picture from a given camera; the viewer's own camera does not change.

        Drawings are omitted, as in OpenRAVE, unless ``SendCommand('SetFiguresInCamera 1')`` was called.

        Args:
            width: Columns [pixels]; 0: the viewer's.
            height: Rows [pixels]; 0: the viewer's.
            transform: ``T_world_camera``, 4x4 or 3x4, or a pose; z forward, x image right, y image down.
            K: Focal lengths and principal point, [fx, fy, cx, cy] [pixels].

        Returns:
            The picture, shape (height, width, 3), uint8, top row first.

        Raises:
            ArgumentError: the transform is not rigid, K is not four numbers with positive focal lengths, or the size
                is out of range.
            RenderingError: no renderer works on this machine.

        Example:
            >>> T = viewer.GetCameraTransform()
            >>> picture = viewer.GetCameraImage(640, 480, T, [640, 640, 320, 240])
        """
        fx, fy, cx, cy = checked_vector(K, 4, "K").tolist()
        if fx <= 0 or fy <= 0:
            raise ArgumentError(f"K: the focal lengths are {fx:g} and {fy:g}, and should be positive")
        camera = Camera(Camera.from_matrix(transform).T_world_camera, calibration=Pinhole(fx, fy, cx, cy))
        form = self._format(width, height, "GetCameraImage")
        return self._renderer.render(
            camera, Look.of_sensor(self._background), form._replace(shadows=False), self._figures_in_camera
        )

    def SetBkgndColor(self, color: ArrayLike) -> None:
        """Set a uniform background colour; it replaces the default gradient and floor.

        Args:
            color: Red, green, blue from 0 to 1.

        Raises:
            ArgumentError: ``color`` is not three numbers from 0 to 1.
        """
        self._background = checked_colour(color)

    def apply_loaded(self, view: View | None = None) -> None:
        """Update camera and background after bodies were loaded.

        Args:
            view: Background and camera of the file. If it has no camera, the first bodies of an empty environment
                are shown from above, unless a camera was set before.
        """
        if view is not None:
            self._background = view.background
        if view is not None and view.T_world_camera is not None:
            self.SetCamera(view.T_world_camera.matrix())
        elif self.camera is self._camera_of_nothing and self._simulation.bodies:
            with contextlib.suppress(RavemjError):  # the next call that needs the bodies raises it
                self.SetCamera(self._renderer.camera_from_above().T_world_camera)

    @property
    def camera(self) -> Camera:
        """The camera: pose and vertical field of view."""
        return self.interaction.view.camera

    @property
    def background(self) -> tuple[float, float, float]:
        """The background colour: red, green, blue from 0 to 1; white if none was set."""
        return self._background or WHITE

    @property
    def own_background(self) -> tuple[float, float, float] | None:
        """The background colour that a script or a file has set, or None."""
        return self._background

    @property
    def look(self) -> Look:
        """Background, floor and lights of the view."""
        return self._choices.look(self._background)

    def choose_look(self, choices: LookChoices) -> None:
        """Set floor, lights and shadows of the view; call it before a window draws."""
        self._choices = choices

    def render(
        self,
        width: int | None = None,
        height: int | None = None,
        *,
        shadows: bool | None = None,
        floor: str = "auto",
        lights: Literal["studio", "model", "both"] = "both",
    ) -> Frame:
        """Render the view, including the handle of the selection.

        Args:
            width: Columns [pixels]; None: the size of ``SetSize``, by default 640.
            height: Rows [pixels]; None: the size of ``SetSize``, by default 480.
            shadows: Whether lights cast shadows; None: only with OpenGL.
            floor: ``on`` draws a floor with a grid, ``off`` none, ``auto`` a floor unless a background was set.
            lights: ``studio``, ``model`` (the model's own lights) or ``both``.

        Returns:
            The picture, shape (height, width, 3), uint8, top row first.

        Raises:
            ArgumentError: the size is out of range, or ``floor`` or ``lights`` has another value.
            RenderingError: no renderer works on this machine.
        """
        form = self._format(width, height, "render")._replace(shadows=shadows is not False)
        look = LookChoices(shadows, floor, lights).look(self._background)
        over = self.interaction.overlay()
        picture = self._renderer.render(self.camera, look, form, gizmos=over.primitives, style=over.style)
        self._image_callbacks.call(picture)
        return picture

    def _format(self, width: int | None, height: int | None, caller: str) -> Format:
        """Return the format of a picture; None or 0 selects the viewer's own width or height."""
        return Format(*_checked_size(width or self._size[0], height or self._size[1], caller))

    def close(self) -> None:
        """Close the viewer."""
        self._recorder.end()
        self._renderer.close()

    def __repr__(self) -> str:
        return f"<viewer:{self._name}>"


def _checked_size(width: float, height: float, caller: str) -> tuple[int, int]:
    """Return an image size in whole pixels; raise an ArgumentError if it is out of range."""
    size = checked_vector([width, height], 2, f"{caller}: size")
    if size.min() < 1 or size.max() > _LARGEST:
        limits = f"1 x 1 to {_LARGEST} x {_LARGEST}"
        raise ArgumentError(f"{caller}: is {width} x {height}, and should be from {limits} pixels")
    return int(size[0]), int(size[1])

"""What every viewer can do, and the viewer without a window."""

from numpy.typing import ArrayLike

from ravemj.rendering import Camera
from ravemj.simulation import Simulation
from ravemj.studio import Format, Frame, Studio, checked_colour
from ravemj.transforms import Floats


class Viewer:
    """A point of view on an environment; ``env.SetViewer`` makes it and ``env.GetViewer()`` returns it.

    This one has no window: it draws when it is asked for a picture. The camera is OpenRAVE's: a 4x4 matrix
    ``T_world_camera`` whose columns are image right, image down, the viewing direction, and the position of the eye.

    Example:
        >>> viewer = env.GetViewer()
        >>> viewer.SetBkgndColor([0.8, 0.85, 0.9])
        >>> viewer.SetCamera([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
        >>> frame = viewer.render(640, 480)
    """

    def __init__(self, simulation: Simulation, studio: Studio, name: str) -> None:
        self._simulation = simulation
        self._studio = studio
        self._name = name
        self._camera = studio.file_camera() or studio.camera_from_above()
        self._background = simulation.view.background

    def GetName(self) -> str:
        """Return the name that the viewer was asked for by."""
        return self._name

    def SetCamera(self, transform: ArrayLike, focalDistance: float = 0.0) -> None:
        """Set the camera.

        Args:
            transform: ``T_world_camera``, 4x4 or 3x4, or a pose [w, x, y, z, tx, ty, tz]. z looks forward, x is image
                right, y is image down. ``GetCameraTransform`` returns the same numbers.
            focalDistance: Distance [m] to the point that the mouse turns the camera about; it changes no picture.

        Raises:
            ArgumentError: this is no rigid transform.

        Example:
            >>> viewer.SetCamera(saved)  # what viewer.GetCameraTransform() printed
        """
        del focalDistance
        self._camera = Camera.from_matrix(transform)

    def GetCameraTransform(self) -> Floats:
        """Return the camera's pose.

        Returns:
            ``T_world_camera``, shape (4, 4): columns image right, image down, viewing direction, eye; a copy.
        """
        return self._camera.T_world_camera.copy()

    def SetBkgndColor(self, color: ArrayLike) -> None:
        """Set the colour behind everything.

        Args:
            color: Red, green, blue from 0 to 1.

        Raises:
            ArgumentError: this is no colour.
        """
        self._background = checked_colour(color)

    @property
    def camera(self) -> Camera:
        """The camera: pose and vertical field of view."""
        return self._camera

    @property
    def background(self) -> tuple[float, float, float]:
        """The colour behind everything: red, green, blue from 0 to 1."""
        return self._background

    def render(self, width: int = 640, height: int = 480) -> Frame:
        """Draw what the viewer sees.

        Args:
            width: Columns [pixels].
            height: Rows [pixels].

        Returns:
            The picture, shape (height, width, 3), uint8, top row first.

        Raises:
            RenderingError: nothing can draw here.
        """
        return self._studio.picture(self._camera, self._background, Format(width, height))

    def close(self) -> None:
        """Close the viewer."""
        self._studio.close()

    def __repr__(self) -> str:
        return f"<viewer:{self._name}>"

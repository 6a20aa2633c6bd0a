"""Pictures of a MuJoCo model: by OpenGL where it works, by ray casting everywhere.

::

    with open_renderer(model, 640, 480) as renderer:
        picture = renderer.render(data, Camera.from_matrix(T_world_camera))

This package knows ``MjModel`` and ``MjData`` and nothing of OpenRAVE's scenes; its cameras follow OpenRAVE's
convention (see :mod:`ravemj.graphics.rendering.camera`).
"""

import logging
from functools import partial
from typing import Protocol, Self

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.errors import ArgumentError
from ravemj.graphics.rendering.camera import (
    Camera,
    CameraIntrinsics,
    Pinhole,
    bounding_sphere,
    geom_corners,
    three_quarter_view,
    view_from_above,
)
from ravemj.graphics.rendering.style import AS_IT_IS, Look, Style, drawn_geoms
from ravemj.model.drawing import NOTHING, Primitives
from ravemj.model.look import WHITE

__all__ = [
    "Camera",
    "CameraIntrinsics",
    "Look",
    "Pinhole",
    "Renderer",
    "Style",
    "bounding_sphere",
    "drawn_geoms",
    "geom_corners",
    "open_renderer",
    "three_quarter_view",
    "view_from_above",
]

_LOG = logging.getLogger("ravemj")


class Renderer(Protocol):
    """Renders one model in pictures of one size.

    Attributes:
        backend: Its backend: ``egl``, ``osmesa``, ``glfw`` or ``ray``.
        has_shadows: Whether it renders shadows.
    """

    backend: str
    has_shadows: bool

    def render(
        self,
        data: mujoco.MjData,
        camera: Camera,
        look: Look | ArrayLike = WHITE,
        primitives: Primitives = NOTHING,
        style: Style = AS_IT_IS,
    ) -> NDArray[np.uint8]:
        """Render a picture.

        Args:
            data: State of the model with computed poses (``mj_kinematics`` or ``mj_forward``), and computed lights
                if the model has some (``mj_camlight``).
            camera: The camera.
            look: Background, floor and lights; a colour (red, green, blue in 0..1) is a background without floor, with
                the lights of the model.
            primitives: Drawings in addition to the model's geoms.
            style: Drawing style of the geoms.

        Returns:
            A new array, shape (height, width, 3), top row first.

        Raises:
            ArgumentError: the data belong to another model, or the background is not a colour.
            RenderingError: the renderer is closed.
        """
        ...

    def segment(self, data: mujoco.MjData, camera: Camera) -> NDArray[np.int32]:
        """Render the geom ids at pixel centres; drawings are ignored.

        Takes the arguments of ``render``, and raises the same errors.

        Returns:
            A new array of geom ids, shape (height, width), -1 for the background. Transparent geoms count.
        """
        ...

    def resize(self, width: int, height: int, samples: int) -> None:
        """Set the size and the samples per pixel of later pictures; this takes about a millisecond."""

    def depth(self, data: mujoco.MjData, camera: Camera) -> NDArray[np.float32]:
        """Render the depths at pixel centres; drawings are ignored.

        Takes the arguments of ``render``, and raises the same errors.

        Returns:
            A new array of depths along the viewing direction [m], shape (height, width), infinite for the background.
            Transparent geoms count.
        """
        ...

    def close(self) -> None:
        """Free the resources, like the end of a ``with`` block."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def open_renderer(
    model: mujoco.MjModel,
    width: int,
    height: int,
    *,
    shadows: bool | None = False,
    samples: int = 4,
    backend: str | None = None,
) -> Renderer:
    """Open a renderer with the first backend that works: EGL, OSMesa, GLFW, else ray casting.

    Args:
        model: The model; geoms may change poses and colours later, but not their number.
        width: Columns of the pictures.
        height: Rows of the pictures.
        shadows: Whether lights cast shadows; None: if there is a graphics card. The ray caster ignores it.
        samples: Samples per pixel for antialiasing: 4 for stills, 0 for speed.
        backend: ``egl``, ``osmesa``, ``glfw`` or ``ray``; by default that of ``MUJOCO_GL``, or any.

    Raises:
        ArgumentError: a size is not positive, or another argument has none of the listed values.
        RenderingError: the requested backend does not work on this machine; the message says why.
    """
    from ravemj.graphics.rendering import contexts  # noqa: PLC0415 - slow to import
    from ravemj.graphics.rendering.gl import GlRenderer  # noqa: PLC0415
    from ravemj.graphics.rendering.gl_scene import Quality  # noqa: PLC0415
    from ravemj.graphics.rendering.ray import RayRenderer  # noqa: PLC0415

    known = (*contexts.GL_BACKENDS, contexts.RAY)
    if width < 1 or height < 1:
        raise ArgumentError(f"picture size {width} x {height}: expected at least 1 x 1 pixels")
    if samples not in (0, 4):
        raise ArgumentError(f"samples is {samples}, expected 0 or 4")
    if backend is not None and backend not in known:
        raise ArgumentError(f"backend is {backend!r}, expected one of {', '.join(known)}")
    make = partial(GlRenderer, model, Quality(width, height, shadows, samples))
    chosen = backend or contexts.requested_backend()
    renderer: Renderer | None = None
    if chosen is None:
        renderer = contexts.make_with_any_backend(make)
    elif chosen != contexts.RAY:
        renderer = contexts.make_with_backend(chosen, make)
    renderer = renderer or RayRenderer(model, width, height, samples)
    _LOG.info("pictures of %d x %d are drawn by %s", width, height, renderer.backend)
    return renderer

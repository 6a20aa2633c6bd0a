"""Rendering of a simulation: renderers per thread, cameras, backgrounds."""

import threading
from collections.abc import Callable
from typing import NamedTuple, TypeVar

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.locks import StateLock
from ravemj.engine.simulation import Simulation
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering import (
    Camera,
    Renderer,
    Style,
    bounding_sphere,
    open_renderer,
    three_quarter_view,
    view_from_above,
)
from ravemj.graphics.rendering.backdrop import lowest_point
from ravemj.graphics.rendering.style import AS_IT_IS, Look
from ravemj.model.drawing import NOTHING, Primitives, merge

Frame = NDArray[np.uint8]
Drawn = TypeVar("Drawn")


class Format(NamedTuple):
    """Size and quality of a picture."""

    width: int = 640  # [pixels]
    height: int = 480  # [pixels]
    shadows: bool | None = None  # whether lights cast shadows; None: only with a graphics card
    samples: int = 4  # per pixel against jagged edges: 4, or 0 for speed
    scale: float = 1.0  # columns relative to the displayed size, by which points and lines become narrower

    @property
    def aspect(self) -> float:
        """The width divided by the height.

        Raises:
            ArgumentError: the size is not in whole pixels, at least 1 x 1.
        """
        for side in (self.width, self.height):
            if side < 1 or side != int(side):
                raise ArgumentError(f"picture size {self.width} x {self.height}: expected whole pixels, at least 1 x 1")
        return self.width / self.height


class SimulationRenderer:
    """Renders a simulation; each thread reuses the renderer of its last picture.

    The simulation is locked only while its state is copied. A separate ``StateLock`` makes the exit of Python wait for
    rendering threads.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._kept = threading.local()

    def render(
        self,
        camera: Camera,
        look: Look | ArrayLike,
        form: Format,
        drawings: bool = True,
        gizmos: Primitives = NOTHING,
        style: Style = AS_IT_IS,
    ) -> Frame:
        """Render the present state of bodies and drawings.

        Args:
            camera: The camera.
            look: Background, floor and lights; a colour is a background without floor, with the model's lights.
            form: Size and quality.
            drawings: Whether to draw the drawings of scripts.
            gizmos: Additional drawings.
            style: Drawing style of the bodies.

        Returns:
            The picture, shape (height, width, 3), top row first.

        Raises:
            RenderingError: no renderer works on this machine, or the renderer in ``MUJOCO_GL`` does not.
        """
        with self._simulation.lock:
            compiled = self._simulation.compiled()
            primitives = self._simulation.drawings.primitives() if drawings else NOTHING
            shown = merge([primitives, gizmos]) if len(gizmos) else primitives
            renderer = self._current(form)
            mujoco.mj_copyData(self._kept.data, compiled.model, compiled.data)
            self._kept.shown, self._kept.published = (shown, style), self._simulation.published.number
        with StateLock():
            return renderer.render(self._kept.data, camera, look, shown.widened(form.scale), style)

    def depth(self, camera: Camera, form: Format) -> NDArray[np.float32]:
        """Return depths along the viewing direction [m], shape (height, width); infinite for the background."""
        return self._measured(form, lambda renderer, data: renderer.depth(data, camera))

    def segment(self, camera: Camera, form: Format) -> NDArray[np.int32]:
        """Return the geom id of each pixel in the present model, shape (height, width); -1 for the background."""
        return self._measured(form, lambda renderer, data: renderer.segment(data, camera))

    def _measured(self, form: Format, measure: Callable[[Renderer, mujoco.MjData], Drawn]) -> Drawn:
        """Return ``measure(renderer, data)`` for this thread's renderer and the present state."""
        with self._simulation.lock:
            compiled = self._simulation.compiled()
            renderer = self._current(form)
            mujoco.mj_copyData(self._kept.data, compiled.model, compiled.data)
        with StateLock():
            return measure(renderer, self._kept.data)

    def render_again(self, camera: Camera, look: Look | ArrayLike, form: Format) -> Frame | None:
        """Render this thread's last state from another camera, without locking the simulation.

        Bodies have the poses of the last state, or those published since. The result is a picture as from ``render``;
        None if this thread has not rendered yet.
        """
        if getattr(self._kept, "key", None) is None:
            return None
        published = self._simulation.published
        if self._kept.published != published.number:
            self._kept.published = published.number
            published.copy_to(self._kept.data, self._kept.model)
        shown, style = self._kept.shown
        with StateLock():
            self._kept.renderer.resize(form.width, form.height, form.samples)
            return self._kept.renderer.render(self._kept.data, camera, look, shown.widened(form.scale), style)

    def backend(self, form: Format) -> str:
        """Return the backend that renders pictures of a format: ``egl``, ``osmesa``, ``glfw`` or ``ray``."""
        with self._simulation.lock:
            return self._current(form).backend

    def has_shadows(self, form: Format) -> bool:
        """Return whether pictures of a format have shadows; the ray caster draws none."""
        with self._simulation.lock:
            return self._current(form).has_shadows

    def _current(self, form: Format) -> Renderer:
        key = (self._simulation.version, form.shadows)
        if getattr(self._kept, "key", None) != key:
            self.close()
            model = self._simulation.compiled().model
            self._kept.model, self._kept.data = model, mujoco.MjData(model)
            size = form.width, form.height
            self._kept.renderer = open_renderer(model, *size, shadows=form.shadows, samples=form.samples)
            self._kept.key = (self._simulation.version, form.shadows)  # recompilation changes the version
        self._kept.renderer.resize(form.width, form.height, form.samples)
        return self._kept.renderer

    def close(self) -> None:
        """Free the renderer of this thread."""
        if getattr(self._kept, "key", None) is not None:
            self._kept.renderer.close()
            self._kept.key = None

    def file_camera(self) -> Camera | None:
        """Return the camera of the loaded file, or None."""
        T_world_camera = self._simulation.view.T_world_camera
        return None if T_world_camera is None else Camera(T_world_camera.matrix())

    def camera_from_above(self) -> Camera:
        """Return OpenRAVE's initial view of the whole scene: along -z, with +y up."""
        return view_from_above(*self.bounding_sphere())

    def camera_for_stills(self, aspect: float) -> Camera:
        """Return the file's camera, else a view of the whole scene; ``aspect`` is width divided by height."""
        return self.file_camera() or three_quarter_view(*self.bounding_sphere(), aspect)

    def lowest_point(self) -> float:
        """Return the minimum z of the drawn geoms [m]; infinity if there are none."""
        with self._simulation.lock:
            compiled = self._simulation.compiled()
            return lowest_point(compiled.model, compiled.data)

    def bounding_sphere(self) -> tuple[NDArray[np.float64], float]:
        """Return centre, shape (3,), and radius [m] of a bounding sphere of the drawn geoms."""
        with self._simulation.lock:
            compiled = self._simulation.compiled()
            return bounding_sphere(compiled.model, compiled.data)

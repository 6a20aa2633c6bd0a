"""The renderers, and which of them is taken."""

import mujoco

from ravemj.errors import ArgumentError
from ravemj.graphics.rendering import Renderer
from ravemj.graphics.rendering.contexts import (
    GL_BACKENDS,
    RAY,
    make_with_any_backend,
    make_with_backend,
    requested_backend,
)
from ravemj.graphics.rendering.gl import GlRenderer
from ravemj.graphics.rendering.gl_scene import Quality
from ravemj.graphics.rendering.ray import RayRenderer


def opened(model: mujoco.MjModel, quality: Quality, backend: str | None) -> Renderer:
    """Return a renderer; see ``open_renderer``."""
    _check(quality, backend)
    chosen = backend or requested_backend()
    renderer: Renderer | None = None
    if chosen is None:
        renderer = make_with_any_backend(lambda context: GlRenderer(model, context, quality))
    elif chosen != RAY:
        renderer = make_with_backend(chosen, lambda context: GlRenderer(model, context, quality))
    return renderer or RayRenderer(model, quality.width, quality.height, quality.samples)


def _check(quality: Quality, backend: str | None) -> None:
    if quality.width < 1 or quality.height < 1:
        raise ArgumentError(f"picture size {quality.width} x {quality.height}: expected at least 1 x 1 pixels")
    if quality.samples not in (0, 4):
        raise ArgumentError(f"samples is {quality.samples}, expected 0 or 4")
    if backend is not None and backend not in (*GL_BACKENDS, RAY):
        raise ArgumentError(f"backend is {backend!r}, expected one of {', '.join((*GL_BACKENDS, RAY))}")

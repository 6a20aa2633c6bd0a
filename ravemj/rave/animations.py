"""Motions as pages that play them."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.errors import ArgumentError
from ravemj.graphics.rendering import Camera
from ravemj.graphics.rendering.checks import checked_colour
from ravemj.graphics.webgl.animation import Animation, Appearance, Recording, animation_page
from ravemj.rave.enums import CheckLimitsAction
from ravemj.rave.recording import camera_for_motion, moving_body, within_limits
from ravemj.trajectories.motion import Motion

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.kinbody import KinBody

_ASPECT = 4 / 3
"""Width of a picture divided by its height for which the first view is chosen; the page has any."""

_LOWEST_FPS, _HIGHEST_FPS = 0.01, 1000


def animate(
    env: "Environment",
    motion: Motion | None,
    robot: "KinBody | None" = None,
    fps: float = 30.0,
    camera: ArrayLike | None = None,
    background: ArrayLike | None = None,
) -> Animation:
    """Return the page of a motion; ``Environment.animation`` says what the arguments are."""
    if not _LOWEST_FPS <= fps <= _HIGHEST_FPS:  # NaN is refused, too
        raise ArgumentError(f"expected from {_LOWEST_FPS} to {_HIGHEST_FPS} frames a second, found {fps}")
    with env:
        body = moving_body(env) if robot is None and motion is not None else robot
        course = None if body is None or motion is None else within_limits(body, motion)
        if camera is not None:
            view = Camera.from_matrix(camera)
        elif body is None or course is None:
            view = env.default_camera(_ASPECT)
        else:
            view = camera_for_motion(env, body, course, _ASPECT)
        recording = _recorded(env, body, course, fps)
        title = "ravemj" if body is None else body.GetName()
        colour = env.background if background is None else checked_colour(background)
        compiled, drawings = env.simulation.compiled(), env.simulation.drawings.primitives()
        return Animation(
            animation_page(compiled.model, compiled.data, recording, Appearance(view, colour, title), drawings)
        )


def _recorded(env: "Environment", body: "KinBody | None", motion: Motion | None, fps: float) -> Recording:
    """Move the body as the motion says, and return where everything was."""
    rows: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    for values in _frames(body, motion, fps):
        data = env.simulation.compiled().data
        rows.append((data.xpos.copy(), data.xquat.copy(), values))
    joints = [] if body is None else [(joint, axis) for joint in body.GetJoints() for axis in range(joint.GetDOF())]
    return Recording(
        fps,
        np.array([row[0] for row in rows]),
        np.array([row[1] for row in rows]),
        np.array([row[2] for row in rows]),
        [joint.GetName() + (f", axis {axis}" if joint.GetDOF() > 1 else "") for joint, axis in joints],
        ["m" if joint.IsPrismatic(axis) else "rad" for joint, axis in joints],
    )


def _frames(body: "KinBody | None", motion: Motion | None, fps: float) -> Iterator[np.ndarray]:
    """Yield the joint values of each frame, with the body there."""
    if body is None or motion is None:
        yield np.zeros(0) if body is None else body.GetDOFValues()
        return
    for values in motion.frames(fps):
        body.SetDOFValues(values, None, CheckLimitsAction.Nothing)
        yield values

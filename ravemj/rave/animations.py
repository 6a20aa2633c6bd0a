"""Motions as pages that play them."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering import Camera
from ravemj.graphics.rendering.style import AS_USUAL, LookChoices
from ravemj.graphics.webgl.animation import Animation, Appearance, Recording, animation_page
from ravemj.rave.recording import camera_for_motion, followed_motion, lowest_of_motion
from ravemj.trajectories.body_motion import BodyMotion
from ravemj.trajectories.motion_arguments import MotionLike

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.kinbody import KinBody

_ASPECT = 4 / 3
"""Width of a picture divided by its height for which the first view is chosen; the page has any."""

_LOWEST_FPS, _HIGHEST_FPS = 0.01, 1000


def animate(
    env: "Environment",
    motion: MotionLike | None,
    robot: "KinBody | None" = None,
    fps: float = 30.0,
    camera: ArrayLike | None = None,
    background: ArrayLike | None = None,
    choices: LookChoices = AS_USUAL,
) -> Animation:
    """Return the page of a motion; ``Environment.animation`` says what the arguments are."""
    if not _LOWEST_FPS <= fps <= _HIGHEST_FPS:  # NaN is refused, too
        raise ArgumentError(f"expected from {_LOWEST_FPS} to {_HIGHEST_FPS} frames a second, found {fps}")
    with env:
        followed = None if motion is None else followed_motion(env, motion, robot)
        is_fitted = camera is None and env.GetViewer() is None and env.renderer.file_camera() is None
        if camera is not None:
            view = Camera.from_matrix(camera)
        elif followed is None:
            view = env.default_camera(_ASPECT)
        else:
            view = camera_for_motion(env, followed, _ASPECT)
        shown = followed.bodies if followed is not None else () if robot is None else (robot.simulation_state,)
        lowest = math.inf if followed is None else lowest_of_motion(env, followed)
        recording = _recorded(env, shown, followed, fps)
        title = ", ".join(body.scene.name for body in shown) or "ravemj"
        look = replace(env.look(background, choices), lowest=lowest)
        appearance = Appearance(view, 1.0 if is_fitted else _ASPECT, look, title, choices.shadows)
        compiled, drawings = env.simulation.compiled(), env.simulation.drawings.primitives()
        return Animation(animation_page(compiled.model, compiled.data, recording, appearance, drawings))


def _recorded(env: "Environment", bodies: Sequence[BodyState], motion: BodyMotion | None, fps: float) -> Recording:
    """Move the bodies as the motion says, and return where everything was."""
    rows: list[tuple[Floats, Floats, Floats]] = []
    for time in [0.0] if motion is None else motion.frame_times(fps):
        if motion is not None:
            motion.place(time)
        data = env.simulation.compiled().data
        values = [body.kinematics.values() for body in bodies]
        rows.append((data.xpos.copy(), data.xquat.copy(), np.concatenate([*values, np.zeros(0)])))
    joints = [joint for body in bodies for joint in body.scene.joints]
    return Recording(
        fps,
        np.array([row[0] for row in rows]),
        np.array([row[1] for row in rows]),
        np.array([row[2] for row in rows]),
        [(f"{body.scene.name} " if bodies[1:] else "") + name for body in bodies for name in body.scene.dof_names],
        ["m" if joint.slides(axis) else "rad" for joint in joints for axis in range(len(joint.axes))],
    )

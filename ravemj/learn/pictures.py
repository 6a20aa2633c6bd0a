"""Pictures of an answer (solid) and the right answer (transparent), with frames, and the error as an arrow."""

import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple, cast

import numpy as np

from ravemj.errors import ArgumentError, RavemjError, RavemjWarning
from ravemj.formats.shipped import SHIPPED_MODELS, model_path
from ravemj.geometry_functions import matrixFromPose, transformLookat
from ravemj.graphics.rendering.camera import three_quarter_view
from ravemj.graphics.video import write_picture
from ravemj.learn.check import Check, Floats, Scene
from ravemj.learn.child import Verdict, questions
from ravemj.rave import Environment, Robot
from ravemj.rave.env.viewing import GraphHandle
from ravemj.rave.registry import RaveCreateRobot

_GHOST = 0.75
_YOURS, _RIGHT = np.array([0.85, 0.2, 0.1]), np.array([0.1, 0.6, 0.2])
_LINKS = np.array([0.35, 0.4, 0.5])
_AXES = np.eye(3)
_LENGTH = 0.15  # of the axes of frames, in parts of the size of what is shown


def has_picture(check: Check) -> bool:
    """Return whether answers to an exercise can be drawn."""
    return check.scene is not None or check.kind in {"position", "pose", "rotation", "quaternion"}


class Shown(NamedTuple):
    """An answer and the right one, drawn together.

    Attributes:
        env: The environment; the caller destroys it.
        drawn: Handles of the drawings.
        camera: ``T_world_camera``.
    """

    env: Environment
    drawn: list[GraphHandle | None]
    camera: Floats

    @property
    def floor(self) -> str:
        """Option ``floor`` of the picture: ``auto``, or ``off`` without bodies."""
        return "auto" if self.env.GetBodies() else "off"


def answer_scene(check: Check, verdict: Verdict) -> Shown:
    """Return the student's answer in ``verdict``, drawn together with the right one.

    Raises:
        RavemjError: the answer is not numbers of the right shape, or the exercise has no picture.
    """
    if not has_picture(check):
        raise ArgumentError(
            "the answers of this exercise are numbers, which no picture shows; ravemj learn check tells"
        )
    arguments = questions(check, verdict.seed)[verdict.question]
    right = _first_row(check, np.asarray(check.answer(*arguments), dtype=float))
    given = None if verdict.answer is None else _first_row(check, np.asarray(verdict.answer, dtype=float))
    if given is None or given.shape != right.shape or not right.size:
        raise RavemjError(f"there is no answer to show: {verdict.message or 'solve it first'}")
    scene = None if check.scene is None else check.scene(*arguments)
    env, T_world_frame = Environment(), np.eye(4)
    env.SetViewer("offscreen")  # which keeps drawings
    drawn: list[GraphHandle | None] = []
    if scene is not None and scene.model:
        T_world_frame = _add_robots(env, scene, check, given, right)
    if scene is not None and scene.line:
        points = np.array([_in_space(np.asarray(point, dtype=float)) for point in scene.line])
        drawn.append(env.drawlinestrip(points, 8, _LINKS))
    poses: list[Floats] = []
    if check.kind != "joint values":
        poses = [T_world_frame @ _pose(check, answer) for answer in (given, right)]
        drawn += _drawn(env, *poses, turned=check.kind != "position")
    return Shown(env, drawn, _camera(env, [pose[:3, 3] for pose in poses], flat=right.shape == (2,)))


def _camera(env: Environment, points: list[Floats], *, flat: bool) -> Floats:
    """Return ``T_world_camera`` of a view of all robots and points; planar answers are seen from above."""
    center, radius = env.renderer.bounding_sphere() if env.GetBodies() else (np.zeros(3), 0.0)
    corners = np.array([np.zeros(3), center, *points])
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = (low + high) / 2
    distance = max(float(np.linalg.norm(high - low)) / 2, float(np.linalg.norm(center - middle)) + radius)
    distance = 1.2 * max(distance, 0.1)  # with the axes of frames
    if flat:
        return transformLookat(middle, middle + np.array([0, 0, 3 * distance]), [0, -1, 0])
    return three_quarter_view(middle, distance).T_world_camera


def _first_row(check: Check, answer: Floats) -> Floats:
    """Return the first of several positions or configurations; return other answers unchanged."""
    return answer[0] if check.kind in {"position", "joint values"} and answer.ndim > 1 and len(answer) else answer


def save_picture(check: Check, verdict: Verdict, output: Path) -> None:
    """Write a picture of an answer, or a page with a movable camera (``.html``)."""
    shown = answer_scene(check, verdict)
    try:
        if output.suffix.lower() == ".html":
            yours = next(iter(shown.env.GetRobots()), None)  # whose joints the page moves
            shown.env.save_html(output, robot=yours, camera=shown.camera, floor=shown.floor)
        else:
            write_picture(output, shown.env.render(camera=shown.camera, floor=shown.floor))
    finally:
        shown.env.Destroy()


def _add_robots(env: Environment, scene: Scene, check: Check, given: Floats, right: Floats) -> Floats:
    """Add the robot of a scene; return the world pose of the frame that the answer refers to.

    If answers are joint values, a copy of the robot shows the right ones.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RavemjWarning)
        env.Load(model_path(scene.model) if scene.model in SHIPPED_MODELS else scene.model)
    robot = env.GetRobots()[0]
    if check.kind == "joint values":
        ghost = cast("Robot", RaveCreateRobot(env, ""))
        ghost.Clone(robot, 0)
        ghost.SetName("the right answer")
        env.Add(ghost, True)
        for body, values in ((robot, given), (ghost, right)):
            body.SetDOFValues(values, range(len(values)), checklimits=0)
        for geometry in (geometry for link in ghost.GetLinks() for geometry in link.GetGeometries()):
            geometry.SetTransparency(_GHOST)
    elif scene.values is not None:
        robot.SetDOFValues(np.asarray(scene.values, dtype=float), range(len(scene.values)), checklimits=0)
    link = robot.GetLink(scene.frame) if scene.frame else None
    return np.eye(4) if link is None else link.GetTransform()


def _pose(check: Check, answer: Floats) -> Floats:
    T = np.eye(4)
    if check.kind == "pose":
        return answer
    if check.kind == "rotation":
        T[:3, :3] = answer
    elif check.kind == "quaternion":
        return matrixFromPose([*answer, 0, 0, 0])
    else:
        T[:3, 3] = _in_space(answer)
    return T


def _in_space(point: Floats) -> Floats:
    """Return a 3D point; a 2D one gets z = 0."""
    return np.pad(point, (0, 3 - len(point)))


def _drawn(env: Environment, given: Floats, right: Floats, *, turned: bool) -> Iterator[GraphHandle | None]:
    """Draw the given and the right pose (if ``turned``, with axes) and an arrow between them; yield the handles."""
    size = max(float(np.abs([given[:3, 3], right[:3, 3]]).max()), 0.2)
    for T, colour, width in ((np.eye(4), None, 1), (given, _YOURS, 4), (right, _RIGHT, 2)):
        origin = T[:3, 3]
        if colour is not None:
            yield env.plot3(origin, 0.02 * size, colour, 1)
        if turned or colour is None:
            for axis in range(3):
                tip = origin + _LENGTH * size * T[:3, axis]
                yield env.drawlinestrip(np.array([origin, tip]), width, _AXES[axis])
    if np.linalg.norm(given[:3, 3] - right[:3, 3]) > 1e-3 * size:
        yield env.drawarrow(given[:3, 3], right[:3, 3], 0.006 * size, np.array([0.9, 0.6, 0.1]))

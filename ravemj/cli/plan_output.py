"""What ``plan`` writes: motions, and pictures and videos of them."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ravemj.cli.arms import add_ghost
from ravemj.cli.pictures import PAGE, explain_rays, write_page, write_video
from ravemj.core.output import check_file
from ravemj.core.transforms import Floats
from ravemj.graphics.rendering.camera import Camera
from ravemj.graphics.simulation_renderer import Format
from ravemj.graphics.video import VIDEO_FORMATS, check_picture, check_target, known_suffix, write_picture
from ravemj.planning.rrt import Search
from ravemj.rave import Planner, Robot
from ravemj.rave.env.viewing import GraphHandle
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.recording import Shot, camera_for_motion
from ravemj.trajectories.body_motion import BodyMotion
from ravemj.trajectories.motion import Motion
from ravemj.trajectories.motion_reading import MOTION_SUFFIXES
from ravemj.trajectories.motion_writing import check_motion_file, write_motion

_PICTURES = (".png", ".jpg", ".jpeg")
_STEP = 0.1  # rad or m, between the points of a line in the space of joint values
_BATCH = 10_000  # configurations at once, for the sake of memory
_PATH_WIDTH, _TREE_WIDTH = 4.0, 1.0  # pixels
_PATH_COLOUR = (0.0, 0.5, 0.2)
_TREE_COLOURS = ((0.1, 0.3, 0.9), (0.95, 0.4, 0.0))  # of the start, of the goals


class Plan(NamedTuple):
    """What was planned, and what came of it.

    Attributes:
        robot: The robot.
        arm: Its manipulator that moves; None: it has none.
        dofs: DOF indices of what moves.
        params: The problem.
        goals: Joint values of the goals, shape (n, len(dofs)).
        search: How the search went; None: there was nothing to search.
        motion: The motion of all DOFs; None: there is none.
    """

    robot: Robot
    arm: Manipulator | None
    dofs: list[int]
    params: Planner.PlannerParameters
    goals: Floats
    search: Search | None
    motion: Motion | None


def check_output(path: str) -> None:
    """Check that a motion, picture or video can be written to a path, without touching anything."""
    kinds = {**dict.fromkeys(MOTION_SUFFIXES, check_motion_file), **dict.fromkeys(_PICTURES, check_picture)}
    kinds[PAGE] = check_file
    kinds.get(known_suffix(path, [*kinds, *VIDEO_FORMATS]), check_target)(path)


def write(plan: Plan, camera: Camera | None, options: argparse.Namespace) -> None:
    """Write a motion, its video or its picture; without a motion, the picture of the trees alone."""
    robot, path = plan.robot, options.output
    suffix = Path(path).suffix.lower()
    if plan.motion is not None and suffix in MOTION_SUFFIXES:
        write_motion(path, plan.motion, robot.simulation_state.scene.dof_names)
        print(f"wrote {path}")
    elif suffix in _PICTURES and (plan.motion is not None or options.show_tree):
        _write_picture(plan, camera, options)
    elif suffix not in _PICTURES and plan.motion is not None:
        env, drawn = robot.GetEnv(), _draw(plan, path=options.show_tree, trees=options.show_tree)
        if suffix == PAGE:
            write_page(path, env, _followed(plan), options, camera)
        else:
            write_video(path, env, _followed(plan), _shot(plan, camera, options))
        del drawn


def _followed(plan: Plan) -> BodyMotion:
    motion = plan.motion or Motion([0.0], [plan.robot.GetDOFValues()])
    return BodyMotion.of_motion(plan.robot.simulation_state, motion)


def _shot(plan: Plan, camera: Camera | None, options: argparse.Namespace) -> Shot:
    env, form = plan.robot.GetEnv(), Format(*options.size)
    view = camera or camera_for_motion(env, _followed(plan), form.width / form.height)
    return Shot(view, env.background if options.background is None else tuple(options.background), form, options.fps)


def _write_picture(plan: Plan, camera: Camera | None, options: argparse.Namespace) -> None:
    """Draw the robot at the start, a transparent copy of it at the goal, and the way of the hand."""
    env, shot = plan.robot.GetEnv(), _shot(plan, camera, options)
    drawn = _draw(plan, path=True, trees=options.show_tree)
    goal = plan.goals[0] if plan.motion is None else plan.motion.values[-1, plan.dofs]
    add_ghost(plan.robot, 2, goal, plan.dofs)
    picture = env.render(*options.size, camera=shot.camera.T_world_camera, background=shot.background)
    write_picture(options.output, picture)
    explain_rays(env, shot.form)
    print(f"wrote {options.output}")
    del drawn


def _draw(plan: Plan, *, path: bool, trees: bool) -> list[GraphHandle | None]:
    """Draw where the hand goes, and the trees, as far as they are asked for; return what keeps the drawing."""
    env, drawn = plan.robot.GetEnv(), list[GraphHandle | None]()
    env.SetViewer("offscreen")  # which keeps drawings
    grown = plan.search.trees if trees and plan.search is not None else ()
    for tree, colour in zip(grown, _TREE_COLOURS, strict=False):
        if lines := tree.lines():
            drawn.append(env.drawlinelist(_segments(plan, tree.nodes(), lines), _TREE_WIDTH, colour))
    if path and plan.motion is not None:
        drawn.append(env.drawlinestrip(_hand(plan, plan.motion.values), _PATH_WIDTH, _PATH_COLOUR))
    return drawn


def _segments(plan: Plan, nodes: Floats, lines: Sequence[tuple[int, int]]) -> Floats:
    """Return the ends of short segments along the ways of the hand on some lines of a tree, shape (2 m, 3)."""
    rows: list[Floats] = []
    for number, parent in lines:
        step = plan.params.DiffStateFn(nodes[number], nodes[parent])
        parts = np.linspace(0.0, 1.0, max(2, int(np.ceil(np.abs(step).max() / _STEP)) + 1))
        rows.append(nodes[parent] + parts[:, None] * step)
    line = np.repeat(np.arange(len(rows)), [len(row) for row in rows])
    values = np.tile(plan.robot.GetDOFValues(), (len(line), 1))
    values[:, plan.dofs] = np.concatenate(rows)
    hand, same = _hand(plan, values), line[1:] == line[:-1]
    return np.stack([hand[:-1][same], hand[1:][same]], axis=1).reshape(-1, 3)


def _hand(plan: Plan, values: Floats) -> Floats:
    """Return where the tool is in the world, or the middle of the last link, for many joint values, shape (n, 3)."""
    if plan.arm is None:
        link = plan.robot.GetLinks()[-1]
        place = np.nan_to_num(link.GetLocalCOM())
    else:
        link, place = plan.arm.GetEndEffector(), plan.arm.GetLocalToolTransform()[:3, 3]
    assert link is not None
    found: list[Floats] = []
    for start in range(0, len(values), _BATCH):
        T_world_links = plan.robot.batch_link_transforms(values[start : start + _BATCH])[:, link.GetIndex()]
        found.append(T_world_links[:, :3, :3] @ place + T_world_links[:, :3, 3])
    return np.concatenate(found)

"""Output of ``plan``: motions, and pictures and videos of them."""

import argparse
import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ravemj.cli.arms import add_ghost
from ravemj.cli.pictures import PAGE, explain_rays, look_of, picture_of, write_page, write_video
from ravemj.cli.robot_motions import write_points
from ravemj.core.output import check_file
from ravemj.core.transforms import Floats
from ravemj.graphics.rendering.camera import Camera
from ravemj.graphics.simulation_renderer import Format
from ravemj.graphics.video import VIDEO_FORMATS, check_picture, check_target, known_suffix, write_picture
from ravemj.planning.certificates import Certificate
from ravemj.planning.rrt import Search
from ravemj.rave import Environment, Planner, Robot
from ravemj.rave.env.viewing import GraphHandle
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.recording import Shot, camera_for_motion
from ravemj.trajectories.body_motion import BodyMotion
from ravemj.trajectories.joint_trajectory import JointTrajectory
from ravemj.trajectories.joint_trajectory_files import (
    JOINT_TRAJECTORY_SUFFIXES,
    check_joint_trajectory_file,
    is_joint_trajectory,
)
from ravemj.trajectories.motion import Motion
from ravemj.trajectories.motion_reading import MOTION_SUFFIXES
from ravemj.trajectories.motion_writing import check_motion_file, write_motion

_FINGERPRINT = 16  # digits
_PICTURES = (".png", ".jpg", ".jpeg")
_STEP = 0.1  # rad or m, between the points of a line in the space of joint values
_BATCH = 10_000  # configurations per batch, to limit memory
_PATH_WIDTH, _TREE_WIDTH = 4.0, 1.0  # pixels
_PATH_COLOUR = (0.0, 0.5, 0.2)
_GAP_COLOUR, _GAP_END = (0.9, 0.0, 0.5), 8.0  # red, green, blue; pixels
_TREE_COLOURS = ((0.1, 0.3, 0.9), (0.95, 0.4, 0.0))  # of the start, of the goals


class Plan(NamedTuple):
    """A planning problem and its result.

    Attributes:
        robot: The robot.
        arm: Its moving manipulator, or None.
        dofs: DOF indices of the moving joints.
        params: Parameters of the planner, with start and goal.
        goals: Goal configurations, shape (n, len(dofs)).
        search: Statistics of the search; None if no search was needed.
        motion: The motion of all DOFs; None if none was found.
        points: The motion for a robot controller; None if it was not requested.
        certificate: Certificate of the motion; None if it was not requested.
        notes: Lines of text about the search.
        examples: By cause of rejection of sampled poses, an example configuration, shape (len(dofs),).
    """

    robot: Robot
    arm: Manipulator | None
    dofs: list[int]
    params: Planner.PlannerParameters
    goals: Floats
    search: Search | None
    motion: Motion | None
    points: JointTrajectory | None
    certificate: Certificate | None
    notes: Sequence[str]
    examples: Mapping[str, Floats]


def check_output(path: str) -> None:
    """Check that a motion, picture or video can be written to a path, without touching anything."""
    if is_joint_trajectory(path):
        check_joint_trajectory_file(path)
        return
    kinds = {**dict.fromkeys(MOTION_SUFFIXES, check_motion_file), **dict.fromkeys(_PICTURES, check_picture)}
    kinds[PAGE] = check_file
    kinds.get(known_suffix(path, [*kinds, *JOINT_TRAJECTORY_SUFFIXES, *VIDEO_FORMATS]), check_target)(path)


def write(plan: Plan, camera: Camera | None, options: argparse.Namespace) -> None:
    """Write a motion as file, video or picture.

    If there is no motion, write a page with the reasons, or a picture of the search trees.
    """
    robot, path = plan.robot, options.output
    suffix = Path(path).suffix.lower()
    notes = [] if plan.certificate is None else [str(plan.certificate), f"scene {_fingerprint(robot.GetEnv())}"]
    if plan.points is not None:
        write_points(robot, plan.points, options, notes)
    elif plan.motion is not None and suffix in MOTION_SUFFIXES:
        write_motion(path, plan.motion, robot.simulation_state.scene.dof_names, notes)
        print(f"wrote {path}")
    elif suffix in _PICTURES and (plan.motion is not None or options.show_tree):
        _write_picture(plan, camera, options)
    elif suffix == PAGE:
        drawn = _draw(plan, path=options.show_tree, trees=options.show_tree)
        if plan.motion is None:
            _add_examples(plan)
        write_page(path, robot.GetEnv(), _followed(plan), options, camera, plan.notes)
        del drawn
    elif suffix not in _PICTURES and plan.motion is not None:
        drawn = _draw(plan, path=options.show_tree, trees=options.show_tree)
        write_video(path, robot.GetEnv(), _followed(plan), _shot(plan, camera, options))
        del drawn


def _add_examples(plan: Plan) -> None:
    """Add transparent copies of the robot at the rejected configurations, one for each cause."""
    for cause, values in plan.examples.items():
        if len(values):
            add_ghost(plan.robot, cause, values, plan.dofs)


def _fingerprint(env: Environment) -> str:
    """Return a hash of all bodies: their links, joints, shapes, poses and joint values."""
    numbers = [(body.GetTransform(), body.GetDOFValues()) for body in env.GetBodies()]
    texts = [f"{body.GetName()} {body.GetKinematicsGeometryHash()}" for body in env.GetBodies()]
    rounded = [[(array.round(9) + 0.0).tolist() for array in arrays] for arrays in numbers]
    return hashlib.sha256(repr((texts, rounded)).encode()).hexdigest()[:_FINGERPRINT]


def _followed(plan: Plan) -> BodyMotion:
    motion = plan.motion or Motion([0.0], [plan.robot.GetDOFValues()])
    return BodyMotion.of_motion(plan.robot.simulation_state, motion)


def _shot(plan: Plan, camera: Camera | None, options: argparse.Namespace) -> Shot:
    env, form = plan.robot.GetEnv(), Format(*options.size, shadows=options.shadows)
    view = camera or camera_for_motion(env, _followed(plan), form.width / form.height)
    return Shot(view, look_of(options, env), form, options.fps)


def _write_picture(plan: Plan, camera: Camera | None, options: argparse.Namespace) -> None:
    """Draw the robot at the start, a transparent copy at the goal, and the end-effector path."""
    env, shot = plan.robot.GetEnv(), _shot(plan, camera, options)
    drawn = _draw(plan, path=True, trees=options.show_tree)
    goals = plan.goals if plan.motion is None else plan.motion.values[-1:, plan.dofs]
    for goal in goals[:1]:
        add_ghost(plan.robot, 2, goal, plan.dofs)
    picture = picture_of(options, env, shot.camera.T_world_camera)
    write_picture(options.output, picture)
    explain_rays(env, shot.form)
    print(f"wrote {options.output}")
    del drawn


def _draw(plan: Plan, *, path: bool, trees: bool) -> list[GraphHandle | None]:
    """Draw the nearest points and, if requested, end-effector path and search trees; return the handles.

    The nearest points are those of the smallest clearance along the motion, known only with a certificate.
    """
    env, drawn = plan.robot.GetEnv(), list[GraphHandle | None]()
    env.SetViewer("offscreen")  # handles of drawings
    grown = plan.search.trees if trees and plan.search is not None else ()
    for tree, colour in zip(grown, _TREE_COLOURS, strict=False):
        if lines := tree.lines():
            drawn.append(env.drawlinelist(_segments(plan, tree.nodes(), lines), _TREE_WIDTH, colour))
    if path and plan.motion is not None:
        drawn.append(env.drawlinestrip(_hand(plan, plan.motion.values), _PATH_WIDTH, _PATH_COLOUR))
    if plan.certificate is not None and plan.certificate.nearest_points is not None:
        ends = np.array(plan.certificate.nearest_points)
        drawn += [env.drawlinelist(ends, _PATH_WIDTH, _GAP_COLOUR), env.plot3(ends, _GAP_END, _GAP_COLOUR)]
    return drawn


def _segments(plan: Plan, nodes: Floats, lines: Sequence[tuple[int, int]]) -> Floats:
    """Sample the end-effector path along tree edges; return segment endpoints, shape (2 m, 3)."""
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
    """Return world positions, shape (n, 3), of the tool or, if there is no arm, of the last link's centre of mass."""
    if plan.arm is None:
        link = plan.robot.GetLinks()[-1]
        place = np.nan_to_num(link.GetLocalCOM())
    else:
        link, place = plan.arm.GetEndEffector(), plan.arm.GetLocalToolTransform()[:3, 3]
    assert link is not None
    positions: list[Floats] = []
    for start in range(0, len(values), _BATCH):
        T_world_links = plan.robot.batch_link_transforms(values[start : start + _BATCH])[:, link.GetIndex()]
        positions.append(T_world_links[:, :3, :3] @ place + T_world_links[:, :3, 3])
    return np.concatenate(positions)

"""HTML page of ``grasp``: hands side by side approach their targets and close; contacts are drawn.

If the arm reaches the grasps, a copy of the whole robot behind them shows the best one.
"""

from collections.abc import Sequence
from typing import NamedTuple, cast

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.graphics.rendering.camera import three_quarter_view
from ravemj.ik.candidates import ranked
from ravemj.manipulation.grasping.search import Grasp
from ravemj.rave import Environment, GraphHandle, KinBody, RaveCreateKinBody, RaveCreateRobot, Robot
from ravemj.rave.grasping import draw_grasp
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.recording import animate
from ravemj.trajectories.body_motion import BodyMotion

_POSE = IkParameterizationType.Transform6D
_COLUMNS = 5
_BACK = 0.12  # m, from which hands approach
_APPROACH, _CLOSE, _REST = 1.5, 1.0, 1.0  # s
_FPS = 20
_ASIDE = 0.6  # columns to the right, beside the notes
_DEPTH = 1.7  # distance of the rows, in distances of the columns
_TRANSPARENCY = 0.5  # of hands, so that contacts show
_STEPS = 12  # of the arm along the approach
_JUMP = 0.3  # rad or m, between two of them
_WIDER = 1.35  # of the view, to show the arm behind the hands
_BEHIND = 1.6  # distances of the columns, from the middle of the hands to that of the view
_LEGEND = (
    "arrows: contacts; red ones limit the quality",
    "double arrow: the weakest direction,",
    "pink for a force along it, violet for a torque about it",
)


class _DrawnHand(NamedTuple):
    """Copy of the robot of which only the hand is visible, at a grasp."""

    robot: Robot
    gripper: list[int]
    T_world_tool: Floats
    T_base_tool: Floats
    grasp: Grasp
    along: Floats


class _DrawnArm(NamedTuple):
    """Copy of the robot at a grasp; ``rows`` are arm configurations along the retreat from the grasp."""

    robot: Robot
    joints: list[int]
    gripper: list[int]
    rows: Floats
    grasp: Grasp


def write_grasps(path: str, arm: Manipulator, target: KinBody, grasps: Sequence[Grasp], notes: Sequence[str]) -> None:
    """Write a page with a hand for each grasp, in rows from left to right; later rows are nearer to the camera."""
    env = Environment()
    env.SetViewer("offscreen")  # which keeps drawings
    spacing, rows = 1.3 * _reach(arm, target), -(-len(grasps) // _COLUMNS)
    with_arm = grasps[0].arm is not None
    radius = spacing * max(1.0, min(len(grasps), _COLUMNS) / 2.2) * (_WIDER if with_arm else 1.0)
    camera = three_quarter_view(np.zeros(3), radius, 4 / 3)
    right, nearer = camera.rotation[:, 0], np.cross(camera.rotation[:, 0], [0, 0, 1])
    if with_arm:
        camera = three_quarter_view(-_BEHIND * spacing * nearer, radius, 4 / 3)
    hands, drawn = list[_DrawnHand](), list[GraphHandle]()
    for number, grasp in enumerate(grasps):
        row, column = divmod(number, _COLUMNS)
        T = target.GetTransform()
        across = (column - (min(len(grasps), _COLUMNS) - 1) / 2 + _ASIDE) * right
        T[:3, 3] = spacing * (across + _DEPTH * (row - (rows - 1) / 2) * nearer)
        body = _copied(env, target, number + 1)
        body.SetTransform(T)
        hands.append(_hand(env, arm, body, grasp, number + 1))
        drawn += draw_grasp(body, grasp)
    arms = list[_DrawnArm]()
    if with_arm:
        body = _copied(env, target, 0)
        T_place = target.GetTransform()
        T_place[:3, 3] = -spacing * _DEPTH * (rows + 1) / 2 * nearer
        body.SetTransform(T_place)
        arms.append(_arm(env, arm, body, target, grasps[0]))
        drawn += draw_grasp(body, grasps[0])
    motion = _motion(hands, arms)
    lines = [f"{number}: {_told(grasp)}" for number, grasp in enumerate(grasps, 1)]
    order = "from left to right, the first row is behind" + ("; the arm is number 1:" if with_arm else ":")
    animate(
        env,
        motion,
        fps=_FPS,
        camera=camera.T_world_camera,
        notes=[order, *lines, *_LEGEND, *notes],
    ).save(path)
    del drawn


def _told(grasp: Grasp) -> str:
    held = "" if grasp.proof is None else "; held" if grasp.proof.held else f"; lost after {grasp.proof.seconds:.1f} s"
    return f"quality {grasp.quality:.3f}, {grasp.weakness}{held}"


def _reach(arm: Manipulator, target: KinBody) -> float:
    """Return a radius around the target in which the hand moves [m]."""
    boxes = [link.ComputeAABB() for link in arm.GetChildLinks()]
    low = np.min([box.pos() - box.extents() for box in boxes], axis=0)
    high = np.max([box.pos() + box.extents() for box in boxes], axis=0)
    own = float(np.linalg.norm(target.ComputeAABB().extents()))
    return own + float(np.linalg.norm(high - low)) / 2


def _copied(env: Environment, body: KinBody, number: int) -> KinBody:
    copied = cast("KinBody", RaveCreateKinBody(env, ""))
    copied.Clone(body, 0)
    copied.SetName(f"{body.GetName()} {number}")
    env.Add(copied, True)
    return copied


def _hand(env: Environment, arm: Manipulator, target: KinBody, grasp: Grasp, number: int) -> _DrawnHand:
    robot = cast("Robot", RaveCreateRobot(env, ""))
    robot.Clone(arm.GetRobot(), 0)
    robot.SetName(f"{arm.GetRobot().GetName()} {number}")
    env.Add(robot, True)
    copied = next(manipulator for manipulator in robot.GetManipulators() if manipulator.GetName() == arm.GetName())
    shown = {link.GetIndex() for link in copied.GetChildLinks()}
    for link in robot.GetLinks():
        for geometry in link.GetGeometries():
            geometry.SetVisible(link.GetIndex() in shown)
            geometry.SetTransparency(_TRANSPARENCY)
    gripper = copied.GetGripperIndices().tolist()
    robot.SetDOFValues(grasp.preshape, gripper, checklimits=0)
    T_base_tool = inverse(robot.GetTransform()) @ copied.GetTransform()
    T_world_target = target.GetTransform()
    return _DrawnHand(
        robot, gripper, T_world_target @ grasp.pose, T_base_tool, grasp, T_world_target[:3, :3] @ grasp.approach
    )


def _arm(env: Environment, arm: Manipulator, body: KinBody, target: KinBody, grasp: Grasp) -> _DrawnArm:
    """Add a copy of the robot that approaches ``body``, a copy of the target; relative poses are as in the original."""
    T_world_target = body.GetTransform()
    robot = cast("Robot", RaveCreateRobot(env, ""))
    robot.Clone(arm.GetRobot(), 0)
    robot.SetName(f"{arm.GetRobot().GetName()} 0")
    env.Add(robot, True)
    robot.SetTransform(T_world_target @ inverse(target.GetTransform()) @ arm.GetRobot().GetTransform())
    copied = next(manipulator for manipulator in robot.GetManipulators() if manipulator.GetName() == arm.GetName())
    assert grasp.arm is not None, "the arm reaches it"
    rows = [grasp.arm]
    for back in np.linspace(0.0, _BACK, _STEPS + 1)[1:]:
        T = T_world_target @ grasp.pose
        T[:3, 3] -= back * T_world_target[:3, :3] @ grasp.approach
        solutions = ranked(arm.ik_solver(), copied.goals_in_base(T, _POSE)[0], rows[-1])
        near = [row for row, _ in solutions[:1] if np.abs(row - rows[-1]).max() < _JUMP]
        rows.append(near[0] if near else rows[-1])
    return _DrawnArm(robot, copied.GetArmIndices().tolist(), copied.GetGripperIndices().tolist(), np.array(rows), grasp)


def _motion(hands: Sequence[_DrawnHand], arms: Sequence[_DrawnArm]) -> BodyMotion:
    """Return the motion of all hands: to the target along a straight line, then the fingers close."""

    def place(time: float) -> None:
        back = _BACK * max(0.0, 1 - time / _APPROACH)
        share = min(1.0, max(0.0, (time - _APPROACH) / _CLOSE))
        for hand in hands:
            T = hand.T_world_tool.copy()
            T[:3, 3] -= back * hand.along
            hand.robot.SetTransform(T @ inverse(hand.T_base_tool))
            values = hand.grasp.preshape + share * (hand.grasp.closed - hand.grasp.preshape)
            hand.robot.SetDOFValues(values, hand.gripper, checklimits=0)
        for arm in arms:
            steps = np.arange(len(arm.rows)) * _BACK / _STEPS
            joints = np.array([np.interp(back, steps, column) for column in arm.rows.T], float)
            arm.robot.SetDOFValues(joints, arm.joints, checklimits=0)
            values = arm.grasp.preshape + share * (arm.grasp.closed - arm.grasp.preshape)
            arm.robot.SetDOFValues(values, arm.gripper, checklimits=0)

    robots = [shown.robot for shown in (*hands, *arms)]
    rows = tuple(robot.GetDOFValues()[None] for robot in robots)
    return BodyMotion(tuple(robot.simulation_state for robot in robots), _APPROACH + _CLOSE + _REST, place, rows)

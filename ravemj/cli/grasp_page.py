"""The page of ``grasp``: hands side by side that approach their target and close, with the contacts."""

from collections.abc import Sequence
from typing import NamedTuple, cast

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.graphics.rendering.camera import three_quarter_view
from ravemj.manipulation.grasping.search import Grasp
from ravemj.rave import Environment, GraphHandle, KinBody, RaveCreateKinBody, RaveCreateRobot, Robot
from ravemj.rave.grasping import draw_grasp
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.recording import animate
from ravemj.trajectories.body_motion import BodyMotion

_COLUMNS = 5
_BACK = 0.12  # m, from which hands approach
_APPROACH, _CLOSE, _REST = 1.5, 1.0, 1.0  # s
_FPS = 20
_ASIDE = 0.6  # columns to the right, beside the notes
_DEPTH = 1.7  # distance of the rows, in distances of the columns
_TRANSPARENCY = 0.5  # of hands, so that contacts show


class _DrawnHand(NamedTuple):
    """A copy of the robot, and its grasp."""

    robot: Robot
    gripper: list[int]
    T_world_tool: Floats
    T_base_tool: Floats
    grasp: Grasp
    along: Floats


def write_grasps(path: str, arm: Manipulator, target: KinBody, grasps: Sequence[Grasp], notes: Sequence[str]) -> None:
    """Write a page with a hand for each grasp, from left to right; the second row is in front."""
    env = Environment()
    env.SetViewer("offscreen")  # which keeps drawings
    spacing, rows = 1.3 * _reach(arm, target), -(-len(grasps) // _COLUMNS)
    camera = three_quarter_view(np.zeros(3), spacing * max(1.0, min(len(grasps), _COLUMNS) / 2.2), 4 / 3)
    right, nearer = camera.rotation[:, 0], np.cross(camera.rotation[:, 0], [0, 0, 1])
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
    motion = _motion(hands)
    lines = [f"{number}: {_told(grasp)}" for number, grasp in enumerate(grasps, 1)]
    animate(
        env,
        motion,
        fps=_FPS,
        camera=camera.T_world_camera,
        notes=["from left to right, the first row is behind:", *lines, *notes],
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
    """Add a copy of the robot of which only the hand is visible."""
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


def _motion(hands: Sequence[_DrawnHand]) -> BodyMotion:
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

    rows = tuple(hand.robot.GetDOFValues()[None] for hand in hands)
    return BodyMotion(tuple(hand.robot.simulation_state for hand in hands), _APPROACH + _CLOSE + _REST, place, rows)

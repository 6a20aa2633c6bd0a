"""The arguments of the commands that move arms: ``ik`` and ``plan``."""

import argparse

from ravemj.cli.argument_types import file_name, positive, seed, vector
from ravemj.cli.shared_options import (
    VIDEOS,
    Commands,
    add_manipulator,
    add_model,
    add_picture_options,
    add_robot,
    command,
)
from ravemj.geometry_functions.ik_types import GOAL_TYPES

_GOAL_TYPES = sorted(kind.name for kind in GOAL_TYPES)


def add_ik(commands: Commands) -> None:
    """Add ``ravemj ik``."""
    parser = command(
        commands,
        "ik.ik",
        "find the joint values that take the tool of an arm to a goal",
        'ravemj ik puma560 --to "0.3,0.3,0.9,0.7071,0,0.7071,0"',
        'ravemj ik puma560 --to "0.3,0.3,0.9,0.7071,0,0.7071,0" -o arms.png',
        'ravemj ik scara --to "0.3,0.2" --type TranslationXY2D --json',
        "ravemj ik panda --describe",
    )
    add_model(parser)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument(
        "--to",
        type=vector,
        metavar="GOAL",
        help="the goal in the world: x,y,z, or x,y,z,qw,qx,qy,qz, or the values of another type of goal; m and rad",
    )
    what.add_argument("--describe", action="store_true", help="say how the arm is solved, and how well that was proved")
    parser.add_argument(
        "--type",
        choices=_GOAL_TYPES,
        metavar="TYPE",
        help="type of goal, as in OpenRAVE: Translation3D for three values, else Transform6D; "
        f"or {', '.join(name for name in _GOAL_TYPES if name not in {'Transform6D', 'Translation3D'})}",
    )
    _add_arm_options(parser)
    parser.add_argument("--json", action="store_true", help="print all solutions as JSON, not the nearest ones alone")
    parser.add_argument(
        "-o",
        "--output",
        type=file_name,
        metavar="FILE",
        help="picture with an arm at each solution; .png, .jpg or .webp",
    )
    add_picture_options(parser, "size of the picture (640x480)")


def add_plan(commands: Commands) -> None:
    """Add ``ravemj plan``."""
    parser = command(
        commands,
        "plan.plan",
        "find a motion without collisions, and write it as a table, a page, a picture or a video",
        'ravemj plan puma560 --to "1.2,0.4,-0.3,0,0.5,0"',
        'ravemj plan puma560 --pose "0.3,0.3,0.9,0.7071,0,0.7071,0" -o plan.mp4',
        'ravemj plan workshop --manip panda_arm --to "1,0.6,0,-1.6,0,2.2,0.8" -o plan.csv',
        'ravemj plan workshop --robot scara --to "1.5,-2,0.1,0" -o plan.html',
        'ravemj plan scara --to "1.5,-2,0.1,0" -o trees.png --show-tree',
    )
    add_model(parser)
    goal = parser.add_mutually_exclusive_group(required=True)
    goal.add_argument(
        "--to",
        type=vector,
        metavar="Q",
        help="joint values of the goal, of the arm or of all joints of the robot: rad or m, separated by commas",
    )
    goal.add_argument(
        "--pose",
        type=vector,
        metavar="POSE",
        help="goal of the tool in the world: x,y,z,qw,qx,qy,qz, or x,y,z and any rotation; m",
    )
    _add_arm_options(parser)
    parser.add_argument(
        "-o",
        "--output",
        type=file_name,
        metavar="FILE",
        help="motion as .csv or .npz, which play takes; page that plays it as .html; picture of start, goal and way as "
        ".png or .jpg; or video as " + VIDEOS,
    )
    parser.add_argument(
        "--show-tree",
        action="store_true",
        help="draw where the trees of the planner take the hand: blue from the start, orange from the goal; a picture "
        "shows them also where no motion was found",
    )
    parser.add_argument("--time-limit", type=positive, default=10.0, metavar="S", help="seconds for the search (10)")
    parser.add_argument("--seed", type=seed, default=0, metavar="N", help="another number finds another motion (0)")
    parser.add_argument("--fps", type=positive, default=30.0, metavar="N", help="frames in a second (30)")
    add_picture_options(parser, "size of the picture or video (640x480)")


def _add_arm_options(parser: argparse.ArgumentParser) -> None:
    add_robot(parser, "robot that moves; default: the one of the manipulator, else the first")
    add_manipulator(parser)
    parser.add_argument(
        "--from",
        dest="start",
        type=file_name,
        metavar="FILE",
        help="joint values to start from, as JSON: a list, or an object with names of joints; default: the model's",
    )

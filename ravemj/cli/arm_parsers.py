"""Arguments of the commands that move arms: ``ik``, ``plan`` and ``grasp``."""

import argparse

from ravemj.cli.argument_types import file_name, limb_goal, names, positive, seed, tilt, vector
from ravemj.cli.shared_options import (
    VIDEOS,
    Commands,
    add_manipulator,
    add_model,
    add_picture_options,
    add_robot,
    add_robot_motion_options,
    add_start,
    command,
    complete_models,
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
        'ravemj ik biped --reach "left_hand=0.3,0.2,0.4" --keep left_foot,right_foot -o biped.png',
    )
    add_model(parser)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument(
        "--to",
        type=vector,
        metavar="GOAL",
        help="the goal in the world: x,y,z, or x,y,z,qw,qx,qy,qz, or the values of another type of goal; m and rad",
    )
    what.add_argument(
        "--reach",
        type=limb_goal,
        action="append",
        default=[],
        metavar="NAME=GOAL",
        help="a goal in the world for a manipulator or link, x,y,z or x,y,z,qw,qx,qy,qz; repeat it for several limbs",
    )
    what.add_argument("--describe", action="store_true", help="say how the arm is solved, and how well that was proved")
    parser.add_argument(
        "--type",
        choices=_GOAL_TYPES,
        metavar="TYPE",
        help="type of goal, as in OpenRAVE: Translation3D for three values, else Transform6D; "
        f"or {', '.join(name for name in _GOAL_TYPES if name not in {'Transform6D', 'Translation3D'})}",
    )
    parser.add_argument(
        "--keep",
        type=names,
        action="append",
        default=[],
        metavar="NAME,NAME",
        help="with --reach: manipulators or links that stay where they are; the base moves then, and the centre of "
        "mass stays above its place as far as the goals allow",
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
        'ravemj plan panda --near "0.4,0.3,0.5" --within 0.02 --upright -o plan.webp',
        'ravemj plan workshop --manip panda_arm --to "1,0.6,0,-1.6,0,2.2,0.8" -o plan.csv',
        'ravemj plan workshop --robot scara --to "1.5,-2,0.1,0" -o plan.html',
        'ravemj plan panda --to "1,0.6,0,-1.6,0,2.2,0.8" -o plan.ros2.yaml    # for the controller of a robot',
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
    goal.add_argument(
        "--near",
        type=vector,
        metavar="POINT",
        help="goal of the tool in the world: any pose near a point x,y,z; m",
    )
    goal.add_argument(
        "--region",
        type=file_name,
        metavar="FILE",
        help="goal of the tool: any pose of the regions in a JSON file: objects with T0_w, Tw_e, Bw, lean, frame (BODY "
        "or BODY/LINK), name and preshape, as of ravemj.Region",
    )
    parser.add_argument(
        "--within", type=positive, metavar="M", help="how far from --near the tool may be along x, y and z (0.01)"
    )
    parser.add_argument(
        "--upright",
        nargs="?",
        type=tilt,
        const=5.0,
        metavar="DEG",
        help="let the tool lean by at most so many degrees (5) from how it starts, at the goal and on the way; it may "
        "turn about the vertical",
    )
    _add_arm_options(parser)
    parser.add_argument(
        "-o",
        "--output",
        type=file_name,
        metavar="FILE",
        help="motion as .csv or .npz, which play takes; motion for a robot as .yaml or .json, ROS's JointTrajectory, "
        "or as .ros2.csv; page that plays it and says how it came about as .html; picture of start, goal and way as "
        ".png or .jpg; or video as " + VIDEOS,
    )
    parser.add_argument(
        "--show-tree",
        action="store_true",
        help="draw where the trees of the planner take the hand: blue from the start, orange from the goal; a picture "
        "shows them also where no motion was found",
    )
    parser.add_argument(
        "--certify",
        choices=["on", "required", "off"],
        default="on",
        help="prove that nothing touches at any time of the motion, not only where it is tested, and say so (on); "
        "required: a motion that is not proved is a failure",
    )
    parser.add_argument("--time-limit", type=positive, default=10.0, metavar="S", help="seconds for the search (10)")
    parser.add_argument("--seed", type=seed, default=0, metavar="N", help="another number finds another motion (0)")
    parser.add_argument("--fps", type=positive, default=30.0, metavar="N", help="frames in a second (30)")
    add_picture_options(parser, "size of the picture or video (640x480)")
    add_robot_motion_options(parser)


def add_grasp(commands: Commands) -> None:
    """Add ``ravemj grasp``."""
    parser = command(
        commands,
        "grasp.grasp",
        "find grasps of a body, and say why others fail",
        "ravemj grasp panda mug",
        "ravemj grasp panda box --method antipodal -o grasps.html",
        'ravemj grasp panda box --at "0.4,0.2,0.3" --friction 0.8',
    )
    add_model(parser)
    complete_models(
        parser.add_argument(
            "target",
            type=file_name,
            metavar="TARGET",
            help="what to grasp: a body of the model, a file, or a model that comes with ravemj, as mug or box",
        )
    )
    parser.add_argument(
        "--at",
        type=vector,
        metavar="POSE",
        help="pose of the target in the world: x,y,z or x,y,z,qw,qx,qy,qz; m. Default: a body of the model is where it "
        "is, and others stand on the floor, 0.5 m before the base",
    )
    add_robot(parser, "robot that grasps; default: the one of the manipulator, else the first")
    add_manipulator(parser)
    parser.add_argument(
        "--method",
        choices=["fly", "antipodal"],
        default="fly",
        help="fly: the hand moves along rays until it touches, and closes (the default); antipodal: parallel jaws "
        "close on opposite points",
    )
    parser.add_argument(
        "--friction", type=positive, default=0.4, metavar="MU", help="friction coefficient of hand and target (0.4)"
    )
    parser.add_argument(
        "-o", "--output", type=file_name, metavar="FILE", help="page with the ten best grasps and their contacts; .html"
    )


def _add_arm_options(parser: argparse.ArgumentParser) -> None:
    add_robot(parser, "robot that moves; default: the one of the manipulator, else the first")
    add_manipulator(parser)
    add_start(
        parser,
        "joint values to start from, as JSON: a list, or an object with names of joints, as ravemj mirror --save-state "
        "writes it; default: the model's",
    )

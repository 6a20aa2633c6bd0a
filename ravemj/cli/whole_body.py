"""``ravemj ik --reach``: whole-body inverse kinematics with several limbs and a moving base."""

import argparse
import json
import math

from ravemj.cli.arms import pose_goal, start_values
from ravemj.cli.console import console, table
from ravemj.cli.models import chosen_robots, load_model
from ravemj.cli.pictures import picture_of
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering.camera_file import read_camera
from ravemj.graphics.video import write_picture
from ravemj.rave import Environment, Robot
from ravemj.rave.whole_body import WholeBodyIK, WholeBodyResult

_SIZES = (3, 7)
_MOST_STEPS = 1000
_BALANCE = 1e-5
"""Weight of the centre-of-mass task, too small to affect whether goals are within tolerance."""
_BASE_ROW = "base x,y,z,qw,qx,qy,qz"


def reach(options: argparse.Namespace) -> int:
    """Show joint values that move limbs to their goals while others stay; return 1 if some goals are not reached."""
    env = load_model(options)
    robot = chosen_robots(env, options.robot)[0]
    if options.start is not None:
        robot.SetDOFValues(start_values(options.start, robot))
    result = _solved(robot, options)
    if options.json:
        print(json.dumps(_entry(robot, result), indent=1))
    else:
        _print(robot, result, moves_base=bool(options.keep))
    if options.output is not None:
        _draw(env, options)
        print(f"wrote {options.output}")
    return 0 if result.converged else 1


def _solved(robot: Robot, options: argparse.Namespace) -> WholeBodyResult:
    """Solve and move the robot.

    With ``--keep``, the named frames stay in contact, the base is free, and the centre of mass keeps its x and y.
    """
    kept = [name for names in options.keep for name in names]
    ik = WholeBodyIK(robot, base=bool(kept))
    for name in kept:
        ik.add_contact(name)
    for name, numbers in options.reach:
        if len(numbers) not in _SIZES:
            raise ArgumentError(
                f"--reach: found {len(numbers)} values for '{name}', expected x,y,z or x,y,z,qw,qx,qy,qz"
            )
        ik.add_reach(name, numbers if len(numbers) == 3 else pose_goal(numbers, "--reach"))
    if kept:
        balance = ik.add_com(axes="xy", weight=_BALANCE)
        balance.task.tolerance = math.inf
    ik.add_posture()
    return ik.solve(_MOST_STEPS)


def _entry(robot: Robot, result: WholeBodyResult) -> dict[str, object]:
    """Return a result as JSON data; the keys are stable."""
    return {
        "converged": result.converged,
        "reason": result.reason,
        "values": robot.GetDOFValues().tolist(),
        "base": _base(robot),
        "residuals": {name: error.tolist() for name, error in result.residuals.items()},
    }


def _base(robot: Robot) -> list[float]:
    """Return the pose of the first link, x, y, z, qw, qx, qy, qz."""
    pose: Floats = robot.GetTransformPose()
    return [*pose[4:].tolist(), *pose[:4].tolist()]


def _print(robot: Robot, result: WholeBodyResult, *, moves_base: bool) -> None:
    rows = table(f"Joint values of '{robot.GetName()}'", "joint", "value>")
    for joint in robot.GetJoints():
        for value in joint.GetValues():
            rows.add_row(joint.GetName(), f"{round(value, 3) + 0.0:.3f}")
    console().print(rows)
    if moves_base:
        print(f"{_BASE_ROW}: {','.join(f'{round(number, 3) + 0.0:.3f}' for number in _base(robot))}")
    print("all goals are met" if result.converged else result.reason)


def _draw(env: Environment, options: argparse.Namespace) -> None:
    camera = None if options.camera is None else read_camera(options.camera).T_world_camera
    write_picture(options.output, picture_of(options, env, camera))

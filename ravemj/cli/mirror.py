"""The command ``mirror``."""

import argparse
import json
import os
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ravemj.cli.arms import add_ghost
from ravemj.cli.models import load_model, moving_robot
from ravemj.cli.robot_motions import motion_file, robot_names
from ravemj.cli.view import show
from ravemj.core.output import check_file, new_file
from ravemj.core.transforms import Floats
from ravemj.errors import Source, SourceError
from ravemj.gui.viewers import Viewer
from ravemj.rave import Environment, Robot
from ravemj.rave.enums import CheckLimitsAction
from ravemj.robots.joint_states import JointStates, check_url, follow_rosbridge, read_lines
from ravemj.trajectories.motion import Motion
from ravemj.trajectories.motion_arguments import followed_file
from ravemj.trajectories.motion_writing import check_motion_file, write_motion

_STANDARD_INPUT = "-"
"""File name that means standard input."""

_PERIOD = 1 / 30
"""Update period of the view, and minimum period of rosbridge messages [s]."""


def mirror(options: argparse.Namespace) -> int:
    """Show the live state of a real robot; at the end save the recorded states."""
    if options.rosbridge is not None:
        check_url(options.rosbridge)
    if options.record is not None:
        check_motion_file(options.record)
    if options.save_state is not None:
        check_file(options.save_state)
    env = load_model(options)
    robot = moving_robot(env, options.robot)
    scene = robot.simulation_state.scene
    names = {new: old for old, new in robot_names(options.rename, robot).items()}
    others, records = [joint.name for joint in scene.all_joints], options.record is not None
    states = JointStates(scene.dof_names, others, names, _say, records=records)
    ghost_motion = None if options.trajectory is None else _ghost_motion(env, robot, options)
    threading.Thread(target=_source(states, options), name="ravemj-states", daemon=True).start()

    def work_for(viewer: Viewer) -> Callable[[], None]:
        viewer.interaction.forbid_drags()
        if ghost_motion is not None:
            viewer.play(ghost_motion[1], robot=ghost_motion[0])
        return lambda: _update(robot, states)

    try:
        show(env, None, options, work_for, _PERIOD)
    finally:
        _save(states, options)
    return 0


def _say(text: str) -> None:
    print(f"ravemj: {text}", file=sys.stderr, flush=True)


def _source(states: JointStates, options: argparse.Namespace) -> Callable[[], None]:
    """Return the function that receives joint states in a thread; raise if the CSV file cannot be read."""
    if options.rosbridge is not None:
        return lambda: follow_rosbridge(options.rosbridge, options.topic, _PERIOD, states, _say)
    is_input = options.csv == _STANDARD_INPUT
    if not is_input and not os.access(options.csv, os.R_OK):
        raise SourceError("cannot read the file: it is missing, or there is no permission", Source(options.csv))

    def read() -> None:
        with open(sys.stdin.fileno() if is_input else options.csv, encoding="utf-8", errors="replace") as lines:
            read_lines(lines, states)
        _say("the lines have ended; the mirror shows the last state")

    return read


def _update(robot: Robot, states: JointStates) -> None:
    """Set the robot to the latest joint state, which may exceed the joint limits."""
    values = states.pop()
    if values:
        names = robot.simulation_state.scene.dof_names
        with robot.GetEnv():
            robot.SetDOFValues(list(values.values()), [names.index(name) for name in values], CheckLimitsAction.Nothing)


def _ghost_motion(env: Environment, robot: Robot, options: argparse.Namespace) -> tuple[Robot, Motion]:
    """Add a transparent copy of the robot; return the copy and its motion, read from the file in the options."""
    followed, dofs = followed_file(env.simulation, motion_file(env, options)), range(robot.GetDOF())
    before, rows = robot.GetDOFValues(), list[Floats]()
    times = list(followed.frame_times(1 / _PERIOD))
    for time in times:
        followed.place(time)
        rows.append(robot.GetDOFValues())
    robot.SetDOFValues(before)
    add_ghost(robot, 2, rows[0], dofs)
    return env.GetRobots()[-1], Motion(times, np.array(rows))


def _save(states: JointStates, options: argparse.Namespace) -> None:
    """Write the requested recording, and report skipped messages."""
    for trouble, count in states.skipped.items():
        _say(f"skipped {count} messages: {trouble}")
    came, values = states.motion(), states.values
    if not values and (options.record or options.save_state):
        _say("no state came, so nothing is saved")
    if came is not None:
        print(f"wrote {write_motion(options.record, *came)}")
    if values and options.save_state is not None:
        with new_file(options.save_state) as file:
            file.write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
        print(f"wrote {Path(options.save_state)}")

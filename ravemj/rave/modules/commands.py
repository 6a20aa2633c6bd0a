"""Text commands of the modules, and the parsing of their arguments."""

import logging
from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import matrixFromPose
from ravemj.manipulation.grasps import GraspTable
from ravemj.manipulation.options import (
    Certify,
    GraspMotion,
    JitterMotion,
    JointMotion,
    StraightMotion,
    ToolMotion,
    UnsyncMotion,
    chosen,
)
from ravemj.rave.interface import Command, Module
from ravemj.rave.kinbody import KinBody
from ravemj.rave.modules.base_manipulation import (
    BaseManipulation,
    Manipulation,
    Options,
    constraint_of,
    tool_constraints,
)
from ravemj.rave.modules.task_manipulation import GraspQuery, TaskManipulation, finger_steps
from ravemj.rave.planning.planner import PlanningError
from ravemj.rave.planning.region_goals import MotionSets
from ravemj.rave.specification import IkParameterization
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.serialization import AS_TEXT

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

_LOG = logging.getLogger("ravemj")


class Tokens:
    """Token stream of a command line.

    Attributes:
        words: The remaining tokens.
    """

    def __init__(self, text: str) -> None:
        self.words = text.split()

    def next(self, wanted: str = "a word") -> str:
        """Return the next token.

        Raises:
            ArgumentError: no token is left.
        """
        if not self.words:
            raise ArgumentError(f"the text ends where {wanted} should follow")
        return self.words.pop(0)

    def __bool__(self) -> bool:
        return bool(self.words)

    def number(self) -> float:
        """Return the next token as a number.

        Raises:
            ArgumentError: the token is not a number.
        """
        word = self.next("a number")
        try:
            return float(word)
        except ValueError:
            raise ArgumentError(f"'{word}' should be a number") from None

    def integer(self) -> int:
        """Return the next token as an integer."""
        number = self.number()
        if not number.is_integer():
            raise ArgumentError(f"{number:g} should be a whole number")
        return int(number)

    def count(self) -> int:
        """Return the next token as a non-negative count."""
        count = self.integer()
        if count < 0:
            raise ArgumentError(f"{count} should be how many follow, 0 or more")
        return count

    def numbers(self, count: int) -> Floats:
        """Return the next tokens as numbers, shape (count,)."""
        return np.array([self.number() for _ in range(count)])

    def rows(self, width: int) -> Floats:
        """Return rows of numbers, shape (n, width), preceded by their count."""
        return self.numbers(self.count() * width).reshape(-1, width)

    def list(self) -> Floats:
        """Return numbers, shape (n,), preceded by their count."""
        return self.numbers(self.count())

    def matrix(self) -> Floats:
        """Return a pose, shape (4, 4), from OpenRAVE's 12 numbers in column order."""
        pose = np.eye(4)
        pose[:3] = self.numbers(12).reshape(4, 3).T
        return pose


Reader = Callable[[Tokens], Any]


def read_options(text: str, readers: Mapping[str, Reader]) -> dict[str, Any]:
    """Parse options: names, each followed by the tokens that its reader consumes.

    Raises:
        ArgumentError: an option is unknown, or is followed by wrong tokens.
    """
    tokens, values = Tokens(text), dict[str, Any]()
    while tokens:
        name = tokens.next().lower()
        if name not in readers:
            raise ArgumentError(f"the command has no argument '{name}'; it takes {', '.join(readers) or 'none'}")
        try:
            values[name] = readers[name](tokens)
        except ArgumentError as error:
            raise ArgumentError(f"{name}: {error.message}") from None
    return values


def switch(tokens: Tokens) -> bool:
    """Return True for an option without a value."""
    del tokens
    return True


def flag(tokens: Tokens) -> bool:
    """Return whether the next token is not 0."""
    return bool(tokens.number())


def text(tokens: Tokens) -> str:
    """Return the next token."""
    return tokens.next()


def _certify(tokens: Tokens) -> Certify:
    word = tokens.next()
    return "required" if word == "required" else word != "0"


_READERS: Mapping[object, Reader] = {
    int: Tokens.integer,
    float: Tokens.number,
    bool: flag,
    str: text,
    Certify: _certify,
}


def readers_of(kind: type) -> dict[str, Reader]:
    """Return a reader for each field of an options class, selected by the type of the field."""
    return {row.name: _READERS[row.type] for row in fields(kind)}


def scene_module(env: "Environment", xmlid: str) -> Module:
    """Make a module that saves all bodies of an environment."""

    def savescene(arguments: str) -> str:
        """Save all bodies as OpenRAVE XML: ``savescene filename F``; meshes go into the folder ``meshes`` beside F."""
        options = read_options(arguments, {"filename": text})
        if not options:
            raise ArgumentError("savescene: give the file: savescene filename F")
        env.Save(options["filename"], atts={"format": "openrave"})
        return ""

    return Module(env, xmlid, lambda arguments: None, {"savescene": savescene})


Kind = TypeVar("Kind", bound=Manipulation)

_OUTPUT: Mapping[str, Reader] = {"execute": flag, "outputtraj": switch}
_SEARCH: Mapping[str, Reader] = {
    **readers_of(JointMotion),
    **_OUTPUT,
}


def commands_of(manipulation: Kind, commands: Mapping[str, Callable[[Kind, str], str | None]]) -> dict[str, Command]:
    """Return the commands of one robot. Like OpenRAVE's, they return None if no motion is found."""

    def bound(command: Callable[[Kind, str], str | None]) -> Command:
        @wraps(command)
        def run(arguments: str) -> str | None:
            try:
                return command(manipulation, arguments)
            except PlanningError:
                return None

        return run

    return {name: bound(command) for name, command in commands.items()}


def _reply(manipulation: Manipulation, traj: Trajectory, options: Options, before: str = "") -> str:
    """Execute a motion unless the options forbid it; return the command's answer, which begins with ``before``."""
    if options.get("execute", True):
        manipulation.execute(traj)
    return before + (traj.serialize(AS_TEXT).decode() if options.get("outputtraj") else "")


def _final_and_reply(manipulation: Manipulation, motion: tuple[Floats, Trajectory], options: Options) -> str:
    return _reply(manipulation, motion[1], options, _text(motion[0]) if options.get("outputfinal") else "")


def some(options: Options, *names: str) -> dict[str, Any]:
    """Return the options with the given names, if they are set."""
    return {name: options[name] for name in names if name in options}


def _set_robot(manipulation: Manipulation, arguments: str) -> str | None:
    """Select the robot by name."""
    return "" if manipulation.choose(arguments.strip()) else None


def _named_body(manipulation: Manipulation, name: str) -> KinBody | None:
    """Return a body of the environment by name; log a warning if there is none."""
    body = manipulation.env.GetKinBody(name)
    if body is None:
        known = ", ".join(f"'{known_body.GetName()}'" for known_body in manipulation.env.GetBodies())
        _LOG.warning("there is no body '%s', only %s", name, known)
    return body


def _grab_body(manipulation: Manipulation, arguments: str) -> str | None:
    """Grab a body with the active manipulator: ``GrabBody name B``."""
    options = read_options(arguments, {"name": text})
    if "name" not in options:
        raise ArgumentError("GrabBody: give the body: GrabBody name B")
    body = _named_body(manipulation, options["name"])
    return "" if body is not None and manipulation.robot.Grab(body) else None


def _release_all(manipulation: Manipulation, arguments: str) -> str:
    """Release all bodies that the robot grabs."""
    read_options(arguments, {})
    manipulation.robot.ReleaseAllGrabbed()
    return ""


_GRABBING: Mapping[str, Callable[[Manipulation, str], str | None]] = {
    "GrabBody": _grab_body,
    "ReleaseAll": _release_all,
}


def _move_active_joints(base: BaseManipulation, arguments: str) -> str:
    """Move the active DOFs to one of several goals without collisions."""
    dof = base.robot.GetActiveDOF()
    readers = {**_SEARCH, **_goals(dof), "initialconfigs": _rows(dof), "postprocessingplanner": text}
    options = read_options(arguments, readers)
    goals, starts = [*options.get("goal", ()), *options.get("goals", ())], options.get("initialconfigs", ())
    post = (options["postprocessingplanner"], "") if "postprocessingplanner" in options else None
    traj = base.move_joints(goals, chosen(JointMotion, options), starts=starts, postprocessing=post)
    return _reply(base, traj, options)


def _move_manipulator(base: BaseManipulation, arguments: str) -> str:
    """Move the active manipulator's arm to one of several goals without collisions."""
    options = read_options(arguments, {**_SEARCH, **_goals(base.arm().GetArmDOF())})
    goals = [*options.get("goal", ()), *options.get("goals", ())]
    return _reply(base, base.move_manipulator(goals, chosen(JointMotion, options)), options)


def _move_to_hand_position(base: BaseManipulation, arguments: str) -> str:
    """Move the active manipulator's tool to one of several poses without collisions."""
    readers: dict[str, Reader] = {**_SEARCH, **_TOOL_GOAL}
    readers |= {name: _several(_TOOL_GOAL[kind]) for name, kind in _TOOL_GOALS.items()}
    readers |= {"goalmaxsamples": Tokens.integer, **readers_of(ToolMotion)}
    readers |= dict.fromkeys(("goalmaxtries", "minimumgoalpaths"), Tokens.number)
    readers |= {"initialconfigs": _rows(base.arm().GetArmDOF())}
    options = read_options(arguments, {**readers, **_CONSTRAINT})
    goals = [options[name] for name in _TOOL_GOAL if name in options]
    goals += [goal for name in _TOOL_GOALS for goal in options.get(name, ())]
    if "goalmaxsamples" in options:
        options.setdefault("goalsamples", options["goalmaxsamples"])
    starts, sets = options.get("initialconfigs", ()), MotionSets(constraints=tool_constraints(options))
    traj = base.move_to_hand_position(goals, chosen(ToolMotion, options), sets=sets, starts=starts)
    return _reply(base, traj, options, "1 " if options.get("outputtraj") else "1")


def _move_hand_straight(base: BaseManipulation, arguments: str) -> str:
    """Move the active manipulator's tool along a straight line."""
    readers: dict[str, Reader] = {**_OUTPUT, "direction": lambda tokens: tokens.numbers(3), "greedysearch": flag}
    readers |= {**readers_of(StraightMotion), "starteematrix": Tokens.matrix}
    readers |= dict.fromkeys(("maxdeviationangle", "steplength"), Tokens.number)
    options = read_options(arguments, {**readers, "planner": text})
    direction, start = options.get("direction", np.zeros(3)), options.get("starteematrix")
    return _reply(base, base.move_hand_straight(direction, chosen(StraightMotion, options), start), options)


def _move_unsync_joints(base: BaseManipulation, arguments: str) -> str:
    """Move the active DOFs to a configuration at which other joints can move to given values without collisions."""
    readers: dict[str, Reader] = {**_OUTPUT, "handjoints": _hand, **readers_of(UnsyncMotion)}
    options = read_options(arguments, readers)
    hand, indices = options.get("handjoints", (np.zeros(0), []))
    return _reply(base, base.move_unsync_joints(hand, indices, chosen(UnsyncMotion, options)), options)


def _jitter_active(base: BaseManipulation, arguments: str) -> str:
    """Move the active DOFs slightly, out of collision."""
    options = read_options(arguments, {**_OUTPUT, **readers_of(JitterMotion), "outputfinal": switch})
    return _final_and_reply(base, base.jitter_active(chosen(JitterMotion, options)), options)


def _set_minimum_goal_paths(module: BaseManipulation | TaskManipulation, arguments: str) -> str:
    """Accept a minimum number of goal paths to compare, which has no effect: ravemj returns the first path."""
    del module
    Tokens(arguments).count()
    return ""


BASE_COMMANDS: Mapping[str, Callable[[BaseManipulation, str], str | None]] = {
    "MoveActiveJoints": _move_active_joints,
    "MoveManipulator": _move_manipulator,
    "MoveToHandPosition": _move_to_hand_position,
    "MoveHandStraight": _move_hand_straight,
    "MoveUnsyncJoints": _move_unsync_joints,
    "JitterActive": _jitter_active,
    "SetMinimumGoalPaths": _set_minimum_goal_paths,
    **_GRABBING,
    "SetRobot": _set_robot,
}
"""The commands of ``BaseManipulation``."""


def _gripper_options(task: TaskManipulation, arguments: str) -> dict[str, Any]:
    manip = task.robot.GetActiveManipulator()
    dof = manip.GetGripperDOF() if manip else 0
    readers: dict[str, Reader] = {**_OUTPUT, "outputfinal": switch, "target": text}
    readers |= dict.fromkeys(("movingdir", "offset"), lambda tokens: tokens.numbers(dof))
    readers |= dict.fromkeys(("coarsestep", "finestep", "translationstepmult"), Tokens.number)
    return read_options(arguments, readers)


def _close_fingers(task: TaskManipulation, arguments: str) -> str:
    """Close the gripper until its fingers touch something."""
    options = _gripper_options(task, arguments)
    motion = task.close_fingers(options.get("movingdir"), options.get("offset"), finger_steps(options))
    return _final_and_reply(task, motion, options)


def _release_fingers(task: TaskManipulation, arguments: str) -> str:
    """Open the gripper, and release the grabbed body that the arguments name, if any."""
    options = _gripper_options(task, arguments)
    target = _named_body(task, options["target"]) if "target" in options else None
    motion = task.release_fingers(options.get("movingdir"), target, finger_steps(options))
    return _final_and_reply(task, motion, options)


def _release_active(task: TaskManipulation, arguments: str) -> str:
    """Move the active joints in one direction until they touch something."""
    dof = task.robot.GetActiveDOF()
    readers: dict[str, Reader] = {**_OUTPUT, "outputfinal": switch, "movingdir": lambda tokens: tokens.numbers(dof)}
    readers |= dict.fromkeys(("finestep", "translationstepmult"), Tokens.number)
    options = read_options(arguments, readers)
    return _final_and_reply(task, task.release_active(options.get("movingdir", np.zeros(dof))), options)


def _grasp_planning(task: TaskManipulation, arguments: str) -> str:
    """Move the arm to one of given grasps."""
    options = read_options(arguments, {**_GRASPS, **_OUTPUT})
    target = task.env.GetKinBody(options.get("target", ""))
    if target is None:
        raise PlanningError(f"there is no body '{options.get('target', '')}'")
    indices, places = some(options, *GRASP_COLUMNS), [*options.get("posedests", ()), *options.get("matdests", ())]
    grasps = options.get("grasps", np.zeros((0, 0)))
    plan = task.plan_grasp(GraspQuery(target, GraspTable(grasps, indices), places, chosen(GraspMotion, options)))
    goals = "".join(f"{goal} " for goal in plan.goals)
    return _reply(task, plan.traj, options, f"{len(plan.goals)} {goals}{plan.number} {plan.seconds!r} ")


def _evaluate_constraints(task: TaskManipulation, arguments: str) -> str:
    """Project configurations onto a tool constraint, and return the number of steps for each."""
    dof = task.robot.GetActiveDOF()
    configurations: list[Floats] = []
    config: Mapping[str, Reader] = {"config": lambda tokens: configurations.append(tokens.numbers(dof))}
    options = {"constraintfreedoms": np.ones(6), "constrainttaskpose": np.eye(4)}
    options |= read_options(arguments, {**_CONSTRAINT, **config})
    steps, rows = task.evaluate_constraints(constraint_of(options), configurations)
    return " ".join(map(str, steps)) + " " + "".join(map(_text, rows))


TASK_COMMANDS: Mapping[str, Callable[[TaskManipulation, str], str | None]] = {
    **dict.fromkeys(("CloseFingers", "ChuckFingers"), _close_fingers),
    **dict.fromkeys(("ReleaseFingers", "UnchuckFingers"), _release_fingers),
    "ReleaseActive": _release_active,
    "GraspPlanning": _grasp_planning,
    "EvaluateConstraints": _evaluate_constraints,
    **_GRABBING,
    "SetMinimumGoalPaths": _set_minimum_goal_paths,
    "SetRobot": _set_robot,
}
"""The commands of ``TaskManipulation``."""


def _goals(dof: int) -> dict[str, Reader]:
    return {"goal": lambda tokens: [tokens.numbers(dof)], "goals": _rows(dof)}


def _rows(dof: int) -> Reader:
    return lambda tokens: tokens.rows(dof)


def _pose(tokens: Tokens) -> Floats:
    return matrixFromPose(tokens.numbers(7))


def _several(reader: Reader) -> Reader:
    """Return a reader of a list, preceded by its count."""
    return lambda tokens: [reader(tokens) for _ in range(tokens.count())]


def _table(tokens: Tokens) -> Floats:
    rows, width = tokens.count(), tokens.count()
    return tokens.numbers(rows * width).reshape(rows, width)


def _hand(tokens: Tokens) -> tuple[Floats, list[int]]:
    count = tokens.count()
    return tokens.numbers(count), [tokens.integer() for _ in range(count)]


def _text(values: Floats) -> str:
    return " ".join(repr(value) for value in values.tolist()) + " "


_KIND = IkParameterization.Type

_TOOL_GOAL: Mapping[str, Callable[[Tokens], IkParameterization]] = {
    "matrix": lambda tokens: IkParameterization(tokens.matrix(), _KIND.Transform6D),
    "pose": lambda tokens: IkParameterization(_pose(tokens), _KIND.Transform6D),
    "translation": lambda tokens: IkParameterization(tokens.numbers(3), _KIND.Translation3D),
    "rotation": lambda tokens: IkParameterization(tokens.numbers(4), _KIND.Rotation3D),
    "ikparam": lambda tokens: IkParameterization.take(tokens.words),
}
"""Readers of options with one tool goal."""

_TOOL_GOALS = {"matrices": "matrix", "poses": "pose", "ikparams": "ikparam"}
"""For each option with a list of tool goals, the option with one such goal."""

_CONSTRAINT: Mapping[str, Reader] = {
    **dict.fromkeys(("constraintmatrix", "constrainttaskmatrix"), Tokens.matrix),
    **dict.fromkeys(("constraintpose", "constrainttaskpose"), _pose),
    **{"constraintfreedoms": lambda tokens: tokens.numbers(6), "constrainterrorthresh": Tokens.number},
}
"""Readers of the options of a tool constraint."""

GRASP_COLUMNS = (
    *("igrasptrans", "grasptrans_nocol", "igraspdir", "imanipulatordirection", "igrasppreshape"),
    *("igrasppos", "igrasproll", "igraspstandoff", "ichuckingdirection"),
)
"""Column names of a grasp table; the last four are only for rows without a tool pose, whose grasps are simulated."""

_GRASPS: Mapping[str, Reader] = {
    **dict.fromkeys(GRASP_COLUMNS, Tokens.integer),
    **readers_of(GraspMotion),
    **{"grasps": _table, "target": text, "posedests": _several(_pose), "matdests": _several(Tokens.matrix)},
}

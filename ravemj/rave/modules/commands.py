"""The commands of the modules for manipulation, as text."""

from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import wraps
from typing import Any, TypeVar

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import matrixFromPose
from ravemj.rave.module import Command
from ravemj.rave.modules.base_manipulation import HAND_SEARCH, BaseManipulation
from ravemj.rave.modules.grasp_planning import GraspQuery
from ravemj.rave.modules.motions import Manipulation, SearchOptions
from ravemj.rave.modules.task_manipulation import TaskManipulation
from ravemj.rave.modules.tokens import Reader, Tokens, flag, read_options, switch, text
from ravemj.rave.planning.hand import ToolConstraint
from ravemj.rave.planning.status import PlanningError
from ravemj.rave.specification import IkParameterization
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.serialization import AS_TEXT

Kind = TypeVar("Kind", bound=Manipulation)
Options = Mapping[str, Any]

_OUTPUT: Mapping[str, Reader] = {"execute": flag, "outputtraj": switch}
_SEARCH: Mapping[str, Reader] = {
    **{"maxiter": Tokens.integer, "maxtries": Tokens.integer, "jitter": Tokens.number, "steplength": Tokens.number},
    **_OUTPUT,
}


def commands_of(manipulation: Kind, commands: Mapping[str, Callable[[Kind, str], str | None]]) -> dict[str, Command]:
    """Return the commands for one robot. They return None if no motion is found, as OpenRAVE's do."""

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
    """Execute a motion if the options do not forbid it, and return the answer of the command."""
    if options.get("execute", True):
        manipulation.execute(traj)
    return before + (traj.serialize(AS_TEXT).decode() if options.get("outputtraj") else "")


def _final_and_reply(manipulation: Manipulation, found: tuple[Floats, Trajectory], options: Options) -> str:
    return _reply(manipulation, found[1], options, _text(found[0]) if options.get("outputfinal") else "")


def _some(options: Options, *names: str) -> dict[str, Any]:
    return {name: options[name] for name in names if name in options}


def search_options(options: Options, default: SearchOptions) -> SearchOptions:
    """Return the effort of a search that options ask for."""
    given = _some(options, "maxiter", "maxtries", "jitter", "steplength")
    return default._replace(**given, constraint=_tool_constraint(options))


def _tool_constraint(options: Options) -> ToolConstraint | None:
    """Return the constraint of the tool that options of a motion ask for; None where they leave it free."""
    given = [name for name in options if name in _CONSTRAINT]
    if given and "constraintfreedoms" not in given:
        raise ArgumentError(f"{given[0]} needs constraintfreedoms, which say what the constraint holds")
    return _constraint(options) if given and np.any(options["constraintfreedoms"]) else None


def _constraint(options: Options) -> ToolConstraint:
    frame = options.get("constraintmatrix", options.get("constraintpose", np.eye(4)))
    point = options.get("constrainttaskmatrix", options.get("constrainttaskpose"))
    return ToolConstraint(frame, point, options["constraintfreedoms"], options.get("constrainterrorthresh", 1e-3))


def _set_robot(manipulation: Manipulation, arguments: str) -> str | None:
    """Chooses the robot by its name."""
    return "" if manipulation.choose(arguments.strip()) else None


def _move_active_joints(base: BaseManipulation, arguments: str) -> str:
    """Moves the active DOFs to one of several goals without collisions."""
    dof = base.robot.GetActiveDOF()
    readers = {**_SEARCH, **_goals(dof), "initialconfigs": _rows(dof), "postprocessingplanner": text}
    options = read_options(arguments, readers)
    goals, starts = [*options.get("goal", ()), *options.get("goals", ())], options.get("initialconfigs", ())
    post = (options["postprocessingplanner"], "") if "postprocessingplanner" in options else None
    search = search_options(options, SearchOptions())
    return _reply(base, base.move_active_joints(goals, search, starts=starts, postprocessing=post), options)


def _move_manipulator(base: BaseManipulation, arguments: str) -> str:
    """Moves the arm of the active manipulator to one of several goals without collisions."""
    options = read_options(arguments, {**_SEARCH, **_goals(base.arm().GetArmDOF())})
    goals = [*options.get("goal", ()), *options.get("goals", ())]
    return _reply(base, base.move_manipulator(goals, search_options(options, SearchOptions())), options)


def _move_to_hand_position(base: BaseManipulation, arguments: str) -> str:
    """Moves the tool of the active manipulator to one of several poses without collisions."""
    readers: dict[str, Reader] = {**_SEARCH, **_TOOL_GOAL}
    readers |= {name: _several(_TOOL_GOAL[one]) for name, one in _TOOL_GOALS.items()}
    readers |= dict.fromkeys(("goalsamples", "goalmaxsamples", "seedik"), Tokens.integer)
    readers |= dict.fromkeys(("goalsampleprob", "goalmaxtries", "minimumgoalpaths"), Tokens.number)
    readers |= {"initialconfigs": _rows(base.arm().GetArmDOF())}
    options = read_options(arguments, {**readers, **_CONSTRAINT})
    goals = [options[name] for name in _TOOL_GOAL if name in options]
    goals += [goal for name in _TOOL_GOALS for goal in options.get(name, ())]
    if "goalmaxsamples" in options:
        options.setdefault("goalsamples", options["goalmaxsamples"])
    given = _some(options, "seedik", "goalsamples", "goalsampleprob")
    starts, search = options.get("initialconfigs", ()), search_options(options, HAND_SEARCH)
    traj = base.move_to_hand_position(goals, search, starts=starts, **given)
    return _reply(base, traj, options, "1 " if options.get("outputtraj") else "1")


def _move_hand_straight(base: BaseManipulation, arguments: str) -> str:
    """Moves the tool of the active manipulator along a straight line."""
    readers: dict[str, Reader] = {**_OUTPUT, "direction": lambda tokens: tokens.numbers(3), "greedysearch": flag}
    readers |= {"minsteps": Tokens.integer, "maxsteps": Tokens.integer, "starteematrix": Tokens.matrix}
    readers |= dict.fromkeys(("stepsize", "ignorefirstcollision", "maxdeviationangle", "steplength"), Tokens.number)
    options = read_options(arguments, {**readers, "planner": text})
    given = _some(options, "stepsize", "minsteps", "maxsteps", "starteematrix", "ignorefirstcollision")
    return _reply(base, base.move_hand_straight(options.get("direction", np.zeros(3)), **given), options)


def _move_unsync_joints(base: BaseManipulation, arguments: str) -> str:
    """Moves the active DOFs to where other joints can move to values without collisions."""
    readers: dict[str, Reader] = {**_OUTPUT, "handjoints": _hand, "planner": text}
    readers |= {"maxtries": Tokens.integer, "maxdivision": Tokens.integer}
    options = read_options(arguments, readers)
    hand, indices = options.get("handjoints", (np.zeros(0), []))
    traj = base.move_unsync_joints(hand, indices, **_some(options, "maxtries", "maxdivision", "planner"))
    return _reply(base, traj, options)


def _jitter_active(base: BaseManipulation, arguments: str) -> str:
    """Moves the active DOFs a little, out of collision."""
    readers: dict[str, Reader] = {**_OUTPUT, "maxiter": Tokens.integer, "jitter": Tokens.number}
    options = read_options(arguments, {**readers, "outputfinal": switch})
    return _final_and_reply(base, base.jitter_active(**_some(options, "maxiter", "jitter")), options)


BASE_COMMANDS: Mapping[str, Callable[[BaseManipulation, str], str | None]] = {
    "MoveActiveJoints": _move_active_joints,
    "MoveManipulator": _move_manipulator,
    "MoveToHandPosition": _move_to_hand_position,
    "MoveHandStraight": _move_hand_straight,
    "MoveUnsyncJoints": _move_unsync_joints,
    "JitterActive": _jitter_active,
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
    """Closes the gripper until its fingers touch something."""
    options = _gripper_options(task, arguments)
    return _final_and_reply(task, task.close_fingers(options.get("movingdir"), options.get("offset")), options)


def _release_fingers(task: TaskManipulation, arguments: str) -> str:
    """Opens the gripper, and lets go of a body."""
    options = _gripper_options(task, arguments)
    target = task.env.GetKinBody(options["target"]) if "target" in options else None
    return _final_and_reply(task, task.release_fingers(options.get("movingdir"), target), options)


def _release_active(task: TaskManipulation, arguments: str) -> str:
    """Moves the active joints to one side until they touch something."""
    dof = task.robot.GetActiveDOF()
    readers: dict[str, Reader] = {**_OUTPUT, "outputfinal": switch, "movingdir": lambda tokens: tokens.numbers(dof)}
    readers |= dict.fromkeys(("finestep", "translationstepmult"), Tokens.number)
    options = read_options(arguments, readers)
    return _final_and_reply(task, task.release_active(options.get("movingdir", np.zeros(dof))), options)


def _grasp_planning(task: TaskManipulation, arguments: str) -> str:
    """Moves the arm to one of given grasps."""
    options = read_options(arguments, {**_GRASPS, **_OUTPUT})
    target = task.env.GetKinBody(options.get("target", ""))
    if target is None:
        raise PlanningError(f"there is no body '{options.get('target', '')}'")
    indices, places = _some(options, *GRASP_COLUMNS), [*options.get("posedests", ()), *options.get("matdests", ())]
    given = _some(options, *(one.name for one in fields(GraspQuery) if one.name not in {"target", "grasps"}))
    query = GraspQuery(target, options.get("grasps", np.zeros((0, 0))), indices, places=places, **given)
    plan = task.plan_grasp(query)
    goals = "".join(f"{goal} " for goal in plan.goals)
    return _reply(task, plan.traj, options, f"{len(plan.goals)} {goals}{plan.number} {plan.seconds!r} ")


def _evaluate_constraints(task: TaskManipulation, arguments: str) -> str:
    """Projects configurations onto a constraint of the tool, and returns the number of steps for each."""
    dof = task.robot.GetActiveDOF()
    configurations: list[Floats] = []
    config: Mapping[str, Reader] = {"config": lambda tokens: configurations.append(tokens.numbers(dof))}
    options = {"constraintfreedoms": np.ones(6), "constrainttaskpose": np.eye(4)}
    options |= read_options(arguments, {**_CONSTRAINT, **config})
    steps, rows = task.evaluate_constraints(_constraint(options), configurations)
    return " ".join(map(str, steps)) + " " + "".join(map(_text, rows))


TASK_COMMANDS: Mapping[str, Callable[[TaskManipulation, str], str | None]] = {
    **dict.fromkeys(("CloseFingers", "ChuckFingers"), _close_fingers),
    **dict.fromkeys(("ReleaseFingers", "UnchuckFingers"), _release_fingers),
    "ReleaseActive": _release_active,
    "GraspPlanning": _grasp_planning,
    "EvaluateConstraints": _evaluate_constraints,
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
    """Return a reader of a list: how many there are, then each."""
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
"""Arguments that are one goal of the tool."""

_TOOL_GOALS = {"matrices": "matrix", "poses": "pose", "ikparams": "ikparam"}
"""Arguments that are several goals of the tool, and what each of these is."""

_CONSTRAINT: Mapping[str, Reader] = {
    **dict.fromkeys(("constraintmatrix", "constrainttaskmatrix"), Tokens.matrix),
    **dict.fromkeys(("constraintpose", "constrainttaskpose"), _pose),
    **{"constraintfreedoms": lambda tokens: tokens.numbers(6), "constrainterrorthresh": Tokens.number},
}
"""Arguments of a constraint of the tool."""

GRASP_COLUMNS = (
    *("igrasptrans", "grasptrans_nocol", "igraspdir", "imanipulatordirection", "igrasppreshape"),
    *("igrasppos", "igrasproll", "igraspstandoff"),
)
"""Names of columns in a list of grasps; the last three are for programs that close the hand, and have no effect."""

_GRASPS: Mapping[str, Reader] = {
    **dict.fromkeys(GRASP_COLUMNS, Tokens.integer),
    **dict.fromkeys(("seedgrasps", "seeddests", "seedik", "maxiter"), Tokens.integer),
    **dict.fromkeys(("randomgrasps", "randomdests"), flag),
    **dict.fromkeys(("approachoffset", "grasptranslationstepmult", "graspfinestep", "steplength"), Tokens.number),
    **{"grasps": _table, "target": text, "posedests": _several(_pose), "matdests": _several(Tokens.matrix)},
}

"""The commands of the modules for manipulation, as text."""

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, Generic, TypeVar

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

_OUTPUT: Mapping[str, Reader] = {"execute": flag, "outputtraj": switch}
_SEARCH: Mapping[str, Reader] = {"maxiter": Tokens.integer, "maxtries": Tokens.integer, "jitter": Tokens.number}


def reply(manipulation: Manipulation, traj: Trajectory, options: Mapping[str, Any], before: str = "") -> str:
    """Execute a motion if the options do not forbid it, and return the answer of the command."""
    if options.get("execute", True):
        manipulation.execute(traj)
    return before + (traj.serialize(AS_TEXT).decode() if options.get("outputtraj") else "")


def search_options(options: Mapping[str, Any], default: SearchOptions) -> SearchOptions:
    """Return the effort of a search that options ask for."""
    names = {"maxiter": "iterations", "maxtries": "tries", "jitter": "jitter"}
    given = {names[name]: value for name, value in options.items() if name in names}
    return default._replace(**given, constraint=_tool_constraint(options))


def _tool_constraint(options: Mapping[str, Any]) -> ToolConstraint | None:
    """Return the constraint of the tool that options of a motion ask for; None where they leave it free.

    Raises:
        ArgumentError: they do not say what the constraint holds.
    """
    given = [name for name in options if name in _CONSTRAINT]
    if given and "constraintfreedoms" not in given:
        raise ArgumentError(f"{given[0]} needs constraintfreedoms, which say what the constraint holds")
    return _constraint(options) if given and np.any(options["constraintfreedoms"]) else None


def _constraint(options: Mapping[str, Any]) -> ToolConstraint:
    frame = options.get("constraintmatrix", options.get("constraintpose", np.eye(4)))
    point = options.get("constrainttaskmatrix", options.get("constrainttaskpose"))
    return ToolConstraint(frame, point, options["constraintfreedoms"], options.get("constrainterrorthresh", 1e-3))


Named = Mapping[str, Callable[[str], str | None]]


def answering(named: Named) -> dict[str, Command]:
    """Return commands that return None if no motion is found, as OpenRAVE's do."""
    return {name: _or_none(command) for name, command in named.items()}


def _or_none(command: Command) -> Command:
    @wraps(command)
    def run(arguments: str) -> str | None:
        try:
            return command(arguments)
        except PlanningError:
            return None

    return run


class _Commands(Generic[Kind]):
    """Commands for one robot."""

    def __init__(self, manipulation: Kind) -> None:
        self._manipulation = manipulation

    def set_robot(self, arguments: str) -> str | None:
        """Chooses the robot by its name."""
        return "" if self._manipulation.choose(arguments.strip()) else None


class BaseCommands(_Commands[BaseManipulation]):
    """The commands of ``BaseManipulation``."""

    def named(self) -> Named:
        """Return the commands by their names."""
        return {
            "MoveActiveJoints": self.move_active_joints,
            "MoveManipulator": self.move_manipulator,
            "MoveToHandPosition": self.move_to_hand_position,
            "MoveHandStraight": self.move_hand_straight,
            "MoveUnsyncJoints": self.move_unsync_joints,
            "JitterActive": self.jitter_active,
            "SetRobot": self.set_robot,
        }

    def move_active_joints(self, arguments: str) -> str:
        """Moves the active DOFs to one of several goals without collisions."""
        dof = self._manipulation.robot.GetActiveDOF()
        readers = {**_OUTPUT, **_SEARCH, **_goals(dof), "steplength": Tokens.number}
        readers |= {"initialconfigs": lambda tokens: tokens.rows(dof), "postprocessingplanner": text}
        options = read_options(arguments, readers)
        starts = options.get("initialconfigs", ())
        post = (options["postprocessingplanner"], "") if "postprocessingplanner" in options else None
        goals = [*options.get("goal", ()), *options.get("goals", ())]
        search = search_options(options, SearchOptions())
        return reply(
            self._manipulation,
            self._manipulation.move_active_joints(goals, search, starts=starts, postprocessing=post),
            options,
        )

    def move_manipulator(self, arguments: str) -> str:
        """Moves the arm of the active manipulator to one of several goals without collisions."""
        dof = self._manipulation.arm().GetArmDOF()
        options = read_options(arguments, {**_OUTPUT, **_SEARCH, **_goals(dof), "steplength": Tokens.number})
        goals = [*options.get("goal", ()), *options.get("goals", ())]
        return reply(
            self._manipulation,
            self._manipulation.move_manipulator(goals, search_options(options, SearchOptions())),
            options,
        )

    def move_to_hand_position(self, arguments: str) -> str:
        """Moves the tool of the active manipulator to one of several poses without collisions."""
        dof = self._manipulation.arm().GetArmDOF()
        readers: dict[str, Reader] = {**_OUTPUT, **_SEARCH, **_TOOL_GOAL}
        readers |= {name: _several(_TOOL_GOAL[one]) for name, one in _TOOL_GOALS.items()}
        readers |= {"goalsamples": Tokens.integer, "goalmaxsamples": Tokens.integer, "steplength": Tokens.number}
        readers |= {"seedik": Tokens.integer, "goalsampleprob": Tokens.number}
        readers |= dict.fromkeys(("goalmaxtries", "minimumgoalpaths"), Tokens.number)
        readers |= {"initialconfigs": lambda tokens: tokens.rows(dof)}
        options = read_options(arguments, {**readers, **_CONSTRAINT})
        goals = [options[name] for name in _TOOL_GOAL if name in options]
        goals += [goal for name in _TOOL_GOALS for goal in options.get(name, ())]
        names = {
            "seedik": "first",
            "goalmaxsamples": "samples",
            "goalsamples": "samples",
            "goalsampleprob": "probability",
            "initialconfigs": "starts",
        }
        given = {names[name]: value for name, value in options.items() if name in names}
        traj = self._manipulation.move_to_hand_position(goals, search_options(options, HAND_SEARCH), **given)
        return reply(self._manipulation, traj, options, "1" if not options.get("outputtraj") else "1 ")

    def move_hand_straight(self, arguments: str) -> str:
        """Moves the tool of the active manipulator along a straight line."""
        readers: dict[str, Reader] = {**_OUTPUT, "direction": lambda tokens: tokens.numbers(3), "greedysearch": flag}
        readers |= {"minsteps": Tokens.integer, "maxsteps": Tokens.integer, "starteematrix": Tokens.matrix}
        readers |= dict.fromkeys(("stepsize", "ignorefirstcollision", "maxdeviationangle", "steplength"), Tokens.number)
        options = read_options(arguments, {**readers, "planner": text})
        return reply(self._manipulation, straight(self._manipulation, options), options)

    def move_unsync_joints(self, arguments: str) -> str:
        """Moves the active DOFs to where other joints can move to values without collisions."""
        readers: dict[str, Reader] = {**_OUTPUT, "handjoints": _hand, "planner": text}
        readers |= {"maxtries": Tokens.integer, "maxdivision": Tokens.integer}
        options = read_options(arguments, readers)
        hand, indices = options.get("handjoints", (np.zeros(0), []))
        return reply(self._manipulation, unsync(self._manipulation, hand, indices, options), options)

    def jitter_active(self, arguments: str) -> str:
        """Moves the active DOFs a little, out of collision."""
        readers: dict[str, Reader] = {**_OUTPUT, "maxiter": Tokens.integer, "jitter": Tokens.number}
        options = read_options(arguments, {**readers, "outputfinal": switch})
        final, traj = self._manipulation.jitter_active(options.get("maxiter", 5000), options.get("jitter", 0.03))
        return reply(self._manipulation, traj, options, _numbers(final) if options.get("outputfinal") else "")


class TaskCommands(_Commands[TaskManipulation]):
    """The commands of ``TaskManipulation``."""

    def named(self) -> Named:
        """Return the commands by their names."""
        return {
            "CloseFingers": self.close_fingers,
            "ChuckFingers": self.close_fingers,
            "ReleaseFingers": self.release_fingers,
            "UnchuckFingers": self.release_fingers,
            "ReleaseActive": self.release_active,
            "GraspPlanning": self.grasp_planning,
            "EvaluateConstraints": self.evaluate_constraints,
            "SetRobot": self.set_robot,
        }

    def close_fingers(self, arguments: str) -> str:
        """Closes the gripper until its fingers touch something."""
        options = self._options(arguments)
        return self._answer(self._manipulation.close_fingers(options.get("movingdir"), options.get("offset")), options)

    def release_fingers(self, arguments: str) -> str:
        """Opens the gripper, and lets go of a body."""
        options = self._options(arguments)
        target = self._manipulation.env.GetKinBody(options["target"]) if "target" in options else None
        return self._answer(self._manipulation.release_fingers(options.get("movingdir"), target), options)

    def release_active(self, arguments: str) -> str:
        """Moves the active joints to one side until they touch something."""
        dof = self._manipulation.robot.GetActiveDOF()
        readers: dict[str, Reader] = {**_OUTPUT, "outputfinal": switch, "movingdir": lambda tokens: tokens.numbers(dof)}
        readers |= dict.fromkeys(("finestep", "translationstepmult"), Tokens.number)
        options = read_options(arguments, readers)
        return self._answer(self._manipulation.release_active(options.get("movingdir", np.zeros(dof))), options)

    def grasp_planning(self, arguments: str) -> str:
        """Moves the arm to one of given grasps."""
        options = read_options(arguments, {**_GRASPS, **_OUTPUT})
        target = self._manipulation.env.GetKinBody(options.get("target", ""))
        if target is None:
            raise PlanningError(f"there is no body '{options.get('target', '')}'")
        indices = {name: options[name] for name in GRASP_COLUMNS if name in options}
        places = [*options.get("posedests", ()), *options.get("matdests", ())]
        named = {_QUERY[name]: value for name, value in options.items() if name in _QUERY}
        plan = self._manipulation.plan_grasp(
            GraspQuery(target, options.get("grasps", np.zeros((0, 0))), indices, places=places, **named)
        )
        goals = "".join(f"{goal} " for goal in plan.goals)
        before = f"{len(plan.goals)} {goals}{plan.number} {plan.seconds!r} "
        return reply(self._manipulation, plan.traj, options, before)

    def evaluate_constraints(self, arguments: str) -> str:
        """Projects configurations onto a constraint of the tool, and returns the number of steps for each."""
        dof = self._manipulation.robot.GetActiveDOF()
        configurations: list[Floats] = []
        config: Mapping[str, Reader] = {"config": lambda tokens: configurations.append(tokens.numbers(dof))}
        options = {"constraintfreedoms": np.ones(6), "constrainttaskpose": np.eye(4)}
        options |= read_options(arguments, {**_CONSTRAINT, **config})
        steps, rows = self._manipulation.evaluate_constraints(_constraint(options), configurations)
        return " ".join(map(str, steps)) + " " + "".join(_numbers(row) for row in rows)

    def _options(self, arguments: str) -> dict[str, Any]:
        manip = self._manipulation.robot.GetActiveManipulator()
        dof = manip.GetGripperDOF() if manip else 0
        readers: dict[str, Reader] = {**_OUTPUT, "outputfinal": switch, "target": text}
        readers |= dict.fromkeys(("movingdir", "offset"), lambda tokens: tokens.numbers(dof))
        readers |= dict.fromkeys(("coarsestep", "finestep", "translationstepmult"), Tokens.number)
        return read_options(arguments, readers)

    def _answer(self, found: tuple[Floats, Trajectory], options: Mapping[str, Any]) -> str:
        return reply(self._manipulation, found[1], options, _numbers(found[0]) if options.get("outputfinal") else "")


def straight(manipulation: BaseManipulation, options: Mapping[str, Any]) -> Trajectory:
    """Return the motion of the tool along a straight line that options ask for."""
    names = {"stepsize": "step", "minsteps": "least", "maxsteps": "most", "starteematrix": "start"}
    names["ignorefirstcollision"] = "ignored"
    given = {names[name]: value for name, value in options.items() if name in names}
    return manipulation.move_hand_straight(options.get("direction", np.zeros(3)), **given)


def unsync(manipulation: BaseManipulation, hand: Floats, indices: list[int], options: Mapping[str, Any]) -> Trajectory:
    """Return the motion of ``MoveUnsyncJoints`` that options ask for."""
    names = {"maxtries": "tries", "maxdivision": "divisions", "planner": "planner"}
    given = {names[name]: value for name, value in options.items() if name in names}
    return manipulation.move_unsync_joints(hand, indices, **given)


def _goals(dof: int) -> dict[str, Reader]:
    return {"goal": lambda tokens: [tokens.numbers(dof)], "goals": lambda tokens: tokens.rows(dof)}


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


def _numbers(values: Floats) -> str:
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

_QUERY = {
    "approachoffset": "offset",
    "seedgrasps": "seed_grasps",
    "seeddests": "seed_places",
    "seedik": "seed_ik",
    "maxiter": "iterations",
    "randomgrasps": "random_grasps",
    "randomdests": "random_places",
}
"""Arguments of ``GraspPlanning``, and their fields in a ``GraspQuery``."""

_GRASPS: Mapping[str, Reader] = {
    **dict.fromkeys(GRASP_COLUMNS, Tokens.integer),
    **dict.fromkeys(("seedgrasps", "seeddests", "seedik", "maxiter"), Tokens.integer),
    **dict.fromkeys(("randomgrasps", "randomdests"), flag),
    **dict.fromkeys(("approachoffset", "grasptranslationstepmult", "graspfinestep", "steplength"), Tokens.number),
    **{"grasps": _table, "target": text, "posedests": _several(_pose), "matdests": _several(Tokens.matrix)},
}

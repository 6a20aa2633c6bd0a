"""The computations of sweeps on a block of items, by name."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.ik_types import IkParameterizationType, goal_size
from ravemj.geometry_functions.poses import matrixFromPose
from ravemj.rave import Environment, Planner, Robot
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.planning.path_planners import BiRrt
from ravemj.rave.trajectory import Trajectory
from ravemj.sweeps import pictures
from ravemj.sweeps.shards import PICTURES, Arrays, joined

Function = Callable[..., Arrays]
"""User's function of an environment, the items of a block, the random generator of the block, and options."""

BLOCK = 1000
"""Default number of items that share a random generator."""

_UNLIMITED = 1e3
"""Limit above which joints are treated as continuous; their values are sampled in [-pi, pi]."""


_ITERATIONS = 4000
"""Default maximum number of planner iterations."""


class Job(NamedTuple):
    """A computation, as sent to worker processes.

    Attributes:
        what: A name of ``JOBS``, or a user's function.
        robot: The name of the robot; empty if the environment has none.
        manip: The name of its manipulator; None for the whole robot.
        options: Options by name.
    """

    what: str | Function
    robot: str
    manip: str | None
    options: Mapping[str, Any]


class Work(NamedTuple):
    """A job with the objects of its environment.

    Attributes:
        env: The environment.
        robot: The robot; None if there is none.
        arm: The manipulator; None for the whole robot.
        options: Options by name.
    """

    env: Environment
    robot: Robot | None
    arm: Manipulator | None
    options: Mapping[str, Any]

    @classmethod
    def for_job(cls, job: Job, env: Environment) -> "Work":
        """Return the work for a job in an environment."""
        robot = env.GetRobot(job.robot)
        arm = robot.GetManipulator(job.manip) if robot is not None and job.manip else None
        return cls(env, robot, arm, job.options)

    @property
    def mover(self) -> Robot:
        """The robot.

        Raises:
            ArgumentError: there is no robot.
        """
        if self.robot is None:
            raise ArgumentError("sweep: model: there is no robot in it, and this needs one")
        return self.robot

    @property
    def tool(self) -> Manipulator:
        """The manipulator.

        Raises:
            ArgumentError: there is no manipulator.
        """
        if self.arm is None:
            raise ArgumentError(f"sweep: manip: '{self.mover.GetName()}' has no manipulator, and this needs one")
        return self.arm


class Kind(NamedTuple):
    """A built-in job.

    Attributes:
        compute: Function that returns arrays with a row for each item, given the work, the items and a random
            generator.
        shape: Returns the shape of an item.
        sample: Draws random items.
        options: Names of the options.
        block: Number of items that share a random generator.
    """

    compute: Callable[[Work, Floats, np.random.Generator], Arrays]
    shape: Callable[[Work], tuple[int, ...]]
    sample: Callable[[Work, np.random.Generator, int], Floats]
    options: frozenset[str] = frozenset()
    block: int = BLOCK


def joint_values(work: Work, random: np.random.Generator, count: int) -> Floats:
    """Draw joint values within the limits [rad or m], shape (count, dof)."""
    lower, upper = work.mover.GetDOFLimits()
    endless = (lower < -_UNLIMITED) | (upper > _UNLIMITED)
    return random.uniform(np.where(endless, -np.pi, lower), np.where(endless, np.pi, upper), (count, len(lower)))


def _moved(work: Work) -> list[int]:
    """Return the DOFs that a planner moves: the arm's or, without an arm, all."""
    return list(range(work.mover.GetDOF())) if work.arm is None else work.arm.GetArmIndices().tolist()


def _starts_and_goals(work: Work, random: np.random.Generator, count: int) -> Floats:
    return joint_values(work, random, 2 * count)[:, _moved(work)].reshape(count, 2, -1)


def _tool_poses(work: Work, values: Floats) -> Floats:
    links = work.mover.batch_link_transforms(values)
    effector = work.tool.GetEndEffector()
    assert effector is not None
    return links[:, effector.GetIndex()] @ work.tool.GetLocalToolTransform()


def _goals(work: Work, random: np.random.Generator, count: int) -> Floats:
    """Draw IK goals that the arm can reach while the other joints keep their values."""
    arm = work.tool.GetArmIndices()
    values = np.tile(work.mover.GetDOFValues(), (count, 1))
    values[:, arm] = joint_values(work, random, count)[:, arm]
    if _type(work) == IkParameterizationType.Transform6D:
        return _tool_poses(work, values)
    goals: list[Floats] = []
    for row in values:
        work.mover.SetDOFValues(row, checklimits=0)
        goals.append(np.asarray(work.tool.GetIkParameterization(_type(work)).GetValues()))
    return np.array(goals)


def _type(work: Work) -> IkParameterizationType:
    name = work.options.get("type", IkParameterizationType.Transform6D.name)
    try:
        return IkParameterizationType[name]
    except KeyError:
        raise ArgumentError(f"sweep: options: type is {name!r}; expected a type of goal, as Transform6D") from None


def _goal_shape(work: Work) -> tuple[int, ...]:
    kind = _type(work)
    return (4, 4) if kind == IkParameterizationType.Transform6D else (goal_size(kind),)


def _collides(work: Work, items: Floats, random: np.random.Generator) -> Arrays:
    del random
    return {"collides": work.mover.batch_collides(items)}


def _poses(work: Work, items: Floats, random: np.random.Generator) -> Arrays:
    del random
    if work.arm is not None:
        return {"T_world_tool": _tool_poses(work, items)}
    return {"T_world_link": work.mover.batch_link_transforms(items)}


def _ik(work: Work, items: Floats, random: np.random.Generator) -> Arrays:
    del random
    collisions = bool(work.options.get("collisions", False))
    solutions = work.tool.batch_solutions(items, collisions=collisions, iktype=_type(work))
    return solutions._asdict()


def _plan(work: Work, items: Floats, random: np.random.Generator) -> Arrays:
    """Plan each motion with its own seed; iterations are limited instead of time, so that results are reproducible."""
    robot, env = work.mover, work.env
    robot.SetActiveDOFs(_moved(work))
    spec = robot.GetActiveConfigurationSpecification()
    rows: list[Arrays] = []
    for start, goal in items:
        params = Planner.PlannerParameters()
        params.SetRobotActiveJoints(robot)
        params.SetInitialConfig(start)
        params.SetGoalConfig(goal)
        params.SetMaxIterations(int(work.options.get("iterations", _ITERATIONS)))
        params.SetRandomGeneratorSeed(int(random.integers(1 << 31)))
        planner, traj = BiRrt(env, "birrt"), Trajectory(env, "")
        planner.InitPlan(robot, params)
        is_solved = bool(planner.PlanPath(traj))
        path = traj.GetAllWaypoints2D(spec) if is_solved else np.zeros((0, len(start)))
        row = {
            "found": is_solved,
            "waypoints": path,
            "count": len(path),
            "length": np.linalg.norm(np.diff(path, axis=0), axis=1).sum() if is_solved else np.nan,
            "duration": traj.GetDuration() if is_solved else np.nan,
            "iterations": 0 if planner.search is None else planner.search.iterations,
        }
        rows.append({name: np.asarray(value)[None] for name, value in row.items()})
    return joined(rows)


def _pictures(work: Work, items: Floats, random: np.random.Generator) -> Arrays:
    return pictures.pictures(work.env, work.mover, items, random, work.options)


def _dofs(work: Work) -> tuple[int, ...]:
    return (work.mover.GetDOF(),)


def _ends(work: Work) -> tuple[int, ...]:
    return 2, len(_moved(work))


JOBS = {
    "collides": Kind(_collides, _dofs, joint_values),
    "poses": Kind(_poses, _dofs, joint_values),
    "ik": Kind(_ik, _goal_shape, _goals, frozenset({"type", "collisions"})),
    "plan": Kind(_plan, _ends, _starts_and_goals, frozenset({"iterations"}), 1),
    PICTURES: Kind(_pictures, _dofs, joint_values, pictures.OPTIONS, 1),
}


def checked_items(work: Work, what: str, items: NDArray[Any]) -> NDArray[Any]:
    """Return the items of a job; convert poses of seven numbers [w, x, y, z, tx, ty, tz] to matrices.

    Raises:
        ArgumentError: they have another shape, or are not finite.
    """
    shape = JOBS[what].shape(work)
    if shape == (4, 4) and items.shape[1:] == (7,):
        items = np.array([matrixFromPose(row) for row in items]).reshape(-1, 4, 4)
    if items.shape[1:] != shape:
        wanted = ", ".join(["N", *map(str, shape)])
        raise ArgumentError(f"sweep: items: have shape {items.shape}, and should have ({wanted}) for '{what}'")
    if not np.issubdtype(items.dtype, np.number) or not np.isfinite(items).all():
        raise ArgumentError("sweep: items: should be finite numbers")
    return np.asarray(items, dtype=float)

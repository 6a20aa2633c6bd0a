"""Motions of a robot that are planned and executed."""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.planning.jitter import nearby
from ravemj.planning.rrt import MoreGoals
from ravemj.rave.enums import SaveParameters
from ravemj.rave.planning.end_waypoints import EndWaypoint
from ravemj.rave.planning.hand import ToolConstraint, hand_of
from ravemj.rave.planning.names import is_planner, needed_planner, retimed
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.status import PlannerStatus, PlanningError
from ravemj.rave.planning.values import Values
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import Trajectory

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

JITTER_TRIES = 1000
"""How many configurations near a start or goal in collision are tried."""

_SAME = 1e-9
"""Configurations this near [rad or m] are the same."""

Postprocessing = tuple[str, str]


class SearchOptions(NamedTuple):
    """How long to search, how far aside of starts and goals, and under which constraint.

    Attributes:
        tries: How often the planner is asked.
        iterations: How many iterations it has.
        jitter: How far each value of a start or goal in collision may be moved to be without [rad or m]; the way
            there and back is not tested.
        constraint: Of the tool, all along; None: none. With one, starts and goals are not moved, and the motion goes
            along straight lines from one of many configurations to the next.
    """

    tries: int = 2
    iterations: int = 4000
    jitter: float = 0.04
    constraint: ToolConstraint | None = None


class Manipulation:
    """Plans and executes motions of one robot.

    Attributes:
        env: Where the robot is.
        planner: Name of the planner of paths.
        maxvelmult: Factor of the velocity limits, for motions that are straight lines.
    """

    def __init__(self, env: "Environment") -> None:
        self.env = env
        self.planner = "birrt"
        self.maxvelmult = 1.0
        self._robot: Robot | None = None

    @property
    def robot(self) -> Robot:
        """The robot.

        Raises:
            ArgumentError: there is none, or it is gone.
        """
        if self._robot is None or not self.env.simulation.holds(self._robot.simulation_state):
            raise ArgumentError("there is no robot; add the module with the name of one, or send SetRobot")
        return self._robot

    def choose(self, name: str) -> bool:
        """Choose the robot by its name; return whether there is one."""
        robot = self.env.GetRobot(name)
        if robot is not None:
            self._robot = robot
        return robot is not None

    def choose_planner(self, name: str) -> None:
        """Choose the planner of paths; an unknown name chooses ``birrt``, as in OpenRAVE."""
        self.planner = name if is_planner(name) else "birrt"

    def keeping_active(self) -> AbstractContextManager[object]:
        """Have the active DOFs as they were afterwards."""
        return self.robot.CreateRobotStateSaver(SaveParameters.ActiveDOF)

    def plan(
        self,
        goals: Sequence[Floats],
        search: SearchOptions,
        *,
        starts: Sequence[Floats] = (),
        postprocessing: Postprocessing | None = None,
        more: MoreGoals | None = None,
    ) -> Trajectory:
        """Return a motion of the active DOFs to one of several goals.

        Args:
            goals: Goals; values outside the limits are moved to them.
            search: How to search; each try has other random numbers.
            starts: Where it may start; none: where the robot is.
            postprocessing: Smoother and its parameters; None: OpenRAVE's.
            more: Further goals, which are asked for while it is planned.

        Raises:
            PlanningError: there is none; its text says why.
        """
        params = PlannerParameters()
        params.SetRobotActiveJoints(self.robot)
        params.SetMaxIterations(search.iterations)
        if postprocessing is not None:
            params.SetPostProcessing(*postprocessing)
        if more is not None:
            params.set_goal_sampler(more.sample, more.probability)
        jitter = search.jitter
        if search.constraint is not None:
            params.given.manifold = hand_of(params.resolved()).to_constraint(search.constraint.checked())
            jitter = 0.0
            if postprocessing is None:
                params.SetPostProcessing("LinearTrajectoryRetimer", "")
        values = params.resolved()
        space = values.space()
        froms = list(starts) or [values.vectors["_vinitialconfig"]]
        wanted = [[space.clamp(one) for one in some] for some in (froms, goals)]
        moved = [self._jittered(values, some, jitter) for some in wanted]
        params.SetInitialConfig(np.array(moved[0]).ravel())
        params.SetGoalConfig(np.array(moved[1]).ravel())
        status = PlannerStatus("there is no try")
        for attempt in range(search.tries):
            params.SetRandomGeneratorSeed(attempt)
            planner = needed_planner(self.env, self.planner)
            traj = Trajectory(self.env, "")
            planner.InitPlan(self.robot, params)
            status = planner.PlanPath(traj)
            if status:
                self._join(traj, wanted, moved)
                return traj
        raise PlanningError(status.description)

    def _jittered(self, values: Values, configurations: Sequence[Floats], jitter: float) -> list[Floats]:
        """Return configurations with those in collision moved a little; those that stay in collision stay."""
        assert values.bodies is not None
        random = np.random.default_rng(0)
        with values.bodies.kept():
            test, space = values.allowed(), values.space()
            found = [nearby(space, one, test, JITTER_TRIES, jitter, random) for one in configurations]
        return [old if new is None else new for old, new in zip(configurations, found, strict=True)]

    def _join(self, traj: Trajectory, wanted: Sequence[Sequence[Floats]], moved: Sequence[Sequence[Floats]]) -> None:
        """Let a motion start and end where it was asked for, where a start or goal was jittered."""
        spec = self.robot.GetActiveConfigurationSpecification()
        for end, (asked, used) in enumerate(zip(wanted, moved, strict=True)):
            place = traj.GetNumWaypoints() if end else 0
            reached = traj.GetWaypoint(-1 if end else 0, spec)
            nearest = int(np.argmin([np.abs(one - reached).max() for one in used]))
            is_it = np.abs(used[nearest] - reached).max() < _SAME  # and no goal that came later
            if is_it and (asked[nearest] != used[nearest]).any():
                rest = np.zeros(len(reached))
                new = EndWaypoint(traj, spec, asked[nearest], rest)
                anchor = new.anchor(place, 0)
                new.join(new.retimed(anchor, (1.0, 1.0), "", ""), anchor)

    def straight(self, points: Floats) -> Trajectory:
        """Return the motion of the active DOFs along straight lines, at the greatest speeds.

        Args:
            points: The active values, shape (m, n).

        Raises:
            PlanningError: it has no times.
        """
        traj = Trajectory(self.env, "")
        traj.Init(self.robot.GetActiveConfigurationSpecification("linear"))
        traj.Insert(0, points.ravel())
        status = retimed(traj, "LinearTrajectoryRetimer", (self.maxvelmult, 1.0))
        if not status:
            raise PlanningError(status.description)
        return traj

    def execute(self, traj: Trajectory) -> None:
        """Let the robot's controller play a motion; it begins with the next step of time."""
        robot = self.robot
        controller = robot.GetController()
        if controller is None:
            raise PlanningError(f"robot '{robot.GetName()}' has no controller to execute the motion")
        if traj.GetNumWaypoints() > 1:
            controller.SetPath(traj)
            return
        values = robot.GetDOFValues()
        spec = traj.GetConfigurationSpecification()
        group = spec.FindCompatibleGroup(f"joint_values {robot.GetName()}")
        if group is not None:
            used, _ = spec.ExtractUsedIndices(robot)
            values[used] = spec.ExtractJointValues(traj.GetWaypoint(0), robot, used)
        controller.SetDesired(values)

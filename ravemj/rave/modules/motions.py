"""Plans and executes motions of a robot."""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.planning.edges import nearby
from ravemj.planning.rrt import MoreGoals
from ravemj.rave.enums import SaveParameters
from ravemj.rave.planning.end_waypoints import EndWaypoint
from ravemj.rave.planning.hand import ToolConstraint, hand_of
from ravemj.rave.planning.names import is_planner, needed_planner, retimed
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.status import PlannerStatus, PlanningError
from ravemj.rave.planning.values import STEP_LENGTH, Values
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import Trajectory

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

JITTER_TRIES = 1000
"""The number of random configurations that are tested near a start or goal in collision."""

_SAME = 1e-9
"""The tolerance within which two configurations are equal [rad or m]."""

Postprocessing = tuple[str, str]


class SearchOptions(NamedTuple):
    """The effort of a search, and the constraint on its result.

    Attributes:
        maxtries: The number of calls of the planner, with other random numbers each time.
        maxiter: The maximum number of iterations of each call.
        steplength: The step of the planner's trees, a weighted distance of configurations.
        jitter: The largest change of each value of a start or goal in collision, to make it free [rad or m]. The
            motion between the two is not tested.
        constraint: The constraint of the tool along the whole motion; None for none. With a constraint, starts and
            goals are not changed, and the motion consists of short straight lines between configurations that keep it.
    """

    maxtries: int = 2
    maxiter: int = 4000
    steplength: float = STEP_LENGTH
    jitter: float = 0.04
    constraint: ToolConstraint | None = None


class Manipulation:
    """Plans and executes motions of one robot.

    Attributes:
        env: The environment of the robot.
        planner: The name of the path planner.
        maxvelmult: The factor of the velocity limits for motions along straight lines.
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
            ArgumentError: no robot was chosen, or it is no longer in the environment.
        """
        if self._robot is None or not self.env.simulation.holds(self._robot.simulation_state):
            raise ArgumentError("there is no robot; add the module with the name of one, or send SetRobot")
        return self._robot

    def choose(self, name: str) -> bool:
        """Choose the robot by its name, and return whether the environment has it."""
        robot = self.env.GetRobot(name)
        if robot is not None:
            self._robot = robot
        return robot is not None

    def choose_planner(self, name: str) -> None:
        """Choose the path planner; an unknown name chooses ``birrt``, as in OpenRAVE."""
        self.planner = name if is_planner(name) else "birrt"

    def keeping_active(self) -> AbstractContextManager[object]:
        """Restore the active DOFs on leaving."""
        return self.robot.CreateRobotStateSaver(SaveParameters.ActiveDOF)

    def move_active_joints(
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
            goals: The goals, each of shape (active dof,); values outside the limits are set to the limits.
            search: The effort of the search.
            starts: The possible starts; by default the current configuration.
            postprocessing: The smoother and its parameters; by default OpenRAVE's.
            more: A source of further goals while the planner works.

        Raises:
            PlanningError: no motion was found; the message says why.
            ArgumentError: a goal or start has another shape, or is not finite; or the step length is not positive.
        """
        self._check(goals, starts)
        if not search.steplength > 0:
            raise ArgumentError(f"steplength: is {search.steplength:g}, and should be more than 0")
        params = PlannerParameters()
        params.SetRobotActiveJoints(self.robot)
        params.SetMaxIterations(search.maxiter)
        params.SetStepLength(search.steplength)
        if postprocessing is not None:
            params.SetPostProcessing(*postprocessing)
        if more is not None:
            params.set_goal_sampler(more.sample, more.probability)
        jitter = search.jitter
        if search.constraint is not None:
            params.given.manifold = hand_of(params.resolved()).to_constraint(search.constraint)
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
        status = PlannerStatus("no attempt was allowed; give at least one try")
        for attempt in range(search.maxtries):
            params.SetRandomGeneratorSeed(attempt)
            planner = needed_planner(self.env, self.planner)
            traj = Trajectory(self.env, "")
            planner.InitPlan(self.robot, params)
            status = planner.PlanPath(traj)
            if status:
                self._join(traj, wanted, moved)
                return traj
        raise PlanningError(status.description)

    def _check(self, goals: Sequence[Floats], starts: Sequence[Floats]) -> None:
        dof = self.robot.GetActiveDOF()
        if not len(goals):
            raise PlanningError("there is no goal")
        for one in [*goals, *starts]:
            if len(one) != dof or not np.isfinite(one).all():
                raise ArgumentError(f"a goal or start is {one.tolist()}, and should be {dof} finite numbers")

    def _jittered(self, values: Values, configurations: Sequence[Floats], jitter: float) -> list[Floats]:
        """Return configurations, each one in collision replaced by a free one nearby, if one is found."""
        assert values.bodies is not None
        random = np.random.default_rng(0)
        with values.bodies.kept():
            test, space = values.allowed(), values.space()
            found = [nearby(space, one, test, JITTER_TRIES, jitter, random) for one in configurations]
        return [old if new is None else new for old, new in zip(configurations, found, strict=True)]

    def _join(self, traj: Trajectory, wanted: Sequence[Sequence[Floats]], moved: Sequence[Sequence[Floats]]) -> None:
        """Extend a motion to the original start and goal, if the planner used jittered ones."""
        spec = self.robot.GetActiveConfigurationSpecification()
        for end, (asked, used) in enumerate(zip(wanted, moved, strict=True)):
            place = traj.GetNumWaypoints() if end else 0
            reached = traj.GetWaypoint(-1 if end else 0, spec)
            nearest = int(np.argmin([np.abs(one - reached).max() for one in used]))
            is_it = np.abs(used[nearest] - reached).max() < _SAME  # and no goal that came later
            if is_it and (asked[nearest] != used[nearest]).any():
                rest = np.zeros(len(reached))
                new = EndWaypoint(traj, spec, asked[nearest], rest, place)
                retimer = "LinearTrajectoryRetimer" if self.robot.GetAffineDOF() else ""  # the only one for poses
                new.join(new.retimed((1.0, 1.0), retimer, ""))

    def straight(self, points: Floats) -> Trajectory:
        """Return the fastest motion of the active DOFs along straight lines through points (m, n).

        Raises:
            PlanningError: the retimer finds no times.
        """
        traj = Trajectory(self.env, "")
        traj.Init(self.robot.GetActiveConfigurationSpecification("linear"))
        traj.Insert(0, points.ravel())
        status = retimed(traj, "LinearTrajectoryRetimer", (self.maxvelmult, 1.0))
        if not status:
            raise PlanningError(status.description)
        return traj

    def execute(self, traj: Trajectory) -> None:
        """Have the robot's controller play a motion, which begins with the next simulation step.

        Raises:
            PlanningError: the robot has no controller.
        """
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

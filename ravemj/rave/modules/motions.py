"""Plans and executes motions of a robot."""

import itertools
from collections.abc import Mapping, Sequence
from operator import is_not
from typing import TYPE_CHECKING, Any

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.manipulation.bodies import Bodies
from ravemj.manipulation.motions import jittered
from ravemj.manipulation.options import JointMotion
from ravemj.manipulation.tool import ToolConstraint
from ravemj.planning.rrt import MoreGoals
from ravemj.rave.planning.end_waypoints import EndWaypoint
from ravemj.rave.planning.names import is_planner, needed_planner, retimed
from ravemj.rave.planning.planner import PlannerStatus, PlanningError
from ravemj.rave.planning.values import Values, hand_of
from ravemj.rave.robot import Robot
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.bodies import body_groups
from ravemj.trajectories.groups import AFFINE, Group
from ravemj.trajectories.layout import count
from ravemj.trajectories.waypoints import Waypoints

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

_SAME = 1e-9
"""The tolerance within which two configurations are equal [rad or m]."""

Postprocessing = tuple[str, str]
Options = Mapping[str, Any]
"""Options of a command, by their names."""


def tool_constraint(options: Options) -> ToolConstraint | None:
    """Return the constraint of the tool that options of a motion ask for; None where they leave it free."""
    given = [name for name in options if name.startswith("constraint")]
    if given and "constraintfreedoms" not in given:
        raise ArgumentError(f"{given[0]} needs constraintfreedoms, which say what the constraint holds")
    return constraint_of(options) if given and np.any(options["constraintfreedoms"]) else None


def constraint_of(options: Options) -> ToolConstraint:
    """Return the constraint of the tool that options of a command describe."""
    frame = options.get("constraintmatrix", options.get("constraintpose", np.eye(4)))
    point = options.get("constrainttaskmatrix", options.get("constrainttaskpose"))
    return ToolConstraint(frame, point, options["constraintfreedoms"], options.get("constrainterrorthresh", 1e-3))


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

    def groups(self, dofs: Sequence[int] | None = None) -> list[Group]:
        """Return the layout of some joints of the robot, or of what is active."""
        if dofs is None:
            return self.robot.GetActiveConfigurationSpecification().GetGroups()
        return body_groups(self.robot.simulation_state.scene.name, dofs, 0, "")

    def bodies_of(self, dofs: Sequence[int]) -> Bodies:
        """Return some joints of the robot as what moves."""
        return Bodies(self.env.simulation, self.groups(dofs), self.env.GetCollisionChecker)

    def stated(self, dofs: Sequence[int] | None = None) -> Values:
        """Return a problem of some joints, or of what is active."""
        values = Values()
        values.state(self.env, self.groups(dofs))
        return values

    def move_joints(
        self,
        goals: Sequence[Floats],
        options: JointMotion,
        *,
        dofs: Sequence[int] | None = None,
        starts: Sequence[Floats] = (),
        postprocessing: Postprocessing | None = None,
        more: MoreGoals | None = None,
        constraint: ToolConstraint | None = None,
    ) -> Trajectory:
        """Return a motion of some joints to one of several goals.

        Args:
            goals: The goals, each of shape (n,); values outside the limits are set to the limits.
            options: The effort of the options.
            dofs: The DOF indices of the joints; None for what is active.
            starts: The possible starts; by default the current configuration.
            postprocessing: The smoother and its parameters; by default OpenRAVE's.
            more: A source of further goals while the planner works.
            constraint: The constraint of the tool along the whole motion, which then consists of short straight lines
                between configurations that keep it.

        Raises:
            PlanningError: no motion was found; the message says why.
            ArgumentError: a goal or start has another shape, or is not finite; or the step length is not positive.
        """
        if not options.steplength > 0:
            raise ArgumentError(f"steplength: is {options.steplength:g}, and should be more than 0")
        values, jitter = self.stated(dofs), options.jitter
        _check(goals, starts, count(values.groups))
        values.goal_sampler = more
        values.numbers["_nmaxiterations"] = options.maxiter
        values.numbers["_fsteplength"] = options.steplength
        if constraint is not None:
            values.conditions.manifold = hand_of(self.env, values).tool.to_constraint(constraint)
            values.postprocessing, jitter = ("LinearTrajectoryRetimer", ""), 0.0
        values.postprocessing = postprocessing or values.postprocessing
        space, conditions = values.space(), values.conditions
        wanted = [[space.clamp(one) for one in some] for some in (starts or [values.vectors["_vinitialconfig"]], goals)]
        moved = [jittered(conditions, space, some, jitter) for some in wanted]
        values.vectors |= {"_vinitialconfig": np.array(moved[0]).ravel(), "_vgoalconfig": np.array(moved[1]).ravel()}
        status = PlannerStatus("no attempt was allowed; give at least one try")
        for attempt in range(options.maxtries):
            values.numbers["_nrandomgeneratorseed"] = attempt
            traj = Trajectory(self.env, "")
            status = needed_planner(self.env, self.planner).run(values, traj)
            if status:
                if any(map(is_not, itertools.chain(*moved), itertools.chain(*wanted))):
                    self._join(traj, values.groups, wanted, moved)
                return traj
        raise PlanningError(status.description)

    def _join(
        self,
        traj: Trajectory,
        groups: Sequence[Group],
        wanted: Sequence[Sequence[Floats]],
        moved: Sequence[Sequence[Floats]],
    ) -> None:
        """Extend a motion to the original start and goal, in place of which the planner used jittered ones."""
        spec = ConfigurationSpecification.of(groups)
        for end, (asked, used) in enumerate(zip(wanted, moved, strict=True)):
            place = traj.GetNumWaypoints() if end else 0
            reached = traj.GetWaypoint(-1 if end else 0, spec)
            nearest = int(np.argmin([np.abs(one - reached).max() for one in used]))
            is_it = np.abs(used[nearest] - reached).max() < _SAME  # and no goal that came later
            if is_it and (asked[nearest] != used[nearest]).any():
                rest = np.zeros(len(reached))
                new = EndWaypoint(traj, spec, asked[nearest], rest, place)
                has_pose = any(group.kind == AFFINE[0] for group in groups)
                retimer = "LinearTrajectoryRetimer" if has_pose else ""  # the only one for poses
                new.join(new.retimed((1.0, 1.0), retimer, ""))

    def straight(self, points: Floats, dofs: Sequence[int] | None = None) -> Trajectory:
        """Return the fastest motion along straight lines through points (m, n) of joints, or of what is active.

        Raises:
            PlanningError: the retimer finds no times.
        """
        traj = Trajectory(self.env, "")
        traj.set_waypoints(Waypoints(self.groups(dofs), points))
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


def _check(goals: Sequence[Floats], starts: Sequence[Floats], dof: int) -> None:
    if not len(goals):
        raise PlanningError("there is no goal")
    for one in [*goals, *starts]:
        if len(one) != dof or not np.isfinite(one).all():
            raise ArgumentError(f"a goal or start is {one.tolist()}, and should be {dof} finite numbers")

"""Parameters of planners, and their form as OpenRAVE's XML."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_number, checked_numbers, checked_vector
from ravemj.core.transforms import Floats
from ravemj.engine.collision.findings import Findings
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.manipulation.bodies import ALL, FREE, Bodies, Constraint
from ravemj.planning.rrt import MoreGoals
from ravemj.rave.enums import Interval
from ravemj.rave.planning.values import Values, parameters_text
from ravemj.rave.report import CollisionReport
from ravemj.rave.robot import Robot
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.trajectories.layout import count

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class PlannerParameters(ApiObject):
    """A planning problem: the joints that move, the start, the goals and the limits.

    Args:
        other: Parameters to copy. Without them, everything has OpenRAVE's defaults, and no joint moves yet.

    Example:
        >>> params = Planner.PlannerParameters()
        >>> params.SetRobotActiveJoints(robot)
        >>> params.SetGoalConfig([1.2, 0.4])
        >>> planner = RaveCreatePlanner(env, "birrt")
        >>> planner.InitPlan(robot, params)
        True
        >>> trajectory = RaveCreateTrajectory(env, "")
        >>> planner.PlanPath(trajectory) == PlannerStatus.HasSolution
        True
    """

    _internal = ("given", "of", "report", "resolved")

    def __init__(self, other: "PlannerParameters | None" = None) -> None:
        self.given = Values()
        self._extra = ""
        self._env: Environment | None = None
        if other is not None:
            source = checked_kind(other, PlannerParameters, "PlannerParameters: other")
            self.given, self._extra, self._env = source.given.copied(), source._extra, source._env

    @classmethod
    def of(cls, values: Values, defaults: Mapping[str, str]) -> "PlannerParameters":
        """Return parameters with some values, and with default texts for the tags that the values lack."""
        params = cls()
        params.given = values.copied()
        params._extra = "\n".join(f"<{name}>{text}</{name}>" for name, text in {**defaults, **values.tags}.items())
        return params

    def resolved(self) -> Values:
        """Return the values. Elements of the extra text replace what setters have set."""
        return self.given.with_tags(self._extra)

    def SetRobotActiveJoints(self, robot: Robot) -> None:
        """Plan for the active DOFs of a robot, with their current values, limits, weights and resolutions.

        Args:
            robot: The robot. Later changes of it have no effect on these parameters.
        """
        checked_kind(robot, Robot, "SetRobotActiveJoints: robot")
        self.SetConfigurationSpecification(robot.GetEnv(), robot.GetActiveConfigurationSpecification())

    def SetConfigurationSpecification(self, env: "Environment", spec: ConfigurationSpecification) -> None:
        """Plan for joints and poses of bodies, with their current values, limits, weights and resolutions.

        Args:
            env: The environment that contains the bodies.
            spec: The joint values and poses; other groups are left out.
        """
        checked_kind(spec, ConfigurationSpecification, "SetConfigurationSpecification: spec")
        self._env = env
        self.given.state(env, spec.GetTimeDerivativeSpecification(0).GetGroups())

    def GetConfigurationSpecification(self) -> ConfigurationSpecification:
        """Return the layout of a configuration."""
        return ConfigurationSpecification.of(self.given.groups)

    def GetDOF(self) -> int:
        """Return the number of values of a configuration."""
        return count(self.given.groups)

    def _set(self, name: str, values: ArrayLike) -> None:
        self.given.vectors[name] = checked_numbers(values, name).ravel()

    def SetGoalConfig(self, values: ArrayLike) -> None:
        """Set the goal ``values`` [rad or m], shape (GetDOF(),), or several goals one after the other."""
        self._set("_vgoalconfig", values)

    def SetInitialConfig(self, values: ArrayLike) -> None:
        """Set the start ``values`` [rad or m], shape (GetDOF(),), or several starts one after the other."""
        self._set("_vinitialconfig", values)

    def SetInitialConfigVelocities(self, velocities: ArrayLike) -> None:
        """Set the ``velocities`` at the start [rad/s or m/s], shape (GetDOF(),)."""
        self._set("_vinitialconfigvelocities", velocities)

    def SetGoalConfigVelocities(self, velocities: ArrayLike) -> None:
        """Set the ``velocities`` at the goal [rad/s or m/s], shape (GetDOF(),)."""
        self._set("_vgoalconfigvelocities", velocities)

    def SetConfigVelocityLimit(self, velocities: ArrayLike) -> None:
        """Set the limits of ``velocities`` [rad/s or m/s], shape (GetDOF(),)."""
        self._set("_vconfigvelocitylimit", velocities)

    def SetConfigAccelerationLimit(self, accelerations: ArrayLike) -> None:
        """Set the limits of ``accelerations`` [rad/s^2 or m/s^2], shape (GetDOF(),)."""
        self._set("_vconfigaccelerationlimit", accelerations)

    def SetConfigJerkLimit(self, jerks: ArrayLike) -> None:
        """Set the limits of ``jerks`` [rad/s^3 or m/s^3], shape (GetDOF(),)."""
        self._set("_vconfigjerklimit", jerks)

    def SetConfigResolution(self, resolution: ArrayLike) -> None:
        """Set the ``resolution`` of collision tests of lines, a step for each value [rad or m], shape (GetDOF(),)."""
        self._set("_vconfigresolution", resolution)

    def GetConfigVelocityLimit(self) -> Floats:
        """Return the velocity limits [rad/s or m/s], shape (dof,)."""
        return self.given.vectors["_vconfigvelocitylimit"].copy()

    def GetConfigAccelerationLimit(self) -> Floats:
        """Return the acceleration limits [rad/s^2 or m/s^2], shape (dof,)."""
        return self.given.vectors["_vconfigaccelerationlimit"].copy()

    def GetConfigJerkLimit(self) -> Floats:
        """Return the jerk limits [rad/s^3 or m/s^3], shape (dof,)."""
        return self.given.vectors["_vconfigjerklimit"].copy()

    def GetConfigResolution(self) -> Floats:
        """Return the steps in which planners test a line for collisions [rad or m], shape (dof,)."""
        return self.given.vectors["_vconfigresolution"].copy()

    def SetMaxIterations(self, nMaxIterations: int) -> None:
        """Set the maximum number of iterations, ``nMaxIterations``; 0 selects the planner's own."""
        self.given.numbers["_nmaxiterations"] = _whole(nMaxIterations, "nMaxIterations")

    def SetMaxPlanningTime(self, nMaxPlanningTime: int) -> None:
        """Set the maximum time of the planner, ``nMaxPlanningTime`` [ms]; 0 sets no limit."""
        self.given.numbers["_nmaxplanningtime"] = _whole(nMaxPlanningTime, "nMaxPlanningTime")

    def SetStepLength(self, fStepLength: float) -> None:
        """Set the step length ``fStepLength``.

        Trees grow in steps of it, a weighted distance of configurations (``DistMetricFn``); 0 selects OpenRAVE's 0.04.
        Retimers that are called directly round times [s] up to multiples of it; 0 leaves them as they are.
        """
        self.given.numbers["_fsteplength"] = checked_vector([fStepLength], 1, "fStepLength").item()

    def SetRandomGeneratorSeed(self, seed: int) -> None:
        """Set the ``seed`` of random numbers, which makes plans repeatable."""
        self.given.numbers["_nrandomgeneratorseed"] = _whole(seed, "seed")

    def SetPostProcessing(self, plannername: str, plannerparameters: str) -> None:
        """Choose the planner that processes the path.

        Args:
            plannername: The name of a smoother or retimer. If it is empty, the path stays as it is found, without
                times.
            plannerparameters: Its parameters as XML text.
        """
        checked_kind(plannername, str, "SetPostProcessing: plannername", "a text")
        checked_kind(plannerparameters, str, "SetPostProcessing: plannerparameters", "a text")
        self.given.postprocessing = plannername, plannerparameters

    def SetExtraParameters(self, extra: str) -> None:
        """Set further parameters as XML text, in place of an earlier text.

        Args:
            extra: Elements such as ``<_nmaxiterations>100</_nmaxiterations>``. They win over the setters.
        """
        self._extra = checked_kind(extra, str, "SetExtraParameters: extra", "a text")

    def add_constraint(self, constraint: Constraint) -> None:
        """Allow only configurations for which a function returns True.

        When ``constraint`` is called with a configuration, shape (dof,), the robot is there.
        """
        self.given.conditions.constraints.append(constraint)

    def set_goal_sampler(self, sample: Callable[[], Floats | None] | None, probability: float = 0.1) -> None:
        """Let a function give further goals while ``birrt`` plans.

        Args:
            sample: A function that returns a goal of shape (dof,), or None if it has no goal at this time. Goals in
                collision are left out. None removes the function.
            probability: The fraction of the iterations that ask the function. While there is no goal, each one does.
        """
        self.given.goal_sampler = None if sample is None else MoreGoals(sample, probability)

    def _bodies(self) -> Bodies:
        bodies = self.given.bodies
        if bodies is None:
            raise ArgumentError("nothing moves yet; call SetRobotActiveJoints(robot) first", ErrorCode.NotInitialized)
        return bodies

    def SetStateValues(self, values: ArrayLike, options: int = 0) -> int:
        """Move the bodies to a configuration. Values outside the limits are set to the limits.

        Args:
            values: The configuration, shape (GetDOF(),).
            options: Not used.

        Returns:
            0.
        """
        del options
        bodies = self._bodies()
        with bodies.lock:
            bodies.move(self.given.space().clamp(self._checked(values)))
        return 0

    def GetStateFn(self) -> Floats:
        """Return the current configuration of the bodies, shape (dof,).

        Raises:
            ArgumentError: no joint moves yet.
        """
        return self._bodies().values()

    GetStateValues = GetStateFn

    def HasNeighStateFn(self) -> bool:
        """Return whether ``NeighStateFn`` can be called, which needs joints that move."""
        return self.given.bodies is not None

    def NeighStateFn(self, values: ArrayLike, delta: ArrayLike, fromgoal: int = 0) -> dict[str, Any]:
        """Return the sum of a configuration and a displacement, set to the limits where it is outside of them.

        Args:
            values: The configuration, shape (GetDOF(),).
            delta: The displacement, shape (GetDOF(),).
            fromgoal: Not used.

        Returns:
            A dictionary: ``configuration`` is the sum, ``returncode`` is 1.
        """
        del fromgoal
        moved = self.given.space().clamp(self._checked(values) + self._checked(delta))
        return {"configuration": moved, "returncode": 1}

    def DistMetricFn(self, values0: ArrayLike, values1: ArrayLike) -> float:
        """Return the distance of two configurations: the square root of the sum of (weight * difference)^2.

        Args:
            values0: One configuration, shape (GetDOF(),).
            values1: The other configuration, shape (GetDOF(),).
        """
        return self.given.space().distance(self._checked(values0), self._checked(values1))

    def DiffStateFn(self, values0: ArrayLike, values1: ArrayLike) -> Floats:
        """Return ``values0 - values1``. The difference of circular joints is the one within [-pi, pi].

        Args:
            values0: A configuration, shape (GetDOF(),).
            values1: The configuration to subtract, shape (GetDOF(),).
        """
        return self.given.space().difference(self._checked(values0), self._checked(values1))

    def _checked(self, values: ArrayLike) -> Floats:
        numbers, dof = checked_numbers(values, "values").ravel(), self.GetDOF()
        if len(numbers) != dof or not np.isfinite(numbers).all():
            raise ArgumentError(f"values: are {numbers.tolist()}, and should be {dof} finite numbers")
        return numbers

    def CheckPathAllConstraints(
        self,
        q0: ArrayLike,
        q1: ArrayLike,
        dq0: ArrayLike,
        dq1: ArrayLike,
        timeelapsed: float,
        interval: int = Interval.Closed,
        options: int = ALL,
        filterreturn: bool = False,
    ) -> int:
        """Test the straight line between two configurations. The robot moves along it, and stays where the test ends.

        Args:
            q0: The start of the line, shape (GetDOF(),).
            q1: The end of the line, shape (GetDOF(),).
            dq0: Velocities at the start; not used.
            dq1: Velocities at the end; not used.
            timeelapsed: How long the motion takes; not used.
            interval: Which ends of the line count, an ``Interval``.
            options: Which tests to run, bits of ``ConstraintFilterOptions``.
            filterreturn: Not used.

        Returns:
            0 if the line passes, else the bit of ``ConstraintFilterOptions`` of the test that fails.
        """
        del dq0, dq1, timeelapsed, filterreturn
        given, bodies = self.given, self._bodies()
        space, start, end = given.space(), self._checked(q0), self._checked(q1)
        step = space.difference(end, start)
        steps = space.steps(step)
        first = 0 if int(interval) in {Interval.OpenEnd, Interval.Closed} else 1
        last = steps if int(interval) in {Interval.OpenStart, Interval.Closed} else steps - 1
        with bodies.lock:
            for number in range(first, last + 1):
                found = given.conditions.violation(start + step * (number / steps), int(options))
                if found:
                    return found
        return FREE

    def report(self, values: Floats, options: int) -> CollisionReport:
        """Move the bodies to a configuration, and return the collision there; empty if there is none."""
        told: list[Findings] = []
        self.resolved().conditions.violation(values, options, told)
        if self._env is None or not told:
            return CollisionReport()
        return self._env.GetCollisionChecker().report(told[-1])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PlannerParameters) and repr(self) == repr(other)

    __hash__ = None  # pyright: ignore[reportAssignmentType] - parameters change

    def __str__(self) -> str:
        return f"<PlannerParameters, dof={self.GetDOF()}>"

    def __repr__(self) -> str:
        given = self.given
        text = parameters_text(given.groups, given.vectors, given.numbers, given.postprocessing, self._extra)
        return f'Planner.PlannerParameters("""{text}""")'


def _whole(value: int, name: str) -> int:
    number = checked_number(value, name)
    if not number.is_integer():
        raise ArgumentError(f"{name}: is {number}, and should be a whole number")
    return int(number)

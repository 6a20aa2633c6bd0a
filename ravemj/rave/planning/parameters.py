"""The problem of a planner."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.rave.enums import Interval
from ravemj.rave.planning.bodies import FREE, Bodies
from ravemj.rave.planning.parameter_text import parameters_text
from ravemj.rave.planning.values import ALL, Constraint, Values
from ravemj.rave.robot import Robot
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.trajectories.layout import count

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class PlannerParameters(ApiObject):
    """The problem of a planner: what moves, from where, to where, and how far it may go.

    Args:
        other: Parameters to copy; None: OpenRAVE's defaults, and nothing that moves.

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

    _internal = ("given", "of", "resolved")

    def __init__(self, other: "PlannerParameters | None" = None) -> None:
        self.given = Values()
        self._extra = ""
        if other is not None:
            source = checked_kind(other, PlannerParameters, "PlannerParameters: other")
            self.given, self._extra = source.given.copied(), source._extra

    @classmethod
    def of(cls, values: Values, defaults: Mapping[str, str]) -> "PlannerParameters":
        """Return parameters with values, and with further tags where the values lack them."""
        params = cls()
        params.given = values.copied()
        params._extra = "\n".join(f"<{name}>{text}</{name}>" for name, text in {**defaults, **values.tags}.items())
        return params

    def resolved(self) -> Values:
        """Return the values, with those of the extra text in place of others."""
        return self.given.with_tags(self._extra)

    def SetRobotActiveJoints(self, robot: Robot) -> None:
        """Take the active DOFs of a robot with their present values, limits, weights and resolutions.

        Args:
            robot: The robot; what changes of it later is not noticed.
        """
        checked_kind(robot, Robot, "SetRobotActiveJoints: robot")
        self.SetConfigurationSpecification(robot.GetEnv(), robot.GetActiveConfigurationSpecification())

    def SetConfigurationSpecification(self, env: "Environment", spec: ConfigurationSpecification) -> None:
        """Take joints and poses of bodies with their present values, limits, weights and resolutions.

        Args:
            env: Where the bodies are.
            spec: Their joint values and poses; its other groups are left out.
        """
        checked_kind(spec, ConfigurationSpecification, "SetConfigurationSpecification: spec")
        groups = spec.GetTimeDerivativeSpecification(0).GetGroups()
        bodies, given = Bodies(env, groups), self.given
        given.bodies, given.groups, given.weights = bodies, groups, bodies.numbers("weight")
        limits = ("lower", "upper", "max_velocity", "max_acceleration", "max_jerk")
        for name, of_body in zip(("lower", "upper", "velocity", "acceleration", "jerk"), limits, strict=True):
            given.vectors[f"_vconfig{name}limit"] = bodies.numbers(of_body)
        given.vectors["_vconfigresolution"] = bodies.numbers("resolution")
        given.vectors["_vinitialconfig"] = bodies.values()

    def GetConfigurationSpecification(self) -> ConfigurationSpecification:
        """Return what the numbers of a configuration are."""
        return ConfigurationSpecification.of(self.given.groups)

    def GetDOF(self) -> int:
        """Return how many numbers a configuration has."""
        return count(self.given.groups)

    def _set(self, name: str, values: ArrayLike) -> None:
        self.given.vectors[name] = checked_numbers(values, name).ravel()

    def SetGoalConfig(self, values: ArrayLike) -> None:
        """Set the goal, or several one behind the other.

        Args:
            values: Their values, a multiple of ``GetDOF()``.
        """
        self._set("_vgoalconfig", values)

    def SetInitialConfig(self, values: ArrayLike) -> None:
        """Set the start, or several one behind the other, in place of where the robot was.

        Args:
            values: Their values, a multiple of ``GetDOF()``.
        """
        self._set("_vinitialconfig", values)

    def SetInitialConfigVelocities(self, velocities: ArrayLike) -> None:
        """Set the velocities at the start.

        Args:
            velocities: As many as values.
        """
        self._set("_vinitialconfigvelocities", velocities)

    def SetGoalConfigVelocities(self, velocities: ArrayLike) -> None:
        """Set the velocities at the goal.

        Args:
            velocities: As many as values.
        """
        self._set("_vgoalconfigvelocities", velocities)

    def SetConfigVelocityLimit(self, velocities: ArrayLike) -> None:
        """Set the velocity limits.

        Args:
            velocities: A limit for each value.
        """
        self._set("_vconfigvelocitylimit", velocities)

    def SetConfigAccelerationLimit(self, accelerations: ArrayLike) -> None:
        """Set the acceleration limits.

        Args:
            accelerations: A limit for each value.
        """
        self._set("_vconfigaccelerationlimit", accelerations)

    def SetConfigJerkLimit(self, jerks: ArrayLike) -> None:
        """Set the jerk limits.

        Args:
            jerks: A limit for each value.
        """
        self._set("_vconfigjerklimit", jerks)

    def SetConfigResolution(self, resolution: ArrayLike) -> None:
        """Set the steps in which lines are tested.

        Args:
            resolution: A step for each value.
        """
        self._set("_vconfigresolution", resolution)

    def GetConfigVelocityLimit(self) -> Floats:
        """Return the velocity limits, shape (dof,)."""
        return self.given.vectors["_vconfigvelocitylimit"].copy()

    def GetConfigAccelerationLimit(self) -> Floats:
        """Return the acceleration limits, shape (dof,)."""
        return self.given.vectors["_vconfigaccelerationlimit"].copy()

    def GetConfigJerkLimit(self) -> Floats:
        """Return the jerk limits, shape (dof,)."""
        return self.given.vectors["_vconfigjerklimit"].copy()

    def GetConfigResolution(self) -> Floats:
        """Return the steps in which lines are tested, shape (dof,)."""
        return self.given.vectors["_vconfigresolution"].copy()

    def SetMaxIterations(self, nMaxIterations: int) -> None:
        """Set how many iterations a planner has at most.

        Args:
            nMaxIterations: The number; 0: as the planner likes.
        """
        self.given.numbers["_nmaxiterations"] = int(nMaxIterations)

    def SetMaxPlanningTime(self, nMaxPlanningTime: int) -> None:
        """Set how long a planner may take.

        Args:
            nMaxPlanningTime: Time [ms]; 0: any.
        """
        self.given.numbers["_nmaxplanningtime"] = int(nMaxPlanningTime)

    def SetStepLength(self, fStepLength: float) -> None:
        """Set the step length: retimers make all times multiples of it.

        Args:
            fStepLength: The length; 0: any times.
        """
        self.given.numbers["_fsteplength"] = float(fStepLength)

    def SetRandomGeneratorSeed(self, seed: int) -> None:
        """Set the seed of random numbers, which makes plans repeatable.

        Args:
            seed: The seed.
        """
        self.given.numbers["_nrandomgeneratorseed"] = int(seed)

    def SetPostProcessing(self, plannername: str, plannerparameters: str) -> None:
        """Choose the planner that processes paths.

        Args:
            plannername: Its name, a smoother or retimer; empty: paths stay as they are found, without times.
            plannerparameters: Its parameters as XML text.
        """
        self.given.postprocessing = plannername, plannerparameters

    def SetExtraParameters(self, extra: str) -> None:
        """Set further parameters as XML text, in place of those that were set so before.

        Args:
            extra: Elements such as ``<_nmaxiterations>100</_nmaxiterations>``; they count more than what setters set.
        """
        self._extra = checked_kind(extra, str, "SetExtraParameters: extra", "a text")

    def add_constraint(self, constraint: Constraint) -> None:
        """Allow only configurations for which a function returns True.

        Args:
            constraint: The function, of a configuration of shape (dof,). The robot is there when it is called.
        """
        self.given.constraints.append(constraint)

    def set_goal_sampler(self, sample: Callable[[], Floats | None] | None, probability: float = 0.1) -> None:
        """Let a function give further goals while ``birrt`` plans.

        Args:
            sample: Returns a goal of shape (dof,), or None if it has none at this time; goals in collision are left
                out. None: no function.
            probability: The part of the iterations in which it is asked; while there is no goal, in each.
        """
        self.given.goal_sampler = None if sample is None else (sample, probability)

    def _bodies(self) -> Bodies:
        if self.given.bodies is None:
            raise ArgumentError("nothing moves yet; call SetRobotActiveJoints(robot) first", ErrorCode.NotInitialized)
        return self.given.bodies

    def SetStateValues(self, values: ArrayLike, options: int = 0) -> int:
        """Move the bodies; values outside the limits go to them.

        Args:
            values: A configuration.
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
        """Return the present configuration of the bodies."""
        return self._bodies().values()

    GetStateValues = GetStateFn

    def HasNeighStateFn(self) -> bool:
        """Return whether configurations can be added, which they can as soon as something moves."""
        return self.given.bodies is not None

    def NeighStateFn(self, values: ArrayLike, delta: ArrayLike, fromgoal: int = 0) -> dict[str, Any]:
        """Return a configuration some way from another, not beyond the limits.

        Args:
            values: The configuration.
            delta: The way.
            fromgoal: Not used.

        Returns:
            ``configuration``, and ``returncode``: 1.
        """
        del fromgoal
        moved = self.given.space().clamp(self._checked(values) + self._checked(delta))
        return {"configuration": moved, "returncode": 1}

    def DistMetricFn(self, values0: ArrayLike, values1: ArrayLike) -> float:
        """Return the distance of two configurations: the root of the sum of (weight * difference)^2.

        Args:
            values0: One.
            values1: The other.
        """
        return self.given.space().distance(self._checked(values0), self._checked(values1))

    def DiffStateFn(self, values0: ArrayLike, values1: ArrayLike) -> Floats:
        """Return ``values0 - values1``; angles that go round take the short way.

        Args:
            values0: A configuration.
            values1: The one to subtract.
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
        """Return what is wrong with the straight line between two configurations; the robot is moved along it.

        Args:
            q0: Its start.
            q1: Its end.
            dq0: Velocities at the start; not used.
            dq1: Velocities at the end; not used.
            timeelapsed: How long the motion takes; not used.
            interval: Which ends count, an ``Interval``.
            options: What is looked at, ``ConstraintFilterOptions``.
            filterreturn: Not used.

        Returns:
            0: nothing; else a bit of ``ConstraintFilterOptions``.
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
                found = given.problem(start + step * (number / steps), int(options))
                if found:
                    return found
        return FREE

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PlannerParameters) and repr(self) == repr(other)

    __hash__ = None  # pyright: ignore[reportAssignmentType] - parameters change

    def __str__(self) -> str:
        return f"<PlannerParameters, dof={self.GetDOF()}>"

    def __repr__(self) -> str:
        given = self.given
        text = parameters_text(given.groups, given.vectors, given.numbers, given.postprocessing, self._extra)
        return f'Planner.PlannerParameters("""{text}""")'

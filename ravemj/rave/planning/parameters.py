"""Planner parameters, and their XML form in OpenRAVE."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_number, checked_numbers, checked_vector
from ravemj.core.transforms import Floats
from ravemj.engine.collision.findings import Findings
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.manipulation.bodies import ALL, FREE, Bodies
from ravemj.manipulation.options import Certify
from ravemj.manipulation.roots import FunctionRoots, Sampler
from ravemj.rave.enums import Interval
from ravemj.rave.kinbody import KinBody
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.planning.path_constraints import TOLERANCE, constrain
from ravemj.rave.planning.region_goals import region_roots
from ravemj.rave.planning.values import Values, hand_of, parameters_text
from ravemj.rave.region import RegionLike, is_region, regions_of
from ravemj.rave.report import CollisionReport
from ravemj.rave.robot import Robot
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.trajectories.layout import count

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


RootSets = Callable[[], Floats | None] | RegionLike | Sequence[RegionLike] | None
"""Source of starts or goals: regions, or a function that returns a configuration or None."""


def check_movable(robot: Robot) -> None:
    """Check that the active joints of a robot do not move a static link.

    Raises:
        RavemjError: a joint moves a static link (``InvalidState``).
    """
    static = [link for link in robot.GetLinks() if link.IsStatic()]
    for dof in robot.GetActiveDOFIndices() if static else ():
        joint = robot.GetJointFromDOFIndex(dof)
        for link in static:
            if robot.DoesAffect(joint.GetJointIndex(), link.GetIndex()):
                message = f"link '{link.GetName()}' of '{robot.GetName()}' is static, and the active joint"
                hint = "call link.SetStatic(False) or choose other joints"
                raise RavemjError(f"{message} '{joint.GetName()}' would move it; {hint}", ErrorCode.InvalidState)


class PlannerParameters(ApiObject):
    """Planning problem: the joints to move, starts, goals and limits.

    Args:
        other: Parameters to copy. By default, OpenRAVE's defaults without joints to move.

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
        """Return parameters with given values, and with default texts for missing planner-specific parameters."""
        params = cls()
        params.given = values.copied()
        params._extra = "\n".join(f"<{name}>{text}</{name}>" for name, text in {**defaults, **values.tags}.items())
        return params

    def resolved(self) -> Values:
        """Return the values; elements of the extra text override those of setters."""
        return self.given.with_tags(self._extra)

    def SetRobotActiveJoints(self, robot: Robot) -> None:
        """Plan for the active DOFs of a robot, with their current values, limits, weights and resolutions.

        Args:
            robot: The robot. Its later changes have no effect on these parameters.

        Raises:
            openrave_exception: an active joint moves a link that is static (``InvalidState``).
        """
        checked_kind(robot, Robot, "SetRobotActiveJoints: robot")
        check_movable(robot)
        self.SetConfigurationSpecification(robot.GetEnv(), robot.GetActiveConfigurationSpecification())

    def SetConfigurationSpecification(self, env: "Environment", spec: ConfigurationSpecification) -> None:
        """Plan for joints and poses of bodies, with their current values, limits, weights and resolutions.

        Args:
            env: The environment that contains the bodies.
            spec: The joint values and poses; other groups are ignored.
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
        """Set the velocity limits to ``velocities`` [rad/s or m/s], shape (GetDOF(),)."""
        self._set("_vconfigvelocitylimit", velocities)

    def SetConfigAccelerationLimit(self, accelerations: ArrayLike) -> None:
        """Set the acceleration limits to ``accelerations`` [rad/s^2 or m/s^2], shape (GetDOF(),)."""
        self._set("_vconfigaccelerationlimit", accelerations)

    def SetConfigJerkLimit(self, jerks: ArrayLike) -> None:
        """Set the jerk limits to ``jerks`` [rad/s^3 or m/s^3], shape (GetDOF(),)."""
        self._set("_vconfigjerklimit", jerks)

    def SetConfigResolution(self, resolution: ArrayLike) -> None:
        """Set the ``resolution`` of edge collision checks, a step for each value [rad or m], shape (GetDOF(),)."""
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
        """Return the steps of edge collision checks [rad or m], shape (dof,)."""
        return self.given.vectors["_vconfigresolution"].copy()

    def SetMaxIterations(self, nMaxIterations: int) -> None:
        """Set the maximum number of iterations, ``nMaxIterations``; 0 means the planner's default."""
        self.given.numbers["_nmaxiterations"] = _whole(nMaxIterations, "nMaxIterations")

    def SetMaxPlanningTime(self, nMaxPlanningTime: int) -> None:
        """Set the time limit of the planner, ``nMaxPlanningTime`` [ms]; 0 means none."""
        self.given.numbers["_nmaxplanningtime"] = _whole(nMaxPlanningTime, "nMaxPlanningTime")

    def SetStepLength(self, fStepLength: float) -> None:
        """Set the step length ``fStepLength``.

        It is the weighted distance (``DistMetricFn``) by which trees grow; 0 means OpenRAVE's 0.04. Retimers that are
        called directly round times [s] up to multiples of it; 0 means no rounding.
        """
        self.given.numbers["_fsteplength"] = checked_vector([fStepLength], 1, "fStepLength").item()

    def SetRandomGeneratorSeed(self, seed: int) -> None:
        """Set the ``seed`` of random numbers, which makes plans repeatable."""
        self.given.numbers["_nrandomgeneratorseed"] = _whole(seed, "seed")

    def SetPostProcessing(self, plannername: str, plannerparameters: str) -> None:
        """Set the planner that post-processes the path.

        Args:
            plannername: The name of a smoother or retimer. If it is empty, the path is neither smoothed nor timed.
            plannerparameters: Its parameters as XML text.
        """
        checked_kind(plannername, str, "SetPostProcessing: plannername", "a text")
        checked_kind(plannerparameters, str, "SetPostProcessing: plannerparameters", "a text")
        self.given.postprocessing = plannername, plannerparameters

    def SetExtraParameters(self, extra: str) -> None:
        """Set further parameters as XML text, which replaces an earlier one.

        Args:
            extra: Elements such as ``<_nmaxiterations>100</_nmaxiterations>``. They override the setters.
        """
        self._extra = checked_kind(extra, str, "SetExtraParameters: extra", "a text")

    def add_constraint(
        self,
        constraint: object,
        *,
        manip: Manipulator | None = None,
        tolerance: float = TOLERANCE,
        holding: KinBody | None = None,
    ) -> None:
        """Add a constraint on the configurations along the whole path.

        All constraints must hold. Planners project configurations onto regions, and the motion then passes through many
        configurations in the regions without stopping; with other constraints they only reject configurations. OMPL's
        planners do not support regions.

        Args:
            constraint: A ``Region`` for the tool; a function of a configuration, shape (dof,), that returns whether it
                is allowed; an object with such a function ``contains``; or several combined by ``all_of`` or
                ``any_of``. The robot is at the configuration when a function is called.
            manip: The manipulator of the tool for regions; by default the active one of the moving robot.
            tolerance: Tolerance of regions: the maximum norm of ``region.displacement`` [m and rad].
            holding: A body grabbed by the tool, to which regions refer instead of the tool.

        Raises:
            ArgumentError: the constraint has another type, or the planned joints do not move the tool.

        Example:
            Carry a glass upright, tilted by at most 5 degrees:

            >>> bounds = [[-np.inf, np.inf]] * 3 + [[0, 0], [0, 0], [-np.pi, np.pi]]
            >>> params.add_constraint(ravemj.Region(Bw=bounds, lean=np.radians(5)), holding=glass)
        """
        constrain(self.given, constraint, lambda: manip or self._manipulator(), tolerance, holding)

    def _manipulator(self) -> Manipulator:
        bodies, env = self._bodies(), self._env
        robots = [body for body in map(env.wrap, bodies.bodies) if isinstance(body, Robot)] if env else []
        manip = robots[0].GetActiveManipulator() if len(robots) == 1 else None
        if manip is None:
            raise ArgumentError(
                "regions are about a tool: give manip, or plan for one robot with an active manipulator"
            )
        return manip

    def set_goal_sampler(self, sample: RootSets, probability: float = 0.1, *, holding: KinBody | None = None) -> None:
        """Set regions or a function as a source of goals, in addition to those of ``SetGoalConfig``.

        From regions, all planners sample goals before planning, and ``birrt`` also during planning: all IK solutions of
        random poses. Only ``birrt`` calls a function, during planning. The problem must move the arm joints of the
        active manipulator, and its gripper joints if regions have a ``preshape``.

        Args:
            sample: One or more regions, one of which the tool must reach; or a function that returns a goal of shape
                (dof,), or None if it has no goal at this time. Goals in collision are rejected. None removes the
                sampler.
            probability: Probability of sampling a goal in an iteration; 1 until there is a goal.
            holding: A body grabbed by the tool; this body, not the tool, must reach the regions.

        Raises:
            ArgumentError: the list is empty, a position component of a region has no bounds, or other joints move.
        """
        self.given.goal_sampler = self._sampler(sample, probability, holding, "set_goal_sampler: sample")

    def set_start_sampler(self, sample: RootSets, probability: float = 0.1, *, holding: KinBody | None = None) -> None:
        """Set regions or a function as a source of starts, in addition to those of ``SetInitialConfig``.

        After ``SetInitialConfig([])`` only the sampler gives starts; otherwise the current configuration is a start,
        too.

        Args:
            sample: As for ``set_goal_sampler``.
            probability: Probability of sampling a start in an iteration.
            holding: A body grabbed by the tool; this body, not the tool, starts in the regions.
        """
        self.given.start_sampler = self._sampler(sample, probability, holding, "set_start_sampler: sample")

    def _sampler(self, sample: RootSets, probability: float, holding: KinBody | None, name: str) -> Sampler | None:
        if sample is None:
            return None
        if callable(sample) and not is_region(sample):
            return Sampler(FunctionRoots(sample), probability)
        regions = regions_of(sample, name)
        env = self._env
        self._bodies()
        assert env is not None, "the bodies are of an environment"
        return Sampler(region_roots(self.given, hand_of(env, self.given, gripper=True), regions, holding), probability)

    def set_certify(self, certify: Certify = True) -> None:
        """Set whether path planners certify that motions are free of collisions at all times.

        ``trajectory.certificate`` has the result. A path or shortcut that cannot be certified is replaced by one that
        can, if one is found.

        Args:
            certify: Whether to certify; ``"required"`` makes uncertified motions failures.

        Raises:
            ArgumentError: the value is invalid.

        Example:
            >>> params.set_certify()
        """
        if certify not in (True, False, "required"):
            raise ArgumentError(f"certify: is {certify!r}, and should be True, False or 'required'")
        self.given.certify = certify

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
            ArgumentError: there are no joints to move.
        """
        return self._bodies().values()

    GetStateValues = GetStateFn

    def HasNeighStateFn(self) -> bool:
        """Return whether ``NeighStateFn`` can be called: whether there are joints to move."""
        return self.given.bodies is not None

    def NeighStateFn(self, values: ArrayLike, delta: ArrayLike, fromgoal: int = 0) -> dict[str, Any]:
        """Return the sum of a configuration and a displacement, clamped to the limits.

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
        """Return the weighted distance of two configurations: the square root of the sum of (weight * difference)^2.

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
        """Test the straight line between two configurations. The robot stays where the test ends.

        Args:
            q0: The start of the line, shape (GetDOF(),).
            q1: The end of the line, shape (GetDOF(),).
            dq0: Velocities at the start; not used.
            dq1: Velocities at the end; not used.
            timeelapsed: Duration of the motion; not used.
            interval: The end points to include, an ``Interval``.
            options: The tests to run, bits of ``ConstraintFilterOptions``.
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
                violated = given.conditions.violation(start + step * (number / steps), int(options))
                if violated:
                    return violated
        return FREE

    def report(self, values: Floats, options: int) -> CollisionReport:
        """Move the bodies to a configuration and return the collision report; empty if there is no collision."""
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

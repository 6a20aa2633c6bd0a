"""IK models: solvers that find joint values for a tool pose.

Nothing is compiled or stored: a solver is derived in milliseconds on first use. So ``load`` succeeds for every arm that
can be solved, and scripts with ``if not model.load(): model.autogenerate()`` work.
"""

import logging
import operator
import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.compat.databases.solved_joints import InverseKinematicsError, SolvedJoints
from ravemj.compat.databases.visibility import ArmVisibility
from ravemj.compat.refusal import lacking, refusing
from ravemj.errors import RavemjError, UnsupportedError
from ravemj.geometry_functions.ik_types import IkParameterizationType, goal_dof
from ravemj.rave.enums import CheckLimitsAction, IkFilterOptions
from ravemj.rave.environment import Environment
from ravemj.rave.iksolver import IkSolver

COMPILING = "compiling of solvers of inverse kinematics"

_LOG = logging.getLogger("ravemj")
_UNCHECKED = IkFilterOptions.IgnoreSelfCollisions | IkFilterOptions.IgnoreCustomFilters
_WRONG = 1e-8
"""Squared distance from the goal above which a solution is wrong."""


@lacking(COMPILING, "getsourcefilename(read outputlang) show(delay options forceclosure) @getcompiler()")
class InverseKinematicsModel(SolvedJoints):
    """IK model of an arm.

    Args:
        robot: The robot, whose active manipulator is used; None means that of ``manip``.
        iktype: The type of the goals.
        forceikfast: Not used.
        freeindices: DOFs of the arm to sample; None means as few as necessary.
        freejoints: The same as joint names or indices.
        manip: The arm.
        checkpreemptfn: Not used.

    Attributes:
        robot: The robot.
        manip: The arm.
        iktype: The type of the goals, or None.
        freeindices: Sampled DOFs of the arm; None before ``load``.
        solveindices: The other DOFs, which are solved for.
        freeinc: Sampling steps of the free DOFs [rad or m].
        iksolver: The solver, after ``load``.
        ikfeasibility: The reason why the arm cannot be solved, or None.
        statistics: ``generationtime`` [s], after ``load``.

    Raises:
        InverseKinematicsError: the arm does not exist, has a static link, or does not contain a free joint.
        LookupError: a joint name is unknown.

    Example:
        >>> model = databases.inversekinematics.InverseKinematicsModel(robot, IkParameterization.Type.Transform6D)
        >>> if not model.load():
        ...     model.autogenerate()
        >>> values = model.manip.FindIKSolution(T_world_tool, IkFilterOptions.CheckEnvCollisions)
    """

    capability = COMPILING
    ArmVisibility = ArmVisibility
    ikfastproblem = None

    # Life

    def has(self) -> bool:
        """Return whether the model is loaded, and the arm has a solver of its type."""
        solver = self.manip.GetIkSolver()
        return self.iksolver is not None and solver is not None and self.iktype == solver.kind

    def load(
        self, freeinc: ArrayLike | None = None, checkforloaded: bool = True, *args: object, **kwargs: object
    ) -> bool:
        """Set the arm's solver.

        Args:
            freeinc: Sampling step of each free joint [rad or m].
            checkforloaded: Whether to keep an existing solver of this type.
            args: Not used.
            kwargs: Not used.

        Returns:
            Whether the arm can be solved; if not, ``ikfeasibility`` and the log give the reason. A model without a type
            uses that of the arm's solver; without a solver, the result is False, and ``autogenerate`` chooses one.
        """
        del args, kwargs
        present = self.manip.GetIkSolver()
        if self.iktype is None and present is not None:
            self.iktype = present.kind
        try:
            self._solve(keep=checkforloaded)
        except (InverseKinematicsError, RavemjError) as error:
            self.ikfeasibility = str(error)
            _LOG.warning("%s", error)
            return False
        return self.setrobot(freeinc)

    def _solve(self, *, keep: bool) -> None:
        """Derive the solver; if ``keep``, use the arm's present solver if it has the model's goal type.

        Raises:
            InverseKinematicsError: The arm cannot be solved.
            UnsupportedError: Goals of that type are not supported.
        """
        kind, start = self._type(), time.perf_counter()
        present = self.manip.GetIkSolver()
        if keep and present is not None and present.kind == kind:
            free = [self.manip.GetArmIndices().tolist()[joint] for joint in present.derived().free]
            self.iksolver, self.freeindices, self.solveindices = present, free, self._divide(free)
        else:
            self._derive(kind)
        self.ikfeasibility = None
        self.statistics = {"generationtime": time.perf_counter() - start, "usinglapack": False}

    def _derive(self, kind: IkParameterizationType) -> None:
        arm, needed, free = self.manip.GetArmIndices().tolist(), goal_dof(kind), self.freeindices
        usual = self.GetDefaultIndices()[1]
        solve = self._divide(usual if free is None else free)
        if len(solve) > needed or (len(solve) < needed and kind != IkParameterizationType.Transform6D):
            message = f"'{self.manip.GetName()}' has {len(solve)} joints to solve for, and {kind.name} needs {needed}"
            hint = "; name others in freeindices" if len(solve) > needed else ""
            raise InverseKinematicsError(message + hint)
        joints = None if free is None else [arm.index(index) for index in free]
        solver = IkSolver(self.env, self._name(kind), kind, joints)
        if not self.manip.SetIkSolver(solver):
            raise InverseKinematicsError(f"no solver of {kind.name} fits the arm '{self.manip.GetName()}'")
        free_dofs = [arm[joint] for joint in solver.derived().free]
        wanted = usual if free is None else free
        self.iksolver, self.freeindices = solver, wanted if set(wanted) == set(free_dofs) else free_dofs
        self.solveindices = self._divide(self.freeindices)
        if free is not None and set(free) != set(free_dofs):
            message = "'%s': no solver samples the joints %s; that of %s samples %s"
            _LOG.warning(message, self.manip.GetName(), list(free), kind.name, free_dofs or "none")

    def generate(
        self,
        iktype: IkParameterizationType | None = None,
        freejoints: Sequence[str | int] | None = None,
        freeinc: ArrayLike | None = None,
        freeindices: Sequence[int] | None = None,
        *args: object,
        **kwargs: object,
    ) -> None:
        """Derive the solver, and assign it to the arm.

        Args:
            iktype: The type of the goals; by default that of the model, else ``Transform6D``.
            freejoints: Joints to sample, by names or DOF indices.
            freeinc: Sampling step of each [rad or m].
            freeindices: DOFs to sample.
            args: Not used.
            kwargs: Not used.

        Raises:
            InverseKinematicsError: the arm cannot be solved with these options.
            UnsupportedError: goals of that type are not supported.
        """
        del args, kwargs
        if iktype is not None or self.iktype is None:
            self.iktype = IkParameterizationType.Transform6D if iktype is None else IkParameterizationType(iktype)
        if freejoints is not None:
            freeindices = self.getIndicesFromJointNames(freejoints)
        if freeindices is not None:
            self.freeindices = [*map(operator.index, freeindices)]
        try:
            self._solve(keep=False)
        except (InverseKinematicsError, UnsupportedError) as error:
            self.ikfeasibility = str(error)
            raise
        self.setrobot(freeinc)

    def autogenerate(self, options: object = None) -> None:
        """Derive the solver, and assign it to the arm; see ``generate``.

        Args:
            options: Not used.
        """
        del options
        self.generate()

    def save(self, filepermissions: int | None = None) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Do nothing: deriving a solver takes no longer than reading one.

        Args:
            filepermissions: Not used.
        """

    def setrobot(self, freeinc: ArrayLike | None = None) -> bool:
        """Set the sampling steps of free joints; return whether there is a solver.

        Args:
            freeinc: A step for each [rad or m]; by default the present ones, else 0.1 rad and 0.01 of the length of the
                arm.
        """
        if self.iksolver is None:
            return False
        free = self.freeindices or []
        if freeinc is None or not free:
            self.freeinc = self.freeinc or self.getDefaultFreeIncrements(0.1, 0.01)
            return True
        steps = [float(step) for step in np.array(freeinc, dtype=float)]
        if len(steps) != len(free) or not all(step > 0 for step in steps):
            raise InverseKinematicsError(f"freeinc {steps} for the free joints {free}: give one above 0 for each")
        self.freeinc = steps
        self.iksolver.set_steps([step for _, step in sorted(zip(free, steps, strict=True))])
        return True

    setFreeIncrements = setrobot

    def clone(self, envother: Environment) -> "InverseKinematicsModel":
        """Return a model of the same arm in another environment, loaded if this one is, with the default steps.

        Args:
            envother: A clone of the environment.
        """
        robot = envother.GetRobot(self.robot.GetName())
        arm = None if robot is None else robot.GetManipulator(self.manip.GetName())
        if arm is None:
            raise InverseKinematicsError(f"the environment has no robot '{self.robot.GetName()}' with such an arm")
        other = InverseKinematicsModel(iktype=self.iktype, freeindices=self.freeindices, manip=arm)
        if self.has():
            other.load()
        return other

    # Trials

    def testik(self, iktests: str | int, jacobianthreshold: object = None) -> tuple[float, float]:
        """Solve tool poses of random configurations within the limits.

        Args:
            iktests: Number of poses, as a number or string.
            jacobianthreshold: Not used.

        Returns:
            The fraction of solved poses, and the fraction of poses with wrong solutions.

        Raises:
            ValueError: ``iktests`` is not a whole number above 0.
        """
        del jacobianthreshold
        count = int(iktests)
        if count < 1:
            raise ValueError(f"testik: iktests: is {count}, and should be 1 or more")
        goals = self._random_goals(count)
        reached = wrong = 0
        with self.robot:
            for goal in goals:
                values = self.manip.FindIKSolution(goal, _UNCHECKED)
                if values is not None:
                    reached += 1
                    self.robot.SetDOFValues(values, self.manip.GetArmIndices(), CheckLimitsAction.Nothing)
                    wrong += self.manip.GetIkParameterization(goal).ComputeDistanceSqr(goal) > _WRONG
        return reached / len(goals), wrong / len(goals)

    def perftiming(self, num: int) -> list[float]:
        """Measure the time to find all solutions [s], for tool poses of random configurations.

        Args:
            num: Number of poses.
        """
        times: list[float] = []
        for goal in self._random_goals(num):
            start = time.perf_counter()
            self.manip.FindIKSolutions(goal, _UNCHECKED)
            times.append(time.perf_counter() - start)
        return times

    def _random_goals(self, count: int) -> list[Any]:
        kind, indices = self._type(), self.manip.GetArmIndices()
        lower, upper = self.robot.GetDOFLimits(indices)
        goals: list[Any] = []
        with self.robot:
            for values in np.random.default_rng().uniform(lower, upper, (max(1, count), len(indices))):
                self.robot.SetDOFValues(values, indices)
                goals.append(self.manip.GetIkParameterization(kind))
        return goals


run = refusing("inversekinematics.run", COMPILING, "*arguments **named")

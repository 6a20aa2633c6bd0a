"""Solvers that find joint values for a pose of the tool.

Nothing is compiled or stored: a solver is derived in milliseconds when it is asked for. So ``load`` finds one for every
arm that can be solved, and scripts that say ``if not model.load(): model.autogenerate()`` work either way.
"""

import logging
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
"""Squared distance from the goal beyond which a solution is wrong."""


@lacking(COMPILING, "getsourcefilename(read outputlang) show(delay options forceclosure) @getcompiler()")
class InverseKinematicsModel(SolvedJoints):
    """A solver for an arm.

    Args:
        robot: The robot, whose active manipulator is taken; None: that of ``manip``.
        iktype: What of the tool's pose is asked for.
        forceikfast: For OpenRAVE.
        freeindices: DOFs of the arm that are sampled; None: as few as have to be.
        freejoints: The same as names or indices of joints.
        manip: The arm.
        checkpreemptfn: For OpenRAVE.

    Attributes:
        robot: The robot.
        manip: The arm.
        iktype: What of the tool's pose is asked for, or None.
        freeindices: DOFs of the arm that are sampled; None: not known before ``load``.
        solveindices: DOFs that are solved for.
        freeinc: How finely the free ones are sampled [rad or m].
        iksolver: The solver, after ``load``.
        ikfeasibility: Why the arm cannot be solved, or None.
        statistics: ``generationtime`` [s], after ``load``.

    Raises:
        InverseKinematicsError: there is no arm, a link of it is static, or a free joint is outside of it.
        LookupError: there is no joint of that name.

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
        """Return whether the arm has a solver of the model's type, and the model was loaded."""
        solver = self.manip.GetIkSolver()
        return self.iksolver is not None and solver is not None and self.iktype == solver.kind

    def load(
        self, freeinc: ArrayLike | None = None, checkforloaded: bool = True, *args: object, **kwargs: object
    ) -> bool:
        """Give the arm a solver.

        Args:
            freeinc: How finely free joints are sampled [rad or m], one for each.
            checkforloaded: Whether a solver of that type that the arm has is kept.
            args: Not used.
            kwargs: Not used.

        Returns:
            Whether the arm can be solved; if not, ``ikfeasibility`` and the log say why.
        """
        del args, kwargs
        self._type()
        try:
            self._solve(keep=checkforloaded)
        except (InverseKinematicsError, RavemjError) as error:
            self.ikfeasibility = str(error)
            _LOG.warning("%s", error)
            return False
        return self.setrobot(freeinc)

    def _solve(self, *, keep: bool) -> None:
        """Derive the solver, or take the one that the arm has.

        Raises:
            InverseKinematicsError: the arm cannot be solved.
            UnsupportedError: no solver answers goals of that type.
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
        found = [arm[joint] for joint in solver.derived().free]
        wanted = usual if free is None else free
        self.iksolver, self.freeindices = solver, wanted if set(wanted) == set(found) else found
        self.solveindices = self._divide(self.freeindices)

    def generate(
        self,
        iktype: IkParameterizationType | None = None,
        freejoints: Sequence[str | int] | None = None,
        freeinc: ArrayLike | None = None,
        freeindices: Sequence[int] | None = None,
        *args: object,
        **kwargs: object,
    ) -> None:
        """Derive the solver, and give it to the arm.

        Args:
            iktype: What of the tool's pose is asked for; None: what the model was made for, or all of it.
            freejoints: Joints that are sampled, by names or DOF indices.
            freeinc: How finely [rad or m], one for each.
            freeindices: DOFs that are sampled.
            args: For OpenRAVE's compiler.
            kwargs: For OpenRAVE's compiler.

        Raises:
            InverseKinematicsError: the arm cannot be solved so.
            UnsupportedError: no solver answers goals of that type.
        """
        del args, kwargs
        if iktype is not None or self.iktype is None:
            self.iktype = IkParameterizationType.Transform6D if iktype is None else IkParameterizationType(iktype)
        if freejoints is not None:
            freeindices = self.getIndicesFromJointNames(freejoints)
        if freeindices is not None:
            self.freeindices = [int(index) for index in freeindices]
        try:
            self._solve(keep=False)
        except (InverseKinematicsError, UnsupportedError) as error:
            self.ikfeasibility = str(error)
            raise
        self.setrobot(freeinc)

    def autogenerate(self, options: object = None) -> None:
        """Derive the solver, and give it to the arm; see ``generate``.

        Args:
            options: For OpenRAVE's compiler.
        """
        del options
        self.generate()

    def save(self, filepermissions: int | None = None) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Do nothing: to derive a solver takes no longer than to read one.

        Args:
            filepermissions: Not used.
        """

    def setrobot(self, freeinc: ArrayLike | None = None) -> bool:
        """Set how finely free joints are sampled; return whether there is a solver.

        Args:
            freeinc: A step for each [rad or m]; None: as before, or 0.1 rad and 0.01 of the length of the arm.
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
        """Ask for places of the tool in random configurations within the limits.

        Args:
            iktests: How many, as a number or a text.
            jacobianthreshold: Not used.

        Returns:
            The share of places that were reached, and the share of those where the answer was wrong.
        """
        del jacobianthreshold
        goals = self._random_goals(int(iktests))
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
        """Return how long it takes to find all solutions [s], for places of the tool in random configurations.

        Args:
            num: How many places.
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

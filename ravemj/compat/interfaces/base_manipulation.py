"""Motions of joints and tools."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from collections.abc import Sequence

from numpy.typing import ArrayLike

from ravemj.compat.interfaces.helper import Helper, given, several
from ravemj.compat.planningutils import RetimeTrajectory, VerifyTrajectory
from ravemj.compat.refusal import refusing
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers, checked_transform, checked_vector, checked_whole_numbers
from ravemj.core.transforms import Floats
from ravemj.manipulation.options import (
    Certify,
    JitterMotion,
    JointMotion,
    StraightMotion,
    ToolMotion,
    UnsyncMotion,
    chosen,
)
from ravemj.rave.kinbody import KinBody
from ravemj.rave.modules import base_module
from ravemj.rave.modules.base_manipulation import tool_constraints
from ravemj.rave.planning.region_goals import MotionSets
from ravemj.rave.region import is_region, regions_of
from ravemj.rave.robot import Robot
from ravemj.rave.specification import IkParameterization
from ravemj.rave.trajectory import Trajectory

Answer = Trajectory | str | None


class BaseManipulation(Helper):
    """Plans and executes motions of the active DOFs, of an arm, or of its tool.

    Each method starts the motion on the robot's controller and returns before its end; with ``execute=False`` the robot
    does not move. The result is the ``Trajectory`` with ``outputtrajobj=True``, its text with ``outputtraj=True``, else
    None. If no motion is found, it raises ``PlanningError`` with the reason, and the robot does not move.

    Args:
        robot: The robot.
        plannername: The path planner; None or an unknown name selects ``birrt``.
        maxvelmult: Factor of the velocity limits for straight motions.

    Example:
        >>> basemanip = interfaces.BaseManipulation(robot)
        >>> basemanip.MoveActiveJoints(goal=[0.5, 0.3])
        >>> robot.WaitForController(0)
        True
    """

    def __init__(self, robot: Robot, plannername: str | None = None, maxvelmult: float | None = None) -> None:
        module, self._base = base_module(robot.GetEnv())
        super().__init__(robot, plannername, maxvelmult, module, self._base)

    def MoveActiveJoints(
        self,
        goal: ArrayLike | None = None,
        steplength: float | None = None,
        maxiter: int | None = None,
        maxtries: int | None = None,
        execute: bool | None = None,
        outputtraj: bool | None = None,
        goals: Sequence[ArrayLike] | None = None,
        outputtrajobj: bool | None = None,
        jitter: float | None = None,
        releasegil: bool = False,
        postprocessingplanner: str | None = None,
        postprocessingparameters: str | None = None,
        usedynamicsconstraints: bool | None = None,
        initialconfigs: Sequence[ArrayLike] | None = None,
        *,
        certify: Certify | None = None,
        constraints: Sequence[object] | None = None,
        holding: KinBody | str | None = None,
    ) -> Answer:
        """Move the active DOFs to a goal without collisions.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``. ``releasegil`` and
        ``usedynamicsconstraints`` are not used.

        Args:
            goal: Active values.
            steplength: The step of the planner's trees, a weighted distance of configurations; by default 0.04.
            maxiter: Maximum number of iterations; by default 4000.
            maxtries: Number of calls of the planner; by default 2.
            goals: Several alternative goals. They may include regions, see ``Region``, for the tool of the active
                manipulator; its arm joints must then be active. ``goal_index`` of the resulting trajectory says which
                goal was reached; regions come last.
            jitter: Maximum change of values of a start or goal in collision [rad or m]; by default 0.04.
            postprocessingplanner: The smoother; by default OpenRAVE's.
            postprocessingparameters: Its parameters as XML text.
            initialconfigs: Possible starts; by default the present configuration.
            constraints: Constraints along the whole motion; see ``PlannerParameters.add_constraint``.
            holding: As for ``MoveToHandPosition``.
            certify: Whether to certify that the motion is free of collisions at all times: ``trajectory.certificate``
                has the result. The default is True if there are regions, else False. ``"required"`` makes uncertified
                motions errors.

        Raises:
            PlanningError: no motion was found.
            AssertionError: the number of values of a goal is wrong.

        Example:
            >>> traj = basemanip.MoveActiveJoints(goal=[0.5, 0.3], execute=False, outputtrajobj=True)
        """
        del releasegil, usedynamicsconstraints
        dof = self.robot.GetActiveDOF()
        regions = [member for member in several(goals, "goals") if is_region(member)]
        rows = None if goals is None else [member for member in goals if not is_region(member)]
        wanted = _rows("goal" if goals is None else "goals", goal, rows, dof)
        starts = _rows("initialconfigs", None, initialconfigs, dof)
        post = None if postprocessingplanner is None else (postprocessingplanner, postprocessingparameters or "")
        effort = given(maxiter=maxiter, maxtries=maxtries, jitter=jitter, steplength=steplength, certify=certify)
        if regions and certify is None:
            effort["certify"] = True
        with self._base.holding(holding) as held:
            traj = self._base.move_joints(
                wanted,
                chosen(JointMotion, effort),
                starts=starts,
                postprocessing=post,
                sets=_sets(regions or None, several(constraints, "constraints"), held),
            )
        return self._done(traj, execute, outputtraj, outputtrajobj)

    def MoveManipulator(
        self,
        goal: ArrayLike | None = None,
        maxiter: int | None = None,
        execute: bool | None = None,
        outputtraj: bool | None = None,
        maxtries: int | None = None,
        goals: Sequence[ArrayLike] | None = None,
        steplength: float | None = None,
        outputtrajobj: bool | None = None,
        jitter: float | None = None,
        releasegil: bool = False,
        *,
        certify: Certify | None = None,
    ) -> Answer:
        """Move the active manipulator's arm to a goal without collisions; the active DOFs do not matter.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``. ``releasegil`` is not used.

        Args:
            goal: Values of the arm's joints.
            maxiter: Maximum number of iterations; by default 4000.
            maxtries: Number of calls of the planner; by default 2.
            goals: Several alternative goals.
            steplength: The step of the planner's trees, a weighted distance of configurations; by default 0.04.
            jitter: Maximum change of values of a start or goal in collision [rad or m]; by default 0.04.
            certify: As for ``MoveActiveJoints``.

        Raises:
            PlanningError: no motion was found.
            AssertionError: the number of values of a goal is wrong.
        """
        del releasegil
        wanted = _rows("goal" if goals is None else "goals", goal, goals, len(self._base.arm().description.arm_dofs))
        effort = given(maxiter=maxiter, maxtries=maxtries, jitter=jitter, steplength=steplength, certify=certify)
        traj = self._base.move_manipulator(wanted, chosen(JointMotion, effort))
        return self._done(traj, execute, outputtraj, outputtrajobj)

    def MoveToHandPosition(
        self,
        matrices: Sequence[ArrayLike] | None = None,
        affinedofs: int | None = None,
        maxiter: int | None = None,
        maxtries: int | None = None,
        translation: ArrayLike | None = None,
        rotation: ArrayLike | None = None,
        seedik: int | None = None,
        constraintfreedoms: ArrayLike | None = None,
        constraintmatrix: ArrayLike | None = None,
        constrainterrorthresh: float | None = None,
        execute: bool | None = None,
        outputtraj: bool | None = None,
        steplength: float | None = None,
        goalsamples: int | None = None,
        ikparam: IkParameterization | None = None,
        ikparams: Sequence[IkParameterization] | None = None,
        jitter: float | None = None,
        minimumgoalpaths: int | None = None,
        outputtrajobj: bool | None = None,
        postprocessing: tuple[str, str] | None = None,
        jittergoal: float | None = None,
        constrainttaskmatrix: ArrayLike | None = None,
        constrainttaskpose: ArrayLike | None = None,
        goalsampleprob: float | None = None,
        goalmaxsamples: int | None = None,
        goalmaxtries: int | None = None,
        releasegil: bool = False,
        initialconfigs: Sequence[ArrayLike] | None = None,
        freevalues: ArrayLike | None = None,
        *,
        certify: Certify | None = None,
        regions: object = None,
        constraints: Sequence[object] | None = None,
        holding: KinBody | str | None = None,
    ) -> Answer:
        """Move the active manipulator's arm so that its tool reaches a goal, without collisions.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``. ``affinedofs``,
        ``minimumgoalpaths``, ``jittergoal``, ``goalmaxtries``, ``releasegil`` and ``freevalues`` are not used.

        Args:
            matrices: Goal poses ``T_world_tool``: 4x4, 3x4 or 7 numbers each. The motion ends at one of them.
            maxiter: The maximum number of iterations of the planner; by default 4000.
            maxtries: The number of calls of the planner; by default 3.
            translation: A goal point of the tool, in place of a pose.
            rotation: A goal quaternion of the tool, in place of a pose.
            seedik: The number of IK solutions that are goals from the start; by default 8.
            constraintfreedoms: The constraint of the tool along the whole motion, shape (6,): 1 forbids, 0 allows
                the rotations about x, y, z, then the translations along them, of ``constraintmatrix @ T_world_tool @
                constrainttaskmatrix``. By default all are allowed.
            constraintmatrix: ``T_task_world``, the task frame, to whose axes ``constraintfreedoms`` refers; by default
                the world.
            constrainterrorthresh: The tolerance of the constraint [m and rad]; by default 0.001.
            steplength: The step of the planner's trees, a weighted distance of configurations; by default 0.04.
            goalsamples: The maximum number of IK solutions that are goals; by default 40.
            ikparam: A goal of any type.
            ikparams: Several goals of any type.
            jitter: The largest change of each value of a start or goal in collision [rad or m]; by default 0.03. With
                a constraint, starts and goals are not changed.
            postprocessing: The smoother and its parameters; by default OpenRAVE's.
            constrainttaskmatrix: ``T_tool_point``, the constrained frame; by default the frame that coincides with the
                task frame at the start.
            constrainttaskpose: The same as 7 numbers.
            goalsampleprob: Probability of sampling another IK solution in an iteration; by default 0.1.
            goalmaxsamples: As ``goalsamples``.
            initialconfigs: Possible starts of the arm; by default its present values.
            regions: One or more goal regions; ``goal_index`` of the trajectory is the index of the reached one. Poses
                are sampled from them before and during planning.
            constraints: Constraints along the whole motion; see ``PlannerParameters.add_constraint``.
            holding: A body that the arm carries, or its name. It is grabbed during planning if necessary; ``regions``
                and ``constraints`` then refer to its pose instead of the tool's.
            certify: As for ``MoveActiveJoints``.

        Raises:
            PlanningError: no motion was found, or there is no IK solver. The text counts rejected poses of regions by
                cause, like ``status.causes``.
            ArgumentError: the constraint is invalid or incomplete.

        Example:
            >>> basemanip.MoveToHandPosition(matrices=[T_world_tool])

            Carry a glass upright: the tool rotates only about the vertical.

            >>> basemanip.MoveToHandPosition(matrices=[T_world_tool], constraintfreedoms=[1, 1, 0, 0, 0, 0])

            Move the tool to any position in a cube of 10 cm, with any rotation:

            >>> cube = ravemj.Region(T_world_cube, Bw=[[-0.05, 0.05]] * 3 + [[-np.pi, np.pi]] * 3)
            >>> basemanip.MoveToHandPosition(regions=[cube])
        """
        del affinedofs, minimumgoalpaths, jittergoal, goalmaxtries, releasegil, freevalues
        constraint = given(
            constraintfreedoms=constraintfreedoms,
            constraintmatrix=constraintmatrix,
            constrainttaskmatrix=constrainttaskmatrix,
            constrainttaskpose=constrainttaskpose,
            constrainterrorthresh=constrainterrorthresh,
        )
        kind = IkParameterization.Type
        poses = several(matrices, "matrices")
        goals = [IkParameterization(checked_transform(pose, "matrices"), kind.Transform6D) for pose in poses]
        if translation is not None:
            goals.append(IkParameterization(checked_vector(translation, 3, "translation"), kind.Translation3D))
        if rotation is not None:
            goals.append(IkParameterization(checked_vector(rotation, 4, "rotation"), kind.Rotation3D))
        others = [*given(ikparam=ikparam).values(), *several(ikparams, "ikparams")]
        goals += [checked_kind(goal, IkParameterization, "ikparam") for goal in others]
        options = given(
            maxiter=maxiter,
            maxtries=maxtries,
            jitter=jitter,
            steplength=steplength,
            seedik=seedik,
            goalsamples=goalsamples or goalmaxsamples,
            goalsampleprob=goalsampleprob,
            certify=True if certify is None and regions is not None else certify,
        )
        with self._base.holding(holding) as held:
            traj = self._base.move_to_hand_position(
                goals,
                chosen(ToolMotion, options),
                starts=_rows("initialconfigs", None, initialconfigs, len(self._base.arm().description.arm_dofs)),
                postprocessing=postprocessing,
                sets=_sets(regions, [*tool_constraints(constraint), *several(constraints, "constraints")], held),
            )
        return self._done(traj, execute, outputtraj, outputtrajobj, "1")

    def MoveHandStraight(
        self,
        direction: ArrayLike,
        minsteps: int | None = None,
        maxsteps: int | None = None,
        stepsize: float | None = None,
        ignorefirstcollision: float | None = None,
        starteematrix: ArrayLike | None = None,
        greedysearch: bool | None = None,
        execute: bool | None = None,
        outputtraj: bool | None = None,
        maxdeviationangle: float | None = None,
        steplength: float | None = None,
        planner: str | None = None,
        outputtrajobj: bool | None = None,
    ) -> Answer:
        """Move the active manipulator's tool along a straight line with constant orientation, as far as possible.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``. ``greedysearch``, ``steplength`` and
        ``planner`` are not used.

        Args:
            direction: Direction in the world, of any length.
            minsteps: Minimum number of steps; by default 0.
            maxsteps: Maximum number of steps; by default 10000.
            stepsize: Length of a step [m]; by default 0.01.
            ignorefirstcollision: Length at the start in which collisions are ignored [m]; by default 0.1.
            starteematrix: ``T_world_tool`` at the start; by default the present pose.
            maxdeviationangle: Not used; the tool does not turn.

        Raises:
            PlanningError: the minimum number of steps is not reached, or there is no IK solver.

        Example:
            >>> basemanip.MoveHandStraight([0, 0, 1], stepsize=0.01, minsteps=5, maxsteps=10)
        """
        del greedysearch, maxdeviationangle, steplength, planner
        start = None if starteematrix is None else checked_transform(starteematrix, "starteematrix")
        steps = given(
            minsteps=minsteps, maxsteps=maxsteps, stepsize=stepsize, ignorefirstcollision=ignorefirstcollision
        )
        options = chosen(StraightMotion, steps)
        traj = self._base.move_hand_straight(checked_vector(direction, 3, "direction"), options, start)
        return self._done(traj, execute, outputtraj, outputtrajobj)

    def MoveUnsyncJoints(
        self,
        jointvalues: ArrayLike,
        jointinds: Sequence[int],
        maxtries: int | None = None,
        planner: str | None = None,
        maxdivision: int | None = None,
        execute: bool | None = None,
        outputtraj: bool | None = None,
        outputtrajobj: bool | None = None,
    ) -> Answer:
        """Move the active DOFs to a configuration from which other joints can reach ``jointvalues`` without collisions.

        The other joints, those of a hand for instance, are not moved.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``.

        Args:
            jointvalues: The values of the other joints.
            jointinds: Their DOF indices.
            maxtries: Number of attempts; by default 1.
            planner: The planner of the motion; by default ``BasicRRT``.
            maxdivision: Number of steps of the test of the other joints' motion; by default 10.

        Raises:
            PlanningError: no such configuration was found.
            AssertionError: the numbers of values and indices differ, or are 0.
        """
        values = checked_numbers(jointvalues, "jointvalues")
        indices = checked_whole_numbers(jointinds, "jointinds").tolist()
        if not len(values) == len(indices) > 0:
            raise AssertionError(f"jointvalues: are {len(values)}, and there are {len(indices)} jointinds")
        options = chosen(UnsyncMotion, given(maxtries=maxtries, maxdivision=maxdivision, planner=planner))
        traj = self._base.move_unsync_joints(values, indices, options)
        return self._done(traj, execute, outputtraj, outputtrajobj)

    def JitterActive(
        self,
        maxiter: int | None = None,
        jitter: float | None = None,
        execute: bool | None = None,
        outputtraj: bool | None = None,
        outputfinal: bool | None = None,
        outputtrajobj: bool | None = None,
    ) -> tuple[Floats | None, Answer]:
        """Move the active DOFs slightly, out of collision.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``.

        Args:
            maxiter: Maximum number of configurations; by default 5000.
            jitter: Maximum change of each value [rad or m]; by default 0.03.
            outputfinal: Whether to return the final values.

        Returns:
            The final values and the motion, each None if not requested.

        Raises:
            PlanningError: no free configuration was found.
        """
        motion = self._base.jitter_active(chosen(JitterMotion, given(maxiter=maxiter, jitter=jitter)))
        return self._pair(motion, execute, outputtraj, outputfinal, outputtrajobj)

    def TrajFromData(self, data: str | bytes, resettrans: bool | None = None, resettiming: bool | None = None) -> None:
        """Execute a trajectory.

        ``resettrans`` is not used.

        Args:
            data: The trajectory, as ``Trajectory.serialize`` writes it.
            resettiming: Whether to retime it.

        Raises:
            openrave_exception: the data is not a trajectory, or cannot be executed.
        """
        self._base.execute(self._read(data, resettiming))

    def VerifyTrajectory(
        self,
        data: str | bytes,
        resettrans: bool | None = None,
        resettiming: bool | None = None,
        samplingstep: float | None = None,
    ) -> None:
        """Check that a trajectory keeps limits and constraints; see ``planningutils.VerifyTrajectory``.

        ``resettrans`` is not used.

        Args:
            data: The trajectory, as ``Trajectory.serialize`` writes it.
            resettiming: Whether to retime it first.
            samplingstep: Sampling step [s].

        Raises:
            openrave_exception: the check fails, or the data is not a trajectory.
        """
        VerifyTrajectory(None, self._read(data, resettiming), **given(samplingstep=samplingstep))

    def _read(self, data: str | bytes, resettiming: bool | None) -> Trajectory:
        traj = Trajectory(self.robot.GetEnv(), "")
        traj.deserialize(data)
        if resettiming:
            RetimeTrajectory(traj, False)
        return traj

    FindIKWithFilters = refusing(  # by OpenRAVE 0.149, too
        "FindIKWithFilters",
        "inverse kinematics (IK) with filters of its own",
        "self ikparam cone solveall filteroptions",
    )


def _sets(regions: object, constraints: Sequence[object], held: KinBody | None) -> MotionSets:
    return MotionSets(() if regions is None else regions_of(regions, "regions"), constraints, held)


def _rows(name: str, single: ArrayLike | None, many: Sequence[ArrayLike] | None, dof: int) -> list[Floats]:
    rows = [checked_numbers(row, name) for row in [*several(many, name), *given(one=single).values()]]
    for row in rows:
        if row.shape != (dof,) or not dof:
            raise AssertionError(f"{name}: has shape {row.shape}, and should have {dof} values")
    return rows

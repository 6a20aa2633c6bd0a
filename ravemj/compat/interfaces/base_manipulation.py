"""Motions of joints and of the tool."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from collections.abc import Sequence

from numpy.typing import ArrayLike

from ravemj.compat.interfaces.helper import Helper, given, several
from ravemj.compat.planningutils import RetimeTrajectory, VerifyTrajectory
from ravemj.compat.refusal import refusing
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers, checked_transform, checked_vector, checked_whole_numbers
from ravemj.core.transforms import Floats
from ravemj.manipulation.options import JitterMotion, JointMotion, StraightMotion, ToolMotion, UnsyncMotion, chosen
from ravemj.rave.modules import base_module
from ravemj.rave.modules.motions import tool_constraint
from ravemj.rave.robot import Robot
from ravemj.rave.specification import IkParameterization
from ravemj.rave.trajectory import Trajectory

Answer = Trajectory | str | None


class BaseManipulation(Helper):
    """Plans and executes motions of the active DOFs, of an arm, or of its tool.

    Each method gives the robot's controller the motion, and returns before it is over; ``execute=False`` leaves the
    robot alone. It returns the ``Trajectory`` with ``outputtrajobj=True``, its text with ``outputtraj=True``, else
    None. Where there is no motion it raises ``PlanningError``, whose text says why; the robot stays as it is.

    Args:
        robot: The robot.
        plannername: The planner of paths; None, or an unknown name: ``birrt``.
        maxvelmult: Factor of the velocity limits, for straight motions.

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
    ) -> Answer:
        """Move the active DOFs to a goal without collisions.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``. ``releasegil`` and
        ``usedynamicsconstraints`` are not used.

        Args:
            goal: Active values.
            steplength: The step of the planner's trees, a weighted distance of configurations; by default 0.04.
            maxiter: Iterations of the planner; None: 4000.
            maxtries: How often it is asked; None: 2.
            goals: Several goals in place of one; any will do.
            jitter: How far values of a start or goal in collision may be moved [rad or m]; None: 0.04.
            postprocessingplanner: The smoother; None: OpenRAVE's.
            postprocessingparameters: Its parameters as XML text.
            initialconfigs: Where the motion may start; None: where the robot is.

        Raises:
            PlanningError: there is no such motion.
            AssertionError: a goal has not as many values as are active.

        Example:
            >>> traj = basemanip.MoveActiveJoints(goal=[0.5, 0.3], execute=False, outputtrajobj=True)
        """
        del releasegil, usedynamicsconstraints
        dof = self.robot.GetActiveDOF()
        wanted, starts = _rows("goal", goal, goals, dof), _rows("initialconfigs", None, initialconfigs, dof)
        post = None if postprocessingplanner is None else (postprocessingplanner, postprocessingparameters or "")
        options = given(maxiter=maxiter, maxtries=maxtries, jitter=jitter, steplength=steplength)
        traj = self._base.move_joints(wanted, chosen(JointMotion, options), starts=starts, postprocessing=post)
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
    ) -> Answer:
        """Move the arm of the active manipulator to a goal without collisions, whatever is active.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``. ``releasegil`` is not used.

        Args:
            goal: Values of the arm's joints.
            maxiter: Iterations of the planner; None: 4000.
            maxtries: How often the planner is asked; None: 2.
            goals: Several goals in place of one; any will do.
            steplength: The step of the planner's trees, a weighted distance of configurations; by default 0.04.
            jitter: How far values of a start or goal in collision may be moved [rad or m]; None: 0.04.

        Raises:
            PlanningError: there is no such motion.
            AssertionError: a goal has not as many values as the arm has joints.
        """
        del releasegil
        wanted = _rows("goal", goal, goals, len(self._base.arm().description.arm_dofs))
        options = given(maxiter=maxiter, maxtries=maxtries, jitter=jitter, steplength=steplength)
        traj = self._base.move_manipulator(wanted, chosen(JointMotion, options))
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
    ) -> Answer:
        """Move the arm of the active manipulator so that its tool reaches a goal, without collisions.

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
            goalsamples: The largest number of IK solutions that are goals; by default 40.
            ikparam: A goal of any type.
            ikparams: Several goals of any type.
            jitter: The largest change of each value of a start or goal in collision [rad or m]; by default 0.03. With
                a constraint, starts and goals are not changed.
            postprocessing: The smoother and its parameters; None: OpenRAVE's.
            constrainttaskmatrix: ``T_tool_point``, the constrained frame; by default the frame of the tool that is the
                task frame at the start, so that the tool keeps what it has there.
            constrainttaskpose: The same as 7 numbers.
            goalsampleprob: The fraction of the iterations that ask for a further IK solution; by default 0.1.
            goalmaxsamples: As ``goalsamples``.
            initialconfigs: Where the arm may start; None: where it is.

        Raises:
            PlanningError: there is no such motion, or no solver of inverse kinematics.
            ArgumentError: the constraint has numbers of none, or nothing says what it holds.

        Example:
            >>> basemanip.MoveToHandPosition(matrices=[T_world_tool])

            A glass is carried upright: since the start, the tool turns about the vertical only.

            >>> basemanip.MoveToHandPosition(matrices=[T_world_tool], constraintfreedoms=[1, 1, 0, 0, 0, 0])
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
        goals += [checked_kind(one, IkParameterization, "ikparam") for one in others]
        options = given(
            maxiter=maxiter,
            maxtries=maxtries,
            jitter=jitter,
            steplength=steplength,
            seedik=seedik,
            goalsamples=goalsamples or goalmaxsamples,
            goalsampleprob=goalsampleprob,
        )
        traj = self._base.move_to_hand_position(
            goals,
            chosen(ToolMotion, options),
            constraint=tool_constraint(constraint),
            starts=_rows("initialconfigs", None, initialconfigs, len(self._base.arm().description.arm_dofs)),
            postprocessing=postprocessing,
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
        """Move the tool of the active manipulator along a straight line, with its orientation, as far as it goes.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``. ``greedysearch``, ``steplength`` and
        ``planner`` are not used.

        Args:
            direction: Where to, in the world; its length does not count.
            minsteps: How many steps it has to go; None: 0.
            maxsteps: How many it goes at most; None: 10000.
            stepsize: How far a step is [m]; None: 0.01.
            ignorefirstcollision: Way at the start in which collisions do not count [m]; None: 0.1.
            starteematrix: ``T_world_tool`` where it starts; None: where it is.
            maxdeviationangle: Not used; the tool does not turn.

        Raises:
            PlanningError: it does not get that far, or there is no solver of inverse kinematics.

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
        """Move the active DOFs to where other joints can move to values without collisions.

        The other joints, those of a hand for instance, are not moved.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``.

        Args:
            jointvalues: The values of the other joints.
            jointinds: Their DOF indices.
            maxtries: How often a place is looked for; None: once.
            planner: The planner of the motion; None: ``BasicRRT``.
            maxdivision: In how many steps the motion of the other joints is tested; None: 10.

        Raises:
            PlanningError: there is no such place.
            AssertionError: there are not as many values as indices, or none.
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
        """Move the active DOFs a little, out of collision.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``.

        Args:
            maxiter: How many configurations are tried; None: 5000.
            jitter: How far each value may move [rad or m]; None: 0.03.
            outputfinal: Whether to return where it leads.

        Returns:
            Where the motion leads, and the motion; None for what was not asked for.

        Raises:
            PlanningError: there is no such configuration.
        """
        found = self._base.jitter_active(chosen(JitterMotion, given(maxiter=maxiter, jitter=jitter)))
        return self._pair(found, execute, outputtraj, outputfinal, outputtrajobj)

    def TrajFromData(self, data: str | bytes, resettrans: bool | None = None, resettiming: bool | None = None) -> None:
        """Execute a trajectory.

        ``resettrans`` is not used.

        Args:
            data: The trajectory, as ``Trajectory.serialize`` writes it.
            resettiming: Whether it gets new times.

        Raises:
            openrave_exception: this is no trajectory, or it cannot be executed.
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
            resettiming: Whether it gets new times first.
            samplingstep: Steps in which it is looked at [s].

        Raises:
            openrave_exception: it does not, or this is no trajectory.
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


def _rows(name: str, one: ArrayLike | None, many: Sequence[ArrayLike] | None, dof: int) -> list[Floats]:
    """Return goals or starts."""
    rows = [checked_numbers(row, name) for row in [*several(many, name), *given(one=one).values()]]
    for row in rows:
        if row.shape != (dof,) or not dof:
            raise AssertionError(f"{name}: has shape {row.shape}, and should have {dof} values")
    return rows

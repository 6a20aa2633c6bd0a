"""Motions of fingers, and of arms to grasps."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.compat.interfaces.helper import Helper, given
from ravemj.compat.refusal import lacking, refusing
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats
from ravemj.errors import UnsupportedError
from ravemj.manipulation.options import GraspMotion, chosen
from ravemj.manipulation.tool import ToolConstraint
from ravemj.rave.kinbody import KinBody
from ravemj.rave.modules import task_module
from ravemj.rave.modules.grasp_planning import GraspQuery
from ravemj.rave.robot import Robot
from ravemj.rave.specification import IkParameterization
from ravemj.rave.trajectory import Trajectory

_PADDING = "padding of models"

Answer = tuple[Floats | None, Trajectory | str | None]
GraspAnswer = tuple[list[IkParameterization], int, float, Trajectory | str | None]


class TaskManipulation(Helper):
    """Opens and closes the gripper of the active manipulator, and moves its arm to grasps.

    Each method gives the robot's controller the motion, and returns before it is over; ``execute=False`` leaves the
    robot alone. It returns where the motion leads (with ``outputfinal=True``) and the motion (with
    ``outputtrajobj=True``; its text with ``outputtraj=True``), each None if it was not asked for.

    Args:
        robot: The robot.
        plannername: For the module.
        maxvelmult: Factor of the velocity limits.
        graspername: For OpenRAVE.

    Example:
        >>> taskmanip = interfaces.TaskManipulation(robot)
        >>> final, trajectory = taskmanip.CloseFingers(outputfinal=True)
        >>> robot.WaitForController(0)
        True
    """

    def __init__(
        self,
        robot: Robot,
        plannername: str | None = None,
        maxvelmult: float | None = None,
        graspername: str | None = None,
    ) -> None:
        del graspername
        module, self._task = task_module(robot.GetEnv())
        super().__init__(robot, plannername, maxvelmult, module, self._task)

    def ChuckFingers(
        self,
        offset: ArrayLike | None = None,
        movingdir: ArrayLike | None = None,
        execute: bool | None = None,
        outputtraj: bool | None = None,
        outputfinal: bool | None = None,
        coarsestep: float | None = None,
        translationstepmult: float | None = None,
        finestep: float | None = None,
        outputtrajobj: bool | None = None,
        releasegil: bool = False,
    ) -> Answer:
        """Close the gripper: each joint moves until what it moves touches something, or to its limit.

        The class explains ``execute``, ``outputtraj``, ``outputfinal`` and ``outputtrajobj``. ``translationstepmult``
        and ``releasegil`` are not used.

        Args:
            offset: How far each joint goes back from there [rad or m].
            movingdir: For each joint, to which side it moves; None: the closing direction.
            coarsestep: How far joints move between two tests [rad or m]; None: 0.01.
            finestep: Not used; contacts are found to a micrometre.

        Raises:
            AssertionError: there are not as many numbers as joints.
            PlanningError: the robot has no gripper.
        """
        del translationstepmult, finestep, releasegil
        directions, offsets = self._of_gripper("movingdir", movingdir), self._of_gripper("offset", offset)
        found = self._task.close_fingers(directions, offsets, **given(step=coarsestep))
        return self._pair(found, execute, outputtraj, outputfinal, outputtrajobj)

    CloseFingers = ChuckFingers

    def UnchuckFingers(
        self,
        target: KinBody | None = None,
        movingdir: ArrayLike | None = None,
        execute: bool | None = None,
        outputtraj: bool | None = None,
        outputfinal: bool | None = None,
        coarsestep: float | None = None,
        translationstepmult: float | None = None,
        finestep: float | None = None,
        outputtrajobj: bool | None = None,
        releasegil: bool = False,
    ) -> Answer:
        """Open the gripper: each joint moves until what it moves touches something new, or to its limit.

        The class explains ``execute``, ``outputtraj``, ``outputfinal`` and ``outputtrajobj``. ``translationstepmult``,
        ``finestep`` and ``releasegil`` are not used.

        Args:
            target: A held body that is let go.
            movingdir: For each joint, to which side it moves; None: against the closing direction.
            coarsestep: How far joints move between two tests [rad or m]; None: 0.01.

        Raises:
            AssertionError: there are not as many numbers as joints.
            PlanningError: the robot has no gripper.
        """
        del translationstepmult, finestep, releasegil
        directions = self._of_gripper("movingdir", movingdir)
        found = self._task.release_fingers(directions, target, **given(step=coarsestep))
        return self._pair(found, execute, outputtraj, outputfinal, outputtrajobj)

    ReleaseFingers = UnchuckFingers

    def ReleaseActive(
        self,
        movingdir: ArrayLike | None = None,
        execute: bool | None = None,
        outputtraj: bool | None = None,
        outputfinal: bool | None = None,
        translationstepmult: float | None = None,
        finestep: float | None = None,
        outputtrajobj: bool | None = None,
    ) -> Answer:
        """Move the active joints to one side, until what they move touches something new, or to their limits.

        The class explains ``execute``, ``outputtraj``, ``outputfinal`` and ``outputtrajobj``. ``translationstepmult``
        is not used.

        Args:
            movingdir: For each active joint, to which side it moves; None: none moves.
            finestep: How far joints move between two tests [rad or m]; None: 0.01.
        """
        del translationstepmult
        count = len(self.robot.GetActiveDOFIndices())
        directions = np.zeros(count) if movingdir is None else np.atleast_1d(np.asarray(movingdir, dtype=float))
        found = self._task.release_active(directions, **given(step=finestep))
        return self._pair(found, execute, outputtraj, outputfinal, outputtrajobj)

    def _of_gripper(self, name: str, numbers: ArrayLike | None) -> Floats | None:
        """Return a number for each joint of the gripper, or None."""
        if numbers is None:
            return None
        manip = self.robot.GetActiveManipulator()
        count, given_numbers = manip.GetGripperDOF() if manip else 0, np.atleast_1d(np.asarray(numbers, dtype=float))
        if given_numbers.shape != (count,):
            raise AssertionError(f"{name}: has {given_numbers.size} numbers, and the gripper has {count} joints")
        return given_numbers

    def GraspPlanning(
        self,
        graspindices: Mapping[str, int] | None = None,
        grasps: ArrayLike | None = None,
        target: KinBody | None = None,
        approachoffset: float = 0,
        destposes: Sequence[ArrayLike] | None = None,
        seedgrasps: int | None = None,
        seeddests: int | None = None,
        seedik: int | None = None,
        maxiter: int | None = None,
        randomgrasps: bool | None = None,
        randomdests: bool | None = None,
        execute: bool | None = None,
        outputtraj: bool | None = None,
        grasptranslationstepmult: float | None = None,
        graspfinestep: float | None = None,
        outputtrajobj: bool | None = None,
        gmodel: Any = None,  # noqa: ANN401 - any object with a list of grasps
        paddedgeometryinfo: object = None,
        steplength: float | None = None,
        releasegil: bool = False,
    ) -> GraspAnswer:
        """Move the arm to one of given grasps, so that the hand can go straight on to it.

        The gripper goes to the preshape of the grasp. Grasps count that the arm reaches without collisions, from where
        the hand gets on to the target in a straight line, and from where it can take the target to one of
        ``destposes``.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``. ``grasptranslationstepmult``,
        ``graspfinestep`` and ``releasegil`` are not used.

        Args:
            graspindices: The first column of what a grasp has: ``igrasptrans``, the pose of the tool in the target, 12
                numbers by columns (``grasptrans_nocol`` counts more); ``igraspdir``, in the target, or
                ``imanipulatordirection``, in the tool: where the hand comes from, None: the tool's direction;
                ``igrasppreshape``, values of the gripper.
            grasps: The grasps, shape (n, m).
            target: What is grasped.
            approachoffset: How far before the grasp the motion ends [m].
            destposes: Poses for the target, 4x4 or 7 numbers each.
            seedgrasps: How many grasps are goals of one plan; None: 20.
            seeddests: How many poses are looked for, for each grasp; None: 5.
            seedik: How many configurations of a grasp are goals; None: all.
            maxiter: Iterations of the planner; None: 4000.
            randomgrasps: Whether grasps are tried in a random order; None: they are.
            randomdests: Whether poses are; None: they are.
            gmodel: Has ``graspindices``, ``grasps`` and ``target``, for those that are not given.
            paddedgeometryinfo: Not possible here.
            steplength: The step of the planner's trees, a weighted distance of configurations; by default 0.04.

        Returns:
            Goals of the hand, as ``IkParameterization``, with which the target is at one of ``destposes``; the number
            of the grasp; how long the planner took [s]; and the motion, None if it was not asked for.

        Raises:
            PlanningError: no grasp can be reached; its text says why.
            ArgumentError: there are no grasps with poses, or the target is held.

        Example:
            >>> goals, index, seconds, trajectory = taskmanip.GraspPlanning(
            ...     graspindices={"igrasptrans": 0}, grasps=grasps, target=box, approachoffset=0.05)
        """
        del grasptranslationstepmult, graspfinestep, releasegil
        if paddedgeometryinfo is not None:
            raise UnsupportedError("GraspPlanning with paddedgeometryinfo", _PADDING)
        rows = np.atleast_2d(np.asarray(gmodel.grasps if grasps is None and gmodel else grasps, dtype=float))
        body = checked_kind(target or getattr(gmodel, "target", None), KinBody, "GraspPlanning: target")
        columns = graspindices or getattr(gmodel, "graspindices", {})
        options = given(seedgrasps=seedgrasps, seeddests=seeddests, seedik=seedik, maxiter=maxiter)
        options |= given(randomgrasps=randomgrasps, randomdests=randomdests, steplength=steplength)
        options |= {"approachoffset": approachoffset}
        places = [checked_transform(one, "destposes") for one in (() if destposes is None else destposes)]
        plan = self._task.plan_grasp(GraspQuery(body, rows, columns, places, chosen(GraspMotion, options)))
        return plan.goals, plan.number, plan.seconds, self._done(plan.traj, execute, outputtraj, outputtrajobj) or None

    def EvaluateConstraints(
        self,
        freedoms: ArrayLike,
        configs: Sequence[ArrayLike],
        targetframematrix: ArrayLike | None = None,
        targetframepose: ArrayLike | None = None,
        errorthresh: float | None = None,
    ) -> tuple[NDArray[np.int_], Floats]:
        """Project configurations onto a constraint of the tool.

        The constraint is about ``T_task_world @ T_world_tool``, which should have no rotation and no translation along
        some axes: with the inverse of the tool's present pose as frame, the tool keeps its place along these axes.

        Args:
            freedoms: For the rotations about x, y, z and the ways along them, 1 where the constraint holds and 0 where
                the tool is free, shape (6,).
            configs: Active values, those of the arm, shape (n, dof).
            targetframematrix: ``T_task_world``, the frame whose axes count; None: the world.
            targetframepose: The same as 7 numbers.
            errorthresh: The error [m and rad] up to which the constraint counts as kept; None: 0.001.

        Returns:
            After how many steps each configuration keeps it, -1 for those that do not get there, shape (n,); and the
            configurations then, shape (n, dof).

        Raises:
            ArgumentError: the active DOFs are not the joints of the arm.
        """
        frame = targetframematrix if targetframematrix is not None else targetframepose
        T_task_world = np.eye(4) if frame is None else checked_transform(frame, "targetframematrix")
        counted = checked_vector(freedoms, 6, "freedoms")
        dof = self.robot.GetActiveDOF()
        rows = [checked_vector(one, dof, "configs") for one in configs]
        constraint = ToolConstraint(T_task_world, np.eye(4), counted, 1e-3 if errorthresh is None else errorthresh)
        steps, found = self._task.evaluate_constraints(constraint, rows)
        return np.array(steps, dtype=int), np.array(found).reshape(-1, dof)

    SwitchModels = refusing(
        "TaskManipulation.SwitchModels",
        _PADDING,
        "self switchpatterns unregister switchtofat clearpatterns clearmodels update",
    )

    @lacking(_PADDING, "__init__(taskmanip update) __enter__() __exit__(type value traceback)")
    class SwitchState:
        """Padded models in place of bodies for a while."""

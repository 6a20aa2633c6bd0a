"""Gripper motions, and arm motions to grasps."""

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
from ravemj.manipulation.grasps import GraspTable
from ravemj.manipulation.options import GraspMotion, chosen
from ravemj.manipulation.tool import ToolConstraint
from ravemj.rave.kinbody import KinBody
from ravemj.rave.modules import task_module
from ravemj.rave.modules.task_manipulation import GraspQuery, finger_steps
from ravemj.rave.robot import Robot
from ravemj.rave.specification import IkParameterization
from ravemj.rave.trajectory import Trajectory

_PADDING = "padding of models"

Answer = tuple[Floats | None, Trajectory | str | None]
GraspAnswer = tuple[list[IkParameterization], int, float, Trajectory | str | None]


class TaskManipulation(Helper):
    """Opens and closes the gripper of the active manipulator, and moves its arm to grasps.

    Each method starts the motion on the robot's controller and returns before its end; with ``execute=False`` the robot
    does not move. The result is the final values (with ``outputfinal=True``) and the motion (with
    ``outputtrajobj=True``; its text with ``outputtraj=True``), each None if not requested.

    Args:
        robot: The robot.
        plannername: The planner of the module.
        maxvelmult: Factor of the velocity limits.
        graspername: Not used.

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
        """Close the gripper: one joint after the other moves until its links touch something, or to its limit.

        The class explains ``execute``, ``outputtraj``, ``outputfinal`` and ``outputtrajobj``. ``releasegil`` is not
        used. A joint that starts in contact stays.

        Args:
            offset: Distance that each joint moves on after it has stopped, in its direction [rad or m].
                ``outputfinal`` returns the values without it.
            movingdir: Sign of the motion of each joint; None: the closing direction.
            coarsestep: Step of joints between two tests [rad]; None: 0.1.
            translationstepmult: Factor of the steps of sliders [m/rad]; None: 0.1.
            finestep: Contacts are found to a sixteenth of it [rad]; None: a hundredth of ``coarsestep``.

        Raises:
            AssertionError: the number of values is wrong.
            PlanningError: the robot has no gripper.
        """
        del releasegil
        directions, offsets = self._of_gripper("movingdir", movingdir), self._of_gripper("offset", offset)
        steps = given(coarsestep=coarsestep, finestep=finestep, translationstepmult=translationstepmult)
        motion = self._task.close_fingers(directions, offsets, finger_steps(steps))
        return self._pair(motion, execute, outputtraj, outputfinal, outputtrajobj)

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
        """Open the gripper: one joint after the other moves to just before its links touch something, or to its limit.

        The class explains ``execute``, ``outputtraj``, ``outputfinal`` and ``outputtrajobj``. ``releasegil`` is not
        used. Joints that start in contact first leave it.

        Args:
            target: A grabbed body that is released.
            movingdir: Sign of the motion of each joint; None: against the closing direction.
            coarsestep: Step of joints between two tests [rad]; None: 0.1. A contact at the start has to end within it.
            translationstepmult: Factor of the steps of sliders [m/rad]; None: 0.1.
            finestep: Distance kept from contacts [rad]; None: a hundredth of ``coarsestep``.

        Raises:
            AssertionError: there are not as many numbers as joints.
            PlanningError: the robot has no gripper, or a joint cannot leave its contact.
        """
        del releasegil
        directions = self._of_gripper("movingdir", movingdir)
        steps = given(coarsestep=coarsestep, finestep=finestep, translationstepmult=translationstepmult)
        motion = self._task.release_fingers(directions, target, finger_steps(steps))
        return self._pair(motion, execute, outputtraj, outputfinal, outputtrajobj)

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
        """Move the active joints in one direction, until moved links touch something new, or to their limits.

        The class explains ``execute``, ``outputtraj``, ``outputfinal`` and ``outputtrajobj``. ``translationstepmult``
        is not used.

        Args:
            movingdir: Sign of the motion of each active joint; by default none moves.
            finestep: Step between two collision checks [rad or m]; by default 0.01.
        """
        del translationstepmult
        count = len(self.robot.GetActiveDOFIndices())
        directions = np.zeros(count) if movingdir is None else np.atleast_1d(np.asarray(movingdir, dtype=float))
        motion = self._task.release_active(directions, **given(step=finestep))
        return self._pair(motion, execute, outputtraj, outputfinal, outputtrajobj)

    def _of_gripper(self, name: str, numbers: ArrayLike | None) -> Floats | None:
        """Convert an argument to an array with a value for each gripper joint; None stays None."""
        if numbers is None:
            return None
        manip = self.robot.GetActiveManipulator()
        count, given_numbers = manip.GetGripperDOF() if manip else 0, np.atleast_1d(np.asarray(numbers, dtype=float))
        if given_numbers.shape != (count,):
            raise AssertionError(f"{name}: has {given_numbers.size} numbers, and the gripper has {count} joints")
        return given_numbers

    def GraspPlanning(
        self,
        graspindices: Mapping[str, int | Sequence[int]] | None = None,
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
        """Move the arm to one of given grasps, from where the hand can approach in a straight line.

        The gripper moves to the preshape of the grasp. A grasp is valid if the arm reaches it without collisions, the
        hand can approach the target in a straight line, and it can move the target to one of ``destposes``.

        The class explains ``execute``, ``outputtraj`` and ``outputtrajobj``; ``releasegil`` is not used.

        Args:
            graspindices: Column indices of each grasp property, or the first index: ``igrasptrans``, ``T_target_tool``
                as 12 numbers by columns (``grasptrans_nocol`` takes precedence); the approach direction, ``igraspdir``
                in the target or ``imanipulatordirection`` in the tool, by default the tool's direction;
                ``igrasppreshape``, values of the gripper. A row without a pose is simulated as ``Grasper.Grasp`` does,
                from ``igraspdir``, ``igrasppos``, ``igrasproll``, ``igraspstandoff`` and ``ichuckingdirection``.
            grasps: The grasps, shape (n, m).
            target: The body to grasp.
            approachoffset: Distance from the grasp at which the motion ends [m].
            destposes: Poses for the target, 4x4 or 7 numbers each.
            seedgrasps: Number of grasps that are goals of one plan; by default 20.
            seeddests: Number of destinations to find for each grasp; by default 5.
            seedik: Number of IK solutions of a grasp that are goals; by default all.
            maxiter: Maximum number of iterations; by default 4000.
            randomgrasps: Whether to try grasps in random order; by default True.
            randomdests: Whether to try destinations in random order; by default True.
            grasptranslationstepmult: As ``translationstepmult`` of ``Grasper.Grasp``, for simulated grasps.
            graspfinestep: As ``finestep`` of ``Grasper.Grasp``, for simulated grasps.
            gmodel: Supplies ``graspindices``, ``grasps`` and ``target`` if they are not given.
            paddedgeometryinfo: Not supported.
            steplength: The step of the planner's trees, a weighted distance of configurations; by default 0.04.

        Returns:
            Goals of the hand, as ``IkParameterization``, that put the target at ``destposes``; the index of the grasp;
            the planning time [s]; and the motion, None if not requested.

        Raises:
            PlanningError: no grasp can be reached; its text says why.
            ArgumentError: there are no grasp poses, or the target is already grabbed.

        Example:
            >>> goals, index, seconds, trajectory = taskmanip.GraspPlanning(
            ...     graspindices={"igrasptrans": 0}, grasps=grasps, target=box, approachoffset=0.05)
        """
        del releasegil
        if paddedgeometryinfo is not None:
            raise UnsupportedError("GraspPlanning with paddedgeometryinfo", _PADDING)
        rows = np.atleast_2d(np.asarray(gmodel.grasps if grasps is None and gmodel else grasps, dtype=float))
        body = checked_kind(target or getattr(gmodel, "target", None), KinBody, "GraspPlanning: target")
        columns = _first_columns(graspindices or getattr(gmodel, "graspindices", {}))
        options = given(seedgrasps=seedgrasps, seeddests=seeddests, seedik=seedik, maxiter=maxiter)
        options |= given(randomgrasps=randomgrasps, randomdests=randomdests, steplength=steplength)
        options |= given(grasptranslationstepmult=grasptranslationstepmult, graspfinestep=graspfinestep)
        options |= {"approachoffset": approachoffset}
        places = [checked_transform(pose, "destposes") for pose in (() if destposes is None else destposes)]
        plan = self._task.plan_grasp(GraspQuery(body, GraspTable(rows, columns), places, chosen(GraspMotion, options)))
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

        The pose of the tool in a task frame, ``T_task_world @ T_world_tool``, should have no rotation about some axes
        and no translation along some. With the inverse of the tool's present pose as ``T_task_world``, the tool stays
        where it is along these axes.

        Args:
            freedoms: For rotations about x, y, z and translations along them, 1 constrains and 0 leaves free, shape
                (6,).
            configs: Active values, which are the arm's, shape (n, dof).
            targetframematrix: ``T_task_world``, the task frame; by default the world.
            targetframepose: The same as 7 numbers.
            errorthresh: Tolerance of the constraint [m and rad]; by default 0.001.

        Returns:
            The number of projection steps of each configuration, -1 if it fails, shape (n,); and the projected
            configurations, shape (n, dof).

        Raises:
            ArgumentError: the active DOFs are not the joints of the arm.
        """
        frame = targetframematrix if targetframematrix is not None else targetframepose
        T_task_world = np.eye(4) if frame is None else checked_transform(frame, "targetframematrix")
        counted = checked_vector(freedoms, 6, "freedoms")
        dof = self.robot.GetActiveDOF()
        rows = [checked_vector(config, dof, "configs") for config in configs]
        constraint = ToolConstraint(T_task_world, np.eye(4), counted, 1e-3 if errorthresh is None else errorthresh)
        steps, projected = self._task.evaluate_constraints(constraint, rows)
        return np.array(steps, dtype=int), np.array(projected).reshape(-1, dof)

    SwitchModels = refusing(
        "TaskManipulation.SwitchModels",
        _PADDING,
        "self switchpatterns unregister switchtofat clearpatterns clearmodels update",
    )

    @lacking(_PADDING, "__init__(taskmanip update) __enter__() __exit__(type value traceback)")
    class SwitchState:
        """Context manager that replaces bodies by padded models; not supported."""


def _first_columns(columns: Mapping[str, int | Sequence[int]]) -> dict[str, int]:
    """Return the first column index of each property; properties without columns are omitted."""
    columns_by_name = {name: np.ravel(part) for name, part in columns.items()}
    return {name: int(part[0]) for name, part in columns_by_name.items() if part.size}

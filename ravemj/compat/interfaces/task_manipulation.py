"""Motions of fingers."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from types import TracebackType

import numpy as np
from numpy.typing import ArrayLike

from ravemj.compat.interfaces.helper import Helper, given
from ravemj.core.transforms import Floats
from ravemj.errors import UnsupportedError
from ravemj.rave.kinbody import KinBody
from ravemj.rave.modules import task_module
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import Trajectory

Answer = tuple[Floats | None, Trajectory | str | None]


class TaskManipulation(Helper):
    """Opens and closes the gripper of the active manipulator.

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

        Args:
            offset: How far each joint goes back from there [rad or m].
            movingdir: For each joint, to which side it moves; None: the closing direction.
            execute: False leaves the robot alone.
            outputtraj: Whether to return the motion's text.
            outputfinal: Whether to return where it leads.
            coarsestep: How far joints move between two tests [rad or m]; None: 0.01.
            translationstepmult: Not used.
            finestep: Not used; contacts are found to a micrometre.
            outputtrajobj: Whether to return the motion.
            releasegil: Not used.

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

        Args:
            target: A held body that is let go.
            movingdir: For each joint, to which side it moves; None: against the closing direction.
            execute: False leaves the robot alone.
            outputtraj: Whether to return the motion's text.
            outputfinal: Whether to return where it leads.
            coarsestep: How far joints move between two tests [rad or m]; None: 0.01.
            translationstepmult: Not used.
            finestep: Not used.
            outputtrajobj: Whether to return the motion.
            releasegil: Not used.

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

        Args:
            movingdir: For each active joint, to which side it moves; None: none moves.
            execute: False leaves the robot alone.
            outputtraj: Whether to return the motion's text.
            outputfinal: Whether to return where it leads.
            translationstepmult: Not used.
            finestep: How far joints move between two tests [rad or m]; None: 0.01.
            outputtrajobj: Whether to return the motion.
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
        graspindices: object = None,
        grasps: object = None,
        target: object = None,
        approachoffset: float = 0,
        destposes: object = None,
        seedgrasps: object = None,
        seeddests: object = None,
        seedik: object = None,
        maxiter: object = None,
        randomgrasps: object = None,
        randomdests: object = None,
        execute: object = None,
        outputtraj: object = None,
        grasptranslationstepmult: object = None,
        graspfinestep: object = None,
        outputtrajobj: object = None,
        gmodel: object = None,
        paddedgeometryinfo: object = None,
        steplength: object = None,
        releasegil: bool = False,
    ) -> None:
        """Refuse to plan a grasp."""
        raise UnsupportedError("interfaces.TaskManipulation.GraspPlanning", "planning of grasps")

    def EvaluateConstraints(
        self,
        freedoms: object,
        configs: object,
        targetframematrix: object = None,
        targetframepose: object = None,
        errorthresh: object = None,
    ) -> None:
        """Refuse to project configurations onto constraints of the tool."""
        raise UnsupportedError(
            "interfaces.TaskManipulation.EvaluateConstraints", "planning with constraints of the tool"
        )

    def SwitchModels(
        self,
        switchpatterns: object = None,
        unregister: object = None,
        switchtofat: object = None,
        clearpatterns: object = None,
        clearmodels: object = None,
        update: object = None,
    ) -> None:
        """Refuse to put other models in place of bodies."""
        raise UnsupportedError("interfaces.TaskManipulation.SwitchModels", "padding of models")

    class SwitchState:
        """Refuses to put padded models in place of bodies for a while."""

        def __init__(self, taskmanip: "TaskManipulation", update: bool = True) -> None:
            raise UnsupportedError("interfaces.TaskManipulation.SwitchState", "padding of models")

        def __enter__(self) -> None: ...

        def __exit__(
            self, type: "type[BaseException] | None", value: BaseException | None, traceback: TracebackType | None
        ) -> None: ...

"""Rows of a grasp table: tool poses, preshapes and simulated grasps."""

import time
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.compat.databases.grasp_rays import ApproachRays
from ravemj.compat.interfaces import BaseManipulation, Grasper
from ravemj.compat.interfaces.grasper import GraspResult
from ravemj.core.transforms import Floats
from ravemj.geometry_functions.affine import DOFAffine
from ravemj.rave.link import Link
from ravemj.rave.planning.planner import PlanningError
from ravemj.rave.robot import Robot

Final = tuple[Floats, Floats | None]
Run = tuple[Floats, Final, float | None, float | None]


class GraspUse(ApproachRays):
    """Poses, preshapes and simulations of the rows of a grasp table; `GraspingModel` makes the table."""

    grasps: Floats
    graspindices: Mapping[str, Sequence[int]]
    grasper: Grasper | None
    basemanip: BaseManipulation | None
    translationstepmult: float | None
    finestep: float | None

    # Parts of a grasp

    def _part(self, grasp: ArrayLike, name: str) -> Floats:
        return np.asarray(grasp, dtype=float)[list(self.graspindices[name])]

    def getPreshape(self, grasp: ArrayLike) -> Floats:
        """Return the values of the gripper joints before they close.

        Args:
            grasp: A row of ``grasps``.
        """
        return self._part(grasp, "igrasppreshape")

    def setPreshape(self, grasp: ArrayLike) -> None:
        """Set the gripper joints to the preshape.

        Args:
            grasp: A row of ``grasps``.
        """
        self._set_gripper(self.getPreshape(grasp))

    def setFinalFingerValues(self, grasp: ArrayLike) -> None:
        """Set the gripper joints to their values after closing.

        Args:
            grasp: A row of ``grasps``.
        """
        self._set_gripper(self._part(grasp, "igraspfinalfingers"))

    def _set_gripper(self, values: Floats) -> None:
        indices = self.manip.GetGripperIndices()
        if len(indices):
            self.robot.SetDOFValues(values, indices)

    def GetLocalGraspTransform(self, grasp: ArrayLike, collisionfree: bool = False) -> Floats:
        """Return the tool pose of a grasp in the target's frame, ``T_target_tool``, shape (4, 4).

        Args:
            grasp: A row of ``grasps``.
            collisionfree: Whether the pose is moved back until the open hand is free of the target.
        """
        T = np.eye(4)
        T[:3] = self._part(grasp, "grasptrans_nocol" if collisionfree else "igrasptrans").reshape(4, 3).T
        return T

    def getGlobalGraspTransform(self, grasp: ArrayLike, collisionfree: bool = False) -> Floats:
        """Return the tool pose of a grasp for the target's current pose, ``T_world_tool``, shape (4, 4).

        Args:
            grasp: A row of ``grasps``.
            collisionfree: Whether the pose is moved back until the open hand is free of the target.
        """
        return self.target.GetTransform() @ self.GetLocalGraspTransform(grasp, collisionfree)

    def getGlobalApproachDir(self, grasp: ArrayLike) -> Floats:
        """Return the direction in which the hand moves to the target, in the world, shape (3,).

        Args:
            grasp: A row of ``grasps``.
        """
        return self.target.GetTransform()[:3, :3] @ self._part(grasp, "igraspdir")

    # Closing the hand

    def _ready_grasper(self) -> Grasper:
        if self.grasper is None:
            self.init(friction=0.3, avoidlinks=[], plannername=None)
        assert self.grasper is not None
        return self.grasper

    def init(self, friction: float | None, avoidlinks: Sequence[Any] | None, plannername: str | None = None) -> None:
        """Create the planning helpers ``grasper`` and ``basemanip``.

        Args:
            friction: Friction coefficient of hand and target.
            avoidlinks: Links that must not touch the target.
            plannername: Name of the grasp planner.
        """
        self.basemanip = BaseManipulation(self.robot)
        self.grasper = Grasper(
            self.robot,
            friction=0.3 if friction is None else friction,
            avoidlinks=list(avoidlinks or []),
            plannername=plannername,
        )

    def runGrasp(
        self,
        grasp: ArrayLike,
        graspingnoise: float | None = 0.0,
        translate: bool = True,
        forceclosure: bool = False,
        translationstepmult: float | None = None,
        finestep: float | None = None,
    ) -> Run:
        """Simulate a grasp: the hand moves to the target and closes. The robot is restored afterwards.

        Args:
            grasp: A row of ``grasps``.
            graspingnoise: Random displacement of the target [m].
            translate: Whether the hand may translate towards the target; otherwise only the fingers move.
            forceclosure: Whether to compute ``mindist`` and ``volume``.
            translationstepmult: Factor of the steps for sliders and the hand's translation [m/rad]; None: the model's.
            finestep: Tolerance of contacts [rad]; None: the model's.

        Returns:
            Contacts (n, 6), joint values and ``T_world_robot``, ``mindist``, ``volume``; the last two are None if they
            were not requested.

        Raises:
            PlanningError: the grasp fails; its text says why.
        """
        with self.robot:
            self.robot.SetActiveManipulator(self.manip)
            self.robot.SetTransform(np.eye(4))
            self.setPreshape(grasp)
            moving = DOFAffine.X | DOFAffine.Y | DOFAffine.Z if translate else DOFAffine.NoTransform
            self.robot.SetActiveDOFs(self.manip.GetGripperIndices(), moving)
            plane = self._part(grasp, "vintersectplane")
            answer = self._ready_grasper().Grasp(
                direction=self._part(grasp, "igraspdir"),
                roll=float(self._part(grasp, "igrasproll")[0]),
                position=self._part(grasp, "igrasppos"),
                standoff=float(self._part(grasp, "igraspstandoff")[0]),
                manipulatordirection=self._part(grasp, "imanipulatordirection"),
                chuckingdirection=self._part(grasp, "ichuckingdirection"),
                vintersectplane=plane if plane.any() else None,
                target=self.target,
                graspingnoise=graspingnoise or 0.0,
                forceclosure=forceclosure,
                execute=False,
                outputfinal=True,
                translationstepmult=translationstepmult or self.translationstepmult,
                finestep=finestep or self.finestep,
            )
        return _closed(answer)

    def runGraspFromTrans(self, grasp: ArrayLike, finestep: float | None = None) -> Run:
        """Close the hand at the stored tool pose of a grasp. The robot is placed there, and restored afterwards.

        Args:
            grasp: A row of ``grasps``.
            finestep: Tolerance of contacts [rad]; None: the model's.

        Returns:
            As `runGrasp`; no contacts for a hand without joints.

        Raises:
            PlanningError: the fingers cannot close; its text says why.
        """
        if not self.manip.GetGripperDOF():
            return np.zeros((0, 6)), (self.robot.GetDOFValues(), None), None, None
        with self.robot:
            self.robot.SetActiveManipulator(self.manip)
            self.setPreshape(grasp)
            self._place_hand(self.getGlobalGraspTransform(grasp))
            self.robot.SetActiveDOFs(self.manip.GetGripperIndices())
            answer = self._ready_grasper().Grasp(
                transformrobot=False,
                target=self.target,
                chuckingdirection=self._part(grasp, "ichuckingdirection"),
                forceclosure=False,
                execute=False,
                outputfinal=True,
                translationstepmult=self.translationstepmult,
                finestep=finestep or self.finestep,
            )
        return _closed(answer)

    def _place_hand(self, T_world_tool: Floats) -> None:
        """Move the whole robot so that its tool pose is ``T_world_tool``."""
        self.robot.SetTransform(T_world_tool @ np.linalg.inv(self.manip.GetTransform()) @ self.robot.GetTransform())

    def testGrasp(
        self,
        graspingnoise: float | None = None,
        Ngraspingtries: int = 20,
        forceclosurethreshold: float = 1e-9,
        **kwargs: Any,  # noqa: ANN401 - arguments of runGrasp
    ) -> Run:
        """Simulate a grasp, and repeat it with noise; ``mindist`` is 0 if the results differ too much.

        They differ too much if their deviation exceeds 0.7 of the noise. The deviation is the standard deviation of the
        robot's coordinates, averaged over x, y, z, plus that of the gripper's joint values times ``jointmaxlengths``,
        averaged over the joints.

        Args:
            graspingnoise: Random displacement of the target [m].
            Ngraspingtries: Number of runs with noise.
            forceclosurethreshold: Minimum ``mindist`` of grasps that are repeated with noise.
            kwargs: Arguments of `runGrasp`.

        Returns:
            As `runGrasp`.

        Raises:
            PlanningError: the grasp fails without noise.
        """
        contacts, final, mindist, volume = self.runGrasp(graspingnoise=0.0, **kwargs)
        if not graspingnoise or (mindist is not None and mindist < forceclosurethreshold):
            return contacts, final, mindist, volume
        try:
            runs = [self.runGrasp(graspingnoise=graspingnoise, **kwargs)[1] for _ in range(Ngraspingtries)]
        except PlanningError:
            return contacts, final, 0.0, volume
        indices = list(self.manip.GetGripperIndices())
        places = np.array([T[:3, 3] for _, T in runs if T is not None])
        fingers = np.array([values[indices] for values, _ in runs])
        deviation = float(places.std(axis=0).mean() + (fingers.std(axis=0) * self.jointmaxlengths).mean())
        return contacts, final, mindist if deviation <= 0.7 * graspingnoise else 0.0, volume

    @property
    def jointmaxlengths(self) -> Floats:
        """Largest distance of the moved link's points from the axis of each gripper joint [m]; 1 for sliders."""
        return np.array([_reach(self.robot, int(index)) for index in self.manip.GetGripperIndices()])

    def moveToPreshape(
        self,
        grasp: ArrayLike,
        execute: bool | None = True,
        outputtraj: bool | None = None,
        outputtrajobj: bool | None = None,
    ) -> Any:  # noqa: ANN401 - as MoveActiveJoints
        """Move the arm to a configuration in which the gripper can open, then the gripper to the preshape.

        Args:
            grasp: A row of ``grasps``.
            execute: Whether the robot moves.
            outputtraj: Whether to return the motion of the gripper as text.
            outputtrajobj: Whether to return the motion of the gripper as a ``Trajectory``.

        Raises:
            PlanningError: no motion without collisions was found.
        """
        if self.basemanip is None:
            self._ready_grasper()
        assert self.basemanip is not None
        preshape, indices = self.getPreshape(grasp), self.manip.GetGripperIndices()
        with self.robot:
            self.robot.SetActiveDOFs(self.manip.GetArmIndices())
            if len(indices) and len(self.manip.GetArmIndices()):
                self.basemanip.MoveUnsyncJoints(jointvalues=preshape, jointinds=indices.tolist(), execute=execute)
        self._wait()
        with self.robot:
            self.robot.SetActiveDOFs(indices)
            answer = self.basemanip.MoveActiveJoints(
                goal=preshape, execute=execute, outputtraj=outputtraj, outputtrajobj=outputtrajobj
            )
        self._wait()
        return answer

    def _wait(self) -> None:
        controller = self.robot.GetController()
        while controller is not None and not controller.IsDone():
            time.sleep(0.01)


def _closed(answer: GraspResult) -> Run:
    contacts, final, mindist, volume = answer
    assert final is not None, "outputfinal is on"
    return contacts, final, mindist, volume


def _reach(robot: Robot, index: int) -> float:
    """Return the largest distance [m] of child link and next joints from a joint's axis; 1 for prismatic joints."""
    joint = robot.GetJointFromDOFIndex(index)
    if joint.IsPrismatic(index - joint.GetDOFIndex()):
        return 1.0
    link, anchor, axis = joint.GetHierarchyChildLink(), joint.GetAnchor(), joint.GetAxis()
    next_ones = [other.GetAnchor() for other in robot.GetJoints() if other.GetHierarchyParentLink() == link]
    points = np.concatenate([_vertices(link), np.array(next_ones).reshape(-1, 3)]) - anchor
    return float(np.linalg.norm(np.cross(points, axis), axis=1).max(initial=0.0))


def _vertices(link: Link) -> Floats:
    mesh, T = link.GetCollisionData(), link.GetTransform()
    return np.asarray(mesh.vertices, float).reshape(-1, 3) @ T[:3, :3].T + T[:3, 3]

"""Grasps that a robot can reach at the target's current pose, and drawings of grasps."""

import sys
import time
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.compat.databases.grasp_use import Final, GraspUse
from ravemj.compat.databases.visibility import GripperVisibility
from ravemj.core.transforms import Floats
from ravemj.geometry_functions.boxes import Ray
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.manipulation.grasping.wrenches import friction_cones
from ravemj.rave.enums import IkFilterOptions
from ravemj.rave.planning.planner import PlanningError
from ravemj.rave.specification import IkParameterization


class ValidGrasp(NamedTuple):
    """Reachable grasp.

    Attributes:
        grasp: The row.
        number: Its index in ``grasps``.
        contacts: Positions and normals, shape (n, 6); empty without simulation of the fingers.
        final: Joint values and ``T_world_robot`` after closing; without simulation, the present joint values and None.
    """

    grasp: Floats
    number: int
    contacts: Floats
    final: Final


class ValidGrasps(GraspUse):
    """Reachable grasps of a table; `GraspingModel` makes the table."""

    GripperVisibility = GripperVisibility

    # Grasps that can be reached

    def computeValidGrasps(
        self,
        startindex: int = 0,
        checkcollision: bool = True,
        checkik: bool = True,
        checkgrasper: bool = True,
        backupdist: float = 0.0,
        returnnum: float = np.inf,
    ) -> tuple[list[Floats], list[int]]:
        """Return the grasps that are reachable at the target's current pose, in the order of the table.

        Args:
            startindex: First row.
            checkcollision: Whether hand and arm have to be free.
            checkik: Whether the arm has to reach the pose.
            checkgrasper: Whether the fingers have to close on the target.
            backupdist: Distance [m]; the tool pose moved back by it along the approach has to be valid as well.
            returnnum: Maximum number of grasps.

        Returns:
            Rows, and their indices.
        """
        accepted: list[ValidGrasp] = []
        rows = range(startindex, len(self.grasps))
        for valid in self._valid(rows, checkcollision, checkik, checkgrasper, backupdist):
            accepted.append(valid)
            if len(accepted) >= returnnum:
                break
        return [valid.grasp for valid in accepted], [valid.number for valid in accepted]

    def validGraspIterator(
        self,
        startindex: int = 0,
        checkcollision: bool = True,
        checkik: bool = True,
        checkgrasper: bool = True,
        backupdist: float = 0.0,
        randomgrasps: bool = False,
        returnfinal: bool = False,
    ) -> Iterator[Any]:
        """Yield the grasps that are reachable at the target's current pose, each as soon as it is found.

        Args:
            startindex: First row.
            checkcollision: Whether hand and arm have to be free.
            checkik: Whether the arm has to reach the pose.
            checkgrasper: Whether the fingers have to close on the target.
            backupdist: Distance [m]; the tool pose moved back by it along the approach has to be valid as well.
            randomgrasps: Whether the order is random.
            returnfinal: Whether to yield contacts and the final configuration as well.

        Yields:
            Row and index; with ``returnfinal`` also contacts (n, 6), joint values and ``T_world_robot``.
        """
        rows = np.arange(startindex, len(self.grasps))
        order = np.random.default_rng().permutation(rows) if randomgrasps else rows
        for valid in self._valid(order.tolist(), checkcollision, checkik, checkgrasper, backupdist):
            yield tuple(valid) if returnfinal else (valid.grasp, valid.number)

    def _valid(
        self, rows: Iterable[int], checkcollision: bool, checkik: bool, checkgrasper: bool, backupdist: float
    ) -> Iterator[ValidGrasp]:
        for index in rows:
            grasp = self.grasps[index]
            with self.robot:
                valid = self._validated(grasp, index, checkcollision, checkik, checkgrasper, backupdist)
            if valid is not None:
                yield valid

    def _validated(
        self, grasp: Floats, index: int, checkcollision: bool, checkik: bool, checkgrasper: bool, backupdist: float
    ) -> ValidGrasp | None:
        """Return a grasp if it passes the requested checks, else None; the robot is not restored."""
        self.robot.SetActiveManipulator(self.manip)
        self.setPreshape(grasp)
        T = self.getGlobalGraspTransform(grasp, collisionfree=True)
        poses = [T]
        if backupdist > 0:
            poses.append(T.copy())
            poses[1][:3, 3] -= backupdist * self.getGlobalApproachDir(grasp)
        reached = self._has_ik if checkik else self._is_free if checkcollision else None
        if reached is not None and not all(reached(pose, checkcollision) for pose in poses):
            return None
        if not (checkcollision and checkgrasper):
            return ValidGrasp(grasp, index, np.zeros((0, 6)), (self.robot.GetDOFValues(), None))
        try:
            contacts, final, _, _ = self.runGraspFromTrans(grasp)
        except PlanningError:
            return None
        return ValidGrasp(grasp, index, contacts, final)

    def _has_ik(self, T_world_tool: Floats, checkcollision: bool) -> bool:
        options = IkFilterOptions.CheckEnvCollisions if checkcollision else 0
        return self.manip.FindIKSolution(self._goal(T_world_tool), options) is not None

    def _is_free(self, T_world_tool: Floats, checkcollision: bool) -> bool:
        del checkcollision
        return not self.manip.CheckEndEffectorCollision(T_world_tool)

    def _goal(self, T_world_tool: Floats) -> Floats | IkParameterization:
        """Return the arm's IK goal: the tool pose, or a ray if the solver leaves the rotation about it free."""
        solver = self.manip.GetIkSolver()
        ray = IkParameterizationType.TranslationDirection5D
        if solver is None or not solver.Supports(ray):
            return T_world_tool
        direction = T_world_tool[:3, :3] @ self.manip.GetLocalToolDirection()
        return IkParameterization(Ray(T_world_tool[:3, 3], direction), ray)

    # Pictures

    def drawContacts(self, contacts: ArrayLike, conelength: float = 0.03, transparency: float = 0.5) -> list[Any]:
        """Draw the friction cones of contacts.

        Args:
            contacts: Positions and normals, shape (n, 6).
            conelength: Length of a cone [m].
            transparency: 0 is opaque, 1 invisible.

        Returns:
            Handles that keep the drawing.
        """
        rows = np.asarray(contacts, float).reshape(-1, 6)
        cones = conelength * friction_cones(rows[:, 3:], max(self._ready_grasper().friction, 1e-3))
        following = np.roll(cones, -1, axis=1)
        tips = np.broadcast_to(rows[:, None, :3], cones.shape)
        triangles = np.stack([tips, tips + cones, tips + following], axis=2)
        color = np.array([1, 0.4, 0.4, 1 - transparency])
        return [self.env.drawtrimesh(triangles.reshape(-1, 3), colors=color)] if len(rows) else []

    def showgrasp(
        self,
        grasp: ArrayLike,
        collisionfree: bool = False,
        useik: bool = False,
        delay: float | None = None,
        showfinal: bool = False,
    ) -> None:
        """Show a grasp in the viewer, then restore the robot.

        Args:
            grasp: A row of ``grasps``.
            collisionfree: Whether to move the hand back until it is free of the target.
            useik: Whether the arm moves to the grasp by IK; otherwise only the hand is shown.
            delay: Duration [s]; None: until the user presses Enter, if there is a terminal.
            showfinal: Whether the fingers are shown closed.

        Raises:
            PlanningError: the arm does not reach the pose.
        """
        with self.GripperVisibility(self.manip) if not useik else self.robot, self.robot:
            self.setPreshape(grasp)
            T = self.getGlobalGraspTransform(grasp, collisionfree=collisionfree)
            if useik:
                values = self.manip.FindIKSolution(self._goal(T), IkFilterOptions.CheckEnvCollisions)
                if values is None:
                    raise PlanningError("showgrasp: the arm does not reach this grasp without collisions")
                self.robot.SetDOFValues(values, self.manip.GetArmIndices())
            else:
                self._place_hand(T)
            if showfinal:
                self.setFinalFingerValues(grasp)
            _pause(delay)

    def show(
        self, delay: float | None = 0.1, options: object = None, forceclosure: bool = True, showcontacts: bool = True
    ) -> None:
        """Show the grasps one after the other, with their contacts.

        Args:
            delay: Duration of each [s]; None: until the user presses Enter, if there is a terminal.
            options: OpenRAVE's; not used.
            forceclosure: Not used; contacts are those of closed fingers.
            showcontacts: Whether to draw contacts.
        """
        del options, forceclosure
        for grasp in self.grasps:
            with self.GripperVisibility(self.manip), self.robot:
                try:
                    contacts, final, _, _ = self.runGrasp(grasp)
                except PlanningError:
                    continue
                self.robot.SetDOFValues(final[0])
                if final[1] is not None:
                    self.robot.SetTransform(final[1])
                handles = self.drawContacts(contacts) if showcontacts else []
                _pause(delay)
                del handles


def _pause(delay: float | None) -> None:
    if delay is not None:
        time.sleep(delay)
    elif sys.stdin.isatty():
        input("press Enter to go on")

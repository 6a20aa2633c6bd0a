"""Grasp simulation: contacts of a hand with a body, and their force closure."""

# ruff: noqa: PLR0913, PLR0917 - OpenRAVE's arguments

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.compat.interfaces.helper import Helper, given, several
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats, Ints
from ravemj.errors import ArgumentError
from ravemj.manipulation.grasping.hulls import hull
from ravemj.rave.environment import Environment
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link
from ravemj.rave.modules import grasper_module
from ravemj.rave.modules.grasper import Found, GraspRequest, Sweep
from ravemj.rave.modules.grasper_commands import candidates_of
from ravemj.rave.planning.grasper import GraspParameters
from ravemj.rave.planning.planner import PlanningError
from ravemj.rave.robot import Robot

_TRIES = 10
"""Number of noisy simulations of each candidate, as in OpenRAVE."""

GraspResult = tuple[Floats, tuple[Floats, Floats] | None, float | None, float | None]
Hull = tuple[Floats | None, list[list[int]] | None, Ints | None]


class Grasper(Helper):
    """Simulates grasps of the active manipulator: the hand moves to a body, and its fingers close one by one.

    It moves the active DOFs: set the joints of the gripper and ``DOFAffine.X | DOFAffine.Y | DOFAffine.Z``.

    Args:
        robot: The robot.
        friction: Friction coefficient.
        avoidlinks: Links that must touch nothing.
        plannername: OpenRAVE's name of the planner; ``Grasper`` is the only one.

    Attributes:
        friction: Friction coefficient.
        avoidlinks: Links that must touch nothing.
        plannername: OpenRAVE's name of the planner.

    Example:
        >>> grasper = interfaces.Grasper(robot, friction=0.4)
        >>> robot.SetActiveDOFs(manip.GetGripperIndices(), DOFAffine.X | DOFAffine.Y | DOFAffine.Z)
        >>> contacts, final, mindist, volume = grasper.Grasp(
        ...     direction=[0, 0, 1], target=box, forceclosure=True, execute=False, outputfinal=True)
        >>> mindist > 0
        True
    """

    def __init__(
        self,
        robot: Robot,
        friction: float = 0.3,
        avoidlinks: Iterable[Link] | None = None,
        plannername: str | None = None,
    ) -> None:
        self.friction, self.avoidlinks, self.plannername = friction, several(avoidlinks, "avoidlinks"), plannername
        module, self._grasper = grasper_module(robot.GetEnv())
        super().__init__(robot, plannername, None, module, self._grasper)

    def clone(self, envother: Environment) -> "Grasper":
        """Return a grasper for the robot of the same name in another environment.

        Args:
            envother: The environment.
        """
        robot = envother.GetRobot(self.robot.GetName())
        links = [robot.GetLink(link.GetName()) for link in self.avoidlinks] if robot else []
        return Grasper(
            checked_kind(robot, Robot, "robot"), self.friction, [link for link in links if link], self.plannername
        )

    Clone = clone

    def Grasp(
        self,
        direction: ArrayLike | None = None,
        roll: float | None = None,
        position: ArrayLike | None = None,
        standoff: float | None = None,
        target: KinBody | None = None,
        stablecontacts: bool = False,
        forceclosure: bool = False,
        transformrobot: bool = True,
        onlycontacttarget: bool = True,
        tightgrasp: bool = False,
        graspingnoise: float | None = None,
        execute: bool | None = None,
        translationstepmult: float | None = None,
        outputfinal: bool = False,
        manipulatordirection: ArrayLike | None = None,
        coarsestep: float | None = None,
        finestep: float | None = None,
        vintersectplane: ArrayLike | None = None,
        chuckingdirection: ArrayLike | None = None,
        ordereddofindices: Sequence[int] | None = None,
        avoidcontact: bool = False,
    ) -> GraspResult:
        """Simulate a grasp. The robot is restored afterwards, unless ``execute`` moves its joints.

        Args:
            direction: Direction of the motion of the hand, in the frame of the target; None: 0 0 1.
            roll: Rotation of the tool about ``manipulatordirection`` before the motion [rad].
            position: Start of the tool, in the frame of the target [m].
            standoff: Distance by which the hand moves back after the contact [m].
            target: The body to grasp.
            stablecontacts: Return only contacts that the closing fingers press against the target. OpenRAVE tests the
                opposite direction, and returns none.
            forceclosure: Whether to compute ``mindist`` and ``volume``.
            transformrobot: Whether the hand is placed and moves to the target; otherwise only the fingers move.
            onlycontacttarget: Whether contact with another body is a failure.
            tightgrasp: Not used, as in OpenRAVE.
            graspingnoise: Largest random error of the assumed position of the target along each axis [m]; the target
                itself does not move.
            execute: Whether the controller moves the joints to those of the grasp; None: it does.
            translationstepmult: Factor of the steps for sliders and the hand's translation [m/rad]; None: 0.1.
            outputfinal: Whether to return the last configuration.
            manipulatordirection: Direction of the tool that is turned to ``direction``, in the frame of the tool; None:
                the manipulator's.
            coarsestep: Step of fingers until contact [rad]; None: 0.1.
            finestep: Step [rad] that determines the tolerance of contacts; None: 0.001.
            vintersectplane: Plane on which the tool stops, in place of a standoff: n.x + d = 0 in the frame of the
                target, shape (4,).
            chuckingdirection: Sign of the motion of each gripper joint: -1, 0 or 1; None: the manipulator's.
            ordereddofindices: DOF indices of the active joints in the order of closing; None: their own order.
            avoidcontact: Whether fingers stop one fine step before contact.

        Returns:
            Contact points [m] and normals out of the target in the world, shape (n, 6); joint values and
            ``T_world_robot`` at the end, or None; distance of the origin from the boundary of the wrench hull, and its
            volume, or None.

        Raises:
            PlanningError: the grasp fails; ``parameter`` is the reason, with ``kind`` and ``name``.
            ArgumentError: an argument is wrong.
        """
        del tightgrasp
        steps = given(coarsestep=coarsestep, finestep=finestep, translationstepmult=translationstepmult)
        parameters = GraspParameters(
            target=None if target is None else checked_kind(target, KinBody, "Grasp: target"),
            transformrobot=transformrobot,
            onlycontacttarget=onlycontacttarget,
            avoidcontact=avoidcontact,
            avoidlinks=self._avoided(),
            ordereddofindices=ordereddofindices,
            **given(roll=roll, standoff=standoff, graspingnoise=graspingnoise),
            **_vectors(
                direction=direction,
                position=position,
                manipulatordirection=manipulatordirection,
                vintersectplane=vintersectplane,
            ),
            **steps,
        )
        request = GraspRequest(
            parameters=parameters,
            chuckingdirection=None
            if chuckingdirection is None
            else _row(chuckingdirection, "chuckingdirection").tolist(),
            friction=self.friction,
            forceclosure=forceclosure,
            stablecontacts=stablecontacts,
        )
        answer = self._grasper.grasp(request)
        if execute is None or execute:
            self._grasper.execute_grasp(answer)
        final = (answer.end.values, answer.end.T_world_base) if outputfinal else None
        return answer.contacts, final, answer.mindist, answer.volume

    def GraspThreaded(
        self,
        approachrays: ArrayLike,
        standoffs: ArrayLike,
        preshapes: ArrayLike,
        rolls: ArrayLike,
        manipulatordirections: ArrayLike | None = None,
        target: KinBody | None = None,
        transformrobot: bool = True,
        onlycontacttarget: bool = True,
        tightgrasp: bool = False,
        graspingnoise: float | tuple[float, int] | None = None,
        forceclosurethreshold: float | None = None,
        collisionchecker: str | None = None,
        translationstepmult: float | None = None,
        numthreads: int | None = None,
        startindex: int | None = None,
        maxgrasps: int | None = None,
        finestep: float | None = None,
    ) -> tuple[int, list[tuple[Any, ...]]]:
        """Simulate all combinations of rays, rolls, preshapes, standoffs and directions. Ctrl-C cancels it.

        The index of a candidate is standoff + preshape S + roll S P + ray S P R + direction S P R N, for S standoffs, P
        preshapes, R rolls and N rays: standoffs change first. Grasps are returned in the order of their indices.

        Args:
            approachrays: Start of the tool [m] and direction of its motion, in the target, shape (n, 6).
            standoffs: Distances by which the hand moves back after the contact [m].
            preshapes: Values of the gripper [rad or m], shape (n, gripper dof).
            rolls: Rotations of the tool [rad].
            manipulatordirections: Directions of the tool, shape (n, 3); None: the manipulator's.
            target: The body to grasp.
            transformrobot: Whether the hand is placed and moves to the target.
            onlycontacttarget: Whether contact with another body is a failure.
            tightgrasp: Not used, as in OpenRAVE.
            graspingnoise: Largest displacement [m], and the number of grasps with noise (10) that have to end close to
                one another.
            forceclosurethreshold: Minimum ``mindist`` of a grasp; None: grasps need not be in force closure.
            collisionchecker: Not used.
            translationstepmult: As in ``Grasp``.
            numthreads: Number of processes that simulate candidates, which does not change the grasps. None: 1.
            startindex: Index of the first candidate.
            maxgrasps: Maximum number of grasps; None means no limit.
            finestep: As in ``Grasp``.

        Returns:
            The index of the next candidate; and for each grasp position, direction, roll, standoff,
            manipulatordirection, mindist, volume, preshape, ``T_world_robot``, joint values and contacts.
        """
        del tightgrasp, collisionchecker
        steps = given(finestep=finestep, translationstepmult=translationstepmult)
        noise, tries = graspingnoise if isinstance(graspingnoise, tuple) else (graspingnoise or 0.0, _TRIES)
        directions = (
            None if manipulatordirections is None else _table(manipulatordirections, 3, "manipulatordirections")
        )
        parts = {
            "approachrays": _table(approachrays, 6, "approachrays"),
            "standoffs": _row(standoffs, "standoffs"),
            "rolls": _row(rolls, "rolls"),
            "preshapes": _table(preshapes, len(self._gripper()), "preshapes"),
            "manipulatordirections": directions,
        }
        parameters = GraspParameters(
            target=None if target is None else checked_kind(target, KinBody, "GraspThreaded: target"),
            transformrobot=transformrobot,
            onlycontacttarget=onlycontacttarget,
            avoidlinks=self._avoided(),
            graspingnoise=noise,
            **steps,
        )
        request = GraspRequest(
            parameters=parameters, friction=self.friction, forceclosure=forceclosurethreshold is not None
        )
        sweep = Sweep(startindex or 0, maxgrasps or 0, forceclosurethreshold, tries)
        following, grasps = self._grasper.sweep(candidates_of(self._grasper, parts), request, sweep, numthreads or 1)
        return following, [_result(grasp) for grasp in grasps]

    def ConvexHull(
        self,
        points: ArrayLike,
        returnplanes: bool = True,
        returnfaces: bool = True,
        returntriangles: bool = True,
    ) -> Hull:
        """Return the convex hull of points.

        Args:
            points: Shape (n, dim).
            returnplanes: Whether to return planes.
            returnfaces: Whether to return faces.
            returntriangles: Whether to return triangles, for points in 3D.

        Returns:
            Planes n.x + d <= 0 inside, shape (m, dim + 1); the indices of the points of each face; the indices of the
            corners of triangles, counterclockwise seen from outside, shape (k, 3); None for those not requested.

        Raises:
            PlanningError: the points are flat.
        """
        array = checked_numbers(points, "ConvexHull: points")
        convex_hull = hull(array) if array.ndim == 2 and len(array) else None
        if convex_hull is None:
            raise PlanningError("ConvexHull: the points are flat; they should span all dimensions")
        faces = [list(face) for face in convex_hull.faces]
        return (
            convex_hull.planes if returnplanes else None,
            faces if returnfaces else None,
            convex_hull.triangles if returntriangles else None,
        )

    def _avoided(self) -> tuple[int, ...]:
        return tuple(checked_kind(link, Link, "avoidlinks").GetIndex() for link in self.avoidlinks)

    def _gripper(self) -> Ints:
        manip = self.robot.GetActiveManipulator()
        if manip is None:
            raise ArgumentError(f"robot '{self.robot.GetName()}' has no active manipulator; call SetActiveManipulator")
        return manip.GetGripperIndices()


def _vectors(**vectors: ArrayLike | None) -> dict[str, Floats]:
    return {name: _row(vector, name) for name, vector in vectors.items() if vector is not None}


def _row(numbers: ArrayLike, name: str) -> Floats:
    return checked_numbers(numbers, f"Grasper: {name}").ravel()


def _table(rows: ArrayLike, width: int, name: str) -> Floats:
    table = np.atleast_2d(checked_numbers(rows, f"Grasper: {name}"))
    if table.shape[1] != width:
        raise ArgumentError(f"Grasper: {name} has {table.shape[1]} columns, and should have {width}")
    return table


def _result(grasp: Found) -> tuple[Any, ...]:
    parameters, answer = grasp.parameters, grasp.answer
    return (
        parameters.position,
        parameters.direction,
        parameters.roll,
        parameters.standoff,
        parameters.manipulatordirection,
        answer.mindist or 0.0,
        answer.volume or 0.0,
        grasp.preshape,
        answer.end.T_world_base,
        answer.end.values,
        answer.contacts,
    )

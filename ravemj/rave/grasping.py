"""Grasps of a body by a robot: search, inverse kinematics, proof by physics, drawings."""

import pickle
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple, cast

import numpy as np

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_number
from ravemj.core.processes import blocks_of, map_parts
from ravemj.core.progress import progress_bar
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.manipulation.bodies import Bodies
from ravemj.manipulation.grasping.grippers import closes, with_closing_direction
from ravemj.manipulation.grasping.search import (
    Choices,
    Grasp,
    Grasps,
    Method,
    Reach,
    count_candidates,
    proved,
    search,
)
from ravemj.model import scene
from ravemj.rave.env.viewing import GraphHandle
from ravemj.rave.kinbody import KinBody
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.robot import Robot
from ravemj.trajectories.bodies import body_groups

_POSE = IkParameterizationType.Transform6D

_BLOCK = 64
"""Number of candidate grasps per task of a worker process."""

_ARROW = 0.035
"""Length of the arrow of a contact [m]."""

_THIN = 0.0012  # m, radius of an arrow
_LIMITING, _OTHER = (0.9, 0.25, 0.1), (0.15, 0.55, 0.25)
_FORCE, _TORQUE = (0.75, 0.1, 0.6), (0.45, 0.2, 0.85)


def grasps(  # noqa: PLR0913 - keyword arguments
    robot: Robot,
    body: KinBody,
    *,
    method: Method = "fly",
    friction: float = 0.4,
    delta: float = 0.02,
    rolls: int | None = None,
    reach: bool = True,
    proofs: int = 0,
    processes: int = 1,
) -> Grasps:
    """Return grasps of a body at its current pose, and the reason for each candidate that was rejected.

    The active manipulator grasps; its gripper opens to its limits. Fingers without a closing direction, as in URDF,
    close towards each other. Robot and body are restored afterwards.

    Args:
        robot: The robot.
        body: The body to grasp.
        method: ``fly`` moves the hand along approach rays until it touches, as OpenRAVE does, and closes one finger
            after the other. ``antipodal`` places parallel jaws at pairs of opposite points of the surface, where the
            line between them lies inside both friction cones.
        friction: Friction coefficient of hand and body.
        delta: Spacing of the approach rays on the faces of the body's bounding box [m].
        rolls: Number of rotations of the hand about each approach, or about the line of each pair. The default is 4 for
            ``fly`` and 8 for ``antipodal``.
        reach: Whether the arm has to reach a grasp without collisions; False: only the hand is tested.
        proofs: Number of grasps that are simulated, those of ``distinct(proofs)``: the fingers press with their largest
            force or torque (10 N or N m if the model has none), the hand is lifted by 0.1 m and shaken along each axis
            with 5 m/s^2 for a second. ``Grasp.proof`` says whether the body moved in the hand by less than 5 mm and 5
            degrees.
        processes: Number of processes that try candidates; a process needs about two seconds to start, so several help
            from some thousand candidates on. The result is the same.

    A terminal shows a progress bar.

    Returns:
        The grasps, the best first. ``print`` shows how many candidates were rejected for which reason.

    Raises:
        ArgumentError: an argument is wrong, the robot has no active manipulator or no gripper that closes, or the body
            has no shapes.

    Example:
        >>> found = ravemj.grasps(robot, mug, method="antipodal", proofs=1)
        >>> print(found[0].proof)
    """
    arm = _active(checked_kind(robot, Robot, "grasps: robot", "a Robot"))
    checked_kind(body, KinBody, "grasps: body", "a KinBody")
    choices = _checked(method, friction, delta, rolls)
    if body is robot or robot.IsGrabbing(body):
        raise ArgumentError(f"grasps: body: '{body.GetName()}' is the robot or in its hand; expected a body to grasp")
    if not robot.simulation_state.simulation.holds(body.simulation_state):
        where = f"in the environment of robot '{robot.GetName()}'"
        raise ArgumentError(f"grasps: body: '{body.GetName()}' is not {where}; add it first")
    if processes < 1:
        raise ArgumentError(f"grasps: processes: is {processes}; expected 1 or more")
    if proofs < 0:
        raise ArgumentError(f"grasps: proofs: is {proofs}; expected 0 or more")
    with robot.GetEnv():
        state, target = robot.simulation_state, body.simulation_state
        searched = Grasps(_searched(_Query(robot, body, choices, reach), processes), friction)
        best = searched.distinct(proofs)
        rest = [grasp for grasp in searched if all(grasp is not chosen for chosen in best)]
        best = [proved(state, _closing(arm), target, grasp, choices.friction) for grasp in best]
    return Grasps([*best, *rest, *searched.rejected], choices.friction)


class _Query(NamedTuple):
    """Grasp search of a robot's active manipulator; ``reach`` tells whether the arm has to reach the grasps."""

    robot: Robot
    body: KinBody
    choices: Choices
    reach: bool

    def run(self, span: tuple[int, int] | None = None, progress: Callable[[int], object] | None = None) -> list[Grasp]:
        """Test the candidates in a range of indices, by default all."""
        arm, target = _active(self.robot), self.body.simulation_state
        reach = _reach(self.robot, arm) if self.reach else None
        state = self.robot.simulation_state
        return search(state, _closing(arm), target, self.choices, reach, span=span, progress=progress)


def _searched(query: _Query, processes: int) -> list[Grasp]:
    """Test all candidates in this process or in several, and return them."""
    robot, target = query.robot.simulation_state, query.body.simulation_state
    count = count_candidates(robot, _closing(_active(query.robot)), target, query.choices)
    with progress_bar("grasps", count) as show:
        if processes == 1 or count <= _BLOCK:
            return query.run(progress=show)
        tried: list[Grasp] = []
        for grasps in map_parts(_tried_part, pickle.dumps(query), blocks_of(0, count, _BLOCK), processes):
            tried += grasps
            show(len(tried))
        return tried


def _tried_part(content: bytes, span: tuple[int, int]) -> list[Grasp]:
    """Test a range of candidate grasps in a worker process; ``content`` is the pickled query."""
    query = _unpickled(content)
    with query.robot.GetEnv():
        return query.run(span)


@lru_cache(maxsize=1)
def _unpickled(content: bytes) -> _Query:
    query: _Query = pickle.loads(content)
    return query


def draw_grasp(body: KinBody, grasp: Grasp) -> list[GraphHandle]:
    """Draw the contacts of a grasp and its weakest direction; return the handles that keep the drawings.

    An arrow shows where and in which direction each contact presses: red if it limits the quality, else green. A double
    arrow through the centre of mass shows the weakest direction: pink for a force along it, violet for a torque about
    it.

    Args:
        body: The body, at its current pose.
        grasp: The grasp.

    Example:
        >>> env.SetViewer("offscreen")
        >>> drawn = ravemj.draw_grasp(mug, found[0])
        >>> picture = env.render(640, 480)
    """
    env, T = body.GetEnv(), body.GetTransform()
    drawn: list[GraphHandle | None] = []
    for number, contact in enumerate(grasp.contacts):
        point, normal = T[:3, :3] @ contact[:3] + T[:3, 3], T[:3, :3] @ contact[3:]
        colour = _LIMITING if number in grasp.limiting else _OTHER
        drawn.append(env.drawarrow(point + _ARROW * normal, point, _THIN, colour))
    if grasp.weakest is not None:
        along, colour = _larger_part(grasp.weakest)
        center, along = body.GetCenterOfMass(), _radius(body) * T[:3, :3] @ along
        drawn += [env.drawarrow(center, center + way, 2 * _THIN, colour) for way in (along, -along)]
    return [handle for handle in drawn if handle is not None]


def _radius(body: KinBody) -> float:
    """Return the radius of a sphere around a body [m], the length of arrows that stick out of it."""
    return float(np.linalg.norm(body.ComputeAABB().extents()))


def _larger_part(wrench: Floats) -> tuple[Floats, tuple[float, float, float]]:
    """Return the direction of a wrench's force or torque, whichever is larger, and the colour of its arrow."""
    force, torque = wrench[:3], wrench[3:]
    part, colour = (force, _FORCE) if np.linalg.norm(force) >= np.linalg.norm(torque) else (torque, _TORQUE)
    return part / np.linalg.norm(part), colour


def _active(robot: Robot) -> Manipulator:
    arm = robot.GetActiveManipulator()
    if arm is None:
        raise ArgumentError(f"grasps: robot '{robot.GetName()}' has no active manipulator; give it a <Manipulator>")
    others = [other.GetName() for other in robot.GetManipulators() if closes(other.description)]
    if others and not arm.GetGripperDOF():
        raise ArgumentError(
            f"grasps: manipulator '{arm.GetName()}' has no gripper joints that close, and {', '.join(others)} "
            f"{'has' if len(others) == 1 else 'have'} some; call robot.SetActiveManipulator"
        )
    return arm


def _closing(arm: Manipulator) -> scene.Manipulator:
    return with_closing_direction(arm.GetRobot().simulation_state, arm.description)


def _checked(method: str, friction: float, delta: float, rolls: int | None) -> Choices:
    if method not in {"fly", "antipodal"}:
        raise ArgumentError(f"grasps: method: is {method!r}; expected 'fly' or 'antipodal'")
    friction, delta = checked_number(friction, "grasps: friction"), checked_number(delta, "grasps: delta")
    if not friction >= 0:
        raise ArgumentError(f"grasps: friction: is {friction:g}; expected 0 or more")
    if rolls is None:
        rolls = 4 if method == "fly" else 8
    if rolls < 1:
        raise ArgumentError(f"grasps: rolls: is {rolls}; expected 1 or more")
    return Choices(cast("Method", method), friction, delta, int(rolls))


def _reach(robot: Robot, arm: Manipulator) -> Reach | None:
    """Return a function that solves IK regardless of collisions; None if the hand has no arm."""
    if not arm.GetArmDOF():
        return None
    from ravemj.ik.candidates import ranked  # noqa: PLC0415 - slow to import

    env, dofs, start = robot.GetEnv(), arm.description.arm_dofs, arm.GetArmDOFValues()
    bodies = Bodies(env.simulation, body_groups(robot.GetName(), dofs, 0, ""), env.GetCollisionChecker)
    solver = arm.ik_solver()

    def reach(T_world_tool: Floats) -> Floats | str:
        solutions = [row for row, _ in ranked(solver, arm.goals_in_base(T_world_tool, _POSE)[0], start)]
        solutions = [row for row in solutions if not bodies.beyond_limits(row)]
        with bodies.kept():
            for row in solutions:
                bodies.move(row)
                if not bodies.collision():
                    return row
        return "arm in collision" if solutions else "no IK"

    return reach

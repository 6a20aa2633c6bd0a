"""The planner ``Grasper``: a hand moves to a body and closes around it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from ravemj.core.arrays import checked_number, checked_vector
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, RavemjError
from ravemj.geometry_functions.affine import DOFAffine
from ravemj.manipulation.grasping.closing import STEPS, Approach, Steps, Waypoint, displaced
from ravemj.manipulation.grasping.hands import Grasped, grasp, hand_of, target_of
from ravemj.manipulation.processing import flag
from ravemj.rave.kinbody import KinBody
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.planning.planner import Planner, PlannerStatus
from ravemj.rave.planning.values import Values
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import Trajectory
from ravemj.trajectories.bodies import body_groups, configuration_values
from ravemj.trajectories.waypoints import Waypoints

_VECTORS = {
    "vtargetdirection": ("direction", 3),
    "vtargetposition": ("position", 3),
    "vmanipulatordirection": ("manipulatordirection", 3),
    "vintersectplane": ("vintersectplane", 4),
}
"""Field of ``GraspParameters`` and vector length, by XML tag."""

_NUMBERS = {
    "ftargetroll": "roll",
    "fstandoff": "standoff",
    "fgraspingnoise": "graspingnoise",
    "fcoarsestep": "coarsestep",
    "ffinestep": "finestep",
    "ftranslationstepmult": "translationstepmult",
}
_SWITCHES = {
    "btransformrobot": ("transformrobot", False),
    "bonlycontacttarget": ("onlycontacttarget", True),
    "bavoidcontact": ("avoidcontact", False),
}
"""Boolean field of ``GraspParameters`` and the planner's default, by XML tag."""


@dataclass(frozen=True, kw_only=True)
class GraspParameters:
    """Approach of a hand to a target. Vectors are in the frame of the target.

    Attributes:
        target: The body to grasp; None if only fingers close.
        direction: Direction of the motion of the hand, shape (3,).
        roll: Rotation about ``manipulatordirection`` before the motion [rad].
        position: Start of the tool [m], shape (3,).
        manipulatordirection: Direction of the tool that is turned to ``direction``, in the frame of the tool; None: the
            manipulator's.
        standoff: Distance by which the hand moves back after the contact [m].
        vintersectplane: Plane on which the tool stops, in place of a standoff: n.x + d = 0, shape (4,).
        transformrobot: Whether the hand is placed and moves to the target.
        onlycontacttarget: Whether contact with another body is a failure.
        avoidcontact: Whether fingers stop before contact.
        leavescontact: Whether fingers that start in contact may leave it, if they avoid contact.
        avoidlinks: Indices of links that must touch nothing.
        graspingnoise: Largest random displacement of the target along each axis [m].
        coarsestep: Step of fingers until contact [rad].
        finestep: Step that determines the tolerance of contacts [rad].
        translationstepmult: Factor of both steps for sliders and for the translation of the hand [m/rad].
        ordereddofindices: DOF indices of the fingers in the order of closing; None: that of the active DOFs.
    """

    target: KinBody | None = None
    direction: Floats = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    roll: float = 0.0
    position: Floats = field(default_factory=lambda: np.zeros(3))
    manipulatordirection: Floats | None = None
    standoff: float = 0.0
    vintersectplane: Floats = field(default_factory=lambda: np.zeros(4))
    transformrobot: bool = True
    onlycontacttarget: bool = True
    avoidcontact: bool = False
    leavescontact: bool = False
    avoidlinks: tuple[int, ...] = ()
    graspingnoise: float = 0.0
    coarsestep: float = STEPS.coarse
    finestep: float = STEPS.fine
    translationstepmult: float = STEPS.per_radian
    ordereddofindices: Sequence[int] | None = None

    def approach(self, manip: Manipulator) -> Approach:
        """Return the parameters of the hand's approach for a manipulator.

        Raises:
            ArgumentError: a number is not finite, a direction has no length, or a step is not positive.
        """
        for name in ("roll", "standoff", "graspingnoise", "coarsestep", "finestep", "translationstepmult"):
            checked_number(getattr(self, name), f"Grasper: {name}")
        for name in ("coarsestep", "finestep", "translationstepmult"):
            if not getattr(self, name) > 0:
                raise ArgumentError(f"Grasper: {name} is {getattr(self, name):g}, and should be more than 0")
        tool_direction = self.manipulatordirection
        if tool_direction is None or not np.any(tool_direction):
            tool_direction = np.array(manip.description.direction)
        return Approach(
            direction=_direction(self.direction, "direction"),
            tool_direction=_direction(tool_direction, "manipulatordirection"),
            position=checked_vector(self.position, 3, "Grasper: position"),
            roll=self.roll,
            standoff=self.standoff,
            plane=checked_vector(self.vintersectplane, 4, "Grasper: vintersectplane"),
            flies=self.transformrobot,
            only_target=self.onlycontacttarget,
            avoid_contact=self.avoidcontact,
            avoided=frozenset(self.avoidlinks),
            leaves_contact=self.leavescontact,
        )


def simulate(
    robot: Robot, parameters: GraspParameters, sides: Mapping[int, float], random: np.random.Generator
) -> Grasped:
    """Simulate a grasp from the present configuration of a robot, which is restored afterwards.

    Args:
        robot: The robot; its active manipulator grasps.
        parameters: The approach of the hand.
        sides: The sign of the motion of each joint that closes, by DOF index.
        random: Source of the noise.

    Raises:
        ArgumentError: the robot has no active manipulator or joint, holds the target, or a parameter is wrong.
    """
    manip = robot.GetActiveManipulator()
    if manip is None:
        raise ArgumentError(f"Grasper: robot '{robot.GetName()}' has no active manipulator; call SetActiveManipulator")
    if not sides and not parameters.transformrobot:
        raise ArgumentError("Grasper: no joint is active; call robot.SetActiveDOFs(manip.GetGripperIndices()) before")
    state, target = robot.simulation_state, _target(robot, parameters.target)
    approach = parameters.approach(manip)
    steps = Steps(parameters.coarsestep, parameters.finestep, parameters.translationstepmult)
    with state.simulation.lock:
        hand = hand_of(state, manip.description, _ordered(sides, parameters.ordereddofindices))
        thought = None
        if target is not None and parameters.graspingnoise > 0:
            thought = displaced(target_of(target), parameters.graspingnoise, random)
        world = robot.GetEnv().GetCollisionChecker().world()
        return grasp(world, state, hand, target, approach, steps, thought=thought)


def _target(robot: Robot, target: KinBody | None) -> BodyState | None:
    if target is None:
        return None
    name = target.GetName()
    if not robot.simulation_state.simulation.holds(target.simulation_state):
        raise ArgumentError(f"Grasper: target '{name}' is not in the environment of the robot; add it first")
    if target == robot or robot.IsGrabbing(target) is not None:
        raise ArgumentError(f"Grasper: robot '{robot.GetName()}' holds or is target '{name}'; release it first")
    return target.simulation_state


def _direction(vector: Floats, name: str) -> Floats:
    direction = checked_vector(vector, 3, f"Grasper: {name}")
    if not np.linalg.norm(direction):
        raise ArgumentError(f"Grasper: {name} is 0 0 0, and should be a direction")
    return direction


def _ordered(sides: Mapping[int, float], order: Sequence[int] | None) -> dict[int, float]:
    """Return the closing directions of finger joints in the given order of closing.

    Raises:
        ArgumentError: the order does not name exactly the joints that close.
    """
    if order is None or not len(order):
        return dict(sides)
    if sorted(order) != sorted(sides):
        raise ArgumentError(f"Grasper: ordereddofindices is {list(order)}, and should order {sorted(sides)}")
    return {int(dof): sides[int(dof)] for dof in order}


def motion_of(robot: Robot, dofs: Sequence[int], path: Sequence[Waypoint]) -> Waypoints:
    """Return configurations of a grasp as waypoints: values of some joints, and the pose of the robot."""
    groups = body_groups(robot.simulation_state.scene.name, list(dofs), int(DOFAffine.Transform), "linear")
    rows = [configuration_values(step.values[list(dofs)], step.T_world_base) for step in path]
    return Waypoints(groups, np.array(rows))


class Grasper(Planner):
    """``Grasper``: the hand of a robot moves to a target, and its fingers close one by one.

    ``SetRobotActiveJoints`` selects the joints, ``SetInitialConfig`` sets the preshape, and ``SetGoalConfig`` the sign
    of the motion of each joint. ``SetExtraParameters`` takes OpenRAVE's ``GraspParameters`` as elements:
    ``<targetbody>`` with the name or the index of the body in the environment, ``<vtargetdirection>``, ``<fstandoff>``
    and so on. The trajectory has only the last configuration; with ``<breturntrajectory>1</breturntrajectory>`` it has
    the start, the contact of the hand, and the end of each finger's motion, without waypoints between these, since
    contacts are found by bisection.
    """

    _defaults: ClassVar[Mapping[str, str]] = {
        "vtargetdirection": "0 0 1",
        "vtargetposition": "0 0 0",
        "bonlycontacttarget": "1",
        "fcoarsestep": "0.1",
        "ffinestep": "0.001",
        "ftranslationstepmult": "0.1",
    }

    def _prepare(self, values: Values) -> PlannerStatus | None:
        try:
            robot, dofs, _ = self._problem(values)
            if not dofs:
                return self._failed("no joint is active; call SetActiveDOFs with the joints of the gripper")
            if robot.GetActiveManipulator() is None:
                return self._failed(f"robot '{robot.GetName()}' has no active manipulator")
            self._parameters(values, robot)
        except RavemjError as error:
            return self._failed(error.message)
        return None

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Simulate the grasp, and write its last configuration or its path into the trajectory."""
        problem = self._prepare(values)
        if problem is not None:
            return problem
        robot, dofs, columns = self._problem(values)
        bodies = values.bodies
        assert bodies is not None, "the problem was checked"
        signs = values.configurations("_vgoalconfig")
        if not len(signs):
            return self._failed("SetGoalConfig should have the sign of the motion of each joint")
        start = values.configurations("_vinitialconfig")
        sides = dict(zip(dofs, signs[0][columns].tolist(), strict=True))
        with bodies.kept():
            if len(start):
                bodies.move(start[0])
            try:
                grasped = simulate(robot, self._parameters(values, robot), sides, values.random())
            except RavemjError as error:
                return self._failed(error.message)
        if grasped.closed.reason is not None:
            return self._failed(str(grasped.closed.reason))
        path = grasped.closed.path if flag(values.tags, "breturntrajectory") else [grasped.closed.end]
        traj.set_waypoints(motion_of(robot, dofs, path))
        return self._solved(f"the hand has {len(grasped.contacts)} contacts with the target")

    def _problem(self, values: Values) -> tuple[Robot, list[int], list[int]]:
        """Return the robot, the DOF indices of the joints that may close, and their configuration columns.

        Raises:
            ArgumentError: the moving bodies are not one robot.
        """
        bodies = values.bodies
        robot = self._env.wrap(bodies.bodies[0]) if bodies is not None and len(bodies.bodies) == 1 else None
        if not isinstance(robot, Robot) or bodies is None:
            raise ArgumentError("Grasper moves one robot; call SetRobotActiveJoints(robot) of the parameters")
        parts = [part for part in bodies.parts if part.dofs]
        dofs = [dof for part in parts for dof in part.dofs]
        columns = [column for part in parts for column in range(bodies.dof)[part.columns]]
        return robot, dofs, columns

    def _parameters(self, values: Values, robot: Robot) -> GraspParameters:
        tags = values.tags
        given: dict[str, object] = {name: values.tag(tag, getattr(_DEFAULTS, name)) for tag, name in _NUMBERS.items()}
        given |= {name: flag(tags, tag, default=default) for tag, (name, default) in _SWITCHES.items()}
        for tag, (name, count) in _VECTORS.items():
            if tags.get(tag, "").strip():
                given[name] = _numbers(tags[tag], count, tag)
        order = _numbers(tags.get("vordereddofindices", ""), None, "vordereddofindices").astype(int).tolist()
        avoided = tuple(_link(robot, name) for name in tags.get("vavoidlinkgeometry", "").split())
        target = _body(robot, tags.get("targetbody", "").strip())
        return GraspParameters(**given, target=target, ordereddofindices=order or None, avoidlinks=avoided)  # pyright: ignore[reportArgumentType]


_DEFAULTS = GraspParameters()


def _numbers(text: str, count: int | None, tag: str) -> Floats:
    try:
        numbers = np.array([float(word) for word in text.split()])
    except ValueError:
        raise ArgumentError(f"<{tag}>: '{text}' should be numbers") from None
    if count is not None and len(numbers) != count:
        raise ArgumentError(f"<{tag}>: '{text}' should be {count} numbers")
    return numbers


def _link(robot: Robot, name: str) -> int:
    link = robot.GetLink(name)
    if link is None:
        raise ArgumentError(f"Grasper: robot '{robot.GetName()}' has no link '{name}' to avoid")
    return link.GetIndex()


def _body(robot: Robot, word: str) -> KinBody | None:
    """Return a body by its name or its index in the environment; None for 0 or an empty text."""
    if word in {"", "0"}:
        return None
    body = robot.GetEnv().GetKinBody(word)
    if body is None and word.isdigit():
        body = robot.GetEnv().GetBodyFromEnvironmentBodyIndex(int(word))
    if body is None:
        raise ArgumentError(f"Grasper: there is no body '{word}'")
    return body

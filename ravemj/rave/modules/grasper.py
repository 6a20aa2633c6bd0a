"""Grasps of the active manipulator: the module ``Grasper``."""

import itertools
import math
import pickle
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np

from ravemj.core.processes import blocks_of, map_parts
from ravemj.core.transforms import Floats, Ints
from ravemj.engine.collision.hand import hand_tests
from ravemj.engine.collision.moving import kept_in_place
from ravemj.engine.collision.patches import contact_rows
from ravemj.errors import ArgumentError
from ravemj.manipulation.grasping.closing import Waypoint
from ravemj.manipulation.grasping.hands import Grasped
from ravemj.manipulation.grasping.wrenches import epsilon, volume
from ravemj.model.motion_bounds import motion_bounds
from ravemj.rave.enums import IkFilterOptions
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.modules.base_manipulation import Manipulation
from ravemj.rave.planning.grasper import GraspParameters, motion_of, simulate
from ravemj.rave.planning.planner import PlanningError
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import Trajectory

_RANDOM = np.random.default_rng()

_MOST = 16
"""Maximum number of contacts in the first, fast test of force closure; OpenRAVE's value."""

_CLOSED = 1e-9
"""Distance of the origin from the boundary of the wrench hull above which the fast test suffices; OpenRAVE's."""

_BLOCK = 32
"""Number of candidates per task of a worker process."""

_CHECKED = int(IkFilterOptions.CheckEnvCollisions)


@dataclass(frozen=True, kw_only=True)
class GraspRequest:
    """A grasp, and the quantities to compute about it.

    Attributes:
        parameters: Approach of the hand.
        chuckingdirection: Sign of the motion of each gripper joint; None: the manipulator's.
        friction: Friction coefficient.
        forceclosure: Whether to compute the volume of the wrench hull, and the origin's distance from its boundary.
        stablecontacts: Whether only contacts count that the fingers press against the target.
        least: Distance of the origin from the boundary of the wrench hull, below which the volume is set to 0.
    """

    parameters: GraspParameters = field(default_factory=GraspParameters)
    chuckingdirection: Sequence[float] | None = None
    friction: float = 0.0
    forceclosure: bool = False
    stablecontacts: bool = False
    least: float = 0.0


class GraspAnswer(NamedTuple):
    """Result of a simulated grasp.

    Attributes:
        contacts: Contact points [m] and normals out of the target in the world, shape (n, 6).
        links: Index of the link at each contact, shape (n,).
        end: Last configuration of the robot.
        mindist: Distance of the origin from the boundary of the wrench hull; None if it was not requested.
        volume: Volume of the wrench hull; None if it was not requested.
        path: Configurations of the robot up to the last.
    """

    contacts: Floats
    links: Ints
    end: Waypoint
    mindist: float | None
    volume: float | None
    path: Sequence[Waypoint]


@dataclass(frozen=True, kw_only=True)
class Candidates:
    """Grasp candidates: all combinations of rays, rolls, preshapes, standoffs and directions.

    Attributes:
        rays: Start of the tool and direction of the motion, in the frame of the target, shape (n, 6).
        rolls: Rotations of the tool [rad].
        preshapes: Values of the gripper [rad or m], shape (n, gripper dof).
        standoffs: Distances by which the hand moves back after the contact [m].
        directions: Directions of the tool, in its own frame, shape (n, 3).
    """

    rays: Floats
    rolls: Sequence[float]
    preshapes: Floats
    standoffs: Sequence[float]
    directions: Floats

    def __len__(self) -> int:
        parts = (self.rays, self.rolls, self.preshapes, self.standoffs, self.directions)
        return math.prod(len(part) for part in parts)

    def all(self, parameters: GraspParameters) -> Iterator[tuple[GraspParameters, Floats]]:
        """Yield the parameters and preshape of each candidate; standoffs vary fastest, directions slowest."""
        for tool, ray, roll, preshape, standoff in product(
            self.directions, self.rays, self.rolls, self.preshapes, self.standoffs
        ):
            changes = {"position": ray[:3], "direction": ray[3:], "manipulatordirection": tool}
            yield replace(parameters, roll=float(roll), standoff=float(standoff), **changes), preshape


class Sweep(NamedTuple):
    """Range of candidates to test, and criteria for grasps to keep.

    Attributes:
        start: Index of the first candidate.
        most: Maximum number of grasps; 0 means no limit.
        threshold: Minimum distance of the origin from the boundary of the wrench hull; None accepts all grasps.
        tries: Number of repetitions with noise, all of which have to succeed and end close to one another.
        checkik: Whether the arm has to reach the grasp without collisions.
    """

    start: int = 0
    most: int = 0
    threshold: float | None = None
    tries: int = 0
    checkik: bool = False


class Found(NamedTuple):
    """An accepted candidate, with its preshape."""

    parameters: GraspParameters
    preshape: Floats
    answer: GraspAnswer


class GraspSimulation(Manipulation):
    """Simulates grasps of the active manipulator of one robot."""

    def grasp(self, request: GraspRequest) -> GraspAnswer:
        """Simulate a grasp from the present configuration.

        Raises:
            PlanningError: the grasp fails; ``parameter`` is the ``Reason``.
            ArgumentError: a parameter is wrong.
        """
        self._check_target(request)
        grasped = simulate(self.robot, request.parameters, self._sides(request.chuckingdirection), _RANDOM)
        if grasped.closed.reason is not None:
            raise PlanningError(grasped.closed.reason)
        contacts, links = grasped.contacts, grasped.links
        if request.stablecontacts:
            kept = self._is_stable(grasped, request)
            contacts, links = contacts[kept], links[kept]
        distance, size = None, None
        if request.forceclosure:
            distance, size = force_closure(contacts, request.friction, request.least)
        return GraspAnswer(contacts, links, grasped.closed.end, distance, size, grasped.closed.path)

    def sweep(
        self, candidates: Candidates, request: GraspRequest, sweep: Sweep, processes: int = 1
    ) -> tuple[int, list[Found]]:
        """Simulate candidates, and keep those that meet the criteria.

        Args:
            candidates: The candidates.
            request: Approach of the hand, and quantities to compute.
            sweep: Range of candidates, and criteria for grasps.
            processes: Number of processes, which does not change the grasps. A few candidates are simulated in the
                calling process.

        Returns:
            The index of the next candidate, and the grasps in the order of their indices.
        """
        self._manipulator()
        self._check_target(request)
        if processes < 1:
            raise ArgumentError(f"GraspThreaded: numthreads is {processes}, and should be 1 or more")
        spans, grasps = blocks_of(sweep.start, len(candidates), _BLOCK), list[Found]()
        if processes > 1 and len(spans) > 1:
            content = pickle.dumps((self.robot, candidates, request, sweep))
            parts = map_parts(_sweep_part, content, spans, processes)
        else:
            parts = ([found] for found in self.good_ones(candidates, request, sweep, (sweep.start, len(candidates))))
        with closing(parts):
            for number, found in itertools.chain.from_iterable(parts):
                mine = replace(found.parameters, target=request.parameters.target)
                grasps.append(found._replace(parameters=mine))
                if len(grasps) == sweep.most:
                    return number + 1, grasps
        return max(len(candidates), sweep.start), grasps

    def good_ones(
        self, candidates: Candidates, request: GraspRequest, sweep: Sweep, span: tuple[int, int]
    ) -> Generator[tuple[int, Found]]:
        """Yield the index and the grasp of each candidate in a range of indices that meets the criteria."""
        manip, state = self._manipulator(), self.robot.simulation_state
        gripper = manip.GetGripperIndices()
        with state.simulation.lock, kept_in_place(state):
            chosen = itertools.islice(enumerate(candidates.all(request.parameters)), *span)
            for number, (parameters, preshape) in chosen:
                self.robot.SetDOFValues(preshape, gripper)
                answer = self._good(replace(request, parameters=parameters), sweep, manip)
                if answer is not None:
                    yield number, Found(parameters, preshape, answer)

    def _good(self, request: GraspRequest, sweep: Sweep, manip: Manipulator) -> GraspAnswer | None:
        noise, noisy = request.parameters.graspingnoise, replace(request, forceclosure=False)
        try:
            exact = replace(request.parameters, graspingnoise=0.0)
            answer = self.grasp(replace(request, parameters=exact, least=sweep.threshold or 0.0))
            if sweep.threshold is not None and (answer.mindist or 0.0) < sweep.threshold:
                return None
            if noise > 0 and not self._is_robust([self.grasp(noisy) for _ in range(sweep.tries)], noise):
                return None
        except PlanningError:
            return None
        return answer if not sweep.checkik or self._is_reachable(answer, manip) else None

    def _is_robust(self, answers: Sequence[GraspAnswer], noise: float) -> bool:
        """Return whether grasps repeated with noise end close to one another, by OpenRAVE's rule."""
        if not answers:
            return True
        values = np.array([answer.end.values for answer in answers])
        places = np.array([answer.end.T_world_base[:3, 3] for answer in answers])
        spread = float(np.linalg.norm(places - places.mean(axis=0), axis=1).mean())
        bounds = motion_bounds(self.robot.simulation_state.scene)
        spread += float((np.abs(values - values.mean(axis=0)) @ bounds).max())
        return spread <= max(0.005 * math.sqrt(0.49 + 400 * noise) - 0.0035, noise / 10)

    def _is_reachable(self, answer: GraspAnswer, manip: Manipulator) -> bool:
        T_base_tool = np.linalg.inv(self.robot.GetTransform()) @ manip.GetTransform()
        return manip.FindIKSolution(answer.end.T_world_base @ T_base_tool, _CHECKED) is not None

    def stable_contacts(self, direction: Floats, friction: float) -> tuple[Floats, Ints]:
        """Return the present contacts of the hand at which closing the fingers presses against other bodies.

        Args:
            direction: Assumed velocity of contacts that closing does not move, such as those of a palm, shape (3,).
            friction: Friction coefficient, more than 0.

        Returns:
            Contact points and normals out of the other bodies, shape (n, 6), and the link at each of them.
        """
        robot, manip = self.robot, self._manipulator()
        links = frozenset(link.GetIndex() for link in manip.GetChildLinks())
        state = robot.simulation_state
        with state.simulation.lock, hand_tests(self.env.GetCollisionChecker().world(), state, None) as tests:
            contacts, at = tests.contacts(links, robot.GetTransform(), robot.GetDOFValues(), "anything")
        rows, indices = contact_rows(contacts), np.array(at, dtype=int)
        kept = self._presses(rows, indices, direction, friction, self._closing())
        return rows[kept], indices[kept]

    def execute_grasp(self, answer: GraspAnswer) -> None:
        """Have the controller move the joints to their values in a grasp."""
        self.execute(self.trajectory_of(answer.path[-1:] and [answer.end]))

    def trajectory_of(self, path: Sequence[Waypoint]) -> Trajectory:
        """Return configurations of a grasp as a trajectory."""
        traj = Trajectory(self.env, "")
        traj.set_waypoints(motion_of(self.robot, self.robot.GetActiveDOFIndices().tolist(), path))
        return traj

    def _check_target(self, request: GraspRequest) -> None:
        if request.parameters.target is None:
            raise PlanningError("there is no target; give the body to grasp")

    def _manipulator(self) -> Manipulator:
        manip = self.robot.GetActiveManipulator()
        if manip is None:
            raise ArgumentError(f"robot '{self.robot.GetName()}' has no active manipulator; call SetActiveManipulator")
        return manip

    def _sides(self, chuckingdirection: Sequence[float] | None) -> Mapping[int, float]:
        """Return the sign of each active joint's closing motion; 0 for joints outside the gripper."""
        manip = self._manipulator()
        gripper = manip.GetGripperIndices().tolist()
        signs = manip.GetChuckingDirection().tolist() if chuckingdirection is None else list(chuckingdirection)
        if len(signs) != len(gripper):
            raise ArgumentError(
                f"Grasper: chuckingdirection has {len(signs)} numbers, and the gripper has {len(gripper)} joints"
            )
        known = dict(zip(gripper, signs, strict=True))
        return {int(dof): float(known.get(int(dof), 0.0)) for dof in self.robot.GetActiveDOFIndices()}

    def _closing(self) -> Floats:
        """Return the velocity of each DOF if all grippers close, shape (dof,): each is 1, -1 or 0."""
        speeds = np.zeros(self.robot.GetDOF())
        for manip in self.robot.GetManipulators():
            speeds[manip.GetGripperIndices()] = manip.GetChuckingDirection()
        return speeds

    def _is_stable(self, grasped: Grasped, request: GraspRequest) -> list[bool]:
        target, end, state = request.parameters.target, grasped.closed.end, self.robot.simulation_state
        assert target is not None, "there are contacts"
        direction = target.GetTransform()[:3, :3] @ request.parameters.direction
        speeds = self._closing()
        for dof, side in self._sides(request.chuckingdirection).items():
            speeds[dof] = side
        with state.simulation.lock, kept_in_place(state):
            state.set_transform(end.T_world_base)
            state.set_values(end.values)
            return self._presses(grasped.contacts, grasped.links, direction, request.friction, speeds)

    def _presses(self, contacts: Floats, links: Ints, direction: Floats, friction: float, speeds: Floats) -> list[bool]:
        """Return for each contact whether its link moves into the friction cone, in the present configuration."""
        kept: list[bool] = []
        for row, link in zip(contacts, links.tolist(), strict=True):
            velocity = self.robot.CalculateJacobian(link, row[:3]) @ speeds
            velocity = velocity if np.linalg.norm(velocity) > 0 else direction
            inwards = -float(velocity @ row[3:])
            kept.append(friction > 0 and inwards * math.hypot(1, friction) >= float(np.linalg.norm(velocity)) > 0)
        return kept


def _sweep_part(content: bytes, span: tuple[int, int]) -> list[tuple[int, Found]]:
    """Simulate a range of candidates in a worker process; return the accepted ones, with ``target`` set to None."""
    robot, candidates, request, sweep = _unpickled(content)
    simulation = GraspSimulation(robot.GetEnv())
    simulation.choose(robot.GetName())
    good_ones = simulation.good_ones(candidates, request, sweep, span)
    return [(number, found._replace(parameters=replace(found.parameters, target=None))) for number, found in good_ones]


@lru_cache(maxsize=1)
def _unpickled(content: bytes) -> tuple[Robot, Candidates, GraspRequest, Sweep]:
    parts: tuple[Robot, Candidates, GraspRequest, Sweep] = pickle.loads(content)
    return parts


def force_closure(contacts: Floats, friction: float, least: float = 0.0) -> tuple[float, float]:
    """Return OpenRAVE's ``mindist`` and ``volume`` of the wrenches about the origin of the world.

    Args:
        contacts: Contact points and normals, shape (n, 6).
        friction: Friction coefficient.
        least: ``mindist`` below which the volume is 0, since computing it takes a hundred times as long.
    """
    some = contacts[np.arange(_MOST) * len(contacts) // _MOST] if len(contacts) > _MOST else contacts
    distance = epsilon(some[:, :3], some[:, 3:], friction)
    if distance <= _CLOSED and len(some) < len(contacts):
        some = contacts
        distance = epsilon(some[:, :3], some[:, 3:], friction)
    return distance, 0.0 if distance < least else volume(some[:, :3], some[:, 3:], friction)

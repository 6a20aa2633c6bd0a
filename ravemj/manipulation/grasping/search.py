"""Search for grasps of an object: candidates by approach rays or antipodal points, each kept or rejected with a reason.

A function decides whether the arm reaches a grasp, so that this module does not depend on IK filters or the API.
"""

from collections import Counter
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal, NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, inverse
from ravemj.engine.collision.hand import HandTests, hand_tests
from ravemj.engine.collision.patches import contact_rows
from ravemj.engine.physics.grasp_proof import Proof, prove
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.manipulation.grasping import antipodal
from ravemj.manipulation.grasping.closing import Approach, Closed, Hand, Reason, Target, close
from ravemj.manipulation.grasping.grippers import CLEARANCE, SQUEEZE, closes, jaws_of
from ravemj.manipulation.grasping.hands import hand_of, target_of
from ravemj.manipulation.grasping.rays import box_rays
from ravemj.manipulation.grasping.wrenches import epsilon, quality
from ravemj.model.bounds import links_bounds
from ravemj.model.scene import Manipulator

Method = Literal["fly", "antipodal"]

_FREE = 1e-4
"""Distance before the grasp at which IK is tested, so that the open hand touches nothing [m]."""

_BACK = 0.1
"""Length of the straight line by which jaws approach [m]."""

_STEP = 0.01  # m, between tested poses on that line
_STANDOFFS = (0.0, 0.025)


@dataclass(frozen=True, eq=False)
class Grasp:
    """Grasp of an object, or a candidate that was rejected.

    Attributes:
        pose: ``T_target_tool``, shape (4, 4).
        preshape: Values of the gripper during the approach [rad or m], shape (g,).
        closed: Values of the gripper in contact [rad or m], shape (g,).
        contacts: Contact points [m] and unit normals out of the object, in its frame, shape (n, 6).
        epsilon: OpenRAVE's ``mindist``: distance of the origin from the boundary of the wrench hull, with torques about
            the origin of the object's frame; 0 if the grasp is not in force closure.
        quality: The same with torques about the centre of mass, divided by the radius of the object, so that grasps of
            different objects can be compared.
        limiting: Indices of the contacts that limit the quality.
        weakest: Unit wrench that the grasp resists least: force and torque in the object's frame, shape (6,).
        approach: Unit vector of the motion of the hand in the object's frame, shape (3,).
        arm: Joint values of the arm at the grasp [rad or m], shape (n,); None if inverse kinematics was not computed.
        proof: Result of the physics simulation; None if there was none.
        reason: The reason of the rejection; empty for accepted grasps.
    """

    pose: Floats
    preshape: Floats
    closed: Floats
    contacts: Floats
    approach: Floats
    epsilon: float = 0.0
    quality: float = 0.0
    limiting: tuple[int, ...] = ()
    weakest: Floats | None = None
    arm: Floats | None = None
    proof: Proof | None = None
    reason: str = ""

    @property
    def weakness(self) -> str:
        """Description of the larger part of the weakest wrench: ``turns about y`` or ``slides along 0.71 0 0.71``."""
        if self.weakest is None:
            return ""
        force, torque = self.weakest[:3], self.weakest[3:]
        slides = np.linalg.norm(force) >= np.linalg.norm(torque)
        part = (force if slides else torque) / np.linalg.norm(force if slides else torque)
        axis = int(np.abs(part).argmax())
        is_axis = np.abs(part[axis]) > np.cos(np.radians(5))
        direction = "xyz"[axis] if is_axis else " ".join(f"{number:.2g}" for number in part.round(2) + 0.0)
        return f"{'slides along' if slides else 'turns about'} {direction}"


_TWIN_DISTANCE, _TWIN_ANGLE = 0.015, np.radians(20)
"""Maximum distance of contacts [m] and angle of approaches [rad] of two similar grasps."""


def _are_twins(grasp: Grasp, other: Grasp) -> bool:
    apart = np.linalg.norm(grasp.contacts[:, None, :3] - other.contacts[None, :, :3], axis=2)
    farthest = max(apart.min(axis=0).max(initial=0), apart.min(axis=1).max(initial=0))
    return bool(farthest < _TWIN_DISTANCE and grasp.approach @ other.approach > np.cos(_TWIN_ANGLE))


class Grasps(Sequence[Grasp]):
    """Grasps of an object, the best first, and the candidates that were rejected.

    Attributes:
        kept: The grasps, sorted by descending quality.
        rejected: The other candidates, each with its reason.
        friction: Friction coefficient.

    Example:
        >>> found = ravemj.grasps(robot, mug, method="antipodal")
        >>> print(found)  # how many candidates were rejected for which reason
        >>> found[0].quality
    """

    def __init__(self, grasps: Sequence[Grasp], friction: float) -> None:
        self.kept = tuple(sorted((grasp for grasp in grasps if not grasp.reason), key=lambda grasp: -grasp.quality))
        self.rejected = tuple(grasp for grasp in grasps if grasp.reason)
        self.friction = friction

    @overload
    def __getitem__(self, index: int) -> Grasp: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Grasp]: ...
    def __getitem__(self, index: int | slice) -> Grasp | Sequence[Grasp]:
        """Return a grasp, or some of them; 0 is the best."""
        return self.kept[index]

    def __len__(self) -> int:
        """Return the number of grasps."""
        return len(self.kept)

    def distinct(self, most: int) -> list[Grasp]:
        """Return at most ``most`` grasps, the best first, without those similar to a better one.

        Grasps are similar if their approaches differ by at most 20 degrees, and each contact of either is within 1.5 cm
        of a contact of the other.
        """
        chosen: list[Grasp] = []
        for grasp in self.kept:
            if len(chosen) < most and not any(_are_twins(grasp, better) for better in chosen):
                chosen.append(grasp)
        return chosen

    @property
    def counts(self) -> dict[str, int]:
        """Number of rejected candidates by reason, the most frequent first."""
        return dict(Counter(grasp.reason for grasp in self.rejected).most_common())

    def __str__(self) -> str:
        """Return a table of the numbers of rejected candidates by reason."""
        total = len(self.kept) + len(self.rejected)
        rows = [(f"{len(self.kept)}", f"grasps of {total} candidates, friction {self.friction:g}")]
        rows += [(str(count), reason) for reason, count in self.counts.items()]
        width = max(len(count) for count, _ in rows)
        return "\n".join(f"{count:>{width}}  {text}" for count, text in rows)


class Choices(NamedTuple):
    """Settings of a search.

    Attributes:
        method: ``fly`` moves the hand along approach rays until it touches; ``antipodal`` places parallel jaws at pairs
            of opposite points.
        friction: Friction coefficient.
        delta: Spacing of the approach rays [m].
        rolls: Number of rotations of the hand about each approach, or about the line of each pair.
    """

    method: Method
    friction: float
    delta: float
    rolls: int


Reach = Callable[[Floats], Floats | str]
"""Function that returns the arm's joint values for ``T_world_tool``, or the reason why there are none.

The gripper is open during the call.
"""


def count_candidates(robot: BodyState, arm: Manipulator, target: BodyState, choices: Choices) -> int:
    """Return the number of candidates of a search; the caller holds the lock.

    Raises:
        ArgumentError: under the same conditions as in ``search``.
    """
    with _opened(robot, arm):
        return len(_CandidateSearch(robot, arm, target, choices).candidates())


def search(
    robot: BodyState,
    arm: Manipulator,
    target: BodyState,
    choices: Choices,
    reach: Reach | None = None,
    *,
    span: tuple[int, int] | None = None,
    progress: Callable[[int], object] | None = None,
) -> list[Grasp]:
    """Return the grasps of an object, and the rejected candidates; robot and object are restored afterwards.

    Args:
        robot: The robot; the caller holds the lock.
        arm: Its manipulator.
        target: The object.
        choices: Settings of the search.
        reach: Test whether the arm reaches a pose; None: only the hand is tested.
        span: First index, and one past the last index, of the candidates to try; None: all.
        progress: Called with the number of candidates tried so far.

    Raises:
        ArgumentError: the manipulator has no gripper joints that close, no effector, or no parallel jaws that
            ``antipodal`` needs; or the object has no shapes.
    """
    with _opened(robot, arm):
        candidates = _CandidateSearch(robot, arm, target, choices)
        return candidates.run(candidates.candidates()[slice(*(span or (None,)))], reach, progress)


def proved(robot: BodyState, arm: Manipulator, target: BodyState, grasp: Grasp, friction: float) -> Grasp:
    """Return a grasp with the result of its physics simulation; the robot is restored. The caller holds the lock."""
    saved = robot.configuration()
    try:
        values = robot.kinematics.values()
        values[list(arm.gripper_dofs)] = grasp.closed
        robot.set_values(values)
        assert arm.effector is not None
        T_base_tool = inverse(robot.link_transform(0)) @ robot.link_transform(arm.effector)
        T_base_tool = T_base_tool @ arm.T_effector_tool.matrix()
        robot.set_transform(target.link_transform(0) @ grasp.pose @ inverse(T_base_tool))
        gravity = np.array(robot.simulation.gravity)
        return replace(grasp, proof=prove(robot, arm, target, friction, gravity))
    finally:
        robot.restore(saved)


@contextmanager
def _at_origin(body: BodyState) -> Generator[None]:
    """Context manager that moves a body to the origin of the world, and restores its pose afterwards."""
    saved = body.configuration()
    body.set_transform(np.eye(4))
    try:
        yield
    finally:
        body.restore(saved)


@contextmanager
def _opened(robot: BodyState, arm: Manipulator) -> Generator[None]:
    """Context manager that opens the gripper to its limits, and restores the robot afterwards."""
    saved = robot.configuration()
    try:
        _open(robot, arm)
        yield
    finally:
        robot.restore(saved)


def _open(robot: BodyState, arm: Manipulator) -> None:
    if not closes(arm):
        message = f"manipulator '{arm.name}' has no gripper joints that close"
        raise ArgumentError(f"{message}; name them in <joints>, and their signs in <closingdirection>")
    values = robot.kinematics.values()
    for dof, side in zip(arm.gripper_dofs, arm.chucking_direction, strict=True):
        axis = robot.scene.dof_axes[dof]
        if side and not axis.circular:
            values[dof] = axis.lower if side > 0 else axis.upper
    robot.set_values(values)


class _Candidate(NamedTuple):
    """Simulated grasp: base pose of the hand, approach direction, result of closing, and reason of a failure."""

    T_world_base: Floats
    approach: Floats
    closed: Closed | None
    reason: str


_Make = Callable[[HandTests], _Candidate]
"""Function that simulates a candidate grasp."""


class _CandidateSearch:
    def __init__(self, robot: BodyState, arm: Manipulator, target: BodyState, choices: Choices) -> None:
        self._robot, self._arm, self._target, self._choices = robot, arm, target, choices
        sides = dict(zip(arm.gripper_dofs, arm.chucking_direction, strict=True))
        self._hand: Hand = hand_of(robot, arm, sides)
        self._placed: Target = target_of(target)
        self._T_world_target = self._placed.T_world_target
        self._gripper = list(arm.gripper_dofs)
        self._signs = np.array(arm.chucking_direction)
        self._geoms = robot.simulation.collisions().geoms_of_body(target)
        with _at_origin(target):
            T_target_links = target.link_transforms()
        bounds = links_bounds(target.scene.links, T_target_links)
        if bounds is None or not len(self._geoms):
            hint = "enable it with Enable(True)" if not any(target.link_enabled) else "give it geometries"
            raise ArgumentError(f"body '{target.scene.name}' has no shapes that collide; {hint}")
        self._low, self._high = np.array(bounds.low), np.array(bounds.high)
        self._center, self._radius = self._mass_center(T_target_links)

    def _mass_center(self, T_target_links: Floats) -> tuple[Floats, float]:
        """Return the centre of mass in the object's frame, and its distance to the farthest bounding box corner [m]."""
        links = self._target.scene.links
        masses = np.array([link.inertial.mass for link in links])
        centers = np.array(
            [T[:3, :3] @ link.inertial.com + T[:3, 3] for link, T in zip(links, T_target_links, strict=True)]
        )
        center = masses @ centers / masses.sum() if masses.sum() > 0 else (self._low + self._high) / 2
        return center, float(np.linalg.norm(np.maximum(self._high - center, center - self._low)))

    def candidates(self) -> list[_Make]:
        """Return functions that simulate the candidate grasps.

        The target is temporarily moved to the origin, so that rounding errors do not depend on its pose.
        """
        with _at_origin(self._target):
            return list((self._flown if self._choices.method == "fly" else self._jawed)(self._surface()))

    def run(
        self, candidates: Sequence[_Make], reach: Reach | None, progress: Callable[[int], object] | None
    ) -> list[Grasp]:
        judged: list[Grasp] = []
        with hand_tests(self._robot.simulation.collisions(), self._robot, self._target) as tests:
            for number, make in enumerate(candidates, 1):
                judged.append(self._judged(make(tests), tests))
                if progress is not None:
                    progress(number)
        if reach is not None:
            judged = [grasp if grasp.reason else self._reached(grasp, reach) for grasp in judged]
        return judged

    def _surface(self) -> Floats:
        """Return points of the surface and outward normals in the object's frame, shape (n, 6)."""
        rays = box_rays((self._low + self._high) / 2, (self._high - self._low) / 2, self._choices.delta).numbers()
        hit, rows = self._cast(rays)
        return rows[hit & ((rows[:, 3:] * rays[:, 3:]).sum(axis=1) < 0)]

    def _cast(self, rays: Floats) -> tuple[NDArray[np.bool_], Floats]:
        """Return the first hits of rays with the object, which must be at the origin."""
        return self._robot.simulation.collisions().rays.first_hits(rays, self._geoms)

    def _flown(self, surface: Floats) -> Iterator[_Make]:
        """Yield candidates: the hand moves against each surface point's normal, with each roll and standoff."""
        tool_direction = np.array(self._arm.direction)
        for row in surface:
            for roll in 2 * np.pi * np.arange(self._choices.rolls) / self._choices.rolls:
                for standoff in _STANDOFFS:
                    yield partial(self._fly, Approach(-row[3:], tool_direction, row[:3], float(roll), standoff))

    def _fly(self, approach: Approach, tests: HandTests) -> _Candidate:
        closed = close(self._hand, self._placed, approach, tests)
        reason = "" if closed.reason is None else str(closed.reason)
        return _Candidate(closed.T_world_base, approach.direction, closed, reason)

    def _jawed(self, surface: Floats) -> Iterator[_Make]:
        """Yield candidates in which the jaws close on each pair of opposite surface points."""
        jaws = jaws_of(self._robot, self._arm)
        for pair in antipodal.pairs(surface, self._cast, self._choices.friction, jaws.width - CLEARANCE):
            if pair.reason:
                yield partial(self._unplaced, pair.reason)
                continue
            for T_target_tool in antipodal.tool_poses(pair, jaws, self._choices.rolls):
                yield partial(self._close_jaws, T_target_tool, jaws.approach)

    def _unplaced(self, reason: str, tests: HandTests) -> _Candidate:
        del tests
        return _Candidate(self._T_world_target @ inverse(self._hand.T_base_tool), np.zeros(3), None, reason)

    def _close_jaws(self, T_target_tool: Floats, tool_direction: Floats, tests: HandTests) -> _Candidate:
        """Move the jaws to a pose along a straight line, and close them."""
        T_world_base = self._T_world_target @ T_target_tool @ inverse(self._hand.T_base_tool)
        along = T_target_tool[:3, :3] @ tool_direction
        hits = self._approach(T_world_base, self._T_world_target[:3, :3] @ along, tests)
        if hits:
            return _Candidate(T_world_base, along, None, f"in collision with '{hits}'")
        approach = Approach(along, tool_direction, flies=False)
        closed = close(replace(self._hand, T_world_base=T_world_base), None, approach, tests)
        return _Candidate(T_world_base, along, closed, "" if closed.reason is None else str(closed.reason))

    def _approach(self, T_world_base: Floats, along: Floats, tests: HandTests) -> str | None:
        """Return the name of a body that the open hand touches at the grasp or on the straight line to it, or None."""
        for distance in np.arange(0.0, _BACK + _STEP / 2, _STEP):
            T = T_world_base.copy()
            T[:3, 3] -= distance * along
            name = tests(self._hand.links, T, self._hand.values)
            if name:
                return name
        return None

    def _judged(self, candidate: _Candidate, tests: HandTests) -> Grasp:
        """Evaluate a candidate: return its grasp with contacts and quality, or with the reason of rejection."""
        pose = inverse(self._T_world_target) @ candidate.T_world_base @ self._hand.T_base_tool
        preshape, closed = self._hand.values[self._gripper], candidate.closed
        values = self._hand.values if closed is None else closed.values
        grasp = Grasp(pose, preshape, values[self._gripper], np.zeros((0, 6)), candidate.approach)
        reason = candidate.reason or self._stuck(values, candidate, tests)
        if reason:
            return replace(grasp, reason=reason)
        squeezed = values.copy()
        squeezed[self._gripper] += SQUEEZE * self._signs
        contacts, _ = tests.contacts(self._hand.links, candidate.T_world_base, squeezed)
        rows = contact_rows(contacts)
        R, origin = self._T_world_target[:3, :3], self._T_world_target[:3, 3]
        rows = np.hstack([(rows[:, :3] - origin) @ R, rows[:, 3:] @ R])
        friction = self._choices.friction
        mindist = epsilon(rows[:, :3], rows[:, 3:], friction) if len(rows) > 1 else 0.0
        if mindist <= 0:
            return replace(grasp, contacts=rows, reason="not closed")
        best = quality(rows[:, :3], rows[:, 3:], friction, self._center, self._radius)
        return replace(
            grasp, contacts=rows, epsilon=mindist, quality=best.epsilon, limiting=best.contacts, weakest=best.direction
        )

    def _stuck(self, values: Floats, candidate: _Candidate, tests: HandTests) -> str:
        """Return a reason for rejection if a finger that did not close touches the object; else an empty string."""
        for finger in self._hand.fingers:
            is_open = finger.side and values[finger.dof] == self._hand.values[finger.dof]
            if is_open and tests(finger.links, candidate.T_world_base, values, "target"):
                return str(Reason("starts in contact", finger.name))
        return ""

    def _reached(self, grasp: Grasp, reach: Reach) -> Grasp:
        """Return a grasp with joint values of the arm, or with the reason why the arm does not reach it."""
        T_world_tool = self._T_world_target @ grasp.pose
        T_world_tool[:3, 3] -= _FREE * self._T_world_target[:3, :3] @ grasp.approach
        reached = reach(T_world_tool)
        return replace(grasp, reason=reached) if isinstance(reached, str) else replace(grasp, arm=reached)

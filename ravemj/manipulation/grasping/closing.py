"""Simulation of a grasp: approach of the hand, standoff, and fingers that close one by one.

The steps are those of OpenRAVE's planner ``Grasper``. Coarse steps bracket each contact, and bisection finds it. A
function tests whether links touch something, so that this module knows neither bodies nor collision checkers.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, Protocol

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.engine.collision.hand import Against
from ravemj.geometry_functions import quatRotateDirection, rotationMatrixFromAxisAngle, rotationMatrixFromQuat

Kind = Literal["flies past", "touches first", "finger touches", "starts in contact", "avoided link", "self-collision"]
"""Failure causes, under which failed grasps are counted."""

_TEXTS: Mapping[Kind, str] = {
    "flies past": "flies past the target",
    "touches first": "touches '{name}' first",
    "finger touches": "finger '{finger}' touches '{name}' first",
    "starts in contact": "finger '{name}' starts in contact",
    "avoided link": "avoided link '{name}' touches",
    "self-collision": "ends in self-collision with link '{name}'",
}

_BACK = 0.05
"""Step by which a hand in contact with the target is moved back before the approach [m]; OpenRAVE's."""

_FINER = 16.0
"""Ratio of the fine step to the tolerance of contacts."""

_PARALLEL = 1e-9
"""Cosine of the angle between a stop plane's normal and the approach below which the hand never reaches the plane."""

_IS_PLANE = 0.5
"""Squared norm of the four numbers of a stop plane up to which they mean that there is none; OpenRAVE's."""


class Touches(Protocol):
    """Protocol of the collision test of a robot."""

    def __call__(
        self, links: frozenset[int], T_world_base: Floats, values: Floats, against: Against = "anything"
    ) -> str | None:
        """Return the name of a body, or of another link of the robot, in contact with the links; None if there is none.

        Args:
            links: Indices of the links to test.
            T_world_base: Pose of the robot.
            values: Values of all its DOFs [rad or m].
            against: The bodies to test against.
        """
        ...


@dataclass(frozen=True)
class Reason:
    """Reason why a grasp failed.

    Attributes:
        kind: The cause.
        name: The body, link or joint concerned; empty if there is none.
        finger: The joint that was closing, for ``finger touches``.
    """

    kind: Kind
    name: str = ""
    finger: str = ""

    def __str__(self) -> str:
        return _TEXTS[self.kind].format(name=self.name, finger=self.finger)


class Ball(NamedTuple):
    """Bounding sphere of a body: centre [m], shape (3,), and radius [m]."""

    center: Floats
    radius: float


@dataclass(frozen=True)
class Finger:
    """Gripper joint that closes.

    Attributes:
        dof: Its DOF index.
        name: Its name.
        side: Sign of the closing motion; 0: the joint does not move.
        limits: Lower and upper limit [rad or m].
        links: Indices of the links that the joint moves.
        is_slider: Whether values are in metres.
    """

    dof: int
    name: str
    side: float
    limits: tuple[float, float]
    links: frozenset[int]
    is_slider: bool = False


@dataclass(frozen=True)
class Hand:
    """Robot before the approach.

    Attributes:
        values: Values of all DOFs [rad or m], including the preshape of the gripper, shape (dof,).
        T_world_base: Its pose.
        T_base_tool: Pose of the tool in the frame of the robot, at ``values``.
        fingers: The joints that close, in the order of closing.
        links: Indices of the links of the hand: effector, links fixed to it, and fingers.
        all_links: Indices of all links of the robot.
        ball: Bounding sphere of the robot, in its own frame.
        names: Names of the links.
    """

    values: Floats
    T_world_base: Floats
    T_base_tool: Floats
    fingers: Sequence[Finger]
    links: frozenset[int]
    all_links: frozenset[int]
    ball: Ball
    names: Sequence[str]


@dataclass(frozen=True)
class Target:
    """Body to grasp: its pose, and its bounding sphere in the world."""

    T_world_target: Floats
    ball: Ball


@dataclass(frozen=True)
class Approach:
    """Approach of the hand to the target. Vectors are in the frame of the target.

    Attributes:
        direction: Direction of the motion, shape (3,).
        position: Position of the tool at the start [m], shape (3,).
        roll: Rotation about ``tool_direction`` [rad].
        tool_direction: The direction, in the frame of the tool, that is rotated to ``direction``, shape (3,).
        standoff: Distance by which the hand retreats after the contact [m]; negative values count as 0.
        plane: Alternative to ``standoff``: the hand moves until the tool is on the plane n.x + d = 0, shape (4,).
        flies: Whether the hand is placed and moves to the target; otherwise only the fingers move.
        only_target: Whether contact with another body is a failure.
        avoid_contact: Whether fingers stop one fine step before contact, and may not start in contact.
        avoided: Indices of links that must not touch anything.
        leaves_contact: Whether fingers that start in contact may leave it within one coarse step.
    """

    direction: Floats
    tool_direction: Floats
    position: Floats | None = None
    roll: float = 0.0
    standoff: float = 0.0
    plane: Floats | None = None
    flies: bool = True
    only_target: bool = True
    avoid_contact: bool = False
    avoided: frozenset[int] = frozenset()
    leaves_contact: bool = False


class Steps(NamedTuple):
    """Step lengths of a simulation: coarse and fine [rad], and the factor for motions in metres [m/rad]."""

    coarse: float = 0.1
    fine: float = 0.001
    per_radian: float = 0.1


STEPS = Steps()
"""OpenRAVE's step lengths."""


class Waypoint(NamedTuple):
    """A configuration of the robot: its pose, and the values of all DOFs [rad or m]."""

    T_world_base: Floats
    values: Floats


@dataclass(frozen=True)
class Closed:
    """Result of a grasp simulation.

    Attributes:
        T_world_base: Last pose of the robot.
        values: Last values of all DOFs [rad or m], shape (dof,).
        path: The start of the approach, its end, and a waypoint for each finger that moved.
        reason: The reason of the failure; None if the grasp succeeded.
    """

    T_world_base: Floats
    values: Floats
    path: tuple[Waypoint, ...]
    reason: Reason | None

    @property
    def end(self) -> Waypoint:
        """The last configuration."""
        return Waypoint(self.T_world_base, self.values)


def tool_start(approach: Approach) -> Floats:
    """Return ``T_target_tool`` at the start: rolled about the tool's direction, then aligned with the approach."""
    along = _unit(approach.tool_direction)
    roll = rotationMatrixFromAxisAngle(along, approach.roll)
    T_target_tool = np.eye(4)
    T_target_tool[:3, :3] = rotationMatrixFromQuat(quatRotateDirection(along, approach.direction)) @ roll
    if approach.position is not None:
        T_target_tool[:3, 3] = approach.position
    return T_target_tool


def displaced(target: Target, noise: float, random: np.random.Generator) -> Target:
    """Return a target with a random error of its pose, OpenRAVE's ``graspingnoise``.

    A random number divides the noise between a translation and a rotation about the centre of the target's bounding
    sphere. As in OpenRAVE, the angle [rad] is proportional to the radius [m], not to its inverse.

    Args:
        target: The target.
        noise: Largest translation along each axis [m].
        random: Source of random numbers.
    """
    share = random.random()
    axis = random.normal(size=3)
    angle = random.random() * noise * share * target.ball.radius
    motion = np.eye(4)
    motion[:3, :3] = rotationMatrixFromAxisAngle(_unit(axis), angle)
    motion[:3, 3] = target.ball.center - motion[:3, :3] @ target.ball.center
    motion[:3, 3] += (1 - share) * noise * random.uniform(-1, 1, 3)
    return Target(motion @ target.T_world_target, target.ball)


def close(hand: Hand, target: Target | None, approach: Approach, touches: Touches, steps: Steps = STEPS) -> Closed:
    """Simulate a grasp: place the hand, move it into contact, retreat by the standoff, and close each finger.

    Args:
        hand: The robot.
        target: The body to grasp; None if only the fingers move.
        approach: The approach of the hand.
        touches: The collision test.
        steps: Step lengths. Contacts are found to a sixteenth of the fine step.

    Example:
        >>> closed = close(hand, target, Approach(direction=z, tool_direction=z), touches)
        >>> str(closed.reason)
        "flies past the target"
    """
    return _ClosingSimulation(hand, approach, touches, steps).run(target)


class _ClosingSimulation:
    """Simulation of one grasp: configuration of the hand, and its collision tests."""

    def __init__(self, hand: Hand, approach: Approach, touches: Touches, steps: Steps) -> None:
        self._hand, self._approach, self._touches, self._steps = hand, approach, touches, steps
        self._pose, self._values = hand.T_world_base, hand.values.copy()
        self._path: list[Waypoint] = []

    def run(self, target: Target | None) -> Closed:
        reason = self._run(target)
        return Closed(self._pose, self._values, tuple(self._path), reason)

    def _run(self, target: Target | None) -> Reason | None:
        if target is not None and self._approach.flies:
            reason = self._fly(target)
            if reason is not None:
                return reason
        self._remember()
        reason = self._forbidden_contact()
        for finger in self._hand.fingers if reason is None else ():
            reason = self._close_finger(finger)
            if reason is not None:
                return reason
        if reason is None:
            reason = self._forbidden_contact()
        if reason is None and (name := self._touch(self._hand.links, "itself")):
            reason = Reason("self-collision", name)
        return reason

    def _remember(self) -> None:
        self._path.append(Waypoint(self._pose, self._values.copy()))

    def _touch(self, links: frozenset[int], against: Against) -> str | None:
        return self._touches(links, self._pose, self._values, against)

    def _forbidden_contact(self) -> Reason | None:
        if self._approach.only_target and (name := self._touch(self._hand.links, "others")):
            return Reason("touches first", name)
        return self._avoided_contact()

    def _avoided_contact(self) -> Reason | None:
        for link in sorted(self._approach.avoided):
            if self._touch(frozenset([link]), "anything"):
                return Reason("avoided link", self._hand.names[link])
        return None

    def _fly(self, target: Target) -> Reason | None:
        """Start the hand outside the target, move it into contact, and retreat by the standoff.

        Returns:
            The reason of a failure, or None.
        """
        hand, T_target_tool = self._hand, tool_start(self._approach)
        start = target.T_world_target @ T_target_tool @ inverse(hand.T_base_tool)
        along = target.T_world_target[:3, :3] @ _unit(self._approach.direction)
        center = start[:3, :3] @ hand.ball.center + start[:3, 3]
        reach, ahead = hand.ball.radius + target.ball.radius, float(along @ (target.ball.center - center))

        def touches(distance: float, links: frozenset[int], against: Against) -> bool:
            self._pose = start.copy()
            self._pose[:3, 3] += distance * along
            return bool(self._touch(links, against))

        def contact(first: float, against: Against) -> float | None:
            step, finest = self._steps.coarse * self._steps.per_radian, self._steps.fine * self._steps.per_radian
            return _contact(lambda s: touches(s, hand.links, against), first, ahead + reach, step, finest / _FINER)

        free = 0.0
        while touches(free, hand.all_links, "target") and free > ahead - reach - _BACK:
            free -= _BACK
        self._remember()
        hit = contact(free, "anything")
        further = hit if hit is None or touches(hit, hand.links, "target") else None
        if hit is not None and further is None:  # an obstacle stopped the hand
            further = contact(hit, "target") if self._approach.standoff > 0 else hit
        if hit is None or further is None:
            return Reason("flies past")
        stop = self._stop(hit, further - hit, T_target_tool)
        if stop != hit and touches(stop, hand.all_links, "target"):
            stop = hit
        touches(stop, hand.links, "target")
        return None

    def _stop(self, hit: float, hidden: float, T_target_tool: Floats) -> float:
        """Return the distance at which the approach stops [m], given by the stop plane, else by the standoff.

        Args:
            hit: Distance of the contact [m].
            hidden: Distance from the contact to the target [m]; 0 if no obstacle is in between.
            T_target_tool: Pose of the tool at the start.
        """
        plane, along = self._approach.plane, _unit(self._approach.direction)
        if plane is not None and plane @ plane > _IS_PLANE:
            slope = float(plane[:3] @ along)
            return -float(plane[:3] @ T_target_tool[:3, 3] + plane[3]) / slope if abs(slope) > _PARALLEL else hit
        return hit - max(self._approach.standoff, hidden) if self._approach.standoff > 0 else hit

    def _close_finger(self, finger: Finger) -> Reason | None:
        """Move a finger to its contact or limit; return the reason if that fails, else None."""
        if not finger.side:
            return None
        side, factor = float(np.sign(finger.side)), self._steps.per_radian if finger.is_slider else 1.0
        coarse, fine = self._steps.coarse * factor, self._steps.fine * factor
        start, most = float(self._values[finger.dof]), _range(finger, float(self._values[finger.dof]))

        def touches(moved: float) -> bool:
            self._values[finger.dof] = start + side * moved
            return bool(self._touch(finger.links, "anything") or self._touch(finger.links, "itself"))

        free = 0.0
        if touches(0.0):
            if not self._approach.avoid_contact:
                return None
            free = min(coarse, most)
            if not self._approach.leaves_contact or touches(free):
                self._values[finger.dof] = start
                return Reason("starts in contact", finger.name)
        hit = _contact(touches, free, most, coarse, fine / _FINER)
        touches(most if hit is None else hit)
        if hit is not None and self._approach.only_target and (name := self._touch(finger.links, "others")):
            return Reason("finger touches", name, finger.name)
        if hit is not None and (self._approach.avoid_contact or self._touch(finger.links, "itself")):
            touches(max(hit - fine, 0.0))
        self._remember()
        return self._avoided_contact()


def _unit(vector: Floats) -> Floats:
    return vector / np.linalg.norm(vector)


def _range(finger: Finger, value: float) -> float:
    """Return the distance from a joint value to the limit in the closing direction; 2 pi without limit [rad or m]."""
    most = (finger.limits[1] - value) if finger.side > 0 else (value - finger.limits[0])
    return max(most, 0.0) if np.isfinite(most) else 2 * np.pi


def _contact(touches: Callable[[float], bool], start: float, end: float, step: float, tolerance: float) -> float | None:
    """Return the first position in contact, at most ``tolerance`` beyond the exact one; None if there is none."""
    if touches(start):
        return start
    free = start
    while free < end:
        hit = min(free + step, end)
        if touches(hit):
            while hit - free > tolerance:
                middle = (free + hit) / 2
                free, hit = (free, middle) if touches(middle) else (middle, hit)
            return hit
        free = hit
    return None

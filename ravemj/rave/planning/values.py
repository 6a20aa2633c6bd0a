"""The numbers of a planning problem, and the bodies that they refer to."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.manipulation.bodies import Bodies, Conditions, space_of
from ravemj.manipulation.tool import MovedTool
from ravemj.planning.edges import STEP
from ravemj.planning.retiming.segments import Limits
from ravemj.planning.rrt import MoreGoals
from ravemj.planning.space import Coordinates, Space
from ravemj.rave.body.affine import affine_numbers, default_kinds
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.planning.parameter_text import CHAIN, NUMBERS, VECTORS, read_tags
from ravemj.rave.robot import Robot
from ravemj.trajectories.groups import Group
from ravemj.trajectories.layout import count

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

STEP_LENGTH = float(np.float32(STEP))
"""OpenRAVE's default step length, which it keeps in single precision."""


def _empty() -> Floats:
    return np.zeros(0)


@dataclass
class Values:
    """The numbers of a planning problem, and the bodies that they refer to.

    Attributes:
        vectors: Vectors, by the names of ``parameter_text.VECTORS``.
        numbers: Scalars, by the names of ``parameter_text.NUMBERS``.
        groups: The layout of a configuration.
        weights: The weight of each value in distances, shape (n,).
        postprocessing: The name of the planner that processes the result, and its parameters as text.
        conditions: The bodies that move, none in problems that are read from text, and the conditions that their
            configurations have to keep.
        goal_sampler: A source of further goals.
        tags: Further parameters of one kind of planner, as texts.
    """

    vectors: dict[str, Floats] = field(default_factory=lambda: {name: np.zeros(0) for name in VECTORS})
    numbers: dict[str, float] = field(
        default_factory=lambda: {**dict.fromkeys(NUMBERS, 0.0), "_fsteplength": STEP_LENGTH}
    )
    groups: Sequence[Group] = ()
    weights: Floats = field(default_factory=_empty)
    postprocessing: tuple[str, str] = CHAIN
    conditions: Conditions = field(default_factory=Conditions)
    goal_sampler: MoreGoals | None = None
    tags: dict[str, str] = field(default_factory=lambda: {})

    def state(self, env: "Environment", groups: Sequence[Group]) -> None:
        """Let joints and poses of bodies move, with their current values, limits, weights and resolutions.

        Raises:
            ArgumentError: a group names a body that is not in the environment, or a DOF that its body does not have.
        """
        bodies = Bodies(env.simulation, groups, env.GetCollisionChecker)
        self.conditions = replace(self.conditions, bodies=bodies)
        self.groups, self.weights = groups, _setting(env, bodies, "weight")
        limits = ("lower", "upper", "max_velocity", "max_acceleration", "max_jerk")
        for name, of_body in zip(("lower", "upper", "velocity", "acceleration", "jerk"), limits, strict=True):
            self.vectors[f"_vconfig{name}limit"] = _setting(env, bodies, of_body)
        self.vectors["_vconfigresolution"] = _setting(env, bodies, "resolution")
        self.vectors["_vinitialconfig"] = bodies.values()

    def copied(self) -> "Values":
        """Return an independent copy."""
        conditions = replace(self.conditions, constraints=list(self.conditions.constraints))
        return replace(self, vectors=dict(self.vectors), numbers=dict(self.numbers), conditions=conditions)

    @property
    def bodies(self) -> Bodies | None:
        """The bodies that move; None in problems that are read from text."""
        return self.conditions.bodies

    def with_tags(self, text: str) -> "Values":
        """Return a copy in which the elements of an XML text replace the values of the same names."""
        read = read_tags(text)
        return replace(
            self,
            numbers=self.numbers | read.numbers,
            vectors=self.vectors | read.vectors,
            tags=self.tags | read.others,
            groups=self.groups if read.groups is None else read.groups,
            postprocessing=read.postprocessing or self.postprocessing,
        )

    def tag(self, name: str, default: float) -> float:
        """Return one of the further parameters as a number.

        Raises:
            ArgumentError: the text of the parameter is not a number.
        """
        text = self.tags.get(name, "").strip()
        try:
            return float(text) if text else default
        except ValueError:
            raise ArgumentError(f"<{name}>: '{text}' should be a number") from None

    def random(self) -> np.random.Generator:
        """Return a random number generator with the seed of the problem."""
        return np.random.default_rng(abs(int(self.numbers["_nrandomgeneratorseed"])))

    def coordinates(self) -> Coordinates:
        """Return which values of a configuration are circular angles, positions or quaternions."""
        return self.bodies.coordinates() if self.bodies else Coordinates(np.zeros(count(self.groups), dtype=bool))

    def space(self) -> Space:
        """Return the configuration space."""
        vector = self.vectors
        limits = vector["_vconfiglowerlimit"], vector["_vconfigupperlimit"]
        return space_of(self.coordinates(), *limits, self.weights, vector["_vconfigresolution"])

    def limits(self) -> Limits:
        """Return the limits of motions.

        Raises:
            ArgumentError: the number of limits differs from the number of values.
        """
        names = ("lower", "upper", "velocity", "acceleration", "jerk")
        dof, found = count(self.groups), [self.vectors[f"_vconfig{name}limit"] for name in names]
        if not len(found[4]):
            found[4] = np.full(dof, np.inf)
        for name, numbers in zip(names, found, strict=True):
            if numbers.shape != (dof,):
                raise ArgumentError(f"{name} limits: are {len(numbers)}, and there are {dof} values")
        return Limits(self.coordinates(), *found)

    def check(self) -> None:
        """Check that some joint or body moves, and that each value has limits and a resolution.

        Raises:
            ArgumentError: nothing moves, or a vector of limits or resolutions has another shape or contains NaN.
        """
        dof = count(self.groups)
        if not dof or self.bodies is None:
            raise ArgumentError("nothing moves; call SetRobotActiveJoints(robot) of the parameters")
        for name, numbers in self.vectors.items():
            is_limit = name.startswith("_vconfig") and (name != "_vconfigjerklimit" or len(numbers))
            if is_limit and (numbers.shape != (dof,) or np.isnan(numbers).any()):
                raise ArgumentError(f"{name}: is {numbers.tolist()}, and should be {dof} numbers")

    def configurations(self, name: str) -> Floats:
        """Return the starts or the goals, shape (number, n).

        Raises:
            ArgumentError: the numbers do not fill whole configurations.
        """
        dof, numbers = count(self.groups), self.vectors[name]
        if not dof or numbers.size % dof:
            raise ArgumentError(f"{name}: has {numbers.size} numbers, and should have a multiple of {dof}")
        return numbers.reshape(-1, dof)


def _setting(env: "Environment", bodies: Bodies, name: str) -> Floats:
    """Return one setting of each value of a configuration, shape (n,): a number of joints, or of affine DOFs."""
    numbers = bodies.numbers(name)
    for part in bodies.parts:
        if not part.dofs:
            body = env.wrap(part.body)
            kinds = body.affine_kinds if isinstance(body, Robot) else default_kinds()
            # OpenRAVE has no accelerations and jerks of affine DOFs: its maximum velocities stand for them.
            names = {"max_acceleration": "max_velocity", "max_jerk": "max_velocity"}
            numbers[part.columns] = affine_numbers(kinds, part.affine, part.axis, names.get(name, name))
    return numbers


class Hand(NamedTuple):
    """The active manipulator of the one robot that a problem moves, and its tool."""

    manip: Manipulator
    tool: MovedTool


def hand_of(env: "Environment", values: Values) -> Hand:
    """Return the active manipulator of the one robot that a problem moves.

    Raises:
        ArgumentError: the problem moves anything but the arm joints of one robot's active manipulator.
    """
    bodies = values.bodies
    robot = env.wrap(bodies.bodies[0]) if bodies is not None and len(bodies.bodies) == 1 else None
    manip = robot.GetActiveManipulator() if isinstance(robot, Robot) else None
    if manip is None or bodies is None:
        raise ArgumentError("the hand of one robot should move, and it should have an active manipulator")
    return Hand(manip, MovedTool.of(bodies, manip.description))

"""Values of a planning problem: their text form, and the bodies that they refer to."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.manipulation.bodies import Bodies, Conditions, space_of
from ravemj.manipulation.options import STEP_LENGTH, Certify
from ravemj.manipulation.roots import Sampler
from ravemj.manipulation.tool import MovedTool
from ravemj.planning.retiming.segments import PathLimits
from ravemj.planning.space import Coordinates, Space
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.robot import Robot
from ravemj.rave.robot.active import affine_numbers, default_kinds
from ravemj.trajectories.groups import Group
from ravemj.trajectories.layout import count
from ravemj.trajectories.serialization import groups_of, layout_text

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml.tree import Element
    from ravemj.rave.environment import Environment


VECTORS = (
    "_vinitialconfig",
    "_vinitialconfigvelocities",
    "_vgoalconfig",
    "_vgoalconfigvelocities",
    "_vconfiglowerlimit",
    "_vconfigupperlimit",
    "_vconfigvelocitylimit",
    "_vconfigaccelerationlimit",
    "_vconfigjerklimit",
    "_vconfigresolution",
)
NUMBERS = ("_nmaxiterations", "_nmaxplanningtime", "_fsteplength", "_nrandomgeneratorseed")

_SECOND = "<_nmaxiterations>100</_nmaxiterations><verifyinitialpath>0</verifyinitialpath>"

CHAIN = (
    "linearsmoother",
    f'<_nmaxiterations>20</_nmaxiterations><_postprocessing planner="parabolicsmoother">{_SECOND}</_postprocessing>',
)
"""Default post-processing of paths: the first planner, and its parameters, which name the second."""

CERTIFIED_CHAIN = "parabolicsmoother", _SECOND
"""Default post-processing of certified motions.

It lacks ``linearsmoother``, whose shortcuts cannot be removed again if they cannot be certified.
"""

_SAME = 1e-9
"""Tolerance of equal configuration values [rad or m]."""

_ROOT = "plannerparameters"
_POSTPROCESSING = "_postprocessing"


class Tags(NamedTuple):
    """Parsed text of planner parameters.

    Attributes:
        numbers: Scalars, by the names of ``NUMBERS``.
        vectors: Vectors, by the names of ``VECTORS``.
        groups: The layout of a configuration; None if the text has none.
        postprocessing: The planner that processes the path, and its parameters; None if the text has none.
        others: The content of all other elements as text, by their names.
    """

    numbers: dict[str, float]
    vectors: dict[str, Floats]
    groups: list[Group] | None
    postprocessing: tuple[str, str] | None
    others: dict[str, str]


def parameters_text(
    groups: Sequence[Group],
    vectors: Mapping[str, Floats],
    numbers: Mapping[str, float],
    postprocessing: tuple[str, str],
    extra: str,
) -> str:
    """Return planner parameters as a ``<plannerparameters>`` element; ``extra`` are further elements as text."""
    planner, inner = postprocessing
    lines = [f"<{name}>{' '.join(repr(float(value)) for value in vectors[name])}</{name}>" for name in VECTORS]
    lines += [f"<{name}>{_number_text(numbers[name])}</{name}>" for name in NUMBERS]
    chain = f'<{_POSTPROCESSING} planner="{planner}">{inner}</{_POSTPROCESSING}>'
    return "\n".join([f"<{_ROOT}>", layout_text(groups).rstrip(), *lines, chain, extra, f"</{_ROOT}>", ""])


def _number_text(number: float) -> str:
    return str(int(number)) if number == int(number) else repr(float(number))


@lru_cache(maxsize=64)
def read_tags(text: str) -> Tags:
    """Parse planner parameters. A text without elements is empty, as in OpenRAVE.

    Args:
        text: Elements, or a whole ``<plannerparameters>``.

    Raises:
        ArgumentError: the text is not well-formed XML, or a numeric element contains something else.
    """
    groups: list[Group] | None = None
    postprocessing: tuple[str, str] | None = None
    numbers, vectors, others = dict[str, float](), dict[str, Floats](), dict[str, str]()
    for element in _elements(text):
        name, content = element.tag, (element.text or "").strip()
        if name in NUMBERS:
            numbers[name] = _numbers(name, content, 1)[0]
            if math.isinf(numbers[name]):
                raise ArgumentError(f"<{name}>: '{content}' should be a finite number")
        elif name in VECTORS:
            vectors[name] = np.array(_numbers(name, content))
        elif name == "configuration":
            groups = groups_of(element)
        elif name == _POSTPROCESSING:
            postprocessing = element.attributes.get("planner", ""), _inner(element)
        else:
            others[name] = _inner(element) if element.children else content
    return Tags(numbers, vectors, groups, postprocessing, others)


def _elements(text: str) -> "Sequence[Element]":
    from ravemj.formats.openrave_xml.tree import parse  # noqa: PLC0415 - slow to import

    stripped = text.strip()
    if "<" not in stripped:
        return ()
    document = parse(f"<all>{stripped}</all>".encode(), "planner parameters")
    root = document.root
    if document.error is not None:
        raise ArgumentError(f"planner parameters: {document.error.message}: {stripped!r}")
    return next((child for child in root.children if child.tag == _ROOT), root).children


def _inner(element: "Element") -> str:
    """Return the content of an element as XML text."""
    from xml.sax.saxutils import escape, quoteattr  # noqa: PLC0415 - imports urllib, which is slow

    parts = [escape((element.text or "").strip())]
    for child in element.children:
        attributes = "".join(f" {name}={quoteattr(value)}" for name, value in child.attributes.items())
        parts.append(f"<{child.tag}{attributes}>{_inner(child)}</{child.tag}>")
    return "".join(parts)


def _numbers(name: str, content: str, count: int = 0) -> list[float]:
    try:
        numbers = [float(word) for word in content.split()]
    except ValueError:
        raise ArgumentError(f"<{name}>: '{content}' should be numbers") from None
    if (count and len(numbers) != count) or any(math.isnan(number) for number in numbers):
        raise ArgumentError(f"<{name}>: '{content}' should be {count or 'any number of'} numbers")
    return numbers


def _empty() -> Floats:
    return np.zeros(0)


@dataclass
class Values:
    """Values of a planning problem, and the bodies that they refer to.

    Attributes:
        vectors: Vectors, by the names of ``VECTORS``.
        numbers: Scalars, by the names of ``NUMBERS``.
        groups: The layout of a configuration.
        weights: The weight of each value in distances, shape (n,).
        postprocessing: The name of the post-processing planner, and its parameters as text.
        conditions: The moving bodies, none in problems read from text, and the constraints on their configurations.
        start_sampler: A source of further starts.
        goal_sampler: A source of further goals.
        tags: Planner-specific parameters, as strings.
        certify: Whether to certify that the motion is free of collisions, and to reject uncertified motions.
    """

    vectors: dict[str, Floats] = field(default_factory=lambda: {name: np.zeros(0) for name in VECTORS})
    numbers: dict[str, float] = field(
        default_factory=lambda: {**dict.fromkeys(NUMBERS, 0.0), "_fsteplength": STEP_LENGTH}
    )
    groups: Sequence[Group] = ()
    weights: Floats = field(default_factory=_empty)
    postprocessing: tuple[str, str] = CHAIN
    conditions: Conditions = field(default_factory=Conditions)
    start_sampler: Sampler | None = None
    goal_sampler: Sampler | None = None
    tags: dict[str, str] = field(default_factory=lambda: {})
    certify: Certify = False

    def state(self, env: "Environment", groups: Sequence[Group]) -> None:
        """Set the joints and body poses to plan for, with their current values, limits, weights and resolutions.

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
        """The moving bodies; None in problems read from text."""
        return self.conditions.bodies

    def with_tags(self, text: str) -> "Values":
        """Return a copy in which XML elements override the values of the same names."""
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
        """Return a planner-specific parameter as a number.

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
        """Return the type of each value of a configuration: circular angle, position or quaternion."""
        return self.bodies.coordinates() if self.bodies else Coordinates(np.zeros(count(self.groups), dtype=bool))

    def space(self) -> Space:
        """Return the configuration space."""
        vector = self.vectors
        limits = vector["_vconfiglowerlimit"], vector["_vconfigupperlimit"]
        return space_of(self.coordinates(), *limits, self.weights, vector["_vconfigresolution"])

    def limits(self) -> PathLimits:
        """Return the limits of values, velocities, accelerations and jerks.

        Raises:
            ArgumentError: the number of limits is wrong.
        """
        names = ("lower", "upper", "velocity", "acceleration", "jerk")
        dof, vectors = count(self.groups), [self.vectors[f"_vconfig{name}limit"] for name in names]
        if not len(vectors[4]):
            vectors[4] = np.full(dof, np.inf)
        for name, numbers in zip(names, vectors, strict=True):
            if numbers.shape != (dof,):
                raise ArgumentError(f"{name} limits: are {len(numbers)}, and there are {dof} values")
        return PathLimits(self.coordinates(), *vectors)

    def check(self) -> None:
        """Check that there are joints or bodies to move, and that each value has limits and a resolution.

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

    def index_of(self, side: int, end: Floats) -> int:
        """Return the index of the start (``side`` 0) or goal (1) with the configuration ``end``; -1 if unknown.

        Configurations are counted first, then regions.
        """
        given = self.configurations("_vgoalconfig" if side else "_vinitialconfig")
        for number, configuration in enumerate(given):
            if np.abs(configuration - end).max() <= _SAME:
                return number
        sampler = self.goal_sampler if side else self.start_sampler
        region = -1 if sampler is None else sampler.source.region_of(end)
        return region if region < 0 else len(given) + region

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
    """Return a property of each configuration value, shape (n,), such as a limit, from joints and affine DOFs."""
    numbers = bodies.numbers(name)
    for part in bodies.parts:
        if not part.dofs:
            body = env.wrap(part.body)
            kinds = body.affine_kinds if isinstance(body, Robot) else default_kinds()
            # OpenRAVE has no acceleration and jerk limits of affine DOFs, and uses their maximum velocities instead.
            names = {"max_acceleration": "max_velocity", "max_jerk": "max_velocity"}
            numbers[part.columns] = affine_numbers(kinds, part.affine, part.axis, names.get(name, name))
    return numbers


class Hand(NamedTuple):
    """Active manipulator of the one robot that a problem moves, with its tool."""

    manip: Manipulator
    tool: MovedTool


def hand_of(env: "Environment", values: Values, *, gripper: bool = False) -> Hand:
    """Return the active manipulator of the one robot that a problem moves.

    ``gripper`` allows the gripper joints to move as well.

    Raises:
        ArgumentError: the problem moves anything but the arm joints of one robot's active manipulator.
    """
    bodies = values.bodies
    robot = env.wrap(bodies.bodies[0]) if bodies is not None and len(bodies.bodies) == 1 else None
    manip = robot.GetActiveManipulator() if isinstance(robot, Robot) else None
    if manip is None or bodies is None:
        raise ArgumentError("the hand of one robot should move, and it should have an active manipulator")
    return Hand(manip, MovedTool.for_arm(bodies, manip.description, gripper=gripper))

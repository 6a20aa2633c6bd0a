"""The numbers of a planning problem, and the bodies that they refer to."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.planning.constrained_edges import ConstrainedEdges, Manifold
from ravemj.planning.edges import STEP, Allowed, Edges
from ravemj.planning.retiming.segments import Limits
from ravemj.planning.space import Coordinates, Space
from ravemj.rave.enums import ConstraintFilterOptions
from ravemj.rave.planning.bodies import FREE, USER, Bodies, space_of
from ravemj.rave.planning.parameter_text import CHAIN, NUMBERS, VECTORS, read_tags
from ravemj.rave.report import CollisionReport
from ravemj.trajectories.groups import Group
from ravemj.trajectories.layout import count

STEP_LENGTH = float(np.float32(STEP))
"""OpenRAVE's default step length, which it keeps in single precision."""

ALL = int(ConstraintFilterOptions.RecommendedOptions)
"""The tests that every configuration of a path has to pass."""

Constraint = Callable[[Floats], bool]
"""A function of a configuration that returns whether it is allowed."""


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
        bodies: The bodies that move; None for problems that are read from text.
        constraints: Functions that return whether a configuration is allowed.
        manifold: The configurations that keep a constraint of the hand; None: all.
        goal_sampler: A function that returns a further goal, or None if it has none now; and the fraction of the
            iterations that call it.
        tags: Further parameters of one kind of planner, as texts.
    """

    vectors: dict[str, Floats] = field(default_factory=lambda: {name: np.zeros(0) for name in VECTORS})
    numbers: dict[str, float] = field(
        default_factory=lambda: {**dict.fromkeys(NUMBERS, 0.0), "_fsteplength": STEP_LENGTH}
    )
    groups: Sequence[Group] = ()
    weights: Floats = field(default_factory=_empty)
    postprocessing: tuple[str, str] = CHAIN
    bodies: Bodies | None = None
    constraints: list[Constraint] = field(default_factory=lambda: [])
    manifold: Manifold | None = None
    goal_sampler: tuple[Callable[[], Floats | None], float] | None = None
    tags: dict[str, str] = field(default_factory=lambda: {})

    def copied(self) -> "Values":
        """Return an independent copy."""
        return replace(self, vectors=dict(self.vectors), numbers=dict(self.numbers), constraints=list(self.constraints))

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

    def allowed(self) -> Allowed:
        """Return the test of single configurations. Use it within ``bodies.kept``, since it may move the bodies."""
        fast, manifold = None if self.bodies is None or self.constraints else self.bodies.fast_test(), self.manifold
        if fast is None:
            return lambda values: not self.problem(values, ALL)
        if manifold is not None:
            return lambda values: manifold.has(values) and not fast(values)
        return lambda values: not fast(values)

    def edges(self, ends: Floats) -> Edges:
        """Return the test of lines between starts and goals, shape (m, n), for use within ``bodies.kept``."""
        space, step = self.space(), self.numbers["_fsteplength"]
        if self.bodies is not None and not self.constraints:
            space = self.bodies.near_others(space, ends)
        if self.manifold is None:
            return Edges(space, self.allowed(), step)
        return ConstrainedEdges(space, replace(self, manifold=None).allowed(), self.manifold, step)

    def problem(self, values: Floats, options: int, report: CollisionReport | None = None) -> int:
        """Move the bodies to a configuration, and return the bit of ``ConstraintFilterOptions`` that fails there, or 0.

        ``options`` are the bits to test; the report receives the collision.
        """
        if self.bodies is None:
            return FREE
        self.bodies.move(values)
        found = self.bodies.collision(report) & options
        if found or not options & USER:
            return found
        keeps_all = all(constraint(values) for constraint in self.constraints)
        return FREE if keeps_all and (self.manifold is None or self.manifold.has(values)) else USER

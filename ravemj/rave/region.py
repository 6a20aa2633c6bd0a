"""Task space regions of tool poses, and combinations of them."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple, Protocol, TypeGuard

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_number, checked_numbers, checked_transform
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.regions import AXES, PoseSet
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link

_BOUNDS = (6, 2)


class RegionLike(Protocol):
    """Protocol of objects with the three attributes of a region, such as a ``tsr.TSR`` of the package sstsr."""

    @property
    def T0_w(self) -> ArrayLike:
        """The pose of the region in its frame."""
        ...

    @property
    def Tw_e(self) -> ArrayLike:
        """The pose of the tool in the region where all coordinates are 0."""
        ...

    @property
    def Bw(self) -> ArrayLike:
        """The bounds, shape (6, 2)."""
        ...


class Region(ApiObject):
    """A task space region: the tool poses between bounds of six coordinates.

    The poses are ``T0_w @ D @ Tw_e`` in the frame, with ``D = translate(x, y, z) Rz(yaw) Ry(pitch) Rx(roll)`` and
    the six numbers within ``Bw`` (D. Berenson, S. Srinivasa and J. Kuffner, "Task Space Regions", IJRR 30(12), 2011).
    At a pitch of 90 degrees roll and yaw turn about one axis, so choose ``T0_w`` such that the largest rotation is the
    yaw.

    Args:
        T0_w: The pose of the region in the frame: 4x4, 3x4 or 7 numbers; by default the frame itself.
        Tw_e: The pose of the tool in the region where all coordinates are 0; by default the region itself.
        Bw: Lower and upper bounds of x, y, z [m], roll, pitch, yaw [rad], shape (6, 2); by default zeros. Lengths may
            be unbounded (``inf``) in constraints; an angle whose bounds are a turn or more apart is free.
        lean: Maximum angle [rad] between the z axes of region and tool. It replaces the bounds of roll and pitch, which
            allow more combined: 15 degrees each give 21 degrees. The yaw is then about the z axis of the tool.
        frame: The link or body that carries the region, at its pose at the time of use; None means the world.
        name: A name for messages.
        preshape: The values of the gripper's joints [rad or m] with which the tool should arrive at a goal, in the
            order of ``GetGripperIndices``; None means the values at the start. Constraints ignore it.

    Raises:
        ArgumentError: a pose is not rigid, or bounds are invalid.

    Example:
        A grasp of a can from any side, up to 3 cm above or below its middle:

        >>> side = ravemj.matrixFromAxisAngle([0, np.pi / 2, 0])
        >>> region = Region(Tw_e=side, Bw=[[0, 0], [0, 0], [-0.03, 0.03], [0, 0], [0, 0], [-np.pi, np.pi]])
        >>> region.contains(region.sample(seed=1)[0])
        True
    """

    _internal = ("at_present", "relative")

    def __init__(
        self,
        T0_w: ArrayLike | None = None,
        Tw_e: ArrayLike | None = None,
        Bw: ArrayLike | None = None,
        *,
        lean: float | None = None,
        frame: Link | KinBody | None = None,
        name: str = "",
        preshape: ArrayLike | None = None,
    ) -> None:
        self.name = name
        self._preshape = None if preshape is None else checked_numbers(preshape, "Region: preshape")
        if self._preshape is not None and (self._preshape.ndim != 1 or not np.isfinite(self._preshape).all()):
            wanted = "finite numbers, one for each joint of the gripper"
            raise ArgumentError(f"Region: preshape is {self._preshape.tolist()}, and should be {wanted}")
        wanted = "a link or a body"
        self._frame = None if frame is None else checked_kind(frame, (Link, KinBody), "Region: frame", wanted)
        frames = [np.eye(4) if T is None else _pose(T, word) for T, word in ((T0_w, "T0_w"), (Tw_e, "Tw_e"))]
        bounds = _checked_bounds(np.zeros(_BOUNDS) if Bw is None else Bw)
        if lean is not None:
            lean = checked_number(lean, "Region: lean", 0.0, " rad")
            if lean > np.pi or bounds[3:5].any():
                mistake = f"lean is {lean:g} with roll and pitch {bounds[3:5].tolist()}"
                raise ArgumentError(
                    f"Region: {mistake}; it should be pi at most, and replaces bounds of roll and pitch"
                )
        self._poses = PoseSet(frames[0], frames[1], bounds[:, 0], bounds[:, 1], lean)

    @property
    def T0_w(self) -> Floats:
        """The pose of the region in its frame, shape (4, 4)."""
        return self._poses.T0_w.copy()

    @property
    def Tw_e(self) -> Floats:
        """The pose of the tool in the region where all coordinates are 0, shape (4, 4)."""
        return self._poses.Tw_e.copy()

    @property
    def Bw(self) -> Floats:
        """Lower and upper bounds of x, y, z [m], roll, pitch, yaw [rad], shape (6, 2)."""
        return np.stack([self._poses.lower, self._poses.upper], axis=1)

    @property
    def lean(self) -> float | None:
        """Maximum angle between the z axes of region and tool [rad]; None if roll and pitch have bounds."""
        return self._poses.lean

    @property
    def frame(self) -> Link | KinBody | None:
        """The link or body that carries the region; None for the world."""
        return self._frame

    @property
    def preshape(self) -> Floats | None:
        """The gripper's joint values at a goal [rad or m], shape (k,); None means those at the start."""
        return None if self._preshape is None else self._preshape.copy()

    def at_present(self) -> PoseSet:
        """Return the region in the world for the present pose of its frame.

        Raises:
            ArgumentError: the link or body of the frame has been removed.
        """
        return self._poses if self._frame is None else self._poses.moved(present_pose(self._frame, self.name))

    def relative(self) -> PoseSet:
        """Return the region relative to its frame."""
        return self._poses

    def displacement(self, T_world_tool: ArrayLike) -> Floats:
        """Return the excess of each coordinate of a pose over its bounds.

        Of the equivalent roll, pitch and yaw angles, those nearest to the bounds are used.

        Args:
            T_world_tool: The pose of the tool: 4x4, 3x4 or 7 numbers.

        Returns:
            Lengths [m] and angles [rad], 0 inside the bounds, shape (6,).
        """
        return self.at_present().displacement(_pose(T_world_tool, "T_world_tool"))

    def distance(self, T_world_tool: ArrayLike) -> float:
        """Return the norm of the displacement of a pose from the region, with equal weights of metres and radians.

        Args:
            T_world_tool: The pose of the tool: 4x4, 3x4 or 7 numbers.
        """
        return self.at_present().distance(_pose(T_world_tool, "T_world_tool"))

    def nearest(self, T_world_tool: ArrayLike) -> Floats:
        """Return the nearest pose of the region: the coordinates of a pose clipped to the bounds, shape (4, 4).

        Args:
            T_world_tool: The other pose: 4x4, 3x4 or 7 numbers.
        """
        return self.at_present().nearest(_pose(T_world_tool, "T_world_tool"))

    def contains(self, T_world_tool: ArrayLike) -> bool:
        """Return whether a pose is in the region, within tolerances.

        These are 1e-6 rad for angles; for lengths 1e-6 of the largest coordinates of the pose, ``T0_w`` and ``Tw_e``.

        Args:
            T_world_tool: The pose of the tool: 4x4, 3x4 or 7 numbers.
        """
        return self.at_present().contains(_pose(T_world_tool, "T_world_tool"))

    def sample(
        self, count: int = 1, seed: int | np.random.Generator | None = None, *, over_rotations: bool = False
    ) -> Floats:
        """Return random poses of the tool, ``T_world_tool``, shape (count, 4, 4).

        Args:
            count: The number of poses.
            seed: A seed or random generator; None means a random seed.
            over_rotations: Draw the rotations uniformly. By default each coordinate is uniform, so that poses with a
                pitch near 90 degrees are over-represented.

        Raises:
            ArgumentError: a length of the region has no bounds.
        """
        return self.at_present().sample(np.random.default_rng(seed), count, over_rotations=over_rotations)

    def width(self) -> float:
        """Return the sum of the widths of the six intervals, with equal weights of metres and radians.

        Unions sample their regions in proportion to it. The weight of a region is at least a tenth of the mean, so that
        single poses are sampled, too.
        """
        return self._poses.width()

    def __repr__(self) -> str:
        lean = "" if self.lean is None else f", lean={self.lean:g}"
        name = f", name={self.name!r}" if self.name else ""
        return f"<Region Bw={self.Bw.tolist()}{lean}{name}>"


def region_of(given: RegionLike) -> Region:
    """Convert an object with the attributes of a region to a ``Region``.

    In such objects, an upper angle below the lower one means an interval through pi.
    """
    if isinstance(given, Region):
        return given
    bounds = checked_numbers(given.Bw, "Bw")
    if bounds.shape == _BOUNDS:
        angles = bounds[3:]
        angles[:, 1] += np.where(angles[:, 1] < angles[:, 0], 2 * np.pi, 0.0)
    return Region(given.T0_w, given.Tw_e, bounds, name=str(getattr(given, "name", "")))


class Sets(NamedTuple):
    """Union or intersection of sets of tool poses or configurations.

    Attributes:
        members: Regions, sets with a function ``contains``, and combinations of them.
        any: Whether it is the union, else the intersection.
    """

    members: tuple[object, ...]
    any: bool


def all_of(*sets: object) -> Sets:
    """Return the intersection of sets: as a constraint, all of them must hold.

    Args:
        sets: Regions, objects with a function ``contains(values)``, predicates of a configuration, or combinations of
            these.

    Example:
        >>> params.add_constraint(ravemj.all_of(upright, in_front))
    """
    return Sets(_members(sets, "all_of"), any=False)


def any_of(*sets: object) -> Sets:
    """Return the union of sets: as a constraint, at least one of them must hold.

    If all are regions, planners project configurations onto the nearest one.

    Args:
        sets: As for ``all_of``.
    """
    return Sets(_members(sets, "any_of"), any=True)


def _members(sets: Sequence[object], name: str) -> tuple[object, ...]:
    if not sets:
        raise ArgumentError(f"{name}: there is no set; give one at least")
    for member in sets:
        if not (
            isinstance(member, Sets)
            or is_region(member)
            or callable(member)
            or callable(getattr(member, "contains", None))
        ):
            raise ArgumentError(
                f"{name}: {member!r} is no region, function, or object with a function contains(values)"
            )
    return tuple(sets)


def is_region(thing: object) -> TypeGuard[RegionLike]:
    """Return whether an object has the attributes ``T0_w``, ``Tw_e`` and ``Bw`` of a region."""
    return all(hasattr(thing, name) for name in ("T0_w", "Tw_e", "Bw"))


def regions_of(given: object, name: str) -> list[Region]:
    """Return the given regions, one or several, as a list.

    Raises:
        ArgumentError: the list is empty, or has an element that is not a region.
    """
    several: list[object] = [given] if is_region(given) else list(given) if _is_list(given) else []
    regions = [region_of(region) for region in several if is_region(region)]
    if not several or len(regions) < len(several):
        mistake = "an empty list" if _is_list(given) and not several else f"{given!r}"
        raise ArgumentError(f"{name}: is {mistake}, and should be regions: ravemj.Region(T0_w, Tw_e, Bw)")
    return regions


def _is_list(given: object) -> TypeGuard[Iterable[object]]:
    return isinstance(given, Iterable) and not isinstance(given, str | bytes)


def present_pose(frame: Link | KinBody, name: str) -> Floats:
    """Return the pose of a link or body in the world, shape (4, 4).

    Raises:
        ArgumentError: it has been removed.
    """
    body = frame if isinstance(frame, KinBody) else frame.GetParent()
    env = body.GetEnv()
    if not env.simulation.holds(body.simulation_state):
        raise ArgumentError(f"region '{name}': its frame was removed from the environment: {frame!r}")
    return frame.GetTransform()


def _pose(given: ArrayLike, name: str) -> Floats:
    try:
        return checked_transform(given, f"Region: {name}")
    except ValueError as error:  # of a wrong shape
        raise ArgumentError(str(error)) from None


def _checked_bounds(given: ArrayLike) -> Floats:
    bounds = checked_numbers(given, "Region: Bw")
    if bounds.shape != _BOUNDS or np.isnan(bounds).any():
        wanted = "two numbers for each of x, y, z, roll, pitch, yaw: shape (6, 2)"
        raise ArgumentError(f"Region: Bw is {bounds.tolist()}, and should be {wanted}")
    for name, (lower, upper) in zip(AXES, bounds.tolist(), strict=True):
        if lower > upper:
            hint = "" if name in AXES[:3] else "; for an interval through pi add a turn to the upper one"
            raise ArgumentError(f"Region: Bw: {name} has the lower bound {lower:g} above the upper one {upper:g}{hint}")
        if lower == np.inf or upper == -np.inf:
            raise ArgumentError(f"Region: Bw: {name} is from {lower:g} to {upper:g}, where no number is")
    return bounds

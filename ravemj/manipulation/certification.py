"""Collision certificates of motions of bodies: proven spans, undecided spans, and clearances."""

from collections.abc import Callable, Sequence

import numpy as np

from ravemj.core.transforms import Floats, Ints, Vec3
from ravemj.engine.affine import translation_columns
from ravemj.engine.collision.clearances import Bools, Chain, Clearances, Tested, has_supports, joints_above
from ravemj.engine.collision.findings import Checker
from ravemj.engine.collision.queries import body_and_others, held_with, itself
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.affine import DOFAffine
from ravemj.manipulation.bodies import Bodies, Part
from ravemj.planning.certificates import Certificate, CertifiedSpan
from ravemj.planning.curves import Curve, configuration_at
from ravemj.planning.proofs import TOUCHING, Cases, Span, distances, exempt_spans, is_proved, prove
from ravemj.trajectories.groups import AFFINE, JOINTS
from ravemj.trajectories.layout import packed
from ravemj.trajectories.waypoints import Waypoints

_FAR = 1e10  # m
_TURNING = DOFAffine.Rotation3D | DOFAffine.RotationQuat


class UncertifiableError(Exception):
    """The motions of some bodies cannot be certified; the text gives the reason."""


class Certifier:
    """Proves motions of bodies. Use it within ``bodies.kept``, without other changes of the world.

    Args:
        bodies: The bodies.
        ends: Configurations at which shapes may touch: the start and the goal of the whole motion.

    Raises:
        UncertifiableError: motions of these bodies cannot be certified.
    """

    def __init__(self, bodies: Bodies, ends: Sequence[Floats]) -> None:
        self._spaces = BodySpaces(bodies)
        near = distances(self._spaces, ends, np.arange(self._spaces.pair_count))
        self._touching: Ints = np.flatnonzero((np.abs(near) < TOUCHING).any(axis=0))

    def proves(self, curves: Sequence[Curve]) -> bool:
        """Return whether a motion is proven collision-free, except for shapes that touch at an end."""
        try:
            return is_proved(self._spaces, curves, exempt_spans(self._spaces, curves, self._touching))
        finally:
            self._spaces.put_back()

    def certificate(self, curves: Sequence[Curve], *, whole: bool = True) -> Certificate:
        """Return the certificate of a motion; unless ``whole``, the proof ends at the first undecided span."""
        try:
            exempt = exempt_spans(self._spaces, curves, self._touching)
            proof = prove(self._spaces, curves, exempt, whole=whole)
            distance, time, pair = proof.nearest
            is_near = pair >= 0 and np.isfinite(distance)
            points = self._spaces.nearest_points(configuration_at(curves, time), pair) if is_near else None
        finally:
            self._spaces.put_back()
        nearest = self._named(Span(time, time, pair)) if is_near else None
        undecided = tuple(map(self._named, proof.undecided))
        gap = min(proof.smallest_gap, 0.0) if undecided else proof.smallest_gap
        named = tuple(map(self._named, exempt))
        return Certificate(not undecided, undecided, named, max(gap, 0.0), nearest, nearest_points=points)

    def _named(self, span: Span) -> CertifiedSpan:
        return CertifiedSpan(span.start, span.end, self._spaces.names(span.pair))


def certified(
    simulation: Simulation, path: Waypoints, checker: Callable[[], Checker], *, whole: bool = True
) -> Certificate:
    """Return the certificate of a timed motion in the present world; see ``Certifier.certificate``."""
    groups = [group for group in path.groups if group.kind in {JOINTS[0], AFFINE[0]}]
    try:
        if not groups or not len(path):
            raise UncertifiableError("nothing moves")
        pieces = list(path.pieces(groups, simulation.body))
        bodies = Bodies(simulation, packed(groups), checker)
        curves = [Curve.of_powers(*piece) for piece in pieces]
        if not curves:
            start = np.concatenate([path.data[0, group.columns] for group in groups])
            curves = [Curve(0.0, 0.0, start[None])]
        with bodies.kept():
            certifier = Certifier(bodies, [curves[0].control[0], curves[-1].control[-1]])
            return certifier.certificate(curves, whole=whole)
    except (UncertifiableError, ArgumentError) as error:
        return Certificate(certified=False, reason=str(error))


class BodySpaces:
    """Clearance between the shapes of moving bodies and all other shapes.

    Attributes:
        pairs: Both geoms of each pair of shapes, shape (pair_count, 2).
        pair_count: The number of pairs.
        counted: Whether the shapes of each pair belong to two bodies; only such pairs contribute to the smallest gap.
    """

    most = Clearances.most

    def __init__(self, bodies: Bodies) -> None:
        self._bodies = bodies
        world = bodies.world()
        if world is None:
            raise UncertifiableError("a collision checker, callback or group of geometries of the user decides")
        _check_grabs(bodies.bodies)
        self._world = world
        pairs = np.concatenate([np.zeros((0, 2), dtype=int), *(_pairs(world, bodies, body) for body in bodies.bodies)])
        count = world.model.model.ngeom
        keys = np.unique(pairs[:, 0] * count + pairs[:, 1])  # of rows, an interrupt would become a TypeError in numpy
        self.pairs = np.column_stack(np.divmod(keys, count))
        self.pair_count = len(self.pairs)
        owners = world.labels(self.pairs)[..., 0]
        self.counted: Bools = owners[:, 0] != owners[:, 1]
        model = world.model.model
        if not has_supports(model, self.pairs.ravel()):
            raise UncertifiableError("a shape is a plane or a height field")
        bases = [part.body for part in bodies.parts if not part.dofs]
        numbers = {body: model.njnt + 2 * number for number, body in enumerate(bases)}
        self._rates = _rates(world, bodies.parts, numbers)
        ids = [int(world.model.part(body).body_ids[0]) for body in bases]
        chains = {geom: chain for body in bodies.bodies for geom, chain in _chains(world, body, numbers)}
        self._clearances = Clearances(model, world.model.data, world.shapes, self.pairs, chains, ids)

    def test(self, middles: Floats, spreads: Floats, cases: Cases, apart: float = 0.0) -> Tested:
        """Test whether pairs of geoms may come within ``apart`` [m] of each other in boxes of configurations.

        Args:
            middles: Centres of the boxes, shape (m, n).
            spreads: Half the sizes of the boxes, shape (m, n).
            cases: The tests, each of one box and one pair of geoms.
            apart: The distance [m].
        """
        place = self._bodies.placement()
        for slot, values in enumerate(middles):
            place(values)
            self._clearances.take(slot)
        return self._clearances.test(spreads @ self._rates, *cases, apart)

    def nearest_points(self, values: Floats, pair: int) -> tuple[Vec3, Vec3]:
        """Return the nearest points of both shapes of a pair in a configuration [m]."""
        self._bodies.move(values)
        self._bodies.world()
        first, second = self.pairs[pair].tolist()
        x, y, z, u, v, w = self._world.shapes.closest(first, second, _FAR)[1].tolist()
        return (x, y, z), (u, v, w)

    def put_back(self) -> None:
        """Restore the shapes of the collision world to the poses of the bodies."""
        self._clearances.put_back()

    def names(self, pair: int) -> tuple[str, str]:
        """Return the link names of a pair."""
        first, second = (_name(*self._world.owner(geom)) for geom in self.pairs[pair].tolist())
        return first, second


def _check_grabs(moving: Sequence[BodyState]) -> None:
    for body in moving:
        for held in (held_body for grab in body.grabs for held_body in held_with(grab.body) if held_body in moving):
            raise UncertifiableError(f"'{held.scene.name}' moves by itself while '{body.scene.name}' holds it")


def _pairs(world: CollisionWorld, bodies: Bodies, body: BodyState) -> Ints:
    """Return the collision pairs of a body with others and itself, the smaller geom index first, shape (n, 2)."""
    moved = bodies.moved(body)
    asked = body_and_others(world, body, moved), itself(world, body, moved)
    return np.sort(np.concatenate([np.stack([pairs.first, pairs.second], axis=1) for pairs in asked]), axis=1)


def _chains(world: CollisionWorld, body: BodyState, bases: dict[BodyState, int]) -> list[tuple[int, Chain]]:
    """Return each geom of a body and its grabbed bodies, with the chain of joints that move it.

    The chain ends with the virtual joints of the base, if the base moves.
    """
    model, ids = world.model.model, world.model.part(body).body_ids
    base = (bases[body], bases[body] + 1) if body in bases else ()
    chains = [Chain((*joints_above(model, int(link)), *base)) for link in ids]
    geoms = [(geom, chain) for link, chain in enumerate(chains) for geom in _geoms(world, body, link)]
    for grab in body.grabs:
        for held in held_with(grab.body):
            links = range(len(held.scene.links))
            geoms += [(geom, chains[grab.link]) for link in links for geom in _geoms(world, held, link)]
    return geoms


def _geoms(world: CollisionWorld, body: BodyState, link: int) -> list[int]:
    return world.geoms_of_link(body, link, enabled_only=False).tolist()


def _rates(world: CollisionWorld, parts: Sequence[Part], bases: dict[BodyState, int]) -> Floats:
    """Return |d joint value / d configuration value|, shape (n, joints); ``bases`` are indices of virtual base joints.

    Raises:
        UncertifiableError: a value moves joints that are neither revolute nor prismatic, or mimic joints with a
            nonlinear equation.
    """
    model = world.model.model
    of_qpos = {int(place): joint for joint, place in enumerate(model.jnt_qposadr.tolist())}
    rates = np.zeros((max((part.columns.stop for part in parts), default=0), model.njnt + 2 * len(bases)))
    for part in parts:
        columns = range(part.columns.start, part.columns.stop)
        if not part.dofs:
            _add_base(rates, part, columns, bases[part.body])
            continue
        kinematics, places = part.body.kinematics, world.model.qpos_indices(part.body)
        _check_joints(part)
        start = world.model.part(part.body).qpos.start
        for column, dof in zip(columns, part.dofs, strict=True):
            if places[dof] >= 0:
                rates[column, of_qpos[int(places[dof])]] = 1.0
            for leader, multiple, place in kinematics.multiples or ():
                if leader == dof:
                    rates[column, of_qpos[start + kinematics.inner_index(place)]] = abs(multiple.slope)
    return rates


def _check_joints(part: Part) -> None:
    scene, kinematics = part.body.scene, part.body.kinematics
    followed = {dof for joint in scene.all_joints if joint.mimic is not None for dof in joint.mimic.dofs}
    for dof in part.dofs:
        joint = scene.joint_of_dof(dof)
        if joint.kind == "spherical":
            raise UncertifiableError(f"joint '{joint.name}' of '{scene.name}' is spherical")
        if kinematics.multiples is None and dof in followed:
            raise UncertifiableError(
                f"joints of '{scene.name}' follow '{joint.name}' by an equation that is not linear"
            )
    if kinematics.displaced:
        raise UncertifiableError(f"links of '{scene.name}' are not where its joints place them")


def _add_base(rates: Floats, part: Part, columns: range, turning: int) -> None:
    affine = DOFAffine(part.affine)
    if affine & _TURNING:
        raise UncertifiableError(f"the base of '{part.body.scene.name}' turns about more than one axis")
    moved = len(translation_columns(part.affine))
    rates[columns[:moved], turning + 1] = 1.0
    rates[columns[moved:], turning] = 1.0


def _name(body: BodyState, link: int) -> str:
    return f"link '{body.scene.links[link].name}' of '{body.scene.name}'"

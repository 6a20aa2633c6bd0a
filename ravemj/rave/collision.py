"""Collision checkers."""

import logging
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self, cast
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_transform
from ravemj.core.blocks import always, block, exit_in_c
from ravemj.core.transforms import Floats, Ints, Pose, pose_of
from ravemj.engine.collision import queries
from ravemj.engine.collision.findings import Collision, Findings, GeometryOf, Listed, Wanted, find
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.queries import LinkOf, Links, MovedBy
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions import AABB, Ray
from ravemj.model import scene
from ravemj.model.shape_bodies import named_body, shape_geometry
from ravemj.rave.enums import CollisionAction, CollisionOptions, InterfaceType
from ravemj.rave.interface import Interface, asked_for
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link
from ravemj.rave.report import FAR, CollisionPairInfo, CollisionReport, Part
from ravemj.rave.trimesh import TriMesh, checked_mesh

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class GeometryGroups:
    """Which group a checker takes in place of the geometries of links. A link without the group keeps its geometries.

    Attributes:
        default: The group of all bodies that have no other; empty for the geometries that links have.
        is_used: Whether any body has a group.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._of_bodies: WeakKeyDictionary[BodyState, str] = WeakKeyDictionary()
        self._last: tuple[tuple[object, ...], CollisionWorld] | None = None
        self.is_used = False
        self.default = ""

    def of(self, body: BodyState) -> str:
        """Return the group that is taken for a body."""
        return self._of_bodies.get(body, self.default)

    def choose(self, name: str, body: BodyState | None = None) -> None:
        """Take a group for a body, or for all bodies."""
        if body is not None:
            self._of_bodies[body] = name
        else:
            self.default = name
            self._of_bodies.clear()
        self.is_used = bool(self.default) or any(self._of_bodies.values())

    def world(self) -> AbstractContextManager[CollisionWorld]:
        """Let bodies have the geometries of their groups, and give what collision checking knows of them then.

        The caller holds the lock.
        """
        return self._exchanged() if self.is_used else nullcontext(self._simulation.collisions())

    @block
    def _exchanged(self) -> Generator[CollisionWorld]:
        scenes = {body: with_group(body.scene, self.of(body)) for body in self._simulation.bodies}
        # A world is made again only for other shapes: that takes long.
        key = (self._simulation.compiled(), *(link.geometries for body in scenes.values() for link in body.links))
        last = self._last[1] if self._last is not None and self._last[0] == key else None
        with self._simulation.described_as(scenes, last) as world:
            self._last = key, world
            yield world


def with_group(body: scene.KinBody, name: str) -> scene.KinBody:
    """Return a body whose links have the geometries of a group, where they have that group."""
    links = tuple(replace(link, geometries=dict(link.groups).get(name, link.geometries)) for link in body.links)
    return replace(body, links=links)


def has_group(body: scene.KinBody, name: str) -> bool:
    """Return whether a link of a body has a group; each has its own geometries."""
    return name in {"", scene.OWN_SHAPES} or any(name in dict(link.groups) for link in body.links)


# Plain numbers: operators of flags take longer than tests of collision.
_ACTIVE_DOFS = int(CollisionOptions.ActiveDOFs)
_IGNORE_CALLBACKS = int(CollisionOptions.IgnoreCallbacks)

_NO_BODIES: frozenset[BodyState] = frozenset()
_NO_LINKS: frozenset[LinkOf] = frozenset()

_LOG = logging.getLogger("ravemj")

_ARGUMENTS = ("ray", "link1", "link2", "link", "body1", "body2", "body", "bodyexcluded", "linkexcluded")
"""Names of the arguments of ``CheckCollision``, in the order in which they stand without names."""


class CollisionChecker(Interface):
    """Tests whether bodies touch; ``env.GetCollisionChecker()`` returns it.

    Boxes, spheres, cylinders, capsules and convex meshes are exact solids. Other meshes are their triangles, as in
    OpenRAVE: what is inside one without touching a triangle does not collide.
    """

    _often_called = ("CheckCollision", "CheckSelfCollision")

    _internal = (
        "answer",
        "collides",
        "find",
        "groups",
        "is_plain",
        "ray_targets",
        "report",
        "world",
    )

    _interface_type = InterfaceType.collisionchecker

    def __init__(self, env: "Environment", name: str = "mujoco") -> None:
        super().__init__(env, name)
        self._simulation = env.simulation
        self._options = 0
        self._wanted = Wanted()
        self._tolerance = 0.0
        self.groups = GeometryGroups(env.simulation)

    def Clone(self, ref: "CollisionChecker", cloningoptions: int = 0) -> None:
        """Take over the options, the description and the data of users from another checker.

        Args:
            ref: The other checker.
            cloningoptions: Not used.
        """
        super().Clone(ref, cloningoptions)
        self._tolerance = ref.GetTolerance()
        self.SetCollisionOptions(ref.GetCollisionOptions())
        self.groups.choose(ref.GetGeometryGroup())

    def InitEnvironment(self) -> bool:
        """Return True; nothing needs to be prepared."""
        return True

    def DestroyEnvironment(self) -> None:
        """Do nothing; OpenRAVE's checkers free memory here."""

    def SetCollisionOptions(self, collisionoptions: int) -> bool:
        """Set ``collisionoptions``, ``CollisionOptions`` combined with ``|``.

        Return False, and change nothing, if there is an unknown one among them.
        """
        if not 0 <= int(collisionoptions) < 2 * CollisionOptions.IgnoreCallbacks:
            return False
        self._options = int(collisionoptions)
        self._choose()
        return True

    def _choose(self) -> None:
        """Work out what reports should tell."""
        options = CollisionOptions(self._options)
        listed: Listed = "links" if options & CollisionOptions.AllLinkCollisions else "first pair"
        self._wanted = Wanted(
            "geometries" if options & CollisionOptions.AllGeometryCollisions else listed,
            bool(options & (CollisionOptions.Contacts | CollisionOptions.AllGeometryContacts)),
            bool(options & CollisionOptions.Distance),
            self._tolerance if options & CollisionOptions.UseTolerance else None,
        )

    def GetCollisionOptions(self) -> int:
        """Return the chosen ``CollisionOptions``."""
        return self._options

    def SetTolerance(self, tolerance: float) -> None:
        """Set the distance ``tolerance`` [m] of ``CollisionOptions.UseTolerance``."""
        self._tolerance = float(tolerance)
        self._choose()

    def GetTolerance(self) -> float:
        """Return the distance [m] of ``CollisionOptions.UseTolerance``."""
        return self._tolerance

    def CheckCollision(self, *arguments: object, report: CollisionReport | None = None, **named: object) -> bool:
        """Return whether things touch; arguments and ``report`` as for ``env.CheckCollision``."""
        if named:
            arguments = (*arguments, *(named.pop(name) for name in _ARGUMENTS if name in named))
        if named:
            raise TypeError(f"CheckCollision: has no argument {', '.join(named)}")
        if len(arguments) > 1 and (arguments[-1] is None or isinstance(arguments[-1], CollisionReport)):
            report, arguments = report or arguments[-1], arguments[:-1]
        if report is not None:
            checked_kind(report, CollisionReport, "CheckCollision: report")
        with self._simulation.lock:
            if not self.groups.is_used:  # without a context manager, since planners ask this most
                return self._check(self._simulation.collisions(), arguments, report)
            with self.groups.world() as world:
                return self._check(world, arguments, report)

    def _check(self, world: CollisionWorld, arguments: tuple[object, ...], report: CollisionReport | None) -> bool:
        if arguments and isinstance(ray := arguments[0], Ray):
            return self._check_ray(world, ray, arguments[1:], report)
        return self.answer(world, self._pairs(world, arguments), report)

    def CheckSelfCollision(self, linkbody: KinBody | Link, report: CollisionReport | None = None) -> bool:
        """Return whether a body collides with itself; see ``body.CheckSelfCollision``.

        Args:
            linkbody: The body, or one link that is tested against the others.
            report: Filled with what is found.
        """
        if report is not None:
            checked_kind(report, CollisionReport, "CheckSelfCollision: report")
        with self._simulation.lock, self.groups.world() as world:
            if isinstance(linkbody, Link):
                pairs = queries.link_and_own_body(world, _link(linkbody))
            else:
                state = _state(linkbody)
                pairs = queries.itself(
                    world, state, MovedBy(linkbody.active_dofs()) if self._options & _ACTIVE_DOFS else None
                )
            return self.answer(world, pairs, report)

    def _pairs(self, world: CollisionWorld, arguments: Sequence[object]) -> Pairs:
        """Return the pairs of geoms that the arguments of ``CheckCollision`` are about."""
        match arguments:
            case (thing,):
                return self._pairs_with_others(world, thing)
            case (thing, list() | tuple(), list() | tuple()):
                bodies, links = cast("Sequence[Sequence[object]]", arguments[1:])
                return self._pairs_with_others(
                    world, thing, frozenset(map(_state, bodies)), frozenset(map(_link, links))
                )
            case (KinBody() | Link() as one, KinBody() | Link() as other):
                first, second = self._added(one), self._added(other)
                return queries.each_other(world, first, second, self._active_links(one))
            case _:
                raise _not_understood(arguments)

    def _pairs_with_others(
        self,
        world: CollisionWorld,
        argument: object,
        without_bodies: frozenset[BodyState] = _NO_BODIES,
        without_links: frozenset[LinkOf] = _NO_LINKS,
    ) -> Pairs:
        thing = self._ours(argument)
        links = self._active_links(argument) if self._options else None
        return queries.body_and_others(world, thing, links, without_bodies, without_links)

    def _ours(self, argument: object) -> BodyState | LinkOf:
        thing = _thing(argument)
        if (state := queries.body_of(thing)).simulation is not self._simulation:
            raise ArgumentError(f"CheckCollision: '{state.scene.name}' was made for another environment")
        return thing

    def _added(self, argument: object) -> BodyState | LinkOf:
        thing = self._ours(argument)
        if not self._simulation.holds(state := queries.body_of(thing)):
            message = f"CheckCollision: '{state.scene.name}' is not in this environment; add it first"
            raise RavemjError(message, ErrorCode.Assert)
        return thing

    def _active_links(self, argument: object) -> Links:
        """Return the links to which the option ``ActiveDOFs`` restricts the tests of a body; None: all."""
        if not self._options & _ACTIVE_DOFS or not isinstance(argument, KinBody) or argument.moves_as_a_whole():
            return None
        return MovedBy(argument.active_dofs())

    @property
    def is_plain(self) -> bool:
        """Whether the engine's own tests answer as this does: no function of a user, no other geometries."""
        return type(self) is CollisionChecker and not self.groups.is_used and not self._env.collision_callbacks

    def world(self) -> AbstractContextManager[CollisionWorld]:
        """Return the world with the geometries that the checker looks at. The caller holds the lock."""
        return self.groups.world()

    def answer(self, world: CollisionWorld, pairs: Pairs, report: CollisionReport | None) -> bool:
        """Test pairs of geoms as the options say, fill the report, and return whether there is a collision.

        The caller holds the lock.
        """
        if report is None:
            return self.collides(world, pairs)
        checked_kind(report, CollisionReport, "report").Reset(self._options)
        found = self.find(world, pairs, report.minDistance)
        self._fill(report, found)
        return bool(found.collisions)

    def collides(self, world: CollisionWorld, pairs: Pairs) -> bool:
        """Return whether any pairs of geoms collide. The caller holds the lock."""
        return bool(self.find(world, pairs).collisions) if self._env.collision_callbacks else world.collide(pairs)

    def find(self, world: CollisionWorld, pairs: Pairs, distance: float = FAR) -> Findings:
        """Return what a report tells of pairs of geoms; distances above ``distance`` [m] are of no interest."""
        counts = self._counts if self._env.collision_callbacks and not self._options & _IGNORE_CALLBACKS else None
        return find(world, pairs, self._wanted, distance, counts)

    def report(self, found: Findings) -> CollisionReport:
        """Return a report of what was found."""
        report = CollisionReport()
        report.Reset(self._options)
        self._fill(report, found)
        return report

    def _fill(self, report: CollisionReport, found: Findings) -> None:
        report.collisionInfos += map(self._info, found.collisions)
        report.minDistance = found.distance
        report.numWithinTol += found.within
        if found.nearest is not None and not report.numCols:
            report.collisionInfos = [self._info(found.nearest, collides=False)]

    def _counts(self, collision: Collision) -> bool:
        """Ask the registered functions whether a collision counts."""
        report = self.report(Findings([collision], FAR, None, 0))
        return all(callback(report, False) != CollisionAction.Ignore for callback in self._env.collision_callbacks)

    def _info(self, collision: Collision, *, collides: bool = True) -> CollisionPairInfo:
        first, second, contacts = collision
        return CollisionPairInfo(self._part(first), self._part(second), contacts, collides=collides)

    def _part(self, geometry: GeometryOf) -> Part:
        link = Link(self._env.wrap(geometry.body), geometry.body, geometry.link)
        group = self.groups.of(geometry.body)
        has_group = group and link.GetGroupNumGeometries(group) >= 0
        geometries = link.GetGeometriesFromGroup(group) if has_group else link.GetGeometries()
        return Part(link, geometries[geometry.geometry])

    def _check_ray(
        self, world: CollisionWorld, ray: Ray, targets: Sequence[object], report: CollisionReport | None
    ) -> bool:
        if len(targets) > 1:
            raise _not_understood((ray, *targets))
        hit = world.rays.first_hit(ray.pos(), ray.dir(), self.ray_targets(world, *targets))
        if report is not None:
            report.Reset(self._options)
        if hit is not None and report is not None:
            distance = hit.fraction * float(np.linalg.norm(ray.dir()))
            contact = hit.position, hit.normal, distance
            report.collisionInfos.append(CollisionPairInfo(self._part(GeometryOf.of(world, hit.geom)), None, [contact]))
            report.minDistance = distance
        return hit is not None

    def ray_targets(self, world: CollisionWorld, target: object = ...) -> Ints | None:
        """Return the geoms of a body or link, which a ray can hit, or with ``...`` None, which stands for all.

        The caller holds the lock.
        """
        if target is ...:
            return None
        if not isinstance(target, KinBody | Link):
            raise _not_understood((Ray(np.zeros(3), np.zeros(3)), target))
        thing = self._added(target)
        return world.geoms_of_group(thing) if isinstance(thing, BodyState) else world.geoms_of_link(*thing)

    def __repr__(self) -> str:
        if self._env.GetCollisionChecker() is self:
            return f"{self._env!r}.GetCollisionChecker()"
        return f"RaveCreateCollisionChecker({self._env!r}, {self._xmlid!r})"

    groups: GeometryGroups

    def CheckCollisionOBB(
        self,
        aabb: AABB,
        pose: ArrayLike,
        *arguments: Sequence[KinBody] | CollisionReport | None,
        bodiesincluded: Sequence[KinBody] | None = None,
        report: CollisionReport | None = None,
    ) -> bool:
        """Return whether a box touches bodies: ``(aabb, pose[, bodiesincluded][, report])``.

        Args:
            aabb: The box, in its own frame.
            pose: ``T_world_box``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz].
            arguments: The others by their places.
            bodiesincluded: The bodies; left out: all.
            report: Filled with what is found; the first names in it are those of a body ``box``.
        """
        checked_kind(aabb, AABB, "CheckCollisionOBB: aabb")
        x, y, z = aabb.extents().tolist()
        T_world_box = pose_of(checked_transform(pose, "CheckCollisionOBB: pose"))
        cx, cy, cz = aabb.pos().tolist()
        shape = shape_geometry(scene.Box((x, y, z)), T_world_box @ Pose((cx, cy, cz)), visible=False)
        for argument in arguments:
            if isinstance(argument, list | tuple):
                bodiesincluded = argument
            else:
                report = argument or report  # pyright: ignore[reportAssignmentType] - a report is no list
        return self._collides(shape, bodiesincluded, report)

    def CheckCollisionTriMesh(
        self,
        trimesh: TriMesh,
        *arguments: KinBody | CollisionReport | None,
        body: KinBody | None = None,
        report: CollisionReport | None = None,
    ) -> bool:
        """Return whether triangles touch bodies: ``(trimesh[, body][, report])``.

        Args:
            trimesh: The triangles, in the world [m].
            arguments: The others by their places.
            body: The only body that counts; left out: all.
            report: Filled with what is found; the first names in it are those of a body ``box``.
        """
        mesh = checked_mesh(trimesh, "CheckCollisionTriMesh: trimesh")
        given: list[Any] = [one for one in arguments if one is not None]
        if given and hasattr(given[0], "GetLinks"):
            body = given.pop(0)
        report = given.pop(0) if given else report
        return self._collides(
            shape_geometry(scene.TriMesh(mesh), Pose(), visible=False), None if body is None else [body], report
        )

    def _collides(
        self, shape: scene.Geometry, bodies: Sequence[KinBody] | None, report: CollisionReport | None
    ) -> bool:
        simulation = self._env.simulation
        with simulation.lock:
            state = simulation.create(named_body(simulation.free_name("box"), [shape]))
            simulation.insert(state)
            try:
                probe = self._env.wrap(state)
                if bodies is None:
                    return self.CheckCollision(probe, report=report)
                return any([self.CheckCollision(probe, body, report=report) for body in bodies])
            finally:
                self._env.Remove(self._env.wrap(state))

    def CheckCollisionRays(
        self,
        rays: ArrayLike,
        body: KinBody | None = None,
        front_facing_only: bool = False,
        checkPreemptFn: object = None,
    ) -> tuple[NDArray[np.bool_], Floats]:
        """Return which rays hit something, shape (n,), and where, shape (n, 6); see ``env.CheckCollisionRays``.

        Args:
            rays: As there.
            body: As there.
            front_facing_only: As there.
            checkPreemptFn: Not used: the rays are cast at once.
        """
        del checkPreemptFn
        return self._env.CheckCollisionRays(rays, body, front_facing_only)

    def InitKinBody(self, body: KinBody) -> bool:
        """Return True: ``body`` needs no preparation."""
        del body
        return True

    def RemoveKinBody(self, body: KinBody) -> None:
        """Do nothing about ``body``; OpenRAVE's checkers free memory here."""

    def SetGeometryGroup(self, groupname: str) -> None:
        """Take a group of geometries in place of those that links have, for all bodies.

        Links without the group keep their geometries, and viewers and physics look at those of all links. A query
        compiles the world anew where shapes have changed since the last one, as it does without groups.

        Args:
            groupname: The group, of ``link.SetGroupGeometries``; empty: the geometries that links have.
        """
        self.groups.choose(checked_kind(groupname, str, "SetGeometryGroup: groupname", "a text"))

    def GetGeometryGroup(self) -> str:
        """Return the group of ``SetGeometryGroup``; empty: the geometries that links have."""
        return self.groups.default

    def SetBodyGeometryGroup(self, body: KinBody, groupname: str) -> bool:
        """Take a group of geometries for one body; see ``SetGeometryGroup``, which sets it for all of them again.

        Args:
            body: The body.
            groupname: The group; empty: the geometries that links have.

        Returns:
            Whether a link of the body has such a group. If not, nothing changes.
        """
        state = body.simulation_state
        found = has_group(state.scene, checked_kind(groupname, str, "SetBodyGeometryGroup: groupname", "a text"))
        if found:
            self.groups.choose(groupname, state)
        return found

    def GetBodyGeometryGroup(self, body: KinBody) -> str:
        """Return the group of geometries that is used for ``body``; empty: the geometries that its links have."""
        return self.groups.of(body.simulation_state)


class NoCollisionChecker(CollisionChecker):
    """A checker for which nothing collides: that of ``env.SetCollisionChecker(None)``."""

    def __init__(self, env: "Environment") -> None:
        super().__init__(env, "GenericCollisionChecker")

    def collides(self, world: CollisionWorld, pairs: Pairs) -> bool:
        """Return False."""
        del world, pairs
        return False

    def find(self, world: CollisionWorld, pairs: Pairs, distance: float = FAR) -> Findings:
        """Return that nothing is found."""
        del world, pairs
        return Findings([], distance, None, 0)

    def ray_targets(self, world: CollisionWorld, target: object = ...) -> Ints | None:
        """Return no geoms."""
        del world, target
        return np.zeros(0, dtype=np.int_)


class CollisionOptionsStateSaver(ApiObject):
    """Sets the options of a checker, and sets the old ones again at the end of its ``with``.

    Example:
        >>> with ravemj.CollisionOptionsStateSaver(checker, ravemj.CollisionOptions.Contacts):
        ...     env.CheckCollision(robot, report)
    """

    @also_named(p="checker", newoptions="options")
    def __init__(self, checker: CollisionChecker, options: int | None = None, required: bool = True) -> None:
        """Set the options.

        Args:
            checker: The checker.
            options: ``CollisionOptions`` combined with ``|``; None: as they are.
            required: Whether to raise where the checker does not know them.

        Raises:
            openrave_exception: it does not.
        """
        self._checker = checked_kind(checker, CollisionChecker, "CollisionOptionsStateSaver: checker")
        self._old = checker.GetCollisionOptions()
        if options is not None and not checker.SetCollisionOptions(options) and required:
            raise ArgumentError(f"CollisionOptionsStateSaver: options are {options}, which are not all known")

    def __enter__(self) -> Self:
        return self

    def _leave(self) -> Callable[..., object]:
        return always(lambda: self._checker.SetCollisionOptions(self._old))

    __exit__ = exit_in_c(_leave)


_told: set[str] = set()
_OTHERS = {"ode", "bullet", "pqp", "fcl", "fcl_"}


def RaveCreateCollisionChecker(env: "Environment", name: str) -> CollisionChecker | None:
    """Make a collision checker; ``env.SetCollisionChecker`` chooses it.

    Args:
        env: The environment that it is for.
        name: ``mujoco``. OpenRAVE's ``ode``, ``bullet``, ``pqp`` and ``fcl_`` make the same checker; once for each
            name the log says so.

    Returns:
        The checker; None for an unknown name.
    """
    word = asked_for(env, name, "RaveCreateCollisionChecker")[0]
    kind = word.lower()
    if kind in _OTHERS and kind not in _told:
        _told.add(kind)
        _LOG.warning("there is no collision checker '%s'; the one over MuJoCo takes its place", word)
    return CollisionChecker(env, word) if kind in _OTHERS or kind == "mujoco" else None


def _state(body: object) -> BodyState:
    if not isinstance(body, KinBody):
        raise _not_understood((body,))
    return body.simulation_state


def _link(link: object) -> LinkOf:
    if not isinstance(link, Link):
        raise _not_understood((link,))
    return link.GetParent().simulation_state, link.GetIndex()


def _thing(argument: object) -> BodyState | LinkOf:
    return argument.simulation_state if isinstance(argument, KinBody) else _link(argument)


def _not_understood(arguments: Iterable[object]) -> RavemjError:
    kinds = ", ".join("None" if one is None else type(one).__name__ for one in arguments)
    forms = "a body, a link, two of them, one and two lists of excluded ones, or a Ray"
    message = f"CheckCollision: takes {forms}; not ({kinds})"
    return RavemjError(message, ErrorCode.Assert) if any(one is None for one in arguments) else ArgumentError(message)

"""Collision checkers."""

import logging
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, Self, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_transform
from ravemj.core.blocks import always, exit_in_c
from ravemj.core.transforms import Floats, Ints, Pose, pose_of
from ravemj.engine.collision import queries
from ravemj.engine.collision.findings import Collision, Findings, Listed, Wanted, find
from ravemj.engine.collision.geometry_groups import GeometryGroups, has_group
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.queries import LinkOf, Links, MovedBy
from ravemj.engine.collision.world import CollisionWorld, GeometryOf
from ravemj.engine.simulation import BodyState
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


# Plain numbers: operators of flags take longer than tests of collision.
_ACTIVE_DOFS = int(CollisionOptions.ActiveDOFs)
_IGNORE_CALLBACKS = int(CollisionOptions.IgnoreCallbacks)

_NO_BODIES: frozenset[BodyState] = frozenset()
_NO_LINKS: frozenset[LinkOf] = frozenset()

_LOG = logging.getLogger("ravemj")

_ARGUMENTS = ("ray", "link1", "link2", "link", "body1", "body2", "body", "bodyexcluded", "linkexcluded")
"""Names of the arguments of ``CheckCollision``, in positional order."""


class CollisionChecker(Interface):
    """Collision checker; ``env.GetCollisionChecker()`` returns it.

    Boxes, spheres, cylinders, capsules and convex meshes are exact solids. Other meshes are hollow, as in OpenRAVE:
    only their triangles collide, not a body inside that touches no triangle.
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
        """Copy the options, the description and the user data of another checker.

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

        Return False, and change nothing, if one of them is unknown.
        """
        if not 0 <= int(collisionoptions) < 2 * CollisionOptions.IgnoreCallbacks:
            return False
        self._options = int(collisionoptions)
        self._choose()
        return True

    def _choose(self) -> None:
        """Set the contents of collision reports from the checker's options."""
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
        """Set the distance ``tolerance`` [m] below which ``report.numWithinTol`` counts geometry pairs."""
        self._tolerance = float(tolerance)
        self._choose()

    def GetTolerance(self) -> float:
        """Return the distance [m] below which ``report.numWithinTol`` counts geometry pairs."""
        return self._tolerance

    def CheckCollision(self, *arguments: object, report: CollisionReport | None = None, **named: object) -> bool:
        """Return whether bodies, links or rays collide; arguments and ``report`` as for ``env.CheckCollision``."""
        if named:
            arguments = (*arguments, *(named.pop(name) for name in _ARGUMENTS if name in named))
        if named:
            raise TypeError(f"CheckCollision: has no argument {', '.join(named)}")
        if len(arguments) > 1 and (arguments[-1] is None or isinstance(arguments[-1], CollisionReport)):
            report, arguments = report or arguments[-1], arguments[:-1]
        if report is not None:
            checked_kind(report, CollisionReport, "CheckCollision: report")
        lock, pairs = self._simulation.lock, None
        try:
            lock.acquire()  # not in a ``with`` block, which takes twice as long
            world = self.groups.world() if self.groups.is_used else self._simulation.collisions()
            if len(arguments) == 1 and isinstance(body := arguments[0], KinBody) and not self._options & _ACTIVE_DOFS:
                pairs = world.known_pairs(body.simulation_state)
            if pairs is not None and report is None:  # in few steps, since this is asked most
                collides = self.collides(world, pairs)
            else:
                collides = self._check(world, arguments, report)
        except BaseException:
            lock.release_if_held()
            raise
        lock.release()
        return collides

    def _check(self, world: CollisionWorld, arguments: tuple[object, ...], report: CollisionReport | None) -> bool:
        if arguments and isinstance(ray := arguments[0], Ray):
            return self._check_ray(world, ray, arguments[1:], report)
        return self.answer(world, self._pairs(world, arguments), report)

    def CheckSelfCollision(self, linkbody: KinBody | Link, report: CollisionReport | None = None) -> bool:
        """Return whether a body collides with itself; see ``body.CheckSelfCollision``.

        Args:
            linkbody: The body, or one link that is tested against the others.
            report: Receives the result.
        """
        if report is not None:
            checked_kind(report, CollisionReport, "CheckSelfCollision: report")
        with self._simulation.lock:
            world = self.groups.world()
            if isinstance(linkbody, Link):
                pairs = queries.link_and_own_body(world, _link(linkbody))
            else:
                state = _state(linkbody)
                pairs = queries.itself(
                    world, state, MovedBy(linkbody.active_dofs()) if self._options & _ACTIVE_DOFS else None
                )
            return self.answer(world, pairs, report)

    def _pairs(self, world: CollisionWorld, arguments: Sequence[object]) -> Pairs:
        """Return the geom pairs selected by the arguments of ``CheckCollision``."""
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
        """Return the links that a body's active DOFs move if the option ``ActiveDOFs`` is set; None means all."""
        if not self._options & _ACTIVE_DOFS or not isinstance(argument, KinBody) or argument.moves_as_a_whole():
            return None
        return MovedBy(argument.active_dofs())

    @property
    def is_plain(self) -> bool:
        """Whether the engine's default tests suffice: there are no user callbacks and no geometry groups."""
        return type(self) is CollisionChecker and not self.groups.is_used and not self._env.collision_callbacks

    def world(self) -> CollisionWorld:
        """Return the collision world with the geometry groups of the checker. The caller holds the lock."""
        return self.groups.world()

    def answer(self, world: CollisionWorld, pairs: Pairs, report: CollisionReport | None) -> bool:
        """Test geom pairs with the checker's options, fill the report, and return whether there is a collision.

        The caller holds the lock.
        """
        if report is None:
            return self.collides(world, pairs)
        checked_kind(report, CollisionReport, "report").Reset(self._options)
        findings = self.find(world, pairs, report.minDistance)
        self._fill(report, findings)
        return bool(findings.collisions)

    def collides(self, world: CollisionWorld, pairs: Pairs) -> bool:
        """Return whether any pairs of geoms collide. The caller holds the lock."""
        return bool(self.find(world, pairs).collisions) if self._env.collision_callbacks else world.collide(pairs)

    def find(self, world: CollisionWorld, pairs: Pairs, distance: float = FAR) -> Findings:
        """Return the collisions and distances of geom pairs; distances above ``distance`` [m] are skipped."""
        counts = self._counts if self._env.collision_callbacks and not self._options & _IGNORE_CALLBACKS else None
        return find(world, pairs, self._wanted, distance, counts)

    def report(self, findings: Findings) -> CollisionReport:
        """Return a collision report of the collisions and distances that ``find`` returned."""
        report = CollisionReport()
        report.Reset(self._options)
        self._fill(report, findings)
        return report

    def _fill(self, report: CollisionReport, findings: Findings) -> None:
        report.collisionInfos += map(self._info, findings.collisions)
        report.minDistance = findings.distance
        report.numWithinTol += findings.within
        if findings.nearest is not None and not report.numCols:
            report.collisionInfos = [self._info(findings.nearest, collides=False)]

    def _counts(self, collision: Collision) -> bool:
        """Return False if a registered callback ignores the collision, else True."""
        report = self.report(Findings([collision], FAR, None, 0))
        return all(callback(report, False) != CollisionAction.Ignore for callback in self._env.collision_callbacks)

    def _info(self, collision: Collision, *, collides: bool = True) -> CollisionPairInfo:
        first, second, contacts = collision
        return CollisionPairInfo(self._part(first), self._part(second), contacts, collides=collides)

    def _part(self, geometry: GeometryOf) -> Part:
        link = Link(self._env.wrap(geometry.body), geometry.body, geometry.link)
        group = self.groups.group_of(geometry.body)
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
            report.collisionInfos.append(CollisionPairInfo(self._part(world.geometry(hit.geom)), None, [contact]))
            report.minDistance = distance
        return hit is not None

    def ray_targets(self, world: CollisionWorld, target: object = ...) -> Ints | None:
        """Return the geoms of a body or link as targets of rays; ``...`` gives None, which means all geoms.

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
            arguments: The remaining arguments by position.
            bodiesincluded: The bodies to test; by default all.
            report: Receives the result; the box appears in it as a body ``box``.
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
            arguments: The remaining arguments by position.
            body: The only body to test; by default all.
            report: Receives the result; the mesh appears in it as a body ``box``.
        """
        mesh = checked_mesh(trimesh, "CheckCollisionTriMesh: trimesh")
        given: list[Any] = [argument for argument in arguments if argument is not None]
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
        """Return whether each ray hits, shape (n,), and the hits, shape (n, 6); see ``env.CheckCollisionRays``.

        Args:
            rays: Starts and directions, shape (n, 6).
            body: The body to test; by default all bodies.
            front_facing_only: Whether to ignore hits on the inside of a surface.
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
        """Select a geometry group of the links for all bodies.

        Links without this group keep their own geometries; viewers and physics always use the links' own geometries.
        If the selected shapes differ from those of the last query, the next query recompiles the collision world.

        Args:
            groupname: The group, of ``link.SetGroupGeometries``; empty: the links' own geometries.
        """
        self.groups.choose(checked_kind(groupname, str, "SetGeometryGroup: groupname", "a text"))

    def GetGeometryGroup(self) -> str:
        """Return the group of ``SetGeometryGroup``; empty: the links' own geometries."""
        return self.groups.default

    def SetBodyGeometryGroup(self, body: KinBody, groupname: str) -> bool:
        """Select a geometry group for one body; a later ``SetGeometryGroup`` replaces it.

        Args:
            body: The body.
            groupname: The group; empty: the links' own geometries.

        Returns:
            Whether a link of the body has such a group. If not, nothing changes.
        """
        state = body.simulation_state
        exists = has_group(state.scene, checked_kind(groupname, str, "SetBodyGeometryGroup: groupname", "a text"))
        if exists:
            self.groups.choose(groupname, state)
        return exists

    def GetBodyGeometryGroup(self, body: KinBody) -> str:
        """Return the geometry group of ``body``; empty: the links' own geometries."""
        return self.groups.group_of(body.simulation_state)


class NoCollisionChecker(CollisionChecker):
    """Collision checker that finds no collisions; the one after ``env.SetCollisionChecker(None)``."""

    def __init__(self, env: "Environment") -> None:
        super().__init__(env, "GenericCollisionChecker")

    def collides(self, world: CollisionWorld, pairs: Pairs) -> bool:
        """Return False."""
        del world, pairs
        return False

    def find(self, world: CollisionWorld, pairs: Pairs, distance: float = FAR) -> Findings:
        """Return empty findings."""
        del world, pairs
        return Findings([], distance, None, 0)

    def ray_targets(self, world: CollisionWorld, target: object = ...) -> Ints | None:
        """Return no geoms."""
        del world, target
        return np.zeros(0, dtype=np.int_)


class CollisionOptionsStateSaver(ApiObject):
    """Context manager that sets the options of a checker and restores the old ones on leaving ``with``.

    Example:
        >>> with ravemj.CollisionOptionsStateSaver(checker, ravemj.CollisionOptions.Contacts):
        ...     env.CheckCollision(robot, report)
    """

    @also_named(p="checker", newoptions="options")
    def __init__(self, checker: CollisionChecker, options: int | None = None, required: bool = True) -> None:
        """Set the options.

        Args:
            checker: The checker.
            options: ``CollisionOptions`` combined with ``|``; None keeps the present ones.
            required: Whether to raise an error if the checker does not know them.

        Raises:
            openrave_exception: the options are unknown, and ``required`` is True.
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
        env: The environment to check.
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
    kinds = ", ".join("None" if argument is None else type(argument).__name__ for argument in arguments)
    forms = "a body, a link, two of them, one and two lists of excluded ones, or a Ray"
    message = f"CheckCollision: takes {forms}; not ({kinds})"
    return (
        RavemjError(message, ErrorCode.Assert)
        if any(argument is None for argument in arguments)
        else ArgumentError(message)
    )

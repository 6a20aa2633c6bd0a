"""Collision checkers: what answers whether things touch."""

import logging
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Self, cast

import numpy as np

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.transforms import Floats
from ravemj.engine.collision import questions
from ravemj.engine.collision.questions import LinkOf, Links, MovedBy
from ravemj.engine.collision.rays import RayHit
from ravemj.engine.collision.world import CollisionWorld, Pairs
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions import Ray
from ravemj.rave.body.base import BodyPart
from ravemj.rave.enums import CollisionAction, CollisionOptions, InterfaceType
from ravemj.rave.interface import Annotations, Interface, checked_environment
from ravemj.rave.link import Link
from ravemj.rave.report import CollisionPairInfo, CollisionReport, Contact, Part

if TYPE_CHECKING:
    from ravemj.rave.env.collision import CollisionCallback
    from ravemj.rave.environment import Environment

# Plain numbers: operators of flags take longer than tests of collision.
_ACTIVE_DOFS = int(CollisionOptions.ActiveDOFs)
_IGNORE_CALLBACKS = int(CollisionOptions.IgnoreCallbacks)
_DISTANCE = int(CollisionOptions.Distance)
_USE_TOLERANCE = int(CollisionOptions.UseTolerance)
_ALL_GEOMETRIES = int(CollisionOptions.AllGeometryCollisions)
_ALL_LINKS = int(CollisionOptions.AllLinkCollisions)
_CONTACTS = int(CollisionOptions.Contacts | CollisionOptions.AllGeometryContacts)

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

    _interface_type = InterfaceType.collisionchecker
    _internal = ("answer", "cast")

    def __init__(self, env: "Environment", name: str = "mujoco") -> None:
        self._env = env
        self._annotations = Annotations()
        self._name = name
        self._simulation = env.simulation
        self._options = 0
        self._tolerance = 0.0

    def GetXMLId(self) -> str:
        """Return the name that the checker was made by."""
        return self._name

    def InitEnvironment(self) -> bool:
        """Return True; nothing needs to be prepared."""
        return True

    def DestroyEnvironment(self) -> None:
        """Do nothing; OpenRAVE's checkers free memory here."""

    def SetCollisionOptions(self, collisionoptions: int) -> bool:
        """Choose what is looked for and reported, in place of what was chosen before.

        Args:
            collisionoptions: ``CollisionOptions`` combined with ``|``.

        Returns:
            False, and nothing changes, if there is an option among them that is not known.
        """
        if not 0 <= int(collisionoptions) < 2 * CollisionOptions.IgnoreCallbacks:
            return False
        self._options = int(collisionoptions)
        return True

    def GetCollisionOptions(self) -> int:
        """Return the chosen ``CollisionOptions``."""
        return self._options

    def SetTolerance(self, tolerance: float) -> None:
        """Set the distance [m] of ``CollisionOptions.UseTolerance``.

        Args:
            tolerance: The distance [m].
        """
        self._tolerance = float(tolerance)

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
            report = report or arguments[-1]
            arguments = arguments[:-1]
        if report is not None:
            checked_kind(report, CollisionReport, "CheckCollision: report")
        simulation = self._simulation
        with simulation.lock:
            world = simulation.collisions()
            if len(arguments) == 1 and isinstance(arguments[0], BodyPart):  # planners ask this most
                pairs = self._pairs_without(world, arguments[0], _NO_BODIES, _NO_LINKS)
            elif arguments and isinstance(arguments[0], Ray):
                return self._check_ray(world, arguments[0], arguments[1:], report)
            else:
                pairs = self._pairs(world, arguments)
            return self.answer(world, pairs, report)

    def CheckSelfCollision(self, linkbody: "BodyPart | Link", report: CollisionReport | None = None) -> bool:
        """Return whether a body collides with itself; see ``body.CheckSelfCollision``.

        Args:
            linkbody: The body, or one link that is tested against the others.
            report: Filled with what is found.
        """
        if report is not None:
            checked_kind(report, CollisionReport, "CheckSelfCollision: report")
        with self._simulation.lock:
            world = self._simulation.collisions()
            if isinstance(linkbody, Link):
                state, link = _key(linkbody)
                others = range(len(state.scene.links))
                pairs = questions.itself(world, state, frozenset((min(link, a), max(link, a)) for a in others))
            else:
                state = _state(linkbody)
                active = self._options & _ACTIVE_DOFS
                pairs = questions.itself(world, state, MovedBy(self._env.wrap(state).active_dofs()) if active else None)
            return self.answer(world, pairs, report)

    def _pairs(self, world: CollisionWorld, arguments: Sequence[object]) -> Pairs:
        """Return the pairs of geoms that the arguments of ``CheckCollision`` are about."""
        if len(arguments) == 1:
            return self._pairs_without(world, arguments[0], _NO_BODIES, _NO_LINKS)
        match arguments:
            case (BodyPart() as body, BodyPart() as other):
                self._check_added(body, other)
                return questions.bodies(world, _state(body), _state(other), self._active_links(_state(body)))
            case (Link() as link, Link() as other):
                self._check_added(link.GetParent(), other.GetParent())
                return questions.links(world, _key(link), _key(other))
            case (Link() as link, BodyPart() as body) | (BodyPart() as body, Link() as link):
                self._check_added(link.GetParent(), body)
                pairs = questions.link_and_body(world, _key(link), _state(body))
                return pairs if link is arguments[0] else world.make_pairs(pairs.second, pairs.first)
            case (thing, list() | tuple(), list() | tuple()):
                bodies, links = cast("Sequence[Sequence[object]]", arguments[1:])
                return self._pairs_without(world, thing, frozenset(map(_state, bodies)), frozenset(map(_key, links)))
            case _:
                raise _not_understood(arguments)

    def _pairs_without(
        self, world: CollisionWorld, thing: object, bodies: frozenset[BodyState], links: frozenset[LinkOf]
    ) -> Pairs:
        if isinstance(thing, BodyPart):
            state = thing.simulation_state
            self._check_ours(state)
            moved = self._active_links(state) if self._options else None
            return questions.body_and_others(world, state, moved, bodies, links)
        link = _key(thing)
        self._check_ours(link[0])
        return questions.link_and_others(world, link, bodies, links)

    def _check_ours(self, state: BodyState) -> None:
        if state.simulation is not self._simulation:
            raise ArgumentError(f"CheckCollision: '{state.scene.name}' was made for another environment")

    def _check_added(self, *bodies: BodyPart) -> None:
        for body in bodies:
            if not self._simulation.holds(body.simulation_state):
                message = f"CheckCollision: '{body.GetName()}' is not in this environment; add it first"
                raise RavemjError(message, ErrorCode.Assert)

    def _active_links(self, state: BodyState) -> Links:
        """Return the links to which the option ``ActiveDOFs`` restricts the tests; None: all."""
        if not self._options & _ACTIVE_DOFS:
            return None
        body = self._env.wrap(state)
        return None if body.moves_as_a_whole() else MovedBy(body.active_dofs())

    def answer(self, world: CollisionWorld, pairs: Pairs, report: CollisionReport | None) -> bool:
        """Test pairs of geoms as the options say, fill the report, and return whether there is a collision.

        The caller holds the lock.
        """
        if report is None and not self._callbacks():
            return world.collide(pairs)
        report = report or CollisionReport()
        report.Reset(self._options)
        found = self._fill(world, pairs, report)
        if self._options & _DISTANCE:
            self._measure(world, pairs, report)
        if self._options & _USE_TOLERANCE:
            report.numWithinTol += world.count_within(pairs, self._tolerance)
        return found

    def _fill(self, world: CollisionWorld, pairs: Pairs, report: CollisionReport) -> bool:
        """Put the colliding pairs into the report that the options ask for; return whether there are any."""
        each_geometry = bool(self._options & _ALL_GEOMETRIES)
        every = each_geometry or bool(self._options & _ALL_LINKS)
        infos: dict[object, CollisionPairInfo] = {}
        for pair in world.hits(pairs):
            key = tuple(self._geometry_key(world, geom)[: 3 if each_geometry else 2] for geom in pair)
            if key not in infos:
                if infos and not every:
                    break
                info = CollisionPairInfo(*(self._part(world, geom) for geom in pair))
                if self._is_ignored(info):
                    continue
                infos[key] = info
                report.collisionInfos.append(info)
            if self._options & _CONTACTS:
                infos[key].contacts.append(Contact(*world.shapes.contact(*pair)))
            elif not every:
                break
        return bool(infos)

    def _measure(self, world: CollisionWorld, pairs: Pairs, report: CollisionReport) -> None:
        """Put the least distance into the report and, where nothing collides, the pair that is so near."""
        distance, nearest = world.nearest(pairs, report.minDistance)
        report.minDistance = max(distance, 0.0)
        if nearest is not None and not report.numCols:
            first, second = (self._part(world, geom) for geom in nearest)
            report.collisionInfos = [CollisionPairInfo(first, second, collides=False)]

    def _is_ignored(self, info: CollisionPairInfo) -> bool:
        """Ask the registered functions whether a collision counts."""
        report = CollisionReport()
        report.Reset(self._options)
        report.collisionInfos.append(info)
        return any(callback(report, False) == CollisionAction.Ignore for callback in self._callbacks())

    def _callbacks(self) -> "list[CollisionCallback]":
        return [] if self._options & _IGNORE_CALLBACKS else self._env.collision_callbacks

    def _part(self, world: CollisionWorld, geom: int) -> Part:
        state, link, geometry = self._geometry_key(world, geom)
        owner = Link(self._env.wrap(state), state, link)
        return Part(owner, owner.GetGeometries()[geometry])

    def _geometry_key(self, world: CollisionWorld, geom: int) -> tuple[BodyState, int, int]:
        return (*world.owner(geom), world.geometry(geom))

    def _check_ray(
        self, world: CollisionWorld, ray: Ray, targets: Sequence[object], report: CollisionReport | None
    ) -> bool:
        if len(targets) > 1:
            raise _not_understood((ray, *targets))
        hit = self.cast(world, ray.pos(), ray.dir(), *targets)
        if report is not None:
            report.Reset(self._options)
        if hit is not None and report is not None:
            distance = hit.fraction * float(np.linalg.norm(ray.dir()))
            info = CollisionPairInfo(self._part(world, hit.geom), None)
            info.contacts.append(Contact(hit.position, hit.normal, distance))
            report.collisionInfos.append(info)
            report.minDistance = distance
        return hit is not None

    def cast(self, world: CollisionWorld, start: Floats, direction: Floats, target: object = ...) -> RayHit | None:
        """Return where a ray first meets a body or link, or with ``...`` anything. The caller holds the lock."""
        match target:
            case BodyPart():
                self._check_added(target)
                geoms = world.geoms_of_group(_state(target))
            case Link():
                self._check_added(target.GetParent())
                geoms = world.geoms_of_link(*_key(target))
            case _ if target is ...:
                geoms = None
            case _:
                raise _not_understood((Ray(start, direction), target))
        return world.ray(start, direction, geoms)

    def __repr__(self) -> str:
        if self._env.GetCollisionChecker() is self:
            return f"{self._env!r}.GetCollisionChecker()"
        return f"RaveCreateCollisionChecker({self._env!r}, {self._name!r})"


class NoCollisionChecker(CollisionChecker):
    """A checker for which nothing collides: that of ``env.SetCollisionChecker(None)``."""

    def __init__(self, env: "Environment") -> None:
        super().__init__(env, "GenericCollisionChecker")

    def answer(self, world: CollisionWorld, pairs: Pairs, report: CollisionReport | None) -> bool:
        """Return False."""
        del world, pairs
        if report is not None:
            report.Reset(self._options)
        return False

    def cast(self, world: CollisionWorld, start: Floats, direction: Floats, target: object = ...) -> RayHit | None:
        """Return None."""
        del world, start, direction, target


class CollisionOptionsStateSaver(ApiObject):
    """Sets the options of a checker, and sets the old ones again at the end of its ``with``.

    Example:
        >>> with ravemj.CollisionOptionsStateSaver(checker, ravemj.CollisionOptions.Contacts):
        ...     env.CheckCollision(robot, report)
    """

    def __init__(self, p: CollisionChecker, newoptions: int, required: bool = True) -> None:
        """Set the options.

        Args:
            p: The checker.
            newoptions: ``CollisionOptions`` combined with ``|``.
            required: Whether to raise where the checker does not know them.

        Raises:
            openrave_exception: it does not.
        """
        self._checker = checked_kind(p, CollisionChecker, "CollisionOptionsStateSaver: p")
        self._old = p.GetCollisionOptions()
        if not p.SetCollisionOptions(newoptions) and required:
            raise ArgumentError(f"CollisionOptionsStateSaver: newoptions are {newoptions}, which are not all known")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self._checker.SetCollisionOptions(self._old)


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
    checked_environment(env, "RaveCreateCollisionChecker")
    kind = name.lower()
    if kind in _OTHERS and kind not in _told:
        _told.add(kind)
        _LOG.warning("there is no collision checker '%s'; the one over MuJoCo takes its place", name)
    return CollisionChecker(env, name) if kind in _OTHERS or kind == "mujoco" else None


def _state(body: object) -> BodyState:
    if not isinstance(body, BodyPart):
        raise _not_understood((body,))
    return body.simulation_state


def _key(link: object) -> LinkOf:
    if not isinstance(link, Link):
        raise _not_understood((link,))
    return link.GetParent().simulation_state, link.GetIndex()


def _not_understood(arguments: Iterable[object]) -> RavemjError:
    kinds = ", ".join("None" if one is None else type(one).__name__ for one in arguments)
    forms = "a body, a link, two of them, one and two lists of excluded ones, or a Ray"
    message = f"CheckCollision: takes {forms}; not ({kinds})"
    return RavemjError(message, ErrorCode.Assert) if any(one is None for one in arguments) else ArgumentError(message)

"""A body and its state."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar
from weakref import WeakSet

import numpy as np

from ravemj.core.transforms import Floats, Pose, cross_rows
from ravemj.engine.kinematics import BodyKinematics, Configuration
from ravemj.engine.kinematics.displacement import place_links
from ravemj.errors import ErrorCode, RavemjError
from ravemj.model.bounds import BodyBounds
from ravemj.model.inertia import Inertias
from ravemj.model.joints import rezeroed
from ravemj.model.scene import Axis, Geometry, Joint, KinBody

if TYPE_CHECKING:
    from ravemj.engine.batch import Batch
    from ravemj.engine.dynamics import BodyDynamics
    from ravemj.engine.simulation.world import Simulation

_Part = TypeVar("_Part")
_Made = TypeVar("_Made")

_LOOKS = {"name", "diffuse", "ambient", "transparency"}


class GrabbedBody(NamedTuple):
    """Body grabbed by a link of another body."""

    body: "BodyState"  # the grabbed body
    link: int  # index of the grabbing link
    T_link_body: Floats
    ignored: frozenset[int] = frozenset()  # indices of the holder's links whose collisions with it are ignored


class SavedConfiguration(NamedTuple):
    """Saved state of joints and links of a body."""

    configuration: Configuration  # of MuJoCo's model
    scene: KinBody  # what the model was made of, for a body that has other joints by then


class BodyState:
    """State of a body, shared by its API objects.

    Joint values and poses are in a MuJoCo model of the body alone (``own_kinematics``), whether or not the body is in
    the world. It is compiled on first use; until then the state is that of the description ``scene``, which contains
    the file's values and later changes by the API.
    """

    def __init__(self, scene: KinBody, simulation: "Simulation") -> None:
        self.simulation = simulation  # the world that it was made for
        self.index = 0  # in the world, from 1; 0 outside of the world
        self.stamp = 0  # grows with every change of pose
        self._grabs: tuple[GrabbedBody, ...] = ()
        self.holders: WeakSet[BodyState] = WeakSet()  # the bodies that have grabbed it
        self._link_enabled: tuple[bool, ...] = ()
        # The pose in which links that touch never count as colliding, shape (links, 4, 4): that in which the body was
        # added, or that of the body of which it is a copy.
        self.rest_poses: Floats | None = None
        self._made: dict[object, tuple[object, Any]] = {}
        self.rebuild(scene)

    def rebuild(self, scene: KinBody) -> None:
        """Rebuild the body with other links and joints, in the configuration of the scene.

        Raises:
            RavemjError: the body is in the world.
        """
        if self.index:
            raise RavemjError(f"'{self.scene.name}' is in an environment; remove it first", ErrorCode.InvalidState)
        self.scene, self.dof = scene, len(scene.dof_axes)
        self.link_enabled = [link.enabled for link in scene.links]
        self.rest_poses = None
        self.stamp += 1
        self._velocities = np.zeros((len(scene.links), 6))
        self._forget_kinematics()

    def _forget_kinematics(self) -> None:
        self.known_kinematics: BodyKinematics | None = None  # ``own_kinematics`` if that was asked for before
        self._dynamics: BodyDynamics | None = None
        self._batch: Batch | None = None

    @property
    def link_enabled(self) -> tuple[bool, ...]:
        """For each link, whether it takes part in collision checks."""
        return self._link_enabled

    @link_enabled.setter
    def link_enabled(self, enabled: Iterable[bool]) -> None:
        with self.simulation.lock:
            before, self._link_enabled = self._link_enabled, tuple(enabled)
            if self._link_enabled != before:
                self.simulation.collision_stamp += 1

    @property
    def grabs(self) -> tuple[GrabbedBody, ...]:
        """Grabs, in the order of grabbing."""
        return self._grabs

    @grabs.setter
    def grabs(self, grabs: Iterable[GrabbedBody]) -> None:
        for grab in self._grabs:
            grab.body.holders.discard(self)
        self._grabs = tuple(grabs)
        for grab in self._grabs:
            grab.body.holders.add(self)
        self.simulation.collision_stamp += 1

    @property
    def own_kinematics(self) -> BodyKinematics:
        """Joint values and link poses, in a model of the body alone.

        Raises:
            CompileError: MuJoCo refuses the body.
        """
        if self.known_kinematics is None:
            self.known_kinematics = BodyKinematics(self.scene)
        return self.known_kinematics

    @property
    def kinematics(self) -> BodyKinematics:
        """``own_kinematics`` of a body in the world; in OpenRAVE, bodies outside of it have no joint values.

        Raises:
            RavemjError: the body is not in the world.
            CompileError: MuJoCo refuses the body.
        """
        if not self.index:
            message = f"'{self.scene.name}' is not in an environment and has no joint values; add it first"
            raise RavemjError(message, ErrorCode.NotInitialized)
        return self.known_kinematics or self.own_kinematics

    @property
    def dynamics(self) -> "BodyDynamics":
        """Jacobians and inverse dynamics; raises the errors of ``kinematics``."""
        if self._dynamics is None or not self.index:
            from ravemj.engine.dynamics import BodyDynamics  # noqa: PLC0415 - slow to import

            self._dynamics = BodyDynamics(self.kinematics)
        return self._dynamics

    @property
    def batch(self) -> "Batch":
        """Chain of links, prepared for many configurations; raises the errors of ``kinematics``."""
        dynamics = self.dynamics
        if self._batch is None:
            from ravemj.engine.batch import Batch  # noqa: PLC0415 - slow to import

            self._batch = Batch(self.own_kinematics, dynamics)
        return self._batch

    @property
    def inertias(self) -> Inertias:
        """Mass properties of the links at present."""
        return self.made_once(Inertias.from_links, self.scene.links)

    @property
    def bounds(self) -> BodyBounds:
        """Extents of the links' geometries at present."""
        return self.made_once(BodyBounds, self.scene.links)

    def made_once(self, make: Callable[[_Part], _Made], part: _Part) -> _Made:
        """Return the cached result of ``make(part)``; ``part`` is the description or a field of it, such as its links.

        It is recomputed if ``part`` is another object than before.
        """
        known = self._made.get(make)
        if known is None or known[0] is not part:
            self._made[make] = known = part, make(part)
        return known[1]

    def link_transforms(self) -> Floats:
        """Return ``T_world_link`` of every link, shape (links, 4, 4); a copy."""
        if self.known_kinematics is None:
            return np.array([link.T_world_link.matrix() for link in self.scene.links]).reshape(-1, 4, 4)
        return self.known_kinematics.link_transforms()

    def link_transform(self, link: int) -> Floats:
        """Return ``T_world_link`` of one link, shape (4, 4); a copy."""
        if self.known_kinematics is None:
            return self.scene.links[link].T_world_link.matrix()
        return self.known_kinematics.link_transform(link)

    def set_values(self, values: Floats, *, clamp_mimic: bool = True) -> None:
        """Set the joint values [rad or m], shape (dof,), and thereby the link poses."""
        self.will_move()
        self.kinematics.set_values(values, clamp_mimic=clamp_mimic)
        self.carry()

    def enter_limits(self) -> None:
        """Clamp joint values to their limits."""
        kinematics = self.known_kinematics
        if kinematics is not None and not kinematics.limits.contain(values := kinematics.values()):
            self.set_values(kinematics.limits.clamp(values))

    def set_transform(self, T_world_link0: Floats) -> None:
        """Move the body rigidly to the pose of its first link, shape (4, 4); joint values are kept."""
        self.will_move()
        self.own_kinematics.set_transform(T_world_link0)
        self.carry()

    def pose(self) -> Pose:
        """Return the pose of the first link."""
        return self.own_kinematics.link_pose(0) if self.scene.links else Pose()

    def set_pose(self, T_world_link0: Pose) -> None:
        """Move the body rigidly, like ``set_transform``; ``pose()`` keeps the sign of the quaternion."""
        self.will_move()
        self.own_kinematics.set_pose(T_world_link0)
        self.carry()

    def place_links(self, T_world_links: Floats, last_values: Floats | None = None) -> None:
        """Set all link poses; joint values are computed from them.

        Args:
            T_world_links: Shape (links, 4, 4).
            last_values: Joint values [rad or m], shape (dof,); hinge values are shifted by full turns towards
                them. Only for a body in the world; None means the present values.
        """
        kinematics = self.own_kinematics if last_values is None else self.kinematics
        self.will_move()
        place_links(kinematics, T_world_links, kinematics.values() if last_values is None else last_values)
        self.carry()

    def moved(self) -> None:
        """Mark the model as outdated, and move the grabbed bodies along."""
        self.will_move()
        self.carry()

    def will_move(self) -> None:
        """Mark the model as outdated. It is called before links move, so that an interrupt cannot skip it."""
        self.stamp += 1
        if self.index:
            self.simulation.changed.add(self)

    def carry(self) -> None:
        """Move the grabbed bodies along with the links that grab them."""
        for grab in self._grabs:
            grab.body.set_transform(self.link_transform(grab.link) @ grab.T_link_body)

    def link_velocities(self) -> Floats:
        """Return a copy of the link velocities in world axes, (links, 6): of the origin [m/s], angular [rad/s].

        Moving links does not change them, as in OpenRAVE.
        """
        return self._velocities.copy()

    @property
    def present_velocities(self) -> Floats:
        """``link_velocities`` without a copy; the array is immutable, and replaced on changes."""
        return self._velocities

    def set_link_velocities(self, velocities: Floats) -> None:
        """Set the velocities of the links, shape (links, 6), and accordingly of grabbed bodies."""
        self._velocities = velocities.copy()
        self._velocities.flags.writeable = False
        for grab in self.grabs:
            self._carry(grab)

    def _carry(self, grab: GrabbedBody) -> None:
        """Set the velocity of a grabbed body to that of a rigid motion with the grabbing link."""
        carrier = self._velocities[grab.link]
        arm = grab.body.link_transform(0)[:3, 3] - self.link_transform(grab.link)[:3, 3]
        grab.body.set_velocity(carrier[:3] + cross_rows(carrier[3:], arm), carrier[3:])

    def set_velocity(self, linear: Floats, angular: Floats) -> None:
        """Set the link velocities of a rigid motion: of the first link's origin [m/s], and angular [rad/s]."""
        origins = self.link_transforms()[:, :3, 3]
        velocities = np.empty((len(origins), 6))
        velocities[:, :3] = linear + cross_rows(angular, origins - origins[:1])
        velocities[:, 3:] = angular
        self.set_link_velocities(velocities)

    def grab(self, grab: GrabbedBody) -> None:
        """Grab a body. If it is already grabbed, its relative pose is updated."""
        if any(old.body is grab.body for old in self.grabs):
            self.grabs = [grab if old.body is grab.body else old for old in self.grabs]
        else:
            self.grabs = (*self.grabs, grab)
        self._carry(grab)

    def carries(self, body: "BodyState") -> bool:
        """Return whether ``body`` is this body, or is grabbed by it directly or indirectly."""
        return body is self or any(grab.body.carries(body) for grab in self.grabs)

    def release(self, body: "BodyState") -> None:
        """Release a body; nothing happens if it is not grabbed."""
        self.grabs = [grab for grab in self.grabs if grab.body is not body]

    def configuration(self) -> SavedConfiguration:
        """Return the state of joints and links, for ``restore``."""
        return SavedConfiguration(self.own_kinematics.configuration(), self.scene)

    def restore(self, saved: SavedConfiguration) -> None:
        """Restore a state returned by ``configuration``, of this body or of a body with the same structure."""
        self.will_move()
        kinematics = self.own_kinematics
        if not kinematics.restore(saved.configuration):
            before = BodyKinematics(saved.scene)
            before.restore(saved.configuration)
            place_links(kinematics, before.link_transforms(), kinematics.values())
        self.carry()

    def copy(self, other: "BodyState", name: str | None = None) -> None:
        """Copy another body, including its configuration and flags, without grabs.

        Raises:
            RavemjError: this body is in the world.
        """
        self.rebuild(other.scene if name is None else replace(other.scene, name=name))
        self.link_enabled, self.rest_poses = other.link_enabled, other.rest_poses
        if other.known_kinematics is not None:
            self.own_kinematics.restore(other.known_kinematics.configuration())
        self._velocities = other.link_velocities()

    def edit(self, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.KinBody
        """Change fields of the description, such as name, limits or manipulators, but not links and joints."""
        scene = replace(self.scene, **changes)
        if not changes.keys().isdisjoint(("joints", "passive_joints")) and _welds(scene) != _welds(self.scene):
            self.remake(scene)
            return
        self.scene = scene
        if self.index:
            self.simulation.changed.add(self)
        if self.known_kinematics is not None:
            self.known_kinematics.describe(self.scene)
        if "passive_joints" in changes:
            self._dynamics = self._batch = None  # the value of a multivalued mimic equation depends on the limits

    def remake(self, scene: KinBody) -> None:
        """Replace the description, also by one with other DOFs, welds or mimic equations.

        The links move when values are next set.
        """
        saved = self.configuration()
        self.simulation.forget_model()
        self._forget_kinematics()
        self.scene, self.dof = scene, len(scene.dof_axes)
        self.restore(saved)

    def rezero(self) -> None:
        """Make the present configuration the zero configuration; links move when values are next set."""
        T_world_links = self.link_transforms()
        scene = rezeroed(self.scene, T_world_links, self.kinematics.values().tolist())
        self.simulation.forget_model()
        self._forget_kinematics()
        self.scene = scene
        self.place_links(T_world_links)

    def edit_link(self, index: int, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.Link
        """Change the description of a link, such as mass or name; for shapes use ``set_geometries``."""
        links = list(self.scene.links)
        links[index] = replace(links[index], **changes)
        self.edit(links=tuple(links))

    def set_geometries(self, link: int, geometries: "Sequence[Geometry]") -> None:
        """Replace the shapes of a link; the next use of the world's model recompiles it."""
        if self.index:
            self.simulation.forget_model()
        self.edit_link(link, geometries=tuple(geometries))

    def edit_geometry(self, link: int, index: int, **changes: Any) -> None:  # noqa: ANN401 - of a scene.Geometry
        """Change the description of a shape; changed colours do not require recompilation."""
        geometries = list(self.scene.links[link].geometries)
        geometries[index] = replace(geometries[index], **changes)
        if changes.keys() <= _LOOKS:
            self.edit_link(link, geometries=tuple(geometries))
        else:
            self.set_geometries(link, geometries)

    def edit_joint(self, index: int, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.Joint
        """Change the description of a joint, given by its index among active, then passive joints."""
        joints = list(self.scene.all_joints)
        joints[index] = _still_moving(joints[index], replace(joints[index], **changes))
        count = len(self.scene.joints)
        self.edit(joints=tuple(joints[:count]), passive_joints=tuple(joints[count:]))

    def edit_axes(self, axes: "list[Axis]") -> None:
        """Replace the axes of all active joints, in DOF order."""
        rest: Iterator[Axis] = iter(axes)
        edited = ((joint, replace(joint, axes=tuple(next(rest) for _ in joint.axes))) for joint in self.scene.joints)
        self.edit(joints=tuple(_still_moving(before, after) for before, after in edited))


def _still_moving(before: Joint, after: Joint) -> Joint:
    """Return ``after``, marked as movable if ``before`` was: limits set by scripts must not weld a joint."""
    return replace(after, keeps_moving=True) if after.static and not before.static else after


def _welds(body: KinBody) -> list[bool]:
    return [joint.static for joint in body.all_joints]

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
from ravemj.model.scene import Axis, Geometry, KinBody

if TYPE_CHECKING:
    from ravemj.engine.batch import Batch
    from ravemj.engine.dynamics import BodyDynamics
    from ravemj.engine.simulation.world import Simulation

_Part = TypeVar("_Part")
_Made = TypeVar("_Made")

_LOOKS = {"name", "diffuse", "ambient", "transparency"}


class GrabbedBody(NamedTuple):
    """One body held by a link of another."""

    body: "BodyState"  # the held one
    link: int  # index of the link that holds it
    T_link_body: Floats
    ignored: frozenset[int] = frozenset()  # indices of the holder's links that it does not collide with


class SavedConfiguration(NamedTuple):
    """State of joints and links."""

    configuration: Configuration  # of MuJoCo's model
    scene: KinBody  # what the model was made of, for a body that has other joints by then


class BodyState:
    """A body and its state; what the API objects of one body share.

    Joint values and poses are those of a MuJoCo model of the body alone (``own_kinematics``), whether the body is in
    the world or not. It is compiled when first asked for; until then the body is where its description has it. That is
    ``scene``: what files say, and what setters of the API changed since.
    """

    def __init__(self, scene: KinBody, simulation: "Simulation") -> None:
        self.simulation = simulation  # the world that it was made for
        self.index = 0  # in the world, from 1; 0 while it is not in the world
        self.stamp = 0  # grows with every change of pose
        self._grabs: tuple[GrabbedBody, ...] = ()
        self.holders: WeakSet[BodyState] = WeakSet()  # the bodies that hold it
        self._link_enabled: tuple[bool, ...] = ()
        # The pose in which links that touch never count as colliding, shape (links, 4, 4): that in which the body was
        # added, or that of the body of which it is a copy.
        self.rest_poses: Floats | None = None
        self._made: dict[object, tuple[object, Any]] = {}
        self.rebuild(scene)

    def rebuild(self, scene: KinBody) -> None:
        """Make the body anew of other links and joints, in the configuration that the scene has.

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
        self._kinematics: BodyKinematics | None = None
        self._dynamics: BodyDynamics | None = None
        self._batch: Batch | None = None

    @property
    def link_enabled(self) -> tuple[bool, ...]:
        """For each link, whether collision checking looks at it."""
        return self._link_enabled

    @link_enabled.setter
    def link_enabled(self, enabled: Iterable[bool]) -> None:
        with self.simulation.lock:
            before, self._link_enabled = self._link_enabled, tuple(enabled)
            if self._link_enabled != before:
                self.simulation.collision_stamp += 1

    @property
    def grabs(self) -> tuple[GrabbedBody, ...]:
        """What it holds, in the order of grabbing."""
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
    def is_compiled(self) -> bool:
        """Whether the body has a model of its own already; if not, it is where its description has it."""
        return self._kinematics is not None

    @property
    def own_kinematics(self) -> BodyKinematics:
        """Joint values and link poses, in a model of the body alone.

        Raises:
            CompileError: MuJoCo refuses the body.
        """
        if self._kinematics is None:
            self._kinematics = BodyKinematics(self.scene)
        return self._kinematics

    @property
    def kinematics(self) -> BodyKinematics:
        """``own_kinematics``, for what OpenRAVE answers for bodies in an environment only: joint values.

        Raises:
            RavemjError: the body is not in the world.
            CompileError: MuJoCo refuses the body.
        """
        if not self.index:
            message = f"'{self.scene.name}' is not in an environment and has no joint values; add it first"
            raise RavemjError(message, ErrorCode.NotInitialized)
        return self._kinematics or self.own_kinematics

    @property
    def dynamics(self) -> "BodyDynamics":
        """Jacobians and inverse dynamics; errors as for ``kinematics``."""
        if self._dynamics is None or not self.index:
            from ravemj.engine.dynamics import BodyDynamics  # noqa: PLC0415 - slow to import

            self._dynamics = BodyDynamics(self.kinematics)
        return self._dynamics

    @property
    def batch(self) -> "Batch":
        """The chain of links, ready for many configurations; errors as for ``kinematics``."""
        dynamics = self.dynamics
        if self._batch is None:
            from ravemj.engine.batch import Batch  # noqa: PLC0415 - slow to import

            self._batch = Batch(self.own_kinematics, dynamics)
        return self._batch

    @property
    def inertias(self) -> Inertias:
        """Mass properties of the links, as the scene has them now."""
        return self.made_once(Inertias.of, self.scene.links)

    @property
    def bounds(self) -> BodyBounds:
        """The extents of the links' geometries, as the scene has them now."""
        return self.made_once(BodyBounds, self.scene.links)

    def made_once(self, make: Callable[[_Part], _Made], part: _Part) -> _Made:
        """Return what a function makes of a part of the scene; it is called again when the part is another one."""
        known = self._made.get(make)
        if known is None or known[0] is not part:
            self._made[make] = known = part, make(part)
        return known[1]

    def link_transforms(self) -> Floats:
        """Return ``T_world_link`` of every link, shape (links, 4, 4); a copy."""
        if self._kinematics is None:
            return np.array([link.T_world_link.matrix() for link in self.scene.links]).reshape(-1, 4, 4)
        return self._kinematics.link_transforms()

    def link_transform(self, link: int) -> Floats:
        """Return ``T_world_link`` of one link, shape (4, 4); a copy."""
        if self._kinematics is None:
            return self.scene.links[link].T_world_link.matrix()
        return self._kinematics.link_transform(link)

    def set_values(self, values: Floats, *, clamp_mimic: bool = True) -> None:
        """Set the joint values [rad or m], shape (dof,), and place all links by them."""
        self.will_move()
        self.kinematics.set_values(values, clamp_mimic=clamp_mimic)
        self.carry()

    def enter_limits(self) -> None:
        """Let joints that are outside their limits go to them."""
        if self._kinematics is not None and not self._kinematics.limits.contain(values := self._kinematics.values()):
            self.set_values(self._kinematics.limits.clamp(values))

    def set_transform(self, T_world_link0: Floats) -> None:
        """Move the body rigidly, with the joint values as they are, by the pose of its first link, shape (4, 4)."""
        self.will_move()
        self.own_kinematics.set_transform(T_world_link0)
        self.carry()

    def pose(self) -> Pose:
        """Return the pose of the first link."""
        return self.own_kinematics.link_pose(0) if self.scene.links else Pose()

    def set_pose(self, T_world_link0: Pose) -> None:
        """Move the body rigidly, as ``set_transform``; ``pose()`` gives back this quaternion, not its negative."""
        self.set_transform(T_world_link0.matrix())
        self.own_kinematics.set_root_wxyz(T_world_link0.wxyz)

    def place_links(self, T_world_links: Floats, last_values: Floats | None = None) -> None:
        """Put every link at a pose; joints get the values that the poses show.

        Args:
            T_world_links: Shape (links, 4, 4).
            last_values: Joint values to which those of hinges are next, full turns apart [rad or m], shape (dof,);
                the body is in the world. None: the present values.
        """
        kinematics = self.own_kinematics if last_values is None else self.kinematics
        self.will_move()
        place_links(kinematics, T_world_links, kinematics.values() if last_values is None else last_values)
        self.carry()

    def moved(self) -> None:
        """Mark the model as out of date, and move the grabbed bodies along."""
        self.will_move()
        self.carry()

    def will_move(self) -> None:
        """Mark the model as out of date. Called before links move, so that no interrupt leaves it unmarked."""
        self.stamp += 1
        if self.index:
            self.simulation.changed.add(self)

    def carry(self) -> None:
        """Move the grabbed bodies to where they are held."""
        for grab in self._grabs:
            grab.body.set_transform(self.link_transform(grab.link) @ grab.T_link_body)

    def link_velocities(self) -> Floats:
        """Return the velocities of the links in world axes, (links, 6): of the origin [m/s], angular [rad/s]; a copy.

        Moving links does not change them, as in OpenRAVE.
        """
        return self._velocities.copy()

    @property
    def present_velocities(self) -> Floats:
        """``link_velocities`` without a copy; the array is never changed, but replaced."""
        return self._velocities

    def set_link_velocities(self, velocities: Floats) -> None:
        """Set the velocities of the links, shape (links, 6); what they hold moves with them."""
        self._velocities = velocities.copy()
        self._velocities.flags.writeable = False
        for grab in self.grabs:
            self._carry(grab)

    def _carry(self, grab: GrabbedBody) -> None:
        """Give a held body the velocity of the link that holds it."""
        carrier = self._velocities[grab.link]
        arm = grab.body.link_transform(0)[:3, 3] - self.link_transform(grab.link)[:3, 3]
        grab.body.set_velocity(carrier[:3] + cross_rows(carrier[3:], arm), carrier[3:])

    def set_velocity(self, linear: Floats, angular: Floats) -> None:
        """Let all links move as one, by the velocity of the first link's origin [m/s] and an angular one [rad/s]."""
        origins = self.link_transforms()[:, :3, 3]
        velocities = np.empty((len(origins), 6))
        velocities[:, :3] = linear + cross_rows(angular, origins - origins[:1])
        velocities[:, 3:] = angular
        self.set_link_velocities(velocities)

    def grab(self, grab: GrabbedBody) -> None:
        """Hold a body; one that is held already, anew."""
        if any(old.body is grab.body for old in self.grabs):
            self.grabs = [grab if old.body is grab.body else old for old in self.grabs]
        else:
            self.grabs = (*self.grabs, grab)
        self._carry(grab)

    def carries(self, body: "BodyState") -> bool:
        """Return whether a body is this one, or held by it or by what it holds."""
        return body is self or any(grab.body.carries(body) for grab in self.grabs)

    def release(self, body: "BodyState") -> None:
        """Let go of a body; nothing happens if it is not held."""
        self.grabs = [grab for grab in self.grabs if grab.body is not body]

    def configuration(self) -> SavedConfiguration:
        """Return the state of joints and links, for ``restore``."""
        return SavedConfiguration(self.own_kinematics.configuration(), self.scene)

    def restore(self, saved: SavedConfiguration) -> None:
        """Bring joints and links back to a state that ``configuration`` returned, of this body or one like it."""
        self.will_move()
        kinematics = self.own_kinematics
        if not kinematics.restore(saved.configuration):
            before = BodyKinematics(saved.scene)
            before.restore(saved.configuration)
            place_links(kinematics, before.link_transforms(), kinematics.values())
        self.carry()

    def copy(self, other: "BodyState", name: str | None = None) -> None:
        """Become like another body, its configuration and flags included; what it holds is left out.

        Raises:
            RavemjError: this body is in the world.
        """
        self.rebuild(other.scene if name is None else replace(other.scene, name=name))
        self.link_enabled, self.rest_poses = other.link_enabled, other.rest_poses
        if other._kinematics is not None:
            self.own_kinematics.restore(other._kinematics.configuration())
        self._velocities = other.link_velocities()

    def edit(self, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.KinBody
        """Change the description of the body where links and joints stay the same: names, limits, manipulators."""
        scene = replace(self.scene, **changes)
        if not changes.keys().isdisjoint(("joints", "passive_joints")) and _welds(scene) != _welds(self.scene):
            self.remake(scene)
            return
        self.scene = scene
        if self.index:
            self.simulation.changed.add(self)
        if self._kinematics is not None:
            self._kinematics.describe(self.scene)
        if "passive_joints" in changes:
            self._dynamics = self._batch = None  # which of several values a follower has depends on its limits

    def remake(self, scene: KinBody) -> None:
        """Take over a description with other DOFs, welds or equations; links stay until values are next set."""
        saved = self.configuration()
        self.simulation.forget_model()
        self._forget_kinematics()
        self.scene, self.dof = scene, len(scene.dof_axes)
        self.restore(saved)

    def rezero(self) -> None:
        """Call the present values of the DOFs zero; the links stay where they are, until values are next set."""
        T_world_links = self.link_transforms()
        scene = rezeroed(self.scene, T_world_links, self.kinematics.values().tolist())
        self.simulation.forget_model()
        self._forget_kinematics()
        self.scene = scene
        self.place_links(T_world_links)

    def edit_link(self, index: int, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.Link
        """Change the description of a link: its masses, its names; shapes by ``set_geometries``."""
        links = list(self.scene.links)
        links[index] = replace(links[index], **changes)
        self.edit(links=tuple(links))

    def set_geometries(self, link: int, geometries: "Sequence[Geometry]") -> None:
        """Give a link other shapes; the model of the world is compiled anew when it is next asked for."""
        if self.index:
            self.simulation.forget_model()
        self.edit_link(link, geometries=tuple(geometries))

    def edit_geometry(self, link: int, index: int, **changes: Any) -> None:  # noqa: ANN401 - of a scene.Geometry
        """Change the description of a shape; colours do not make the model compile anew."""
        geometries = list(self.scene.links[link].geometries)
        geometries[index] = replace(geometries[index], **changes)
        if changes.keys() <= _LOOKS:
            self.edit_link(link, geometries=tuple(geometries))
        else:
            self.set_geometries(link, geometries)

    def edit_joint(self, index: int, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.Joint
        """Change the description of a joint; the index counts active joints and then passive ones."""
        joints = list(self.scene.all_joints)
        joints[index] = replace(joints[index], **changes)
        count = len(self.scene.joints)
        self.edit(joints=tuple(joints[:count]), passive_joints=tuple(joints[count:]))

    def edit_axes(self, axes: "list[Axis]") -> None:
        """Replace the axes of all active joints, in DOF order."""
        rest: Iterator[Axis] = iter(axes)
        self.edit(
            joints=tuple(replace(joint, axes=tuple(next(rest) for _ in joint.axes)) for joint in self.scene.joints)
        )


def _welds(body: KinBody) -> list[bool]:
    return [joint.static for joint in body.all_joints]

"""Comparison of bodies: names, order, poses, masses, joints, shapes, manipulators."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats, Pose
from ravemj.model.chains import adjacent_pairs, separate_pairs
from ravemj.model.inertia import principal_frame
from ravemj.model.joints import poses_at
from ravemj.model.look import WHITE
from ravemj.model.mimic import MimicJoints
from ravemj.model.scene import (
    AttachedSensor,
    Axis,
    Geometry,
    Joint,
    KinBody,
    Link,
    Manipulator,
    Mesh,
    Rgb,
    Scene,
    sensor_kind,
)

TOLERANCE = 1e-9
"""Tolerance of numbers, relative to the larger of 1 and the largest number."""
MESH_TOLERANCE = 1e-6
"""Tolerance of mesh vertices, which files store in single precision."""
CONFIGURATIONS = 5
"""Number of random configurations to compare."""

_FARTHEST = 10.0  # range of random values of joints without limits [rad or m]
_AXIS_FIELDS = tuple(field.name for field in fields(Axis) if field.name not in {"direction", "reference"})
"""Compared fields of axes: all except the direction, which some joints lack, and the reference, which is derived."""


class Difference(NamedTuple):
    """Difference between two models.

    Attributes:
        part: The body, link, joint or shape, in words.
        quantity: The quantity that differs.
        first: Its value in the first model.
        second: Its value in the second model.
        error: The largest difference of two numbers, relative to the larger of 1 and the largest number; None for other
            values.
    """

    part: str
    quantity: str
    first: object
    second: object
    error: float | None = None


def compare(first: Scene, second: Scene, tolerance: float = TOLERANCE) -> list[Difference]:
    """Compare two scenes body by body, in order; for ``tolerance``, see ``TOLERANCE``."""
    return list(_Comparison(tolerance).scenes(first, second))


@dataclass(frozen=True, slots=True)
class _Comparison:
    tolerance: float

    def scenes(self, first: Scene, second: Scene) -> Iterator[Difference]:
        """Yield differences of bodies and sensors; of gravity, view and description if both scenes have them."""
        part = "the scene"
        yield from self._same(part, "bodies", _names(first.bodies), _names(second.bodies))
        yield from self._same(part, "sensors", _names(first.sensors), _names(second.sensors))
        if first.description and second.description:
            yield from self._same(part, "description", first.description, second.description)
        if first.gravity is not None and second.gravity is not None:
            yield from self._near(part, "gravity", first.gravity, second.gravity)
        if first.view is not None and second.view is not None:
            yield from self._near(part, "background", *(view.background or WHITE for view in (first.view, second.view)))
            yield from self._poses(part, "camera", first.view.T_world_camera, second.view.T_world_camera)
        for item, other in zip(first.bodies, second.bodies, strict=False):
            yield from self._bodies(item, other)
        for item, other in zip(first.sensors, second.sensors, strict=False):
            yield from self._sensors(f"sensor '{item.name}'", item, other)

    def _bodies(self, first: KinBody, second: KinBody) -> Iterator[Difference]:
        part = f"'{first.name}'"
        yield from self._same(part, "is a robot", first.is_robot, second.is_robot)
        yield from self._same(part, "description", first.description, second.description)
        yield from self._same(
            part, "has an active manipulator", first.has_active_manipulator, second.has_active_manipulator
        )
        structure = [
            *self._same(part, "links", _names(first.links), _names(second.links)),
            *self._same(part, "joints", _names(first.joints), _names(second.joints)),
            *self._same(part, "passive joints", _names(first.passive_joints), _names(second.passive_joints)),
        ]
        yield from structure
        if len(first.links) == len(second.links) and separate_pairs(first) != separate_pairs(second):
            yield from self._same(part, "adjacent links", *(sorted(adjacent_pairs(body)) for body in (first, second)))
        for item, other in zip(first.links, second.links, strict=False):
            yield from self._links(f"{part} link '{item.name}'", item, other)
        for item, other in zip(first.all_joints, second.all_joints, strict=False):
            yield from self._joints(f"{part} joint '{item.name}'", item, other)
        yield from self._equations(part, first, second)
        yield from self._attached(part, first, second)
        if not structure:
            yield from self._configurations(part, first, second)

    def _equations(self, part: str, first: KinBody, second: KinBody) -> Iterator[Difference]:
        if not any(joint.mimic for body in (first, second) for joint in body.all_joints):
            return
        from ravemj.model.mimic_texts import mimic_texts  # noqa: PLC0415 - slow to import, and rarely wanted

        texts = mimic_texts(first), mimic_texts(second)
        for joint, equations, other in zip(first.all_joints, *texts, strict=False):
            for quantity in sorted(equations.keys() | other.keys()):
                yield from self._same(
                    f"{part} joint '{joint.name}'", quantity, equations.get(quantity), other.get(quantity)
                )

    def _attached(self, part: str, first: KinBody, second: KinBody) -> Iterator[Difference]:
        yield from self._same(part, "manipulators", _names(first.manipulators), _names(second.manipulators))
        yield from self._same(part, "sensors", _names(first.sensors), _names(second.sensors))
        for item, other in zip(first.manipulators, second.manipulators, strict=False):
            yield from self._manipulators(f"{part} manipulator '{item.name}'", item, other)
        yield from self._same(part, "holds", *([(x.body, x.link, x.ignored) for x in y.grabs] for y in (first, second)))
        for item, other in zip(first.grabs, second.grabs, strict=False):
            yield from self._poses(part, "pose of what it holds", item.T_link_body, other.T_link_body)
        for item, other in zip(first.sensors, second.sensors, strict=False):
            yield from self._sensors(f"{part} sensor '{item.name}'", item, other)

    def _links(self, part: str, first: Link, second: Link) -> Iterator[Difference]:
        yield from self._poses(part, "pose", first.T_world_link, second.T_world_link)
        yield from self._near(part, "mass", first.inertial.mass, second.inertial.mass)
        yield from self._near(part, "centre of mass", first.inertial.com, second.inertial.com)
        yield from self._near(part, "inertia", first.inertial.inertia, second.inertial.inertia)
        yield from self._poses(part, "axes of inertia", *(principal_frame(x.inertial) for x in (first, second)))
        yield from self._same(part, "has no defined mass", first.inertial.undefined, second.inertial.undefined)
        yield from self._same(part, "static", first.static, second.static)
        yield from self._same(part, "enabled", first.enabled, second.enabled)
        yield from self._same(
            part, "is tested against its body", *(not x.self_collision_ignored for x in (first, second))
        )
        yield from self._same(part, "parameters", first.parameters, second.parameters)
        groups, others = dict(first.groups), dict(second.groups)
        yield from self._same(part, "groups of shapes", list(groups), list(others))
        yield from self._shapes(part, first.geometries, second.geometries)
        for name in groups.keys() & others.keys():
            yield from self._shapes(f"{part} group '{name}'", groups[name], others[name])

    def _shapes(self, part: str, first: Sequence[Geometry], second: Sequence[Geometry]) -> Iterator[Difference]:
        yield from self._same(part, "shapes", _types(first), _types(second))
        for index, (geometry, other) in enumerate(zip(first, second, strict=False)):
            yield from self._geometries(f"{part} shape {index}", geometry, other)

    def _joints(self, part: str, first: Joint, second: Joint) -> Iterator[Difference]:
        for name in ("kind", "parent", "child", "places_child"):
            yield from self._same(part, name.replace("_", " "), getattr(first, name), getattr(second, name))
        if first.kind != "slider":  # every point is as good there
            yield from self._near(part, "anchor", first.anchor, second.anchor)
        for axis, other in zip(first.axes, second.axes, strict=False):
            if first.kind != "spherical":  # a rotation vector in the axes of the parent
                yield from self._near(part, "direction", axis.direction, other.direction)
            for name in _AXIS_FIELDS:
                yield from self._near(part, name.replace("_", " "), getattr(axis, name), getattr(other, name))
        yield from self._same(part, "parameters", first.parameters, second.parameters)
        mimics = [None if joint.mimic is None else joint.mimic.dofs for joint in (first, second)]
        yield from self._same(part, "follows DOFs", *mimics)

    def _manipulators(self, part: str, first: Manipulator, second: Manipulator) -> Iterator[Difference]:
        for name in (
            "base", "effector", "arm_dofs", "gripper_joints", "gripper_dofs", "chucking_direction", "gripper_name",
        ):  # fmt: skip
            yield from self._same(part, name.replace("_", " "), getattr(first, name), getattr(second, name))
        yield from self._poses(part, "tool", first.T_effector_tool, second.T_effector_tool)
        yield from self._near(part, "direction", first.direction, second.direction)

    def _sensors(self, part: str, first: AttachedSensor, second: AttachedSensor) -> Iterator[Difference]:
        yield from self._same(part, "link", first.link, second.link)
        kinds = [_kind(sensor) for sensor in (first, second)]
        yield from self._same(part, "kind", *kinds)
        devices = [type(sensor.device).__name__ for sensor in (first, second)]
        yield from self._same(part, "device", *devices)
        for name in () if first.device is None or devices[0] != devices[1] else first.device.__slots__:
            values = getattr(first.device, name), getattr(second.device, name)
            compare = self._same if isinstance(values[0], str) else self._near
            yield from compare(part, name.replace("_", " "), *values)
        yield from self._same(part, "is on", first.is_on, second.is_on)
        yield from self._near(part, "color", first.color, second.color)
        yield from self._poses(part, "pose", first.T_link_sensor, second.T_link_sensor)

    def _geometries(self, part: str, first: Geometry, second: Geometry) -> Iterator[Difference]:
        for name in ("name", "visible", "modifiable"):
            yield from self._same(part, name, getattr(first, name), getattr(second, name))
        yield from self._poses(part, "pose", first.T_link_geometry, second.T_link_geometry)
        for name in ("diffuse", "ambient", "transparency"):
            yield from self._near(part, name, getattr(first, name), getattr(second, name))
        if type(first.shape) is type(second.shape):
            for size in first.shape.sizes():
                values = getattr(first.shape, size.name), getattr(second.shape, size.name)
                yield from self._sizes(part, size.name.replace("_", " "), *values)
        yield from self._same(
            part, "has triangles of scripts", *(x.collision_mesh is not None for x in (first, second))
        )
        if first.collision_mesh is not None and second.collision_mesh is not None:
            yield from self._meshes(part, "triangles of scripts", first.collision_mesh, second.collision_mesh)
        yield from self._meshes(part, "drawn triangles", _drawn(first), _drawn(second))
        yield from self._same(part, "drawn colours", _colours(first), _colours(second))

    def _sizes(
        self, part: str, quantity: str, first: Mesh | ArrayLike, second: Mesh | ArrayLike
    ) -> Iterator[Difference]:
        if isinstance(first, Mesh) and isinstance(second, Mesh):
            yield from self._meshes(part, "triangles", first, second)
        elif not isinstance(first, Mesh) and not isinstance(second, Mesh):
            yield from self._near(part, quantity, first, second)

    def _configurations(self, part: str, first: KinBody, second: KinBody) -> Iterator[Difference]:
        """Compare the poses of all links in random configurations; report the largest difference."""
        random = np.random.default_rng(0)
        differences: list[Difference] = []
        for _ in range(CONFIGURATIONS if first.joints else 0):
            values = [_random_value(axis, random) for axis in first.dof_axes]
            poses = [poses_in(body, values) for body in (first, second)]
            named = " ".join(f"{value:.3g}" for value in values)
            for link, pose, other in zip(first.links, *poses, strict=True):
                place = f"{part} link '{link.name}' at the values {named}"
                differences += self._poses(place, "pose", pose, other)
        if differences:
            yield max(differences, key=lambda difference: difference.error or math.inf)

    def _poses(self, part: str, quantity: str, first: Pose | None, second: Pose | None) -> Iterator[Difference]:
        if first is None or second is None:
            yield from self._same(part, quantity, first is None, second is None)
        elif first != second:
            yield from self._near(part, quantity, first.matrix(), second.matrix())

    def _meshes(self, part: str, quantity: str, first: Mesh, second: Mesh) -> Iterator[Difference]:
        if first is second or first == second:
            return
        corners = [_corners(mesh) for mesh in (first, second)]
        yield from self._same(part, f"number of {quantity}", *map(len, corners))
        if len(corners[0]) == len(corners[1]):
            largest = max(1.0, float(np.abs(corners[0]).max(initial=0.0)))
            error = float(np.abs(corners[0] - corners[1]).max(initial=0.0)) / largest
            if not error <= MESH_TOLERANCE:
                yield Difference(part, quantity, "", "", error)

    def _near(self, part: str, quantity: str, first: ArrayLike, second: ArrayLike) -> Iterator[Difference]:
        if first is second:
            return
        numbers, other = np.asarray(first, dtype=np.float64), np.asarray(second, dtype=np.float64)
        if numbers.shape != other.shape:
            yield Difference(part, quantity, numbers.tolist(), other.tolist())
            return
        with np.errstate(invalid="ignore"):
            errors = np.abs(numbers - other) / max(1.0, np.abs(numbers).max(initial=0.0))
        is_same = (numbers == other) | (np.isnan(numbers) & np.isnan(other))
        error = float(np.where(is_same, 0.0, errors).max(initial=0.0))
        if not error <= self.tolerance:
            yield Difference(part, quantity, numbers.tolist(), other.tolist(), error)

    def _same(self, part: str, quantity: str, first: object, second: object) -> Iterator[Difference]:
        if first != second:
            yield Difference(part, quantity, first, second)


def poses_in(body: KinBody, dof_values: Sequence[float]) -> list[Pose]:
    """Return the link poses of a body at joint values [rad or m], with its root links unchanged."""
    rest = iter(dof_values)
    values = [[next(rest) for _ in joint.axes] for joint in body.joints]
    values += [[axis.value for axis in joint.axes] for joint in body.passive_joints]
    firsts = [joint_values[0] for joint_values in values]
    MimicJoints(body.all_joints).evaluate(firsts)
    return poses_at(body, [[first, *joint_values[1:]] for first, joint_values in zip(firsts, values, strict=True)])


def _random_value(axis: Axis, random: np.random.Generator) -> float:
    """Return a random axis value within the limits and, if these allow it, within +-``_FARTHEST``."""
    low, high = (min(max(end, axis.lower), axis.upper) for end in (-_FARTHEST, _FARTHEST))
    return float(random.uniform(low, high))


def _names(parts: Iterable[Link | Joint | KinBody | Manipulator | AttachedSensor]) -> list[str]:
    return [part.name for part in parts]


def _types(geometries: Sequence[Geometry]) -> list[str]:
    return [type(geometry.shape).__name__ for geometry in geometries]


def _kind(sensor: AttachedSensor) -> str | None:
    """Return the canonical name of a sensor type, which formats spell differently."""
    kind = sensor_kind(sensor.type or "")
    return sensor.type if kind is None else kind.name


def _colours(geometry: Geometry) -> list[tuple[Rgb, float]]:
    """Return colour and transparency of each display surface."""
    return [(surface.diffuse, surface.transparency) for surface in geometry.display or ()]


def _drawn(geometry: Geometry) -> Mesh:
    if geometry.display is None:
        return _NOTHING
    return Mesh.merged(surface.mesh for surface in geometry.display)


def _corners(mesh: Mesh) -> Floats:
    """Return the corners of each triangle, shape (n, 3, 3), without those that degenerate in single precision."""
    corners = mesh.vertices[mesh.triangles]
    a, b, c = (corners[:, i].astype(np.float32) for i in range(3))
    return corners[~((a == b).all(1) | (b == c).all(1) | (c == a).all(1))]


_NOTHING = Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int_))

"""Rigid bodies of physics scenes, which contain the masses of links."""

import math
from dataclasses import dataclass

import numpy as np

from ravemj.core.transforms import ZERO, Pose, Vec3
from ravemj.formats.collada.library import Library
from ravemj.formats.collada.visual import Node, find_node, read_pose, rigid_part
from ravemj.formats.meshes.collada.document import Element, child, children, local_name, numbers, words
from ravemj.model.inertia import inertial_about
from ravemj.model.scene import Inertial

NO_MASS = Inertial(1e-10, ZERO, ((1e-7, 0.0, 0.0), (0.0, 1e-7, 0.0), (0.0, 0.0, 1e-7)))
"""Mass properties of a link without a rigid body."""


@dataclass(frozen=True, slots=True)
class RigidBody:
    """The rigid body of a node.

    Attributes:
        element: The ``<rigid_body>``.
        parent: The node in whose frame its mass properties are given, or None for the frame of the first link.
    """

    element: Element
    parent: Node | None

    @property
    def static(self) -> bool:
        """Whether the body is static."""
        return words(child(self.element, "technique_common", "dynamic"))[:1] == ["false"]

    def inertial(self, library: Library, T_world_link: Pose, T_world_root: Pose) -> Inertial:
        """Return the mass properties in a link's frame, given its pose and the first link's pose with joints at 0.

        Raises:
            SourceError: A number is not finite.
        """
        common = child(self.element, "technique_common")
        mass, moments = numbers(child(common, "mass")), numbers(child(common, "inertia"))
        weight = float(mass[0]) if len(mass) else NO_MASS.mass
        moments = moments[:3] if len(moments) >= 3 else np.full(3, 1e-7)
        if not math.isfinite(weight) or not np.isfinite(moments).all():
            raise library.error("the mass properties are not finite", self.element)
        frame = child(common, "mass_frame")
        source = library.source(self.element if frame is None else frame)
        T_world_parent = T_world_root if self.parent is None else rigid_part(self.parent.world, source)
        T_parent_mass = Pose() if frame is None else read_pose(library, frame)
        T_link_mass = T_world_link.inverse() @ T_world_parent @ T_parent_mass
        return inertial_about(weight, T_link_mass, moments)


class PhysicsScenes:
    """The physics scenes of a document.

    Attributes:
        gravity: Gravitational acceleration [m/s^2], or None.
    """

    def __init__(self, library: Library, scene: Element | None, root: Node | None) -> None:
        """Read the physics scenes instantiated by a ``<scene>``."""
        self._library = library
        self._root = root
        self._bodies: dict[Node, RigidBody] = {}
        self.gravity: Vec3 | None = None
        for instance in children(scene, "instance_physics_scene"):
            physics = library.follow(instance)
            gravity = numbers(child(physics, "technique_common", "gravity")).tolist()
            if len(gravity) == 3 and all(map(math.isfinite, gravity)):
                self.gravity = (gravity[0], gravity[1], gravity[2])
            for model in children(physics, "instance_physics_model"):
                self._read_model(model)

    def of(self, node: Node | None) -> RigidBody | None:
        """Return the rigid body of a node, or None."""
        return None if node is None else self._bodies.get(node)

    def _read_model(self, instance: Element) -> None:
        model = self._library.follow(instance)
        if model is None:
            return
        parent = self._node(instance, "parent")
        for body in children(instance, "instance_rigid_body"):
            node = self._node(body, "target")
            resolved = self._library.resolve(body.get("body") or "", model)
            if resolved is None or local_name(resolved.element) != "rigid_body":
                self._library.warn("broken-reference", f"there is no rigid body '{body.get('body')}'", body)
            elif node is not None:
                self._bodies.setdefault(node, RigidBody(resolved.element, parent))

    def _node(self, element: Element, attribute: str) -> Node | None:
        url = element.get(attribute) or ""
        return find_node(self._library, self._root, url, element) if url else None

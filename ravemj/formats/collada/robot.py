"""OpenRAVE's ``<extra>`` elements: body type, manipulators, sensors, motors and adjacent links."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from ravemj.core.transforms import Pose
from ravemj.formats.collada.extras import extras
from ravemj.formats.collada.kinematics_model import valid_name
from ravemj.formats.collada.library import Library
from ravemj.formats.collada.sensor import read_sensor
from ravemj.formats.collada.visual import read_pose
from ravemj.formats.meshes.collada.document import Element, child, children, local_name, numbers, words
from ravemj.model.builder import BodyBuilder, SensorBuilder
from ravemj.model.manipulators import ManipulatorBuilder
from ravemj.model.scene import Axis


def interface_kind(*elements: Element) -> str | None:
    """Return ``robot`` or ``kinbody``, from the first element that specifies it; None without one."""
    for element in elements:
        for _, technique in extras(element, "interface_type"):
            for interface in children(technique, "interface"):
                kind = (interface.get("type") or "".join(words(interface))).lower()
                if kind:
                    return "kinbody" if kind == "kinbody" else "robot"
    return None


@dataclass(frozen=True, slots=True)
class ExtraReader:
    """Reader of the extras of one body.

    Attributes:
        library: The documents.
        body: The body with its links and joints.
        models: Its kinematics models.
        links: Indices of its links, by their elements.
        joints: Indices of its joints, by their elements.
    """

    library: Library
    body: BodyBuilder
    models: list[Element]
    links: Mapping[Element, int]
    joints: Mapping[Element, int]

    def read(self, systems: list[Element]) -> None:
        """Read the extras of articulated systems and of the models."""
        for system in systems:
            for extra, technique in extras(system, "manipulator"):
                self._read_manipulator(extra, technique, system)
            for extra, technique in extras(system, "attach_sensor"):
                self._read_sensor(extra, technique, system)
            for _, technique in extras(system, "attach_actuator"):
                self._read_actuator(technique, system)
        for scope in (*systems, *self.models):
            for _, technique in extras(scope, "collision"):
                self._read_collision(technique, scope)

    def _link(self, element: Element, scope: Element, attribute: str = "link") -> int | None:
        """Return the index of the link that an attribute names; None, with a warning, if it does not exist."""
        path = element.get(attribute) or ""
        index = self._found(path, scope, self.links)
        if index is None:
            index = self.body.find_link(valid_name(path.rpartition("/")[2]))
        if index is None:
            self.library.warn("unknown-body", f"there is no link '{path}'", element)
        return index

    def _joint(self, element: Element, scope: Element) -> int | None:
        """Return the index of the joint that an element refers to; None, with a warning, if it does not exist."""
        path = element.get("joint") or ""
        index = self._found(path, scope, self.joints)
        if index is None:
            self.library.warn("unknown-joint", f"there is no joint '{path}'", element)
        return index

    def _found(self, path: str, scope: Element, parts: Mapping[Element, int]) -> int | None:
        """Return the index in ``parts`` of the element at a path relative to ``scope`` or a model, or None."""
        for around in (scope, *self.models):
            resolved = self.library.resolve(path, around) if path else None
            if resolved is not None and resolved.element in parts:
                return parts[resolved.element]
        return None

    def _read_manipulator(self, extra: Element, technique: Element, system: Element) -> None:
        name = extra.get("name") or f"manip{len(self.body.manipulators)}"
        built = ManipulatorBuilder(name, self.library.source(extra))
        origin, tip = child(technique, "frame_origin"), child(technique, "frame_tip")
        base = None if origin is None else self._link(origin, system)
        effector = None if tip is None else self._link(tip, system)
        if base is None or effector is None or tip is None:
            self.library.warn("no-effector", "the manipulator is left out: its first or last link is missing", extra)
            return
        built.base, built.effector = (self.body.links[index].name for index in (base, effector))
        built.T_effector_tool = read_pose(self.library, tip)
        direction = numbers(child(tip, "direction")).tolist()
        if len(direction) == 3 and all(map(math.isfinite, direction)):
            built.direction = (direction[0], direction[1], direction[2])
        for element in children(technique, "gripper_joint"):
            index = self._joint(element, system)
            if index is not None:
                built.gripper_joints.append(self.body.joints[index].name)
                built.closing_direction += self._closing(element, len(self.body.joints[index].axes))
        self.body.manipulators.append(built)

    def _closing(self, element: Element, count: int) -> list[float]:
        """Return the sign of the closing direction of each of the ``count`` axes of a gripper joint; 0 if missing."""
        directions = children(element, "chucking_direction", "closing_direction")
        signs = [self.library.number(direction) or 0.0 for direction in directions]
        return (signs + [0.0] * count)[:count]

    def _read_sensor(self, extra: Element, technique: Element, system: Element) -> None:
        origin = child(technique, "frame_origin")
        link = None if origin is None else self._link(origin, system)
        pose = Pose() if origin is None else read_pose(self.library, origin)
        self.body.sensors.append(SensorBuilder(read_sensor(self.library, extra, technique, link, pose)))

    def _read_actuator(self, technique: Element, system: Element) -> None:
        """Set a joint's torque limit, armature and friction from its motor, if the technique binds one."""
        bound, instance = child(technique, "bind_actuator"), child(technique, "instance_actuator")
        if bound is None or instance is None:
            return
        index, motor = self._joint(bound, system), self.library.follow(instance, "actuator")
        if index is not None and motor is not None:
            joint = self.body.joints[index]
            joint.axes = tuple(_driven(axis, motor) for axis in joint.axes)

    def _read_collision(self, technique: Element, scope: Element) -> None:
        for element in children(technique):
            kind = local_name(element)
            if kind == "ignore_link_pair":
                pair = [self._link(element, scope, attribute) for attribute in ("link0", "link1")]
                first, second = sorted(-1 if index is None else index for index in pair)
                if 0 <= first < second:
                    self.body.adjacent.append((first, second))
            elif kind in ("link_collision_state", "link_visible_state"):
                index = self._link(element, scope)
                if index is not None:
                    self._set_state(index, kind, self.library.truth(element, True))
            else:
                self.library.warn("ignored-tag", "OpenRAVE leaves it out unless it is asked for", element)

    def _set_state(self, index: int, kind: str, state: bool) -> None:
        link = self.body.links[index]
        if kind == "link_collision_state":
            link.enabled = state
        elif not state:
            link.geometries = [replace(part, visible=False) for part in link.geometries]


def _driven(axis: Axis, motor: Element) -> Axis:
    """Return an axis with the friction of its motor, and its torque limit and inertia converted by the gear ratio."""

    def number(name: str) -> float:
        values = numbers(child(motor, name))
        return float(values[0]) if len(values) and math.isfinite(values[0]) else 0.0

    gear = number("gear_ratio")
    torques = (number(name) * gear for name in ("max_instantaneous_torque", "nominal_torque") if number(name) > 0)
    return replace(
        axis,
        max_torque=next(torques, axis.max_torque),
        armature=number("rotor_inertia") * gear**2,
        coulomb_friction=number("coloumb_friction"),
        viscous_friction=number("viscous_friction"),
    )

"""OpenRAVE's ``<extra>`` elements: the kind of a body, manipulators, sensors, motors and adjacent links."""

import math
from collections.abc import Iterator
from dataclasses import replace

from ravemj.core.transforms import Pose
from ravemj.formats.collada.kinematics_model import ModelReader, valid_name
from ravemj.formats.collada.library import Library
from ravemj.formats.collada.motor import driven
from ravemj.formats.collada.polar import rigid_part
from ravemj.formats.collada.references import References
from ravemj.formats.collada.sensor import SensorReader
from ravemj.formats.collada.visual import transform_of
from ravemj.formats.meshes.collada.document import Element, child, children, local_name, numbers, words
from ravemj.model.builder import SensorBuilder
from ravemj.model.manipulators import ManipulatorBuilder


def extras(element: Element | None, kind: str) -> Iterator[tuple[Element, Element]]:
    """Yield the ``<extra>`` elements of a type, each with its technique of OpenRAVE's."""
    for extra in children(element, "extra"):
        if extra.get("type") == kind:
            for technique in children(extra, "technique"):
                if technique.get("profile") == "OpenRAVE":
                    yield extra, technique


def interface_kind(*elements: Element) -> str | None:
    """Return ``robot`` or ``kinbody``, as the first of some elements says it; None where none does."""
    for element in elements:
        for _, technique in extras(element, "interface_type"):
            for interface in children(technique, "interface"):
                kind = (interface.get("type") or "".join(words(interface))).lower()
                if kind:
                    return "kinbody" if kind == "kinbody" else "robot"
    return None


class ExtraReader:
    """Reads the extras of one body."""

    def __init__(self, library: Library, references: References, models: list[ModelReader]) -> None:
        self._library = library
        self._references = references
        self._models = models
        self._body = models[0].body

    def read(self, systems: list[Element]) -> None:
        """Read the extras of articulated systems, and those of the models."""
        for system in systems:
            for extra, technique in extras(system, "manipulator"):
                self._read_manipulator(extra, technique, system)
            for extra, technique in extras(system, "attach_sensor"):
                self._read_sensor(extra, technique, system)
            for _, technique in extras(system, "attach_actuator"):
                self._read_actuator(technique, system)
        for scope in (*systems, *(model.model for model in self._models)):
            for _, technique in extras(scope, "collision"):
                self._read_collision(technique, scope)

    def link(self, element: Element, scope: Element, attribute: str = "link") -> int | None:
        """Return the index of the link that an attribute names; None, with a warning, where there is none."""
        path = element.get(attribute) or ""
        for around in (scope, *(model.model for model in self._models)):
            found = self._references.resolve(path, around) if path else None
            for model in self._models:
                if found is not None and found.element in model.links:
                    return model.links[found.element]
        named = self._body.find_link(valid_name(path.rpartition("/")[2]))
        if named is None:
            self._library.warn("unknown-body", f"there is no link '{path}'", element)
        return named

    def joint(self, element: Element, scope: Element) -> int | None:
        """Return the index of the joint that an element names; None, with a warning, where there is none."""
        path = element.get("joint") or ""
        for around in (scope, *(model.model for model in self._models)):
            found = self._references.resolve(path, around) if path else None
            for model in self._models:
                if found is not None and found.element in model.joints:
                    return model.joints[found.element]
        self._library.warn("unknown-joint", f"there is no joint '{path}'", element)
        return None

    def _read_manipulator(self, extra: Element, technique: Element, system: Element) -> None:
        name = extra.get("name") or f"manip{len(self._body.manipulators)}"
        built = ManipulatorBuilder(name, self._library.source(extra))
        origin, tip = child(technique, "frame_origin"), child(technique, "frame_tip")
        base = None if origin is None else self.link(origin, system)
        effector = None if tip is None else self.link(tip, system)
        if base is None or effector is None or tip is None:
            self._library.warn("no-effector", "the manipulator is left out: its first or last link is missing", extra)
            return
        built.base, built.effector = (self._body.links[index].name for index in (base, effector))
        built.T_effector_tool = self._pose(tip)
        direction = numbers(child(tip, "direction")).tolist()
        if len(direction) == 3 and all(map(math.isfinite, direction)):
            built.direction = (direction[0], direction[1], direction[2])
        for element in children(technique, "gripper_joint"):
            index = self.joint(element, system)
            if index is not None:
                built.gripper_joints.append(self._body.joints[index].name)
                built.closing_direction += self._closing(element, len(self._body.joints[index].axes))
        self._body.manipulators.append(built)

    def _closing(self, element: Element, count: int) -> list[float]:
        """Return the signs of closing of a gripper's joint, one for each axis."""
        found = children(element, "chucking_direction", "closing_direction")
        signs = [self._references.number(direction) or 0.0 for direction in found]
        return (signs + [0.0] * count)[:count]

    def _pose(self, element: Element) -> Pose:
        return rigid_part(transform_of(self._library, element), self._library.source(element))

    def _read_sensor(self, extra: Element, technique: Element, system: Element) -> None:
        origin = child(technique, "frame_origin")
        link = None if origin is None else self.link(origin, system)
        pose = Pose() if origin is None else self._pose(origin)
        sensor = SensorReader(self._library, self._references).read(extra, technique, link, pose)
        self._body.sensors.append(SensorBuilder(sensor))

    def _read_actuator(self, technique: Element, system: Element) -> None:
        """Give a joint the torque limit and the inertia of its motor, where the file has a motor."""
        bound, instance = child(technique, "bind_actuator"), child(technique, "instance_actuator")
        if bound is None or instance is None:
            return
        index, motor = self.joint(bound, system), self._library.follow(instance, "actuator")
        if index is not None and motor is not None:
            joint = self._body.joints[index]
            joint.axes = tuple(driven(axis, motor) for axis in joint.axes)

    def _read_collision(self, technique: Element, scope: Element) -> None:
        for element in children(technique):
            kind = local_name(element)
            if kind == "ignore_link_pair":
                pair = [self.link(element, scope, attribute) for attribute in ("link0", "link1")]
                first, second = (-1 if index is None else index for index in pair)
                if first >= 0 and second >= 0 and first != second:
                    self._body.adjacent.append((min(first, second), max(first, second)))
            elif kind == "link_collision_state":
                index = self.link(element, scope)
                if index is not None:
                    self._body.links[index].enabled = self._references.truth(element, True)
            elif kind == "link_visible_state":
                self._show(element, scope)
            else:
                self._library.warn("ignored-tag", "OpenRAVE leaves it out unless it is asked for", element)

    def _show(self, element: Element, scope: Element) -> None:
        index = self.link(element, scope)
        if index is not None and not self._references.truth(element, True):
            link = self._body.links[index]
            link.geometries = [replace(part, visible=False) for part in link.geometries]

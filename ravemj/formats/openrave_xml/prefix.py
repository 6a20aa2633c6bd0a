"""Prefixing and ordering of the parts added to a body since a snapshot."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple, TypeVar

from ravemj.model.builder import BodyBuilder, SensorBuilder
from ravemj.model.manipulators import ManipulatorBuilder
from ravemj.model.mimic import Equations

Part = TypeVar("Part")


class Marks(NamedTuple):
    """A snapshot of a body's parts: their number or, if their order may change, the parts."""

    links: int = 0
    joints: int = 0
    manipulators: tuple[ManipulatorBuilder, ...] = ()
    sensors: tuple[SensorBuilder, ...] = ()

    @classmethod
    def of(cls, body: BodyBuilder) -> "Marks":
        """Take a snapshot of a body's present parts."""
        return cls(len(body.links), len(body.joints), tuple(body.manipulators), tuple(body.sensors))


def add_prefix(prefix: str, body: BodyBuilder, marks: Marks, *, whole: bool) -> None:
    """Put a prefix before the names of the parts added to a body since a snapshot.

    Args:
        prefix: The prefix.
        body: The body.
        marks: The snapshot.
        whole: Whether to rename, besides links and joints, joints in equations, manipulators and sensors as well:
            OpenRAVE does so in a Robot, and not in a KinBody (tests mimic-13, environment-07).
    """
    joints = body.joints[marks.joints :]
    renamed = {joint.name: prefix + joint.name for joint in joints if joint.name}
    body.forget_names(marks.links)
    for part in (*body.links[marks.links :], *joints):
        part.name = prefix + part.name
    if not whole:
        return
    for joint in joints:
        if joint.equations is not None:
            from ravemj.model.expressions import substitute  # noqa: PLC0415 - rarely wanted

            equations = joint.equations
            texts = (equations.position, equations.velocity, equations.acceleration)
            joint.equations = Equations(*(substitute(text, renamed) for text in texts))
    body.configurations = [
        replace(named, values=tuple((renamed.get(name, name), value) for name, value in named.values))
        for named in body.configurations
    ]
    for built in _newer(body.manipulators, marks.manipulators):
        built.name = prefix + built.name
        built.base = prefix + built.base
        built.effector = prefix + built.effector
        built.gripper_joints = [prefix + name for name in built.gripper_joints]
    older = set(map(id, marks.sensors))
    body.sensors = [
        built if id(built) in older else built._replace(sensor=replace(built.sensor, name=prefix + built.sensor.name))
        for built in body.sensors
    ]


def youngest_first(parts: list[Part], older: Sequence[Part]) -> list[Part]:
    """Return the new parts in reverse order, followed by the older ones (tests gap-44, gap-45).

    The order is kept if there are no older parts (test gap-43), and for parts of a COLLADA file (test gap-75).
    """
    return [*reversed(_newer(parts, older)), *older] if older else parts


def _newer(parts: Sequence[Part], older: Sequence[Part]) -> list[Part]:
    known = set(map(id, older))
    return [part for part in parts if id(part) not in known]

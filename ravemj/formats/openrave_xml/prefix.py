"""Prefixes of names: of the parts of a body that were made since some moment."""

from dataclasses import replace
from typing import NamedTuple

from ravemj.model.builder import BodyBuilder, SensorBuilder
from ravemj.model.manipulators import ManipulatorBuilder
from ravemj.model.mimic import Equations
from ravemj.model.scene import AttachedSensor


class Marks(NamedTuple):
    """The parts of a body at some moment: how many, or where they change their order, which."""

    links: int = 0
    joints: int = 0
    manipulators: tuple[ManipulatorBuilder, ...] = ()
    sensors: tuple[AttachedSensor, ...] = ()

    @classmethod
    def of(cls, body: BodyBuilder) -> "Marks":
        """Return the marks of the present moment."""
        sensors = tuple([built.sensor for built in body.sensors])
        return cls(len(body.links), len(body.joints), tuple(body.manipulators), sensors)


def add_prefix(prefix: str, body: BodyBuilder, marks: Marks, *, whole: bool) -> None:
    """Put a prefix before the names of the parts that a body got since some moment.

    Args:
        prefix: The prefix.
        body: The body.
        marks: That moment.
        whole: Whether to rename, beside links and joints, joints in equations, manipulators and sensors as well:
            OpenRAVE does so in a Robot, and not in a KinBody (mimic-13, environment-07).
    """
    joints = body.joints[marks.joints :]
    renamed = {joint.name: prefix + joint.name for joint in joints if joint.name}
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
    _prefix_arms_and_sensors(prefix, body, marks)


def _prefix_arms_and_sensors(prefix: str, body: BodyBuilder, marks: Marks) -> None:
    for built in body.manipulators:
        if any(built is older for older in marks.manipulators):
            continue
        built.name = prefix + built.name
        built.base = prefix + built.base
        built.effector = prefix + built.effector
        built.gripper_joints = [prefix + name for name in built.gripper_joints]
    for index, (sensor, link_name) in enumerate(body.sensors):
        if all(sensor is not older for older in marks.sensors):
            body.sensors[index] = SensorBuilder(replace(sensor, name=prefix + sensor.name), link_name)

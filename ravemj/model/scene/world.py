"""Scenes: bodies, sensors without robots, gravity, and the view."""

from dataclasses import dataclass

from ravemj.core.transforms import Pose, Vec3
from ravemj.model.scene.body import AttachedSensor, KinBody
from ravemj.model.scene.record import Record
from ravemj.model.scene.shapes import Rgb


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class View(Record):
    """View defined in a file.

    Attributes:
        background: Background colour, or None if the file has none.
        T_world_camera: Pose of the camera (z forward, y down), or None if the file has no camera.
    """

    background: Rgb | None = None
    T_world_camera: Pose | None = None


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Scene(Record):
    """Content of a file.

    Attributes:
        bodies: Bodies in document order.
        view: Background and camera, or None if the file has no ``<Environment>``.
        gravity: Gravitational acceleration [m/s^2], or None if the file has no physics engine.
        sensors: Sensors without a robot and link; ``T_link_sensor`` is their pose in the world.
        description: A text for people.
    """

    bodies: tuple[KinBody, ...] = ()
    view: View | None = None
    gravity: Vec3 | None = None
    sensors: tuple[AttachedSensor, ...] = ()
    description: str = ""

"""A scene: bodies, loose sensors, gravity, and the view."""

from dataclasses import dataclass

from ravemj.core.transforms import Pose, Vec3
from ravemj.model.scene.body import AttachedSensor, KinBody
from ravemj.model.scene.record import Record
from ravemj.model.scene.shapes import Rgb


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class View(Record):
    """The view that a file asks for.

    Attributes:
        background: Colour behind everything, or None where the file sets none.
        T_world_camera: Pose of the camera (z forward, y down), or None where the file has no camera.
    """

    background: Rgb | None = None
    T_world_camera: Pose | None = None


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Scene(Record):
    """The content of a file.

    Attributes:
        bodies: Bodies in document order.
        view: Background and camera, or None where the file has no ``<Environment>``.
        gravity: Acceleration of free fall [m/s^2], or None where the file has no physics engine.
        sensors: Sensors that no robot carries; they are on no link, and ``T_link_sensor`` is their pose in the world.
        description: A text for people.
    """

    bodies: tuple[KinBody, ...] = ()
    view: View | None = None
    gravity: Vec3 | None = None
    sensors: tuple[AttachedSensor, ...] = ()
    description: str = ""

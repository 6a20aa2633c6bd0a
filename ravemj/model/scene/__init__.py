"""The scene: frozen dataclasses with what OpenRAVE has in memory after loading, without XML and without MuJoCo.

Readers make a ``Scene`` (through ``ravemj.model.builder``), writers and the runtime read it. Lengths are metres,
angles radians, masses kilograms. Links are referred to by their index in ``KinBody.links``.
"""

from ravemj.model.scene.body import AttachedSensor, Intrinsics, KinBody, Manipulator
from ravemj.model.scene.mechanism import (
    NO_PARAMETERS,
    UNLIMITED,
    Axis,
    Inertial,
    Joint,
    JointKind,
    Link,
    Mimic,
    Parameters,
)
from ravemj.model.scene.mesh import Bounds, Mesh
from ravemj.model.scene.shapes import (
    SHAPE_TYPES,
    Box,
    CalibrationBoard,
    Capsule,
    Container,
    CrossSection,
    Cylinder,
    Geometry,
    MeshFile,
    NoShape,
    Prism,
    Rgb,
    Shape,
    ShapeType,
    Solid,
    Sphere,
    Surface,
    TriMesh,
)
from ravemj.model.scene.world import Scene, View

__all__ = [
    "NO_PARAMETERS",
    "SHAPE_TYPES",
    "UNLIMITED",
    "AttachedSensor",
    "Axis",
    "Bounds",
    "Box",
    "CalibrationBoard",
    "Capsule",
    "Container",
    "CrossSection",
    "Cylinder",
    "Geometry",
    "Inertial",
    "Intrinsics",
    "Joint",
    "JointKind",
    "KinBody",
    "Link",
    "Manipulator",
    "Mesh",
    "MeshFile",
    "Mimic",
    "NoShape",
    "Parameters",
    "Prism",
    "Rgb",
    "Scene",
    "Shape",
    "ShapeType",
    "Solid",
    "Sphere",
    "Surface",
    "TriMesh",
    "View",
]

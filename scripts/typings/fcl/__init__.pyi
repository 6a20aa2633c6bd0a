# ruff: noqa - FCL's names
"""The part of python-fcl that ravemj uses, for the type checker: its wheels carry no type information."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

class CollisionGeometry: ...

class Box(CollisionGeometry):
    def __init__(self, x: float, y: float, z: float) -> None: ...

class BVHModel(CollisionGeometry):
    def beginModel(self, num_tris_: int = 0, num_vertices_: int = 0) -> int: ...
    def addSubModel(self, verts: Floats, triangles: NDArray[np.int_]) -> int: ...
    def endModel(self) -> int: ...

class Transform:
    def __init__(self, rotation: Floats, translation: Floats) -> None: ...

class CollisionObject:
    def __init__(self, geom: CollisionGeometry, tf: Transform | None = None) -> None: ...
    def setTransform(self, tf: Transform) -> None: ...

class Contact:
    b1: int
    b2: int

class CollisionRequest:
    def __init__(self, num_max_contacts: int = 1, enable_contact: bool = False) -> None: ...

class CollisionResult:
    contacts: list[Contact]

class DistanceRequest:
    def __init__(self, enable_nearest_points: bool = False) -> None: ...

class DistanceResult:
    nearest_points: list[Floats]

def collide(o1: CollisionObject, o2: CollisionObject, request: CollisionRequest, result: CollisionResult) -> int: ...
def distance(o1: CollisionObject, o2: CollisionObject, request: DistanceRequest, result: DistanceResult) -> float: ...

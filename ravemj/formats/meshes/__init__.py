"""Readers of mesh files, which return triangles and colours, and checks of what MuJoCo can load.

``read_mesh`` reads STL, OBJ, COLLADA, Inventor and VRML itself, and PLY, OFF and glTF through trimesh, with the same
triangles, parts and colours as OpenRAVE. This package knows only meshes, not the links that they belong to.

The readers are imported on first use: most models have no meshes.
"""

import importlib
from typing import TYPE_CHECKING

from ravemj.formats.meshes.hulls import CollisionForm, area, collision_form, volume
from ravemj.formats.meshes.parts import MESH_SUFFIXES, MeshPart

if TYPE_CHECKING:
    from ravemj.formats.meshes.decomposition import decompose
    from ravemj.formats.meshes.obj import write_obj
    from ravemj.formats.meshes.reading import read_mesh

__all__ = [
    "MESH_SUFFIXES",
    "CollisionForm",
    "MeshPart",
    "area",
    "collision_form",
    "decompose",
    "read_mesh",
    "volume",
    "write_obj",
]

_MODULES = {"decompose": "decomposition", "read_mesh": "reading", "write_obj": "obj"}


def __getattr__(name: str) -> object:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_MODULES[name]}"), name)

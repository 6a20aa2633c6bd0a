"""Mesh files to triangles and colours, and triangles to what MuJoCo loads.

``read_mesh`` reads STL, OBJ, COLLADA, Inventor and VRML itself, PLY, OFF and glTF through trimesh, and gives what
OpenRAVE gives: the same triangles, parts and colours. Nothing here knows of links.
"""

from ravemj.meshes.decomposition import decompose
from ravemj.meshes.hulls import CollisionForm, area, collision_form, volume
from ravemj.meshes.obj import write_obj
from ravemj.meshes.parts import MeshPart
from ravemj.meshes.reading import MESH_SUFFIXES, read_mesh

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

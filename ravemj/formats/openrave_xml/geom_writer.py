"""Writer of ``<Geom>``, and of the mesh files beside the document."""

from typing import Literal

from ravemj.core.transforms import UNIT_WXYZ, UNMOVED, ZERO, Pose
from ravemj.errors import Diagnostics
from ravemj.formats import settled
from ravemj.formats.meshes.obj import write_obj
from ravemj.formats.meshes.parts import corners_of, weld, without_degenerate
from ravemj.formats.meshes.stl import write_stl
from ravemj.formats.openrave_xml.geom import CYLINDER_TURN, SIZE_TAGS
from ravemj.formats.xml_text import XmlText
from ravemj.model.scene import SHAPE_TYPES, Cylinder, Geometry, Mesh, TriMesh

FOLDER = "meshes"
"""Folder of the mesh files, beside the document."""

MeshFormat = Literal["stl", "obj"]

_TYPES = {kind.shape: kind.xml for kind in SHAPE_TYPES}


class GeomWriter:
    """Writes shapes and collects the files of their meshes.

    Attributes:
        files: The content of the mesh files, by name.
    """

    def __init__(self, out: XmlText, diagnostics: Diagnostics, kind: MeshFormat) -> None:
        self._out = out
        self._diagnostics = diagnostics
        self._kind = kind
        self._names: dict[Mesh, str | None] = {}
        self.files: dict[str, bytes] = {}

    def write(self, geometry: Geometry, group: str | None = None) -> None:
        """Write a shape with its pose and colours, in a geometry group if given."""
        shape = geometry.shape
        kind = _TYPES[type(shape)]
        if kind is None:
            kind = "box"
            message = f"OpenRAVE XML has no {type(shape).__name__}; a box stands for it"
            self._diagnostics.warn("not-written", message, geometry.source)
        turn = CYLINDER_TURN.inverse() if isinstance(shape, Cylinder) else UNMOVED
        attributes = {"name": geometry.name or None, "type": kind}
        attributes |= {"group": group, "render": None if geometry.visible else False}
        with self._out.inside("Geom", **attributes, modifiable=None if geometry.modifiable else False):
            write_pose(self._out, settled.pose(geometry.T_link_geometry @ turn))
            if isinstance(shape, TriMesh):
                self._write_file("data", shape.mesh)
            else:
                for size in shape.sizes():
                    value = getattr(shape, size.name)
                    numbers = [part for corner in value for part in corner] if size.name == "cross_section" else value
                    self._out.element(SIZE_TAGS.get(size.name, size.name), numbers)
            if geometry.display is not None:
                self._write_file("render", Mesh.merged(surface.mesh for surface in geometry.display))
            self._out.element("diffuseColor", geometry.diffuse)
            self._out.element("ambientColor", geometry.ambient)
            self._out.element("transparency", geometry.transparency)

    def _write_file(self, tag: str, mesh: Mesh) -> None:
        """Write the name of a mesh's file under a tag, and add the file; do nothing if the mesh has no triangles."""
        if mesh not in self._names:
            self._names[mesh] = self._added(mesh)
        name = self._names[mesh]
        if name is not None:
            self._out.element(tag, f"{FOLDER}/{name}")

    def _added(self, mesh: Mesh) -> str | None:
        """Add a mesh file, with vertices merged as by readers; return its name, or None if it has no triangles."""
        stored = weld(without_degenerate(corners_of(mesh)))
        if not len(stored.triangles):
            return None
        name = f"mesh-{stored.digest[:16]}.{self._kind}"
        self.files[name] = write_stl(stored) if self._kind == "stl" else write_obj(stored).encode()
        return name


def write_pose(out: XmlText, pose: Pose) -> None:
    """Write the elements of a pose, without identity parts."""
    if pose.position != ZERO:
        out.element("Translation", pose.position)
    if pose.wxyz != UNIT_WXYZ:
        out.element("Quat", pose.wxyz)

"""Writer of ``<geometry>`` and materials: triangles, and OpenRAVE's primitives."""

import numpy as np

from ravemj.core.transforms import Floats, Pose
from ravemj.errors import Diagnostics
from ravemj.formats import settled
from ravemj.formats.collada.extras import inside_extra
from ravemj.formats.meshes.parts import weld
from ravemj.formats.xml_text import XmlText
from ravemj.model.scene import SHAPE_TYPES, Cylinder, Geometry, Mesh, Rgb, TriMesh

_TAGS = {kind.shape: kind.collada[-1] for kind in SHAPE_TYPES if kind.collada}  # the last of two is that along z
_MESH_DECIMALS = 10  # a coordinate [m] that is all rounding becomes 0
_LEAST_OPACITY = 1e-12
"""Minimum written opacity: readers treat an opacity of 0 as a mistake."""


class GeometryWriter:
    """Writes shapes and collects their materials.

    Attributes:
        geometries: The library of geometries.
        effects: The library of effects.
        materials: The library of materials.
    """

    def __init__(self, diagnostics: Diagnostics) -> None:
        self.geometries, self.effects, self.materials = XmlText(2), XmlText(2), XmlText(2)
        self._diagnostics = diagnostics
        self._known: dict[tuple[Rgb, Rgb, float], str] = {}

    def write(self, geometry: Geometry, name: str, node: XmlText) -> None:
        """Write a shape with an id, and an instance of it in its link's node."""
        T_link_geometry = settled.pose(geometry.T_link_geometry)
        out = self.geometries
        with out.inside("geometry", id=name, name=geometry.name or None):
            _write_mesh(out, name, _stored(geometry.shape.triangulated(), T_link_geometry))
            with inside_extra(out, "geometry_info"):
                _write_info(out, geometry, T_link_geometry)
            if geometry.display is not None or not geometry.modifiable:
                with inside_extra(out):
                    out.element("modifiable", geometry.modifiable)
                    if geometry.display is not None:
                        out.element("render", url=f"#{name}_render")
        if geometry.display is not None:
            drawn = Mesh.merged(surface.mesh for surface in geometry.display)
            with out.inside("geometry", id=f"{name}_render"):
                _write_mesh(out, f"{name}_render", _stored(drawn, T_link_geometry))
        with (
            node.inside("instance_geometry", url=f"#{name}"),
            node.inside("bind_material"),
            node.inside("technique_common"),
        ):
            node.element("instance_material", symbol="material", target=f"#{self._material(geometry)}")

    def _material(self, geometry: Geometry) -> str:
        """Return the id of a geometry's material; geometries of equal colours share one."""
        colours = (geometry.diffuse, geometry.ambient, geometry.transparency)
        name = self._known.get(colours)
        if name is None:
            name = self._known[colours] = f"material{len(self._known)}"
            self._write_material(name, *colours)
        return name

    def _write_material(self, name: str, diffuse: Rgb, ambient: Rgb, transparency: float) -> None:
        with self.materials.inside("material", id=name):
            self.materials.element("instance_effect", url=f"#{name}_effect")
        out = self.effects
        with (
            out.inside("effect", id=f"{name}_effect"),
            out.inside("profile_COMMON"),
            out.inside("technique", sid="common"),
            out.inside("phong"),
        ):
            for tag, colour in (("ambient", ambient), ("diffuse", diffuse)):
                out.element_inside(tag, "color", (*colour, 1.0))
            out.element_inside("transparency", "float", max(_LEAST_OPACITY, settled.number(1.0 - transparency, 1.0)))


def _write_info(out: XmlText, geometry: Geometry, T_link_geometry: Pose) -> None:
    """Write a geometry's pose, its primitive type and sizes, and whether it is visible."""
    write_pose(out, T_link_geometry)
    tag = "cylinderz" if isinstance(geometry.shape, Cylinder) else _TAGS[type(geometry.shape)]
    with out.inside(tag):
        for size in () if isinstance(geometry.shape, TriMesh) else geometry.shape.sizes():
            value = getattr(geometry.shape, size.name)
            numbers = [part for corner in value for part in corner] if size.name == "cross_section" else value
            out.element(size.name, numbers)
    out.element_inside("visible", "bool", geometry.visible)


def _stored(mesh: Mesh, T_link_geometry: Pose) -> Mesh:
    """Return a mesh as readers will read it: in the link's frame, single precision, duplicate vertices merged."""
    vertices = mesh.vertices
    if T_link_geometry != Pose():
        vertices = mesh.moved(T_link_geometry.matrix()).vertices
    corners: Floats = np.round(vertices, _MESH_DECIMALS)[mesh.triangles]
    return weld(corners)


def _write_mesh(out: XmlText, name: str, mesh: Mesh) -> None:
    """Write a ``<mesh>`` with the triangles of a mesh; it is empty if there are none."""
    count = len(mesh.vertices)
    with out.inside("mesh"):
        if not len(mesh.triangles):
            return
        with out.inside("source", id=f"{name}_positions"):
            text = " ".join(["%.9g"] * (3 * count)) % tuple(mesh.vertices.ravel().tolist())  # exact in single precision
            out.element("float_array", text, id=f"{name}_array", count=3 * count)
            with (
                out.inside("technique_common"),
                out.inside("accessor", source=f"#{name}_array", count=count, stride=3),
            ):
                for axis in "XYZ":
                    out.element("param", name=axis, type="float")
        with out.inside("vertices", id=f"{name}_vertices"):
            out.element("input", semantic="POSITION", source=f"#{name}_positions")
        with out.inside("triangles", count=len(mesh.triangles), material="material"):
            out.element("input", semantic="VERTEX", source=f"#{name}_vertices", offset=0)
            out.element("p", " ".join(map(str, mesh.triangles.ravel().tolist())))


def write_pose(out: XmlText, T: Pose) -> None:
    """Write the transforms of a rounded pose."""
    out.element("translate", T.position)
    out.element("rotate", settled.axis_angle(T.wxyz))

"""``<visual>`` and ``<collision>``: shapes, mesh files, and materials."""

import os
from dataclasses import dataclass, field
from typing import NamedTuple

from ravemj.core.transforms import UNSCALED, Vec3, scale
from ravemj.errors import Source, SourceError
from ravemj.formats.meshes.parts import MESH_SUFFIXES, MeshPart
from ravemj.formats.openrave_xml.context import Context, did_you_mean
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.urdf.elements import (
    attribute,
    check_children,
    number_of,
    numbers_of,
    only,
    origin_of,
)
from ravemj.formats.urdf.packages import SCHEMES, Packages
from ravemj.model.scene import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Mesh,
    MeshFile,
    NoShape,
    Rgb,
    Shape,
    Sphere,
    Surface,
    TriMesh,
)

_GRAY: Rgb = (0.7, 0.7, 0.7)
"""Colour of boxes, cylinders, spheres and capsules without a material."""

_SHAPES = ("box", "sphere", "cylinder", "capsule", "mesh")
_KINDS = ("origin", "geometry", "material", "verbose", "name", "contact_coefficients", "max_contacts")


class Material(NamedTuple):
    """A colour with the element that defines it; opacity is from 0 to 1."""

    color: Rgb
    opacity: float
    source: Source


class UrdfShape(NamedTuple):
    """Shape described by a ``<geometry>``.

    Attributes:
        shape: The shape.
        parts: The parts of a mesh file, each of one colour; for another shape its triangles.
        file: The mesh file, or None.
    """

    shape: Shape
    parts: tuple[MeshPart, ...]
    file: MeshFile | None = None


@dataclass
class UrdfShapeReader:
    """Reads the shapes of one URDF.

    Attributes:
        context: Receives diagnostics, and caches meshes.
        packages: Finds mesh files.
        materials: Materials defined so far, by name.
        textures: The first texture, or None.
    """

    context: Context
    packages: Packages
    materials: dict[str, Material] = field(default_factory=lambda: {})
    textures: Source | None = None
    _meshes: dict[tuple[str, Vec3], Mesh] = field(default_factory=lambda: {})

    def define(self, element: Element) -> Material | None:
        """Read a ``<material>``, and return its own colour. Names are global; the first colour of a name is used."""
        color = only(element, "color", self.context)
        texture = only(element, "texture", self.context)
        self.textures = self.textures or (texture and texture.source)
        if color is None:
            return None
        red, green, blue, opacity = numbers_of(color, "rgba", 4)
        own = Material((red, green, blue), opacity, element.source)
        name = element.attributes.get("name", "")
        first = self.materials.setdefault(name, own) if name else own
        if first[:2] != own[:2]:
            message = (
                f"material '{name}' has another colour in line {first.source.line}, which counts in all of the file"
            )
            self.context.diagnostics.warn("material-redefined", message, element.source, "give it a name of its own")
        return first

    def visual(self, element: Element) -> tuple[Geometry, Geometry] | None:
        """Read a ``<visual>``.

        Returns:
            The drawn geometry of the link, and the shape for the link's group ``visual``; None if there is no shape.
        """
        form, material = self._form(element), self._material(element)
        if form is None:
            return None
        surfaces = tuple(
            Surface(
                part.mesh,
                part.diffuse if material is None else material.color,
                part.transparency if material is None else 1.0 - material.opacity,
            )
            for part in form.parts
        )
        T_link_geometry = origin_of(element, self.context)
        first = surfaces[0]
        drawn, shaped = (
            Geometry(
                shape=shape,
                T_link_geometry=T_link_geometry,
                name=element.attributes.get("name", ""),
                diffuse=first.diffuse,
                ambient=first.diffuse,
                transparency=first.transparency,
                visible=True,
                display=surfaces,
                render_file=form.file,
                source=element.source,
            )
            for shape in (NoShape(), form.shape)
        )
        return drawn, shaped

    def collision(self, element: Element) -> Geometry | None:
        """Read a ``<collision>``, which is not drawn; None if it has no shape."""
        form = self._form(element)
        if form is None:
            return None
        return Geometry(
            shape=form.shape,
            T_link_geometry=origin_of(element, self.context),
            name=element.attributes.get("name", ""),
            diffuse=_GRAY,
            ambient=_GRAY,
            transparency=0.0,
            visible=False,
            collision_file=form.file,
            source=element.source,
        )

    def _material(self, element: Element) -> Material | None:
        """Return the material that a ``<visual>`` defines or names; None for no material or an unknown name."""
        material = only(element, "material", self.context)
        if material is None:
            return None
        own = self.define(material)
        name = material.attributes.get("name", "")
        if own is None and name and name not in self.materials and not material.children:
            message = f"material '{name}' is not defined above; the shape keeps its own colour"
            hint = did_you_mean(name, self.materials) or "define it before the first <link>"
            self.context.diagnostics.warn("unknown-material", message, material.source, hint)
        return own or self.materials.get(name)

    def _form(self, element: Element) -> UrdfShape | None:
        check_children(element, _KINDS, self.context)
        geometry = only(element, "geometry", self.context)
        if geometry is None:
            self.context.diagnostics.error(
                "missing-geometry", f"<{element.spelled}> has no <geometry>", element.source, "it is left out"
            )
            return None
        shapes = [child for child in geometry.children if child.spelled in _SHAPES]
        check_children(geometry, _SHAPES, self.context)
        if len(shapes) != 1:
            message = f"<geometry> holds {len(shapes)} shapes and should hold one of: {', '.join(_SHAPES)}"
            self.context.diagnostics.error("missing-geometry", message, geometry.source, "the first one counts")
        return self._shape(shapes[0]) if shapes else None

    def _shape(self, element: Element) -> UrdfShape | None:
        """Return the shape of an element in ``<geometry>``; None, with a diagnostic, for an unreadable mesh."""
        if element.spelled == "mesh":
            return self._mesh(element)
        sizes = [
            size
            for name, count in (("size", 3), ("radius", 1), ("length", 1))
            if name in _SIZES[element.spelled]
            for size in numbers_of(element, name, count)
        ]
        if min(sizes) < 0:
            raise SourceError(f"<{element.spelled}> has a negative size", element.source)
        if element.spelled == "box":
            shape: Shape = Box(scale((sizes[0], sizes[1], sizes[2]), 0.5))
        elif element.spelled == "sphere":
            shape = Sphere(sizes[0])
        elif element.spelled == "cylinder":
            shape = Cylinder(sizes[0], sizes[1])
        else:
            shape = Capsule(sizes[0], sizes[1])
        return UrdfShape(shape, (MeshPart(shape.triangulated(), _GRAY, _GRAY),))

    def _mesh(self, element: Element) -> UrdfShape | None:
        uri = attribute(element, "filename")
        factors = _scale(element)
        path = self._find(uri, element.source)
        if path is None:
            return None
        if not path.lower().endswith(MESH_SUFFIXES):
            known = " ".join(MESH_SUFFIXES)
            message = f"the format of '{uri}' is not known; the shape is left out"
            self.context.diagnostics.error("unknown-mesh", message, element.source, f"known are {known}")
            return None
        parts = self.context.mesh(path, element.source, scale=factors, ros=True)
        if not parts:
            return None
        mesh = self._meshes.get((path, factors))
        if mesh is None:
            mesh = parts[0].mesh if len(parts) == 1 else Mesh.merged(part.mesh for part in parts)
            self._meshes[path, factors] = mesh
        return UrdfShape(TriMesh(mesh), parts, MeshFile(path, factors))

    def _find(self, uri: str, source: Source) -> str | None:
        """Return the path of a mesh file; None, with a diagnostic, if it is missing or must not be read."""
        package_file, diagnostics = self.packages.find(uri), self.context.diagnostics
        if package_file.path is not None:
            return package_file.path
        if package_file.is_remote:
            message = f"'{uri}' is on the network, and ravemj reads no files from there"
            diagnostics.error("refused-file", message, source, "save it beside the URDF")
        elif self.context.access.is_dropped:
            folder = os.path.basename(os.path.dirname(uri)) or "the meshes"
            message = f"the mesh '{uri}' is not with what was dropped"
            diagnostics.warn("missing-file", message, source, f"drop the folder that contains {folder}/")
        else:
            package = uri.partition("://")[2].lstrip("/").partition("/")[0]
            is_packaged = uri.partition("://")[0].lower() in SCHEMES
            places = ", ".join(package_file.searched) or "no folder of that name"
            hint = f"--package {package}=FOLDER says where it is, and so does ROS_PACKAGE_PATH" if is_packaged else ""
            message = f"there is no file '{uri}'; looked in {places}"  # not quoted, as long quotations are cut
            diagnostics.warn("missing-file", message, source, hint)
        return None


_SIZES = {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length"), "capsule": ("radius", "length")}


def _scale(element: Element) -> Vec3:
    """Return the scale factors of a mesh; a single number, which urdfdom refuses, applies to all axes."""
    text = element.attributes.get("scale", "")
    if len(text.split()) == 1:
        factor = number_of(element, "scale", 1.0)
        return (factor, factor, factor)
    if not text:
        return UNSCALED
    x, y, z = numbers_of(element, "scale", 3)
    return x, y, z

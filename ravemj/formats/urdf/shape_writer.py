"""``<visual>`` and ``<collision>`` elements of a link, and meshes as STL."""

import hashlib
from collections.abc import Callable, Iterator

from ravemj.core.transforms import Pose
from ravemj.formats.meshes.parts import corners_of, weld, without_degenerate
from ravemj.formats.meshes.stl import write_stl
from ravemj.formats.urdf.link import VISUAL_GROUP
from ravemj.formats.urdf.rpy import NOTHING, origin_attributes
from ravemj.formats.xml_text import Content, XmlText
from ravemj.model.scene import Geometry, Link, Mesh, NoShape, Rgb, Solid, Surface

FOLDER = "meshes"
"""Folder of the meshes, beside the URDF."""

_LEVEL = 2
_DECIMALS = 9


class ShapeWriter:
    """Writes shapes, and collects the files of their meshes.

    Attributes:
        meshes: Content of the mesh files, by name.
    """

    def __init__(self) -> None:
        self.meshes: dict[str, bytes] = {}
        self._materials: dict[tuple[float, ...], str] = {}

    def elements(self, link: Link, lose: Callable[[str, str], None]) -> list[XmlText]:
        """Return the visual elements of a link, then its collision elements.

        ``lose`` receives the kind of each omitted property, and a name.
        """
        groups = dict(link.groups)
        lost = [name for name in groups if name not in {VISUAL_GROUP, "spheres"}]
        if lost:
            lose(f"the group of shapes '{lost[0]}' is left out", link.name)
        drawn = groups.get(VISUAL_GROUP) or tuple(geometry for geometry in link.geometries if geometry.visible)
        visuals = [element for geometry in drawn for element in self._visuals(geometry)]
        return [*visuals, *(element for geometry in link.geometries for element in self._collisions(geometry))]

    def _visuals(self, geometry: Geometry) -> Iterator[XmlText]:
        solids = geometry.shape.solids()
        surfaces = geometry.display
        if surfaces is None:
            surfaces = (Surface(geometry.shape.triangulated(), geometry.diffuse, geometry.transparency),)
        if solids and len(surfaces) == 1:
            for solid in solids:
                yield from self._solid("visual", geometry, solid, (surfaces[0].diffuse, surfaces[0].transparency))
            return
        for surface in surfaces:
            yield from self._mesh("visual", geometry, surface.mesh, (surface.diffuse, surface.transparency))

    def _collisions(self, geometry: Geometry) -> Iterator[XmlText]:
        if isinstance(geometry.shape, NoShape):
            return
        solids = geometry.shape.solids()
        for solid in solids:
            yield from self._solid("collision", geometry, solid, None)
        if not solids:
            yield from self._mesh("collision", geometry, geometry.shape.triangulated(), None)

    def _solid(self, tag: str, geometry: Geometry, solid: Solid, look: tuple[Rgb, float] | None) -> Iterator[XmlText]:
        kind, size, centre = solid
        pose = geometry.T_link_geometry @ Pose(centre) if any(centre) else geometry.T_link_geometry
        if kind == "box":
            sizes: dict[str, Content] = {"size": tuple(2 * part for part in size)}
            yield self._element(tag, geometry, pose, "box", sizes, look)
        elif kind == "sphere":
            yield self._element(tag, geometry, pose, "sphere", {"radius": size[0]}, look)
        else:
            yield self._element(tag, geometry, pose, "cylinder", {"radius": size[0], "length": 2 * size[1]}, look)
        if kind == "capsule":  # which urdfdom does not know
            for end in (-size[1], size[1]):
                there = pose @ Pose((0.0, 0.0, end))
                yield self._element(tag, geometry, there, "sphere", {"radius": size[0]}, look)

    def _mesh(self, tag: str, geometry: Geometry, mesh: Mesh, look: tuple[Rgb, float] | None) -> Iterator[XmlText]:
        corners = without_degenerate(corners_of(mesh))
        if len(corners):
            content = write_stl(weld(corners))
            name = f"{hashlib.sha256(content).hexdigest()[:16]}.stl"
            self.meshes[name] = content
            yield self._element(tag, geometry, geometry.T_link_geometry, "mesh", {"filename": f"{FOLDER}/{name}"}, look)

    def _element(
        self,
        tag: str,
        geometry: Geometry,
        pose: Pose,
        kind: str,
        sizes: dict[str, Content],
        look: tuple[Rgb, float] | None,
    ) -> XmlText:
        out = XmlText(_LEVEL)
        with out.inside(tag, name=geometry.name or None):
            origin = origin_attributes(pose)
            if origin != {"xyz": NOTHING}:
                out.element("origin", **origin)
            with out.inside("geometry"):
                out.element(kind, **sizes)
            if look is not None:
                self._material(out, *look)
        return out

    def _material(self, out: XmlText, diffuse: Rgb, transparency: float) -> None:
        rgba = tuple(round(part, _DECIMALS) for part in (*diffuse, 1.0 - transparency))
        name = self._materials.setdefault(rgba, f"color{len(self._materials) + 1}")
        with out.inside("material", name=name):
            out.element("color", rgba=rgba)

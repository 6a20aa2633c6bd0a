"""The geoms and meshes of a geometry."""

from ravemj.core.transforms import Pose
from ravemj.errors import Diagnostics
from ravemj.formats.meshes import collision_form
from ravemj.formats.mjcf.lines import Attribute, XmlLines, attribute_text, pose_attributes
from ravemj.model.scene import Geometry, Mesh, Rgb, Solid, Surface

SMALLEST_SIZE = 1e-10
"""Minimum written size [m], since MuJoCo requires positive sizes."""


class MjcfGeomWriter:
    """Writes geoms and collects their meshes.

    Attributes:
        meshes: The meshes, by the name of their files.
        lines: The declarations of the meshes.
    """

    def __init__(self, diagnostics: Diagnostics, *, decomposed: bool = False, hull_vertices: int | None = None) -> None:
        """Start without geoms; ``hull_vertices`` limits the number of vertices of a hull."""
        self.diagnostics = diagnostics
        self.meshes: dict[str, Mesh] = {}
        self.lines = XmlLines(2)
        self._decomposed = decomposed
        self._hull_vertices = hull_vertices
        self._masks: dict[str, Attribute | None] = {}
        self._written = 0

    def write(self, geometry: Geometry, out: XmlLines, *, meets_robots: bool = True) -> tuple[int, bool]:
        """Write the geoms of a geometry; return their number, and whether one of them collides.

        Without ``meets_robots`` they collide only with geoms that have MuJoCo's default masks.
        """
        self._masks = {} if meets_robots else {"contype": 2, "conaffinity": 1}
        before = self._written
        seen = geometry.visible and geometry.display is None
        solids = geometry.shape.solids()
        for solid in solids:
            self._write_solid(geometry, solid, out, seen=seen)
        collides = bool(solids) or self._write_mesh(geometry, geometry.shape.triangulated(), out, seen=seen)
        for surface in geometry.display or () if geometry.visible else ():
            self._write_mesh_geom(geometry, surface.mesh, "visual", surface, out)
        return self._written - before, collides

    def _write_solid(self, geometry: Geometry, solid: Solid, out: XmlLines, *, seen: bool) -> None:
        kind, size, centre = solid
        legal = size
        if min(size) < SMALLEST_SIZE:
            legal = tuple(max(part, SMALLEST_SIZE) for part in size)
            message = f"MuJoCo refuses a {kind} of size {attribute_text(size)}; the MJCF has {attribute_text(legal)}"
            self.diagnostics.warn("raised-size", message, geometry.source)
        pose = geometry.T_link_geometry @ Pose(centre) if any(centre) else geometry.T_link_geometry
        self._written += 1
        out.element(
            "geom",
            geometry.source,
            **{"class": None if seen else "collision"},
            **self._masks,
            type=kind,
            size=legal,
            **pose_attributes(pose),
            rgba=rgba(geometry.diffuse, geometry.transparency),
        )

    def _write_mesh(self, geometry: Geometry, mesh: Mesh, out: XmlLines, *, seen: bool) -> bool:
        """Write a mesh for collision and, if ``seen``, display, in one geom if possible; return whether it collides."""
        hulls = self._hulls(geometry, mesh)
        both = seen and hulls == (mesh,)
        if seen:
            self._write_mesh_geom(geometry, mesh, None if both else "visual", geometry, out)
        if not both:
            for hull in hulls:
                self._write_mesh_geom(geometry, hull, "collision", geometry, out)
        return bool(hulls)

    def _hulls(self, geometry: Geometry, mesh: Mesh) -> tuple[Mesh, ...]:
        """Return meshes whose convex hulls represent a mesh in collisions; empty, with a warning, if it has none."""
        form = collision_form(mesh)
        if form == "visual":
            message = "the mesh is flat and has no convex hull; it is drawn and does not collide"
            self.diagnostics.warn("flat-mesh", message, geometry.source)
        elif form == "none" and len(mesh.triangles):
            message = "the mesh has no area, or is too large for MuJoCo; it is left out"
            self.diagnostics.warn("flat-mesh", message, geometry.source)
        if form != "hull":
            return ()
        if not self._decomposed:
            return (mesh,)
        from ravemj.formats.meshes.decomposition import decompose  # noqa: PLC0415 - rarely wanted
        from ravemj.formats.meshes.obj import as_written  # noqa: PLC0415 - most models have no meshes

        written = as_written(mesh)  # so that the pieces are the same when the model is read again
        pieces = decompose(written)
        return (mesh,) if pieces == (written,) else pieces

    def _write_mesh_geom(
        self, geometry: Geometry, mesh: Mesh, role: str | None, look: Geometry | Surface, out: XmlLines
    ) -> None:
        name = self.mesh_name(mesh)
        if name is not None:
            self._written += 1
            masks = {} if role == "visual" else self._masks
            attributes: dict[str, Attribute | None] = {"class": role, **masks, "type": "mesh", "mesh": name}
            attributes |= pose_attributes(geometry.T_link_geometry)
            out.element("geom", geometry.source, **attributes, rgba=rgba(look.diffuse, look.transparency))

    def mesh_name(self, mesh: Mesh) -> str | None:
        """Return the name of a mesh, declaring it on first use; None if MuJoCo cannot load it."""
        from ravemj.formats.meshes.obj import written_name  # noqa: PLC0415 - most models have no meshes

        if collision_form(mesh) == "none":
            return None
        name = written_name(mesh)
        file = f"{name}.obj"
        if file not in self.meshes:
            self.meshes[file] = mesh
            self.lines.element("mesh", name=name, file=file, inertia="shell", maxhullvert=self._hull_vertices)
        return name


def rgba(colour: Rgb, transparency: float) -> tuple[float, ...]:
    """Return a colour and its opacity, clamped to the range from 0 to 1."""
    rgba = (*colour, 1.0 - transparency)
    return rgba if min(rgba) >= 0.0 and max(rgba) <= 1.0 else tuple(min(max(part, 0.0), 1.0) for part in rgba)

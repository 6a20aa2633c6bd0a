"""Reader of COLLADA files as meshes: flattens the visual scene to one part per material.

As in OpenRAVE's importer, the file is scaled by its unit and rotated to y up; for a URDF it is not rotated. The reader
of COLLADA robots does neither, and shares the modules ``triangles``, ``materials`` and ``node_transforms``.
"""

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import SourceError
from ravemj.formats.limits import MOST_NODES
from ravemj.formats.meshes.collada.document import (
    ColladaDocument,
    Element,
    attribute_number,
    child,
    children,
    local_name,
)
from ravemj.formats.meshes.collada.materials import ColladaMaterial, bindings, read_material
from ravemj.formats.meshes.collada.node_transforms import local_transform
from ravemj.formats.meshes.collada.triangles import primitive_groups
from ravemj.formats.meshes.files import FileContent
from ravemj.formats.meshes.obj import GRAY, transparency
from ravemj.formats.meshes.parts import WHITE, MeshPart, check_size, rgb, welded
from ravemj.model.scene import Rgb

_AMBIENT = rgb((0.1, 0.1, 0.1))  # where the file gives other colours alone, in OpenRAVE's importer
_MAX_DEPTH = 150

_Y_UP_FROM = {
    "X_UP": np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
    "Z_UP": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
}


def read_collada(file: FileContent) -> tuple[MeshPart, ...]:
    """Read a COLLADA file: one part for each used material, in the order of the materials' ids.

    Raises:
        SourceError: The file is not well-formed XML, not COLLADA, or too large.
    """
    document = ColladaDocument(file.data, file.path)
    flattening = _Flattening(document)
    instance = child(document.root, "scene", "instance_visual_scene")
    scene = None if instance is None else document.find("visual_scene", instance.get("url"))
    if scene is not None:
        flattening.nodes(scene, _root_transform(document, turns=not file.ros), 0)
    return tuple(
        part
        for material, pieces in sorted(flattening.pieces.items())
        for part in welded(np.concatenate(pieces), file.source, *_colours(flattening.material(material)))
    )


def _colours(material: ColladaMaterial) -> tuple[Rgb, Rgb, float]:
    """Return diffuse colour, ambient colour and transparency for a material."""
    diffuse = WHITE if material.textured else rgb(material.diffuse or GRAY)
    is_bare = material == ColladaMaterial()
    ambient = rgb(material.ambient or (GRAY if is_bare else _AMBIENT))
    return diffuse, ambient, transparency(material.opacity)


def _root_transform(document: ColladaDocument, *, turns: bool) -> Floats:
    """Return the 4x4 transform from the file's units to metres and, if ``turns``, from its up axis to y."""
    asset = child(document.root, "asset")
    metres = attribute_number(child(asset, "unit"), "meter", 1.0)
    up = child(asset, "up_axis")
    name = "" if up is None else up.text or ""  # with blanks around it OpenRAVE's importer does not know it
    matrix = np.eye(4)
    matrix[:3, :3] = metres * (_Y_UP_FROM.get(name, np.eye(3)) if turns else np.eye(3))
    return matrix


class _Flattening:
    """Triangles of a visual scene in scene coordinates, collected by material id."""

    def __init__(self, document: ColladaDocument) -> None:
        self._document = document
        self._nodes_left = MOST_NODES
        self._count = 0
        self._groups: dict[Element, list[tuple[Element, Floats]]] = {}
        library = (item for each in children(document.root, "library_materials") for item in children(each, "material"))
        materials = {item.get("id", ""): read_material(document, item) for item in library}
        self._materials = {name: material for name, material in materials.items() if material is not None}
        self.pieces: dict[str, list[Floats]] = {}

    def material(self, name: str) -> ColladaMaterial:
        """Return the material of a name, or a default material if the file has none."""
        return self._materials.get(name, ColladaMaterial())

    def nodes(self, parent: Element, matrix: Floats, depth: int) -> None:
        """Collect triangles from the descendant nodes of a scene or node; ``matrix`` is the pose of ``parent``."""
        self._nodes_left -= 1
        if depth > _MAX_DEPTH or self._nodes_left < 0:
            raise SourceError("the nodes are nested too deep or repeated too often", self._document.source(parent))
        for element in children(parent):
            kind = local_name(element)
            step = local_transform(element)
            if step is not None:
                matrix = matrix @ step
            elif kind in ("instance_geometry", "instance_controller"):
                self._instance(element, matrix)
            elif kind in ("node", "instance_node"):
                node = element if kind == "node" else self._document.find("node", element.get("url"))
                if node is not None:
                    self.nodes(node, matrix, depth + 1)

    def _instance(self, instance: Element, matrix: Floats) -> None:
        geometry = self._geometry(instance)
        if geometry is None:
            return
        if geometry not in self._groups:
            self._groups[geometry] = primitive_groups(self._document, geometry)
        bound = bindings(instance)
        for element, corners in self._groups[geometry]:
            self._count += len(corners)
            check_size(self._count, self._document.source(instance))
            placed = corners @ matrix[:3, :3].T + matrix[:3, 3]
            self.pieces.setdefault(self._material_of(element.get("material", ""), bound), []).append(placed)

    def _geometry(self, instance: Element) -> Element | None:
        """Return the geometry of an instance; for a COLLADA controller (skin or morph), the undeformed geometry."""
        url = instance.get("url")
        for _ in range(10):  # controllers of controllers
            geometry = self._document.find("geometry", url)
            controller = self._document.find("controller", url)
            if geometry is not None or controller is None:
                return geometry
            deformer = next(children(controller, "skin", "morph"), None)
            url = None if deformer is None else deformer.get("source")
        return None

    def _material_of(self, symbol: str, bound: dict[str, str]) -> str:
        """Return the id of the material bound to a symbol, else of any bound material, else of the first material."""
        url = bound.get(symbol, bound[min(bound)] if bound else symbol)
        name = url.strip().removeprefix("#")
        return name if name in self._materials else min(self._materials, default="")

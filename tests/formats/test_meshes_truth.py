"""Mesh files against what OpenRAVE makes of them: the conformance suite and, where it is present, the corpus."""

import collections
import json

import numpy as np
import pytest
from agreement import CONFORMANCE, CORPUS, NEEDS_THE_CORPUS
from lxml import etree

from ravemj.errors import SourceError
from ravemj.formats.meshes import MESH_SUFFIXES, read_mesh, volume
from ravemj.formats.meshes.collada.document import ColladaDocument, attribute_number, child
from ravemj.formats.meshes.collada.triangles import primitive_groups
from ravemj.model.scene import Mesh

pytestmark = pytest.mark.usefixtures("no_cache")

CASES = CONFORMANCE / "cases"
DATA = CORPUS / "models" / "rdiankov+openrave" / "src"

(needs_corpus,) = NEEDS_THE_CORPUS


def corners(mesh: Mesh, scale=(1.0, 1.0, 1.0)):
    return (mesh.vertices * scale)[mesh.triangles]


def area(triangles):
    return (
        np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1).sum() / 2
    )


def tag(element):
    return element.tag.lower() if isinstance(element.tag, str) else ""


def differences(part, expected, scale, given):
    """Compare a part with OpenRAVE's geometry; ``given`` are the colours that the XML itself sets."""
    mesh, triangles = expected["mesh"], corners(part.mesh, scale)
    found = {
        "triangles": (len(triangles), mesh["triangles"]),
        "minimum": (triangles.min(axis=(0, 1)), mesh["bbox_min"]),
        "maximum": (triangles.max(axis=(0, 1)), mesh["bbox_max"]),
        "area": (area(triangles), mesh["area"]),
        "volume": (volume(Mesh(part.mesh.vertices * scale, part.mesh.triangles)), mesh["signed_volume"]),
    }
    for name in ("diffuse", "ambient", "transparency"):
        if not any(name in colour for colour in given):
            found[name] = (getattr(part, name), expected[name])
    return {
        name: (got, wanted)
        for name, (got, wanted) in found.items()
        if not np.all(np.abs(np.subtract(got, wanted)) <= 1e-6 * np.maximum(1, np.abs(wanted)))
    }


def reference(geometry, folders):
    """Return the file and scale of a trimesh's collision mesh, or of the render mesh if there is none."""
    texts = {tag(item): (item.text or "").split() for item in reversed(geometry)}
    for name in ("data", "collision", "render"):
        for folder in folders if texts.get(name) else []:
            if (folder / texts[name][0]).is_file():
                scale = [float(word) for word in texts[name][1:4]] or [1.0]
                return folder / texts[name][0], tuple(scale * 3 if len(scale) == 1 else [*scale, scale[0]][:3])
    return None


def references(document, expected, folders):
    """Yield file, scale, OpenRAVE's geometries and colours set in the XML for links with a single mesh file."""
    links = collections.defaultdict(list)
    for body in expected["result"]["bodies"] if expected.get("result") else []:
        for link in body.get("links", []):
            links[link["name"]].append(link)
    if any(tag(element) == "scalegeometry" for element in document.iter()):
        return
    bodies = [element for element in document.iter() if tag(element) == "body" and element.get("name")]
    for body in bodies:
        name = "".join(item.get("prefix", "") for item in reversed(list(body.iterancestors()))) + body.get("name")
        meshes = [
            item for item in body if tag(item) in ("geom", "geometry") and item.get("type", "").lower() == "trimesh"
        ]
        same = [other for other in bodies if other.get("name") == body.get("name")]
        if len(same) == 1 and len(meshes) == 1 and len(links[name]) == 1:
            found = reference(meshes[0], folders)
            geometries = [item for item in links[name][0]["geometries"] if item["type"] == "trimesh"]
            if found is not None:
                yield *found, geometries, [tag(item) for item in meshes[0]]


def corpus_references():
    for xml in sorted((CORPUS / "models").rglob("*.xml")):
        expected = CORPUS / "expected" / xml.relative_to(CORPUS / "models")
        expected = expected.with_name(expected.name + ".json")
        if expected.is_file():
            try:
                document = etree.parse(str(xml)).getroot()
            except etree.XMLSyntaxError:
                continue
            inner = [
                xml.parent / item.text.strip() for item in document.iter() if tag(item) == "modelsdir" and item.text
            ]
            yield from references(document, json.loads(expected.read_text()), [*inner, xml.parent, DATA])


@needs_corpus
def test_meshes_of_the_corpus_are_openraves():
    seen = {}
    for path, scale, geometries, given in corpus_references():
        if path not in seen:
            parts = read_mesh(str(path))
            wrong = [differences(*each, scale, given) for each in zip(parts, geometries, strict=True)]
            seen[path] = [item for item in wrong if item]
    assert {path.name: wrong for path, wrong in seen.items() if wrong} == {}
    kinds = collections.Counter(path.suffix for path in seen)
    assert kinds[".iv"] >= 17
    assert kinds[".wrl"] >= 39
    assert kinds[".stl"] >= 15


@needs_corpus
def test_every_mesh_of_the_corpus_has_triangles():
    for path in sorted((CORPUS / "models").rglob("*")):
        if path.name.lower().endswith(MESH_SUFFIXES):
            assert read_mesh(str(path)), path.name


@pytest.mark.parametrize(
    ("case", "geometry", "file", "scale", "given"),
    [
        ("geom-10-trimesh-stl-scale", 0, "wedge.stl", (1e-3, 1e-3, 1e-3), ()),
        ("geom-10-trimesh-stl-scale", 1, "wedge.stl", (1, 2, 3), ()),
        ("geom-12-trimesh-obj-quads", 0, "cube.obj", (1, 1, 1), ()),
        ("geom-13-trimesh-obj-groups", 0, "two.obj", (1, 1, 1), ("diffuse",)),
        ("geom-15-render-and-data", 0, "wedge.stl", (1, 1, 1), ()),
        ("geom-16-render-only", 0, "tetra.stl", (2, 2, 2), ()),
        ("geom-21-mesh-material", 0, "m.obj", (1, 1, 1), ()),
        ("geom-21-mesh-material", 2, "m.obj", (1, 1, 1), ("transparency",)),
        ("geom-29-modelsdir-after", 0, "wedge.stl", (1, 1, 1), ()),
        ("geom-30-mesh-transform", 0, "wedge.stl", (2, 2, 2), ()),
        ("geom-31-mesh-negative-scale", 0, "wedge.stl", (-1, 1, 1), ()),
        ("environment-17-kinbody-from-mesh-file", 0, "wedge.stl", (1, 1, 1), ()),
    ],
)
def test_meshes_of_the_conformance_cases_are_openraves(case, geometry, file, scale, given):
    expected = json.loads((CASES / case / "expected.json").read_text())
    link = expected["result"]["bodies"][0]["links"][0]
    (part,) = read_mesh(str(CASES / case / file))
    assert differences(part, link["geometries"][geometry], scale, given) == {}


@needs_corpus
def test_geometry_of_collada_robots_has_openraves_triangles():
    """The arrays alone: how many triangles, and their area, which no placement changes."""
    checked = 0
    for path in sorted((CORPUS / "models").rglob("*.dae")):
        expected = CORPUS / "expected" / path.relative_to(CORPUS / "models")
        expected = json.loads(expected.with_name(expected.name + ".json").read_text())
        document = ColladaDocument(path.read_bytes(), str(path))
        metres = attribute_number(child(document.root, "asset", "unit"), "meter", 1.0)
        ours = {(0, 0.0)}
        for geometry in document.root.iter("{*}geometry"):
            groups = primitive_groups(document, geometry, of_robots=True)
            ours |= {(len(corners), round(area(corners * metres), 6)) for _, corners in groups}
        for body in expected["result"]["bodies"]:
            for geometry in (
                item for link in body["links"] for item in link["geometries"] if item["type"] == "trimesh"
            ):
                mesh = geometry["mesh"]
                assert any(n == mesh["triangles"] and abs(a - mesh["area"]) < 2e-6 for n, a in ours), path.name
                checked += 1
    assert checked >= 30


def test_a_missing_file_says_so():
    with pytest.raises(SourceError, match=r"nowhere\.stl: error: no such mesh file"):
        read_mesh("nowhere.stl")

"""STL, OBJ and the formats that trimesh reads. Numbers that are not plain geometry were measured with assimp 5."""

import struct

import numpy as np
import pytest
import trimesh
from conftest import DATA

from ravemj.errors import SourceError
from ravemj.formats.meshes import area, read_mesh, volume
from ravemj.formats.readers import read_file

pytestmark = pytest.mark.usefixtures("no_cache")

FILES = DATA / "meshes"
WEDGE_AREA = 0.06 + 0.04 + 0.03 + 0.5 * np.sqrt(0.08**2 + 0.06**2 + 0.12**2)
GRAY = pytest.approx((0.6, 0.6, 0.6))
BOX = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"


@pytest.fixture
def read(tmp_path):
    """Write a file and read it."""

    def read(name, content):
        (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_mesh(str(tmp_path / name))

    return read


def binary_stl(*triangles, header=b"", extra=b""):
    facets = b"".join(struct.pack("<12fH", 0, 0, 0, *np.ravel(corners), 0) for corners in triangles)
    return header.ljust(80, b"\0") + struct.pack("<I", len(triangles)) + facets + extra


FACE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


@pytest.mark.parametrize(
    ("name", "diffuse", "ambient"), [("wedge.stl", 1, 0.05), ("wedge.off", 0.6, 0.6), ("wedge.ply", 1, 1)]
)
def test_a_wedge_has_the_default_colours_of_openraves_importer(name, diffuse, ambient):
    (part,) = read_mesh(str(FILES / name))
    assert len(part.mesh.triangles) == 4  # the degenerate one of the STL file is gone
    assert len(part.mesh.vertices) == 4
    assert volume(part.mesh) == pytest.approx(0.004)
    assert area(part.mesh) == pytest.approx(WEDGE_AREA)
    assert part.diffuse == pytest.approx((diffuse,) * 3)
    assert part.ambient == pytest.approx((ambient,) * 3)
    assert part.transparency == 0


def test_binary_stl(read):
    (part,) = read("MESH.STL", binary_stl(FACE, [[0, 0, 1], [0, 0, 1], [1, 0, 0]], header=b"solid but binary"))
    assert part.mesh.triangles.tolist() == [[0, 1, 2]]
    assert part.mesh.vertices.tolist() == FACE
    assert part.diffuse == (1, 1, 1)


def test_binary_stl_with_a_colour_and_more_behind(read):
    (part,) = read("mesh.stl", binary_stl(FACE, header=b"COLOR=\x7f\x00\xff\xff", extra=b"garbage"))
    assert part.diffuse == pytest.approx((127 / 255, 0, 1))
    assert read("mesh.stl", binary_stl(FACE, header=b"x" * 73 + b"COLOR=\x7f"))[0].diffuse == (1, 1, 1)


def test_bodies_of_files_without_triangles_are_reported(tmp_path):
    (tmp_path / "empty.stl").write_bytes(binary_stl())
    (found,) = read_file(tmp_path / "empty.stl").diagnostics
    assert (found.code, "there are no triangles in it" in found.message) == ("broken-mesh", True)


def test_ply_with_a_comment_in_latin_1(read):
    text = "ply\nformat ascii 1.0\ncomment caf\xe9\nelement vertex 3\n"
    text += "property float x\nproperty float y\nproperty float z\n"
    text += "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    (part,) = read("mesh.ply", text.encode("latin-1"))
    assert len(part.mesh.triangles) == 1


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (binary_stl(FACE)[:-1], "cut short"),
        (b"garbage", "neither text nor binary"),
        (b"solid\nfacet normal 0 0 1\nvertex 0 0 0\nvertex 1 0 0\n", "without three vertices"),
        (b"solid\nfacet vertex 0 0 0 vertex 1 0 0 vertex 1 x 0\n", "not a number"),
        (binary_stl([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]]), "not a finite number"),
        (b"", "empty"),
    ],
)
def test_malformed_stl(read, content, message):
    with pytest.raises(SourceError, match=message):
        read("mesh.stl", content)


def test_obj_has_one_part_for_each_material():
    blue, red = read_mesh(str(FILES / "two.obj"))
    assert (len(blue.mesh.triangles), len(red.mesh.triangles)) == (1, 3)
    assert (blue.diffuse, blue.ambient, blue.transparency) == ((0, 0, 1), (0, 0, 0), 0)
    assert red.diffuse == pytest.approx((0.9, 0.1, 0.2))
    assert red.ambient == pytest.approx((0.1, 0, 0))
    assert red.transparency == 0.25
    assert blue.mesh.vertices == pytest.approx(np.array([[0, 0, 0], [0, 0, 0.2], [0, 0.3, 0]]))


def test_obj_with_materials_that_are_nowhere(read):
    gray, other = read("mesh.obj", BOX + "mtllib none.mtl\nusemtl a\nf 1 2 3\nusemtl b c\nf 1 2 4\n")
    assert (gray.diffuse, gray.ambient, other.diffuse) == (GRAY, (0, 0, 0), GRAY)


def test_obj_without_usemtl_takes_the_last_material_as_openrave_does(read, tmp_path):
    (tmp_path / "m.mtl").write_text("newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\nd 0\nKa x y z\nTr\n")
    (part,) = read("mesh.obj", BOX + "mtllib m.mtl\nf 1 2 3\n")
    assert part.diffuse == (0, 1, 0)
    assert part.transparency == 0  # wholly invisible is a mistake of the exporter


def test_obj_polygons(read):
    (quad,) = read(
        "mesh.obj", BOX + "f 1 2 3 4\nf -1/1/1 -2//2 -3\nf 1 1 2\nf 1 2\np 1\nl 1 2\nvn 0 0 1\nvt 0 0\ng x\n"
    )
    assert (quad.diffuse, len(quad.mesh.triangles)) == (GRAY, 3)
    (dented,) = read("mesh.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 1 2 3 4 5\nf 5 1 2 3 4\n")
    assert area(dented.mesh) == pytest.approx(5)
    (weighted,) = read("mesh.obj", "v 0 0 0 2\nv 1 0 0 2\nv 1 1 0 2\nf 1 2 \\\n3\n")
    assert area(weighted.mesh) == pytest.approx(0.125)


@pytest.mark.parametrize("line", ["f 1 2 9", "f 0 1 2", "f 1 2 -9", "f 1 2 x", "v 1 2", "v 1 2 x"])
def test_malformed_obj(read, line):
    with pytest.raises(SourceError, match="malformed line") as caught:
        read("mesh.obj", f"{BOX}{line}\n")
    assert caught.value.source.line == 6


@pytest.mark.parametrize(("name", "content"), [("mesh.stl", binary_stl()), ("mesh.obj", "v 0 0 0\n")])
def test_files_without_triangles(read, name, content):
    assert read(name, content) == ()


def test_glb_materials_and_placement(read):
    scene = trimesh.Scene()
    box = trimesh.creation.box()
    box.visual = trimesh.visual.TextureVisuals(
        material=trimesh.visual.material.PBRMaterial(baseColorFactor=[51, 102, 153, 128], name="a")
    )
    scene.add_geometry(box, transform=trimesh.transformations.translation_matrix([1, 2, 3]))
    scene.add_geometry(trimesh.creation.icosphere(1))
    blue, white = read("mesh.GLB", scene.export(file_type="glb"))
    assert blue.diffuse == pytest.approx((0.2, 0.4, 0.6))
    assert blue.transparency == pytest.approx(1 - 128 / 255)
    assert blue.mesh.vertices.mean(axis=0) == pytest.approx([1, 2, 3])
    assert len(white.mesh.triangles) == 80


@pytest.mark.parametrize("name", ["mesh.ply", "mesh.off", "mesh.glb", "mesh.gltf"])
def test_malformed_files_for_trimesh(read, name):
    for content in (b"garbage", b"ply\nformat ascii 1.0\nelement vertex 9\n", b"OFF\n9 9 9\n", b"glTF" + bytes(40)):
        with pytest.raises(SourceError):
            read(name, content)


@pytest.mark.parametrize("name", ["mesh.txt", "stl", "mesh.3ds"])
def test_unknown_kinds(read, name):
    with pytest.raises(SourceError, match="no mesh format") as caught:
        read(name, "x")
    assert ".iv .wrl .vrml .stl .obj .dae" in caught.value.hint


def test_paths_that_are_no_files(tmp_path):
    (tmp_path / "folder.stl").mkdir()
    for path in (tmp_path / "folder.stl", tmp_path / "none.obj", f"{tmp_path}/\0.stl", tmp_path / ("x" * 300 + ".iv")):
        with pytest.raises(SourceError, match=r"no such mesh file|cannot read"):
            read_mesh(str(path))

"""Inventor and VRML in all dialects. Numbers that are not plain geometry were measured with Coin."""

import gzip
import struct

import numpy as np
import pytest
from conftest import DATA

from ravemj.errors import SourceError
from ravemj.formats.meshes import area, read_mesh, volume

pytestmark = pytest.mark.usefixtures("no_cache")

FILES = DATA / "meshes"
BROWN = (0.5, 0.25, 0.125)
SQUARE = "coord Coordinate { point [0 0 0, 1 0 0, 1 1 0, 0 1 0] }"
DENTED = "2 0 0, 2 2 0, 1 0.5 0, 0 2 0, 0 0 0"


@pytest.fixture
def read(tmp_path):
    """Write a file and read it."""

    def read(text, name="mesh.iv", header="#Inventor V2.1 ascii"):
        data = text if isinstance(text, bytes) else f"{header}\n{text}\n".encode("latin-1")
        (tmp_path / name).write_bytes(data)
        return read_mesh(str(tmp_path / name))

    return read


@pytest.fixture
def vrml97(read):
    return lambda text, name="mesh.wrl": read(text, name, "#VRML V2.0 utf8")


def bounds(parts):
    (part,) = parts
    return np.concatenate([part.mesh.vertices.min(axis=0), part.mesh.vertices.max(axis=0)])


def count(parts):
    return sum(len(part.mesh.triangles) for part in parts)


@pytest.mark.parametrize(
    ("name", "ambient"),
    [("prism_1.0.iv", (0.1, 0.2, 0.3)), ("prism_vrml1.wrl", (0.1, 0.2, 0.3)), ("prism_vrml97.wrl", 0.5)],
)
def test_the_same_prism_in_every_dialect(name, ambient):
    parts = read_mesh(str(FILES / name))
    mesh = parts[0].mesh
    assert len(mesh.triangles) == 8
    assert len(mesh.vertices) == 6
    assert volume(mesh) == pytest.approx(0.012, abs=1e-8)
    assert area(mesh) == pytest.approx(0.36, abs=1e-7)
    assert bounds(parts) == pytest.approx([0, 0, 0, 0.4, 0.3, 0.2], abs=1e-7)
    assert parts[0].diffuse == BROWN
    assert parts[0].ambient == pytest.approx(np.full(3, ambient))
    assert parts[0].transparency == 0


def test_transforms_change_the_state_of_a_separator():
    parts = read_mesh(str(FILES / "prism_2.1.iv"))
    # Scaled along x, turned from x to y, moved; all but the first after the last row of the matrix moved z.
    assert bounds(parts) == pytest.approx([0, 0, 0.5, 1, 1, 2], abs=1e-6)
    assert count(parts) == 8 + 2
    assert parts[0].transparency == 0.5


def test_last_material_colours_everything_and_hidden_ones_do_not_count(read):
    (part,) = read("Material { diffuseColor 1 0 0 } Cube { } Material { diffuseColor 0 1 0 } Switch { Material { } }")
    assert part.diffuse == (0, 1, 0)
    assert part.ambient == pytest.approx((0.2, 0.2, 0.2))


@pytest.mark.parametrize("node", ["LOD", "LevelOfDetail"])
def test_materials_of_other_levels_of_detail_count(read, vrml97, node):
    (part,) = read(f"Material {{ diffuseColor 1 0 0 }} {node} {{ Cube {{ }} Group {{ Material {{ }} Sphere {{ }} }} }}")
    assert part.diffuse == pytest.approx((0.8, 0.8, 0.8))
    assert len(part.mesh.triangles) == 12
    (part,) = vrml97(
        "LOD { level [ Shape { geometry Box { } } Shape { appearance Appearance { material Material { } } } ] }"
    )
    assert part.diffuse == pytest.approx((0.8, 0.8, 0.8))


def test_without_material_a_mesh_is_white(read):
    (part,) = read("Cube { }")
    assert (part.diffuse, part.ambient, part.transparency) == ((1, 1, 1), (0, 0, 0), 0)


@pytest.mark.parametrize(
    ("shape", "triangles", "content", "surface"),
    [
        ("Cube { width 1 height 2 depth 3 }", 12, 6, 22),
        ("Cylinder { radius 2 height 3 }", 76, 37.08203933604314, 62.265631172611705),
        ("Cylinder { parts SIDES }", 40, 4.120226592893682, 12.514757205083203),
        ("Cylinder { parts (SIDES | TOP) }", 58, 5.150283241117103, 15.604927149753463),
        ("Cone { bottomRadius 2 height 3 }", 38, 12.360679778681046, 34.836878019731614),
        ("Cone { parts BOTTOM }", 18, 1.0300566482234206, 3.090169944670262),
        ("Sphere { radius 2 }", 390, 32.131023357923816, 49.223925311428715),
        ("Complexity { value 0 } Sphere { }", 8, 1.3333333333333357, 6.928203331222653),
        ("Complexity { value 0.2 } Sphere { }", 48, 3.1333092963, 10.8984685946),
        ("Complexity { value 0.1 } Cone { }", 6, 1.3333333333, 8),
        ("Complexity { value 1 } Cylinder { }", 156, 6.2573785871074925, 18.81083388901639),
    ],
)
def test_round_shapes_have_coins_tessellation(read, shape, triangles, content, surface):
    (part,) = read(shape)
    assert len(part.mesh.triangles) == triangles
    assert volume(part.mesh) == pytest.approx(content, rel=1e-6)
    assert area(part.mesh) == pytest.approx(surface, rel=1e-6)


def test_a_sphere_starts_at_minus_z(read):
    assert bounds(read("Sphere { radius 2 }")) == pytest.approx([-1.98904383, -2, -2, 1.98904383, 2, 1.95629525])


@pytest.mark.parametrize(
    ("text", "box"),
    [
        ("Units { units MILLIMETERS } Separator { Units { units METERS } Cube { } } Cube { }", [-1, -1, -1, 1, 1, 1]),
        ("Units { units MILLIMETERS } Cube { } Units { units INCHES } Cube { }", np.repeat([-0.0254, 0.0254], 3)),
        ("MatrixTransform { matrix 1 0 0 0 0 2 0 0 0 0 3 0 4 5 6 1 } Cube { }", [3, 3, 3, 5, 7, 9]),
        ("RotationXYZ { axis Z angle 0.5 } Cube { width 1 }",
         [-0.91821682, -1.11729527, -1, 0.91821682, 1.11729527, 1]),
        ("Transform { translation 1 2 3 rotation 0 0 1 0.5 scaleFactor 1 2 3 scaleOrientation 1 0 0 0.3 "
         "center 1 1 1 } Cube { }",
         [-0.02586889, -1.62246323, -1.82533526, 4.00144053, 3.49552011, 4.56464195]),
        ("Rotation { rotation 0 0 2 1.5707963267948966 } Scale { scaleFactor 3 1 1 } Cube { }", [-1, -3, -1, 1, 3, 1]),
        ("Group { Translation { translation 5 0 0 } } Cube { }", [4, -1, -1, 6, 1, 1]),
        ("LOD { Translation { translation 5 0 0 } } Cube { }", [4, -1, -1, 6, 1, 1]),
        ("TransformSeparator { Translation { translation 5 0 0 } } Cube { }", [-1, -1, -1, 1, 1, 1]),
        ("Translation { translation 5 0 0 } ResetTransform { } Cube { }", [-1, -1, -1, 1, 1, 1]),
        ("Switch { whichChild -3 Cube { } Cube { height 6 } }", [-1, -3, -1, 1, 3, 1]),
        ("Switch { whichChild 1 Cube { height 9 } Cube { height 6 } }", [-1, -3, -1, 1, 3, 1]),
        ("LOD { range [ 5 ] Cube { } Cube { height 6 } } LevelOfDetail { Cube { } Cube { height 6 } }",
         [-1, -1, -1, 1, 1, 1]),
        ("Unheard { of TRUE other [ 1 2 ] Cube { } }", [-1, -1, -1, 1, 1, 1]),
        ("Translation { translation 1,0,0 ~ } DirectionalLight { on 0 } Cube { }", [0, -1, -1, 2, 1, 1]),
    ],
)  # fmt: skip
def test_state(read, text, box):
    assert bounds(read(text)) == pytest.approx(np.array(box), abs=2e-6)


@pytest.mark.parametrize(
    ("shape", "triangles", "surface"),
    [
        ("FaceSet { }", 3, 3.5),
        ("FaceSet { numVertices [ 3 ] } FaceSet { startIndex 1 numVertices -1 }", 3, 4.5),
        ("FaceSet { numVertices [ 3, 9 ] }", 1, 1),
        ("IndexedFaceSet { coordIndex [ 0 1 2 3 4 -1 ] }", 3, 3.5),
        ("IndexedFaceSet { coordIndex [ 0 1 2 -1 0 1 -1 0 1 99 -1 -2 4 ] }", 1, 1),
        ("ShapeHints { faceType UNKNOWN_FACE_TYPE } IndexedFaceSet { coordIndex [ 0 1 2 3 4 4 ] }", 3, 2.5),
        ("ShapeHints { faceType UNKNOWN_FACE_TYPE } FaceSet { numVertices [ 5 ] }", 3, 2.5),
        ("IndexedFaceSet { coordIndex 0 } IndexedLineSet { coordIndex [ 0 1 2 ] } PointSet { }", 0, 0),
        ("IndexedTriangleStripSet { coordIndex [ 0 1 2 -1 0 1 2 3 4 ] }", 4, 4.5),
        ("QuadMesh { startIndex 1 verticesPerColumn 2 verticesPerRow 2 }", 2, 2.5),
    ],
)
def test_faces(read, shape, triangles, surface):
    parts = read(f"Coordinate3 {{ point [ {DENTED} ] }} {shape}")
    assert count(parts) == triangles
    assert sum(area(part.mesh) for part in parts) == pytest.approx(surface)


def test_strips_alternate_so_that_one_side_is_outside(read):
    strip = "Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0, 1 1 0, 0 2 0 ] } TriangleStripSet { numVertices [ 5 ] }"
    (part,) = read(strip)
    a, b, c = np.moveaxis(part.mesh.vertices[part.mesh.triangles], 1, 0)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()


def test_vrml97_shapes(vrml97):
    assert bounds(vrml97("Shape { geometry Box { size 1 2 3 } }")) == pytest.approx([-0.5, -1, -1.5, 0.5, 1, 1.5])
    assert count(vrml97("Shape { geometry Cylinder { top FALSE radius 2 height 5 } }")) == 58
    assert count(vrml97("Shape { geometry Cone { side FALSE } }")) == 18
    assert count(vrml97("Shape { geometry Sphere { } }")) == 390
    assert count(vrml97(f"Shape {{ geometry IndexedFaceSet {{ {SQUARE} coordIndex [ 0 1 2 3 ] }} }}")) == 2
    assert count(vrml97("Shape { geometry IndexedFaceSet { coordIndex [ 0 1 2 3 ] } } Shape { }")) == 0
    dented = f"coord Coordinate {{ point [ {DENTED} ] }} coordIndex [ 0 1 2 3 4 -1 ]"
    (convex,) = vrml97(f"Shape {{ geometry IndexedFaceSet {{ {dented} }} }}")
    (concave,) = vrml97(f"Shape {{ geometry IndexedFaceSet {{ convex FALSE {dented} }} }}")
    assert (area(convex.mesh), area(concave.mesh)) == (3.5, 2.5)


def test_vrml97_groups(vrml97):
    box, wide = "Shape { geometry Box { } }", "Shape { geometry Box { size 6 2 2 } }"
    moved = "Transform { translation 1 0 0 scale -2 1 1 children [ DEF B Shape { geometry Box { } } ] }"
    assert bounds(vrml97(moved)) == pytest.approx([-1, -1, -1, 3, 1, 1])
    assert count(vrml97(f"{moved} Collision {{ children USE B }} Billboard {{ children [ USE B ] }}")) == 36
    assert bounds(vrml97(f"LOD {{ level [ {box} {wide} ] }}")) == pytest.approx([-1, -1, -1, 1, 1, 1])
    assert bounds(vrml97(f"Switch {{ whichChoice 1 choice [ {box} {wide} ] }}")) == pytest.approx([-3, -1, -1, 3, 1, 1])


def test_the_last_material_of_vrml97(vrml97):
    material = (
        "appearance Appearance { material Material { diffuseColor 1 0 0 ambientIntensity 0.5 transparency 0.25 } }"
    )
    (part,) = vrml97(f"Shape {{ {material} geometry Box {{ }} }} Shape {{ geometry Box {{ }} }}")
    assert (part.diffuse, part.ambient, part.transparency) == ((1, 0, 0), (0.5, 0.5, 0.5), 0.25)


def test_prototypes_are_filled_in_anew_for_each_use(vrml97):
    parts = vrml97(
        "PROTO Inner [ field SFVec3f size 1 1 1 ] { Shape { geometry Box { size IS size } } }"
        "PROTO Outer [ field SFVec3f s 2 2 2 field MFNode more [ ] ] {"
        "  Group { children [ Inner { size IS s } Group { children IS more } ] } }"
        'EXTERNPROTO Far [ field SFVec3f size ] [ "far.wrl" ]'
        "Outer { } Transform { translation 5 0 0 children Outer { s 4 1 1 more [ Inner { } ] } } Far { size 1 1 1 }"
    )
    assert count(parts) == 36
    assert bounds(parts) == pytest.approx([-1, -1, -1, 7, 1, 1])


@pytest.mark.parametrize("node", ['File { name "part.iv" }', 'WWWInline { name "part.iv" }'])
def test_included_files(read, node):
    read("Material { diffuseColor 1 0 0 } Cube { }", "part.iv")
    (part,) = read(f"Units {{ units MILLIMETERS }} {node} {node}", "whole.iv")
    assert len(part.mesh.triangles) == 24
    assert np.ptp(part.mesh.vertices) == pytest.approx(0.002)
    assert part.diffuse == (1, 1, 1)  # colours of included files do not count


def test_an_included_file_changes_the_state(read):
    read("Translation { translation 5 0 0 }", "part.iv")
    assert bounds(read('File { name "part.iv" } Cube { }')) == pytest.approx([4, -1, -1, 6, 1, 1])
    assert bounds(read('Separator { File { name "part.iv" } } Cube { }')) == pytest.approx([-1, -1, -1, 1, 1, 1])


def test_included_vrml97_takes_the_first_url_that_works(read, vrml97, caplog):
    read("Cube { }", "my part.iv")
    parts = vrml97(
        'Inline { url [ "http://example.org/x.wrl", "none.wrl", "my%20part.iv#x" ] } Inline { url "none.wrl" }'
    )
    assert count(parts) == 12
    assert "nothing to include" in caplog.text
    vrml97("Shape { appearance Appearance { material Material { diffuseColor 1 0 0 } } geometry Box { } }", "red.wrl")
    (part,) = vrml97('Inline { url "red.wrl" }')
    assert part.diffuse == (1, 0, 0)  # unlike those of a File node


def test_files_that_include_each_other_end(read):
    read('Cube { } File { name "b.iv" }', "a.iv")
    assert count(read('Sphere { } File { name "a.iv" } File { name "b.iv" }', "b.iv")) == 390 + 12


def test_compressed_files(read):
    text = b"#VRML V2.0 utf8\nShape { geometry Box { } }"
    assert count(read(gzip.compress(text), "box.wrl")) == 12
    with pytest.raises(SourceError, match=r"damaged|cut short"):
        read(gzip.compress(text)[:-9], "box.wrl")


def word(text):
    return struct.pack(">i", len(text)) + text.encode() + bytes(-len(text) % 4)


def fields(*items):
    return struct.pack(">i", len(items)) + b"".join(word(name) + value + bytes(4) for name, value in items)


@pytest.mark.parametrize("version", ["2.1", "2.0"])
def test_binary(read, version):
    def node(kind, *items, children=None):
        flags = struct.pack(">i", 0 if children is None else 2) if version == "2.1" else b""
        below = b"" if children is None else struct.pack(">i", len(children)) + b"".join(children)
        return word(kind) + flags + fields(*items) + below

    floats = lambda *numbers: struct.pack(f">{len(numbers)}f", *numbers)  # noqa: E731
    integers = lambda *numbers: struct.pack(f">{len(numbers)}i", *numbers)  # noqa: E731
    material = node(
        "Material", ("diffuseColor", integers(1) + floats(*BROWN)), ("transparency", integers(1) + floats(0.5))
    )
    points = node("VertexProperty", ("vertex", integers(4) + floats(0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0)))
    strip = node("IndexedTriangleStripSet", ("vertexProperty", points), ("coordIndex", integers(5, 0, 1, 2, 3, -1)))
    cylinder = node("Cylinder", ("parts", word("SIDES") + word("TOP") + word("")), ("radius", floats(3)))
    texture = node("Texture2", ("filename", word("a.png")), ("image", integers(1, 1, 3) + b"abc\0"))
    group = node(
        "Separator", children=[material, word("DEF") + word("S") + strip, texture, word("USE") + word("S"), cylinder]
    )
    data = f"#Inventor V{version} binary  \n".encode() + group
    (part,) = read(data)
    assert len(part.mesh.triangles) == 2 + 2 + 58
    assert (part.diffuse, part.transparency) == (BROWN, 0.5)
    assert bounds((part,)) == pytest.approx([-3, -1, -3, 3, 1, 3])
    for end in range(30, len(data), 7):
        with pytest.raises(SourceError):
            read(data[:end])


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("Cube {", 2, "the file ends inside Cube"),
        ("Separator {\n Cube { width }\n}", 3, "where a value belongs"),
        ("Separator {\n Cube { width abc }\n}", 3, "Cube.width holds something that is not a number"),
        ("\n\nTranslation { translation 1 2 }", 4, "Translation.translation needs 3 numbers"),
        ("Cube { }\n}", 3, "found '}' where a node belongs"),
        ("USE Nothing", 2, "USE of 'Nothing'"),
        ("Cube { width 1 2 ]", 2, "found ']' where a field of Cube belongs"),
        ('Info { string "no end }', 2, "a string without an end"),
        ("Units { units CUBITS }", 2, "unknown unit of length 'CUBITS'"),
        ("RotationXYZ { axis W }", 2, "X, Y or Z"),
        ("Separator { " * 101, 2, "too deep"),
        ("DEF a DEF b Cube { }", 2, "DEF of DEF"),
        ("Coordinate3 { point [ 1e300 0 0, 0 1 0, 1 1 0 ] } FaceSet { }", 0, "not a finite number"),
    ],
)
def test_errors_name_the_line(read, text, line, message):
    with pytest.raises(SourceError) as caught:
        read(text)
    assert message in caught.value.message
    assert caught.value.source.line == line


def test_a_quad_mesh_needs_its_points(read):
    with pytest.raises(SourceError, match="fewer points than it says"):
        read("Coordinate3 { point [ 0 0 0 ] } QuadMesh { verticesPerColumn 2 verticesPerRow 2 }")


def test_the_header_decides(read):
    with pytest.raises(SourceError, match="neither Inventor nor VRML"):
        read("Cube { }", header="# a file")
    with pytest.raises(SourceError, match=r"neither Inventor nor VRML|neither text nor binary"):
        read(b"#Inventor Vx binary\n")
    assert count(read("Shape { geometry Box { } }", "vrml97.iv", "#VRML V2.0 utf8")) == 12

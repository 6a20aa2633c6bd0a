"""COLLADA meshes. The expected placements, colours and merging were measured with assimp 5."""

import numpy as np
import pytest
from conftest import DATA

from ravemj.errors import SourceError
from ravemj.formats.meshes import area, read_mesh
from ravemj.formats.meshes.collada.document import ColladaDocument
from ravemj.formats.meshes.collada.materials import read_material
from ravemj.formats.meshes.collada.triangles import primitive_groups

pytestmark = pytest.mark.usefixtures("no_cache")

FILES = DATA / "meshes"
GRAY = pytest.approx((0.6, 0.6, 0.6))
MESH = """<mesh><source id="p"><float_array id="pa">0 0 0 1 0 0 1 1 0 0 1 0 0 0 1</float_array><technique_common>
<accessor source="#pa" count="5" stride="3"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>%s</mesh>"""
INPUT = '<input semantic="VERTEX" source="#v" offset="0"/>'
NODE = '<node><instance_geometry url="#g"/></node>'
MATERIALS = {"mb": "0 0 1", "ma": "1 0 0", "mc": "0 1 0"}


def triangles(indices, symbol=""):
    return f'<triangles material="{symbol}">{INPUT}<p>{indices}</p></triangles>'


def phong(inner):
    return f"<phong>{inner}</phong>"


def amount(transparency):
    return f"<transparency><float>{transparency}</float></transparency>"


def effects(shaders):
    """Return libraries of materials and their effects."""
    fx = "".join(
        f'<effect id="{name}-fx"><profile_COMMON><technique>{shader}</technique></profile_COMMON></effect>'
        for name, shader in shaders.items()
    )
    items = "".join(f'<material id="{name}"><instance_effect url="#{name}-fx"/></material>' for name in shaders)
    return f"<library_effects>{fx}</library_effects><library_materials>{items}</library_materials>"


COLOURED = effects({name: phong(f"<diffuse><color>{colour} 1</color></diffuse>") for name, colour in MATERIALS.items()})


def bound(*pairs):
    items = "".join(f'<instance_material symbol="{symbol}" target="#{target}"/>' for symbol, target in pairs)
    binding = f"<bind_material><technique_common>{items}</technique_common></bind_material>"
    return f'<node><instance_geometry url="#g">{binding}</instance_geometry></node>'


@pytest.fixture
def read(tmp_path):
    """Write a document and read it."""

    def read(primitives=None, nodes=NODE, extra="", asset="", mesh=MESH):
        primitives = triangles("0 1 4") if primitives is None else primitives
        (tmp_path / "mesh.dae").write_text(
            f'<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema"><asset>{asset}</asset>{extra}'
            f'<library_geometries><geometry id="g">{mesh % primitives}</geometry></library_geometries>'
            f'<library_visual_scenes><visual_scene id="s">{nodes}</visual_scene></library_visual_scenes>'
            '<scene><instance_visual_scene url="#s"/></scene></COLLADA>'
        )
        return read_mesh(str(tmp_path / "mesh.dae"))

    return read


def box(parts):
    points = np.concatenate([part.mesh.vertices for part in parts])
    return np.concatenate([points.min(axis=0), points.max(axis=0)])


def test_a_prism_with_two_materials():
    blue, red = read_mesh(str(FILES / "prism.dae"))
    assert (len(blue.mesh.triangles), len(red.mesh.triangles)) == (6, 2)
    assert blue.diffuse == (0, 0, 1)
    assert blue.ambient == pytest.approx((0.1, 0.1, 0.1))  # the importer's default
    assert (red.diffuse, red.ambient, red.transparency) == ((1, 0, 0), pytest.approx((0.1, 0.2, 0.3)), 0.25)
    assert area(blue.mesh) + area(red.mesh) == pytest.approx(0.36)
    assert box([blue, red]) == pytest.approx([0.7, 0, -0.4, 1, 0.2, 0], abs=1e-7)  # centimetres, turned to y up


@pytest.mark.parametrize(
    ("asset", "expected"),
    [
        ("<up_axis>Z_UP</up_axis>", [0, 0, 0, 1, 1, 0]),
        ("<up_axis>Y_UP</up_axis>", [0, 0, 0, 1, 0, 1]),
        ("<up_axis> Z_UP </up_axis>", [0, 0, 0, 1, 0, 1]),  # not known so to OpenRAVE's importer
        ("<up_axis>X_UP</up_axis>", [0, 0, 0, 0, 1, 1]),
        ("", [0, 0, 0, 1, 0, 1]),
        ('<unit meter="0.01"/>', [0, 0, 0, 0.01, 0, 0.01]),
        ('<unit meter="x"/>', [0, 0, 0, 1, 0, 1]),
        ("<unit/>", [0, 0, 0, 1, 0, 1]),
    ],
)
def test_units_and_axes(read, asset, expected):
    assert box(read(asset=asset)) == pytest.approx(expected)


def test_one_part_for_each_material_in_the_order_of_ids(read):
    primitives = triangles("0 1 4", "A") + triangles("0 1 2", "B") + triangles("0 2 3", "A")
    red, blue = read(primitives, bound(("A", "mb"), ("B", "ma")), COLOURED)
    assert (red.diffuse, len(red.mesh.triangles)) == ((1, 0, 0), 1)
    assert (blue.diffuse, len(blue.mesh.triangles)) == ((0, 0, 1), 2)


def test_materials_that_are_not_bound(read):
    by_name = read(triangles("0 1 4", "mc") + triangles("0 1 2", "zz"), NODE, COLOURED)
    assert [part.diffuse for part in by_name] == [(1, 0, 0), (0, 1, 0)]  # the first of all, and the one of that name
    (any_bound,) = read(triangles("0 1 4", "A") + triangles("0 1 2", "zz"), bound(("B", "mc"), ("A", "mb")), COLOURED)
    assert any_bound.diffuse == (0, 0, 1)
    (missing,) = read(triangles("0 1 4", "A"), bound(("A", "nowhere")), COLOURED)
    assert missing.diffuse == (1, 0, 0)
    (none,) = read(triangles("0 1 4", "A"))
    assert none.diffuse == GRAY


@pytest.mark.parametrize(
    ("shader", "transparency"),
    [
        (phong(amount(0.3)), 0.7),
        (phong(amount(1)), 0),
        (phong(amount(0)), 0),
        (phong("<transparent><color>1 1 1 0.5</color></transparent>"), 0.5),
        (phong('<transparent opaque="A_ZERO"><color>1 1 1 0.5</color></transparent>' + amount(0.2)), 0.1),
        (phong('<transparent opaque="RGB_ZERO"><color>1 0 0 1</color></transparent>' + amount(0.5)), 0.1063355),
        (phong('<transparent opaque="RGB_ONE"><color>.5 .5 .5 1</color></transparent>'), 0.5),
        (phong(amount(7)), 0),
        (phong("<transparency><param ref='t'/></transparency>"), 0),
        ("<constant><emission><color>1 0 0 1</color></emission></constant>", 0),
        ("", 0),
    ],
)  # fmt: skip
def test_transparency(read, shader, transparency):
    (part,) = read(triangles("0 1 4", "A"), bound(("A", "m")), effects({"m": shader}))
    assert part.transparency == pytest.approx(transparency, abs=1e-6)
    assert part.diffuse == GRAY


def test_a_texture_is_white(read):
    shader = '<lambert><diffuse><texture texture="t" texcoord="c"/></diffuse></lambert>'
    (part,) = read(triangles("0 1 4", "A"), bound(("A", "m")), effects({"m": shader}))
    assert part.diffuse == (1, 1, 1)


def test_raw_materials_keep_what_the_file_says():
    text = effects({"m": phong("<transparency><float>0</float></transparency>")})
    document = ColladaDocument(f"<COLLADA>{text}</COLLADA>".encode(), "x.dae")
    material = read_material(document, document.find("material", "#m"))
    assert (material.transparency, material.diffuse, material.opacity) == (0, None, 0)
    text = text.replace("<float>0</float>", '<param ref="t"/>').replace(
        "<technique>", '<newparam sid="t"><float>0.5</float></newparam><technique>'
    )
    document = ColladaDocument(f"<COLLADA>{text}</COLLADA>".encode(), "x.dae")
    assert read_material(document, document.find("material", "#m")).transparency == 0.5


@pytest.mark.parametrize(
    ("nodes", "expected"),
    [
        ("<node><translate>1 0 0</translate><rotate>0 0 1 90</rotate><scale>2 1 1</scale>"
         "<node><matrix>1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1</matrix>%s</node></node>", [-5, 10, 7, -5, 12, 8]),
        ("<node><lookat>0 0 0 0 0 -1 0 1 0</lookat>%s</node>", [0, 0, 0, 1, 0, 1]),
        ("<node><lookat>0 0 0 0 0 1 0 1 0</lookat>%s</node>", [-1, 0, -1, 0, 0, 0]),
        ("<node><translate>1 2</translate><skew>1 1 1 1 1 1 1</skew><translate>0 0 3</translate>%s</node>",
         [0, 0, 3, 1, 0, 4]),
        ("<node id='n'><translate>0 0 5</translate>%s</node>"
         "<node><translate>1 0 0</translate><instance_node url='#n'/></node>", [0, 0, 5, 2, 0, 6]),
        ("<node><scale>-1 1 1</scale>%s<instance_geometry url='#none'/><instance_node url='#none'/></node>",
         [-1, 0, 0, 0, 0, 1]),
    ],
)  # fmt: skip
def test_nodes(read, nodes, expected):
    parts = read(nodes=nodes % '<instance_geometry url="#g"/>')
    assert box(parts) == pytest.approx(expected, abs=1e-6)


def test_a_controller_shows_the_shape_that_it_deforms(read):
    controller = '<controller id="c"><skin source="#g"><bind_shape_matrix/></skin></controller>'
    parts = read(nodes='<node><instance_controller url="#c"/></node>', extra=controller)
    assert box(parts) == pytest.approx([0, 0, 0, 1, 0, 1])


@pytest.mark.parametrize(
    ("primitives", "count", "surface"),
    [
        ("<polylist><input semantic='NORMAL' source='#p' offset='0'/><input semantic='VERTEX' source='#v' offset='1'/>"
         "<vcount>4 3</vcount><p>0 0 0 1 0 2 0 3 0 0 0 1 0 4</p></polylist>", 3, 1.5),
        (f"<polygons>{INPUT}<p>0 1 2 3</p><ph><p>0 1 4</p><h>0 1 2</h></ph></polygons>", 3, 1.5),
        (f"<tristrips>{INPUT}<p>0 1 3 2</p><p>0 1 4</p></tristrips>", 3, 1.5),
        (f"<trifans>{INPUT}<p>0 1 2 3</p></trifans>", 2, 1),
        (f"<lines>{INPUT}<p>0 1</p></lines>", 0, 0),
        (triangles("0 1 1 0 1 2 0 0 0 3"), 1, 0.5),
        (triangles("0 1 99 0 1 2 0 1 -1"), 1, 0.5),
        (triangles("0 1 x 0 1 2"), 1, 0.5),
        (f"<polylist>{INPUT}<vcount>3 99</vcount><p>0 1 2 3 4</p></polylist>", 1, 0.5),
        ("<triangles><p>0 1 2</p></triangles><triangles/>", 1, 0.5),
    ],
)  # fmt: skip
def test_primitives(read, primitives, count, surface):
    parts = read(primitives)
    assert sum(len(part.mesh.triangles) for part in parts) == count
    assert sum(area(part.mesh) for part in parts) == pytest.approx(surface)


def test_sources_with_other_strides_and_broken_numbers(read):
    mesh = MESH.replace('stride="3"', 'stride="4" offset="1"').replace(
        "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1", "9 0 0 0 9 1 0 0 9 1 1? 0 9 0 1e 0 9"
    )
    assert box(read(triangles("0 1 2"), mesh=mesh)) == pytest.approx([0, 0, 0, 1, 1, 0])
    named = MESH.replace("/></technique", "><param name='Z'/><param name='Y'/><param name='X'/></accessor></technique")
    assert box(read(mesh=named)) == pytest.approx([0, 0, 0, 1, 0, 1])
    assert box(read(triangles("0 1 2"), mesh=named)) == pytest.approx([0, 0, 0, 0, 1, 1])


def test_groups_of_a_geometry_for_robots():
    dented = MESH.replace("0 0 0 1 0 0 1 1 0 0 1 0 0 0 1", "0 0 0 2 0 0 2 2 0 1 0.5 0 0 2 0")
    five = f'<polylist material="m">{INPUT}<vcount>5</vcount><p>0 1 2 3 4</p></polylist>'
    text = f"<COLLADA><geometry id='a'>{dented % (five + five)}</geometry><geometry id='b'/><effect id='a'/></COLLADA>"
    document = ColladaDocument(text.encode(), "x.dae")
    (first, _), (_, corners) = primitive_groups(document, document.find("geometry", "#a"))
    assert (first.get("material"), len(corners)) == ("m", 3)
    ((_, fan), *_) = primitive_groups(document, document.find("geometry", "a"), of_robots=True)
    assert fan[:, 0].tolist() == [[2, 0, 0]] * 3 or fan[:, 0].tolist() == [[0, 0, 0]] * 3
    assert primitive_groups(document, document.find("geometry", "#b")) == []


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("<COLLADA>\n<asset>\n</COLLADA>", 3, "not well-formed"),
        ("", 0, "empty"),
        ("plain text", 1, "not well-formed"),
        ("<Robot/>", 1, "not COLLADA"),
        ('<!DOCTYPE a [<!ENTITY b "c">]>\n<COLLADA>&d;</COLLADA>', 2, "not well-formed"),
    ],
)
def test_malformed(tmp_path, text, line, message):
    path = tmp_path / "mesh.dae"
    path.write_text(text)
    with pytest.raises(SourceError, match=message) as caught:
        read_mesh(str(path))
    assert caught.value.source.line == line


def test_without_a_scene_there_is_nothing(tmp_path):
    path = tmp_path / "mesh.dae"
    path.write_text("<COLLADA/>")
    assert read_mesh(str(path)) == ()

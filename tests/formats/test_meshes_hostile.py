"""Files that mean harm, or were merely damaged: a SourceError and nothing else, after little work."""

import gzip
import warnings

import numpy as np
import pytest
from conftest import DATA
from hypothesis import given
from hypothesis import strategies as st
from strategies import examples
from waiting import time_limit

from ravemj.errors import SourceError
from ravemj.formats.meshes import MESH_SUFFIXES, read_mesh
from ravemj.formats.meshes.files import FileContent
from ravemj.formats.meshes.reading import read_content, reader_of

pytestmark = pytest.mark.usefixtures("no_cache")

FILES = DATA / "meshes"
SAMPLES = {path.name: path.read_bytes() for path in sorted(FILES.iterdir()) if path.suffix in MESH_SUFFIXES}
TRIMESH = (".off", ".ply")
_TEXT = (
    '{ } [ ] ( ) | " # , -1 0 1 3 1e999 -1e308 nan 99999999999999999999 0x10 . TRUE NULL DEF USE IS PROTO ROUTE x '
    "Separator FaceSet Switch Transform vertex facet f v usemtl <p> </p> <node> <!-- </COLLADA> #p end_header"
)
WORDS = [*_TEXT.encode().split(), b"\0", b"\xff", b"\n", b"-" * 50, b"9" * 5000]


@pytest.fixture
def refused(tmp_path):
    """Write a file; reading it has to fail, after little work."""

    def refused(name, text, match="."):
        (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        with time_limit(), pytest.raises(SourceError, match=match):
            read_mesh(str(tmp_path / name))

    return refused


def outcome(read):
    """Return what is read; nothing where it is refused."""
    try:
        return read()
    except SourceError:
        return ()


def survives(name, data):
    """Read damaged data: parts that can be used, or a SourceError."""
    suffix = "." + name.rpartition(".")[2]
    with warnings.catch_warnings():
        if suffix in TRIMESH:
            warnings.simplefilter("ignore")
        parts = outcome(lambda: read_content(FileContent(str(FILES / name), data), reader_of(suffix))[0])
    for part in parts:
        assert len(part.mesh.triangles)
        assert part.mesh.triangles.min() >= 0
        assert part.mesh.triangles.max() < len(part.mesh.vertices)
        assert np.isfinite([*part.mesh.vertices.ravel(), *part.diffuse, *part.ambient, part.transparency]).all()


def damaged(name, edits):
    data = bytearray(SAMPLES[name])
    for place, length, new in edits:
        at = int(place * len(data))
        data[at : at + length] = new
    survives(name, bytes(data))


calm = examples(60)
PLACES = st.floats(0, 1, exclude_max=True)


@pytest.mark.parametrize("name", SAMPLES)
@calm
@given(edits=st.lists(st.tuples(PLACES, st.integers(0, 5), st.binary(max_size=3)), min_size=1, max_size=4))
def test_damaged_bytes(name, edits):
    damaged(name, edits)


@pytest.mark.parametrize("name", SAMPLES)
@calm
@given(swaps=st.lists(st.tuples(PLACES, st.sampled_from(WORDS)), min_size=1, max_size=3))
def test_damaged_words(name, swaps):
    words = SAMPLES[name].replace(b"\n", b" \n ").split(b" ")
    for place, word in swaps:
        words[int(place * len(words))] = word
    survives(name, b" ".join(words))


@pytest.mark.parametrize("name", SAMPLES)
def test_every_beginning_of_a_file(name):
    for end in range(1, len(SAMPLES[name]), 37):
        survives(name, SAMPLES[name][:end])


@calm
@given(st.binary(max_size=200))
def test_binary_inventor_of_noise(noise):
    survives("x.iv", b"#Inventor V2.1 binary  \n\0\0\0\x09Separator\0\0\0" + noise)


@calm
@given(st.lists(st.sampled_from([*WORDS, b"Cube", b"width", b"coordIndex", b"Coordinate3", b"point", b"[ 0 0 0 ]"])))
@pytest.mark.parametrize("header", [b"#Inventor V2.1 ascii", b"#VRML V2.0 utf8"])
def test_text_of_random_words(header, words):
    survives("x.iv", b" ".join([header, b"\n", *words]))


def test_compressed_bombs(refused, monkeypatch):
    refused("bomb.wrl", gzip.compress(b"#VRML V2.0 utf8\n" + b" " * (2 << 20)), "over 200 times its own")
    monkeypatch.setenv("RAVEMJ_MOST_BYTES", "10000")
    refused("bomb.wrl", gzip.compress(b"#VRML V2.0 utf8\n" + b" " * 10_000), "it unpacks to 10,001 bytes or more")


def test_files_that_are_too_large(refused, monkeypatch):
    monkeypatch.setenv("RAVEMJ_MOST_BYTES", "1000")
    refused("large.stl", bytes(1001), "1,001 bytes or more, and 1,000 are read")


@pytest.mark.stress
def test_repeated_nodes(refused):
    doubling = "\n".join(f"DEF n{k} Group {{ USE n{k - 1} USE n{k - 1} }}" for k in range(1, 40))
    refused("use.iv", f"#Inventor V2.1 ascii\nDEF n0 Info {{ }}\n{doubling}", "repeated too often")
    refused(
        "cubes.iv",
        f"#Inventor V2.1 ascii\nComplexity {{ value 1 }} DEF n0 Sphere {{ }}\n{doubling}",
        "triangles|too often",
    )
    faces = (
        "Coordinate3 { point [" + "0 0 0 " * 999 + "] } DEF n0 IndexedFaceSet { coordIndex [" + "-1 7 " * 99999 + "] }"
    )
    refused("faces.iv", f"#Inventor V2.1 ascii\n{faces}\n{doubling}", "corners of polygons")


@pytest.mark.stress
def test_repeated_prototypes(refused):
    text = "PROTO P0 [ ] { Shape { } }" + "".join(
        f"PROTO P{k} [ ] {{ Group {{ children [ P{k - 1} {{ }} P{k - 1} {{ }} ] }} }}" for k in range(1, 40)
    )
    refused("proto.wrl", f"#VRML V2.0 utf8\n{text}\nP39 {{ }}", "too many nodes")


@pytest.mark.stress
def test_repeated_files(tmp_path, refused):
    for number in range(40):
        inner = f'Inline {{ url "{number - 1}.wrl" }} ' * 2 if number else "Shape { geometry Box { } }"
        (tmp_path / f"{number}.wrl").write_text(f"#VRML V2.0 utf8\n{inner}")
    refused(
        "all.wrl", '#VRML V2.0 utf8\nInline { url "39.wrl" } ' * 3 + "Shape { geometry Box { } }", "too often|triangles"
    )


@pytest.mark.stress
def test_repeated_collada_nodes(refused):
    nodes = "".join(
        f'<node id="n{k}"><instance_node url="#n{k - 1}"/><instance_node url="#n{k - 1}"/></node>' for k in range(1, 40)
    )
    scene = '<scene><instance_visual_scene url="#s"/></scene>'
    visual = '<visual_scene id="s"><node><instance_node url="#n39"/></node></visual_scene>'
    refused("nodes.dae", f"<COLLADA><node id='n0'/>{nodes}{visual}{scene}</COLLADA>", "repeated too often")
    cycle = f"<COLLADA><node id='n39'><instance_node url='#n39'/></node>{visual}{scene}</COLLADA>"
    refused("cycle.dae", cycle, "nested too deep")


def test_deep_nesting(refused, tmp_path):
    refused("deep.iv", "#Inventor V2.1 ascii\n" + "Separator { " * 50_000, "too deep")
    refused("deep.wrl", "#VRML V2.0 utf8\n" + "Group { children [ " * 50_000, "too deep")
    refused("proto.wrl", "#VRML V2.0 utf8\n" + "PROTO P [ ] { " * 50_000, "too deep")
    chain = "".join(f"DEF n{k} Group {{ USE n{k - 1} }} " for k in range(1, 500))
    refused("chain.iv", f"#Inventor V2.1 ascii\nDEF n0 Cube {{ }} {chain}", "too deep")
    refused("deep.dae", "<COLLADA>" + "<node>" * 50_000)


def test_entities_are_not_expanded(tmp_path):
    laughs = "".join(f'<!ENTITY l{k} "{f"&l{k - 1};" * 10}">' for k in range(1, 12))
    laughs += '<!ENTITY l0 "ha"><!ENTITY f SYSTEM "file:///etc/hostname">'
    (tmp_path / "laugh.dae").write_text(f"<!DOCTYPE COLLADA [{laughs}]><COLLADA>&l11;&f;</COLLADA>")
    assert outcome(lambda: read_mesh(str(tmp_path / "laugh.dae"))) == ()  # some versions of libxml2 refuse it


@pytest.mark.parametrize("suffix", [".ply", ".off"])
def test_counts_beyond_all_memory(refused, suffix):
    huge = 10**15
    content = {
        ".ply": "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {huge}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {huge}\nproperty list uchar int vertex_indices\nend_header\nabc",
        ".off": f"OFF\n{huge} {huge} 0\n0 0 0\n",
    }[suffix]
    refused("huge" + suffix, content)


@pytest.mark.stress
def test_many_corners_are_cut_in_time(tmp_path):
    rng = np.random.default_rng(0)
    points = "".join(f"v {x:.3f} {y:.3f} {z:.3f}\n" for x, y, z in rng.normal(size=(5000, 3)))
    faces = "".join("f " + " ".join(map(str, rng.integers(1, 5001, 400))) + "\n" for _ in range(8))
    (tmp_path / "tangle.obj").write_text(points + faces)
    with time_limit():
        assert read_mesh(str(tmp_path / "tangle.obj"))

"""Models read no files that they must not read, in whatever format and spelling they name them."""

import functools
import json
import os
import re
import struct
import sys
import warnings
import zipfile
from xml.sax.saxutils import quoteattr

import pytest
from conftest import DATA
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import examples

import ravemj
from ravemj.cli.checking import check
from ravemj.errors import RavemjWarning
from ravemj.formats.file_access import FileAccess
from ravemj.formats.meshes import read_mesh

pytestmark = pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")

OBJ = "mtllib {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl secret\nf 1 2 3\n"
FACES = "Coordinate{0} {{ point [0 0 0, 1 0 0, 0 1 0] }} IndexedFaceSet {{ coordIndex [0, 1, 2, -1] }}"
OLD = FACES.format("3")
VRML97 = (
    "Shape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 0 1 0] } coordIndex [0, 1, 2, -1] } }"
)
STL = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"
BODY = '<KinBody name="k"><Body name="b"><Geom type="box"><extents>1 1 1</extents></Geom></Body></KinBody>'
SECRETS = {
    "s.xml": BODY,
    "s.env.xml": f"<Environment>{BODY}</Environment>",
    "s.robot.xml": f'<Robot name="r">{BODY}</Robot>',
    "s.body.xml": '<Body name="b"><Geom type="box"><extents>1 1 1</extents></Geom></Body>',
    "s.sensor.xml": '<Sensor type="BaseLaser2D" name="eye"/>',
    "s.stl": STL,
    "s.mtl": "newmtl secret\nKd 0.25 0.5 0.75\n",
    "s.iv": f"#Inventor V2.1 ascii\n{OLD}",
    "s.wrl": f"#VRML V2.0 utf8\n{VRML97}",
    "s.arm.dae": (DATA / "collada" / "arm.dae").read_text(),
    "s.dae": (DATA / "collada" / "shapes.dae").read_text(),
    "s.bin": "".join(map(chr, range(65, 101))),
}
"""The files outside: each one its reader would read."""


def gltf(name):
    """Return glTF whose vertices are the bytes of a file, and its indices."""
    indices = "data:application/octet-stream;base64,AAAAAAEAAAACAAAA"
    return {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": name, "byteLength": 36}, {"uri": indices, "byteLength": 12}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 1, "byteLength": 12}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5125, "count": 3, "type": "SCALAR"},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
    }


def glb(tree):
    """Return GLB with the buffers of glTF behind its own."""
    tree["buffers"].insert(0, {"byteLength": 4})
    for view in tree["bufferViews"]:
        view["buffer"] += 1
    content = json.dumps(tree).encode()
    content += b" " * (-len(content) % 4)
    chunks = struct.pack("<II", len(content), 0x4E4F534A) + content + struct.pack("<II", 4, 0x004E4942) + b"\0" * 4
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def binary_inventor(name):
    def word(text):
        return struct.pack(">I", len(text)) + text + b"\0" * (-len(text) % 4)

    name = name.encode()
    return (
        b"#Inventor V2.1 binary\n" + word(b"File") + struct.pack(">II", 0, 1) + word(b"name") + word(name) + b"\0" * 4
    )


def geom(tag):
    body = '<KinBody name="k"><Body name="b">\n<Geom type="trimesh"><{0}>{1}</{0}></Geom></Body></KinBody>'
    return lambda name: body.format(tag, quoteattr(name)[1:-1])


def element(text):
    return lambda name: text.format(quoteattr(name))


def string(text):
    return lambda name: text % json.dumps(name, ensure_ascii=False)


PAIR = (DATA / "collada" / "pair.dae").read_text()

MODELS = {
    "environment": ("a.xml", "s.env.xml", element("<Environment file={}/>")),
    "body": ("a.xml", "s.xml", element('<Environment><KinBody name="k" file={}/></Environment>')),
    "robot": ("a.xml", "s.robot.xml", element('<Environment><Robot name="r" file={}/></Environment>')),
    "nested": ("a.xml", "s.xml", element('<Robot name="r"><KinBody file={}/></Robot>')),
    "link": ("a.xml", "s.body.xml", element('<KinBody name="k"><Body name="b" file={}/></KinBody>')),
    "sensor": ("a.xml", "s.sensor.xml", element('<Environment><Sensor name="eye" file={}/></Environment>')),
    "mesh as a body": ("a.xml", "s.stl", element('<Environment><KinBody name="k" file={}/></Environment>')),
    "robot of COLLADA": ("a.xml", "s.arm.dae", element('<Environment><Robot name="r" file={}/></Environment>')),
    "data": ("a.xml", "s.stl", geom("data")),
    "render": ("a.xml", "s.stl", geom("render")),
    "collision": ("a.xml", "s.stl", geom("collision")),
    "COLLADA": ("a.dae", "s.dae", lambda name: PAIR.replace("shapes.dae", quoteattr(name)[1:-1])),
    "archive": ("a.zae", "s.dae", lambda name: PAIR.replace("shapes.dae", quoteattr(name)[1:-1])),
}
"""Of models and meshes that files name: the file that names one, the file that is named, and the content."""

PARTS = {
    "materials": ("a.obj", "s.mtl", OBJ.format),
    "inline": ("a.wrl", "s.wrl", string("#VRML V2.0 utf8\nInline { url %s }")),
    "old inline": ("a.wrl", "s.iv", string("#VRML V1.0 ascii\nWWWInline { name %s }")),
    "file": ("a.iv", "s.iv", string("#Inventor V2.1 ascii\nFile { name %s }")),
    "binary file": ("a.iv", "s.iv", binary_inventor),
}
"""Of what meshes name and is read as what it is."""

RAW = {
    "glTF": ("a.gltf", "s.bin", lambda name, more=(): json.dumps(gltf(name) | dict(more)).encode()),
    "GLB": ("a.glb", "s.bin", lambda name, more=(): glb(gltf(name) | dict(more))),
}
"""Of bytes that become numbers."""

ALL = MODELS | PARTS | RAW

ESCAPES = {
    "above": "../out/{}",
    "below and above": "sub/../../out/{}",
    "much above": "../" * 40 + "{out}/{}",
    "absolute": "{out}/{}",
    "double slash": "/{out}/{}",
    "linked file": "link-{}",
    "linked folder": "linked/{}",
    "above a link": "linked/../out/{}",
    "file": "file:{out}/{}",
    "file with slashes": "file://{out}/{}",
    "file above": "file:../out/{}",
    "escaped": "%2e%2e/out/{}",
    "escaped slashes": "..%2Fout%2f{}",
    "twice escaped": "%252e%252e/out/{}",
    "backslashes": "..\\out\\{}",
    "home": "~/out/{}",
    "openrave": "openrave:/{}",
    "data folder": "{}",
    "zero": "../out/{}%00",
    "long": "sub/../" * 800 + "../out/{}",
    "longer than names": "x" * 5000 + "/../../out/{}",
}

_opened: "list[str] | None" = None


def _hook(event, arguments):
    if _opened is not None and event == "open" and isinstance(arguments[0], str | bytes):
        _opened.append(os.path.realpath(os.fsdecode(arguments[0])))


sys.addaudithook(_hook)


class Places:
    """A folder ``in`` with a model, and beside it ``out`` with what is not the model's."""

    def __init__(self, root):
        self.inside, self.outside = root / "in", root / "out"
        for folder in (self.inside, self.outside, self.inside / "sub"):
            folder.mkdir(parents=True)
        for name, text in SECRETS.items():
            (self.outside / name).write_text(text)
            (self.inside / f"link-{name}").symlink_to(self.outside / name)
        (self.inside / "linked").symlink_to(self.outside)

    def write(self, kind, spelling):
        """Write a model of a kind that names a file by a spelling; return its path."""
        file, target, content = ALL[kind]
        made = content(spelling.replace("{out}", str(self.outside)).replace("{}", target))
        path = self.inside / file
        if kind == "archive":
            with zipfile.ZipFile(path, "w") as archive:
                archive.writestr("a.dae", made)
                archive.writestr("../s.dae", "<COLLADA/>")
        else:
            path.write_bytes(made if isinstance(made, bytes) else made.encode(errors="surrogateescape"))
        return str(path)

    def opened(self, read):
        """Return what reading yields, and the files outside that it opened."""
        global _opened  # noqa: PLW0603 - hooks stay
        _opened = []
        try:
            result = read()
            found = [os.path.basename(path) for path in _opened if path.startswith(f"{self.outside}{os.sep}")]
        finally:
            _opened = None
        return result, found


@pytest.fixture
def places(tmp_path, monkeypatch):
    monkeypatch.setenv("RAVEMJ_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("OPENRAVE_DATA", str(tmp_path / "out"))
    monkeypatch.setenv("HOME", str(tmp_path))
    return Places(tmp_path)


def findings(path):
    """Return whether a model loads as its user opens it, and the codes of its findings with their severities."""
    env = ravemj.Environment()
    return env.Load(path), {(finding.severity, finding.code) for finding in env.diagnostics}, env


@pytest.mark.parametrize("escape", ESCAPES)
@pytest.mark.parametrize("kind", ALL)
def test_a_dropped_file_reads_nothing_outside(places, kind, escape):
    path = places.write(kind, ESCAPES[escape])
    env = ravemj.Environment()
    trouble, opened = places.opened(lambda: env.add_file(path))
    assert opened == []
    if escape in {"above", "below and above", "much above", "absolute", "linked file", "linked folder"}:
        assert "is outside of what was dropped; put all files into one folder" in trouble
        assert "[refused-file]" in trouble
    if trouble:
        assert env.GetBodies() == []
        assert trouble.startswith(os.path.basename(path))
        assert str(places.inside) not in trouble
        assert "\n" not in trouble
    else:
        assert kind in PARTS  # which are left out where they are missing


@pytest.mark.parametrize("escape", ["above", "absolute", "linked file", "linked folder"])
@pytest.mark.parametrize("kind", MODELS)
def test_a_model_that_its_user_opens_names_any_model_or_mesh(places, kind, escape):
    path = places.write(kind, ESCAPES[escape])
    (loaded, found, env), opened = places.opened(lambda: findings(path))
    assert loaded
    assert opened
    assert "refused-file" not in {code for _, code in found}
    assert env.GetBodies() or env.GetSensors()


@pytest.mark.parametrize("kind", PARTS | RAW)
@pytest.mark.parametrize("escape", ["linked file", "linked folder"])
def test_paths_of_a_model_that_its_user_opens_count_as_written(places, kind, escape):
    (loaded, found, _), opened = places.opened(lambda: findings(places.write(kind, ESCAPES[escape])))
    assert (loaded, found, opened) == (True, set(), [ALL[kind][1]])


@pytest.mark.parametrize("escape", ["above", "below and above", "absolute", "file", "file with slashes", "escaped"])
@pytest.mark.parametrize("kind", PARTS | RAW)
def test_a_mesh_refers_to_nothing_outside_of_the_model(places, kind, escape, monkeypatch):
    monkeypatch.delenv("OPENRAVE_DATA")
    path = places.write(kind, ESCAPES[escape])
    (loaded, found, env), opened = places.opened(lambda: findings(path))
    assert opened == []
    assert ("error" if kind in RAW else "warning", "refused-file") in found
    assert loaded == (kind in PARTS)
    (finding,) = (finding for finding in env.diagnostics if finding.code == "refused-file")
    assert finding.source.file == path
    assert finding.source.line == (
        0 if "bin" in kind or kind == "GLB" else 1 + (kind in ("file", "inline", "old inline"))
    )


@pytest.mark.parametrize("kind", PARTS | RAW)
def test_the_tree_of_a_model_holds_its_meshes_and_what_they_share(places, tmp_path, kind):
    mesh = places.write(kind, "../out/{}")
    (tmp_path / "a.xml").write_text(geom("data")(f"in/{os.path.basename(mesh)}"))
    (loaded, found, env), opened = places.opened(lambda: findings(str(tmp_path / "a.xml")))
    if kind in RAW:
        assert (loaded, found, opened) == (False, {("error", "refused-file")}, [])
    else:
        assert (loaded, found, opened) == (True, set(), [ALL[kind][1]])
        assert str(tmp_path / "out" / opened[0]) in env.files


@pytest.mark.parametrize("picture", ["../out/s.bin", "../out/wood.png", "{out}/s.bin?a"])
@pytest.mark.parametrize("suffix", ["gltf", "glb", "ply"])
def test_pictures_are_not_read(places, picture, suffix, caplog):
    picture = picture.replace("{out}", str(places.outside))
    (places.outside / "wood.png").write_bytes(b"\x89PNG\r\n")
    path = places.inside / f"a.{suffix}"
    if suffix == "ply":
        text = (DATA / "meshes" / "wedge.ply").read_text()
        path.write_text(text.replace("\nelement", f"\ncomment TextureFile {picture}\nelement", 1))
    else:
        (places.inside / "sub" / "s.bin").write_text(SECRETS["s.bin"])
        pictures = {
            "images": [{"uri": picture}],
            "textures": [{"source": 0}],
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        }
        path.write_bytes(RAW["glTF" if suffix == "gltf" else "GLB"][2]("sub/s.bin", pictures))
    (loaded, found, _), opened = places.opened(lambda: findings(str(path)))
    assert (loaded, found, opened, caplog.records) == (True, set(), [], [])
    trouble, opened = places.opened(lambda: ravemj.Environment().add_file(str(path)))
    assert (trouble, opened) == ("", [])


def test_the_error_names_both_files_the_reason_and_what_to_do(places):
    mesh = places.write("glTF", "../{}")
    model = places.inside / "k.xml"
    model.write_text(geom("data")("a.gltf"))
    (finding,) = findings(str(model))[2].diagnostics
    assert str(finding) == (
        f"{mesh}:1: error[refused-file]: '../s.bin' is not read: it is raw data outside of the folder "
        f"of the mesh; copy it into that folder (included from {model}:2)"
    )


@pytest.mark.parametrize("kind", ["COLLADA", "materials", "glTF"])
def test_files_that_were_dropped_together_may_name_one_another(places, kind):
    path = places.write(kind, "../out/{}" if kind == "COLLADA" else "sub/{}")
    inside = places.inside / "sub" / ALL[kind][1]
    inside.write_text((places.outside / inside.name).read_text())
    env = ravemj.Environment()
    trouble, opened = places.opened(lambda: env.add_file(path, [path, str(places.outside / ALL[kind][1])]))
    assert (trouble, bool(opened)) == ("", kind == "COLLADA")
    assert env.GetBodies()


def test_what_is_missing_among_dropped_files_is_said(places):
    path = places.write("data", "mug.stl")
    assert ravemj.Environment().add_file(path) == (
        "a.xml:2: error[missing-file]: there is no file 'mug.stl' with what was dropped; "
        "drop it together with the model"
    )


def test_a_link_that_is_dropped_leads_to_the_file(places):
    link = places.inside / "k.xml"
    link.symlink_to(places.outside / "s.xml")
    env = ravemj.Environment()
    assert env.add_file(str(link)) == ""
    assert len(env.GetBodies()) == 1


def test_included_files_lead_no_further_than_the_one_that_was_dropped(places):
    places.write("materials", "{out}/{}")
    (places.inside / "sub" / "b.xml").write_text(geom("data")("../a.obj"))
    model = places.inside / "c.xml"
    model.write_text('<Environment>\n<KinBody name="k" file="sub/b.xml"/></Environment>')
    trouble, opened = places.opened(lambda: ravemj.Environment().add_file(str(model)))
    assert opened == []
    assert re.match(
        r"sub/\.\./a\.obj:1: error\[refused-file\].*\(included from sub/b.xml:2 \(included from c.xml:2\)\)$", trouble
    )


def test_warnings_of_dropped_files_name_no_folders(places):
    path = places.inside / "k.xml"
    path.write_text(BODY.replace("<Body", "<Nonsense/><Body"))
    with warnings.catch_warnings(record=True) as shown:
        warnings.simplefilter("always", RavemjWarning)
        assert ravemj.Environment().add_file(str(path)) == ""
    assert [str(warning.message).partition(":")[0] for warning in shown] == ["k.xml"]


class TestTheCache:
    def test_holds_nothing_for_those_who_must_not_read_it(self, places, monkeypatch, tmp_path):
        monkeypatch.delenv("OPENRAVE_DATA")
        mesh = places.write("materials", "../out/{}")
        wide, narrow = FileAccess.opened(str(tmp_path / "a.xml")), FileAccess.opened(mesh)
        for _ in range(2):
            assert read_mesh(mesh, access=wide)[0].diffuse == (0.25, 0.5, 0.75)
            assert read_mesh(mesh, access=narrow)[0].diffuse == pytest.approx((0.6, 0.6, 0.6))
        assert [finding.code for finding in narrow.diagnostics] == ["refused-file"]
        assert not len(wide.diagnostics)

    def test_follows_no_links_of_dropped_files(self, places):
        for kind in ("materials", "inline", "glTF"):
            mesh = places.write(kind, "link-{}")
            assert read_mesh(mesh)
            assert "refused-file" in ravemj.Environment().add_file(mesh)


def test_check_lists_the_files_outside_of_the_folder(places, tmp_path):
    (tmp_path / "out" / "a.obj").write_text(OBJ.format("s.mtl"))
    path = places.write("data", "../out/a.obj")
    found = [str(finding) for finding in check(path) if finding.code == "outside-file"]
    for file, place in [("a.obj", f"{path}:2"), ("s.mtl", f"{places.inside}/../out/a.obj")]:
        (line,) = [line for line in found if f"/{file}', outside" in line]
        assert line.startswith(f"{place}: note[outside-file]: the model reads '{places.outside.parent}")
    assert len(found) == 2
    places.write("data", "sub/s.stl")
    (places.inside / "sub" / "s.stl").write_text(STL)
    assert "outside-file" not in {finding.code for finding in check(path)}


EDITS = st.sampled_from(
    [
        *[("/", "//"), ("/", "/./"), ("/", "%2F"), ("/", "\\"), ("/", "%5C"), ("/", "/sub/../"), ("/", "/linked/../")],
        *[("..", "%2e%2e"), ("..", ".%2E"), ("..", "%252e."), ("..", "../in/.."), ("..", "linked/.."), ("..", "...")],
        *[
            ("out", "%6fut"),
            ("out", "OUT"),
            ("s.", "%73."),
            ("file:", "FILE:"),
            ("file:", "file://localhost"),
            ("%", "%25"),
        ],
        *[
            ("", "./"),
            ("", "file:"),
            ("", "openrave:"),
            ("", "/"),
            ("", "linked/"),
            ("", "http://a/"),
            ("", " "),
            ("", "\t"),
        ],
    ]
)
SPELLINGS = st.builds(
    lambda spelling, edits: functools.reduce(lambda text, edit: text.replace(*edit, 1), edits, spelling),
    st.sampled_from(sorted(ESCAPES.values())),
    st.lists(EDITS, max_size=4),
)
ENDS = st.sampled_from(["", "#s", "?s", "%00", "%0a", "/", "/.", "%", "\u00e9"])


def try_spelling(places, kind, spelling):
    """Nothing outside is opened for a dropped file; for a model that its user opens, no raw data but by a link."""
    path = places.write(kind, spelling)
    trouble, opened = places.opened(lambda: ravemj.Environment().add_file(path))
    assert (opened, "\n" in trouble, str(places.inside) in trouble) == ([], False, False)
    (_, _, env), opened = places.opened(lambda: findings(path))
    assert "s.bin" not in opened or "link" in spelling
    assert not any("\n" in str(finding) for finding in env.diagnostics)


@pytest.fixture(scope="module")
def anywhere(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        root = tmp_path_factory.mktemp("access")
        patch.setenv("RAVEMJ_CACHE", str(root / "cache"))
        yield Places(root)


@examples(150)
@given(kind=st.sampled_from(sorted(ALL)), spelling=SPELLINGS, end=ENDS)
def test_no_spelling_leads_outside(anywhere, kind, spelling, end):
    try_spelling(anywhere, kind, spelling + end)


@pytest.mark.stress
@settings(max_examples=20_000)
@given(kind=st.sampled_from(sorted(ALL)), spelling=SPELLINGS, end=ENDS)
def test_no_spelling_of_many_leads_outside(anywhere, kind, spelling, end):
    try_spelling(anywhere, kind, spelling + end)

"""Small files that would fill the memory or take hours: one error that names the file, what was found and the limit."""

import base64
import io
import json
import struct
import zipfile

import pytest
from waiting import time_limit

import ravemj
from ravemj.errors import LimitError, RavemjError, SourceError
from ravemj.formats import limits
from ravemj.formats.meshes import read_mesh
from ravemj.formats.readers import read_data, read_file

pytestmark = pytest.mark.usefixtures("no_cache")

COLLADA = '<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">{}</COLLADA>'
TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)


def archive(members, method=zipfile.ZIP_DEFLATED) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", method, compresslevel=9) as opened:
        for name, data in members.items():
            opened.writestr(name, data)
    return content.getvalue()


@pytest.fixture
def failure(tmp_path):
    """Write a file, and return the error of loading it as a model."""

    def read(name, content, *, message):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        with time_limit():
            reading = read_file(path)
        text = str(reading.failure)
        assert message in text
        assert "\n" not in text
        return reading

    return read


class TestBytes:
    @pytest.mark.parametrize("name", ["a.xml", "a.dae", "a.zae", "a.stl", "a.json"])
    def test_a_file_that_is_too_large(self, name, tmp_path, monkeypatch):
        monkeypatch.setenv("RAVEMJ_MOST_BYTES", "1000")
        (tmp_path / name).write_bytes(b"<" * 1001)
        with pytest.raises(SourceError, match=r"1,001 bytes or more, and 1,000 are read.*RAVEMJ_MOST_BYTES") as caught:
            read_mesh(str(tmp_path / name)) if name == "a.stl" else ravemj.load(tmp_path / name)
        assert caught.value.source.file == str(tmp_path / name)

    def test_included_files_add_up(self, failure, tmp_path, monkeypatch):
        (tmp_path / "part.xml").write_text("<KinBody/>" + " " * 400)
        text = '<KinBody name="k">' + '<KinBody file="part.xml"/>' * 3 + "</KinBody>"
        monkeypatch.setenv("RAVEMJ_MOST_BYTES", "1000")
        failure("main.xml", text, message="the files of the model have")
        monkeypatch.setenv("RAVEMJ_MOST_BYTES", "2000")
        assert read_file(tmp_path / "main.xml").failure is None

    def test_a_model_that_is_named_many_times_is_read_once(self, tmp_path, monkeypatch):
        node = '<node id="n" name="n"/>'
        scene = f'<visual_scene id="s">{node}</visual_scene><scene><instance_visual_scene url="#s"/></scene>'
        (tmp_path / "one.dae").write_text(COLLADA.format(scene) + " " * 900)
        bodies = "".join(f'<KinBody name="k{k}" file="one.dae"/>' for k in range(20))
        (tmp_path / "main.xml").write_text(f"<Environment>{bodies}</Environment>")
        monkeypatch.setenv("RAVEMJ_MOST_BYTES", "3000")
        assert read_file(tmp_path / "main.xml").failure is None
        assert read_file(tmp_path / "main.xml").files.count(str(tmp_path / "one.dae")) == 1

    @pytest.mark.parametrize("value", ["5x", "-1", "0", "1.5", "1e9", "9" * 30, "٣"])
    def test_a_wrong_limit(self, value, models, tmp_path, monkeypatch):
        monkeypatch.setenv("RAVEMJ_MOST_BYTES", value)
        (tmp_path / "a.json").write_text('{"bodies": []}')
        for path in (models / "env.xml", tmp_path / "a.json"):
            with pytest.raises(RavemjError, match=f"RAVEMJ_MOST_BYTES is '{value}'; write a number of bytes"):
                ravemj.load(path)


class TestArchives:
    def test_what_unpacks_to_far_more(self, failure):
        content = COLLADA.format("<a/>" * 500_000)
        failure("a.zae", archive({"a.dae": content}), message="over 200 times its own")
        failure("b.zae", archive({"a.dae": COLLADA.format(""), "manifest.xml": content}), message="over 200 times")

    def test_more_than_the_limit_of_bytes(self, failure, monkeypatch):
        monkeypatch.setenv("RAVEMJ_MOST_BYTES", "20000")
        content = COLLADA.format("<!-- " + " ".join(map(str, range(8000))) + " -->")
        failure("a.zae", archive({"a.dae": content}), message="it unpacks to 20,001 bytes or more, and 20,000 are read")

    def test_very_many_members(self, failure):
        """All entries of the directory lead to the same bytes, so that the archive is small."""
        raw = archive({"0.dae": COLLADA.format('<a b="c"/>' * 500)})
        start, end = raw.rfind(b"PK\1\2"), raw.rfind(b"PK\5\6")
        entry = raw[start:end]
        total = end - start
        tail = bytearray(raw[end:])
        tail[8:12] = struct.pack("<HH", 20_000, 20_000)
        tail[12:16] = struct.pack("<I", 20_000 * total)
        failure("a.zae", raw[:start] + entry * 20_000 + bytes(tail), message="20,000 files in the archive")

    @pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
    def test_other_compression(self, method, failure):
        """Python would unpack all of it before its size can be seen."""
        content = archive({"a.dae": COLLADA.format(" " * 1_000_000)}, method)
        failure("a.zae", content, message="not compressed by deflate")

    def test_every_damaged_byte(self, tmp_path):
        """``zipfile`` raises more kinds of exceptions than it says."""
        whole = archive({"a.dae": COLLADA.format("")})
        for place in range(len(whole)):
            for value in (0, 1, 0x7F, 0x80, 0xFF):
                data = bytearray(whole)
                data[place] = value
                (tmp_path / "a.zae").write_bytes(data)
                assert isinstance(read_file(tmp_path / "a.zae").failure, SourceError)


class TestElements:
    MESSAGE = "elements in the model, and at most 1,000,000 are read"

    @pytest.mark.parametrize("name", ["a.xml", "a.dae"])
    @pytest.mark.parametrize("piece", ["<a/>", "<a></a>", "<!---->", "<?a?>"])
    def test_many(self, name, piece, failure):
        text = "<Environment>{}</Environment>" if name == "a.xml" else COLLADA
        failure(name, text.format(piece * 1_000_001), message=self.MESSAGE)

    @pytest.mark.parametrize("name", ["a.xml", "a.dae"])
    def test_many_attributes(self, name, failure):
        tag = "<a " + " ".join(f'a{k}=""' for k in range(50)) + "/>"
        text = "<Environment>{}</Environment>" if name == "a.xml" else COLLADA
        failure(name, text.format(tag * 40_001), message="attributes in the model, and at most 2,000,000")

    @pytest.mark.parametrize("encoding", ["utf-7", "cp037", "iso-2022-jp"])
    def test_encodings_in_which_elements_cannot_be_counted(self, encoding, failure):
        text = f'<?xml version="1.0" encoding="{encoding}"?>' + COLLADA.format("")
        failure("a.dae", text.encode(encoding), message="not well-formed XML in one of the usual encodings")
        padded = text.replace("?>", " " * 100_000 + "?>")
        failure("b.dae", padded.encode("ascii"), message="error")

    @pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1", "windows-1252", "shift_jis"])
    def test_usual_encodings(self, encoding, failure):
        text = f'<?xml version="1.0" encoding="{encoding.removesuffix("-sig")}"?>' + COLLADA.format("")
        failure("a.dae", text.encode(encoding), message="there is no body in it")

    def test_included_files_add_up(self, failure, tmp_path, monkeypatch):
        monkeypatch.setattr(limits, "MOST_ELEMENTS", 1000)
        (tmp_path / "part.xml").write_text("<KinBody>" + '<Body type="dynamic"/>' * 99 + "</KinBody>")
        text = '<KinBody name="k">' + '<KinBody file="part.xml"/>' * 10 + "</KinBody>"
        reading = failure("main.xml", text, message="1,011 elements in the model, and at most 1,000 are read")
        assert isinstance(reading.failure, LimitError)

    def test_copies_of_a_collada_file_add_up(self, failure, tmp_path, monkeypatch):
        monkeypatch.setattr(limits, "MOST_ELEMENTS", 1000)
        (tmp_path / "part.dae").write_text(COLLADA.format("<a/>" * 99))
        bodies = "".join(f'<KinBody name="k{k}" file="part.dae"/>' for k in range(10))
        failure("main.xml", f"<Environment>{bodies}</Environment>", message="elements in the model")

    def test_systems_that_double(self, failure):
        systems = '<articulated_system id="s0"><kinematics/></articulated_system>' + "".join(
            f'<articulated_system id="s{k}"><motion>'
            + f'<instance_articulated_system url="#s{k - 1}"/>' * 2
            + "</motion></articulated_system>"
            for k in range(1, 40)
        )
        scene = '<kinematics_scene id="k"><instance_articulated_system url="#s39"/></kinematics_scene>'
        scene += '<scene><instance_kinematics_scene url="#k"/></scene>'
        failure("a.dae", COLLADA.format(systems + scene), message="articulated systems in a body, and at most 1,000")

    @pytest.mark.parametrize(
        ("values", "message"),
        [
            ("[" + "[]," * 1_000_000 + "[]]", "objects and lists, and at most 1,000,000"),
            ("[" + "{}," * 1_000_000 + "{}]", "objects and lists, and at most 1,000,000"),
            ("{" + ",".join(f'"{k}":1' for k in range(2_000_001)) + "}", "names and texts, and at most 2,000,000"),
        ],
    )
    def test_json(self, values, message, tmp_path):
        (tmp_path / "a.json").write_text(f'{{"bodies": [], "a": {values}}}')
        with pytest.raises(LimitError, match=message):
            ravemj.load(tmp_path / "a.json")
        assert not ravemj.Environment().Load(str(tmp_path / "a.json"))

    def test_texts_in_memory(self):
        assert self.MESSAGE in str(read_data("<Environment>" + "<a/>" * 1_000_001 + "</Environment>").failure)
        with pytest.raises(ravemj.openrave_exception, match=self.MESSAGE):
            ravemj.RaveCreateTrajectory(ravemj.Environment(), "").deserialize(
                "<trajectory>" + "<a/>" * 1_000_001 + "</trajectory>"
            )


def test_one_mesh_in_many_sizes(failure, tmp_path, monkeypatch):
    monkeypatch.setattr("ravemj.formats.openrave_xml.context.MOST_MODEL_TRIANGLES", 5)
    (tmp_path / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    geoms = "".join(f'<Geom type="trimesh"><data>m.obj {k}</data></Geom>' for k in range(1, 7))
    text = '<KinBody name="k"><Body name="b">{}</Body></KinBody>'
    failure("a.xml", text.format(geoms), message="6 triangles in the meshes of the model, and at most 5 are read")
    same = '<Geom type="trimesh"><data>m.obj</data></Geom>' * 7
    (tmp_path / "b.xml").write_text(text.format(same))
    assert read_file(tmp_path / "b.xml").failure is None


def test_long_lists_of_numbers(tmp_path, monkeypatch):
    monkeypatch.setattr("ravemj.formats.meshes.number_lists.MOST_NUMBERS", 100)
    for count, is_read in ((11, True), (12, False)):
        points = "0 0 0, 1 0 0, 0 1 0, " * count
        faces = f"IndexedFaceSet {{ coordIndex [0 1 2 -1] coord Coordinate {{ point [{points}] }} }}"
        text = f"#VRML V2.0 utf8\nShape {{ geometry {faces} }}"
        (tmp_path / "a.wrl").write_text(text)
        if is_read:
            assert len(read_mesh(str(tmp_path / "a.wrl"))[0].mesh.triangles) == 1
        else:
            with pytest.raises(SourceError, match="a list has more than 100 numbers"):
                read_mesh(str(tmp_path / "a.wrl"))


def test_pieces_of_a_list_make_the_whole(tmp_path, monkeypatch):
    """A list is cut at spaces, however many there are."""
    from ravemj.formats.meshes import number_lists

    for piece in (1, 2, 5, 1000):
        monkeypatch.setattr(number_lists, "_PIECE", piece)
        for text in ("", " ", "1", " 12  345\n\t6 ", "7 " * 50):
            assert number_lists.parse_list(text, float).tolist() == list(map(float, text.split()))


def gltf(**changes) -> bytes:
    """Return a triangle as glTF, with some entries changed."""
    uri = "data:application/octet-stream;base64," + base64.b64encode(TRIANGLE).decode()
    content = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": uri, "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [POSITIONS],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
    }
    return json.dumps({**content, **changes}).encode()


POSITIONS = {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}
INDICES = {"componentType": 5125, "count": 30_000_000, "type": "SCALAR"}
INDEXED = [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]
GLTF = {
    "the one of the report": ({"accessors": [POSITIONS, INDICES], "meshes": INDEXED}, "declares 30,000,000 items"),
    "sparse": ({"accessors": [POSITIONS, {**INDICES, "sparse": {"count": 1}}], "meshes": INDEXED}, "30,000,000 items"),
    "points without data": ({"accessors": [{**POSITIONS, "bufferView": 0, "count": 4}]}, "4 items.*hold 3"),
    "a view that is too short": ({"accessors": [{**POSITIONS, "byteOffset": 4}]}, "3 items.*hold 2"),
    "a stride": (
        {"bufferViews": [{"buffer": 0, "byteLength": 36, "byteStride": 16}]},
        "3 items.*hold 2",
    ),
    "an offset behind the end": ({"accessors": [{**POSITIONS, "byteOffset": 10**12}]}, "hold 0"),
    "negative": ({"accessors": [{**POSITIONS, "count": -3}]}, "declares -3 items"),
    "no whole number": ({"accessors": [{**POSITIONS, "count": 3e15}]}, "no whole number"),
    "a truth value": ({"accessors": [{**POSITIONS, "count": True}]}, "no whole number"),
    "one mesh twice over": (
        {"nodes": [{"mesh": 0}, *({"children": [k, k]} for k in range(40))], "scenes": [{"nodes": [40]}]},
        "several places",
    ),
    "a circle": ({"nodes": [{"mesh": 0, "children": [1]}, {"children": [0]}]}, "several places"),
    "long transforms": ({"nodes": [{"mesh": 0, "scale": [1] * 20_000}]}, "scale of a node has not 3 numbers"),
    "deep": ({"nodes": [*({"children": [k + 1]} for k in range(200)), {"mesh": 0}]}, "151 nodes inside one another"),
    "longer than its buffer": ({"bufferViews": [{"buffer": 0, "byteLength": 10**9}]}, "the buffers have"),
}


class TestDeclaredCounts:
    @pytest.mark.parametrize(("changes", "message"), GLTF.values(), ids=GLTF)
    def test_gltf(self, changes, message, tmp_path):
        (tmp_path / "a.gltf").write_bytes(gltf())
        assert len(read_mesh(str(tmp_path / "a.gltf"))[0].mesh.triangles) == 1
        (tmp_path / "a.gltf").write_bytes(gltf(**changes))
        with time_limit(), pytest.raises(SourceError, match=message):
            read_mesh(str(tmp_path / "a.gltf"))

    def test_glb(self, tmp_path):
        content = gltf(accessors=[POSITIONS, INDICES], meshes=INDEXED)
        content += b" " * (-len(content) % 4)
        head = struct.pack("<4sIIII", b"glTF", 2, 20 + len(content), len(content), 0x4E4F534A)
        (tmp_path / "a.glb").write_bytes(head + content)
        with pytest.raises(SourceError, match="declares 30,000,000 items in an accessor, and can hold"):
            read_mesh(str(tmp_path / "a.glb"))

    @pytest.mark.parametrize("use", ["accessors", "primitives", "nodes"])
    def test_gltf_that_repeats_what_it_holds(self, use, tmp_path):
        points = TRIANGLE * 4000
        uri = "data:application/octet-stream;base64," + base64.b64encode(points).decode()
        position = {**POSITIONS, "count": 12_000}
        changes = {
            "accessors": {"accessors": [position] * 3000},
            "primitives": {"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}] * 3000}]},
            "nodes": {"nodes": [{"mesh": 0}] * 3000, "scenes": [{"nodes": list(range(3000))}]},
        }[use]
        content = {"accessors": [position], **changes}
        views = [{"buffer": 0, "byteLength": len(points)}]
        (tmp_path / "a.gltf").write_bytes(gltf(buffers=[{"uri": uri}], bufferViews=views, **content))
        with pytest.raises(LimitError, match="RAVEMJ_MOST_BYTES" if use == "accessors" else "12,000,000 triangles"):
            read_mesh(str(tmp_path / "a.gltf"))

    @pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
    @pytest.mark.parametrize("element", ["vertex", "face", "other"])
    @pytest.mark.parametrize("count", [-1, 10**7, 10**12])
    def test_ply(self, form, element, count, tmp_path):
        counts = {"vertex": 3, "face": 1, "other": 0, element: count}
        header = f"ply\nformat {form} 1.0\nelement other {counts['other']}\nelement vertex {counts['vertex']}\n"
        header += "property float x\nproperty float y\nproperty float z\n"
        header += f"element face {counts['face']}\nproperty list uchar int vertex_indices\nend_header\n"
        body = b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n" if form == "ascii" else TRIANGLE + struct.pack("<B3i", 3, 0, 1, 2)
        (tmp_path / "a.ply").write_bytes(header.encode() + body)
        with time_limit(), pytest.raises(SourceError, match=f"declares {count:,} {element} elements, and can hold"):
            read_mesh(str(tmp_path / "a.ply"))

    @pytest.mark.parametrize("counts", ["99999999 1", "3 99999999", "3 2", "-3 1", "3 -1"])
    def test_off(self, counts, tmp_path):
        (tmp_path / "a.off").write_text(f"OFF # a comment\n# another\n{counts} 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2")
        with time_limit(), pytest.raises(SourceError, match="declares"):
            read_mesh(str(tmp_path / "a.off"))

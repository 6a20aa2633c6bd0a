"""Damaged and hostile documents: a scene or a ``RavemjError``, after little work, and nothing on stderr."""

import os
import time

import pytest
from conftest import one_in
from fuzzing import MAIN, Fuzzer, Outcome, Trial, parsed, smaller
from lxml import etree
from waiting import time_limit

import ravemj
from ravemj.errors import Diagnostics
from ravemj.formats import mjcf
from ravemj.formats.readers import read_file

BATCHES, BATCH = 20, 250
DEEP = 5
"""One in so many documents is compiled too."""


class TestDamaged:
    @pytest.fixture(autouse=True)
    def _elsewhere(self, tmp_path, monkeypatch):
        """MuJoCo would leave a log in the working folder."""
        monkeypatch.chdir(tmp_path)
        monkeypatch.setenv("RAVEMJ_CACHE", "off")

    @pytest.mark.stress
    @pytest.mark.parametrize("batch", one_in(10, range(BATCHES)))
    def test_documents(self, batch, capfd, tmp_path):
        fuzzer = Fuzzer(seed=0)
        linked, crashes = 0, []
        for number in range(batch * BATCH, (batch + 1) * BATCH):
            try:
                outcome = Trial(deep=number % DEEP == 0).run(fuzzer.make(number))
            except Exception as error:  # the number says how to make it again
                crashes.append((number, repr(error)[:200]))
                continue
            linked += outcome.links > 0
        assert crashes == []
        assert linked >= BATCH / 2, "too few documents reach the meaning of elements"
        assert capfd.readouterr().err == ""
        assert not (tmp_path / "MUJOCO_LOG.TXT").exists()

    def test_a_seed_gives_the_same_documents_again(self):
        one, other = Fuzzer(5), Fuzzer(5)
        assert [one.make(number) for number in range(20)] == [other.make(number) for number in range(20)]

    def test_small_examples(self):
        files = {
            MAIN: b'<KinBody name="b"><Body name="a"><Translation>1 2 7</Translation></Body></KinBody>',
            "x.xml": b"",
        }

        def fails(files) -> bool:
            root = parsed(files[MAIN])
            return root is not None and any("7" in node.text for node in root.walk())

        assert (
            smaller(files, fails)[MAIN].split()
            == b"<KinBody> <Body> <Translation>7</Translation> </Body> </KinBody>".split()
        )


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Read, translate and compile a document."""
    monkeypatch.chdir(tmp_path)

    def run(content: str | bytes, **files: str | bytes) -> Outcome:
        named = {MAIN: content, **{f"{name}.xml": text for name, text in files.items()}}
        encoded = {name: text if isinstance(text, bytes) else text.encode() for name, text in named.items()}
        return Trial(deep=True).run(encoded)

    return run


def body(content: str, attributes: str = "") -> str:
    return f'<KinBody name="b" {attributes}>{content}</KinBody>'


LINK = '<Body name="A"/>'
TWO = '<Body name="A"/><Body name="B"/>'
HINGE = "<Joint name='j'><Body>A</Body><Body>B</Body>{}</Joint>"
BOMB = "<!DOCTYPE x [<!ENTITY a0 'aaaaaaaaaa'>{}]>".format(
    "".join(f"<!ENTITY a{i} '{f'&a{i - 1};' * 10}'>" for i in range(1, 10))
)
EXTERNAL = "<!DOCTYPE x [<!ENTITY a SYSTEM '/etc/passwd'>]>"


class TestHostile:
    @pytest.mark.parametrize(
        "content",
        [
            BOMB + body("<Body name='A'><Translation>&a9;</Translation></Body>"),
            BOMB + body("<Body name='&a9;'/>"),
            EXTERNAL + body("<Body name='A'><Translation>&a;</Translation></Body>"),
            EXTERNAL + body("<Body name='&a;'/>"),
            "<KinBody>" * 100_000,
            body("<x>" * 100_000 + "</x>" * 100_000),
            body("<Body name='a\0'/>"),
            body("<Body name='a&#0;'/>"),
            body("<Body name='a&#1;'/>"),
            body(LINK).encode("utf-32"),
            body("<Body name='é'/>").encode("latin-1"),
            *(f"<?xml version='1.0' encoding='{code}'?>{body(LINK)}" for code in ("utf-7", "idna", "hex", "x" * 999)),
            body("<Translation>1 2 3"),
        ],
        ids=lambda content: content[:30],
    )  # fmt: skip
    def test_refused(self, run, content):
        outcome = run(content)
        assert outcome.links == 0
        assert any(name.startswith("failure") for name in outcome.signature)

    @pytest.mark.stress
    @pytest.mark.parametrize(
        "content",
        [
            body("<KinBody>" * 190 + LINK + "</KinBody>" * 190),
            body(f"<Body name='{'n' * 1_000_000}'/>"),
            body("<Body name='a&#10;&#9;&#13;&#x85;&#x2028;&#x202e;&#xfffd;--&gt;'/>"),
            body(LINK, f"zzz='{'q' * 5_000_000}'"),
            body(f"<Body name='A'><Translation>{'9' * 4_000_000} 1 2</Translation></Body>"),
            body(f"<Body name='A'><Translation>.{'9' * 4_000_000} 1 2</Translation></Body>"),
            body(f"<Body name='A'><Translation>{' ' * 5_000_000}x</Translation></Body>"),
            body(TWO + HINGE.replace("{}", "<axis>0 0 1</axis>").replace("'j'", f"'j' mimic_pos='{'j+' * 999_999}1'")),
            body("<Body name='ü'/>").encode("utf-16"),
            body("<Body name='ü'/>").encode("utf-16-le"),
            "<!DOCTYPE x SYSTEM '/dev/zero'>" + body(LINK),
            "<!DOCTYPE x [<!ENTITY % p SYSTEM '/dev/zero'> %p;]>" + body(LINK),
        ],
        ids=lambda content: content[:30],
    )
    def test_read(self, run, content):
        assert run(content).links >= 1

    @pytest.mark.parametrize(
        "name", [".", "/", "/dev/zero", "fifo", "a/" * 100_000, "socket:", "http://localhost/x.xml"]
    )
    def test_files_that_are_none(self, tmp_path, name):
        os.mkfifo(tmp_path / "fifo")
        (tmp_path / MAIN).write_text(
            body(f"<Body name='A'><Geom type='trimesh'><data>{name}</data></Geom></Body>", f"file='{name}'")
        )
        with time_limit():
            reading = read_file(tmp_path / MAIN)
        assert reading.failure is None
        assert {finding.code for finding in reading.diagnostics} == {"missing-file"}

    @pytest.mark.parametrize("files", [
        {"a": "<KinBody file='main.xml'/>"},
        {"a": "<KinBody file='b.xml'/>", "b": "<KinBody file='a.xml'/>"},
        {"a": "<KinBody><KinBody><KinBody file='a.xml'/></KinBody></KinBody>"},
    ])  # fmt: skip
    def test_files_that_include_themselves(self, run, files):
        assert run(body("", "file='a.xml'"), **files).signature == {"broken-file"}

    def test_links_that_include_themselves(self, tmp_path):
        (tmp_path / "round").symlink_to(".")
        (tmp_path / "other.xml").symlink_to(MAIN)
        for name in ("other.xml", "round/main.xml", "round/round/other.xml"):
            (tmp_path / MAIN).write_text(body("", f"file='{name}'"))
            with time_limit():
                assert "includes itself" in str(read_file(tmp_path / MAIN).failure)

    def test_many_bodies_in_linear_time(self, tmp_path):
        def seconds(count: int) -> float:
            """The time of this thread alone, whatever else the machine does."""
            bodies = "".join(f"<KinBody name='b{i}'><Body name='l'/></KinBody>" for i in range(count))
            (tmp_path / MAIN).write_text(f"<Environment>{bodies}</Environment>")
            start = time.thread_time()
            reading = read_file(tmp_path / MAIN)
            mjcf.write(reading.scene, Diagnostics())
            assert len(reading.scene.bodies) == count
            return time.thread_time() - start

        few = min(seconds(250) for _ in range(3))
        assert seconds(4000) < 5 * 16 * few, "in quadratic time it is 256 times as long"


THREE = TWO + "<Body name='C'/>" + HINGE.format("")
FOLLOWER = "<Joint name='k' {}><Body>A</Body><Body>C</Body></Joint>"
SOLID = "<Body name='A'><Geom type='{0}'><{1}>1e200</{1}></Geom><Mass type='mimicgeom'/></Body>"
TETRAHEDRON = "0 0 0 0 1 0 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 0 0 1 0 1 0 1 0 0 0 1 0 1e308 0 1"
FAR = "<Translation>1e308 0 0</Translation>"

EXCEPTIONS = {
    "a matrix": body("<RotationMat>1e200</RotationMat>" + LINK),
    "a gear": body(TWO + HINGE.format("<actuator><gear_ratio>1e300</gear_ratio></actuator>")),
    "a sphere": body(SOLID.format("sphere", "radius")),
    "a cylinder": body(SOLID.format("cylinder", "radius")),
    "a high cylinder": body(SOLID.format("cylinder", "height")),
    "a box": body("<Body name='A'><Geom><extents>1e154 1 1</extents></Geom><Mass type='mimicgeom'/></Body>"),
    "a mesh": body(f"<Body name='A'><Geom type='trimesh'><vertices>{TETRAHEDRON}</vertices></Geom></Body>"),
    "two translations": body(f"<Body name='A'>{FAR}{FAR}</Body>"),
    "an infinite follower": body(THREE + FOLLOWER.format("circular='1' mimic_pos='1e300*1e300*(j+1)'")),
    "a follower without a value": body(THREE.replace("'j'", "'j' enable='0'") + FOLLOWER.format("mimic_pos='acos(2+j)'")
                                       + "<Joint name='l'><Body>B</Body><Body>C</Body></Joint>"),
}  # fmt: skip
REFUSED = {
    "transparency": body(
        "<Body name='A'><Geom><extents>1 1 1</extents><transparency>1e77</transparency></Geom></Body>"
    ),
    "inertia": body("<Body name='A'><Mass type='custom'><inertia>0 1.7167209862385004</inertia></Mass></Body>"),
    "a ball that follows": body(THREE + FOLLOWER.format("type='spherical' mimic_pos='j'")),
    "an axis": body(TWO + HINGE.replace("'j'", "'j' type='hinge2'").format("<axis1>1 0 0</axis1><axis2>1e200</axis2>")),
}


FORMULA = "<Joint name='k' {}><Body>A</Body><Body>C</Body></Joint>"


@pytest.mark.parametrize("third", ["2.0000000000001", "2.000000000001", "2", "1.9999999999999"])
def test_inertias_at_the_edge(run, third):
    mass = f"<Mass type='custom'><total>1</total><inertia>1 0 0 0 1 0 0 0 {third}</inertia></Mass>"
    turned = f"<Mass type='custom'><total>1</total><inertia>1.5 .5 0 .5 1.5 0 0 0 {third}</inertia></Mass>"
    rod = "<Mass type='custom'><total>1</total><inertia>1 1 0 1 1 0 0 0 2</inertia></Mass>"
    for content in (mass, turned, rod):
        assert run(body(f"<Body name='A'>{content}</Body>")).refused == ""


def test_a_formula_without_finite_values_is_left_out(run):
    content = TWO + "<Body name='C'/>" + HINGE.replace("'j'", "'j' enable='false'").format("")
    content += FORMULA.format("mimic_pos='exp(exp(exp(j+9)))'") + FORMULA.format("").replace("'k'", "'l'")
    run(body(content))


class TestFound:
    """What these tests found once."""

    @pytest.mark.parametrize("name", EXCEPTIONS)
    def test_exceptions(self, run, name):
        run(EXCEPTIONS[name])

    @pytest.mark.parametrize("name", REFUSED)
    def test_refused_by_mujoco(self, run, name):
        assert run(REFUSED[name]).refused == ""

    def test_entities_in_attributes(self, run):
        assert run("<!DOCTYPE x [<!ENTITY a 'zzz'>]>" + body("<Body name='&a;'/>")).links == 0

    @pytest.mark.stress
    def test_inclusions_that_double(self, run):
        files = {
            f"f{i}": f"<KinBody><KinBody file='f{i + 1}.xml'/><KinBody file='f{i + 1}.xml'/></KinBody>"
            for i in range(40)
        }
        run(body("", "file='f0.xml'"), f40="<KinBody/>", **files)

    def test_size_of_the_mjcf_is_linear(self, tmp_path):
        def size(count: int) -> int:
            (tmp_path / MAIN).write_text(body("".join(f"<Body name='l{i}'/>" for i in range(count))))
            return len(mjcf.write(read_file(tmp_path / MAIN).scene, Diagnostics()).text)

        assert size(200) < 3 * size(100)

    @pytest.mark.stress
    def test_long_chains_of_followers(self, run):
        links = "".join(f"<Body name='l{i}'/>" for i in range(1202))
        joint = "<Joint name='j{0}' mimic_pos='{1}'><Body>l0</Body><Body>l{0}</Body></Joint>"
        joints = "".join(joint.format(i, f"j{i + 1}") for i in range(1, 1201))
        assert run(body(links + joints + joint.format(1201, "").replace("mimic_pos=''", ""))).links == 1202

    @pytest.mark.parametrize("links", [496, 497])
    def test_long_chains_of_links(self, tmp_path, links):
        joint = "<Joint name='j{0}'><Body>l{0}</Body><Body>l{1}</Body></Joint>"
        content = "\n".join(f"<Body name='l{i}'/>" for i in range(links))
        content += "".join(joint.format(i, i + 1) for i in range(links - 1))
        (tmp_path / MAIN).write_text(body(content))
        if links <= 496:
            assert ravemj.load(tmp_path / MAIN).model.nbody == links + 1
            return
        with pytest.raises(ravemj.CompileError, match="chain of 496 links") as caught:
            ravemj.load(tmp_path / MAIN)
        assert caught.value.source == (str(tmp_path / MAIN), links, None)

    @pytest.mark.stress
    def test_many_misspelt_tags(self, run):
        assert run(body(LINK + "<Bodey/>" * 100_000)).links == 1

    @pytest.mark.parametrize(
        ("text", "count", "most"), [("x" * 10**6, 4, 400), ("it's " * 10**6, 5, 3000)], ids=["word", "apostrophes"]
    )
    def test_messages_stay_short(self, tmp_path, text, count, most):
        tags = '<Translation>{0}</Translation><Mass type="{0}"/><Geom type="{0}"/><offsetfrom>{0}</offsetfrom>'
        (tmp_path / MAIN).write_text(body(f"<Body name='A'>{tags.format(text)}</Body>"))
        findings = [str(finding) for finding in read_file(tmp_path / MAIN).diagnostics]
        assert len(findings) == count
        assert max(map(len, findings)) < most

    @pytest.mark.parametrize("name", ["a---b.xml", "a--->b.xml", "new\nline.xml", "control\x01.xml", "\udcff.xml"])
    def test_strange_paths(self, tmp_path, name):
        (tmp_path / name).write_text(body(LINK))
        env = ravemj.load(tmp_path / name)
        compiled = env.simulation.compiled().mjcf
        assert len(compiled.sources) == compiled.text.count("\n")
        root = etree.fromstring(compiled.text.encode())
        assert "".join(root.itertext()).strip() == ""

    def test_loading_a_pipe(self, tmp_path):
        os.mkfifo(tmp_path / "pipe.xml")
        with time_limit():  # it would wait for a writer
            assert ravemj.Environment().Load(tmp_path / "pipe.xml") is False

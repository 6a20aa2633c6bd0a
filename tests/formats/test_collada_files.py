"""COLLADA robots of several files, by all the ways to name them, and what the commands make of them."""

import json
import os
import runpy
import zipfile
from pathlib import Path

import mujoco
import numpy as np
import pytest
from command_line import run
from conftest import DATA, MODELS, one_in
from PIL import Image

import ravemj
from ravemj.cli import main
from ravemj.formats.readers import read_file

COLLADA = DATA / "collada"
CORNERS = np.array([[0, 0, 0], [0, 0.2, 0], [0.2, 0, 0], [0, 0, 0.2]])
SMALL = ("--size", "96x72")


def bodies(path) -> dict:
    reading = read_file(path)
    assert reading.failure is None, reading.failure
    return {body.name: body for body in reading.scene.bodies}


def codes(path) -> list[str]:
    return sorted(finding.code for finding in read_file(path).diagnostics)


def vertices(geometry) -> np.ndarray:
    """Return the corners of a shape in its link."""
    T = geometry.T_link_geometry.matrix()
    return geometry.shape.mesh.vertices @ T[:3, :3].T + T[:3, 3]


@pytest.fixture
def zae(tmp_path) -> Path:
    """The SCARA in an archive."""
    path = tmp_path / "scara.zae"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(MODELS / "scara.dae", "scara.dae")
    return path


class TestOtherFiles:
    def test_two_robots_and_a_body_take_kinematics_and_shapes_from_another_file(self):
        found = bodies(COLLADA / "pair.dae")
        assert [(name, body.is_robot) for name, body in found.items()] == [
            ("hinge", True),
            ("hinge0", True),
            ("crate", False),
        ]
        for name, x in (("hinge", 0), ("hinge0", 2)):
            base, leaf = found[name].links
            assert (base.T_world_link.position, leaf.T_world_link.position) == ((x, 0, 0), (x, 0, 0.5))
            (plate,) = leaf.geometries
            np.testing.assert_allclose(vertices(plate), CORNERS, atol=1e-7)  # in the unit of its own file
            assert [joint.name for joint in found[name].joints] == ["hinge"]
        assert found["crate"].links[0].T_world_link.position == (0, 3, 0)

    def test_the_files_that_were_read_are_known(self):
        assert [Path(file).name for file in read_file(COLLADA / "pair.dae").files] == ["pair.dae", "shapes.dae"]

    def test_other_sets_of_shapes_are_left_out_and_links_can_be_hidden(self):
        found = bodies(COLLADA / "pair.dae")
        visible = [part.visible for name in ("hinge", "hinge0") for part in found[name].links[1].geometries]
        assert visible == [True, False]
        assert codes(COLLADA / "pair.dae") == ["ignored-tag"]

    @pytest.mark.parametrize("name", ["right_system", "right"])
    def test_an_id_behind_the_file_picks_one_body(self, name):
        assert list(bodies(f"{COLLADA}/pair.dae#{name}")) == ["hinge"]

    def test_an_id_that_is_not_there(self):
        failure = read_file(f"{COLLADA}/pair.dae#middle").failure
        assert str(failure).startswith(
            f"{COLLADA}/pair.dae:3: error: <COLLADA>: there is no articulated system 'middle'"
        )

    def test_an_id_in_an_archive_and_a_number_sign_in_a_name(self, zae):
        assert list(bodies(f"{zae}#motion")) == list(bodies(f"{zae}#kinematics")) == ["scara"]
        odd = zae.rename(zae.with_name("a#b.zae"))
        assert list(bodies(odd)) == list(bodies(f"{odd}#motion")) == ["scara"]

    @pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")
    def test_a_robot_of_the_api_by_uri(self, monkeypatch):
        monkeypatch.setenv("OPENRAVE_DATA", str(COLLADA.parent))
        env = ravemj.Environment()
        robot = env.ReadRobotURI("openrave:/collada/pair.dae#right_system")
        assert robot.GetName() == "hinge"


class TestInXml:
    def load(self, folder, text: str):
        (folder / "main.xml").write_text(text)
        return bodies(folder / "main.xml")

    def test_the_model_is_scaled(self, tmp_path, monkeypatch):
        monkeypatch.setenv("OPENRAVE_DATA", str(MODELS))
        plain = self.load(tmp_path, '<Robot file="scara.dae"/>')["scara"]
        large = self.load(tmp_path, '<Robot file="scara.dae" scalegeometry="2"/>')["scara"]
        for one, other in zip(plain.links, large.links, strict=True):
            np.testing.assert_allclose(2 * np.array(one.T_world_link.position), other.T_world_link.position)
            np.testing.assert_allclose(one.T_world_link.wxyz, other.T_world_link.wxyz)
            np.testing.assert_allclose(2 * np.array(one.inertial.com), other.inertial.com)
            assert one.inertial.mass == other.inertial.mass
            for shape, scaled in zip(one.geometries, other.geometries, strict=True):
                np.testing.assert_allclose(2 * vertices(shape), vertices(scaled), rtol=1e-6)
        assert [joint.axes[0].upper for joint in large.joints] == pytest.approx(
            [joint.axes[0].upper * (2 if joint.kind == "slider" else 1) for joint in plain.joints]
        )

    def test_scales_multiply_and_uneven_ones_are_reported(self, tmp_path, monkeypatch):
        monkeypatch.setenv("OPENRAVE_DATA", str(MODELS))
        inner = '<Robot file="scara.dae" scalegeometry="3"/>'
        found = self.load(tmp_path, f'<Robot name="r" scalegeometry="2">{inner}</Robot>')["r"]
        assert found.links[1].T_world_link.position == pytest.approx((6 * 0.425, 0, 6 * 0.877))
        self.load(tmp_path, '<Robot file="scara.dae" scalegeometry="1 2 3"/>')
        assert "ignored-attribute" in codes(tmp_path / "main.xml")

    def test_an_id_picks_the_body(self, tmp_path, monkeypatch):
        monkeypatch.setenv("OPENRAVE_DATA", str(COLLADA))
        found = self.load(tmp_path, '<Robot file="pair.dae#right_system" prefix="r_"/>')
        assert [link.name for link in found["hinge"].links] == ["r_base", "r_leaf"]


class TestFunctions:
    @pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")  # the MJCF has polynomials in their place
    def test_followers(self):
        robot = ravemj.load(COLLADA / "functions.dae").GetBodies()[0]
        for angle in (-0.4, 0.2, 0.5, 0.6, 1.3):
            robot.SetDOFValues([angle])
            values = [joint.GetValue(0) for joint in robot.GetPassiveJoints()]
            third = np.sqrt(9 + 16 - 24 * np.cos(angle))  # the side that the others enclose
            corner = np.arctan2(3 * np.sin(angle) / third, (16 + third**2 - 9) / (8 * third))
            np.testing.assert_allclose(values, [corner, 0.5 if angle > 0.5 else 2 * angle], atol=1e-9)

    @pytest.mark.parametrize(
        ("old", "new", "said"),
        [
            ("#bent", "#straight", "there is no function 'bent'"),
            ("<cn>0.5</cn>", "", "the function 'bent' has 2 parameters, not 1"),
            ("<ci>limit</ci><apply>", "<ci>levers/j0</ci><apply>", "there is no joint 'levers/j0'"),
            ("<cn>2</cn>", '<apply><csymbol definitionURL="#bent">bent</csymbol><cn>1</cn><cn>2</cn></apply>', "deep"),
            ("</piece>", "<cn>1</cn></piece>", "<piece> has 3 parts"),
            ("<otherwise>", "<piece><cn>1</cn><cn>0</cn></piece><otherwise><cn>1</cn>", "<otherwise> has 2 parts"),
        ],
    )
    def test_what_is_wrong_with_them_freezes_the_follower(self, old, new, said, tmp_path):
        text = (COLLADA / "functions.dae").read_text()
        assert text.count(old) == 1
        (tmp_path / "functions.dae").write_text(text.replace(old, new))
        reading = read_file(tmp_path / "functions.dae")
        messages = [finding.message for finding in reading.diagnostics if finding.code == "bad-mimic"]
        assert any(said in message for message in messages), messages
        (stop,) = (joint for joint in reading.scene.bodies[0].passive_joints if joint.name == "stop")
        assert stop.mimic is None

    def test_functions_that_grow_without_end_are_stopped(self, tmp_path):
        call = '<apply><csymbol definitionURL="#f{}">f</csymbol>{}</apply>'
        twice = "<apply><plus/><ci>x</ci><ci>x</ci></apply>"
        formula = '<formula id="f{}"><newparam sid="x"/><technique_common><math>{}</math></technique_common></formula>'
        chain = "".join(formula.format(n, call.format(n + 1, twice)) for n in range(30)) + formula.format(
            30, "<ci>x</ci>"
        )
        text = (COLLADA / "functions.dae").read_text().replace("</library_formulas>", f"{chain}</library_formulas>")
        (tmp_path / "functions.dae").write_text(
            text.replace("<cn>3</cn>", f"<cn>3</cn>{call.format(0, '<csymbol>levers/j0</csymbol>')}")
        )
        messages = [finding.message for finding in read_file(tmp_path / "functions.dae").diagnostics]
        assert any("too long" in message for message in messages)


PEAK = """
import hashlib, sys
from ravemj.formats import readers

def peak():
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmHWM")) * 1024

readers.read_file(sys.argv[1])  # imports
with open("/proc/self/clear_refs", "w") as counters:
    counters.write("5")  # the peak is what is held now
before = peak()
readers.read_file(sys.argv[2])
print(peak() - before)
"""


@pytest.mark.stress
@pytest.mark.skipif(not os.access("/proc/self/clear_refs", os.W_OK), reason="only Linux says how much memory was held")
def test_memory_is_bounded_by_the_size_of_the_file(tmp_path):
    script = runpy.run_path(str(MODELS.parent / "scripts" / "models" / "scara.py"))
    script["outline"].__globals__["CORNERS"] = 2000
    large = tmp_path / "large.dae"
    script["main"](large)
    size = large.stat().st_size
    assert size > 2e6
    taken = int(run(tmp_path, "-c", PEAK, MODELS / "scara.dae", large, variables={"RAVEMJ_CACHE": "off"}).stdout)
    assert 0 < taken < 20 * size


@pytest.fixture
def names(zae, monkeypatch) -> dict[str, str]:
    """Ways to name a robot in COLLADA, by what they show."""
    monkeypatch.setenv("OPENRAVE_DATA", str(MODELS.parent))
    monkeypatch.chdir(zae.parent)
    (zae.parent / "main.xml").write_text('<Robot name="scara" file="scara.zae"/>')
    return {
        "a file": str(MODELS / "scara.dae"),
        "an archive": "scara.zae",
        "a URI": "openrave:/models/scara.dae",
        "an id": "scara.zae#motion",
        "a relative path and data": "models/scara.dae",
        "xml": "main.xml",
    }


@pytest.mark.parametrize(
    "way", one_in(6, ["a file", "an archive", "a URI", "an id", "a relative path and data", "xml"])
)
def test_commands(way, names, capsys, tmp_path):
    name = names[way]
    assert main(["check", "--strict", name]) == 0
    assert main(["info", "--json", name]) == 0
    info = json.loads(capsys.readouterr().out.partition("\n")[2])
    assert [body["name"] for body in info["bodies"]] == ["scara"]
    assert main(["convert", name, "-o", str(tmp_path / "out")]) == 0
    written = tmp_path / "out" / ("main.xml" if way == "xml" else "scara.xml")
    assert {file.name for file in written.parent.glob("*.xml")} == {written.name, "scene.xml"}
    assert mujoco.MjModel.from_xml_path(str(written)).nq == 4
    assert main(["render", name, "-o", str(tmp_path / "seen.png"), *SMALL]) == 0
    assert len(np.unique(np.asarray(Image.open(tmp_path / "seen.png")).reshape(-1, 3), axis=0)) > 20
    assert main(["play", name, "-o", str(tmp_path / "frames"), "--to", "1,1,0.1,0", "--fps", "2", *SMALL]) == 0
    assert len(list((tmp_path / "frames").glob("*.png"))) == 3


@pytest.mark.parametrize("command", [["info"], ["check"], ["render", "-o", "x.png"], ["play", "-o", "x"], ["convert"]])
def test_commands_name_file_line_and_id_of_what_is_wrong(command, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = (MODELS / "scara.dae").read_text()
    line = text[: text.index('<attachment_full joint="kmodel/joint3"')].count("\n") + 1
    Path("bad.dae").write_text(text.replace('joint="kmodel/joint3"', 'joint="kmodel/joint9"'))
    assert main([command[0], "bad.dae", *command[1:]]) == 1
    said = capsys.readouterr()
    where = f"bad.dae:{line}: error"
    what = "<attachment_full> in <link> 'link2': there is no joint 'kmodel/joint9'"
    assert where in said.out + said.err
    assert what in said.out + said.err
    assert [path.name for path in tmp_path.iterdir()] == ["bad.dae"]

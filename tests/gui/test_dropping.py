"""Files that are dropped on a viewer are added to the environment; errors are shown in the view."""

import base64
import json
import os
import zipfile

import pytest
from conftest import MODELS
from waiting import await_that

from ravemj.gui.interaction import Notices
from ravemj.gui.viewers.dropping import Upload, add_files
from ravemj.gui.viewers.web.messages import parse

MUG = '<KinBody name="mug"><Body><Geom type="trimesh"><data>mug.stl</data></Geom></Body></KinBody>'
STL = b"""solid
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid
"""


@pytest.fixture
def notices():
    return Notices()


def said(notices, words):
    await_that(lambda: any(words in line for line in notices.lines), f"it does not say: {words}")


def test_a_file_is_added_and_again_under_another_name(env, notices):
    for count in (2, 3):
        add_files(env, [str(MODELS / "env.xml")], notices)
        await_that(lambda count=count: len(env.GetBodies()) == count, "it is not added")
    said(notices, "Added env.xml")
    assert len({body.GetName() for body in env.GetBodies()}) == 3


def test_a_broken_file_changes_nothing_and_the_view_says_where(env, notices, tmp_path):
    path = tmp_path / "bad.xml"
    path.write_text('<Environment><KinBody name="a"><Body/></KinBody>\n<KinBody name="b"></Body>')
    add_files(env, [str(path)], notices)
    said(notices, "bad.xml:2")
    assert len(env.GetBodies()) == 1
    add_files(env, [str(tmp_path / "none.xml")], notices)
    said(notices, "none.xml")
    add_files(None, [str(path)], notices)  # a viewer whose environment is gone


def chain_of(links):
    """Return a body that MuJoCo refuses where it has too many links."""
    parts = [f'<Body name="l{number}"/>' for number in range(links)]
    parts += [
        f'<Joint name="j{number}"><Body>l{number}</Body><Body>l{number + 1}</Body><axis>0 0 1</axis></Joint>'
        for number in range(links - 1)
    ]
    return f'<Environment><bkgndcolor>1 0 0</bkgndcolor><KinBody name="chain">{"".join(parts)}</KinBody></Environment>'


def test_what_mujoco_refuses_is_not_added_and_the_view_says_why(env, notices, tmp_path):
    path = tmp_path / "chain.xml"
    path.write_text(chain_of(510))
    env.SetViewer("offscreen")
    before = env.GetViewer().render(64, 48)
    add_files(env, [str(path)], notices)
    said(notices, "a chain of 496 links, and MuJoCo takes no longer ones")
    assert [body.GetName() for body in env.GetBodies()] == ["Pendulum"]
    assert (env.GetViewer().render(64, 48) == before).all()


def test_of_json_that_breaks_off_in_its_second_body_nothing_is_added(env, notices, tmp_path):
    add_files(env, [str(MODELS / "env.xml")], notices)
    said(notices, "Added env.xml")
    path = tmp_path / "two.json"
    env.Save(str(path))
    content = json.loads(path.read_text())
    content["bodies"][1]["joints"][0]["parentLinkName"] = "none"
    path.write_text(json.dumps(content))
    add_files(env, [str(path)], notices)
    said(notices, "two.json")
    assert len(env.GetBodies()) == 2


def piece(name, data, last=False):
    return parse(json.dumps({"type": "piece", "name": name, "data": base64.b64encode(data).decode(), "last": last}))


def test_a_page_sends_a_model_with_its_meshes_in_pieces(env, notices):
    upload = Upload()
    for name, content in (("mug.stl", STL), ("mug.kinbody.xml", MUG.encode())):
        for start in range(0, len(content), 50):
            message = piece(name, content[start : start + 50])
            assert upload.append(message.name, message.data)
    folder = upload.paths[0].rpartition("/")[0]
    with env:
        upload.add_to(env, notices)
        del upload  # as pages do, before the files are read
        assert os.path.exists(folder)
    said(notices, "Added mug.kinbody.xml")
    assert env.GetKinBody("mug").GetLinks()[0].GetGeometries()[0].GetCollisionMesh().indices.shape == (1, 3)
    await_that(lambda: not os.path.exists(folder), "the files stay")


def test_an_upload_has_an_end(monkeypatch):
    monkeypatch.setattr(Upload, "_LARGEST", 10)
    upload = Upload()
    assert upload.append("a", b"12345")
    assert not upload.append("a", b"123456")


@pytest.mark.parametrize("name", ["", "../a.xml", "a//b.xml", ".bashrc", "a\\b", "a\x00", "x" * 101, 7, None])
def test_names_lead_to_no_other_folder(name):
    with pytest.raises(ValueError, match="there are no such files"):
        parse(json.dumps({"type": "piece", "name": name, "data": "", "last": False}))


def test_pieces_are_base64():
    with pytest.raises(ValueError, match="ASCII"):
        parse(json.dumps({"type": "piece", "name": "a.xml", "data": "§", "last": False}))


ROBOT = """<robot name="r"><link name="a"><visual><geometry><mesh filename="package://pack/meshes/part.stl"/></geometry>
</visual></link></robot>"""


@pytest.fixture
def package(tmp_path):
    folder = tmp_path / "drop" / "pack"
    (folder / "urdf").mkdir(parents=True)
    (folder / "meshes").mkdir()
    (folder / "package.xml").write_text("<package><name>pack</name></package>")
    (folder / "urdf" / "r.urdf").write_text(ROBOT)
    (folder / "meshes" / "part.stl").write_bytes(STL)
    return folder


def shown_triangles(env):
    return sum(
        len(surface.mesh.triangles)
        for body in env.GetBodies()
        for link in body.simulation_state.scene.links
        for geometry in link.geometries
        for surface in geometry.display or ()
    )


def zipped(package):
    path = package.parent / "robot.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for file in sorted(package.rglob("*")):
            archive.write(file, file.relative_to(package.parent))
    return path


@pytest.mark.parametrize("packed", [False, True])
def test_a_folder_or_zip_is_one_drop(env, notices, package, packed):
    add_files(env, [str(zipped(package) if packed else package)], notices)
    said(notices, "Added r.urdf")
    assert shown_triangles(env) == 1


def test_a_robot_without_its_meshes_is_shown_and_says_what_to_drop(env, notices, package, tmp_path):
    alone = tmp_path / "alone" / "r.urdf"
    alone.parent.mkdir()
    alone.write_text(ROBOT)
    add_files(env, [str(alone)], notices)
    said(notices, "drop the folder that contains meshes/")
    assert len(env.GetBodies()) == 2


def test_a_folder_with_several_robots_says_so(env, notices, package):
    (package / "urdf" / "s.urdf").write_text(ROBOT)
    add_files(env, [str(package)], notices)
    said(notices, "there are 2 robots in it: r.urdf, s.urdf")


def test_a_xacro_is_not_expanded(env, notices, package):
    path = package / "urdf" / "r.urdf.xacro"
    path.write_text('<robot name="r" xmlns:xacro="x"><xacro:property name="p" value="${1/0}"/></robot>')
    add_files(env, [str(path)], notices)
    said(notices, "a xacro that was dropped is not expanded")


@pytest.mark.parametrize("name", ["../out.urdf", "/out.urdf", "a/../../out.urdf", "..\\out.urdf"])
def test_a_zip_writes_nothing_outside(env, notices, tmp_path, name):
    path = tmp_path / "bad.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(name, ROBOT)
    add_files(env, [str(path)], notices)
    said(notices, "outside of itself")
    assert not list(tmp_path.rglob("out.urdf"))


def test_a_zip_that_unpacks_to_too_much_is_refused(env, notices, tmp_path):
    path = tmp_path / "bomb.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("r.urdf", b"\0" * 10_000_000)
    add_files(env, [str(path)], notices)
    said(notices, "it unpacks to")


def test_pages_send_files_of_folders(env, notices, package):
    upload = Upload()
    for file in ("urdf/r.urdf", "meshes/part.stl"):
        data = base64.b64encode((package / file).read_bytes()).decode()
        piece = parse(json.dumps({"type": "piece", "name": f"pack/{file}", "data": data, "last": False}))
        assert upload.append(piece.name, piece.data)
    upload.add_to(env, notices)
    said(notices, "Added r.urdf")
    assert shown_triangles(env) == 1
    for name in ("../r.urdf", "a/../r.urdf", "/r.urdf", "a//r.urdf", "a/" * 20 + "r.urdf", "a\\b.urdf"):
        with pytest.raises(ValueError, match="no such files"):
            parse(json.dumps({"type": "piece", "name": name, "data": "", "last": True}))

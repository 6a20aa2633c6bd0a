"""URDF: what a document means, against Pinocchio's answers and variations of them."""

import json
import warnings

import numpy as np
import pytest
from conftest import DATA

import ravemj
from ravemj.formats.readers import read_data, read_file

EDGES = json.loads((DATA / "urdf" / "edges.json").read_text())

REFUSED = {
    "axis 0": "the axis of joint 'j' is 0 0 0",
    "axis no xyz": "<axis> has no xyz",
    "no root": "joint 'j' and those that carry it make a loop",
    "two parents": "link 'b' is the child of two joints, 'j' in line 1 and 'l'",
    "dup link": "there are two links 'a'; the other one is in line 1",
    "dup joint": "there are two joints 'j'; the other one is in line 1",
    "unknown child": "there is no link 'x'",
    "planar x": "a joint of type 'planar'",
    "type ball": "no joint type 'ball'",
    "type Revolute": "no joint type 'Revolute'; did you mean 'revolute'?",
    "rpy and comma": 'xyz="1,0,0" of <origin> should be 3 numbers',
    "xyz two numbers": 'xyz="1 0" of <origin>',
    "number 1e": 'xyz="1 0 x" of <origin>',
    "nan": 'xyz="nan 0 0" of <origin>',
}
FINDINGS = {
    "axis 0 0 2": "axis-length",
    "axis 1 0 1": "axis-length",
    "prismatic axis 0 0 2": "axis-length",
    "no limit": "missing-limit",
    "limit no effort": "missing-limit",
    "lower>upper": "exchanged-limits",
    "two roots": "several-roots",
    "floating": "floating-joint",
    "no name": "no-name",
    "version 2": "unknown-version",
    "mimic missing": "bad-mimic",
    "mimic self": "bad-mimic",
    "two <axis>": "repeated-tag",
    "dup material": "repeated-tag",
}
ERRORS = {"no limit", "two roots", "mimic missing", "mimic self"}
"""Mistakes for which ``Load`` returns False though the robot is there."""


@pytest.mark.parametrize("case", EDGES)
def test_the_edge_cases(case):
    reading = read_data(EDGES[case]["urdf"])
    if case in REFUSED:
        assert REFUSED[case] in str(reading.failure)
        assert str(reading.failure).startswith("data:1: error: ")
        assert not reading.scene.bodies
        return
    assert reading.failure is None
    found = [(finding.severity, finding.code) for finding in reading.diagnostics]
    wanted = [("error" if case in ERRORS else "warning", FINDINGS[case])] if case in FINDINGS else []
    assert found == wanted
    truth = EDGES[case]["pinocchio"]
    if truth["loads"] and truth["first_joint"] is not None and case != "mimic":  # which Pinocchio does not let follow
        robot = loaded(EDGES[case]["urdf"])
        for joint in robot.GetJoints():
            robot.SetDOFValues([0.5 if joint.GetName() == truth["joints"][0] else 0.0], [joint.GetDOFIndex()], 0)
        for link, pose in truth["poses"].items():
            np.testing.assert_allclose(robot.GetLink(link).GetTransform()[:3].ravel(), pose, rtol=0, atol=1e-9)


def loaded(text, **given):
    env = ravemj.Environment()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        env.LoadData(text, given)
    return env.GetRobots()[0]


def urdf(*elements, links="abc", attributes=""):
    names = "".join(f'<link name="{name}"/>' for name in links)
    return f'<robot name="r" {attributes}>\n{names}\n' + "\n".join(elements) + "</robot>"


def joint(name, parent, child, inner="", kind="revolute"):
    limit = '<limit lower="-2" upper="2" effort="3" velocity="4"/>'
    inner = inner if "<limit" in inner or kind == "fixed" else inner + limit
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{inner}</joint>'


SRDF = '<robot name="r"/>'
TWO = urdf(joint("j", "a", "b"), joint("k", "b", "c"))


def codes(text):
    reading = read_data(text)
    assert reading.failure is None, reading.failure
    return [finding.code for finding in reading.diagnostics if finding.severity != "note"]


def test_rpy_are_turns_about_fixed_axes():
    roll, pitch, yaw = 0.3, -1.1, 2.2
    robot = loaded(urdf(joint("j", "a", "b", f'<origin xyz="1 2 3" rpy="{roll} {pitch} {yaw}"/>'), links="ab"))
    about = ravemj.matrixFromAxisAngle
    turned = about([0, 0, yaw]) @ about([0, pitch, 0]) @ about([roll, 0, 0])
    turned[:3, 3] = 1, 2, 3
    np.testing.assert_allclose(robot.GetLink("b").GetTransform(), turned, atol=1e-12)


def test_the_root_comes_first_and_the_others_in_the_order_of_the_file():
    text = urdf(joint("k", "a", "c"), joint("j", "b", "a"), links="cab")
    assert [link.GetName() for link in loaded(text).GetLinks()] == ["b", "c", "a"]
    assert [one.GetName() for one in loaded(text).GetJoints()] == ["k", "j"]
    by_name = loaded(text, like="or_urdf", srdf=SRDF)
    assert [link.GetName() for link in by_name.GetLinks()] == ["b", "a", "c"]
    assert [one.GetName() for one in by_name.GetJoints()] == ["j", "k"]


@pytest.mark.parametrize("leader_first", [True, False])
def test_a_follower_has_all_digits_and_follows_followers(leader_first):
    leading = joint("j", "a", "b")
    second = joint("k", "b", "c", '<mimic joint="j" multiplier="-0.321428571428" offset="0.25"/>')
    third = joint("l-2.x", "c", "d", '<mimic joint="k"/>', "prismatic")
    joints = [leading, second, third]
    robot = loaded(urdf(*(joints if leader_first else reversed(joints)), links="abcd"))
    assert robot.GetDOF() == 1
    robot.SetDOFValues([0.7])
    value = -0.321428571428 * 0.7 + 0.25
    assert robot.GetJoint("k").GetMimicEquation() == "j*-0.321428571428+0.25"
    assert robot.GetJoint("k").GetValue(0) == pytest.approx(value, abs=1e-12)
    assert robot.GetJoint("l-2.x").GetValue(0) == pytest.approx(value, abs=1e-12)


def test_a_follower_without_limits_of_its_own_moves():
    follower = joint("k", "b", "c", '<mimic joint="j" multiplier="2"/><limit effort="1" velocity="1"/>')
    robot = loaded(urdf(joint("j", "a", "b"), follower))
    robot.SetDOFValues([0.5])
    assert robot.GetJoint("k").GetValue(0) == pytest.approx(1.0)
    assert codes(urdf(joint("j", "a", "b"), follower)) == []


def test_followers_in_a_circle_do_not_move():
    text = urdf(
        joint("j", "a", "b", '<mimic joint="k"/>'), joint("k", "b", "c", '<mimic joint="j"/>'), joint("l", "c", "d"),
        links="abcd",
    )  # fmt: skip
    assert set(codes(text)) == {"bad-mimic"}
    assert loaded(text).GetDOF() == 1


def test_limits_of_all_kinds():
    limit = '<limit lower="-1" upper="2" effort="-3" velocity="0" acceleration="5" jerk="6"/>'
    dynamics = '<dynamics damping="0.7" friction="0.2"/>'
    robot = loaded(urdf(joint("j", "a", "b", limit + dynamics), joint("k", "b", "c", kind="continuous")))
    j, k = robot.GetJoints()
    assert np.ravel(j.GetLimits()).tolist() == [-1, 2]
    assert j.GetMaxTorque() == 3
    assert j.GetMaxVel() == 10  # 0 would stop planners
    assert j.GetMaxAccel() == 5
    assert j.GetMaxJerk() == 6
    axis = robot.simulation_state.scene.joints[0].axes[0]
    assert (axis.viscous_friction, axis.coulomb_friction) == (0.7, 0.2)
    assert k.IsCircular(0)
    assert codes(urdf(joint("j", "a", "b", limit), links="ab")) == ["zero-velocity"]
    drake = '<limit lower="-1" upper="2" effort="3" velocity="1" drake:acceleration="7"/>'
    text = urdf(joint("j", "a", "b", drake), links="ab", attributes='xmlns:drake="d"')
    assert loaded(text).GetJoints()[0].GetMaxAccel() == 7


def test_a_joint_without_room_is_a_weld():
    text = urdf(joint("j", "a", "b", '<limit effort="1" velocity="1"/>'), links="ab")
    assert codes(text) == ["no-room"]
    assert loaded(text).GetJoints()[0].IsStatic()


def test_values_outside_of_limits_are_one_finding():
    limit = '<limit lower="0.5" upper="2" effort="1" velocity="1"/>'
    reading = read_data(urdf(joint("j", "a", "b", limit), joint("k", "b", "c", limit)))
    (finding,) = reading.diagnostics
    assert finding.code == "value-outside-limits"
    assert finding.message.endswith("(and 1 more joints of it)")
    np.testing.assert_allclose(loaded(urdf(joint("j", "a", "b", limit), links="ab")).GetDOFValues(), [0.5])


def test_a_floating_joint_below_an_empty_root_makes_a_second_root():
    text = urdf(joint("f", "a", "b", '<origin xyz="0 0 1"/>', "floating"), joint("j", "b", "c"))
    robot = loaded(text)
    robot.SetDOFValues([0.5])
    np.testing.assert_allclose(robot.GetLink("c").GetTransform()[:3, 3], [0, 0, 1])
    shaped = text.replace('<link name="a"/>', f'<link name="a">{shape("sphere", SIZE)}</link>')
    assert "floating joint 'f' has six DOFs" in str(read_data(shaped).failure)
    below = urdf(joint("j", "a", "b"), joint("f", "b", "c", kind="floating"))
    assert ":4: error: floating joint 'f'" in str(read_data(below).failure)


SIZE = 'radius="1"'
INERTIAL = '<inertial><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/><mass value="2"/>{}</inertial>'


def test_inertia_is_turned_into_the_axes_of_the_link():
    tensor = '<inertia ixx="1" ixy="0.1" ixz="0.2" iyy="2" iyz="0.3" izz="2.5"/>'
    link = loaded(f'<robot name="r"><link name="a">{INERTIAL.format(tensor)}</link></robot>').GetLinks()[0]
    assert link.GetMass() == 2
    np.testing.assert_allclose(link.GetLocalCOM(), [1, 2, 3])
    wanted = [[2, -0.1, -0.3], [-0.1, 1, 0.2], [-0.3, 0.2, 2.5]]
    np.testing.assert_allclose(link.GetLocalInertia(), wanted, atol=1e-12)


def test_an_inertial_without_its_parts_is_an_error():
    assert codes(f'<robot name="r"><link name="a">{INERTIAL.format("")}</link></robot>') == ["missing-inertia"]


def link_with(inner):
    return f'<robot name="r">\n<link name="a">\n{inner}</link></robot>'


def shape(kind, inner, more="", tag="visual"):
    return f'<{tag}><origin xyz="0 0 1"/><geometry><{kind} {inner}/></geometry>{more}</{tag}>'


def geometries(text):
    (link,) = read_data(text).scene.bodies[0].links
    return link.geometries


@pytest.mark.parametrize(
    ("kind", "sizes", "reach"),
    [
        ("box", 'size="1 2 4"', [0.5, 1, 2]),
        ("sphere", 'radius="2"', [2, 2, 2]),
        ("cylinder", 'radius="0.5" length="4"', [0.5, 0.5, 2]),
        ("capsule", 'radius="0.5" length="4"', [0.5, 0.5, 2.5]),
    ],
)
def test_shapes_have_full_sizes_and_lie_along_z(kind, sizes, reach):
    visual, collision = geometries(link_with(shape(kind, sizes) + shape(kind, sizes, tag="collision")))
    lower, upper = collision.shape.bounds(np.eye(4))
    np.testing.assert_allclose(upper, reach)
    np.testing.assert_allclose(lower, -np.array(reach))
    assert (visual.visible, collision.visible) == (True, False)
    np.testing.assert_allclose(visual.display[0].mesh.vertices.max(axis=0), reach, rtol=0.05)
    assert visual.T_link_geometry.position == (0, 0, 1)


def test_what_is_drawn_does_not_collide():
    text = link_with(shape("box", 'size="1 1 1"'))
    env = ravemj.Environment()
    env.LoadData(text)
    env.LoadData(text)
    assert not env.CheckCollision(*env.GetBodies())


def test_links_have_the_groups_of_or_urdf():
    inner = shape("box", 'size="1 1 1"', tag="visual") + shape("sphere", 'radius="1"', tag="collision")
    group = '<geometry_group name="coarse"><geometry><sphere radius="3"/></geometry></geometry_group>'
    text = f'<robot name="r"><link name="a">{inner}</link><link name="b">{group}</link>{joint("j", "a", "b")}</robot>'
    first, second = loaded(text).GetLinks()
    names = ("visual", "spheres", "coarse", "self")
    assert [len(first.GetGeometriesFromGroup(name)) for name in names] == [1, 0, 0, 2]
    assert [len(second.GetGeometriesFromGroup(name)) for name in names] == [0, 0, 1, 0]


RED = '<material name="{}"><color rgba="1 0 0 0.25"/></material>'
BLUE = '<material name="{}"><color rgba="0 0 1 1"/></material>'


def colours(text):
    return [shown.display[0].diffuse for shown in geometries(text)]


def test_the_first_colour_of_a_name_counts_everywhere():
    box = 'size="1 1 1"'
    text = link_with(shape("box", box, RED.format("m")) + shape("box", box, BLUE.format("m")))
    assert colours(text) == [(1, 0, 0), (1, 0, 0)]
    assert codes(text) == ["material-redefined"]
    assert geometries(text)[0].display[0].transparency == 0.75
    top = text.replace('<robot name="r">', f'<robot name="r">{BLUE.format("m")}')
    assert colours(top) == [(0, 0, 1), (0, 0, 1)]


def test_a_material_without_a_name_is_its_own():
    box = 'size="1 1 1"'
    text = link_with(shape("box", box, RED.format("")) + shape("box", box, BLUE.format("")))
    assert colours(text) == [(1, 0, 0), (0, 0, 1)]
    assert codes(text) == []


def test_a_material_that_is_not_defined_is_a_warning():
    text = link_with(shape("box", 'size="1 1 1"', '<material name="rde"/>'))
    text = text.replace('<robot name="r">', f'<robot name="r">{RED.format("red")}')
    (finding,) = read_data(text).diagnostics
    assert (finding.code, finding.hint) == ("unknown-material", "did you mean 'red'?")


STL = """solid s
facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet
facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet
endsolid"""
DAE = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="0.5"/>
<up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">
0 0 0 1 0 0 0 0 4</float_array><technique_common><accessor source="#a" count="3" stride="3">
<param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v">
<input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


@pytest.fixture
def robot_folder(tmp_path):
    """A package ``my_robot`` with a URDF in ``urdf`` and meshes in ``meshes``."""
    folder = tmp_path / "my_robot"
    (folder / "urdf").mkdir(parents=True)
    (folder / "meshes").mkdir()
    (folder / "meshes" / "part.stl").write_text(STL)
    (folder / "meshes" / "part.dae").write_text(DAE)
    return folder


def read_mesh_robot(folder, uri, more="", tag="collision", **given):
    path = folder / "urdf" / "r.urdf"
    path.write_text(link_with(shape("mesh", f'filename="{uri}" {more}', tag=tag)))
    return read_file(path, given)


def only_mesh(reading):
    (link,) = reading.scene.bodies[0].links
    assert [finding.code for finding in reading.diagnostics] == []
    return link.geometries[0].shape.mesh


def test_the_up_axis_of_collada_is_ignored_and_its_unit_is_not(robot_folder):
    vertices = only_mesh(read_mesh_robot(robot_folder, "../meshes/part.dae")).vertices
    np.testing.assert_allclose(vertices.max(axis=0), [0.5, 0, 2])


@pytest.mark.parametrize(
    ("text", "factors"), [("", (1, 1, 1)), ("0.5", (0.5, 0.5, 0.5)), ("1 2 -3", (1, 2, -3)), ("-1 -1 1", (-1, -1, 1))]
)
def test_mirrored_meshes_keep_their_outside(robot_folder, text, factors):
    plain = only_mesh(read_mesh_robot(robot_folder, "../meshes/part.stl"))
    mesh = only_mesh(read_mesh_robot(robot_folder, "../meshes/part.stl", f'scale="{text}"' if text else ""))
    np.testing.assert_allclose(mesh.vertices, plain.vertices * factors)
    corners, before = mesh.vertices[mesh.triangles], plain.vertices[plain.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outside = np.cross(before[:, 1] - before[:, 0], before[:, 2] - before[:, 0])
    assert (np.sum(normals * (outside / factors), axis=1) > 0).all()


URIS = {
    "package://my_robot/meshes/part.stl": "the folder above has the name of the package",
    "package:///my_robot/meshes/part.stl": "slashes more are stripped",
    "model://my_robot/meshes/part.stl": "Gazebo's scheme",
    "../meshes/part.stl": "relative to the URDF",
    "file:../meshes/part.stl": "relative, with a scheme",
    "package://my_robot/meshes/../meshes/part.stl": "dots lead back",
}


@pytest.mark.parametrize("uri", URIS)
def test_uris_lead_to_files(robot_folder, uri):
    reading = read_mesh_robot(robot_folder, uri)
    assert only_mesh(reading).triangles.shape == (2, 3)
    assert str(robot_folder / "meshes" / "part.stl") in reading.files


def test_a_file_of_another_machine_is_looked_for_beside_the_urdf(robot_folder):
    (robot_folder / "urdf" / "there.stl").write_text(STL)
    assert only_mesh(read_mesh_robot(robot_folder, "file:///usr/elsewhere/there.stl")) is not None


@pytest.mark.parametrize("variable", ["ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "GZ_SIM_RESOURCE_PATH", "OPENRAVE_DATA"])
def test_packages_of_the_environment(robot_folder, tmp_path, monkeypatch, variable):
    place = tmp_path / "ws" / ("share" if variable.endswith("PREFIX_PATH") else "") / "other" / "meshes"
    place.mkdir(parents=True)
    (place / "part.stl").write_text(STL)
    monkeypatch.setenv(variable, str(tmp_path / "ws"))
    assert only_mesh(read_mesh_robot(robot_folder, "package://other/meshes/part.stl")) is not None


def test_a_manifest_names_the_package(robot_folder):
    (robot_folder / "package.xml").write_text("<package>\n <name> other_name </name></package>")
    assert only_mesh(read_mesh_robot(robot_folder, "package://other_name/meshes/part.stl")) is not None


def test_a_package_may_be_given(robot_folder, tmp_path):
    uri = "package://elsewhere/part.stl"
    assert only_mesh(read_mesh_robot(robot_folder, uri, packages=f"elsewhere={robot_folder / 'meshes'}")) is not None
    wrong = read_mesh_robot(robot_folder, uri, packages="elsewhere")
    assert "'elsewhere' should be NAME=FOLDER" in str(wrong.failure)


def test_a_missing_mesh_says_where_it_was_searched(robot_folder):
    reading = read_mesh_robot(robot_folder, "package://nowhere/part.stl")
    (finding,) = reading.diagnostics
    assert (finding.severity, finding.code) == ("warning", "missing-file")
    assert "no folder of that name" in finding.message
    assert "--package nowhere=FOLDER" in finding.hint
    (finding,) = read_mesh_robot(robot_folder, "package://my_robot/part.stl").diagnostics
    assert str(robot_folder) in finding.message
    assert finding.source.line == 3


def test_addresses_and_formats_that_are_not_read(robot_folder):
    (finding,) = read_mesh_robot(robot_folder, "https://example.com/part.stl").diagnostics
    assert (finding.severity, finding.code) == ("error", "refused-file")
    (robot_folder / "meshes" / "part.mesh").write_text("Ogre")
    (finding,) = read_mesh_robot(robot_folder, "../meshes/part.mesh").diagnostics
    assert (finding.severity, finding.code) == ("error", "unknown-mesh")


def test_a_visual_mesh_keeps_its_colours_without_a_material(robot_folder):
    (robot_folder / "meshes" / "c.obj").write_text("mtllib c.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (robot_folder / "meshes" / "c.mtl").write_text("newmtl red\nKd 1 0 0\n")
    reading = read_mesh_robot(robot_folder, "../meshes/c.obj", tag="visual")
    (drawn,) = reading.scene.bodies[0].links[0].geometries
    assert drawn.display[0].diffuse == (1, 0, 0)


def test_extensions_of_other_programs_are_one_note_for_each_kind():
    others = '<gazebo/><gazebo reference="a"/><transmission name="t"/><my:tag xmlns:my="x"/>'
    text = urdf(others, joint("j", "a", "b"), links="ab")
    found = [(finding.severity, finding.code, finding.message) for finding in read_data(text).diagnostics]
    assert found == [
        ("note", "left-out", "<gazebo> is left out, 2 in the file"),
        ("note", "left-out", "<transmission> is left out, 1 in the file"),
    ]


def test_an_unknown_tag_is_a_warning_with_a_guess():
    (finding,) = read_data(link_with("<visuals/>")).diagnostics
    assert (finding.code, finding.hint) == ("unknown-tag", "did you mean 'visual'?")


def test_half_a_file_is_no_robot():
    reading = read_data(TWO[:-30])
    assert reading.failure is not None
    assert not reading.scene.bodies


def test_entities_are_refused():
    text = '<!DOCTYPE robot [<!ENTITY x "1 0 0">]>' + TWO.replace("/></joint", '/><axis xyz="&x;"/></joint', 1)
    assert "the entity &x; is not supported" in str(read_data(text).failure)


def test_given_attributes_act():
    robot = loaded(TWO, name="other", prefix="p/")
    assert robot.GetName() == "other"
    assert [one.GetName() for one in robot.GetJoints()] == ["p/j", "p/k"]
    text = link_with(shape("box", 'size="1 1 1"'))
    assert not loaded(text, skipgeometry="1").GetLinks()[0].GetGeometries()


def test_a_second_robot_of_the_same_name_gets_another_name():
    env = ravemj.Environment()
    assert env.LoadData(TWO)
    assert env.LoadData(TWO)
    assert len({robot.GetName() for robot in env.GetRobots()}) == 2


@pytest.mark.parametrize("read", ["ReadRobotData", "ReadKinBodyData"])
def test_the_functions_that_read_bodies_take_urdf(read):
    env = ravemj.Environment()
    body = getattr(env, read)(TWO)
    env.Add(body)
    assert body.GetDOF() == 2


def test_a_urdf_is_part_of_an_openrave_file(robot_folder, tmp_path):
    (robot_folder / "urdf" / "r.urdf").write_text(TWO)
    scene = tmp_path / "scene.env.xml"
    scene.write_text(
        '<Environment><Robot name="left"><Robot file="my_robot/urdf/r.urdf" prefix="l_"/>'
        "<Translation>1 2 3</Translation>"
        "<Manipulator name='arm'><base>l_a</base><effector>l_c</effector></Manipulator></Robot>"
        '<KinBody name="right" file="my_robot/urdf/r.urdf"><Translation>-1 0 0</Translation></KinBody></Environment>'
    )
    env = ravemj.load(scene)
    left, right = env.GetRobot("left"), env.GetKinBody("right")
    assert [link.GetName() for link in left.GetLinks()] == ["l_a", "l_b", "l_c"]
    np.testing.assert_allclose(left.GetTransform()[:3, 3], [1, 2, 3])
    assert left.GetManipulator("arm").GetArmDOF() == 2
    assert not right.IsRobot()
    assert right.GetDOF() == 2


XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="tip" default="c"/><link name="a"/>
<link name="$(arg tip)"/><joint name="j" type="revolute"><parent link="a"/><child link="$(arg tip)"/>
<limit lower="-1" upper="${pi / 2}" effort="1" velocity="1"/></joint></robot>"""


def test_comments_make_no_xacro(tmp_path):
    (tmp_path / "r.urdf").write_text(TWO.replace("</robot>", "<!-- <xacro:arm/> -->\n</robot>"))
    assert read_file(tmp_path / "r.urdf").failure is None


@pytest.mark.parametrize("name", ["r.urdf", "r.urdf.xacro"])
def test_a_xacro_is_expanded_for_its_user(tmp_path, name):
    pytest.importorskip("xacrodoc", reason="needs the extra xacro")
    (tmp_path / name).write_text(XACRO)
    reading = read_file(tmp_path / name, {"args": "tip:=hand"})
    (body,) = reading.scene.bodies
    assert [link.name for link in body.links] == ["a", "hand"]
    assert body.joints[0].axes[0].upper == pytest.approx(np.pi / 2)


@pytest.mark.stress
def test_a_xacro_that_never_ends_is_stopped(tmp_path, monkeypatch):
    pytest.importorskip("xacrodoc", reason="needs the extra xacro")
    monkeypatch.setattr("ravemj.formats.urdf.xacro.LIMIT", 1.0)
    (tmp_path / "r.xacro").write_text(XACRO.replace("pi / 2", "[1 for i in range(10 ** 12)][0]"))
    assert "is not expanded after 1 s" in str(read_file(tmp_path / "r.xacro").failure)


def test_a_mistake_in_a_xacro_is_one_line(tmp_path):
    pytest.importorskip("xacrodoc", reason="needs the extra xacro")
    (tmp_path / "r.xacro").write_text(XACRO.replace("pi / 2", "tau2"))
    assert "name 'tau2' is not defined" in str(read_file(tmp_path / "r.xacro").failure)


def test_a_xacro_without_the_extra_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    (tmp_path / "r.xacro").write_text(XACRO)
    assert 'pip install "ravemj[xacro]"' in str(read_file(tmp_path / "r.xacro").failure)


def test_a_xacro_that_another_file_or_a_text_brings_is_not_expanded(tmp_path):
    assert "only a file that its user opens is expanded" in str(read_data(XACRO).failure)
    (tmp_path / "r.xacro").write_text(XACRO)
    (tmp_path / "scene.xml").write_text('<Environment><Robot name="r" file="r.xacro"/></Environment>')
    found = read_file(tmp_path / "scene.xml").diagnostics
    assert any("only a file that its user opens" in finding.message for finding in found)

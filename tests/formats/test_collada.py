"""COLLADA robots: one small arm, and what becomes of it when one thing in the file is different."""

import io
import math
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA

import ravemj
from ravemj.formats.readers import read_data, read_file
from ravemj.model import scene
from ravemj.model.scene import Box, Cylinder, TriMesh

COLLADA = DATA / "collada"
ARM = (COLLADA / "arm.dae").read_text("utf8")
DEGREE = math.pi / 180
_WITHOUT_GRAVITY = re.sub("<gravity>.*?</gravity>", "", ARM)


def changed(*replacements: tuple[str, str], text: str = ARM) -> str:
    """Return the arm with pieces of its text replaced, each of which must be there once."""
    for old, new in replacements:
        assert text.count(old) == 1, f"{old!r} is there {text.count(old)} times"
        text = text.replace(old, new)
    return text


def arm(*replacements: tuple[str, str]):
    reading = read_data(changed(*replacements))
    assert reading.failure is None
    return reading.scene.bodies[0]


def findings(*replacements: tuple[str, str]) -> set[str]:
    return {finding.code for finding in read_data(changed(*replacements)).diagnostics}


def matrix(pose) -> np.ndarray:
    return pose.matrix()


def zipped(members: dict[str, str | bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return content.getvalue()


class TestArm:
    """The numbers of the file as it is, by the rules of the format."""

    def test_nothing_is_reported(self):
        assert list(read_data(ARM).diagnostics) == []

    def test_parts(self):
        body = arm()
        assert (body.name, body.is_robot) == ("arm", True)
        assert [link.name for link in body.links] == ["base", "upper_arm", "__dummy0"]
        assert [joint.name for joint in body.joints] == ["elbow"]
        assert [joint.name for joint in body.passive_joints] == ["grip"]
        assert body.adjacent == ((0, 2),)
        assert [link.enabled for link in body.links] == [True, True, False]
        assert [link.static for link in body.links] == [True, False, False]

    def test_poses_are_those_of_the_bound_values(self):
        body = arm()
        angle = 30 * DEGREE
        turned = np.array([[math.cos(angle), -math.sin(angle), 0], [0, 0, -1], [math.sin(angle), math.cos(angle), 0]])
        np.testing.assert_allclose(matrix(body.links[0].T_world_link)[:3, 3], [0, 0, 1], atol=1e-15)
        np.testing.assert_allclose(matrix(body.links[1].T_world_link)[:3, :3], turned, atol=1e-15)
        np.testing.assert_allclose(matrix(body.links[1].T_world_link)[:3, 3], [0.5, 0, 1], atol=1e-15)
        grip = angle / 2 - 0.25
        np.testing.assert_allclose(
            matrix(body.links[2].T_world_link)[:3, 3], [0.5, 0, 1] + turned @ [0, 2 + grip, 0], atol=1e-15
        )

    def test_axes(self):
        (elbow,), (grip,) = arm().joints, arm().passive_joints
        assert (elbow.kind, grip.kind) == ("hinge", "slider")
        np.testing.assert_allclose(elbow.axes[0].direction, [0, -1, 0], atol=1e-15)
        np.testing.assert_allclose(elbow.anchor, [0.5, 0, 0])
        axis = elbow.axes[0]
        numbers = [axis.lower, axis.upper, axis.max_velocity, axis.max_acceleration, axis.value]
        np.testing.assert_allclose(numbers, np.array([-90, 45, 2, 4, 30]) * DEGREE)
        assert (axis.weight, axis.resolution, axis.max_torque) == (3, 0.02, 20)
        assert axis.armature == pytest.approx(1)
        assert (grip.axes[0].lower, grip.axes[0].upper) == (-1, 0.5)  # its own, since the system has none

    def test_mimic(self):
        (grip,) = arm().passive_joints
        assert grip.mimic.position == "((0.5*elbow)+-0.25)"
        assert grip.mimic.expression.evaluate({"joint0": 2.0}) == 0.75
        assert grip.mimic.dofs == (0,)

    def test_masses_are_given_in_the_frame_of_the_body(self):
        base, upper, finger = arm().links
        assert (base.inertial.mass, base.inertial.com) == (2, (0, 0, 0.5))
        np.testing.assert_allclose(upper.inertial.com, [0, 0.25, 0], atol=1e-15)  # the link is turned about x
        np.testing.assert_allclose(upper.inertial.inertia, np.diag([1, 2.5, 2]), atol=1e-15)
        assert finger.inertial.mass == 1e-10

    def test_shapes(self):
        base, upper, _ = arm().links
        assert base.geometries == ()
        (wedge,) = upper.geometries
        assert isinstance(wedge.shape, TriMesh)
        assert wedge.shape.mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3], [0, 3, 1], [2, 1, 3]]
        np.testing.assert_allclose(wedge.shape.mesh.vertices, [[0, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-9)
        assert (wedge.name, wedge.diffuse, wedge.ambient) == ("wedge", (0.5, 0.25, 0), (0.25, 0, 0))
        assert wedge.transparency == 0.25
        np.testing.assert_allclose(matrix(wedge.T_link_geometry), np.eye(4), atol=1e-15)

    def test_extras(self):
        body = arm()
        (hand,) = body.manipulators
        assert (hand.name, hand.base, hand.effector, hand.arm_dofs) == ("hand", 0, 1, (0,))
        assert (hand.T_effector_tool.position, hand.direction) == ((0, 0, 0.125), (0, 1, 0))
        (eye,) = body.sensors
        assert (eye.name, eye.link, eye.T_link_sensor.position) == ("eye", 1, (0, 0, 0.25))
        assert (eye.camera.fx, eye.camera.fy, eye.camera.width, eye.camera.height) == (640, 480, 640, 480)

    def test_sensors_have_colladas_tags_or_those_of_xml(self):
        scanner = """type="base_laser2d"><angle_range>-90 45</angle_range><angle_increment>0.5</angle_increment>
            <distance_range>0.1 8</distance_range><measurement_time>0.05</measurement_time><time_increment>1e-4
            </time_increment>"""
        camera = """type="base_pinhole_camera">
        <intrinsic>640 0 320 0 480 240</intrinsic>
        <image_dimensions>640 480 3</image_dimensions>"""
        (eye,) = arm((camera, scanner)).sensors
        laser = scene.Laser(-90 * DEGREE, 45 * DEGREE, 0.5 * DEGREE, 0.1, 8.0, 0.05, 1e-4)
        assert (eye.type, eye.device) == ("base_laser2d", laser)
        named = """type="base_unknown"><interface_type><technique profile="OpenRAVE"><interface>BaseForce6D</interface>
            </technique></interface_type><polarity>-1</polarity>"""
        assert arm((camera, named)).sensors[0].device == scene.ForceTorque(polarity=-1)
        (blank,) = arm((camera, 'type="base_stereo_camera">')).sensors
        assert (blank.type, blank.device) == ("base_stereo_camera", None)
        broken = (
            """type="base_laser2d"><power>1</power><angle_increment>0</angle_increment><max_range>nan</max_range>"""
        )
        assert {"bad-sensor", "number-count"} <= findings((camera, broken))
        assert not arm((camera, broken)).sensors[0].is_on

    def test_gravity(self):
        assert read_data(ARM).scene.gravity == (0, 0, -2)


class TestTraps:
    def test_old_writers_have_radians(self):
        body = arm((">by hand<", ">OpenRAVE Collada Writer<"), (">30<", ">0.25<"))
        axis = body.joints[0].axes[0]
        assert (axis.max_velocity, axis.max_acceleration) == (2, 4)
        assert axis.value == pytest.approx(0.25)
        assert axis.lower == pytest.approx(-90 * DEGREE)  # limits are in degrees in every file

    def test_units_scale_lengths_and_no_masses(self):
        body = arm(('meter="1"', 'meter="0.001"'))
        np.testing.assert_allclose(body.links[1].T_world_link.position, [0.0005, 0, 0.001], atol=1e-15)
        assert body.links[1].inertial.mass == 4
        np.testing.assert_allclose(body.links[1].inertial.com, [0, 0.00025, 0], atol=1e-15)
        np.testing.assert_allclose(np.diag(body.links[1].inertial.inertia), [1, 2.5, 2])
        assert body.passive_joints[0].axes[0].upper == 0.0005
        np.testing.assert_allclose(body.links[1].geometries[0].shape.mesh.vertices.max(), 0.001, rtol=1e-6)

    def test_the_nearest_unit_counts(self):
        unit = '<asset><unit meter="10"/></asset><technique_common>\n        <joint name="elbow"'
        body = arm(('<technique_common>\n        <joint name="elbow"', unit))
        assert body.links[1].T_world_link.position == (5, 0, 1)

    def test_the_up_axis_turns_nothing(self):
        assert arm(("Z_UP", "Y_UP")).links == arm().links

    def test_the_first_binding_of_an_axis_wins(self):
        second = (
            '<bind_joint_axis target="visual1/finger_axis0"><axis><param>s_joint0</param></axis>'
            "<value><float>1</float></value></bind_joint_axis></instance_kinematics_scene>"
        )
        body = arm(("</instance_kinematics_scene>", second))
        assert len(body.links[1].geometries) == 1
        assert body.joints[0].axes[0].value == pytest.approx(30 * DEGREE)

    def test_the_vertices_of_a_mesh_are_its_own_whatever_their_id(self):
        replacement = ('source="#corners"', 'source="#wedge/corners"')
        assert arm(replacement).links[1].geometries == arm().links[1].geometries

    def test_one_id_may_belong_to_elements_of_two_kinds(self):
        text = ARM.replace("red-effect", "wedge")
        assert read_data(text).scene.bodies[0].links[1].geometries == arm().links[1].geometries

    def test_without_a_visual_scene_there_are_links_without_shapes(self):
        replacement = ('<instance_visual_scene url="#vscene"/>', "")
        body = arm(replacement)
        np.testing.assert_allclose(body.links[1].T_world_link.position, [0.5, 0, 0], atol=1e-15)
        assert all(not link.geometries for link in body.links)
        assert body.joints[0].axes[0].value == pytest.approx(30 * DEGREE)  # bound, though to no node
        assert findings(replacement) == {"broken-reference"}

    def test_meshes_come_from_the_cache(self, tmp_path, monkeypatch):
        monkeypatch.setenv("RAVEMJ_CACHE", str(tmp_path))
        first = arm().links
        (entry,) = (tmp_path / "meshes").iterdir()
        written = entry.stat().st_mtime_ns
        assert arm().links == first
        scaled = arm(('meter="1"', 'meter="0.5"'))
        assert (len(list((tmp_path / "meshes").iterdir())), entry.stat().st_mtime_ns) == (2, written)
        assert scaled.links[1].geometries[0].shape.mesh.vertices.max() == pytest.approx(0.5)

    def test_a_mass_without_a_frame_lies_where_the_body_is(self):
        body = arm(("<mass_frame><translate>0.5 0 0.25</translate></mass_frame>", ""))
        np.testing.assert_allclose(body.links[1].inertial.com, [-0.5, 0, 0], atol=1e-15)

    def test_a_locked_axis_is_a_weld_with_a_dof(self):
        body = arm(("<locked><bool>false", "<locked><bool>true"))
        assert (body.joints[0].axes[0].lower, body.joints[0].axes[0].upper) == (0, 0)
        assert body.joints[0].static

    @pytest.mark.parametrize("limits", [("30", "-30"), ("5", "5"), ("1e-9", "0")])
    def test_limits_that_leave_no_room_are_a_weld(self, limits):
        lower, upper = limits
        old = "<limits><min><param>low</param></min><max><float>45</float></max></limits>"
        new = f"<limits><min><float>{lower}</float></min><max><float>{upper}</float></max></limits>"
        body = arm((old, new))
        assert (body.joints[0].axes[0].lower, body.joints[0].axes[0].upper) == (0, 0)
        assert body.joints[0].static
        turned = body.joints[0].T_parent_child.apply((0.0, 0.0, 1.0))
        z = np.subtract(turned, body.joints[0].T_parent_child.position)
        np.testing.assert_allclose(body.joints[0].axes[0].direction, z, atol=1e-15)

    @pytest.mark.parametrize("turn", ["", "<rotate>0 0 1 90</rotate>", "<rotate>1 0 0 30</rotate>"])
    def test_a_slider_that_cannot_move_keeps_its_axis_in_the_parent(self, turn):
        """The axis of a hinge that cannot move is z of its child; turning the child changes no slider's axis."""
        slider = [("<revolute sid", "<prismatic sid"), ("</revolute>", "</prismatic>"), ("<axis>0 0 2", "<axis>2 0 0")]
        slider += [('<link sid="link1" name="upper arm">', f'<link sid="link1" name="upper arm">{turn}')]
        old = "<limits><min><param>low</param></min><max><float>45</float></max></limits>"
        new = "<limits><min><float>1</float></min><max><float>-1</float></max></limits>"
        moving, welded = arm(*slider).joints[0], arm(*slider, (old, new)).joints[0]
        assert (welded.static, welded.axes[0].lower, welded.axes[0].upper) == (True, 0, 0)
        np.testing.assert_allclose(welded.axes[0].direction, moving.axes[0].direction, atol=1e-15)
        np.testing.assert_allclose(welded.anchor, welded.T_parent_child.position, atol=1e-15)

    @pytest.mark.parametrize(
        ("ambient", "diffuse", "transparency", "expected"),
        [
            ("", "0.5 0.25 0 0.3", "", (0.5, 0.25, 0, 0.7)),
            ("", "0.5 0.25 0 0", "", (0.5, 0.25, 0, 0)),
            ("", "0.5 0.25 0 1", "", (0.5, 0.25, 0, 0)),
            ("", "0.5 0.25 0", "", (0.5, 0.25, 0, 0)),
            ("1 0 0 0.4", "0.5 0.25 0 0.3", "", (0.5, 0.25, 0, 0.7)),
            ("1 0 0 0.4", "", "", (1, 1, 1, 0.6)),
            ("", "0.5 0.25 0 0.3", "0.8", (0.5, 0.25, 0, 0.2)),
            ("", "", "0.8", (1, 1, 1, 0.2)),
            ("", "texture", "", (1, 1, 1, 0)),
        ],
    )
    def test_colours_of_phong(self, ambient, diffuse, transparency, expected):
        given = {"ambient": ambient, "diffuse": diffuse}
        parts = [f"<{tag}><color>{text}</color></{tag}>" for tag, text in given.items() if text and text != "texture"]
        parts += ['<diffuse><texture texture="a" texcoord="b"/></diffuse>'] if diffuse == "texture" else []
        parts += [f"<transparency><float>{transparency}</float></transparency>"] if transparency else []
        text = re.sub("<phong>.*?</phong>", f"<phong>{''.join(parts)}</phong>", ARM, flags=re.DOTALL)
        wedge = read_data(text).scene.bodies[0].links[1].geometries[0]
        assert (*wedge.diffuse, wedge.transparency) == pytest.approx(expected)

    @pytest.mark.parametrize("shader", ["blinn", "lambert"])
    def test_the_fourth_number_counts_for_phong_only(self, shader):
        text = ARM.replace("phong>", f"{shader}>").replace("0.5 0.25 0 1", "0.5 0.25 0 0.3")
        text = re.sub("<transparency>.*?</transparency>", "", text)
        assert read_data(text).scene.bodies[0].links[1].geometries[0].transparency == 0

    def test_a_joint_without_a_name_is_numbered(self):
        text = changed(('<joint name="elbow" sid', '<joint id="elbow" sid'), ('<joint name="grip" sid', "<joint sid"))
        names = [joint.name for joint in read_data(text).scene.bodies[0].all_joints]
        assert names == ["dummy0", "dummy1"]

    @pytest.mark.parametrize("up", ["X_UP", "Y_UP", "Z_UP", " Y_UP "])
    def test_gravity_is_along_the_up_axis(self, up):
        scene = read_data(re.sub("<up_axis>.*?</up_axis>", f"<up_axis>{up}</up_axis>", _WITHOUT_GRAVITY)).scene
        axis = "XYZ".index(up.strip()[0])
        assert scene.gravity == (
            None if axis == 2 else tuple(-9.797930195020351 if i == axis else 0.0 for i in range(3))
        )

    def test_a_written_gravity_counts(self):
        text = re.sub("<up_axis>.*?</up_axis>", "<up_axis>Y_UP</up_axis>", ARM)
        assert read_data(text).scene.gravity == read_data(ARM).scene.gravity

    def test_an_inactive_axis_has_no_dof(self):
        body = arm(("<active><bool>true", "<active><bool>false"))
        assert [joint.name for joint in body.passive_joints] == ["elbow", "grip"]

    def test_an_axis_without_limits_turns_for_ever(self):
        body = arm(
            ("<limits><min>-170</min><max>170</max></limits>", ""),
            ("<limits><min><param>low</param></min><max><float>45</float></max></limits>", ""),
        )
        assert body.joints[0].axes[0].circular

    def test_joints_come_in_the_order_of_their_indices(self):
        second = '<axis_info sid="info1" axis="kmodel1/joint1/axis0">'
        index = '<index semantic="OpenRAVE"><int>{}</int></index>'
        start, end = ARM.index("<formula"), ARM.index("</formula>") + len("</formula>")
        text = changed(
            (second, second + index.format(0)),
            ("<active><bool>false", "<active><bool>true"),
            ('<newparam sid="low">', index.format(1) + '<newparam sid="low">'),
            text=ARM[:start] + ARM[end:],
        )
        body = read_data(text).scene.bodies[0]
        assert [joint.name for joint in body.joints] == ["grip", "elbow"]

    def test_the_equation_of_openrave_counts_before_the_common_one(self):
        own = (
            '</technique_common><technique profile="OpenRAVE"><equation type="position"><math>'
            '<apply><minus/><csymbol encoding="COLLADA">kmodel1/joint0</csymbol></apply></math></equation>'
            '<equation type="first_partial" target="kmodel1/joint0"><math><cn>-1</cn></math></equation>'
            "</technique></formula>"
        )
        (grip,) = read_data(re.sub(r"</technique_common>\s*</formula>", own, ARM)).scene.bodies[0].passive_joints
        assert (grip.mimic.position, grip.mimic.velocity) == ("(-elbow)", "|elbow -1 ")

    def test_a_function_that_nobody_knows_freezes_the_follower(self):
        replacement = ("<times/>", "<gcd/>")
        (grip,) = arm(replacement).passive_joints
        assert grip.mimic is None
        assert findings(replacement) == {"bad-mimic"}

    @pytest.mark.parametrize(
        ("old", "new", "said"),
        [
            ("1 2 3</p>", "1 2 4</p>", "<triangles> in <geometry> 'wedge': only 3 of 4 can be read"),
            ("1 2 3</p>", "1 2 -1</p>", "only 3 of 4 can be read"),
            ("1 2 3</p>", "1 2</p>", "only 3 of 4 can be read"),
            ('stride="3"', 'stride="2"', "only 0 of 4 can be read"),
            ("</triangles>", "</triangles><lines count='1'/>", "<lines> in <geometry> 'wedge': OpenRAVE reads no such"),
            ("</triangles>", "</triangles><polygons><p>0 1 2</p></polygons>", "OpenRAVE reads no such primitives"),
            ("<translate>0 0 1</translate>", "<translate>0 0</translate>", "needs 3 numbers, and has 2"),
            (
                "<translate>0 0 1</translate>",
                "<skew>30 1 0 0 0 1 0</skew>",
                "<skew> in <node> 'visual1': OpenRAVE leaves",
            ),
            ('meter="1"', 'meter="abc"', "'abc' is no length, which is a number above 0; 1 m counts"),
            ('meter="1"', 'meter="-2"', "-2 m counts"),
        ],
    )
    def test_what_does_not_count_is_reported(self, old, new, said):
        found = [finding for finding in read_data(changed((old, new))).diagnostics if said in finding.message]
        assert len(found) == 1
        assert found[0].source.line

    def test_polygons_may_be_more_triangles_than_they_count(self):
        primitives = '<polylist count="1"><input semantic="VERTEX" source="#corners" offset="0"/><vcount>4</vcount>'
        start, end = ARM.index("<triangles"), ARM.index("</triangles>") + len("</triangles>")
        reading = read_data(f"{ARM[:start]}{primitives}<p>0 1 2 3</p></polylist>{ARM[end:]}")
        assert len(reading.scene.bodies[0].links[1].geometries[0].shape.mesh.triangles) == 2
        assert "broken-mesh" not in {finding.code for finding in reading.diagnostics}

    def test_a_primitive_stands_in_place_of_triangles(self):
        extra = (
            '</mesh><extra type="geometry_info"><technique profile="OpenRAVE"><translate>0 0 3</translate>'
            "{}<visible><bool>false</bool></visible></technique></extra>"
        )
        box = arm(("</mesh>", extra.format("<box><half_extents>1 2 3</half_extents></box>")))
        (geometry,) = box.links[1].geometries
        assert (geometry.shape, geometry.visible) == (Box((1, 2, 3)), False)
        np.testing.assert_allclose(geometry.T_link_geometry.position, [0, 0, 3], atol=1e-15)
        cylinder = arm(("</mesh>", extra.format("<cylinder><radius>1</radius><height>2</height></cylinder>")))
        (geometry,) = cylinder.links[1].geometries
        assert geometry.shape == Cylinder(1, 2)
        np.testing.assert_allclose(matrix(geometry.T_link_geometry)[:3, 2], [0, 1, 0], atol=1e-15)  # it lies along y

    def test_two_instances_are_two_robots(self):
        again = '<instance_articulated_system sid="again" url="#arm_motion" name="arm"/></kinematics_scene>'
        reading = read_data(changed(("</kinematics_scene>", again)))
        assert [body.name for body in reading.scene.bodies] == ["arm", "arm0"]

    def test_a_model_without_a_system_is_no_robot(self):
        text = re.sub(
            r"<instance_articulated_system sid=.*?</instance_articulated_system>",
            '<instance_kinematics_model url="#kmodel1" sid="k"/>',
            ARM,
            flags=re.DOTALL,
        )
        body = read_data(text).scene.bodies[0]
        assert (body.name, body.is_robot, len(body.links)) == ("arm", False, 3)

    def test_nodes_without_kinematics_are_bodies_of_their_own(self):
        table = '<node id="table"><translate>3 0 0</translate><instance_geometry url="#wedge"/></node>'
        robot, other = read_data(changed(("</visual_scene>", f"{table}</visual_scene>"))).scene.bodies
        assert (robot.name, other.name, other.is_robot) == ("arm", "table", False)
        assert other.links[0].T_world_link.position == (3, 0, 0)

    def test_a_file_without_kinematics_loads_no_body_in_openrave(self):
        text = re.sub(r"<instance_kinematics_scene.*?</instance_kinematics_scene>", "", ARM, flags=re.DOTALL)
        env = ravemj.Environment()
        with pytest.warns(ravemj.RavemjWarning, match="no-kinematics"):
            assert not env.LoadData(text)
        with pytest.warns(ravemj.RavemjWarning):
            assert env.ReadKinBodyData(text).GetLinks()[0].GetName() == "visual1"


class TestFiles:
    def test_archive(self, tmp_path):
        manifest = "<?xml version='1.0'?><dae_root>./my%20arm.dae</dae_root>"
        (tmp_path / "arm.zae").write_bytes(zipped({"manifest.xml": manifest, "my arm.dae": ARM, "other.dae": "<x/>"}))
        reading = read_file(tmp_path / "arm.zae")
        (body,) = reading.scene.bodies
        assert [(link.name, link.T_world_link) for link in body.links] == [
            (link.name, link.T_world_link) for link in arm().links
        ]
        assert reading.files == (str(tmp_path / "arm.zae"),)

    def test_archive_without_a_manifest(self, tmp_path):
        (tmp_path / "arm.zae").write_bytes(zipped({"arm.dae": ARM}))
        assert len(read_file(tmp_path / "arm.zae").scene.bodies) == 1
        body = ravemj.load(tmp_path / "arm.zae").GetBodies()[0]
        assert body.GetURI() == f"file:{tmp_path / 'arm.zae'}"  # what Load takes

    @pytest.mark.parametrize(
        ("members", "message"),
        [
            ({"manifest.xml": "<dae_root>../arm.dae</dae_root>", "arm.dae": ARM}, "outside of the archive"),
            ({"manifest.xml": "<dae_root>/etc/arm.dae</dae_root>"}, "outside of the archive"),
            ({"manifest.xml": "<dae_root>gone.dae</dae_root>"}, "not in the archive"),
            ({"manifest.xml": "<dae_root>"}, "not well-formed"),
            ({"readme.txt": "x"}, "no .dae file"),
            ({"arm.dae": b"0" * (1 << 20)}, "over 200 times its own"),
            ({"arm.dae": "<html/>"}, "not COLLADA"),
        ],
    )
    def test_bad_archives(self, members, message, tmp_path):
        (tmp_path / "arm.zae").write_bytes(zipped(members))
        assert message in str(read_file(tmp_path / "arm.zae").failure)

    def test_no_archive(self, tmp_path):
        (tmp_path / "arm.zae").write_bytes(b"PK nothing")
        assert "not a zip archive" in str(read_file(tmp_path / "arm.zae").failure)

    def test_references_to_other_files(self, tmp_path, monkeypatch):
        monkeypatch.setenv("OPENRAVE_DATA", str(tmp_path / "data"))
        for folder in ("data", "data/deep"):
            (tmp_path / folder).mkdir()
        for uri, place in (("./shapes.dae", "shapes.dae"), ("openrave:/deep/shapes.dae", "data/deep/shapes.dae")):
            (tmp_path / place).write_text(ARM)
            (tmp_path / "arm.dae").write_text(changed(('geometry url="#wedge"', f'geometry url="{uri}#wedge"')))
            reading = read_file(tmp_path / "arm.dae")
            assert len(reading.scene.bodies[0].links[1].geometries) == 1
            assert [Path(file).resolve() for file in reading.files] == [tmp_path / "arm.dae", tmp_path / place]

    def test_references_within_and_out_of_an_archive(self, tmp_path):
        main = changed(('geometry url="#wedge"', 'geometry url="parts/shapes.dae#wedge"'))
        (tmp_path / "arm.zae").write_bytes(
            zipped({"manifest.xml": "<dae_root>arm.dae</dae_root>", "arm.dae": main, "parts/shapes.dae": ARM})
        )
        assert len(read_file(tmp_path / "arm.zae").scene.bodies[0].links[1].geometries) == 1
        (tmp_path / "parts").mkdir()
        (tmp_path / "parts" / "shapes.dae").write_text(ARM)
        (tmp_path / "arm.zae").write_bytes(zipped({"arm.dae": main}))
        assert len(read_file(tmp_path / "arm.zae").scene.bodies[0].links[1].geometries) == 1

    def test_missing_files_are_reported(self):
        assert findings(('geometry url="#wedge"', 'geometry url="gone.dae#wedge"')) == {
            "missing-file",
            "broken-reference",
        }

    def test_errors_name_file_line_and_id(self, tmp_path):
        (tmp_path / "arm.dae").write_text(changed(('joint="kmodel1/joint1">', 'joint="kmodel1/gone">')))
        line = ARM[: ARM.index('<attachment_full joint="kmodel1/joint1"')].count("\n") + 1
        failure = str(read_file(tmp_path / "arm.dae").failure)
        assert failure.startswith(f"{tmp_path}/arm.dae:{line}: error: <attachment_full> in <link> 'link1': ")
        assert "kmodel1/gone" in failure

    def test_entities_and_the_network_are_off(self):
        bomb = '<!DOCTYPE COLLADA [<!ENTITY a "base"><!ENTITY b SYSTEM "file:///etc/passwd">]>\n<COLLADA'
        text = changed(("<COLLADA", bomb), ("param>s_model<", "param>&b;<"))
        assert "root:" not in "".join(map(str, read_data(text).diagnostics))


class TestInXml:
    def load(self, tmp_path, xml: str):
        (tmp_path / "arm.dae").write_text(ARM)
        (tmp_path / "main.xml").write_text(xml)
        reading = read_file(tmp_path / "main.xml")
        assert reading.failure is None
        assert [finding for finding in reading.diagnostics if finding.severity == "error"] == []
        return reading.scene.bodies[0]

    def test_a_robot_from_a_file(self, tmp_path):
        body = self.load(tmp_path, '<Robot file="arm.dae" prefix="left_"><Translation>1 0 0</Translation></Robot>')
        assert body.name == "arm"
        assert [link.name for link in body.links] == ["left_base", "left_upper_arm", "left___dummy0"]
        assert body.passive_joints[0].mimic.position == "((0.5*left_elbow)+-0.25)"
        assert body.links[1].T_world_link.position == (1.5, 0, 1)
        assert body.joints[0].axes[0].value == 0  # the values of the file hold only where it is loaded by itself
        assert [built.name for built in body.manipulators] == ["left_hand"]

    def test_links_of_one_name_are_joined(self, tmp_path):
        ball = '<Geom type="sphere"><radius>1</radius></Geom>'
        base = f'<KinBody><Body name="base"><Translation>0 0 5</Translation>{ball}</Body></KinBody>'
        xml = f'<Robot name="two">{base}<Robot file="arm.dae"/></Robot>'
        body = self.load(tmp_path, xml)
        assert [link.name for link in body.links] == ["base", "upper_arm", "__dummy0"]
        assert body.links[0].inertial.mass == 2
        assert len(body.links[0].geometries) == 1
        assert body.links[1].T_world_link.position == (0.5, 0, 5)

    def test_a_broken_file_is_an_error_and_the_rest_is_read(self, tmp_path):
        (tmp_path / "bad.dae").write_text("<COLLADA>")
        (tmp_path / "main.xml").write_text(
            '<Environment><Robot name="a" file="bad.dae"/><KinBody name="b"><Body/></KinBody></Environment>'
        )
        reading = read_file(tmp_path / "main.xml")
        assert [body.name for body in reading.scene.bodies] == ["a", "b"]
        (finding,) = [finding for finding in reading.diagnostics if finding.severity == "error"]
        assert finding.code == "broken-file"


def test_the_robot_moves(tmp_path):
    path = tmp_path / "arm.dae"
    path.write_text(ARM)
    env = ravemj.Environment()
    assert env.Load(path)
    robot = env.GetRobots()[0]
    np.testing.assert_allclose(robot.GetDOFValues(), [30 * DEGREE])
    robot.SetDOFValues([0])
    np.testing.assert_allclose(robot.GetLink("__dummy0").GetTransform()[:3, 3], [0.5, 0, 1 + 2 - 0.25], atol=1e-12)

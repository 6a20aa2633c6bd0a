"""The reader of OpenRAVE XML: what it reads, and what it says of what it does not."""

import math

import numpy as np
import pytest

from ravemj.formats.meshes import area, volume
from ravemj.formats.openrave_xml import Reading, read
from ravemj.model import scene


@pytest.fixture
def write(tmp_path):
    def write(content: str, name: str = "model.xml") -> str:
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(content)
        return str(path)

    return write


@pytest.fixture
def read_text(write):
    def read_text(content: str) -> Reading:
        return read(write(content))

    return read_text


@pytest.fixture
def link(read_text):
    """The only link of a KinBody with the given content, and with no other findings than the given ones."""

    def link(content: str, *found: str) -> scene.Link:
        reading = read_text(f'<KinBody name="b">{content}</KinBody>')
        assert reading.failure is None
        assert codes(reading) == [*found]
        (only,) = reading.scene.bodies[0].links
        return only

    return link


def codes(reading: Reading) -> list[str]:
    return [finding.code for finding in reading.diagnostics]


def rotation(pose):
    return pose.matrix()[:3, :3]


class TestDocument:
    def test_the_tutorial(self, models):
        reading = read(models / "env.xml")
        assert reading.failure is None
        assert len(reading.diagnostics) == 0
        (pendulum,) = reading.scene.bodies
        assert pendulum.is_robot
        assert [link.name for link in pendulum.links] == ["Base", "Arm0", "Arm1"]
        assert reading.scene.view == scene.View()

    def test_letter_case_of_names_does_not_matter(self, link):
        shouted = link('<BODY NAME="a"><GEOM TYPE="Box"><EXTENTS>1 2 3</EXTENTS></GEOM></BODY>')
        assert shouted.name == "a"
        assert shouted.geometries[0].shape == scene.Box((1, 2, 3))

    def test_bodies_in_document_order(self, read_text):
        reading = read_text(
            '<Environment><Robot name="r"/><KinBody name="k"/>'
            '<Environment><Robot name="s"/></Environment></Environment>'
        )
        assert [(body.name, body.is_robot) for body in reading.scene.bodies] == [("r", True), ("k", False), ("s", True)]

    @pytest.mark.parametrize("root", ["Robot", "KinBody"])
    def test_a_body_as_root(self, read_text, root):
        reading = read_text(f'<{root} name="x"/>')
        assert [body.name for body in reading.scene.bodies] == ["x"]
        assert reading.scene.view is None

    def test_comments_are_transparent(self, link):
        assert link('<Body name="a"><Translation>1 <!-- and --> 2 3</Translation></Body>').T_world_link.position == (
            1,
            2,
            3,
        )

    def test_text_before_a_child_is_dropped(self, read_text):
        reading = read_text(
            '<KinBody name="b"><Body name="a"><Translation>1 2 3 <b/> 4 5 6</Translation></Body></KinBody>'
        )
        assert reading.scene.bodies[0].links[0].T_world_link.position == (4, 5, 6)

    def test_background_and_camera(self, read_text):
        reading = read_text(
            "<Environment><bkgndcolor>.1 .2 .3</bkgndcolor><camtrans>1 2 3</camtrans>"
            "<camrotationaxis>0 0 1 90</camrotationaxis></Environment>"
        )
        view = reading.scene.view
        assert view.background == (0.1, 0.2, 0.3)
        assert view.T_world_camera.position == (1, 2, 3)
        np.testing.assert_allclose(rotation(view.T_world_camera), [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-15)


def test_an_entity_behind_a_greater_sign_is_found(read_text):
    reading = read_text("<!DOCTYPE r [<!ENTITY e '1'>]><KinBody name='a>&e;'><Body name='l'/></KinBody>")
    assert "the entity &e; is not supported" in str(reading.failure)


class TestBodyInBody:
    BOX = "<Geom><Extents>1 1 1</Extents><Translation>0 0 1</Translation></Geom>"
    INNER = (
        f'<Body name="other"><Translation>1 0 0</Translation><RotationAxis>1 0 0 90</RotationAxis>{BOX}'
        "<Mass><total>7</total></Mass></Body>"
    )

    def test_is_the_same_link_and_moves_all_its_shapes(self, read_text):
        reading = read_text(
            f"<KinBody name='k'><Body name='a'><Translation>5 0 0</Translation>{self.BOX}{self.INNER}</Body></KinBody>"
        )
        ((link,),) = [body.links for body in reading.scene.bodies]
        assert (link.name, link.T_world_link.position, link.inertial.mass) == ("other", (5, 0, 0), 1)
        for geometry in link.geometries:
            np.testing.assert_allclose(geometry.T_link_geometry.position, (1, -1, 0), atol=1e-15)
        assert [finding.code for finding in reading.diagnostics] == ["openrave-bug", "openrave-bug"]

    def test_in_a_file(self, read_text, tmp_path):
        (tmp_path / "inner.xml").write_text(self.INNER)
        mass = "<Mass type='custom'><total>3</total></Mass>"
        reading = read_text(f"<KinBody name='k'><Body name='a' file='inner.xml'>{mass}{self.BOX}</Body></KinBody>")
        (link,) = reading.scene.bodies[0].links
        assert (link.name, link.inertial.mass) == ("other", 3)
        positions = [geometry.T_link_geometry.position for geometry in link.geometries]
        np.testing.assert_allclose(positions, [(1, -1, 0), (0, 0, 1)], atol=1e-15)

    def test_a_file_with_something_else(self, read_text, tmp_path):
        (tmp_path / "inner.xml").write_text("<KinBody><Body name='b'/></KinBody>")
        reading = read_text("<KinBody name='k'><Body name='a' file='inner.xml'/></KinBody>")
        assert [link.name for link in reading.scene.bodies[0].links] == ["a"]
        (finding,) = reading.diagnostics
        assert (
            "inner.xml:1: warning[unknown-tag]: the file of a Body has to hold a <Body>, and holds a <KinBody>"
            in str(finding)
        )


def test_a_prism_has_walls_alone(link):
    corners = "0 0  2 0  2 1  0 1"
    geometry = link(
        f'<Body name="a"><Geom type="prism"><crosssection>{corners}</crosssection><height>3</height></Geom></Body>'
    ).geometries[0]
    walls = geometry.shape.triangulated()
    assert area(walls) == pytest.approx((2 + 1 + 2 + 1) * 3)
    assert volume(walls) == pytest.approx(2 * 1 * 3 * 2 / 3)  # two of three pairs of faces, all turned outwards
    np.testing.assert_array_equal(walls.vertices.min(axis=0), [0, 0, -1.5])
    np.testing.assert_array_equal(walls.vertices.max(axis=0), [2, 1, 1.5])


class TestPlacement:
    def test_translations_add_and_are_not_rotated(self, link):
        pose = link(
            '<Body name="a"><RotationAxis>0 0 1 90</RotationAxis><Translation>1 0 0</Translation>'
            "<RotationAxis>1 0 0 90</RotationAxis><Translation>0 2 0</Translation></Body>"
        ).T_world_link
        assert pose.position == (1, 2, 0)
        np.testing.assert_allclose(rotation(pose), [[0, -1, 0], [0, 0, -1], [1, 0, 0]], atol=1e-15)

    @pytest.mark.parametrize(
        "spelling",
        [
            "<RotationAxis>0 0 5 90</RotationAxis>",
            "<Quat>2 0 0 2</Quat>",
            "<RotationMat>0 -1 0  1 0 0  0 0 1</RotationMat>",
        ],
    )
    def test_spellings_of_a_rotation(self, link, spelling):
        pose = link(f'<Body name="a">{spelling}</Body>').T_world_link
        np.testing.assert_allclose(rotation(pose), [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-15)

    def test_scopes(self, read_text):
        """Robot and KinBody act once on all links made inside; offsetfrom refers to the scope frame."""
        reading = read_text("""
            <Robot name="r">
              <Translation>100 0 0</Translation><RotationAxis>0 0 1 90</RotationAxis><Translation>0 0 3</Translation>
              <KinBody>
                <Translation>10 0 0</Translation><RotationAxis>1 0 0 90</RotationAxis>
                <Body name="a">
                  <RotationAxis>0 0 1 90</RotationAxis><Translation>1 0 0</Translation>
                  <RotationAxis>1 0 0 90</RotationAxis>
                  <Geom type="box">
                    <RotationAxis>0 0 1 90</RotationAxis><Translation>.5 0 0</Translation>
                    <RotationAxis>1 0 0 90</RotationAxis>
                  </Geom>
                </Body>
                <Body name="c"><offsetfrom>a</offsetfrom><Translation>0 1 0</Translation></Body>
              </KinBody>
            </Robot>""")
        a, c = reading.scene.bodies[0].links
        np.testing.assert_allclose(a.T_world_link.position, (100, 11, 3), atol=1e-13)
        np.testing.assert_allclose(rotation(a.T_world_link), np.diag([1, -1, -1]), atol=1e-15)
        np.testing.assert_allclose(c.T_world_link.position, (100, 10, 3), atol=1e-13)
        in_link = a.geometries[0].T_link_geometry
        assert in_link.position == (0.5, 0, 0)
        np.testing.assert_allclose(rotation(in_link), [[0, -1, 0], [0, 0, -1], [1, 0, 0]], atol=1e-15)

    def test_a_body_of_the_same_name_is_re_opened(self, link):
        again = link(
            '<Body name="a"><Translation>1 0 0</Translation><Mass type="custom"><total>3</total></Mass></Body>'
            '<Body name="a"><Translation>0 1 0</Translation><RotationAxis>0 0 1 90</RotationAxis></Body>',
            "openrave-bug",
        )
        assert again.T_world_link.position == (1, 1, 0)
        assert again.inertial.mass == 1  # the second element has no Mass


class TestGeometry:
    @pytest.mark.parametrize(
        ("content", "shape"),
        [
            ('type="box"><Extents>.1 .2 .3</Extents>', scene.Box((0.1, 0.2, 0.3))),
            ('type="box"><FullExtents>.2 .4 .6</FullExtents>', scene.Box((0.1, 0.2, 0.3))),
            ('type="sphere"><Radius>.5</Radius>', scene.Sphere(0.5)),
            ('type="cylinder"><Radius>.5</Radius><Height>2</Height>', scene.Cylinder(0.5, 2)),
            ('type="capsule"><Radius>.5</Radius><Height>2</Height>', scene.Capsule(0.5, 2)),
            ("><Extents>1 1 1</Extents>", scene.Box((1, 1, 1))),
        ],
    )
    def test_shapes(self, link, content, shape):
        assert link(f'<Body name="a"><Geom {content}</Geom></Body>').geometries[0].shape == shape

    def test_a_cylinder_lies_along_y(self, link):
        pose = link('<Body name="a"><Geom type="cylinder"/></Body>').geometries[0].T_link_geometry
        np.testing.assert_allclose(rotation(pose) @ [0, 0, 1], [0, -1, 0], atol=1e-15)

    def test_colours(self, link):
        geometry = link(
            '<Body name="a"><Geom render="false">'
            "<diffuseColor>.1 .2 .3</diffuseColor><ambientColor>1 0 0</ambientColor>"
            "<transparency>.25</transparency><name>lid</name></Geom></Body>"
        ).geometries[0]
        assert geometry.diffuse == (0.1, 0.2, 0.3)
        assert geometry.ambient == (1, 0, 0)
        assert (geometry.transparency, geometry.visible, geometry.name) == (0.25, False, "lid")


BOX = '<Geom type="box"><Extents>.1 .2 .3</Extents><Translation>1 0 0</Translation></Geom>'
TWO_BOXES = BOX + BOX.replace(">1 0 0<", ">-1 0 0<")


class TestMass:
    @pytest.mark.parametrize(
        ("content", "mass", "moments"),
        [
            (BOX, 1, (0.4, 0.4, 0.4)),
            (TWO_BOXES + '<Mass type="mimicgeom"><density>1000</density></Mass>', 96, (4.16, 99.2, 97.6)),
            (TWO_BOXES + '<Mass type="mimicgeom"><total>10</total></Mass>', 10, (4.16, 13.2, 11.6)),
            (BOX + '<Mass type="mimicgeom"><total>10</total></Mass>', 10, (2.08, 1.6, 0.8)),
            ('<Mass type="sphere"></Mass>', 4.1887902, (1.6755161,) * 3),
            ('<Mass type="sphere"><radius>.5</radius><total>2</total></Mass>', 2, (0.2,) * 3),
            ('<Mass type="box"><total>10</total></Mass>', 10, (20 / 3,) * 3),
            ('<Mass type="custom"><total>3</total><com>1 2 3</com></Mass>', 3, (0.4,) * 3),
            (
                '<Geom type="cylinder"><radius>.1</radius><height>.5</height></Geom>'
                '<Mass type="mimicgeom"><density>1000</density></Mass>',
                15.707963,
                (0.36651914, 0.078539816, 0.36651914),
            ),
        ],
    )
    def test_of_a_body(self, link, content, mass, moments):
        inertial = link(f'<Body name="a">{content}</Body>').inertial
        assert inertial.mass == pytest.approx(mass, rel=1e-7)
        np.testing.assert_allclose(inertial.inertia, np.diag(moments), rtol=1e-7, atol=1e-12)

    def test_centre_of_mass(self, link):
        assert link('<Body name="a"><Mass type="custom"><com>1 2 3</com></Mass></Body>').inertial.com == (1, 2, 3)
        mimic = link(f'<Body name="a">{BOX}<Mass type="mimicgeom"><total>10</total></Mass></Body>')
        assert mimic.inertial.com == pytest.approx((1, 0, 0))

    def test_only_the_upper_triangle_of_an_inertia_counts(self, link):
        numbers = "374 -1.3 63  1.3 845 -3  63 3 698"
        mass = f'<Mass type="custom"><inertia>{numbers}</inertia></Mass>'
        inertial = link(f'<Body name="a">{mass}</Body>', "asymmetric-inertia").inertial
        assert inertial.inertia == ((374, -1.3, 63), (-1.3, 845, -3), (63, -3, 698))

    def test_of_a_kinbody_is_the_default_of_later_bodies(self, read_text):
        reading = read_text(f"""
            <KinBody name="b">
              <Body name="before">{BOX}</Body>
              <Mass type="box"><extents>.1 .2 .3</extents><density>50</density></Mass>
              <Body name="after"/>
              <Body name="own"><Mass type="custom"><total>7</total></Mass></Body>
              <KinBody><Body name="nested"/></KinBody>
            </KinBody>""")
        before, after, own, nested = reading.scene.bodies[0].links
        assert before.inertial.mass == nested.inertial.mass == 1
        assert after.inertial.mass == pytest.approx(2.4, rel=1e-6)
        np.testing.assert_allclose(after.inertial.inertia, np.diag([0.104, 0.08, 0.04]), rtol=1e-6)
        assert own.inertial.mass == 7

    def test_a_total_of_a_kinbody_is_taken_for_a_density(self, read_text):
        reading = read_text(
            f'<KinBody name="b"><Mass type="mimicgeom"><total>10</total></Mass><Body name="a">{BOX}</Body></KinBody>'
        )
        assert codes(reading) == ["openrave-bug"]
        assert reading.scene.bodies[0].links[0].inertial.mass == pytest.approx(0.48)

    @pytest.mark.parametrize(
        "shape",
        [
            "",
            '<Geom type="trimesh"><vertices>0 0 0  1 0 0  0 1 0</vertices></Geom>',
            '<Geom type="box"><extents>0 1 1</extents></Geom>',
            '<Geom type="capsule"><radius>1</radius><height>1</height></Geom>',
        ],
    )
    @pytest.mark.parametrize("amount", ["<total>2</total>", "<total>0</total>", "<density>2</density>", ""])
    def test_without_a_volume_is_0(self, read_text, shape, amount):
        """OpenRAVE's masses are 0 or, of some shapes with a total, NaN."""
        body = f'<Body name="a">{shape}<Mass type="mimicgeom">{amount}</Mass></Body>'
        reading = read_text(f'<KinBody name="b">{body}</KinBody>')
        inertial = reading.scene.bodies[0].links[0].inertial
        assert (inertial.mass, np.abs(inertial.inertia).max()) == (0, 0)
        assert inertial.undefined == bool(shape and "total" in amount)
        code = "undefined-mass" if shape else "openrave-bug"
        assert (code in codes(reading)) == (amount == "<total>2</total>")

    def test_box_extents_in_a_body_have_no_effect(self, read_text):
        mass = '<Mass type="box"><extents>.1 .2 .3</extents><total>10</total></Mass>'
        reading = read_text(f'<KinBody name="b"><Body name="a">{mass}</Body></KinBody>')
        assert codes(reading) == ["openrave-bug"]
        np.testing.assert_allclose(reading.scene.bodies[0].links[0].inertial.inertia, np.diag([20 / 3] * 3))


BODIES = '<Body name="A"/><Body name="B"><Translation>1 0 0</Translation></Body>'


class TestJoint:
    @pytest.fixture
    def axis(self, read_text):
        def axis(content: str, attributes: str = 'type="hinge"') -> scene.Axis:
            reading = read_text(
                f'<KinBody name="b">{BODIES}<Joint name="j" {attributes}><Body>A</Body><Body>B</Body>'
                f"<axis>0 0 1</axis>{content}</Joint></KinBody>"
            )
            assert reading.failure is None
            return (*reading.scene.bodies[0].joints, *reading.scene.bodies[0].passive_joints)[0].axes[0]

        return axis

    def test_defaults(self, axis):
        hinge = axis("")
        assert (hinge.lower, hinge.upper, hinge.circular) == (-math.pi, math.pi, False)
        assert (hinge.weight, hinge.resolution) == (1, 0.02)
        assert (hinge.max_velocity, hinge.max_acceleration, hinge.max_torque) == (10, 50, 0)
        slider = axis("", 'type="slider"')
        assert (slider.lower, slider.upper) == (-10, 10)

    @pytest.mark.parametrize(
        ("content", "attributes", "limits"),
        [
            ("<limits>-1 2</limits>", "", (-1, 2)),
            ("<limitsrad>2 -1</limitsrad>", "", (-1, 2)),
            ("<limitsdeg>-90 180</limitsdeg>", "", (-math.pi / 2, math.pi)),
            ("<limitsdeg>-90 180</limitsdeg>", 'type="slider"', (-90, 180)),
            ("", 'circular="true"', (-10000, 10000)),
            ("", 'circular="yes"', (-10000, 10000)),
            ("", 'circular="0"', (-math.pi, math.pi)),
        ],
    )
    def test_limits(self, axis, content, attributes, limits):
        read_axis = axis(content, attributes)
        assert (read_axis.lower, read_axis.upper) == pytest.approx(limits)

    def test_scalars(self, axis):
        hinge = axis(
            "<weight>4</weight><resolution>1</resolution><maxvel>3.42</maxvel><maxaccel>5</maxaccel><maxtorque>9</maxtorque>"
        )
        assert (hinge.weight, hinge.max_velocity, hinge.max_acceleration, hinge.max_torque) == (4, 3.42, 5, 9)
        assert hinge.resolution == pytest.approx(math.radians(1))
        assert axis("<maxveldeg>180</maxveldeg>").max_velocity == pytest.approx(math.pi)

    def test_names_of_bodies_in_any_letter_case(self, read_text):
        reading = read_text(
            f'<KinBody name="b">{BODIES}<Joint name="j">'
            "<Body>a</Body><Body>b</Body><axis>0 0 1</axis></Joint></KinBody>"
        )
        assert reading.failure is None
        assert len(reading.scene.bodies[0].joints) == 1


class TestIncludes:
    def test_path_is_relative_to_the_file_that_names_it(self, write):
        write('<KinBody name="inner"><Body name="A"/></KinBody>', "deep.xml")
        write('<Robot><KinBody file="../deep.xml"/></Robot>', "sub/robot.xml")
        reading = read(write('<Environment><Robot file="sub/robot.xml" name="r"/></Environment>'))
        assert reading.failure is None
        (robot,) = reading.scene.bodies
        assert robot.name == "r"
        assert [link.name for link in robot.links] == ["A"]

    def test_data_folders(self, write, monkeypatch, tmp_path):
        write('<KinBody><Body name="A"/></KinBody>', "data/shared.xml")
        monkeypatch.setenv("OPENRAVE_DATA", f"/nowhere:{tmp_path / 'data'}")
        reading = read(write('<KinBody name="b" file="shared.xml"/>'))
        assert [link.name for link in reading.scene.bodies[0].links] == ["A"]

    def test_children_come_after_the_file(self, write):
        write(
            '<Robot name="x"><Translation>1 0 0</Translation><KinBody><Body name="A"/></KinBody></Robot>', "robot.xml"
        )
        reading = read(
            write(
                '<Robot name="r" file="robot.xml"><Translation>0 1 0</Translation>'
                '<KinBody><Body name="B"/></KinBody></Robot>'
            )
        )
        a, b = reading.scene.bodies[0].links
        assert a.T_world_link.position == (1, 1, 0)
        assert b.T_world_link.position == (0, 1, 0)

    def test_prefix(self, write):
        write(
            f'<Robot><KinBody>{BODIES}<Joint name="j"><Body>A</Body><Body>B</Body></Joint></KinBody></Robot>', "arm.xml"
        )
        reading = read(
            write('<Robot name="r"><Robot file="arm.xml" prefix="l_"/><Robot file="arm.xml" prefix="r_"/></Robot>')
        )
        (robot,) = reading.scene.bodies
        assert [link.name for link in robot.links] == ["l_A", "l_B", "r_A", "r_B"]
        assert [joint.name for joint in robot.joints] == ["l_j", "r_j"]

    def test_absolute_paths_count_as_found(self, write):
        """OpenRAVE makes a reddish empty mesh of an absolute path that leads nowhere, but of STL files."""
        write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "t.obj")
        geom = '<Geom type="trimesh">{}<vertices>0 0 0 1 0 0 0 1 0</vertices></Geom>'
        lost, grey, white = (1.0, 0.5, 0.5), (0.6, 0.6, 0.6), (1.0, 1.0, 1.0)
        for tags, triangles, colours in (
            ("<collision>/gone/x.iv</collision>", [0], [lost]),
            ("<data>/gone/x.obj</data><render>/gone/y.obj</render>", [0, 0], [lost, lost]),
            ("<data>/gone/x.obj</data><render>t.obj</render>", [0, 1], [lost, grey]),
            ("<data>t.obj</data><render>/gone/x.obj</render>", [1], [grey]),
            ("<data>/gone/x.stl</data>", [1], [white]),
            ("<data>gone/x.obj</data>", [1], [white]),
        ):
            reading = read(write(f'<KinBody name="k"><Body name="a">{geom.format(tags)}</Body></KinBody>'))
            parts = reading.scene.bodies[0].links[0].geometries
            assert [len(part.shape.mesh.triangles) for part in parts] == triangles, tags
            assert [part.diffuse for part in parts] == [pytest.approx(colour) for colour in colours], tags

    def test_missing_file_is_a_warning(self, write):
        reading = read(write('<Environment>\n<Robot name="r" file="gone.xml"/></Environment>'))
        assert reading.failure is None
        (finding,) = reading.diagnostics
        assert (finding.code, finding.source.line) == ("missing-file", 2)
        assert "gone.xml" in finding.message

    @pytest.mark.parametrize(
        ("places", "root", "taken"),
        [
            (["shared.xml"], None, "shared.xml"),
            (["a/shared.xml"], "a", "a/shared.xml"),
            (["shared.xml"], "a", None),
            (["shared.xml", "a/shared.xml"], None, None),
            (["a/b/shared.xml", "shared.xml"], None, "a/b/shared.xml"),
        ],
    )
    def test_a_file_in_a_folder_above(self, tmp_path, places, root, taken):
        """Up to the root of a repository, and only where exactly one fits; the places of OpenRAVE come first."""
        (tmp_path / "a" / "b").mkdir(parents=True)
        for place in places:
            (tmp_path / place).write_text(f'<KinBody><Body name="{place}"/></KinBody>')
        if root is not None:
            (tmp_path / root / ".git").mkdir()
        path = tmp_path / "a" / "b" / "model.xml"
        path.write_text('<Environment>\n<KinBody name="b" file="shared.xml"/></Environment>')
        reading = read(path)
        assert [link.name for body in reading.scene.bodies for link in body.links] == ([taken] if taken else [])
        beside = taken == "a/b/shared.xml"
        codes = [] if beside else ["found-above" if taken else "missing-file"]
        assert [(finding.code, finding.source.line) for finding in reading.diagnostics] == [(code, 2) for code in codes]

    def test_a_file_that_includes_itself(self, write):
        path = write('<Environment>\n  <Environment file="model.xml"/>\n</Environment>')
        assert str(read(path).failure) == f"{path}:2: error: the file includes itself through model.xml"

    def test_sources_tell_the_chain(self, write):
        inner = write('<Robot name="r">\n<KinBody>\n<Bodi/></KinBody></Robot>', "robot.xml")
        outer = write('<Environment>\n<Robot file="robot.xml"/></Environment>')
        (finding,) = read(outer).diagnostics
        assert str(finding).startswith(f"{inner}:3: warning[unknown-tag]: ")
        assert str(finding).endswith(f"(included from {outer}:2)")


THREE = "<Body name='a'/><Body name='b'/><Body name='c'/>"
THREE_NAMES = "<Body>a</Body><Body>b</Body><Body>c</Body>"
TWO = "<Body name='a'/><Body name='b'/><Joint name='lead'><Body>a</Body><Body>b</Body><axis>0 0 1</axis></Joint>"
JOINT = TWO + "<Body name='c'/><Joint name='j' {}><Body>b</Body><Body>c</Body>{}</Joint>"
"""Two joints; attributes and children of the second one go into the braces."""


ARM = '<Manipulator name="m"><base>b</base><effector>a</effector></Manipulator>'


class TestFindings:
    def test_none_for_numbers_with_an_enormous_sum(self, read_text):
        reading = read_text('<KinBody name="b"><Body name="a"/><Translation>9e307 9e307 0</Translation></KinBody>')
        assert codes(reading) == []

    def test_unread_files_are_named(self, write):
        inner = write('<KinBody name="b"/>\n<KinBody name="c"/>', "two.xml")
        (finding,) = read(write('<Environment><KinBody file="two.xml"/></Environment>')).diagnostics
        assert str(finding).startswith(f"{inner}:2: warning[unread]: ")

    @pytest.mark.parametrize(
        ("content", "code", "words"),
        [
            ("<Body name='a'><Trnslation>1 2 3</Trnslation></Body>", "unknown-tag", "did you mean 'translation'?"),
            ("<Body name='a' typ='static'/>", "unknown-attribute", "did you mean 'type'?"),
            ("<Body name='a'><Translation>1,2,3</Translation></Body>", "bad-number", "OpenRAVE reads 1 0 0"),
            ("<Body name='a'><Translation>a b c</Translation></Body>", "bad-number", "OpenRAVE reads 0 0 0"),
            ("<Body name='a'><Translation>1 2</Translation></Body>", "number-count", "OpenRAVE reads 1 2 0"),
            ("<Body name='a'><Translation>1 2 3 4</Translation></Body>", "number-count", "OpenRAVE reads 1 2 3"),
            ("<Body name='a'><Translation>nan inf 1e999</Translation></Body>", "bad-number", "OpenRAVE reads 0 0 0"),
            ("<Body name='a'><Translation>1\u00a02 3 4</Translation></Body>", "bad-number", "OpenRAVE reads 1 0 0"),
            ("<Body name='a'><Translation>\uff11 2 3</Translation></Body>", "bad-number", "OpenRAVE reads 0 0 0"),
            ("<Body name='a'><Translation>1_0 2 3</Translation></Body>", "bad-number", "OpenRAVE reads 1 0 0"),
            ("<RotationMat>-1 0 0 0 1 0 0 0 1</RotationMat>", "bad-rotation", "holds no rotation"),
            ("<Translation unit='mm'>1 2 3</Translation>", "unknown-attribute", "'unit' of <Translation>"),
            (JOINT.format("", "<actuator kind='x'/>"), "unknown-attribute", "'kind' of <actuator>"),
            ("<RotationAxis>0 0 0 90</RotationAxis>", "bad-rotation", "turns nothing"),
            ("<Body name='a' enable='no'/>", "bad-flag", "counts as true"),
            ("<Body name='a'><Geom render='off'/></Body>", "bad-flag", "counts as true"),
            ("<KinBody skipgeometry='yes'/>", "bad-flag", "counts as false"),
            ("<KinBody makejoinedlinksadjacent='true'/>", "openrave-bug", "counts as 0"),
            ("<Body name='a' type='fixed'/>", "unknown-type", "a dynamic one"),
            ("<KinBody scalegeometry='2 3'/>", "number-count", "one number or three"),
            ("<KinBody scalegeometry='big'/>", "bad-number", "one number or three"),
            (JOINT.format("", "<limits>-1 1 x</limits>"), "bad-number", "holds 'x'"),
            (JOINT.format("enable='no'", ""), "bad-flag", "counts as true"),
            ("<Body name='a'/><Body name='b'><offsetfrom>a b</offsetfrom></Body>", "extra-words", "reads 'a'"),
            ("<Body name='a'/><grabbed body='x' link='a'><Turn/></grabbed>", "unknown-tag", "<Turn> in <grabbed>"),
            ("<Body name='a'/><grabbed body='x' link='a' at='1'/>", "unknown-attribute", "'at' of <grabbed>"),
            ("<diffuseColor>1 0 0</diffuseColor>", "ignored-tag", "write it in each Geom"),
            (JOINT.format("", "<axis>0 0 1</axis>" * 2), "repeated-tag", "overrides <axis>"),
            (
                "<Body name='a'><Geom><extents>1 1 1</extents><radius>1</radius><radius>2</radius></Geom></Body>",
                "repeated-tag",
                "<radius>",
            ),
            (
                "<Body name='a'><Mass type='custom'><total>1</total><total>2</total></Mass></Body>",
                "repeated-tag",
                "<total>",
            ),
            (
                "<Body name='a'><Mass type='custom'><inertia>2 1 0 -1 2 0 0 0 2</inertia></Mass></Body>",
                "asymmetric-inertia",
                "above",
            ),
            (
                "<Body name='a'><Mass type='custom'><total>3</total></Mass></Body><Body name='a'/>",
                "openrave-bug",
                "no longer 3 kg",
            ),
            ("<Body name='a'><offsetfrom>b</offsetfrom></Body>", "unknown-body", "no Body 'b'"),
            ("<adjacent>a b</adjacent>", "unknown-body", "two Bodies"),
            ("<Body name='a'><Geom type='teapot'/></Body>", "unsupported-geometry", "teapot"),
            ("<Body name='a'><Mass type='heavy'/></Body>", "unknown-type", "heavy"),
            (f"{THREE}<Joint name='j'>{THREE_NAMES}<axis>0 0 1</axis></Joint>", "third-body", "'c'"),
            ("</KinBody><KinBody name='z'>", "unread", "behind the end of <KinBody>"),
            (JOINT.format("mimic_pos='lead*2+nope(3)'", ""), "bad-mimic", "after 'lead*2+' and before 'nope(3)'"),
            (
                JOINT.format("mimic_pos='(lead lead'", ""),
                "bad-mimic",
                "unexpected 'lead' at character 6 after '(lead '",
            ),
            (JOINT.format("mimic_pos='leader'", ""), "bad-mimic", "at character 0 before 'leader'"),
            (JOINT.format("", "<limits>0 1</limits><limitsdeg>0 9</limitsdeg>"), "repeated-tag", "overrides <limits>"),
            (JOINT.format("", "<offsetfrom>a</offsetfrom>" * 2), "repeated-tag", "in line 3"),
            ("<Body name='a'/><Body name='b'>" + "<offsetfrom>a</offsetfrom>" * 2 + "</Body>", "repeated-tag", "last"),
        ],
    )
    def test_are_reported_with_their_place(self, read_text, content, code, words):
        reading = read_text(f'<KinBody name="b">\n\n{content}</KinBody>')
        assert reading.failure is None
        (finding,) = reading.diagnostics
        assert finding.code == code
        assert finding.source.line == 3
        assert words in str(finding)

    def test_geometries_that_are_skipped_have_known_attributes(self, read_text):
        content = '<Body name="a"><Geom type="box" name="g"/></Body>'
        assert codes(read_text(f'<KinBody name="b" skipgeometry="true">{content}</KinBody>')) == []

    def test_a_second_mesh_file(self, read_text):
        files = "<data>one.stl big</data><data>two.stl</data>"
        reading = read_text(f'<KinBody name="b"><Body name="a"><Geom type="trimesh">{files}</Geom></Body></KinBody>')
        assert set(codes(reading)) == {"bad-number", "repeated-tag", "missing-file"}

    @pytest.mark.parametrize(
        ("content", "code"),
        [
            ('<Module type="basemanipulation"/>', "ignored-tag"),
            ('<Controller type="nobody"/>', "unknown-interface"),
            ('<Sensor name="s" type="BaseCamra"/>', "unknown-interface"),
            ('<Environment><PhysicsEngine type="ode" gravity="0 0 -9"/></Environment>', "unknown-attribute"),
        ],
    )
    def test_without_bodies(self, read_text, content, code):
        reading = read_text(content)
        assert (reading.failure, codes(reading)) == (None, [code])

    @pytest.mark.parametrize("inner", ["<Environment>{}</Environment>", '<Environment file="inner.xml"/>'])
    def test_an_environment_without_a_camera_leaves_that_of_the_one_inside(self, write, inner):
        tags = "<camtrans>1 2 3</camtrans><bkgndcolor>0 0 1</bkgndcolor>"
        write(f"<Environment>{tags}</Environment>", "inner.xml")
        view = read(write(f"<Environment>{inner.format(tags)}</Environment>")).scene.view
        assert view.T_world_camera.position == (1, 2, 3)
        assert view.background is None

    def test_several_values_of_one_kind_are_no_repetition(self, read_text):
        children = "<axis1>0 0 1</axis1><axis2>1 0 0</axis2><hardmaxvel>1 1</hardmaxvel><maxjerk>1 1</maxjerk>"
        content = JOINT.format("type='hinge2'", children)
        assert codes(read_text(f'<KinBody name="b">{content}</KinBody>')) == []

    def test_joint_values_of_a_weld(self, read_text):
        weld = JOINT.format("", "<limits>0 0</limits>")
        reading = read_text(f'<KinBody name="b">{weld}<jointvalues>0.1 0.2</jointvalues></KinBody>')
        (finding,) = reading.diagnostics
        assert finding.code == "value-outside-limits"
        assert [joint.axes[0].value for joint in reading.scene.bodies[0].joints] == [0.1, 0]

    def test_a_manipulator_without_an_arm(self, read_text):
        arm = "<Manipulator name='m'><base>a</base><effector>c</effector></Manipulator>"
        reading = read_text(f'<Robot name="r"><KinBody>{TWO}<Body name="c"/></KinBody>{arm}</Robot>')
        assert codes(reading) == ["no-arm"]

    def test_manipulators_of_one_name(self, read_text):
        arm = '<Manipulator name="arm"><base>a</base><effector>{}</effector></Manipulator>'
        reading = read_text(f'<Robot name="r"><KinBody>{TWO}</KinBody>\n{arm.format("b")}\n{arm.format("a")}</Robot>')
        (finding,) = reading.diagnostics
        assert (finding.code, finding.source.line) == ("repeated-name", 3)
        assert [one.effector for one in reading.scene.bodies[0].manipulators] == [1, 0]  # as in errors-41

    def test_a_unit_scales_nothing(self, read_text):
        reading = read_text(
            '<Environment><unit>mm 0.001</unit><KinBody name="b"><Body name="a"/></KinBody></Environment>'
        )
        (finding,) = reading.diagnostics
        assert finding.code == "ignored-tag"
        assert "metres" in finding.message

    def test_unknown_offset_is_an_error_that_leaves_the_body(self, read_text):
        reading = read_text('<KinBody name="b"><Body name="a"><offsetfrom>b</offsetfrom></Body></KinBody>')
        assert [finding.severity for finding in reading.diagnostics] == ["error"]
        assert len(reading.scene.bodies[0].links) == 1


class TestFailures:
    @pytest.mark.parametrize(
        ("content", "line", "words"),
        [
            (
                "<Environment>\n<Robot>\n</Environment>",
                3,
                "not well-formed XML in column 3: mismatched tag; <Robot> of line 2",
            ),
            ('<KinBody name="a&b"/>', 1, "invalid token; write & as &amp;"),
            ('<?xml version="1.0" encoding="utf-16"?><KinBody name="b"/>', 1, "leave the encoding out"),
            ('<?xml version="1.0" encoding="shift_jis"?><KinBody name="b"/>', 1, "save it as UTF-8"),
            ('<Robot name="r">\n<KinBody/>', 2, "no element found; <Robot> of line 1 is open there"),
            (
                "<KinBody name='b'>\n" + JOINT.format("mimic_pos='1/lead'", "") + "</KinBody>",
                2,
                "joint 'j' has no value",
            ),
            (f'<Robot name="r"><KinBody>{TWO}</KinBody>\n{ARM}</Robot>', 2, "exchange base"),
            ("", 0, "the file is empty"),
            ("<Nonsense/>", 1, "the root element is <Nonsense>"),
            ('<KinBody name="b"><Body name="A"/>\n<Joint>\n<Body>nope</Body></Joint></KinBody>', 3, "there are: A"),
            ('<KinBody name="b"><Body name="A"/>\n<Joint><Body>A</Body></Joint></KinBody>', 2, "names 1 bodies"),
            (f'<KinBody name="b">{BODIES}\n<Joint><axis>0 0 0</axis></Joint></KinBody>', 2, "cannot be 0 0 0"),
            (f'<KinBody name="b">{BODIES}\n<Joint><maxvel>-1</maxvel></Joint></KinBody>', 2, "cannot be negative"),
            ('<KinBody name="b">\n<Body><Quat>0 0 0 0</Quat></Body></KinBody>', 2, "no rotation"),
            ("<Environment>\n<Robot/></Environment>", 2, "has no name"),
            ('<Environment>\n<Robot name="a b"/></Environment>', 2, "spaces"),
            ('<Environment><Robot name="a"/>\n<KinBody name="a"/></Environment>', 2, "already is a body 'a'"),
            ('<!DOCTYPE r [<!ENTITY e "1">]>\n<KinBody name="b"><Body name="a">&e;</Body></KinBody>', 2, "entity"),
        ],
    )
    def test_name_the_line(self, read_text, content, line, words):
        failure = read_text(content).failure
        assert failure is not None
        assert failure.source.line == line
        assert words in str(failure)

    def test_bodies_before_stay(self, read_text):
        reading = read_text('<Environment><KinBody name="a"/><KinBody name="a"/><KinBody name="c"/></Environment>')
        assert [body.name for body in reading.scene.bodies] == ["a"]

    def test_entities_from_outside_are_not_read(self, write):
        secret = write("secret", "secret.txt")
        reading = read(
            write(
                f'<!DOCTYPE r [<!ENTITY e SYSTEM "file://{secret}">]>'
                '<KinBody name="b"><Body name="a">&e;</Body></KinBody>'
            )
        )
        assert reading.failure is not None

    def test_entity_bomb(self, write):
        entities = '<!ENTITY a0 "ha">' + "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 20}">' for i in range(1, 10))
        reading = read(write(f'<!DOCTYPE r [{entities}]><KinBody name="b"><Body name="x">&a9;</Body></KinBody>'))
        assert reading.failure is not None

    def test_unreadable(self, tmp_path):
        path = tmp_path / "nowhere.xml"
        assert str(read(path).failure) == f"{path}: error: cannot read the file: no such file or directory"

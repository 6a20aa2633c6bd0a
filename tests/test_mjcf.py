"""The MJCF text: what plain MuJoCo makes of it."""

import mujoco
import numpy as np
import pytest

import ravemj
import ravemj.mjcf.document
from ravemj import mjcf
from ravemj.errors import Diagnostics
from ravemj.openrave_xml import read
from ravemj.scene import Inertial
from ravemj.simulation import Simulation


@pytest.fixture
def load(tmp_path):
    def load(content: str) -> ravemj.Environment:
        path = tmp_path / "model.xml"
        path.write_text(f"<Environment>{content}</Environment>")
        return ravemj.load(path)

    return load


def codes(env):
    return [finding.code for finding in env.diagnostics]


def test_one_element_a_line(env):
    for line in env.mjcf.splitlines():
        assert line.count("<") <= 1 or line.strip().startswith("<!--")


def test_each_body_says_where_it_comes_from(env):
    assert "double-pendulum.xml:16 -->" in env.mjcf


def test_all_digits_are_kept(load):
    env = load(
        '<KinBody name="b"><Body name="a"><Translation>0.1 0.123456789012345678 1e-300</Translation></Body></KinBody>'
    )
    assert 'pos="0.1 0.12345678901234568 1e-300"' in env.mjcf
    assert env.model.body("a").pos.tolist() == [0.1, 0.12345678901234568, 1e-300]


def test_source_map(models):
    scene = read(models / "env.xml").scene
    text = mjcf.write(scene, Diagnostics())
    lines = text.text.splitlines()
    assert len(text.sources) == len(lines)
    joint = next(number for number, line in enumerate(lines, 1) if "<joint" in line)
    assert str(text.source_of_line(joint)) == f"{models / 'double-pendulum.xml'}:26"
    assert text.source_of_line(0) is None
    assert text.source_of_line(len(lines) + 1) is None


def test_names_that_clash_get_the_name_of_their_body(load):
    two = '<KinBody name="{}"><Body name="link"/></KinBody>'
    with pytest.warns(ravemj.RavemjWarning):
        env = load(two.format("one") + two.format("two"))
    assert [env.model.body(i).name for i in range(3)] == ["world", "link", "two/link"]
    assert codes(env) == ["renamed"]
    assert [body.GetLinks()[0].GetName() for body in env.GetBodies()] == ["link", "link"]


def test_world_is_taken_and_names_are_escaped(load):
    with pytest.warns(ravemj.RavemjWarning):
        env = load("""<KinBody name="b"><Body name="world"/><Body name='a&amp;"b&lt;'/><Body/></KinBody>""")
    assert [env.model.body(i).name for i in range(4)] == ["world", "b/world", 'a&"b<', "link2"]


@pytest.mark.parametrize(
    ("total", "inertia"),
    [("0", "1 0 0 0 1 0 0 0 1"), ("-2", "1 0 0 0 1 0 0 0 1"), ("1", "1 0 0 0 1 0 0 0 5"), ("1", "0 0 0 0 0 0 0 0 0")],
)
def test_inertia_that_mujoco_refuses(load, total, inertia):
    with pytest.warns(ravemj.RavemjWarning):
        env = load(
            '<KinBody name="b"><Body name="a"/><Body name="c">'
            f'<Mass type="custom"><total>{total}</total><inertia>{inertia}</inertia></Mass></Body>'
            '<Joint name="j"><Body>a</Body><Body>c</Body><axis>0 0 1</axis></Joint></KinBody>'
        )
    assert codes(env) == ["raised-inertia"]
    link = env.GetBodies()[0].GetLink("c")
    assert link.GetMass() == float(total)
    assert env.model.body("c").mass == float(total)
    wanted = np.array([float(part) for part in inertia.split()]).reshape(3, 3)
    np.testing.assert_array_equal(link.GetLocalInertia(), wanted)
    np.testing.assert_allclose(np.sort(env.model.body("c").inertia), np.sort(np.diag(wanted)), atol=1e-15)
    mujoco.MjModel.from_xml_string(env.mjcf)  # the text has legal values


def test_legal_inertia_is_left_alone():
    legal = Inertial(2.0, (0, 0, 0), ((1, 0.1, 0), (0.1, 1.2, 0), (0, 0, 2.0)))
    assert mjcf.legal_inertial(legal) is legal


def test_flat_inertia_is_legal():
    """A thin plate: the largest moment is the sum of the others, but for rounding."""
    third = 0.1 + 0.2
    plate = Inertial(2.0, (0, 0, 0), ((0.1, 0, 0), (0, 0.2, 0), (0, 0, third)))
    assert mjcf.legal_inertial(plate) is plate


def test_size_that_mujoco_refuses(load):
    with pytest.warns(ravemj.RavemjWarning):
        env = load('<KinBody name="b"><Body name="a"><Geom type="box"/></Body></KinBody>')
    assert codes(env) == ["raised-size"]
    assert env.model.geom_size[0].tolist() == [1e-10] * 3


def test_limits_effort_and_reference(load):
    env = load(
        '<KinBody name="b"><Body name="a"/><Body name="c"/>'
        '<Joint name="j"><Body>a</Body><Body>c</Body><axis>0 0 2</axis><anchor>1 0 0</anchor>'
        "<limits>-1 2</limits><maxtorque>5</maxtorque><initial>.5</initial></Joint></KinBody>"
    )
    joint = env.model.joint("j")
    assert joint.range.tolist() == [-1, 2]
    assert env.model.jnt_actfrcrange.tolist() == [[-5, 5]]
    assert joint.qpos0.tolist() == [0.5]
    assert (joint.pos.tolist(), joint.axis.tolist()) == ([1, 0, 0], [0, 0, 1])


def test_pairs_that_never_touch(load):
    boxes = "".join(f'<Body name="{name}"><Geom type="box"><extents>1 1 1</extents></Geom></Body>' for name in "abcd")
    env = load(
        f'<KinBody name="k">{boxes}<adjacent>a c</adjacent>'
        '<Joint name="ab"><Body>a</Body><Body>b</Body></Joint><Joint name="bc"><Body>b</Body><Body>c</Body></Joint>'
        '<Joint name="cd"><Body>c</Body><Body>d</Body></Joint></KinBody>'
    )
    mujoco.mj_forward(env.model, env.data)
    touching = {
        frozenset(env.model.body(env.model.geom_bodyid[geom]).name for geom in contact.geom)
        for contact in env.data.contact
    }
    assert touching == {frozenset("bd"), frozenset("ad")}


def test_invisible_shapes_collide_and_are_not_drawn(load):
    env = load(
        '<KinBody name="b"><Body name="a"><Geom type="sphere" render="false"><radius>1</radius></Geom></Body></KinBody>'
    )
    assert env.model.geom_group.tolist() == [3]
    assert env.model.geom_contype.tolist() == [1]


def test_mujoco_s_complaints_name_the_user_s_line(monkeypatch, models, tmp_path):
    """Whatever MuJoCo still refuses is reported for the line of the user's file."""
    monkeypatch.setattr(mjcf.document, "legal_inertial", lambda given: Inertial(-1.0, given.com, given.inertia))
    simulation = Simulation()
    (body,) = read(models / "double-pendulum.xml").scene.bodies
    simulation.add(body)
    with pytest.raises(ravemj.CompileError, match=r"MuJoCo refuses .*mass") as caught:
        simulation.compile()
    assert caught.value.source.file == str(models / "double-pendulum.xml")
    assert caught.value.source.line == 16

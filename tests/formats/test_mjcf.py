"""The MJCF text: what plain MuJoCo makes of it."""

import mujoco
import numpy as np
import pytest

import ravemj
import ravemj.formats.mjcf.document
from ravemj.engine.simulation import Simulation
from ravemj.errors import Diagnostics
from ravemj.formats import mjcf
from ravemj.formats.openrave_xml import read
from ravemj.model.scene import Inertial, Scene


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
    env = load(two.format("one") + two.format("two"))
    assert [env.model.body(i).name for i in range(3)] == ["world", "link", "two/link"]
    assert codes(env) == ["renamed"]
    assert [body.GetLinks()[0].GetName() for body in env.GetBodies()] == ["link", "link"]


def test_world_is_taken_and_names_are_escaped(load):
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


@pytest.mark.parametrize(
    ("given", "nearest"),
    [
        ((1, 1, 10), (11 / 3, 11 / 3, 22 / 3)),
        ((2.5e-5, 6.9e-5, 4.59e-4), (1.4666667e-4, 1.9066667e-4, 3.3733333e-4)),
        ((1, 2, 2.9), (1, 2, 2.9)),
        ((-5, 1, 1), (0, 1, 1)),
        ((-1, -1, -1), (0, 0, 0)),
        ((0, 0, 3), (1, 1, 2)),
    ],
)
def test_illegal_inertia_becomes_the_nearest_legal_one(given, nearest):
    """That is, the one with the least sum of squared differences."""
    x, y, z = given
    moments = np.diag(mjcf.legal_inertial(Inertial(2.0, (0, 0, 0), ((y, 0, 0), (0, z, 0), (0, 0, x)))).inertia)
    np.testing.assert_allclose(np.sort(moments), nearest, rtol=1e-6, atol=2e-10)
    mesh = np.stack(np.meshgrid(*[np.linspace(0, 8, 33)] * 3), axis=-1).reshape(-1, 3)
    allowed = mesh[2 * mesh.max(axis=1) <= mesh.sum(axis=1)]
    distance = np.linalg.norm(allowed - given, axis=1).min()
    assert np.linalg.norm(np.subtract(nearest, given)) <= distance + 1e-9


@pytest.mark.parametrize("offset", [5e-7, 9e-7, 1.1e-6, 1e-5])
def test_a_centre_of_mass_near_its_frame_counts(load, offset):
    mass = f'<Mass type="custom"><total>1000</total><com>{offset} 0 0</com><inertia>1 0 0 0 1 0 0 0 1</inertia></Mass>'
    env = load(
        f'<Robot name="r"><KinBody><Body name="a"/><Body name="b">{mass}</Body>'
        '<Joint name="j" type="hinge"><Body>a</Body><Body>b</Body><axis>0 1 0</axis></Joint></KinBody></Robot>'
    )
    gravity = env.GetPhysicsEngine().GetGravity()[2]
    torque = env.GetRobots()[0].ComputeInverseDynamics([0.0])
    np.testing.assert_allclose(torque, [1000 * gravity * offset], rtol=1e-9)


def test_the_text_of_many_bodies_asks_for_the_memory_that_they_need(load):
    box = '<Geom type="box"><Extents>0.1 0.1 0.1</Extents></Geom>'
    body = f'<KinBody name="k{{0}}"><Translation>{{0}} 0 0</Translation><Body name="b">{box}</Body></KinBody>'
    env = load("<Environment>" + "".join(body.format(number) for number in range(2000)) + "</Environment>")
    model = mujoco.MjModel.from_xml_string(env.mjcf)
    mujoco.mj_forward(model, mujoco.MjData(model))
    assert "<size" not in load(body.format(0)).mjcf


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
        simulation.compiled()
    assert caught.value.source.file == str(models / "double-pendulum.xml")
    assert caught.value.source.line == 16


FOLLOWING = """<KinBody name="k"><Mass type="mimicgeom"><density>1000</density></Mass>
  {bodies}
  <Joint name="a"><Body>l0</Body><Body>l1</Body><axis>0 1 0</axis><limits>-2 2</limits><initial>0.25</initial></Joint>
  <Joint name="b"><Body>l0</Body><Body>l2</Body><axis>0 1 0</axis><limits>-2 2</limits></Joint>
  <Joint name="f" mimic_pos="{equation}"><Body>l0</Body><Body>l3</Body><axis>0 1 0</axis><limits>-3 3</limits></Joint>
</KinBody>"""
LINKS = "".join(
    f'<Body name="l{i}"><Translation>0 {i} 0</Translation><Geom type="box"><extents>.1 .1 .1</extents>'
    "<Translation>.3 0 0</Translation></Geom></Body>"
    for i in range(4)
)


def settle(env, targets):
    """Let MuJoCo alone pull the joints to the targets, and return where they all are."""
    model = mujoco.MjModel.from_xml_string(env.mjcf)
    data = mujoco.MjData(model)
    model.opt.gravity[:] = 0
    model.dof_damping[:] = 2
    for _ in range(3000):
        for name, target in targets.items():
            joint = data.joint(name)
            joint.qfrc_applied[:] = 50 * (target - joint.qpos) - 5 * joint.qvel
        mujoco.mj_step(model, data)
    return {name: float(data.joint(name).qpos[0]) for name in ("a", "b", "f")}


@pytest.mark.parametrize(
    ("equation", "value"),
    [
        ("0.5*a+0.2", lambda a, b: 0.5 * a + 0.2),
        ("a^3-a", lambda a, b: a**3 - a),
        ("a-2*b+0.1", lambda a, b: a - 2 * b + 0.1),
        ("0.7", lambda a, b: 0.7),
    ],
)
def test_followers_follow_in_plain_mujoco(load, equation, value):
    env = load(FOLLOWING.format(bodies=LINKS, equation=equation))
    assert codes(env) == []
    settled = settle(env, {"a": 0.8, "b": -0.3})
    assert settled["f"] == pytest.approx(value(settled["a"], settled["b"]), abs=5e-3)


def test_a_follower_that_is_no_polynomial_is_fitted(load):
    with pytest.warns(ravemj.RavemjWarning, match="off by up to"):
        env = load(FOLLOWING.format(bodies=LINKS, equation="sin(a)"))
    assert codes(env) == ["fitted-mimic"]
    settled = settle(env, {"a": 0.8, "b": 0.0})
    assert settled["f"] == pytest.approx(np.sin(settled["a"]), abs=0.05)


def test_a_follower_that_mjcf_cannot_say_is_reported(load):
    with pytest.warns(ravemj.RavemjWarning, match="in a way that MJCF cannot say"):
        env = load(FOLLOWING.format(bodies=LINKS, equation="a*b"))
    assert codes(env) == ["dropped-mimic"]
    body = env.GetBodies()[0]
    body.SetDOFValues([0.5, 0.4])
    assert body.GetJoint("f").GetValues() == [0.2]  # the runtime needs no constraint


def test_container(load):
    env = load(
        '<KinBody name="b"><Body name="a"><Geom type="container"><outer_extents>1 2 3</outer_extents>'
        "<inner_extents>.8 1.6 2.9</inner_extents></Geom></Body></KinBody>"
    )
    lows = env.model.geom_pos - env.model.geom_size
    highs = env.model.geom_pos + env.model.geom_size
    np.testing.assert_allclose(lows.min(axis=0), [-0.5, -1, 0], atol=1e-12)
    np.testing.assert_allclose(highs.max(axis=0), [0.5, 1, 3], atol=1e-12)
    mujoco.mj_forward(env.model, env.data)
    down = mujoco.mj_ray(
        env.model, env.data, np.array([0.0, 0, 5]), np.array([0.0, 0, -1]), None, 1, -1, np.zeros(1, np.int32)
    )
    assert down == pytest.approx(4.9)  # the floor is 0.1 thick, and the box is open


VERTICES = "0 0 0 1 0 0 0 1 0  0 0 0 0 0 1 1 0 0  0 0 0 0 1 0 0 0 1  1 0 0 0 0 1 0 1 0"


def test_a_mesh_is_drawn_and_collides_as_one_geom(load):
    env = load(
        f'<KinBody name="b"><Body name="a"><Geom type="trimesh"><vertices>{VERTICES}</vertices></Geom></Body></KinBody>'
    )
    assert codes(env) == []
    assert env.model.nmesh == env.model.ngeom == 1
    assert env.model.geom_contype.tolist() == [1]
    assert env.model.geom_group.tolist() == [0]


def test_a_flat_mesh_is_drawn_only(load):
    flat = "0 0 0 1 0 0 0 1 0  1 0 0 1 1 0 0 1 0"
    with pytest.warns(ravemj.RavemjWarning, match="flat"):
        env = load(
            f'<KinBody name="b"><Body name="a"><Geom type="trimesh"><vertices>{flat}</vertices></Geom></Body></KinBody>'
        )
    assert codes(env) == ["flat-mesh"]
    assert env.model.geom_contype.tolist() == [0]
    assert env.model.geom_group.tolist() == [2]


def test_mesh_vertices_stay_where_they_are(load):
    """MuJoCo moves meshes to their centre of mass; what is seen must not move."""
    env = load(
        '<KinBody name="b"><Translation>1 2 3</Translation><Body name="a"><Geom type="trimesh">'
        "<Translation>.1 0 0</Translation><RotationAxis>0 0 1 90</RotationAxis>"
        f"<vertices>{VERTICES}</vertices></Geom></Body></KinBody>"
    )
    mujoco.mj_kinematics(env.model, env.data)
    seen = env.model.mesh_vert @ env.data.geom_xmat[0].reshape(3, 3).T + env.data.geom_xpos[0]
    expected = {(1.1, 2, 3), (1.1, 3, 3), (0.1, 2, 3), (1.1, 2, 4)}
    assert {tuple(np.round(point, 6).tolist()) for point in seen} == expected


class TestOptions:
    def write(self, env, **options):
        scene = read_scene(env)
        return mujoco.MjModel.from_xml_string(mjcf.write(scene, Diagnostics(), mjcf.Options(**options)).text)

    def test_free_bases(self, load):
        env = load(
            '<KinBody name="falls"><Body name="a"/></KinBody>'
            '<KinBody name="stands"><Body name="b" type="static"/></KinBody>'
        )
        model = self.write(env, free_bases=True)
        assert model.nq == 7
        data = mujoco.MjData(model)
        for _ in range(50):
            mujoco.mj_step(model, data)
        assert data.body("a").xpos[2] < -0.01
        assert data.body("b").xpos[2] == 0

    @pytest.mark.parametrize("kind", ["position", "velocity", "torque"])
    def test_actuators(self, load, kind):
        motor = (
            '<actuator type="electric_motor"><gear_ratio>10</gear_ratio><rotor_inertia>0.002</rotor_inertia></actuator>'
        )
        env = load(
            f'<KinBody name="b">{LINKS}<Joint name="j"><Body>l0</Body><Body>l1</Body><axis>0 0 1</axis>'
            f"<limits>-1 2</limits><maxtorque>5</maxtorque><maxvel>3</maxvel>{motor}</Joint></KinBody>"
        )
        assert env.model.dof_armature.tolist() == [0]
        model = self.write(env, actuators=kind)
        assert model.dof_armature.tolist() == [0.2]
        limits = {"position": [-1, 2], "velocity": [-3, 3], "torque": [-5, 5]}[kind]
        assert model.actuator_ctrlrange.tolist() == [limits]


def read_scene(env):
    return Scene(tuple(body.scene for body in env.simulation.bodies))

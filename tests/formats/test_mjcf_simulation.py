"""MJCF models for simulations: start poses, gains, options, and the text that people edit."""

import json
import math
import re
import warnings
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sim_judge import judge

import ravemj
from ravemj.cli import main
from ravemj.engine.servo_gains import ServoLoads, servo_gains
from ravemj.formats.mjcf.tidy import tidy, tidy_vector

URDF = """<?xml version="1.0"?>
<robot name="arm">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision>
    <inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="upper"><collision><origin xyz="0 0 0.2"/><geometry><box size="0.05 0.05 0.3"/></geometry></collision>
    <inertial><origin xyz="0 0 0.2"/><mass value="1.5"/>
      <inertia ixx="0.01" iyy="0.01" izz="0.002" ixy="0.001" ixz="0" iyz="0"/></inertial></link>
  <link name="plate"><visual><geometry><box size="0.1 0.1 0.01"/></geometry></visual>
    <inertial><origin xyz="0.1 0 0"/><mass value="0.5"/>
      <inertia ixx="0.001" iyy="0.001" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="fore"><collision><origin xyz="0.15 0 0"/><geometry><box size="0.3 0.04 0.04"/></geometry></collision>
    <inertial><origin xyz="0.15 0 0"/><mass value="0.8"/>
      <inertia ixx="0.001" iyy="0.006" izz="0.006" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="left"><collision><origin xyz="0 0 0"/><geometry><box size="0.1 0.02 0.02"/></geometry></collision>
    <inertial><mass value="0.05"/><inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="right"><collision><geometry><box size="0.1 0.02 0.02"/></geometry></collision>
    <inertial><mass value="0.05"/><inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.06"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="80" velocity="3"/>
    <dynamics damping="0.3" friction="0.1"/></joint>
  <joint name="mount" type="fixed"><parent link="upper"/><child link="plate"/>
    <origin xyz="0.05 0.02 0.3" rpy="0.3 0.2 0.1"/></joint>
  <joint name="elbow" type="revolute"><parent link="plate"/><child link="fore"/><origin xyz="0 0 0.06" rpy="0 0.4 0"/>
    <axis xyz="0 1 0"/><limit lower="0.2" upper="2.5" effort="40" velocity="3"/></joint>
  <joint name="finger" type="prismatic"><parent link="fore"/><child link="left"/><origin xyz="0.35 0.005 0"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.05" effort="20" velocity="1"/></joint>
  <joint name="follower" type="prismatic"><parent link="fore"/><child link="right"/><origin xyz="0.35 -0.005 0"/>
    <axis xyz="0 -1 0"/><limit lower="0" upper="0.05" effort="20" velocity="1"/><mimic joint="finger"/></joint>
</robot>
"""
SRDF = """<?xml version="1.0"?>
<robot name="arm">
  <group name="all"><chain base_link="base" tip_link="fore"/></group>
  <group_state name="up" group="all"><joint name="shoulder" value="0.1"/><joint name="elbow" value="0.5"/></group_state>
  <group_state name="half_sitting" group="all"><joint name="shoulder" value="0.7"/></group_state>
</robot>
"""


@pytest.fixture
def arm(tmp_path):
    (tmp_path / "arm.urdf").write_text(URDF)
    return load(tmp_path / "arm.urdf")


def load(path, **given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        return ravemj.load(path, given)


def written(env, path, **choices):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        return Path(env.write_mjcf(path, **choices))


def opened(env, tmp_path, **choices):
    return mujoco.MjModel.from_xml_path(str(written(env, tmp_path / "out.xml", **choices)))


def at_key(model, name="home"):
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(name).id)
    mujoco.mj_forward(model, data)
    return data


def test_it_starts_at_zero_moved_into_the_limits(arm, tmp_path):
    data = at_key(opened(arm, tmp_path, actuators="position"))
    assert [data.joint(name).qpos[0] for name in ("shoulder", "elbow", "finger", "follower")] == [0, 0.2, 0, 0]
    assert data.ctrl.tolist() == [0, 0.2, 0]


def test_states_of_the_srdf_are_keyframes(arm, tmp_path):
    (tmp_path / "arm.srdf").write_text(SRDF)
    env = load(tmp_path / "arm.urdf")
    model = opened(env, tmp_path)
    assert [model.key(number).name for number in range(model.nkey)] == ["home", "up", "half_sitting"]
    assert at_key(model).joint("shoulder").qpos == [0.7]
    assert at_key(model, "up").joint("elbow").qpos == [0.5]
    assert at_key(opened(env, tmp_path, state="up")).joint("shoulder").qpos == [0.1]
    env.GetRobots()[0].SetDOFValues([0.3, 0.9, 0.02])
    moved = at_key(opened(env, tmp_path))
    assert [moved.joint(name).qpos[0] for name in ("shoulder", "elbow", "follower")] == [0.3, 0.9, 0.02]
    with pytest.raises(ravemj.ArgumentError, match="no state 'down'; the model has up, half_sitting"):
        env.write_mjcf(tmp_path / "out.xml", state="down")


def test_what_touches_at_the_start_is_excluded(arm, tmp_path):
    """The fingers are in each other; forearm and upper arm are joined over a plate, and touch when folded."""
    text = written(arm, tmp_path / "out.xml").read_text()
    assert '<exclude body1="left" body2="right"/>' in text
    assert at_key(mujoco.MjModel.from_xml_path(str(tmp_path / "out.xml"))).ncon == 0
    bare = opened(arm, tmp_path, exclude="none")
    assert (bare.nexclude, at_key(bare).ncon > 0) == (0, True)


def test_self_collision_can_be_switched_off_and_the_floor_stays(arm, tmp_path):
    folder = written(arm, tmp_path / "out", self_collision=False, exclude="none", base="free").parent
    model = mujoco.MjModel.from_xml_path(str(folder / "scene.xml"))
    data = at_key(model)
    assert data.ncon == 4, "the base stands on the floor, and no more"
    assert {model.geom(geom).name for geom in data.contact.geom[:, 0]} == {"ground"}


def test_links_that_cannot_move_are_merged_with_all_that_they_have(arm, tmp_path):
    apart, merged = opened(arm, tmp_path), opened(arm, tmp_path, merge_fixed=True)
    assert (apart.nbody - merged.nbody, merged.site("plate").bodyid[0]) == (1, merged.body("upper").id)
    rng = np.random.default_rng(1)
    one, other = mujoco.MjData(apart), mujoco.MjData(merged)
    for _ in range(5):
        one.qpos[:] = other.qpos[:] = rng.uniform(0, 1, apart.nq)
        full, same = np.zeros((2, apart.nv, apart.nv))
        for model, data, mass in ((apart, one, full), (merged, other, same)):
            mujoco.mj_forward(model, data)
            mujoco.mj_fullM(model, data, mass)
        np.testing.assert_allclose(same, full, atol=1e-12)
        np.testing.assert_allclose(other.qfrc_bias, one.qfrc_bias, atol=1e-12)
        np.testing.assert_allclose(other.site("plate").xpos, one.body("plate").xpos, atol=1e-12)
        np.testing.assert_allclose(other.body("fore").xmat, one.body("fore").xmat, atol=1e-12)
    assert merged.ngeom == apart.ngeom


def test_sensors_are_those_of_joints_base_and_model(arm, tmp_path):
    model = opened(arm, tmp_path, sensors=True)
    names = {model.sensor(number).name for number in range(model.nsensor)}
    assert {"shoulder/jointpos", "follower/jointvel", "imu/accelerometer", "imu/gyro"} <= names
    data = at_key(model)
    np.testing.assert_allclose(data.sensor("imu/accelerometer").data, [0, 0, -model.opt.gravity[2]], atol=1e-9)
    assert data.sensor("elbow/jointpos").data == [0.2]


def test_sensors_of_a_robot_are_kept(tmp_path):
    xml = """<Robot name="r"><KinBody>
    <Body name="b"><Geom type="box"><Extents>.1 .1 .1</Extents></Geom></Body></KinBody>
    <AttachedSensor name="eye"><link>b</link><translation>0 0 1</translation><sensor type="BaseCamera">
    <KK>640 480 320 240</KK><width>640</width><height>480</height></sensor></AttachedSensor>
    <AttachedSensor name="wrench"><link>b</link><sensor type="BaseForce6D"/></AttachedSensor>
    <AttachedSensor name="scan"><link>b</link>
    <sensor type="BaseLaser2D"><maxrange>3</maxrange></sensor></AttachedSensor>
    </Robot>"""
    (tmp_path / "r.xml").write_text(xml)
    env = load(tmp_path / "r.xml")
    with pytest.warns(ravemj.RavemjWarning, match="'scan' of the type .* has no counterpart in MJCF"):
        env.write_mjcf(tmp_path / "out.xml", sensors=True)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out.xml"))
    assert model.camera("eye").fovy[0] == pytest.approx(math.degrees(2 * math.atan(0.5)))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.camera("eye").xmat.reshape(3, 3) @ [0, 0, -1], [0, 0, 1], atol=1e-12)
    assert {"wrench/force", "wrench/torque"} <= {model.sensor(number).name for number in range(model.nsensor)}


def test_gains_of_a_file_are_taken(arm, tmp_path):
    (tmp_path / "gains.txt").write_text("# mine\nsh*, 500, 30\nshoulder, 600, 40  # the last one counts\n")
    model = opened(arm, tmp_path, actuators="position", gains=tmp_path / "gains.txt")
    assert model.actuator("shoulder").gainprm[0] == 600
    assert model.actuator("shoulder").biasprm[:3].tolist() == [0, -600, -40]
    assert model.actuator("elbow").gainprm[0] != 600


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("elbow 3", "'elbow 3' is not 'joint, kp, kv'"),
        ("\nelbow, x, 3", "gains.txt:2: .*is not 'joint, kp, kv'"),
        ("elbow, -1, 3", "are not positive"),
        ("elbow, nan, 3", "are not positive"),
        ("knee, 1, 3", "no joint is called 'knee'"),
    ],
)
def test_a_broken_file_of_gains_names_its_line(arm, tmp_path, text, message):
    (tmp_path / "gains.txt").write_text(text)
    with pytest.raises(ravemj.SourceError, match=message):
        arm.write_mjcf(tmp_path / "out.xml", actuators="position", gains=tmp_path / "gains.txt")
    assert not (tmp_path / "out.xml").exists()


def test_a_fragment_is_added_section_by_section(arm, tmp_path):
    (tmp_path / "more.xml").write_text("""<mujoco>
  <option timestep="0.001"/>
  <default><default class="mine"><geom rgba="1 0 0 1"/><default class="inner"/></default></default>
  <worldbody><body name="ball" pos="1 0 0.3333333333333333">
    <freejoint/><geom class="mine" size="0.1"/>
    <geom class="inner" size="0.1" rgba="0 1 0 1"/><geom class="inner" size="0.2" rgba="0 1 0 1"/></body></worldbody>
  <actuator><motor name="kick" joint="shoulder"/></actuator>
  <sensor><framepos name="where" objtype="body" objname="fore"/></sensor>
</mujoco>""")
    path = written(arm, tmp_path / "out.xml", actuators="position", append=tmp_path / "more.xml")
    assert 'pos="1 0 0.3333333333333333"' in path.read_text()
    model = mujoco.MjModel.from_xml_path(str(path))
    assert (model.nu, model.nsensor, model.opt.timestep) == (4, 1, 0.001)
    data = at_key(model)
    assert data.body("ball").xpos.tolist() == [1, 0, 1 / 3]
    assert data.joint("elbow").qpos == [0.2]
    assert path.read_text().count("<actuator>") == 1


@pytest.mark.parametrize(
    ("fragment", "message"),
    [
        ('<mujoco>\n<worldbody>\n<body name="fore"/></worldbody></mujoco>', "more.xml:3: .*'fore' has a name"),
        ('<mujoco>\n<include file="x.xml"/></mujoco>', "more.xml:2: .*<include> cannot be added"),
        ('<mujoco><extension><plugin plugin="x"/></extension></mujoco>', "more.xml:1: .*<extension> cannot"),
        ('<mujoco><compiler angle="degree"/></mujoco>', "<compiler> cannot be added"),
        ('<mujoco><worldbody>\n<geom size="0.1" colour="red"/></worldbody></mujoco>', "more.xml:2: .*colour"),
        ("<robot/>", "<robot> is no fragment"),
        ("<mujoco>", "not well-formed"),
        ("", "empty"),
        ('<mujoco><keyframe><key name="home"/></keyframe></mujoco>', "'home'"),
    ],
)
def test_a_broken_fragment_names_file_and_line(arm, tmp_path, fragment, message):
    (tmp_path / "more.xml").write_text(fragment)
    with pytest.raises(ravemj.RavemjError, match=message):
        arm.write_mjcf(tmp_path / "out.xml", append=tmp_path / "more.xml")
    assert not (tmp_path / "out.xml").exists()


@pytest.mark.parametrize(
    "choices",
    [
        {"base": "floating"}, {"actuators": "motor"}, {"exclude": "all"}, {"hull_vertices": 3}, {"timestep": 0.0},
        {"timestep": math.nan}, {"gains": "gains.txt"}, {"gains": "gains.txt", "actuators": "torque"},
    ],
)  # fmt: skip
def test_wrong_choices_are_refused(arm, tmp_path, choices):
    with pytest.raises(ravemj.ArgumentError, match=next(iter(choices))):
        arm.write_mjcf(tmp_path / "out.xml", **choices)


def test_hulls_can_be_small(tmp_path):
    env = load(ravemj.model_path("scara"))
    full, small = opened(env, tmp_path), opened(env, tmp_path, hull_vertices=8)
    assert small.mesh_graph.size < full.mesh_graph.size


def test_the_armature_of_servos_is_kept_apart_from_that_of_the_model(arm, tmp_path):
    model = opened(arm, tmp_path, actuators="position")
    assert not model.dof_armature.any()
    gains = arm.GetRobots()[0].servo_gains()
    np.testing.assert_allclose(model.actuator_armature, gains.armature, rtol=1e-5)
    np.testing.assert_allclose(model.actuator_gainprm[:, 0], gains.kp, rtol=1e-5)
    np.testing.assert_allclose(-model.actuator_biasprm[:, 2], gains.kv, rtol=1e-5)
    assert model.dof_damping[0] == 0.3
    assert model.dof_frictionloss[0] == 0.1


def test_a_model_without_actuators_has_what_it_had(arm, tmp_path):
    model = opened(arm, tmp_path)
    assert (model.nu, model.opt.integrator) == (0, mujoco.mjtIntegrator.mjINT_EULER)
    assert not model.dof_damping.any()


@pytest.mark.parametrize("timestep", [0.001, 0.002, 0.005])
def test_servos_hold_and_step(arm, tmp_path, timestep):
    path = written(arm, tmp_path / "out.xml", actuators="position", timestep=timestep)
    found = judge(path)
    assert (found["drooping"], found["bad_steps"], found["hold_warnings"]) == ({}, {}, 0)


positive = st.floats(1e-6, 1e4)


@given(positive, st.floats(0, 1e4), st.one_of(positive, st.just(math.inf)), st.booleans(), st.floats(1e-4, 0.01))
def test_gains_keep_what_their_rule_says(inertia, torque, effort, slides, timestep):
    one = np.ones(1)
    loads = ServoLoads(inertia * one, torque * one, 0 * one, 0 * one, effort * one, np.array([slides]))
    (kp,), (kv,), (armature,) = servo_gains(loads, timestep)
    moved = inertia + armature
    assert torque / kp <= (0.0005 if slides else 0.005) * (1 + 1e-12)
    assert kp >= inertia * 3600 * (1 - 1e-12)
    assert kv >= 2 * math.sqrt(kp * moved) * (1 - 1e-12)
    assert math.sqrt(kp / moved) <= 1 / (2 * timestep) * (1 + 1e-12)
    assert armature >= kv * timestep / 2 * (1 - 1e-9)


def test_a_motor_that_is_too_weak_is_named(tmp_path):
    (tmp_path / "arm.urdf").write_text(URDF.replace('effort="40"', 'effort="0.5"'))
    env = load(tmp_path / "arm.urdf")
    with pytest.warns(ravemj.RavemjWarning, match=r"joint 'elbow' gives 0\.5 N m, and gravity needs 1\.\d+") as caught:
        env.write_mjcf(tmp_path / "out.xml", actuators="position")
    assert [one.message.code for one in caught] == ["weak-motor"]


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False, width=64), min_size=1, max_size=6))
def test_tidied_vectors_are_near_and_short(numbers):
    text = " ".join(map(repr, numbers))
    tidied = [float(word) for word in tidy_vector(text).split()]
    noise = 8 * math.ulp(max(map(abs, numbers)))
    assert all(abs(one - other) <= noise for one, other in zip(tidied, numbers, strict=True))
    assert tidy_vector(tidy_vector(text)) == tidy_vector(text) or noise > 0
    assert len(tidy_vector(text)) <= len(text)


def test_noise_is_left_out_and_masses_stay():
    line = '<body pos="0 -0.6718000000000001 1.4916956558863602e-16" quat="0.7071067811865476 0 0 0.7071067811865475"/>'
    assert tidy(line) == '<body pos="0 -0.6718 0" quat="0.707106781186548 0 0 0.707106781186547"/>'
    assert tidy('<joint axis="0 1.0000000000000002 -2.2e-16" range="-1.0000000000000002 1"/>') == (
        '<joint axis="0 1 0" range="-1.0000000000000002 1"/>'
    )
    inertial = (
        '<inertial pos="0 0 0.10000000000000002" mass="0.30000000000000004" diaginertia="1 1 1.0000000000000002"/>'
    )
    assert tidy(inertial) == inertial.replace("0.10000000000000002", "0.1")


def test_comments_name_files_relative_to_the_model(arm, tmp_path):
    text = written(arm, tmp_path / "there.xml").read_text()
    assert "<!-- arm.urdf:3 -->" in text
    assert str(tmp_path) not in text


def test_joints_and_geoms_that_repeat_have_classes(tmp_path):
    links = "".join(
        f'<link name="l{n}"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision><inertial>'
        '<mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        for n in range(4)
    )
    joints = "".join(
        f'<joint name="j{n}" type="revolute"><parent link="l{n}"/><child link="l{n + 1}"/><origin xyz="0 0 1"/>'
        '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="50" velocity="1"/></joint>'
        for n in range(3)
    )
    (tmp_path / "r.urdf").write_text(f'<robot name="r">{links}{joints}</robot>')
    env = load(tmp_path / "r.urdf")
    text = written(env, tmp_path / "out.xml").read_text()
    assert len(re.findall(r'<joint class="joint1" name="j\d" pos="0 0 0" axis="0 1 0"/>', text)) == 3
    assert len(re.findall(r'<geom class="collision1" type="box" size="0.05 0.05 0.05"/>', text)) == 4
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out.xml"))
    assert model.jnt_range.tolist() == [[-1, 1]] * 3
    assert set(model.geom_group.tolist()) == {3}


BAD = {
    "no mass": ('<mass value="1.5"/>', '<mass value="0"/>'),
    "effort 0": ('effort="80"', 'effort="0"'),
    "reversed limits": ('lower="-2" upper="2"', 'lower="2" upper="-2"'),
    "tiny inertia": (
        '<inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/>',
        '<inertia ixx="1e-9" iyy="1e-9" izz="1e-9" ixy="0" ixz="0" iyz="0"/>',
    ),
    "huge": ('<mass value="0.8"/>', '<mass value="8e9"/>'),
    "mimic loop": ('<axis xyz="0 1 0"/><limit lower="0" upper="0.05" effort="20" velocity="1"/></joint>',
                   '<axis xyz="0 1 0"/><limit lower="0" upper="0.05" effort="20" velocity="1"/>'
                   '<mimic joint="follower"/></joint>'),
    "missing mesh": ('<box size="0.3 0.04 0.04"/>', '<mesh filename="gone.stl"/>'),
    "no inertial": ('<inertial><mass value="0.05"/>', '<inertial><mass value="1e-30"/>'),
}  # fmt: skip
SAID = {
    "no mass": {"raised-inertia"},
    "effort 0": {"no-effort"},
    "reversed limits": {"exchanged-limits"},
    "tiny inertia": set(),  # what hangs on the joint has enough
    "huge": {"weak-motor"},
    "mimic loop": {"bad-mimic"},
    "missing mesh": {"missing-file"},
    "no inertial": {"raised-inertia"},
}


@pytest.mark.parametrize("kind", BAD)
@pytest.mark.parametrize("base", ["fixed", "free"])
def test_bad_input_gives_a_model_or_an_error(kind, base, tmp_path):
    (tmp_path / "arm.urdf").write_text(URDF.replace(*BAD[kind]))
    env = load(tmp_path / "arm.urdf")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        path = Path(env.write_mjcf(tmp_path / "out.xml", actuators="position", base=base, sensors=True))
    codes = {one.message.code for one in caught} | {finding.code for finding in env.diagnostics}
    assert codes >= SAID[kind]
    assert "nan" not in path.read_text()
    assert "inf" not in path.read_text().replace("info", "")
    mujoco.MjModel.from_xml_path(str(path))


def test_a_model_called_scene_is_refused_in_a_folder(tmp_path):
    (tmp_path / "scene.urdf").write_text(URDF)
    env = load(tmp_path / "scene.urdf")
    with pytest.raises(ravemj.OutputError, match="the model is called scene"):
        env.write_mjcf(tmp_path / "out")
    assert not (tmp_path / "out").exists()
    written(env, tmp_path / "out.xml")


def test_an_environment_keeps_its_floor(tmp_path):
    folder = written(load(ravemj.model_path("workshop")), tmp_path / "out").parent
    assert "plane" not in (folder / "scene.xml").read_text()
    folder = written(load(ravemj.model_path("panda")), tmp_path / "arm").parent
    assert "plane" in (folder / "scene.xml").read_text()


def test_check_sim_lists_what_is_missed(arm, tmp_path, capsys):
    assert main(["check", str(tmp_path / "arm.urdf"), "--sim"]) == 0
    assert "ok      holds" in capsys.readouterr().out
    (tmp_path / "weak.urdf").write_text(URDF.replace('effort="40"', 'effort="0.5"'))
    assert main(["check", str(tmp_path / "weak.urdf"), "--sim", "--json"]) == 1
    (points,) = json.loads(capsys.readouterr().out).values()
    missed = {point["point"]: point for point in points if not point["ok"]}
    assert "elbow" in missed["holds"]["missed"][0]
    assert "gravity needs" in missed["holds"]["notes"][-1]


def test_convert_says_in_one_line_how_it_holds(arm, tmp_path, capsys):
    words = ["convert", str(tmp_path / "arm.urdf"), "-o", str(tmp_path / "out"), "--actuators", "position"]
    assert main(words) == 0
    assert re.search(r"\nholds within 0\.\d+ rad and \S+ m; \d+ pairs? that touch\S* at the start excluded\n$",
                     capsys.readouterr().out)  # fmt: skip


def test_a_joint_that_moves_next_to_nothing_is_named(tmp_path):
    """One kilogram on the axis, with an inertia of 1e-9."""
    (tmp_path / "wheel.urdf").write_text("""<robot name="wheel"><link name="base"/><link name="disk"><inertial>
      <mass value="1"/><inertia ixx="1e-9" iyy="1e-9" izz="1e-9" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <joint name="spin" type="continuous"><parent link="base"/><child link="disk"/><axis xyz="0 0 1"/>
      <limit effort="1" velocity="1"/></joint></robot>""")
    env = load(tmp_path / "wheel.urdf")
    with pytest.warns(ravemj.RavemjWarning, match="joint 'spin' moves an inertia of only 1e-09 kg m"):
        env.write_mjcf(tmp_path / "out.xml", actuators="position")
    assert judge(tmp_path / "out.xml")["bad_steps"] == {}

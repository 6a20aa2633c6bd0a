"""SRDF: pairs, groups, manipulators and states; and manipulators that are guessed without one."""

from itertools import pairwise

import pytest
from test_urdf import joint, urdf

import ravemj
from ravemj.formats.readers import read_data, read_file

ARM = urdf(
    joint("j1", "base", "l1"), joint("j2", "l1", "l2"), joint("j3", "l2", "l3"),
    joint("t", "l3", "tool0", kind="fixed"), joint("f1", "l3", "finger1", kind="prismatic"),
    joint("f2", "l3", "finger2", '<mimic joint="f1"/>', "prismatic"),
    links=["base", "l1", "l2", "l3", "tool0", "finger1", "finger2"],
)  # fmt: skip
CHAIN = '<group name="arm"><chain base_link="base" tip_link="l3"/></group>'
HAND = '<group name="hand"><joint name="f1"/><joint name="f2"/></group>'


def read(srdf, text=ARM, **given):
    reading = read_data(text, {"srdf": f'<robot name="r">\n{srdf}</robot>', **given})
    assert reading.failure is None, reading.failure
    return reading


def body(srdf, **given):
    return read(srdf, **given).scene.bodies[0]


def arms(srdf):
    found = body(srdf)
    names = [link.name for link in found.links]
    return {
        arm.name: (names[arm.base], names[arm.effector], len(arm.arm_dofs), len(arm.gripper_dofs))
        for arm in found.manipulators
    }


def codes(srdf):
    return [finding.code for finding in read(srdf).diagnostics if finding.severity != "note"]


def test_disabled_pairs_are_adjacent():
    pairs = '<disable_collisions link1="l3" link2="base"/><disable_collisions link1="l1" link2="l3" reason="x"/>'
    assert body(pairs).adjacent == ((0, 3), (1, 3))
    assert body('<disable_default_collisions link="base"/>').adjacent == tuple((0, other) for other in range(1, 7))
    enabled = '<enable_collisions link1="l3" link2="base"/>'
    assert body(pairs + enabled).adjacent == ((1, 3),)


def test_an_unknown_link_is_a_warning():
    (finding,) = [
        finding
        for finding in read('<disable_collisions link1="l3" link2="bsae"/>').diagnostics
        if finding.severity == "warning"
    ]
    assert (finding.code, finding.hint) == ("unknown-link", "did you mean 'base'?")
    assert finding.source.line == 2


def test_an_end_effector_with_a_parent_group():
    effector = '<end_effector name="gripper" group="hand" parent_link="l3" parent_group="arm"/>'
    assert arms(CHAIN + HAND + effector) == {"gripper": ("base", "l3", 3, 1)}


@pytest.mark.parametrize("parent", ["l3", "tool0"])
def test_an_end_effector_whose_group_is_the_arm(parent):
    """As in the files of today, which name no parent_group."""
    effector = f'<end_effector name="ee" group="arm" parent_link="{parent}"/>'
    assert arms(CHAIN + HAND + effector) == {"ee": ("base", parent, 3, 0), "hand": ("l3", "finger1", 1, 0)}


def test_an_end_effector_whose_arm_is_the_group_that_ends_there():
    effector = '<end_effector name="ee" group="hand" parent_link="l3"/>'
    longer = '<group name="all"><group name="arm"/><group name="hand"/></group>'
    assert arms(CHAIN + longer + HAND + effector)["ee"] == ("base", "l3", 3, 1)


def test_groups_of_joints_and_links_and_groups_are_manipulators():
    joints = '<group name="js"><joint name="j2"/><joint name="j3"/><joint name="t"/></group>'
    links = '<group name="ls"><link name="l2"/><link name="l3"/></group>'
    nested = '<group name="ns"><group name="js"/><joint name="j1"/></group>'
    longer = '<group name="longer"><joint name="f1"/><chain base_link="base" tip_link="l3"/><joint name="t"/></group>'
    assert arms(joints + links + nested + longer) == {
        "js": ("l1", "l3", 2, 0),
        "ls": ("l1", "l3", 2, 0),
        "ns": ("base", "l3", 3, 0),
        "longer": ("base", "finger1", 4, 0),
    }


def test_groups_inside_themselves_are_refused():
    text = '<group name="a"><group name="b"/></group><group name="b"><group name="a"/></group>'
    (error,) = [finding for finding in read(text).diagnostics if finding.severity == "error"]
    assert (error.code, error.message) == ("broken-file", "group 'a' contains itself")


def test_many_nested_groups_are_read_once():
    text = "".join(f'<group name="g{i}"><group name="g{i + 1}"/><group name="g{i + 1}"/></group>' for i in range(45))
    assert codes(text + '<group name="g45"><chain base_link="base" tip_link="l3"/></group>') == []


def test_states_are_kept_and_taken():
    states = (
        '<group_state name="home" group="arm"><joint name="j1" value="0.5"/><joint name="world_joint" value="0 0 1"/>'
        '</group_state><group_state name="home" group="hand"><joint name="f1" value="1"/></group_state>'
        '<group_state name="far" group="arm"><joint name="j2" value="-1"/></group_state>'
    )
    text = CHAIN + HAND + states
    assert [(named.name, named.values) for named in body(text).configurations] == [
        ("home", (("j1", 0.5), ("f1", 1.0))),
        ("far", (("j2", -1.0),)),
    ]
    assert [axis.value for axis in body(text, state="home").dof_axes] == [0.5, 0, 0, 1]
    assert [axis.value for axis in body(text).dof_axes] == [0, 0, 0, 0]
    failure = read_data(ARM, {"srdf": f'<robot name="r">{text}</robot>', "state": "hom"}).failure
    assert "there is no group state 'hom'; did you mean 'home'?" in str(failure)


def test_a_state_without_an_srdf_is_an_error():
    assert "the robot has no SRDF" in str(read_data(ARM, {"state": "home"}).failure)


def test_spheres_go_to_their_group():
    spheres = '<link_sphere_approximation link="l1"><sphere center="0 0 1" radius="2"/></link_sphere_approximation>'
    (sphere,) = dict(body(spheres).links[1].groups)["spheres"]
    assert (sphere.shape.radius, sphere.T_link_geometry.position) == (2, (0, 0, 1))


def test_the_srdf_beside_the_urdf_is_found(tmp_path):
    for place in ("r.srdf", "../srdf/r.srdf"):
        (tmp_path / "urdf").mkdir(exist_ok=True)
        (tmp_path / "srdf").mkdir(exist_ok=True)
        (tmp_path / "urdf" / "r.urdf").write_text(ARM)
        srdf = (tmp_path / "urdf" / place).resolve()
        srdf.write_text(f'<robot name="r">{CHAIN}</robot>')
        reading = read_file(tmp_path / "urdf" / "r.urdf")
        assert [arm.name for arm in reading.scene.bodies[0].manipulators] == ["arm"]
        assert str(srdf) in reading.files
        assert read_file(tmp_path / "urdf" / "r.urdf", {"srdf": "none"}).scene.bodies[0].manipulators == ()
        srdf.unlink()


def test_an_srdf_alone_says_what_it_is():
    failure = read_data(f'<robot name="r">{CHAIN}</robot>').failure
    assert "this is an SRDF, which belongs to a URDF" in str(failure)


def guessed(text):
    reading = read_data(text)
    names = [link.name for link in reading.scene.bodies[0].links]
    return {
        arm.name: (names[arm.base], len(arm.arm_dofs), len(arm.gripper_dofs))
        for arm in reading.scene.bodies[0].manipulators
    }


def test_a_tool_is_guessed_and_said_in_one_line():
    assert guessed(ARM) == {"tool0": ("base", 3, 1)}
    (note,) = read_data(ARM).diagnostics
    assert (note.severity, note.code) == ("note", "guessed-manipulators")
    assert note.message == "no SRDF describes the arms; a guessed manipulator: 'tool0' (3 joints)"


def chain(links, base="base"):
    ends = [base, *links]
    return [joint(f"to_{child}", parent, child) for parent, child in pairwise(ends)]


def robot(*chains):
    links = ["base", *(link for one in chains for link in one)]
    return urdf(*(text for one in chains for text in chain(one)), links=dict.fromkeys(links))


def test_a_jaw_behind_a_gripper_is_no_arm():
    assert guessed(robot(["a", "b", "c", "gripper", "moving_jaw"])) == {"gripper": ("base", 4, 1)}


def test_two_arms_start_at_the_torso():
    left, right = ["torso", "l1", "l2", "l3", "left_hand"], ["r1", "r2", "r3", "right_hand"]
    text = urdf(*chain(left), *chain(right, "torso"), links=["base", *left, *right])
    assert guessed(text) == {"left_hand": ("torso", 4, 0), "right_hand": ("torso", 4, 0)}


def test_legs_without_names_of_tools_are_the_longest_chains():
    assert guessed(robot(["a", "b", "foot_a"], ["c", "d", "foot_c"], ["neck"])) == {
        "foot_a": ("base", 3, 0),
        "foot_c": ("base", 3, 0),
    }


def test_two_joints_are_no_arm():
    assert guessed(robot(["a", "tool0"])) == {}


# or_urdf's module


@pytest.fixture
def module():
    env = ravemj.Environment()
    assert ravemj.RaveLoadPlugin("or_urdf")
    return ravemj.RaveCreateModule(env, "urdf")


def test_the_module_loads_files_with_their_joints_by_name(module, tmp_path):
    text = urdf(joint("zz", "a", "z"), joint("aa", "a", "m"), links="zam")
    (tmp_path / "r.urdf").write_text(text)
    (tmp_path / "r2.srdf").write_text('<robot name="r"/>')
    name = module.SendCommand(f"LoadURI {tmp_path / 'r.urdf'} {tmp_path / 'r2.srdf'}")
    env = module.GetEnv()
    robot = env.GetRobot(name)
    assert name == "r"
    assert [one.GetName() for one in robot.GetJoints()] == ["aa", "zz"]
    assert [one.GetName() for one in robot.GetLinks()] == ["a", "m", "z"]
    other = module.SendCommand(f"load file://{tmp_path / 'r.urdf'}")
    assert other != name
    assert env.GetRobot(other) is None
    assert env.GetKinBody(other).GetDOF() == 2


def test_the_module_loads_texts(module):
    import json

    srdf = f'<robot name="r">{CHAIN}</robot>'
    name = module.SendCommand("LoadString " + json.dumps({"urdf": ARM, "srdf": srdf}))
    assert [arm.GetName() for arm in module.GetEnv().GetRobot(name).GetManipulators()] == ["arm"]
    for wrong in ("{", "[]", '{"urdf": 1}', '{"srdf": "x"}'):
        with pytest.raises(ravemj.openrave_exception, match="LoadString"):
            module.SendCommand(f"LoadString {wrong}")


def test_the_module_answers_none_for_what_it_cannot_load(module, caplog):
    assert module.SendCommand("LoadURI package://nowhere/r.urdf") is None
    assert module.SendCommand("LoadURI nowhere.urdf") is None
    assert "nowhere.urdf" in caplog.text

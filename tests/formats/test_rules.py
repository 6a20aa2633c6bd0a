"""Rules of OpenRAVE that random scripts showed, on inputs of our own."""

import json

import numpy as np
import pytest

import ravemj

CHAIN = """<Robot name="r"><KinBody>
  <Body name="a" type="{base}"><Geom type="box"><extents>.1 .1 .1</extents></Geom></Body>
  <Body name="b"><Translation>.5 0 0</Translation><Mass type="custom"><total>2</total><com>.3 0 .1</com></Mass>
    <Geom type="box"><extents>.1 .1 .1</extents></Geom></Body>
  <Body name="c"><Translation>1 .2 0</Translation><Mass type="custom"><total>1</total><com>.1 .2 0</com></Mass></Body>
  <Joint name="one" type="hinge" {circular}><Body>a</Body><Body>b</Body><offsetfrom>b</offsetfrom>
    <axis>0 1 0</axis>{motor}</Joint>
  <Joint name="two" type="slider" {more}><Body>b</Body><Body>c</Body><offsetfrom>c</offsetfrom>
    <axis>1 0 0</axis><limits>-1 1</limits>{motor}</Joint>
</KinBody></Robot>"""
MOTOR = """<actuator type="electric_motor"><gear_ratio>{}</gear_ratio><rotor_inertia>.2</rotor_inertia>
  <coloumb_friction>.4</coloumb_friction><viscous_friction>.7</viscous_friction></actuator>"""


def chain(base="dynamic", circular="", more="", motor=""):
    env = ravemj.Environment()
    env.StopSimulation()
    assert env.LoadData(CHAIN.format(base=base, circular=circular, more=more, motor=motor))
    return env, env.GetRobot("r")


class TestMotors:
    """gap-16: rotor inertia and friction count, of hinges and sliders."""

    @pytest.mark.parametrize(("gear", "rates"), [(3, [0.5, -2]), (1, [0, 0.1]), (3, [-1e-15, 0])])
    def test_they_add_to_what_links_need(self, gear, rates):
        (_, free), (_, driven) = chain(), chain(motor=MOTOR.format(gear))
        accelerations = np.array([0.3, -0.7])
        for robot in (free, driven):
            robot.SetDOFValues([0.4, 0.2])
            robot.SetDOFVelocities(rates, [0.1, 0.2, 0.3], [0.5, -0.3, 0.2])
        signs = np.where(np.abs(rates) > np.array(1e-9), np.sign(rates), 0)
        motors = 0.2 * gear**2 * accelerations + 0.4 * signs + 0.7 * np.array(rates)
        added = driven.ComputeInverseDynamics(accelerations) - free.ComputeInverseDynamics(accelerations)
        np.testing.assert_allclose(added, motors, atol=1e-9)
        parts = zip(
            driven.ComputeInverseDynamics(accelerations, None, True),
            free.ComputeInverseDynamics(accelerations, None, True),
            strict=True,
        )
        by_acceleration, by_velocity, rest = (one - other for one, other in parts)
        np.testing.assert_allclose(by_acceleration, 0.2 * gear**2 * accelerations, atol=1e-9)
        np.testing.assert_allclose(by_velocity, 0.4 * signs + 0.7 * np.array(rates), atol=1e-9)
        np.testing.assert_allclose(rest, 0, atol=1e-9)

    def test_many_configurations_agree_with_one(self):
        _, robot = chain(motor=MOTOR.format(2))
        Q, rates, accelerations = np.random.default_rng(1).uniform(-1, 1, (3, 5, 2))
        many = robot.batch_inverse_dynamics(Q, rates, accelerations)
        for values, rate, acceleration, expected in zip(Q, rates, accelerations, many, strict=True):
            robot.SetDOFValues(values)
            robot.SetDOFVelocities(rate, [0, 0, 0], [0, 0, 0], 0)
            np.testing.assert_allclose(robot.ComputeInverseDynamics(acceleration), expected, atol=1e-9)


def test_a_joint_that_nobody_moves_has_no_inverse_dynamics():  # random-api-92
    _, robot = chain(more='enable="false"')
    with pytest.raises(ravemj.openrave_exception, match="'two' has no DOF") as caught:
        robot.ComputeInverseDynamics([0])
    assert caught.value.GetCode() == "Assert"
    assert robot.batch_inverse_dynamics([[0]], [[0]], [[0]]).shape == (1, 1)


@pytest.mark.parametrize(("base", "difference"), [("dynamic", 5 - 2 * np.pi), ("static", 5)])
def test_differences_of_circular_joints(base, difference):  # gap-13, random-api-102
    _, robot = chain(base=base, circular='circular="true"')
    np.testing.assert_allclose(robot.SubtractDOFValues([5, 0.5], [0, 0.1]), [difference, 0.4])
    np.testing.assert_allclose(robot.SubtractDOFValues([5], [0], [0]), [difference])
    assert robot.SubtractDOFValues([], [], []).shape == (0,)
    assert robot.GetJoint("one").SubtractValue(5, 0, 0) == pytest.approx(difference)
    robot.SetActiveDOFs([0], ravemj.DOFAffine.X)
    np.testing.assert_allclose(robot.SubtractActiveDOFValues([5, 3], [0, 1]), [difference, 2])


def test_arguments_that_openrave_does_not_take():
    env, robot = chain()
    box = ravemj.RaveCreateKinBody(env, "")
    with pytest.raises(TypeError):
        robot.SetDOFWeights([1], [0])  # random-api-103
    with pytest.raises(ravemj.openrave_exception, match="not a robot") as caught:
        box.GetNonAdjacentLinks(ravemj.KinBody.AdjacentOptions.ActiveDOFs)  # random-api-90
    assert caught.value.GetCode() == "InvalidArguments"
    with pytest.raises(ValueError, match="position"):
        robot.ComputeJacobianTranslation(99, [1, 2])  # random-api-5: the point is looked at first


def test_values_without_numbers_change_nothing():  # random-api-145, random-api-238
    _, robot = chain()
    robot.SetDOFValues([0.1, 3], [0, 1], 0)
    robot.SetDOFValues([], [1])
    np.testing.assert_allclose(robot.GetDOFValues(), [0.1, 3])
    robot.SetDOFValues([0.2, 0.3, 9], None)
    np.testing.assert_allclose(robot.GetDOFValues(), [0.2, 0.3])
    with pytest.raises(ravemj.openrave_exception, match="shape"):
        robot.SetDOFValues([0.2, 0.3, 9])


def test_limits_that_close_hold_a_joint_where_it_is():  # random-api-117
    env, robot = chain()
    robot.SetDOFValues([0.5, 0.25])
    stood = robot.link_transforms()
    robot.SetDOFLimits([1], [-1], [0])
    assert robot.GetJoint("one").IsStatic()
    assert not env.CheckCollision(robot)
    np.testing.assert_allclose(robot.link_transforms(), stood, atol=1e-12)
    robot.SetDOFLimits([-1], [1], [0])
    robot.SetDOFValues([0.5, 0.25])
    assert not env.CheckCollision(robot)
    np.testing.assert_allclose(robot.link_transforms(), stood, atol=1e-12)


def test_axes_stay_at_their_parents_when_links_are_moved():  # random-api-234
    _, robot = chain()
    robot.GetLink("b").SetTransform(ravemj.matrixFromPose([0.5, 0.5, 0.5, 0.5, 1, 2, 3]))
    point = np.array([0.3, 0.4, 0.5])
    one, two = robot.GetJoints()
    expected = np.column_stack([np.cross(one.GetAxis(0), point - one.GetAnchor()), two.GetAxis(0)])
    np.testing.assert_allclose(robot.ComputeJacobianTranslation(2, point), expected, atol=1e-12)


def test_clones_are_within_their_limits():  # random-api-232
    env, robot = chain()
    robot.SetDOFValues([0.2, 3], [0, 1], 0)
    np.testing.assert_allclose(env.CloneSelf(1).GetRobot("r").GetDOFValues(), [0.2, 1])
    np.testing.assert_allclose(robot.GetDOFValues(), [0.2, 3])


def test_sliders_have_no_last_value():  # random-api-102
    _, robot = chain()
    robot.SetDOFValues([0.4, 0.3])
    np.testing.assert_allclose(robot.GetLinkTransformations(True)[1], [0.4, 0])


def test_json_files(tmp_path):  # name-11
    env, robot = chain()
    robot.SetDOFValues([0.4, 0.3])
    env.LoadData('<KinBody name="k"><Body name="x"/></KinBody>')
    path = tmp_path / "scene.json"
    env.Save(path, env.SelectionOptions.Body, "r")
    assert [body["name"] for body in json.loads(path.read_text())["bodies"]] == ["r"]
    other = ravemj.Environment()
    assert other.Load(path)
    np.testing.assert_allclose(other.GetRobot("r").link_transforms(), robot.link_transforms(), atol=1e-12)
    path.write_text("[1")
    assert not other.Load(path)
    assert not other.Load(tmp_path / "none.json")


FOLLOWER = """<Robot name="r"><KinBody>
  <Body name="a"/>
  <Body name="b"><Translation>.5 0 0</Translation><RotationAxis>0 1 2 40</RotationAxis></Body>
  <Body name="c"><offsetfrom>b</offsetfrom><Translation>.1 .2 0</Translation><RotationAxis>3 1 0 70</RotationAxis>
    <Mass type="custom"><total>2</total><com>.3 0 .1</com></Mass></Body>
  <Joint name="one" type="slider"><Body>a</Body><Body>b</Body><axis>0 1 1</axis></Joint>
  <Joint name="two" type="{kind}" mimic_pos="2*one-1" mimic_vel="|one 2"><Body>{first}</Body><Body>{second}</Body>
    <offsetfrom>b</offsetfrom><anchor>.1 .1 .3</anchor>{axis}<limits>{limits}</limits></Joint>
</KinBody></Robot>"""


@pytest.mark.parametrize(("first", "second"), [("b", "c"), ("c", "b")])
def test_a_spherical_joint_follows_about_x_of_its_parent(first, second):
    """random-xml-41, and random-xml-102, where the second Body is the parent; as a hinge about that x."""
    found = []
    x = f"<axis>{-1 if first == 'c' else 1} 0 0</axis>"
    for kind, axis, limits in [("spherical", "", "-9 9 " * 3), ("hinge", x, "-9 9")]:
        env = ravemj.Environment()
        env.StopSimulation()
        assert env.LoadData(FOLLOWER.format(kind=kind, first=first, second=second, axis=axis, limits=limits))
        robot = env.GetRobot("r")
        loaded = [link.GetTransform() for link in robot.GetLinks()]
        robot.SetDOFValues([0.7])
        place = robot.GetLinks()[2].GetTransform()
        rates = robot.ComputeJacobianTranslation(2, place[:3, 3]), robot.ComputeJacobianAxisAngle(2)
        robot.SetDOFVelocities([0.4])
        torque, many = robot.ComputeInverseDynamics([0.3]), robot.batch_link_transforms([[0.2], [0.7]])
        found.append([loaded, place, *rates, torque, many, robot.GetPassiveJoints()[0].GetValues()[:1]])
        assert env.model.neq == 1
    assert robot.GetPassiveJoints()[0].GetValues() == pytest.approx([0.4])
    np.testing.assert_allclose(found[0][-2][1][2], found[0][1], atol=1e-9)
    for one, other in zip(*found, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-9)


def test_a_link_without_a_name_is_no_base_that_is_missing():
    """random-xml-36: OpenRAVE refuses the robot at the first arm, and comes to no link of the third."""
    arms = "".join(f'<Manipulator name="{i}"><base>b</base><effector>b</effector></Manipulator>' for i in range(3))
    arms = arms.replace("<effector>b</effector>", "<effector>a</effector>", 1)
    env = ravemj.Environment()
    text = """<Robot name="r"><KinBody><Body name="a"/><Body/><Body name="b"/>
      <Joint name="j"><Body>a</Body><Body>b</Body><axis>0 0 1</axis></Joint></KinBody>{}</Robot>"""
    assert not env.LoadData(text.format(arms))
    assert env.GetRobot("r").GetManipulator("2").GetBase() is None


def test_a_body_without_a_name_is_refused():  # gap-18, random-api-82
    env, _ = chain()
    for text in ("<KinBody/>", '<Environment><KinBody><Body name="x"/></KinBody></Environment>'):
        with pytest.raises(ravemj.openrave_exception, match="no name") as caught:
            env.LoadData(text)
        assert caught.value.GetCode() == "Failed"
    assert len(env.GetBodies()) == 1


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ('<KinBody><Body name="a"/></KinBody>', []),
        ('<Robot><KinBody><Body name="a"/></KinBody></Robot>', []),
        ('<Environment><KinBody><Body/></KinBody><KinBody name="k"><Body name="b"/></KinBody></Environment>', []),
        ('<Environment><KinBody name="k"><Body/></KinBody><KinBody><Body name="a"/></KinBody></Environment>', ["k"]),
        ('<Environment><KinBody name="k"><Body/></KinBody><Robot><KinBody/></Robot></Environment>', ["k"]),
    ],
)
def test_a_file_with_a_body_without_a_name_does_not_load(text, kept, tmp_path):
    """OpenRAVE's ``Load`` of a file keeps what came before; only ``LoadData`` raises."""
    (tmp_path / "unnamed.xml").write_text(text)
    env = ravemj.Environment()
    assert not env.Load(str(tmp_path / "unnamed.xml"))
    assert [body.GetName() for body in env.GetBodies()] == kept


_BOX = '<Body name="{}"><Translation>{} 0 0</Translation><Geom type="sphere"><radius>0.1</radius></Geom></Body>'
_JOINT = '<Joint name="j"><Body>a</Body><Body>b</Body><axis>0 0 1</axis></Joint>'
_PARTS = _BOX.format("a", 0) + _BOX.format("b", 1) + _JOINT
_OTHER = _BOX.format("c", 2)


@pytest.mark.parametrize(
    ("first", "second", "adjacent"),
    [
        (None, None, True),
        (0, None, True),
        (None, 0, False),
        (0, 0, False),
        (0, 1, True),
        (1, 0, False),
    ],
)
@pytest.mark.parametrize("form", ["nested", "nested first", "included", "including"])
def test_the_last_kinbody_to_open_decides_about_joined_links(first, second, adjacent, form, tmp_path, monkeypatch):
    """An element that names a file opens after the root of that file."""
    monkeypatch.chdir(tmp_path)
    outer, inner = ("" if flag is None else f'makejoinedlinksadjacent="{flag}"' for flag in (first, second))
    root = f"<KinBody {outer if form == 'including' else inner}>{_OTHER}</KinBody>"
    (tmp_path / "other.xml").write_text(root)
    text = {
        "nested": f'<KinBody name="k" {outer}>{_PARTS}{root}</KinBody>',
        "nested first": f'<KinBody name="k" {outer}>{root}{_PARTS}</KinBody>',
        "included": f'<Robot name="k"><KinBody {outer}>{_PARTS}</KinBody><KinBody file="other.xml" {inner}/></Robot>',
        "including": f'<Robot name="k"><KinBody>{_PARTS}</KinBody><KinBody file="other.xml" {inner}/></Robot>',
    }[form]
    env = ravemj.Environment()
    assert env.LoadData(text)
    assert ((0, 1) in {tuple(sorted(pair)) for pair in _named_pairs(env.GetBodies()[0])}) == adjacent


def _named_pairs(body):
    names = [link.GetName() for link in body.GetLinks()]
    order = {"a": 0, "b": 1, "c": 2}
    return [(order[names[one]], order[names[two]]) for one, two in body.GetAdjacentLinks()]


@pytest.mark.parametrize("axis", ["1e-320 0 0", "0 1e-310 1e-312", "1e-160 0 0", "1e-200 1e-200 0", "1e308 1e308 0"])
@pytest.mark.parametrize("kind", ["hinge", "slider"])
def test_axes_of_any_length(axis, kind):
    env = ravemj.Environment()
    follower = f'<Joint name="m" type="{kind}" enable="false" mimic_pos="2*j"><Body>b</Body><Body>c</Body>'
    follower += f"<axis>{axis}</axis></Joint>"
    assert env.LoadData(f'<KinBody name="k">{_PARTS.replace("</Joint>", "</Joint>" + _OTHER + follower)}</KinBody>')
    direction = np.array([float(word) for word in axis.split()])
    direction = direction / np.abs(direction).max()
    (joint,) = env.GetBodies()[0].GetPassiveJoints()
    np.testing.assert_allclose(joint.GetAxis(0), direction / np.linalg.norm(direction), atol=1e-9)
    env.GetBodies()[0].SetDOFValues([1.0])
    assert np.isfinite(env.GetBodies()[0].GetLinks()[2].GetTransform()).all()

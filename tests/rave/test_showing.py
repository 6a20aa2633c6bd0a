"""Objects as a prompt shows them: repr, str, tables, tab completion."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest
from conftest import MODELS
from IPython.core.formatters import PlainTextFormatter

import ravemj
from ravemj import (
    GeometryType,
    JointType,
    KinBody,
    RaveCreateController,
    RaveCreateKinBody,
    RaveCreateTrajectory,
    TriMesh,
)

HOSTILE = """it's <b onload="x">&amp;</b> \\ "1" """.strip()

ROBOT = """<Environment>
  <Robot name="arm">
    <KinBody>
      <Body name="a"><Geom type="box" name="block"><extents>1 1 1</extents></Geom></Body>
      <Body name="b"><Translation>0 0 3</Translation><Geom type="sphere"><radius>.5</radius></Geom></Body>
      <Body name="c"><Geom type="sphere"><radius>.1</radius></Geom></Body>
      <Joint name="turn" type="hinge"><body>a</body><body>b</body><limitsrad>-1 2</limitsrad></Joint>
      <Joint name="slide" type="slider"><body>b</body><body>c</body><axis>1 0 0</axis><limits>0 .25</limits></Joint>
    </KinBody>
    <Manipulator name="hand"><base>a</base><effector>b</effector></Manipulator>
    <AttachedSensor name="eye">
      <link>b</link>
      <Sensor type="BaseCamera"><image_dimensions>64 48 3</image_dimensions></Sensor>
    </AttachedSensor>
  </Robot>
</Environment>"""


@pytest.fixture
def env():
    env = ravemj.Environment()
    assert env.LoadData(ROBOT)
    yield env
    env.Destroy()


def hostile_body(env):
    """A body of links and a joint whose names would break texts and pages."""
    first, second, joint = KinBody.LinkInfo(), KinBody.LinkInfo(), KinBody.JointInfo()
    first._name, second._name, joint._name = HOSTILE + "1", HOSTILE + "2", HOSTILE
    joint._linkname0, joint._linkname1, joint._type = first._name, second._name, JointType.Hinge
    joint._vaxes, joint._vlowerlimit, joint._vupperlimit = [[0, 0, 1]], [-1], [1]
    first._vgeometryinfos = [KinBody.GeometryInfo(_type=GeometryType.Box, _vGeomData=[1, 1, 1])]
    body = RaveCreateKinBody(env, "")
    assert body.Init([first, second], [joint])
    body.SetName(HOSTILE)
    env.Add(body)
    return body


def shown(env):
    """Everything that shows itself."""
    robot, hostile = env.GetRobots()[0], hostile_body(env)
    eye, spec = robot.GetAttachedSensor("eye"), robot.GetConfigurationSpecification()
    named = robot.CreateRobotStateSaver(), env.plot3([0, 0, 1], 5), ravemj.CollisionReport()
    trajectory = RaveCreateTrajectory(env, "")
    trajectory.Init(spec)
    trajectory.Insert(0, np.arange(2.0 * spec.GetDOF()))
    values = [
        *(env, robot, *robot.GetLinks(), *robot.GetJoints(), *robot.GetManipulators(), eye, eye.GetSensor()),
        *(hostile, *hostile.GetLinks(), *hostile.GetJoints(), *hostile.GetLinks()[0].GetGeometries()),
        *(robot.GetLinks()[0].GetGeometries()[0], robot.GetController(), env.GetPhysicsEngine()),
        *(env.GetCollisionChecker(), spec, *spec.GetGroups()),
        *(thing.GetInfo() for thing in [*robot.GetLinks(), *robot.GetJoints(), *robot.GetManipulators()]),
        *(hostile.GetLinks()[0].GetInfo(), hostile.GetJoints()[0].GetInfo()),
        *(KinBody.LinkInfo(), KinBody.GeometryInfo(), KinBody.JointInfo(), hostile.ExtractInfo()),
    ]
    return values, [
        *named,
        trajectory,
        RaveCreateController(env, "IdealController"),
        eye.GetInfo(),
        robot.ExtractInfo(),
    ]


def evaluated(text):
    """What an expression is in a script that imports all of ravemj."""
    return eval(text, {name: getattr(ravemj, name) for name in ravemj.__all__})


def test_repr_leads_back(env):
    for thing in shown(env)[0]:
        assert evaluated(repr(thing)) == thing, repr(thing)


def test_no_address_is_shown(env):
    values, others = shown(env)
    env.CheckCollision(env.GetRobots()[0], others[2])
    for thing in [*values, *others]:
        assert "0x" not in repr(thing) + str(thing)
        assert " at " not in repr(thing) + str(thing)


def test_repr_of_a_trajectory_makes_one_with_the_same_waypoints(env):
    trajectory = shown(env)[1][3]
    again = evaluated(repr(trajectory))
    assert again.serialize(0x8000) == trajectory.serialize(0x8000)
    assert again.GetNumWaypoints() == 2


def test_infos_compare_by_content(env):
    robot = env.GetRobots()[0]
    first, second = robot.ExtractInfo(), robot.ExtractInfo()
    assert first == second
    second._vLinkInfos[1]._vgeometryinfos[0]._vGeomData[0] += 1e-9
    assert first != second
    assert KinBody.LinkInfo() != KinBody.JointInfo()
    meshes = [KinBody.GeometryInfo(_meshcollision=TriMesh(np.eye(3) * size, [[0, 1, 2]])) for size in (1, 1, 2)]
    assert meshes[0] == meshes[1] != meshes[2]


# Names that are not OpenRAVE's, and that users call all the same
OURS = """
    goal_index start_index certificate certify write_mjcf servo_gains
    animation save_html null_space null_space_path set_noise segmentation_image depth_image
    background batch_collides serve_viewer batch_inverse_dynamics batch_jacobians batch_link_transforms camera close
    com_jacobian data default_camera diagnostics drawaabb drawarrow drawboxarray drawlabel drawobb drawbox drawlinelist
    drawlinestrip drawplane drawtrimesh jacobians
    files link_transforms mjcf model plot3 qpos_indices render spec collisionInfos contacts minDistance
    nKeepPrevious numCols numWithinTol options pgeom1 pgeom2 plink1 plink2 vLinkColliding deserialize serialize
    extents pos dir main quitmainloop interaction body columns dof interpolation kind name names offset toDict
    play playback ik ik_solver is_open wait batch_distances batch_self_collides batch_solutions
     to_joint_trajectory from_joint_trajectory
"""


def test_dir_lists_what_users_call(env):
    env.SetViewer("offscreen")
    values, others = shown(env)
    for thing in [*values, *others, env.GetViewer(), env.GetRobots()[0].ComputeAABB(), ravemj.Ray()]:
        names = {name for name in dir(thing) if not name.startswith("__")}
        assert names, thing
        assert all(hasattr(thing, name) for name in names)
        if not type(thing).__name__.endswith("Info"):
            assert {name for name in names if not name[0].isupper()} <= set(OURS.split()), thing
    assert "_vGeomData" in dir(KinBody.GeometryInfo())
    assert "_drawn" not in dir(KinBody.GeometryInfo())


def test_dir_compiles_nothing(env, monkeypatch):
    monkeypatch.setattr(type(env.simulation), "compiled", lambda *_: pytest.fail("the world was compiled"))
    dir(env), dir(env.GetRobots()[0]), repr(env.GetRobots()[0].GetLinks()), str(env)


class Page(HTMLParser):
    """The texts and tags of a page."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.texts, self.open = [], [], []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attrs):
        assert not attrs, "themes choose how it looks"
        self.tags.append(tag)
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)

    def row(self, *cells):
        """Whether these cells stand one after the other."""
        return any(tuple(self.texts[start:][: len(cells)]) == cells for start in range(len(self.texts)))


def test_table_of_a_robot(env):
    robot = env.GetRobots()[0]
    robot.SetDOFValues([0.5, 0.125])
    page = Page(robot._repr_html_())
    assert page.row("DOF", "joint", "value", "limits", "unit")
    assert page.row("0", "turn", "0.5", "-1 … 2", "rad")
    assert page.row("1", "slide", "0.125", "0 … 0.25", "m")
    assert page.row("index", "link", "mass", "0", "a", f"{robot.GetLink('a').GetMass():.4g} kg")
    assert page.texts[0] == "arm"
    assert len(robot._repr_html_()) < 1500
    joint = Page(robot.GetJoint("slide")._repr_html_())
    assert joint.row("1", "slide", "0.125", "0 … 0.25", "m")


def test_tables_escape_names(env):
    body = hostile_body(env)
    for text in (body._repr_html_(), body.GetJoints()[0]._repr_html_()):
        page = Page(text)
        assert set(page.tags) <= {"b", "table", "thead", "tbody", "tr", "th", "td", "details", "summary"}
        assert HOSTILE in page.texts


def test_table_of_a_body_that_is_not_added(env):
    robot = env.GetRobots()[0]
    env.Remove(robot)
    page = Page(robot._repr_html_())
    assert page.row("0", "turn", "?", "-1 … 2", "rad")
    body = RaveCreateKinBody(env, "")
    body.InitFromBoxes(np.array([[0, 0, 0, 1, 1, 1]]))
    assert re.search("<b></b> \\(body, 0 DOF\\)<details>", body._repr_html_())


def in_ipython(thing) -> str:
    return PlainTextFormatter()(thing)


def test_ipython_prints_tables_without_a_notebook(env):
    robot = env.GetRobots()[0]
    robot.SetDOFValues([0.5, 0.125])
    title, *rows = in_ipython(robot).splitlines()
    assert re.fullmatch(r"arm \(robot, 2 DOF, 3 links, [\d.]+ kg\)", title)
    assert rows == [
        "DOF  joint  value  limits    unit",
        "0    turn   0.5    -1 … 2    rad",
        "1    slide  0.125  0 … 0.25  m",
    ]
    assert in_ipython(robot.GetJoint("slide")).splitlines() == [
        "slide (Slider, joint of arm)",
        "DOF  joint  value  limits    unit",
        "1    slide  0.125  0 … 0.25  m",
    ]
    title, heading, row, *_ = in_ipython(env).splitlines()
    assert title.startswith(f"environment {env!r}: ")
    assert heading.split() == ["name", "kind", "DOF", "links"]
    assert row.startswith("arm   robot  2    3 links, ")
    assert in_ipython(ravemj.Environment()).endswith(": no bodies")


def test_lists_in_ipython_and_repr_elsewhere_name_things(env):
    robot = env.GetRobots()[0]
    assert in_ipython([robot]) == f"[{robot!r}]" == str([robot])
    assert in_ipython({"a": robot.GetJoints()[0]}) == f"{{'a': {robot.GetJoints()[0]!r}}}"
    assert repr(robot).endswith(".GetRobot('arm')")
    body = hostile_body(env)
    assert HOSTILE in in_ipython(body)
    env.Remove(robot)
    assert "0    turn   ?" in in_ipython(robot)
    env.Destroy()
    in_ipython(env)


def test_contexts_show_only_the_arm_or_what_it_carries():
    from ravemj.databases.grasping import GraspingModel
    from ravemj.databases.inversekinematics import InverseKinematicsModel

    def visible(robot):
        return {link.GetName() for link in robot.GetLinks() if all(one.IsVisible() for one in link.GetGeometries())}

    robot = ravemj.load(MODELS / "puma560.xml").GetRobots()[0]
    before, arm = visible(robot), robot.GetActiveManipulator()
    with GraspingModel.GripperVisibility(arm):
        hidden = before - visible(robot)
    assert hidden == {link.GetName() for link in robot.GetLinks() if link not in arm.GetChildLinks()} & before
    assert visible(robot) == before
    info = arm.GetInfo()
    info._name, info._sBaseLinkName, info._sEffectorLinkName = "upper", "link1", "link3"
    upper = robot.AddManipulator(info)
    shape = robot.GetLink("base").GetGeometries()[0]
    with InverseKinematicsModel.ArmVisibility(upper, 0.5):
        assert shape.GetTransparency() == 0.5
        assert robot.GetLink("link2").GetGeometries()[0].GetTransparency() == 0
    assert shape.GetTransparency() == 0
    with InverseKinematicsModel.ArmVisibility(manip=upper):
        assert not shape.IsVisible()
        assert robot.GetLink("link2").GetGeometries()[0].IsVisible()
    assert visible(robot) == before

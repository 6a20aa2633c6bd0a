"""Solvers of inverse kinematics that files and old scripts name, and bodies that URIs name."""

import pytest

import ravemj
from ravemj.compat.openravepy_configurationcache import ConfigurationCache
from ravemj.errors import Diagnostics
from ravemj.formats.readers import read_file
from ravemj.formats.writers import save

_LINK = (
    '<Body name="{name}"><Translation>{at}</Translation><Geom type="box"><extents>.03 .03 .1</extents></Geom></Body>'
)
_JOINT = (
    '<Joint name="j{n}" type="hinge"><Body>l{n}</Body><Body>l{m}</Body><axis>{axis}</axis><anchor>{at}</anchor></Joint>'
)


@pytest.fixture
def env() -> ravemj.Environment:
    return ravemj.Environment()


def robot_text(count: int, solver: str, name: str = "arm") -> str:
    """Return a robot with an arm of some joints, about z, y, y, x, y, x, and a solver."""
    axes = ["0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"][:count]
    heights = [0, 0.1, 0.4, 0.7, 0.8, 0.8, 0.9][: count + 1]
    links = "".join(_LINK.format(name=f"l{n}", at=f"0 0 {z}") for n, z in enumerate(heights))
    joints = "".join(_JOINT.format(n=n, m=n + 1, axis=axis, at=f"0 0 {heights[n + 1]}") for n, axis in enumerate(axes))
    manipulator = (
        f'<Manipulator name="m"><base>l0</base><effector>l{count}</effector><iksolver>{solver}</iksolver></Manipulator>'
    )
    return f'<Robot name="{name}"><KinBody>{links}{joints}</KinBody>{manipulator}</Robot>'


@pytest.mark.parametrize(
    ("count", "kind"), [(6, "Transform6D"), (5, "TranslationDirection5D"), (3, "Translation3D"), (4, None), (2, None)]
)
@pytest.mark.parametrize("solver", ["WAM7ikfast 0.05", "PUMAikfast", "ikfast_katana5d"])
def test_a_solver_of_a_file_answers_at_once(env, count, kind, solver):
    assert env.LoadData(robot_text(count, solver))
    (robot,) = env.GetRobots()
    manipulator = robot.GetManipulators()[0]
    assert manipulator.GetInfo()._sIkSolverXMLId == solver  # noqa: SLF001 - OpenRAVE's name
    if kind is None:
        assert manipulator.GetIkSolver() is None
        return
    robot.SetDOFValues([0.1, 0.5, 0.4, -0.2, 0.3, 0.2][:count])
    kind = ravemj.IkParameterizationType[kind]
    assert manipulator.GetIkSolver().Supports(kind)
    goal = manipulator.GetIkParameterization(kind)
    robot.SetDOFValues(manipulator.FindIKSolution(goal, 0))
    assert goal.ComputeDistanceSqr(manipulator.GetIkParameterization(kind)) < 1e-12
    manipulator.SetIkSolver(None)
    assert manipulator.GetIkSolver() is None


def test_a_solver_of_no_plugin_is_named_where_it_is_missed(env):
    env.LoadData(robot_text(6, "MySolver"))
    manipulator = env.GetRobots()[0].GetManipulators()[0]
    assert manipulator.GetIkSolver() is None
    with pytest.raises(ravemj.openrave_exception, match="there is none of the name 'MySolver'"):
        manipulator.FindIKSolution(manipulator.GetTransform(), 0)


def test_the_name_of_a_solver_is_saved(env, tmp_path):
    first, second, third = (str(tmp_path / name) for name in ("first.robot.xml", "second.robot.xml", "third.json"))
    (tmp_path / "first.robot.xml").write_text(robot_text(6, "WAM7ikfast 0.05"))
    save(tmp_path / "second.robot.xml", read_file(first).scene, Diagnostics(), "openrave")
    env.Load(second)
    env.Save(third)
    for file in (second, third):
        other = ravemj.Environment()
        assert other.Load(file)
        assert other.GetRobots()[0].GetManipulators()[0].GetInfo()._sIkSolverXMLId == "WAM7ikfast 0.05"  # noqa: SLF001 - OpenRAVE's name


def test_the_module_ikfast_gives_active_arms_solvers(env):
    env.LoadData(robot_text(6, ""))
    (robot,) = env.GetRobots()
    robot.SetActiveManipulator("m")
    module = ravemj.RaveCreateProblem(env, "ikfast")
    assert env.LoadProblem(module, "") == 0
    kind = ravemj.IkParameterizationType.Transform6D
    for word in (str(int(kind)), kind.name):
        robot.GetActiveManipulator().SetIkSolver(None)
        assert module.SendCommand(f"LoadIKFastSolver arm {word}") == ""
        assert robot.GetActiveManipulator().GetIkSolver().Supports(kind)
    for wrong in ("", "arm", "nosuch 1", "arm 7", "arm Transform7D"):
        with pytest.raises(ravemj.openrave_exception, match="LoadIKFastSolver"):
            module.SendCommand(f"LoadIKFastSolver {wrong}")
    for command, instead in (("AddIkLibrary a b", "InverseKinematicsModel"), ("PerfTiming 10 a", "FindIKSolutions")):
        with pytest.raises(NotImplementedError, match=instead):
            module.SendCommand(command)


def test_commands_of_solvers(env):
    env.LoadData(robot_text(6, "ikfast"))
    solver = env.GetRobots()[0].GetManipulators()[0].GetIkSolver()
    assert solver.SendCommand("SetJacobianRefineBit 1") == ""
    with pytest.raises(NotImplementedError, match="FindIKSolutions returns them all"):
        solver.SendCommand("GetSolutionIndices")


def test_the_cache_of_configurations_says_what_to_ask_instead(env):
    with pytest.raises(NotImplementedError, match="batch_collides"):
        ConfigurationCache(None)


@pytest.mark.parametrize("suffix", [".dae", ".zae"])
def test_the_uri_of_a_body_of_a_collada_scene_reads_it_alone(env, tmp_path, suffix):
    env.LoadData(f"<Environment>{robot_text(3, '', 'one')}{robot_text(2, '', 'two')}</Environment>")
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes([[0, 0, 3, 0.1, 0.1, 0.1]])
    box.SetName("box")
    env.Add(box)
    path = str(tmp_path / f"scene{suffix}")
    env.Save(path)
    other = ravemj.Environment()
    assert other.Load(path)
    assert [body.GetName() for body in other.GetBodies()] == ["one", "two", "box"]
    for body in other.GetBodies():
        uri = body.GetURI()
        assert uri.startswith(f"file:{path}#")
        alone = ravemj.Environment()
        read = alone.ReadRobotURI(uri) if body.IsRobot() else alone.ReadKinBodyURI(uri)
        assert (read.GetName(), read.GetURI(), len(read.GetLinks())) == (body.GetName(), uri, len(body.GetLinks()))
        assert alone.Load(uri)
        assert [loaded.GetName() for loaded in alone.GetBodies()] == [body.GetName()]


def test_the_uri_of_the_only_body_of_a_file_is_the_file(env, tmp_path):
    env.LoadData(robot_text(3, ""))
    path = str(tmp_path / "one.dae")
    env.Save(path)
    assert ravemj.Environment().ReadRobotURI(path).GetURI() == f"file:{path}"


@pytest.mark.filterwarnings("ignore:.*missing-file")
def test_a_file_that_is_missing_is_named_and_not_the_name_alone(env):
    with pytest.raises(ravemj.openrave_exception, match=r"its file 'nosuch\.robot\.xml' gives none; check the path"):
        env.LoadData('<Environment><Robot file="nosuch.robot.xml"/></Environment>')


def test_planners_without_a_name_say_so(env, caplog):
    assert ravemj.RaveCreatePlanner(env, "") is None
    assert "the name of the planner is empty; RaveGetLoadedInterfaces" in caplog.text

"""Calls of OpenRAVE's own tests, of its examples and of users' scripts, each with what OpenRAVE answers."""

import importlib

import numpy as np
import pytest

import ravemj
from ravemj import KinBody, Planner, RaveCreateTrajectory, databases, interfaces, planningutils
from ravemj.compat import alias
from ravemj.compat.databases.inversekinematics import InverseKinematicsModel

FOOT = """<Robot name="r"><KinBody>
<Body name="foot"><Geom type="box"><extents>.1 .1 .1</extents></Geom></Body>
<Body name="hip"><offsetfrom>foot</offsetfrom><Translation>0 0 1</Translation></Body>
<Joint name="j"><Body>foot</Body><Body>hip</Body><axis>0 1 0</axis></Joint></KinBody>
<Manipulator name="leg"><base>{}</base><effector>{}</effector></Manipulator></Robot>"""


@pytest.fixture
def puma():
    env = ravemj.Environment()
    assert env.Load(ravemj.model_path("puma560"))
    return env.GetRobots()[0]


class TestReading:
    @pytest.mark.parametrize("call", ["ReadRobotData", "ReadKinBodyData", "ReadRobotURI", "ReadInterfaceURI"])
    def test_an_effector_that_nothing_moves_is_a_warning(self, call, tmp_path):
        """``Load`` is False and keeps the robot (gap-10, gap-39); ``Read…`` returns it."""
        text = FOOT.format("hip", "foot")
        (tmp_path / "leg.xml").write_text(text)
        env = ravemj.Environment()
        with pytest.warns(ravemj.RavemjWarning, match="does not move its effector 'foot'"):
            robot = getattr(env, call)(text if call.endswith("Data") else str(tmp_path / "leg.xml"))
        env.Add(robot)
        assert [arm.GetName() for arm in robot.GetManipulators()] == ["leg"]
        assert not ravemj.Environment().Load(str(tmp_path / "leg.xml"))

    @pytest.mark.parametrize(
        ("text", "cause"),
        [
            ("<Robot", "unclosed"),
            ('<KinBody name="a b"/>', "spaces"),
            ("<KinBody/>", "no name"),
            ("<Environment/>", "no body"),
        ],
    )
    def test_add_of_none_tells_why_nothing_was_read(self, text, cause):
        env = ravemj.Environment()
        body = env.ReadKinBodyData(text)
        assert body is None
        with pytest.raises(ravemj.openrave_exception, match=cause):
            env.Add(body)

    def test_add_of_none_after_a_missing_file(self):
        env = ravemj.Environment()
        with pytest.raises(ravemj.openrave_exception, match=r"nowhere\.robot\.xml"):
            env.Add(env.ReadRobotURI("nowhere.robot.xml"))

    @pytest.mark.parametrize("form", ["Robot", "KinBody"])
    @pytest.mark.parametrize("how", ["Load", "LoadData"])
    def test_uri_of_an_included_body(self, form, how, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        inner = '<KinBody name="k"><Body name="a"/></KinBody>'
        (tmp_path / "part.xml").write_text(inner if form == "KinBody" else f'<Robot name="k">{inner}</Robot>')
        text = f'<Environment><{form} file="part.xml"/><KinBody name="own"><Body/></KinBody></Environment>'
        (tmp_path / "world.env.xml").write_text(text)
        env = ravemj.Environment()
        assert env.LoadData(text) if how == "LoadData" else env.Load("world.env.xml")
        assert env.GetKinBody("k").GetURI() == f"file:{tmp_path / 'part.xml'}"
        own = "" if how == "LoadData" else f"file:{tmp_path / 'world.env.xml'}"
        assert env.GetKinBody("own").GetXMLFilename() == own


class TestSavers:
    @pytest.mark.parametrize("with_poses", [False, True])
    @pytest.mark.parametrize("released", [False, True])
    def test_what_was_held_is_back_in_the_hand(self, with_poses, released, puma):
        env = puma.GetEnv()
        box = ravemj.RaveCreateKinBody(env, "")
        box.InitFromBoxes([[0, 0, 0, 0.1, 0.1, 0.1]])
        box.SetName("box")
        env.Add(box)
        link = puma.GetActiveManipulator().GetEndEffector()
        box.SetTransform(link.GetTransform())
        puma.Grab(box, link)
        options = KinBody.SaveParameters.GrabbedBodies
        options |= KinBody.SaveParameters.LinkTransformation if with_poses else 0
        with puma.CreateRobotStateSaver(options):
            if released:
                puma.ReleaseAllGrabbed()
            puma.SetDOFValues([-0.5], [1])
        assert puma.IsGrabbing(box)
        np.testing.assert_allclose(box.GetTransform(), link.GetTransform(), atol=1e-12)
        assert (puma.GetDOFValues()[1] == 0) == with_poses


class TestInverseKinematicsModel:
    def test_without_a_type(self, puma):
        model = InverseKinematicsModel(puma)
        assert (model.load(), model.has(), model.iktype) == (False, False, None)
        model.autogenerate()
        assert model.iktype == ravemj.IkParameterizationType.Transform6D
        assert model.manip.FindIKSolution(model.manip.GetTransform(), 0) is not None

    @pytest.mark.parametrize("name", ["Transform6D", "Translation3D", "Rotation3D"])
    def test_without_a_type_it_takes_that_of_the_solver(self, name, puma):
        kind = getattr(ravemj.IkParameterizationType, name)
        assert InverseKinematicsModel(puma, kind).load()
        model = databases.inversekinematics.InverseKinematicsModel(puma)
        assert model.load()
        assert model.iktype == kind

    def test_commands_of_solvers(self, puma):
        model = InverseKinematicsModel(puma, ravemj.IkParameterizationType.Translation3D)
        assert model.load()
        solver = puma.GetActiveManipulator().GetIkSolver()
        free = [int(word) for word in solver.SendCommand("GetFreeIndices").split()]
        assert free == sorted(model.freeindices)
        assert solver.SendCommand("SetFreeIncrements " + " ".join(["0.25"] * len(free))) == ""
        assert [float(word) for word in solver.SendCommand("GetFreeIncrements").split()] == [0.25] * len(free)
        assert solver.SendCommand("GetRobotLinkStateRepeatCount") == "0"
        for wrong in ("", "0.1", "0 0 0", "a b c", "nan nan nan"):
            with pytest.raises(ravemj.openrave_exception, match="3 numbers above 0"):
                solver.SendCommand(f"SetFreeIncrements {wrong}")

    @pytest.mark.parametrize(("joints", "range_"), [(range(6), 3), ([5], 6), ([3], 8), ([3, 5], 6), ([0, 3, 5], 9)])
    def test_filters_learn_whether_they_saw_the_link_poses_before(self, joints, range_, puma):
        """The solver's command counts turns of joints whose range is more than one turn, as its help promises."""
        manip = puma.GetActiveManipulator()
        assert InverseKinematicsModel(puma, ravemj.IkParameterizationType.Transform6D).load()
        lower, upper = puma.GetDOFLimits()
        lower[[*joints]], upper[[*joints]] = -range_, range_
        puma.SetDOFLimits(lower, upper)
        puma.SetDOFValues([0.3, -0.7, 0.5, 0.4, 0.8, -0.6])
        solver, told = manip.GetIkSolver(), []

        def count(values, arm, goal):
            told.append((values, solver.SendCommand("GetRobotLinkStateRepeatCount")))
            return ravemj.IkReturnAction.Success

        handle = solver.RegisterCustomFilter(0, count)
        rows = manip.FindIKSolutions(manip.GetTransform(), 0)
        postures = {tuple(np.round(np.exp(1j * row), 6)) for row in rows}
        assert len(told) == len(rows) == len(postures) + sum(answer == "1" for _, answer in told)
        assert (len(rows) > len(postures)) == (range_ > np.pi)
        for index, (values, answer) in enumerate(told):
            seen = any(np.allclose(np.exp(1j * values), np.exp(1j * earlier)) for earlier, _ in told[:index])
            assert answer == str(int(seen))
        assert solver.SendCommand("GetRobotLinkStateRepeatCount") == "0"
        handle.Close()


class TestPlanning:
    @pytest.mark.parametrize("static", [1, 3, 6])
    @pytest.mark.parametrize("active", [[0], [2, 3], [0, 1, 2, 3, 4, 5]])
    def test_static_links_do_not_move(self, static, active, puma):
        """OpenRAVE raises ``InvalidState`` if an active joint moves a static link."""
        puma.SetActiveDOFs(active)
        puma.GetLinks()[static].SetStatic(True)
        moves = any(puma.DoesAffect(joint, static) for joint in active)
        values = puma.GetActiveDOFValues()
        calls = (
            lambda: Planner.PlannerParameters().SetRobotActiveJoints(puma),
            lambda: interfaces.BaseManipulation(puma).MoveActiveJoints(goal=values, execute=False),
        )
        for call in calls:
            if moves:
                with pytest.raises(ravemj.openrave_exception, match="is static") as caught:
                    call()
                assert caught.value.GetCode() == "InvalidState"
            else:
                call()

    def test_an_empty_planner_name(self, puma):
        """The smoother has a default; the retimer raises when it plans (retime-02)."""
        puma.SetActiveDOFs([0, 1])
        traj = RaveCreateTrajectory(puma.GetEnv(), "")
        traj.Init(puma.GetActiveConfigurationSpecification())
        traj.Insert(0, [0, 0, 0.2, 0.1])
        with pytest.raises(ravemj.openrave_exception, match="plannername is empty") as caught:
            planningutils.ActiveDOFTrajectoryRetimer(puma, "", "").PlanPath(traj)
        assert caught.value.GetCode() == "Assert"
        assert planningutils.ActiveDOFTrajectorySmoother(puma, "", "").PlanPath(traj)
        assert traj.GetDuration() > 0

    def test_minimum_goal_paths(self, puma):
        module = interfaces.BaseManipulation(puma).prob
        assert module.SendCommand("SetMinimumGoalPaths 6") == ""
        for wrong in ("", "-1", "1.5", "many"):
            with pytest.raises(ravemj.openrave_exception):
                module.SendCommand(f"SetMinimumGoalPaths {wrong}")


class TestOlderNames:
    def test_joint_values(self, puma):
        puma.SetJointValues([0.1, 0.2], [1, 2])
        np.testing.assert_array_equal(puma.GetJointValues(), puma.GetDOFValues())
        np.testing.assert_array_equal(puma.GetJointValues([1, 2]), [0.1, 0.2])

    @pytest.mark.parametrize("name", ["collisionmaprobot", "CollisionMapRobot", "GenericRobot", ""])
    def test_kinds_of_robots(self, name, puma, caplog):
        robot = ravemj.RaveCreateRobot(puma.GetEnv(), name)
        assert robot.IsRobot()
        assert bool(caplog.text) == ("map" in name.lower())

    def test_a_filter_that_stays(self, puma):
        model = InverseKinematicsModel(puma, ravemj.IkParameterizationType.Transform6D)
        assert model.load()
        solver, goal = model.manip.GetIkSolver(), model.manip.GetTransform()
        assert solver.SetCustomFilter(lambda values, manip, goal: ravemj.IkReturnAction.Reject)
        assert model.manip.FindIKSolution(goal, 0) is None
        assert solver.SetCustomFilter(lambda values, manip, goal: ravemj.IkReturnAction.Success)
        assert model.manip.FindIKSolution(goal, 0) is not None
        with pytest.raises(ravemj.openrave_exception, match="a function"):
            solver.SetCustomFilter(3)

    @pytest.mark.parametrize("name", ["pr2turnlever", "tutorial_iksolutions", "hanoi"])
    def test_examples_say_where_they_are(self, name):
        alias.install_finder()
        modules = [importlib.import_module(f"openravepy.examples.{name}")]
        modules.append(getattr(importlib.import_module("openravepy.examples"), name))
        for module in modules:
            with pytest.raises(ravemj.UnsupportedError, match=rf"{name}\.py of https://github\.com/rdiankov"):
                module.main  # noqa: B018 - the look-up raises
            assert not hasattr(module, "__all__")


class TestTimesOfGoals:
    @pytest.mark.parametrize("way", [0.01, 0.1, 0.5])
    @pytest.mark.parametrize("axis", [0, 1, 2])
    def test_poses_of_the_tool_are_retimed_like_joints(self, way, axis):
        """OpenRAVE's numbers for the Parabolic retimer: d/v + v/a, or 2 sqrt(d/a) for short ways."""
        speed, acceleration = 0.3259, 2.2036
        env = ravemj.Environment()
        T = np.eye(4)
        T[axis, 3] = way
        kind = ravemj.IkParameterizationType.Transform6D
        start, goal = ravemj.IkParameterization(np.eye(4), kind), ravemj.IkParameterization(T, kind)
        traj = RaveCreateTrajectory(env, "")
        traj.Init(start.GetConfigurationSpecification())
        traj.Insert(0, start.GetValues())
        traj.Insert(1, goal.GetValues())
        limits = [np.full(7, speed), np.full(7, acceleration)]
        assert planningutils.RetimeAffineTrajectory(traj, *limits, False, "ParabolicTrajectoryRetimer")
        cruises = way > speed**2 / acceleration
        expected = way / speed + speed / acceleration if cruises else 2 * np.sqrt(way / acceleration)
        assert traj.GetDuration() == pytest.approx(expected, rel=1e-12)

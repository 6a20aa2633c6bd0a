"""The OpenRAVE API on the pendulum: values, errors, identities."""

import gc
import logging
import math
import warnings

import numpy as np
import pytest

import ravemj

LIMITED = """<Robot name="r"><KinBody>
  <Body name="A"/><Body name="B"/><Body name="C"/><Body name="D"/>
  <Joint name="hinge"><Body>A</Body><Body>B</Body><axis>0 0 1</axis><limits>-1 2</limits></Joint>
  <Joint name="slide" type="slider"><Body>B</Body><Body>C</Body><axis>1 0 0</axis><limits>-.1 .4</limits></Joint>
  <Joint name="spin" circular="true"><Body>C</Body><Body>D</Body><axis>0 0 1</axis></Joint>
</KinBody></Robot>"""


@pytest.fixture
def limited(tmp_path) -> ravemj.Robot:
    path = tmp_path / "limited.xml"
    path.write_text(LIMITED)
    return ravemj.load(path).GetRobot("r")


class TestEnvironment:
    def test_load(self, models):
        env = ravemj.Environment()
        assert env.Load(models / "env.xml") is True
        assert env.diagnostics == ()

    def test_load_twice_is_a_clash(self, env, models, caplog):
        """OpenRAVE's answers in the case ``name-15-load-twice``."""
        assert env.Load(models / "env.xml") is False
        assert str(models / "env.xml") in caplog.text
        assert "already is a body 'Pendulum'" in caplog.text
        with pytest.raises(ravemj.openrave_exception, match="already is a body 'Pendulum'") as caught:
            env.LoadData((models / "double-pendulum.xml").read_text())
        assert caught.value.GetCode() == "BodyNameConflict"
        assert len(env.GetBodies()) == 1

    @pytest.mark.parametrize("copies", [1, 2])
    def test_spec_compiles_with_its_meshes(self, copies, tmp_path):
        (tmp_path / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
        env = ravemj.Environment()
        for index in range(copies):
            geom = f'<Geom type="trimesh"><data>part.obj {1 + index}</data></Geom>'
            (tmp_path / "body.xml").write_text(f'<KinBody name="b{index}"><Body name="a">{geom}</Body></KinBody>')
            assert env.Load(tmp_path / "body.xml")
            spec = env.spec
            spec.worldbody.add_camera(name="above", pos=[0, 0, 3])
            model = spec.compile()
            assert (model.nmesh, model.ncam) == (index + 1, env.model.ncam + 1)

    @pytest.mark.parametrize("content", [None, "<Robot", "<Nonsense/>"])
    def test_load_of_what_is_no_model(self, tmp_path, caplog, content):
        path = tmp_path / "broken.xml"
        if content is not None:
            path.write_text(content)
        env = ravemj.Environment()
        with caplog.at_level(logging.ERROR, "ravemj"):
            assert env.Load(path) is False
        assert str(path) in caplog.text
        assert env.GetBodies() == []
        with pytest.raises(ravemj.SourceError):
            ravemj.load(path)

    def test_load_of_a_folder_and_of_collada(self, tmp_path):
        with pytest.raises(ravemj.SourceError, match="folder"):
            ravemj.load(tmp_path)
        (tmp_path / "robot.zae").touch()
        with pytest.raises(ravemj.SourceError, match=r"zip|archive|empty"):
            ravemj.load(tmp_path / "robot.zae")

    def test_what_was_read_before_a_failure_stays(self, tmp_path):
        path = tmp_path / "half.xml"
        path.write_text('<Environment><KinBody name="a"/><KinBody name="a b"/></Environment>')
        env = ravemj.Environment()
        assert env.Load(path) is False
        assert [body.GetName() for body in env.GetBodies()] == ["a"]

    def test_recoverable_trouble(self, tmp_path):
        path = tmp_path / "offset.xml"
        path.write_text('<KinBody name="b"><Body name="a"><offsetfrom>nowhere</offsetfrom></Body></KinBody>')
        env = ravemj.Environment()
        with pytest.warns(ravemj.RavemjWarning, match="nowhere"):
            assert env.Load(path) is False
        assert len(env.GetBodies()) == 1
        with pytest.warns(ravemj.RavemjWarning):
            assert ravemj.load(path).diagnostics[0].code == "unknown-body"

    def test_warnings_of_one_load_are_gathered_and_point_at_the_user(self, tmp_path):
        path = tmp_path / "odd.xml"
        lines = ["<KinBody name='b'>", *["<Odd/>"] * 6, "<Body name='a'><Odder/></Body></KinBody>"]
        path.write_text("\n".join(lines))
        with pytest.warns(ravemj.RavemjWarning) as caught:
            env = ravemj.load(path)
        assert {warning.filename for warning in caught} == {__file__}
        (warning,) = (each.message for each in caught)
        assert warning.code == "unknown-tag"
        assert warning.diagnostics == env.diagnostics
        assert len(env.diagnostics) == 7
        words = f"(and 6 more [unknown-tag]: line 3, line 4, line 5, …; `ravemj check {path}` lists them all)"
        assert str(warning).endswith(words)

    def test_data_folder(self, models, monkeypatch):
        monkeypatch.setenv("OPENRAVE_DATA", str(models))
        assert ravemj.Environment().Load("env.xml")

    def test_loading_more_keeps_the_configuration(self, env, robot, tmp_path):
        robot.SetDOFValues([0.3, 0.4])
        path = tmp_path / "more.xml"
        path.write_text('<KinBody name="box"><Body name="box"/></KinBody>')
        env.Load(path)
        assert robot.GetDOFValues().tolist() == [0.3, 0.4]
        assert [body.GetName() for body in env.GetBodies()] == ["Pendulum", "box"]
        assert len(env.GetRobots()) == 1

    def test_look_up(self, env, robot):
        assert env.GetRobot("Pendulum") == env.GetKinBody("Pendulum") == robot
        assert env.GetRobot("nobody") is None
        assert env.GetKinBody("nobody") is None
        assert robot.GetEnv() is env

    def test_a_body_is_no_robot(self, tmp_path):
        path = tmp_path / "body.xml"
        path.write_text('<KinBody name="b"><Body name="a"/></KinBody>')
        env = ravemj.load(path)
        assert env.GetRobots() == []
        assert env.GetRobot("b") is None
        assert not isinstance(env.GetKinBody("b"), ravemj.Robot)
        assert not env.GetKinBody("b").IsRobot()

    def test_destroy(self, env):
        env.SetViewer("offscreen")
        env.Destroy()
        env.Destroy()
        assert env.GetBodies() == []
        assert env.GetViewer() is None

    def test_empty(self):
        env = ravemj.Environment()
        assert env.GetBodies() == []
        assert env.render(16, 12).shape == (12, 16, 3)

    def test_forgotten_environments_go(self):
        env = ravemj.Environment()
        number = int(repr(env).removeprefix("RaveGetEnvironment(").removesuffix(")"))
        assert ravemj.RaveGetEnvironment(number) is env
        del env
        gc.collect()
        assert ravemj.RaveGetEnvironment(number) is None


class TestText:
    def test_repr_leads_back(self, env, robot):
        for thing in (env, robot, robot.GetLink("Arm1"), robot.GetJoint("Joint1")):
            assert eval(repr(thing), {"RaveGetEnvironment": ravemj.RaveGetEnvironment}) == thing

    def test_str(self, env, robot):
        assert str(robot.GetLink("Arm1")) == "<link:Arm1 (2), parent=Pendulum>"
        assert str(robot.GetJoint("Joint1")) == "<joint:Joint1 (1), dof=1, parent=Pendulum>"
        assert str(robot) == f"<robot:GenericRobot - Pendulum ({robot.GetKinematicsGeometryHash()})>"
        assert str(env).startswith("<environment:")

    def test_objects_are_equal_across_calls(self, env, robot):
        assert robot.GetLinks()[0] == robot.GetLinks()[0]
        assert len({robot.GetLinks()[0], robot.GetLinks()[0], robot.GetJoint("Joint0"), robot.GetJoint("Joint0")}) == 2
        assert len({env.GetRobots()[0], robot}) == 1
        assert robot.GetLinks()[0] != robot.GetLinks()[1]


class TestDofValues:
    def test_copies(self, robot):
        for array in (
            robot.GetDOFValues(),
            robot.GetTransform(),
            robot.GetLinkTransformations()[1],
            *robot.GetDOFLimits(),
            robot.GetDOFVelocityLimits(),
            robot.GetActiveDOFValues(),
            robot.GetLinks()[1].GetTransform(),
            robot.ComputeJacobianTranslation(2, [0, 0, 0]),
            robot.CalculateActiveJacobian(2, [0, 0, 0]),
            robot.ComputeInverseDynamics([1, 0]),
            *robot.ComputeInverseDynamics([1, 0], None, True),
        ):
            assert array.dtype == np.float64
            array[...] = 7
        assert robot.GetDOFValues().tolist() == robot.GetActiveDOFValues().tolist() == [0, 0]
        assert robot.GetTransform()[3, 3] == robot.GetLinks()[1].GetTransform()[3, 3] == 1
        assert robot.GetDOFLimits()[0].tolist() == [-10000, -10000]
        assert 7 not in robot.GetDOFVelocityLimits()
        assert 7 not in robot.ComputeJacobianTranslation(2, [0, 0, 0])
        assert 7 not in robot.ComputeInverseDynamics([1, 0])

    def test_answers_follow_new_descriptions(self, robot):
        robot.SetDOFLimits([-1, -2], [1, 2])
        assert robot.GetDOFLimits()[1].tolist() == [1, 2]
        robot.SetDOFVelocityLimits([3, 4])
        assert robot.GetDOFVelocityLimits().tolist() == [3, 4]

    def test_indices(self, robot):
        robot.SetDOFValues([0.1, 0.2])
        assert robot.GetDOFValues([1, 0]).tolist() == [0.2, 0.1]
        assert robot.GetDOFValues([]).tolist() == robot.GetDOFValues(None).tolist() == []
        robot.SetDOFValues([0.5], [1])
        assert robot.GetDOFValues().tolist() == [0.1, 0.5]
        robot.SetDOFValues([], [])
        robot.SetDOFValues([7, 8, 9], dofindices=[0])
        assert robot.GetDOFValues().tolist() == [7, 0.5]
        lower, upper = robot.GetDOFLimits([1])
        assert (lower.tolist(), upper.tolist()) == ([-10000], [10000])

    @pytest.mark.parametrize("values", [(0.1, 0.2), [1, 2], np.array([1, 2], dtype=np.int8), np.float32([0.5, 0.25])])
    def test_kinds_of_input(self, robot, values):
        robot.SetDOFValues(values)
        assert robot.GetDOFValues().tolist() == [float(value) for value in values]

    @pytest.mark.parametrize(
        ("values", "words"),
        [
            ([0.1], r"shape \(1,\), and 'Pendulum' has 2 DOFs"),
            ([0.1, 0.2, 0.3], "2 DOFs"),
            ([[0.1, 0.2]], "2 DOFs"),
            ([], "2 DOFs"),
            ([math.inf, 0], "finite"),
            ([-math.inf, 0], "finite"),
            (["a", "b"], "numbers"),
            (None, "is None, and should be numbers"),
        ],
    )
    @pytest.mark.parametrize("checklimits", [0, 1])
    def test_bad_values_change_nothing(self, robot, values, words, checklimits):
        robot.SetDOFValues([0.3, 0.4])
        with pytest.raises(ravemj.openrave_exception, match=words) as caught:
            robot.SetDOFValues(values, checklimits=checklimits)
        assert caught.value.GetCode() == "InvalidArguments"
        assert not isinstance(caught.value, ValueError)  # as in OpenRAVE
        assert robot.GetDOFValues().tolist() == [0.3, 0.4]

    @pytest.mark.parametrize("indices", [[2], [-1], [0, 5]])
    def test_bad_indices(self, robot, indices):
        with pytest.raises(IndexError, match="from 0 to 1"):
            robot.GetDOFValues(indices)
        with pytest.raises(IndexError):
            robot.SetDOFValues([0.1] * len(indices), indices)

    def test_too_few_values_for_the_indices(self, robot):
        with pytest.raises(ravemj.ArgumentError, match="2 dofindices"):
            robot.SetDOFValues([0.1], [0, 1])

    def test_nan_leaves_a_joint_as_it_is(self, robot):
        robot.SetDOFValues([0.3, 0.4])
        robot.SetDOFValues([math.nan, 0.9])
        assert robot.GetDOFValues().tolist() == [0.3, 0.9]
        robot.SetDOFValues([0.1, math.nan], None, 0)
        assert robot.GetDOFValues().tolist() == [0.1, 0.9]


class TestLimits:
    def test_clamps_with_a_warning(self, limited):
        with pytest.warns(ravemj.RavemjWarning, match=r"joint 'hinge' is set to 3, outside its limits \[-1, 2\]"):
            limited.SetDOFValues([3, 0.1, 20])
        assert limited.GetDOFValues().tolist() == [2, 0.1, 20]
        with pytest.warns(ravemj.RavemjWarning, match="joint 'slide'"):
            limited.SetDOFValues([0, -5, 0])

    def test_rounding_is_clamped_without_a_warning(self, limited):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            limited.SetDOFValues([2 + 1e-11, 0.1, 0])
        assert limited.GetDOFValues()[0] == 2

    def test_actions(self, limited):
        actions = ravemj.KinBody.CheckLimitsAction
        limited.SetDOFValues([3, 0.9, 0], None, actions.Nothing)
        assert limited.GetDOFValues().tolist() == [3, 0.9, 0]
        limited.SetDOFValues([3, 0.9, 0], checklimits=actions.CheckLimitsSilent)
        assert limited.GetDOFValues().tolist() == [2, 0.4, 0]
        with pytest.raises(ravemj.openrave_exception, match="slide"):
            limited.SetDOFValues([0, 0.9, 0], checklimits=3)
        assert limited.GetDOFValues().tolist() == [2, 0.4, 0]
        limited.SetDOFValues([0, 0.3, 100], checklimits=actions.CheckLimitsThrow)
        assert limited.GetDOFValues().tolist() == [0, 0.3, 100]
        assert [int(action) for action in actions] == [0, 1, 2, 3]

    def test_circular_joints_have_no_limits(self, limited):
        for value in (3.5, -20.0, 20000.0):
            limited.SetDOFValues([value], [2], 3)
            assert limited.GetDOFValues()[2] == value


class TestLinksAndJoints:
    def test_look_up(self, robot):
        assert robot.GetLink("nothing") is None
        assert robot.GetJoint("nothing") is None
        assert [link.GetIndex() for link in robot.GetLinks([2, 0])] == [2, 0]
        assert [joint.GetName() for joint in robot.GetJoints([1])] == ["Joint1"]
        assert robot.GetLink("Arm0").GetParent() == robot.GetJoint("Joint0").GetParent() == robot
        assert robot.GetPassiveJoints() == []

    def test_values_of_joints(self, robot):
        robot.SetDOFValues([0.1, 0.2])
        assert [joint.GetValue(0) for joint in robot.GetJoints()] == [0.1, 0.2]
        assert robot.GetJoint("Joint1").GetValues().tolist() == [0.2]
        assert [joint.GetJointIndex() for joint in robot.GetJoints()] == [0, 1]
        assert not robot.GetJoint("Joint0").IsStatic()
        assert not robot.GetLink("Base").IsStatic()

    def test_a_body_without_joints(self, tmp_path):
        path = tmp_path / "box.xml"
        path.write_text('<KinBody name="b"><Body name="a" type="static"/></KinBody>')
        body = ravemj.load(path).GetBodies()[0]
        assert body.GetDOF() == 0
        assert body.GetDOFValues().shape == (0,)
        body.SetDOFValues([])
        assert body.GetLink("a").IsStatic()


class TestViewer:
    CAMERA = np.array([[0.0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    SAVED = np.array(
        [
            [-0.67725463, 0.23636616, -0.69674759, 0.40368351],
            [0.73512462, 0.25638653, -0.62758086, 0.43931767],
            [0.03029782, -0.93722835, -0.34739755, 0.42627937],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )

    @pytest.fixture
    def viewer(self, env) -> ravemj.Viewer:
        assert env.GetViewer() is None
        assert env.SetViewer("qtcoin", False) is True
        return env.GetViewer()

    @pytest.mark.parametrize("camera", [CAMERA, SAVED, SAVED.tolist()])
    def test_camera_round_trip(self, viewer, camera):
        viewer.SetCamera(camera)
        np.testing.assert_array_equal(viewer.GetCameraTransform(), camera)
        viewer.GetCameraTransform()[:] = 0
        np.testing.assert_array_equal(viewer.GetCameraTransform(), camera)

    def test_no_negative_zeros(self, viewer):
        viewer.SetCamera(-1.0 * np.array([[0.0, 0, 1, -1], [-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, -1]]))
        assert not np.signbit(viewer.GetCameraTransform()[np.where(viewer.GetCameraTransform() == 0)]).any()

    def test_first_view_is_from_above(self, viewer):
        matrix = viewer.GetCameraTransform()
        np.testing.assert_array_equal(matrix[:3, :3], np.diag([1, -1, -1]))

    def test_bad_camera(self, viewer):
        with pytest.raises(ravemj.ArgumentError, match="rotation"):
            viewer.SetCamera(np.diag([2, 2, 2, 1]))
        with pytest.raises(ravemj.ArgumentError):
            viewer.SetCamera([1, 2, 3])

    @pytest.mark.parametrize("colour", [[2, 0, 0], [0, 0], "red", [math.nan, 0, 0], None])
    def test_bad_background(self, viewer, colour):
        with pytest.raises(ravemj.ArgumentError, match="a colour is three numbers from 0 to 1"):
            viewer.SetBkgndColor(colour)

    def test_background(self, viewer):
        viewer.SetBkgndColor([0.8, 0.85, 0.9])
        assert viewer.render(32, 24)[0, 0].tolist() == [204, 217, 230]

    def test_name(self, viewer):
        assert viewer.GetName() == "qtcoin"

    def test_removing_it(self, env, viewer):
        assert env.SetViewer("") is False
        assert env.GetViewer() is None

    def test_the_file_s_view_comes_back(self, tmp_path):
        path = tmp_path / "view.xml"
        path.write_text(
            "<Environment><bkgndcolor>1 0 0</bkgndcolor><camtrans>1 2 3</camtrans>"
            "<camrotationaxis>1 0 0 180</camrotationaxis></Environment>"
        )
        env = ravemj.load(path)
        env.SetViewer("offscreen")
        np.testing.assert_allclose(env.GetViewer().GetCameraTransform()[:3, 3], [1, 2, 3])
        np.testing.assert_allclose(env.GetViewer().GetCameraTransform()[:3, :3], np.diag([1, -1, -1]), atol=1e-15)
        assert env.GetViewer().render(8, 8)[0, 0].tolist() == [255, 0, 0]


class TestPictures:
    def test_shape(self, env):
        picture = env.render(64, 48)
        assert picture.shape == (48, 64, 3)
        assert picture.dtype == np.uint8

    def test_shows_the_pendulum_hanging_and_upright(self, env, robot):
        def heights(picture):
            rows = np.arange(len(picture))
            red = (picture[..., 0] > 120) & (picture[..., 2] < 100)
            blue = (picture[..., 2] > 120) & (picture[..., 0] < 100)
            return [np.average(rows, weights=mask.sum(axis=1)) for mask in (red, blue)]

        camera = TestViewer.CAMERA
        red, blue = heights(env.render(160, 120, camera=camera, background=[1, 1, 1]))
        assert red < blue
        robot.SetDOFValues([math.pi, 0])
        red, blue = heights(env.render(160, 120, camera=camera, background=[1, 1, 1]))
        assert blue < red < 62

    def test_moving_changes_the_next_picture(self, env, robot):
        before = env.render(64, 48)
        robot.SetDOFValues([1, 1])
        assert not np.array_equal(env.render(64, 48), before)

    def test_png_for_notebooks(self, env):
        assert env._repr_png_().startswith(b"\x89PNG")

    def test_bad_camera(self, env):
        with pytest.raises(ravemj.ArgumentError):
            env.render(camera=np.zeros((4, 4)))


class TestRecord:
    def test_moves_and_stays(self, env, robot, tmp_path):
        frames = []
        path = ravemj.record(
            env,
            tmp_path / "frames",
            ravemj.Motion.line([0, 0], [1, 0.5], 0.5),
            width=32,
            height=24,
            fps=10,
            on_frame=frames.append,
        )
        assert frames == [1, 2, 3, 4, 5, 6]
        assert len(list(path.iterdir())) == 6
        np.testing.assert_allclose(robot.GetDOFValues(), [1, 0.5])

    def test_outside_the_limits(self, limited, tmp_path):
        with pytest.warns(ravemj.RavemjWarning, match="takes joint 'hinge' outside"):
            ravemj.record(
                limited.GetEnv(),
                tmp_path / "frames",
                ravemj.Motion.line([0, 0, 0], [9, 0, 9], 0.1),
                width=16,
                height=12,
                fps=10,
            )
        assert limited.GetDOFValues().tolist() == [2, 0, 9]

    def test_without_a_robot(self, tmp_path):
        with pytest.raises(ravemj.ArgumentError, match="no robot with joints"):
            ravemj.record(ravemj.Environment(), tmp_path / "x.mp4", ravemj.Motion.line([0], [1]))

    def test_wrong_number_of_joints(self, env, tmp_path):
        with pytest.raises(ravemj.ArgumentError, match="has 1 joints, and 'Pendulum' has 2 DOFs"):
            ravemj.record(env, tmp_path / "x.mp4", ravemj.Motion.line([0], [1]))

    def test_default_view_shows_the_whole_motion(self, env, robot):
        from ravemj.rave.recording import camera_for_motion, followed_motion

        swing = followed_motion(env, ravemj.Motion.line([0, 0], [math.pi, 0]))
        camera = camera_for_motion(env, swing, 4 / 3)
        for q in ([0, 0], [math.pi / 2, 0], [math.pi, 0]):
            robot.SetDOFValues(q)
            tips = np.array([link @ [0.2, 0, 0, 1] for link in robot.GetLinkTransformations()[1:]])[:, :3]
            pixels, _ = camera.project(tips, 640, 480)
            assert (pixels > 0).all()
            assert (pixels < [640, 480]).all()

"""Links and geometries: what setters change, and when the model is compiled anew."""

import numpy as np
import pytest

import ravemj
from ravemj.geometry_functions import matrixFromAxisAngle, matrixFromPose

MESH = ravemj.TriMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


@pytest.fixture
def world():
    return ravemj.Environment()


def box(env, name="box", *rows):
    body = ravemj.RaveCreateKinBody(env, "")
    body.InitFromBoxes(rows or [[0, 0, 0, 0.5, 0.5, 0.5]])
    body.SetName(name)
    env.Add(body)
    return body


def seen_colour(env):
    """Return the colour in the middle of a picture from above."""
    camera = np.diag([1.0, -1.0, -1.0, 1.0])
    camera[2, 3] = 3
    return env.render(32, 32, camera=camera, background=[0, 0, 0])[16, 16].astype(int)


def cylinder(turn):
    """A link of one cylinder and its mass; OpenRAVE's XML lays the cylinder along y of its element."""
    rotation = f"<RotationAxis>{turn}</RotationAxis>" if turn else ""
    shape = f"<radius>0.1</radius><height>0.4</height>{rotation}<Translation>0 0 0.3</Translation>"
    body = ravemj.Environment().ReadKinBodyData(
        f"""<KinBody name="k"><Body name="b"><Mass type="mimicgeom"><density>100</density></Mass>
        <Geom type="cylinder">{shape}</Geom></Body></KinBody>"""
    )
    return body.GetLinks()[0]


class TestMass:
    def test_inverse_dynamics_uses_what_was_set(self, robot, env):
        before, model = robot.ComputeInverseDynamics(None), env.model
        for link in robot.GetLinks():
            link.SetMass(3 * link.GetMass())
            link.SetPrincipalMomentsOfInertia(3 * link.GetPrincipalMomentsOfInertia())
        np.testing.assert_allclose(robot.ComputeInverseDynamics(None), 3 * before, atol=1e-9)
        assert env.model is model

    def test_the_model_has_what_was_set(self, robot, env):
        link = robot.GetLinks()[1]
        body = env.model.body("Arm0")
        total = env.model.body_subtreemass[0]
        link.SetMass(link.GetMass() + 5)
        T = matrixFromPose([0.6, 0, 0, 0.8, 0.1, 0.2, 0.3])
        link.SetLocalMassFrame(T)
        link.SetPrincipalMomentsOfInertia([0.3, 0.2, 0.1])
        assert env.model.body_subtreemass[0] == pytest.approx(total + 5)
        np.testing.assert_allclose(env.data.xipos[body.id], link.GetGlobalCOM(), atol=1e-9)
        turned = env.data.ximat[body.id].reshape(3, 3)
        inertia = turned @ np.diag(env.model.body_inertia[body.id]) @ turned.T
        np.testing.assert_allclose(inertia, link.GetGlobalInertia(), atol=1e-9)
        compiled = env.model
        env.simulation.forget_model()
        assert env.model is not compiled
        np.testing.assert_allclose(env.model.body("Arm0").ipos, [0.1, 0.2, 0.3], atol=1e-9)

    def test_a_total_over_shapes_without_a_volume_is_nan_and_computed_with_as_0(self, world):
        """As random-xml-132: OpenRAVE divides by their mass, 0."""
        mass = '<Mass type="mimicgeom"><total>5</total></Mass><Geom type="capsule"><radius>1</radius></Geom>'
        joint = '<Joint name="j"><Body>a</Body><Body>b</Body><axis>1 0 0</axis></Joint>'
        text = f"<KinBody name='k'><Body name='a'/><Body name='b'>{mass}</Body>{joint}</KinBody>"
        with pytest.warns(ravemj.errors.RavemjWarning, match="undefined-mass"):
            body = world.ReadKinBodyData(text)
        world.Add(body)
        one, other = body.GetLinks()
        answers = [other.GetMass(), body.GetMass(), other.GetLocalCOM(), other.GetGlobalCOM(), other.GetLocalInertia()]
        assert all(np.isnan(answer).any() for answer in [*answers, other.GetGlobalInertia()])
        assert one.GetMass() == 1
        assert np.isfinite(body.ComputeInverseDynamics([1.0])).all()
        assert np.isfinite(body.GetCenterOfMass()).all()
        other.SetMass(2)
        assert (body.GetMass(), other.GetLocalCOM().tolist()) == (3, [0, 0, 0])
        for link in (one, other):
            link.SetMass(0)
        assert np.isnan(body.GetCenterOfMass()).all()  # and numpy does not warn

    def test_moments_and_frame_stay_as_they_are_set(self, robot):
        link = robot.GetLinks()[1]
        T = matrixFromAxisAngle([0.3, -0.5, 1.2])
        T[:3, 3] = [1, 2, 3]
        link.SetLocalMassFrame(T)
        link.SetPrincipalMomentsOfInertia([0.3, 0.1, 0.2])
        np.testing.assert_allclose(link.GetPrincipalMomentsOfInertia(), [0.3, 0.1, 0.2], atol=1e-12)
        np.testing.assert_allclose(link.GetLocalMassFrame(), T, atol=1e-12)
        np.testing.assert_allclose(np.linalg.eigvalsh(link.GetLocalInertia()), [0.1, 0.2, 0.3], atol=1e-12)

    @pytest.mark.parametrize("turn", ["", "1 0 0 90", "0 0 1 90", "0 1 0 -90", "1 0 0 270", "1 1 0 180"])
    def test_frame_of_a_cylinder_has_the_axes_of_its_link(self, turn):
        """Also where the quarter turns of the cylinder leave rounding in its tensor."""
        link = cylinder(turn)
        axis = np.abs(link.GetGeometries()[0].GetTransform()[:3, 2]).round()
        expected = np.where(axis == 1, 0.5 * 0.01, 0.25 * 0.01 + 0.16 / 12) * link.GetMass()
        np.testing.assert_allclose(link.GetLocalMassFrame(), matrixFromPose([1, 0, 0, 0, 0, 0, 0.3]), atol=1e-9)
        np.testing.assert_allclose(link.GetPrincipalMomentsOfInertia(), expected, rtol=1e-9)

    def test_frame_of_a_turned_cylinder_has_its_axis(self):
        link = cylinder("1 2 3 40")
        moments, T = link.GetPrincipalMomentsOfInertia(), link.GetLocalMassFrame()
        axis = T[:3, moments.argmin()]
        assert abs(axis @ link.GetGeometries()[0].GetTransform()[:3, 2]) == pytest.approx(1)
        assert np.linalg.det(T) == pytest.approx(1)
        np.testing.assert_allclose(T[:3, :3] @ np.diag(moments) @ T[:3, :3].T, link.GetLocalInertia(), atol=1e-12)

    @pytest.mark.parametrize(
        "call",
        [
            lambda link: link.SetMass(np.nan),
            lambda link: link.SetPrincipalMomentsOfInertia([1, 2]),
            lambda link: link.SetLocalMassFrame(np.ones((4, 4))),
        ],
    )
    def test_what_is_refused_changes_nothing(self, robot, call):
        link = robot.GetLinks()[1]
        before = robot.simulation_state.scene
        with pytest.raises(ravemj.ArgumentError):
            call(link)
        assert robot.simulation_state.scene is before


class TestColours:
    def test_they_show_without_compiling(self, world):
        geometry = box(world).GetLinks()[0].GetGeometries()[0]
        geometry.SetDiffuseColor([0, 1, 0])
        red, green, blue = seen_colour(world)
        model = world.model
        assert green > 4 * max(red, blue)
        geometry.SetDiffuseColor([0, 0, 1])
        red, green, blue = seen_colour(world)
        assert blue > 4 * max(red, green)
        geometry.SetTransparency(1)
        assert seen_colour(world).tolist() == [0, 0, 0]
        assert world.model is model

    def test_only_the_geoms_of_the_geometry_change(self, world):
        tray = ravemj.KinBody.GeometryInfo()
        tray._type, tray._vGeomData, tray._vGeomData2 = ravemj.GeometryType.Container, [1, 1, 1], [0.9, 0.9, 0.9]
        ball = ravemj.KinBody.GeometryInfo()
        ball._type, ball._vGeomData = ravemj.GeometryType.Sphere, [1, 0, 0, 0]
        box(world, "before")
        body = ravemj.RaveCreateKinBody(world, "")
        body.InitFromGeometries([ball, tray, ball])
        body.SetName("body")
        world.Add(body)
        before = world.model.geom_rgba.copy()
        body.GetLinks()[0].GetGeometries()[1].SetDiffuseColor([0.1, 0.2, 0.3])
        changed = np.flatnonzero((world.model.geom_rgba != before).any(axis=1))
        assert changed.tolist() == [2, 3, 4, 5, 6]

    def test_a_new_model_has_them_too(self, world):
        geometry = box(world).GetLinks()[0].GetGeometries()[0]
        geometry.SetDiffuseColor([0.1, 0.2, 0.3])
        np.testing.assert_allclose(world.model.geom_rgba[0], [0.1, 0.2, 0.3, 1], atol=1e-6)

    @pytest.mark.parametrize("colour", [[1, 0], [[1, 0, 0]], [np.nan, 0, 0], "red"])
    def test_what_is_refused_changes_nothing(self, world, colour):
        geometry = box(world).GetLinks()[0].GetGeometries()[0]
        with pytest.raises(ravemj.ArgumentError):
            geometry.SetDiffuseColor(colour)
        assert geometry.GetDiffuseColor().tolist() == [1, 0.5, 0.5]


class TestShapes:
    def test_hidden_ones_are_not_seen_and_their_body_stays(self, world):
        body = box(world)
        body.SetTransform(matrixFromPose([1, 0, 0, 0, 0, 0, -1]))
        assert seen_colour(world).any()
        assert body.SetVisible(False) is True
        assert body.SetVisible(False) is False
        assert not seen_colour(world).any()
        assert body.GetTransform()[2, 3] == -1

    def test_a_set_mesh_is_the_one_that_is_drawn(self, world):
        body = ravemj.RaveCreateKinBody(world, "")
        body.InitFromTrimesh(MESH)
        body.SetName("mesh")
        world.Add(body)
        world.model  # noqa: B018 - compiles
        geometry = body.GetLinks()[0].GetGeometries()[0]
        geometry.SetCollisionMesh(ravemj.TriMesh(MESH.vertices * 3, MESH.indices))
        assert world.Triangulate(body).vertices.max() == 3
        corners = world.model.mesh_vert
        assert np.linalg.norm(corners[:, None] - corners, axis=2).max() == pytest.approx(3 * 2**0.5)

    def test_a_mesh_set_for_another_shape_is_the_one_that_scripts_get(self, world):
        body = box(world)
        link = body.GetLinks()[0]
        geometry = link.GetGeometries()[0]
        before, bounds = geometry.GetCollisionMesh(), body.ComputeAABB().extents()
        far = ravemj.TriMesh(MESH.vertices + np.array([9, 0, 0]), MESH.indices)
        geometry.SetCollisionMesh(far)
        copy = ravemj.RaveCreateKinBody(world, "")
        copy.InitFromGeometries([geometry.GetInfo()])
        for one in (geometry, copy.GetLinks()[0].GetGeometries()[0]):
            assert one.GetType() == ravemj.GeometryType.Box
            np.testing.assert_array_equal(one.GetCollisionMesh().vertices, far.vertices)
            np.testing.assert_array_equal(one.GetCollisionMesh().indices, far.indices)
            np.testing.assert_array_equal(one.GetBoxExtents(), geometry.GetBoxExtents())
        np.testing.assert_array_equal(link.GetCollisionData().vertices[:, 0].min(), 9)
        assert world.Triangulate(body).vertices[:, 0].min() == 9
        np.testing.assert_array_equal(body.ComputeAABB().extents(), bounds)
        ray = ravemj.Ray([9.1, 0.1, 5], [0, 0, -10])
        assert not world.CheckCollision(ray)
        assert geometry.InitCollisionMesh()
        np.testing.assert_array_equal(geometry.GetCollisionMesh().vertices, before.vertices)

    @pytest.mark.parametrize("wrong", [None, 3, ravemj.TriMesh([[0, 0, 0]], [[0, 1, 2]])])
    def test_a_wrong_mesh_changes_nothing(self, world, wrong):
        geometry = box(world).GetLinks()[0].GetGeometries()[0]
        before = geometry.GetCollisionMesh()
        with pytest.raises(ravemj.openrave_exception):
            geometry.SetCollisionMesh(wrong)
        np.testing.assert_array_equal(geometry.GetCollisionMesh().vertices, before.vertices)

    def test_groups_can_be_swapped_in(self, world):
        link = box(world).GetLinks()[0]
        info = link.GetGeometries()[0].GetInfo()
        info._vGeomData, info._name = [1, 2, 3], "large"
        assert link.GetGroupNumGeometries("large") == -1
        link.SetGroupGeometries("large", [info, info])
        assert link.GetGroupNumGeometries("large") == 2
        link.GetGeometriesFromGroup("large")[1].SetName("second")
        link.SetGeometriesFromGroup("large")
        assert [geometry.GetName() for geometry in link.GetGeometries()] == ["large", "second"]
        assert link.RemoveGeometryByName("large") is True
        assert [geometry.GetName() for geometry in link.GetGeometries()] == ["second"]
        assert link.GetGroupNumGeometries("large") == 1
        link.AddGeometry(info)
        with pytest.raises(ravemj.ArgumentError, match="already"):
            link.AddGeometry(info)
        link.InitGeometries([])
        assert link.GetGeometries() == []
        with pytest.raises(ravemj.ArgumentError, match="large"):
            link.SetGeometriesFromGroup("none")

    def test_geometries_are_equal_by_their_place(self, world):
        link = box(world, "two", [0, 0, 0, 1, 1, 1], [3, 0, 0, 1, 1, 1]).GetLinks()[0]
        first, second = link.GetGeometries()
        assert first == link.GetGeometry(0)
        assert first != second
        assert len({first, second, *link.GetGeometries()}) == 2


class TestLink:
    def test_moved_alone(self, robot):
        arm, tip = robot.GetLinks()[1:]
        before = tip.GetTransform()
        arm.SetTransform([1, 0, 0, 0, 1, 2, 3])
        np.testing.assert_allclose(arm.GetTransformPose(), [1, 0, 0, 0, 1, 2, 3], atol=1e-12)
        np.testing.assert_allclose(tip.GetTransform(), before, atol=1e-12)

    def test_parameters(self, robot):
        link = robot.GetLinks()[0]
        link.SetFloatParameters("f", [1.5, 2])
        link.SetIntParameters("i", [3])
        assert link.GetFloatParameters("f", 1) == 2
        assert link.GetIntParameters()["i"].tolist() == [3]
        link.SetFloatParameters("f", [])
        assert link.GetFloatParameters("f") is None
        assert link.GetInfo()._mapIntParameters["i"].tolist() == [3]

    def test_static(self, robot):
        link = robot.GetLinks()[1]
        link.SetStatic(True)
        assert link.IsStatic()
        assert robot.GetDOF() == 2


@pytest.mark.parametrize("enabled_only", [False, True])
def test_the_box_of_a_body_holds_those_of_its_links(enabled_only):
    """Every other link of an arm is disabled; shapes are boxes, cylinders, a mesh and points."""
    robot = ravemj.load("models/panda.xml").GetRobots()[0]
    link, point = robot.GetLinks()[6], ravemj.KinBody.GeometryInfo()
    point._type, point._vGeomData = ravemj.GeometryType.Box, np.zeros(3)
    point._t = np.array([[1, 0, 0, 100], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    mesh = ravemj.KinBody.GeometryInfo()
    mesh._type, mesh._meshcollision = ravemj.GeometryType.Trimesh, MESH
    link.InitGeometries([mesh, point])
    robot.SetDOFValues(np.full(robot.GetDOF(), 0.3), ..., ravemj.KinBody.CheckLimitsAction.Nothing)
    robot.SetTransform(matrixFromAxisAngle([0.4, -0.3, 0.9]))
    robot.SetLinkEnableStates(np.arange(len(robot.GetLinks())) % 2 == 0)
    boxes = [one.ComputeAABB() for one in robot.GetLinks() if one.IsEnabled() or not enabled_only]
    boxes = [box for box in boxes if box.extents().any()]
    whole = robot.ComputeAABB(enabled_only)
    low, high = (np.array([box.pos() + sign * box.extents() for box in boxes]) for sign in (-1, 1))
    np.testing.assert_allclose(whole.pos() - whole.extents(), low.min(axis=0), atol=1e-12)
    np.testing.assert_allclose(whole.pos() + whole.extents(), high.max(axis=0), atol=1e-12)

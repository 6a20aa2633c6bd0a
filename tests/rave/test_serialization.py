"""Goals, failures and whole environments as JSON and as bytes."""

import numpy as np
import pytest
from conftest import MODELS

import ravemj
from ravemj import IkParameterization, Ray

Type = IkParameterization.Type
T = [0.5, 0.5, 0.5, 0.5, 1, 2, 3]
GOALS = {
    Type.Transform6D: (T, [0.5, 0.5, 0.5, 0.5, 1000, 2000, 3000]),
    Type.Rotation3D: (T[:4], T[:4]),
    Type.Translation3D: ([1, 2, 3], [1000, 2000, 3000]),
    Type.Direction3D: ([0, 1, 0], [0, 1, 0]),
    Type.Ray4D: (Ray([1, 2, 3], [0, 1, 0]), [0, 1, 0, 1000, 2000, 3000]),
    Type.TranslationXYOrientation3D: ([1, 2, 0.5], [1000, 2000, 0.5]),
    Type.TranslationLocalGlobal6D: ([[1, 2, 3], [4, 5, 6]], [1000, 2000, 3000, 4000, 5000, 6000]),
    Type.TranslationZAxisAngle4D: ([[1, 2, 3], 0.5], [0.5, 1000, 2000, 3000]),
}


@pytest.fixture
def env():
    env = ravemj.Environment()
    assert env.Load(MODELS / "env.xml")
    return env


@pytest.mark.parametrize("kind", GOALS, ids=lambda kind: kind.name)
def test_goals_in_other_units(kind):
    value, millimetres = GOALS[kind]
    goal = IkParameterization(primitive=value, type=kind)
    goal.SetCustomValues("shelf", [1, 2])
    written = goal.SerializeJSON(1000)
    np.testing.assert_allclose(written["values"], millimetres, atol=1e-12)
    read = IkParameterization()
    read.DeserializeJSON({"id": "g1", "name": "grasp", **written}, unitScale=0.001)
    assert (read.GetId(), read.GetName()) == ("g1", "grasp")
    assert read.GetType() == goal.GetType()
    np.testing.assert_allclose(read.GetValues(), goal.GetValues(), atol=1e-12)
    np.testing.assert_array_equal(read.GetCustomValues("shelf"), [1, 2])
    assert IkParameterization(ikparam=read).SerializeJSON() == read.SerializeJSON()
    assert read.GetDOF(type=Type.Translation3D) == 3


@pytest.mark.parametrize(
    "wrong", [{}, {"type": 5, "values": []}, {"type": int(Type.Translation3D), "values": "x"}, {"customData": 1}, [1]]
)
def test_what_is_no_goal_changes_nothing(wrong):
    goal = IkParameterization([1, 2, 3], Type.Translation3D)
    before = goal.SerializeJSON()
    with pytest.raises(ravemj.openrave_exception):
        goal.DeserializeJSON({**before, "values": [4, 5, 6], **wrong} if wrong == {"customData": 1} else wrong)
    assert goal.SerializeJSON() == before


def test_bytes_are_what_save_writes(env, tmp_path):
    for filetype, name in (("collada", "scene.dae"), ("json", "scene.json")):
        env.Save(tmp_path / name)
        written = env.WriteToMemory(filetype)
        other = ravemj.Environment()
        (tmp_path / name).write_bytes(written)
        assert other.Load(tmp_path / name)
        assert [body.GetName() for body in other.GetBodies()] == [body.GetName() for body in env.GetBodies()]
    robot = env.GetRobots()[0].GetName()
    assert b"table" not in env.WriteToMemory("json", env.SelectionOptions.Body, robot)
    with pytest.raises(ravemj.openrave_exception, match="collada, json"):
        env.WriteToMemory("xml")


def test_affine_settings_by_openraves_names(env):
    robot = env.GetRobots()[0]
    robot.SetAffineTranslationMaxVels(vels=[1, 2, 3])
    robot.SetAffineRotation3DMaxVels(velocity=[4, 5, 6])
    robot.SetAffineRotationQuatLimits(quatangle=[0.5, 0, 0, 0])
    twin = ravemj.RaveClone(robot)
    np.testing.assert_array_equal(twin.GetAffineTranslationMaxVels(), [1, 2, 3])
    np.testing.assert_array_equal(twin.GetAffineRotation3DMaxVels(), [4, 5, 6])
    np.testing.assert_array_equal(twin.GetAffineRotationQuatLimits(), [0.5, 0, 0, 0])


class TestUnits:
    """An environment in millimetres: COLLADA and JSON are converted, XML and what is there are not."""

    @pytest.fixture
    def millimetres(self):
        env = ravemj.Environment()
        env.SetUnitInfo(ravemj.UnitInfo(lengthUnit=ravemj.LengthUnit.mm))
        return env

    @pytest.mark.parametrize("name", ["scene.dae", "scene.json"])
    def test_files_with_a_unit_are_converted(self, env, millimetres, tmp_path, name):
        env.Save(tmp_path / name)
        assert millimetres.Load(tmp_path / name)
        for body in env.GetBodies():
            twin = millimetres.GetKinBody(body.GetName())
            small, large = body.ComputeAABB(), twin.ComputeAABB()
            np.testing.assert_allclose(large.pos(), 1000 * small.pos(), atol=1e-3)
            np.testing.assert_allclose(large.extents(), 1000 * small.extents(), rtol=1e-5)

    def test_xml_is_not(self, env, millimetres):
        assert millimetres.Load(MODELS / "env.xml")
        for body, twin in zip(env.GetBodies(), millimetres.GetBodies(), strict=True):
            np.testing.assert_array_equal(twin.GetTransform(), body.GetTransform())

    def test_they_come_back_in_metres(self, env, millimetres, tmp_path):
        env.Save(tmp_path / "metres.json")
        assert millimetres.Load(tmp_path / "metres.json")
        millimetres.Save(tmp_path / "millimetres.json")
        other = ravemj.Environment()
        assert other.Load(tmp_path / "millimetres.json")
        assert other.GetUnit() == ("m", 1)
        for body, twin in zip(env.GetBodies(), other.GetBodies(), strict=True):
            np.testing.assert_allclose(twin.GetTransform(), body.GetTransform(), atol=1e-9)
            np.testing.assert_allclose(twin.GetLinkTransformations(), body.GetLinkTransformations(), atol=1e-9)
        with pytest.raises(NotImplementedError, match="COLLADA"):
            millimetres.Save(tmp_path / "scene.dae")

    def test_a_whole_description_has_its_unit(self, env, millimetres):
        assert millimetres.CloneSelf().GetUnit() == ("mm", 0.001)
        millimetres.UpdateFromInfo(env.ExtractInfo())
        assert millimetres.GetUnit() == ("m", 1)


def test_the_module_logging_saves_scenes(env, tmp_path):
    module = ravemj.RaveCreateModule(env, "logging")
    env.Add(module)
    assert module.SendCommand(f"savescene filename {tmp_path / 'scene.xml'}") == ""
    other = ravemj.Environment()
    assert other.Load(tmp_path / "scene.xml")
    assert [body.GetName() for body in other.GetBodies()] == [body.GetName() for body in env.GetBodies()]
    with pytest.raises(ravemj.openrave_exception, match="filename"):
        module.SendCommand("savescene")

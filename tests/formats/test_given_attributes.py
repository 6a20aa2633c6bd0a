"""Attributes that callers of ``Load`` and ``ReadRobotURI`` and their like give, and names that are taken."""

import os
import warnings

import numpy as np
import pytest
from conftest import DATA

import ravemj

BODY = """<KinBody name="k">
  <Body name="l"><Geom type="box"><extents>1 1 1</extents></Geom></Body>
  <Body name="m"><Translation>1 1 1</Translation></Body>
  <Joint name="j" type="hinge"><Body>l</Body><Body>m</Body></Joint>
</KinBody>"""
ROBOT = """<Robot name="r" prefix="own_" scalegeometry="2">
  <KinBody>
    <Body name="l"><Geom type="box"><extents>1 1 1</extents></Geom></Body>
    <Body name="m"><Translation>1 1 1</Translation></Body>
    <Body name="n"/>
    <Joint name="j" type="hinge"><Body>l</Body><Body>m</Body></Joint>
    <Joint name="f" type="hinge" mimic_pos="2*j"><Body>m</Body><Body>n</Body></Joint>
  </KinBody>
  <Manipulator name="hand"><base>l</base><effector>m</effector></Manipulator>
  <AttachedSensor name="eye"><link>m</link></AttachedSensor>
</Robot>"""
PAIR = DATA / "collada" / "pair.dae"
WEDGE = DATA / "meshes" / "wedge.stl"


@pytest.fixture(autouse=True)
def _quiet():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        yield


@pytest.fixture
def env():
    return ravemj.Environment()


@pytest.fixture(params=["Load", "LoadData", "ReadURI", "ReadData", "ReadBytes", "into"])
def read(request, env, tmp_path):
    """A function that gets the first body of a text, with attributes, in one of all ways."""

    def read(text, atts=None):
        kind = "Robot" if "<Robot" in text else "KinBody"
        path = tmp_path / f"model.{kind.lower()}.xml"
        path.write_text(text)
        if request.param.startswith("Load"):
            content = path if request.param == "Load" else text
            assert getattr(env, request.param)(content, *([] if atts is None else [atts]))
            return env.GetBodies()[0]
        arguments = {
            "ReadURI": ("URI", path),
            "ReadData": ("Data", text),
            "ReadBytes": ("Data", text.encode()),
            "into": ("Data", getattr(ravemj, f"RaveCreate{kind}")(env, ""), text),
        }
        name, *given = arguments[request.param]
        return getattr(env, f"Read{kind}{name}")(*given, *([] if atts is None else [atts]))

    return read


def names(parts):
    return [part.GetName() for part in parts]


def positions(body):
    return np.array([link.GetTransform()[:3, 3] for link in body.GetLinks()])


def codes(env):
    return [finding.code for finding in env.diagnostics]


def test_without_attributes(read, env):
    body = read(BODY)
    assert (body.GetName(), names(body.GetLinks()), names(body.GetJoints())) == ("k", ["l", "m"], ["j"])
    assert codes(env) == []


def test_name_and_prefix(read, env):
    """OpenRAVE's answers in the case ``gap-17-attributes-of-read``."""
    body = read(BODY, {"name": "n", "prefix": "q"})
    assert (body.GetName(), names(body.GetLinks()), names(body.GetJoints())) == ("n", ["ql", "qm"], ["qj"])
    assert codes(env) == []


def test_of_a_robot_everything_gets_the_prefix(read, env):
    robot = read(ROBOT, {"PREFIX": "p_"})
    assert robot.GetName() == "r"
    assert names(robot.GetLinks()) == ["p_own_l", "p_own_m", "p_own_n"]
    assert names(robot.GetJoints()) == ["p_own_j"]
    assert names(robot.GetManipulators()) == ["p_own_hand"]
    assert names(robot.GetAttachedSensors()) == ["p_own_eye"]
    if not robot.GetEnvironmentBodyIndex():
        env.Add(robot)
    robot.SetDOFValues([0.25])
    assert robot.GetPassiveJoints()[0].GetValue(0) == pytest.approx(0.5)


@pytest.mark.parametrize(("value", "count"), [("1", 0), ("True", 0), ("0", 1), ("", 1)])
def test_without_shapes(read, value, count):
    assert len(read(BODY, {"skipgeometry": value}).GetLinks()[0].GetGeometries()) == count


@pytest.mark.parametrize(("value", "moved"), [("2", [2, 2, 2]), ("2 3 4", [2, 3, 4]), ("2 3", [2, 2, 2])])
def test_factors_of_lengths(read, env, value, moved):
    body = read(BODY, {"scalegeometry": value})
    np.testing.assert_allclose(positions(body), [[0, 0, 0], moved])
    np.testing.assert_array_equal(body.GetLinks()[0].GetGeometries()[0].GetBoxExtents(), [1, 1, 1])
    assert codes(env) == (["bad-number"] if value == "2 3" else [])


def test_factors_multiply_those_of_the_file(read):
    np.testing.assert_allclose(positions(read(ROBOT, {"scalegeometry": "2 3 -0.25"}))[1], [4, 6, -0.5])


def test_what_nothing_reads_is_said(read, env):
    read(BODY, {"skipgeometri": "1", "name": ""})
    assert codes(env) == ["unknown-attribute"]
    assert "skipgeometri" in str(env.diagnostics[0])
    assert "did you mean 'skipgeometry'?" in str(env.diagnostics[0])
    assert env.diagnostics[0].source.line == 1


def test_below_an_environment_nothing_acts(read, env):
    body = read(f"<Environment>{BODY}</Environment>", {"name": "n", "prefix": "p", "skipgeometry": "1"})
    assert (body.GetName(), names(body.GetLinks())) == ("k", ["l", "m"])
    assert len(body.GetLinks()[0].GetGeometries()) == 1
    assert codes(env) == ["ignored-attribute"] * 3


def test_of_a_file_in_the_root(env, tmp_path):
    (tmp_path / "inner.xml").write_text(BODY)
    (tmp_path / "outer.xml").write_text('<KinBody file="inner.xml"><Translation>1 0 0</Translation></KinBody>')
    assert env.Load(tmp_path / "outer.xml", {"name": "n", "prefix": "p", "scalegeometry": "2", "skipgeometry": "1"})
    (body,) = env.GetBodies()
    assert (body.GetName(), names(body.GetLinks()), names(body.GetJoints())) == ("n", ["pl", "pm"], ["pj"])
    np.testing.assert_allclose(positions(body), [[2, 0, 0], [4, 2, 2]])
    assert body.GetLinks()[0].GetGeometries() == []


@pytest.fixture(params=["Load", "LoadData"])
def load_pair(request, monkeypatch):
    """A function that loads a COLLADA file, or its text, which refers to a file beside it."""
    monkeypatch.chdir(PAIR.parent)

    def load(env, atts=None):
        return getattr(env, request.param)(PAIR if request.param == "Load" else PAIR.read_bytes(), atts)

    return load


def test_of_collada(env, load_pair):
    plain = ravemj.Environment()
    assert load_pair(plain)
    assert load_pair(env, {"name": "n", "prefix": "p_", "scalegeometry": "2"})
    assert names(env.GetBodies()) == ["n", "hinge", "crate"]
    for body, other in zip(env.GetBodies(), plain.GetBodies(), strict=True):
        assert names(body.GetLinks()) == [f"p_{name}" for name in names(other.GetLinks())]
        assert names(body.GetJoints()) == [f"p_{name}" for name in names(other.GetJoints())]
        np.testing.assert_allclose(positions(body), 2 * positions(other), atol=1e-12)
        np.testing.assert_allclose(body.ComputeAABB().extents(), 2 * other.ComputeAABB().extents(), rtol=1e-6)


def test_of_collada_without_shapes_and_with_one_factor(env):
    assert env.Load(PAIR, {"skipgeometry": "1", "scalegeometry": "2 3 4"})
    assert "ignored-attribute" in codes(env)
    assert all(link.GetGeometries() == [] for body in env.GetBodies() for link in body.GetLinks())


def test_of_a_mesh(env):
    assert env.Load(WEDGE)
    assert env.Load(WEDGE, {"name": "n", "prefix": "p_", "scalegeometry": "2 3 4"})
    assert env.Load(WEDGE, {"skipgeometry": "1"})
    plain, scaled, bare = env.GetBodies()
    assert (scaled.GetName(), names(scaled.GetLinks())) == ("n", ["p_base"])
    np.testing.assert_allclose(scaled.ComputeAABB().extents(), plain.ComputeAABB().extents() * [2, 3, 4], rtol=1e-6)
    assert bare.GetLinks()[0].GetGeometries() == []


def test_collada_twice_gets_other_names(env, load_pair):
    """OpenRAVE's answers in the case ``name-15-load-twice``."""
    for _ in range(3):
        assert load_pair(env)
    found = names(env.GetBodies())
    assert found[:3] == ["hinge", "hinge0", "crate"]
    assert len(set(found)) == len(found) == 9
    assert [name.rstrip("0123456789") for name in found] == ["hinge", "hinge", "crate"] * 3


def test_a_mesh_twice_gets_another_name(env):
    assert [env.Load(WEDGE) for _ in range(2)] == [True, True]
    first, second = names(env.GetBodies())
    assert (first, second.startswith("wedge"), second != first) == ("wedge", True, True)


def test_what_stands_before_a_clash_in_a_file_stays(env, tmp_path, caplog):
    bodies = [BODY.replace('"k"', f'"{name}"') for name in "abc"]
    env.LoadData(bodies[1])
    (tmp_path / "env.xml").write_text(f"<Environment>{''.join(bodies)}</Environment>")
    assert env.Load(tmp_path / "env.xml") is False
    assert names(env.GetBodies()) == ["b", "a"]
    assert "'b'" in caplog.text


def test_paths_may_be_bytes(env):
    assert env.Load(os.fsencode(WEDGE))
    assert env.ReadKinBodyURI(os.fsencode(WEDGE)).GetName() == "wedge"


def test_arguments_by_name(env):
    assert env.ReadKinBodyURI(filename=WEDGE, atts={"name": "n"}).GetName() == "n"
    assert env.ReadRobotData(ROBOT, atts={"name": "n"}).GetName() == "n"
    assert env.ReadRobotData(data=ROBOT).GetName() == "r"
    with pytest.raises(TypeError, match="attributes"):
        env.ReadRobotURI(WEDGE, attributes={})

"""Bodies without a name, in every way of reading and in every call without arguments."""

import inspect

import pytest

import ravemj

SHAPE = '<Body name="x"><Geom type="box"><extents>.1 .1 .1</extents></Geom></Body>'
TEXTS = {"KinBody": f"<KinBody%s>{SHAPE}</KinBody>", "Robot": f"<Robot%s><KinBody>{SHAPE}</KinBody></Robot>"}
NAMES = {"missing": "", "empty": ' name=""', "blank": ' name=" "'}
GIVEN = {"name": "given"}

LOADS = {
    "Load": lambda env, text: env.Load("body.xml"),
    "LoadURI": lambda env, text: env.LoadURI("file:body.xml"),
    "ReadKinBodyURI": lambda env, text: env.ReadKinBodyURI("body.xml"),
    "ReadRobotURI": lambda env, text: env.ReadRobotURI("body.xml"),
    "ReadKinBodyData": lambda env, text: env.ReadKinBodyData(text),
    "ReadRobotData": lambda env, text: env.ReadRobotData(text),
    "with a prefix": lambda env, text: env.ReadKinBodyData(text, {"prefix": "p_"}),
}
NAMED = {
    "Load": lambda env, text: env.Load("body.xml", GIVEN) and env.GetBodies()[0],
    "LoadData": lambda env, text: env.LoadData(text, GIVEN) and env.GetBodies()[0],
    "ReadKinBodyURI": lambda env, text: env.ReadKinBodyURI("body.xml", GIVEN),
    "ReadRobotURI": lambda env, text: env.ReadRobotURI("body.xml", GIVEN),
    "ReadKinBodyData": lambda env, text: env.ReadKinBodyData(text, GIVEN),
    "ReadRobotData": lambda env, text: env.ReadRobotData(text, GIVEN),
}


@pytest.fixture
def env():
    env = ravemj.Environment()
    env.StopSimulation()
    yield env
    env.Destroy()


@pytest.fixture(params=[(kind, name) for kind in TEXTS for name in NAMES], ids=" ".join)
def text(request, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    kind, name = request.param
    content = TEXTS[kind] % NAMES[name]
    (tmp_path / "body.xml").write_text(content)
    return content


@pytest.mark.parametrize("load", LOADS)
def test_they_are_not_read(env, text, load):
    assert not LOADS[load](env, text)
    assert env.GetBodies() == []


@pytest.mark.parametrize("load", NAMED)
def test_a_given_name_is_theirs(env, text, load):
    assert NAMED[load](env, text).GetName() == "given"


@pytest.mark.parametrize("before", [0, 1, 3])
def test_data_raises_and_files_keep_what_came_before(env, text, before, tmp_path):
    known = "".join(f'<KinBody name="k{number}">{SHAPE}</KinBody>' for number in range(before))
    scene = f'<Environment>{known}{text}<KinBody name="after">{SHAPE}</KinBody></Environment>'
    if ' name=" "' in text:
        assert not env.LoadData(scene)
    else:
        with pytest.raises(ravemj.openrave_exception, match="has no name"):
            env.LoadData(scene)
    assert len(env.GetBodies()) == before
    env.Reset()
    (tmp_path / "scene.xml").write_text(scene)
    assert not env.Load("scene.xml")
    assert len(env.GetBodies()) == before


def made(env, name, factory):
    body = factory(env, "")
    link = ravemj.KinBody.LinkInfo()
    link._name = "l"
    shape = ravemj.KinBody.GeometryInfo()
    shape._type, shape._vGeomData = ravemj.GeometryType.Box, [0.1, 0.1, 0.1]
    link._vgeometryinfos = [shape]
    body.Init([link], [], [], []) if body.IsRobot() else body.Init([link], [])
    if name:
        body.SetName(name)
    return body


def outcome(get):
    """Return how a call ends; errors of Python are mistakes here."""
    try:
        get()
    except ravemj.openrave_exception as error:
        return error.GetCode()
    return "returns"


@pytest.mark.parametrize("factory", [ravemj.RaveCreateKinBody, ravemj.RaveCreateRobot])
def test_calls_end_as_those_of_named_bodies(env, factory):
    without, named = made(env, "", factory), made(env, "named", factory)
    calls = 0
    for name in dir(named):
        static = inspect.getattr_static(type(named), name, None)
        if name[0] == "_" or name == "Destroy":
            continue
        if isinstance(static, property):
            assert outcome(lambda: getattr(without, name)) == outcome(lambda: getattr(named, name)), name  # noqa: B023
        elif inspect.isfunction(static):
            arguments = [*inspect.signature(static).parameters.values()][1:]
            if all(one.default is not one.empty or one.kind in {2, 4} for one in arguments):
                calls += 1
                assert outcome(getattr(without, name)) == outcome(getattr(named, name)), name
    assert calls > 70


def test_names_are_not_taken_away(env):
    body = made(env, "named", ravemj.RaveCreateKinBody)
    for wrong in ("", None):
        with pytest.raises(ravemj.openrave_exception, match="should not be empty"):
            body.SetName(wrong)
    assert body.GetName() == "named"
    assert env.GetKinBody("") is env.GetRobot("") is None
    assert not env.Remove(made(env, "", ravemj.RaveCreateKinBody))


def test_places_in_qpos_are_those_of_a_body_in_an_environment(env):
    body = made(env, "named", ravemj.RaveCreateKinBody)
    with pytest.raises(
        ravemj.openrave_exception, match=r"qpos_indices: 'named' is not in an environment; add it first"
    ):
        _ = body.qpos_indices
    env.Add(body)
    assert body.qpos_indices.tolist() == []

"""Names of interfaces in every ``RaveCreate…`` function: known ones, unknown ones, letter case, arguments."""

import pytest

import ravemj
from ravemj import InterfaceType
from ravemj.compat import openravepy
from ravemj.planning.retiming import topp_ra

FACTORIES = {
    InterfaceType.collisionchecker: "CollisionChecker",
    InterfaceType.controller: "Controller",
    InterfaceType.iksolver: "IkSolver",
    InterfaceType.kinbody: "KinBody",
    InterfaceType.module: "Module",
    InterfaceType.physicsengine: "PhysicsEngine",
    InterfaceType.planner: "Planner",
    InterfaceType.robot: "Robot",
    InterfaceType.sensor: "Sensor",
    InterfaceType.sensorsystem: "SensorSystem",
    InterfaceType.spacesampler: "SpaceSampler",
    InterfaceType.trajectory: "Trajectory",
    InterfaceType.viewer: "Viewer",
}
ARGUMENTS = {"RobotConfiguration": " PUMA560", "BodyConfiguration": " PUMA560", "ikfast": " Transform6D 0.1"}
"""What has to follow a name."""
BY_DEFAULT = {InterfaceType.kinbody, InterfaceType.robot, InterfaceType.trajectory}
"""Types of which the empty name makes one."""
KNOWN = [
    (kind, name)
    for kind, names in ravemj.RaveGetLoadedInterfaces().items()
    for name in names
    if name and kind != InterfaceType.viewer and (topp_ra.is_installed() or not name.lower().startswith("toppra"))
]


@pytest.fixture(scope="module")
def env():
    env = ravemj.load(ravemj.model_path("puma560"))
    env.StopSimulation()
    yield env
    env.Destroy()


def create(env, kind, name):
    """Return what both functions make, after a check that it is the same."""
    made = getattr(ravemj, f"RaveCreate{FACTORIES[kind]}")(env, name)
    again = ravemj.RaveCreateInterface(env, kind, name)
    assert type(made) is type(again)
    return made


def test_every_type_has_a_factory():
    assert {InterfaceType(kind) for kind in ravemj.RaveGetLoadedInterfaces()} == set(FACTORIES) == set(InterfaceType)
    assert len(KNOWN) > 50


@pytest.mark.parametrize(("kind", "name"), KNOWN)
def test_known_names(env, kind, name):
    needed = ARGUMENTS.get(name, "")
    made = create(env, kind, name + needed)
    assert made is not None
    assert made.GetInterfaceType() == kind
    assert made.GetEnv() == env
    for other in (name.lower(), name.upper(), name.swapcase()):
        assert type(create(env, kind, other + needed)) is type(made)
        assert ravemj.RaveHasInterface(kind, other)
    for more in (" ", " 1", " a b"):
        if not needed:
            assert type(create(env, kind, name + more)) is type(made)
    assert made.GetXMLId().split()[0].lower() == name.lower()


@pytest.mark.parametrize("name", ["nosuch", "nosuch x", "x" * 1000, "\n", "ode\0", "é", "1", "None", "birrt2"])
@pytest.mark.parametrize("kind", FACTORIES)
def test_unknown_names_give_none(env, kind, name):
    if name == "\n" and kind in BY_DEFAULT:
        return
    assert create(env, kind, name) is None
    assert not ravemj.RaveHasInterface(kind, name)


@pytest.mark.parametrize("kind", FACTORIES)
def test_the_empty_name(env, kind):
    made = create(env, kind, "")
    assert (made is not None) == (kind in BY_DEFAULT)
    if made is not None:
        assert type(made).__name__ == FACTORIES[kind]


@pytest.mark.parametrize("kind", FACTORIES)
def test_names_of_another_type_give_none(env, kind):
    mine = {name.lower() for of_kind, name in KNOWN if of_kind == kind}
    for _, name in KNOWN:
        if name.lower() not in mine:
            assert create(env, kind, name) is None


@pytest.mark.parametrize("wrong", [None, 3, b"ode", ["ode"], object()])
@pytest.mark.parametrize("kind", FACTORIES)
def test_names_are_texts_and_environments_are_environments(env, kind, wrong):
    factory = getattr(ravemj, f"RaveCreate{FACTORIES[kind]}")
    for call in (factory, lambda scene, name: ravemj.RaveCreateInterface(scene, kind, name)):
        with pytest.raises(ravemj.openrave_exception, match=r"name: is .*should be a text"):
            call(env, wrong)
        with pytest.raises(ravemj.openrave_exception, match=r"env is .*should be an Env"):
            call(wrong, "nosuch")


def test_old_names_of_modules(env):
    for factory in (openravepy.RaveCreateProblem, openravepy.RaveCreateProblemInstance):
        assert type(factory(env, "basemanipulation")).__name__ == "Module"
        assert factory(env, "nosuch") is factory(env, "") is None
    assert type(ravemj.RaveCreateMultiController(env, "")).__name__ == "MultiController"
    assert ravemj.RaveCreateMultiController(env, "IdealController") is None


def test_sensor_systems_are_told_in_the_log(env, caplog):
    assert ravemj.RaveCreateSensorSystem(env, "mocap") is None
    assert "there is no sensor system 'mocap'" in caplog.text

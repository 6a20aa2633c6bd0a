"""What scripts find under the name openravepy: the star, its sub-modules, the library's own functions."""

import builtins
import logging
import sys
import weakref

import numpy as np
import pytest

import ravemj
from ravemj.compat import alias, legacy, metaclass, names
from ravemj.rave import environment, library
from ravemj.rave.modules import MISSING as MISSING_MODULES


@pytest.fixture
def openravepy(monkeypatch):
    """The module, imported as scripts do, for one test."""
    known = set(sys.modules)
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))
    alias.install_finder()
    import openravepy

    yield openravepy
    for name in set(sys.modules) - known:
        if name.partition(".")[0] == "openravepy":
            del sys.modules[name]


@pytest.fixture(autouse=True)
def _environments(monkeypatch):
    """Keep those of other tests from being destroyed."""
    monkeypatch.setattr(environment, "_environments", weakref.WeakValueDictionary())


@pytest.fixture(autouse=True)
def _level():
    yield
    ravemj.RaveSetDebugLevel(ravemj.DebugLevel.Info)
    for name in ("openravepy", "ravemj"):
        logging.getLogger(name).handlers = []
    logging.getLogger("ravemj").setLevel(logging.NOTSET)


def test_the_star_brings_openraves_names_and_what_slips_out(openravepy):
    space: dict[str, object] = {"load": "numpy's"}
    exec("from openravepy import *", space)
    for name in ("Environment", "RaveInitialize", "openrave_exception", "IkParameterizationType"):
        assert space[name] is getattr(ravemj, name)
    for name in ("raveLogInfo", "with_destroy", "planning_error"):
        assert space[name] is getattr(legacy, name)
    for name in ("databases", "interfaces", "metaclass", "misc", "openravepy_int", "planningutils"):
        assert space[name] is sys.modules[f"ravemj.compat.{name}"]
    assert space["OpenRAVEGlobalArguments"] is sys.modules["ravemj.compat.misc"].OpenRAVEGlobalArguments
    assert space["numpy"] is np
    assert space["sys"] is sys
    assert isinstance(space["log"], logging.Logger)
    assert {"pickle", "logging"} <= set(space)
    assert space["load"] == "numpy's"
    assert openravepy.load is ravemj.load
    assert not hasattr(openravepy, "nonsense")


def test_every_name_of_openraves_is_in_ravemj_too(openravepy):
    for name in dir(openravepy):
        leaks = {"itertools", "log", "logging", "numpy", "os", "pickle", "sys"}
        moved = {"OpenRAVEGlobalArguments", "OpenRAVEModel"}
        assert hasattr(ravemj, name) or name in {*leaks, *moved, *legacy.__all__, *names.ONLY_OPENRAVEPY}


def test_sub_modules_are_ours(openravepy):
    import openravepy.databases.inversekinematics as ik
    from openravepy import databases, misc
    from openravepy.misc import InitOpenRAVELogging

    assert ik is databases.inversekinematics is ravemj.databases.inversekinematics
    assert misc.InitOpenRAVELogging is InitOpenRAVELogging
    assert openravepy.openravepy_int.Environment is ravemj.Environment
    assert __import__("openravepy.examples").examples is sys.modules["ravemj.compat.examples"]


def test_importing_sets_the_flag_and_has_a_version_that_can_be_compared(openravepy):
    assert builtins.__openravepy_build_doc__ is openravepy.__build_doc__ is False
    assert [int(part) for part in openravepy.__version__.split(".")] >= [0, 9, 0]


def test_enumerations_are_numbers_with_names():
    assert ravemj.IkFilterOptions.CheckEnvCollisions | ravemj.IkFilterOptions.IgnoreJointLimits == 5
    assert ravemj.IkFilterOptions.IgnoreEndEffectorCollisions.name == "IgnoreEndEffectorEnvCollisions"
    assert ravemj.Sensor.ConfigureCommand.PowerOn.name == "PowerOn"
    assert ravemj.SelectionOptions.NoRobots == ravemj.TriangulateOptions.Obstacles == 1
    assert int(ravemj.DebugLevel.VerifyPlans) == 1 << 31


@pytest.mark.parametrize("name", ["Failed", "HasSolution", "Interrupted", "InterruptedWithSolution"])
def test_a_planner_status_is_old_and_new(name):
    status = getattr(ravemj.PlannerStatus, name)
    assert status.statusCode is ravemj.PlannerStatusCode[name]
    assert status == getattr(ravemj.Planner.PlannerStatus, name) == ravemj.PlannerStatusCode[name]
    assert bool(status & ravemj.PlannerStatus.HasSolution) == ("Solution" in name)
    assert bool(status) == ("Solution" in name)


def test_initialize_and_destroy():
    assert ravemj.RaveInitialize(True, level=None) == 0
    assert ravemj.RaveGetDebugLevel() == ravemj.DebugLevel.Info
    assert ravemj.RaveInitialize(True, level=ravemj.DebugLevel.Warn) == 0
    assert ravemj.RaveGetDebugLevel() == ravemj.DebugLevel.Warn
    env = ravemj.load("models/env.xml")
    number = ravemj.RaveGetEnvironmentId(env)
    assert ravemj.RaveGetEnvironment(number) is env
    assert env in ravemj.RaveGetEnvironments()
    ravemj.RaveDestroy()
    assert env.GetBodies() == []
    ravemj.RaveDestroy()


def test_with_destroy_ends_with_empty_environments_even_after_an_error():
    made = []

    @legacy.with_destroy
    def main(count):
        """What main does."""
        made.append(ravemj.load("models/env.xml"))
        return 1 / count

    assert main(2) == 0.5
    with pytest.raises(ZeroDivisionError):
        main(count=0)
    assert [env.GetBodies() for env in made] == [[], []]
    assert main.__doc__ == "What main does."


def test_the_level_decides_what_is_logged(caplog):
    ravemj.RaveSetDebugLevel(ravemj.DebugLevel.Warn | ravemj.DebugLevel.VerifyPlans)
    assert ravemj.RaveGetDebugLevel() & 0xFFFF == ravemj.DebugLevel.Warn
    legacy.raveLogInfo("quiet")
    ravemj.RaveLogWarn("loud\n")
    ravemj.RaveSetDebugLevel(5)
    legacy.raveLogVerbose("100 %s")
    assert caplog.messages == ["loud", "100 %s"]


def test_plugins_of_openrave_are_there_from_the_start(caplog):
    for name in ("ikfastsolvers", "libikfastsolvers", "/usr/lib/openrave0.9-plugins/librmanipulation.so"):
        assert ravemj.RaveLoadPlugin(name) is True
    assert not caplog.messages


def test_enumerations_list_their_members_as_those_of_boost_python():
    kinds = ravemj.IkParameterizationType
    assert kinds.values[int(kinds.Transform6D)] is kinds.Transform6D
    assert kinds.names["Ray4D"] is kinds.Ray4D
    assert list(ravemj.SampleDataType.values.values()) == [ravemj.SampleDataType.Real, ravemj.SampleDataType.Uint32]


def test_native_plugins_and_unknown_things_fail_softly(env, caplog):
    assert ravemj.RaveLoadPlugin("libor_other.so") is False
    assert "libor_other.so" in caplog.text
    assert ravemj.RaveLoadPlugin("libor_urdf.so")
    for create in (
        ravemj.RaveCreateModule,
        ravemj.RaveCreateProblem,
        ravemj.RaveCreatePlanner,
        ravemj.RaveCreateIkSolver,
        ravemj.RaveCreateSensor,
        ravemj.RaveCreateSpaceSampler,
        ravemj.RaveCreateViewer,
    ):
        assert create(env, "nosuch") is None
        assert create(env, "") is None


@pytest.mark.parametrize(
    ("name", "capability"),
    MISSING_MODULES.items(),
)
def test_openraves_own_plugins_say_what_is_missing(env, name, capability):
    with pytest.raises(NotImplementedError, match=capability) as caught:
        ravemj.RaveCreateModule(env, name.upper() + " with arguments")
    assert caught.value.capability == capability
    assert caught.value.GetCode() == "NotImplemented"


def test_modules_are_refused_and_none_is_there(env):
    for add in (env.AddModule, env.LoadProblem):
        with pytest.raises(ravemj.openrave_exception, match="AddModule: module is None; RaveCreateModule") as caught:
            add(ravemj.RaveCreateModule(env, "nomodule"), "")
        assert caught.value.GetCode() == "InvalidArguments"
        with pytest.raises(ravemj.openrave_exception, match="module: is of type str"):
            add("urdf", args="")
    assert env.GetModules() == env.GetLoadedProblems() == []
    for wrong in (object(), "urdf"):
        with pytest.raises(ravemj.openrave_exception, match="takes a body, a sensor, a module or a viewer"):
            env.RemoveProblem(wrong)
    with pytest.raises(ravemj.openrave_exception, match="None"):
        env.RemoveProblem(None)


def test_sensors_stand_where_they_are_attached(env):
    camera = '<sensor type="BaseCamera"><KK>500 500 320 240</KK><width>640</width><height>480</height></sensor>'
    text = (
        '<Robot name="r"><KinBody><Body name="b"><Geom type="sphere"><radius>1</radius></Geom></Body></KinBody>'
        f'<AttachedSensor name="eye"><link>b</link><translation>0 0 2</translation>{camera}</AttachedSensor></Robot>'
    )
    assert env.LoadData(text)
    (sensor,) = env.GetSensors()
    assert sensor.GetName() == "r:eye"
    assert env.GetSensor("r:eye").GetTransform()[2, 3] == 2
    assert env.GetSensor("eye") is None


def test_a_viewer_by_its_name_is_the_environments(env, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert ravemj.RaveCreateViewer(env, "QtCoin") is env.GetViewer() is not None


def test_files_of_databases(tmp_path, monkeypatch):
    monkeypatch.setenv("OPENRAVE_HOME", str(tmp_path / "home"))
    monkeypatch.setenv("OPENRAVE_DATABASE", str(tmp_path / "data"))
    assert library.RaveGetHomeDirectory() == str(tmp_path / "home")
    assert library.RaveFindDatabaseFile("robot.x/ik.so") == ""
    assert library.RaveFindDatabaseFile("robot.x/ik.so", False) == str(tmp_path / "data" / "robot.x" / "ik.so")
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / "file").touch()
    assert library.RaveFindDatabaseFile("file") == str(tmp_path / "home" / "file")


@pytest.mark.parametrize("by_alias", [True, False])
@pytest.mark.parametrize("given", ["OPENRAVE_HOME", "HOME"])
def test_initialising_makes_the_home_folder(request, tmp_path, monkeypatch, by_alias, given):
    module = request.getfixturevalue("openravepy") if by_alias else ravemj
    monkeypatch.delenv("OPENRAVE_HOME")
    monkeypatch.setenv(given, str(tmp_path / "not yet" / "home"))
    wanted = tmp_path / "not yet" / "home" / ("" if given == "OPENRAVE_HOME" else ".openrave")
    for _ in range(2):
        assert module.RaveInitialize() == 0
        assert wanted.is_dir()
    assert module.RaveGetHomeDirectory() == str(wanted)


def test_a_home_folder_that_cannot_be_made_is_a_warning(tmp_path, monkeypatch, caplog):
    (tmp_path / "file").touch()
    monkeypatch.setenv("OPENRAVE_HOME", str(tmp_path / "file" / "home"))
    assert ravemj.RaveInitialize(level=ravemj.DebugLevel.Info) == 0
    assert str(tmp_path / "file" / "home") in caplog.text


def test_nobody_at_home_is_a_warning(monkeypatch, caplog):
    def nobody():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("OPENRAVE_HOME")
    monkeypatch.setattr(library.Path, "home", nobody)
    assert ravemj.RaveInitialize(level=ravemj.DebugLevel.Info) == 0
    assert "Could not determine" in caplog.text


def test_local_files(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    assert library.RaveFindLocalFile("file", str(tmp_path)) == str(tmp_path / "file")
    assert library.RaveFindLocalFile("file") == ""
    monkeypatch.setenv("OPENRAVE_DATA", str(tmp_path))
    assert library.RaveFindLocalFile("file") == str(tmp_path / "file")


# Sub-modules


def test_models_are_made_have_nothing_and_say_what_is_missing(robot):
    reachability = ravemj.databases.kinematicreachability.ReachabilityModel(robot)
    assert reachability.has() is False
    with pytest.raises(ravemj.openrave_exception, match=r"ReachabilityModel.generate: .* maps of what arms reach"):
        reachability.generate()
    assert not hasattr(reachability, "__array__")


def test_convex_decomposition_does_nothing(robot):
    model = ravemj.databases.convexdecomposition.ConvexDecompositionModel(robot, padding=0.01)
    model.autogenerate()
    model.save()
    assert model.load() is True


@pytest.mark.parametrize("name", ["TaskCaging", "VisualFeedback"])
def test_interfaces_say_what_is_missing(name, robot):
    with pytest.raises(NotImplementedError, match=f"{name}: ravemj does no"):
        getattr(ravemj.interfaces, name)(robot)


def test_planning_errors_are_no_openrave_exceptions():
    with pytest.raises(ravemj.PlanningError):
        raise legacy.planning_error("no way")
    assert not issubclass(ravemj.PlanningError, ravemj.openrave_exception)


def test_metaclass_has_what_scripts_derive_from():
    class Model(metaclass.AutoReloader):
        pass

    assert isinstance(Model(), metaclass.InstanceTracker)

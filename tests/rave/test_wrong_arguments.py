"""Mistakes that scripts make: each error says what was found, and what was expected."""

import gc
import inspect
import math
import re
from enum import EnumMeta
from types import GenericAlias

import numpy as np
import pytest
from wrong_calls import KINDS, calls_with_one_argument, calls_with_several_arguments

import ravemj
from ravemj import geometry_functions
from ravemj.compat import legacy, openravepy, pyANN_int
from ravemj.core.handles import Handle


def trajectory(env, robot):
    spec = robot.GetActiveConfigurationSpecification("linear")
    spec.AddDeltaTimeGroup()
    made = ravemj.RaveCreateTrajectory(env, "")
    made.Init(spec)
    return made


MISTAKES = {
    "values": (lambda env, robot: robot.SetDOFValues(None), "SetDOFValues: is None, and should be numbers"),
    "pose": (lambda env, robot: robot.SetTransform(None), "SetTransform: transform: is None"),
    "rotation": (lambda env, robot: robot.SetTransform(np.ones((4, 4))), "the rotation .* is not one"),
    "goal": (lambda env, robot: robot.ik(np.eye(3)), r"goals: has shape \(3, 3\), .* \(N, 4, 4\) for .*Transform6D"),
    "point": (
        lambda env, robot: robot.ik([1, 2], ravemj.IkParameterizationType.Translation3D),
        r"goals: has shape \(2,\), .* \(N, 3\) for .*Translation3D",
    ),
    "nothing": (lambda env, robot: env.render(0, 0), "picture size 0 x 0: expected whole pixels"),
    "half a pixel": (lambda env, robot: env.render(640.5, 480), "picture size 640.5 x 480: expected whole pixels"),
    "no video": (
        lambda env, robot: ravemj.record(env, "a.mp4", ravemj.Motion.line(np.zeros(6), np.full(6, 0.5), 1), width=-1),
        "picture size -1 x 480: expected whole pixels",
    ),
    "itself": (lambda env, robot: robot.Grab(robot), "'PUMA560' cannot hold itself"),
    "no step": (lambda env, robot: env.StepSimulation(None), "StepSimulation: timestep"),
    "endless step": (lambda env, robot: env.StepSimulation(math.inf), "StepSimulation: timestep"),
    "backwards": (lambda env, robot: env.StepSimulation(-1), "timestep is -1, .* 0 s or more"),
    "axis": (
        lambda env, robot: robot.GetJoints()[0].GetMaxVel([]),
        "GetMaxVel: axis: is of type list, and should be a whole",
    ),
    "key": (
        lambda env, robot: robot.GetJoints()[0].SetStringParameters([], "x"),
        "key: is of type list, and should be a text",
    ),
    "leader": (
        lambda env, robot: robot.GetJoints()[0].SetMimicEquations(0, 3),
        "poseq: is of type int, and should be a text",
    ),
    "command": (lambda env, robot: robot.SupportsCommand(None), "SupportsCommand: cmd: is None, and should be a text"),
    "info": (lambda env, robot: robot.UpdateFromKinBodyInfo(3), "info: is of type int, and should be a KinBodyInfo"),
    "name for body": (lambda env, robot: env.Remove("PUMA560"), "Remove: takes a body, .* not something of type str"),
    "add mode": (lambda env, robot: env.Add(robot, "x"), "addMode is 'x', and should be True, False or an Interface"),
    "callback": (lambda env, robot: env.RegisterBodyCallback(3), "callback is 3, and should be a function"),
    "false checker": (
        lambda env, robot: env.SetCollisionChecker(""),
        "collisionchecker: is of type str, and should be Coll",
    ),
    "new name": (
        lambda env, robot: env.TriangulateScene(options=[]),
        "TriangulateScene: options: is of type list, and should be a whole number",
    ),
    "function": (
        lambda env, robot: ravemj.RaveGetAffineConfigurationSpecification("xyz"),
        "RaveGetAffineConfigurationSpecification: affinedofs: is of type str, and should be a whole number",
    ),
    "name of a function": (
        lambda env, robot: ravemj.RaveCreateController(env, 3),
        "RaveCreateController: name: is of type int, and should be a text",
    ),
    "constructor": (
        lambda env, robot: ravemj.IkParameterization(np.eye(4), "pose"),
        "IkParameterization: type: is of type str, and should be an IkParameterizationType or a whole number",
    ),
    "half a dimension": (
        lambda env, robot: ravemj.RaveCreateSpaceSampler(env, "MT19937").SetSpaceDOF(1.5),
        "SetSpaceDOF: dof: is of type float, and should be a whole number",
    ),
    "seed": (lambda env, robot: ravemj.RaveCreateSpaceSampler(env, "Halton").SetSeed(-1), "SetSeed: seed is -1, and"),
    "half a seed": (lambda env, robot: ravemj.Planner.PlannerParameters().SetRandomGeneratorSeed(0.5), "whole number"),
    "tag without an end": (
        lambda env, robot: ravemj.RaveCreatePlanner(env, "LinearSmoother").InitPlan(None, "<a"),
        "planner parameters: not well-formed XML .*'<a'",
    ),
    "limits": (
        lambda env, robot: robot.SetDOFValues([99], [0], checklimits="nosuch"),
        "checklimits: is 'nosuch', and should be a CheckLimitsAction",
    ),
    "eternity": (
        lambda env, robot: ravemj.RaveCreatePhysicsEngine(env, "ode").SimulateStep(1e30),
        r"1e\+30 s, and should be 86400 s at most",
    ),
    "when": (lambda env, robot: trajectory(env, robot).GetFirstWaypointIndexAfterTime(math.nan), "time: is nan"),
    "which": (lambda env, robot: trajectory(env, robot).GetWaypoint("0"), "GetWaypoint: index: is of type str"),
    "link of a chain": (lambda env, robot: robot.GetChain(0, None), "GetChain: linkindex2: linkindex: is None"),
    "affine speeds": (lambda env, robot: robot.SetAffineTranslationMaxVels(None), "MaxVels: vels: is None"),
    "affine weights": (lambda env, robot: robot.SetAffineRotation3DWeights([1]), r"weights: has shape \(1,\)"),
    "heading": (
        lambda env, robot: ravemj.IkParameterization().SetTranslationXAxisAngle4D([0, 0, 0], "x"),
        "SetTranslationXAxisAngle4D: angle: 'x' should be numbers",
    ),
    "shape": (lambda env, robot: robot.GetLinks()[0].AddGeometry(None), "AddGeometry: geometryinfo: a geometry is of"),
    "unit": (lambda env, robot: env.SetUnit(None, 1), "SetUnit: unitname: LengthUnit: .* is None"),
    "engine": (lambda env, robot: env.SetPhysicsEngine("newton"), "no physics engine 'newton'; there are ode, bullet"),
}


@pytest.fixture(scope="module")
def scene():
    env = ravemj.Environment()
    env.Load(ravemj.model_path("puma560"))
    yield env, env.GetRobots()[0]
    env.Destroy()


@pytest.mark.parametrize("name", MISTAKES)
def test_errors_say_what_was_expected(scene, name):
    env, robot = scene
    before = robot.GetDOFValues(), robot.GetTransform()
    mistake, message = MISTAKES[name]
    with pytest.raises((ravemj.openrave_exception, TypeError), match=message):
        mistake(env, robot)
    assert (robot.GetDOFValues() == before[0]).all()
    assert (robot.GetTransform() == before[1]).all()
    assert env.GetBodies() == [robot]


def test_an_axis_that_a_joint_does_not_have_is_an_index_error(scene):
    joint = scene[1].GetJoints()[0]
    for index in (-1, 1):
        with pytest.raises(IndexError, match="axis are"):
            joint.GetMaxVel(index)


def test_none_is_not_blamed_where_it_is_allowed():
    env = ravemj.Environment()
    env.Load(ravemj.model_path("puma560"))
    arm, pose = env.GetRobots()[0].GetActiveManipulator(), ravemj.IkParameterizationType.Transform6D
    assert ravemj.databases.inversekinematics.InverseKinematicsModel(arm.GetRobot(), pose).load()
    with pytest.raises(ravemj.openrave_exception, match=r"^freevalues have shape \(1,\)"):
        arm.GetIkSolver().Solve(arm.GetIkParameterization(pose, False), None, [0.5], 0)
    env.Destroy()


WRONG = [None, [], {}, object(), [("a", "b")], [[1]], [[0, 1, 2]], [None], [[[1]]], b"x", 10**400, -1, 1.5]
WRONG += [float("nan"), [float("inf")], "x\0y", [[0, "b"]], ("a", 1), lambda: 1]


def test_errors_of_users_functions_stay_as_they_are():
    env = ravemj.Environment()

    def callback(body, action):
        raise TypeError("mine")

    handle = env.RegisterBodyCallback(callback)
    with pytest.raises(TypeError, match=r"^mine$"):
        env.Load(ravemj.model_path("puma560"))
    handle.close()


@pytest.mark.parametrize("name", KINDS)
def test_pythons_own_errors_name_the_argument(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # some write files
    env = ravemj.Environment()
    env.Load(ravemj.model_path("puma560"))
    thing, calls = KINDS[name](env, env.GetRobots()[0]), 0
    for method, argument in calls_with_one_argument(thing):
        for wrong in WRONG:
            calls += 1
            try:
                getattr(thing, method)(**{argument: wrong})
            except ravemj.openrave_exception:
                pass
            except (TypeError, AttributeError, ValueError, LookupError, OverflowError) as error:
                assert names_one_of([argument], error), (method, argument, wrong, error)  # noqa: PT017 - of many calls
    assert calls > 20
    env.Destroy()


SEVERAL = KINDS | {
    "specification": lambda env, robot: robot.GetActiveConfigurationSpecification(),
    "functions": lambda env, robot: geometry_functions,
    "environment": lambda env, robot: env,
}


@pytest.mark.parametrize("name", SEVERAL)
def test_pythons_own_errors_name_one_of_several_arguments(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    env = ravemj.Environment()
    env.Load(ravemj.model_path("puma560"))
    thing = SEVERAL[name](env, env.GetRobots()[0])
    for function, arguments in calls_with_several_arguments(thing):
        rows = [
            {**dict.fromkeys(arguments, rest), one: wrong}
            for one in arguments
            for wrong in WRONG
            for rest in (0, [0.0])
        ]
        for row in rows:
            try:
                getattr(thing, function)(**row)
            except ravemj.openrave_exception:
                pass
            except (TypeError, AttributeError, ValueError, LookupError, OverflowError) as error:
                named = names_one_of((*arguments, function, "pose"), error)
                assert named, (function, row, error)  # noqa: PT017 - of many calls
    env.Destroy()


MODULES = (ravemj, ravemj.planningutils, ravemj.misc, ravemj.interfaces, ravemj.databases, pyANN_int)


def of_helpers(env, robot):
    pose = ravemj.IkParameterizationType.Transform6D
    return {
        "ik model": ravemj.databases.inversekinematics.InverseKinematicsModel(robot, pose),
        "statistics": ravemj.databases.linkstatistics.LinkStatisticsModel(robot),
        "retimer": ravemj.planningutils.ActiveDOFTrajectoryRetimer(robot, "LinearTrajectoryRetimer"),
        "fingers": ravemj.interfaces.TaskManipulation(robot),
        "motions": ravemj.interfaces.BaseManipulation(robot),
        "parameters": ravemj.Planner.PlannerParameters(),
        "goal": ravemj.IkParameterization(np.eye(4), pose),
    } | {module.__name__: module for module in MODULES}


OTHERS = {
    "Environment": lambda env, robot: env,
    "Robot": lambda env, robot: robot,
    "KinBody": lambda env, robot: robot,
    "Manipulator": lambda env, robot: robot.GetActiveManipulator(),
    "Trajectory": trajectory,
    "ConfigurationSpecification": lambda env, robot: robot.GetActiveConfigurationSpecification(),
    "int": lambda env, robot: 0,
    "float": lambda env, robot: 0.5,
    "str": lambda env, robot: "x",
    "ArrayLike": lambda env, robot: np.zeros(6),
}
"""What stands beside a wrong argument, by the annotation."""
ENUMERATIONS = {
    name: kind for module in (ravemj, openravepy) for name, kind in vars(module).items() if isinstance(kind, EnumMeta)
}
SLOW = {"SetViewerUserThread", "InitOpenRAVELogging", "autogenerate", "generate", "testik", "perftiming"}


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("wrong", [*WRONG[:5], *(pytest.param(one, marks=pytest.mark.stress) for one in WRONG[5:])])
def test_functions_and_helpers_of_submodules_name_an_argument(wrong, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    env = ravemj.Environment()
    env.Load(ravemj.model_path("puma560"))
    robot, calls = env.GetRobots()[0], 0
    for thing in of_helpers(env, robot).values():
        for name in sorted({*getattr(thing, "__all__", dir(thing))} - SLOW):
            function = getattr(thing, name)
            if name[0] == "_" or not takes_arguments(function):
                continue
            for argument, given in rows_of(function, env, robot, wrong):
                calls += 1
                try:
                    function(**given)
                except (ravemj.openrave_exception, ravemj.PlanningError, NotImplementedError, AssertionError):
                    pass
                except (TypeError, AttributeError, ValueError, LookupError, ArithmeticError) as error:
                    assert names_one_of((*given, name), error), (name, argument, wrong, error)  # noqa: PT017 - of many
    assert calls > 800
    env.Destroy()


NAMES_OF_OLD = sorted({*legacy.NAMES} - {"RaveGlobalState", "VoidPointer"})
ERRORS = ["SourceError", "CompileError", "OutputError", "UnsupportedError", "PlanningError", "SweepError"]
ERRORS += ["CollisionPairInfo"]


@pytest.mark.parametrize("name", [*NAMES_OF_OLD, *ERRORS])
def test_old_names_and_errors_name_an_argument(name, scene):
    function = getattr(openravepy, name, None) or getattr(ravemj, name)
    if isinstance(function, EnumMeta):
        return
    for wrong in WRONG:
        for _, given in rows_of(function, *scene, wrong):
            try:
                function(**given)
            except ravemj.openrave_exception:
                pass
            except (TypeError, AttributeError, ValueError, LookupError, ArithmeticError) as error:
                assert names_one_of((*given, name), error), (given, error)  # noqa: PT017 - of many calls
            gc.collect(0)


@pytest.mark.stress
def test_a_handle_needs_a_function(capfd):
    for wrong in WRONG[:-1]:
        with pytest.raises(TypeError, match=r"Handle: release: is .*, and should be a function"):
            Handle(wrong)
    gc.collect()
    assert "Exception ignored" not in capfd.readouterr().err


def names_one_of(words, error):
    return any(re.search(rf"\b{word}\b", str(error)) for word in words)


@pytest.mark.parametrize("name", ENUMERATIONS)
def test_enumerations_name_the_value(name):
    for wrong in [None, [], {}, object(), 1.5, float("nan"), "x", b"x", [[1]]]:
        with pytest.raises(ValueError, match=rf"^{ENUMERATIONS[name].__name__}: value: is .*, and should be "):
            ENUMERATIONS[name](wrong)


def takes_arguments(thing):
    return inspect.isroutine(thing) or (inspect.isclass(thing) and not isinstance(thing, EnumMeta | GenericAlias))


def rows_of(function, env, robot, wrong):
    """Return the arguments of calls with a wrong one: its name, and all of them."""
    known = [one for one in inspect.signature(function).parameters.values() if one.kind not in (0, 2, 4)]
    beside = {one.name: stand_in(str(one.annotation), env, robot) for one in known if one.default is one.empty}
    return [(one.name, beside | {one.name: wrong}) for one in known]


def stand_in(annotation, env, robot):
    words = [word for word in OTHERS if word in annotation]
    return OTHERS[words[0]](env, robot) if words else None

"""What the API does with wrong input: it raises what OpenRAVE's users expect, says why, and nothing has changed."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import MODELS

import ravemj

FOLDER = MODELS.parent / "tests" / "scripts" / "data"
SHEAR, MIRROR = np.eye(4), np.diag([1.0, 1, -1, 1])
SHEAR[0, 1] = 0.5

CALLS = {
    # wrong lengths, shapes and numbers
    "ValueError": """
        robot.SetDOFVelocities([1, 0, 0, 0], [1, 2], [1, 2, 3])
        robot.SetDOFVelocities([1, 0, 0, 0], [1, 2, 3], [1, 2])
        robot.SetTransform(SHEAR[:3, :3])
        robot.ComputeJacobianTranslation(1, [0, 0])
        IkParameterization(EYE[:3, :3], IkParameterizationType.Transform6D)
    """,
    "InvalidArguments": """
        robot.SendCommand("")
        env.Load("room.env.xml", "prefix")
        env.Load("room.env.xml", {"prefix": 1})
        env.LoadData("<KinBody/>", {1: "p"})
        env.ReadKinBodyData("<KinBody/>", {"scalegeometry": 2})
        env.ReadRobotData()
        env.ReadRobotData({"name": "r"}, "<Robot/>")
        robot.SetDOFValues([1])
        robot.SetDOFValues([[1, 2, 3, 4]])
        robot.SetDOFValues("abcd")
        robot.SetDOFValues(None)
        robot.SetDOFValues([1, 2, 3, inf])
        robot.SetDOFValues([1], [0, 1])
        robot.SetDOFValues([1], ["a"])
        robot.SetDOFValues([1], [0.5])
        robot.SetDOFValues([0.1, 9], [1, 0], checklimits=3)
        robot.GetDOFValues("x")
        robot.SetDOFVelocities([1])
        robot.SetDOFVelocities([1, 2, 3, nan])
        robot.SetDOFVelocities([99, 0, 0, 0], [1, 2, 3], [1, 2, 3], 3)
        robot.SetDOFVelocities([1, 99], 3, [1, 0])
        robot.SetLinkVelocities([[1, 2, 3]])
        robot.SetVelocity([1, 2], [1, 2, 3])
        robot.SetVelocity([1, 2, 3], [1, 2])
        robot.SetDOFLimits([nan] * 4, [2] * 4)
        robot.SetDOFTorqueLimits("x")
        robot.SetDOFWeights([0, 1, 1, 1])
        robot.SetDOFResolutions([-1, 1, 1, 1])
        robot.SetTransform(SHEAR)
        robot.SetTransform(MIRROR)
        robot.SetTransform(nan * SHEAR)
        robot.SetTransform([0, 0, 0, 0, 1, 2, 3])
        robot.SetTransform(None)
        robot.SetTransformWithDOFValues(SHEAR, [0, 0, 0, 0])
        robot.SetLinkTransformations([EYE] * 5 + [SHEAR])
        robot.SetLinkTransformations([EYE] * 6, [0])
        robot.SetConfigurationValues([0.5] * 4 + [nan] * 7)
        robot.SetConfigurationValues([inf] * 4 + [1, 0, 0, 0, 1, 2, 3])
        link.SetTransform(SHEAR)
        link.SetVelocity([1, 2, 3], [1, 2])
        link.SetMass("x")
        link.SetMass(nan)
        link.SetPrincipalMomentsOfInertia([1, 2])
        link.SetLocalMassFrame(SHEAR)
        link.SetForce([1, 2], [0, 0, 0], True)
        link.SetTorque([1], True)
        link.SetGroupGeometries("x", [1])
        link.SetGeometriesFromGroup("nosuch")
        geometry.SetDiffuseColor([1, 2])
        geometry.SetAmbientColor("red")
        geometry.SetTransparency(nan)
        joint.SetAccelerationLimits([nan])
        joint.SetResolution("x")
        robot.GetChain(0, 99)
        robot.GetChain(-1, 0)
        robot.DoesAffect(9, 0)
        robot.DoesAffect(0, -1)
        robot.ComputeJacobianTranslation(99, [0, 0, 0])
        robot.ComputeJacobianTranslation(-1, [0, 0, 0])
        robot.ComputeJacobianTranslation("hand", [0, 0, 0])
        robot.ComputeHessianAxisAngle(None)
        robot.CalculateRotationJacobian(1, [1, 0, 0])
        robot.ComputeInverseDynamics(None, {99: [0] * 6})
        robot.ComputeInverseDynamics(None, {1: [0] * 5})
        robot.ComputeInverseDynamics(None, [1])
        robot.SetActiveDOFs([9])
        robot.SetActiveDOFs([-1])
        robot.SetActiveDOFs(["x"])
        robot.SetActiveDOFs([0], DOFAffine.RotationAxis, [0, 0, 0])
        robot.SetActiveDOFs([0], DOFAffine.RotationAxis, [0, 0])
        robot.SetActiveDOFValues([1])
        robot.SetActiveDOFValues([1, inf, 1])
        robot.SetActiveDOFValues([1, 1, inf])
        robot.SetActiveDOFVelocities([1])
        robot.SetAffineTranslationLimits([0, 0], [1, 1, 1])
        robot.SetActiveManipulator("leg")
        robot.SetActiveManipulator(7)
        robot.SetActiveManipulator(twin.GetManipulators()[1])
        robot.AddManipulator(None)
        robot.AddManipulator(arm.GetInfo())
        arm.SetLocalToolTransform(SHEAR)
        arm.SetLocalToolDirection([0, 0, 0])
        arm.SetChuckingDirection([1, 2])
        controller.SetDesired([1])
        controller.SetDesired([1, 2, 3, nan])
        controller.SetDesired([0, 0, 0, 0], SHEAR)
        controller.SetPath(3)
        controller.SendCommand(None)
        robot.SetController(3)
        robot.SetController(twin.GetController())
        robot.Grab(link)
        robot.Grab(robot)
        robot.Grab(twin)
        robot.Grab(table, twin.GetLinks()[0])
        robot.Grab(table, link, ["nosuch"], None)
        robot.Grab(table, link, [99], None)
        mug.Grab(robot, mug.GetLinks()[0])
        robot.Release(None)
        robot.IsGrabbing(None)
        robot.ResetGrabbed([1])
        mug.Clone(None)
        loose.Clone(3)
        loose.InitFromTrimesh(None)
        loose.InitFromGeometries([3])
        loose.Init([3], [])
        env.Add(None)
        env.Add(3)
        env.Add(link)
        env.Add(twin)
        env.AddKinBody(None)
        env.AddRobot(3)
        env.AddModule(None, "")
        env.Remove(twin)
        env.Load(None)
        env.LoadData(3)
        env.ReadKinBodyURI(None)
        env.Clone(None)
        env.Clone(robot)
        env.CheckCollision()
        env.CheckCollision(3)
        env.CheckCollision(twin)
        env.CheckCollision(twin.GetLinks()[0])
        env.CheckCollision(robot, twin)
        env.CheckCollision(link, twin.GetLinks()[0])
        env.CheckCollision(robot, [3], [])
        env.CheckCollision(robot, report=3)
        env.CheckCollisionRays([[1, 2, 3]])
        env.CheckCollisionRays([[1, 2, 3, 4, 5, 6]], body=3)
        robot.CheckSelfCollision(3)
        env.SetCollisionChecker(3)
        env.SetCollisionChecker(other.GetCollisionChecker())
        env.SetPhysicsEngine(3)
        env.SetPhysicsEngine(other.GetPhysicsEngine())
        env.GetPhysicsEngine().SetGravity([1, 2, nan])
        env.StartSimulation(-1)
        env.StepSimulation(nan)
        env.plot3([], 1)
        env.Triangulate(3)
        env.render(camera=SHEAR)
        CollisionOptionsStateSaver(None, 1)
        RobotStateSaver(None)
        robot.CreateKinBodyStateSaver().Restore(table)
        robot.CreateKinBodyStateSaver().Restore(3)
        RaveCreateKinBody(None, "")
        RaveCreateRobot(robot, "")
        RaveCreateTrajectory(None, "")
        RaveCreateController(None, "IdealController")
        RaveCreateMultiController(None)
        RaveCreateCollisionChecker(None, "ode")
        RaveCreatePhysicsEngine(3, "ode")
        RaveCreateModule(env, None)
        RaveGetEnvironmentId(None)
        trajectory.Init(None)
        trajectory.Init(3)
        trajectory.Insert(0, [0] * 3)
        trajectory.Insert(0, "x")
        trajectory.deserialize("x")
        trajectory.deserialize(3)
        trajectory.GetConfigurationSpecification().AddGroup(None, 1, "")
        IkParameterization([1, 2, 3], IkParameterizationType.Ray4D)
        ConfigurationSpecification(3)
        """,
    "Failed": """
        robot.SetTransformWithDOFValues(EYE, [0, 0])
        joint.SetLimits([0], [1, 2])
        joint.SetLimits([0, 1], [1, 2])
        joint.SetVelocityLimits([1, 2])
        robot.SetDOFLimits([1], [2])
        robot.SetDOFLimits([1, 1, 1, 1], [2])
        robot.SetDOFVelocityLimits([1])
        robot.SetDOFWeights([1])
        robot.SetLinkTransformations([EYE])
        controller.SetPath(None)
        geometry.GetContainerBottom()
        robot.Grab(None)
        env.Remove(None)
        loose.InitFromBoxes([[0] * 5])
        loose.InitFromSpheres([[0] * 3])
        env.SetPhysicsEngine("nosuch")
        trajectory.LoadFromFile("nosuch")
        """,
    "Assert": """
        robot.SetLinkEnableStates([True])
        robot.SetDOFLimits([1, 1], [2], [0, 1])
        joint.SetWeights([0])
        robot.SetAdjacentLinks(-1, 0)
        robot.SetDOFTorques([1], True)
        robot.SetDOFTorques([nan] * 4, True)
        robot.SetConfigurationValues([1])
        robot.SubtractDOFValues([1], [2])
        robot.SetName("")
        robot.SetName(None)
        env.CheckCollision(None)
        controller.SetPath(RaveCreateTrajectory(env, ""))
        trajectory.GetWaypoint(9)
        trajectory.GetWaypoint(-9)
        trajectory.GetWaypoints(0, 9)
        trajectory.Remove(0, 9)
        trajectory.Sample(-1)
        RaveCreateTrajectory(env, "").Sample(0)
        """,
    "IndexError": """
        robot.ComputeInverseDynamics([1])
        robot.GetLinkAccelerations([1])
        robot.SetDOFValues([1, 2], [0, 7])
        robot.SetDOFValues([1, 2], [0, -1])
        robot.GetDOFValues([-1])
        robot.SetDOFVelocities([1], 0, [9])
        robot.SetDOFLimits([1], [2], [9])
        robot.SetDOFLimits([0], [1], [-1])
        robot.GetJointFromDOFIndex(-1)
        robot.GetLinks([-1])
        robot.GetJoints([9])
        joint.GetAxis(-1)
        robot.SetController(RaveCreateController(env, "IdealController"), [9], 0)
        env.GetPhysicsEngine().SetGravity([1, 2])
        """,
    "BodyNameConflict": """
        robot.SetName("mug")
        env.LoadData("<KinBody name='table'><Body name='b'/></KinBody>")
        env.Add(namesake)
        """,
    "NotInitialized": """
        loose.Grab(robot, loose.GetLinks()[0])
        loose.GetDOFValues()
        loose.SetDOFValues([])
        loose.ComputeInverseDynamics(None)
        gone.SetDOFValues([0] * 4)
        gone.GetActiveDOFValues()
        gone.Grab(mug)
        gone.GetController().SetDesired([0] * 4)
        gone.GetJoints()[0].GetValues()
        """,
    "InvalidState": """
        env.ReadRobotURI(robot, "arm.robot.xml")
        env.Clone(dead)
        dead.Load("room.env.xml")
        dead.LoadData("<KinBody name='a'><Body name='b'/></KinBody>")
        dead.Add(gone)
        dead.CheckCollision(gone)
        dead.StartSimulation(0.01)
        dead.StepSimulation(0.01)
        dead.SetViewer("qtcoin")
        dead.SetPhysicsEngine("ode")
        dead.SetCollisionChecker(None)
        dead.ReadKinBodyURI("mug.kinbody.xml")
        dead.Clone(env)
        dead.CloneSelf()
        dead.render()
        """,
    "CommandNotSupported": """
        controller.SendCommand("dance")
        env.GetCollisionChecker().SendCommand("dance now")
        """,
    "EnvironmentNotLocked": "env.Unlock()",
}
"""Calls with wrong input, by the code of the ``openrave_exception`` that they raise, or by another exception."""

NOTHING = """
    None is env.GetKinBody(None)
    None is env.GetKinBody("nosuch")
    None is env.GetRobot("mug")
    [] == env.GetRobots("nosuch")
    None is env.GetBodyFromEnvironmentBodyIndex(-1)
    None is env.ReadKinBodyURI("nosuch")
    None is env.ReadRobotData("")
    False is env.Load("nosuch")
    False is env.Load("")
    False is env.LoadData("")
    False is env.Remove(loose)
    None is env.Clone(env)
    False is env.GetCollisionChecker().SetCollisionOptions(-1)
    None is robot.GetLink("nosuch")
    None is robot.GetJoint("nosuch")
    -1 == robot.GetJointIndex("nosuch")
    None is robot.GetManipulator("nosuch")
    [] == robot.GetManipulators("nosuch")
    False is robot.RemoveManipulator(None)
    None is robot.Release(table)
    0 == len(robot.GetDOFValues([]))
    -1 == link.GetGroupNumGeometries("nosuch")
    None is RaveCreateController(env, "nosuch")
    None is RaveGetEnvironment(-1)
    [] == dead.GetBodies()
    None is dead.Destroy()
    None is dead.plot3([0, 0, 0], 1)
    """
"""Calls with names that nobody has, and what they return; nothing changes by them either."""


def lines(text: str) -> list[str]:
    return [line.strip() for line in text.strip().splitlines()]


def world(**more: object) -> SimpleNamespace:
    """A room with a robot that holds a mug, in the middle of something."""
    env = ravemj.Environment()
    env.StopSimulation()
    assert env.Load(FOLDER / "room.env.xml")
    robot, mug = env.GetRobot("arm"), env.GetKinBody("mug")
    robot.SetDOFValues([0.1, 0.2, 0.3, 0.04])
    robot.SetDOFVelocities([0.1, 0.2, 0.3, 0.01])
    robot.SetActiveDOFs([1, 0], ravemj.DOFAffine.X)
    robot.Grab(mug)
    return SimpleNamespace(env=env, robot=robot, mug=mug, **more)


@pytest.fixture
def names(monkeypatch):
    """What the calls speak of."""
    monkeypatch.chdir(FOLDER)
    here, there, dead = world(), world(), world()
    dead.env.Destroy()
    loose, namesake = (here.env.ReadKinBodyURI("mug.kinbody.xml") for _ in range(2))
    loose.SetName("loose")
    trajectory = ravemj.RaveCreateTrajectory(here.env, "")
    spec = here.robot.GetActiveConfigurationSpecification("linear")
    spec.AddDeltaTimeGroup()
    trajectory.Init(spec)
    trajectory.Insert(0, [0, 0, 0, 0, 0.1, 0.2, 0.3, 1])
    link = here.robot.GetLinks()[1]
    return {
        **{name: getattr(ravemj, name) for name in ravemj.__all__},
        **vars(here),
        **{"table": here.env.GetKinBody("table"), "link": link, "geometry": link.GetGeometries()[0]},
        **{"joint": here.robot.GetJoints()[0], "arm": here.robot.GetActiveManipulator()},
        **{"controller": here.robot.GetController(), "trajectory": trajectory, "loose": loose, "namesake": namesake},
        **{"other": there.env, "twin": there.robot, "dead": dead.env, "gone": dead.robot},
        **{"nan": np.nan, "inf": np.inf, "EYE": np.eye(4), "SHEAR": SHEAR, "MIRROR": MIRROR},
    }


def state(names) -> list[object]:
    """All that a call could have changed."""
    env, trajectory = names["env"], names["trajectory"]
    found: list[object] = [
        env.IsSimulationRunning(),
        env.GetViewer(),
        env.GetCollisionChecker(),
        env.GetSimulationTime(),
    ]
    found += [
        env.GetPhysicsEngine(),
        *env.GetPhysicsEngine().GetGravity(),
        env.GetCollisionChecker().GetCollisionOptions(),
    ]
    found += [trajectory.serialize(), names["loose"].GetName(), len(names["loose"].GetLinks())]
    for body in env.GetBodies():
        found += [body.GetName(), *body.GetDOFValues(), *body.GetDOFVelocities(), *np.ravel(body.GetDOFLimits())]
        found += [*np.ravel(body.GetLinkTransformations()), *np.ravel(body.GetLinkVelocities()), *body.GetDOFWeights()]
        found += [*body.GetDOFVelocityLimits(), *body.GetDOFAccelerationLimits(), *body.GetDOFTorqueLimits()]
        found += [
            *body.GetDOFResolutions(),
            [held.GetName() for held in body.GetGrabbed()],
            len(body.GetAdjacentLinks()),
        ]
        found.append(body.GetKinematicsGeometryHash())
        for link in body.GetLinks():
            found += [link.IsEnabled(), link.IsStatic(), link.GetMass(), *np.ravel(link.GetLocalMassFrame())]
            for geometry in link.GetGeometries():
                found += [*geometry.GetDiffuseColor(), *geometry.GetAmbientColor(), geometry.GetTransparency()]
    robot = names["robot"]
    found += [robot.GetActiveManipulator(), robot.GetController(), *robot.GetActiveDOFIndices(), robot.GetActiveDOF()]
    found += [*np.ravel(robot.GetActiveDOFLimits()), len(robot.GetManipulators())]
    for arm in robot.GetManipulators():
        found += [*np.ravel(arm.GetLocalToolTransform()), *arm.GetLocalToolDirection(), *arm.GetChuckingDirection()]
    return found


PYTHONS_OWN = {"IndexError": IndexError, "ValueError": ValueError}


@pytest.mark.parametrize(
    ("call", "code"),
    [
        pytest.param(call, code, marks=[pytest.mark.stress] * (place % 3 > 0))
        for code, text in CALLS.items()
        for place, call in enumerate(lines(text))
    ],
    ids=str,
)
def test_wrong_input_raises_and_changes_nothing(names, call, code):
    before = state(names)
    kind = PYTHONS_OWN.get(code, ravemj.openrave_exception)
    with pytest.raises(kind) as caught:
        eval(call, names)
    if code not in PYTHONS_OWN:
        assert caught.value.GetCode() == code
    assert len(str(caught.value)) > 15
    assert state(names) == before


@pytest.mark.parametrize("call", lines(NOTHING))
def test_what_is_not_there_is_no_error(names, call):
    before = state(names)
    assert eval(call, names)
    assert state(names) == before


def test_the_state_shows_what_changes(names):
    changes = (
        "robot.SetDOFValues([0.2], [0])",
        "robot.SetDOFVelocities([0.2], 0, [0])",
        "robot.Release(mug)",
        "robot.SetDOFLimits([-1] * 4, [1] * 4)",
        "link.SetMass(7)",
        "robot.SetActiveDOFs([0])",
        "link.Enable(False)",
        "trajectory.Remove(0, 1)",
        "env.SetCollisionChecker(None)",
        "robot.SetController(None)",
        "geometry.SetTransparency(0.5)",
        "arm.SetLocalToolDirection([0, 1, 0])",
        "env.Remove(table)",
    )
    before = state(names)
    for call in changes:
        eval(call, names)
        assert state(names) != before, call
        before = state(names)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        ("robot.SetDOFValues([1])", r"values.*\(1,\).*4"),
        ("robot.SetDOFValues([1], [9])", r"\[9\].*0 to 3"),
        ("robot.SetTransform([1, 2])", r"SetTransform: transform.*\(2,\).*\(4, 4\)"),
        ("robot.Grab(None)", "Grab: body is None|Grab: body: is None"),
        ("env.Add(twin)", "'arm' was made for"),
        ("robot.SetActiveManipulator('leg')", "leg.*gripper, elbow"),
        ("robot.ComputeJacobianTranslation(9, [0, 0, 0])", "linkindex.*9.*0 to 5"),
        ("robot.ComputeJacobianTranslation(1, [0, 0, 0], 'abc')", "indices.*abc"),
        ("robot.ComputeJacobianAxisAngle(1, [0.5])", "indices.*0.5"),
        ("robot.ComputeHessianTranslation(1, [0, 0, 0], (i for i in [0, 1]))", "indices.*generator"),
        ("robot.ComputeInverseDynamics((a for a in [0] * 4))", "dofaccelerations.*generator"),
        ("robot.ComputeInverseDynamics([1])", "dofaccelerations.*1 for 4"),
        ("robot.ComputeInverseDynamics([0] * 4, SHEAR)", "externalforcetorque.*dictionary"),
        ("robot.GetLinkAccelerations([[1], [1, 2]])", "dofaccelerations"),
        ("robot.GetJointFromDOFIndex([0, 1])", r"dofindex.*\[0, 1\].*one number"),
        ("robot.IsDOFRevolute(None)", r"dofindex.*\[\].*one number"),
        ("robot.SetName(1.5)", "name.*float.*text"),
        ("robot.SetSelfCollisionChecker('ode')", "collisionchecker.*str.*CollisionChecker"),
        ("robot.CheckSelfCollision([])", "report.*list"),
        ("arm.CheckEndEffectorCollision(EYE, [1])", "report.*list"),
        ("dead.Load('x')", "destroyed"),
    ],
)
def test_messages_name_the_argument_and_what_was_expected(names, call, words):
    with pytest.raises((ravemj.openrave_exception, IndexError, ValueError)) as caught:
        eval(call, names)
    assert re.search(words, str(caught.value))

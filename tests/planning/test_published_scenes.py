"""Plans in published scenes that OpenRAVE's own tests and examples ask for."""

import numpy as np
import pytest
from agreement import CORPUS, NEEDS_THE_CORPUS
from conftest import one_in

import ravemj

pytestmark = [
    *NEEDS_THE_CORPUS,
    pytest.mark.corpus,
    pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning"),
]
SOURCES = CORPUS / "models" / "rdiankov+openrave" / "src"


@pytest.fixture
def load(monkeypatch):
    monkeypatch.setenv("OPENRAVE_DATA", str(SOURCES))

    def loaded(name):
        env = ravemj.Environment()
        env.Load(str(SOURCES / "data" / name))
        return env, env.GetRobots()[0]

    return loaded


@pytest.fixture
def puma_with_disk(load):
    """Return a PUMA that holds a disk on a peg, with OpenRAVE's weights and resolutions, and a goal of its tool."""
    env, robot = load("hanoi_complex2.env.xml")
    kind = ravemj.IkParameterization.Type.Transform6D
    ravemj.databases.inversekinematics.InverseKinematicsModel(robot, iktype=kind).load()
    resolutions = [0.00292825, 0.00303916, 0.01520142, 0.0163279, 0.03591959, 0.03591959, 0.08129367]
    weights = [1.61903856, 1.11858069, 0.20061367, 0.15267405, 0.05951496, 0.04199751, 0.01950391]
    for joint, resolution, weight in zip(robot.GetJoints(), resolutions, weights, strict=True):
        joint.SetWeights([weight])
        joint.SetResolution(resolution)
    pose = np.eye(4)
    pose[:3] = [
        [-0.9152146, 0.40084098, -0.04133701, -0.21687754],
        [-0.39826911, -0.88415551, 0.24423505, -0.19242871],
        [0.06135107, 0.23999073, 0.96883461, 1.12189841],
    ]
    env.GetKinBody("disk2").SetTransform(pose)
    robot.SetDOFValues([0.4620151, -2.67934022, 0.29334635, -1.45878047, -1.2220377, -1.83725485, -0.25900999])
    robot.Grab(env.GetKinBody("disk1"))
    goal = np.eye(4)
    goal[:3] = [
        [-0.7912808, 0.25088882, 0.55761053, -0.1646556],
        [-0.3734526, 0.52379002, -0.76562208, 0.02972558],
        [-0.48415685, -0.81406315, -0.32076991, 1.38703197],
    ]
    return env, robot, goal


@pytest.mark.parametrize("steplength", one_in(2, [0.1, None]))
def test_a_disk_is_lifted_off_its_peg(puma_with_disk, steplength):
    env, robot, goal = puma_with_disk
    helper = ravemj.interfaces.BaseManipulation(robot)
    found = helper.MoveToHandPosition(matrices=[goal], steplength=steplength, execute=False, outputtrajobj=True)
    robot.SetActiveDOFs(robot.GetActiveManipulator().GetArmIndices())
    last = found.GetWaypoint(-1, robot.GetActiveConfigurationSpecification())
    robot.SetActiveDOFValues(last)
    assert robot.GetActiveManipulator().GetTransform() == pytest.approx(goal, abs=1e-4)
    assert not env.CheckCollision(robot)


@pytest.mark.stress
def test_a_pr2_drives_through_a_door(load):
    env, robot = load("pr2test2.env.xml")
    names = ["shoulder_lift", "elbow_flex", "wrist_flex"]
    arms = [robot.GetJoint(f"{side}_{name}_joint").GetDOFIndex() for side in "lr" for name in names]
    robot.SetDOFValues([1.29023451, -2.32099996, -0.69800004, 1.27843491, -2.32100002, -0.69799996], arms)
    parts = ravemj.DOFAffine
    robot.SetActiveDOFs([], parts.X | parts.Y | parts.RotationAxis, [0, 0, 1])
    helper = ravemj.interfaces.BaseManipulation(robot)
    goal = [2.8, -1.3, 0]
    found = helper.MoveActiveJoints(
        goal=goal, maxiter=5000, steplength=0.15, maxtries=2, execute=False, outputtrajobj=True
    )
    spec = robot.GetActiveConfigurationSpecification()
    assert found.GetWaypoint(-1, spec) == pytest.approx(goal)
    for time in np.linspace(0, found.GetDuration() - 0.5, 100):
        robot.SetActiveDOFValues(found.Sample(time, spec))
        assert not env.CheckCollision(robot)

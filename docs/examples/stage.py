"""What the examples share: boxes, and videos in which time passes only while robots move."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import ravemj

Colour = tuple[float, float, float]

WOOD: Colour = (0.72, 0.58, 0.42)
GREEN: Colour = (0.45, 0.6, 0.55)
RED: Colour = (0.8, 0.3, 0.1)
BLUE: Colour = (0.2, 0.4, 0.75)
YELLOW: Colour = (0.9, 0.7, 0.15)


def load_robot(env: ravemj.Environment, model: str, name: str, place: Sequence[float] = (0, 0, 0)) -> ravemj.Robot:
    """Add a robot that comes with ravemj to an environment, under a name and at a place."""
    robot = env.ReadRobotURI(str(ravemj.model_path(model)))
    robot.SetName(name)
    env.Add(robot)
    robot.SetTransform([1, 0, 0, 0, *place])
    return robot


def add_box(
    env: ravemj.Environment, name: str, centre: Sequence[float], half: Sequence[float], colour: Colour
) -> ravemj.KinBody:
    """Add a box: where its centre is, and half of its sides [m]."""
    body = ravemj.RaveCreateKinBody(env, "")
    body.SetName(name)
    body.InitFromBoxes([[0, 0, 0, *half]], True)
    body.SetTransform([1, 0, 0, 0, *centre])
    body.GetLinks()[0].GetGeometries()[0].SetDiffuseColor(colour)
    env.Add(body)
    return body


def solve_poses(arm: ravemj.Manipulator) -> None:
    """Let an arm solve inverse kinematics of poses."""
    kind = ravemj.IkParameterization.Type.Transform6D
    assert ravemj.databases.inversekinematics.InverseKinematicsModel(arm.GetRobot(), kind, manip=arm).load()


@contextmanager
def filmed(env: ravemj.Environment, look_at: Sequence[float], eye: Sequence[float], fps: int = 8) -> Iterator[None]:
    """Write a video of what happens meanwhile: to the file of the command line, else one named like the script."""
    script = Path(sys.argv[0])
    path = sys.argv[1] if len(sys.argv) > 1 else f"{script.stem}.webp"
    env.SetViewer("offscreen")
    env.GetViewer().SetBkgndColor([0.86, 0.9, 0.94])
    env.GetViewer().SetCamera(ravemj.transformLookat(look_at, eye, [0, 0, -1]))
    recorder = ravemj.RaveCreateModule(env, "viewerrecorder")
    env.AddModule(recorder, "")
    env.StopSimulation()  # time passes in wait() alone, so that every run makes the same video
    recorder.SendCommand(f"Start 400 300 {fps} codec 0 timing simtime filename {path}")
    yield
    recorder.SendCommand("Stop")
    print(f"wrote {path}")


def wait(*robots: ravemj.Robot) -> None:
    """Let time pass until robots have arrived."""
    env = robots[0].GetEnv()
    while not all(robot.GetController().IsDone() for robot in robots):
        env.StepSimulation(0.025)

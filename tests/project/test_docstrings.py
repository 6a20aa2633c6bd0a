"""What ``?`` shows teaches: every argument, every answer, shapes; examples that work for what scripts use most."""

import doctest
import inspect
import re

import numpy as np
import pytest
from conftest import REPOSITORY

import ravemj

MOST_USED = """
    Environment Environment.Load KinBody.GetTransform KinBody.SetTransform Environment.SetViewer Robot.SetActiveDOFs
    Environment.CheckCollision Robot.SetActiveDOFValues KinBody.GetName KinBody.GetDOFValues KinBody.SetDOFValues
    Environment.GetRobot KinBody.GetLinks RaveCreateTrajectory Environment.GetRobots Manipulator.GetArmIndices
    KinBody.GetEnv Environment.Add Robot.SetActiveManipulator Trajectory.Insert KinBody.SetName Robot.GetController
    KinBody.GetDOF Trajectory.Init Environment.plot3 KinBody.InitFromBoxes Environment.GetViewer KinBody.GetJoint
    Joint.GetDOFIndex Environment.GetKinBody Environment.Destroy Trajectory.GetNumWaypoints Robot.GetActiveDOFValues
    Trajectory.GetWaypoint KinBody.CheckSelfCollision RaveCreateKinBody Link.GetGeometries IdealController.SetPath
    Robot.GetActiveManipulator KinBody.GetLink KinBody.GetDOFLimits KinBody.ComputeAABB Environment.Remove
    Environment.GetBodies
"""
"""Of the names that old scripts use, those in most repositories."""

SHAPED = r"\(\d|\(dof|\(axes|\(n\b|\(k\b|\(m\b|\(height|shape|indices|\*"


def public_members() -> dict[str, object]:
    """Functions, methods and properties that users meet."""
    found: dict[str, object] = {}
    for name in ravemj.__all__:
        thing = getattr(ravemj, name)
        if inspect.isfunction(thing):
            found[name] = thing
        elif inspect.isclass(thing) and thing.__module__.startswith("ravemj") and not issubclass(thing, BaseException):
            members = {word: inspect.getattr_static(thing, word) for word in dir(thing) if word[0] != "_"}
            found |= {f"{name}.{word}": member for word, member in members.items()}
    plain = {name: getattr(member, "__func__", member) for name, member in found.items()}
    functions = {name: getattr(member, "fget", member) for name, member in plain.items()}
    once = {id(function): name for name, function in reversed(functions.items()) if _is_ours(function)}
    return {name: plain[name] for name in reversed(once.values())}


def _is_ours(member: object) -> bool:
    return inspect.isfunction(member) and member.__module__.startswith("ravemj")


MEMBERS = public_members()


def taught(name: str) -> str:
    thing: object = ravemj
    for word in name.split("."):
        thing = getattr(thing, word)
    return inspect.getdoc(thing) or ""


def test_there_is_much_to_teach():
    assert len(MEMBERS) > 700


@pytest.mark.parametrize("name", MEMBERS)
def test_docstrings_explain_arguments_and_answers(name):
    member = MEMBERS[name]
    doc = inspect.getdoc(member) or ""
    summary = doc.partition("\n")[0]
    assert summary.endswith((".", ":")), f"has no summary: {summary!r}"
    assert len(summary) > 10
    if isinstance(member, property):
        return
    signature = inspect.signature(member)
    for argument in signature.parameters.values():
        if argument.name not in {"self", "cls"} and argument.kind not in {
            argument.VAR_KEYWORD,
            argument.VAR_POSITIONAL,
        }:
            assert re.search(rf"\b{argument.name}\b", doc), f"does not explain {argument.name}"
    answer = str(signature.return_annotation)
    if answer not in {"None", str(inspect.Signature.empty)}:
        assert re.search(r"Returns?:|\breturns?\b", doc, re.IGNORECASE), "does not say what it returns"
    if "ndarray" in answer and "float" in answer and "dict" not in answer:
        assert re.search(SHAPED, doc), "does not say the shape of what it returns"


@pytest.fixture
def names(monkeypatch):
    """What examples name: the tutorial's pendulum with a manipulator, and a trajectory of it."""
    monkeypatch.chdir(REPOSITORY)
    env = ravemj.load("models/env.xml")
    robot = env.GetRobots()[0]
    arm = ravemj.Robot.ManipulatorInfo(_name="arm", _sBaseLinkName="Base", _sEffectorLinkName="Arm1")
    manipulator = robot.AddManipulator(arm)
    robot.SetActiveManipulator("arm")
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    spec = robot.GetActiveConfigurationSpecification("linear")
    spec.AddDeltaTimeGroup()
    trajectory.Init(spec)
    trajectory.Insert(0, [0, 0, 0, 0.1, 0.2, 0.05])
    yield {
        **{"env": env, "robot": robot, "body": robot, "manip": manipulator, "trajectory": trajectory, "np": np},
        **{"ravemj": ravemj, **{name: getattr(ravemj, name) for name in ravemj.__all__}},
    }
    ravemj.RaveDestroy()


@pytest.mark.parametrize("name", MOST_USED.split())
def test_examples_of_the_most_used_names_work(name, names):
    doc = taught(name)
    assert ">>>" in doc
    examples = doctest.DocTestParser().get_doctest(doc, names, name, None, None)
    told: list[str] = []
    doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE).run(examples, out=told.append)
    assert not told, "".join(told)

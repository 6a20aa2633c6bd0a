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


def unexplained(member: object) -> list[str]:
    """Return what the docstring of a function leaves open; ruff checks its form."""
    doc = inspect.getdoc(member) or ""
    signature = inspect.signature(member)
    variadic = {inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL}
    arguments = {name for name, argument in signature.parameters.items() if argument.kind not in variadic}
    found = [name for name in sorted(arguments - {"self", "cls"}) if not re.search(rf"\b{name}\b", doc)]
    answer = str(signature.return_annotation)
    if answer not in {"None", str(inspect.Signature.empty)} and not re.search(r"\breturns?\b", doc, re.IGNORECASE):
        found.append("what it returns")
    if "Floats" in answer and "dict" not in answer and not re.search(SHAPED, doc):
        found.append("the shape of what it returns")
    return found


def test_docstrings_explain_arguments_and_answers():
    assert len(MEMBERS) > 700
    functions = {name: member for name, member in MEMBERS.items() if not isinstance(member, property)}
    open_ends = {name: unexplained(member) for name, member in functions.items()}
    assert not {name: what for name, what in open_ends.items() if what}


def test_a_docstring_that_leaves_something_open_is_found():
    def move(distance: float) -> "Floats":  # noqa: F821 - as sources write it
        """Move on."""

    assert unexplained(move) == ["distance", "what it returns", "the shape of what it returns"]


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

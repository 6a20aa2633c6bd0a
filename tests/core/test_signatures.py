"""What ``?`` and ``help`` show of a call: the types as the source writes them."""

import inspect
import pydoc

import pytest
from IPython.core.oinspect import Inspector

import ravemj
from ravemj.core.signatures import show_as_written

EXPANDED = ("numpy.", "_ArrayLike", "_array_like", "Union[", "ravemj.", "collections.abc")


def shown(thing) -> str:
    return str(inspect.signature(thing)).replace("typing.", "")


@pytest.mark.parametrize(
    ("thing", "expected"),
    [
        (
            ravemj.Robot.SetDOFValues,
            "(self, values: ArrayLike, dofindices: ArrayLike | EllipsisType | None = Ellipsis, "
            "checklimits: int = <CheckLimitsAction.CheckLimits: 1>) -> None",
        ),
        (
            ravemj.Robot.GetDOFLimits,
            "(self, indices: ArrayLike | EllipsisType | None = Ellipsis) -> tuple[Floats, Floats]",
        ),
        (
            ravemj.load,
            "(path: str | os.PathLike[str], atts: Mapping[str, str] | None = None, *, "
            "into: Environment | None = None) -> Environment",
        ),
        (ravemj.matrixFromQuat, "(quat: ArrayLike) -> Floats"),
        (ravemj.Motion, "(times: ArrayLike, values: ArrayLike) -> None"),
        (ravemj.Motion.line, "(start: ArrayLike, goal: ArrayLike, duration: float = 1.0) -> Motion"),
        (
            ravemj.read_motion,
            "(path: str | os.PathLike[str], joint_names: Sequence[str], current: ArrayLike) -> Motion",
        ),
        (ravemj.KinBody.JointInfo.DeserializeJSON, None),
        (ravemj.planningutils.RetimeTrajectory, None),
        (ravemj.databases.inversekinematics.InverseKinematicsModel, None),
        (ravemj.interfaces.BaseManipulation.MoveManipulator, None),
        (ravemj.record, None),
    ],
)
def test_annotations_are_those_of_the_source(thing, expected):
    text = shown(thing)
    assert expected is None or text == expected
    assert not any(part in text for part in EXPANDED)


def test_bound_methods_lose_their_object_and_further_names_have_the_type_of_theirs():
    env = ravemj.load(ravemj.model_path("pendulum"))
    robot = env.GetRobots()[0]
    assert shown(robot.SetTransform).startswith("(transform: ArrayLike")
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    assert shown(trajectory.Init) == "(spec: Spec, *, group: Spec = Ellipsis) -> None"
    assert "(values: ArrayLike, dofindices:" in pydoc.plain(pydoc.render_doc(robot.SetDOFValues))
    text = Inspector(theme_name="nocolor").info(robot.SetDOFValues, "robot.SetDOFValues")["definition"]
    assert "values: ArrayLike," in text
    inspect.signature(robot.SetDOFValues).bind([1, 2], checklimits=0)


def test_fields_of_infos_are_the_arguments_of_their_constructors():
    text = shown(ravemj.KinBody.JointInfo)
    assert "_vaxes: Sequence[ArrayLike] = <factory>" in text
    assert "_infoElectricMotor: ElectricMotorActuatorInfo | None = None" in text


@pytest.mark.parametrize("name", ["KinBody", "Robot", "Environment", "Trajectory", "Manipulator", "Viewer"])
def test_no_public_method_shows_what_numpys_types_stand_for(name):
    kind = getattr(ravemj, name)
    for method in dir(kind):
        found = inspect.getattr_static(kind, method)
        for _ in range(
            2 if method[0] != "_" and inspect.isfunction(found) else 0
        ):  # the second look is at what is kept
            text = shown(found)
            assert not any(part in text for part in EXPANDED), f"{name}.{method}{text}"


def test_what_has_no_source_keeps_its_signature():
    space: dict[str, object] = {}
    exec("def given(values: float = 1.0) -> int: ...", space)
    show_as_written(space["given"])
    assert shown(space["given"]) == "(values: float = 1.0) -> int"
    show_as_written(len)

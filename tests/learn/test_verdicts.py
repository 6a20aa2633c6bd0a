"""Verdicts on students' files: what is accepted, and what is said."""

import warnings

import numpy as np
import pytest

import ravemj
from ravemj.learn import Check
from ravemj.learn.check import precision, shortened
from ravemj.learn.child import check_file

HINTS = ("Look.", "Think.", "Write it.")


def check(answer, question=lambda random: (random.uniform(1, 2, 2),), **others):
    return Check("solve", question, answer, HINTS, **others)


def roots(x):
    """Both square roots of each of two numbers; none if the first one is the larger one."""
    return np.array([np.sqrt(x), -np.sqrt(x)]) if x[0] < x[1] else np.array([])


def judge(given, x):
    return None if all(np.allclose(row**2, x) for row in given) else "a row is no root"


@pytest.fixture
def verdict(tmp_path):
    def check_text(body, check, name="solve.py"):
        path = tmp_path / name
        path.write_text(body if name.endswith("xml") else f"import numpy as np\n\ndef solve(x):\n    {body}\n", "utf-8")
        return check_file(path, check, 0)

    return check_text


class TestListsOfSolutions:
    check = check(
        roots,
        judge=judge,
        kind="joint values",
        mistakes={"One of two.": lambda x: roots(x)[:1], "The exponent is wrong.": lambda x: roots(x) ** 3},
    )

    @pytest.mark.parametrize("none", ["[]", "()", "np.zeros((0, 2))"])
    def test_an_empty_list_may_have_any_form(self, verdict, none):
        body = f"return [-np.sqrt(x), np.sqrt(x)] if x[0] < x[1] else {none}"
        assert verdict(body, self.check).status == "solved"

    def test_solutions_where_there_are_none_are_wrong(self, verdict):
        result = verdict("return [-np.sqrt(x), np.sqrt(x)]", self.check)
        assert result.status == "wrong"
        assert result.message == "it returns an array of shape (2, 2), and should return an empty list"

    @pytest.mark.parametrize("rows", ["[-np.sqrt(x) ** 3, np.sqrt(x) ** 3]", "[np.sqrt(x) ** 3, -np.sqrt(x) ** 3]"])
    def test_mistakes_are_recognized_in_any_order_of_rows(self, verdict, rows):
        result = verdict(f"return {rows} if x[0] < x[1] else []", self.check)
        assert (result.status, result.mistake) == ("wrong", "The exponent is wrong.")

    def test_without_a_judge_the_order_of_rows_counts(self, verdict):
        ordered = check(lambda x: np.array([x, 2 * x]), kind="joint values")
        assert verdict("return [x, 2 * x]", ordered).status == "solved"
        assert verdict("return [2 * x, x]", ordered).status == "wrong"

    def test_a_judge_sees_single_precision(self, verdict):
        strict = check(
            lambda x: x, judge=lambda given, x: None if np.abs(given - x).max() < precision(given) else "off"
        )
        assert verdict("return x.astype(np.float32) + np.float32(5e-5)", strict).status == "solved"
        assert verdict("return x + 5e-5", strict).message == "off"

    def test_nan_is_named_before_the_shape(self, verdict):
        assert "NaN" in verdict("return [[np.nan, np.nan]] * 2", self.check).message


def test_a_truth_value_is_shown_as_one(verdict):
    truth = check(lambda x: x[0] < x[1], kind="boolean")
    result = verdict("return x[0] > x[1]", truth)
    assert result.status == "wrong"
    assert result.message == f"it should be {result.expected}"
    assert {result.yours, result.expected} == {"True", "False"}


def test_a_function_may_change_its_arguments(verdict):
    assert verdict("x *= 2; return x", check(lambda x: 2 * x)).status == "solved"


@pytest.mark.parametrize(
    ("thing", "text"),
    [(None, "None"), (np.True_, "True"), ([[1, 2], [3]], "[[1, 2], [3]]"), ([1j], "[1j]"), ((1, 2), "[1. 2.]")],
)
def test_answers_are_shown_as_they_are(thing, text):
    assert shortened(thing) == text


def test_a_robot_is_shown_by_its_name():
    robot = ravemj.load(ravemj.model_path("pendulum")).GetRobots()[0]
    assert shortened(robot) == "Pendulum"


class TestModels:
    check = Check(
        lambda path: ravemj.load(path).GetRobots()[0].GetDOF, lambda random: (), lambda: 1, HINTS, questions=1
    )

    def test_an_error_of_a_model_names_the_line_alone(self, verdict, tmp_path):
        result = verdict("<Robot>\n  <KinBody>\n</Robot>", self.check, "robot.xml")
        assert result.status == "error"
        assert result.message.startswith(f"{tmp_path / 'robot.xml'}:3: error: ")

    def test_a_question_without_arguments_is_no_call(self, verdict):
        text = '<Robot name="one"><KinBody><Body name="base" type="dynamic"/></KinBody></Robot>'
        result = verdict(text, self.check, "robot.xml")
        assert (result.status, result.tried, result.message) == ("wrong", "", "off by 1")


def test_mistakes_of_robots_give_no_warnings(verdict):
    def wrong(x):
        warnings.warn("a joint is beyond its limits", stacklevel=2)
        return 3 * x

    with warnings.catch_warnings(action="error"):
        assert verdict("return 3 * x", check(lambda x: x, mistakes={"Thrice.": wrong})).mistake == "Thrice."


def test_a_byte_order_mark_is_no_error(tmp_path):
    (tmp_path / "marked.py").write_text("def solve(x):\n    return 3 * x\n", encoding="utf-8-sig")
    assert check_file(tmp_path / "marked.py", check(lambda x: 3 * x), 0).status == "solved"

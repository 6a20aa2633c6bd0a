"""The page about inverse kinematics: its tables say of our models what is so; times and errors are not compared."""

import ik_coverage as made
import pytest
from conftest import one_in

from ravemj.ik import Task, make_solver

PAGE = made.PAGE.read_text(encoding="utf-8")
OURS = {arm.robot: arm for arm in made.our_arms() if arm.chain.dof in made.JOINTS}
MADE_BY = "run python scripts/pages/ik_coverage.py"


def same_everywhere(row):
    return {name: cell for name, cell in row.items() if name not in made.TIMED}


def test_every_arm_of_our_models_has_its_line():
    assert [row["robot"].strip("`") for row in made.cells(PAGE, made.OURS)] == list(OURS), MADE_BY
    assert len(OURS) >= 3


@pytest.mark.parametrize("robot", one_in(4, OURS))
def test_lines_of_our_models(robot):
    row = next(row for row in made.cells(PAGE, made.OURS) if row["robot"] == f"`{robot}`")
    assert same_everywhere(dict(zip(row, made.arm_row(OURS[robot]), strict=True))) == same_everywhere(row), MADE_BY


@pytest.mark.parametrize("task", Task)
def test_every_type_has_two_lines_at_least(task):
    rows = [row for row in made.cells(PAGE, made.TYPES) if row["type of goal"] == f"`{task.value}`"]
    assert len(rows) >= 2
    for row in rows:
        solver = make_solver(OURS[row["robot"].strip("`")].chain, task)
        assert row["solved by"] == made.kind(solver), MADE_BY
        assert row["free"] == ", ".join(f"{joint + 1}" for joint in solver.free), MADE_BY
        assert row["solved"] == "100 %"
        assert row["own values"] == ("100 %" if solver.complete else "")


def test_closed_forms_of_all_arms_find_everything():
    for row in [*made.cells(PAGE, made.OURS), *made.cells(PAGE, made.CORPUS)]:
        assert row["own values"] == "100 %", row
        assert float(row["solved"].split()[0]) >= 99.9, row
        assert float(row["search"].split()[0]) >= 99.9, row


def test_the_words_are_those_of_the_script():
    assert PAGE.startswith(made.HEAD), MADE_BY

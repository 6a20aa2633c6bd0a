"""The second suite of scripts with OpenRAVE's answers: inverse kinematics.

Scripts run and answers are compared as in ``test_api_conformance``.
"""

import os
from pathlib import Path

import pytest
from test_api_conformance import compared

from ravemj.ik import Task

CASES = Path(__file__).parent / "data" / "api-conformance-2"
NAMES = sorted(path.stem for path in CASES.glob("*.py"))

MISTAKES = {
    "ik-10-param-distance": (r"Lookat3D\[0\]", "OpenRAVE leaves out what is along a direction that nobody can set"),
}
"""Other answers that are OpenRAVE's mistakes or accidents: the places in ``result`` that may differ, and why."""

WANTS = {
    "ik-80-direction5d-sets": "TranslationDirection5D",
    "ik-81-direction5d-pose-goal": "TranslationDirection5D",
    "ik-83-direction3d": "Direction3D",
    "ik-84-lookat3d": "Lookat3D",
    "ik-94-random-directions": "TranslationDirection5D",
}
"""Types of goals that cases want to be solved; without them the cases fail."""
NOT_YET = {name for name, kind in WANTS.items() if kind not in {task.value for task in Task}}


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.xfail(reason="not yet", strict=True)] if name in NOT_YET else [])
        for name in NAMES
    ],
)
def test_case(name, tmp_path):
    assert compared(name, tmp_path, CASES, MISTAKES) == []


def test_the_list_names_cases():
    assert len(NAMES) == 66
    assert {*MISTAKES, *WANTS} <= set(NAMES)

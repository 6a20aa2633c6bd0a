"""The second suite of scripts with OpenRAVE's answers: inverse kinematics.

Scripts run and answers are compared as in ``test_api_conformance``.
"""

import os
from pathlib import Path

import pytest
from test_api_conformance import compared

CASES = Path(__file__).parent / "data" / "api-conformance-2"
NAMES = sorted(path.stem for path in CASES.glob("*.py"))

MISTAKES = {
    "ik-10-param-distance": (r"Lookat3D\[0\]", "OpenRAVE leaves out what is along a direction that nobody can set"),
}
"""Other answers that are OpenRAVE's mistakes or accidents: the places in ``result`` that may differ, and why."""

NOT_YET = {
    "ik-80-direction5d-sets",
    "ik-81-direction5d-pose-goal",
    "ik-83-direction3d",
    "ik-84-lookat3d",
    "ik-94-random-directions",
}
"""Cases that want solvers for types of goals which ``ravemj.ik.Task`` does not have yet."""


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
    assert {*MISTAKES, *NOT_YET} <= set(NAMES)

"""Small OpenRAVE XML files, each with what OpenRAVE makes of it."""

import json

import pytest
from agreement import CONFORMANCE, compare

CASES = sorted(path.parent for path in CONFORMANCE.glob("cases/*/expected.json"))


@pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")
@pytest.mark.parametrize("physics", [False, True], ids=["openrave", "physics"])
@pytest.mark.parametrize("folder", CASES, ids=lambda folder: folder.name)
def test_case(folder, physics, caplog):
    """With OpenRAVE's own numbers, and with true Jacobians and torques where OpenRAVE errs."""
    caplog.set_level("CRITICAL")
    expected = json.loads((folder / "expected.json").read_text())
    differences, _ = compare(folder, expected, strict_failures=True, physics=physics)
    assert differences == []


def test_all_cases_are_here():
    assert len(CASES) == 189

"""Scripts that use OpenRAVE's API, each with the answer that OpenRAVE gave.

A script leaves a dictionary ``result``; the file ``.json`` beside it has OpenRAVE's. Each runs in a process of its own,
a fork. Numbers agree at 1e-9, or at the ``TOLERANCE`` that a script sets.

``not-yet.txt`` lists the scripts that do not give OpenRAVE's answer yet; whoever makes one work removes its line. To
write the list anew: ``PYTHONPATH=tests python tests/rave/test_api_conformance.py``.
"""

import functools
import json
import math
import os
import re
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from api_case import plain
from command_line import PACKAGE_ROOT, environment
from conftest import DATA, TESTS
from forks import Forks
from waiting import PATIENCE

CASES = DATA / "api-conformance"
NAMES = sorted(path.stem for path in CASES.glob("*.py"))
LIST = CASES / "not-yet.txt"
NOT_YET = set(LIST.read_text().split())

SLIDER_FORCES = {
    "dynamics-01-gravity-only": r"(zeros|none)\[2\]$",
    "dynamics-02-gravity-changed": r"\[2\]$",
    "dynamics-03-accelerations": r"M\[\d\]\[2\]$",
    "dynamics-05-components": r"\[2\]$",
    "dynamics-08-external-in-components": r"\[2\]$",
    "dynamics-09-moving-base": r"torques\[2\]$",
    "dynamics-22-base-velocity-and-acceleration": r"torques\[2\]$",
}
"""Places with forces of sliders, which OpenRAVE divides by 2 pi and ravemj does not."""

MISTAKES = {
    "data-01-load-return-values": (
        "unknown-root",
        "a file with an unknown root is no model: False is better",
    ),
    "dynamics-03-accelerations": ("symmetric", "with the forces of sliders as they are, the mass matrix is symmetric"),
    "dynamics-11-mimic": (r"b\[0\]", "OpenRAVE leaves out what accelerates the follower"),
    "gap-03-wrong-shapes": (r"manipulator$", "numbers of manipulators are taken here, as in old scripts"),
    "gap-04-arrays-that-are-too-long": (r"a\[4\]", "OpenRAVE leaves out what accelerates the follower"),
    "ik-10-param-distance": (
        r"Lookat3D\[0\]",
        "OpenRAVE leaves out what is along x, turned as the argument was, so (1, 0, 0) and (5, 0, 0) have no distance",
    ),
    "info-23-extract-and-init": ("limits-before-add", "OpenRAVE counts no DOFs of a body that is not added yet"),
    "world-14-rave-environment-ids": ("destroyed|number", "OpenRAVE goes on listing environments that are destroyed"),
    "gap-18-unnamed-bodies": ("anonymous", "see REPLACED"),
    "name-30-mimic-equations": ("atan2", "OpenRAVE's atan2 is wrong in the third digit"),
    "name-36-spec-of-trajectory-file": (
        "returns_self",
        "deserialize returns the trajectory, since OpenRAVE's own repr of one takes what it returns",
    ),
    "ray-11-inside-start": ("", "what ODE says about rays that start inside a body differs from shape to shape"),
}
"""Other answers that are OpenRAVE's mistakes or accidents: the places in ``result`` that may differ, and why."""

REPLACED = {"gap-18-unnamed-bodies": ("env.Add(b, True))\nresult['after']", "env.Add(b))\nresult['after']")}
"""A call of a script and what stands in its place: where two truths exclude each other, all the rest is compared.

OpenRAVE 0.149 refuses a body without a name, whatever ``anonymous`` is. pymanoid, written for OpenRAVE 0.9, makes just
these calls (``RaveCreateKinBody(env, "")``, ``InitFromBoxes``, ``Add(box, True)``) for each of its boxes and would end
there, so ravemj gives the body a name (``test_pymanoid``); no rule on the arguments tells the two apart.
"""


def run_case(name: str, folder: Path, cases: Path = CASES) -> dict[str, object]:
    """Run a script in a process of its own; return its ``result`` or ``error``."""
    with tempfile.TemporaryDirectory() as scratch:
        answer = Path(scratch) / "answer.json"
        words = [str(cases / f"{name}.py"), str(answer), *REPLACED.get(name, ())]
        done = _forks().run("api_case", words, folder, environment(folder))
        return json.loads(answer.read_text()) if answer.exists() else {"error": done.stderr or "no answer"}


@functools.cache
def _forks() -> Forks:
    """Forks of a process without threads or environments of other tests: what these held may hang a fork."""
    path = os.pathsep.join([str(TESTS), str(PACKAGE_ROOT)])
    return Forks(
        environment(PACKAGE_ROOT, PYTHONPATH=path),
        PATIENCE,
        [
            "api_case",
            "ravemj.compat.convexdecompositionpy",
            "ravemj.compat.examples",
            "ravemj.compat.metaclass",
            "ravemj.compat.openravepy",
            "ravemj.compat.openravepy_configurationcache",
            "ravemj.compat.openravepy_ext",
            "ravemj.compat.openravepy_int",
            "ravemj.compat.pyANN",
            "ravemj.formats.meshes.files",
            "ravemj.formats.meshes.obj",
            "ravemj.formats.mjcf",
            "ravemj.formats.readers",
        ],
    )


def differences(expected, got, tolerance, where="result"):
    """Places where two answers differ; an integer may stand for a float, not the other way round."""
    if isinstance(expected, dict | list) and type(expected) is type(got):
        here, there = _parts(expected), _parts(got)
        for part in sorted(here.keys() ^ there.keys()):
            yield f"{where}{part}: {'missing' if part in here else 'not expected'}"
        for part in here.keys() & there.keys():
            yield from differences(here[part], there[part], tolerance, f"{where}{part}")
    elif not _agree(expected, got, tolerance):
        yield f"{where}: expected {expected!r}, got {got!r}"


def scaled(answer, places, factor, where="result"):
    """An answer with the numbers at some places multiplied by a factor."""
    if isinstance(answer, dict):
        return {key: scaled(item, places, factor, f"{where}.{key}") for key, item in answer.items()}
    if isinstance(answer, list):
        return [scaled(item, places, factor, f"{where}[{index}]") for index, item in enumerate(answer)]
    return answer * factor if isinstance(answer, float) and re.search(places, where) else answer


def _parts(answer):
    items = answer.items() if isinstance(answer, dict) else enumerate(answer)
    return {f"[{key}]" if isinstance(answer, list) else f".{key}": item for key, item in items}


def _agree(expected, got, tolerance):
    if isinstance(expected, float) and type(got) in {int, float}:
        return abs(expected - got) <= tolerance * max(1.0, abs(expected))
    return type(expected) is type(got) and expected == got


def compared(
    name: str, folder: Path, cases: Path = CASES, mistakes: Mapping[str, tuple[str, str]] = MISTAKES
) -> list[str]:
    """Run a script and return what is wrong with its answer."""
    answer = run_case(name, folder, cases)
    if "error" in answer:
        return [str(answer["error"])]
    tolerance = re.search(r"^TOLERANCE = (\S+)", (cases / f"{name}.py").read_text(), re.MULTILINE)
    expected = json.loads((cases / f"{name}.json").read_text())
    if name in SLIDER_FORCES:
        expected = scaled(expected, SLIDER_FORCES[name], 2 * math.pi)
    found = differences(expected, answer["result"], float(tolerance[1]) if tolerance else 1e-9)
    if name in mistakes:
        found = (text for text in found if not re.search(mistakes[name][0], text.partition(": ")[0]))
    return list(found)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.xfail(name in NOT_YET, reason="not yet", strict=True))
        if name in NOT_YET
        else name
        for name in NAMES
    ],
)
def test_case(name, tmp_path):
    assert compared(name, tmp_path) == []


def test_the_lists_name_cases():
    assert len(NAMES) == 524
    assert {*MISTAKES, *SLIDER_FORCES, *REPLACED} <= set(NAMES)
    assert set(NAMES) >= NOT_YET
    assert LIST.read_text().split() == sorted(NOT_YET)


def test_answers_are_compared_number_by_number():
    expected = {"a": [1.0, 2], "b": None, "c": {"d": "x"}, "e": True}
    assert list(differences(expected, {"a": [1 + 1e-10, 2], "b": None, "c": {"d": "x"}, "e": True}, 1e-9)) == []
    for wrong in (
        {**expected, "a": [1.1, 2]},
        {**expected, "a": [1.0, 2.0]},
        {**expected, "a": [1.0]},
        {**expected, "b": 0},
        {**expected, "c": {}},
        {**expected, "e": 1},
        {**expected, "f": 1},
    ):
        assert len(list(differences(expected, wrong, 1e-9))) == 1
    with pytest.raises(TypeError):
        plain(object())
    assert plain((np.float64(1.5), np.array([2]), math.inf)) == [1.5, [2], "Infinity"]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        failing = [name for name in NAMES if compared(name, Path(scratch))]
    LIST.write_text("".join(f"{name}\n" for name in failing))
    sys.stdout.write(f"{len(NAMES) - len(failing)} of {len(NAMES)} pass\n")

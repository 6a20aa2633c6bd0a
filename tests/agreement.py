"""Compares a loaded file with what OpenRAVE makes of it, and measures the worst difference.

The comparison itself is that of ``tests/conformance/compare.py``, the suite's own program.
"""

import importlib.util
import types
from pathlib import Path

import numpy as np
import pytest

import ravemj

CONFORMANCE = Path(__file__).parent / "conformance"
CORPUS = Path(__file__).resolve().parents[2] / "shared" / "corpus"
"""Published models with OpenRAVE's numbers; they belong to other projects and are no part of this repository."""

NEEDS_THE_CORPUS = [pytest.mark.skipif(not CORPUS.is_dir(), reason="there are no published models in ../shared/corpus")]


def _load_suite():
    spec = importlib.util.spec_from_file_location("conformance_compare", CONFORMANCE / "compare.py")
    suite = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(suite)
    return suite


SUITE = _load_suite()


class Measured(SUITE.Diff):
    """Collects differences, and the largest error in units of the tolerance's scale max(1, |expected|)."""

    def __init__(self, options):
        super().__init__(options)
        self.worst = 0.0

    def array(self, path, expected, got, tolerance=SUITE.TOL):
        super().array(path, expected, got, tolerance)
        if tolerance != SUITE.TOL:  # meshes and colours, in single precision
            return
        try:
            a, b = np.asarray(expected, float), np.asarray(got, float)
        except (TypeError, ValueError):
            return
        if a.size and a.shape == b.shape:
            errors = np.abs(a - b) / np.maximum(1, np.abs(a))
            self.worst = max(self.worst, float(np.fmax.reduce(errors, axis=None, initial=0.0)))


def options(**changes):
    plain = {"ignore": None, "skip_missing": False, "strict_failures": False, "physics": False, "isolate": False}
    return types.SimpleNamespace(**{**plain, **changes})


def compare(folder: Path, expected: dict, **changes) -> tuple[list[str], float]:
    """Return the differences between a file and OpenRAVE's numbers, and the worst error of those that agree.

    With ``physics`` the torques of bodies in which a joint without DOFs follows no other are those of
    ``batch_inverse_dynamics``, since ``ComputeInverseDynamics`` raises there, as OpenRAVE's does.
    """
    made = []

    def collect(opt):
        made.append(Measured(opt))
        return made[-1]

    adapter = SUITE.get_adapter("ravemj")
    adapter.collision = "collision checker" not in expected.get("note", "")
    if changes.get("physics"):
        single = adapter.inverse_dynamics

        def torques(body, q, qd, qdd):
            try:
                return single(body, q, qd, qdd)
            except ravemj.openrave_exception:
                return body.batch_inverse_dynamics([q], [qd], [qdd])[0]

        adapter.inverse_dynamics = torques
    original, SUITE.Diff = SUITE.Diff, collect
    try:
        differences = SUITE.run_case(adapter, str(folder), expected, options(**changes))
    finally:
        SUITE.Diff = original
    return differences, max((diff.worst for diff in made), default=0.0)

"""Translated robots can be simulated: the points of ``sim_judge``, on the robots of ``example-robot-data``."""

import json
import lzma
import warnings

import pytest
import sim_judge
from conftest import DATA
from test_urdf_robots import ROBOTS

import ravemj

TRUTH = json.loads(lzma.decompress((DATA / "urdf" / "truth.json.xz").read_bytes()))

pytestmark = pytest.mark.skipif(
    not ROBOTS.is_dir(),
    reason="the robots are not here: pip install example-robot-data==6.0.0, or name their folder in RAVEMJ_ROBOT_DATA",
)

UNREADABLE = {"ur3.urdf", "alex_psyonic_hands.urdf"}
NAMES = sorted(str(path.relative_to(ROBOTS)) for path in ROBOTS.glob("**/*.urdf") if path.name not in UNREADABLE)

WEAK = {"baxter.urdf", "pr2.urdf", "simple_humanoid.urdf", "simple_humanoid_classical.urdf", "tiago_dual.urdf"}
"""Robots with a motor that gravity overcomes at the start pose."""

BLOCKED = {"icub_reduced.urdf"}
"""Robots whose hands rest so near their hips that steps of the torso end there."""

FEW = {"go2.urdf", "panda.urdf", "tiago_pro.urdf", "allegro_left_hand.urdf", "baxter.urdf", "so100.urdf"}
"""Robots of the quick tests: legs, an arm with a gripper, mimic joints, tiny inertias, weak motors."""

STANDING = {
    "a1.urdf", "anymal-kinova.urdf", "b1.urdf", "go1.urdf", "go2.urdf", "hyq_no_sensors.urdf", "laikago.urdf",
    "solo.urdf", "solo12.urdf", "g1_29dof_rev_1_0.urdf", "romeo.urdf", "quadruped.urdf",
}  # fmt: skip
"""Robots that stand where they start. A bolt, with two points for feet, and an icub do not."""


def quick(names):
    """Return robots as parameters; all but a few are long tests."""
    return [
        pytest.param(name, marks=() if name.rpartition("/")[2] in FEW else pytest.mark.stress, id=name)
        for name in names
    ]


def converted(name, folder, **choices):
    env = ravemj.Environment()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert env.Load(ROBOTS / name)
        path = env.write_mjcf(folder / "robot", actuators="position", **choices)
    return path, {warning.message.code for warning in caught if isinstance(warning.message, ravemj.RavemjWarning)}


@pytest.mark.stress
@pytest.mark.parametrize("name", quick(NAMES))
def test_a_robot_can_be_simulated(name, tmp_path):
    path, codes = converted(name, tmp_path)
    found = sim_judge.judge(path, truth=TRUTH.get(name))
    file = name.rpartition("/")[2]
    assert found["touching"] == []
    assert not found["self_collision_off"]
    assert found["passive_warnings"] == 0
    assert found["energy"] < 0.05
    assert ("weak-motor" in codes) == (file in WEAK)
    if found["nu"] and file not in WEAK:
        assert found["hold_warnings"] == 0
        assert found["drooping"] == {}
        assert file in BLOCKED or found["bad_steps"] == {}
    if name in TRUTH:
        assert (found["missing"], found["boxes"]) == ([], [])
        assert max(found["pose"], found["mass"] / 10, found["limit"], found["effort"]) < 1e-9
        assert found["tensor"] < 1e-4
        equalities, followers = found["mimic"].split("/")
        assert equalities == followers


@pytest.mark.parametrize("name", quick(name for name in NAMES if name.rpartition("/")[2] in STANDING))
def test_a_robot_stands(name, tmp_path):
    path, _ = converted(name, tmp_path, base="free")
    found = sim_judge.standing(path)
    assert abs(found["sank"]) < 0.005
    assert found["droop"] <= 1
    assert found["warnings"] == 0

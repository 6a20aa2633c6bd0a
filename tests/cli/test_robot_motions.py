"""Motions for controllers of robots on the command line: ``plan -o``, ``play --trajectory … -o``."""

import json

import numpy as np
import pytest
from command_line import ravemj_command

import ravemj

URDF = """<robot name="arm"><link name="base"/><link name="upper"/><link name="fore"/>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
<limit effort="1" velocity="2"/></joint>
<joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0.3 0 0"/>
<axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="2"/></joint></robot>"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "arm.urdf").write_text(URDF)
    (tmp_path / "names.json").write_text('{"elbow": "left_elbow_joint"}')
    return tmp_path


def plan(folder, *words):
    return ravemj_command(folder, "plan", "arm.urdf", "--to=1,0.5", *words)


def play(folder, *words):
    return ravemj_command(folder, "play", "arm.urdf", *words)


def test_a_plan_is_written_with_the_names_of_the_robot_and_read_back(folder):
    done = plan(folder, "-o", "plan.json", "--rename", "names.json")
    assert done.returncode == 0, done.stderr
    assert "acceleration limits: 50, assumed where a model gives none, of shoulder (rad/s^2), elbow" in done.stdout
    message = json.loads((folder / "plan.json").read_text())
    assert message["joint_names"] == ["shoulder", "left_elbow_joint"]
    assert message["points"][-1]["positions"] == pytest.approx([1, 0.5])
    assert play(folder, "--trajectory", "plan.json", "--rename", "names.json", "-o", "again.html").returncode == 0
    lacking = play(folder, "--trajectory", "plan.json", "-o", "again.html")
    assert lacking.returncode == 1
    assert "'left_elbow_joint' is not a joint of 'arm'" in lacking.stderr


def test_yaml_keeps_the_notes_of_the_plan(folder):
    pytest.importorskip("yaml")
    done = plan(folder, "-o", "plan.ros2.yaml")
    assert done.returncode == 0, done.stderr
    assert "# certified: there are no other bodies" in (folder / "plan.ros2.yaml").read_text()
    again = play(folder, "--trajectory", "plan.ros2.yaml", "-o", "plan.ros2.csv")
    assert again.returncode == 0, again.stderr
    first, second = (ravemj.read_joint_trajectory(folder / f"plan.ros2{suffix}") for suffix in (".yaml", ".csv"))
    np.testing.assert_allclose(second.positions, first.positions, atol=1e-9)
    assert second.units == ("rad", "rad")


def test_acceleration_and_rate(folder):
    assert plan(folder, "-o", "plan.json", "--acceleration", "3", "--rate", "50").returncode == 0
    points = ravemj.read_joint_trajectory(folder / "plan.json")
    assert np.abs(points.accelerations).max() == pytest.approx(3)
    assert points.times[1] == pytest.approx(0.02)
    assert plan(folder, "-o", "plan.json", "--acceleration", "3", "--rate", "waypoints").returncode == 0
    assert len(ravemj.read_joint_trajectory(folder / "plan.json").times) < 10


def test_the_measured_state_is_the_start(folder):
    assert plan(folder, "-o", "plan.csv").returncode == 0
    (folder / "near.json").write_text('{"shoulder": 12.566, "elbow": -0.005}')
    assert play(folder, "--trajectory", "plan.csv", "-o", "plan.json", "--from", "near.json").returncode == 0
    assert ravemj.read_joint_trajectory(folder / "plan.json").positions[0, 0] == pytest.approx(4 * np.pi)
    (folder / "far.json").write_text('{"elbow": 0.5}')
    (folder / "plan.json").unlink()
    done = play(folder, "--trajectory", "plan.csv", "-o", "plan.json", "--from", "far.json")
    assert (done.returncode, done.stdout) == (1, "")
    assert "joint 'elbow' starts at 0 rad, and the robot is at 0.5 rad" in done.stderr
    assert not (folder / "plan.json").exists()


@pytest.mark.parametrize(
    "words",
    [("plan", "scara", "--to=1,0.5,0,0"), ("ik", "scara", "--to=0.3,0.3,0"), ("play", "scara", "-o", "plan.json")],
    ids=lambda words: words[0],
)
def test_a_state_outside_of_the_limits_is_an_error(folder, words):
    (folder / "beyond.json").write_text('{"joint3": 0.245}')
    done = ravemj_command(folder, *words, "--from", "beyond.json")
    assert done.returncode == 1
    assert "beyond.json: error: joint 'joint3' is at 0.245 m, 0.05 m outside of its limits [0, 0.195]" in done.stderr
    assert not (folder / "plan.json").exists()


def test_a_table_moves_the_joints_that_it_names(folder):
    (folder / "swing.csv").write_text("time,elbow\n0,0\n1,1\n")
    assert play(folder, "--trajectory", "swing.csv", "-o", "swing.json").returncode == 0
    assert ravemj.read_joint_trajectory(folder / "swing.json").joint_names == ("elbow",)
    assert play(folder, "--trajectory", "swing.csv", "-o", "swing.json", "--moving").returncode == 0
    moving = ravemj.read_joint_trajectory(folder / "swing.json")
    assert moving.velocities is None
    np.testing.assert_array_equal(moving.times, [0, 1])


def test_the_usual_motion_of_play(folder):
    assert play(folder, "--to=1,0.5", "-o", "swing.json").returncode == 0
    assert ravemj.read_joint_trajectory(folder / "swing.json").positions[-1] == pytest.approx([1, 0.5])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["--trajectory", "fast.csv", "--moving"],
            "joint 'elbow' has a velocity of 10 rad/s at 0.1 s, and its limit is 2",
        ),
        (["--trajectory", "far.csv"], "joint 'elbow' is at 3 rad, 1 rad outside of its limits [-2, 2], at 1 s"),
        (["--to=1,1", "--duration", "2"], "--duration: goes with pictures"),
        (["--to=1,1", "--acceleration", "1,2,3"], "--acceleration: found 1, 2, 3; expected one above 0, or 2"),
        (["--to=1,1", "--acceleration=-1"], "--acceleration: found -1"),
        (["--to=1,1", "--rename", "missing.json"], "missing.json"),
        (["--to=1,1", "--rename", "list.json"], "list.json: error: found no names, expected an object"),
        (
            ["--to=1,1", "--rename", "other.json"],
            "there is no joint 'elbo'; the joints are shoulder, elbow; did you mean",
        ),
        (["--to=1,1", "--rename", "twice.json"], "found a name twice"),
        (["--to=1,1", "--rename", "number.json"], "'elbow': found 1, expected a name"),
        (["--to=1,1", "--rename", "clash.json"], "'shoulder' is there twice"),
    ],
)
def test_what_cannot_be_written_is_said_in_a_line(folder, words, message):
    (folder / "fast.csv").write_text("time,elbow\n0,0\n0.1,1\n")
    (folder / "far.csv").write_text("time,elbow\n0,0\n1,3\n")
    (folder / "list.json").write_text("[1]")
    (folder / "other.json").write_text('{"elbo": "a"}')
    (folder / "twice.json").write_text('{"elbow": "a", "shoulder": "a"}')
    (folder / "number.json").write_text('{"elbow": 1}')
    (folder / "clash.json").write_text('{"elbow": "shoulder"}')
    done = play(folder, *words, "-o", "plan.json")
    assert (done.returncode, done.stdout) == (1, "")
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (folder / "plan.json").exists()


@pytest.mark.parametrize("command", ["plan", "play"])
def test_a_wrong_suffix_or_rate_says_what_is_known(folder, command):
    done = ravemj_command(folder, command, "arm.urdf", "--to=1,0.5", "-o", "plan.foo")
    assert done.returncode == 1
    assert ".yaml, .yml, .json, .ros2.csv" in done.stderr
    done = ravemj_command(folder, command, "arm.urdf", "--to=1,0.5", "-o", "plan.json", "--rate", "often")
    assert done.returncode == 2
    assert "'often' is not a finite number, and not the word waypoints" in done.stderr

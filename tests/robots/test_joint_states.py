"""States of real robots: messages, lines of text, and a stand-in for rosbridge that misbehaves."""

import io
import json
import math
import signal
import socket

import numpy as np
import pytest
from command_line import Served, ravemj_command
from hypothesis import given
from hypothesis import strategies as st
from rosbridge import Rosbridge, publish, saying
from strategies import examples
from waiting import await_that, time_limit

import ravemj
from ravemj.robots import joint_states
from ravemj.robots.joint_states import JointStates, follow_rosbridge, read_lines

NAMES = ["shoulder", "elbow", "wrist"]


class EnoughError(Exception):
    """A test has seen what it waits for."""


class States(JointStates):
    """States that note what is said, and end the thread that brings them after some messages."""

    def __init__(self, most=None, renamed=None):
        self.said, self.taken, self.most = [], 0, most
        super().__init__(NAMES, ["finger_mimic"], renamed or {}, self.said.append, records=True)

    def add(self, names, values, now):
        super().add(names, values, now)
        self.taken += 1
        if self.taken == self.most:
            raise EnoughError


@pytest.fixture
def hasty(monkeypatch):
    monkeypatch.setattr(joint_states, "PAUSE", 0.01)
    monkeypatch.setattr(joint_states, "SILENCE", 0.2)


def follow(url, states, say=None, topic="/joint_states"):
    with time_limit(), pytest.raises(EnoughError):
        follow_rosbridge(url, topic, 1 / 30, states, say or states.said.append)


def test_values_are_those_of_the_names():
    states = States()
    states.add(["elbow", "shoulder"], [2, 1.5], 0.0)
    assert states.pop() == {"shoulder": 1.5, "elbow": 2.0}
    assert states.pop() is None
    states.add(["wrist"], [3.0], 1.0)
    assert states.pop() == {"shoulder": 1.5, "elbow": 2.0, "wrist": 3.0}


def test_unknown_names_are_said_once_and_mimic_joints_are_known():
    states = States()
    for _ in range(3):
        states.add(["elbow", "nose", "finger_mimic"], [1, 2, 3], 0.0)
    assert states.said == ["no joint of the model: nose; the joints are shoulder, elbow, wrist"]
    assert states.values == {"elbow": 1.0}


def test_values_are_there_when_unknown_names_are_said():
    """Whoever ends the mirror upon that message has a state to save."""
    seen = []
    states = JointStates(NAMES, [], {}, lambda text: seen.append(states.values), records=True)
    states.add(["elbow", "nose"], [1, 2], 0.0)
    assert seen == [{"elbow": 1.0}]


def test_names_of_the_robot_are_renamed():
    states = States(renamed={"left_elbow": "elbow"})
    states.add(["left_elbow"], [1], 0.0)
    assert states.values == {"elbow": 1.0}


@pytest.mark.parametrize(
    ("names", "values"),
    [
        (["elbow", "elbow"], [1, 2]),
        (["elbow"], [1, 2]),
        (["elbow"], []),
        (["elbow"], [math.nan]),
        (["elbow"], [None]),
        (["elbow"], ["1"]),
        (["elbow"], [True]),
        (["elbow"], [10**400]),
        ([1], [1]),
        ("elbow", [1]),
        (None, None),
        ({"elbow": 1}, [1]),
    ],
)
def test_messages_that_make_no_sense_are_skipped_counted_and_said_once(names, values):
    states = States()
    states.add(["elbow", "wrist"], [0.5, 0.25], 0.0)
    for _ in range(5):
        states.add(names, values, 1.0)
    assert states.values == {"elbow": 0.5, "wrist": 0.25}
    assert len(states.said) == 1
    assert sum(states.skipped.values()) == 5


anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=3) | st.sampled_from(NAMES),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=2), inner, max_size=2),
    max_leaves=6,
)


@given(st.lists(st.tuples(anything, anything), max_size=5))
@examples(200)
def test_no_message_raises_or_brings_what_is_not_finite(messages):
    states = States()
    for moment, (names, values) in enumerate(messages):
        states.add(names, values, float(moment))
    assert all(math.isfinite(value) for value in states.values.values())
    assert len(states.said) <= 4 + len(messages)


def test_what_came_is_a_motion():
    states = States()
    states.add(["elbow"], [1.0], 10.0)
    states.add(["shoulder"], [2.0], 10.5)
    states.add(["elbow"], [3.0], 10.501)  # too near: the newest counts
    motion, names = states.motion()
    assert names == ["shoulder", "elbow"]
    np.testing.assert_array_equal(motion.times, [0.0, 0.5])
    np.testing.assert_array_equal(motion.values, [[2, 1], [2, 3]])
    assert States().motion() is None


def test_nothing_is_kept_that_nobody_records():
    states = JointStates(NAMES, [], {}, print, records=False)
    for moment in range(3):
        states.add(["elbow"], [1.0], float(moment))
    assert states.motion() is None
    assert states.values == {"elbow": 1.0}


@pytest.mark.parametrize(
    ("text", "values", "troubles"),
    [
        ("elbow=1 wrist=-2e-1\n", {"elbow": 1, "wrist": -0.2}, 0),
        ("elbow=1,wrist=2\n# note\n\nelbow=3\n", {"elbow": 3, "wrist": 2}, 0),
        ("time,elbow,wrist\n0,1,2\n0.1,3,4\n", {"elbow": 3, "wrist": 4}, 0),
        ("elbow\twrist\n1\t2\n", {"elbow": 1, "wrist": 2}, 0),
        ("elbow,wrist\n1,2\n1\n1,x\nnan,1\n", {"elbow": 1, "wrist": 2}, 3),
        ("elbow=1\nelbow=x\nelbow=\nhello world\n", {"elbow": 1}, 2),
        ("1,2\n", {}, 1),
    ],
)
def test_lines(text, values, troubles):
    states = States()
    read_lines(io.StringIO(text), states)
    assert states.values == values
    assert sum(states.skipped.values()) == troubles


def test_the_request_is_understood_by_ros_1_and_ros_2():
    states = States(1)
    with Rosbridge(saying([publish(["elbow"], [1.0])])) as server:
        follow(server.url, states)
    request = {"op": "subscribe", "topic": "/joint_states", "type": "sensor_msgs/JointState"}
    assert server.requests == [{**request, "throttle_rate": 33, "queue_length": 1}]
    assert states.values == {"elbow": 1.0}
    assert states.said == [f"connected to {server.url}"]


def test_messages_of_all_kinds():
    messages = [
        "no json",
        "[" * 100_000,
        "[]",
        "{}",
        json.dumps({"op": "publish", "topic": "/joint_states"}),
        publish(["elbow"], [9.0], "/other"),
        json.dumps({"op": "status", "level": "error", "msg": "no such topic"}),
        publish(["elbow"], [None]),
        publish(["elbow"], ["text"]),
        publish(["elbow", "nose"], [1.0, 2.0]),
    ]
    states = States(4)
    with Rosbridge(saying(messages)) as server:
        follow(server.url, states)
    assert states.values == {"elbow": 1.0}
    assert sum(states.skipped.values()) == 5
    assert "rosbridge: no such topic" in states.said
    assert len(states.said) == 6


def test_a_lost_connection_is_made_again(hasty):
    def talk(connection, number):
        connection.send(publish(["elbow"], [float(number)]))  # and the connection ends

    states = States(3)
    with Rosbridge(talk) as server:
        follow(server.url, states)
    assert states.values == {"elbow": 3.0}
    assert sum(said.startswith("connected") for said in states.said) == 3
    assert any("trying again" in said for said in states.said)


def test_a_server_that_is_missing_is_said_once(hasty):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        url = f"ws://127.0.0.1:{free.getsockname()[1]}"
    said, pauses = [], []

    def sleep(seconds):
        pauses.append(seconds)
        if len(pauses) == 5:
            raise EnoughError

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(joint_states.time, "sleep", sleep)
        follow(url, States(), said.append)
    assert len(said) == 1
    assert said[0].startswith(f"no connection to {url}: ")


def test_a_server_that_never_answers_is_said(hasty):
    said = []

    def say(text):
        said.append(text)
        raise EnoughError

    with socket.create_server(("127.0.0.1", 0)) as silent:
        follow(f"ws://127.0.0.1:{silent.getsockname()[1]}", States(), say)
    assert "trying again" in said[0]


def test_a_server_without_messages_is_said_once_and_the_mirror_goes_on(hasty):
    states, silence = States(1), "no message on /joint_states for 0.2 s"

    def talk(connection, number):
        await_that(lambda: silence in states.said)
        connection.send(publish(["elbow"], [1.0]))
        connection.recv()

    with Rosbridge(talk) as server:
        follow(server.url, states)
    assert states.said.count(silence) == 1  # a busy machine may need several attempts to connect, each of 0.2 s


def test_a_flood_leaves_the_newest_state_and_a_short_record():
    count = 5000
    states = States(count)
    with Rosbridge(saying([publish(["elbow"], [float(number)]) for number in range(count)])) as server:
        follow(server.url, states)
    assert states.pop() == {"elbow": count - 1}
    motion, _ = states.motion()
    assert np.diff(motion.times).min(initial=1) >= joint_states.LEAST_PERIOD
    assert motion.values[-1, 0] == count - 1


# The command


def test_the_mirror_saves_what_came_and_plans_go_on_from_there(tmp_path):
    (tmp_path / "names.json").write_text('{"joint2": "elbow_joint"}')
    received = [publish(["joint1", "elbow_joint", "joint9"], [0.25, -0.5, 1.0])]
    with Rosbridge(saying(received)) as server:
        words = ["scara", "--web", "--rosbridge", server.url, "--rename", "names.json"]
        words += ["--save-state", "now.json", "--record", "came.csv"]
        with Served(tmp_path, "mirror", *words) as page:
            said = page.next_message(), page.next_message()
            ended = page.end(signal.SIGINT)
    assert ended == (0, "wrote came.csv\nwrote now.json\n", ""), "\n".join(map(str, [*said, *ended]))
    assert said[0] == f"ravemj: connected to {server.url}\n"
    assert "no joint of the model: joint9" in said[1]
    assert json.loads((tmp_path / "now.json").read_text()) == {"joint1": 0.25, "joint2": -0.5}
    assert (tmp_path / "came.csv").read_text() == "time,joint1,joint2\n0.0,0.25,-0.5\n"
    done = ravemj_command(tmp_path, "plan", "scara", "--to=0,0,0,0", "--from", "now.json", "-o", "plan.json")
    assert done.returncode == 0, done.stderr
    points = ravemj.read_joint_trajectory(tmp_path / "plan.json")
    np.testing.assert_allclose(points.positions[0], [0.25, -0.5, 0, 0])


def test_the_ghost_of_a_motion(tmp_path):
    (tmp_path / "plan.csv").write_text("time,joint1\n0,0\n1,0.5\n")
    (tmp_path / "lines.txt").write_text("joint1=0.1\n")
    with Served(tmp_path, "mirror", "scara", "--web", "--csv", "lines.txt", "--motion", "plan.csv") as page:
        assert page.url.startswith("http://127.0.0.1:")
        code, printed, said = page.end(signal.SIGINT)
    assert (code, printed) == (0, "")
    assert said in {"", "ravemj: the lines have ended; the mirror shows the last state\n"}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--rosbridge", "http://x"], "--rosbridge: 'http://x' is not an address such as ws://127.0.0.1:9090"),
        (["--csv", "missing.txt"], "missing.txt: error: cannot read the file"),
        (["--csv", "-", "--record", "x.mp4"], "a motion is a .csv or a .npz file, not '.mp4'"),
        (["--csv", "-", "--save-state", "no/x.json"], "there is no folder"),
        (["--csv", "-", "--motion", "missing.csv"], "missing.csv"),
        (["--csv", "-", "--robot", "nobody"], "there is no robot 'nobody'"),
    ],
)
def test_wrong_arguments_are_said_in_a_line(tmp_path, words, message):
    done = ravemj_command(tmp_path, "mirror", "scara", "--web", *words)
    assert (done.returncode, done.stdout) == (1, "")
    assert message in done.stderr
    assert done.stderr.count("\n") == 1

"""Joint states of a real robot, from ROS messages and text lines."""

import json
import math
import re
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import cast

import numpy as np

from ravemj.errors import ArgumentError
from ravemj.trajectories.joint_trajectory_files import LARGEST_NUMBER, fields_of
from ravemj.trajectories.motion import Motion

LEAST_PERIOD = 0.005
"""Minimum time between two rows of a recording [s]; of closer states, the newest one is kept."""

SILENCE = 5.0
"""Time without messages after which a warning is shown [s]."""

PAUSE = 1.0
"""Time between two attempts to connect [s]."""

_TIME = "time"

Say = Callable[[str], None]
"""Callback that shows a text to the user."""


class JointStates:
    """The latest joint values of a body, passed from a receiving thread to another one.

    Args:
        names: Names of the DOFs of the body.
        others: Names of joints without a DOF, such as mimic joints, which messages may contain.
        renamed: Joint names of the body by those of the robot, if they differ.
        say: Called once for each kind of problem.
        records: Whether to record the states for ``motion``.
    """

    def __init__(
        self, names: Sequence[str], others: Iterable[str], renamed: Mapping[str, str], say: Say, *, records: bool
    ) -> None:
        self._names, self._others, self._renamed, self._say = list(names), set(others), renamed, say
        self._records, self._lock = records, threading.Lock()
        self._values: dict[str, float] = {}
        self._rows: list[tuple[float, dict[str, float]]] = []
        self._is_new = False
        self._unknown: set[str] = set()
        self.skipped: Counter[str] = Counter()

    def add(self, names: object, values: object, now: float) -> None:
        """Add a state: joint names, their values and the time [s]; an invalid one is skipped."""
        trouble = _trouble(names, values)
        if trouble:
            self.skip(trouble)
            return
        pairs = zip(cast("list[str]", names), cast("list[float]", values), strict=True)
        named = {self._renamed.get(name, name): float(value) for name, value in pairs}
        unknown = named.keys() - set(self._names) - self._others - self._unknown
        with self._lock:
            self._values |= {name: named[name] for name in self._names if name in named}
            self._is_new = True
            if self._rows and now - self._rows[-1][0] < LEAST_PERIOD:
                self._rows[-1] = self._rows[-1][0], self._values.copy()
            elif self._values and self._records:
                self._rows.append((now, self._values.copy()))
        if unknown:
            self._unknown |= unknown
            self._say(f"no joint of the model: {', '.join(sorted(unknown))}; the joints are {', '.join(self._names)}")

    def skip(self, trouble: str) -> None:
        """Count an invalid message; each kind of problem is reported once."""
        self.skipped[trouble] += 1
        if self.skipped[trouble] == 1:
            self._say(f"skipped a message: {trouble}; further ones are counted")

    def pop(self) -> dict[str, float] | None:
        """Return the latest values by joint name; None if no state has arrived since the last call."""
        with self._lock:
            is_new, self._is_new = self._is_new, False
            return self._values.copy() if is_new else None

    @property
    def values(self) -> dict[str, float]:
        """The latest values by joint name."""
        with self._lock:
            return self._values.copy()

    def motion(self) -> tuple[Motion, list[str]] | None:
        """Return the recorded motion, starting at time 0, and its joint names; None if no state has arrived.

        Until a joint's first value arrives, the motion contains this first value.
        """
        with self._lock:
            rows = list(self._rows)
        names = [name for name in self._names if rows and name in rows[-1][1]]
        if not names:
            return None
        first = {name: next(values[name] for _, values in rows if name in values) for name in names}
        times = np.array([time for time, _ in rows]) - rows[0][0]
        return Motion(times, [[values.get(name, first[name]) for name in names] for _, values in rows]), names


def _trouble(names: object, values: object) -> str:
    """Return the reason to skip a message with these names and values; empty if it is valid."""
    if not isinstance(names, list) or not isinstance(values, list):
        return "it has no lists of names and values"
    texts, numbers = cast("list[object]", names), cast("list[object]", values)
    if len(texts) != len(numbers):
        return "it has more or fewer values than names"
    if not all(isinstance(name, str) for name in texts) or len(set(map(str, texts))) < len(texts):
        return "a name is there twice, or is no text"
    are_numbers = (isinstance(number, int | float) and not isinstance(number, bool) for number in numbers)
    if not all(are_numbers) or not all(abs(cast("float", number)) < LARGEST_NUMBER for number in numbers):
        return "a value is not a finite number"
    return ""


def read_lines(lines: Iterable[str], states: JointStates) -> None:
    """Read states from lines: ``name=value name=value``, or a row of names followed by rows of values.

    Separators are blanks, commas, semicolons and tabs. A column ``time`` is ignored.
    """
    header: list[str] = []
    for line in lines:
        words = [word for word in re.split(r"[\s,;]+", line.strip()) if word]
        if not words or words[0].startswith("#"):
            continue
        if all("=" in word for word in words):
            pairs = [word.partition("=")[::2] for word in words]
        elif not header and not any(map(_is_number, words)):
            header = words
            continue
        elif len(words) != len(header):
            states.skip("it has more or fewer values than names")
            continue
        else:
            pairs = list(zip(header, words, strict=True))
        pairs = [(name, value) for name, value in pairs if name != _TIME]
        values = [float(value) if _is_number(value) else math.nan for _, value in pairs]
        states.add([name for name, _ in pairs], values, time.monotonic())


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def follow_rosbridge(url: str, topic: str, period: float, states: JointStates, say: Say) -> None:
    """Receive ``sensor_msgs/JointState`` messages from a rosbridge server, reconnecting for ever.

    Args:
        url: Its address, ``ws://HOST:PORT``.
        topic: The topic.
        period: Minimum time between two messages [s].
        states: Receives the states.
        say: Called when the connection is established, fails or is lost.
    """
    from websockets.exceptions import WebSocketException  # noqa: PLC0415 - slow to import
    from websockets.sync.client import connect  # noqa: PLC0415

    throttle = {"throttle_rate": round(1000 * period), "queue_length": 1}
    request = {"op": "subscribe", "topic": topic, "type": "sensor_msgs/JointState", **throttle}
    last = ""
    while True:
        try:
            with connect(url, open_timeout=SILENCE, close_timeout=PAUSE) as connection:
                connection.send(json.dumps(request))
                say(f"connected to {url}")
                last = ""
                _receive(connection.recv, topic, states, say)
        except (OSError, WebSocketException) as error:  # TimeoutError is one
            reason = f"no connection to {url}: {error or 'no answer'}; trying again"
            if reason != last:
                say(" ".join(reason.split()))
            last = reason
        time.sleep(PAUSE)


def _receive(receive: Callable[[float], str | bytes], topic: str, states: JointStates, say: Say) -> None:
    """Receive messages until the connection is lost."""
    is_silent = False
    while True:
        try:
            text = receive(SILENCE)
        except TimeoutError:
            if not is_silent:
                say(f"no message on {topic} for {SILENCE:g} s")
            is_silent = True
            continue
        is_silent = False
        try:
            content: object = json.loads(text)
        except (RecursionError, ValueError):
            states.skip("it is not JSON")
            continue
        message = fields_of(content)
        if message.get("op") == "status" and message.get("level") in {"error", "warning"}:
            say(f"rosbridge: {message.get('msg')}"[:200])
        if message.get("op") != "publish" or message.get("topic") != topic:
            continue
        fields = fields_of(message.get("msg"))
        states.add(fields.get("name"), fields.get("position"), time.monotonic())


def check_url(url: str) -> None:
    """Check the address of a server.

    Raises:
        ArgumentError: it is not the address of a websocket.
    """
    if not re.fullmatch(r"wss?://[^\s/]+(/\S*)?", url):
        raise ArgumentError(f"--rosbridge: '{url}' is not an address such as ws://127.0.0.1:9090")

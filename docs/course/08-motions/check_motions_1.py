"""Check of motions-1."""

import numpy as np

from ravemj.learn import Check


def question(random):
    count = random.integers(3, 7)
    times = np.cumsum(random.uniform(0.2, 2, count))
    return times, random.uniform(-2, 2, (count, 3)), random.uniform(times[0] - 0.5, times[-1] + 0.5)


def segment(times, t):
    """Return the index of the waypoint before a time, but not of the last one."""
    return int(np.clip(np.searchsorted(times, t) - 1, 0, len(times) - 2))


def extrapolated(times, waypoints, t):
    i = segment(times, t)
    s = (t - times[i]) / (times[i + 1] - times[i])
    return waypoints[i] + s * (waypoints[i + 1] - waypoints[i])


def answer(times, waypoints, t):
    return extrapolated(times, waypoints, np.clip(t, times[0], times[-1]))


def seconds_as_part(times, waypoints, t):
    t = np.clip(t, times[0], times[-1])
    i = segment(times, t)
    return waypoints[i] + (t - times[i]) * (waypoints[i + 1] - waypoints[i])


def even(times, waypoints, t):
    return answer(np.linspace(times[0], times[-1], len(times)), waypoints, t)


def backwards(times, waypoints, t):
    t = np.clip(t, times[0], times[-1])
    i = segment(times, t)
    return waypoints[i] + waypoints[i + 1] - answer(times, waypoints, t)


CHECK = Check(
    function="joint_values",
    question=question,
    answer=answer,
    kind="joint values",
    mistakes={
        "Before the first and after the last waypoint the robot stands still: limit t to the times of the motion.": (
            extrapolated
        ),
        "The seconds since the waypoint are taken for s: divide them by the time between the two waypoints.": (
            seconds_as_part
        ),
        "The waypoints are taken to be evenly spaced in time: each has its own time.": even,
        "The two waypoints are exchanged: s is 0 at the first of them, and 1 at the second.": backwards,
        "This is the waypoint before t: between two waypoints the joint values change.": lambda times, waypoints, t: (
            waypoints[max(np.searchsorted(times, t, "right") - 1, 0)]
        ),
        "This is the nearest waypoint: between two waypoints the joint values change.": lambda times, waypoints, t: (
            waypoints[np.abs(times - t).argmin()]
        ),
        "This goes straight from the first waypoint to the last, and forgets those between.": (
            lambda times, waypoints, t: answer(times[[0, -1]], waypoints[[0, -1]], t)
        ),
    },
    hints=(
        "Between which two waypoints is t? np.searchsorted(times, t) finds the first time that is not before t.",
        "Which fraction s of the time between them has passed? The joint values have changed by the same fraction.",
        "np.interp(t, times, column) does this for one joint; call it for each column of the waypoints.",
    ),
)

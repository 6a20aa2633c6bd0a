"""Check of motions-3."""

import numpy as np

from ravemj.learn import Check


def question(random):
    return random.uniform(0.5, 3, 2) * random.choice([-1, 1], 2), random.uniform(2, 6, 2)


def cubic(goal, speeds, least=None, slower=1.5):
    u = np.linspace(0, 1, 101)
    T = slower * (np.max(np.abs(goal) / speeds) if least is None else least)
    return np.column_stack([T * u, np.outer(3 * u**2 - 2 * u**3, goal)])


def linear(goal, speeds):
    u = np.linspace(0, 1, 101)
    return np.column_stack([np.max(np.abs(goal) / speeds) * u, np.outer(u, goal)])


def judge(rows, goal, speeds):
    times, values = rows[:, 0], rows[:, 1:]
    if times[0] != 0 or (np.diff(times) <= 0).any():
        return "the first column should have times that begin with 0 and increase"
    if max(np.abs(values[0]).max(), np.abs(values[-1] - goal).max()) > 1e-5:
        return f"it goes from {values[0].round(4)} to {values[-1].round(4)}, not from [0 0] to {goal.round(4)}"
    used = np.abs(np.diff(values, axis=0)) / np.diff(times)[:, None] / speeds
    if used.max() > 1 + 1e-4:
        row, joint = np.unravel_index(used.argmax(), used.shape)
        return f"joint {joint} has {used.max():.2f} times its largest speed at {times[row]:.3f} s"
    if used[[0, -1]].max() > 0.05:
        return f"it does not start and end at rest: a joint has {100 * used[[0, -1]].max():.0f} % of its limit there"
    least = np.max(np.abs(goal) / speeds)
    if times[-1] > 2 * least * (1 + 1e-4):
        return f"it takes {times[-1]:.3f} s, and should take at most {2 * least:.3f} s"
    return None


CHECK = Check(
    function="swing",
    question=question,
    answer=cubic,
    judge=judge,
    mistakes={
        "The speed is constant, so the pendulum would have to start at once: let s start and end slowly.": (linear),
        "s = 3 u^2 - 2 u^3 is fastest in the middle, with 1.5 / T: the motion needs 1.5 times the time.": (
            lambda *arguments: cubic(*arguments, slower=1)
        ),
        "The duration is that of one joint: the slowest joint counts, the one with the largest distance / speed.": (
            lambda goal, speeds: cubic(goal, speeds, np.min(np.abs(goal) / speeds))
        ),
        "Distances may be negative: take the absolute value of each joint's distance.": (
            lambda goal, speeds: cubic(goal, speeds, np.max(goal / speeds))
        ),
    },
    hints=(
        "Use the cubic timing of the page: u from 0 to 1, and joint values s * goal. Which duration keeps the limits?",
        "s is fastest in the middle, with 1.5 / T. So joint i has the speed 1.5 |goal[i]| / T there.",
        "T is 1.5 times the largest |goal| / speeds; rows are T * u, s * goal[0], s * goal[1] for 101 values of u.",
    ),
)

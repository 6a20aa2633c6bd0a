"""Check of control-3."""

import numpy as np

from ravemj.learn import Check


def question(random):
    return random.uniform(0.05, 3), random.uniform(2, 40)


def damped(inertia, omega, ratio):
    """Return the gains with a damping ratio, of which 1 is critical."""
    return np.array([inertia * omega**2, 2 * ratio * inertia * omega])


def answer(inertia, omega):
    return damped(inertia, omega, 1)


CHECK = Check(
    function="gains",
    question=question,
    answer=answer,
    mistakes={
        "The gains are exchanged: the first one is kp, the second one kd.": lambda *arguments: answer(*arguments)[::-1],
        "kd is half as large as it should be: the joint overshoots. The factor 2 is missing.": lambda inertia, omega: (
            damped(inertia, omega, 0.5)
        ),
        "kd is twice as large as it should be: the joint creeps to its goal.": lambda inertia, omega: damped(
            inertia, omega, 2
        ),
        "The inertia is forgotten: a heavy joint needs larger gains for the same frequency.": lambda inertia, omega: (
            answer(1, omega)
        ),
        "The inertia is forgotten in kd, which is 2 sqrt(kp I).": lambda inertia, omega: np.array(
            [inertia * omega**2, 2 * np.sqrt(inertia) * omega]
        ),
        "omega is not squared in kp: omega is the square root of kp / I.": lambda inertia, omega: np.array(
            [inertia * omega, 2 * inertia * omega]
        ),
        "omega is not squared in kp, and kd follows from it: omega is the square root of kp / I.": (
            lambda inertia, omega: np.array([inertia * omega, 2 * inertia * np.sqrt(omega)])
        ),
        "omega is in rad/s already, and not a number of turns per second: there is no 2 pi.": lambda inertia, omega: (
            answer(inertia, 2 * np.pi * omega)
        ),
        "kd = 2 kp: it is 2 sqrt(kp I).": lambda inertia, omega: inertia * omega**2 * np.array([1, 2]),
    },
    hints=(
        "The frequency of a joint on a spring is sqrt(kp / I). Solve this for kp.",
        "kp = I omega^2. The page has the kd of critical damping, in terms of kp and I.",
        "kd = 2 sqrt(kp I), which is 2 I omega.",
    ),
)

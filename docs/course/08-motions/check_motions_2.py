"""Check of motions-2."""

import numpy as np

from ravemj.learn import Check


def question(random):
    start, goal = random.uniform(-2, 2, (2, 3))
    return start, goal, random.uniform(0.5, 3, 3), random.uniform(0.5, 8, 3)


def limits(start, goal, speeds, accelerations):
    """Return the largest speed and acceleration of s."""
    distances = np.abs(goal - start)
    return (speeds / distances).min(), (accelerations / distances).min()


def duration(v, a, distance=1):
    return np.where(v * v < a * distance, distance / v + v / a, 2 * np.sqrt(distance / a))


def answer(*arguments):
    return duration(*limits(*arguments))


def trapezoid(*arguments):
    v, a = limits(*arguments)
    return 1 / v + v / a


def separately(start, goal, speeds, accelerations):
    return duration(speeds, accelerations, np.abs(goal - start)).max()


def half_triangle(*arguments):
    v, a = limits(*arguments)
    return duration(v, a) if v * v < a else np.sqrt(2 / a)


def braking_forgotten(*arguments):
    v, a = limits(*arguments)
    return 1 / v + v / (2 * a) if v * v < 2 * a else np.sqrt(2 / a)


def in_space(start, goal, speeds, accelerations):
    return duration(speeds.min(), accelerations.min(), np.linalg.norm(goal - start))


CHECK = Check(
    function="shortest_duration",
    question=question,
    answer=answer,
    kind="number",
    mistakes={
        "The slowest joint decides, because all share one s: take the smallest speed and acceleration of s.": (
            lambda start, goal, speeds, accelerations: duration(
                (speeds / np.abs(goal - start)).max(), (accelerations / np.abs(goal - start)).max()
            )
        ),
        "Accelerations are forgotten: the robot cannot start with its full speed.": lambda *arguments: (
            1 / limits(*arguments)[0]
        ),
        "The triangle is forgotten: on a short path the robot has to brake before it reaches full speed.": trapezoid,
        "Each joint is timed on its own: on a straight line all share one s, so the smallest speed limit and the "
        "smallest acceleration limit of s count, also if they are those of different joints.": separately,
        "In the triangle, braking begins at half of the distance: it lasts 2 sqrt(1 / a).": half_triangle,
        "Braking is forgotten: the motion ends at rest.": braking_forgotten,
        "The length of the path is compared with the limits of single joints: divide each limit by the distance "
        "of its joint.": in_space,
    },
    hints=(
        "If s goes from 0 to 1, joint i has the speed |goal - start|[i] times that of s. How fast may s be at most?",
        "v is the smallest of speeds / distances, a that of accelerations / distances. How long does s take?",
        "If v * v < a, the duration is 1 / v + v / a (a trapezoid); else it is 2 sqrt(1 / a) (a triangle).",
    ),
)

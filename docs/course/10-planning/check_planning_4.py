"""Check of planning-4."""

import numpy as np

from ravemj.learn import Check

RADIUS = 0.12


class Disks:
    """Tells whether a straight line meets no disk."""

    def __init__(self, centres):
        self.centres = centres

    def __call__(self, a, b):
        a, way = np.asarray(a, dtype=float), np.subtract(b, a)
        part = np.clip((self.centres - a) @ way / max(way @ way, 1e-12), 0, 1)
        return bool((np.linalg.norm(a + part[:, None] * way - self.centres, axis=1) > RADIUS).all())

    def __repr__(self):
        return "is_free"


def question(random):
    while True:
        path = np.cumsum(random.normal(0, 0.25, (random.integers(6, 12), 2)), axis=0)
        disks = random.uniform(path.min(axis=0), path.max(axis=0), (40, 2))
        disks = disks[[all(map(Disks(disk[None]), path[:-1], path[1:])) for disk in disks]]
        if len(disks) and len(answer(path, Disks(disks))) > 2:
            return path, Disks(disks)


def walked(path, choose):
    """Return the waypoints that are left if each next one is chosen from those after it."""
    kept = [0]
    while kept[-1] < len(path) - 1:
        kept.append(choose(kept[-1], range(kept[-1] + 1, len(path))))
    return path[kept]


def farthest(path, is_free, here, after):
    return next(k for k in reversed(after) if is_free(path[here], path[k]))


def answer(path, is_free):
    return walked(path, lambda here, after: farthest(path, is_free, here, after))


def first_blocked(path, is_free):
    return walked(
        path,
        lambda here, after: next((k - 1 for k in after if not is_free(path[here], path[k])), len(path) - 1),
    )


def one_jump(path, is_free):
    k = farthest(path, is_free, 0, range(1, len(path)))
    return np.array([path[0], *path[k:]])


def judge(given, path, is_free):
    right = answer(path, is_free)
    if len(given) != len(right):
        return f"it leaves {len(given)} of {len(path)} waypoints, and should leave {len(right)}"
    wrong = np.flatnonzero(np.abs(given - right).max(axis=1) > 1e-5)
    if not len(wrong):
        return None
    return f"waypoint {wrong[0]} is {given[wrong[0]].round(4)}, and should be {right[wrong[0]].round(4)}"


CHECK = Check(
    function="shortened",
    question=question,
    answer=answer,
    judge=judge,
    any_length=True,
    mistakes={
        "Nothing is left out: try lines to waypoints that come later.": lambda path, is_free: path,
        "This stops at the first waypoint that cannot be reached: a later one may be visible again, so try all, "
        "from the last one backwards.": first_blocked,
        "Only the first waypoint is joined to a later one: go on from there, up to the end.": one_jump,
        "The lines are not checked: first and last waypoint are joined through obstacles.": (
            lambda path, is_free: path[[0, -1]]
        ),
        "The first waypoint is missing.": lambda path, is_free: answer(path, is_free)[1:],
        "The last waypoint is missing.": lambda path, is_free: answer(path, is_free)[:-1],
    },
    hints=(
        "From the first waypoint, try the last one, then the last but one, and so on. When does this end?",
        "At the latest with the next waypoint: lines between neighbours are free. Then go on from there.",
        "here = 0; while here < n - 1: here = the largest k > here with is_free(path[here], path[k]); keep path[here].",
    ),
)

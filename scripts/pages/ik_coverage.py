"""How arms are solved, and how well: writes ``docs/ik.md``.

    python scripts/pages/ik_coverage.py [CORPUS]

The corpus of published models is ../shared/corpus beside the repository by default. Where there is none, what the page
says about it stays as it is.
"""

import csv
import logging
import os
import statistics
import sys
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT)]

from ravemj.core.transforms import Floats, pose_of  # noqa: E402 - after the path is set
from ravemj.formats.readers import read_file  # noqa: E402
from ravemj.ik import ArmSolutions, Chain, NumericSolver, Task, make_solver  # noqa: E402
from ravemj.ik.arms import chain_of  # noqa: E402
from ravemj.ik.residuals import ToolState, residual_and_jacobian  # noqa: E402
from ravemj.ik.tasks import ANGLES, HEADINGS, goal_poses  # noqa: E402

PAGE = ROOT / "docs" / "ik.md"
POSES = 1000
TYPE_POSES = 100
JOINTS = range(4, 8)
SEED = 2026
TIMED = ("worst error", "time", "its time")
"""Columns that differ between machines."""
CORPUS = "## Published robots\n"
_ARMS_HEAD = """\
| robot | manipulator | joints | solved by | free | solved | own values | worst error | time | search | its time |
|---|---|---:|---|---|---:|---:|---:|---:|---:|---:|
"""
_TYPES_HEAD = """\
| type of goal | robot | solved by | free | solved | own values | worst error | time |
|---|---|---|---|---:|---:|---:|---:|
"""
HEAD = """\
# How inverse kinematics is solved

Which joint values bring the tool to a place? This page says how ravemj answers, and how well. The tables are made by
`scripts/pages/ik_coverage.py`; a test compares what does not depend on the machine.

```python
import numpy as np
import ravemj
from ravemj.formats.readers import read_file
from ravemj.ik import make_solver
from ravemj.ik.arms import chain_of

robot = read_file(ravemj.model_path("puma560")).scene.bodies[0]
chain = chain_of(robot, robot.manipulators[0])
solver = make_solver(chain)
print(solver.describe())

T_base_tool = chain.forward(np.array([0.3, -0.8, 0.9, 0.4, -0.5, 0.6]))
rows = solver.solve_one(T_base_tool)  # all within the limits, further turns included
nearest = solver.nearest(T_base_tool, np.zeros(6))
everywhere = solver.solve(np.stack([T_base_tool] * 1000))  # many poses at once
```

## From the axes to a solver

**An arm is a list of lines.** From the base to the tool, each joint is an axis and a point on it, where all values
are 0 (the product of exponentials, R. W. Brockett 1983). Everything follows from these lines, whatever file they come
from: nothing is compiled, and a solver is found in about ten milliseconds when it is first asked for.

**Families.** Six joints with a pose to reach are six equations in six unknowns. They fall apart when three neighbouring
joints form a *block*: axes that meet in a point (a spherical wrist or shoulder), parallel axes (as in the UR arms),
slides among these, or three slides. What the block keeps, its point or its plane, gives equations in the three other
joints, and those are the classical subproblems of B. Paden and W. Kahan: turn a point to a point, to a sphere, to a
plane. Mostly they are quadratic, so there are up to eight solutions; where no two axes meet or are parallel, a quartic
equation couples two joints (D. L. Pieper 1968). Arms with fewer joints get further ones that have to stay at 0. An arm
of six revolute joints in no special position leads to an eigenvalue problem of 24 rows (M. Raghavan and B. Roth 1993,
D. Manocha and J. F. Canny 1994), with up to sixteen solutions; it takes a hundred times longer.

**Nearly special arms.** Files give four to six digits, so that axes which should meet miss by micrometres. A family is
derived from the nearest exact geometry (within 1e-5 of the reach), and its solutions are refined by Newton's method on
the true one.

**A certificate.** A solver is used when it has proved itself: for 64 random configurations, all its solutions have to
reach their pose within 1e-9, and the configuration has to be among them. Later, every single solution is checked by
forward kinematics of the true arm, and dropped if it misses.

**Redundant arms.** Seven joints have a free one. It is sampled, from its present value outwards, every 0.1 rad, and
the rest is solved in closed form. Between a spherical shoulder and a spherical wrist the third joint is free, as in
OpenRAVE; in other arms it is the last joint, else the first one, else another, where that leaves a closed form. Several
free joints share 4096 samples.

A pose is reached for *intervals* of the free joint's values, and some are narrower than a step: near a folded elbow,
near limits. So where no sample has a solution, the places at which the samples come closest to the pose and to the
limits are searched. If the samples have solutions and all of them collide or are rejected, the ends of each interval
are found, and its ends, its middle and eight more points are tried, then, for collisions, points between these. A gap
in an interval that is narrower than a step is not seen. Of 10,000 poses of random configurations of a Panda, an iiwa, a
WAM and an arm with an offset shoulder, none is lost; `nearest_reachable` says by how much a pose is out of reach.

**Other goals than poses** leave something open. It becomes *virtual joints* at the tool: with a roll about its
direction for `TranslationDirection5D`, and a slide along it for `Ray4D`, the arm is one for poses again. For
`Rotation3D` and `Direction3D` all axes are moved to one point.

**The search** answers what is left: damped least squares (K. Levenberg, D. Marquardt; the damping is T. Sugihara's,
2011) within the limits, from up to 200 starts that fill the space of joint values evenly. It finds a solution, but its
list of solutions is not complete, and `describe()` says so. A weighted variant comes as near as it can where a goal is
out of reach, which is what dragging a hand needs.

## How to read the tables

The goals are tool poses of random configurations, uniform within the limits. *Solved*: a solution within the limits was
found, from the middle of the range. *Own values*: the joint values that made the goal are among the solutions, if free
joints keep theirs. *Worst error*: of any entry of the tool's pose. *Time*: of one goal, the nearest solution, median on
a busy core. *Search*: how many goals the search solves without the closed form.

"""
OURS = "## The robots of `models/`\n"
TYPES = "## Every type of goal\n"
_TYPES_NOTE = f"""\
{TYPE_POSES} goals of each type, for arms that have more joints than most of them need. Of the three types with `Norm`,
the goals are those of configurations in which the tool's direction is in their plane. Where nothing stands in
*own values*, the search answers, whose list is not complete.
"""
_CORPUS_NOTE = """\
Manipulators with four to seven joints of robots that people published for OpenRAVE; those with the same numbers once.
"""


@dataclass(frozen=True)
class Arm:
    """A manipulator of a robot in a file.

    Attributes:
        file: The file's name in parentheses, where it says more than the robot's.
        robot: The robot's name.
        manipulator: That of the manipulator.
        chain: Its joints.
    """

    file: str
    robot: str
    manipulator: str
    chain: Chain


def arms_of(path: Path, name: str = "") -> Iterator[Arm]:
    """Return the manipulators of a file that have joints."""
    for body in read_file(path).scene.bodies:
        for manipulator in body.manipulators:
            try:
                yield Arm(name, body.name, manipulator.name, chain_of(body, manipulator))
            except ValueError:  # no joints, or such as follow others
                continue


def our_arms() -> list[Arm]:
    """Return the first manipulator of each robot of ``models/``: the limbs of the biped are alike."""
    paths = [path for path in sorted((ROOT / "models").iterdir()) if path.suffix in {".xml", ".dae"}]
    first: dict[str, Arm] = {}
    for arm in _different([arm for path in paths for arm in arms_of(path)]):
        first.setdefault(arm.robot, arm)
    return list(first.values())


def corpus_arms(corpus: Path) -> list[Arm]:
    """Return the manipulators of the corpus with four to seven joints; arms with the same numbers once."""
    os.environ["OPENRAVE_DATA"] = str((corpus / "models" / "rdiankov+openrave" / "src").resolve())
    with open(corpus / "index.csv", encoding="utf8") as file:
        names = [row["file"] for row in csv.DictReader(file) if row["robots"] != "0"]
    found = [arm for name in names for arm in arms_of(corpus / "models" / name, f" ({name.rpartition('/')[2]})")]
    return _different([arm for arm in found if arm.chain.dof in JOINTS])


def _different(arms: list[Arm]) -> list[Arm]:
    known: dict[bytes, Arm] = {}
    for arm in arms:
        chain = arm.chain
        numbers = [chain.axes, chain.points, chain.T_base_tool, chain.lower, chain.upper, chain.circular]
        known.setdefault(b"".join(np.round(part + 0.0, 5).tobytes() for part in numbers), arm)
    return list(known.values())


def arm_row(arm: Arm, poses: int = POSES) -> list[str]:
    """Return the cells of an arm's line."""
    chain = arm.chain
    solver, search = make_solver(chain), NumericSolver(chain)
    values = random_values(chain, poses)
    goals = chain.forward(values)
    cells = [f"`{arm.robot}`{arm.file}", f"`{arm.manipulator}`", str(chain.dof), *_answers(solver, values, goals)]
    found, took = _asked([lambda goal=goal: search.solve(goal) for goal in goals])
    return [*cells, _share(sum(one is not None for one in found), poses), f"{took:.0f} µs"]


def type_row(arm: Arm, task: Task, poses: int = TYPE_POSES) -> list[str]:
    """Return the cells of the line of a type of goal."""
    values = random_values(arm.chain, poses)
    if task in HEADINGS:
        values = _level(arm.chain, task, values)
    goals = np.array([goal_of(arm.chain, task, row) for row in values])
    return [f"`{task.value}`", f"`{arm.robot}`", *_answers(make_solver(arm.chain, task), values, goals)]


def _level(chain: Chain, task: Task, values: Floats) -> Floats:
    """Return configurations in which the tool's direction is in the plane that a task wants, found from others."""
    search = NumericSolver(chain, task)
    goals = goal_poses(chain, task, np.array([goal_of(chain, task, row) for row in values]))
    found = [search.solve(goal, row, starts=5) for goal, row in zip(goals, values, strict=True)]
    return np.array([row for row in found if row is not None])


def _answers(solver: ArmSolutions, values: Floats, goals: Floats) -> list[str]:
    """Return what solves goals, the free joints, the shares, the worst error and the median time."""
    chain = solver.chain
    limited = np.isfinite(chain.lower + chain.upper)
    middle = np.where(limited, (np.where(limited, chain.lower, 0) + np.where(limited, chain.upper, 0)) / 2, 0)
    found, took = _asked([lambda goal=goal: solver.nearest(goal, middle) for goal in goals])
    solved = [(row, goal) for row, goal in zip(found, goals, strict=True) if row is not None]
    errors = [distance(chain, solver.task, goal, row) for row, goal in solved]
    free = ", ".join(f"{joint + 1}" for joint in solver.free)
    shares = [_share(len(solved), len(goals)), own_values(solver, values, goals)]
    return [kind(solver), free, *shares, f"{max(errors):.0e}", f"{took:.0f} µs"]


def distance(chain: Chain, task: Task, goal: Floats, values: Floats) -> float:
    """Return what a configuration lacks of a goal, the greatest component [m or rad]."""
    pose, tool = goal_poses(chain, task, goal), chain.forward(values)
    jacobian = chain.forward_and_jacobian(values[None])[1][0]
    missing, _ = residual_and_jacobian(chain, task, pose, ToolState(tool[:3, :3], tool[:3, 3], jacobian), np.ones(6))
    return float(np.abs(missing).max())


def goal_of(chain: Chain, task: Task, values: Floats) -> Floats:
    """Return the goal of a type that a configuration reaches, with OpenRAVE's numbers."""
    tool = chain.forward(values)
    place, direction = tool[:3, 3], tool[:3, :3] @ chain.direction
    if task is Task.TRANSFORM:
        return tool
    if task in ANGLES:
        return np.append(np.arccos(direction[ANGLES[task]]), place)
    if task in HEADINGS:
        x, y = direction[HEADINGS[task]], direction[(HEADINGS[task] + 1) % 3]
        return np.append(np.arctan2(y, x), place)
    local = np.array([0.05, 0.1, -0.02])
    return {
        Task.ROTATION: np.array(pose_of(tool).wxyz),
        Task.PLACE: place,
        Task.DIRECTION: direction,
        Task.RAY: np.append(direction, place + 0.3 * direction),
        Task.LOOK_AT: place + 0.5 * direction,
        Task.PLACE_DIRECTION: np.append(direction, place),
        Task.PLACE_XY: place[:2],
        Task.PLANAR: np.append(place[:2], np.arctan2(direction[1], direction[0])),
        Task.LOCAL_PLACE: np.append(local, place + tool[:3, :3] @ local),
    }[task]


def random_values(chain: Chain, count: int) -> Floats:
    """Return joint values within the limits, shape (count, n)."""
    endless = chain.circular | ~np.isfinite(chain.upper - chain.lower)
    span = np.where(chain.prismatic, chain.reach, np.pi)
    low, high = np.where(endless, -span, chain.lower), np.where(endless, span, chain.upper)
    return np.random.default_rng(SEED).uniform(low, high, (count, chain.dof))


def kind(solver: ArmSolutions) -> str:
    """Return in a few words what solves an arm."""
    return "search" if solver.closed is None else f"{solver.closed.family.name}: {solver.closed.family.equations}"


def own_values(solver: ArmSolutions, values: Floats, goals: Floats) -> str:
    """Return the share of configurations that are among the solutions of their goals; free joints keep their values."""
    if solver.closed is None:
        return ""
    poses = goal_poses(solver.chain, solver.task, goals)
    found = solver.closed.solve(poses, values[:, list(solver.free)])
    away = found.values - values[:, None]
    turning = ~solver.chain.prismatic
    away[..., turning] = 2 * np.sin(away[..., turning] / 2)
    own = ((np.abs(away).max(axis=2) < 1e-5) & found.valid).any(axis=1)
    return _share(int(own.sum()), len(poses))


def _asked(calls: Sequence[Callable[[], Floats | None]]) -> tuple[list[Floats | None], float]:
    """Return the answers, and the median time of one [µs]."""
    answers, times = list[Floats | None](), list[float]()
    for call in calls:
        begin = time.process_time()
        answers.append(call())
        times.append((time.process_time() - begin) * 1e6)
    return answers, statistics.median(times)


def _share(part: int, whole: int) -> str:
    return "100 %" if part == whole else f"{100 * part / whole:.1f} %"


def table(head: str, rows: Iterable[list[str]]) -> str:
    """Return a table."""
    return head + "".join("| " + " | ".join(row) + " |\n" for row in rows)


def cells(page: str, heading: str) -> list[dict[str, str]]:
    """Return the rows of the table below a heading, each by the names of its columns."""
    lines = page.partition(heading)[2].partition("\n## ")[0].splitlines()
    columns, _, *rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if line.startswith("|")]
    return [dict(zip(columns, row, strict=True)) for row in rows]


def markdown(corpus: Path) -> str:
    """Return the page; without a corpus, what it says about published robots stays as it is."""
    ours = [arm for arm in our_arms() if arm.chain.dof in JOINTS]
    several = [arm for arm in ours if arm.chain.dof > 5 and arm.robot != "Biped"]  # whose leg is solved as the PUMA is
    page = HEAD + OURS + "\n" + table(_ARMS_HEAD, map(arm_row, ours)) + "\n"
    rows = (type_row(arm, task) for task in Task for arm in several)
    page += f"{TYPES}\n{_TYPES_NOTE}\n" + table(_TYPES_HEAD, rows) + "\n" + CORPUS
    if not (corpus / "index.csv").is_file():
        return page + PAGE.read_text(encoding="utf-8").partition(CORPUS)[2]
    return page + "\n" + _CORPUS_NOTE + "\n" + table(_ARMS_HEAD, map(arm_row, corpus_arms(corpus)))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    logging.disable(logging.CRITICAL)
    made = markdown(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT.parent / "shared" / "corpus")
    PAGE.write_text(made, encoding="utf-8")

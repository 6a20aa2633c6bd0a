"""How arms are solved, and how well: ``docs/ik.md``.

    python scripts/pages/ik.py [CORPUS] > docs/ik.md

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
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT)]

from ravemj.core.transforms import Floats  # noqa: E402 - after the path is set
from ravemj.formats.readers import read_file  # noqa: E402
from ravemj.ik import Chain, IKSolver, NumericSolver, make_solver  # noqa: E402
from ravemj.ik.arms import chain_of  # noqa: E402

PAGE = ROOT / "docs" / "ik.md"
POSES = 1000
JOINTS = range(4, 8)
SEED = 2026
_CORPUS_HEADING = "## Published robots\n"
_TABLE = """\
| robot | manipulator | joints | solved by | free | solved | own posture | worst error | time | search | its time |
|---|---|---:|---|---|---:|---:|---:|---:|---:|---:|
"""
TIMED = ("worst error", "time", "its time")
"""Columns that differ between machines."""


@dataclass(frozen=True)
class Arm:
    """A manipulator of a robot in a file.

    Attributes:
        file: The file's name.
        robot: The robot's name.
        manipulator: That of the manipulator.
        chain: Its joints.
    """

    file: str
    robot: str
    manipulator: str
    chain: Chain


def arms_of(path: Path, name: str) -> Iterator[Arm]:
    """Return the manipulators of a file that have joints, with a name for the file."""
    for body in read_file(path).scene.bodies:
        for manipulator in body.manipulators:
            try:
                yield Arm(name, body.name, manipulator.name, chain_of(body, manipulator))
            except ValueError:  # no joints, or such as follow others
                continue


def our_arms() -> list[Arm]:
    """Return the manipulators of ``models/``; each robot once."""
    paths = [path for path in sorted((ROOT / "models").iterdir()) if path.suffix in {".xml", ".dae"}]
    return _different([arm for path in paths for arm in arms_of(path, path.name)])


def corpus_arms(corpus: Path) -> list[Arm]:
    """Return the manipulators of the corpus with four to seven joints; arms with the same numbers once."""
    os.environ["OPENRAVE_DATA"] = str((corpus / "models" / "rdiankov+openrave" / "src").resolve())
    with open(corpus / "index.csv", encoding="utf8") as file:
        names = [row["file"] for row in csv.DictReader(file) if row["robots"] != "0"]
    found = [arm for name in names for arm in arms_of(corpus / "models" / name, name)]
    return _different([arm for arm in found if arm.chain.dof in JOINTS])


def _different(arms: list[Arm]) -> list[Arm]:
    known: dict[bytes, Arm] = {}
    for arm in arms:
        chain = arm.chain
        numbers = [chain.axes, chain.points, chain.T_base_tool, chain.lower, chain.upper, chain.circular]
        known.setdefault(b"".join(np.round(part + 0.0, 5).tobytes() for part in numbers), arm)
    return list(known.values())


def row(arm: Arm) -> list[str]:
    """Return the cells of an arm's line."""
    chain = arm.chain
    solver = make_solver(chain)
    values = random_values(chain)
    poses = chain.forward(values)
    middle = (chain.lower + chain.upper) / 2 if np.isfinite(chain.lower + chain.upper).all() else np.zeros(chain.dof)
    ours, took = _asked([lambda pose=pose: solver.nearest(pose, middle) for pose in poses])
    search = NumericSolver(chain)
    found, searched = _asked([lambda pose=pose: search.solve(pose) for pose in poses])
    errors = [np.abs(chain.forward(one) - pose).max() for one, pose in zip(ours, poses, strict=True) if one is not None]
    return [
        f"`{arm.robot}`",
        f"`{arm.manipulator}`",
        str(chain.dof),
        kind(solver),
        ", ".join(f"{joint + 1}" for joint in solver.free),
        _share(sum(one is not None for one in ours), POSES),
        own_postures(solver, values, poses),
        f"{max(errors):.0e}",
        f"{took:.0f} µs",
        _share(sum(one is not None for one in found), POSES),
        f"{searched:.0f} µs",
    ]


def random_values(chain: Chain) -> Floats:
    """Return joint values within the limits, shape (POSES, n)."""
    endless = chain.circular | ~np.isfinite(chain.upper - chain.lower)
    span = np.where(chain.prismatic, chain.reach, np.pi)
    low, high = np.where(endless, -span, chain.lower), np.where(endless, span, chain.upper)
    return np.random.default_rng(SEED).uniform(low, high, (POSES, chain.dof))


def kind(solver: IKSolver) -> str:
    """Return in a few words what solves an arm."""
    return "search" if solver.closed is None else f"{solver.closed.family.name}: {solver.closed.family.equations}"


def own_postures(solver: IKSolver, values: Floats, poses: Floats) -> str:
    """Return the share of postures that are among the solutions of their poses, free joints having their values."""
    if solver.closed is None:
        return ""
    found = solver.closed.solve(poses, values[:, list(solver.free)])
    away = found.values - values[:, None]
    turning = ~solver.chain.prismatic
    away[..., turning] = 2 * np.sin(away[..., turning] / 2)
    own = ((np.abs(away).max(axis=2) < 1e-5) & found.valid).any(axis=1)
    return _share(int(own.sum()), len(poses))


def _asked(calls) -> tuple[list[Floats | None], float]:  # noqa: ANN001 - of functions that return an answer
    """Return the answers, and the median time of one [µs]."""
    answers, times = list[Floats | None](), list[float]()
    for call in calls:
        begin = time.process_time()
        answers.append(call())
        times.append((time.process_time() - begin) * 1e6)
    return answers, statistics.median(times)


def _share(part: int, whole: int) -> str:
    return "100 %" if part == whole else f"{100 * part / whole:.1f} %"


def table(arms: list[Arm]) -> str:
    """Return the table of some arms."""
    return _TABLE + "".join("| " + " | ".join(row(arm)) + " |\n" for arm in arms)


def cells(page: str, heading: str) -> list[dict[str, str]]:
    """Return the rows of the table below a heading, without the columns that differ between machines."""
    lines = page.partition(heading)[2].partition("\n## ")[0].splitlines()
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if line.startswith("|")]
    columns = rows[0]
    return [{name: cell for name, cell in zip(columns, line, strict=True) if name not in TIMED} for line in rows[2:]]


def markdown(corpus: Path) -> str:
    """Return the page."""
    page = HEAD + OUR_HEADING + OUR_TEXT + table([arm for arm in our_arms() if arm.chain.dof in JOINTS])
    if (corpus / "index.csv").is_file():
        return page + "\n" + _CORPUS_HEADING + CORPUS_TEXT + table(corpus_arms(corpus))
    return page + "\n" + _CORPUS_HEADING + PAGE.read_text(encoding="utf-8").partition(_CORPUS_HEADING)[2]


OUR_HEADING = "## The robots of `models/`\n"
HEAD = ""
OUR_TEXT = CORPUS_TEXT = "\n"

if __name__ == "__main__":
    warnings.simplefilter("ignore")
    logging.disable(logging.CRITICAL)
    sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    sys.stdout.write(markdown(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT.parent / "shared" / "corpus"))

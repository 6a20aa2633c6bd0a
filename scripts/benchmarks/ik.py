"""Inverse kinematics: deriving a solver, one pose, many poses, free joints, and the search."""

import importlib
import statistics
import time
from collections.abc import Callable
from dataclasses import replace

import mujoco
import numpy as np

from benchmarks.measure import ROOT, Row, microseconds, take_turns
from ravemj.core.transforms import Floats
from ravemj.formats.readers import read_file
from ravemj.ik import Chain, NumericSolver, make_solver
from ravemj.ik.arms import chain_of
from ravemj.ik.numeric import CompiledKinematics

MANY = 20000
POSES = 200
_BETWEEN = [
    [-1.87, -1.69, -0.3, -0.75, 1.75, 1.79, 2.84],
    [-2.23, -1.57, -2.32, -3.06, 1.55, 1.72, 2.45],
    [-0.74, -1.6, 1.56, -0.6, -2.27, 1.69, -2.85],
    [0.18, -1.49, 2.78, -1.05, 2.06, 1.79, 2.87],
]
"""Configurations of a Panda whose poses have no solution at any sample of its free joint from 0 outwards."""
_IDLE = "the limit is that of µs on an idle machine, where the floor is 1"


def rows() -> list[Row]:
    """Measure the arms of our models, and one with three parallel axes."""
    puma, panda, parallel = _model("puma560.xml"), _model("panda.xml"), _parallel()
    found = [_derived(name, chain) for name, chain in (("PUMA", puma), ("Panda", panda), ("UR-like", parallel))]
    found += [_batch("PUMA", puma, 8.0), _batch("UR-like", parallel, None), _batch("six general joints", _odd(), None)]
    found += [_one("PUMA", puma, 250.0), _one("UR-like", parallel, None), _eaik("PUMA", puma), _first(panda)]
    found += _hard(panda)
    return found + _searches("PUMA", puma) + _searches("Panda", panda)


def _model(name: str) -> Chain:
    scene = read_file(ROOT / "models" / name).scene
    body = next(body for body in scene.bodies if body.manipulators)
    return chain_of(body, body.manipulators[0])


def _parallel() -> Chain:
    """Return an arm of the shape of the UR5."""
    y, z = [0, 1, 0], [0, 0, 1]
    points = [[0, 0, 0.09], [0, 0, 0.09], [0.425, 0, 0.09], [0.817, 0, 0.09], [0.817, 0.109, 0.09], [0.817, 0.109, 0]]
    tool = np.array([[1.0, 0, 0, 0.817], [0, 0, 1, 0.191], [0, -1, 0, -0.005], [0, 0, 0, 1]])
    return Chain.of([z, y, y, y, [0, 0, -1], y], points, T_base_tool=tool)


def _odd() -> Chain:
    rng = np.random.default_rng(0)
    return Chain.of(rng.normal(size=(6, 3)), rng.uniform(-1, 1, (6, 3)))


def _poses(chain: Chain, count: int) -> tuple[Floats, Floats]:
    values = np.random.default_rng(7).uniform(chain.lower, chain.upper, (count, chain.dof))
    return values, chain.forward(values)


def _derived(name: str, chain: Chain) -> Row:
    (measured,) = take_turns([microseconds(lambda: make_solver(replace(chain)))], 9)
    return Row(f"{name}: derive, certificate included", "ms", measured / 1e3, 1.0, 50.0, note="limit in ms")


def _batch(name: str, chain: Chain, limit: float | None) -> Row:
    """Compare with MuJoCo's forward kinematics of one configuration, in a loop, which slows down as we do."""
    solver = make_solver(chain).closed
    if solver is None:
        raise RuntimeError(f"{name} has no closed form")
    count = MANY if limit else MANY // 10
    values, poses = _poses(chain, count)
    found = solver.solve(poses)
    if not found.valid.any(axis=1).all():
        raise RuntimeError("a pose has no solution")
    batch, floor = take_turns([microseconds(lambda: solver.solve(poses)), microseconds(_floor(chain, values), 1)], 5)
    mean = found.valid.sum() / count
    note = f"{mean:.1f} solutions a pose; {_IDLE}"
    return Row(
        f"{name}: all solutions, a pose of a batch : mj_kinematics", "µs", batch / count, floor / 100, limit, note=note
    )


def _floor(chain: Chain, values: Floats) -> Callable[[], None]:
    compiled = CompiledKinematics(chain)
    model, data = compiled.model, compiled.data

    def place() -> None:
        for row in values[:100]:
            data.qpos[:] = row
            mujoco.mj_kinematics(model, data)

    return place


def _one(name: str, chain: Chain, limit: float | None) -> Row:
    solver = make_solver(chain)
    values, poses = _poses(chain, POSES)

    def each() -> None:
        for pose in poses:
            solver.solve_one(pose)

    measured, floor = take_turns([microseconds(each), microseconds(_floor(chain, values), 1)], 5)
    what = f"{name}: all solutions of one pose : mj_kinematics"
    return Row(what, "µs", measured / POSES, floor / 100, limit, note=_IDLE)


def _eaik(name: str, chain: Chain) -> Row:
    """Compare one core of our batch with a loop of EAIK, which is C++ behind a call from Python for each pose."""
    what = f"{name}: all solutions, a pose of a batch : EAIK"
    solver = make_solver(chain).closed
    if solver is None:
        raise RuntimeError(f"{name} has no closed form")
    _, poses = _poses(chain, MANY // 10)
    ours = microseconds(lambda: solver.solve(poses))
    try:
        HPRobot = importlib.import_module("eaik.IK_HP").HPRobot
    except ImportError:
        (measured,) = take_turns([ours], 5)
        return Row(what, "µs", measured / len(poses), note="no EAIK here: pip install --no-deps EAIK")
    points = np.vstack([np.zeros(3), chain.points, chain.T_base_tool[:3, 3]])
    other = HPRobot(chain.axes, np.diff(points, axis=0))
    turned = poses.copy()
    turned[:, :3, :3] = poses[:, :3, :3] @ chain.T_base_tool[:3, :3].T
    rows = np.array(other.IK(turned[0]).Q)
    if not (np.abs(chain.forward(rows) - poses[0]).max(axis=(1, 2)) < 1e-6).any():
        raise RuntimeError("EAIK answers another question")
    measured, floor = take_turns([ours, microseconds(lambda: [other.IK(pose) for pose in turned])], 5)
    return Row(what, "µs", measured / len(poses), floor / len(poses))


def _first(chain: Chain) -> Row:
    solver = make_solver(chain)
    values, poses = _poses(chain, POSES)
    median, share = _median([lambda pose=pose: solver.nearest(pose, np.zeros(chain.dof)) for pose in poses])
    what = "Panda: nearest solution within limits, median : mj_kinematics"
    return _single(what, chain, values, median, 1000.0, f"{share:.1%} of the poses; ")


def _hard(chain: Chain) -> list[Row]:
    """Measure all solutions of poses between the samples of the free joint, and of poses out of reach."""
    solver, values = make_solver(chain), np.resize(_BETWEEN, (POSES, chain.dof))
    near = chain.forward(values)
    far = near.copy()
    far[:, :3, 3] *= 3
    rows: list[Row] = []
    for what, poses in (("between two samples", near), ("out of reach", far)):
        median, _ = _median([lambda pose=pose: solver.solve_one(pose) for pose in poses])
        label = f"Panda: all solutions of a pose {what}, median : mj_kinematics"
        rows.append(_single(label, chain, values, median, 3000.0, ""))
    return rows


def _searches(name: str, chain: Chain) -> list[Row]:
    solver = NumericSolver(chain)
    values, poses = _poses(chain, POSES)
    near = values + np.random.default_rng(1).uniform(-0.2, 0.2, values.shape)
    anywhere, share = _median([lambda pose=pose: solver.solve(pose) for pose in poses])
    tracking, _ = _median([lambda pair=pair: solver.solve(*pair) for pair in zip(poses, near, strict=True)])
    found = f"{share:.1%} of the poses; "
    return [
        _single(f"{name}: search from anywhere, median : mj_kinematics", chain, values, anywhere, 500.0, found),
        _single(f"{name}: search from nearby, median : mj_kinematics", chain, values, tracking, 200.0, ""),
    ]


def _single(what: str, chain: Chain, values: Floats, measured: float, limit: float, note: str) -> Row:
    (floor,) = take_turns([microseconds(_floor(chain, values), 1)], 5)
    return Row(what, "µs", measured, floor / 100, limit, note=note + _IDLE)


def _median(calls: list[Callable[[], Floats | None]]) -> tuple[float, float]:
    """Return the median time of calls [µs], and the share of them that return something."""
    times, found = list[float](), 0
    for call in calls:
        begin = time.process_time()
        found += call() is not None
        times.append((time.process_time() - begin) * 1e6)
    return statistics.median(times), found / len(calls)

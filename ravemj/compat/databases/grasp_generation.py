"""Generation of grasp tables: test grasp candidates as a sweep, and collect the successful ones."""

import itertools
import logging
import pickle
import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.compat.databases.grasp_use import GraspUse
from ravemj.core.progress import progress_bar
from ravemj.core.transforms import Floats
from ravemj.engine.simulation.record import WorldRecord
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.geometry_functions.poses import poseFromMatrix
from ravemj.manipulation.grasping.wrenches import epsilon
from ravemj.rave.environment import Environment
from ravemj.rave.planning.planner import PlanningError
from ravemj.sweeps.digests import digest
from ravemj.sweeps.driver import SweepError
from ravemj.sweeps.shards import Arrays, joined, read_shard
from ravemj.sweeps.sweep import Sweep, sweep, versions

BLOCK = 16
"""Number of candidates per result file; at most this many are lost if a process dies."""

MANIFEST = "manifest.json"
_BACK = 9e-5  # m, step of a hand away from the target: OpenRAVE's collision_escape_offset
_MOST_BACK = 2000  # steps

_LOG = logging.getLogger("ravemj")


@dataclass(frozen=True)
class Settings:
    """Settings of a generation, in types that JSON can store.

    Attributes:
        robot: Name of the robot.
        manip: Name of its manipulator.
        target: Name of the target.
        more: Number of columns of each user-defined grasp property, by name.
        friction: Friction coefficient.
        avoidlinks: Names of links that must not touch.
        plannername: Name of the grasp planner; None: the default.
        translationstepmult: Factor of the steps for sliders and the hand's translation [m/rad]; None: the default.
        finestep: Tolerance of contacts [rad]; None: the default.
        graspingnoise: Random displacement of the target [m].
        tries: Number of runs with noise.
        threshold: Minimum ``mindist`` of a grasp, its margin of force closure; None accepts all grasps.
    """

    robot: str
    manip: str
    target: str
    more: Mapping[str, int]
    friction: float
    avoidlinks: Sequence[str]
    plannername: str | None
    translationstepmult: float | None
    finestep: float | None
    graspingnoise: float
    tries: int
    threshold: float | None


class Generation(NamedTuple):
    """Result of a generation, which may be unfinished.

    Attributes:
        rows: Successful grasps, sorted by ``performance``, shape (n, m).
        rejected: Number of rejected candidates by reason.
        tried: Number of tested candidates.
        candidates: Number of all candidates.
    """

    rows: Floats
    rejected: Counter[str]
    tried: int
    candidates: int


class Tried(NamedTuple):
    """Successful grasp, with its contacts and the robot's final configuration.

    Attributes:
        row: The grasp.
        contacts: Positions and normals in the world, shape (n, 6).
        values: Joint values after closing.
        T_world_robot: Pose of the robot after closing, shape (4, 4).
    """

    row: Floats
    contacts: Floats
    values: Floats
    T_world_robot: Floats


Check = Callable[[Tried], bool]
"""Function that returns whether to keep a grasp."""


def candidates(
    columns: Mapping[str, Sequence[int]], width: int, approachrays: Floats, parts: Mapping[str, Floats], fixed: Floats
) -> Floats:
    """Return a candidate for each combination of an approach ray and property values; the last property varies fastest.

    Args:
        columns: Column indices of each property.
        width: Number of columns of a candidate.
        approachrays: Points and outward normals, shape (n, 6).
        parts: Values of each property, one per row.
        fixed: Closing directions of the gripper joints.
    """
    rows: list[Floats] = []
    for ray, *values in itertools.product(approachrays, *parts.values()):
        row = np.zeros(width)
        row[list(columns["igrasppos"])], row[list(columns["igraspdir"])] = ray[:3], -ray[3:]
        row[list(columns["ichuckingdirection"])] = fixed
        for name, value in zip(parts, values, strict=True):
            row[list(columns[name])] = value
        rows.append(row)
    return np.array(rows).reshape(-1, width)


# What processes do


def try_candidates(
    env: Environment,
    items: NDArray[Any],
    random: np.random.Generator,
    **options: Any,  # noqa: ANN401 - `Settings`
) -> Arrays:
    """Test grasp candidates; the processes of ``ravemj.sweep`` call this function.

    Args:
        env: An environment with robot and target.
        items: Rows of candidates.
        random: Not used: the grasp planner makes the noise.
        options: The fields of `Settings`.
    """
    del random
    settings = Settings(**options)
    model = _model(env, settings)
    return joined([tried(model, row, settings) for row in np.asarray(items, float)])


def _model(env: Environment, settings: Settings) -> GraspUse:
    from ravemj.compat.databases.grasping import GraspingModel  # noqa: PLC0415 - it imports this

    robot, target = env.GetRobot(settings.robot), env.GetKinBody(settings.target)
    assert robot is not None
    assert target is not None
    robot.SetActiveManipulator(settings.manip)
    model = GraspingModel(robot, target, graspparametersdof=dict(settings.more))
    links = [robot.GetLink(name) for name in settings.avoidlinks]
    model.init(settings.friction, links, settings.plannername)
    model.translationstepmult, model.finestep = settings.translationstepmult, settings.finestep
    return model


def tried(model: GraspUse, row: Floats, settings: Settings) -> Arrays:
    """Test one candidate. Return its row, contacts and final configuration, and the reason if it is rejected."""
    row, reason = row.copy(), ""
    contacts, values, pose = np.zeros((0, 6)), model.robot.GetDOFValues(), None
    try:
        contacts, (values, pose), stable, _ = model.testGrasp(
            grasp=row, graspingnoise=settings.graspingnoise, Ngraspingtries=settings.tries
        )
        mindist = epsilon(contacts[:, :3], contacts[:, 3:], settings.friction)
        if stable == 0:
            reason = "varies with noise"
        elif settings.threshold is not None and mindist < settings.threshold:
            reason = f"not closed ({len(contacts)} contacts)"
        else:
            _complete(model, row, (contacts, values, _pose(pose), mindist))
    except PlanningError as error:
        reason = str(error.parameter)
    row_of_table = {"rows": row, "contacts": contacts, "values": values, "T_world_robot": _pose(pose)}
    row_of_table |= {"count": np.array(len(contacts)), "reason": np.array(reason)}
    return {name: np.asarray(value)[None] for name, value in row_of_table.items()}


def _pose(T_world_robot: Floats | None) -> Floats:
    return np.eye(4) if T_world_robot is None else T_world_robot


def _complete(model: GraspUse, row: Floats, answer: tuple[Floats, Floats, Floats, float]) -> None:
    """Write the tool pose, finger values and quality of a successful grasp into its table row."""
    contacts, values, T_world_robot, mindist = answer
    robot, manip, target, columns = model.robot, model.manip, model.target, model.graspindices
    T_target_world = np.linalg.inv(target.GetTransform())
    with robot:
        robot.SetTransform(T_world_robot)
        robot.SetDOFValues(values)
        T = T_target_world @ manip.GetTransform()
        fingers = values[list(manip.GetGripperIndices())]
        model.setPreshape(row)
        away = T.copy()
        for _ in range(_MOST_BACK):
            if not manip.CheckEndEffectorCollision(target.GetTransform() @ away):
                break
            away[:3, 3] -= _BACK * row[list(columns["igraspdir"])]
    center = target.ComputeLocalAABB().pos()
    places = contacts[:, :3] @ T_target_world[:3, :3].T + T_target_world[:3, 3]
    kind = float(int(IkParameterizationType.Transform6D))
    results = {
        "igrasptrans": T[:3].T.ravel(),
        "grasptrans_nocol": away[:3].T.ravel(),
        "graspikparam_nocol": np.concatenate([[kind], poseFromMatrix(away)]),
        "igraspfinalfingers": fingers,
        "forceclosure": mindist,
        "performance": -((places - center) ** 2).sum(axis=1).min(initial=np.inf),
    }
    for name, value in results.items():
        row[list(columns[name])] = value


# What the generation does with them


class GenerationJob(NamedTuple):
    """Files and processes of a generation.

    Attributes:
        folder: Folder of unfinished generations.
        processes: Number of processes.
        alone: Whether bodies other than robot and target are left out.
    """

    folder: str
    processes: int
    alone: bool


def generate(
    model: GraspUse, rows: Floats, settings: Settings, job: GenerationJob, check: Check | None
) -> tuple[Generation, Path]:
    """Test grasp candidates, except those that an interrupted earlier call has tested.

    Args:
        model: Robot and target.
        rows: Candidates.
        settings: Settings of the tests.
        job: Folder and number of processes.
        check: Called with each grasp as soon as it is found; with one process, in the order of the candidates. Its
            errors end the generation, and the files are removed.

    Returns:
        The result, and the folder with its files.

    Raises:
        SweepError: testing failed with an error.
        KeyboardInterrupt: the user stopped it; the log says how to resume.
    """
    with _copy(model, job.alone) as env:
        options = vars(settings) | {"more": dict(settings.more), "avoidlinks": list(settings.avoidlinks)}
        key = digest(
            (WorldRecord.from_simulation(env.simulation), rows, sorted(map(repr, options.items())), versions())
        )[:16]
        parts = _writable(Path(job.folder) / key)
        chosen = _GraspFilter(check, parts)
        if (parts / MANIFEST).exists():
            done = Sweep.open(parts).done
            _LOG.warning("going on with %d of %d candidates that are tried already", done, len(rows))
        try:
            chosen.update()
            with progress_bar("grasps", len(rows)) as show:

                def progress(done: int, total: int, failed: int) -> None:
                    del total, failed
                    show(min(done * BLOCK, len(rows)))
                    chosen.update()

                _run(env, rows, parts, options, job.processes, progress)
        except SweepError:
            raise
        except Exception:  # of the check
            forget(parts)
            raise
        chosen.update()
        return collected(model.graspindices, parts, chosen), parts


class _GraspFilter:
    """Filter that calls the user's function once for each grasp in the result files (shards) of the sweep."""

    def __init__(self, check: Check | None, parts: Path) -> None:
        self._check, self._parts = check, parts
        self.reasons: dict[Path, NDArray[Any]] = {}

    def update(self) -> None:
        """Call the user's function with the valid grasps in result files written since the last call."""
        if self._check is None or not (self._parts / MANIFEST).exists():
            return
        for path in Sweep.open(self._parts).files:
            if path not in self.reasons:
                arrays = read_shard(path)
                reasons = arrays["reason"].astype(object)
                for i in np.flatnonzero(arrays["reason"] == ""):
                    contacts = arrays["contacts"][i, : arrays["count"][i]]
                    grasp = Tried(arrays["rows"][i], contacts, arrays["values"][i], arrays["T_world_robot"][i])
                    reasons[i] = "" if self._check(grasp) else "refused by checkgraspfn"
                self.reasons[path] = reasons


def _run(
    env: Environment,
    rows: Floats,
    parts: Path,
    options: Mapping[str, Any],
    processes: int,
    told: Callable[[int, int, int], object],
) -> None:
    try:
        named: dict[str, Any] = {"block": BLOCK, "shard": BLOCK, "progress": told, "options": options}
        executor = processes if processes > 1 else None
        sweep(env, try_candidates, rows, parts, executor=executor, check=True, **named)
    except KeyboardInterrupt:
        done = Sweep.open(parts).done if (parts / MANIFEST).exists() else 0
        _LOG.warning("stopped: %d of %d candidates are tried; the same call goes on from there", done, len(rows))
        raise


def collected(columns: Mapping[str, Sequence[int]], parts: Path, chosen: _GraspFilter | None = None) -> Generation:
    """Read the grasps of a finished or unfinished generation from the folder ``parts``; ``chosen`` filters them."""
    done = Sweep.open(parts)
    arrays: Mapping[str, NDArray[Any]] = done.arrays(partial=True)
    if not arrays:
        return Generation(np.zeros((0, 0)), Counter(), 0, done.total)
    reasons = arrays["reason"]
    if chosen is not None and chosen.reasons:
        reasons = np.concatenate([chosen.reasons[path] for path in done.files])
    rows = arrays["rows"][reasons == ""]
    order = np.argsort(rows[:, columns["performance"][0]], kind="stable")
    return Generation(rows[order], Counter(str(reason) for reason in reasons if reason), len(reasons), done.total)


def unfinished(folder: str | Path) -> Path | None:
    """Return the newest folder of an unfinished generation, or None."""
    folders = [path.parent for path in Path(folder).glob(f"*/{MANIFEST}")]
    return max(folders, key=lambda path: (path / MANIFEST).stat().st_mtime, default=None)


def forget(parts: Path) -> None:
    """Remove the files of a generation whose table is saved."""
    shutil.rmtree(parts, ignore_errors=True)
    if parts.parent.is_dir() and not any(parts.parent.iterdir()):
        parts.parent.rmdir()


@contextmanager
def _copy(model: GraspUse, alone: bool) -> Generator[Environment]:
    """Yield a copy of the environment; if ``alone``, it contains only the robot and the target."""
    env: Environment = pickle.loads(pickle.dumps(model.env))
    try:
        names = {model.robot.GetName(), model.target.GetName()}
        for body in env.GetBodies() if alone else []:
            if body.GetName() not in names:
                env.Remove(body)
        for body in env.simulation.bodies:
            body.configuration()  # so that its record is the same in each process
        yield env
    finally:
        env.Destroy()


def _writable(parts: Path) -> Path:
    """Return ``parts`` after creating it, or a temporary folder if it is not writable."""
    try:
        parts.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        other = Path(tempfile.mkdtemp(prefix="ravemj-grasps-"))
        _LOG.warning("cannot write %s (%s); unfinished grasps are in %s", parts, error.strerror, other)
        return other
    return parts

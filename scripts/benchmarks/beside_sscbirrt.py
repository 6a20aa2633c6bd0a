"""Plans the tasks of ``regions`` with ravemj and with sscbirrt in turns, and prints a table; nothing is limited.

sscbirrt needs another version of MuJoCo, so it has a Python of its own:

    python -m venv /tmp/other && /tmp/other/bin/pip install "sscbirrt[mujoco,ssik]"
    PYTHONPATH=scripts python -m benchmarks.beside_sscbirrt /tmp/other/bin/python

Both plan paths without smoothing. sscbirrt bounds roll and pitch, and knows no lean: bounds of 3.5 degrees allow 4.95.
"""

import argparse
import json
import re
import statistics
import subprocess
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import ravemj
from benchmarks import regions

_ROLL = float(np.radians(3.5))


def main() -> None:
    """Plan both tasks with the seeds that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("python", help="the Python in which sscbirrt is installed")
    parser.add_argument("--seeds", type=int, default=20, help="how many runs of each task")
    options = parser.parse_args()
    for name, task in (("18 grasps", regions.cans()), ("upright carry", regions.upright())):
        ours, theirs = _runs(options.python, task, options.seeds)
        for who, runs in (("ravemj", ours), ("sscbirrt", theirs)):
            solved = sum(done for done, _ in runs)
            print(f"{name:14} {who:9} {solved} of {len(runs)}, median {statistics.median(ms for _, ms in runs):.0f} ms")


def _runs(python: str, task: regions.Task, seeds: int) -> list[list[tuple[bool, float]]]:
    child = Path(__file__).with_name("sscbirrt_child.py")
    with subprocess.Popen(
        [python, "-I", str(child)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        print(json.dumps(_described(task)), file=process.stdin, flush=True)
        ours, theirs = list[tuple[bool, float]](), list[tuple[bool, float]]()
        for seed in range(seeds):
            ours.append(regions.planned(task, seed, "birrt"))
            print(seed, file=process.stdin, flush=True)
            done, took, _ = json.loads(process.stdout.readline())
            theirs.append((done, took))
    return [ours, theirs]


def _described(task: regions.Task) -> dict[str, object]:
    """Return what sscbirrt needs of a task: the world, the arm alone, and regions of the tool in the world."""
    env, held = task.robot.GetEnv(), task.robot.GetGrabbed()
    return {
        "mjcf": _with_free(_mjcf(env), held),
        "arm": _alone(task.robot),
        "qpos": task.robot.GetActiveDOFValues().tolist(),
        "joints": [joint.GetName() for joint in task.robot.GetJoints()],
        "goals": [_as_lists(region, task) for region in task.goals],
        "constraints": [_as_lists(region, task) for region in task.constraints],
        "holding": [f"{body.GetName()}/base" for body in held],
        "seconds": regions.SECONDS,
    }


def _as_lists(region: ravemj.Region, task: regions.Task) -> dict[str, list[list[float]]]:
    """Return a region of the tool in the world; one of a held body is shifted by the grasp."""
    frame, bounds = region.frame, np.array(region.Bw)
    T_world_frame = np.eye(4) if frame is None else frame.GetTransform()
    tool, T_held_tool = task.robot.GetActiveManipulator(), np.eye(4)
    assert tool is not None
    for held in task.robot.GetGrabbed():
        T_held_tool = np.linalg.inv(held.GetTransform()) @ tool.GetTransform()
    if region.lean is not None:
        bounds[3:5] = [-_ROLL, _ROLL]
    finite = np.clip(bounds, [[-5.0]] * 3 + [[-np.pi]] * 3, [[5.0]] * 3 + [[np.pi]] * 3)
    return {
        "T0_w": (T_world_frame @ region.T0_w).tolist(),
        "Tw_e": (region.Tw_e @ T_held_tool).tolist(),
        "Bw": finite.tolist(),
    }


def _alone(robot: ravemj.Robot) -> str:
    """Return the same of a robot without other bodies."""
    env = robot.GetEnv().CloneSelf(ravemj.CloningOptions.Bodies)
    for body in env.GetBodies():
        if body.GetName() != robot.GetName():
            env.Remove(body)
    return _mjcf(env)


def _with_free(mjcf: str, held: list[ravemj.KinBody]) -> str:
    """Give held bodies free joints, which sscbirrt asks for; the keyframe would be too short."""
    for body in held:
        mjcf = re.sub(rf'<body name="{body.GetName()}/base"[^>]*>', r"\g<0><freejoint/>", mjcf)
    return re.sub("<keyframe>.*</keyframe>", "", mjcf, flags=re.DOTALL)


def _mjcf(env: ravemj.Environment) -> str:
    """Return the world as it is now, with the tool of the arm as a site."""
    with TemporaryDirectory() as folder, warnings.catch_warnings(action="ignore"):  # about names
        path = Path(folder, "world.xml")
        env.write_mjcf(path)
        return path.read_text(encoding="utf-8")


if __name__ == "__main__":
    main()

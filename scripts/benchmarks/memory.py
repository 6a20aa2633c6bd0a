"""Memory must not depend on how long a motion is, nor on how many calls a script makes."""

import statistics
import sys
import tempfile
from pathlib import Path

from benchmarks.measure import CAMERA, MODEL, Row, peak_memory, run_python

_SHORT, _LONG = 60, 600
_SIZE = (320, 240)
_FPS = 30
_PROCESSES = 3
_LIMIT = 1.03
"""Noise of repeated runs: some MB. The frames of the long motion would take more than half as much again."""

_CALLS, _CYCLES = 100_000, 1_000
_MOST_GROWTH = 5.0
"""How much a process may grow during all of these calls [MB]."""

_GROWTH = """
import ctypes, gc, os, sys
os.environ["MUJOCO_GL"] = "disable"
import ravemj

def memory():
    gc.collect()
    getattr(ctypes.CDLL(None), "malloc_trim", int)(0)  # glibc gives back what it keeps for later
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1024

def calls():
    robot.SetDOFValues([0.1, 0.2])
    robot.GetLinkTransformations()
    robot.GetTransform()
    env.CheckCollision(robot)
    env.plot3([0, 0, 1], 5)

def cycle():
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes([[2, 0, 0, 0.1, 0.1, 0.1]])
    box.SetName("box")
    env.Add(box)
    robot.Grab(box, robot.GetLinks()[1])
    with robot:
        calls()
    copy = env.CloneSelf(1)
    copy.GetRobots()[0].GetDOFValues()
    copy.Destroy()
    env.Remove(box)

env = ravemj.load(sys.argv[1])
robot = env.GetRobots()[0]
env.SetViewer("offscreen")
for count, work in ((int(sys.argv[2]), calls), (int(sys.argv[3]), cycle)):
    for _ in range(count // 10):
        work()
    before = memory()
    for _ in range(count):
        work()
    print(memory() - before)
"""


def rows() -> list[Row]:
    """Compare a long motion with a short one, played to MP4 and to PNG files; and see whether many calls add up."""
    with tempfile.TemporaryDirectory() as folder:
        played = [_row(Path(folder), name, target) for name, target in (("MP4", "video.mp4"), ("PNG files", "frames"))]
    return [*played, *(_growth(_CALLS, _CYCLES) if sys.platform == "linux" else [])]


def _growth(calls: int, cycles: int) -> list[Row]:
    by_calls, by_cycles = map(float, run_python("-c", _GROWTH, str(MODEL), str(calls), str(cycles)).split())
    return [
        Row(f"growth by {calls} times values, poses, collision, drawing : limit", "MB", by_calls, _MOST_GROWTH, 1.0),
        Row(f"growth by {cycles} times add, grab, save, clone, remove : limit", "MB", by_cycles, _MOST_GROWTH, 1.0),
    ]


def _row(folder: Path, name: str, target: str) -> Row:
    series = [[_peak(folder, target, frames) for frames in (_LONG, _SHORT)] for _ in range(_PROCESSES)]
    long, short = (statistics.median(peaks) for peaks in zip(*series, strict=True))
    all_frames = (_LONG - _SHORT) * _SIZE[0] * _SIZE[1] * 3 / 1e6
    note = f"{long - short:+.1f} MB; the frames between them have {all_frames:.0f} MB"
    return Row(
        f"peak memory of play to {name} : {_LONG} frames : {_SHORT} frames", "MB", long, short, _LIMIT, note=note
    )


def _peak(folder: Path, target: str, frames: int) -> float:
    """Return the peak memory of a command whose trajectory has one row for each frame [MB]."""
    trajectory = folder / f"{frames}.csv"
    if not trajectory.exists():
        lines = (f"{frame / _FPS!r},{frame / frames!r},{-frame / frames!r}" for frame in range(frames))
        trajectory.write_text("\n".join(["time,Joint0,Joint1", *lines]) + "\n")
    options = ("--trajectory", str(trajectory), "--fps", str(_FPS), "--camera", str(CAMERA))
    size = f"{_SIZE[0]}x{_SIZE[1]}"
    return peak_memory("-m", "ravemj", "play", str(MODEL), "-o", str(folder / target), "--size", size, *options)

"""Peak memory of ``ravemj play``, which must not depend on how long the motion is."""

import statistics
import tempfile
from pathlib import Path

from benchmarks.measure import CAMERA, MODEL, Row, peak_memory

_SHORT, _LONG = 60, 600
_SIZE = (320, 240)
_FPS = 30
_PROCESSES = 3
_LIMIT = 1.03
"""Noise of repeated runs: some MB. The frames of the long motion would take more than half as much again."""


def rows() -> list[Row]:
    """Compare a long motion with a short one, played to MP4 and to PNG files by commands of their own."""
    with tempfile.TemporaryDirectory() as folder:
        return [_row(Path(folder), name, target) for name, target in (("MP4", "video.mp4"), ("PNG files", "frames"))]


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

"""Robots of ROS: how long reading a URDF takes beside Pinocchio, and a robot of many meshes beside MuJoCo."""

import importlib
import importlib.util
import os
import sysconfig
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mujoco

from benchmarks.measure import Row, microseconds, take_turns
from ravemj.engine.simulation import Compiled
from ravemj.errors import Diagnostics
from ravemj.formats.meshes import read_mesh
from ravemj.formats.readers import read_file

_INSTALLED = Path(sysconfig.get_paths()["purelib"], "cmeel.prefix/share/example-robot-data/robots")
_ROBOTS = Path(os.environ.get("RAVEMJ_ROBOT_DATA") or _INSTALLED)
_READ = ("talos_data/robots/talos_full_v2_box.urdf", "panda_description/urdf/panda.urdf")
_MANY_MESHES = "tiago_description/robots/tiago_dual.urdf"
_ROUNDS = 7


def rows() -> list[Row]:
    """Measure robots of the package example-robot-data, where that is installed."""
    if not _ROBOTS.is_dir():
        return [Row("robots in URDF: left out", "", 0.0, note="needs example-robot-data, or RAVEMJ_ROBOT_DATA")]
    return [*(_reading(name) for name in _READ), _meshes()]


def _reading(name: str) -> Row:
    """Compare reading without shapes with Pinocchio's ``buildModelFromUrdf``."""
    path = str(_ROBOTS / name)
    with tempfile.TemporaryDirectory() as folder:
        bare = Path(folder) / "bare.urdf"
        bare.write_text(Path(path).read_text().replace("<mesh ", "<sphere radius='1' "))
        measured: list[Callable[[], float]] = [microseconds(lambda: read_file(str(bare)))]
        if importlib.util.find_spec("pinocchio") is not None:
            pinocchio: Any = importlib.import_module("pinocchio")
            measured.append(microseconds(lambda: pinocchio.buildModelFromUrdf(path)))
        times = take_turns(measured, _ROUNDS)
    floor = times[1] if len(times) > 1 else None
    return Row(f"{Path(name).stem}, file to scene without meshes : Pinocchio", "µs", times[0], floor, 10.0)


def _meshes() -> Row:
    """Compare file to model, meshes in the cache, with MuJoCo's compile of the same meshes."""
    path = str(_ROBOTS / _MANY_MESHES)
    reading = read_file(path)
    meshes = [file for file in reading.files if file.lower().endswith((".stl", ".dae", ".obj"))]

    def bare() -> None:
        spec = mujoco.MjSpec()
        for number, file in enumerate(meshes):
            part = read_mesh(file, ros=True)[0].mesh
            spec.add_mesh(name=str(number), uservert=part.vertices.ravel(), userface=part.triangles.ravel())
            spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=str(number))
        spec.compile()

    ours, theirs = take_turns(
        [microseconds(lambda: Compiled(read_file(path).scene, Diagnostics())), microseconds(bare)], 3
    )
    return Row(f"tiago_dual, {len(meshes)} meshes, file to model : MuJoCo's compile", "µs", ours, theirs, 2.0)

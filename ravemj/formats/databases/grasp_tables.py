"""Files of grasp tables."""

import json
import pickle
import struct
import zipfile
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any, cast

import numpy as np

from ravemj.core.output import new_file
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError

VERSION = 10
"""OpenRAVE's version of the table."""

_READ = (6, 7, VERSION)
_DAMAGED = (
    *(ValueError, LookupError, TypeError, AttributeError, EOFError, NotImplementedError, RuntimeError),
    *(zipfile.BadZipFile, zlib.error, struct.error, pickle.UnpicklingError),
)
_IN_ORDER = (
    *("grasps", "graspindices", "friction", "avoidlinks", "plannername"),
    *("translationstepmult", "finestep", "graspsetname"),
)


@dataclass(frozen=True)
class Owner:
    """Hand and body of a grasp table; the strings are empty in files of OpenRAVE.

    Attributes:
        robot: Name of the robot.
        manip: Name of the manipulator.
        target: Name of the body.
        joints: Names of the gripper joints.
        robot_hash: ``GetKinematicsGeometryHash()`` of the robot.
        target_hash: ``GetKinematicsGeometryHash()`` of the target.
    """

    robot: str = ""
    manip: str = ""
    target: str = ""
    joints: tuple[str, ...] = ()
    robot_hash: str = ""
    target_hash: str = ""


@dataclass(frozen=True)
class StoredGrasps:
    """Grasp table, and how it was generated.

    Attributes:
        rows: One grasp in each row, shape (n, m).
        columns: Columns of each property, by OpenRAVE's names.
        owner: Hand and body.
        settings: ``friction``, ``avoidlinks``, ``plannername``, ``translationstepmult``, ``finestep`` and
            ``graspsetname``.
        tried: Number of tested candidates.
        candidates: Number of candidates; greater than ``tried`` if the table is partial.
    """

    rows: Floats
    columns: Mapping[str, Sequence[int]]
    owner: Owner = field(default_factory=Owner)
    settings: Mapping[str, Any] = field(default_factory=dict[str, Any])
    tried: int = 0
    candidates: int = 0


def write_grasps(path: str | Path, stored: StoredGrasps) -> None:
    """Write a table as ``.npz``, whatever the suffix of the name. An existing file is renamed to ``.old``.

    Raises:
        OutputError: it cannot be written.
    """
    path = Path(path)
    header = {
        "version": VERSION,
        "columns": {name: list(map(int, columns)) for name, columns in stored.columns.items()},
        "owner": asdict(stored.owner),
        "settings": dict(stored.settings),
        "tried": stored.tried,
        "candidates": stored.candidates,
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    with new_file(path) as temporary:
        with open(temporary, "wb") as file:
            np.savez_compressed(file, allow_pickle=False, grasps=stored.rows, header=np.array(json.dumps(header)))
        if path.exists() and path.read_bytes() != temporary.read_bytes():
            with new_file(path.with_name(f"{path.name}.old")) as old:
                old.write_bytes(path.read_bytes())


def read_grasps(path: str | Path) -> StoredGrasps:
    """Read a table of ravemj or a pickle of OpenRAVE.

    Raises:
        ArgumentError: the file is damaged, has no table, or a table of another version.
        OSError: it cannot be read.
    """
    content = Path(path).read_bytes()
    try:
        if content.startswith(b"PK"):
            return _of_archive(content)
        version, params = read_version(content)
        return _of_params(version, params)
    except _DAMAGED as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        hint = "restore it from a copy, or move it away and generate the grasps again"
        raise ArgumentError(f"{path} is no sound table of grasps ({reason}): {hint}") from error


def read_version(content: bytes) -> tuple[int, Any]:
    """Return the version and the value of an OpenRAVE database."""
    from ravemj.formats.databases.pickles import read_pickle  # noqa: PLC0415 - old files are rare

    version, params = read_pickle(content)
    return int(version), params


def _of_archive(content: bytes) -> StoredGrasps:
    with np.load(BytesIO(content), allow_pickle=False) as archive:
        rows, header = np.asarray(archive["grasps"], float), json.loads(str(archive["header"]))
    _check_version(header["version"])
    named: dict[str, Any] = header["owner"]
    named["joints"] = tuple(named["joints"])
    owner = Owner(**named)
    return _checked(
        StoredGrasps(rows, header["columns"], owner, header["settings"], header["tried"], header["candidates"])
    )


def _of_params(version: int, params: Any) -> StoredGrasps:  # noqa: ANN401 - whatever a file holds
    _check_version(version)
    named = cast("dict[str, Any]", params if isinstance(params, dict) else dict(zip(_IN_ORDER, params, strict=False)))
    rows = np.asarray(named.pop("grasps"), dtype=float)
    columns = {str(name): [int(i) for i in np.atleast_1d(part)] for name, part in named.pop("graspindices").items()}
    rows = rows if rows.size else np.zeros((0, 1 + max((max(part) for part in columns.values() if part), default=-1)))
    return _checked(StoredGrasps(rows, columns, settings={str(name): value for name, value in named.items()}))


def _check_version(version: object) -> None:
    if version not in _READ:
        raise ValueError(f"its version is {version}, and {', '.join(map(str, _READ))} are read")


def _checked(stored: StoredGrasps) -> StoredGrasps:
    last = max((max(columns) for columns in stored.columns.values() if columns), default=-1)
    if stored.rows.ndim != 2 or stored.rows.shape[1] <= last:
        raise ValueError(f"its array has shape {stored.rows.shape}, and the last column is {last}")
    return stored

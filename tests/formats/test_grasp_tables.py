"""Files of grasp tables: what is written is read, old pickles are read, and no file runs code or is lost."""

import os
import pickle
import struct
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import examples

from ravemj.errors import ArgumentError
from ravemj.formats.databases.grasp_tables import Owner, StoredGrasps, read_grasps, write_grasps
from ravemj.formats.databases.pickles import read_pickle

OWNER = Owner("robot", "arm", "mug", ("left", "right"), "12ab", "34cd")
SETTINGS = {"friction": 0.4, "avoidlinks": ["palm"], "plannername": None, "finestep": 0.001}
TABLE = StoredGrasps(
    np.arange(15.0).reshape(3, 5), {"igraspdir": [0, 1, 2], "forceclosure": [3]}, OWNER, SETTINGS, 7, 9
)


def test_a_table_comes_back(tmp_path):
    path = tmp_path / "robot.1" / "graspset.2.3.pp"
    write_grasps(path, TABLE)
    found = read_grasps(path)
    assert found.rows.tolist() == TABLE.rows.tolist()
    assert replace(found, rows=TABLE.rows) == TABLE
    assert os.listdir(path.parent) == [path.name]


def test_an_older_table_is_kept(tmp_path):
    path = tmp_path / "table.pp"
    write_grasps(path, TABLE)
    write_grasps(path, TABLE)
    assert os.listdir(tmp_path) == ["table.pp"]
    write_grasps(path, replace(TABLE, rows=TABLE.rows[:1]))
    assert len(read_grasps(path).rows) == 1
    assert len(read_grasps(tmp_path / "table.pp.old").rows) == 3


def test_an_empty_table_comes_back(tmp_path):
    write_grasps(tmp_path / "table", replace(TABLE, rows=np.zeros((0, 5))))
    assert read_grasps(tmp_path / "table").rows.shape == (0, 5)


COLUMNS = {"igraspdir": range(3), "forceclosure": [3], "performance": [4]}
PARAMS = {"grasps": TABLE.rows, "graspindices": COLUMNS, "friction": np.float64(0.3), "avoidlinks": ["palm"]}
IN_ORDER = (TABLE.rows, COLUMNS, 0.3, ["palm"], "Grasper")


@pytest.mark.parametrize("protocol", [0, 2, 4])
@pytest.mark.parametrize("params", [PARAMS, IN_ORDER], ids=["by name", "in order"])
def test_pickles_of_openrave_are_read(tmp_path, protocol, params):
    path = tmp_path / "graspset.pp"
    path.write_bytes(pickle.dumps((10, params), protocol))
    found = read_grasps(path)
    assert found.rows.tolist() == TABLE.rows.tolist()
    assert found.columns["igraspdir"] == [0, 1, 2]
    assert found.settings["friction"] == 0.3
    assert found.settings["avoidlinks"] == ["palm"]


def test_pickles_of_python_2_are_read():
    """An array that Python 2 pickled: its bytes are a text there."""
    code = b"cnumpy.core.multiarray\n_reconstruct\n(cnumpy\nndarray\n(I0\ntS'b'\ntR"
    code += b"(I1\n(I2\ntcnumpy\ndtype\n(S'f8'\nI0\nI1\n"
    code += (
        b"tR(I3\nS'<'\nNNNI-1\nI-1\nI0\ntbI00\nS"
        + repr(struct.pack("<2d", 1.5, -2)).removeprefix("b").encode()
        + b"\ntb."
    )
    assert read_pickle(code).tolist() == [1.5, -2]


class Bomb:
    def __reduce__(self):
        return os.mkdir, ("bomb",)


@pytest.mark.parametrize(
    "content",
    [
        pickle.dumps((10, Bomb())),
        pickle.dumps((10, {"grasps": np.zeros((1, 5)), "graspindices": {}, "x": print})),
        pickle.dumps((10, np.array([Bomb()], dtype=object))),
        pickle.dumps((9, PARAMS)),
        pickle.dumps((10, {"grasps": np.zeros((1, 2)), "graspindices": COLUMNS})),
        pickle.dumps((10, {"graspindices": COLUMNS})),
        pickle.dumps([1, 2, 3]),
        pickle.dumps((10, PARAMS))[:-20],
        b"",
        b"text",
        b"PK\x03\x04 and nothing else",
        b"c_codecs\nencode\n(S'a'\nS'utf_8'\ntR.",
    ],
)
def test_bad_files_say_what_is_wrong(tmp_path, monkeypatch, content):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "table.pp"
    path.write_bytes(content)
    with pytest.raises(ArgumentError, match=r"table\.pp is no sound table of grasps \(.+\): restore it"):
        read_grasps(path)
    assert os.listdir(tmp_path) == ["table.pp"]


@given(st.integers(0, 10**6), st.integers(1, 255))
@examples(60)
def test_damaged_bytes_are_found_or_harmless(tmp_path_factory, place, change):
    path = tmp_path_factory.mktemp("tables") / "table.pp"
    write_grasps(path, TABLE)
    content = bytearray(path.read_bytes())
    content[place % len(content)] ^= change
    path.write_bytes(content)
    try:
        found = read_grasps(path)
    except ArgumentError:
        return
    assert found.rows.tolist() == TABLE.rows.tolist()


@given(st.integers(0, 10**6))
@examples(30)
def test_files_that_end_early_are_found(tmp_path_factory, length):
    path = tmp_path_factory.mktemp("tables") / "table.pp"
    write_grasps(path, TABLE)
    content = path.read_bytes()
    path.write_bytes(content[: length % len(content)])
    with pytest.raises(ArgumentError):
        read_grasps(path)


def test_archives_of_something_else(tmp_path):
    np.savez(tmp_path / "other.npz", numbers=np.zeros(3))
    with pytest.raises(ArgumentError, match="no sound table"):
        read_grasps(tmp_path / "other.npz")
    assert zipfile.is_zipfile(tmp_path / "other.npz")

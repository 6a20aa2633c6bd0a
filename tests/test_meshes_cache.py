"""The cache of parsed meshes: it may never be wrong, and never be in the way."""

import multiprocessing
import os
from pathlib import Path

import numpy as np
import pytest

from ravemj.errors import SourceError
from ravemj.meshes import cache, read_mesh, reading

FILES = Path(__file__).parent / "data" / "meshes"
OBJ = "mtllib m.mtl\nv 0 0 0\nv 0.1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty cache."""
    monkeypatch.setenv("RAVEMJ_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache" / "meshes"


@pytest.fixture
def mesh(tmp_path):
    path = tmp_path / "mesh.obj"
    path.write_text(OBJ)
    (tmp_path / "m.mtl").write_text("newmtl a\nKd 1 0 0\n")
    return str(path)


@pytest.fixture
def reads(monkeypatch):
    """Count how often a file is really read."""
    counted = []
    real = reading._read
    monkeypatch.setattr(reading, "_read", lambda file, reader: counted.append(file.path) or real(file, reader))
    return counted


def entries(folder):
    return sorted(folder.glob("*.npz"))


def test_the_second_reading_comes_from_the_cache(folder, mesh, reads):
    first, second = read_mesh(mesh), read_mesh(mesh)
    assert first == second
    assert (first[0].diffuse, len(reads), len(entries(folder))) == ((1, 0, 0), 1, 1)
    assert second[0].mesh.vertices.dtype == np.float64
    assert not second[0].mesh.vertices.flags.writeable


@pytest.mark.parametrize("path", sorted(FILES.glob("*.*")), ids=lambda path: path.name)
def test_every_format_comes_back_the_same(folder, path):
    if path.suffix in (".off", ".ply"):
        pytest.importorskip("trimesh")
    if path.suffix != ".mtl":
        assert read_mesh(str(path)) == read_mesh(str(path))
        assert len(entries(folder)) == 1


def test_content_and_kind_decide_not_the_name(folder, mesh, reads, tmp_path):
    read_mesh(mesh)
    (tmp_path / "other.OBJ").write_text(OBJ)
    read_mesh(str(tmp_path / "other.OBJ"))
    assert len(reads) == 1
    (tmp_path / "box.iv").write_text("#VRML V2.0 utf8\nShape { geometry Box { } }")
    (tmp_path / "box.wrl").write_text("#VRML V2.0 utf8\nShape { geometry Box { } }")
    assert read_mesh(str(tmp_path / "box.iv")) == read_mesh(str(tmp_path / "box.wrl"))
    assert len(entries(folder)) == 3


def test_a_changed_file_or_reference_is_read_anew(folder, mesh, reads, tmp_path):
    assert read_mesh(mesh)[0].diffuse == (1, 0, 0)
    (tmp_path / "m.mtl").write_text("newmtl a\nKd 0 1 0\n")
    assert read_mesh(mesh)[0].diffuse == (0, 1, 0)
    os.unlink(tmp_path / "m.mtl")
    assert read_mesh(mesh)[0].diffuse == pytest.approx((0.6, 0.6, 0.6))
    read_mesh(mesh)
    assert len(reads) == 3
    (tmp_path / "m.mtl").write_text("newmtl a\nKd 1 0 0\n")
    assert read_mesh(mesh)[0].diffuse == (1, 0, 0)
    Path(mesh).write_text(OBJ.replace("0.1", "0.5"))
    assert read_mesh(mesh)[0].mesh.vertices.max(axis=0)[0] == 0.5
    assert len(reads) == 5


@pytest.mark.parametrize("damage", [b"", b"garbage", b"PK\x03\x04" + bytes(50), None])
def test_a_damaged_entry_is_read_over_and_rewritten(folder, mesh, reads, damage):
    expected = read_mesh(mesh)
    (entry,) = entries(folder)
    whole = entry.read_bytes()
    entry.write_bytes(whole[:-30] if damage is None else damage)
    assert read_mesh(mesh) == expected
    assert len(reads) == 2
    assert read_mesh(mesh) == expected
    assert len(reads) == 2


def test_every_flipped_byte_is_noticed_or_harmless(folder, mesh):
    expected = read_mesh(mesh)
    (entry,) = entries(folder)
    whole = entry.read_bytes()
    for position in range(0, len(whole), 11):
        entry.write_bytes(whole[:position] + bytes([whole[position] ^ 0x55]) + whole[position + 1 :])
        assert read_mesh(mesh) == expected


def test_pickles_are_not_loaded(folder, mesh):
    read_mesh(mesh)
    (entry,) = entries(folder)
    np.savez(entry, about=np.array([{"finish": []}], dtype=object), allow_pickle=True)
    assert len(read_mesh(mesh)) == 1


@pytest.mark.parametrize("switch", ["off", "OFF"])
def test_switched_off(tmp_path, monkeypatch, mesh, reads, switch):
    monkeypatch.setenv("RAVEMJ_CACHE", switch)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert read_mesh(mesh) == read_mesh(mesh)
    assert len(reads) == 2
    assert not (tmp_path / "xdg").exists()


def test_folders(tmp_path, monkeypatch):
    monkeypatch.setenv("RAVEMJ_CACHE", str(tmp_path))
    assert cache.cache_folder() == tmp_path / "meshes"
    monkeypatch.delenv("RAVEMJ_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache.cache_folder() == tmp_path / "ravemj" / "meshes"
    monkeypatch.setenv("XDG_CACHE_HOME", "relative/is/no/good")
    monkeypatch.setenv("HOME", "/home/someone")
    assert cache.cache_folder() == Path("/home/someone/.cache/ravemj/meshes")
    monkeypatch.setattr(Path, "home", lambda: (_ for _ in ()).throw(RuntimeError))
    assert cache.cache_folder() is None


def test_a_folder_that_cannot_be_written_is_no_trouble(tmp_path, monkeypatch, mesh, reads, caplog):
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("RAVEMJ_CACHE", str(tmp_path / "file"))
    caplog.set_level("DEBUG", "ravemj")
    assert read_mesh(mesh) == read_mesh(mesh)
    assert len(reads) == 2
    assert {record.levelname for record in caplog.records} == {"DEBUG"}


def test_a_full_disk_leaves_nothing_behind(folder, mesh, monkeypatch):
    def full(*_args):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(cache.os, "replace", full)
    assert len(read_mesh(mesh)) == 1
    assert list(folder.iterdir()) == []


def test_malformed_files_leave_no_entry(folder, tmp_path):
    (tmp_path / "bad.stl").write_bytes(b"garbage")
    with pytest.raises(SourceError):
        read_mesh(str(tmp_path / "bad.stl"))
    assert not folder.exists()


def test_the_longest_unused_go_first(tmp_path):
    for number in range(4):
        (tmp_path / f"{number}.npz").write_bytes(bytes(100))
        os.utime(tmp_path / f"{number}.npz", (number, number))
    (tmp_path / "mine.txt").write_bytes(bytes(1000))
    cache.prune(tmp_path, max_bytes=250)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["2.npz", "3.npz", "mine.txt"]


def _many_reads(folder, mesh, results):
    os.environ["RAVEMJ_CACHE"] = folder
    digests = set()
    for _ in range(30):
        digests |= {part.mesh.digest for part in read_mesh(mesh)}
        for entry in Path(folder, "meshes").glob("*.npz"):
            entry.unlink(missing_ok=True)
    results.put(digests)


def test_many_processes_at_once(tmp_path):
    context = multiprocessing.get_context("spawn")
    results = context.Queue()
    mesh = str(FILES / "prism.dae")
    workers = [context.Process(target=_many_reads, args=(str(tmp_path), mesh, results)) for _ in range(2)]
    for worker in workers:
        worker.start()
    digests = [results.get(timeout=60) for _ in workers]
    for worker in workers:
        worker.join()
        assert worker.exitcode == 0
    assert digests == [digests[0]] * 2
    assert len(digests[0]) == 2
    assert not list(tmp_path.rglob("*.tmp"))

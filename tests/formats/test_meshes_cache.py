"""The cache of parsed meshes: it may never be wrong, and never be in the way."""

import io
import multiprocessing
import os
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA
from waiting import PATIENCE

from ravemj.errors import SourceError
from ravemj.formats.meshes import cache, collision_form, read_mesh, reading
from ravemj.model.scene import Mesh

FILES = DATA / "meshes"
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
    real = reading.read_content
    monkeypatch.setattr(reading, "read_content", lambda file, reader: counted.append(file.path) or real(file, reader))
    return counted


def entries(folder):
    return sorted(folder.glob("*.mesh"))


def change(path, content):
    """Change a file to something as long, so that only the clock tells."""
    before = os.stat(path)
    time.sleep(0.05)  # longer than a tick of the kernel
    Path(path).write_text(content)
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert os.stat(path).st_size == before.st_size


def anew(parts):
    """Forget what the cache told about meshes besides their numbers."""
    return tuple(replace(part, mesh=Mesh(part.mesh.vertices.copy(), part.mesh.triangles.copy())) for part in parts)


def test_the_second_reading_comes_from_the_cache(folder, mesh, reads):
    first, second = read_mesh(mesh), read_mesh(mesh)
    assert first == second
    assert (first[0].diffuse, len(reads), len(entries(folder))) == ((1, 0, 0), 1, 1)
    assert second[0].mesh.vertices.dtype == np.float64
    assert not second[0].mesh.vertices.flags.writeable


@pytest.mark.parametrize("path", sorted(FILES.glob("*.*")), ids=lambda path: path.name)
def test_every_format_comes_back_the_same(folder, path):
    if path.suffix != ".mtl":
        first, second = read_mesh(str(path)), read_mesh(str(path))
        assert anew(first) == anew(second) == second
        assert [collision_form(part.mesh) for part in second] == [collision_form(part.mesh) for part in anew(second)]
        assert len(entries(folder)) == 1


@pytest.mark.parametrize("scale", [(0.001, 0.001, 0.001), (2.0, 1.0, -3.0), (1e39, 1.0, 1.0)])
def test_scaled_meshes_come_from_the_cache(folder, mesh, reads, scale):
    plain = read_mesh(mesh)
    first, second = read_mesh(mesh, scale), read_mesh(mesh, scale)
    assert [len(reads), len(entries(folder))] == [2, 2]
    for one, other, unscaled in zip(first, second, plain, strict=True):
        np.testing.assert_array_equal(one.mesh.vertices, unscaled.mesh.vertices * scale)
        np.testing.assert_array_equal(one.mesh.vertices, other.mesh.vertices)
        assert one == other
        assert Mesh(one.mesh.vertices.copy(), one.mesh.triangles).digest == other.mesh.digest


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


def test_a_copy_elsewhere_has_its_own_references(folder, mesh, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    (other / "mesh.obj").write_text(OBJ)
    (other / "m.mtl").write_text("newmtl a\nKd 0 1 0\n")
    for _ in range(2):
        assert read_mesh(mesh)[0].diffuse == (1, 0, 0)
        assert read_mesh(str(other / "mesh.obj"))[0].diffuse == (0, 1, 0)


def test_changed_readers(folder, mesh, reads, monkeypatch):
    read_mesh(mesh)
    monkeypatch.setattr(cache, "readers_digest", lambda: b"other source")
    read_mesh(mesh)
    assert len(reads) == 2


def test_the_source_is_known():
    names = {os.path.basename(path) for path in cache.reader_sources()}
    assert {"cache.py", "entries.py", "reading.py", "old.py", "triangles.py", "mesh.py"} <= names
    assert len(cache.readers_digest()) == 32


def test_files_that_change_faster_than_the_clock(folder, mesh, reads):
    for number in range(100):  # faster than the clock of the file system
        Path(mesh).write_text(OBJ.replace("0.1", f"0.{number % 9 + 1}"))
        assert read_mesh(mesh)[0].mesh.vertices.max(axis=0)[0] == pytest.approx((number % 9 + 1) / 10)
    assert len(reads) == 9


@pytest.mark.parametrize("changed", ["mesh", "reference"])
def test_a_file_that_changes_while_it_is_read(folder, mesh, tmp_path, monkeypatch, changed):
    real = reading.read_content
    path, before, after = {
        "mesh": (mesh, "0.1", "0.5"),
        "reference": (tmp_path / "m.mtl", "1 0 0", "0 1 0"),
    }[changed]

    def read(file, reader):
        parts = real(file, reader)
        change(path, Path(path).read_text().replace(before, after))
        return parts

    monkeypatch.setattr(reading, "read_content", read)
    read_mesh(mesh)
    monkeypatch.setattr(reading, "read_content", real)
    (part,) = read_mesh(mesh)
    assert part.mesh.vertices.max() == 1
    assert (part.mesh.vertices[:, 0].max(), part.diffuse) == (
        (0.5, (1, 0, 0)) if changed == "mesh" else (pytest.approx(0.1), (0, 1, 0))
    )


def test_changes_of_equal_size_and_time_are_seen(folder, mesh, tmp_path):
    read_mesh(mesh)
    change(mesh, OBJ.replace("0.1", "0.5"))
    assert read_mesh(mesh)[0].mesh.vertices.max(axis=0)[0] == 0.5
    change(tmp_path / "m.mtl", "newmtl a\nKd 0 1 0\n")
    assert read_mesh(mesh)[0].diffuse == (0, 1, 0)
    os.unlink(tmp_path / "m.mtl")
    assert read_mesh(mesh)[0].diffuse == pytest.approx((0.6, 0.6, 0.6))
    assert read_mesh(mesh)[0].diffuse == pytest.approx((0.6, 0.6, 0.6))
    (tmp_path / "m.mtl").write_text("newmtl a\nKd 0 0 1\n")
    assert read_mesh(mesh)[0].diffuse == (0, 0, 1)
    os.unlink(mesh)
    with pytest.raises(SourceError, match="no such mesh file"):
        read_mesh(mesh)


def test_a_link_that_leads_elsewhere(folder, mesh, tmp_path):
    (tmp_path / "mesh2.obj").write_text(OBJ.replace("0.1", "0.5"))
    link = tmp_path / "link.obj"
    for target, width in [("mesh.obj", 0.1), ("mesh2.obj", 0.5)] * 2:
        link.unlink(missing_ok=True)
        link.symlink_to(target)
        assert read_mesh(str(link))[0].mesh.vertices.max(axis=0)[0] == pytest.approx(width)


def test_dots_behind_a_link_lead_elsewhere(folder, mesh, tmp_path):
    (tmp_path / "far" / "away").mkdir(parents=True)
    (tmp_path / "far" / "mesh.obj").write_text(OBJ.replace("0.1", "0.5"))
    (tmp_path / "link").symlink_to("far/away")
    for _ in range(2):
        assert read_mesh(mesh)[0].mesh.vertices.max(axis=0)[0] == pytest.approx(0.1)
        assert read_mesh(str(tmp_path / "link" / ".." / "mesh.obj"))[0].mesh.vertices.max(axis=0)[0] == 0.5


def pickled() -> bytes:
    file = io.BytesIO()
    np.save(file, np.array([{"finish": []}], dtype=object), allow_pickle=True)
    return file.getvalue()


def test_a_valid_entry_under_the_name_of_another_is_not_taken(folder, mesh, reads, tmp_path, caplog):
    caplog.set_level("DEBUG")
    other = tmp_path / "other.obj"
    other.write_text("v 5 0 0\nv 0.1 0 0\nv 0 1 0\nf 1 2 3\n")
    right, _ = read_mesh(mesh), read_mesh(str(other))
    first, second = entries(folder)
    contents = first.read_bytes(), second.read_bytes()
    for content in contents:
        first.write_bytes(content)
        second.write_bytes(content)
        assert read_mesh(mesh) == right
        assert read_mesh(str(other))[0].mesh.vertices[0].tolist() == [5, 0, 0]
    assert len(reads) == 4
    assert "cannot be used: it is a copy of the entry" in caplog.text
    assert {first.read_bytes(), second.read_bytes()} == {*contents}


@pytest.mark.parametrize("damage", [b"", b"garbage", b"PK\x03\x04" + bytes(50), pickled(), None])
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
    for position in range(0, len(whole), 5):
        entry.write_bytes(whole[:position] + bytes([whole[position] ^ 0x55]) + whole[position + 1 :])
        assert anew(read_mesh(mesh)) == expected


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


def test_the_folder_of_someone_else_is_used(folder, mesh, reads, monkeypatch):
    expected = read_mesh(mesh)

    def refuse(*_args):
        raise PermissionError(1, "Operation not permitted")

    for path in folder.iterdir():
        os.utime(path, (1, 1))
    monkeypatch.setattr(cache.os, "utime", refuse)
    assert read_mesh(mesh) == expected
    assert len(reads) == 1


@pytest.mark.parametrize(("hours", "marked"), [(1, False), (25, True)])
def test_what_is_used_is_marked_once_a_day(folder, mesh, hours, marked):
    read_mesh(mesh)
    then = time.time() - 3600 * hours
    for path in folder.iterdir():
        os.utime(path, (then, then))
    read_mesh(mesh)
    assert [path.stat().st_mtime > then + 1 for path in folder.iterdir()] == [marked]


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
    for number, name in enumerate(["0.tmp", "1.mesh", "2.mesh", "3.mesh"]):
        (tmp_path / name).write_bytes(bytes(100))
        os.utime(tmp_path / name, (number, number))
    (tmp_path / "mine.txt").write_bytes(bytes(1000))
    cache.prune(tmp_path, max_bytes=250)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["2.mesh", "3.mesh", "mine.txt"]


def _many_reads(folder, mesh, results):
    os.environ["RAVEMJ_CACHE"] = folder
    digests = set()
    for _ in range(30):
        digests |= {part.mesh.digest for part in anew(read_mesh(mesh))}
        for entry in Path(folder, "meshes").glob("*.mesh"):
            entry.unlink(missing_ok=True)
    results.put(digests)


@pytest.mark.stress
def test_many_processes_at_once(tmp_path):
    context = multiprocessing.get_context("spawn")
    results = context.Queue()
    mesh = str(FILES / "prism.dae")
    workers = [context.Process(target=_many_reads, args=(str(tmp_path), mesh, results)) for _ in range(2)]
    for worker in workers:
        worker.start()
    digests = [results.get(timeout=PATIENCE) for _ in workers]
    for worker in workers:
        worker.join()
        assert worker.exitcode == 0
    assert digests == [digests[0]] * 2
    assert len(digests[0]) == 2
    assert not list(tmp_path.rglob("*.tmp"))

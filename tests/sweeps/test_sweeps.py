"""Sweeps: the same numbers however they are computed, resumption, failures, damaged files."""

import json
import os
import signal
import subprocess
import sys
import tarfile
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import jobs
import numpy as np
import pytest
from conftest import MODELS, one_in
from hypothesis import given
from hypothesis import strategies as st
from strategies import examples

import ravemj
from ravemj.sweeps.digests import digest
from ravemj.sweeps.folder import MANIFEST
from ravemj.sweeps.shards import is_sound, read_shard, shard_path, write_shard

HERE = Path(__file__).parent
ITEMS = np.arange(60.0)[:, None] * 10
JOBS = {
    "collides": ("panda", "collides", 2300, {}),
    "poses": ("panda", "poses", 1200, {"manip": "arm"}),
    "ik": ("puma560", "ik", 300, {"options": {"collisions": True}, "block": 100}),
    "places": ("puma560", "ik", 6, {"options": {"type": "Translation3D"}, "block": 5}),
    "pictures": ("pendulum", "pictures", 5, {"options": {"size": (40, 30), "prepare": jobs.paint}}),
    "plan": ("puma560", "plan", 5, {"options": {"iterations": 50}}),
    "a function": ("pendulum", jobs.sums, 250, {"block": 30}),
}


@pytest.fixture(autouse=True)
def _path(monkeypatch):
    """Processes import the functions of this folder."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(HERE), os.environ.get("PYTHONPATH", "")]))


def content(sweep):
    """Return all arrays as bytes, by name."""
    return {name: (array.shape, array.tobytes()) for name, array in sweep.arrays().items()}


def files(folder):
    return {path.name: path.read_bytes() for path in sorted((folder / "shards").glob("*.npz"))}


@pytest.mark.parametrize("name", one_in(3, list(JOBS)))
def test_shards_and_executors_do_not_change_numbers(name, tmp_path):
    model, what, count, more = JOBS[name]
    whole = ravemj.sweep(model, what, count, tmp_path / "whole", shard=count, **more)
    assert len(whole.files) == 1
    expected = content(whole)
    assert all(shape[0] == count for shape, _ in expected.values())
    small = 2 if count < 10 else max(7, count // 9)
    parts = ravemj.sweep(model, what, count, tmp_path / "parts", shard=small, **more)
    assert len(parts.files) > 1
    assert content(parts) == expected
    with ThreadPoolExecutor(2) as threads:
        threaded = ravemj.sweep(model, what, count, tmp_path / "threads", shard=small, executor=threads, **more)
    reordered = ravemj.sweep(model, what, count, tmp_path / "order", shard=small, executor=jobs.Reordering(), **more)
    assert files(parts.folder) == files(threaded.folder) == files(reordered.folder)


@pytest.mark.stress
@pytest.mark.parametrize("name", JOBS)
def test_processes_do_not_change_numbers(name, tmp_path):
    model, what, count, more = JOBS[name]
    here = ravemj.sweep(model, what, count, tmp_path / "here", shard=70, **more)
    for number in (1, 3):
        there = ravemj.sweep(model, what, count, tmp_path / str(number), shard=70, executor=number, **more)
        assert files(there.folder) == files(here.folder)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        there = ravemj.sweep(model, what, count, tmp_path / "pool", shard=70, executor=pool, **more)
    assert files(there.folder) == files(here.folder)


@pytest.mark.stress
def test_two_processes_with_one_that_dies(tmp_path, monkeypatch):
    monkeypatch.setenv("SWEEP_MARK", str(tmp_path / "mark"))
    sweep = ravemj.sweep("pendulum", jobs.dies_once, ITEMS, tmp_path / "out", block=10, shard=10, executor=2)
    assert (tmp_path / "mark").exists()
    np.testing.assert_array_equal(sweep.arrays("twice"), 2 * ITEMS)
    assert sweep.failed == []


@pytest.mark.stress
def test_a_shard_that_kills_its_process_harms_no_other(tmp_path):
    with pytest.raises(ravemj.SweepError, match=r"shard 30-40 failed; the first error: its process died, 3 times"):
        ravemj.sweep("pendulum", jobs.dies_always, ITEMS, tmp_path, block=10, shard=10, executor=2, retries=2)
    sweep = ravemj.Sweep.open(tmp_path)
    assert (sweep.done, sweep.total) == (50, 60)


@pytest.mark.stress
def test_a_shard_that_hangs_is_ended(tmp_path):
    begin = time.monotonic()
    with pytest.raises(ravemj.SweepError, match=r"shard 30-40 failed; .*TimeoutError: it took longer than 2 s"):
        ravemj.sweep("pendulum", jobs.hangs_at_300, ITEMS, tmp_path, block=10, shard=10, executor=2, timeout=2)
    assert time.monotonic() - begin < 60
    assert ravemj.Sweep.open(tmp_path).done == 50


def test_options_are_arguments_of_functions(tmp_path):
    items = np.arange(4.0)
    sweep = ravemj.sweep("pendulum", jobs.scaled, items, tmp_path / "out", options={"factor": 3.0})
    assert sweep.arrays("scaled").tolist() == [0, 3, 6, 9]
    with pytest.raises(ravemj.ArgumentError, match="options is"):
        ravemj.sweep("pendulum", jobs.scaled, items, tmp_path / "out", options={"factor": 4.0})
    with pytest.raises(ravemj.SweepError, match="missing 1 required"):
        ravemj.sweep("pendulum", jobs.scaled, items, tmp_path / "other")


def test_a_function_that_fails(tmp_path):
    with pytest.raises(
        ravemj.SweepError, match=r"shard 30-40 failed; the first error: ValueError: no 300 please"
    ) as raised:
        ravemj.sweep("pendulum", jobs.fails_at_300, ITEMS, tmp_path, block=10, shard=10)
    (failure,) = raised.value.failures
    assert (failure.start, failure.stop) == (30, 40)
    assert "fails_at_300" in failure.details
    sweep = ravemj.Sweep.open(tmp_path)
    assert sweep.failed == [failure]
    assert repr(sweep).endswith("50 of 60 items, 1 shards failed>")
    assert len(sweep.arrays("twice", partial=True)) == 50
    with pytest.raises(ravemj.openrave_exception, match="50 of 60 items are done"):
        sweep.arrays("twice")


@pytest.mark.parametrize(
    ("function", "message"),
    [(jobs.wrong_rows, "returned 'rows' of shape"), (jobs.no_arrays, "returned ndarray; expected a dict")],
)
def test_results_of_functions_are_checked(function, message, tmp_path):
    with pytest.raises(ravemj.SweepError, match=message):
        ravemj.sweep("pendulum", function, ITEMS, tmp_path, block=10, shard=10)


def test_destroyed_environments_are_made_again(tmp_path):
    for folder in ("before", "after"):
        sweep = ravemj.sweep("panda", "collides", 20, tmp_path / folder)
        assert len(sweep.arrays("collides")) == 20
        ravemj.RaveDestroy()


def test_resumption_computes_what_is_missing(tmp_path):
    told = []
    arguments = "pendulum", jobs.sums, 250, tmp_path
    first = ravemj.sweep(*arguments, block=10, shard=50)
    expected = files(tmp_path)
    first.files[3].unlink()
    (tmp_path / "failed" / "000000000150-000000000200.json").write_text(json.dumps([1]))
    ravemj.sweep(*arguments, block=10, told=told.append, progress=lambda *numbers: told.append(numbers))
    assert files(tmp_path) == expected
    assert (told[0].start, told[0].stop, told[0].error) == (150, 200, "")
    assert told[1:] == [(5, 5, 0)]
    assert ravemj.Sweep.open(tmp_path).failed == []


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"seed": 1}, "seed is 1, and 0 in"),
        ({"shard": 70}, "shard is 70, and 50 in"),
        ({"block": 5}, "block is 5, and 10 in"),
        ({"items": 251}, "total is 251, and 250 in"),
        ({"items": np.zeros((250, 2))}, "the array of items differs"),
        ({"what": "poses"}, "what is 'poses', and 'collides' in"),
        ({"model": "puma560"}, "the model or its state differs"),
        ({"model": "moved"}, "the model or its state differs"),
    ],
)
def test_another_sweep_is_refused(changed, message, tmp_path):
    arguments = {"model": "pendulum", "what": "collides", "items": 250, "out": tmp_path, "block": 10}
    ravemj.sweep(**arguments, shard=50)
    before = files(tmp_path)
    if changed.get("model") == "moved":
        env = ravemj.load(MODELS / "env.xml")
        env.GetRobots()[0].SetDOFValues([0.1, 0])
        changed = {"model": env}
    with pytest.raises(ravemj.ArgumentError, match=message):
        ravemj.sweep(**{**arguments, **changed})
    assert files(tmp_path) == before


def test_each_entry_of_the_manifest_counts(tmp_path):
    arguments = "pendulum", "collides", 250, tmp_path
    ravemj.sweep(*arguments)
    manifest = json.loads((tmp_path / MANIFEST).read_text())
    for key in manifest.keys() - {"shard"}:
        (tmp_path / MANIFEST).write_text(json.dumps(manifest | {key: "other"}))
        with pytest.raises(ravemj.ArgumentError, match=r"manifest\.json"):
            ravemj.sweep(*arguments)
    for text in ("", "[]", "{", "{}"):
        (tmp_path / MANIFEST).write_text(text)
        with pytest.raises(ravemj.ArgumentError, match="is damaged"):
            ravemj.sweep(*arguments)


@examples(40)
@given(st.data())
def test_damaged_shards_are_found(tmp_path_factory, data):
    folder = tmp_path_factory.mktemp("shard")
    what = data.draw(st.sampled_from(["collides", "pictures"]))
    path = shard_path(folder, what, 0, 5)
    path.parent.mkdir()
    arrays = {"a": np.arange(5.0), "b": np.arange(10).reshape(5, 2) % 3 == 0}
    if what == "pictures":
        arrays |= {
            "rgb": np.arange(360, dtype=np.uint8).reshape(5, 4, 6, 3),
            "depth": np.full((5, 4, 6), 999, np.uint16),
        }
    write_shard(path, arrays, 0)
    assert is_sound(path)
    whole = bytearray(path.read_bytes())
    if data.draw(st.booleans()):
        path.write_bytes(whole[: data.draw(st.integers(0, len(whole) - 1))])
        assert not is_sound(path) or what == "pictures"  # a tar may lack zeros at its end
    else:
        whole[data.draw(st.integers(0, len(whole) - 1))] ^= data.draw(st.integers(1, 255))
        path.write_bytes(whole)
    if is_sound(path):  # a date, for instance, tells nothing
        found = read_shard(path)
        assert all(np.array_equal(found[name], array) for name, array in arrays.items())
        assert found.keys() == arrays.keys()


def test_check_computes_damaged_shards_anew(tmp_path):
    arguments = "pendulum", "poses", 400, tmp_path
    sweep = ravemj.sweep(*arguments, shard=50)
    before = files(tmp_path)
    for path, keep in zip(sweep.files[:3], (0, 100, -1), strict=True):
        path.write_bytes(path.read_bytes()[:keep])
    ravemj.sweep(*arguments, check=True)
    assert files(tmp_path) == before


@pytest.mark.parametrize(
    ("executor", "message"),
    [
        (jobs.Failing(2), r"3 of 5 shards are missing: run it again with a working executor \(BrokenExecutor: a node"),
        (jobs.Failing(2, refuses=True), r"3 of 5 shards are missing.*RuntimeError: it is closed"),
        (jobs.Losing(2), r"3 of 5 shards failed; the first error: ConnectionError: lost"),
        pytest.param(jobs.Hanging(), r"5 of 5 shards are missing.*no shard ended within 1 s", marks=pytest.mark.stress),
    ],
)
def test_executors_that_fail(executor, message, tmp_path):
    arguments = "pendulum", jobs.sums, 250, tmp_path
    with pytest.raises(ravemj.SweepError, match=message):
        ravemj.sweep(*arguments, block=10, shard=50, executor=executor, timeout=1)
    again = ravemj.sweep(*arguments, block=10)
    assert content(again) == content(ravemj.sweep("pendulum", jobs.sums, 250, tmp_path / "whole", block=10))


def test_unsendable_functions_are_refused_before_anything_starts(tmp_path):
    with pytest.raises(ravemj.ArgumentError, match="processes cannot import it"):
        ravemj.sweep("pendulum", lambda env, items, random: {}, 10, tmp_path / "out", executor=2)
    assert not (tmp_path / "out").exists()
    sweep = ravemj.sweep("pendulum", lambda env, items, random: {"n": items[:, 0]}, 10, tmp_path / "out")
    assert sweep.done == 10


@pytest.mark.skipif(not Path("/dev/full").exists() or os.getuid() == 0, reason="root writes everywhere")
def test_a_folder_that_cannot_be_written(tmp_path):
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(ravemj.OutputError, match="cannot write"):
            ravemj.sweep("pendulum", "poses", 10, tmp_path / "out")
    finally:
        tmp_path.chmod(0o700)


def test_a_folder_of_something_else_is_refused(tmp_path):
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(ravemj.OutputError, match="holds something else than a sweep"):
        ravemj.sweep("pendulum", "poses", 10, tmp_path)


def test_a_file_in_place_of_the_folder_is_refused(tmp_path):
    (tmp_path / "out").touch()
    for out in (tmp_path / "out", tmp_path / "out" / "below"):
        with pytest.raises(ravemj.OutputError, match="cannot write"):
            ravemj.sweep("pendulum", "poses", 10, out)


def test_a_full_disk_ends_it(tmp_path, monkeypatch):
    def full(path, arrays, first):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("ravemj.sweeps.worker.write_shard", full)
    with pytest.raises(ravemj.SweepError, match=r"stopped after 3 shards that could not be written.*No space left"):
        ravemj.sweep("pendulum", "poses", 1000, tmp_path, shard=50)
    monkeypatch.undo()
    assert ravemj.sweep("pendulum", "poses", 1000, tmp_path).done == 1000


@pytest.mark.stress
def test_two_drivers_on_one_folder(tmp_path):
    arguments = "pendulum", jobs.slow, 300, tmp_path / "out"
    with ThreadPoolExecutor(2) as threads:
        both = [threads.submit(ravemj.sweep, *arguments, block=10, shard=10) for _ in range(2)]
        sweeps = [one.result() for one in both]
    assert content(sweeps[0]) == content(sweeps[1])
    assert sweeps[0].arrays("random").shape == (300,)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"what": "nope"}, r"what is 'nope'; expected a function, or one of collides, poses, ik, plan, pictures"),
        ({"items": 0}, "items is 0"),
        ({"items": 1.5}, "items is 1.5"),
        ({"items": []}, "at least one row"),
        ({"items": np.zeros((3, 5))}, r"have shape \(3, 5\), and should have \(N, 2\) for 'collides'"),
        ({"items": [[np.nan, 0]]}, "finite"),
        ({"items": "missing.npy"}, r"cannot read missing\.npy"),
        ({"manip": "nope", "model": "panda"}, r"manip is 'nope'; there are: arm"),
        ({"seed": -1}, "seed is -1"),
        ({"shard": 0}, "shard is 0"),
        ({"ahead": 0}, "ahead is 0"),
        ({"block": True}, "block is True"),
        ({"executor": 0}, "executor is 0"),
        ({"options": {"speed": 3}}, "options: found speed; expected none"),
        ({"timeout": 3}, "timeout is 3; expected None, or more than 0 with processes"),
        ({"model": "workshop"}, "several robots"),
        ({"model": 5}, "model: is 5"),
        ({"what": "ik", "options": {"type": "Nope"}}, "type is 'Nope'"),
        ({"what": "pictures", "options": {"size": (0, 3)}}, r"size is \(0, 3\); expected width and height"),
        ({"what": "pictures", "options": {"size": 3}}, "size is 3"),
        ({"what": "pictures", "options": {"outputs": ["rgb", "sound"]}}, "outputs are rgb, sound; expected some of"),
        ({"what": "pictures", "options": {"camera": np.zeros((4, 4))}}, "camera"),
        ({"what": "pictures", "options": {"prepare": 3}}, "prepare is 3"),
    ],
)
def test_wrong_arguments(changed, message, tmp_path):
    arguments = {"model": "pendulum", "what": "collides", "items": 10, "out": tmp_path / "out"}
    with pytest.raises(ravemj.ArgumentError, match=message):
        ravemj.sweep(**{**arguments, **changed})
    assert not (tmp_path / "out").exists()


def test_pictures(tmp_path):
    env = ravemj.load(MODELS / "panda.xml")
    panda = env.GetRobots()[0]
    camera = env.default_camera().T_world_camera
    sweep = ravemj.sweep(env, "pictures", 3, tmp_path / "out", shard=2, options={"size": (64, 48), "camera": camera})
    found = sweep.arrays()
    assert [path.suffix for path in sweep.files] == [".tar", ".tar"]
    with tarfile.open(sweep.files[1]) as archive:
        names = [f"000000000002.{name}" for name in ("depth.png", "links.png", "rgb.png", "json")]
        assert archive.getnames() == names
    for number, values in enumerate(found["items"]):
        panda.SetDOFValues(values)
        np.testing.assert_array_equal(found["rgb"][number], env.render(64, 48, camera=camera))
        poses = found["T_world_camera"][number] @ found["T_camera_link"][number]
        np.testing.assert_allclose(poses, panda.GetLinkTransformations(), atol=1e-12)
        names = found["link_names"][number].tolist()
        assert names == [f"{panda.GetName()}/{link.GetName()}" for link in panda.GetLinks()]
        seen = sorted(set(found["links"][number].ravel()) - {0})
        assert len(seen) > 3
        assert (found["depth"][number] > 0).tolist() == (found["links"][number] > 0).tolist()
        # What a pixel shows is in the box around its link.
        for link in seen:
            rows, columns = np.nonzero(found["links"][number] == link)
            depth = found["depth"][number][rows, columns] / 1000
            rays = np.linalg.inv(found["K"][number]) @ np.stack([columns + 0.5, rows + 0.5, np.ones(len(rows))])
            points = camera[:3, :3] @ (rays * depth) + camera[:3, 3:]
            box = panda.GetLinks()[link - 1].ComputeAABB()
            assert (np.abs(points.T - box.pos()) <= box.extents() + 0.01).all()


def test_users_change_what_pictures_show(tmp_path):
    options = {"size": (40, 30), "outputs": ["rgb"], "prepare": jobs.paint}
    sweep = ravemj.sweep("pendulum", "pictures", np.zeros((3, 2)), tmp_path, options=options)
    found = sweep.arrays()
    assert "depth" not in found
    assert len({picture.tobytes() for picture in found["rgb"]}) == 3
    assert len({camera.tobytes() for camera in found["T_world_camera"]}) == 3


@pytest.mark.parametrize("suffix", ["npy", "npz", "csv"])
def test_items_of_files(suffix, tmp_path):
    rows = np.random.default_rng(1).uniform(-1, 1, (20, 2))
    path = tmp_path / f"items.{suffix}"
    if suffix == "csv":
        np.savetxt(path, rows, delimiter=",")
    else:
        np.save(path, rows) if suffix == "npy" else np.savez(path, rows)
    robot = ravemj.load(MODELS / "env.xml").GetRobots()[0]
    found = ravemj.sweep(robot, "poses", path, tmp_path / "out").arrays()
    np.testing.assert_array_equal(found["T_world_link"], robot.batch_link_transforms(rows))
    assert found.keys() == {"T_world_link"}


def test_the_answers_are_those_of_the_batch_calls(tmp_path):
    env = ravemj.load(MODELS / "panda.xml")
    panda = env.GetRobots()[0]
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes([[0.4, 0.2, 0.4, 0.1, 0.1, 0.1]])
    box.SetName("box")
    env.Add(box)
    found = ravemj.sweep(panda, "collides", 500, tmp_path / "a").arrays()
    np.testing.assert_array_equal(found["collides"], panda.batch_collides(found["items"]))
    assert 0 < found["collides"].sum() < 500
    found = ravemj.sweep(panda, "ik", 40, tmp_path / "b", options={"collisions": True}).arrays()
    values, valid = panda.GetActiveManipulator().batch_solutions(found["items"], collisions=True)
    np.testing.assert_array_equal(found["values"], values)
    np.testing.assert_array_equal(found["valid"], valid)
    found = ravemj.sweep(panda, "plan", 4, tmp_path / "c").arrays()
    for ends, path, count, is_found in zip(
        found["items"], found["waypoints"], found["count"], found["found"], strict=True
    ):
        if is_found:
            np.testing.assert_allclose(path[[0, count - 1]], ends, atol=1e-9)
            assert not panda.batch_collides(path[:count]).any()
        assert np.isnan(path[count:]).all()
    assert found["found"].any()


def test_the_environment_stays_as_it_is(tmp_path):
    env = ravemj.load(MODELS / "puma560.xml")
    before = env.GetRobots()[0].GetDOFValues()
    ravemj.sweep(env, jobs.sums, 100, tmp_path, block=10)
    np.testing.assert_array_equal(env.GetRobots()[0].GetDOFValues(), before)


@pytest.mark.stress
def test_digests_are_those_of_other_processes():
    code = """
import ravemj
from ravemj.engine.simulation.record import WorldRecord
from ravemj.sweeps.digests import digest
print(digest(WorldRecord.from_simulation(ravemj.load(ravemj.model_path("workshop")).simulation)))
"""
    found = {
        subprocess.run(
            [sys.executable, "-c", code],
            env=os.environ | {"PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    }
    assert len(found) == 1
    assert digest({"a": 1.0, "b": {2, 3}}) == digest({"b": {3, 2}, "a": 1.0}) != digest({"a": 1.0, "b": {2, 4}})


SCRIPT = """
import sys
import jobs
import ravemj
if __name__ == "__main__":
    ravemj.sweep("pendulum", jobs.slow, int(sys.argv[2]), sys.argv[1], block=10, shard=10, executor=2)
"""


def start(folder, out, count=400):
    (folder / "script.py").write_text(SCRIPT)
    words = [sys.executable, "script.py", str(out), str(count)]
    return subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def processes_of(folder):
    """Return the processes that work in a folder."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdecimal() and os.readlink(entry / "cwd") == str(folder):
                found.append(int(entry.name))
        except OSError:
            continue
    return found


def wait_for_shards(out, count):
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and len(list((out / "shards").glob("*.npz"))) < count:
        time.sleep(0.02)


@pytest.mark.stress
@pytest.mark.skipif(not Path("/proc/self/cwd").exists(), reason="finds processes in /proc")
def test_killed_drivers_and_workers_leave_whole_files(tmp_path):
    expected = ravemj.sweep("pendulum", jobs.slow, 400, tmp_path / "here", block=10, shard=10)
    random = np.random.default_rng(5)
    for number in range(10):
        folder = tmp_path / f"run{number}"
        folder.mkdir()
        out = folder / "out"
        driver = start(folder, out)
        wait_for_shards(out, int(random.integers(0, 30)))
        time.sleep(random.uniform(0, 0.2))
        driver.send_signal(signal.SIGKILL)
        driver.communicate()
        deadline = time.monotonic() + 10
        while processes_of(folder) and time.monotonic() < deadline:
            time.sleep(0.05)
        assert not processes_of(folder)
        assert all(map(is_sound, out.glob("shards/*.npz")))
        again = ravemj.sweep("pendulum", jobs.slow, 400, out, block=10, shard=10)
        assert files(again.folder) == files(expected.folder)


@pytest.mark.stress
@pytest.mark.skipif(not Path("/proc/self/cwd").exists(), reason="finds processes in /proc")
@pytest.mark.parametrize("count", [0, 5, 25])
def test_killed_workers(count, tmp_path):
    out = tmp_path / "out"
    driver = start(tmp_path, out)
    wait_for_shards(out, count)
    workers = sorted(set(processes_of(tmp_path)) - {driver.pid})
    spawned = [one for one in workers if b"spawn_main" in Path(f"/proc/{one}/cmdline").read_bytes()]
    if count:
        os.kill(spawned[0], signal.SIGKILL)
    _, errors = driver.communicate(timeout=120)
    assert (driver.returncode, errors) == (0, "")
    assert content(ravemj.Sweep.open(out))


@pytest.mark.stress
@pytest.mark.parametrize("count", [0, 10])
def test_ctrl_c_returns_soon(count, tmp_path):
    out = tmp_path / "out"
    driver = start(tmp_path, out, 40_000)  # more than any machine does in two seconds
    wait_for_shards(out, count)
    time.sleep(0.5 if count else 2.0)
    begin = time.monotonic()
    driver.send_signal(signal.SIGINT)
    _, errors = driver.communicate(timeout=60)
    assert time.monotonic() - begin < 5
    assert driver.returncode in (1, 130, -signal.SIGINT)
    assert "KeyboardInterrupt" in errors
    assert all(map(is_sound, out.glob("shards/*.npz")))

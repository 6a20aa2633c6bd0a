"""Sweeps on Dask, with two worker processes of this machine, as docs/many.md shows."""

import os
from pathlib import Path

import jobs
import numpy as np
import pytest

import ravemj

distributed = pytest.importorskip("distributed", reason="install the dependency group cluster")

HERE = Path(__file__).parent


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:  # what processes inherit
        patch.setenv("PYTHONPATH", os.pathsep.join([str(HERE), os.environ.get("PYTHONPATH", "")]))
        patch.setenv("SWEEP_MARK", str(tmp_path_factory.mktemp("mark") / "mark"))
        with (
            distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
            distributed.Client(cluster) as client,
        ):
            yield client


def files(folder):
    return {path.name: path.read_bytes() for path in sorted((folder / "shards").glob("*"))}


@pytest.mark.stress
@pytest.mark.parametrize(
    ("model", "what", "count", "more"),
    [
        ("panda", "collides", 3000, {}),
        ("puma560", "ik", 300, {"options": {"collisions": True}}),
        ("pendulum", jobs.sums, 300, {"block": 10}),
        ("pendulum", "pictures", 4, {"options": {"size": (40, 30)}}),
    ],
)
def test_the_bytes_are_those_of_this_process(model, what, count, more, client, tmp_path):
    here = ravemj.sweep(model, what, count, tmp_path / "here", shard=max(1, count // 5), **more)
    there = ravemj.sweep(
        model, what, count, tmp_path / "there", shard=max(1, count // 5), executor=client.get_executor(), **more
    )
    assert files(there.folder) == files(here.folder)


@pytest.mark.stress
def test_functions_of_scripts_and_workers_that_die(client, tmp_path):
    offset = 3
    sweep = ravemj.sweep(
        "pendulum",
        lambda env, items, random: {"more": items[:, 0] + offset},
        np.zeros((40, 2)),
        tmp_path / "lambda",
        block=10,
        shard=10,
        executor=client.get_executor(),
    )
    assert (sweep.arrays("more") == offset).all()
    items = np.arange(60.0)[:, None] * 10
    died = ravemj.sweep(
        "pendulum", jobs.dies_once, items, tmp_path / "died", block=10, shard=10, executor=client.get_executor()
    )
    np.testing.assert_array_equal(died.arrays("twice"), 2 * items)
    assert Path(os.environ["SWEEP_MARK"]).exists()

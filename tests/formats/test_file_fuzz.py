"""Damaged archives and mesh files: a scene or a ``RavemjError``, after little work."""

import pytest
from conftest import one_in
from file_fuzzing import FileFuzzer
from fuzzing import Trial

BATCHES, BATCH = 20, 200


@pytest.mark.parametrize("batch", one_in(BATCHES, range(BATCHES)))
def test_files(batch, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("RAVEMJ_CACHE", "off")
    fuzzer = FileFuzzer(seed=0)
    linked, crashes = 0, []
    for number in range(batch * BATCH, (batch + 1) * BATCH):
        try:
            linked += Trial().run(fuzzer.make(number)).links > 0
        except Exception as error:  # the number says how to make it again
            crashes.append((number, repr(error)[:200]))
    assert crashes == []
    assert linked >= BATCH / 5, "too few files are read"


@pytest.mark.stress
def test_a_seed_gives_the_same_files_again():
    one, other = FileFuzzer(5), FileFuzzer(5)
    assert [one.make(number) for number in range(50)] == [other.make(number) for number in range(50)]

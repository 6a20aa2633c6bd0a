"""Numbers of numpy, also arrays without dimensions, count as Python's in every argument, as in OpenRAVE."""

import inspect
import re

import numpy as np
import pytest
from wrong_calls import KINDS, calls_with_one_argument

import ravemj
from ravemj.core.threads import batch_threads

WHOLE = {
    "int64": np.int64,
    "uint8": np.uint8,
    "array": np.array,
    "short array": lambda number: np.array(number, dtype=np.uint16),
}
REAL = {"int": int, "float64": np.float64, "float32": np.float32, "array": lambda number: np.array(float(number))}


def outcome(function, **given):
    """Return the kind of error of a call, or None."""
    try:
        function(**given)
    except Exception as error:
        return type(error)
    return None


@pytest.fixture
def puma(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # some calls write files
    env = ravemj.Environment()
    env.Load(ravemj.model_path("puma560"))
    yield env.GetRobots()[0]
    env.Destroy()


@pytest.mark.parametrize("name", KINDS)
def test_methods_take_numbers_in_all_forms(name, puma):
    thing = KINDS[name](puma.GetEnv(), puma)
    for method, argument in calls_with_one_argument(thing):
        function = getattr(thing, method)
        annotation = str(inspect.signature(function).parameters[argument].annotation)
        for kind, forms in (("int", WHOLE), ("float", REAL)):
            if re.search(rf"\b{kind}\b", annotation) and method != "SetViewerUserThread":
                plain = outcome(function, **{argument: 1})
                for form, make in forms.items():
                    assert outcome(function, **{argument: make(1)}) is plain, (method, argument, form)


@pytest.mark.parametrize("make", WHOLE.values(), ids=WHOLE)
def test_whole_numbers_of_other_calls(make, puma):
    env = puma.GetEnv()
    assert puma.ComputeJacobianTranslation(make(2), [0, 0, 0]).shape == (3, 6)
    assert puma.DoesDOFAffectLink(make(0), make(1)) == puma.DoesDOFAffectLink(0, 1)
    assert [link.GetIndex() for link in puma.GetChain(make(0), make(2), returnjoints=False)] == [0, 1, 2]
    assert ravemj.RaveGetAffineDOF(make(7)) == 3
    path = ravemj.RaveCreateTrajectory(env, "")
    path.Init(puma.GetActiveConfigurationSpecification())
    assert path.serialize(make(1)) == path.serialize(1)
    viewer = env.serve_viewer(port=make(0))
    viewer.close()
    count = batch_threads()
    ravemj.set_batch_threads(make(1))
    assert batch_threads() == 1
    ravemj.set_batch_threads(make(count))


@pytest.mark.parametrize("make", REAL.values(), ids=REAL)
def test_real_numbers_of_other_calls(make, puma):
    env = puma.GetEnv()
    assert env.Lock(make(1)) is True
    env.Unlock()
    env.drawlinelist([[0, 0, 0], [1, 0, 0]], make(1))
    path = ravemj.Motion.line(np.zeros(6), np.full(6, 0.5), 0.1)
    assert env.animation(path, fps=make(10)) is not None

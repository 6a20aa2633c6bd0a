"""Trajectories, parameters of planners and archives that are damaged: refused with OpenRAVE's exception, or taken."""

import random
import warnings
import zipfile

import pytest
from text_fuzzing import PARAMETERS, TextFuzzer, TextTrial, damaged, damaged_bytes

import ravemj
from ravemj import Planner, RaveCreateTrajectory, planningutils

SEEDS = [91101, 91102, 91103]


@pytest.fixture
def path():
    env = ravemj.Environment()
    env.Load(ravemj.model_path("pendulum"))
    robot = env.GetRobots()[0]
    made = RaveCreateTrajectory(env, "")
    made.Init(robot.GetActiveConfigurationSpecification("linear"))
    made.Insert(0, [0, 0, 0.2, 0.1, 0.3, 0.4])
    planningutils.RetimeActiveDOFTrajectory(made, robot)
    return robot, made


def read_trajectories(path, chance, count):
    _, made = path
    text, data = made.serialize(0x8000), made.serialize(0)
    text = text.decode() if isinstance(text, bytes) else text
    taken = 0
    for _ in range(count):
        other = RaveCreateTrajectory(made.GetEnv(), "")
        content = damaged(text, chance)
        if chance.random() < 0.5:
            content = damaged_bytes(data, chance)
        try:
            other.deserialize(content)
            taken += 1
            other.GetDuration()
            other.GetWaypoints(0, other.GetNumWaypoints())
            if other.GetNumWaypoints():
                other.Sample(0.1)
                planningutils.RetimeTrajectory(other)
        except (ravemj.openrave_exception, NotImplementedError):
            pass
    return taken


def read_parameters(path, chance, count):
    robot, made = path
    taken = 0
    for _ in range(count):
        text = damaged(PARAMETERS, chance)
        try:
            params = Planner.PlannerParameters()
            params.SetRobotActiveJoints(robot)
            params.SetExtraParameters(text)
            copy = RaveCreateTrajectory(made.GetEnv(), "")
            copy.Clone(made, 0)
            planningutils.RetimeActiveDOFTrajectory(copy, robot, plannerparameters=text)
            taken += 1
        except ravemj.openrave_exception:
            pass
    return taken


def read_archives(folder, chance, count):
    file = folder / "model.zae"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("model.dae", "<COLLADA/>")
        archive.writestr("manifest.xml", "<dae_root>./model.dae</dae_root>")
    whole = file.read_bytes()
    for _ in range(count):
        content = bytearray(whole[: chance.randrange(len(whole))] if chance.random() < 0.2 else whole)
        for _ in range(chance.randint(1, 5) if content else 0):
            content[chance.randrange(len(content))] = chance.choice([0, 1, 0x7F, 0x80, 0xFF, chance.randrange(256)])
        file.write_bytes(bytes(content))
        assert not ravemj.Environment().Load(str(file))
    return count


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seed", SEEDS)
def test_some(seed, path, tmp_path, monkeypatch):
    monkeypatch.setenv("RAVEMJ_CACHE", "off")
    run(seed, path, tmp_path, 60)


@pytest.mark.stress
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seed", range(91200, 91220))
def test_many(seed, path, tmp_path, monkeypatch):
    monkeypatch.setenv("RAVEMJ_CACHE", "off")
    run(seed, path, tmp_path, 1000)


def run(seed, path, folder, count):
    chance = random.Random(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert read_trajectories(path, chance, count) < count
        assert read_parameters(path, chance, count) < count
        read_archives(folder, chance, count // 4)


@pytest.mark.parametrize("seed", [4211, *(pytest.param(seed, marks=pytest.mark.stress) for seed in range(4212, 4242))])
def test_random_trajectories_and_parameters(seed):
    fuzzer, taken = TextFuzzer(seed), 0
    for number in range(300 if seed == 4211 else 3000):
        files = fuzzer.make(number)
        assert fuzzer.make(number) == files
        taken += TextTrial().run(files).links
    assert taken > 100


@pytest.mark.parametrize("name", ["_nmaxiterations", "_nmaxplanningtime", "_fsteplength", "_nrandomgeneratorseed"])
@pytest.mark.parametrize("number", ["1e400", "-inf", "nan"])
def test_parameters_are_finite(name, number, path):
    robot, made = path
    with pytest.raises(ravemj.openrave_exception, match=name):
        planningutils.RetimeActiveDOFTrajectory(made, robot, plannerparameters=f"<{name}>{number}</{name}>")

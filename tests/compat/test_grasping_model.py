"""GraspingModel: generation, files, interruptions, and use of a table."""

import logging
import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from command_line import PACKAGE_ROOT

import ravemj
from ravemj.errors import ArgumentError
from ravemj.formats.databases.grasp_tables import read_grasps
from ravemj.sweeps.folder import Sweep

HAND = """<Robot name="hand"><KinBody>
  <Body name="palm"><Geom type="box"><extents>.06 .02 .01</extents></Geom></Body>
  <Body name="left"><Translation>-.045 0 .04</Translation>
    <Geom type="box"><extents>.005 .01 .03</extents></Geom></Body>
  <Body name="right"><Translation>.045 0 .04</Translation>
    <Geom type="box"><extents>.005 .01 .03</extents></Geom></Body>
  <Joint name="jl" type="slider"><Body>palm</Body><Body>left</Body><axis>1 0 0</axis><limits>0 .04</limits></Joint>
  <Joint name="jr" type="slider"><Body>palm</Body><Body>right</Body><axis>-1 0 0</axis><limits>0 .04</limits></Joint>
 </KinBody>
 <Manipulator name="grip"><base>palm</base><effector>palm</effector><joints>jl jr</joints>
  <closingdirection>1 1</closingdirection><direction>0 0 1</direction><Translation>0 0 .04</Translation></Manipulator>
 <Manipulator name="bare"><base>palm</base><effector>palm</effector></Manipulator>
</Robot>"""
THING = """<KinBody name="thing"><Body name="b"><Geom type="box"><extents>.02 .03 .02</extents></Geom></Body></KinBody>
<KinBody name="ghost"><Body name="b"/></KinBody>
<KinBody name="table"><Translation>0 0 -5</Translation>
  <Body name="b"><Geom type="box"><extents>1 1 .01</extents></Geom></Body></KinBody>"""
WORLD = f"<Environment>{HAND}{THING}</Environment>"

SCRIPT = f"""
import logging, sys, time
import numpy as np
import ravemj

def main():
    logging.basicConfig(format="%(message)s")
    env = ravemj.Environment()
    env.LoadData('''{WORLD}''')
    gmodel = ravemj.databases.grasping.GraspingModel(env.GetRobot("hand"), env.GetKinBody("thing"))
    gmodel.numthreads = int(sys.argv[1])
    gmodel.autogenerate()
    print(len(gmodel.grasps))

if __name__ == "__main__":
    main()
"""


@pytest.fixture(autouse=True)
def database(tmp_path, monkeypatch):
    monkeypatch.setenv("OPENRAVE_HOME", str(tmp_path / "home"))
    monkeypatch.delenv("OPENRAVE_DATABASE", raising=False)
    return tmp_path / "home"


@pytest.fixture
def env():
    env = ravemj.Environment()
    env.LoadData(WORLD)
    yield env
    env.Destroy()


@pytest.fixture
def gmodel(env):
    return model_of(env)


def model_of(env, target="thing"):
    return ravemj.databases.grasping.GraspingModel(env.GetRobot("hand"), env.GetKinBody(target))


def few(gmodel, **named):
    """Generate from the six sides; every other candidate is a grasp."""
    options = {"rolls": [0, np.pi / 2], "standoffs": [0.005, 0.01], "preshapes": [[0.0, 0.0]], "friction": 0.4}
    gmodel.generate(**{"approachrays": gmodel.computeBoxApproachRays(delta=0.04), **options, **named})
    return gmodel


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


# Generation


def test_generation_leaves_the_robot_and_no_files(gmodel, database):
    robot = gmodel.robot
    before = robot.GetTransform(), robot.GetDOFValues(), robot.GetActiveDOFIndices().tolist()
    few(gmodel)
    assert len(gmodel.grasps) == 24
    assert gmodel.has()
    assert files(database) == []
    assert np.array_equal(robot.GetTransform(), before[0])
    assert np.array_equal(robot.GetDOFValues(), before[1])
    assert robot.GetActiveDOFIndices().tolist() == before[2]


def test_stored_poses_are_those_of_the_simulation(gmodel):
    few(gmodel)
    for grasp in gmodel.grasps[::5]:
        _, (values, T_world_robot), mindist, _ = gmodel.runGrasp(grasp, forceclosure=True)
        with gmodel.robot:
            gmodel.robot.SetTransform(T_world_robot)
            assert gmodel.manip.GetTransform() == pytest.approx(gmodel.getGlobalGraspTransform(grasp), abs=1e-6)
        assert values == pytest.approx(grasp[list(gmodel.graspindices["igraspfinalfingers"])], abs=1e-6)
        assert mindist == pytest.approx(grasp[gmodel.graspindices["forceclosure"][0]], rel=1e-6)


@pytest.mark.stress
def test_processes_do_not_change_the_table(env, gmodel):
    alone = few(gmodel).grasps
    other = model_of(env)
    other.numthreads = 2
    assert np.array_equal(few(other).grasps, alone)


def test_other_bodies_are_ignored_unless_wanted(env, gmodel):
    env.GetKinBody("table").SetTransform(ravemj.matrixFromPose([1, 0, 0, 0, 0, 0, -0.04]))
    assert len(few(gmodel).grasps) == 24
    gmodel.disableallbodies = False
    few(gmodel)
    directions = gmodel.grasps[:, list(gmodel.graspindices["igraspdir"])]
    assert 0 < len(directions) < 24
    assert not (directions[:, 2] > 0.5).any()  # nothing comes through the table
    assert any("table" in reason for reason in gmodel.rejected)


def test_a_function_chooses_grasps(gmodel):
    seen = []

    def check(contacts, final, grasp, numbers):
        seen.append((contacts.shape[1], len(final[0]), final[1].shape, len(grasp), sorted(numbers)))
        return numbers["mindist"] > 0 and numbers["volume"] > 0 and len(seen) % 2

    few(gmodel, checkgraspfn=check)
    assert len(gmodel.grasps) == 12
    assert seen[0] == (6, 2, (4, 4), gmodel.totaldof, ["mindist", "volume"])


def test_rejected_candidates_have_reasons(gmodel, caplog):
    few(gmodel, approachrays=[[0.02, 0.5, 0, 1, 0, 0], [0, 0, 0.02, 0, 0, 1.0]], standoffs=[0.01])
    assert len(gmodel.grasps) == 2
    assert gmodel.rejected == {"flies past the target": 2}
    few(gmodel, approachrays=[[0.02, 0.5, 0, 1, 0, 0]], standoffs=[0.01])
    assert not gmodel.has()
    assert "none of 2 candidates is a grasp of 'thing' (2: flies past the target)" in caplog.text


def test_closure_is_a_choice(gmodel):
    assert len(few(gmodel, friction=0.0).grasps) == 0
    assert len(few(gmodel, friction=0.0, forceclosure=False).grasps) == 24


def test_noise_keeps_what_ends_at_the_same_place(gmodel):
    rays = [[0, 0, 0.02, 0, 0, 1.0]]
    few(gmodel, approachrays=rays, graspingnoise=0.001)
    assert len(gmodel.grasps) + gmodel.rejected["varies with noise"] == 4
    found = gmodel.testGrasp(grasp=few(gmodel, approachrays=rays).grasps[0], graspingnoise=None)
    assert found[2] is None


def test_properties_of_the_user_have_columns(env):
    robot, target = env.GetRobot("hand"), env.GetKinBody("thing")
    gmodel = ravemj.databases.grasping.GraspingModel(robot, target, graspparametersdof={"mine": 2})
    few(gmodel)
    assert gmodel.grasps.shape == (24, 63)
    gmodel.save()
    other = ravemj.databases.grasping.GraspingModel(robot, target, graspparametersdof={"mine": 2})
    assert other.load()
    assert list(other.graspindices["mine"]) == [61, 62]


# Bad input


def test_hands_without_joints(env):
    robot = env.GetRobot("hand")
    robot.SetActiveManipulator("bare")
    with pytest.raises(ArgumentError, match=r"manipulator 'bare' of 'hand' has no gripper joints.*<joints>"):
        model_of(env).autogenerate()


def test_targets_without_shapes(env):
    with pytest.raises(ArgumentError, match="target 'ghost' has no geometries"):
        model_of(env, "ghost").autogenerate()


def test_held_targets(env, gmodel):
    env.GetRobot("hand").Grab(env.GetKinBody("thing"))
    with pytest.raises(ArgumentError, match="'hand' holds 'thing'; release it first"):
        gmodel.autogenerate()


@pytest.mark.parametrize(
    "named",
    [
        {"preshapes": [[0.0]]},
        {"rolls": [float("nan")]},
        {"approachrays": np.zeros((0, 6))},
        {"approachrays": [[1.0, 2, 3]]},
        {"manipulatordirections": [0, 1.0]},
    ],
)
def test_arguments_of_wrong_shapes(gmodel, named):
    with pytest.raises(ArgumentError, match=r"generate: .*"):
        few(gmodel, **named)


def test_robots_without_manipulators(env):
    robot = ravemj.RaveCreateRobot(env, "")
    robot.InitFromBoxes(np.array([[0, 0, 3, 0.1, 0.1, 0.1]]), True)
    robot.SetName("box")
    env.Add(robot)
    with pytest.raises(ArgumentError, match="robot 'box' has no manipulator"):
        ravemj.databases.grasping.GraspingModel(robot, env.GetKinBody("thing"))


# Files


def test_a_saved_table_is_loaded(env, gmodel, database):
    few(gmodel)
    gmodel.save()
    assert files(database) == [os.path.relpath(gmodel.getfilename(True), database)]
    folder, name = os.path.split(gmodel.getfilename(True))
    assert os.path.basename(folder) == f"robot.{gmodel.robot.GetKinematicsGeometryHash()}"
    assert name.startswith(f"graspset.{gmodel.manip.GetStructureHash()}.")
    other = model_of(env)
    assert other.load()
    assert np.array_equal(other.grasps, gmodel.grasps)
    assert other.grasper.friction == 0.4
    clone = gmodel.clone(env.CloneSelf(ravemj.CloningOptions.Bodies))
    assert np.array_equal(clone.grasps, gmodel.grasps)
    assert clone.target.GetEnv() is not env


def test_damaged_tables_are_reported_and_kept(env, gmodel, caplog):
    few(gmodel).save()
    path = Path(gmodel.getfilename(True))
    path.write_bytes(path.read_bytes()[:300])
    other = model_of(env)
    assert not other.load()
    assert "is no sound table of grasps" in caplog.text
    assert "move it away and generate the grasps again" in caplog.text
    assert len(path.read_bytes()) == 300
    with pytest.raises(ArgumentError, match="no sound table"):
        other.load(str(path))
    gmodel.save()
    assert len(path.with_name(f"{path.name}.old").read_bytes()) == 300
    assert other.load()


def test_files_of_elsewhere(env, gmodel, tmp_path, caplog):
    few(gmodel).save()
    file = tmp_path / "mine.pp"
    os.rename(gmodel.getfilename(True), file)
    other = model_of(env)
    assert not other.load()
    assert other.load(file=str(file))
    assert np.array_equal(other.grasps, gmodel.grasps)
    assert caplog.text == ""
    table = model_of(env, "table")
    assert table.load(file=str(file))
    assert "was made for other links or shapes than those of target 'table'" in caplog.text
    with pytest.raises(ArgumentError, match=r"cannot read .*nothing\.pp: No such file"):
        other.load(file=str(tmp_path / "nothing.pp"))


def test_tables_of_another_hand(env, gmodel, tmp_path):
    few(gmodel).save()
    path = gmodel.getfilename(True)
    one_finger = HAND.replace("<joints>jl jr</joints>", "<joints>jl</joints>").replace(">1 1<", ">1<")
    other = ravemj.Environment()
    other.LoadData(f"<Environment>{one_finger}{THING}</Environment>")
    with pytest.raises(ArgumentError, match=r"is a table of 'grip' of 'hand' \(jl, jr\), and 'grip' of 'hand' has jl"):
        model_of(other).load(file=path)


def test_pickles_of_openrave(env, gmodel, tmp_path):
    few(gmodel)
    params = {"grasps": gmodel.grasps, "graspindices": dict(gmodel.graspindices), "friction": 0.35, "avoidlinks": []}
    file = tmp_path / "graspset.pp"
    file.write_bytes(pickle.dumps((10, params), 2))
    other = model_of(env)
    assert other.load(file=str(file))
    assert np.array_equal(other.grasps, gmodel.grasps)
    assert other.grasper.friction == 0.35


# Interruptions


def interrupted(gmodel, monkeypatch, after):
    """Generate, and press Ctrl-C after some files."""
    from ravemj.compat.databases import grasp_generation

    tried = []
    original = grasp_generation.tried

    def counted(*arguments):
        tried.append(1)
        if len(tried) > after:
            raise KeyboardInterrupt
        return original(*arguments)

    monkeypatch.setattr(grasp_generation, "tried", counted)
    with pytest.raises(KeyboardInterrupt):
        gmodel.autogenerate()
    monkeypatch.setattr(grasp_generation, "tried", original)


@pytest.mark.stress
def test_ctrl_c_keeps_what_is_done(env, gmodel, database, monkeypatch, caplog):
    from ravemj.compat.databases import grasp_generation

    interrupted(gmodel, monkeypatch, 40)
    assert "stopped: 32 of 432 candidates are tried; the same call goes on from there" in caplog.text
    caplog.clear()
    other = model_of(env)
    assert other.load()
    assert "is partial: 32 of 432 candidates are tried" in caplog.text
    assert other.has()
    partial = len(other.grasps)
    tried = []
    original = grasp_generation.tried
    monkeypatch.setattr(grasp_generation, "tried", lambda *given: tried.append(1) or original(*given))
    other.autogenerate()
    assert "going on with 32 of 432 candidates" in caplog.text
    assert len(tried) == 400
    assert len(other.grasps) > partial
    assert files(database) == [os.path.relpath(other.getfilename(True), database)]


@pytest.mark.stress
def test_other_settings_start_anew(env, gmodel, monkeypatch):
    interrupted(gmodel, monkeypatch, 40)
    few(gmodel)
    assert len(gmodel.grasps) == 24
    assert gmodel.load()  # what was stopped is still there


def test_targets_that_cannot_be_grasped_are_refused(env, gmodel, database):
    model = ravemj.databases.grasping.GraspingModel
    with pytest.raises(ArgumentError, match="target 'hand' is the robot; expected a body"):
        model(gmodel.robot, gmodel.robot).autogenerate()
    other = ravemj.Environment()
    other.LoadData(WORLD)
    with pytest.raises(ArgumentError, match="'thing' is not in the environment of robot 'hand'"):
        model(gmodel.robot, other.GetKinBody("thing")).generate(approachrays=[[0, 0, 0.02, 0, 0, 1]])
    assert files(database) == []


def test_errors_of_generation_are_told(gmodel, monkeypatch):
    from ravemj.compat.databases import grasp_generation

    def broken(*given):
        raise ValueError("broken")

    monkeypatch.setattr(grasp_generation, "tried", broken)
    with pytest.raises(ravemj.SweepError, match="ValueError: broken"):
        gmodel.autogenerate()


def run(script, processes):
    command = [sys.executable, str(script), str(processes)]
    named = dict(env={**os.environ, "PYTHONPATH": str(PACKAGE_ROOT)}, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return subprocess.Popen(command, text=True, **named)


@pytest.mark.stress
@pytest.mark.parametrize("processes", [1, 2])
def test_a_killed_generation_goes_on(env, gmodel, database, tmp_path, processes):
    script = tmp_path / "generate.py"
    script.write_text(SCRIPT)
    for _ in range(4):
        running = run(script, processes)
        before = done(database)
        deadline = time.monotonic() + 60
        while done(database) < before + 20 and running.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        running.send_signal(signal.SIGKILL)
        running.communicate()
        if done(database):
            assert gmodel.load()
    assert done(database) >= 20 or os.path.exists(gmodel.getfilename(False))
    out, log = run(script, processes).communicate(timeout=300)
    assert "going on with" in log or not log
    found = read_grasps(gmodel.getfilename(True))
    assert int(out) == len(found.rows)
    assert found.tried == found.candidates == 432
    os.remove(gmodel.getfilename(True))
    gmodel.autogenerate()
    assert np.array_equal(gmodel.grasps, found.rows)


@pytest.mark.stress
def test_processes_do_not_repeat_the_script(tmp_path, gmodel):
    """A script without a guard for processes runs once."""
    script = tmp_path / "plain.py"
    script.write_text(SCRIPT.replace('if __name__ == "__main__":\n    main()', 'print("begin", flush=True)\nmain()'))
    out, log = run(script, 2).communicate(timeout=300)
    assert out.split()[:1] == ["begin"]
    assert out.count("begin") == 1
    assert log == ""
    assert read_grasps(gmodel.getfilename(True)).tried == 432


def done(database):
    return max((Sweep.open(path.parent).done for path in database.rglob("manifest.json")), default=0)


# Use


def test_valid_grasps_avoid_the_table(env, gmodel):
    few(gmodel)
    everything, numbers = gmodel.computeValidGrasps(checkik=False)
    assert numbers == list(range(24))
    env.GetKinBody("table").SetTransform(ravemj.matrixFromPose([1, 0, 0, 0, 0, 0, -0.035]))
    before = gmodel.robot.GetDOFValues()
    found, numbers = gmodel.computeValidGrasps(checkik=False)
    assert 0 < len(found) < len(everything)
    for grasp in found:
        assert gmodel.getGlobalApproachDir(grasp)[2] < 0.5
    assert gmodel.computeValidGrasps(checkik=False, returnnum=2)[1] == numbers[:2]
    assert gmodel.computeValidGrasps(checkik=False, startindex=numbers[0] + 1)[1] == numbers[1:]
    assert gmodel.computeValidGrasps(checkik=False, checkcollision=False)[1] == list(range(24))
    assert len(gmodel.computeValidGrasps(checkik=False, backupdist=0.3)[0]) <= len(found)
    assert np.array_equal(gmodel.robot.GetDOFValues(), before)


def test_iterators_yield_each_grasp(gmodel):
    few(gmodel)
    assert [number for _, number in gmodel.validGraspIterator(checkik=False)] == list(range(24))
    numbers = [number for _, number in gmodel.validGraspIterator(checkik=False, randomgrasps=True)]
    assert sorted(numbers) == list(range(24))
    grasp, number, contacts, (values, T) = next(gmodel.validGraspIterator(checkik=False, returnfinal=True))
    assert number == 0
    assert contacts.shape[1] == 6
    assert values == pytest.approx(grasp[list(gmodel.graspindices["igraspfinalfingers"])], abs=1e-4)
    assert T.shape == (4, 4)


def test_poses_follow_the_target(env, gmodel):
    grasp = few(gmodel).grasps[3]
    before = gmodel.getGlobalGraspTransform(grasp)
    T = ravemj.matrixFromPose([np.cos(0.3), 0, np.sin(0.3), 0, 1, 2, 3])
    gmodel.target.SetTransform(T)
    assert gmodel.getGlobalGraspTransform(grasp) == pytest.approx(T @ before)
    assert gmodel.GetLocalGraspTransform(grasp) == pytest.approx(before)
    assert gmodel.getGlobalApproachDir(grasp) == pytest.approx(
        T[:3, :3] @ grasp[list(gmodel.graspindices["igraspdir"])]
    )


def test_grasps_are_shown(env, gmodel):
    few(gmodel)
    gmodel.grasps = gmodel.grasps[:2]
    before = gmodel.robot.GetTransform()
    gmodel.show(delay=0)
    gmodel.showgrasp(gmodel.grasps[0], delay=0, showfinal=True)
    assert np.array_equal(gmodel.robot.GetTransform(), before)
    assert all(geometry.IsVisible() for link in gmodel.robot.GetLinks() for geometry in link.GetGeometries())


def test_preshapes_are_reached(env, gmodel):
    few(gmodel, preshapes=[[0.005, 0.01]])
    gmodel.moveToPreshape(gmodel.grasps[0])
    assert gmodel.robot.GetDOFValues() == pytest.approx([0.005, 0.01])
    gmodel.setFinalFingerValues(gmodel.grasps[0])
    assert gmodel.robot.GetDOFValues() == pytest.approx(
        gmodel.grasps[0][list(gmodel.graspindices["igraspfinalfingers"])]
    )


def test_the_log_is_quiet_without_reason(gmodel, caplog):
    with caplog.at_level(logging.WARNING):
        few(gmodel)
        gmodel.save()
        gmodel.load()
    assert caplog.text == ""

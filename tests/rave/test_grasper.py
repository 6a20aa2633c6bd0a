"""The module, the planner and the wrapper Grasper: answers that are known, other hands, turned worlds, wrong input."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from command_line import PACKAGE_ROOT

import ravemj
from ravemj import (
    DOFAffine,
    Planner,
    PlannerStatus,
    PlanningError,
    RaveCreateModule,
    RaveCreatePlanner,
    RaveCreateTrajectory,
    interfaces,
    matrixFromAxisAngle,
    matrixFromPose,
)

pytestmark = pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")

SLIDERS = """<Robot name="hand"><KinBody>
<Body name="palm"><Geom type="box"><extents>.06 .02 .01</extents></Geom></Body>
<Body name="left"><Translation>-.045 0 .04</Translation><Geom type="box"><extents>.005 .01 .03</extents></Geom></Body>
<Body name="right"><Translation>.045 0 .04</Translation><Geom type="box"><extents>.005 .01 .03</extents></Geom></Body>
<Joint name="jl" type="slider"><Body>palm</Body><Body>left</Body><axis>1 0 0</axis><limits>0 .04</limits></Joint>
<Joint name="jr" type="slider"><Body>palm</Body><Body>right</Body><axis>-1 0 0</axis><limits>0 .04</limits></Joint>
</KinBody><Manipulator name="grip"><base>palm</base><effector>palm</effector><joints>jl jr</joints>
<closingdirection>1 1</closingdirection><direction>0 0 1</direction><Translation>0 0 .04</Translation></Manipulator>
</Robot>"""
MIMIC = SLIDERS.replace(
    'Joint name="jr" type="slider"', 'Joint name="jr" type="slider" enable="true" mimic_pos="jl" mimic_vel="|jl 1"'
).replace("<joints>jl jr</joints>\n<closingdirection>1 1", "<joints>jl</joints>\n<closingdirection>1")
THREE = """<Robot name="hand"><KinBody>
<Body name="palm"><Geom type="box"><extents>.03 .03 .01</extents></Geom></Body>
{}</KinBody><Manipulator name="grip"><base>palm</base><effector>palm</effector><joints>j0 j1 j2</joints>
<closingdirection>1 1 1</closingdirection><direction>0 0 1</direction><Translation>0 0 .05</Translation></Manipulator>
</Robot>""".format(
    "".join(
        f"<Body name='f{k}'><Translation>{0.05 * np.cos(a):.9f} {0.05 * np.sin(a):.9f} .01</Translation>"
        f"<Rotationaxis>0 0 1 {np.degrees(a):.9f}</Rotationaxis>"
        "<Geom type='box'><extents>.005 .008 .04</extents><Translation>0 0 .045</Translation></Geom></Body>"
        f"<Joint name='j{k}' type='hinge'><Body>palm</Body><Body>f{k}</Body><offsetfrom>f{k}</offsetfrom>"
        "<axis>0 -1 0</axis><limitsdeg>-30 60</limitsdeg></Joint>"
        for k, a in enumerate(np.array([0, 2, 4]) * np.pi / 3)
    )
)
BOX = "<Geom type='box'><extents>.02 .03 .02</extents></Geom>"
SPHERE = "<Geom type='sphere'><radius>.02</radius></Geom>"
CYLINDER = "<Geom type='cylinder'><rotationaxis>1 0 0 90</rotationaxis><radius>.02</radius><height>.06</height></Geom>"
CUBE = [[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)]
TRIANGLES = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]]
TRIANGLES += [[0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]


class Scene:
    """A hand, a thing, and a grasp along the z axis of the thing."""

    def __init__(self, thing=BOX, hand=SLIDERS, extra=""):
        self.env = ravemj.Environment()
        body = f"<KinBody name='thing'><Body name='b'>{thing}</Body></KinBody>" if thing else ""
        self.env.LoadData(f"<Environment>{hand}{body}{extra}</Environment>")
        self.robot, self.thing = self.env.GetRobot("hand"), self.env.GetKinBody("thing")
        self.manip = self.robot.GetActiveManipulator()

    def grasp(self, friction=0.4, avoid=(), moves=True, **named):
        affine = DOFAffine.X | DOFAffine.Y | DOFAffine.Z if moves else 0
        self.robot.SetActiveDOFs(self.manip.GetGripperIndices(), affine)
        grasper = interfaces.Grasper(self.robot, friction, [self.robot.GetLink(name) for name in avoid])
        options = {"direction": [0, 0, 1], "target": self.thing, "forceclosure": True, "execute": False}
        contacts, final, mindist, volume = grasper.Grasp(**{**options, "outputfinal": True, **named})
        return contacts, final[0], final[1], mindist, volume


def sides(contacts):
    return sorted({tuple((np.round(normal, 2) + 0.0).tolist()) for normal in contacts[:, 3:]})


def reason(call):
    with pytest.raises(PlanningError) as caught:
        call()
    return str(caught.value)


def with_mesh():
    scene = Scene(thing="")
    thing = ravemj.RaveCreateKinBody(scene.env, "")
    thing.InitFromTrimesh(ravemj.TriMesh(np.array(CUBE) * [0.02, 0.03, 0.02], np.array(TRIANGLES)), True)
    thing.SetName("thing")
    scene.env.Add(thing)
    scene.thing = thing
    return scene


@pytest.mark.parametrize("make", [Scene, with_mesh, lambda: Scene(hand=MIMIC)])
def test_sliders_on_a_box(make):
    scene = make()
    contacts, values, T, mindist, volume = scene.grasp()
    np.testing.assert_allclose(values, 0.02, atol=1e-4)
    np.testing.assert_allclose(T, matrixFromPose([1, 0, 0, 0, 0, 0, -0.03]), atol=1e-4)
    assert sides(contacts) == [(-1, 0, 0), (0, 0, -1), (1, 0, 0)]
    assert mindist == pytest.approx(0.011872, rel=2e-3)
    assert volume > 0
    alone, _, T, mindist, _ = scene.grasp(standoff=0.01)
    assert sides(alone) == [(-1, 0, 0), (1, 0, 0)]
    assert mindist == pytest.approx(0.007878, rel=2e-3)
    assert T[2, 3] == pytest.approx(-0.04, abs=1e-4)


def test_two_opposite_points_of_a_sphere_never_close_and_a_third_does():
    scene = Scene(SPHERE)
    for friction in (0.1, 0.4, 2.0):
        contacts, *_, mindist, volume = scene.grasp(friction, standoff=0.01)
        assert (len(contacts), mindist, volume) == (2, 0.0, 0.0)
    *_, mindist, volume = scene.grasp()
    assert mindist == pytest.approx(0.00182898, rel=2e-3)
    assert volume == pytest.approx(9.208e-8, rel=1e-2)
    assert scene.grasp(0.0)[3] == 0.0


@pytest.mark.parametrize("turn", [(0.3, -0.2, 0.1), (1.0, 2.0, -0.5), (0, np.pi, 0)])
@pytest.mark.parametrize("thing", [BOX, CYLINDER, SPHERE])
def test_worlds_may_be_turned(turn, thing):
    scene = Scene(thing)
    here, values, T, _, volume = scene.grasp(standoff=0.005)
    T_world_thing = matrixFromAxisAngle(turn)
    T_world_thing[:3, 3] = 0.5, 0.2, 0.3
    scene.thing.SetTransform(T_world_thing)
    there, turned_values, turned, _, turned_volume = scene.grasp(standoff=0.005)
    np.testing.assert_allclose(turned_values, values, atol=1e-4)
    np.testing.assert_allclose(turned, T_world_thing @ T, atol=1e-4)
    back = there[:, 3:] @ T_world_thing[:3, :3]
    assert sides(np.hstack([there[:, :3], back])) == sides(here)
    assert turned_volume == pytest.approx(volume, rel=0.2)


@pytest.mark.parametrize(
    ("thing", "friction", "closed"),
    [
        (CYLINDER, 0.4, True),
        (SPHERE, 0.4, False),
        (SPHERE, 0.8, True),
    ],  # its normals lean by 28 degrees
)
def test_three_fingers_hold_what_does_not_slip_out(thing, friction, closed):
    contacts, values, *_, mindist, _ = Scene(thing, THREE).grasp(friction, standoff=0.02)
    assert np.ptp(values) < 0.01  # by symmetry
    assert (mindist > 1e-4) == closed
    np.testing.assert_allclose(contacts[:, 3:].mean(axis=0)[:2], 0, atol=1e-3)


def test_the_robot_stays_as_it_is_and_contacts_lie_on_the_surface():
    scene = Scene()
    scene.robot.SetTransform(matrixFromPose([1, 0, 0, 0, 3, 2, 1]))
    scene.robot.SetDOFValues([0.001, 0.002])
    contacts = scene.grasp()[0]
    np.testing.assert_array_equal(scene.robot.GetTransform(), matrixFromPose([1, 0, 0, 0, 3, 2, 1]))
    np.testing.assert_array_equal(scene.robot.GetDOFValues(), [0.001, 0.002])
    assert not scene.env.CheckCollision(scene.robot)
    assert np.abs(np.abs(contacts[:, :3]) - [0.02, 0.03, 0.02]).min(axis=1).max() < 1e-4


def test_execute_moves_the_joints():
    scene = Scene()
    scene.grasp(execute=True)
    scene.robot.WaitForController(0)
    scene.env.StepSimulation(0.01)
    np.testing.assert_allclose(scene.robot.GetDOFValues(), 0.02, atol=1e-4)


def test_reasons_say_what_to_change():
    assert reason(lambda: Scene().grasp(position=[1, 1, 0])) == "flies past the target"
    table = "<KinBody name='table'><Body><Geom type='box'><extents>1 1 .01</extents></Geom>"
    table += "<Translation>0 0 -.035</Translation></Body></KinBody>"
    assert "touches 'table' first" in reason(lambda: Scene(extra=table).grasp(position=[0, 0, -0.2]))
    wall = "<KinBody name='wall'><Body><Geom type='box'><extents>.001 .01 .01</extents></Geom>"
    wall += "<Translation>.03 0 0</Translation></Body></KinBody>"
    assert reason(lambda: Scene(extra=wall).grasp(standoff=0.01)) == "finger 'jr' touches 'wall' first"
    assert Scene(extra=wall).grasp(standoff=0.01, onlycontacttarget=False)[1][1] == pytest.approx(0.009, abs=1e-4)


def test_avoided_links_are_avoided():
    """OpenRAVE loses the list of avoided links (case grasp-16): it grasps."""
    assert reason(lambda: Scene().grasp(avoid=["palm"])) == "avoided link 'palm' touches"
    assert reason(lambda: Scene().grasp(avoid=["left"], standoff=0.01)) == "avoided link 'left' touches"
    assert Scene().grasp(avoid=["palm"], standoff=0.01)[3] > 0


def test_reasons_are_data():
    with pytest.raises(PlanningError) as caught:
        Scene().grasp(avoid=["palm"])
    assert (caught.value.parameter.kind, caught.value.parameter.name) == ("avoided link", "palm")


def test_noise_spreads_the_grasps_and_the_target_stays():
    scene = Scene()
    places = np.array([scene.grasp(graspingnoise=0.01, standoff=0.01)[2][:3, 3] for _ in range(10)])
    assert 1e-4 < places.std(axis=0).max() < 0.02
    np.testing.assert_array_equal(scene.thing.GetTransform(), np.eye(4))


def test_stable_contacts_are_those_that_fingers_press():
    scene = Scene()
    contacts = scene.grasp(stablecontacts=True, standoff=0.01)[0]
    assert sides(contacts) == [(-1, 0, 0), (1, 0, 0)]
    assert len(scene.grasp(stablecontacts=True, standoff=0.01, chuckingdirection=[1, 0])[0]) == 4
    assert len(scene.grasp(friction=0.0, stablecontacts=True)[0]) == 0


def test_the_tool_stops_on_a_plane_and_fingers_in_a_given_order():
    scene = Scene()
    T = scene.grasp(vintersectplane=[0, 0, 1, 0.02])[2]
    assert T[2, 3] == pytest.approx(-0.06)  # the tool is 0.04 before the palm
    scene.thing.SetTransform(matrixFromPose([1, 0, 0, 0, 0, 0, 1]))
    scene.robot.SetDOFLimits([0, 0], [0.06, 0.06])
    for order in ([0, 1], [1, 0]):
        values = scene.grasp(moves=False, transformrobot=False, ordereddofindices=order)[1]
        np.testing.assert_allclose(values[order], [0.06, 0.02], atol=2e-4)  # the second meets the first


def test_wrong_arguments():
    scene = Scene()
    assert "no target" in reason(lambda: scene.grasp(target=None))
    for named, text in (
        ({"direction": [0, 0, 0]}, "direction is 0 0 0"),
        ({"direction": [0, 1]}, "direction"),
        ({"standoff": np.nan}, "standoff"),
        ({"coarsestep": 0}, "coarsestep is 0"),
        ({"ordereddofindices": [0]}, "ordereddofindices"),
        ({"chuckingdirection": [1]}, "chuckingdirection has 1 numbers"),
        ({"target": scene.robot}, "holds or is target"),
    ):
        with pytest.raises((ravemj.openrave_exception, ValueError), match=text):
            scene.grasp(**named)
    empty = Scene(thing="")
    empty.thing = ravemj.RaveCreateKinBody(empty.env, "")
    empty.thing.InitFromBoxes(np.zeros((0, 6)))
    empty.thing.SetName("thing")
    with pytest.raises(ravemj.openrave_exception, match="is not in the environment"):
        empty.grasp()
    empty.env.Add(empty.thing)
    with pytest.raises(ravemj.openrave_exception, match="'thing' has no shapes"):
        empty.grasp()
    scene.robot.SetActiveDOFs([])
    with pytest.raises(ravemj.openrave_exception, match="no joint is active"):
        interfaces.Grasper(scene.robot).Grasp(target=scene.thing, transformrobot=False)
    scene.robot.Grab(scene.thing)
    with pytest.raises(ravemj.openrave_exception, match="release it first"):
        scene.grasp()


def test_a_hand_around_the_target_at_the_start_begins_there():
    scene = Scene()
    scene.robot.SetTransform(matrixFromPose([1, 0, 0, 0, 0, 0, -0.04]))
    scene.robot.SetDOFValues([0.03, 0.03])  # fingers inside
    values = scene.grasp(moves=False, transformrobot=False)[1]
    np.testing.assert_array_equal(values, [0.03, 0.03])
    assert reason(lambda: scene.grasp(moves=False, transformrobot=False, avoidcontact=True)).endswith(
        "starts in contact"
    )


@pytest.mark.stress
def test_candidates_come_in_the_order_of_their_indices():
    scene = Scene()
    scene.robot.SetActiveDOFs(scene.manip.GetGripperIndices(), DOFAffine.X | DOFAffine.Y | DOFAffine.Z)
    grasper = interfaces.Grasper(scene.robot, 0.4)
    rays = np.array([[0, 0, -0.1, 0, 0, 1], [0.5, 0, 0, 0, 0, 1], [0, 0, 0.1, 0, 0, -1.0]])
    parts = {"approachrays": rays, "standoffs": [0, 0.01], "preshapes": [[0, 0], [0.01, 0.01]], "rolls": [0, np.pi / 2]}
    following, found = grasper.GraspThreaded(**parts, target=scene.thing, forceclosurethreshold=1e-9)
    assert following == 24
    rows = [(one[0][2], one[2], one[7][0], one[3]) for one in found]
    assert rows == sorted(rows, key=lambda row: (row[0], row[1], row[2], row[3]))
    assert {row[0] for row in rows} == {-0.1, 0.1}
    first, some = grasper.GraspThreaded(**parts, target=scene.thing, forceclosurethreshold=1e-9, maxgrasps=3)
    _, rest = grasper.GraspThreaded(**parts, target=scene.thing, forceclosurethreshold=1e-9, startindex=first)
    assert [one[5] for one in [*some, *rest]] == pytest.approx([one[5] for one in found])
    assert len(some) == 3
    noisy = grasper.GraspThreaded(**parts, target=scene.thing, graspingnoise=(1e-4, 3), maxgrasps=1)[1]
    assert len(noisy) == 1  # of 24, and chance rejects a third
    np.testing.assert_array_equal(scene.robot.GetDOFValues(), [0, 0])


def many_candidates(scene):
    """Arguments of GraspThreaded with 288 candidates."""
    scene.robot.SetActiveDOFs(scene.manip.GetGripperIndices(), DOFAffine.X | DOFAffine.Y | DOFAffine.Z)
    rays = [[x, y, -0.1, 0, 0, 1] for x in np.linspace(-0.03, 0.03, 6) for y in np.linspace(-0.04, 0.04, 6)]
    parts = {"standoffs": [0, 0.01], "preshapes": [[0, 0], [0.01, 0.01]], "rolls": [0, np.pi / 2]}
    return {"approachrays": rays, **parts, "target": scene.thing, "forceclosurethreshold": 1e-9}


@pytest.mark.stress
def test_processes_find_the_same_grasps():
    scene = Scene()
    grasper, parts = interfaces.Grasper(scene.robot, 0.4), many_candidates(scene)
    for some in ({}, {"maxgrasps": 5}, {"startindex": 100, "maxgrasps": 7}, {"startindex": 280}):
        following, found = grasper.GraspThreaded(**parts, **some)
        other, others = grasper.GraspThreaded(**parts, **some, numthreads=2)
        assert (other, len(others)) == (following, len(found))
        assert len(found) > 2 or following == 288
        for one, two in zip(found, others, strict=True):
            for number, same in zip(one, two, strict=True):
                np.testing.assert_array_equal(number, same)
    np.testing.assert_array_equal(scene.robot.GetDOFValues(), [0, 0])


def test_candidates_need_a_target_and_processes():
    scene = Scene()
    grasper, parts = interfaces.Grasper(scene.robot, 0.4), many_candidates(scene)
    with pytest.raises(PlanningError, match="there is no target"):
        grasper.GraspThreaded(**{**parts, "target": None})
    with pytest.raises(ravemj.openrave_exception, match="numthreads is -1, and should be 1 or more"):
        grasper.GraspThreaded(**parts, numthreads=-1)


SLOW = f"""
import sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
from test_grasper import Scene, interfaces, many_candidates

if __name__ == "__main__":
    scene = Scene()
    parts = many_candidates(scene)
    parts["approachrays"] = parts["approachrays"] * 200
    print("begin", flush=True)
    try:
        interfaces.Grasper(scene.robot, 0.4).GraspThreaded(**parts, numthreads=int(sys.argv[1]))
    except KeyboardInterrupt:
        print("stopped", *scene.robot.GetDOFValues(), flush=True)
"""


@pytest.mark.stress
@pytest.mark.parametrize("processes", ["1", "2"])
def test_ctrl_c_cancels_it(tmp_path, processes):
    script = tmp_path / "slow.py"
    script.write_text(SLOW)
    environment = {**os.environ, "PYTHONPATH": f"{PACKAGE_ROOT}:{Path(__file__).parents[1]}"}
    command = [sys.executable, "-W", "ignore", str(script), processes]
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None
        assert running.stdout.readline() == "begin\n"
        time.sleep(3)  # processes begin
        running.send_signal(signal.SIGINT)
        assert running.communicate(timeout=20)[0] == "stopped 0.0 0.0\n"


def test_commands_answer_in_numbers():
    scene = Scene()
    scene.robot.SetActiveDOFs(scene.manip.GetGripperIndices(), DOFAffine.X | DOFAffine.Y | DOFAffine.Z)
    module = RaveCreateModule(scene.env, "grasper")
    scene.env.Add(module, True, "hand planner Grasper")
    words = "Grasp body thing direction 0 0 1 standoff 0.01 friction 0.4 execute 0 manipulatordirection 0 0 1"
    rows = [row.split() for row in module.SendCommand(words + " getlinkcollisions 1").splitlines()]
    assert [len(rows), {len(row) for row in rows}, {row[6] for row in rows}] == [8, {7}, {"1", "2"}]
    answer = module.SendCommand(words + " outputfinal 1 forceclosure 1").split()
    numbers = np.array(answer[-11:], dtype=float)  # pose, joints, distance and volume
    np.testing.assert_allclose(numbers[:9], [1, 0, 0, 0, 0, 0, -0.04, 0.02, 0.02], atol=1e-4)
    assert numbers[9] == pytest.approx(0.007878, rel=2e-3)
    assert module.SendCommand("Grasp target nothing execute 0") is None
    with pytest.raises(ravemj.openrave_exception, match="no link 'thumb'"):
        module.SendCommand(words + " avoidlink thumb")
    threaded = "GraspThreaded target thing approachrays 1 0 0 0 0 0 1 rolls 1 0 standoffs 2 0 .01 preshapes 1 0 0 "
    answer = module.SendCommand(threaded + "forceclosure 1 1e-9 friction .4 numthreads 1 maxgrasps 10").split()
    assert answer[:2] == ["2", "2"]
    with pytest.raises(NotImplementedError):
        module.SendCommand("ComputeDistanceMap target thing")


def test_stable_contacts_of_the_present_configuration():
    scene = Scene()
    scene.robot.SetActiveDOFs(scene.manip.GetGripperIndices())
    scene.robot.SetTransform(matrixFromPose([1, 0, 0, 0, 0, 0, -0.04]))
    scene.robot.SetDOFValues([0.02001, 0.02001])
    module = RaveCreateModule(scene.env, "Grasper")
    scene.env.Add(module, True, "hand")
    assert len(module.SendCommand("GetStableContacts direction 0 0 1 friction 0.4").splitlines()) == 8
    assert module.SendCommand("GetStableContacts direction 0 0 1 friction 0") is None


def planned(scene, extra, signs=(1, 1, 0, 0, 0)):
    scene.robot.SetActiveDOFs(scene.manip.GetGripperIndices(), DOFAffine.X | DOFAffine.Y | DOFAffine.Z)
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(scene.robot)
    params.SetGoalConfig(signs)
    params.SetExtraParameters(f"<targetbody>thing</targetbody><btransformrobot>1</btransformrobot>{extra}")
    planner, traj = RaveCreatePlanner(scene.env, "Grasper"), RaveCreateTrajectory(scene.env, "")
    return planner, planner.InitPlan(scene.robot, params), planner.PlanPath(traj), traj


def test_the_planner_reads_openraves_parameters():
    scene = Scene()
    _, ready, status, traj = planned(scene, "<fstandoff>0.01</fstandoff><vtargetdirection>0 0 1</vtargetdirection>")
    assert ready
    assert status == PlannerStatus.HasSolution
    spec = traj.GetConfigurationSpecification()
    assert traj.GetNumWaypoints() == 1
    np.testing.assert_allclose(spec.ExtractJointValues(traj.GetWaypoint(0), scene.robot, [0, 1]), 0.02, atol=1e-4)
    T = spec.ExtractTransform(np.eye(4), traj.GetWaypoint(0), scene.robot)
    assert T[2, 3] == pytest.approx(-0.04, abs=1e-4)
    path = planned(scene, "<breturntrajectory>1</breturntrajectory>")[3]
    assert path.GetNumWaypoints() == 4
    avoided = planned(scene, "<vavoidlinkgeometry>palm</vavoidlinkgeometry>")[2]
    assert avoided == PlannerStatus.Failed
    assert "avoided link 'palm' touches" in avoided.description
    assert "vtargetdirection" in planned(scene, "<vtargetdirection>0 1</vtargetdirection>")[2].description
    assert "no body 'cup'" in planned(scene, "<targetbody>cup</targetbody>")[2].description
    assert planned(scene, "", (1, 0, 0, 0, 0))[3].GetWaypoint(0)[1] == 0


def test_fingers_open_out_of_contact_and_offsets_go_on():
    scene = Scene()
    scene.robot.SetTransform(matrixFromPose([1, 0, 0, 0, 0, 0, -0.04]))
    task = interfaces.TaskManipulation(scene.robot)
    final, traj = task.CloseFingers(execute=False, outputfinal=True, outputtrajobj=True, offset=[0.001, 0.002])
    np.testing.assert_allclose(final, 0.02, atol=2e-4)
    spec = traj.GetConfigurationSpecification()
    last = spec.ExtractJointValues(traj.GetWaypoint(-1), scene.robot, [0, 1])
    np.testing.assert_allclose(last - final, [0.001, 0.002], atol=1e-9)
    scene.robot.SetDOFValues(final)
    opened = task.ReleaseFingers(execute=False, outputfinal=True)[0]
    np.testing.assert_array_equal(opened, [0, 0])
    scene.robot.SetDOFValues([0.038, 0.038])  # 18 mm inside of the box
    assert "starts in contact" in reason(lambda: task.ReleaseFingers(execute=False))


def test_hulls_of_flat_points_are_refused():
    grasper = interfaces.Grasper(Scene().robot)
    planes, faces, triangles = grasper.ConvexHull(np.array(CUBE))
    assert [len(planes), len(faces), len(triangles)] == [6, 6, 12]
    assert grasper.ConvexHull(np.array(CUBE), returnfaces=False, returntriangles=False)[1:] == (None, None)
    assert "flat" in reason(lambda: grasper.ConvexHull(np.array(CUBE)[:4]))


def test_a_clone_works_in_a_cloned_environment():
    scene = Scene()
    other = scene.env.CloneSelf(ravemj.CloningOptions.Bodies)
    grasper = interfaces.Grasper(scene.robot, 0.4, [scene.robot.GetLink("palm")]).clone(other)
    other.GetRobot("hand").SetActiveDOFs([0, 1], DOFAffine.X)
    with pytest.raises(PlanningError, match="palm"):
        grasper.Grasp(target=other.GetKinBody("thing"), execute=False)

"""``openravepy.misc``: options of scripts, logging, drawing, samples."""

import logging
import optparse

import numpy as np
import pytest

import ravemj
from ravemj import misc


class Canvas:
    """Takes lines, as an environment does."""

    def __init__(self, **bodies):
        self.bodies = bodies

    def GetKinBody(self, name):
        return self.bodies.get(name)

    def drawlinelist(self, points, linewidth, colors):
        return points, linewidth, colors

    drawlinestrip = drawlinelist


class Body:
    def GetTransform(self):
        return POSE


POSE = np.array([[0.0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
ENDS = [[1, 2, 3], [1, 2.5, 3], [1, 2, 3], [0.5, 2, 3], [1, 2, 3], [1, 2, 3.5]]


@pytest.mark.parametrize(
    "target",
    [POSE, POSE[:3], [0.5**0.5, 0, 0, 0.5**0.5, 1, 2, 3], Body(), "mug"],
    ids=["4", "3", "7", "object", "name"],
)
def test_axes(target):
    points, width, colours = misc.DrawAxes(Canvas(mug=Body()), target, dist=0.5, linewidth=3)
    np.testing.assert_allclose(points, ENDS, atol=1e-15)
    assert width == 3
    assert colours[::2].tolist() == np.eye(3).tolist()


def test_axes_of_several_and_of_the_world():
    drawn = misc.DrawAxes(Canvas(), [POSE, Body(), None], 0.5, colormode="cmy", coloradd=[0, 0, 0.5])
    assert len(drawn) == 3
    np.testing.assert_allclose(drawn[1][0], ENDS)
    np.testing.assert_allclose(drawn[2][0][1], [0.5, 0, 0])
    assert drawn[0][2][4].tolist() == [1, 1, 0.5]


def test_axes_of_nothing_say_so():
    with pytest.raises(ravemj.openrave_exception, match="'cup'"):
        misc.DrawAxes(Canvas(), "cup")


def test_a_circle_goes_round_its_normal():
    points, _, colour = misc.DrawCircle(Canvas(), [1, 2, 3], [0, 1, 2], 0.5, colors=None)
    assert list(colour) == [0, 0, 0]
    arms = points - [1, 2, 3]
    np.testing.assert_allclose(np.linalg.norm(arms, axis=1), 0.5)
    np.testing.assert_allclose(arms @ [0, 1, 2], 0, atol=1e-12)
    np.testing.assert_allclose(points[0], points[-1])
    assert len({tuple(row) for row in points.round(6)}) == 64


# Scripts


@pytest.fixture
def parsed():
    def parse(*arguments):
        parser = optparse.OptionParser()
        misc.OpenRAVEGlobalArguments.addOptions(parser)
        parser.add_option("--robot")
        return parser.parse_args(list(arguments))[0]

    yield parse
    ravemj.RaveSetDebugLevel(ravemj.DebugLevel.Info)
    logging.getLogger("ravemj").setLevel(logging.NOTSET)


def test_examples_start_with_options_an_environment_and_a_viewer(parsed, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    seen = []

    def main(env, options):
        seen.append((env.GetViewer() and env.GetViewer().GetName(), options.robot))

    start = misc.OpenRAVEGlobalArguments.parseAndCreateThreadedUser
    start(parsed("--robot", "a"), main)
    start(parsed("--viewer", "qtosg"), main)
    start(parsed("--viewer="), main)
    start(parsed(), main, defaultviewer=False)
    assert seen == [("qtcoin", "a"), ("qtosg", None), (None, None), (None, None)]


def test_options_are_applied_to_an_environment(parsed, env):
    apply = misc.OpenRAVEGlobalArguments.parseEnvironment
    assert apply(parsed("--level", "Debug"), env, returnviewer=True) == ""
    assert ravemj.RaveGetDebugLevel() == ravemj.DebugLevel.Debug
    assert apply(parsed("-l", "1"), env, defaultviewer=True, returnviewer=True) == "qtcoin"
    assert ravemj.RaveGetDebugLevel() == ravemj.DebugLevel.Error
    assert apply(parsed(), env) is None
    assert env.GetViewer() is None
    assert misc.OpenRAVEGlobalArguments.parseAndCreate(parsed()).GetBodies() == []


def test_options_choose_what_collides_and_falls(parsed, env):
    apply = misc.OpenRAVEGlobalArguments.parseEnvironment
    env.GetPhysicsEngine().SetGravity([0, 0, -1])
    apply(parsed("--collision", "pqp", "--physics", "ode", "--debug", "Warn"), env)
    assert env.GetCollisionChecker().GetXMLId() == "pqp"
    assert env.GetPhysicsEngine().GetXMLId() == "ode"
    assert env.GetPhysicsEngine().GetGravity().tolist() == [0, 0, -1]
    assert ravemj.RaveGetDebugLevel() == ravemj.DebugLevel.Warn
    for option in ("--collision", "--physics"):
        with pytest.raises(ravemj.openrave_exception, match="'nosuch'"):
            apply(parsed(option, "nosuch"), env)


def test_trajectories_come_from_files(env, robot, tmp_path):
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    trajectory.Init(robot.GetConfigurationSpecificationIndices([0, 1], "linear"))
    trajectory.Insert(0, [0.1, 0.2, 0.3, 0.4])
    for options in (0, 0x8000):
        trajectory.SaveToFile(tmp_path / "file", options)
        found = misc.LoadTrajectoryFromFile(env, tmp_path / "file")
        assert found.GetAllWaypoints2D().tolist() == [[0.1, 0.2], [0.3, 0.4]]
    assert misc.LoadTrajectoryFromFile(env, tmp_path / "file", "nosuch") is None
    with pytest.raises(ravemj.openrave_exception, match="missing"):
        misc.LoadTrajectoryFromFile(env, tmp_path / "missing")


def test_logging_is_shown_once(capsys):
    try:
        misc.InitOpenRAVELogging()
        misc.InitOpenRAVELogging()
        ravemj.RaveLogInfo("to be seen")
        assert capsys.readouterr().out.count("to be seen") == 1
    finally:
        logging.getLogger("openravepy").handlers = []


def test_folders_and_products(tmp_path):
    for _ in range(2):
        misc.mkdir_recursive(str(tmp_path / "a" / "b"))
    assert (tmp_path / "a" / "b").is_dir()
    assert list(misc.myproduct([1, 2], "ab")) == [(1, "a"), (1, "b"), (2, "a"), (2, "b")]


# Samples


@pytest.mark.parametrize("level", [0, 1, 2])
def test_rotations_and_directions_cover_all_evenly(level):
    sampler = misc.SpaceSamplerExtra()
    directions = sampler.sampleS2(level)
    rotations = sampler.sampleSO3(level)
    assert len(directions) == 12 * 4**level
    assert len(rotations) == 72 * 8**level
    rng = np.random.default_rng(3)
    for samples, reach in ((directions, 1.2), (rotations, 0.75)):
        np.testing.assert_allclose(np.linalg.norm(samples, axis=1), 1)
        wanted = rng.normal(size=(200, samples.shape[1]))
        wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
        cosines = wanted @ samples.T
        nearest = np.arccos(np.abs(cosines).max(axis=1) if samples.shape[1] == 4 else cosines.max(axis=1))
        assert nearest.max() < reach / 2**level


def test_samples_by_distance():
    sampler = misc.SpaceSamplerExtra()
    assert 4 * np.pi / len(sampler.sampleS2(angledelta=0.2)) == pytest.approx(0.04, rel=0.01)
    assert len(sampler.sampleSO3(quatdelta=0.5)) == pytest.approx(8 * np.pi**2 / 0.125, rel=0.1)
    lattice = sampler.sampleR3lattice(0.5, [1, 2, 0.5])
    assert lattice.shape == (8, 3)
    assert lattice.max(axis=0).tolist() == [0.5, 1.5, 0]


def test_rotations_from_the_direction_that_they_take_to_x():
    sampler = misc.SpaceSamplerExtra()
    polar, azimuth = 0.7, 2.0
    direction = [np.cos(polar), -np.sin(polar) * np.sin(azimuth), np.sin(polar) * np.cos(azimuth)]
    one, other = sampler.hopf2quat([[polar, azimuth, 0], [polar, azimuth, -0.4]])
    for rotation in (one, other):
        np.testing.assert_allclose(ravemj.rotationMatrixFromQuat(rotation) @ direction, [1, 0, 0], atol=1e-12)
    turn = ravemj.quatMult(other, ravemj.quatInverse(one))
    np.testing.assert_allclose(ravemj.axisAngleFromQuat(turn), [-0.4, 0, 0], atol=1e-12)
    samples = sampler.sampleSO3(1)
    separation = sampler.computeSepration(samples)
    assert separation.shape == (len(samples),)
    nearest = sorted(np.arccos(min(1.0, abs(samples[0] @ other))) for other in samples[1:])[0]
    assert separation[0] == pytest.approx(nearest)
    with pytest.raises(NotImplementedError, match="HEALPix"):
        sampler.computeFaceIndices(8)

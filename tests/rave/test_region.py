"""Regions of tool poses: numbers from the note's formulas, rules by random examples."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ravemj
from ravemj import Region
from ravemj.geometry_functions.regions import weights
from ravemj.rave.region import region_of

ZERO = [0.0, 0.0]
TURN = [-math.pi, math.pi]


def pose(rotation=(0, 0, 0), position=(0, 0, 0)):
    T = ravemj.matrixFromAxisAngle(rotation)
    T[:3, 3] = position
    return T


def rpy(roll, pitch, yaw):
    return pose((0, 0, yaw)) @ pose((0, pitch, 0)) @ pose((roll, 0, 0))


def bounds(**named):
    return [named.get(name, ZERO) for name in ("x", "y", "z", "roll", "pitch", "yaw")]


# --- known answers


def test_samples_have_the_mean_and_the_deviation_of_the_region():
    bw = bounds(x=[-0.1, 0.3], y=[0, 0.2], pitch=[-0.2, 0.2], yaw=TURN)
    region = Region(pose((0, 0, math.pi / 2), (1, 0, 0.5)), pose(position=(0, 0, -0.1)), bw)
    places = region.sample(20_000, seed=3)[:, :3, 3]
    assert places.mean(axis=0) == pytest.approx([0.9, 0.1, 0.400665], abs=0.0033)
    assert places.std(axis=0) == pytest.approx([0.058305, 0.115756, 0.000595], abs=0.002)


@pytest.mark.parametrize(("over_rotations", "mean"), [(False, 2 / math.pi), (True, 0.5)])
def test_directions_are_uniform_by_coordinates_or_over_rotations(over_rotations, mean):
    region = Region(Bw=bounds(pitch=[-math.pi / 2, math.pi / 2], yaw=TURN))
    sines = np.abs(region.sample(20_000, seed=0, over_rotations=over_rotations)[:, 2, 0])
    assert sines.mean() == pytest.approx(mean, abs=0.01)


def test_cones_are_sampled_uniformly_over_the_sphere():
    region = Region(Bw=bounds(yaw=TURN), lean=2.0)
    tips = region.sample(20_000, seed=0, over_rotations=True)[:, 2, 2]
    assert tips.mean() == pytest.approx((1 + math.cos(2.0)) / 2, abs=0.01)
    assert tips.min() >= math.cos(2.0) - 1e-12


def test_weights_are_sums_of_widths_and_points_have_a_share():
    regions = [Region(Bw=bounds(x=[0, 0.4], yaw=[0, 0.2])), Region(Bw=bounds(z=[0, 0.3])), Region()]
    assert [region.width() for region in regions] == pytest.approx([0.6, 0.3, 0.0])
    sets = [region.at_present() for region in regions]
    assert weights(sets) == pytest.approx(np.array([0.6, 0.3, 0.03]) / 0.93)
    assert weights(sets[2:] * 4) == pytest.approx([0.25] * 4)


DISTANCES = [
    (bounds(x=[-0.1, 0.1], y=[-0.1, 0.1], yaw=[-0.5, 0.5]), pose((0, 0, 0.6), (0.15, 0, 0)), math.hypot(0.05, 0.1)),
    (bounds(yaw=[3 * math.pi / 4, 5 * math.pi / 4]), pose((0, 0, math.pi)), 0),
    (bounds(yaw=[3 * math.pi / 4, 5 * math.pi / 4]), pose((0, 0, math.pi / 2)), math.pi / 4),
    (bounds(pitch=TURN), pose((0, math.pi, 0)), 0),
    (bounds(roll=[-0.1, 0.1]), pose((-0.106, 0, 0)), 0.006),
    (bounds(), pose(position=(0.01, 0.02, 0.02)) @ rpy(0.1, 0.2, 0.3), 0.3753665),
]


@pytest.mark.parametrize(("bw", "T", "distance"), DISTANCES)
def test_distances(bw, T, distance):
    assert Region(Bw=bw).distance(T) == pytest.approx(distance, abs=1e-7)


def test_the_nearest_pose_has_the_cut_coordinates():
    region = Region(pose((0, 0, math.pi / 2), (1, 2, 3)), pose(position=(0.1, 0, 0)), bounds(x=[0, 0.2]))
    there = pose((0, 0, math.pi / 2), (1, 2.35, 3))
    assert region.distance(there) == pytest.approx(0.05)
    assert region.displacement(there) == pytest.approx([0.05, 0, 0, 0, 0, 0])
    assert region.nearest(there)[:3, 3] == pytest.approx([1, 2.3, 3])


@pytest.mark.parametrize("degrees", [15, 10, 5])
def test_bounds_of_roll_and_pitch_are_no_cone(degrees):
    most = math.radians(degrees)
    square = Region(Bw=bounds(roll=[-most, most], pitch=[-most, most]))
    corner = rpy(most, most, 0)
    lean = math.acos(math.cos(most) ** 2)
    assert square.contains(corner)
    assert math.acos(corner[2, 2]) == pytest.approx(lean)
    assert Region(lean=most, Bw=bounds(yaw=TURN)).distance(corner) == pytest.approx(lean - most)


# --- rules

numbers = st.floats(-3, 3)
vectors = st.tuples(numbers, numbers, numbers)
poses = st.builds(pose, vectors, vectors)
intervals = st.tuples(numbers, numbers).map(sorted)
locks = st.sampled_from([[math.pi / 2] * 2, [-math.pi / 2] * 2, ZERO, TURN, [-10.0, 10.0]])
angles = st.one_of(intervals, locks)
regions = st.one_of(
    st.builds(Region, poses, poses, st.tuples(intervals, intervals, intervals, angles, angles, angles)),
    st.builds(
        lambda T, Te, x, yaw, lean: Region(T, Te, bounds(x=x, yaw=yaw), lean=lean),
        poses,
        poses,
        intervals,
        angles,
        st.floats(0, math.pi),
    ),
)


@given(regions, st.integers(0, 99), st.booleans())
def test_samples_are_inside(region, seed, over_rotations):
    for T in region.sample(3, seed=seed, over_rotations=over_rotations):
        assert region.contains(T)
        assert region.distance(T) < 1e-6


@given(regions, poses)
def test_the_nearest_pose_is_inside_and_itself_where_the_pose_is(region, T):
    nearest = region.nearest(T)
    assert region.contains(nearest)
    assert region.nearest(nearest) == pytest.approx(nearest, abs=1e-5)
    assert region.distance(T) == pytest.approx(np.linalg.norm(region.displacement(T)))


@given(regions, poses, poses)
def test_distances_do_not_depend_on_where_the_world_is(region, T, moved):
    turned = Region(moved @ region.T0_w, region.Tw_e, region.Bw, lean=region.lean)
    assert turned.distance(moved @ T) == pytest.approx(region.distance(T), abs=1e-6)


@given(regions, poses)
def test_velocities_change_the_error_as_the_rates_say(region, T):
    shape, step = region.at_present(), 1e-6
    D = shape.relative(T)
    error, rates = shape.error(D)
    assert np.linalg.norm(error) == pytest.approx(region.distance(T))
    if region.lean is None and abs(math.cos(shape.coordinates(T)[4])) < 0.07:  # a pitch of 1.5: roll and yaw are one
        return
    for axis in range(6):
        moved = [D.copy(), D.copy()]
        for sign, one in zip((1, -1), moved, strict=True):
            if axis < 3:
                one[axis, 3] += sign * step
            else:
                one[:3, :3] = ravemj.rotationMatrixFromAxisAngle(sign * step * np.eye(3)[axis - 3]) @ D[:3, :3]
        first, second = (shape.error(one)[0] for one in moved)
        difference = (second - first) / (2 * step)
        smooth = (np.abs(error) > 1e-4) & (np.abs(error) < 3) & (np.abs(difference) < 1e3)  # no other bound is nearer
        assert difference[smooth] == pytest.approx(rates[smooth, axis], abs=1e-3)


# --- frames, other objects, wrong arguments


@pytest.fixture
def pendulum():
    return ravemj.load(ravemj.model_path("pendulum")).GetRobots()[0]


def test_a_region_moves_with_its_link(pendulum):
    link = pendulum.GetLinks()[-1]
    region = Region(pose(position=(0, 0, 0.1)), frame=link, name="tip")
    for values in ([0.0, 0.0], [0.4, -1.0]):
        pendulum.SetDOFValues(values)
        assert region.distance(link.GetTransform() @ pose(position=(0, 0, 0.1))) == pytest.approx(0, abs=1e-9)


def test_a_removed_frame_is_named(pendulum):
    region = Region(frame=pendulum.GetLinks()[-1], name="tip")
    pendulum.GetEnv().Remove(pendulum)
    with pytest.raises(ravemj.ArgumentError, match="region 'tip': its frame was removed"):
        region.sample()


def test_any_object_with_the_three_attributes_is_a_region():
    class Other:
        T0_w, Tw_e, Bw = pose(position=(1, 0, 0)), pose(), bounds(yaw=[3.0, -3.0])

    region = region_of(Other())
    assert region.Bw[5] == pytest.approx([3.0, 2 * math.pi - 3.0])
    assert region.contains(pose((0, 0, math.pi), (1, 0, 0)))


def test_regions_of_sstsr_are_taken():
    tsr = pytest.importorskip("tsr", reason="pip install sstsr")
    random = np.random.default_rng(0)
    for _ in range(50):
        bw = np.sort(random.uniform(-2, 2, (6, 2)), axis=1)
        theirs = tsr.TSR(pose(random.normal(size=3)), pose(random.normal(size=3)), bw)
        ours, T = region_of(theirs), pose(random.normal(size=3), random.normal(size=3))
        assert ours.distance(T) == pytest.approx(theirs.distance(T)[0], abs=1e-6)
        assert ours.contains(theirs.sample())


WRONG = [
    (dict(Bw=bounds(x=[1, 0])), "x has the lower bound 1 above the upper one 0"),
    (dict(Bw=bounds(yaw=[1, -1])), "for an interval through pi add a turn"),
    (dict(Bw=bounds(yaw=[math.nan, 1])), "shape \\(6, 2\\)"),
    (dict(Bw=[[0, 1]]), "shape \\(6, 2\\)"),
    (dict(T0_w=2 * np.ones((4, 4))), "T0_w: the rotation"),
    (dict(Tw_e=[1, 2, 3]), "Tw_e: has shape"),
    (dict(lean=-0.1), "lean is -0.1"),
    (dict(lean=0.1, Bw=bounds(roll=[0, 1])), "replaces bounds of roll and pitch"),
    (dict(frame="link"), "should be a link or a body"),
]


@pytest.mark.parametrize(("arguments", "message"), WRONG)
def test_wrong_arguments_are_named(arguments, message):
    with pytest.raises((ravemj.ArgumentError, TypeError), match=message):
        Region(**arguments)


def test_unbounded_lengths_cannot_be_sampled():
    region = Region(Bw=bounds(y=[0.5, math.inf]))
    assert region.contains(pose(position=(0, 900, 0)))
    with pytest.raises(ravemj.ArgumentError, match="y of the region has no bounds"):
        region.sample()

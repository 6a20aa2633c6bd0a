"""Spaces, trees, shortcuts, ramps: planning without the API. Truth is geometry, and the formulas of motion."""

from itertools import pairwise

import numpy as np
import pytest
from conftest import one_in

from ravemj.planning.curves import line_curve
from ravemj.planning.detours import certified_detour
from ravemj.planning.edges import LINE, STEP, Edges, bisection_order, length, nearby, path_is_allowed
from ravemj.planning.ramps import fit_from_rest, fit_ramps, shortest_ramps
from ravemj.planning.randomized_astar import search_by_cost
from ravemj.planning.retiming.polynomials import Cubic, JerkLimited, Linear, Parabolic, Quintic
from ravemj.planning.retiming.segments import OutsideLimitsError, PathLimits, RetimingError, retime
from ravemj.planning.rrt import Budget, End, MoreRoots, connect, explore, single
from ravemj.planning.shortcuts import ShortenedMotion, lines, shorten, straightened
from ravemj.planning.space import Coordinates, Space
from ravemj.planning.verification import Samples, flaw

START, GOAL = np.array([-1.0, 0.0]), np.array([1.0, 0.0])
PROFILES = [Linear(), Parabolic(), Cubic(), Quintic(), JerkLimited()]


def plain(dof: int) -> Coordinates:
    return Coordinates(np.zeros(dof, dtype=bool))


def space(dof: int = 2, size: float = 2.0) -> Space:
    ones = np.ones(dof)
    return Space(plain(dof), -size * ones, size * ones, ones, 0.05 * ones)


def limits(dof: int, velocity=2.0, acceleration=5.0, jerk=100.0) -> PathLimits:
    ones = np.ones(dof)
    return PathLimits(plain(dof), -10 * ones, 10 * ones, velocity * ones, acceleration * ones, jerk * ones)


def round_a_wall(values) -> bool:
    """A wall between start and goal with a way round above."""
    return not (abs(values[0]) < 0.2 and values[1] < 1.5)


def in_a_tunnel(values) -> bool:
    """Start and goal are in boxes; a narrow tunnel joins them."""
    x, y = values
    return abs(y) < 0.04 if abs(x) < 0.5 else abs(y) < 1.5


def nowhere(values) -> bool:
    return abs(values[0]) > 0.2


def budget(iterations: int = 20000, **options) -> Budget:
    return Budget(iterations, **options)


def found(allowed, *, starts=(START,), goals=(GOAL,), seed=0, iterations=20000, **options):
    return connect(Edges(space(), allowed), starts, goals, budget(iterations), np.random.default_rng(seed), **options)


@pytest.mark.parametrize("allowed", [round_a_wall, in_a_tunnel, lambda values: True])
@pytest.mark.parametrize("seed", range(5))
def test_paths_are_allowed_everywhere_and_join_start_and_goal(allowed, seed):
    search = found(allowed, seed=seed)
    assert search.end is End.found
    assert search.path[0].tolist() == START.tolist()
    assert search.path[-1].tolist() == GOAL.tolist()
    assert path_is_allowed(Edges(space(), allowed), search.path)
    for first, second in pairwise(search.path):
        for part in np.linspace(0, 1, 200):
            assert allowed(first + part * (second - first)) or np.abs(second - first).max() < 0.05


def test_the_smaller_tree_is_grown_so_that_none_is_fed_in_vain():
    search = found(nowhere, iterations=4000)
    first, second = (tree.count for tree in search.trees)
    assert (search.end, search.path, search.iterations) == (End.iterations, None, 4000)
    assert min(first, second) > 0.4 * max(first, second)
    steps = np.ceil(np.linalg.norm(space().upper - space().lower) / STEP)  # of a tree to where the other got
    assert first + second <= 2 + search.iterations * (LINE / STEP + steps), "memory is bounded by the iterations"


def test_a_tree_that_cannot_grow_leaves_the_other_its_turn():
    search = found(lambda values: values[0] > -0.5 or (values == START).all(), iterations=2000)
    first, second = (tree.count for tree in search.trees)
    assert (first, second > 30) == (1, True)


def test_one_of_several_starts_leads_to_one_of_several_goals():
    search = found(nowhere, starts=[START, np.array([0.9, 0.9])], goals=[GOAL, np.array([1.5, 1.5])])
    assert (search.end, search.start) == (End.found, 1)
    assert search.path[0].tolist() == [0.9, 0.9]
    assert search.path[-1].tolist() == [GOAL.tolist(), [1.5, 1.5]][search.goal]


def test_goals_come_while_a_search_is_under_way():
    coming = [None] * 5 + [np.array([0.5, 0.5])]
    search = found(round_a_wall, goals=(), more=(None, MoreRoots(lambda: coming.pop(0) if coming else None, 1.0)))
    assert (search.end, search.goal) == (End.found, 0)
    assert search.path[-1].tolist() == [0.5, 0.5]
    never = connect(
        Edges(space(), round_a_wall),
        [START],
        [],
        budget(30),
        np.random.default_rng(0),
        (None, MoreRoots(lambda: None, 1.0)),
    )
    assert (never.end, never.iterations) == (End.no_goal, 30)


def test_searches_end_when_they_should():
    assert found(lambda values: True).iterations == 0  # a straight line needs no tree
    asked = []
    stopping = budget(proceed=lambda iteration: asked.append(iteration) or iteration < 3)
    search = connect(Edges(space(), nowhere), [START], [GOAL], stopping, np.random.default_rng(0))
    assert (search.end, asked) == (End.interrupted, [0, 1, 2, 3])
    late = budget(10**9, seconds=0.05)
    assert connect(Edges(space(), nowhere), [START], [GOAL], late, np.random.default_rng(0)).end is End.time


def test_a_search_with_one_seed_is_repeatable():
    assert np.array_equal(found(round_a_wall, seed=4).path, found(round_a_wall, seed=4).path)


@pytest.mark.parametrize("allowed", [round_a_wall, in_a_tunnel, lambda values: True])
def test_the_search_by_cost_finds_allowed_paths_that_are_short(allowed):
    edges = Edges(space(), allowed)
    search = search_by_cost(edges, [START], [GOAL], budget(), np.random.default_rng(0))
    assert path_is_allowed(edges, search.path)
    assert (search.path[0].tolist(), search.path[-1].tolist()) == (START.tolist(), GOAL.tolist())
    assert length(space(), search.path) < 7
    ended = search_by_cost(Edges(space(), nowhere), [START], [GOAL], budget(300), np.random.default_rng(0))
    assert (ended.end, ended.path) == (End.iterations, None)


def outside_or_in_a_hole(values) -> bool:
    """The open half of a space, and a hole 0.5 deep and 0.16 wide in the other half."""
    return values[0] > 0.5 or (values[0] > -0.05 and np.abs(values[1:]).max() < 0.08)


def one_step(start, target, allowed, step, **options):
    weighted = Space(plain(2), -2 * np.ones(2), 2 * np.ones(2), np.array([2.0, 1.0]), 0.01 * np.ones(2))
    return Edges(weighted, allowed, step).grow(np.array(start), np.array(target), **options), weighted


@pytest.mark.parametrize("step", [0.03, 0.1, 0.4])
@pytest.mark.parametrize("wall", np.random.default_rng(0).uniform(0, 0.4, 10))
def test_a_line_grows_step_by_step_up_to_what_blocks_it(step, wall):
    calls = []

    def allowed(values):
        calls.append(values)
        return values[0] <= wall

    grown, weighted = one_step([0, 0], [0.4, 0.2], allowed, step)
    points = np.vstack([[0, 0], grown.points])
    lengths = [weighted.distance(second, first) for first, second in pairwise(points)]
    assert max(lengths, default=0.0) <= step * (1 + 1e-9)
    assert (points[:, 0] <= wall).all()
    assert points[-1, 0] + step / 2 + 0.01 > wall, "the last allowed configuration is kept"
    assert grown.is_blocked
    assert not grown.arrives
    tested, calls[:] = len(calls), []
    dropped, _ = one_step([0, 0], [0.4, 0.2], allowed, step, whole=True)
    assert (len(dropped.points), dropped.is_blocked) == (0, True)
    assert len(calls) <= tested


def test_a_line_that_nothing_blocks_arrives_or_ends_at_its_greatest_length():
    grown, weighted = one_step([0, 0], [0.3, 0.2], lambda values: True, 0.1)
    assert (grown.is_blocked, grown.arrives) == (False, True)
    assert grown.points[-1] == pytest.approx([0.3, 0.2])
    assert len(grown.points) == 7, "0.632 in steps of 0.1"
    grown, _ = one_step([0, 0], [1.0, 0.0], lambda values: True, 0.1, longest=0.5)
    assert (grown.is_blocked, grown.arrives, len(grown.points)) == (False, False, 5)
    assert weighted.distance(grown.points[-1], np.zeros(2)) == pytest.approx(0.5)


def test_every_step_of_a_line_is_tested_at_the_resolution():
    seen = [np.zeros(2)]
    grown, weighted = one_step([0, 0], [0.4, 0.2], lambda values: seen.append(values) or True, 0.1)
    along = np.array(sorted(seen, key=lambda one: one[0]))
    assert np.abs(np.diff(along, axis=0)).max() <= weighted.resolution.max() + 1e-12
    assert {tuple(np.round(one, 9)) for one in grown.points} <= {tuple(np.round(one, 9)) for one in seen}


@pytest.mark.parametrize("step", [0.04, 0.15, 0.5])
@pytest.mark.parametrize("allowed", [round_a_wall, nowhere])
def test_neighbouring_nodes_of_all_trees_are_a_step_apart_at_most(step, allowed):
    weighted = Space(plain(2), -2 * np.ones(2), 2 * np.ones(2), np.array([2.0, 0.5]), 0.02 * np.ones(2))
    edges, random = Edges(weighted, allowed, step), np.random.default_rng(0)
    trees = [*connect(edges, [START], [GOAL], budget(300), random).trees]
    trees += single(edges, [START], [GOAL], budget(300), random, 0.05).trees
    for tree in trees:
        nodes = tree.nodes()
        lengths = np.array([weighted.distance(nodes[child], nodes[parent]) for child, parent in tree.lines()])
        assert (lengths <= step * (1 + 1e-9)).all()
        assert lengths.max() > 0.7 * step, "lines are divided no finer than needed"
        assert all(map(allowed, nodes))


@pytest.mark.parametrize("step", [0.04, 0.15, 0.5])
def test_exploration_takes_one_step_at_a_time(step):
    tree = explore(Edges(space(), round_a_wall, step), [START], 50, budget(50), np.random.default_rng(0))
    nodes = tree.nodes()
    lengths = np.array([space().distance(nodes[child], nodes[parent]) for child, parent in tree.lines()])
    assert (lengths <= step * (1 + 1e-9)).all()
    assert np.median(lengths) == pytest.approx(step), "samples that are nearer than a step are few"
    assert len(lengths) <= 49


@pytest.mark.parametrize("seed", range(5))
def test_a_way_out_of_a_narrow_hole_is_found_in_steps(seed):
    edges, random = Edges(space(5), outside_or_in_a_hole), np.random.default_rng(seed)
    search = connect(edges, [np.zeros(5)], [np.ones(5)], budget(4000), random)
    assert search.end is End.found
    assert path_is_allowed(edges, search.path)


@pytest.mark.parametrize("seed", range(5))
def test_paths_have_no_waypoints_on_their_lines(seed):
    path = found(round_a_wall, seed=seed).path
    steps = np.diff(path, axis=0)
    directions = steps / np.linalg.norm(steps, axis=1, keepdims=True)
    assert np.linalg.norm(np.diff(directions, axis=0), axis=1).min() > 1e-6
    assert len(path) < 12


def test_a_line_of_more_than_half_a_turn_keeps_its_nodes():
    circle = Space(
        Coordinates(np.array([True])), -np.pi * np.ones(1), np.pi * np.ones(1), np.ones(1), 0.05 * np.ones(1)
    )
    edges = Edges(circle, lambda values: np.cos(values[0] - np.pi / 2) < 0.5)  # the short way is blocked
    search = connect(edges, [np.array([0.0])], [np.array([3.0])], budget(2000), np.random.default_rng(0))
    turned = circle.difference(search.path[1:], search.path[:-1]).sum()
    assert turned == pytest.approx(3.0 - 2 * np.pi)
    assert path_is_allowed(edges, search.path)


def test_one_tree_finds_goals_and_explores():
    edges = Edges(space(), round_a_wall)
    search = single(edges, [START], [GOAL], budget(), np.random.default_rng(0), 0.05)
    assert path_is_allowed(edges, search.path)
    assert search.path[-1].tolist() == GOAL.tolist()
    tree = explore(edges, [START], 50, budget(), np.random.default_rng(0))
    assert tree.count == 50
    assert len(tree.lines()) == 49


@pytest.mark.parametrize("steps", [1, 2, 3, 7, 64, 101])
def test_lines_are_tested_at_each_step_with_the_end_and_the_middle_first(steps):
    order = bisection_order(steps)
    assert sorted(order) == list(range(1, steps + 1))
    assert order[0] == steps
    assert steps < 2 or abs(order[1] - steps / 2) <= 0.5


def test_no_step_is_longer_than_the_resolution():
    one = Space(plain(2), -np.ones(2), np.ones(2), np.ones(2), np.array([0.1, 0.01]))
    assert [one.steps(np.array(step)) for step in ([0.0, 0.0], [0.1, 0.0], [0.11, 0.0], [0.1, 0.1])] == [1, 1, 2, 10]


def test_distances_are_weighted_and_angles_go_the_short_way_round():
    one = Space(Coordinates(np.array([True, False])), -np.pi * np.ones(2), np.ones(2), np.array([2.0, 1.0]), np.ones(2))
    assert one.distance(np.array([3.0, 0.0]), np.array([-3.0, 0.0])) == pytest.approx(2 * (2 * np.pi - 6))
    assert one.difference(np.array([-3.0, 1.0]), np.array([3.0, 0.0])) == pytest.approx([2 * np.pi - 6, 1])
    assert one.clamp(np.array([9.0, 9.0])).tolist() == [9.0, 1.0]
    assert one.outside(np.array([9.0, 1.0 + 1e-15])) is None
    assert one.outside(np.array([9.0, 1.1])) == 1


@pytest.mark.parametrize("seed", range(20))
def test_shortcuts_are_allowed_and_shorter_and_keep_the_ends(seed):
    edges = Edges(space(), round_a_wall)
    detour = np.array([[-1, 0], [-1, 1.9], [1.9, 1.9], [1.9, -1.9], [1, -1.9], [1, 0]], dtype=float)
    short = shorten(edges, detour, 100, np.random.default_rng(seed))
    assert path_is_allowed(edges, short)
    assert (short[0].tolist(), short[-1].tolist()) == (detour[0].tolist(), detour[-1].tolist())
    assert length(space(), short) < 0.6 * length(space(), detour)
    straight = shorten(Edges(space(), lambda values: True), detour, 50, np.random.default_rng(0))
    assert straight.tolist() == [detour[0].tolist(), detour[-1].tolist()]


@pytest.mark.parametrize("seed", range(20))
def test_ramps_reach_their_end_within_all_limits(seed):
    random = np.random.default_rng(seed)
    speed, acceleration = random.uniform(0.5, 2, 6), random.uniform(0.5, 5, 6)
    steps, start, end = random.uniform(-2, 2, 6), random.uniform(-speed, speed), random.uniform(-speed, speed)
    least = float(shortest_ramps(steps, start, end, speed, acceleration).max())
    assert fit_ramps(steps, start, end, 0.9 * least, speed, acceleration) is None
    for duration in (least, 1.5 * least, 3 * least):
        ramps = fit_ramps(steps, start, end, duration, speed, acceleration)
        if ramps is None:  # there are gaps in what times are possible
            continue
        times = np.linspace(0, duration, 400)
        values, velocities = ramps.states(times)
        assert values[-1] == pytest.approx(steps)
        assert velocities[-1] == pytest.approx(end)
        assert (np.abs(velocities) <= speed * (1 + 1e-9)).all()
        assert (np.abs(np.diff(velocities, axis=0)) <= acceleration * times[1] * (1 + 1e-6)).all()
        least_value, greatest = ramps.reach()
        assert least_value == pytest.approx(np.minimum(values.min(axis=0), 0), abs=1e-3)
        assert greatest == pytest.approx(np.maximum(values.max(axis=0), 0), abs=1e-3)


def shortened(seed):
    """Return a motion around a wall along lines, and with shortcuts."""
    slow, bounds = lines(found(round_a_wall, seed=seed).path, limits(2, 1.0, 3.0)), limits(2, 1.0, 3.0)
    motion = ShortenedMotion(slow)
    motion.shorten(Edges(space(), round_a_wall), bounds, 200, np.random.default_rng(seed))
    return slow, motion


def time_of(segments):
    return sum(piece.duration for piece in segments)


def assert_smooth(segments):
    """Check that a motion keeps start, goal, limits and the wall, without jumps of values and velocities."""
    samples = [(piece.duration * part, *piece.after(piece.duration * part)) for piece in segments for part in (0, 0.5)]
    assert segments[0].values.tolist() == START.tolist()
    assert segments[-1].after(segments[-1].duration)[0] == pytest.approx(GOAL)
    for before, after in pairwise(segments):
        assert before.after(before.duration)[0] == pytest.approx(after.values)
        assert before.after(before.duration)[1] == pytest.approx(after.velocities)
    for _, values, velocities in samples:
        assert round_a_wall(values) or abs(values[0]) > 0.15 or values[1] > 1.45  # corners, by less than a step
        assert (np.abs(velocities) <= 1 + 1e-9).all()
    assert all((np.abs(piece.accelerations) <= 3 + 1e-9).all() for piece in segments)


@pytest.mark.parametrize("seed", range(5))
def test_smoothed_motions_are_allowed_within_limits_and_faster(seed):
    slow, motion = shortened(seed)
    assert time_of(motion.segments) < time_of(slow)
    assert_smooth(motion.segments)


@pytest.mark.parametrize("seed", range(10))
def test_shortcuts_can_be_removed_one_by_one(seed):
    slow, motion = shortened(seed)
    random = np.random.default_rng(seed)
    removed = 0
    while True:
        quick = time_of(motion.segments)
        if not any(motion.remove_shortcut(time) for time in random.uniform(0, quick, 20)):
            break
        removed += 1
        assert_smooth(motion.segments)
        assert quick < time_of(motion.segments) <= time_of(slow) * (1 + 1e-9)
    assert removed > 1
    while any(motion.remove_shortcut(time) for time in np.linspace(0, time_of(motion.segments), 500)):
        assert_smooth(motion.segments)
    for piece, line in zip(motion.segments, slow, strict=True):
        assert (piece.duration, piece.values.tolist()) == (line.duration, line.values.tolist())


@pytest.mark.parametrize("seed", one_in(5, range(10)))
def test_lines_can_be_replaced_by_detours(seed):
    slow, motion = shortened(seed)
    random, parts = np.random.default_rng(seed), []
    while any(motion.remove_shortcut(time) for time in np.linspace(0, time_of(motion.segments), 500)):
        pass
    for time in random.uniform(0, time_of(slow), 5):
        before, at = motion.segments, at_time(motion.segments, time)
        assert not motion.replace_line(time, space(), limits(2, 1.0, 3.0), parts.append)
        assert motion.segments is before
        part = parts[-1]
        assert np.linalg.norm(part - at, axis=1).min() == pytest.approx(0, abs=1e-9)
        for end, own in ((part[0], START), (part[-1], GOAL)):
            assert np.linalg.norm(end - at) >= 0.3 - 1e-9 or np.linalg.norm(end - own) < 1e-9
        assert motion.replace_line(time, space(), limits(2, 1.0, 3.0), lambda part: around(part, 0.01))
        assert_smooth(motion.segments)
        assert np.isclose([piece.values for piece in motion.segments], around(part, 0.01)[1]).all(axis=1).any()
        motion.shorten(Edges(space(), round_a_wall), limits(2, 1.0, 3.0), 20, random)
        assert_smooth(motion.segments)
        while any(motion.remove_shortcut(time) for time in np.linspace(0, time_of(motion.segments), 500)):
            pass


def at_time(segments, time):
    for piece in segments:
        if time <= piece.duration:
            return piece.after(time)[0]
        time -= piece.duration
    return segments[-1].after(segments[-1].duration)[0]


def around(part, offset):
    """Return the part of a path with its first line bent by an offset away from the wall."""
    away = np.array([np.sign(part[:2].mean(axis=0)[0]) * offset, offset])
    return np.array([part[0], part[:2].mean(axis=0) + away, *part[1:]])


@pytest.mark.parametrize("seed", range(10))
def test_certified_detours_avoid_what_is_smaller_than_the_resolution(seed):
    random = np.random.default_rng(seed)
    start = random.uniform(-1, 1, 2)
    end = start + 0.6 * np.array([np.cos(seed), np.sin(seed)])
    post, radius = (start + end) / 2 + 0.005 * random.normal(size=2), 0.012

    def distance(curve):
        first, last = curve.control
        step = last - first
        part = np.clip((post - first) @ step / max(step @ step, 1e-12), 0, 1)
        return np.linalg.norm(post - first - part * step)

    edges = Edges(space(), lambda values: np.linalg.norm(values - post) > radius)
    path = certified_detour(
        edges, lambda curves: all(distance(one) > radius for one in curves), np.array([start, end]), random
    )
    assert path[0].tolist() == start.tolist()
    assert path[-1].tolist() == end.tolist()
    assert all(distance(line_curve(first, last - first)) > radius for first, last in pairwise(path))
    assert (path >= np.minimum(start, end) - 0.3).all()
    assert (path <= np.maximum(start, end) + 0.3).all()
    assert certified_detour(edges, lambda curves: False, np.array([start, end]), random) is None


def test_paths_are_straightened():
    corners = np.array([[0.0, 0.0], [1.0, 0.5], [1.0, 1.0], [-1.0, 0.0]])
    points = np.concatenate(
        [start + np.linspace(0, 1, 7)[:-1, None] * (end - start) for start, end in pairwise(corners)]
    )
    edges = Edges(space(), lambda values: True)
    np.testing.assert_allclose(straightened(edges, np.concatenate([points, corners[-1:]])), corners)
    many = np.random.default_rng(0).uniform(-1, 1, (40, 2))
    np.testing.assert_array_equal(straightened(edges, many), many[[0, -1]])
    np.testing.assert_array_equal(straightened(edges, many[:20]), many[:20])


@pytest.mark.parametrize("profile", PROFILES, ids=lambda one: type(one).__name__)
def test_retimed_paths_go_through_their_waypoints_in_multiples_of_a_step(profile):
    points = np.random.default_rng(1).uniform(-2, 2, (6, 3))
    timed = retime(profile, points, limits(3))
    assert timed.orders[0][timed.is_point].tolist() == points.tolist()
    assert timed.deltas[0] == 0
    assert (timed.deltas[1:] > 0).all()
    stepped = retime(profile, points, limits(3), time_step=0.25)
    arrivals = np.cumsum(stepped.deltas)[stepped.is_point]
    assert arrivals / 0.25 == pytest.approx(np.round(arrivals / 0.25))
    assert stepped.deltas.sum() >= timed.deltas.sum()


@pytest.mark.parametrize("profile", PROFILES, ids=lambda one: type(one).__name__)
def test_what_cannot_be_retimed_says_why(profile):
    with pytest.raises(RetimingError, match="no waypoints"):
        retime(profile, np.zeros((0, 2)), limits(2))
    with pytest.raises(OutsideLimitsError, match=r"value 1 of waypoint 1 is 10\.00000000005, outside its limits"):
        retime(profile, np.array([[0, 0], [0, 10 + 5e-11]]), limits(2))
    with pytest.raises(RetimingError, match="from waypoint 0 to 1: a joint moves whose velocity"):
        retime(profile, np.array([[0.0, 0], [1, 0]]), limits(2, velocity=0.0))
    with pytest.raises(OutsideLimitsError):
        retime(profile, np.array([[0, 0], [0, np.nan]]), limits(2))
    assert retime(profile, np.zeros((1, 2)), limits(2)).deltas.tolist() == [0.0]


def test_a_limit_of_zero_holds_a_joint_that_stands_still_back_in_nothing():
    still = PathLimits(plain(2), -np.ones(2), np.ones(2), np.array([1.0, 0]), np.array([1.0, 0]), np.ones(2))
    for profile in (Linear(), Parabolic(), Cubic()):
        assert np.isfinite(retime(profile, np.array([[0, 0], [1.0, 0]]), still).deltas).all()


def samples(times, values, velocities=None) -> Samples:
    return Samples(np.array(times), np.array(values), velocities, None, has_jumps=velocities is None)


def test_verification_finds_what_is_wrong_and_when():
    bounds, free = limits(1, 1.0, 2.0), lambda values: True
    assert flaw(samples([0.0, 1.0], [[0.0], [1.0]]), bounds, free) is None
    assert "speed of value 0 is 1.1" in flaw(samples([0.0, 1.0], [[0.0], [1.1]]), bounds, free)
    assert "outside its limits" in flaw(samples([0.0, 99.0], [[0.0], [11.0]]), bounds, free)
    assert "is inf at 1 s" in flaw(samples([0.0, 1.0, 1.0], [[0.0], [0.5], [0.6]]), bounds, free)
    assert "at 1 s it collides" in flaw(samples([0.0, 1.0], [[0.0], [1.0]]), bounds, lambda values: values[0] < 1)
    hasty = samples([0.0, 0.1], [[0.0], [0.05]], np.array([[0.0], [1.0]]))
    assert "acceleration of value 0 is 10 at 0.1 s" in flaw(hasty, bounds, free)
    assert flaw(samples([0.0, 1.0], [[0.0], [1.0 + 1e-12]]), bounds, free) is None
    close = samples([0.0, 0.21, 0.21 + 1e-16, 1.0], [[0.0], [0.2], [0.2 + 1e-15], [0.9]])
    assert flaw(close, bounds, free) is None  # rounding is no speed


def test_jitter_stays_near_and_gives_up():
    random = np.random.default_rng(0)
    assert nearby(space(), START, round_a_wall, 10, 0.1, random) is START
    touching = np.array([-0.19, 0.0])
    moved = nearby(space(), touching, round_a_wall, 1000, 0.1, random)
    assert round_a_wall(moved)
    assert np.abs(moved - touching).max() <= 0.1
    assert nearby(space(), touching, round_a_wall, 1000, 0.0, random) is None
    assert nearby(space(), np.zeros(2), round_a_wall, 100, 0.1, random) is None


@pytest.mark.parametrize("longer", [0.9, 1.0, 1.3, 3.0])
def test_ramps_from_rest_to_rest_are_those_of_the_general_formulas(longer):
    random, found = np.random.default_rng(7), []
    for _ in range(50):
        steps, rest = random.uniform(-2, 2, 5) * (random.random(5) > 0.2), np.zeros(5)
        bounds = random.uniform(0.1, 3, 5), random.uniform(0.1, 8, 5)
        duration = longer * float(shortest_ramps(steps, rest, rest, *bounds).max())
        general, short = fit_ramps(steps, rest, rest, duration, *bounds), fit_from_rest(steps, duration, *bounds)
        found.append(short is not None)
        assert (general is None) == (short is None)
        if general is not None and short is not None:
            times = np.linspace(0, duration, 7)
            for one, other in zip(general.states(times), short.states(times), strict=True):
                assert one == pytest.approx(other, abs=1e-8)
    assert all(found) == (longer >= 1)

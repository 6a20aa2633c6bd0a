"""A hand in one dimension whose contacts are known: approach, standoff, fingers, and why grasps fail."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravemj.manipulation.grasping.closing import (
    Approach,
    Ball,
    Finger,
    Hand,
    Reason,
    Target,
    close,
    displaced,
    tool_start,
)

PALM, LEFT, RIGHT = range(3)
Z = np.array([0.0, 0.0, 1.0])
FINE = 1e-4  # m, OpenRAVE's fine step of sliders and flights
TARGET = Target(np.eye(4), Ball(np.zeros(3), 0.05))


class World:
    """A palm that touches the target from z = ``palm`` on, and obstacles; fingers touch at ``stops``."""

    def __init__(self, palm=-0.03, stops=(0.02, 0.02), obstacle=None, finger_obstacle=None, meet=None):
        self.palm, self.stops, self.obstacle = palm, stops, obstacle
        self.finger_obstacle, self.meet, self.count = finger_obstacle, meet, 0

    def __call__(self, links, T_world_base, values, against="anything"):
        self.count += 1
        z = T_world_base[2, 3]
        if against == "itself":
            meets = self.meet is not None and values.sum() >= self.meet and links & {LEFT, RIGHT}
            return "right" if meets else None
        if against in {"target", "anything"}:
            if links & {PALM} and z >= self.palm:
                return "box"
            if any({link} & links and values[link - 1] >= self.stops[link - 1] for link in (LEFT, RIGHT)):
                return "box"
        if against in {"others", "anything"}:
            if self.obstacle is not None and links & {PALM} and z >= self.obstacle:
                return "table"
            if self.finger_obstacle is not None and LEFT in links and values[0] >= self.finger_obstacle:
                return "wall"
        return None


def hand(values=(0.0, 0.0), sides=(1, 1), limits=(0.0, 0.04), slides=True):
    fingers = [
        Finger(dof, name, side, limits, frozenset([link]), slides)
        for dof, (name, side, link) in enumerate(zip(("jl", "jr"), sides, (LEFT, RIGHT), strict=True))
    ]
    everything = frozenset([PALM, LEFT, RIGHT])
    names = ("palm", "left", "right")
    return Hand(np.array(values), np.eye(4), np.eye(4), fingers, everything, everything, Ball(np.zeros(3), 0.1), names)


def approach(**named):
    return Approach(**{"direction": Z, "tool_direction": Z, **named})


def test_the_hand_stops_at_the_contact_and_each_finger_at_its_own():
    closed = close(hand(), TARGET, approach(), World(stops=(0.02, 0.013)))
    assert closed.reason is None
    assert -0.03 <= closed.T_world_base[2, 3] <= -0.03 + FINE
    np.testing.assert_allclose(closed.values, [0.02, 0.013], atol=FINE)
    assert [len(closed.path), closed.path[-1].values.tolist()] == [4, closed.values.tolist()]


@given(st.floats(-0.2, 0.2), st.floats(0.001, 0.03), st.floats(0.0, 0.02))
def test_a_standoff_is_a_distance_from_the_contact(palm, stop, standoff):
    closed = close(hand(), TARGET, approach(standoff=standoff), World(palm=palm, stops=(stop, stop)))
    past = palm > 0.15  # beyond both spheres
    assert (closed.reason is None) is not past or palm > 0.14
    if closed.reason is None:
        assert closed.T_world_base[2, 3] == pytest.approx(palm - standoff, abs=FINE)
        np.testing.assert_allclose(closed.values, stop, atol=FINE)


def test_negative_standoffs_count_as_none():
    closed = close(hand(), TARGET, approach(standoff=-0.01), World())
    assert closed.T_world_base[2, 3] == pytest.approx(-0.03, abs=FINE)


def test_the_tool_stops_on_a_plane():
    closed = close(hand(), TARGET, approach(plane=np.array([0, 0, 1, 0.07]), standoff=0.01), World())
    assert closed.T_world_base[2, 3] == pytest.approx(-0.07)


def test_contacts_are_found_with_few_tests():
    world = World()
    close(hand(), TARGET, approach(), world)
    assert world.count < 110  # OpenRAVE: about 400


@pytest.mark.parametrize(
    ("world", "named", "reason", "text"),
    [
        (World(palm=9.0), {}, Reason("flies past"), "flies past the target"),
        (World(obstacle=-0.1), {}, Reason("touches first", "table"), "touches 'table' first"),
        (World(finger_obstacle=0.01), {}, Reason("finger touches", "wall", "jl"), "finger 'jl' touches 'wall' first"),
        (World(), {"avoided": frozenset([PALM])}, Reason("avoided link", "palm"), "avoided link 'palm' touches"),
        (
            World(stops=(-1.0, 0.02)),
            {"flies": False, "avoid_contact": True},
            Reason("starts in contact", "jl"),
            "finger 'jl' starts in contact",
        ),
        (World(meet=0.0), {}, Reason("self-collision", "right"), "ends in self-collision with link 'right'"),
    ],
)
def test_reasons(world, named, reason, text):
    closed = close(hand(), TARGET, approach(**named), world)
    assert closed.reason == reason
    assert str(closed.reason) == text


def test_an_obstacle_only_counts_where_it_should():
    closed = close(hand(), TARGET, approach(only_target=False), World(obstacle=-0.045))
    assert closed.reason is None
    assert closed.T_world_base[2, 3] == pytest.approx(-0.045, abs=FINE)
    behind = close(hand(), TARGET, approach(only_target=False, standoff=0.005), World(obstacle=-0.045))
    assert behind.T_world_base[2, 3] == pytest.approx(-0.045 - 0.015, abs=2 * FINE)  # the distance to the target


def test_avoided_links_may_touch_on_the_way():
    closed = close(hand(), TARGET, approach(avoided=frozenset([PALM]), standoff=0.01), World())
    assert closed.reason is None


def test_a_finger_that_starts_in_contact_stays():
    still = close(hand(), None, approach(flies=False), World(stops=(-1.0, 0.02)))
    np.testing.assert_allclose(still.values, [0.0, 0.02], atol=FINE)


def test_fingers_stop_before_they_meet():
    closed = close(hand(), None, approach(flies=False), World(palm=9.0, stops=(9.0, 9.0), meet=0.05))
    assert closed.values[0] == 0.04  # the first goes to its limit
    assert closed.values[1] == pytest.approx(0.01 - FINE, abs=FINE)
    assert closed.reason is None


def test_avoiding_contact_keeps_a_fine_step():
    closed = close(hand(), None, approach(flies=False, avoid_contact=True), World(palm=9.0, stops=(0.02, 9.0)))
    assert 0.02 - 2 * FINE < closed.values[0] < 0.02
    assert closed.values[1] == 0.04


def test_signs_and_limits():
    for sides, expected in (((-1, 0), [0.0, 0.015]), ((0, 1), [0.015, 0.02]), ((-1, -1), [0.0, 0.0])):
        closed = close(hand((0.015, 0.015), sides), None, approach(flies=False), World(palm=9.0))
        np.testing.assert_allclose(closed.values, expected, atol=FINE)


def test_circular_joints_turn_once_at_most():
    closed = close(hand(limits=(-np.inf, np.inf), slides=False), None, approach(flies=False), World(9.0, (9.0, 9.0)))
    np.testing.assert_allclose(closed.values, 2 * np.pi)


def test_the_tool_turns_by_the_least_rotation_after_its_roll():
    for direction in (Z, -Z, np.array([1.0, 0, 0]), np.array([1.0, 2, 3])):
        for roll in (0.0, 0.7, np.pi):
            T = tool_start(approach(direction=direction, roll=roll, position=np.array([1.0, 2, 3])))
            np.testing.assert_allclose(T[:3, :3] @ Z, direction / np.linalg.norm(direction), atol=1e-12)
            np.testing.assert_allclose(T[:3, 3], [1, 2, 3])
    T = tool_start(approach(roll=0.7))
    np.testing.assert_allclose(T[:2, 0], [np.cos(0.7), np.sin(0.7)])


@given(st.integers(0, 1000), st.floats(0.0, 0.1))
def test_noise_moves_the_target_by_its_size_at_most(seed, noise):
    moved = displaced(TARGET, noise, np.random.default_rng(seed))
    points = np.array([[0, 0, 0.05], [0.05, 0, 0], [0, 0, 0]])
    shift = points @ moved.T_world_target[:3, :3].T + moved.T_world_target[:3, 3] - points
    assert np.linalg.norm(shift, axis=1).max() <= np.sqrt(3) * noise + 1e-12

"""How sharp pictures are while things move, when they get crisp, and how often it is looked whether they changed."""

import itertools
import json

import pytest

from ravemj.graphics.rendering import Look
from ravemj.gui.viewers.sharpness import BUDGET, CRISP, LEVELS, REST, Sharpness, period
from ravemj.gui.viewers.web.client import Client, PageStyle
from ravemj.gui.viewers.web.scenes import Scenes


def draw_moving(sharpness, crisp_cost, pictures=60):
    """Draw at 30 Hz on a machine where crisp pictures take so long; return the levels."""
    levels = []
    for number in range(pictures):
        level = sharpness.level_while_moving(number / 30)
        sharpness.add_measurement(level, crisp_cost * level.cost)
        levels.append(level)
    return levels


@pytest.mark.parametrize("crisp_cost", [0.001, 0.027, 0.04, 0.071, 0.13, 0.2])
def test_moving_pictures_fit_the_budget_and_are_as_sharp_as_that_allows(crisp_cost):
    *_, last = draw_moving(Sharpness(), crisp_cost)
    assert crisp_cost * last.cost <= BUDGET
    if last is not CRISP:
        sharper = LEVELS[LEVELS.index(last) - 1]
        assert crisp_cost * sharper.cost > 0.7 * BUDGET


def test_a_machine_that_cannot_draws_as_coarsely_as_there_is():
    assert draw_moving(Sharpness(), 5.0)[-1] is LEVELS[-1]


def test_the_second_picture_fits_already():
    assert LEVELS.index(draw_moving(Sharpness(), 0.071, 2)[1]) > 1


def test_a_first_picture_that_takes_long_is_forgotten():
    sharpness = Sharpness()
    sharpness.add_measurement(sharpness.level_while_moving(0.0), 0.6)
    assert draw_moving(sharpness, 0.002)[-1] is CRISP


def test_noise_does_not_change_the_sharpness_with_every_picture():
    sharpness = Sharpness()
    draw_moving(sharpness, 0.071)
    levels = []
    for number in range(100):
        level = sharpness.level_while_moving(number / 30)
        sharpness.add_measurement(level, (0.065, 0.077)[number % 2] * level.cost)
        levels.append(level)
    assert sum(one is not other for one, other in itertools.pairwise(levels)) < 3


def test_what_rests_is_drawn_crisp_once_and_soon():
    sharpness = Sharpness()
    assert not sharpness.is_due(0.0), "nothing was drawn yet"
    draw_moving(sharpness, 0.1, 10)
    rests_at = 10 / 30
    sharpness.add_measurement(sharpness.level_while_moving(rests_at), 0.02)
    assert not sharpness.is_due(rests_at + 0.5 * REST)
    assert sharpness.is_due(rests_at + 0.15), "crisp within 150 ms"
    sharpness.add_measurement(CRISP, 0.1)
    assert not sharpness.is_due(rests_at + 60)


def test_a_fast_machine_draws_nothing_twice():
    sharpness = Sharpness()
    draw_moving(sharpness, 0.002)
    assert not sharpness.is_due(1000.0)


def test_who_waits_for_changes_looks_less_often_once_nothing_has_changed_for_long():
    assert period(0.0) == period(0.9) == 1 / 60
    assert period(1.1) == period(1e9) == 1 / 30


def test_a_page_is_looked_after_at_once_again_when_something_changes(env):
    viewer, now = env.serve_viewer(), [0.0]
    client = Client(env.simulation, viewer._renderer, viewer.interaction, Scenes(), lambda: now[0])
    client.queue_messages([json.dumps({"type": "draws", "itself": True}), '{"type": "ready"}'], pytest.fail)
    periods = []
    for now[0], values in ((0, [0, 0]), (0.5, [0, 0]), (5, [0, 0]), (6, [0.1, 0]), (20, [0.1, 0])):
        env.GetRobots()[0].SetDOFValues(values)
        client.handle_messages(Deaf(), PageStyle(Look(), None, "ravemj"))
        client.queue_messages(['{"type": "ready"}'], pytest.fail)
        periods.append(client.patience)
    assert periods == [1 / 60, 1 / 60, 1 / 30, 1 / 60, 1 / 30]


class Deaf:
    """A page that takes everything and says nothing."""

    def recv(self, timeout=None):
        raise TimeoutError

    def send(self, message):
        pass

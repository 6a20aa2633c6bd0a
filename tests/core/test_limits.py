"""Limits of joint values, in both ways in which they are compared: few values one by one, many with numpy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravemj.model.limits import Limits
from ravemj.model.scene import Axis

Z = (0.0, 0.0, 1.0)
VALUES = st.sampled_from([-np.inf, -2.0, -1.0, -1e-300, -0.0, 0.0, 1.0, np.nextafter(1, 2), 7.0, np.inf, np.nan])


@given(st.sampled_from([0, 1, 2, 12, 13, 40]), st.data())
def test_values_are_within_limits_as_their_definition_says(count: int, data: st.DataObject) -> None:
    circular = data.draw(st.lists(st.booleans(), min_size=count, max_size=count))
    limits = Limits([Axis(Z, lower=-1.0, upper=1.0, circular=one) for one in circular])
    values = np.zeros(count)
    for place in data.draw(st.lists(st.integers(0, max(count - 1, 0)), max_size=2 if count else 0)):
        values[place] = data.draw(VALUES)
    is_inside = [
        np.isfinite(value) and (turns or -1 <= value <= 1) for value, turns in zip(values, circular, strict=True)
    ]
    assert limits.contain(values) is all(is_inside)


@pytest.mark.parametrize("count", [12, 13])
def test_one_answer_does_not_change_the_next(count: int) -> None:
    limits = Limits([Axis(Z, lower=-1.0, upper=1.0)] * count)
    outside = np.zeros(count)
    outside[-1] = 2
    assert [limits.contain(values) for values in (outside, np.zeros(count), outside, np.zeros(count))] == [
        False,
        True,
    ] * 2

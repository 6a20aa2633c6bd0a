"""Complaints about the form of an answer: the number of rows of a path, and yes or no."""

import dataclasses

import numpy as np

from ravemj.learn import Check

STRAIGHT = Check(
    "f", lambda random: (), lambda: np.zeros((2, 3)), ("", "", ""), any_length=True, judge=lambda path: None
)
YES = Check("f", lambda random: (), lambda: True, ("", "", ""), kind="boolean")


def test_a_path_has_any_number_of_waypoints():
    for count in (1, 2, 7):
        assert STRAIGHT.complaint(np.zeros((count, 3)), ()) is None
        assert (dataclasses.replace(STRAIGHT, any_length=False).complaint(np.zeros((count, 3)), ()) is None) == (
            count == 2
        )


def test_its_waypoints_have_the_right_length():
    expected = "should return an array of shape (n, 3)"
    for wrong in (np.zeros((2, 2)), np.zeros(3), np.zeros((0, 3)), np.zeros((2, 3, 1))):
        assert (STRAIGHT.complaint(wrong, ()) or "").endswith(expected)


def test_a_wrong_yes_or_no_is_no_distance():
    assert YES.complaint(np.True_, ()) is None
    assert YES.complaint(False, ()) == "it should be True"

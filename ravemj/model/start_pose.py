"""Start configuration of a simulation, and other named configurations."""

from collections.abc import Sequence

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.model.scene import Axis, KinBody

HOME_STATES = ("home", "standing", "half_sitting")
"""Names of start configurations of a robot, in order of preference."""


def start_values(body: KinBody, state: str | None = None) -> Floats:
    """Return the joint values of the start configuration [rad or m], shape (dof,).

    It is the configuration ``state`` if given, else the joint values of the body. If these are all zero (clamped to the
    limits), it is the configuration ``home``, ``standing`` or ``half_sitting``, if one exists.
    """
    values = np.array([axis.value for axis in body.dof_axes])
    names = [configuration.name for configuration in body.configurations]
    if state is None and np.array_equal(values, _nearest_to_zero(body.dof_axes)):
        state = next((name for name in HOME_STATES if name in names), None)
    if state not in names:
        return values
    axes = body.dof_axes
    return np.array([_within(axis, value) for axis, value in zip(axes, named_values(body, state), strict=True)])


def named_values(body: KinBody, name: str) -> Floats:
    """Return the joint values of a named configuration, shape (dof,); missing ones are 0, clamped to the limits."""
    given = {
        key: value
        for configuration in body.configurations
        if configuration.name == name
        for key, value in configuration.values
    }
    values = _nearest_to_zero(body.dof_axes)
    first = 0
    for joint in body.joints:
        values[first] = given.get(joint.name, values[first])
        first += len(joint.axes)
    return values


def _nearest_to_zero(axes: Sequence[Axis]) -> Floats:
    return np.array([_within(axis, 0.0) for axis in axes])


def _within(axis: Axis, value: float) -> float:
    return value if axis.circular else min(max(axis.lower, value), max(axis.lower, axis.upper))

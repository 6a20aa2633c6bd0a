"""Chains with mimic joints, such as the levelled hand of an arm with parallel links."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ravemj.core.caching import cached_property
from ravemj.ik.chain import Chain
from ravemj.ik.vectors import Floats

_STEP = 1e-6
"""Step of the numeric derivatives of mimic joints [rad or m]; exact for affine equations."""


@dataclass(frozen=True, eq=False, kw_only=True)
class FollowingChain(Chain):
    """Chain whose variables are the joints that are not mimic joints; only the numeric solver accepts it.

    Axes and points are those of the variables, which need not be joints of the chain.

    Attributes:
        inner: The chain of all N joints between base and tool.
        expand: Returns the values of all N joints for values of the variables, shape (n,).
    """

    inner: Chain
    expand: Callable[[Floats], Floats]

    @cached_property
    def reach(self) -> float:
        """Length of the chain [m]."""
        return self.inner.reach

    def rates(self, values: Floats) -> Floats:
        """Return the derivatives of all joints with respect to the variables, shape (N, n), by central differences."""
        steps = _STEP * np.eye(self.dof)
        columns = [(self.expand(values + step) - self.expand(values - step)) / (2 * _STEP) for step in steps]
        return np.array(columns).reshape(self.dof, -1).T

    def forward(self, values: Floats) -> Floats:
        """Return poses of the tool (..., 4, 4) for values of the variables (..., n)."""
        rows = [self.expand(row) for row in values.reshape(-1, self.dof)]
        return self.inner.forward(np.array(rows).reshape(*values.shape[:-1], self.inner.dof))

    def forward_and_jacobian(self, values: Floats) -> tuple[Floats, Floats]:
        """Return tool columns (4, 3, M) and Jacobians (M, 6, n) for values of the variables (M, n)."""
        tool, jacobians = self.inner.forward_and_jacobian(np.array([self.expand(row) for row in values]))
        return tool, jacobians @ np.array([self.rates(row) for row in values])

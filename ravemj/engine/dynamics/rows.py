"""What MuJoCo writes for each of its velocities, and what is read off it for each DOF."""

import math

import numpy as np

from ravemj.core.transforms import Floats, Ints


class Rows:
    """Derivatives by MuJoCo's velocities, such as a Jacobian or generalised forces.

    Attributes:
        matrix: What MuJoCo writes, shape (..., nv).
    """

    def __init__(self, shape: tuple[int, ...], nv: int, columns: Ints | None) -> None:
        """Make room for numbers of a shape (without the last axis) for each of MuJoCo's ``nv`` velocities.

        ``columns``: that of each DOF, or ``nv`` for a DOF that moves nothing; None: they are not one to one.
        """
        count = math.prod(shape)
        self._numbers = np.zeros(count * nv + 1)  # the last number stays 0
        self.matrix = self._numbers[:-1].reshape(*shape, nv)
        if columns is not None:
            firsts = nv * np.arange(count).reshape(*shape, 1)
            self._places = np.where(columns < nv, firsts + columns, count * nv)

    def of_dofs(self, coupling: Floats | None) -> Floats:
        """Return the derivatives by the DOFs, shape (..., dof); a copy. The coupling matrix is (nv, dof), or none."""
        return self._numbers[self._places] if coupling is None else self.matrix.dot(coupling)

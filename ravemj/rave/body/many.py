"""Many configurations of a body at once."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_vector
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.rave.body.base import BodyPart


class Many(BodyPart):
    """Link poses, Jacobians and torques for arrays of joint values. The body's own state stays as it is.

    Memory beside the result stays small however many configurations there are. Where the result itself is too large,
    hand in parts of the joint values, or an ``out`` that lies on disk (``numpy.memmap``).
    """

    def batch_link_transforms(self, values: ArrayLike, out: Floats | None = None) -> Floats:
        """Return the poses of all links for many joint values, several times faster than a loop.

        Joint limits are not looked at, except that joints that follow others stop at theirs.

        Args:
            values: Joint values [rad, for sliders m], shape (N, dof).
            out: Takes the result: float64, shape (N, links, 4, 4); None: a new array.

        Returns:
            ``T_world_link`` in the order of ``GetLinks()``, shape (N, links, 4, 4).

        Raises:
            ArgumentError: a shape is wrong, or a value is infinite or no number.

        Example:
            >>> lower, upper = robot.GetDOFLimits()
            >>> Q = numpy.random.uniform(lower, upper, (100_000, robot.GetDOF()))
            >>> tips = robot.batch_link_transforms(Q)[:, -1, :3, 3]
        """
        checked = self._checked_many(values, "values")
        result = _checked_out(out, (len(checked), len(self._state.scene.links), 4, 4))
        with self._simulation.lock:
            self._state.batch.link_transforms(checked, result)
        return result

    def batch_jacobians(
        self, values: ArrayLike, linkindex: int, position_in_link: ArrayLike, out: Floats | None = None
    ) -> Floats:
        """Return the Jacobians of a link for many joint values.

        Args:
            values: Joint values [rad, for sliders m], shape (N, dof).
            linkindex: Index of the link.
            position_in_link: The point whose motion is asked for, in the link's frame [m], shape (3,).
            out: Takes the result: float64, shape (N, 6, dof); None: a new array.

        Returns:
            Shape (N, 6, dof): the first three rows are ``ComputeJacobianTranslation``, the others
            ``ComputeJacobianAxisAngle``.

        Raises:
            ArgumentError: a shape is wrong, there is no such link, or a value is infinite or no number.
        """
        checked = self._checked_many(values, "values")
        count = len(self._state.scene.links)
        if not 0 <= linkindex < count:
            raise ArgumentError(f"linkindex is {linkindex}, and should be from 0 to {count - 1}")
        point = checked_vector(position_in_link, 3, "position_in_link")
        result = _checked_out(out, (len(checked), 6, self.GetDOF()))
        with self._simulation.lock:
            self._state.batch.jacobians(checked, linkindex, point, result)
        return result

    def batch_inverse_dynamics(
        self, values: ArrayLike, velocities: ArrayLike, accelerations: ArrayLike, out: Floats | None = None
    ) -> Floats:
        """Return ``ComputeInverseDynamics`` for many joint values, velocities and accelerations, with the base at rest.

        Args:
            values: Joint values [rad, for sliders m], shape (N, dof).
            velocities: Joint velocities [rad/s or m/s], shape (N, dof).
            accelerations: Joint accelerations [rad/s^2 or m/s^2], shape (N, dof).
            out: Takes the result: float64, shape (N, dof); None: a new array.

        Returns:
            Torques [N m, for sliders N], shape (N, dof).

        Raises:
            ArgumentError: a shape is wrong, or a value is infinite or no number.
        """
        given = {"values": values, "velocities": velocities, "accelerations": accelerations}
        checked = [self._checked_many(numbers, name) for name, numbers in given.items()]
        if len({len(numbers) for numbers in checked}) > 1:
            raise ArgumentError(
                f"there are {[len(numbers) for numbers in checked]} configurations; give as many of all"
            )
        result = _checked_out(out, checked[0].shape)
        with self._simulation.lock:
            state, gravity = self._state, np.array(self._simulation.gravity)
            state.batch.inverse_dynamics(checked[0], checked[1], checked[2], state.inertias, gravity, result)
        return result

    def _checked_many(self, numbers: ArrayLike, name: str) -> Floats:
        """Return an array of shape (N, dof), which is the given one where that has numbers of the right kind."""
        dof = self.GetDOF()
        try:
            checked = np.asarray(numbers, dtype=np.float64)
        except (TypeError, ValueError):
            raise ArgumentError(f"{name}: should be numbers of shape (N, {dof})") from None
        if checked.ndim != 2 or checked.shape[1] != dof:
            raise ArgumentError(f"{name}: has shape {checked.shape}, and should have (N, {dof})")
        if not np.isfinite(checked.sum()) and not all(np.isfinite(row).all() for row in checked):
            raise ArgumentError(f"{name}: should be finite")
        return checked


def _checked_out(out: Floats | None, shape: tuple[int, ...]) -> Floats:
    if out is None:
        return np.empty(shape)
    if out.shape != shape or out.dtype != np.float64:
        raise ArgumentError(f"out: has shape {out.shape} and numbers {out.dtype}, and should be float64 of {shape}")
    return out

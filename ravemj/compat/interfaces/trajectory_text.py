"""Trajectories that are given as text."""

from ravemj.compat.interfaces.helper import Helper, given
from ravemj.compat.planningutils import RetimeTrajectory, VerifyTrajectory
from ravemj.rave.modules.base_manipulation import BaseManipulation
from ravemj.rave.trajectory import Trajectory


class TrajectoryText(Helper):
    """The part of ``BaseManipulation`` that executes and verifies trajectories from their text."""

    _base: BaseManipulation

    def TrajFromData(self, data: str | bytes, resettrans: bool | None = None, resettiming: bool | None = None) -> None:
        """Execute a trajectory.

        ``resettrans`` is not used.

        Args:
            data: The trajectory, as ``Trajectory.serialize`` writes it.
            resettiming: Whether it gets new times.

        Raises:
            openrave_exception: this is no trajectory, or it cannot be executed.
        """
        del resettrans
        self._base.execute(self._read(data, resettiming))

    def VerifyTrajectory(
        self,
        data: str | bytes,
        resettrans: bool | None = None,
        resettiming: bool | None = None,
        samplingstep: float | None = None,
    ) -> None:
        """Check that a trajectory keeps limits and constraints; see ``planningutils.VerifyTrajectory``.

        ``resettrans`` is not used.

        Args:
            data: The trajectory, as ``Trajectory.serialize`` writes it.
            resettiming: Whether it gets new times first.
            samplingstep: Steps in which it is looked at [s].

        Raises:
            openrave_exception: it does not, or this is no trajectory.
        """
        del resettrans
        VerifyTrajectory(None, self._read(data, resettiming), **given(samplingstep=samplingstep))

    def _read(self, data: str | bytes, resettiming: bool | None) -> Trajectory:
        traj = Trajectory(self.robot.GetEnv(), "")
        traj.deserialize(data)
        if resettiming:
            RetimeTrajectory(traj, False)
        return traj

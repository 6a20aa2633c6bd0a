"""Solvers that find joint values for a pose of the tool."""

from collections.abc import Sequence

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.geometry_functions.ik_parameterization import INVERSE_KINEMATICS, IkParameterizationType
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.robot import Robot


class InverseKinematicsModel(DatabaseGenerator):
    """A solver for an arm.

    Args:
        robot: The robot, whose active manipulator is taken; None: that of ``manip``.
        iktype: What of the tool's pose is asked for; None: all of it.
        forceikfast: For OpenRAVE.
        freeindices: DOFs that the solver leaves as they are.
        freejoints: For OpenRAVE.
        manip: The arm.

    Example:
        >>> model = databases.inversekinematics.InverseKinematicsModel(robot, IkParameterization.Type.Transform6D)
        >>> if not model.load():
        ...     model.autogenerate()
    """

    capability = INVERSE_KINEMATICS

    def __init__(
        self,
        robot: Robot | None = None,
        iktype: IkParameterizationType | None = None,
        forceikfast: bool = False,
        freeindices: Sequence[int] | None = None,
        freejoints: Sequence[str] | None = None,
        manip: Manipulator | None = None,
    ) -> None:
        del forceikfast, freejoints
        owner = manip.GetRobot() if robot is None and manip is not None else robot
        if not isinstance(owner, Robot):
            raise ValueError("InverseKinematicsModel: give a robot or a manipulator")
        super().__init__(owner)
        self.manip = manip or self.manip
        self.iktype = IkParameterizationType.Transform6D if iktype is None else iktype
        self.freeindices = [] if freeindices is None else list(freeindices)

    @property
    def solveindices(self) -> list[int]:
        """The DOFs that the solver moves."""
        arm = [] if self.manip is None else list(self.manip.GetArmIndices())
        return [int(index) for index in arm if index not in self.freeindices]

    def load(self, freeinc: object = None, checkforloaded: bool = True) -> bool:
        """Return whether there is a solver: False."""
        del freeinc, checkforloaded
        return False

"""Extents of a robot's links, for the weights and resolutions of planners."""

import numpy as np

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.compat.refusal import lacking, refusing
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.model.motion_bounds import motion_bounds

STATISTICS = "files of statistics of links"


@lacking(
    STATISTICS,
    """
    LoadPickle() SavePickle() generate(**named) getfilename(read) getversion() show(options) @CreateOptionParser()
    @RunFromParser(Model parser **named)
    """,
)
class LinkStatisticsModel(DatabaseGenerator):
    """Extents of a robot's links, computed from bounding boxes on demand.

    Args:
        robot: The robot.

    Example:
        >>> model = databases.linkstatistics.LinkStatisticsModel(robot)
        >>> if not model.load():
        ...     model.autogenerate()
        >>> model.setRobotWeights()
        >>> model.setRobotResolutions(xyzdelta=0.005)
    """

    capability = STATISTICS

    def load(self) -> bool:
        """Return True: the model is always available."""
        return True

    def autogenerate(self, options: object = None) -> None:
        """Do nothing."""

    def save(self, params: object = None) -> None:
        """Do nothing."""

    def setRobotWeights(self, type: int = 0, weightmult: float = 1.0) -> None:
        """Set the weights of the DOFs according to the displacement that they cause.

        Args:
            type: Must be 0, OpenRAVE's number for weights proportional to the maximum displacement of a point of the
                robot per unit of the DOF.
            weightmult: The mean of the weights.
        """
        if type != 0:
            raise ArgumentError(f"setRobotWeights: type is {type}, and should be 0")
        distances = self._distances()
        self.robot.SetDOFWeights(weightmult * distances / distances.mean() if len(distances) else distances)

    def setRobotResolutions(self, xyzdelta: float | None = None) -> None:
        """Set the resolutions of the DOFs so that a step moves no point of the robot farther than a limit.

        Args:
            xyzdelta: Maximum displacement of a point [m]; by default 0.005.
        """
        delta = 0.005 if xyzdelta is None else xyzdelta
        self.robot.SetDOFResolutions(delta / self._distances())

    def _distances(self) -> Floats:
        """Return for each DOF the maximum displacement of a point of the robot per unit of the DOF, shape (dof,).

        A DOF that moves nothing gets the smallest displacement of the other DOFs.
        """
        distances = motion_bounds(self.robot.simulation_state.scene)
        return np.where(distances > 0, distances, np.min(distances, initial=1.0, where=distances > 0))

    grabbedjointspheres = None


run = refusing("linkstatistics.run", STATISTICS, "*arguments **named")

"""Classes of motion planning, for scripts that name them; ravemj does not plan yet."""

from ravemj.errors import UnsupportedError
from ravemj.rave.enums import PlannerStatus, PlannerStatusCode

PLANNING = "motion planning"


class PlanningError(Exception):
    """No motion was found; not an ``openrave_exception``.

    Attributes:
        parameter: What was to be planned.
        recoverySolutions: What the caller can do instead.
    """

    def __init__(self, parameter: object = None, recoverySolutions: object = None) -> None:
        super().__init__(parameter)
        self.parameter = parameter
        self.recoverySolutions = recoverySolutions


class PlannerParameters:
    """The problem of a planner."""

    def __init__(self) -> None:
        raise UnsupportedError("Planner.PlannerParameters", PLANNING)


class Planner:
    """Finds motions without collisions; ``RaveCreatePlanner`` makes it in OpenRAVE."""

    PlannerParameters = PlannerParameters
    PlannerStatus = PlannerStatus
    PlannerStatusCode = PlannerStatusCode

    def __init__(self) -> None:
        raise UnsupportedError("Planner", PLANNING)

    def InitPlan(self, robot: object, params: object) -> bool:
        """Take over a problem; return whether it can be solved.

        Args:
            robot: The robot.
            params: The problem.
        """
        raise UnsupportedError("Planner.InitPlan", PLANNING)

    def PlanPath(self, traj: object, releasegil: bool = True) -> PlannerStatus:
        """Solve the problem, into a trajectory; return a ``PlannerStatus``.

        Args:
            traj: Where the motion goes.
            releasegil: Not used.
        """
        raise UnsupportedError("Planner.PlanPath", PLANNING)

"""Bodies that come and go."""

from ravemj.rave.env.base import EnvironmentPart
from ravemj.rave.kinbody import KinBody
from ravemj.rave.physics import PhysicsEngine
from ravemj.rave.robot import Robot


class Contents(EnvironmentPart):
    """The bodies of an environment."""

    def GetBodies(self) -> list[KinBody]:
        """Return all bodies, robots included, in the order in which they were added."""
        return [self._wrap(state) for state in self._simulation.bodies]

    def GetRobots(self) -> list[Robot]:
        """Return the robots, in the order in which they were added.

        Example:
            >>> robot = env.GetRobots()[0]
        """
        return [body for body in self.GetBodies() if isinstance(body, Robot)]

    def GetKinBody(self, name: str) -> KinBody | None:
        """Return the body or robot of that name, or None."""
        state = self._simulation.body(name)
        return None if state is None else self._wrap(state)

    def GetRobot(self, name: str) -> Robot | None:
        """Return the robot of that name, or None.

        Example:
            >>> robot = env.GetRobot("Pendulum")
        """
        body = self.GetKinBody(name)
        return body if isinstance(body, Robot) else None

    def GetPhysicsEngine(self) -> PhysicsEngine:
        """Return what holds gravity; never None."""
        return PhysicsEngine(self._simulation)

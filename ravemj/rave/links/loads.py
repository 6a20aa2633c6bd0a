"""Forces on a link."""

from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from ravemj.rave.member import LinkPart

if TYPE_CHECKING:
    from ravemj.rave.physics import PhysicsEngine


class LinkLoads(LinkPart):
    """Forces and torques for physics engines; without one they do nothing."""

    def SetForce(self, force: ArrayLike, pos: ArrayLike, add: bool) -> bool:
        """Let a force act on the link during the next step of simulation time, and not longer.

        Args:
            force: In the world [N], shape (3,).
            pos: Where it acts, in the world [m], shape (3,).
            add: Whether forces that were set for that step stay.

        Returns:
            Whether the environment has a physics engine that moves bodies.

        Example:
            >>> env.SetPhysicsEngine("mujoco")
            True
            >>> link.SetForce([0, 0, 20], link.GetTransform()[0:3, 3], False)
            True
            >>> env.StepSimulation(0.01)
        """
        return (
            self._parent.GetEnv().GetPhysicsEngine().SetBodyForce(self._parent.GetLinks()[self._index], force, pos, add)
        )

    def SetTorque(self, torque: ArrayLike, add: bool) -> bool:
        """Let a torque act on the link during the next step of simulation time, and not longer.

        Args:
            torque: In world axes [N m], shape (3,).
            add: Whether torques that were set for that step stay.

        Returns:
            Whether the environment has a physics engine that moves bodies.
        """
        return self._engine.SetBodyTorque(self._parent.GetLinks()[self._index], torque, add)

    @property
    def _engine(self) -> "PhysicsEngine":
        return self._parent.GetEnv().GetPhysicsEngine()

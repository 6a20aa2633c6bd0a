"""Copies of an environment."""

from typing import TYPE_CHECKING

from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.body import GrabbedBody
from ravemj.rave.body.base import both_locks
from ravemj.rave.enums import CloningOptions
from ravemj.rave.env.contents import Contents
from ravemj.rave.interface import checked_environment
from ravemj.rave.kinbody import KinBody
from ravemj.rave.robot import Robot

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


class Cloning(Contents):
    """Copies the bodies of another environment."""

    def CloneSelf(self, options: int = CloningOptions.Bodies, name: str | None = None) -> "Environment":
        """Return a new environment with copies of the bodies, in the same state.

        Robots keep their active DOFs and manipulators, and hold what they held.

        Args:
            options: What to copy, a ``CloningOptions``; bodies, gravity and the view are, whatever it says.
            name: OpenRAVE's; ignored.

        Example:
            >>> copy = env.CloneSelf(CloningOptions.Bodies)
            >>> copy.GetRobots()[0].SetDOFValues([1, 1])  # env's robot stays
        """
        del name
        clone = type(self._environment)()
        clone.Clone(self._environment, options)
        return clone

    def Clone(self, reference: "Environment", options: int = CloningOptions.Bodies, name: str | None = None) -> None:
        """Replace the bodies of this environment by copies of those of another.

        Args:
            reference: The environment to copy; nothing happens where it is this one.
            options: As in ``CloneSelf``.
            name: OpenRAVE's; ignored.
        """
        del options, name
        for env in (self, checked_environment(reference, "Clone: reference")):
            env._check_alive()
        source = reference.simulation
        if source is self._simulation:
            return
        with both_locks(source, self._simulation):
            self._remove_all()
            self._simulation.view = source.view
            self._simulation.set_gravity(source.gravity)
            copies = {body: self._copy(body, reference.wrap(body)) for body in source.bodies}
            for original, copy in copies.items():
                copy.grabs = [
                    GrabbedBody(copies[grab.body], grab.link, grab.T_link_body, grab.ignored) for grab in original.grabs
                ]

    def _copy(self, original: BodyState, other: KinBody) -> BodyState:
        copy = self._simulation.create(original.scene)
        copy.copy(original)
        self._simulation.insert(copy, original.index)
        copy.rest_poses = original.rest_poses
        body = self.wrap(copy)
        if isinstance(body, Robot) and isinstance(other, Robot):
            body.take_choices(other)
        return copy

"""Inverse-kinematics drags with pinned links: the rest of the body, including its base, moves."""

from collections.abc import Sequence

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.geometry_functions.affine import Z_AXIS, DOFAffine
from ravemj.gui.interaction.dragging import in_plane
from ravemj.gui.interaction.notices import Notices
from ravemj.gui.interaction.reaching import Reach
from ravemj.gui.interaction.viewpoint import ViewRay
from ravemj.ik.whole_body import Descent, TaskRows, WeightedTask
from ravemj.ik.whole_body.tasks import pose_rows
from ravemj.manipulation.whole_body import Moving
from ravemj.model.drawing import NOTHING, Primitives

_STEPS, _LONGEST = 40, 0.3
"""Maximum number of steps per pointer move, and maximum length of a step [rad or m]."""

_PULL, _STAY = 0.1, 1e-6
"""Weights of the dragged point and of the posture task, relative to 1 for a pinned link."""

_NEAR = 2e-3
"""Distance of the dragged link from the pointer at which the drag has converged [m]."""

_TOLD = 1.5
"""Duration of the message that names blocking pins or limits [s]."""


class PinnedReach(Reach):
    """A drag of a link while pinned links of the same body keep their poses."""

    def __init__(
        self, body: BodyState, link: int, point: Floats, normal: Floats, pins: Sequence[int], notices: Notices
    ) -> None:
        """Start the drag of a link.

        Args:
            body: The body.
            link: Index of the link.
            point: The grabbed point, in the world [m], shape (3,).
            normal: Normal of the drag plane, unit vector, shape (3,).
            pins: Indices of the pinned links.
            notices: Receives the message about blocking pins or limits.
        """
        self.body, self.link = body, link
        self._point, self._normal, self._notices = point, normal, notices
        self._free = None
        self._goal = point
        self._moving = moving = Moving(body, np.arange(body.dof), int(DOFAffine.Transform), Z_AXIS)
        limits = moving.limits(values=True, velocities=False, accelerations=False, base_velocity=None)
        self._descent = Descent(moving, limits)
        self._descent.tasks += [self._contact(pin) for pin in pins]
        self._descent.tasks += [self._pull(), self._wish()]

    def _contact(self, link: int) -> WeightedTask:
        number, T_world_link = self._moving.add_frame(link, np.eye(4)), self.body.link_transform(link)
        name = self.body.scene.links[link].name
        return WeightedTask(
            name, lambda: pose_rows(*self._moving.frame(number), T_world_link), str, 1.0, is_contact=True
        )

    def _pull(self) -> WeightedTask:
        T_link_point, T_world_link = np.eye(4), self.body.link_transform(self.link)
        T_link_point[:3, 3] = (self._point - T_world_link[:3, 3]) @ T_world_link[:3, :3]
        number = self._moving.add_frame(self.link, T_link_point)

        def measure() -> TaskRows:
            T_world_point, jacobian = self._moving.frame(number)
            return TaskRows(self._goal - T_world_point[:3, 3], jacobian[:3])

        return WeightedTask(self.body.scene.links[self.link].name, measure, str, _PULL, tolerance=_NEAR)

    def _wish(self) -> WeightedTask:
        moving, identity = self._moving, np.eye(self.body.dof, self._moving.count)
        start = moving.values()[: self.body.dof]

        def measure() -> TaskRows:
            return TaskRows(start - moving.values()[: self.body.dof], identity, is_identity=True)

        return WeightedTask("posture", measure, str, _STAY, tolerance=np.inf)

    def follow(self, ray: ViewRay) -> None:
        """Move the link towards the intersection of the ray and the drag plane, as far as pins and limits permit."""
        goal = in_plane(ray, self._point, self._normal)
        if goal is not None:
            self._goal = goal
            self._descent.solve(_STEPS, _LONGEST)
            for task in self._descent.tasks:
                line = f"{task.name} gives in: the pins and the limits let it go no further"
                if task.is_met:
                    self._notices.withdraw(line)
                else:
                    self._notices.say(line, _TOLD)

    def ghosts(self) -> Primitives:
        """Return no drawings of other IK solutions, since there are infinitely many."""
        return NOTHING

"""Selective display of a robot's geometry while a model is shown."""

from typing import Self

from ravemj.core.api_object import published
from ravemj.rave.geometry import Geometry
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator


class GripperVisibility:
    """Context manager that shows only the gripper of an arm; the other links of the robot are hidden.

    Args:
        manip: The arm.

    Example:
        >>> with databases.grasping.GraspingModel.GripperVisibility(manip):
        ...     picture = env.render()
    """

    def __init__(self, manip: Manipulator) -> None:
        self.manip = manip
        self._transparency = 1.0
        self._hidden: list[tuple[Geometry, bool, float]] = []

    def _shown(self) -> list[Link]:
        return self.manip.GetChildLinks()

    def __enter__(self) -> Self:
        shown = self._shown()
        hidden = [link for link in self.manip.GetRobot().GetLinks() if link not in shown]
        for shape in (shape for link in hidden for shape in link.GetGeometries()):
            self._hidden.append((shape, shape.IsVisible(), shape.GetTransparency()))
            if self._transparency < 1:
                shape.SetTransparency(self._transparency)
            else:
                shape.SetVisible(False)
        return self

    def __exit__(self, type: object, value: object, traceback: object) -> None:
        for shape, visible, transparency in self._hidden:
            shape.SetVisible(visible)
            shape.SetTransparency(transparency)
        self._hidden.clear()


class ArmVisibility(GripperVisibility):
    """Context manager that shows only the links of an arm, or makes the others transparent.

    Args:
        manip: The arm.
        transparency: Transparency of the other links: 0 is opaque, 1 hides them.
    """

    def __init__(self, manip: Manipulator, transparency: float = 1) -> None:
        super().__init__(manip)
        self._transparency = float(transparency)

    def _shown(self) -> list[Link]:
        base, effector = self.manip.GetBase(), self.manip.GetEndEffector()
        if base is None or effector is None:
            return []
        return self.manip.GetRobot().GetChain(base.GetIndex(), effector.GetIndex(), returnjoints=False)


for _kind in (GripperVisibility, ArmVisibility):
    published(_kind, __name__)

"""Poses of a body and its links."""

from collections.abc import Sequence
from typing import Literal, overload

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats, pose_of
from ravemj.errors import RavemjError
from ravemj.rave.body.configuration import JointValues
from ravemj.rave.enums import CheckLimitsAction


class Placement(JointValues):
    """Where the body and its links are."""

    def GetTransform(self) -> Floats:
        """Return the body's pose: that of its first link, not of the file's origin.

        Returns:
            ``T_world_link0``, shape (4, 4); a copy. The identity for a body without links.

        Example:
            >>> position = robot.GetTransform()[:3, 3]
            >>> x_axis = robot.GetTransform()[:3, 0]
        """
        with self._simulation.lock:
            return self._state.link_transform(0) if self._state.scene.links else np.eye(4)

    def GetTransformPose(self) -> Floats:
        """Return the body's pose as [w, x, y, z, tx, ty, tz]: unit quaternion and position [m], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def SetTransform(self, transform: ArrayLike) -> None:
        """Move the whole body rigidly; joint values stay as they are.

        What the body holds moves along. A body that is not in the environment can be moved as well.

        Args:
            transform: ``T_world_link0``, the new pose of the first link: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].

        Raises:
            ArgumentError: this is no rigid transform. Nothing has moved then.

        Example:
            >>> T = body.GetTransform()
            >>> T[0:3, 3] = [1, 0, 0.5]
            >>> body.SetTransform(T)
        """
        checked = checked_transform(transform, "SetTransform: transform")
        with self._simulation.lock:
            self._state.set_transform(checked)

    def SetTransformWithDOFValues(
        self, transform: ArrayLike, values: ArrayLike, checklimits: int = CheckLimitsAction.CheckLimits
    ) -> None:
        """Set the pose of the first link and the joint values in one go.

        Args:
            transform: ``T_world_link0``, as ``SetTransform`` takes it.
            values: Joint values [rad or m], shape (dof,).
            checklimits: As in ``SetDOFValues``.
        """
        checked = checked_transform(transform, "SetTransformWithDOFValues: transform")
        with self._simulation.lock:
            self.SetDOFValues(values, None, checklimits)
            self._state.set_transform(checked)

    SetTransformWithJointValues = SetTransformWithDOFValues

    @overload
    def GetLinkTransformations(self, returndoflastvlaues: Literal[False] = False) -> list[Floats]: ...
    @overload
    def GetLinkTransformations(self, returndoflastvlaues: Literal[True]) -> tuple[list[Floats], Floats]: ...
    def GetLinkTransformations(self, returndoflastvlaues: bool = False) -> list[Floats] | tuple[list[Floats], Floats]:
        """Return the poses of all links in the world.

        Args:
            returndoflastvlaues: Whether to return the joint values, too, as ``SetLinkTransformations`` takes them
                (the spelling is OpenRAVE's).

        Returns:
            ``T_world_link`` of shape (4, 4) for each link, in the order of ``GetLinks()``; copies.
        """
        with self._simulation.lock:
            transforms = list(self._state.link_transforms())
            return (transforms, self._state.kinematics.values()) if returndoflastvlaues else transforms

    def SetLinkTransformations(
        self, transforms: Sequence[ArrayLike], doflastsetvalues: ArrayLike | None = None
    ) -> None:
        """Put every link at a pose; joints get the values that the poses show.

        Args:
            transforms: ``T_world_link`` for each link, in the order of ``GetLinks()``: 4x4, 3x4 or 7 numbers each.
            doflastsetvalues: Joint values that tell how many full turns each hinge has made, shape (dof,), as
                ``GetLinkTransformations(True)`` returns them; left out: none.

        Raises:
            openrave_exception: there are more or fewer poses than links, or one is not rigid. Nothing has moved then.
        """
        count = len(self._state.scene.links)
        if len(transforms) != count:
            message = f"SetLinkTransformations: there are {len(transforms)} transforms, and should be {count}"
            raise RavemjError(message)
        checked = np.array([checked_transform(one, "SetLinkTransformations: transforms") for one in transforms])
        last = np.zeros(self.GetDOF())
        if doflastsetvalues is not None and np.size(doflastsetvalues):
            last = checked_vector(doflastsetvalues, self.GetDOF(), "SetLinkTransformations: doflastsetvalues")
        with self._simulation.lock:
            self._state.place_links(checked.reshape(-1, 4, 4), last)

    def link_transforms(self) -> Floats:
        """Return the poses of all links in one array: the fast form of ``GetLinkTransformations``.

        Returns:
            ``T_world_link`` in the order of ``GetLinks()``, shape (links, 4, 4); a copy.
        """
        with self._simulation.lock:
            return self._state.link_transforms()

    def GetUpdateStamp(self) -> int:
        """Return a number that grows with every change of pose."""
        return self._state.stamp

"""Collision of a link."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform
from ravemj.geometry_functions import AABB
from ravemj.model.bounds import link_bounds
from ravemj.rave.body.collision import aabb_of
from ravemj.rave.member import LinkPart


class LinkCollision(LinkPart):
    """Whether a link takes part in collision checking, and how much room it needs."""

    def Enable(self, enable: bool) -> None:
        """Enable or disable the link for collision checking; nothing else changes.

        Args:
            enable: False: collision checking leaves it out.
        """
        with self._state.simulation.lock:
            enabled = list(self._state.link_enabled)
            enabled[self._index] = bool(enable)
            self._state.link_enabled = enabled

    def IsEnabled(self) -> bool:
        """Return whether collision checking looks at the link."""
        return self._state.link_enabled[self._index]

    def SetIgnoreSelfCollision(self, bIgnore: bool) -> None:
        """Leave the link out of ``body.CheckSelfCollision``, or take it in again.

        Args:
            bIgnore: Whether it is left out.
        """
        with self._state.simulation.lock:
            self._state.edit_link(self._index, self_collision_ignored=bool(bIgnore))
            self._state.simulation.collision_stamp += 1

    def IsSelfCollisionIgnored(self) -> bool:
        """Return whether ``body.CheckSelfCollision`` leaves the link out."""
        return self._scene.self_collision_ignored

    def ComputeAABB(self) -> AABB:
        """Return the smallest box along the world's axes that holds the link's geometries.

        Returns:
            The box, with methods ``pos()`` and ``extents()``; a point at the link's origin if there is no geometry.
        """
        with self._state.simulation.lock:
            return self.ComputeAABBFromTransform(self._state.link_transform(self._index))

    def ComputeAABBFromTransform(self, transform: ArrayLike) -> AABB:
        """Return the box of ``ComputeAABB`` for the link standing at a pose: 4x4, 3x4 or 7 numbers.

        Args:
            transform: ``T_world_link``: 4x4, 3x4, or [w, x, y, z, tx, ty, tz].
        """
        T_a_link = checked_transform(transform, "ComputeAABBFromTransform: transform")
        return aabb_of(link_bounds(self._scene, T_a_link), T_a_link)

    def ComputeLocalAABB(self) -> AABB:
        """Return the smallest box along the link's axes that holds its geometries, in the link's frame."""
        return self.ComputeAABBFromTransform(np.eye(4))

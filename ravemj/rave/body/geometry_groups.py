"""Groups of geometries of all links of a body."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform
from ravemj.core.transforms import inverse
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import AABB
from ravemj.model.bounds import enclosing_box, links_bounds
from ravemj.rave.body.structure import Structure
from ravemj.rave.infos import GeometryInfo


class GeometryGroups(Structure):
    """Sets of shapes, one for each link, that can stand for its own; see ``link.SetGroupGeometries``."""

    def SetLinkGroupGeometries(self, name: str, linkgeometries: Sequence[Sequence[GeometryInfo]]) -> None:
        """Keep a set of shapes for every link under one name.

        Args:
            name: The name of the group.
            linkgeometries: For each link, in order, the descriptions of its shapes.

        Raises:
            openrave_exception: there are not as many lists as links, or an info describes nothing that can be.
        """
        links = self.GetLinks()
        if len(linkgeometries) != len(links):
            message = f"linkgeometries has {len(linkgeometries)} lists, and should have {len(links)}, one for each link"
            raise ArgumentError(f"SetLinkGroupGeometries: {message}")
        for link, infos in zip(links, linkgeometries, strict=True):
            link.SetGroupGeometries(name, infos)

    def SetLinkGeometriesFromGroup(self, name: str, propagateGroupNameToSelfCollisionChecker: bool = True) -> None:
        """Give every link the shapes of a group in place of its own.

        Args:
            name: The name of the group; ``self`` brings their own shapes back.
            propagateGroupNameToSelfCollisionChecker: Not used: collisions always look at the shapes that links have.

        Raises:
            openrave_exception: a link has no such group. Nothing has changed then.
        """
        del propagateGroupNameToSelfCollisionChecker
        with self._simulation.lock:
            for link in self.GetLinks():
                link.GetGeometriesFromGroup(name)
            for link in self.GetLinks():
                link.SetGeometriesFromGroup(name)

    def ComputeAABBForGeometryGroup(self, geomgroupname: str, enabledOnlyLinks: bool = False) -> AABB:
        """Return the box of ``ComputeAABB`` around the shapes of a group; links without the group are left out.

        Args:
            geomgroupname: The name of the group; ``self``: the links' own shapes.
            enabledOnlyLinks: Whether disabled links are left out.
        """
        with self._simulation.lock:
            T_world_link0 = self._state.link_transform(0) if self._state.scene.links else np.eye(4)
        return self.ComputeAABBForGeometryGroupFromTransform(geomgroupname, T_world_link0, enabledOnlyLinks)

    def ComputeAABBForGeometryGroupFromTransform(
        self, geomgroupname: str, transform: ArrayLike, enabledOnlyLinks: bool = False
    ) -> AABB:
        """Return the box of ``ComputeAABBForGeometryGroup`` for the body standing elsewhere.

        Args:
            geomgroupname: The name of the group.
            transform: ``T_world_link0``, as ``SetTransform`` takes it.
            enabledOnlyLinks: Whether disabled links are left out.
        """
        T_world_body = checked_transform(transform, "ComputeAABBForGeometryGroupFromTransform: transform")
        with self._simulation.lock:
            poses, enabled = self._state.link_transforms(), self._state.link_enabled
        if len(poses):
            poses = T_world_body @ inverse(poses[0]) @ poses
        links = [
            (link.scene_with_group(geomgroupname), pose)
            for link, pose, takes_part in zip(self.GetLinks(), poses, enabled, strict=True)
            if link.GetGroupNumGeometries(geomgroupname) >= 0 and (takes_part or not enabledOnlyLinks)
        ]
        return enclosing_box(links_bounds([link for link, _ in links], [pose for _, pose in links]), T_world_body)

    def ComputeLocalAABBForGeometryGroup(self, geomgroupname: str, enabledOnlyLinks: bool = False) -> AABB:
        """Return the box of ``ComputeAABBForGeometryGroup`` along the axes of the first link and in its frame.

        Args:
            geomgroupname: The name of the group.
            enabledOnlyLinks: Whether disabled links are left out.
        """
        return self.ComputeAABBForGeometryGroupFromTransform(geomgroupname, np.eye(4), enabledOnlyLinks)

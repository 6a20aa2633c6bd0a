"""Shapes of a link."""

from ravemj.rave.geometry import Geometry
from ravemj.rave.links.base import LinkPart
from ravemj.rave.trimesh import TriMesh, trimesh_of
from ravemj.tessellation import merged, moved, triangulated


class LinkShapes(LinkPart):
    """The geometries of a link, and other sets of them that can be swapped in."""

    def GetGeometries(self) -> list[Geometry]:
        """Return the link's shapes, in the order of the file."""
        return [Geometry(self._state, self._index, index) for index in range(len(self._scene.geometries))]

    def GetGeometry(self, index: int) -> Geometry:
        """Return one of the link's shapes.

        Args:
            index: Its position in ``GetGeometries()``.
        """
        return self.GetGeometries()[index]

    def GetCollisionData(self) -> TriMesh:
        """Return all shapes of the link as triangles, in the link's frame; copies."""
        return trimesh_of(
            merged(moved(triangulated(one.shape), one.T_link_geometry.matrix()) for one in self._scene.geometries)
        )

    def IsVisible(self) -> bool:
        """Return whether any shape of the link is drawn."""
        return any(geometry.visible for geometry in self._scene.geometries)

    def SetVisible(self, visible: bool) -> bool:
        """Draw all shapes of the link, or none; they collide all the same.

        Args:
            visible: Whether to draw them.

        Returns:
            Whether that changed something.
        """
        return any([geometry.SetVisible(visible) for geometry in self.GetGeometries()])

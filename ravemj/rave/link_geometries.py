"""Shapes of a link."""

from collections.abc import Sequence

from ravemj.errors import ArgumentError
from ravemj.model import scene
from ravemj.model.scene import Mesh
from ravemj.rave.geometry import Geometry
from ravemj.rave.infos import GeometryInfo
from ravemj.rave.infos.link import geometries_of
from ravemj.rave.member import LinkPart
from ravemj.rave.trimesh import TriMesh, trimesh_of


class LinkShapes(LinkPart):
    """The geometries of a link, and other sets of them that can be swapped in."""

    def GetGeometries(self) -> list[Geometry]:
        """Return the link's shapes, in the order of the file.

        Example:
            >>> for geometry in robot.GetLink("Arm0").GetGeometries():
            ...     geometry.SetTransparency(0.5)
        """
        return [Geometry(self, self._state, self._index, index) for index in range(len(self._scene.geometries))]

    def GetGeometry(self, index: int) -> Geometry:
        """Return one of the link's shapes.

        Args:
            index: Its position in ``GetGeometries()``.
        """
        return self.GetGeometries()[index]

    def GetCollisionData(self) -> TriMesh:
        """Return all shapes of the link as triangles, in the link's frame; copies."""
        return trimesh_of(
            Mesh.merged(one.shape.triangulated().moved(one.T_link_geometry.matrix()) for one in self._scene.geometries)
        )

    def InitGeometries(self, geometryinfos: Sequence[GeometryInfo]) -> None:
        """Give the link other shapes in place of its own.

        Args:
            geometryinfos: Their descriptions.

        Raises:
            openrave_exception: one describes nothing that can be. Nothing has changed then.
        """
        self._set_geometries(geometries_of(geometryinfos))

    def AddGeometry(self, geometryinfo: GeometryInfo, addToGroups: bool = False) -> None:
        """Add a shape.

        Args:
            geometryinfo: Its description.
            addToGroups: Whether to add it to all groups, too.

        Raises:
            openrave_exception: it describes nothing that can be, or a shape of that name is there. Nothing has changed
                then.
        """
        added = geometries_of([geometryinfo])
        if any(one.name == added[0].name for one in self._scene.geometries if one.name):
            raise ArgumentError(f"AddGeometry: link '{self._scene.name}' has a geometry '{added[0].name}' already")
        self._set_geometries((*self._scene.geometries, *added))
        if addToGroups:
            self._set_groups({name: (*group, *added) for name, group in self._scene.groups})

    def RemoveGeometryByName(self, geometryname: str, removeFromAllGroups: bool = True) -> bool:
        """Remove the shapes of a name.

        Args:
            geometryname: The name.
            removeFromAllGroups: Whether to remove them from all groups, too.

        Returns:
            Whether there was one.
        """

        def without(geometries: tuple[scene.Geometry, ...]) -> tuple[scene.Geometry, ...]:
            return tuple(one for one in geometries if one.name != geometryname)

        kept = without(self._scene.geometries)
        removed = kept != self._scene.geometries
        if removed:
            self._set_geometries(kept)
        if removeFromAllGroups:
            self._set_groups({name: without(group) for name, group in self._scene.groups})
        return removed

    def SetGroupGeometries(self, name: str, geometryinfos: Sequence[GeometryInfo]) -> None:
        """Keep a set of shapes under a name, for ``SetGeometriesFromGroup``.

        Args:
            name: The name of the group.
            geometryinfos: The descriptions of the shapes.
        """
        self._set_groups(dict(self._scene.groups) | {str(name): geometries_of(geometryinfos)})

    def GetGroupNumGeometries(self, name: str) -> int:
        """Return the number of shapes in a group, or -1 where there is no such group.

        Args:
            name: Name of the set.
        """
        groups = dict(self._scene.groups)
        return len(groups[name]) if name in groups else -1

    def GetGeometriesFromGroup(self, name: str) -> list[Geometry]:
        """Return the shapes of a group.

        Args:
            name: Name of the set.

        Raises:
            openrave_exception: there is no such group.
        """
        return [Geometry(self, self._state, self._index, index, name) for index in range(len(self._group(name)))]

    GetGroupGeometries = GetGeometriesFromGroup

    def SetGeometriesFromGroup(self, name: str) -> None:
        """Give the link the shapes of a group in place of its own.

        Args:
            name: Name of the set.

        Raises:
            openrave_exception: there is no such group. Nothing has changed then.
        """
        self._set_geometries(self._group(name))

    def _group(self, name: str) -> tuple[scene.Geometry, ...]:
        groups = dict(self._scene.groups)
        if name not in groups:
            known = ", ".join(groups) or "none"
            raise ArgumentError(f"link '{self._scene.name}' has no group of geometries '{name}'; it has {known}")
        return groups[name]

    def _set_groups(self, groups: dict[str, tuple[scene.Geometry, ...]]) -> None:
        with self._state.simulation.lock:
            self._state.edit_link(self._index, groups=tuple(groups.items()))

    def _set_geometries(self, geometries: Sequence[scene.Geometry]) -> None:
        with self._state.simulation.lock:
            self._state.set_geometries(self._index, geometries)

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

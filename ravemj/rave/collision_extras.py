"""What collision checkers answer about shapes that are no bodies, and what OpenRAVE's checkers prepare."""

from abc import abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_transform
from ravemj.core.transforms import Floats, Pose, pose_of
from ravemj.geometry_functions import AABB
from ravemj.model import scene
from ravemj.model.shape_bodies import named_body, shape_geometry
from ravemj.rave.geometry_groups import GeometryGroups, has_group
from ravemj.rave.interface import Interface
from ravemj.rave.trimesh import TriMesh, checked_mesh

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody
    from ravemj.rave.report import CollisionReport


class CheckerExtras(Interface):
    """Boxes and meshes against bodies; each such query takes the shape into the world and out again."""

    groups: GeometryGroups

    @abstractmethod
    def CheckCollision(self, *arguments: object, report: "CollisionReport | None" = None, **named: object) -> bool:
        """Return whether things touch."""

    def CheckCollisionOBB(
        self,
        aabb: AABB,
        pose: ArrayLike,
        *arguments: "Sequence[KinBody] | CollisionReport | None",
        bodiesincluded: "Sequence[KinBody] | None" = None,
        report: "CollisionReport | None" = None,
    ) -> bool:
        """Return whether a box touches bodies: ``(aabb, pose[, bodiesincluded][, report])``.

        Args:
            aabb: The box, in its own frame.
            pose: ``T_world_box``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz].
            arguments: The others by their places.
            bodiesincluded: The bodies; left out: all.
            report: Filled with what is found; the first names in it are those of a body ``box``.
        """
        checked_kind(aabb, AABB, "CheckCollisionOBB: aabb")
        x, y, z = aabb.extents().tolist()
        T_world_box = pose_of(checked_transform(pose, "CheckCollisionOBB: pose"))
        cx, cy, cz = aabb.pos().tolist()
        shape = shape_geometry(scene.Box((x, y, z)), T_world_box @ Pose((cx, cy, cz)), visible=False)
        for argument in arguments:
            if isinstance(argument, list | tuple):
                bodiesincluded = argument
            else:
                report = argument or report  # pyright: ignore[reportAssignmentType] - a report is no list
        return self._collides(shape, bodiesincluded, report)

    def CheckCollisionTriMesh(
        self,
        trimesh: TriMesh,
        *arguments: "KinBody | CollisionReport | None",
        body: "KinBody | None" = None,
        report: "CollisionReport | None" = None,
    ) -> bool:
        """Return whether triangles touch bodies: ``(trimesh[, body][, report])``.

        Args:
            trimesh: The triangles, in the world [m].
            arguments: The others by their places.
            body: The only body that counts; left out: all.
            report: Filled with what is found; the first names in it are those of a body ``box``.
        """
        mesh = checked_mesh(trimesh, "CheckCollisionTriMesh: trimesh")
        given: list[Any] = [one for one in arguments if one is not None]
        if given and hasattr(given[0], "GetLinks"):
            body = given.pop(0)
        report = given.pop(0) if given else report
        return self._collides(
            shape_geometry(scene.TriMesh(mesh), Pose(), visible=False), None if body is None else [body], report
        )

    def _collides(
        self, shape: scene.Geometry, bodies: "Sequence[KinBody] | None", report: "CollisionReport | None"
    ) -> bool:
        simulation = self._env.simulation
        with simulation.lock:
            state = simulation.create(named_body(simulation.free_name("box"), [shape]))
            simulation.insert(state)
            try:
                probe = self._env.wrap(state)
                if bodies is None:
                    return self.CheckCollision(probe, report=report)
                return any([self.CheckCollision(probe, body, report=report) for body in bodies])
            finally:
                self._env.Remove(self._env.wrap(state))

    def CheckCollisionRays(
        self,
        rays: ArrayLike,
        body: "KinBody | None" = None,
        front_facing_only: bool = False,
        checkPreemptFn: object = None,
    ) -> tuple[NDArray[np.bool_], Floats]:
        """Return which rays hit something, shape (n,), and where, shape (n, 6); see ``env.CheckCollisionRays``.

        Args:
            rays: As there.
            body: As there.
            front_facing_only: As there.
            checkPreemptFn: Not used: the rays are cast at once.
        """
        del checkPreemptFn
        return self._env.CheckCollisionRays(rays, body, front_facing_only)

    def InitKinBody(self, body: "KinBody") -> bool:
        """Return True: ``body`` needs no preparation."""
        del body
        return True

    def RemoveKinBody(self, body: "KinBody") -> None:
        """Do nothing about ``body``; OpenRAVE's checkers free memory here."""

    def SetGeometryGroup(self, groupname: str) -> None:
        """Take a group of geometries in place of those that links have, for all bodies.

        Links without the group keep their geometries, and viewers and physics look at those of all links. A query
        compiles the world anew where shapes have changed since the last one, as it does without groups.

        Args:
            groupname: The group, of ``link.SetGroupGeometries``; empty: the geometries that links have.
        """
        self.groups.choose(checked_kind(groupname, str, "SetGeometryGroup: groupname", "a text"))

    def GetGeometryGroup(self) -> str:
        """Return the group of ``SetGeometryGroup``; empty: the geometries that links have."""
        return self.groups.default

    def SetBodyGeometryGroup(self, body: "KinBody", groupname: str) -> bool:
        """Take a group of geometries for one body; see ``SetGeometryGroup``, which sets it for all of them again.

        Args:
            body: The body.
            groupname: The group; empty: the geometries that links have.

        Returns:
            Whether a link of the body has such a group. If not, nothing changes.
        """
        state = body.simulation_state
        found = has_group(state.scene, checked_kind(groupname, str, "SetBodyGeometryGroup: groupname", "a text"))
        if found:
            self.groups.choose(groupname, state)
        return found

    def GetBodyGeometryGroup(self, body: "KinBody") -> str:
        """Return the group of geometries that is used for ``body``; empty: the geometries that its links have."""
        return self.groups.of(body.simulation_state)

"""Bodies and files as triangles."""

import logging
from collections.abc import Callable
from enum import IntEnum

from ravemj.core.arguments import checked_kind
from ravemj.engine.simulation import BodyState
from ravemj.errors import Source, SourceError
from ravemj.model.scene import KinBody as Description
from ravemj.model.scene import Mesh
from ravemj.rave.env.base import EnvironmentPart
from ravemj.rave.kinbody import KinBody
from ravemj.rave.trimesh import TriMesh, trimesh_of

_LOG = logging.getLogger("ravemj")


class TriangulateOptions(IntEnum):
    """Which bodies ``env.TriangulateScene`` takes."""

    Obstacles = 1
    """All but robots."""
    Robots = 2
    Everything = 3
    Body = 4
    """The one of the given name."""
    AllExceptBody = 5
    """All but the one of the given name."""


class Meshing(EnvironmentPart):
    """Gives triangles, whether they are visible and enabled or not."""

    TriangulateOptions = TriangulateOptions

    def Triangulate(self, body: KinBody) -> TriMesh:
        """Return all shapes of a body as triangles, in the world as the body stands now.

        Args:
            body: The body; what it holds is left out.
        """
        checked_kind(body, KinBody, "Triangulate: body")
        with self._simulation.lock:
            return trimesh_of(_triangles(body.simulation_state))

    def TriangulateScene(self, options: int = TriangulateOptions.Everything, name: str = "") -> TriMesh:
        """Return the shapes of several bodies as triangles, in the world as they stand now.

        Args:
            options: Which bodies, a ``TriangulateOptions``.
            name: The name that ``Body`` and ``AllExceptBody`` mean.
        """
        takes = _CHOICES[TriangulateOptions(options)]
        with self._simulation.lock:
            bodies = [state for state in self._simulation.bodies if takes(state.scene, name)]
            return trimesh_of(Mesh.merged(map(_triangles, bodies)))

    def ReadTrimeshURI(self, filename: str) -> TriMesh | None:
        """Read a mesh file: all its triangles, in metres and in the frame of the file.

        Args:
            filename: The file. It is looked for in the working folder, then in the folders of the environment variable
                ``OPENRAVE_DATA``.

        Returns:
            The triangles, or None, with the reason in the log, where there is no such file or it is broken.
        """
        from ravemj.formats.meshes import read_mesh  # noqa: PLC0415 - slow to import
        from ravemj.formats.readers import find  # noqa: PLC0415

        path = find(filename)
        try:
            if path is None:
                raise SourceError("there is no such file", Source(filename), "check the path, or set OPENRAVE_DATA")
            parts = read_mesh(path)
        except SourceError as error:
            _LOG.error("%s", error)
            return None
        return trimesh_of(Mesh.merged(part.mesh for part in parts))

    ReadTrimeshFile = ReadTrimeshURI


_CHOICES: dict[TriangulateOptions, Callable[[Description, str], bool]] = {
    TriangulateOptions.Obstacles: lambda body, name: not body.is_robot,
    TriangulateOptions.Robots: lambda body, name: body.is_robot,
    TriangulateOptions.Everything: lambda body, name: True,
    TriangulateOptions.Body: lambda body, name: body.name == name,
    TriangulateOptions.AllExceptBody: lambda body, name: body.name != name,
}


def _triangles(state: BodyState) -> Mesh:
    transforms = state.link_transforms()
    return Mesh.merged(
        geometry.triangulated().moved(transforms[index] @ geometry.T_link_geometry.matrix())
        for index, link in enumerate(state.scene.links)
        for geometry in link.geometries
    )

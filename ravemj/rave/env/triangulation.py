"""Converts the bodies of an environment to triangles."""

from collections.abc import Callable, Iterable

from ravemj.engine.simulation import BodyState
from ravemj.model.bounds import links_triangles
from ravemj.model.scene import KinBody, Mesh
from ravemj.rave.enums import TriangulateOptions
from ravemj.rave.trimesh import TriMesh, trimesh_of

_CHOICES: dict[TriangulateOptions, Callable[[KinBody, str], bool]] = {
    TriangulateOptions.Obstacles: lambda body, name: not body.is_robot,
    TriangulateOptions.Robots: lambda body, name: body.is_robot,
    TriangulateOptions.Everything: lambda body, name: True,
    TriangulateOptions.Body: lambda body, name: body.name == name,
    TriangulateOptions.AllExceptBody: lambda body, name: body.name != name,
}


def chosen(bodies: Iterable[BodyState], options: TriangulateOptions, name: str) -> list[BodyState]:
    """Return the bodies that options select.

    Args:
        bodies: All bodies.
        options: The options.
        name: The name of the body, for ``Body`` and ``AllExceptBody``.
    """
    takes = _CHOICES[options]
    return [state for state in bodies if takes(state.scene, name)]


def triangles(bodies: Iterable[BodyState]) -> TriMesh:
    """Return the triangles of all geometries of bodies, in the world."""
    parts = [links_triangles(body.scene.links, body.link_transforms()) for body in bodies]
    return trimesh_of(Mesh.merged(parts))

"""Approximate convex decomposition of meshes, with CoACD."""

import importlib
from typing import Any

import numpy as np

from ravemj.errors import RavemjError
from ravemj.formats.meshes import cache
from ravemj.formats.meshes.hulls import collision_form
from ravemj.formats.meshes.parts import MeshPart, corners_of, weld
from ravemj.model.scene import Mesh

_SETTINGS = {"resolution": 500, "mcts_iterations": 40, "seed": 0}  # seconds a mesh, not minutes


def decompose(mesh: Mesh, threshold: float = 0.15, max_pieces: int = 8) -> tuple[Mesh, ...]:
    """Decompose a mesh into convex pieces, so that for instance a mug stays hollow.

    This takes seconds; the result is cached. Walls of a mesh that is not closed may be lost.

    Args:
        mesh: The mesh.
        threshold: Maximum concavity of a piece, from 0.01 (fine) to 1 (coarse).
        max_pieces: Maximum number of pieces.

    Returns:
        The pieces; the mesh itself if it has no volume.

    Raises:
        RavemjError: CoACD is not installed or refuses the mesh.
    """
    if collision_form(mesh) != "hull":
        return (mesh,)

    def read() -> tuple[MeshPart, ...]:
        return tuple(MeshPart(piece) for piece in _pieces(mesh, threshold, max_pieces))

    settings = f"coacd {threshold!r} {max_pieces} {_SETTINGS}"
    return tuple(part.mesh for part in cache.cached(mesh.digest.encode(), settings, read))


def _pieces(mesh: Mesh, threshold: float, max_pieces: int) -> list[Mesh]:
    try:
        coacd: Any = importlib.import_module("coacd")
    except ImportError as error:
        raise RavemjError('cutting meshes needs CoACD: pip install "ravemj[decompose]"') from error
    coacd.set_log_level("error")
    try:
        pieces = coacd.run_coacd(
            coacd.Mesh(mesh.vertices, mesh.triangles), threshold=threshold, max_convex_hull=max_pieces, **_SETTINGS
        )
    except Exception as error:  # its C++ exceptions
        raise RavemjError(f"CoACD cannot cut the mesh: {error}") from error
    meshes = (Mesh(np.asarray(vertices), np.asarray(triangles)) for vertices, triangles in pieces)
    return [weld(corners_of(piece)) for piece in meshes]

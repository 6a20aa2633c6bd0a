"""``openravepy.convexdecompositionpy``: convex parts of triangles; ravemj gives none to scripts."""

from typing import NoReturn

from ravemj.errors import UnsupportedError


def computeConvexDecomposition(*arguments: object, **named: object) -> NoReturn:
    """Refuse to return convex parts.

    Raises:
        UnsupportedError: always; ``ravemj convert`` writes models with convex parts.
    """
    raise UnsupportedError("computeConvexDecomposition", "convex parts for scripts")

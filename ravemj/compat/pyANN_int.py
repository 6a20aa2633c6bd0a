"""``openravepy.pyANN_int``: nearest-neighbour searches with the interface of the library ANN.

Distances are squared, and exact for any ``eps``.
"""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import also_named
from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats, Ints
from ravemj.errors import ArgumentError

_CHUNK = 4_000_000
"""Maximum number of distances that are computed at once, to limit memory."""

_NONE = -1
"""Index that means no point."""


class KDTree(ApiObject):
    """Set of points with nearest-neighbour searches.

    Args:
        n: The points, shape (n, d); or, as in ANN, a number of points, which are then all at the origin.
        dd: The dimension, if ``n`` is a number.
        bs: Not used.
    """

    def __init__(self, n: "ArrayLike" = 0, dd: int = 0, bs: int = 1) -> None:
        del bs
        self._points = np.zeros((int(np.asarray(n)), dd)) if np.ndim(n) == 0 else checked_numbers(n, "KDTree: n")
        if self._points.ndim != 2:
            raise ArgumentError(f"KDTree: n has shape {self._points.shape}, and should have shape (n, d)")

    def __len__(self) -> int:
        return len(self._points)

    def dim(self) -> int:
        """Return the dimension of the points."""
        return self._points.shape[1]

    def kSearch(self, q: ArrayLike, k: int, eps: float = 0.0) -> tuple[Ints, Floats]:
        """Return the indices of the k nearest points, and their squared distances, shape (k,) each."""
        indices, distances = self.kSearchArray(np.asarray(q)[None], k, eps)
        return indices[0], distances[0]

    kPriSearch = kSearch

    @also_named(q="qarray")
    def kSearchArray(self, qarray: ArrayLike, k: int, eps: float = 0.0) -> tuple[Ints, Floats]:
        """Return ``kSearch`` of each of many points: indices and squared distances, shape (m, k) each."""
        del eps
        queries = checked_numbers(qarray, "kSearchArray: qarray")
        if queries.ndim != 2 or queries.shape[1] != self.dim():
            raise ArgumentError(f"KDTree: queries have shape {queries.shape}, and should have shape (m, {self.dim()})")
        if not 0 < k <= len(self):
            raise ArgumentError(f"KDTree: k is {k}, and should be from 1 to {len(self)}")
        step = max(1, _CHUNK // max(1, self._points.size))
        parts = [self._nearest(queries[first : first + step], k) for first in range(0, len(queries), step)]
        if not parts:
            return np.zeros((0, k), dtype=np.int_), np.zeros((0, k))
        return np.concatenate([neighbors for neighbors, _ in parts]), np.concatenate(
            [neighbors for _, neighbors in parts]
        )

    kPriSearchArray = kSearchArray

    def _nearest(self, queries: Floats, k: int) -> tuple[Ints, Floats]:
        squared = ((queries[:, None] - self._points) ** 2).sum(axis=2)
        order = np.argsort(squared, axis=1, kind="stable")[:, :k]
        return order, np.take_along_axis(squared, order, axis=1)

    def kFRSearch(self, q: ArrayLike, sqrad: float, k: int, eps: float = 0.0) -> tuple[Ints, Floats, int]:
        """Return the k nearest points within a squared radius, and the number of points within it.

        Returns:
            Indices and squared distances as of ``kSearch``, padded with -1 and infinity; and the number.
        """
        indices, distances, counts = self.kFRSearchArray(np.asarray(q)[None], sqrad, k, eps)
        return indices[0], distances[0], int(counts[0])

    def kFRSearchArray(self, qarray: ArrayLike, sqrad: float, k: int, eps: float = 0.0) -> tuple[Ints, Floats, Ints]:
        """Return ``kFRSearch`` of each of many points: shapes (m, k), (m, k), (m,)."""
        indices, distances = self.kSearchArray(qarray, len(self), eps)
        inside = distances <= sqrad
        counts = inside.sum(axis=1)
        indices, distances = np.where(inside, indices, _NONE)[:, :k], np.where(inside, distances, np.inf)[:, :k]
        missing = ((0, 0), (0, max(0, k - len(self))))
        return (
            np.pad(indices, missing, constant_values=_NONE),
            np.pad(distances, missing, constant_values=np.inf),
            counts,
        )


def max_pts_visit(maxPts: int) -> None:
    """Do nothing: searches are exact."""

"""Uniformly spread rotations, directions and points."""

import math

import numpy as np
from numpy.typing import ArrayLike

from ravemj.compat.refusal import refusing
from ravemj.core.arrays import checked_numbers, checked_vector
from ravemj.core.transforms import Floats


class SpaceSamplerExtra:
    """Deterministic samples that cover a space uniformly."""

    def sampleS2(self, level: int = 0, angledelta: float | None = None) -> Floats:
        """Return directions.

        Args:
            level: Level of refinement; there are 12 * 4^level directions.
            angledelta: Angle between neighbours [rad], in place of a level.

        Returns:
            Unit vectors, shape (N, 3).
        """
        count = 12 * 4**level if angledelta is None else math.ceil(4 * math.pi / angledelta**2)
        index = np.arange(count) + 0.5
        z = 1 - 2 * index / count
        angle = index * math.pi * (1 + 5**0.5)
        radius = np.sqrt(1 - z**2)
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), z])

    def sampleSO3(self, level: int = 0, quatdelta: float | None = None) -> Floats:
        """Return rotations.

        Args:
            level: Level of refinement; there are 72 * 8^level rotations.
            quatdelta: Angle between neighbours [rad], in place of a level.

        Returns:
            Unit quaternions [w, x, y, z], shape (N, 4).
        """
        angle = 2 * math.pi / (6 * 2**level) if quatdelta is None else quatdelta
        directions = self.sampleS2(level) if quatdelta is None else self.sampleS2(angledelta=quatdelta)
        turns = np.arange(0, 2 * math.pi - 1e-9, angle)
        polar, azimuth = np.arccos(directions[:, 2]), np.arctan2(directions[:, 1], directions[:, 0])
        repeated = [np.repeat(angles, len(turns)) for angles in (polar, azimuth)]
        return self.hopf2quat(np.column_stack([*repeated, np.tile(turns, len(polar))]))

    @staticmethod
    def hopf2quat(hopfarray: ArrayLike) -> Floats:
        """Convert Hopf coordinates to rotations; each brings a direction to x, then turns about x.

        Args:
            hopfarray: For each rotation, the direction's angle to x, its azimuth about x (0: towards z, pi / 2: towards
                -y), and the turn about x [rad], shape (N, 3).

        Returns:
            Unit quaternions [w, x, y, z], shape (N, 4).
        """
        polar, azimuth, turn = checked_numbers(hopfarray, "hopf2quat: hopfarray").reshape(-1, 3).T
        cosine, sine = np.cos(polar / 2), np.sin(polar / 2)
        return np.column_stack(
            [
                cosine * np.cos(turn / 2),
                cosine * np.sin(turn / 2),
                sine * np.cos(azimuth + turn / 2),
                sine * np.sin(azimuth + turn / 2),
            ]
        )

    @staticmethod
    def computeSepration(qarray: ArrayLike) -> Floats:
        """Return the distance of each rotation to its nearest neighbour.

        Args:
            qarray: Unit quaternions [w, x, y, z], shape (N, 4).

        Returns:
            Angles between quaternions [rad], half of those between the rotations, shape (N,).
        """
        rotations = checked_numbers(qarray, "computeSepration: qarray").reshape(-1, 4)
        cosines = np.abs(rotations @ rotations.T)
        np.fill_diagonal(cosines, 0)
        return np.arccos(np.minimum(cosines.max(axis=1, initial=0), 1))

    computeFaceIndices = refusing(  # directions are on a spiral
        "SpaceSamplerExtra.computeFaceIndices", "HEALPix's grid of directions", "self N"
    )

    def sampleR3lattice(self, averagedist: float, boxdims: ArrayLike) -> Floats:
        """Return points of a grid.

        Args:
            averagedist: Distance of neighbours [m].
            boxdims: Lengths of the box that they fill, from the origin [m], shape (3,).

        Returns:
            Points, shape (N, 3).
        """
        axes = [np.arange(0, length, averagedist) for length in checked_vector(boxdims, 3, "boxdims").tolist()]
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)

    sampleR3 = sampleR3lattice

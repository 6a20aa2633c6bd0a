"""The poses of links as matrices."""

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints


class LinkPoses:
    """Gathers the poses of links from MuJoCo's positions and rotations, as fast as numpy can."""

    def __init__(self, data: mujoco.MjData, body_ids: Ints) -> None:
        self._xpos, self._xmat = data.xpos.reshape(-1), data.xmat.reshape(-1)
        positions, rotations = len(self._xpos), len(self._xmat)
        self._numbers = np.append(np.zeros(positions + rotations), (0.0, 1.0))  # and what the last rows consist of
        self._positions, self._rotations = np.split(self._numbers[:-2], [positions])
        self._places = np.full((len(body_ids), 4, 4), positions + rotations)
        self._places[:, 3, 3] += 1
        self._places[:, :3, 3] = 3 * body_ids[:, None] + np.arange(3)
        self._places[:, :3, :3] = positions + 9 * body_ids[:, None, None] + np.arange(9).reshape(3, 3)

    def matrices(self) -> Floats:
        """Return the poses, shape (links, 4, 4); a copy."""
        self._positions[...], self._rotations[...] = self._xpos, self._xmat
        return self._numbers[self._places]

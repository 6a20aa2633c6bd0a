"""Published state, which viewers show while a script holds the simulation's lock."""

from threading import Lock

import mujoco

from ravemj.core.transforms import Floats


class Published:
    """Copy of the world's state that is readable without the lock of the simulation."""

    def __init__(self) -> None:
        self.number = 0  # number of copies so far
        self.is_wanted = False  # whether a viewer waits for the simulation; otherwise no copies are made
        self._lock = Lock()
        self._model: mujoco.MjModel | None = None
        self._data: mujoco.MjData | None = None

    def put(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Copy a state."""
        with self._lock:
            if self._data is None or self._model is not model:
                self._model, self._data = model, mujoco.MjData(model)
            mujoco.mj_copyData(self._data, model, data)
            self.number += 1

    def copy_to(self, data: mujoco.MjData, model: mujoco.MjModel) -> bool:
        """Copy the state into a viewer's data; return False without a change if it belongs to another model."""
        with self._lock:
            if self._data is None or self._model is not model:
                return False
            mujoco.mj_copyData(data, model, self._data)
            return True

    def poses(self, model: mujoco.MjModel) -> tuple[Floats, Floats] | None:
        """Return positions (B, 3) [m] and quaternions wxyz (B, 4) of the bodies; None if they are of another model."""
        with self._lock:
            if self._data is None or self._model is not model:
                return None
            return self._data.xpos.copy(), self._data.xquat.copy()

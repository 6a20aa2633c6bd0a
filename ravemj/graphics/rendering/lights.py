"""The light on surfaces, for the renderer without OpenGL: the diffuse part of OpenGL's formula."""

import mujoco
import numpy as np

from ravemj.core.transforms import Floats
from ravemj.graphics.rendering.camera import Camera
from ravemj.graphics.rendering.gl_scene import aim


class Lights:
    """The lights of a model as its visualiser sets them up, headlight included."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._scene = mujoco.MjvScene(model, 1)

    def update(self, data: mujoco.MjData, camera: Camera, depths: tuple[float, float]) -> None:
        """Take over where the lights are now; the headlight shines from the camera, which sees these depths [m]."""
        if self._model.nlight:
            mujoco.mj_camlight(self._model, data)
        aim(self._scene, camera, (1, 1), depths)
        mujoco.mjv_makeLights(self._model, data, self._scene)

    def on(self, points: Floats, rays: Floats, normals: Floats) -> Floats:
        """Return the light of three colours that surfaces reflect, (N, 3); 1 shows their own colour.

        They are at points in the world (N, 3) [m] and seen along rays (N, 3); their unit normals (N, 3) are turned
        towards the eye where they look away.
        """
        away = np.einsum("ij,ij->i", normals, rays) > 0
        facing = np.where(away[:, None], -normals, normals)
        total = np.zeros(points.shape)
        for light in self._scene.lights[: self._scene.nlight]:
            if light.type == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL:
                cosine = -(facing @ np.asarray(light.dir, dtype=np.float64))
            else:
                towards = np.asarray(light.pos, dtype=np.float64) - points
                towards /= np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), mujoco.mjMINVAL)
                cosine = np.einsum("ij,ij->i", facing, towards)
            total += light.ambient
            total += np.maximum(cosine, 0)[:, None] * np.asarray(light.diffuse, dtype=np.float64)
        return total

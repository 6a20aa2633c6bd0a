"""The MuJoCo model of all bodies of an environment."""

from collections.abc import Iterable

import mujoco

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Ints
from ravemj.engine.compiled import Compiled, write_inertial
from ravemj.engine.kinematics import NO_QPOS
from ravemj.engine.model_part import ModelPart
from ravemj.engine.simulation.body import BodyState
from ravemj.errors import Diagnostics
from ravemj.model.scene import KinBody, Link, Scene, View


class WorldModel(Compiled):
    """All bodies with their shapes in one model: for collisions, pictures and export.

    Each body is at home in its own model (``BodyState.own_kinematics``). Here is a copy; ``take`` brings it up to date.
    ``stamp`` grows with every change that was taken over, and is 0 before the first ``take``, when links are nowhere
    yet; ``pose_stamp`` grows where more than joint values changed.
    """

    def __init__(self, bodies: Iterable[BodyState], view: View, diagnostics: Diagnostics) -> None:
        """Compile bodies.

        Raises:
            CompileError: MuJoCo refuses the model.
        """
        self.stamp = self.pose_stamp = 0
        bodies = tuple(bodies)
        scene = Scene(tuple(body.scene for body in bodies), view)
        super().__init__(scene, diagnostics)
        self.write_true_inertias(scene)
        self._described = dict(zip(bodies, scene.bodies, strict=True))

    @cached_property
    def _parts(self) -> dict[BodyState, ModelPart]:
        described = zip(self._described, self.mjcf.names, strict=True)
        return {body: ModelPart(self.model, self.data, names) for body, names in described}

    def part(self, body: BodyState) -> ModelPart:
        """Return where a body is in this model."""
        return self._parts[body]

    def take(self, bodies: Iterable[BodyState]) -> None:
        """Take over what changed of some bodies: joint values, poses, masses, colours."""
        for body in bodies:
            part, described = self._parts[body], self._described[body]
            if body.scene is not described:
                self._describe(part, described.links, body.scene.links)
                self._described[body] = body.scene
            if (body.is_compiled or not _is_at_reference(body.scene)) and part.take(body.own_kinematics):
                self.pose_stamp += 1
        self.stamp += 1
        mujoco.mj_kinematics(self.model, self.data)

    def _describe(self, part: ModelPart, before: Iterable[Link], links: Iterable[Link]) -> None:
        """Give links other masses, and geometries other colours; what is drawn in place of one keeps its own."""
        from ravemj.formats.mjcf import rgba  # noqa: PLC0415 - slow to import

        for old, link, body_id, counts in zip(before, links, part.body_ids.tolist(), part.names.geoms, strict=True):
            if link.inertial is not old.inertial:
                write_inertial(self.model, body_id, link.inertial)
            if link.geometries is not old.geometries:
                geom = int(self.model.body_geomadr[body_id])
                for geometry, count in zip(link.geometries, counts, strict=True):
                    if geometry.display is None:
                        self.model.geom_rgba[geom : geom + count] = rgba(geometry.diffuse, geometry.transparency)
                    geom += count

    def qpos_indices(self, body: BodyState) -> Ints:
        """Return where each DOF of a body is in ``qpos``, shape (dof,); -1 where ``BodyKinematics`` has none."""
        kinematics, part = body.own_kinematics, self._parts[body]
        indices = kinematics.qpos_indices.copy()
        for number, index in enumerate(indices.tolist()):
            if index != NO_QPOS:
                indices[number] = part.qpos.start + kinematics.inner_index(index)
        return indices


def _is_at_reference(body: KinBody) -> bool:
    """Return whether the joints of a body are loaded at the values for which MuJoCo compiles the poses."""
    return all(axis.value == axis.reference for joint in body.all_joints for axis in joint.axes)

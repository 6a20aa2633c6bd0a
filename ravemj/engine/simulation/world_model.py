"""MuJoCo model of all bodies of an environment."""

import copy
from collections.abc import Iterable, Mapping

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
    """Model of all bodies with their shapes: for collisions, pictures and export.

    The state of each body is in its own model (``BodyState.own_kinematics``); ``take`` copies it here. ``stamp``
    increases with every copied change, and is 0 before the first ``take``, when poses are undefined; ``pose_stamp``
    increases if more than joint values changed.
    """

    def __init__(
        self,
        bodies: Iterable[BodyState],
        view: View,
        diagnostics: Diagnostics,
        described: Mapping[BodyState, KinBody] | None = None,
    ) -> None:
        """Compile bodies.

        Args:
            bodies: The bodies.
            view: Background and camera.
            diagnostics: Receives the warnings of the translation.
            described: Descriptions that replace those of the bodies and differ only in geometries; later changes of
                colours and masses do not affect them.

        Raises:
            CompileError: MuJoCo refuses the model.
        """
        self.stamp = self.pose_stamp = 0
        bodies = tuple(bodies)
        self._is_own = described is None
        scene = Scene(tuple(body.scene if described is None else described[body] for body in bodies), view)
        super().__init__(scene, diagnostics)
        self.write_true_inertias(scene)
        self._described = dict(zip(bodies, scene.bodies, strict=True))

    @cached_property
    def _parts(self) -> dict[BodyState, ModelPart]:
        described = zip(self._described, self.mjcf.names, strict=True)
        return {body: ModelPart(self.model, self.data, names) for body, names in described}

    @cached_property
    def queried_model(self) -> mujoco.MjModel:
        """A copy for collision queries, which change masks and options. Poses of bodies without joints are outdated."""
        return copy.copy(self.model)

    def description(self, body: BodyState) -> KinBody:
        """Return the description of a body in this model or, if the model does not contain the body, the body's own."""
        return self._described.get(body, body.scene)

    def part(self, body: BodyState) -> ModelPart:
        """Return the part of this model that belongs to a body."""
        return self._parts[body]

    def take(self, bodies: Iterable[BodyState]) -> None:
        """Copy changes of the given bodies: joint values, poses, masses, colours."""
        parts, described = self._parts, self._described
        for body in bodies:
            part, scene = parts[body], body.scene
            if self._is_own and scene is not described[body]:
                self._describe(part, described[body].links, scene.links)
                described[body] = scene
            kinematics = body.known_kinematics
            if kinematics is None and not _is_at_reference(scene):
                kinematics = body.own_kinematics
            if kinematics is not None and part.take(kinematics):
                self.pose_stamp += 1
        self.stamp += 1
        mujoco.mj_kinematics(self.model, self.data)

    def _describe(self, part: ModelPart, before: Iterable[Link], links: Iterable[Link]) -> None:
        """Update masses of links and colours of geometries, except of those with separate display surfaces."""
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
        """Return the index of each DOF of a body in ``qpos``, shape (dof,); -1 if it has none."""
        kinematics, part = body.own_kinematics, self._parts[body]
        indices = kinematics.qpos_indices.copy()
        for number, index in enumerate(indices.tolist()):
            if index != NO_QPOS:
                indices[number] = part.qpos.start + kinematics.inner_index(index)
        return indices


def _is_at_reference(body: KinBody) -> bool:
    """Return whether all joint values of the loaded body are the reference values, for which MuJoCo compiles poses."""
    return all(axis.value == axis.reference for joint in body.all_joints for axis in joint.axes)

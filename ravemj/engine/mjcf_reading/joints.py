"""Conversion of MJCF joints to single-axis or ball joints; several joints of one body become a chain of links."""

from dataclasses import replace

import mujoco

from ravemj.core.transforms import Pose, Vec3, rotate
from ravemj.engine.mjcf_reading.compiling import CompiledModel
from ravemj.engine.mjcf_reading.names import ModelNames
from ravemj.engine.mjcf_reading.numbers import as_written, vector
from ravemj.model.builder import JointBuilder
from ravemj.model.scene import UNLIMITED, Axis
from ravemj.model.scene.mechanism import JointKind

FREE = int(mujoco.mjtJoint.mjJNT_FREE)
BALL = int(mujoco.mjtJoint.mjJNT_BALL)
SLIDE = int(mujoco.mjtJoint.mjJNT_SLIDE)

_UNIT: tuple[Vec3, Vec3, Vec3] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_BALL_LIMIT = 100.0
"""Default limit of spherical joints [rad], as in OpenRAVE's XML."""


class JointReader:
    """Reader of one model's joints; ``torques`` are torque limits of joints [N m or N], 0 if unknown."""

    def __init__(self, compiled: CompiledModel, names: ModelNames, torques: list[float]) -> None:
        self._model = compiled.model
        self.written = {joint.id: joint for joint in compiled.spec.joints}
        self._names = names
        self._torques = torques
        self._document = compiled.document

    def moving(self, index: int, links: tuple[int, int], T_parent_child: Pose, T_parent_body: Pose) -> JointBuilder:
        """Return a moving joint.

        Args:
            index: MuJoCo's number of the joint.
            links: Parent and child.
            T_parent_child: Pose of the child in the parent at the joint's ``ref``.
            T_parent_body: Pose, in the parent, of the MJCF body in whose frame anchor and axis are given.
        """
        model, written = self._model, self.written[index]
        name, kind = self._names.joints[index], int(model.jnt_type[index])
        position = vector(as_written(written.pos, model.jnt_pos[index]))
        kinds: dict[int, JointKind] = {BALL: "spherical", SLIDE: "slider"}
        axes = self._ball(index) if kind == BALL else (self._axis(index, T_parent_body),)
        return JointBuilder(
            name=name,
            kind=kinds.get(kind, "hinge"),
            links=links,
            T_first_second=T_parent_child,
            anchor=T_parent_body.apply(position) if any(position) else T_parent_body.position,
            axes=axes,
            enabled=True,
            source=self._document.source(model.joint(index).name, "joint", "freejoint"),
        )

    def _axis(self, index: int, T_parent_body: Pose) -> Axis:
        model, written = self._model, self.written[index]
        direction = vector(as_written(written.axis, model.jnt_axis[index]))
        reference = float(model.qpos0[model.jnt_qposadr[index]])
        is_limited, slides = bool(model.jnt_limited[index]), int(model.jnt_type[index]) == SLIDE
        lower, upper = model.jnt_range[index].tolist() if is_limited else (-UNLIMITED, UNLIMITED)
        dof = int(model.jnt_dofadr[index])
        return Axis(
            rotate(T_parent_body.wxyz, direction),
            reference=reference,
            lower=lower,
            upper=upper,
            circular=not (is_limited or slides),
            max_torque=self._torques[index],
            armature=float(model.dof_armature[dof]),
            viscous_friction=float(model.dof_damping[dof]),
            coulomb_friction=float(model.dof_frictionloss[dof]),
        )

    def _ball(self, index: int) -> tuple[Axis, ...]:
        dof = int(self._model.jnt_dofadr[index])
        first = Axis(
            _UNIT[0],
            lower=-_BALL_LIMIT,
            upper=_BALL_LIMIT,
            armature=float(self._model.dof_armature[dof]),
            viscous_friction=float(self._model.dof_damping[dof]),
            coulomb_friction=float(self._model.dof_frictionloss[dof]),
        )
        return tuple(replace(first, direction=unit) for unit in _UNIT)

    def fixed(self, body: int, links: tuple[int, int], T_parent_child: Pose) -> JointBuilder:
        """Return the weld between a body without joints and its parent."""
        return JointBuilder(
            name=f"{self._names.bodies[body]}/fixed",
            kind="hinge",
            links=links,
            T_first_second=T_parent_child,
            anchor=T_parent_child.position,
            axes=(Axis((1.0, 0.0, 0.0)),),
            enabled=False,
            source=self._document.source(self._model.body(body).name, "body"),
        )

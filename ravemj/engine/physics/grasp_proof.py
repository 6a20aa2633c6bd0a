"""Proof of a grasp by physics: the fingers press, the hand is lifted and shaken, and the object should not move in it.

MuJoCo simulates the hand and the object as ``ravemj convert`` translates them, without their surroundings. The hand
never rotates, so the simulation is done in its frame: an acceleration ``a`` of the hand acts on the object as the
gravity ``g - a``. The object has no weight until the fingers press.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, inverse, pose_of
from ravemj.engine.compiled import Compiled
from ravemj.engine.simulation import BodyState
from ravemj.engine.snapshot import snapshot
from ravemj.errors import Diagnostics
from ravemj.formats.mjcf import BodyNames, Mjcf, Options
from ravemj.model import chains
from ravemj.model.scene import KinBody, Manipulator, Scene

FORCE = 10.0
"""Force or torque of a finger [N or N m] if the model has no limit."""

LIFT, SHAKE = 0.1, 5.0
"""Height to which the hand is lifted [m], and amplitude of its acceleration along each axis afterwards [m/s^2]."""

MOST_MOVED, MOST_TURNED = 0.005, np.radians(5.0)
"""Maximum translation [m] and rotation [rad] in the hand with which an object counts as held."""

_PRESSING, _LIFTING, _SHAKING = 0.5, 0.5, 1.0  # s; the last for each axis
_TIMESTEP = 0.001  # s
_CLOSING_SPEED = {False: 1.0, True: 0.1}  # rad/s, and m/s of sliders
_PATTERN = np.array([1.0, -1.0, -1.0, 1.0])  # accelerations of a shake; velocity and position end where they began
_STIFFER = 10.0  # friction against normal contact: MuJoCo's contacts creep otherwise


@dataclass(frozen=True)
class Proof:
    """Result of a simulated lift and shake.

    Attributes:
        held: Whether the object moved in the hand by less than 5 mm and 5 degrees.
        moved: Largest translation of the object's centre of mass in the hand [m].
        turned: Largest rotation in the hand [rad].
        seconds: Time until the object was lost [s], at most 3.5: a lift of 0.5 s, and a shake of 1 s along each axis.
        mass: Mass of the object [kg].
        friction: Friction coefficient of hand and object.
        forces: Force or torque of each gripper joint [N or N m].
    """

    held: bool
    moved: float
    turned: float
    seconds: float
    mass: float
    friction: float
    forces: tuple[float, ...]

    def __str__(self) -> str:
        """Return the result with mass, friction and forces."""
        how = "held" if self.held else f"lost after {self.seconds:.2f} s"
        forces = ", ".join(f"{force:g}" for force in self.forces)
        motion = f"moved by {1e3 * self.moved:.2g} mm and {np.degrees(self.turned):.2g} degrees"
        return f"{how}: {motion}; {self.mass:.3g} kg, friction {self.friction:g}, fingers press with {forces} N or N m"


def prove(robot: BodyState, arm: Manipulator, target: BodyState, friction: float, gravity: Floats) -> Proof:
    """Simulate a hand that presses with its largest forces, lifts the object, and is shaken.

    Args:
        robot: The robot, in the configuration of the closed grasp. The caller holds the lock.
        arm: Its manipulator.
        target: The object at its pose in the grasp. It may be static in the model.
        friction: Friction coefficient of hand and object.
        gravity: Gravity in the world [m/s^2], shape (3,).
    """
    return _Experiment(robot, arm, target, friction).run(gravity)


class _Experiment:
    """Model of a hand that is fixed to the world, and of an object.

    The joints of the arm are removed, so the hand has its pose at joint values of 0. Object and gravity are transformed
    accordingly.
    """

    def __init__(self, robot: BodyState, arm: Manipulator, target: BodyState, friction: float) -> None:
        self._robot, self._arm, self._friction = snapshot(robot), arm, friction
        self._hand = set(chains.links_beyond(self._robot, arm))
        axes = self._robot.dof_axes
        self._forces = {dof: axes[dof].max_torque or FORCE for dof in arm.gripper_dofs}
        scene = Scene((_fixed(self._robot), _free(snapshot(target))))
        compiled = Compiled(scene, Diagnostics(), Options(free_bases=True, self_collision=False), self._edit)
        self._model, (hand_names, object_names) = compiled.model, compiled.mjcf.names
        self._data = mujoco.MjData(self._model)
        self._copy_values(robot, hand_names)
        self._copy_values(target, object_names)
        self._object = self._model.body(object_names.links[0]).id
        self._prepare_contacts(hand_names)
        self._place(robot, target, hand_names)
        self._pressed = self._pressing_forces(hand_names)

    def _edit(self, spec: mujoco.MjSpec, written: Mjcf) -> None:
        """Remove the joints of the arm, damp the closing joints, and lock the other joints of the hand."""
        signs = dict(zip(self._arm.gripper_dofs, self._arm.chucking_direction, strict=True))
        removed: set[str] = set()
        dof = 0
        for joint, names in zip(self._robot.all_joints, written.names[0].joints, strict=True):
            if not {joint.parent, joint.child} <= self._hand:
                removed.update(names)
            elif joint.mimic is None and len(names) == 1 and dof < len(self._robot.dof_axes):
                if signs.get(dof):
                    spec.joint(names[0]).damping[0] = self._forces[dof] / _CLOSING_SPEED[joint.slides()]
                else:
                    lock = spec.add_equality(type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT)
                    lock.name1, lock.data[:5] = names[0], [joint.axes[0].value, 0, 0, 0, 0]
            dof += len(joint.axes)
        for equality in spec.equalities:
            if {equality.name1, equality.name2} & removed:
                spec.delete(equality)
        for name in removed:
            spec.delete(spec.joint(name))
        option = spec.option
        option.timestep, option.impratio = _TIMESTEP, _STIFFER
        option.cone, option.integrator = mujoco.mjtCone.mjCONE_ELLIPTIC, mujoco.mjtIntegrator.mjINT_IMPLICITFAST

    def _copy_values(self, state: BodyState, names: BodyNames) -> None:
        kinematics = state.kinematics
        for places, joint_names in zip(kinematics.joint_qpos, names.joints, strict=True):
            for place, name in zip(places, joint_names, strict=True):
                joint = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_JOINT, name)
                if joint >= 0:
                    self._data.qpos[self._model.jnt_qposadr[joint]] = kinematics.qpos[place]

    def _prepare_contacts(self, names: BodyNames) -> None:
        """Set the friction of all geoms, and disable contacts of other links than the hand's."""
        model = self._model
        model.geom_friction[:, 0] = self._friction
        links = {model.body(name).id for index, name in enumerate(names.links) if index not in self._hand}
        apart = np.isin(model.geom_bodyid, sorted(links))
        model.geom_contype[apart] = model.geom_conaffinity[apart] = 0

    def _place(self, robot: BodyState, target: BodyState, names: BodyNames) -> None:
        assert self._arm.effector is not None
        model, data = self._model, self._data
        mujoco.mj_kinematics(model, data)
        effector = model.body(names.links[self._arm.effector]).id
        T_model_effector = np.eye(4)
        T_model_effector[:3, :3] = data.xmat[effector].reshape(3, 3)
        T_model_effector[:3, 3] = data.xpos[effector]
        self._T_model_world = T_model_effector @ inverse(robot.link_transform(self._arm.effector))
        pose = pose_of(self._T_model_world @ target.link_transform(0))
        place = model.jnt_qposadr[model.body_jntadr[self._object]]
        data.qpos[place : place + 7] = [*pose.position, *pose.wxyz]

    def _pressing_forces(self, names: BodyNames) -> Floats:
        """Return the closing forces of the fingers as ``qfrc_applied``."""
        forces, dof = np.zeros(self._model.nv), 0
        signs = dict(zip(self._arm.gripper_dofs, self._arm.chucking_direction, strict=True))
        for joint, joint_names in zip(self._robot.joints, names.joints, strict=False):
            if joint_names and dof in signs:
                row = self._model.joint(joint_names[0]).dofadr[0]
                forces[row] = signs[dof] * self._forces[dof]
            dof += len(joint.axes)
        return forces

    def run(self, gravity: Floats) -> Proof:
        """Press with the fingers, then lift and shake the object; stop early if it moves too far in the hand."""
        model, data = self._model, self._data
        rotation = self._T_model_world[:3, :3]
        model.opt.gravity[:] = 0.0
        data.qfrc_applied[:] = self._pressed
        mujoco.mj_step(model, data, round(_PRESSING / _TIMESTEP))
        start, R_start = data.xipos[self._object].copy(), data.xmat[self._object].reshape(3, 3).copy()
        moved, turned, steps = 0.0, 0.0, 0
        for acceleration in _accelerations(gravity):
            model.opt.gravity[:] = rotation @ (gravity - acceleration)
            mujoco.mj_step(model, data)
            moved = max(moved, float(np.linalg.norm(data.xipos[self._object] - start)))
            cosine = (np.trace(R_start.T @ data.xmat[self._object].reshape(3, 3)) - 1) / 2
            turned = max(turned, float(np.arccos(np.clip(cosine, -1, 1))))
            if moved >= MOST_MOVED or turned >= MOST_TURNED or not np.isfinite(data.qpos).all():
                break
            steps += 1
        held = steps == round((_LIFTING + 3 * _SHAKING) / _TIMESTEP)
        mass = float(model.body_subtreemass[self._object])
        return Proof(held, moved, turned, steps * _TIMESTEP, mass, self._friction, tuple(self._forces.values()))


def _accelerations(gravity: Floats) -> Iterator[Floats]:
    """Yield the acceleration of the hand in the world at each time step, shape (3,): up, then back and forth.

    Up is the direction opposite to ``gravity``.
    """
    length = float(np.linalg.norm(gravity))
    up = -gravity / length if length else np.array([0.0, 0.0, 1.0])
    count = round(_LIFTING / _TIMESTEP)
    for step in range(count):
        yield up * (4 * LIFT / _LIFTING**2) * (1 if step < count / 2 else -1)
    count = round(_SHAKING / _TIMESTEP)
    for axis in np.eye(3):
        for step in range(count):
            yield axis * SHAKE * _PATTERN[step * len(_PATTERN) // count]


def _fixed(robot: KinBody) -> KinBody:
    """Return a robot with a fixed base and without grabbed bodies."""
    return replace(robot, grabs=(), links=(replace(robot.links[0], static=True), *robot.links[1:]))


def _free(body: KinBody) -> KinBody:
    """Return a body with all links marked as not static."""
    return replace(body, links=tuple(replace(link, static=False) for link in body.links))

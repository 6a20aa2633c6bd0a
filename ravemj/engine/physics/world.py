"""MuJoCo's dynamics for the bodies of a simulation.

In the simulation's own model, the poses of bodies are prescribed. This second model has free bodies, unless they have a
static link. Its state is copied from the simulation before each step and back afterwards, so it can be recompiled
whenever bodies are added, removed or changed.
"""

import itertools
import logging
import math
from collections.abc import Iterable

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, wxyz_from_rows
from ravemj.engine.collision.queries import tested_pairs
from ravemj.engine.model_part import ModelPart
from ravemj.engine.physics.body import PhysicalBody
from ravemj.engine.physics.loads import Loads, Spring
from ravemj.engine.simulation import BodyState, Compiled, Simulation
from ravemj.errors import Diagnostics
from ravemj.formats.mjcf import Mjcf, Options
from ravemj.model.scene import Scene

_LOG = logging.getLogger("ravemj")

LONGEST_STEP = 0.002
"""Maximum internal time step [s]; longer steps are divided."""


class Physics:
    """Dynamics of a simulation's bodies: masses, forces, joints and contacts."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self.self_collisions = True  # collisions between links of one body
        self.spring: Spring | None = None  # spring of interactive dragging
        self._loads: dict[BodyState, Loads] = {}
        self._bodies: dict[BodyState, PhysicalBody] = {}
        self._made_of: list[object] = []
        self._model = mujoco.MjModel.from_xml_string("<mujoco/>")
        self._data = mujoco.MjData(self._model)

    def loads(self, state: BodyState) -> Loads:
        """Return the mutable loads on a body for the next step."""
        if state not in self._loads:
            self._loads[state] = Loads(state)
        return self._loads[state]

    def step(self, timestep: float) -> None:
        """Advance the dynamics by a time [s], and copy poses and velocities to the simulated bodies."""
        self.prepare()
        model, data = self._model, self._data
        count = math.ceil(timestep / LONGEST_STEP)
        if not count:
            return
        model.opt.timestep = timestep / count
        before = data.qpos.copy()
        data.qfrc_applied[:], data.xfrc_applied[:] = 0.0, 0.0
        for state, loads in self._loads.items():
            if state in self._bodies:
                loads.apply(self._bodies[state])
        applied, pushed = data.qfrc_applied.copy(), data.xfrc_applied.copy()
        spring = self.spring
        pulled = None if spring is None else self._bodies.get(spring.state)
        for _ in range(count):
            if spring is not None and pulled is not None:
                spring.act(pulled, pushed)
            self._drive(applied)
            mujoco.mj_step(model, data)
        if not (np.isfinite(data.qpos).all() and np.isfinite(data.qvel).all()):
            _LOG.error("physics got unstable and starts again at rest; very light links or strong forces do that")
            mujoco.mj_resetData(model, data)
            data.qpos[:] = before
        self._loads = {state: loads.next() for state, loads in self._loads.items() if loads.motor is not None}
        self._give_back()

    def _drive(self, applied: Floats) -> None:
        """Apply the joint forces ``applied`` and the motors' forces in the next time step."""
        driven = [state for state, loads in self._loads.items() if loads.motor is not None and state in self._bodies]
        if driven:
            self._data.qfrc_applied[:] = applied
            mujoco.mj_forward(self._model, self._data)
            for state in driven:
                self._loads[state].drive(self._bodies[state], applied)

    def prepare(self) -> None:
        """Recompile the model if the set of bodies changed; copy gravity and user-set poses."""
        states = self._simulation.bodies
        parts = (part for state in states for part in (state, state.scene, state.rest_poses, *state.grabs))
        made_of: list[object] = [self.self_collisions, *parts]
        if len(made_of) != len(self._made_of) or any(a is not b for a, b in zip(made_of, self._made_of, strict=True)):
            self._make(states)
            self._made_of = made_of
        self._model.opt.gravity[:] = self._simulation.gravity
        for body in self._bodies.values():
            body.take_over()

    def _make(self, states: tuple[BodyState, ...]) -> None:
        scene = Scene(tuple(state.scene for state in states), None)
        compiled = Compiled(scene, Diagnostics(), Options(free_bases=True, excludes=False), self._add_grabs)
        self._model, self._data = compiled.model, compiled.data
        self._model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
        self._model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
        self._bodies = {
            state: PhysicalBody(state, self._model, self._data, ModelPart(self._model, self._data, names))
            for state, names in zip(states, compiled.mjcf.names, strict=True)
        }

    def _add_grabs(self, spec: mujoco.MjSpec, written: Mjcf) -> None:
        """Weld grabbed bodies to the links that grab them, and exclude their ignored collisions."""
        names = dict(zip(self._simulation.bodies, written.names, strict=True))
        for state, own in names.items():
            for grab in state.grabs:
                held = names[grab.body]
                if not any(link.static for link in grab.body.scene.links):
                    pose = [*grab.T_link_body[:3, 3], *wxyz_from_rows(grab.T_link_body[:3, :3].tolist())]
                    weld = spec.add_equality(type=mujoco.mjtEq.mjEQ_WELD, objtype=mujoco.mjtObj.mjOBJ_BODY)
                    weld.name1, weld.name2 = own.links[grab.link], held.links[0]
                    weld.data[:11] = [0, 0, 0, *pose, 1]
                for link in {grab.link, *grab.ignored}:
                    for name in held.links:
                        spec.add_exclude(bodyname1=own.links[link], bodyname2=name)
            for first, second in self._untested_pairs(state):
                spec.add_exclude(bodyname1=own.links[first], bodyname2=own.links[second])

    def _untested_pairs(self, state: BodyState) -> set[tuple[int, int]]:
        """Return the pairs of link indices of a body that are not tested for self-collisions."""
        pairs = set(itertools.combinations(range(len(state.scene.links)), 2))
        return pairs.difference(tested_pairs(self._simulation.collisions(), state)) if self.self_collisions else pairs

    def joint_wrench(self, state: BodyState, child: int, anchor: Floats) -> tuple[Floats, Floats]:
        """Return the force on a link from its parent [N], and the torque about ``anchor`` [N m], in world axes."""
        body_id = self._body_id(state, child)
        if body_id is None:
            return np.zeros(3), np.zeros(3)
        return self._wrench(body_id, self._data.cfrc_int[body_id], anchor)

    def link_wrench(self, state: BodyState, link: int) -> tuple[Floats, Floats]:
        """Return force [N] and torque about its centre of mass [N m] of joints and contacts on a link."""
        body_id = self._body_id(state, link)
        if body_id is None:
            return np.zeros(3), np.zeros(3)
        children = np.flatnonzero(self._model.body_parentid == body_id)
        data = self._data
        total = data.cfrc_int[body_id] + data.cfrc_ext[body_id] - data.cfrc_int[children].sum(axis=0)
        force, torque = self._wrench(body_id, total, data.xipos[body_id])
        applied = data.xfrc_applied[body_id]
        return force - applied[:3], torque - applied[3:]

    def link_acceleration(self, state: BodyState, link: int) -> tuple[Floats, Floats]:
        """Return the acceleration of a link's origin minus gravity, and its angular acceleration.

        The first is the reading of an accelerometer [m/s^2], upwards at rest; the second is in rad/s^2. Both are of
        shape (3,), in world axes; zero before the first step.
        """
        body_id, acceleration = self._body_id(state, link), np.zeros(6)
        if body_id is not None:
            kind = mujoco.mjtObj.mjOBJ_XBODY
            mujoco.mj_objectAcceleration(self._model, self._data, kind, body_id, acceleration, 0)
        return acceleration[3:], acceleration[:3]

    def link_contacts(self, state: BodyState, link: int) -> tuple[Floats, Floats]:
        """Return the contact points of a link [m] and the forces on it there [N], each (n, 3), in the world."""
        body_id = self._body_id(state, link)
        touches = [] if body_id is None else self._touches()
        felt = [touch for touch in touches if body_id in touch[0]]
        return _columns((point, push if sides[1] == body_id else -push) for sides, point, push in felt)

    def contacts(self) -> tuple[Floats, Floats]:
        """Return the points of all contacts of the last step [m], and the force at each [N], each (n, 3), in the world.

        The force acts on the movable body, or on one of two movable bodies.
        """
        touches, fixed = self._touches(), self._model.body_weldid == 0
        return _columns((point, -push if fixed[sides[1]] else push) for sides, point, push in touches)

    def mean_weight(self) -> float:
        """Return the mean weight of the movable links [N]; 0 if there are none or no gravity."""
        masses = self._model.body_mass[self._model.body_weldid > 0]
        return float(np.linalg.norm(self._simulation.gravity)) * float(masses.mean()) if len(masses) else 0.0

    def _touches(self) -> list[tuple[tuple[int, int], Floats, Floats]]:
        """Return both body indices, the point [m], and the force on the second body [N] of each active contact."""
        touches: list[tuple[tuple[int, int], Floats, Floats]] = []
        wrench = np.zeros(6)
        for index, contact in enumerate(self._data.contact):
            if contact.efc_address >= 0:
                mujoco.mj_contactForce(self._model, self._data, index, wrench)
                first, second = self._model.geom_bodyid[contact.geom].tolist()
                touches.append(((first, second), contact.pos.copy(), contact.frame.reshape(3, 3).T @ wrench[:3]))
        return touches

    def _body_id(self, state: BodyState, link: int) -> int | None:
        """Compute the forces on all links, and return MuJoCo's index of one link; None before the first step."""
        body = self._bodies.get(state)
        if body is None:
            return None
        mujoco.mj_forward(self._model, self._data)
        mujoco.mj_rnePostConstraint(self._model, self._data)
        return int(body.body_ids[link])

    def _wrench(self, body_id: int, spatial: Floats, point: Floats) -> tuple[Floats, Floats]:
        """Return force, and torque about ``point``, of a MuJoCo spatial force about the tree's centre of mass."""
        center = self._data.subtree_com[self._model.body_rootid[body_id]]
        return spatial[3:].copy(), spatial[:3] - np.cross(point - center, spatial[3:])

    def _give_back(self) -> None:
        """Copy poses and velocities from MuJoCo to the simulated bodies."""
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_comVel(self._model, self._data)
        moving = [body for body in self._bodies.values() if body.can_move]
        held = {grab.body for state in self._bodies for grab in state.grabs}
        own = [body for body in moving if body.state not in held]
        for body in own:
            body.part.give(body.state.kinematics)
        for body in own:
            body.state.moved()
        for body in own:
            body.part.stamp = body.state.kinematics.stamp  # it has not moved
        for body in moving:
            body.give_velocities()


def _columns(pairs: Iterable[tuple[Floats, Floats]]) -> tuple[Floats, Floats]:
    """Return the first and the second vectors of pairs, shape (n, 3) each."""
    both = np.array(list(pairs)).reshape(-1, 2, 3)
    return both[:, 0], both[:, 1]

"""Batches of configurations of one body: link poses, Jacobians and torques for arrays of joint values.

Configurations are along the last, contiguous axis of arrays, so that each step of the chain takes a few numpy calls for
hundreds of them. Chunks fit into the processor's cache, and memory apart from the result is constant.
"""

from collections.abc import Callable, Iterator, Sequence

import mujoco
import numpy as np

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats
from ravemj.engine.batch.chain import LinkChain
from ravemj.engine.batch.kinematic_state import KinematicState, cross
from ravemj.engine.dynamics import BodyDynamics
from ravemj.engine.kinematics import BodyKinematics, fixed_view
from ravemj.model.inertia import Inertias

POSES, MOTIONS = 60_000, 8_000
"""Number of link poses per chunk, for poses only, and for Jacobians or dynamics: few enough for the processor's cache,
enough for numpy.
"""


FEW_LINKS = 12
"""Number of links up to which numpy is faster than a MuJoCo call for each configuration."""


class Batch:
    """Chain of links of a body, prepared for many joint values. The body's state is neither used nor changed.

    Mimic joints are clamped to their limits, other joints are not; within all limits, poses are those of
    ``SetDOFValues``.
    """

    def __init__(self, kinematics: BodyKinematics, dynamics: BodyDynamics) -> None:
        self._kinematics = kinematics
        self._dynamics = dynamics
        self._chain = LinkChain(kinematics, dynamics.tree)

    def _chunks(self, count: int, poses: int = POSES) -> Iterator[slice]:
        """Yield slices of similar size that cover ``count`` configurations, each with about ``poses`` link poses."""
        parts = -(-count // max(100, min(1000, poses // len(self._kinematics.body_ids))))
        for part in range(parts):
            yield slice(part * count // parts, (part + 1) * count // parts)

    def link_transforms(self, values: Floats, out: Floats) -> None:
        """Write the poses ``T_world_link`` for joint values [rad or m], (N, dof), into an array (N, links, 4, 4)."""
        if len(values) == 1:
            _fill_twice(lambda both, rows: self.link_transforms(rows[0], both), out, values)
            return
        for part in self._chunks(len(values)):
            poses = out[part]
            for step, frame in self._chain.frames(np.ascontiguousarray(values[part].T)):
                axes_last = frame.transpose(1, 2, 0)
                for link in step.links:
                    np.matmul(axes_last, self._chain.T_step_links[link], out=poses[:, link, :3].transpose(1, 0, 2))
                    poses[:, link, 3] = (0.0, 0.0, 0.0, 1.0)

    def _state(self, values: Floats) -> KinematicState:
        """Return the poses of links and joint axes for joint values [rad or m], shape (dof, N)."""
        tree, count = self._dynamics.tree, values.shape[1]
        axes, anchors = np.zeros((tree.count, 3, count)), np.zeros((tree.count, 3, count))
        links = np.zeros((len(self._kinematics.body_ids), 4, 3, count))
        for step, frame in self._chain.frames(values):
            for link in step.links:
                np.matmul(self._chain.T_step_links[link].T, frame.reshape(4, -1), out=links[link].reshape(4, -1))
            first = step.coordinate
            if step.kind == "spherical":  # its coordinates turn about the child's axes
                axes[first : first + 3] = links[step.child, :3]
                anchors[first : first + 3] = frame[3]
            elif step.kind != "root":
                axes[first], anchors[first] = frame[2], frame[3]
        reference = self._kinematics.link_transform(0)[:3, 3:]  # near the body, so that no digits are lost far away
        coupling = self._dynamics.couplings.at(values)
        return KinematicState(tree, coupling, axes, anchors - reference, links[:, 3] - reference, links[:, :3])

    def jacobians(self, values: Floats, link: int, point: Floats, out: Floats) -> None:
        """Write the Jacobians of a link.

        Args:
            values: Joint values [rad or m], shape (N, dof).
            link: Index of the link.
            point: The point in the link's frame [m], shape (3,).
            out: Receives the derivatives of the point's position and the link's angular velocity, shape (N, 6, dof).
        """
        if len(values) == 1:
            _fill_twice(lambda both, rows: self.jacobians(rows[0], link, point, both), out, values)
            return
        path, slides = self._chain.path_to(link), self._dynamics.tree.slides
        T_step_link = self._chain.T_step_links[link]
        for part in self._chunks(len(values), MOTIONS):
            now = np.ascontiguousarray(values[part].T)
            steps = list(self._chain.frames(now, path))
            place = _combined(steps[-1][1][:3], T_step_link[:3] @ (*point, 1.0)) + steps[-1][1][3]
            columns = np.zeros((self._dynamics.tree.count, 6, now.shape[1]))
            for step, frame in steps:
                first = step.coordinate
                if step.kind == "spherical":  # its coordinates turn about the child's axes
                    axes = np.array(
                        [_combined(frame[:3], axis) for axis in self._chain.T_step_links[step.child][:3, :3].T]
                    )
                elif step.kind == "root":
                    continue
                else:
                    axes = frame[2:3]
                some = slice(first, first + len(axes))
                if slides[first]:
                    columns[some, :3] = axes
                else:
                    columns[some, :3], columns[some, 3:] = cross(axes, (place - frame[3])[None]), axes
            coupling = self._dynamics.couplings.at(now, second=False)
            out[part] = coupling.backward(columns).transpose(2, 1, 0)

    def inverse_dynamics(
        self, values: Floats, rates: Floats, accelerations: Floats, inertias: Inertias, gravity: Floats, out: Floats
    ) -> None:
        """Write the generalised forces of given motions, with the base at rest.

        Args:
            values: Joint values [rad or m], shape (N, dof).
            rates: Joint velocities, shape (N, dof).
            accelerations: Joint accelerations, shape (N, dof).
            inertias: Mass properties of the links.
            gravity: Gravitational acceleration [m/s^2], shape (3,).
            out: Receives torques [N m], for sliders forces [N], shape (N, dof).
        """
        if len(self._kinematics.body_ids) > FEW_LINKS and self._inverse_dynamics_by_mujoco(
            values, rates, accelerations, gravity, out
        ):
            return
        if len(values) == 1:

            def fill(both: Floats, rows: Sequence[Floats]) -> None:
                self.inverse_dynamics(rows[0], rows[1], rows[2], inertias, gravity, both)

            _fill_twice(fill, out, values, rates, accelerations)
            return
        for part in self._chunks(len(values), MOTIONS):
            now, speed, change = (np.ascontiguousarray(rows[part].T) for rows in (values, rates, accelerations))
            state = self._state(now)
            coupling = state.coupling
            velocities = coupling.forward(speed)
            speeding = coupling.forward(change) + coupling.bias(speed)
            twists = state.twists(velocities)
            changes = state.accelerations(twists, velocities, speeding)
            wrenches = state.needed_forces(inertias, state.of_links(twists), state.of_links(changes), gravity)
            forces = state.forces(wrenches)
            if self._dynamics.motors is not None:
                forces = forces + self._dynamics.motors.torques(velocities, speeding)
            out[part] = coupling.backward(forces).T

    def _inverse_dynamics_by_mujoco(
        self, values: Floats, rates: Floats, accelerations: Floats, gravity: Floats, out: Floats
    ) -> bool:
        """Compute inverse dynamics with ``mj_rne``, one configuration at a time.

        Returns:
            False without a result if joints are coupled or have motors, or links are displaced.
        """
        kinematics, dynamics = self._kinematics, self._dynamics
        coupling = dynamics.couplings.constant
        if coupling is None or not dynamics.couplings.is_one_to_one or dynamics.motors or kinematics.displaced:
            return False
        model, data = kinematics.model, self._data
        model.opt.gravity[:] = gravity
        data.qpos[:] = kinematics.qpos
        dofs, columns = coupling.dofs, np.arange(model.nv)[kinematics.inner_qvel][coupling.coordinates]
        # Look-ups outside of the loop over configurations.
        place, place_coms, move, find_forces = mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_comVel, mujoco.mj_rne
        (qpos, places), (qvel, moved), (qacc, pushed) = (
            fixed_view(data.qpos, kinematics.qpos_indices[dofs]),
            fixed_view(data.qvel, columns),
            fixed_view(data.qacc, columns),
        )
        out[:] = 0.0
        for part in self._chunks(len(values), MOTIONS):
            forces = np.empty((part.stop - part.start, model.nv))
            given = (rows[part].take(dofs, 1) for rows in (values, rates, accelerations))
            for row, now, speed, change in zip(forces, *given, strict=True):
                qpos[places], qvel[moved], qacc[pushed] = now, speed, change
                place(model, data)
                place_coms(model, data)
                move(model, data)
                find_forces(model, data, 1, row)
            out[part, dofs] = forces[:, columns]
        return True

    @cached_property
    def _data(self) -> mujoco.MjData:
        """Separate MuJoCo state of the body, in which the base never has a velocity."""
        return mujoco.MjData(self._kinematics.model)


def _combined(vectors: Floats, factors: Floats) -> Floats:
    """Return x v1 + y v2 + z v3 of three arrays, without BLAS, whose rounding depends on the number of columns."""
    x, y, z = factors.tolist()
    return x * vectors[0] + y * vectors[1] + z * vectors[2]


def _fill_twice(fill: Callable[[Floats, Sequence[Floats]], None], out: Floats, *rows: Floats) -> None:
    """Compute a single configuration by passing it twice, since BLAS rounds single columns differently.

    Args:
        fill: Called with an array for the results, and with the configurations.
        out: The result, shape (1, ...).
        rows: The configuration, arrays of shape (1, n).
    """
    both = np.empty((2, *out.shape[1:]))
    fill(both, [np.repeat(row, 2, axis=0) for row in rows])
    out[:] = both[:1]

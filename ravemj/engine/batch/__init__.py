"""Many configurations of one body at once: link poses, Jacobians and torques for arrays of joint values.

The configurations run along the last, contiguous axis, so that each step of the chain of links is a few calls of numpy
for hundreds of them. Work goes in chunks that fit the processor's cache, and memory beside the result does not grow.
"""

from collections.abc import Iterator

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.batch.chain import Chain
from ravemj.engine.dynamics import BodyDynamics, Inertias, Posture
from ravemj.engine.kinematics import BodyKinematics

POSES, MOTIONS = 60_000, 8_000
"""Poses of links, and their motions, that are worked out together: few enough for the cache, enough for numpy."""


class Batch:
    """A body's chain of links, ready for many joint values. The body's state is neither used nor changed.

    Poses are those that ``SetDOFValues`` gives within the limits: joint limits are not looked at, but followers stop at
    theirs.
    """

    def __init__(self, kinematics: BodyKinematics, dynamics: BodyDynamics) -> None:
        self._kinematics = kinematics
        self._dynamics = dynamics
        self._chain = Chain(kinematics, dynamics.tree)

    def _chunks(self, count: int, poses: int = POSES) -> Iterator[slice]:
        """Yield slices of like size that cover that many configurations."""
        parts = -(-count // max(100, min(1000, poses // len(self._kinematics.body_ids))))
        for part in range(parts):
            yield slice(part * count // parts, (part + 1) * count // parts)

    def link_transforms(self, values: Floats, out: Floats) -> None:
        """Write the poses of the links.

        Args:
            values: Joint values [rad or m], shape (N, dof).
            out: Takes ``T_world_link``, shape (N, links, 4, 4).
        """
        for part in self._chunks(len(values)):
            poses = out[part]
            for step, frame in self._chain.frames(np.ascontiguousarray(values[part].T)):
                axes_last = frame.transpose(1, 2, 0)
                for link in step.links:
                    np.matmul(axes_last, self._chain.T_step_links[link], out=poses[:, link, :3].transpose(1, 0, 2))
                    poses[:, link, 3] = (0.0, 0.0, 0.0, 1.0)

    def _posture(self, values: Floats, *, second: bool = False) -> Posture:
        """Return where links and axes are.

        Args:
            values: Joint values [rad or m], shape (dof, N).
            second: Whether second derivatives of followers and spherical joints are wanted.
        """
        tree, count = self._dynamics.tree, values.shape[1]
        axes, anchors = np.zeros((tree.count, 3, count)), np.zeros((tree.count, 3, count))
        links = np.zeros((len(self._kinematics.body_ids), 4, 3, count))
        for step, frame in self._chain.frames(values):
            for link in step.links:
                np.matmul(self._chain.T_step_links[link].T, frame.reshape(4, -1), out=links[link].reshape(4, -1))
            if step.kind == "spherical":  # its movers turn about the child's axes
                axes[step.mover : step.mover + 3] = links[step.child, :3]
                anchors[step.mover : step.mover + 3] = frame[3]
            elif step.kind != "root":
                axes[step.mover], anchors[step.mover] = frame[2], frame[3]
        reference = self._dynamics.reference.reshape(3, 1)
        slopes = self._dynamics.map.at(values, second=second)
        return Posture(tree, slopes, axes, anchors - reference, links[:, 3] - reference, links[:, :3])

    def jacobians(self, values: Floats, link: int, point: Floats, out: Floats) -> None:
        """Write the Jacobians of a link.

        Args:
            values: Joint values [rad or m], shape (N, dof).
            link: Index of the link.
            point: In the link's frame [m], shape (3,).
            out: Takes the derivatives of the point's position and the link's angular velocity, shape (N, 6, dof).
        """
        for part in self._chunks(len(values), MOTIONS):
            posture = self._posture(np.ascontiguousarray(values[part].T))
            place = posture.positions[link] + np.tensordot(point, posture.rotations[link], 1)
            out[part] = posture.jacobian(link, place).transpose(2, 1, 0)

    def inverse_dynamics(self, values: Floats, rates: Floats, growths: Floats, inertias: Inertias, out: Floats) -> None:
        """Write the generalised forces that move the body as given, with its base at rest.

        Args:
            values: Joint values [rad or m], shape (N, dof).
            rates: Joint velocities, shape (N, dof).
            growths: Joint accelerations, shape (N, dof).
            inertias: Mass properties of the links.
            out: Takes torques [N m], for sliders forces [N], shape (N, dof).
        """
        armature, gravity = self._dynamics.armature[:, None], self._kinematics.model.opt.gravity.copy()
        for part in self._chunks(len(values), MOTIONS):
            now, speed, growth = (np.ascontiguousarray(one[part].T) for one in (values, rates, growths))
            posture = self._posture(now, second=True)
            slopes = posture.slopes
            movers, bent = slopes.forward(speed), slopes.forward(growth) + slopes.bend(speed)
            twists = posture.twists(movers, None)
            change = posture.accelerations(twists, movers, bent, None)
            motion = posture.of_links(twists, None), posture.of_links(change, None)
            forces = posture.forces(posture.needed_forces(inertias, *motion, gravity)) + armature * bent
            out[part] = slopes.backward(forces).T

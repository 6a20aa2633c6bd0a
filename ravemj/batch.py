"""Many configurations of one body at once: link poses, Jacobians and torques for arrays of joint values.

The configurations run along the last, contiguous axis, so that each step of the chain of links is a few calls of numpy
for hundreds of them. Work goes in chunks that fit the processor's cache, and memory beside the result does not grow.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import mujoco
import numpy as np

from ravemj.dynamics import BodyDynamics, Inertias, Posture
from ravemj.dynamics.slopes import first_values
from ravemj.kinematics import BodyKinematics
from ravemj.scene import Joint
from ravemj.transforms import Floats, inverse, rows_from_wxyz

CHUNK = 40_000
"""Poses of links that are worked out together: few enough for the cache, many enough for numpy."""

Source = tuple[Literal["dof", "follower", "fixed"], int]
"""Where a joint's value comes from: a DOF, a follower by its joint, or what ``qpos`` has now."""


@dataclass(frozen=True, slots=True)
class Step:
    """One moving axis, with a frame whose z it is, or a spherical joint, with a frame in the parent's axes.

    Attributes:
        kind: ``hinge``, ``slider`` or ``spherical``.
        parent: The step that it hangs on, or -1 for a root link.
        root: The root link that it hangs on.
        T_parent_frame: The frame in the parent's at the value ``reference``, shape (4, 4).
        source: Where the value comes from.
        reference: What is subtracted from the value.
        mover: Its first mover.
        child: The link that it moves.
    """

    kind: str
    parent: int
    root: int
    T_parent_frame: Floats
    source: Source
    reference: float
    mover: int
    child: int


class Batch:
    """A body's chain of links, ready for many joint values. The body's state is neither used nor changed.

    Poses are those that ``SetDOFValues`` gives within the limits: joint limits are not looked at, but followers stop at
    theirs.
    """

    def __init__(self, kinematics: BodyKinematics, dynamics: BodyDynamics) -> None:
        self._kinematics = kinematics
        self._dynamics = dynamics
        self._steps: list[Step] = []
        count = len(kinematics.body_ids)
        self._step_of: list[int] = [-1] * count
        self._root_of: list[int] = list(range(count))
        self._T_step_link = np.tile(np.eye(4), (count, 1, 1))
        joints = (*kinematics.body.joints, *kinematics.body.passive_joints)
        placing = {joint.child: index for index, joint in enumerate(joints) if joint.places_child}
        for link in np.argsort(kinematics.body_ids).tolist():
            if link not in kinematics.roots:
                self._add(placing[link], joints[placing[link]])

    def _add(self, index: int, joint: Joint) -> None:
        """Add the steps of a joint, and place its child behind them."""
        parent, child = joint.parent, joint.child
        step, root = self._step_of[parent], self._root_of[parent]
        T_step_parent = self._T_step_link[parent]
        for axis, name in enumerate(self._kinematics.names.joints[index]):
            T_parent_frame = _axis_frame(joint, axis)
            step = self._append(joint, index, axis, name, step, root, T_step_parent @ T_parent_frame)
            T_step_parent = inverse(T_parent_frame)
        names = self._kinematics.names.joints[index]  # none for a joint that never moves
        T_parent_child = joint.T_parent_child.matrix() if names else self._kinematics.rest_transform(child)
        T_step_child = T_step_parent @ T_parent_child
        self._step_of[child], self._root_of[child], self._T_step_link[child] = step, root, T_step_child

    def _append(
        self, joint: Joint, index: int, axis: int, name: str, parent: int, root: int, T_parent_frame: Floats
    ) -> int:
        """Add a step and return its number."""
        kinematics = self._kinematics
        model = kinematics.model
        found = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
        source: Source = ("fixed", int(model.jnt_qposadr[found]))
        if index < len(kinematics.body.joints):
            source = ("dof", kinematics.first_dofs[index] + axis)
        elif any(follower.joint == index for follower in kinematics.followers):
            source = ("follower", index)
        mover = self._dynamics.tree.dofs.tolist().index(int(model.jnt_dofadr[found]))
        kind = "hinge" if joint.kind == "hinge2" else joint.kind
        reference = joint.axes[axis].reference
        self._steps.append(Step(kind, parent, root, T_parent_frame, source, reference, mover, joint.child))
        return len(self._steps) - 1

    def chunks(self, count: int) -> Iterator[slice]:
        """Yield slices of that many configurations."""
        size = max(200, min(1000, CHUNK // len(self._step_of)))
        for start in range(0, count, size):
            yield slice(start, min(start + size, count))

    def frames(self, values: Floats) -> tuple[list[Floats], dict[int, Floats]]:
        """Return the frame of each step, and of each root link.

        Args:
            values: Joint values, shape (dof, N).

        Returns:
            Three axes and an origin, of three components each, for N configurations: shape (4, 3, N) each.
        """
        count = values.shape[1]
        roots = {link: self._root_frame(link, count) for link in self._kinematics.roots}
        followed = self._followed(values)
        frames: list[Floats] = []
        for step in self._steps:
            before = frames[step.parent] if step.parent >= 0 else roots[step.root]
            parent = before.reshape(4, -1)
            if step.kind == "spherical":
                frames.append(_turned(parent, step.T_parent_frame, self._vector(step, values)))
            elif step.kind == "slider":
                frames.append(_slid(parent, step.T_parent_frame, self._value(step, values, followed)))
            else:
                frames.append(_hinged(parent, step.T_parent_frame, self._value(step, values, followed)))
        return frames, roots

    def _value(self, step: Step, values: Floats, followed: dict[int, Floats]) -> Floats:
        """Return how far a joint is from where its frame is given, shape (N,)."""
        kind, index = step.source
        if kind == "dof":
            return values[index] - step.reference if step.reference else values[index]
        if kind == "follower":
            return followed[index] - step.reference
        return np.full(values.shape[1:], float(self._kinematics.data.qpos[index]) - step.reference)

    def _vector(self, step: Step, values: Floats) -> Floats:
        """Return the rotation vector of a spherical joint, shape (3, N)."""
        kind, index = step.source
        if kind == "dof":
            return values[index : index + 3]
        return np.zeros((3, values.shape[1]))

    def _followed(self, values: Floats) -> dict[int, Floats]:
        """Return the values of the followers by their joints, each of shape (N,)."""
        kinematics = self._kinematics
        if not kinematics.followers:
            return {}
        known = first_values(kinematics, values)
        joints = (*kinematics.body.joints, *kinematics.body.passive_joints)
        for follower in kinematics.followers:
            mimic, axis = joints[follower.joint].mimic, follower.axis
            assert mimic is not None
            assert mimic.expression is not None
            named = {name: known[int(name.removeprefix("joint"))] for name in mimic.expression.variables}
            value = np.broadcast_to(mimic.expression.evaluate_many(named), values.shape[1:])
            known[follower.joint] = value if axis.circular else np.clip(value, axis.lower, axis.upper)
        return {follower.joint: known[follower.joint] for follower in kinematics.followers}

    def _root_frame(self, link: int, count: int) -> Floats:
        model, body_id = self._kinematics.model, self._kinematics.body_ids[link]
        w, x, y, z = model.body_quat[body_id].tolist()
        frame = np.vstack((np.array(rows_from_wxyz((w, x, y, z))).T, model.body_pos[body_id]))
        return np.repeat(frame[:, :, None], count, axis=2)

    def _frame_of(self, frames: tuple[list[Floats], dict[int, Floats]], link: int) -> Floats:
        step = self._step_of[link]
        return frames[0][step] if step >= 0 else frames[1][self._root_of[link]]

    def link_transforms(self, values: Floats, out: Floats) -> None:
        """Write the poses of the links.

        Args:
            values: Joint values [rad or m], shape (N, dof).
            out: Takes ``T_world_link``, shape (N, links, 4, 4).
        """
        for part in self.chunks(len(values)):
            frames = self.frames(np.ascontiguousarray(values[part].T))
            poses = out[part]
            poses[:, :, 3] = (0.0, 0.0, 0.0, 1.0)
            for link, T_step_link in enumerate(self._T_step_link):
                frame = self._frame_of(frames, link).transpose(1, 2, 0)  # component, configuration, axis
                np.matmul(frame, T_step_link, out=poses[:, link, :3].transpose(1, 0, 2))

    def posture(self, values: Floats, *, second: bool = False) -> Posture:
        """Return where links and axes are, in the world.

        Args:
            values: Joint values [rad or m], shape (dof, N).
            second: Whether second derivatives of followers and spherical joints are wanted.
        """
        tree, count = self._dynamics.tree, values.shape[1]
        frames = self.frames(values)
        axes, anchors = np.zeros((tree.count, 3, count)), np.zeros((tree.count, 3, count))
        links = np.zeros((len(self._step_of), 4, 3, count))
        for link, T_step_link in enumerate(self._T_step_link):
            np.matmul(T_step_link.T, self._frame_of(frames, link).reshape(4, -1), out=links[link].reshape(4, -1))
        for step, frame in zip(self._steps, frames[0], strict=True):
            if step.kind == "spherical":  # its movers turn about the child's axes
                axes[step.mover : step.mover + 3], anchors[step.mover : step.mover + 3] = (
                    links[step.child, :3],
                    frame[3],
                )
            else:
                axes[step.mover], anchors[step.mover] = frame[2], frame[3]
        reference = self._kinematics.data.xpos[self._kinematics.body_ids[0]].reshape(3, 1)
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
        for part in self.chunks(len(values)):
            posture = self.posture(np.ascontiguousarray(values[part].T))
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
        for part in self.chunks(len(values)):
            now, speed, growth = (np.ascontiguousarray(one[part].T) for one in (values, rates, growths))
            posture = self.posture(now, second=True)
            slopes = posture.slopes
            movers, bent = slopes.forward(speed), slopes.forward(growth) + slopes.bend(speed)
            twists = posture.twists(movers, None)
            change = posture.accelerations(twists, movers, bent, None)
            motion = posture.of_links(twists, None), posture.of_links(change, None)
            forces = posture.forces(posture.needed_forces(inertias, *motion, gravity)) + armature * bent
            out[part] = slopes.backward(forces).T


def _axis_frame(joint: Joint, axis: int) -> Floats:
    """Return the frame of a joint's axis in its parent link: at the anchor, with z along the axis, shape (4, 4)."""
    frame = np.eye(4)
    frame[:3, 3] = joint.anchor
    if joint.kind != "spherical":
        z = np.array(joint.axes[axis].direction)
        x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
        x /= np.linalg.norm(x)
        frame[:3, :3] = np.column_stack((x, np.cross(z, x), z))
    return frame


def _hinged(parent: Floats, T_parent_frame: Floats, angles: Floats) -> Floats:
    """Return frames behind a hinge: parents of shape (4, 3 N) to (4, 3, N)."""
    count = len(angles)
    x, y, z, origin = T_parent_frame.T
    frames = np.empty((4, 3, count))
    flat = frames.reshape(4, -1)
    crosswise = (np.array((x, y, y, -x)) @ parent).reshape(2, 2, 3, count)
    np.multiply(crosswise[0], np.cos(angles), out=frames[:2])
    crosswise[1] *= np.sin(angles)
    frames[:2] += crosswise[1]
    np.matmul(np.array((z, origin)), parent, out=flat[2:])
    return frames


def _slid(parent: Floats, T_parent_frame: Floats, ways: Floats) -> Floats:
    """Return frames behind a slider."""
    frames = (T_parent_frame.T @ parent).reshape(4, 3, -1)
    frames[3] += ways * frames[2]
    return frames


def _turned(parent: Floats, T_parent_frame: Floats, vectors: Floats) -> Floats:
    """Return frames behind a spherical joint, turned by rotation vectors of shape (3, N)."""
    frames = (T_parent_frame.T @ parent).reshape(4, 3, -1)
    angle = np.sqrt((vectors * vectors).sum(axis=0))
    x, y, z = vectors / np.where(angle > 0, angle, 1.0)
    sine, rest = np.sin(angle), 1 - np.cos(angle)
    rows = np.array(
        [
            [1 - rest * (y * y + z * z), rest * x * y - sine * z, rest * x * z + sine * y],
            [rest * x * y + sine * z, 1 - rest * (x * x + z * z), rest * y * z - sine * x],
            [rest * x * z - sine * y, rest * y * z + sine * x, 1 - rest * (x * x + y * y)],
        ]
    )
    frames[:3] = np.einsum("kcn,kjn->jcn", frames[:3], rows)
    return frames

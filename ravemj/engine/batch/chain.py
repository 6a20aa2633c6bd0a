"""Chain of links of a body, for many configurations at once.

A frame is an array of shape (4, 3, N): three axes and an origin, of three components each, for N configurations.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.engine.dynamics import CoordinateTree, first_values
from ravemj.engine.kinematics import BodyKinematics
from ravemj.model.joints import moving_direction
from ravemj.model.scene import Joint

ROOT = -1


@dataclass(slots=True)
class Step:
    """Element of a chain: root link, single joint axis (z of the element's frame), or spherical joint."""

    kind: str  # ``root``, ``hinge``, ``slider`` or ``spherical``
    parent: int  # the parent step
    T_parent_frame: Floats  # its frame in the parent's at the value ``reference``, shape (4, 4)
    source: tuple[Literal["dof", "mimic", "qpos"], int]  # of its value: a DOF, a mimic joint, or what ``qpos`` has now
    reference: float  # what is subtracted from the value
    coordinate: int  # its first velocity coordinate
    child: int  # the link that it moves
    links: list[int] = field(default_factory=list[int])  # fixed to its frame, in which they are at ``T_step_links``
    last: int = ROOT  # its last child step


class LinkChain:
    """Links of a body in topological order.

    Attributes:
        steps: The chain elements (roots and joint axes) that move the links.
        T_step_links: Pose of each link in the frame of the chain element that it is fixed to, shape (links, 4, 4).
    """

    def __init__(self, kinematics: BodyKinematics, tree: CoordinateTree) -> None:
        self._kinematics = kinematics
        self._coordinate_of_qpos = tree.of_qpos
        self.steps: list[Step] = []
        count = len(kinematics.body_ids)
        self._step_of: list[int] = [ROOT] * count
        self.T_step_links = np.tile(np.eye(4), (count, 1, 1))
        joints = kinematics.body.all_joints
        placing = {joint.child: index for index, joint in enumerate(joints) if joint.places_child}
        order: list[int] = np.argsort(kinematics.body_ids).tolist()
        for link in order:
            if link in kinematics.roots:
                self._step_of[link] = self._append(Step("root", ROOT, np.eye(4), ("qpos", 0), 0.0, ROOT, link))
            else:
                self._hang(placing[link], joints[placing[link]])
            self.steps[self._step_of[link]].links.append(link)

    def _hang(self, index: int, joint: Joint) -> None:
        """Append a ``Step`` for each axis of a joint, and attach the joint's child link to the last of them."""
        kinematics = self._kinematics
        places = kinematics.joint_qpos[index]  # none for a joint that never moves
        step, T_step_parent = self._step_of[joint.parent], self.T_step_links[joint.parent]
        for axis, qpos in enumerate(places):
            T_parent_frame = _axis_frame(joint, axis)
            source: tuple[Literal["dof", "mimic", "qpos"], int] = ("qpos", qpos)
            if index < len(kinematics.body.joints):
                source = ("dof", kinematics.first_dofs[index] + axis)
            elif any(mimic.joint == index for mimic in kinematics.mimic.joints):
                source = ("mimic", index)
            kind = "spherical" if joint.is_ball else "slider" if joint.slides(axis) else "hinge"
            frame, reference = T_step_parent @ T_parent_frame, joint.axes[axis].reference
            step = self._append(Step(kind, step, frame, source, reference, self._coordinate_of_qpos[qpos], joint.child))
            T_step_parent = inverse(T_parent_frame)
        T_parent_child = joint.T_parent_child.matrix() if places else kinematics.rest_transform(joint.child)
        self._step_of[joint.child], self.T_step_links[joint.child] = step, T_step_parent @ T_parent_child

    def _append(self, step: Step) -> int:
        self.steps.append(step)
        index = len(self.steps) - 1
        if step.parent != ROOT:
            self.steps[step.parent].last = index
        return index

    def path_to(self, link: int) -> list[int]:
        """Return the chain elements from the root to a link."""
        path = [self._step_of[link]]
        while self.steps[path[-1]].parent != ROOT:
            path.append(self.steps[path[-1]].parent)
        return path[::-1]

    def frames(self, values: Floats, wanted: Sequence[int] | None = None) -> Iterator[tuple[Step, Floats]]:
        """Yield the chain elements with their frames.

        A frame is released after the last child of its element, so that memory in use fits into the cache.

        Args:
            values: Joint values, shape (dof, N).
            wanted: The elements to compute, parents before children; by default all.
        """
        chosen = range(len(self.steps)) if wanted is None else wanted
        ways = self._ways(values, chosen)
        cosines, sines = _cosines_and_sines(ways)
        frames: dict[int, Floats] = {}
        for row, index in enumerate(chosen):
            step = self.steps[index]
            if step.kind == "root":
                frame = self._root_frame(step.child, values.shape[1])
            else:
                parent = frames[step.parent].reshape(4, -1)
                if step.kind == "spherical":
                    vectors = values[step.source[1] :][:3] if step.source[0] == "dof" else np.zeros((3, ways.shape[1]))
                    frame = _turned(parent, step.T_parent_frame, vectors)
                elif step.kind == "slider":
                    frame = _slid(parent, step.T_parent_frame, ways[row])
                else:
                    frame = _hinged(parent, step.T_parent_frame, cosines[row], sines[row])
                if self.steps[step.parent].last == index:
                    del frames[step.parent]
            frames[index] = frame
            yield step, frame

    def _root_frame(self, link: int, count: int) -> Floats:
        frame = self._kinematics.link_transform(link)[:3].T
        return np.repeat(frame[:, :, None], count, axis=2)

    def _ways(self, values: Floats, chosen: Sequence[int]) -> Floats:
        """Return displacements from the reference values [rad or m], shape (len(chosen), N), of the chosen joint axes.

        ``chosen`` are their indices in ``steps``.
        """
        ways = np.zeros((len(chosen), values.shape[1]))
        first_values = self._first_values(values)
        for index, step in enumerate(self.steps[number] for number in chosen):
            kind, place = step.source
            if kind == "dof":
                ways[index] = values[place]
            elif step.kind != "root":
                ways[index] = first_values[place] if kind == "mimic" else self._kinematics.data.qpos[place]
            if step.reference:
                ways[index] -= step.reference
        return ways

    def _first_values(self, values: Floats) -> list[Floats]:
        """Return the value of the first axis of each joint, shape (N,) each; empty without mimic joints."""
        mimic = self._kinematics.mimic
        if not mimic.joints:
            return []
        known = first_values(self._kinematics, values)
        mimic.evaluate_many(known)
        return known


def _axis_frame(joint: Joint, axis: int) -> Floats:
    """Return the frame of a joint's axis in its parent link: at the anchor, with z along the axis, shape (4, 4)."""
    frame = np.eye(4)
    frame[:3, 3] = joint.anchor
    if not joint.is_ball:
        z = np.array(moving_direction(joint, axis))
        x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
        x /= np.linalg.norm(x)
        frame[:3, :3] = np.column_stack((x, np.cross(z, x), z))
    return frame


def _cosines_and_sines(angles: Floats) -> tuple[Floats, Floats]:
    """Return cosines and sines by the half-angle tangent, which is several times faster in numpy."""
    tangents = np.tan(angles / 2)
    squares = tangents * tangents
    factors = 1 / (1 + squares)
    return (1 - squares) * factors, 2 * tangents * factors


def _hinged(parent: Floats, T_parent_frame: Floats, cosines: Floats, sines: Floats) -> Floats:
    """Return the frames after a revolute joint, (4, 3, N), for N parent frames, shape (4, 3 N)."""
    frames = (T_parent_frame.T @ parent).reshape(4, 3, -1)
    x_part, y_part = frames[:2] * sines
    frames[:2] *= cosines
    frames[0] += y_part
    frames[1] -= x_part
    return frames


def _slid(parent: Floats, T_parent_frame: Floats, ways: Floats) -> Floats:
    """Return the frames after a prismatic joint, (4, 3, N), for N displacements ``ways`` [m]."""
    frames = (T_parent_frame.T @ parent).reshape(4, 3, -1)
    frames[3] += ways * frames[2]
    return frames


def _turned(parent: Floats, T_parent_frame: Floats, vectors: Floats) -> Floats:
    """Return the frames after a spherical joint, (4, 3, N), for N rotation vectors [rad], shape (3, N)."""
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

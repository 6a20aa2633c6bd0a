"""The cylindrical handle of a selected joint."""

from dataclasses import dataclass

import mujoco
import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.gui.interaction.picking import visible_box
from ravemj.gui.interaction.viewpoint import ViewRay
from ravemj.model import drawing
from ravemj.model.chains import joints_above
from ravemj.model.drawing import Primitives
from ravemj.model.joints import directions_at
from ravemj.model.manipulators import joint_dofs
from ravemj.model.scene import Joint, KinBody

SIZES = (1.0, 2.0, 4.0, 0.5)
"""Scale factors of the cylinder, selected by repeated clicks."""

_RADIUS = 0.15
"""Radius of the cylinder handle, as a fraction of the diagonal of the link's visible geometry."""

_SMALLEST, _LARGEST = 0.02, 0.1
"""Bounds of the radius, as fractions of the diagonal of the body's visible geometry."""

_OVERHANG = 1.2
_STRIPES = 6
_SURFACE = np.array([0.9, 0.5, 0.0, 0.6])
_LINES = np.array([0.35, 0.15, 0.0, 1.0])
_LINE_WIDTH = 2.0
_MARKED = np.array([1.0, 0.85, 0.2, 0.5])
_MARK_MARGIN = 1.03
_CIRCLE = np.linspace(0, 2 * np.pi, 49)


def driving_dof(body: KinBody, link: int) -> int | None:
    """Return the first DOF of the joint that moves a link: its parent joint or, above welds, the next moving joint.

    For a mimic joint, it is the first DOF that the joint follows. None if no joint moves the link.
    """
    joints = body.all_joints
    for index in joints_above(body, link):
        mimic = joints[index].mimic
        if mimic is not None and mimic.dofs:
            return mimic.dofs[0]
        if mimic is None and index < len(body.joints) and not joints[index].static:
            return joint_dofs(body, index)[0]
    return None


def joint_and_axis(body: BodyState, dof: int) -> tuple[Joint, int]:
    """Return the joint of a DOF, and the index of the axis in the joint."""
    joint = body.scene.joint_of_dof(dof)
    return joint, dof - body.kinematics.first_dofs[body.scene.joints.index(joint)]


@dataclass(frozen=True, eq=False)
class JointHandle:
    """A cylinder on the axis of a joint.

    Attributes:
        T_world_handle: Pose of its centre, shape (4, 4); z is the joint axis. It moves with the child link.
        radius: Its radius [m].
        height: Its height [m].
    """

    T_world_handle: Floats
    radius: float
    height: float

    @classmethod
    def at(cls, body: BodyState, dof: int, scale: float = 1.0) -> "JointHandle":
        """Return the handle of a DOF at the present pose, scaled by a factor."""
        joint, T_world_handle = joint_frame(body, dof)
        child, whole = (visible_box(body, links, T_world_handle) for links in ([joint.child], None))
        length = 1.0 if whole is None else 2 * float(np.linalg.norm(whole.half))
        radius, half_height = _SMALLEST * length, 0.0
        if child is not None:
            wanted = _RADIUS * 2 * float(np.linalg.norm(child.half))
            radius = min(max(wanted, radius), _LARGEST * length)
            half_height = _OVERHANG * float(abs(child.center[2]) + child.half[2])
        return cls(T_world_handle, scale * radius, 2 * scale * min(max(half_height, radius), length))

    @property
    def center(self) -> Floats:
        """Centre of the handle in the world [m], shape (3,)."""
        return self.T_world_handle[:3, 3]

    @property
    def axis(self) -> Floats:
        """The direction of the joint's axis in the world, unit vector, shape (3,)."""
        return self.T_world_handle[:3, 2]

    def hit(self, ray: ViewRay) -> Floats | None:
        """Return the first intersection of a ray with the cylinder, in the world [m], shape (3,), or None."""
        size = np.array([self.radius, self.height / 2, 0.0])
        turned = self.T_world_handle[:3, :3].reshape(-1)
        kind = int(mujoco.mjtGeom.mjGEOM_CYLINDER)
        distance = mujoco.mju_rayGeom(self.center, turned, size, ray.start, ray.direction, kind, np.zeros(3))
        return None if distance < 0 else ray.start + distance * ray.direction

    def highlight(self) -> Primitives:
        """Return the drawing of the highlighted handle, in the world."""
        size = _MARK_MARGIN * self.radius, _MARK_MARGIN * self.height
        return drawing.cylinder(*size, _MARKED).placed(self.T_world_handle)

    def primitives(self) -> Primitives:
        """Return the drawing of the handle, in the world; stripes show its rotation."""
        ring = self.radius * np.column_stack([np.cos(_CIRCLE), np.sin(_CIRCLE), 0 * _CIRCLE])
        up = np.array([0.0, 0.0, self.height / 2])
        corners = ring[: -1 : len(ring) // _STRIPES]
        lines = [_strip(ring + up), _strip(ring - up), *(_strip(np.array([c - up, c + up])) for c in corners)]
        return drawing.merge([drawing.cylinder(self.radius, self.height, _SURFACE), *lines]).placed(self.T_world_handle)


def _strip(points: Floats) -> Primitives:
    return drawing.line_strip(points, _LINE_WIDTH, np.tile(_LINES, (len(points), 1)))


def joint_frame(body: BodyState, dof: int) -> tuple[Joint, Floats]:
    """Return the joint of a DOF and its axis's frame in the world, 4x4: z along the axis, x fixed to the child."""
    joint, axis = joint_and_axis(body, dof)
    values = body.kinematics.values()[dof - axis :].tolist()
    T_world_parent, T_world_child = (body.link_transform(link) for link in (joint.parent, joint.child))
    directions = directions_at(joint, values)
    direction = np.array(directions[axis])
    anchor = np.array(joint.anchor)
    for index in range(axis + 1):
        if joint.slides(index):
            anchor += (values[index] - joint.axes[index].reference) * np.array(directions[index])
    z = T_world_parent[:3, :3] @ direction
    in_child = z @ T_world_child[:3, :3]
    aside = np.eye(3)[0 if abs(in_child[0]) < 0.9 else 1]
    x = T_world_child[:3, :3] @ np.cross(aside, in_child)
    x /= np.linalg.norm(x)
    frame = np.eye(4)
    frame[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    frame[:3, 3] = T_world_parent[:3, :3] @ anchor + T_world_parent[:3, 3]
    return joint, frame

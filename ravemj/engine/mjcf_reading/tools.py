"""Conversion of tool sites to manipulators, and of cameras to sensors or the view."""

import math
import re
from collections.abc import Sequence

import mujoco

from ravemj.core.transforms import Pose
from ravemj.engine.mjcf_reading.numbers import pose
from ravemj.engine.mjcf_reading.trees import BodyTree, TreeReader
from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.urdf.arms import base_of, guess
from ravemj.formats.urdf.joint import UrdfJoint
from ravemj.formats.urdf.tree import RobotTree
from ravemj.model.builder import SensorBuilder
from ravemj.model.manipulators import ManipulatorBuilder
from ravemj.model.scene import AttachedSensor, Intrinsics, View

_TOOL = re.compile(
    r"(^|[_/:.])(attachment_site|tcp|ee|eef|ee_site|tool0?|grip|gripper|grip_site|grasp_site|pinch|pinch_site"
    r"|gripperframe)$",
    re.IGNORECASE,
)
"""Pattern of tool site names, derived from 525 public models."""

_BACK = Pose((0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0))
"""Rotation between camera frames: MuJoCo's look along -z with y up, OpenRAVE's along z with y down."""

_SIZE = (640, 480)
"""Default image size of a camera [pixels]."""


def add_manipulators(reader: TreeReader, trees: Sequence[BodyTree], context: Context) -> None:
    """Add an arm for each tool site; robots without tool sites get guessed arms."""
    for tree in trees:
        if not tree.builder.is_robot:
            continue
        robot = _robot_tree(tree)
        arms = _arms_at_sites(reader, tree, robot)
        root = Element("robot", "mujoco", {}, tree.builder.source)
        tree.builder.manipulators = arms or guess(robot, root, context, "no site marks a tool", "")


def _robot_tree(tree: BodyTree) -> RobotTree:
    """Convert links and joints to a URDF-like tree, for guessing arms."""
    links, joints = tree.builder.links, list[UrdfJoint]()
    for joint in tree.builder.joints:
        parent, child = (links[index].name for index in joint.links)
        kind = "revolute" if joint.enabled else "fixed"
        element = Element("joint", "joint", {}, joint.source)
        joints.append(UrdfJoint(element, joint.name, kind, parent, child, joint.T_first_second))
    robot = RobotTree({link.name: link.source for link in links}, joints, {})
    robot.followers |= {joint.name for joint in tree.builder.joints if joint.equations is not None}
    return robot


def _arms_at_sites(reader: TreeReader, tree: BodyTree, robot: RobotTree) -> list[ManipulatorBuilder]:
    model, arms = reader.compiled.model, dict[str, ManipulatorBuilder]()
    written = {site.id: site for site in reader.compiled.spec.sites}
    for index in range(model.nsite):
        name, body = model.site(index).name, int(model.site_bodyid[index])
        if body not in tree.links or not _TOOL.search(name):
            continue
        effector = tree.builder.links[tree.links[body]].name
        base = base_of(robot, effector)
        dofs = [joint for joint in robot.path(effector, base) or [] if robot.is_dof(joint)]
        if not dofs:
            continue
        arms[name] = ManipulatorBuilder(
            name,
            reader.compiled.document.source(name, "site"),
            base,
            effector,
            pose((written[index].pos, written[index].quat), (model.site_pos[index], model.site_quat[index])),
            gripper_joints=[joint.name for joint in robot.dofs_below(dofs[-1].child)],
        )
    return [*arms.values()]


def add_cameras(reader: TreeReader, trees: Sequence[BodyTree]) -> View | None:
    """Add the cameras on robots as sensors; return the view of the first camera fixed in the world."""
    model, view = reader.compiled.model, None
    written = {camera.id: camera for camera in reader.compiled.spec.cameras}
    for index in range(model.ncam):
        body, given = int(model.cam_bodyid[index]), written[index]
        T_body_camera = pose((given.pos, given.quat), (model.cam_pos[index], model.cam_quat[index])) @ _BACK
        tree = next((tree for tree in trees if body in tree.links), None)
        if body == 0:
            is_fixed = model.cam_mode[index] == mujoco.mjtCamLight.mjCAMLIGHT_FIXED
            view = view or (View(T_world_camera=T_body_camera) if is_fixed else None)
        elif tree is not None and tree.builder.is_robot:
            name = model.cam(index).name or f"camera{index}"
            sensor = AttachedSensor(
                name=name,
                link=tree.links[body],
                T_link_sensor=T_body_camera,
                type="BaseCamera",
                device=_intrinsics(model, index),
                source=reader.compiled.document.source(name, "camera"),
            )
            tree.builder.sensors.append(SensorBuilder(sensor))
    return view


def _intrinsics(model: mujoco.MjModel, index: int) -> Intrinsics:
    """Return the pinhole parameters of a camera from its vertical field of view."""
    width, height = (int(part) for part in model.cam_resolution[index])
    if min(width, height) <= 1:
        width, height = _SIZE
    focal = height / 2 / math.tan(math.radians(float(model.cam_fovy[index])) / 2)
    return Intrinsics(focal, focal, (width - 1) / 2, (height - 1) / 2, width, height)

"""Writer of OpenRAVE XML: a scene as a document, with its mesh files.

As the reader requires, links are written as if every joint had its ``<initial>`` value, joints in the frame of their
parent, and ``<jointvalues>`` are the present values. What the format cannot represent is reported.
"""

from dataclasses import dataclass, replace

from ravemj.core.transforms import ZERO, Pose
from ravemj.errors import Diagnostics, OutputError
from ravemj.formats import settled
from ravemj.formats.openrave_xml.geom_writer import GeomWriter, MeshFormat, write_pose
from ravemj.formats.openrave_xml.joint_writer import JointWriter, listed_poses, needs_values, writable
from ravemj.formats.openrave_xml.mass import single
from ravemj.formats.openrave_xml.part_names import PartNames
from ravemj.formats.parameters import write_parameters
from ravemj.formats.sensor_tags import written
from ravemj.formats.xml_text import XmlText
from ravemj.model.inertia import principal_frame
from ravemj.model.scene import (
    OWN_SHAPES,
    SENSOR_COLOR,
    AttachedSensor,
    Inertial,
    KinBody,
    Link,
    Manipulator,
    Scene,
    SensorKind,
    View,
    sensor_kind,
)


@dataclass(frozen=True)
class WrittenScene:
    """A written scene.

    Attributes:
        text: The document.
        meshes: The content of the mesh files, by their names in the folder ``geom_writer.FOLDER``.
    """

    text: str
    meshes: dict[str, bytes]


def write(scene: Scene, diagnostics: Diagnostics, meshes: MeshFormat = "stl") -> WrittenScene:
    """Write a scene: an ``<Environment>``, or the only body of a scene without a view as the root.

    Args:
        scene: The scene.
        diagnostics: Receives a warning for everything that the format cannot represent.
        meshes: The format of the mesh files.

    Raises:
        OutputError: A name or a number cannot be written.
    """
    writer = _Writer(diagnostics, meshes)
    out = writer.out
    if scene.view is None and scene.gravity is None and len(scene.bodies) == 1 and not scene.sensors:
        writer.write_body(scene.bodies[0])
    else:
        with out.inside("Environment"):
            writer.write_view(scene.view or View())
            if scene.gravity is not None:
                with out.inside("PhysicsEngine", type="GenericPhysicsEngine"), out.inside("odeproperties"):
                    out.element("gravity", scene.gravity)
            for body in scene.bodies:
                writer.write_body(body)
            for sensor in scene.sensors:
                writer.write_sensor(sensor)
    return WrittenScene(out.document(), writer.geoms.files)


class _Writer:
    def __init__(self, diagnostics: Diagnostics, meshes: MeshFormat) -> None:
        self.diagnostics = diagnostics
        self.out = XmlText()
        self.geoms = GeomWriter(self.out, diagnostics, meshes)

    def write_view(self, view: View) -> None:
        if view.background is not None:
            self.out.element("bkgndColor", view.background)
        if view.T_world_camera is not None:
            camera = settled.pose(view.T_world_camera)
            self.out.element("camtrans", camera.position)
            self.out.element("camrotationaxis", settled.axis_angle(camera.wxyz))

    def write_body(self, body: KinBody) -> None:
        _check_name("body", body.name)
        joined = None if body.joined_links_adjacent else 0
        body = writable(body, self.diagnostics)
        names = PartNames(body, self.diagnostics)
        if not body.is_robot:
            if body.manipulators or body.sensors:
                message = f"'{body.name}' is not a robot; its manipulators and sensors are left out"
                self.diagnostics.warn("not-written", message, body.source)
            with self.out.inside("KinBody", name=body.name, makeJoinedLinksAdjacent=joined):
                self._write_parts(body, names)
                self._write_state(body, names)
            return
        with self.out.inside("Robot", name=body.name):
            with self.out.inside("KinBody", makeJoinedLinksAdjacent=joined):
                self._write_parts(body, names)
            for manipulator in body.manipulators:
                self._write_manipulator(manipulator, names)
            for sensor in body.sensors:
                self._write_attached_sensor(sensor, names)
            self._write_state(body, names)

    def _write_parts(self, body: KinBody, names: PartNames) -> None:
        """Write links, joints and adjacent link pairs."""
        poses = [settled.pose(pose) for pose in listed_poses(body)]
        for link, name, pose in zip(body.links, names.links, poses, strict=True):
            self._write_link(link, name, pose)
        JointWriter(self.out, self.diagnostics, names, poses).write_all(body)
        for first, second in body.adjacent:
            self.out.element("adjacent", f"{names.links[first]} {names.links[second]}")

    def _write_state(self, body: KinBody, names: PartNames) -> None:
        """Write joint values and grabbed bodies."""
        if needs_values(body):
            self.out.element("jointvalues", [axis.value for axis in body.dof_axes])
        for grab in body.grabs:
            ignored = " ".join(names.links[link] for link in grab.ignored) or None
            with self.out.inside("grabbed", body=grab.body, link=names.links[grab.link], ignored=ignored):
                write_pose(self.out, settled.pose(grab.T_link_body))

    def _write_link(self, link: Link, name: str, pose: Pose) -> None:
        attributes = {"name": name or None, "type": "static" if link.static else "dynamic"}
        attributes |= {"selfcollision": False if link.self_collision_ignored else None}
        with self.out.inside("Body", **attributes, enable=None if link.enabled else False):
            write_pose(self.out, pose)
            self._write_mass(link.inertial)
            for geometry in link.geometries:
                self.geoms.write(geometry)
            self._write_groups(link)
            write_parameters(self.out, link.parameters)

    def _write_groups(self, link: Link) -> None:
        for group, geometries in link.groups:
            if group == OWN_SHAPES or not geometries:
                message = f"of link '{link.name}' the group of shapes '{group}', which others replace, is left out"
                if group != OWN_SHAPES:
                    message = f"of link '{link.name}' the group '{group}' without shapes is left out"
                self.diagnostics.warn("not-written", message, link.source)
                continue
            for geometry in geometries:
                self.geoms.write(geometry, group)

    def _write_mass(self, inertial: Inertial) -> None:
        with self.out.inside("Mass", type="custom"):
            self.out.element("total", inertial.mass)
            if single(inertial.mass) != inertial.mass:
                self.out.element("precisetotal", inertial.mass)
            if inertial.com != ZERO:
                self.out.element("com", inertial.com)
            self.out.element("inertia", [part for row in inertial.inertia for part in row])
            axes = settled.pose(principal_frame(inertial)).wxyz
            if axes != settled.pose(principal_frame(replace(inertial, axes=None))).wxyz:
                self.out.element("principalaxes", axes)

    def _write_manipulator(self, manipulator: Manipulator, names: PartNames) -> None:
        with self.out.inside("Manipulator", name=manipulator.name):
            if manipulator.base is not None:
                self.out.element("base", names.links[manipulator.base])
            if manipulator.effector is not None:
                self.out.element("effector", names.links[manipulator.effector])
            if manipulator.gripper_joints:
                self.out.element("gripperjoints", " ".join(names.joints[joint] for joint in manipulator.gripper_joints))
                self.out.element("closingdirection", manipulator.chucking_direction)
            if manipulator.ik_solver:
                self.out.element("iksolver", manipulator.ik_solver)
            self.out.element("direction", settled.direction(manipulator.direction))
            write_pose(self.out, settled.pose(manipulator.T_effector_tool))

    def write_sensor(self, sensor: AttachedSensor) -> None:
        """Write a sensor that is not attached to a robot."""
        _check_name("sensor", sensor.name)
        kind = None if sensor.type is None else sensor_kind(sensor.type)
        if kind is None:
            message = f"'{sensor.name}' is left out: OpenRAVE XML knows no sensor of type '{sensor.type}'"
            self.diagnostics.warn("not-written", message, sensor.source)
            return
        with self.out.inside("Sensor", name=sensor.name, type=kind.name):
            write_pose(self.out, settled.pose(sensor.T_link_sensor))
            self._write_device(sensor, kind)

    def _write_attached_sensor(self, sensor: AttachedSensor, names: PartNames) -> None:
        kind = None if sensor.type is None else sensor_kind(sensor.type)
        if kind is None and sensor.type is not None:
            message = f"OpenRAVE XML knows no sensor of type '{sensor.type}'; of '{sensor.name}' only the frame is kept"
            self.diagnostics.warn("not-written", message, sensor.source)
        with self.out.inside("AttachedSensor", name=sensor.name):
            if sensor.link is not None:
                self.out.element("link", names.links[sensor.link])
            write_pose(self.out, settled.pose(sensor.T_link_sensor))
            if kind is not None:
                with self.out.inside("Sensor", type=kind.name):
                    self._write_device(sensor, kind)

    def _write_device(self, sensor: AttachedSensor, kind: SensorKind) -> None:
        for tag, content in written(sensor.device or kind.device):
            self.out.element(tag, content)
        if sensor.is_on:
            self.out.element("power", 1)
        if sensor.color != SENSOR_COLOR:
            self.out.element("color", sensor.color)


def _check_name(kind: str, name: str) -> None:
    if not name or " " in name or not name.isprintable():
        raise OutputError(f"OpenRAVE reads no {kind} with the name {name!r}; give it one without spaces")

"""Sensors of joints and of the base, and the model's own sensors."""

import math
from collections.abc import Sequence

from ravemj.core.transforms import Pose
from ravemj.errors import Diagnostics
from ravemj.formats.mjcf.lines import Attribute, XmlLines, pose_attributes
from ravemj.model.scene import AttachedSensor, ForceTorque, Imu, Intrinsics, Joint, JointEncoder, KinBody

_IMU = ("accelerometer", "gyro")
_BACK: Pose = Pose((0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0))
"""Half turn about x: MuJoCo's cameras look along -z with y up, OpenRAVE's along z with y down."""


class SensorWriter:
    """Writes sites and cameras into links, and collects the sensors.

    Attributes:
        lines: The content of the section ``<sensor>``.
    """

    def __init__(self, diagnostics: Diagnostics, taken: set[str]) -> None:
        """Start without sensors; ``taken`` are the names of sites, to which new names are added."""
        self.lines = XmlLines(2)
        self._diagnostics = diagnostics
        self._taken = taken

    def write_joints(self, joints: Sequence[Joint], names: Sequence[tuple[str, ...]]) -> None:
        """Write position and velocity sensors for each moving joint."""
        for joint, joint_names in zip(joints, names, strict=True):
            kinds = ("ballquat", "ballangvel") if joint.is_ball else ("jointpos", "jointvel")
            for name in joint_names:
                for kind in kinds:
                    self.lines.element(kind, joint.source, name=self._free(f"{name}/{kind}"), joint=name)

    def write_on_link(self, body: KinBody, link: int, T_body_link: Pose, out: XmlLines) -> None:
        """Write the sensors of a link: the IMU of a robot's base, and the robot's own sensors."""
        if link == 0 and body.joints:
            self._write_at_site("imu", _IMU, T_body_link, body.links[0].source, out)
        for sensor in body.sensors:
            if sensor.link == link:
                self._write_own(sensor, T_body_link @ sensor.T_link_sensor, out)

    def write_tools(self, body: KinBody, link: int, T_body_link: Pose, out: XmlLines) -> None:
        """Write a site for the tool of each manipulator whose end effector is the link."""
        for arm in body.manipulators:
            if arm.effector == link:
                pose = pose_attributes(T_body_link @ arm.T_effector_tool)
                out.element("site", arm.source, name=self._free(arm.name), **pose, group=4)

    def _write_own(self, sensor: AttachedSensor, pose: Pose, out: XmlLines) -> None:
        device = sensor.device
        if isinstance(device, Intrinsics):
            name = self._free(sensor.name)
            out.element("camera", sensor.source, name=name, **pose_attributes(pose @ _BACK), **_lens(device))
        elif isinstance(device, Imu):
            self._write_at_site(sensor.name, _IMU, pose, sensor.source, out)
        elif isinstance(device, ForceTorque):
            self._write_at_site(sensor.name, ("force", "torque"), pose, sensor.source, out)
        elif device is not None and not isinstance(device, JointEncoder):
            message = f"sensor '{sensor.name}' of the type {sensor.type} has no counterpart in MJCF and is left out"
            self._diagnostics.warn("not-written", message, sensor.source)

    def _write_at_site(self, name: str, kinds: Sequence[str], pose: Pose, source: object, out: XmlLines) -> None:
        site = self._free(name)
        out.element("site", None, name=site, **pose_attributes(pose), group=4)
        for kind in kinds:
            self.lines.element(kind, None, name=self._free(f"{site}/{kind}"), site=site)

    def _free(self, name: str) -> str:
        """Reserve and return a name that is unique among the written sensors, sites and cameras."""
        unique, number = name, 1
        while unique in self._taken:
            number += 1
            unique = f"{name}-{number}"
        self._taken.add(unique)
        return unique


def _lens(camera: Intrinsics) -> dict[str, Attribute]:
    """Return a camera's field of view and resolution as MJCF attributes; empty if its intrinsics are not positive."""
    if not (camera.fy > 0 and camera.height > 0 and camera.width > 0):
        return {}
    angle = math.degrees(2 * math.atan(camera.height / 2 / camera.fy))
    return {"fovy": angle, "resolution": (camera.width, camera.height)}

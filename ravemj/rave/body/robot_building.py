"""Robots made in code."""

from collections.abc import Sequence

from ravemj.rave.body.building import Building
from ravemj.rave.infos import (
    AttachedSensorInfo,
    ExtractInfoOptions,
    JointInfo,
    LinkInfo,
    ManipulatorInfo,
    RobotBaseInfo,
)


class RobotBuilding(Building):
    """Makes a robot anew, with its arms and sensors."""

    def Init(  # pyright: ignore[reportIncompatibleMethodOverride] - OpenRAVE's arguments
        self,
        linkinfos: Sequence[LinkInfo],
        jointinfos: Sequence[JointInfo],
        manipinfos: Sequence[ManipulatorInfo] = (),
        attachedsensorinfos: Sequence[AttachedSensorInfo] = (),
        uri: str = "",
    ) -> bool:
        """Make the robot of links, joints, arms and sensors.

        Args:
            linkinfos: The descriptions of the links; the first one is the root.
            jointinfos: The descriptions of the joints; those with DOFs in DOF order.
            manipinfos: The descriptions of the arms; the first one is active.
            attachedsensorinfos: The descriptions of the sensors on its links.
            uri: Not used.

        Returns:
            True.

        Raises:
            openrave_exception: the robot is in an environment, or an info describes nothing that can be. Nothing has
                changed then.
        """
        del uri
        info = RobotBaseInfo(
            _vLinkInfos=linkinfos,
            _vJointInfos=jointinfos,
            _vManipInfos=manipinfos,
            _vAttachedSensorInfos=attachedsensorinfos,
        )
        return self.InitFromKinBodyInfo(info)

    def InitFromRobotInfo(self, info: RobotBaseInfo) -> bool:
        """Make the robot, its name included, of a description; see ``InitFromKinBodyInfo``.

        Args:
            info: The description, for instance of ``ExtractInfo``.

        Returns:
            True.
        """
        return self.InitFromKinBodyInfo(info)

    def ExtractInfo(self, options: int = ExtractInfoOptions.Everything) -> RobotBaseInfo:
        """Return the description of the robot as it stands, a copy.

        Args:
            options: What to take, ``ExtractInfoOptions``.
        """
        body = self._state.scene
        return RobotBaseInfo(
            **self.extracted(options),
            _vManipInfos=[ManipulatorInfo.of(body, arm) for arm in body.manipulators],
            _vAttachedSensorInfos=[AttachedSensorInfo.of(body, sensor) for sensor in body.sensors],
        )

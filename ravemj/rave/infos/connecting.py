"""Merges the descriptions of connected bodies into the description of their robot."""

# The fields have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import re
from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from ravemj.core.arrays import checked_transform
from ravemj.errors import ArgumentError
from ravemj.rave.enums import JointType
from ravemj.rave.infos.body import RobotBaseInfo
from ravemj.rave.infos.connected import ConnectedBodyInfo
from ravemj.rave.infos.joint import JointInfo

_LISTS = ("_vLinkInfos", "_vJointInfos", "_vManipInfos", "_vAttachedSensorInfos", "_vGripperInfos")
_WORD = re.compile(r"[^\W\d]\w*")

Rename = Callable[[str | None], str]


def with_connected(robot: RobotBaseInfo, bodies: Iterable[ConnectedBodyInfo]) -> RobotBaseInfo:
    """Return a robot with the parts of connected bodies.

    The names of these parts begin with the name of their body and an underscore.

    Raises:
        ArgumentError: the robot does not have the link that should carry a body, or a body has no links.
    """
    for body in bodies:
        robot = _with_one(robot, body)
    return robot


def only_parts_of(robot: RobotBaseInfo, own: RobotBaseInfo) -> RobotBaseInfo:
    """Return a robot reduced to the parts whose names another description contains."""
    kept = {name: {one._name for one in getattr(own, name)} for name in _LISTS}
    parts = {name: [one for one in getattr(robot, name) if one._name in kept[name]] for name in _LISTS}
    joints = kept["_vJointInfos"]
    return replace(robot, **parts, _dofValues=[value for value in robot._dofValues if value[0][0] in joints])


def _with_one(robot: RobotBaseInfo, body: ConnectedBodyInfo) -> RobotBaseInfo:
    carrier = next((link for link in robot._vLinkInfos if link._name == body._linkname), None)
    if carrier is None or not body._linkInfos:
        raise ArgumentError(
            f"connected body '{body._name}': it needs links, and a link '{body._linkname}' of the robot"
        )
    relative = checked_transform(body._trelative, "ConnectedBodyInfo._trelative")
    T_robot_body = checked_transform(carrier._t, "LinkInfo._t") @ relative
    lists = (body._linkInfos, body._jointInfos, body._gripperInfos)
    names = {one._name for infos in lists for one in infos}

    def own(name: str | None) -> str:  # only the body's own parts get the prefix; they may refer to parts of the robot
        return f"{body._name}_{name}" if name in names else name or ""

    links = [
        replace(
            link,
            _name=own(link._name),
            _t=T_robot_body @ checked_transform(link._t, "LinkInfo._t"),
            _vForcedAdjacentLinks=[own(name) for name in link._vForcedAdjacentLinks],
        )
        for link in body._linkInfos
    ]
    joints = [_renamed(joint, own) for joint in body._jointInfos]
    arms = [
        replace(
            arm,
            _name=f"{body._name}_{arm._name}",
            _sBaseLinkName=own(arm._sBaseLinkName),
            _sEffectorLinkName=own(arm._sEffectorLinkName),
            _vGripperJointNames=[own(name) for name in arm._vGripperJointNames],
            _grippername=own(arm._grippername),
        )
        for arm in body._manipulatorInfos
    ]
    sensors = [
        replace(sensor, _name=f"{body._name}_{sensor._name}", _linkname=own(sensor._linkname))
        for sensor in body._attachedSensorInfos
    ]
    grippers = [
        replace(
            gripper, _name=own(gripper._name), _gripperJointNames=[own(name) for name in gripper._gripperJointNames]
        )
        for gripper in body._gripperInfos
    ]
    joints = [_weld(body, str(carrier._name), str(links[0]._name)), *joints]
    added = zip(_LISTS, (links, joints, arms, sensors, grippers), strict=True)
    return replace(robot, **{name: [*getattr(robot, name), *parts] for name, parts in added})


def _renamed(joint: JointInfo, own: Rename) -> JointInfo:
    # Equations contain the names of joints: every word that is one gets the prefix, functions and numbers do not.
    mimic = [one and [_WORD.sub(lambda word: own(word[0]), equation) for equation in one] for one in joint._vmimic]
    linkname0, linkname1 = own(joint._linkname0), own(joint._linkname1)
    return replace(joint, _name=own(joint._name), _linkname0=linkname0, _linkname1=linkname1, _vmimic=mimic)


def _weld(body: ConnectedBodyInfo, carrier: str, root: str) -> JointInfo:
    """Return the joint without DOFs that fixes a body to the robot, under OpenRAVE's name for it."""
    return JointInfo(
        _name=f"{body._name}___dummyconnectedbody__",
        _type=JointType.Prismatic,
        _linkname0=carrier,
        _linkname1=root,
        _vaxes=[np.array([0.0, 0.0, 1.0])],
        _bIsActive=False,
    )

"""The description of an environment."""

# JSON and users put anything into the fields that the functions of forms take.
# pyright: reportUnknownLambdaType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.engine.simulation import DEFAULT_GRAVITY
from ravemj.rave.infos.base import Info, info_class, json_field
from ravemj.rave.infos.body import KinBodyInfo, RobotBaseInfo
from ravemj.rave.infos.json import TEXT, Form, Json, infos, parameters
from ravemj.rave.units import UnitInfo


def _read_units(value: Json, scale: float, present: UnitInfo) -> UnitInfo:
    del scale
    changed = replace(present)
    changed.DeserializeJSON(value)
    return changed


_UNITS = Form(lambda units, scale: units.SerializeJSON(), _read_units)
_BODIES = infos(KinBodyInfo, robot=RobotBaseInfo)


@info_class
class EnvironmentBaseInfo(Info):
    """The description of an environment.

    Attributes:
        _vBodyInfos: The bodies, a list of ``KinBodyInfo`` and ``RobotBaseInfo``.
        _gravity: The gravitational acceleration in the world frame [m/s^2], shape (3,).
        _description: A text for people; ``_keywords`` is a list of words.
        _uInt64Parameters: Integers of the user by name.
        _unitInfo: The units, a ``UnitInfo``.
    """

    _vBodyInfos: Sequence[KinBodyInfo] = json_field("bodies", _BODIES, default=[], optional=True)
    _gravity: ArrayLike = json_field("gravity", default=np.array(DEFAULT_GRAVITY))
    _description: str = json_field("description", TEXT, default="", optional=True)
    _keywords: Sequence[str] = json_field("keywords", default=[])
    _uInt64Parameters: dict[str, int] = json_field("uint64Parameters", parameters("value"), default={}, optional=True)
    _unitInfo: UnitInfo = json_field("unitInfo", _UNITS, default=UnitInfo())
    _revision: int = 0

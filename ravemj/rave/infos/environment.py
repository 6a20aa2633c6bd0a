"""The description of an environment."""

# JSON and users put anything into the fields that the functions of forms take.
# pyright: reportUnknownLambdaType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownMemberType=false

from collections.abc import Sequence
from dataclasses import field, replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.engine.simulation import DEFAULT_GRAVITY
from ravemj.rave.infos.base import Info, info_class
from ravemj.rave.infos.body import KinBodyInfo, RobotBaseInfo
from ravemj.rave.infos.json import PLAIN, TEXT, Entry, Form, Json, infos, parameters
from ravemj.rave.units import UnitInfo


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

    _called = "EnvironmentBaseInfo"

    _vBodyInfos: Sequence[KinBodyInfo] = field(default_factory=list[KinBodyInfo])
    _gravity: ArrayLike = field(default_factory=lambda: np.array(DEFAULT_GRAVITY))
    _description: str = ""
    _keywords: Sequence[str] = field(default_factory=list[str])
    _uInt64Parameters: dict[str, int] = field(default_factory=dict[str, int])
    _unitInfo: UnitInfo = field(default_factory=UnitInfo)
    _revision: int = 0

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        del obj
        return _ENVIRONMENT_JSON


_UNITS = Form(lambda units, scale: units.SerializeJSON(), lambda value, scale, present: _units(value, present))
_ENVIRONMENT_JSON = (
    Entry("keywords", "_keywords", PLAIN),
    Entry("description", "_description", TEXT, optional=True),
    Entry("unitInfo", "_unitInfo", _UNITS),
    Entry("gravity", "_gravity", PLAIN),
    Entry("uint64Parameters", "_uInt64Parameters", parameters("value"), optional=True),
    Entry(
        "bodies",
        "_vBodyInfos",
        infos(lambda item: RobotBaseInfo() if item.get("isRobot") else KinBodyInfo()),
        optional=True,
    ),
)


def _units(value: Json, present: UnitInfo) -> UnitInfo:
    changed = replace(present)
    changed.DeserializeJSON(value)
    return changed

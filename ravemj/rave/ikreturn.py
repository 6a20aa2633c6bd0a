"""Results of inverse kinematics: solutions, and reasons of failures."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.rave.enums import IkReturnAction
from ravemj.rave.report import CollisionReport
from ravemj.rave.specification import IkParameterization


class IkReturn(ApiObject):
    """Result of inverse kinematics: a solution, or the reasons of the failure. Filters return it, too.

    Args:
        action: ``Success``; else the combined reasons of all rejections.

    Example:
        >>> answer = manip.FindIKSolution(T_world_tool, 0, ikreturn=True)
        >>> if answer.GetAction() == IkReturnAction.Success:
        ...     robot.SetDOFValues(answer.GetSolution(), manip.GetArmIndices())
    """

    def __init__(self, action: IkReturnAction | int) -> None:
        self._action = IkReturnAction(action)
        self._solution = np.zeros(0)
        self._map: dict[str, Floats] = {}
        self._user_data: Any = None
        self._failures: list[int] = []

    _internal = ("name_failures", "take")

    def GetAction(self) -> IkReturnAction:
        """Return ``Success``, or the combined reasons of all rejections."""
        return self._action

    def GetSolution(self) -> Floats:
        """Return the joint values [rad or m] in the order of ``GetArmIndices()``, shape (n,), or (0,) without any."""
        return self._solution.copy()

    def SetSolution(self, solution: ArrayLike) -> None:
        """Set the ``solution``, joint values [rad or m], shape (n,).

        In the answer of a filter, it replaces the candidate solution without further checks.
        """
        self._solution = checked_numbers(solution, "SetSolution: solution")

    def GetMapData(self, key: str) -> Floats | None:
        """Return the values attached under the name ``key``, shape (k,), or None."""
        return self._map[key].copy() if key in self._map else None

    def GetMapDataDict(self) -> dict[str, Floats]:
        """Return all attached values by name."""
        return {key: numbers.copy() for key, numbers in self._map.items()}

    def SetMapKeyValue(self, key: str, value: ArrayLike) -> None:
        """Attach numbers under a name.

        Args:
            key: The name.
            value: The numbers, shape (k,).
        """
        self._map[key] = checked_numbers(value, "SetMapKeyValue: value")

    def GetUserData(self) -> Any:  # noqa: ANN401 - any object of the user's
        """Return the object that ``SetUserData`` attached, or None."""
        return self._user_data

    def SetUserData(self, data: Any) -> None:  # noqa: ANN401 - any object of the user's
        """Attach a user object ``data``."""
        self._user_data = data

    def GetIkFailureInfoIndices(self) -> list[int]:
        """Return the indices of this search's failures in the list given as ``ikFailureAccumulator``."""
        return list(self._failures)

    def name_failures(self, indices: list[int]) -> None:
        """Set the indices of the failures in the user's list."""
        self._failures = indices

    def take(self, other: "IkReturn") -> None:
        """Copy the data that a filter attached to its answer."""
        self._map.update(other.GetMapDataDict())
        if other.GetUserData() is not None:
            self._user_data = other.GetUserData()


class IkFailureInfo(ApiObject):
    """Reason of a rejected solution; collected in the list given as ``ikFailureAccumulator``.

    Args:
        action: The reason of the rejection.
        configuration: The joint values that were rejected, shape (n,); none if the goal is out of reach.
        ikparam: The goal, in the frame of the arm's base.
        report: The collision report, if a collision was the reason.
        description: The reason as a sentence.
    """

    def __init__(
        self,
        action: IkReturnAction,
        configuration: Floats,
        ikparam: IkParameterization,
        report: CollisionReport | None = None,
        description: str = "",
    ) -> None:
        self._action, self._configuration, self._goal = action, configuration, ikparam
        self._report = CollisionReport() if report is None else report
        self._description = description

    def GetAction(self) -> IkReturnAction:
        """Return the reason of the rejection."""
        return self._action

    def GetConfiguration(self) -> Floats:
        """Return the rejected joint values [rad or m], shape (n,)."""
        return self._configuration.copy()

    def GetIkParam(self) -> IkParameterization:
        """Return the goal, in the frame of the arm's base."""
        return IkParameterization(self._goal)

    def GetCollisionReport(self) -> CollisionReport:
        """Return the collision report; empty if the reason is not a collision."""
        return self._report

    def GetMapData(self, key: str) -> Floats:
        """Return additional values of a solver, shape (k,); ravemj's solvers provide none.

        Args:
            key: Their name.

        Raises:
            openrave_exception: there are none of that name.
        """
        raise ArgumentError(f"GetMapData: there are no numbers '{key}'")

    def GetMapDataDict(self) -> dict[str, Floats]:
        """Return all additional values of a solver by name: always empty."""
        return {}

    def GetDescription(self) -> str:
        """Return the reason as a sentence."""
        return self._description

    def SerializeJSON(self) -> dict[str, Any]:
        """Return the failure as JSON data: dicts, lists, numbers and strings."""
        return {
            "action": int(self._action),
            "config": self._configuration.tolist(),
            "ikparam": self._goal.SerializeJSON(),
            "description": self._description,
            "collisions": [str(pair) for pair in self._report.collisionInfos],
        }


class IkFailureAccumulatorBase(list[IkFailureInfo]):
    """List of failures for ``ikFailureAccumulator``; any list works."""

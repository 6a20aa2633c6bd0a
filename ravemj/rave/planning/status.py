"""The result of planning, and the progress that callbacks are told."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ravemj.core.api_object import ApiObject
from ravemj.core.transforms import Floats
from ravemj.rave.enums import PlannerStatusCode
from ravemj.rave.report import CollisionReport

if TYPE_CHECKING:
    from ravemj.rave.specification import IkParameterization


class PlanningError(Exception):
    """No motion was found. As in OpenRAVE, this is not an ``openrave_exception``.

    Attributes:
        parameter: The reason.
        recoverySuggestions: What the caller can do instead.
    """

    def __init__(self, parameter: object = "", recoverySuggestions: Sequence[object] | None = None) -> None:
        super().__init__(parameter)
        self.parameter = parameter
        self.recoverySuggestions = list(recoverySuggestions or ())

    def __eq__(self, r: object) -> bool:
        if not isinstance(r, PlanningError):
            return NotImplemented
        return (self.parameter, self.recoverySuggestions) == (r.parameter, r.recoverySuggestions)

    def __hash__(self) -> int:
        return hash(str(self.parameter))


class PlannerStatus(ApiObject):
    """The result of planning, with the reason on failure.

    A status compares with codes and numbers, as in OpenRAVE 0.9: ``status == PlannerStatus.HasSolution``. As a truth
    value it is False without a solution.

    Attributes:
        statusCode: The result, a ``PlannerStatusCode``.
        description: A sentence that says what happened.
        errorOrigin: The planner that failed.
        jointValues: The configuration that caused the failure; empty if none did.
        ikparam: The goal of inverse kinematics that caused the failure, or None.
        report: The collision that caused the failure, or None.
    """

    Failed: ClassVar["PlannerStatus"]
    HasSolution: ClassVar["PlannerStatus"]
    Interrupted: ClassVar["PlannerStatus"]
    InterruptedWithSolution: ClassVar["PlannerStatus"]

    statusCode: PlannerStatusCode = PlannerStatusCode.Failed
    description: str = ""
    errorOrigin: str = ""
    jointValues: Floats = np.zeros(0)
    ikparam: "IkParameterization | None" = None
    report: CollisionReport | None = None

    def __init__(
        self,
        description: str = "",
        statusCode: int = PlannerStatusCode.Failed,
        errorOrigin: str = "",
        *,
        jointValues: Floats | None = None,
        report: CollisionReport | None = None,
    ) -> None:
        self.statusCode = PlannerStatusCode(int(statusCode))
        self.description = description
        self.errorOrigin = errorOrigin
        self.jointValues = np.zeros(0) if jointValues is None else jointValues
        self.ikparam = None
        self.report = report

    def __bool__(self) -> bool:
        return bool(self.statusCode & PlannerStatusCode.HasSolution)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, PlannerStatus):
            return self.statusCode == other.statusCode
        return self.statusCode == other if isinstance(other, int) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.statusCode)

    def __and__(self, other: Any) -> PlannerStatusCode:  # noqa: ANN401 - a status, a code or a number
        return self.statusCode & (other.statusCode if isinstance(other, PlannerStatus) else int(other))

    __rand__ = __and__

    def __repr__(self) -> str:
        return f"<PlannerStatus {self.statusCode.name}: {self.description}>"


for _code in PlannerStatusCode.__members__.values():
    setattr(PlannerStatus, str(_code.name), PlannerStatus(f"{_code.name}", _code))


class PlannerProgress(ApiObject):
    """The progress of a planner, as callbacks of ``planner.RegisterPlanCallback`` get it.

    Attributes:
        _iteration: The number of finished iterations.
    """

    def __init__(self, iteration: int) -> None:
        self._iteration = iteration

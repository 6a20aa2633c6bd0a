"""How planning ended."""

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
    """No motion was found; not an ``openrave_exception``.

    Attributes:
        parameter: Why.
        recoverySuggestions: What the caller can do instead.
    """

    def __init__(self, parameter: object = "", recoverySuggestions: Sequence[object] | None = None) -> None:
        super().__init__(parameter)
        self.parameter = parameter
        self.recoverySuggestions = list(recoverySuggestions or ())


class PlannerStatus(ApiObject):
    """How planning ended, and on failure why.

    It compares with codes and numbers, as in OpenRAVE 0.9: ``status == PlannerStatus.HasSolution``; a status without a
    solution is false.

    Attributes:
        statusCode: How it ended, a ``PlannerStatusCode``.
        description: A sentence that says what happened.
        errorOrigin: The planner that failed.
        jointValues: The configuration that is to blame; empty if none is.
        ikparam: The goal of inverse kinematics that is to blame, or None.
        report: The collision that is to blame, or None.
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
    """What a function of ``planner.RegisterPlanCallback`` is told.

    Attributes:
        _iteration: How many iterations are over.
    """

    def __init__(self, iteration: int) -> None:
        self._iteration = iteration

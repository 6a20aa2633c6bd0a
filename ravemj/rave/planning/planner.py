"""Base class of planners, their status, and the progress passed to callbacks."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.handles import Handle, registered
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.manipulation.refusals import Tally
from ravemj.rave.enums import InterfaceType, PlannerAction, PlannerStatusCode
from ravemj.rave.interface import Interface
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.values import Values
from ravemj.rave.report import CollisionReport
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import Trajectory

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.specification import IkParameterization


class PlannerStatus(ApiObject):
    """Result of planning, with the reason of a failure.

    A status compares with codes and numbers, as in OpenRAVE 0.9: ``status == PlannerStatus.HasSolution``. As a truth
    value it is False without a solution.

    Attributes:
        statusCode: The result, a ``PlannerStatusCode``.
        description: The result as a sentence.
        errorOrigin: The planner that failed.
        jointValues: The configuration that caused the failure; empty if none did.
        ikparam: The goal of inverse kinematics that caused the failure, or None.
        report: The collision that caused the failure, or None.
        start_index: The index of the start of the motion: configurations are counted first, then regions; -1 if
            unknown.
        goal_index: The index of the goal, likewise.
    """

    _internal = ("tally",)

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
    start_index: int = -1
    goal_index: int = -1
    tally: Tally | None = None

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

    @property
    def causes(self) -> dict[str, int]:
        """Number of poses sampled from goal regions, for each cause of failure.

        Poses that gave goals are counted as ``reached``, so that the numbers add up to the number of poses.
        """
        total = Counter[str]()
        for counts in self.causes_by_region.values():
            total.update(counts)
        return dict(total)

    @property
    def causes_by_region(self) -> dict[str, dict[str, int]]:
        """``causes`` of each region, by name; empty without regions."""
        return {} if self.tally is None else self.tally.named()

    @property
    def examples(self) -> dict[str, Floats]:
        """An example configuration for each cause [rad or m], shape (dof,); empty if the poses are out of reach."""
        return (
            {}
            if self.tally is None
            else {cause.value: example.values for cause, example in self.tally.examples.items()}
        )

    def __bool__(self) -> bool:
        return bool(self.statusCode & PlannerStatusCode.HasSolution)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, PlannerStatus):
            return self.statusCode == other.statusCode
        return self.statusCode == other if isinstance(other, int) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.statusCode)

    def __and__(self, other: Any) -> int:  # noqa: ANN401 - a status, a code or a number
        return self.statusCode & (other.statusCode if isinstance(other, PlannerStatus) else int(other))

    __rand__ = __and__

    def __repr__(self) -> str:
        return f"<PlannerStatus {self.statusCode.name}: {self.description}>"


for _code in PlannerStatusCode.__members__.values():
    setattr(PlannerStatus, str(_code.name), PlannerStatus(f"{_code.name}", _code))


class PlanningError(Exception):
    """Error of a failed motion. As in OpenRAVE, this is not an ``openrave_exception``.

    Attributes:
        parameter: The reason.
        recoverySuggestions: Suggestions for the caller.
        status: The status of the planner that failed last, or None.
    """

    def __init__(
        self,
        parameter: object = "",
        recoverySuggestions: Sequence[object] | None = None,
        *,
        status: PlannerStatus | None = None,
    ) -> None:
        super().__init__(parameter)
        self.parameter, self.status = parameter, status
        self.recoverySuggestions = list(recoverySuggestions or ())

    def __eq__(self, r: object) -> bool:
        if not isinstance(r, PlanningError):
            return NotImplemented
        return (self.parameter, self.recoverySuggestions) == (r.parameter, r.recoverySuggestions)

    def __hash__(self) -> int:
        return hash(str(self.parameter))


class PlannerProgress(ApiObject):
    """Progress of a planner, the argument of callbacks of ``planner.RegisterPlanCallback``.

    Attributes:
        _iteration: The number of finished iterations.
    """

    def __init__(self, iteration: int) -> None:
        self._iteration = iteration


PlanCallback = Callable[[PlannerProgress], int | None]
"""Callback with the progress; returns a ``PlannerAction``, or None to continue."""


class Planner(Interface):
    """Base class of planners, which find, smooth or time paths; ``RaveCreatePlanner`` makes planners."""

    PlannerParameters = PlannerParameters
    PlannerStatus = PlannerStatus
    PlannerStatusCode = PlannerStatusCode

    _interface_type = InterfaceType.planner
    _internal = ("run",)
    _takes_text: ClassVar[bool] = False
    """Whether the planner accepts parameters as text: only retimers and smoothers do, as a text cannot name bodies."""
    _defaults: ClassVar[Mapping[str, str]] = {}
    """Default texts of the planner-specific parameters, by tag."""

    def __init__(self, env: "Environment", xmlid: str) -> None:
        super().__init__(env, xmlid)
        self._values: Values | None = None
        self._callbacks: list[PlanCallback] = []
        self._action = 0

    @also_named(xmlparams="params")
    def InitPlan(self, robot: Robot | None, params: PlannerParameters | str, releasegil: bool = False) -> bool:
        """Set the problem, and check its starts and goals.

        Args:
            robot: Not used, since the problem names the bodies.
            params: The problem; it is copied. Retimers and smoothers also accept it as XML text.
            releasegil: Not used.

        Returns:
            Whether planning can start. False if there is no start or no goal, or if all starts or all goals collide or
            are outside the limits; the status of ``PlanPath`` then says which.

        Raises:
            TypeError: ``params`` is neither ``PlannerParameters`` nor a text.
            ArgumentError: ``params`` is a text, and this planner needs to know the bodies.
        """
        del robot, releasegil
        self._values = None
        if isinstance(params, str):
            if not self._takes_text:
                raise ArgumentError(f"{self._xmlid}: a text does not say what moves; give PlannerParameters")
            self._values = Values().with_tags(params)
        elif isinstance(params, PlannerParameters):  # pyright: ignore[reportUnnecessaryIsInstance] - users' values
            self._values = PlannerParameters(params).resolved()
        else:
            raise TypeError(f"InitPlan: params is of type {type(params).__name__}, and should be PlannerParameters")
        return self._prepare(self._values) is None

    def GetParameters(self) -> PlannerParameters | None:
        """Return a copy of the problem with all defaults filled in; None before ``InitPlan``."""
        return None if self._values is None else PlannerParameters.of(self._values, self._defaults)

    def PlanPath(self, traj: Trajectory, releasegil: bool = True) -> PlannerStatus:
        """Solve the problem. Afterwards the robot's configuration is restored.

        Args:
            traj: Receives the motion, and is the input of retimers and smoothers. It is unchanged after a failure.
            releasegil: Not used.

        Returns:
            The status; on failure its ``description`` says why.

        Example:
            >>> status = planner.PlanPath(trajectory)
            >>> if status != PlannerStatus.HasSolution:
            ...     print(status.description)
        """
        del releasegil
        checked_kind(traj, Trajectory, "PlanPath: traj")
        if self._values is None:
            return self._failed("there is no problem; call InitPlan first")
        with self._env.simulation.lock:
            return self.run(self._values, traj)

    def RegisterPlanCallback(self, callback: PlanCallback) -> Handle:
        """Register a function that is called during planning.

        Args:
            callback: Called with a ``PlannerProgress`` at the beginning and after each iteration. It returns a
                ``PlannerAction``, or None to continue.

        Returns:
            A handle; deleting or closing it removes the callback.

        Raises:
            ArgumentError: the callback is not a function.
        """
        return registered(self._callbacks, callback, "RegisterPlanCallback: callback")

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Solve a problem, and write the result into a trajectory. The caller holds the lock."""
        raise NotImplementedError

    def _prepare(self, values: Values) -> PlannerStatus | None:
        """Return a failure status if the parameters are unsuitable, else None."""
        del values
        return None

    def _proceed(self, iteration: int) -> bool:
        """Call the user's callbacks; return False if one of them interrupts."""
        for callback in tuple(self._callbacks):
            self._action = int(callback(PlannerProgress(iteration)) or 0)
            if self._action == PlannerAction.Interrupt:
                return False
        return True

    def _failed(self, description: str) -> PlannerStatus:
        return PlannerStatus(description, PlannerStatusCode.Failed, self._xmlid)

    def _solved(self, description: str) -> PlannerStatus:
        return PlannerStatus(description, PlannerStatusCode.HasSolution)

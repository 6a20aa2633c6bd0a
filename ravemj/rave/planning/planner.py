"""The base of all planners."""

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, ClassVar

from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.handles import Handle
from ravemj.errors import ArgumentError
from ravemj.rave.enums import InterfaceType, PlannerAction, PlannerStatusCode
from ravemj.rave.interface import Interface
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.status import PlannerProgress, PlannerStatus
from ravemj.rave.planning.values import Values
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import Trajectory
from ravemj.rave.user_data import Annotations

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

PlanCallback = Callable[[PlannerProgress], int | None]
"""A function of the progress; it returns a ``PlannerAction``, or None to go on."""


class Planner(Interface):
    """Finds motions, or gives them times; ``RaveCreatePlanner`` makes it."""

    PlannerParameters = PlannerParameters
    PlannerStatus = PlannerStatus
    PlannerStatusCode = PlannerStatusCode

    _interface_type = InterfaceType.planner
    _internal = ("run",)
    _takes_text: ClassVar[bool] = False
    """Whether parameters as text are enough, which say nothing about bodies."""
    _defaults: ClassVar[Mapping[str, str]] = {}
    """Parameters of this kind of planner, by their tags."""

    def __init__(self, env: "Environment", xmlid: str) -> None:
        self._env = env
        self._xmlid = xmlid
        self.annotations = Annotations()
        self._values: Values | None = None
        self._callbacks: list[PlanCallback] = []
        self._action = 0

    def GetXMLId(self) -> str:
        """Return the name of the planner, as it was spelled when it was made."""
        return self._xmlid

    @also_named(xmlparams="params")
    def InitPlan(self, robot: Robot | None, params: PlannerParameters | str, releasegil: bool = False) -> bool:
        """Take over a problem.

        Args:
            robot: The robot; not used, since the problem says what moves.
            params: The problem, which is copied; or, for retimers, its text.
            releasegil: Not used.

        Returns:
            Whether it can be solved: False if each start, or each goal, is in collision or outside its limits, or
            there is none. ``PlanPath`` says why.

        Raises:
            TypeError: ``params`` is neither.
            ArgumentError: it is a text, and the planner needs to know what moves.
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
            raise TypeError(f"InitPlan: params is a {type(params).__name__}, and should be PlannerParameters")
        return self._prepare(self._values) is None

    def GetParameters(self) -> PlannerParameters | None:
        """Return the problem as the planner understands it, a copy; None before ``InitPlan``."""
        return None if self._values is None else PlannerParameters.of(self._values, self._defaults)

    def PlanPath(self, traj: Trajectory, releasegil: bool = True) -> PlannerStatus:
        """Solve the problem.

        The robot is where it was afterwards.

        Args:
            traj: Filled with the motion; retimers and smoothers read it first. It stays as it is where there is none.
            releasegil: Not used.

        Returns:
            How it ended; on failure its ``description`` says why.

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
        """Call a function while planning.

        Args:
            callback: Called at the beginning and after each iteration, with a ``PlannerProgress``. It returns a
                ``PlannerAction``.

        Returns:
            A handle; the function is called as long as it exists.
        """
        if not callable(callback):
            raise ArgumentError("RegisterPlanCallback: callback should be a function")
        self._callbacks.append(callback)
        return Handle(_forget, self._callbacks, callback)

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Solve a problem. The caller holds the lock."""
        raise NotImplementedError

    def _prepare(self, values: Values) -> PlannerStatus | None:
        """Return why a problem cannot be solved, or None."""
        del values
        return None

    def _proceed(self, iteration: int) -> bool:
        """Ask the callbacks whether to go on."""
        for callback in tuple(self._callbacks):
            self._action = int(callback(PlannerProgress(iteration)) or 0)
            if self._action == PlannerAction.Interrupt:
                return False
        return True

    def _failed(self, description: str) -> PlannerStatus:
        return PlannerStatus(description, PlannerStatusCode.Failed, self._xmlid)

    def _solved(self, description: str) -> PlannerStatus:
        return PlannerStatus(description, PlannerStatusCode.HasSolution)


def _forget(callbacks: list[PlanCallback], callback: PlanCallback) -> None:
    with suppress(ValueError):
        callbacks.remove(callback)

"""State savers: change a body, and have it back as it was."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from types import TracebackType
from typing import TYPE_CHECKING, Self, cast

from ravemj.core.api_object import ApiObject
from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.body import GrabbedBody
from ravemj.errors import ArgumentError
from ravemj.rave.body.base import BodyPart
from ravemj.rave.body.placement import Placement
from ravemj.rave.enums import SaveParameters
from ravemj.rave.interface import checked_kind

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody

Restorer = Callable[["KinBody"], None]
"""Gives a body, the saved one or one like it, a part of its state back."""

_AXIS_FIELDS = {
    SaveParameters.JointLimits: ("lower", "upper"),
    SaveParameters.JointMaxVelocityAndAcceleration: ("max_velocity", "max_acceleration"),
    SaveParameters.JointWeights: ("weight",),
    SaveParameters.JointResolutions: ("resolution",),
}


class Saving(Placement):
    """State savers: ``with body:`` and ``body.CreateKinBodyStateSaver``."""

    _internal = ("default_saved", "restorers")

    default_saved = SaveParameters.LinkTransformation | SaveParameters.LinkEnable
    _open_savers: "list[StateSaver]"

    def CreateKinBodyStateSaver(self, options: int | None = None) -> "StateSaver":
        """Save the body's state.

        Args:
            options: What to save, ``SaveParameters`` combined with ``|``; None: poses, joint values and enabled links.

        Returns:
            A saver: ``with`` it, the state comes back at the end of the block, also after an exception. Otherwise
            ``Restore()`` brings it back; dropping it does nothing.

        Example:
            >>> with body.CreateKinBodyStateSaver():
            ...     body.SetDOFValues([0.5, 0.5])
        """
        return StateSaver(cast("KinBody", self), options)

    def restorers(self, options: SaveParameters) -> list[Restorer]:
        """Return what gives this body, or one like it, its present state back."""
        state = self._state
        found: list[Restorer] = []
        if options & SaveParameters.GrabbedBodies:
            grabs = state.grabs
            found.append(lambda body: _hold(body.simulation_state, grabs))
        if options & SaveParameters.LinkTransformation:
            saved = state.configuration()
            found.append(lambda body: body.simulation_state.restore(saved))
        if options & SaveParameters.LinkVelocities:
            velocities = state.link_velocities()
            found.append(lambda body: body.simulation_state.set_link_velocities(velocities))
        if options & SaveParameters.LinkEnable:
            enabled = list(state.link_enabled)
            found.append(lambda body: setattr(body.simulation_state, "link_enabled", list(enabled)))
        fields = [name for option, names in _AXIS_FIELDS.items() if options & option for name in names]
        if fields:
            axes = state.scene.dof_axes
            kept = [{name: getattr(axis, name) for name in fields} for axis in axes]
            found.append(lambda body: _set_axes(body, kept))
        return found

    def __enter__(self) -> Self:
        """Lock the environment and save the body: poses, joint values and enabled links come back at the end.

        A robot's active DOFs and active manipulator come back as well. Limits, velocities and what it holds do not.

        Example:
            >>> with robot:
            ...     robot.SetDOFValues([0.5, 0.5])
            ...     hits = env.CheckCollision(robot)
        """
        self._simulation.lock.acquire()
        self._open_savers.append(StateSaver(cast("KinBody", self), None))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Restore the body, and let go of the lock."""
        try:
            self._open_savers.pop().Restore()
        finally:
            self._simulation.lock.release()


class StateSaver(ApiObject):
    """Keeps a state of a body; ``body.CreateKinBodyStateSaver()`` and ``robot.CreateRobotStateSaver()`` make it."""

    def __init__(self, body: "KinBody", options: int | None = None) -> None:
        checked_kind(body, BodyPart, "StateSaver: body", "a KinBody")
        self._body = body
        wanted = body.default_saved if options is None else SaveParameters(options)
        with body.GetEnv().simulation.lock:
            self._restorers = body.restorers(wanted)

    def GetBody(self) -> "KinBody":
        """Return the body."""
        return self._body

    def Restore(self, body: "KinBody | None" = None) -> None:
        """Bring the state back, as often as wanted.

        Args:
            body: Another body of the same structure that should get the state; None: the body itself.
        """
        target = self._body if body is None else body
        checked_kind(target, BodyPart, "Restore: body", "a KinBody")
        if _structure(target) != _structure(self._body):
            raise ArgumentError(f"Restore: body is {target!r}, and should have the structure of {self._body!r}")
        with target.GetEnv().simulation.lock:
            for restore in self._restorers:
                restore(target)

    def Release(self) -> None:
        """Forget the state: nothing is restored any more."""
        self._restorers = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Bring the state back."""
        self.Restore()

    def __repr__(self) -> str:
        return f"<state saver:{self._body.GetName()}>"


def _hold(state: BodyState, grabs: Sequence[GrabbedBody]) -> None:
    """Let a body hold what is still there; in another environment, the bodies of the same names."""
    world = state.simulation
    bodies = [one.body if one.body.simulation is world else world.body(one.body.scene.name) for one in grabs]
    state.grabs = [
        grab._replace(body=body)
        for grab, body in zip(grabs, bodies, strict=True)
        if body is not None and world.holds(state) and world.holds(body) and not body.carries(state)
    ]


def _structure(body: "KinBody") -> tuple[int, int]:
    return len(body.GetLinks()), body.GetDOF()


def _set_axes(body: "KinBody", kept: list[dict[str, float]]) -> None:
    state = body.simulation_state
    axes = [replace(axis, **fields) for axis, fields in zip(state.scene.dof_axes, kept, strict=True)]
    state.edit_axes(axes)

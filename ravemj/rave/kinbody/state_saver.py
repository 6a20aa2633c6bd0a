"""State savers, which restore an earlier state of a body."""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Self

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.blocks import always, exit_in_c
from ravemj.engine.grabbing import still_possible
from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.body import GrabbedBody
from ravemj.errors import ArgumentError
from ravemj.model.limits import with_fields
from ravemj.rave.enums import SaveParameters
from ravemj.rave.kinbody.structure import BodyPart

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody

Restorer = Callable[["KinBody"], None]
"""Function that restores a part of the saved state, on the saved body or on another body of the same structure."""

# Plain numbers, because ``&`` of two flags takes as long as saving a pose.
_TRANSFORMATION, _ENABLE = int(SaveParameters.LinkTransformation), int(SaveParameters.LinkEnable)
_VELOCITIES, _GRABBED = int(SaveParameters.LinkVelocities), int(SaveParameters.GrabbedBodies)
_AXIS_FIELDS = {
    int(SaveParameters.JointLimits): ("lower", "upper"),
    int(SaveParameters.JointMaxVelocityAndAcceleration): ("max_velocity", "max_acceleration"),
    int(SaveParameters.JointWeights): ("weight",),
    int(SaveParameters.JointResolutions): ("resolution",),
}


def body_restorers(state: BodyState, options: int) -> list[Restorer]:
    """Return functions that restore the current state, on this body or on another body of the same structure.

    Args:
        state: The body.
        options: ``SaveParameters`` combined, as a plain number.
    """
    restorers: list[Restorer] = []
    if options & _GRABBED:
        grabs = state.grabs
        moves = bool(options & _TRANSFORMATION)
        restorers.append(lambda body: _hold(body.simulation_state, grabs, moves_held=not moves))
    if options & _TRANSFORMATION:
        saved = state.configuration()
        restorers.append(lambda body: body.simulation_state.restore(saved))
    if options & _VELOCITIES:
        velocities = state.link_velocities()
        restorers.append(lambda body: body.simulation_state.set_link_velocities(velocities))
    if options & _ENABLE:
        enabled = state.link_enabled
        restorers.append(lambda body: setattr(body.simulation_state, "link_enabled", enabled))
    fields = [name for option, names in _AXIS_FIELDS.items() if options & option for name in names]
    if fields:
        axes = state.scene.dof_axes
        kept = {name: [getattr(axis, name) for axis in axes] for name in fields}
        restorers.append(lambda body: _set_axes(body, kept))
    return restorers


class StateSaver(ApiObject):
    """Saved state of a body, restored on leaving a ``with`` block.

    ``body.CreateKinBodyStateSaver()`` and ``robot.CreateRobotStateSaver()`` make state savers.
    """

    def __init__(self, body: "KinBody", options: int | None = None) -> None:
        checked_kind(body, BodyPart, "StateSaver: body", "a KinBody")
        self._body = body
        wanted = body.default_saved if options is None else int(SaveParameters(options))
        with body.GetEnv().simulation.lock:
            self._restorers = body.restorers(wanted)
            self._structure = _structure(body)

    def GetBody(self) -> "KinBody":
        """Return the body."""
        return self._body

    def Restore(self, body: "KinBody | None" = None) -> None:
        """Restore the state. It can be restored several times.

        Args:
            body: The body to change, of the same structure; by default the saved body.
        """
        target = self._body if body is None else body
        checked_kind(target, BodyPart, "Restore: body", "a KinBody")
        if self._restorers and _structure(target) != self._structure:
            saved = "{} links and {} DOFs".format(*self._structure)
            raise ArgumentError(f"Restore: {target!r} should have {saved}, as {self._body!r} had when it was saved")
        with target.GetEnv().simulation.lock:
            for restore in self._restorers:
                restore(target)

    def Release(self) -> None:
        """Discard the state: the saver restores nothing afterwards."""
        self._restorers = []

    Close = Release

    def __enter__(self) -> Self:
        return self

    def _leave(self) -> Callable[..., object]:
        return always(self.Restore)

    __exit__ = exit_in_c(_leave)

    def __repr__(self) -> str:
        return f"<state saver:{self._body.GetName()}>"


def _hold(state: BodyState, grabs: Sequence[GrabbedBody], *, moves_held: bool) -> None:
    """Restore grabs and, if ``moves_held``, the poses of grabbed bodies relative to their links."""
    state.grabs = still_possible(state, grabs)
    if moves_held:
        state.carry()


def _structure(body: "KinBody") -> tuple[int, int]:
    state = body.simulation_state
    return len(state.scene.links), state.dof


def _set_axes(body: BodyPart, kept: Mapping[str, Sequence[float]]) -> None:
    state = body.simulation_state
    state.edit_axes(with_fields(state.scene.dof_axes, range(len(state.scene.dof_axes)), kept))


KinBodyStateSaver = RobotStateSaver = StateRestoreContext = StateSaver
"""Alias of ``StateSaver`` under OpenRAVE's names."""

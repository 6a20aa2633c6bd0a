"""Checks and descriptions of grabbed bodies."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

import numpy as np

from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.body import GrabbedBody
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.infos import GrabbedInfo


def link_index(state: BodyState, link: int | str) -> int:
    """Return the index of a link, given by its index or its name.

    Raises:
        ArgumentError: the body has no such link.
    """
    names = [one.name for one in state.scene.links]
    if isinstance(link, str) and link in names:
        return names.index(link)
    if isinstance(link, str) or not 0 <= link < len(names):
        raise ArgumentError(f"'{state.scene.name}' has no link {link!r}")
    return link


def check_holdable(state: BodyState, held: BodyState) -> None:
    """Check that a body can grab another one.

    Raises:
        RavemjError: the body is not in its environment; or the other body was made for another environment, or holds
            this one.
    """
    if not state.simulation.holds(state):
        message = f"Grab: '{state.scene.name}' is not in this environment; add it first"
        raise RavemjError(message, ErrorCode.NotInitialized)
    if held.simulation is not state.simulation:
        raise ArgumentError(f"Grab: '{held.scene.name}' was made for another environment")
    _check_not_carried_by(state, held)


def _check_not_carried_by(state: BodyState, held: BodyState) -> None:
    if held.carries(state):
        reason = "itself" if held is state else f"'{held.scene.name}', by which it is held itself"
        raise ArgumentError(f"Grab: '{state.scene.name}' cannot hold {reason}")


def grab_of(state: BodyState, held: BodyState) -> GrabbedBody | None:
    """Return the grab by which a body holds another one, or None."""
    return next((grab for grab in state.grabs if grab.body is held), None)


def grabbed_infos(state: BodyState) -> list[GrabbedInfo]:
    """Return the infos of all grabs of a body, for ``ResetGrabbed``."""
    return [GrabbedInfo.of(state.scene, grab) for grab in state.grabs]


def described_grab(state: BodyState, info: GrabbedInfo) -> GrabbedBody:
    """Return the grab that an info describes.

    Raises:
        ArgumentError: the grabbed body or a link does not exist, or the grabbed body holds the other one.
    """
    held = state.simulation.body(info._grabbedname)
    if held is None:
        raise ArgumentError(f"ResetGrabbed: there is no body '{info._grabbedname}' in the environment")
    _check_not_carried_by(state, held)
    ignored = frozenset(link_index(state, name) for name in info._setIgnoreRobotLinkNames)
    link = link_index(state, info._robotlinkname)
    return GrabbedBody(held, link, np.array(info._trelative, dtype=float), ignored)

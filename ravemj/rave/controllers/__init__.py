"""Controllers of robots."""

from typing import TYPE_CHECKING

from ravemj.rave.controllers.base import Controller
from ravemj.rave.controllers.ideal import IdealController
from ravemj.rave.controllers.multi import MultiController
from ravemj.rave.controllers.velocity import VelocityController
from ravemj.rave.interface import asked_for

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

__all__ = [
    "Controller",
    "IdealController",
    "MultiController",
    "RaveCreateController",
    "RaveCreateMultiController",
    "VelocityController",
]

_KINDS: dict[str, type[Controller]] = {
    "idealcontroller": IdealController,
    "idealvelocitycontroller": VelocityController,
    "odevelocity": VelocityController,
    "genericmulticontroller": MultiController,
}


def RaveCreateController(env: "Environment", name: str) -> Controller | None:
    """Make a controller for ``robot.SetController``.

    Args:
        env: The environment of the robot.
        name: ``IdealController``, ``IdealVelocityController`` or ``odevelocity``; letter case does not matter.
            Arguments after a space are ignored.

    Returns:
        The controller; None for an unknown name.

    Example:
        >>> controller = RaveCreateController(env, "IdealController")
        >>> robot.SetController(controller, [0, 1], 0)
        True
    """
    word = asked_for(env, name, "RaveCreateController")[0]
    kind = _KINDS.get(word.lower())
    return None if kind is None else kind(env, word)


def RaveCreateMultiController(env: "Environment", name: str = "") -> MultiController | None:
    """Make a controller that distributes the DOFs of a robot among other controllers.

    Args:
        env: The environment of the robot.
        name: ``GenericMultiController``, or empty.

    Returns:
        The controller; None for an unknown name.
    """
    word = asked_for(env, name, "RaveCreateMultiController")[0] or "GenericMultiController"
    return MultiController(env, word) if _KINDS.get(word.lower()) is MultiController else None

"""What the user selects in a viewer, and who is told."""

import weakref
from typing import Any

from ravemj.core.api_object import ApiObject
from ravemj.core.handles import Handle
from ravemj.engine.simulation import Simulation
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction import Hit, Interaction, Ray
from ravemj.gui.viewers.callbacks import Callback, Callbacks


class Selecting(ApiObject):
    """Part of every viewer: its mouse and keys, and what they select.

    Attributes:
        environment: What the viewer was made for; OpenRAVE's scripts ask ``GetEnv``.
        interaction: Takes events of mouse and keys; ``ravemj.gui.interaction`` says how.
    """

    _internal = ("environment",)

    environment: "weakref.ref[Any] | None" = None

    def __init__(self, simulation: Simulation, camera: Camera, size: tuple[int, int]) -> None:
        self._selection_callbacks = Callbacks()
        self.interaction = Interaction(simulation, camera, size, self._may_select)

    def GetEnv(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the environment that the viewer was made for."""
        return None if self.environment is None else self.environment()

    def GetSelectedBody(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the body that the user selected, also by one of its joints; None if there is none."""
        selection, env = self.interaction.selection, self.GetEnv()
        return None if selection is None or env is None else env.wrap(selection.body)

    def GetSelectedLink(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the link that the user clicked on to select something; None if nothing is selected."""
        selection, body = self.interaction.selection, self.GetSelectedBody()
        return None if selection is None or body is None else body.GetLinks()[selection.link]

    def GetSelectedJoint(self) -> Any:  # noqa: ANN401 - the API stands above viewers
        """Return the joint that the user selected; None if there is none."""
        selection, body = self.interaction.selection, self.GetSelectedBody()
        if selection is None or body is None or selection.dof is None:
            return None
        return body.GetJointFromDOFIndex(selection.dof)

    def RegisterItemSelectionCallback(self, callback: Callback) -> Handle:
        """Have a function called when the user is about to select a link, in the thread of the window.

        Args:
            callback: The function. Its arguments are the link, the point on it in the world [m], shape (3,), and the
                direction from the eye to it, a unit vector of shape (3,). Where it returns True, as in OpenRAVE, it
                has dealt with the click, and nothing is selected.

        Returns:
            A handle; the function is forgotten when it is closed or dropped.

        Raises:
            ArgumentError: this cannot be called.

        Example:
            >>> handle = viewer.RegisterItemSelectionCallback(lambda link, point, direction: print(link.GetName()))
        """
        return self._selection_callbacks.add(callback)

    def _may_select(self, hit: Hit, ray: Ray) -> bool:
        env = self.GetEnv()
        if env is None or not self._selection_callbacks:
            return True
        link = env.wrap(hit.body).GetLinks()[hit.link]
        return not any(self._selection_callbacks.call(link, hit.position.copy(), ray.direction.copy()))

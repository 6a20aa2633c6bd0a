"""What the parts of a link's API share."""

from typing import TYPE_CHECKING

from ravemj.core.api_object import ApiObject
from ravemj.engine.simulation import BodyState
from ravemj.model import scene

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class LinkPart(ApiObject):
    """Part of the API of a link; ``Link`` joins the parts."""

    def __init__(self, parent: "KinBody", state: BodyState, index: int) -> None:
        self._parent = parent
        self._state = state
        self._index = index

    @property
    def _scene(self) -> scene.Link:
        return self._state.scene.links[self._index]

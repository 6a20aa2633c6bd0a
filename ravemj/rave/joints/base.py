"""What the parts of a joint's API share."""

from typing import TYPE_CHECKING

from ravemj.core.api_object import ApiObject
from ravemj.engine.simulation import BodyState
from ravemj.model import scene

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class JointPart(ApiObject):
    """Part of the API of a joint; ``Joint`` joins the parts."""

    def __init__(self, parent: "KinBody", state: BodyState, index: int) -> None:
        self._parent = parent
        self._state = state
        self._index = index

    @property
    def _scene(self) -> scene.Joint:
        body = self._state.scene
        return body.all_joints[self._index]

    @property
    def _is_active(self) -> bool:
        return self._index < len(self._state.scene.joints)

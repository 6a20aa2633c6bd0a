"""What links and joints have in common."""

from abc import abstractmethod
from typing import TYPE_CHECKING

from ravemj.core.api_object import ApiObject
from ravemj.engine.simulation import BodyState
from ravemj.model import scene

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class Member(ApiObject):
    """A link or joint of a body. It is equal to others of its kind at the same place of the same body."""

    def __init__(self, parent: "KinBody", state: BodyState, index: int) -> None:
        self._parent = parent
        self._state = state
        self._index = index

    @property
    @abstractmethod
    def _scene(self) -> scene.Link | scene.Joint:
        """The description as it stands."""

    def GetName(self) -> str:
        """Return the name."""
        return self._scene.name

    def GetParent(self, returnexist: bool = False) -> "KinBody":
        """Return the body that the link or joint belongs to.

        Args:
            returnexist: Not used: the body always exists.
        """
        del returnexist
        return self._parent

    def UpdateInfo(self) -> None:
        """Do nothing: ``GetInfo`` always gives the present state."""

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and self._state is other._state and self._index == other._index

    def __hash__(self) -> int:
        return hash((type(self), id(self._state), self._index))

    def __repr__(self) -> str:
        env, body = self._parent.GetEnv(), self._parent.GetName()
        return f"{env!r}.GetKinBody({body!r}).Get{type(self).__name__}({self.GetName()!r})"

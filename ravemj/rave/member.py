"""The base class of links and joints: name, parent, and parameters of the user."""

from abc import abstractmethod
from collections.abc import Hashable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers, checked_whole_numbers
from ravemj.core.transforms import Floats, Ints
from ravemj.engine.simulation import BodyState
from ravemj.errors import ErrorCode, RavemjError
from ravemj.model import scene
from ravemj.model.scene import Parameters

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


class Member(ApiObject):
    """Base of links and joints. Two objects are equal if they refer to the same link or joint of the same body."""

    _often_called = ("__init__",)

    def __init__(self, parent: "KinBody", state: BodyState, index: int) -> None:
        self._parent = parent
        self._state = state
        self._index = index

    @property
    @abstractmethod
    def _scene(self) -> scene.Link | scene.Joint:
        """Description of the link or joint in the present scene."""

    def _gone(self, kind: str) -> RavemjError:
        """Return the error for a link or joint that no longer exists, since the body was initialized again."""
        return RavemjError(f"'{self._parent.GetName()}' has no {kind} {self._index} any more", ErrorCode.InvalidState)

    @abstractmethod
    def _set_parameters(self, parameters: Parameters) -> None:
        """Replace all parameters; the caller holds the lock."""

    def GetName(self) -> str:
        """Return the name."""
        return self._scene.name

    def GetParent(self, returnexist: bool = False) -> "KinBody":
        """Return the body that the link or joint belongs to; ``returnexist`` has no effect."""
        del returnexist
        return self._parent

    def UpdateInfo(self) -> None:
        """Do nothing: ``GetInfo`` always returns the current state."""

    def GetFloatParameters(self, name: str | None = None, index: int = -1) -> dict[str, Floats] | Floats | float | None:
        """Return the numbers that ``SetFloatParameters`` attached.

        Args:
            name: The name of the parameter; None returns all parameters.
            index: The index of one number; -1 returns all numbers.

        Returns:
            All arrays by name; for a name its array, shape (n,); with an index one number; None for an unknown name.
        """
        return _chosen({key: np.array(values) for key, values in self._scene.parameters.floats}, name, index)

    def SetFloatParameters(self, key: str, parameters: ArrayLike) -> None:
        """Attach numbers under a name.

        Args:
            key: The name.
            parameters: The numbers; [] removes them.
        """
        self._set_parameter("floats", key, tuple(checked_numbers(parameters, "SetFloatParameters").ravel().tolist()))

    def GetIntParameters(self, name: str | None = None, index: int = -1) -> dict[str, Ints] | Ints | int | None:
        """Return the integers that ``SetIntParameters`` attached; see ``GetFloatParameters``.

        Args:
            name: The name of the parameter; None returns all parameters.
            index: The index of one number; -1 returns all numbers.
        """
        arrays = {key: np.array(values, dtype=np.int_) for key, values in self._scene.parameters.integers}
        return _chosen(arrays, name, index)

    def SetIntParameters(self, key: str, parameters: ArrayLike) -> None:
        """Attach integers under a name.

        Args:
            key: The name.
            parameters: The integers; [] removes them.
        """
        numbers = checked_whole_numbers(parameters, "SetIntParameters: parameters")
        self._set_parameter("integers", key, tuple(numbers.tolist()))

    def GetStringParameters(self, name: str | None = None) -> dict[str, str] | str | None:
        """Return the text that ``SetStringParameters`` attached under a name, or None; without a name, all of them."""
        texts = dict(self._scene.parameters.texts)
        return texts if name is None else texts.get(name)

    def SetStringParameters(self, key: str, value: str) -> None:
        """Attach a text under a name.

        Args:
            key: The name.
            value: The text; an empty one removes it.
        """
        self._set_parameter("texts", key, checked_kind(value, str, "SetStringParameters: value", "a text"))

    def _set_parameter(self, field: str, key: str, value: Hashable) -> None:
        checked_kind(key, str, "key", "a text")
        with self._state.simulation.lock:
            items: tuple[tuple[str, Hashable], ...] = getattr(self._scene.parameters, field)
            kept = tuple(item for item in items if item[0] != key)
            changed = replace(self._scene.parameters, **{field: (*kept, (key, value)) if value else kept})
            self._set_parameters(changed)

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and self._state is other._state and self._index == other._index

    def __hash__(self) -> int:
        return hash((type(self), id(self._state), self._index))

    def __repr__(self) -> str:
        env, body = self._parent.GetEnv(), self._parent.GetName()
        return f"{env!r}.GetKinBody({body!r}).Get{type(self).__name__}({self.GetName()!r})"


def _chosen(arrays: dict[str, Any], name: str | None, index: int) -> Any:  # noqa: ANN401 - floats or integers
    """Return all arrays, the array ``name`` or, if ``index`` >= 0, one element; None for an unknown name."""
    if name is None:
        return arrays
    array = arrays.get(name)
    return array if array is None or index < 0 else array[index].item()

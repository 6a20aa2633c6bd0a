"""Protocols of the API objects that viewers use: the environment and its bodies."""

# ruff: noqa: D102 - documented in the classes of the API

from collections.abc import Sequence
from typing import Protocol

from ravemj.engine.simulation import BodyState


class Body(Protocol):
    """Protocol of a body of the OpenRAVE API."""

    @property
    def simulation_state(self) -> BodyState: ...

    def GetLinks(self) -> Sequence[object]: ...

    def GetJointFromDOFIndex(self, dofindex: int, /) -> object: ...


class ShownAnimation(Protocol):
    """A recorded motion that a notebook can display."""

    def _repr_html_(self) -> str: ...


class Host(Protocol):
    """Protocol of an environment of the OpenRAVE API."""

    def wrap(self, body: BodyState, /) -> Body: ...

    def add_file(self, path: str, dropped: Sequence[str] = (), /) -> str: ...

    def animation(self) -> ShownAnimation: ...

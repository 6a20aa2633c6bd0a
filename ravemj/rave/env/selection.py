"""Which bodies of an environment are meant: the selections of ``TriangulateScene`` and ``Save``."""

from collections.abc import Callable, Collection

from ravemj.model.scene import KinBody
from ravemj.rave.enums import SelectionOptions

_SELECTIONS: dict[SelectionOptions, Callable[[KinBody, Collection[str]], bool]] = {
    SelectionOptions.NoRobots: lambda body, names: not body.is_robot,
    SelectionOptions.Robots: lambda body, names: body.is_robot,
    SelectionOptions.Everything: lambda body, names: True,
    SelectionOptions.Body: lambda body, names: body.name in names,
    SelectionOptions.AllExceptBody: lambda body, names: body.name not in names,
}


def selects(options: int, names: Collection[str], body: KinBody) -> bool:
    """Return whether options select a body; ``names`` are for ``Body`` and ``AllExceptBody``."""
    return _SELECTIONS[SelectionOptions(options)](body, names)

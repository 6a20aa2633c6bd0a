"""Names of the parts of a compiled model; unnamed parts are named by MuJoCo's index."""

from collections.abc import Iterable

import mujoco


class ModelNames:
    """Names of bodies and joints, and of links inserted between them.

    Attributes:
        bodies: Name of each body.
        joints: Name of each joint.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.bodies = _completed("body", [model.body(index).name for index in range(model.nbody)])
        self.joints = _completed("joint", [model.joint(index).name for index in range(model.njnt)])
        self._links = set(self.bodies)

    def link(self, name: str) -> str:
        """Return a unique name for an additional link, similar to the given one."""
        while name in self._links:
            name += "_"
        self._links.add(name)
        return name


def one_word(name: str) -> str:
    """Convert a name to a single printable word, as OpenRAVE requires for bodies."""
    return "_".join("".join(letter if letter.isprintable() else " " for letter in name).split()) or "body"


def free_name(name: str, taken: Iterable[str]) -> str:
    """Return a name, with a number appended if it is taken."""
    unique, number, known = name, 0, set(taken)
    while unique in known:
        unique, number = f"{name}{number}", number + 1
    return unique


def _completed(kind: str, names: list[str]) -> list[str]:
    taken = set(names)
    return [name or free_name(f"{kind}{index}", taken) for index, name in enumerate(names)]

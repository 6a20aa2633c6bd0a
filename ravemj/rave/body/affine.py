"""Limits, resolutions and weights of the affine DOFs: the components of the base's pose that can be active.

The 34 methods for them differ only in a kind of DOF and a setting, so they are made from two tables.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import wraps
from inspect import Signature, signature
from typing import NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_vector
from ravemj.core.transforms import Floats, Vec3
from ravemj.engine.affine import translation_columns
from ravemj.geometry_functions.affine import DOFAffine

Topic = TypeVar("Topic")


@dataclass
class AffineKind:
    """The settings of one kind of affine DOFs, arrays of shape (n,)."""

    lower: Floats
    upper: Floats
    max_velocity: Floats
    resolution: Floats
    weight: Floats


class _WithKinds(Protocol):
    affine_kinds: dict[str, AffineKind]


class _Kind(NamedTuple):
    """OpenRAVE's defaults for one kind of affine DOFs, and the words of the docstrings."""

    size: int
    limit: float
    velocity: float
    resolution: float
    weight: float
    values: str
    unit: str


_KINDS = {
    "Translation": _Kind(3, 100, 1.0, 0.001, 2.0, "X, Y and Z", "m"),
    "RotationAxis": _Kind(4, 10000, 0.4, 0.01, 2.0, "angle, for x, y, z and other axes", "rad"),
    "Rotation3D": _Kind(3, 10000, 0.07, 0.01, 1.0, "rotation vector", "rad"),
    "RotationQuat": _Kind(4, 1.0, 1.0, 0.01, 0.4, "quaternion", "1"),
}

_SETTINGS = {
    "Limits": (("lower", "upper"), "lower and upper limits of the base's {values} [{unit}], each of shape ({size},)."),
    "MaxVels": (("max_velocity",), "the velocity limits of the base's {values} [{unit}/s], shape ({size},)."),
    "Resolution": (("resolution",), "the planners' steps of the base's {values} [{unit}], shape ({size},)."),
    "Weights": (("weight",), "the weights of the base's {values} in distances, shape ({size},)."),
}
"""The end of a method's name, the fields of ``AffineKind`` that it handles, and the words of its docstring."""

_ARGUMENTS = {
    "MaxVels": "\n\nArgs:\n    {argument}: Largest velocities.",
    "Resolution": "\n\nArgs:\n    resolution: Step for each value.",
}


def affine_numbers(kinds: Mapping[str, AffineKind], affine: int, axis: Vec3, name: str) -> Floats:
    """Return one setting of several components of a pose, shape (n,).

    Args:
        kinds: The settings.
        affine: The components, bits of ``DOFAffine``.
        axis: The axis of ``DOFAffine.RotationAxis``.
        name: The setting, a field of ``AffineKind``.
    """
    parts = [getattr(kinds["Translation"], name)[translation_columns(affine)]]
    if affine & DOFAffine.RotationAxis:
        # OpenRAVE keeps four numbers for a rotation about an axis: for x, y, z, and for any other axis.
        number = next((number for number in range(3) if axis[number] == 1.0), 3)
        parts.append(getattr(kinds["RotationAxis"], name)[number : number + 1])
    elif affine & DOFAffine.Rotation3D:
        parts.append(getattr(kinds["Rotation3D"], name))
    elif affine & DOFAffine.RotationQuat:
        parts.append(getattr(kinds["RotationQuat"], name))
    return np.concatenate(parts)


def default_kinds() -> dict[str, AffineKind]:
    """Return OpenRAVE's defaults, rounded to single precision as in OpenRAVE."""
    defaults = {name: (-one.limit, one.limit, *one[2:5]) for name, one in _KINDS.items()}
    return {
        name: AffineKind(*(np.full(_KINDS[name].size, float(np.float32(value))) for value in values))
        for name, values in defaults.items()
    }


def with_affine_settings(topic: type[Topic]) -> type[Topic]:
    """Fill in bodies and docstrings of the methods for affine DOFs, which the class declares by signature only."""
    for kind, about in _KINDS.items():
        for setting, (fields, what) in _SETTINGS.items():
            if (kind, setting) == ("RotationQuat", "Limits"):  # one quaternion times an angle, not two limits
                continue
            words = what.format(**about._asdict())
            get, set_ = (getattr(topic, f"{verb}Affine{kind}{setting}") for verb in ("Get", "Set"))
            get.__doc__, set_.__doc__ = f"Return {words}", f"Set {words}{_argument(setting, set_)}"
            for method, body in ((get, _getter(kind, fields)), (set_, _setter(kind, fields, signature(set_)))):
                setattr(topic, method.__name__, wraps(method)(body))
    return topic


def _argument(setting: str, setter: Callable[..., None]) -> str:
    *_, name = signature(setter).parameters
    return _ARGUMENTS.get(setting, "").format(argument=name)


def _getter(kind: str, fields: tuple[str, ...]) -> Callable[[_WithKinds], Floats | tuple[Floats, ...]]:
    def get(self: _WithKinds) -> Floats | tuple[Floats, ...]:
        first, *more = (getattr(self.affine_kinds[kind], field).copy() for field in fields)
        return (first, *more) if more else first

    return get


def _setter(kind: str, fields: tuple[str, ...], arguments: Signature) -> Callable[..., None]:
    def set_(self: _WithKinds, *values: ArrayLike, **named: ArrayLike) -> None:
        _, *given = arguments.bind(self, *values, **named).arguments.values()
        settings = self.affine_kinds[kind]
        count = len(settings.lower)
        pairs = list(zip(fields, given, strict=True))
        checked = {field: checked_vector(one, count, f"SetAffine{kind}: {field}") for field, one in pairs}
        for field, numbers in checked.items():
            setattr(settings, field, numbers)

    return set_

"""IK goals: their values, with a setter and a getter for each type."""

# ruff: noqa: D102 - the docstrings of the last methods come from a table
# The functions of the table are the methods.
# pyright: reportPrivateUsage=false

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_numbers, checked_transform, checked_vector
from ravemj.core.transforms import Floats, pose_of
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.geometry_functions import Ray
from ravemj.geometry_functions.ik_parameterization import (
    checked_goal,
    goal_distance_squared,
    goal_moved_in_its_frame,
    goal_pose,
    goal_ray,
    length_scales,
    moved_custom_values,
    moved_goal,
)
from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType, goal_dof, goal_size

_Type = IkParameterizationType


_ANGLES = {
    _Type.TranslationXAxisAngle4D: "angle between the direction and the x axis",
    _Type.TranslationYAxisAngle4D: "angle between the direction and the y axis",
    _Type.TranslationZAxisAngle4D: "angle between the direction and the z axis",
    _Type.TranslationXAxisAngleZNorm4D: "heading of the direction about z, from x",
    _Type.TranslationYAxisAngleXNorm4D: "heading of the direction about x, from y",
    _Type.TranslationZAxisAngleYNorm4D: "heading of the direction about y, from z",
}
"""Goal types that consist of a point and an angle, and descriptions of the angles."""

_ROTATION_SIZES = {
    _Type.Transform6D: 4,
    _Type.Rotation3D: 4,
    _Type.Direction3D: 3,
    _Type.Ray4D: 3,
    _Type.TranslationDirection5D: 3,
    _Type.TranslationLocalGlobal6D: 3,
    **dict.fromkeys(_ANGLES, 1),
}
"""Number of values of a goal that OpenRAVE stores in place of its quaternion, by goal type; 0 for other types."""

_SET = """Set the goal to a point and the {angle}.

Args:
    translation: The point [m], shape (3,).
    angle: The angle [rad], in the frame of the arm's base.
"""


def _with_angles(goals: type["GoalValues"]) -> type["GoalValues"]:
    """Class decorator that implements and documents the point-and-angle methods, written as signatures only."""
    for kind, angle in _ANGLES.items():
        set_, get = (getattr(goals, f"{verb}{kind.name}") for verb in ("Set", "Get"))
        set_.__doc__, get.__doc__ = _SET.format(angle=angle), "Return the point [m], shape (3,), and the angle [rad]."
        for method, body in zip((set_, get), _point_and_angle(kind), strict=True):
            setattr(goals, method.__name__, wraps(method)(body))
    return goals


def _point_and_angle(kind: IkParameterizationType) -> tuple[Callable[..., None], Callable[..., tuple[Floats, float]]]:
    def set_(self: "GoalValues", translation: ArrayLike, angle: float) -> None:
        point = checked_numbers(translation, f"Set{kind.name}: translation")
        self._set(kind, [point, *checked_numbers(angle, f"Set{kind.name}: angle")])

    def get(self: "GoalValues") -> tuple[Floats, float]:
        values = self._of(kind)
        return values[1:], float(values[0])

    return set_, get


@_with_angles
class GoalValues(ApiObject):
    """Type and values of an IK goal.

    As in OpenRAVE, getters do not check the type: ``GetTranslation3D`` of a pose is its position.
    """

    _type: IkParameterizationType
    _values: Floats

    def _set(self, kind: IkParameterizationType, value: Any) -> None:  # noqa: ANN401 - as the type asks for
        self._values = checked_goal(kind, value)
        self._type = kind

    def _of(self, kind: IkParameterizationType) -> Floats:
        """Return the goal as values of another goal type.

        OpenRAVE stores a goal of any type as a quaternion and a point, and reads the values of any type from these.
        """
        if self._type == kind:
            return self._values.copy()
        stored, own, asked = np.eye(1, 7)[0], *(_ROTATION_SIZES.get(one, 0) for one in (self._type, kind))
        stored[:own] = self._values[:own]
        stored[4 : 4 + len(self._values) - own] = self._values[own:]
        if kind == _Type.Transform6D and not stored[:4].any():
            raise ArgumentError(f"the goal is of type {self._type.name}, and has no rotation")
        return np.concatenate([stored[:asked], stored[4 : 4 + goal_size(kind) - asked]])

    def SetTransform6D(self, transform: ArrayLike) -> None:
        """Set the goal to a pose ``transform``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz]."""
        self._set(_Type.Transform6D, transform)

    def GetTransform6D(self) -> Floats:
        """Return the pose, shape (4, 4)."""
        return goal_pose(self._of(_Type.Transform6D)).matrix()

    def GetTransform6DPose(self) -> Floats:
        """Return the pose [w, x, y, z, tx, ty, tz], shape (7,)."""
        return self._of(_Type.Transform6D)

    def SetRotation3D(self, quat: ArrayLike) -> None:
        """Set the goal to the rotation ``quat``, [w, x, y, z], shape (4,), stored without normalization."""
        self._set(_Type.Rotation3D, quat)

    def GetRotation3D(self) -> Floats:
        """Return the quaternion [w, x, y, z], shape (4,)."""
        return self._of(_Type.Rotation3D)

    def SetTranslation3D(self, pos: ArrayLike) -> None:
        """Set the goal to the point ``pos`` [m], shape (3,)."""
        self._set(_Type.Translation3D, pos)

    def GetTranslation3D(self) -> Floats:
        """Return the point [m], shape (3,)."""
        return self._of(_Type.Translation3D)

    def SetDirection3D(self, dir: ArrayLike) -> None:
        """Set the goal to the direction ``dir``, a unit vector, shape (3,)."""
        self._set(_Type.Direction3D, dir)

    def GetDirection3D(self) -> Floats:
        """Return the direction, shape (3,)."""
        return self._of(_Type.Direction3D)

    def SetLookat3D(self, pos: ArrayLike) -> None:
        """Set the goal to the point ``pos`` to look at [m], shape (3,)."""
        self._set(_Type.Lookat3D, pos)

    def GetLookat3D(self) -> Floats:
        """Return the point [m] to look at, shape (3,)."""
        return self._of(_Type.Lookat3D)

    def SetRay4D(self, quat: Ray) -> None:
        """Set the goal to the ray ``quat``, with a unit direction: the tool axis must lie on it, anywhere along it."""
        self._set(_Type.Ray4D, quat)

    def GetRay4D(self) -> Ray:
        """Return the ray."""
        return goal_ray(self._of(_Type.Ray4D))

    def SetTranslationDirection5D(self, quat: Ray) -> None:
        """Set the goal to the point and the direction, a unit vector, of the ray ``quat``."""
        self._set(_Type.TranslationDirection5D, quat)

    def GetTranslationDirection5D(self) -> Ray:
        """Return point and direction."""
        return goal_ray(self._of(_Type.TranslationDirection5D))

    def SetTranslationXY2D(self, pos: ArrayLike) -> None:
        """Set the goal to ``pos``, x and y [m], shape (2,)."""
        self._set(_Type.TranslationXY2D, pos)

    def GetTranslationXY2D(self) -> Floats:
        """Return x and y [m], shape (2,)."""
        return self._of(_Type.TranslationXY2D)

    def SetTranslationXYOrientation3D(self, posangle: ArrayLike) -> None:
        """Set the goal to ``posangle``: x, y [m] and the heading of the tool's direction [rad], shape (3,)."""
        self._set(_Type.TranslationXYOrientation3D, posangle)

    def GetTranslationXYOrientation3D(self) -> Floats:
        """Return x, y [m] and heading [rad], shape (3,)."""
        return self._of(_Type.TranslationXYOrientation3D)

    def SetTranslationLocalGlobal6D(self, localpos: ArrayLike, pos: ArrayLike) -> None:
        """Set the goal to a point of the tool and its desired position.

        Args:
            localpos: The point in the frame of the tool [m], shape (3,).
            pos: The desired position [m], shape (3,).
        """
        self._set(_Type.TranslationLocalGlobal6D, [localpos, pos])

    def GetTranslationLocalGlobal6D(self) -> tuple[Floats, Floats]:
        """Return the point of the tool and its desired position [m], shape (3,) each."""
        values = self._of(_Type.TranslationLocalGlobal6D)
        return values[:3], values[3:]

    # A point and an angle: bodies and docstrings come from ``_ANGLES``

    def SetTranslationXAxisAngle4D(self, translation: ArrayLike, angle: float) -> None: ...
    def GetTranslationXAxisAngle4D(self) -> tuple[Floats, float]: ...
    def SetTranslationYAxisAngle4D(self, translation: ArrayLike, angle: float) -> None: ...
    def GetTranslationYAxisAngle4D(self) -> tuple[Floats, float]: ...
    def SetTranslationZAxisAngle4D(self, translation: ArrayLike, angle: float) -> None: ...
    def GetTranslationZAxisAngle4D(self) -> tuple[Floats, float]: ...
    def SetTranslationXAxisAngleZNorm4D(self, translation: ArrayLike, angle: float) -> None: ...
    def GetTranslationXAxisAngleZNorm4D(self) -> tuple[Floats, float]: ...
    def SetTranslationYAxisAngleXNorm4D(self, translation: ArrayLike, angle: float) -> None: ...
    def GetTranslationYAxisAngleXNorm4D(self) -> tuple[Floats, float]: ...
    def SetTranslationZAxisAngleYNorm4D(self, translation: ArrayLike, angle: float) -> None: ...
    def GetTranslationZAxisAngleYNorm4D(self) -> tuple[Floats, float]: ...


_CUSTOM_DATA = 0x10000
"""Bit of the type number that marks custom data in the text form of a goal."""


class IkParameterizationData(GoalValues):
    """Base of ``IkParameterization`` with its values, transforms and custom data."""

    Type = IkParameterizationType
    __array_ufunc__ = None  # so that ``matrix * goal`` is ours

    @also_named(primitive="value", ikparam="value", str="value")
    def __init__(self, value: Any = None, type: IkParameterizationType | int | None = None) -> None:  # noqa: ANN401 - as the type asks for
        self._type = _Type.none
        self._values = np.zeros(0)
        self._custom: dict[str, Floats] = {}
        self._id = self._name = ""
        if isinstance(value, str):
            value = self.take(value.split())
        if isinstance(value, IkParameterizationData):
            self._type, self._values = value._type, value._values.copy()
            self._custom = {name: numbers.copy() for name, numbers in value._custom.items()}
            self._id, self._name = value._id, value._name
            self._check_type(type)
        elif type is not None:
            self._set(_Type(type), value)
        elif value is not None:
            message = (
                "is given without its type; IkParameterization(value, IkParameterizationType.Transform6D) has both"
            )
            raise TypeError(f"IkParameterization: value: {message}")

    def _check_type(self, type: IkParameterizationType | int | None) -> None:
        """Check that the type that a user gave together with a goal is the goal's type; None is accepted."""
        if type is not None and type != self._type:
            raise ArgumentError(f"type: is {_Type(type).name}, and the goal is of type {self._type.name}")

    def GetType(self) -> IkParameterizationType:
        """Return the type."""
        return self._type

    def GetId(self) -> str:
        """Return the id that ``DeserializeJSON`` read; empty without one."""
        return self._id

    def GetName(self) -> str:
        """Return the name that ``DeserializeJSON`` read; empty without one."""
        return self._name

    def GetDOF(self, type: int | None = None) -> int:
        """Return the number of degrees of freedom that the goal, or a goal of ``type``, constrains."""
        return self.GetDOFFromType(self._type if type is None else type)

    def GetNumberOfValues(self, type: int | None = None) -> int:
        """Return the number of values of the goal, or of a goal of ``type``."""
        return self.GetNumberOfValuesFromType(self._type if type is None else type)

    @staticmethod
    def GetDOFFromType(type: int) -> int:
        """Return the number of degrees of freedom that a goal of a type constrains."""
        return goal_dof(type)

    @staticmethod
    def GetNumberOfValuesFromType(type: int) -> int:
        """Return the number of values of a goal of a type."""
        return goal_size(type)

    def GetValues(self) -> Floats:
        """Return the values of the goal, shape (n,).

        Raises:
            ArgumentError: the goal is empty.
        """
        if self._type not in GOAL_TYPES:
            raise ArgumentError("the goal is empty, and has no values; give it a value and a type first")
        return self._values.copy()

    def SetValues(self, values: ArrayLike, type: int) -> None:
        """Set the values of the goal.

        Args:
            values: The values, as many as the type has.
            type: The type.
        """
        kind = _Type(type)
        self._values = checked_vector(values, self.GetNumberOfValuesFromType(kind), "values")
        self._type = kind

    # Transforms and distances

    def MultiplyTransform(self, transform: ArrayLike) -> None:
        """Multiply the goal in place by ``transform`` from the left (4x4 or [w, x, y, z, tx, ty, tz])."""
        pose = pose_of(checked_transform(transform, "transform"))
        custom = {name: moved_custom_values(name, numbers, pose) for name, numbers in self._custom.items()}
        self._values = moved_goal(self._type, self._values, pose)
        self._custom = custom

    def Transform(self, transform: ArrayLike) -> Self:
        """Return ``transform * goal``."""
        moved = type(self)(self)
        moved.MultiplyTransform(transform)
        return moved

    def __rmul__(self, transform: ArrayLike) -> Self:
        return self.Transform(transform)

    def MultiplyTransformRight(self, transform: ArrayLike) -> None:
        """Transform the goal in place by a transform in its own frame, as ``goal * transform`` does.

        The goal's own frame has the identity rotation for points; for directions, its z axis is turned onto the
        direction by the shortest rotation.

        Args:
            transform: 4x4, or [w, x, y, z, tx, ty, tz].

        Raises:
            openrave_exception: the type is ``Ray4D``, as in OpenRAVE.
        """
        pose = pose_of(checked_transform(transform, "transform"))
        self._values = goal_moved_in_its_frame(self._type, self._values, pose)

    def __mul__(self, transform: ArrayLike) -> Self:
        moved = type(self)(self)
        moved.MultiplyTransformRight(transform)
        return moved

    def ComputeDistanceSqr(self, other: "IkParameterizationData") -> float:
        """Return the squared distance to ``other``, a goal of the same type.

        Angles count in radians; for poses they have a smaller weight.
        """
        if self._type != other._type:
            message = f"ComputeDistanceSqr: other is of type {other._type.name}, and should be {self._type.name}"
            raise ArgumentError(message, ErrorCode.Assert)
        return goal_distance_squared(self._type, self._values, other._values)

    # Data of users

    def SetCustomValues(self, name: str, values: ArrayLike) -> None:
        """Attach numbers under a name without spaces.

        Args:
            name: The name. Values whose name ends in ``_transform=point``, or continues after it with ``_``, are
                transformed with the goal; so are those with ``direction``, ``quat`` or ``ikparam`` in place of
                ``point``.
            values: The numbers, shape (n,).
        """
        if not name or name.split() != [name]:
            raise ArgumentError(f"name: is '{name}', and should be a word")
        self._custom[name] = checked_numbers(values, "values")

    def SetCustomValue(self, name: str, value: float) -> None:
        """Attach one number under a name; see ``SetCustomValues``.

        Args:
            name: The name.
            value: The number.
        """
        self.SetCustomValues(name, [value])

    def GetCustomValues(self, name: str) -> Floats | None:
        """Return the values attached under a name, shape (n,), or None."""
        return self._custom[name].copy() if name in self._custom else None

    def GetCustomDataMap(self) -> dict[str, Floats]:
        """Return all attached values by name."""
        return {name: numbers.copy() for name, numbers in self._custom.items()}

    def ClearCustomValues(self, name: str = "") -> int:
        """Remove the values of a name, or all by default; return the number of removed names."""
        names = [known for known in self._custom if name in {"", known}]
        for known in names:
            del self._custom[known]
        return len(names)

    # JSON and text

    def SerializeJSON(self, unitScale: float = 1.0) -> dict[str, Any]:
        """Return the goal as JSON data: dicts, lists, numbers and strings.

        ``unitScale`` is a factor for lengths, but not for those in custom data.
        """
        scales = length_scales(self._type, unitScale)
        written: dict[str, Any] = {"type": int(self._type), "values": (self._values * scales).tolist()}
        if self._custom:
            written["customData"] = {name: numbers.tolist() for name, numbers in self._custom.items()}
        texts = {"id": self._id, "name": self._name}
        return {**{key: text for key, text in texts.items() if text}, **written}

    def DeserializeJSON(self, obj: Mapping[str, Any], unitScale: float = 1.0) -> None:
        """Restore the goal from a result of ``SerializeJSON``.

        Args:
            obj: The dict.
            unitScale: Factor for lengths.

        Raises:
            openrave_exception: a value of ``obj`` is missing or wrong; nothing changes then.
        """
        checked_kind(obj, Mapping, "DeserializeJSON: obj", "a dict")
        try:
            read = type(self)()
            read.SetValues(obj["values"], obj["type"])
            read._values = read._values * length_scales(read._type, unitScale)
            for name, numbers in obj.get("customData", {}).items():
                read.SetCustomValues(name, numbers)
        except (KeyError, ValueError, TypeError, AttributeError) as error:
            raise ArgumentError(f"IkParameterization.DeserializeJSON: {error!r} in {obj}") from None
        self._type, self._values, self._custom = read._type, read._values, read._custom
        self._id, self._name = str(obj.get("id", self._id)), str(obj.get("name", self._name))

    @classmethod
    def take(cls, words: list[str]) -> Self:
        """Return the goal that a list of words begins with, as ``str`` writes it, and remove its words from the list.

        Raises:
            ArgumentError: the words do not start with a goal.
        """
        read, rest = cls(), list(words)
        try:
            number = int(rest.pop(0))
            kind = _Type(number & ~_CUSTOM_DATA)
            read.SetValues([float(rest.pop(0)) for _ in range(goal_size(kind))], kind)
            for _ in range(int(rest.pop(0)) if number & _CUSTOM_DATA else 0):
                name = rest.pop(0)
                read._custom[name] = np.array([float(rest.pop(0)) for _ in range(int(rest.pop(0)))])
        except (ValueError, IndexError):
            text = " ".join(words)
            raise ArgumentError(
                f"'{text}' should be a goal: the number of its type, as many numbers as the type has, data of users"
            ) from None
        words[:] = rest
        return read

    def __str__(self) -> str:
        words = [str(int(self._type) | (_CUSTOM_DATA if self._custom else 0)), *map(repr, self._values.tolist())]
        if self._custom:
            words.append(str(len(self._custom)))
        for name, numbers in self._custom.items():
            words += [name, str(len(numbers)), *map(repr, numbers.tolist())]
        return " ".join(words)

    def __repr__(self) -> str:
        return f"IkParameterization('{self}')"

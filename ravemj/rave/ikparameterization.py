"""What the tool of an arm shall reach."""

from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arrays import checked_numbers, checked_transform, checked_vector
from ravemj.core.transforms import Floats, pose_of
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import Ray
from ravemj.geometry_functions.ik_parameterization import (
    IkParameterizationType,
    checked_goal,
    goal_distance_squared,
    goal_dof,
    goal_moved_in_its_frame,
    goal_pose,
    goal_ray,
    goal_size,
    moved_goal,
)

_Type = IkParameterizationType
_CUSTOM_DATA = 0x10000
"""Bit of the type's number in the text of a goal that has data of users."""


class IkParameterizationData(ApiObject):
    """The part of ``IkParameterization`` that works on its numbers and the data of users."""

    Type = IkParameterizationType
    __array_ufunc__ = None  # so that ``matrix * goal`` is ours

    def __init__(self, value: Any = None, type: IkParameterizationType | int | None = None) -> None:  # noqa: ANN401 - as the type asks for
        self._type = _Type.None_
        self._values = np.zeros(0)
        self._custom: dict[str, Floats] = {}
        if isinstance(value, IkParameterizationData):
            self._type, self._values = value._type, value._values.copy()
            self._custom = {name: numbers.copy() for name, numbers in value._custom.items()}
        elif isinstance(value, str):
            self._read(value.split())
        elif type is not None:
            self._set(_Type(type), value)

    def _set(self, kind: IkParameterizationType, value: Any) -> None:  # noqa: ANN401 - as the type asks for
        self._values = checked_goal(kind, value)
        self._type = kind

    def GetType(self) -> IkParameterizationType:
        """Return the type."""
        return self._type

    def GetDOF(self) -> int:
        """Return how many degrees of freedom the goal takes away."""
        return self.GetDOFFromType(self._type)

    def GetNumberOfValues(self) -> int:
        """Return how many numbers the goal has."""
        return self.GetNumberOfValuesFromType(self._type)

    @staticmethod
    def GetDOFFromType(type: int) -> int:
        """Return how many degrees of freedom a goal of a type takes away."""
        return goal_dof(type)

    @staticmethod
    def GetNumberOfValuesFromType(type: int) -> int:
        """Return how many numbers a goal of a type has."""
        return goal_size(type)

    def GetValues(self) -> Floats:
        """Return the numbers of the goal, shape (n,)."""
        return self._values.copy()

    def SetValues(self, values: ArrayLike, type: int) -> None:
        """Set the numbers of the goal.

        Args:
            values: As many as the type has.
            type: The type.
        """
        kind = _Type(type)
        self._values = checked_vector(values, self.GetNumberOfValuesFromType(kind), "values")
        self._type = kind

    # One pair of methods for each type

    def SetTransform6D(self, transform: ArrayLike) -> None:
        """Set the goal to a pose: 4x4 or [w, x, y, z, tx, ty, tz].

        Args:
            transform: A matrix 4x4 or 3x4, or [w, x, y, z, tx, ty, tz].
        """
        self._set(_Type.Transform6D, transform)

    def GetTransform6D(self) -> Floats:
        """Return the pose, shape (4, 4)."""
        return goal_pose(self._of(_Type.Transform6D)).matrix()

    def GetTransform6DPose(self) -> Floats:
        """Return the pose [w, x, y, z, tx, ty, tz], shape (7,)."""
        return self._of(_Type.Transform6D)

    def SetRotation3D(self, quat: ArrayLike) -> None:
        """Set the goal to a rotation: a quaternion [w, x, y, z].

        Args:
            quat: [w, x, y, z], shape (4,).
        """
        self._set(_Type.Rotation3D, quat)

    def GetRotation3D(self) -> Floats:
        """Return the quaternion [w, x, y, z], shape (4,)."""
        return self._of(_Type.Rotation3D)

    def SetTranslation3D(self, point: ArrayLike) -> None:
        """Set the goal to a point [m]."""
        self._set(_Type.Translation3D, point)

    def GetTranslation3D(self) -> Floats:
        """Return the point [m], shape (3,)."""
        return self._of(_Type.Translation3D)

    def SetDirection3D(self, direction: ArrayLike) -> None:
        """Set the goal to a direction."""
        self._set(_Type.Direction3D, direction)

    def GetDirection3D(self) -> Floats:
        """Return the direction, shape (3,)."""
        return self._of(_Type.Direction3D)

    def SetLookat3D(self, point: ArrayLike) -> None:
        """Set the goal to a point [m] to look at."""
        self._set(_Type.Lookat3D, point)

    def GetLookat3D(self) -> Floats:
        """Return the point [m] to look at, shape (3,)."""
        return self._of(_Type.Lookat3D)

    def SetRay4D(self, ray: Ray) -> None:
        """Set the goal to a ray that the tool lies on, anywhere."""
        self._set(_Type.Ray4D, ray)

    def GetRay4D(self) -> Ray:
        """Return the ray."""
        return goal_ray(self._of(_Type.Ray4D))

    def SetTranslationDirection5D(self, ray: Ray) -> None:
        """Set the goal to a point and a direction.

        Args:
            ray: The tool's position and direction.
        """
        self._set(_Type.TranslationDirection5D, ray)

    def GetTranslationDirection5D(self) -> Ray:
        """Return point and direction."""
        return goal_ray(self._of(_Type.TranslationDirection5D))

    def _of(self, kind: IkParameterizationType) -> Floats:
        if self._type != kind:
            raise ArgumentError(f"the goal is of type {self._type.name}, and not {kind.name}")
        return self._values.copy()

    # Transforms and distances

    def MultiplyTransform(self, transform: ArrayLike) -> None:
        """Move the goal itself, as ``transform * goal`` does.

        Args:
            transform: 4x4, or [w, x, y, z, tx, ty, tz].
        """
        pose = pose_of(checked_transform(transform, "transform"))
        self._values = moved_goal(self._type, self._values, pose)

    def Transform(self, transform: ArrayLike) -> Self:
        """Return ``transform * goal``."""
        moved = type(self)(self)
        moved.MultiplyTransform(transform)
        return moved

    def __rmul__(self, transform: ArrayLike) -> Self:
        return self.Transform(transform)

    def MultiplyTransformRight(self, transform: ArrayLike) -> None:
        """Move the goal itself by a transform in its own frame, as ``goal * transform`` does.

        A frame is turned as the goal says: as it stands for points, and for directions so that the shortest way brings
        its z axis onto the direction.

        Args:
            transform: 4x4, or [w, x, y, z, tx, ty, tz].

        Raises:
            openrave_exception: OpenRAVE moves no goal of type ``Ray4D`` so.
        """
        pose = pose_of(checked_transform(transform, "transform"))
        self._values = goal_moved_in_its_frame(self._type, self._values, pose)

    def __mul__(self, transform: ArrayLike) -> Self:
        moved = type(self)(self)
        moved.MultiplyTransformRight(transform)
        return moved

    def ComputeDistanceSqr(self, other: "IkParameterizationData") -> float:
        """Return the squared distance to another goal of the same type; angles count in radians, and less for poses.

        Args:
            other: Another goal of the same type.
        """
        return goal_distance_squared(self._type, self._values, other._of(self._type))

    # Data of users

    def SetCustomValues(self, name: str, values: ArrayLike) -> None:
        """Attach numbers under a name without spaces.

        Args:
            name: The name.
            values: The numbers, shape (n,).
        """
        if not name or name.split() != [name]:
            raise ArgumentError(f"name: is '{name}', and should be a word")
        self._custom[name] = checked_numbers(values, "values")

    def GetCustomValues(self, name: str) -> Floats | None:
        """Return the numbers under a name, shape (n,), or None."""
        return self._custom[name].copy() if name in self._custom else None

    def GetCustomDataMap(self) -> dict[str, Floats]:
        """Return all attached numbers."""
        return {name: numbers.copy() for name, numbers in self._custom.items()}

    def ClearCustomValues(self, name: str = "") -> int:
        """Forget the numbers under a name, or all without one; return how many names were forgotten."""
        names = [known for known in self._custom if name in {"", known}]
        for known in names:
            del self._custom[known]
        return len(names)

    # Text

    def _read(self, words: list[str]) -> None:
        """Take over what ``str`` gave."""
        number = int(words[0])
        kind = _Type(number & ~_CUSTOM_DATA)
        end = 1 + self.GetNumberOfValuesFromType(kind)
        self.SetValues([float(word) for word in words[1:end]], kind)
        if number & _CUSTOM_DATA:
            rest = iter(words[end + 1 :])
            for name in rest:
                self._custom[name] = np.array([float(next(rest)) for _ in range(int(next(rest)))])

    def __str__(self) -> str:
        words = [str(int(self._type) | (_CUSTOM_DATA if self._custom else 0)), *map(repr, self._values.tolist())]
        if self._custom:
            words.append(str(len(self._custom)))
        for name, numbers in self._custom.items():
            words += [name, str(len(numbers)), *map(repr, numbers.tolist())]
        return " ".join(words)

    def __repr__(self) -> str:
        return f"IkParameterization('{self}')"

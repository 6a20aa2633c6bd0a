"""What the tool of an arm shall reach."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.arrays import checked_numbers, checked_transform, checked_vector
from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.geometry_functions import Ray
from ravemj.rave.enums import IkParameterizationType
from ravemj.rave.goal_motion import POINTS, RAYS, moved, moved_inside, pose_of_goal
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.showing import Shown
from ravemj.transforms import Floats, Pose, pose_of

_Type = IkParameterizationType
_ANGLES = {kind for kind in _Type if "AxisAngle" in kind.name}
_CUSTOM_DATA = 0x10000
_ANGLE_WEIGHT = 0.4


class IkParameterization(Shown):
    """A pose, a direction, a point or a ray that the tool of an arm shall reach.

    The numbers are, by type: ``Transform6D`` the pose [w, x, y, z, tx, ty, tz]; ``Rotation3D`` the quaternion;
    ``Translation3D`` and ``Lookat3D`` the point; ``Direction3D`` the direction; ``Ray4D`` and
    ``TranslationDirection5D`` direction and point; ``TranslationXY2D`` x and y, ``TranslationXYOrientation3D`` the
    angle behind them; ``TranslationLocalGlobal6D`` a point of the tool and where it shall be; the types with
    ``AxisAngle`` angle and point.

    Args:
        value: What to reach: a 4x4 matrix or a pose, a quaternion, a vector, a ``Ray``, a pair of points, or a point
            and an angle, as the type asks for; or another ``IkParameterization``, or the text of one.
        type: The type, with a value.

    Example:
        >>> goal = IkParameterization(T_world_tool, IkParameterization.Type.Transform6D)
        >>> moved_in_the_world = matrixFromPose([1, 0, 0, 0, 0, 0, 0.1]) * goal
        >>> moved_in_the_tool = goal * matrixFromPose([1, 0, 0, 0, 0, 0, 0.1])
    """

    Type = IkParameterizationType
    __array_ufunc__ = None  # so that ``matrix * goal`` is ours

    def __init__(self, value: Any = None, type: "IkParameterizationType | int | None" = None) -> None:  # noqa: ANN401 - as the type asks for
        self._type = _Type.None_
        self._values = np.zeros(0)
        self._custom: dict[str, Floats] = {}
        if isinstance(value, IkParameterization):
            self._type, self._values = value._type, value._values.copy()
            self._custom = {name: numbers.copy() for name, numbers in value._custom.items()}
        elif isinstance(value, str):
            self._read(value.split())
        elif type is not None:
            self._set(_Type(type), value)

    def _set(self, kind: IkParameterizationType, value: Any) -> None:  # noqa: ANN401 - as the type asks for
        self._values = _numbers(kind, value)
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
        return int(type) >> 28 & 0xF

    @staticmethod
    def GetNumberOfValuesFromType(type: int) -> int:
        """Return how many numbers a goal of a type has."""
        return int(type) >> 24 & 0xF

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

    def GetConfigurationSpecification(
        self, interpolation: str = "", robotname: str = "", manipname: str = ""
    ) -> ConfigurationSpecification:
        """Return the layout of a goal of this type in a trajectory.

        Args:
            interpolation: How the values change between waypoints.
            robotname: Name of the robot; empty: any.
            manipname: Name of the arm; empty: any.
        """
        return self.GetConfigurationSpecificationFromType(self._type, interpolation, robotname, manipname)

    @staticmethod
    def GetConfigurationSpecificationFromType(
        type: int, interpolation: str = "", robotname: str = "", manipname: str = ""
    ) -> ConfigurationSpecification:
        """Return the layout of a goal of a type in a trajectory.

        Args:
            type: A type of goal.
            interpolation: How the values change between waypoints.
            robotname: Name of the robot; empty: any.
            manipname: Name of the arm; empty: any.
        """
        spec = ConfigurationSpecification()
        name = " ".join(filter(None, ["ikparam_values", str(int(type)), robotname, manipname]))
        spec.AddGroup(name, IkParameterization.GetNumberOfValuesFromType(type), interpolation)
        return spec

    # One pair of methods for each type

    def SetTransform6D(self, transform: ArrayLike) -> None:
        """Set the goal to a pose: 4x4 or [w, x, y, z, tx, ty, tz].

        Args:
            transform: A matrix 4x4 or 3x4, or [w, x, y, z, tx, ty, tz].
        """
        self._set(_Type.Transform6D, transform)

    def GetTransform6D(self) -> Floats:
        """Return the pose, shape (4, 4)."""
        return self._pose(_Type.Transform6D).matrix()

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
        return _ray(self._of(_Type.Ray4D))

    def SetTranslationDirection5D(self, ray: Ray) -> None:
        """Set the goal to a point and a direction.

        Args:
            ray: The tool's position and direction.
        """
        self._set(_Type.TranslationDirection5D, ray)

    def GetTranslationDirection5D(self) -> Ray:
        """Return point and direction."""
        return _ray(self._of(_Type.TranslationDirection5D))

    def _of(self, kind: IkParameterizationType) -> Floats:
        if self._type != kind:
            raise ArgumentError(f"the goal is of type {self._type.name}, and not {kind.name}")
        return self._values.copy()

    def _pose(self, kind: IkParameterizationType) -> Pose:
        return pose_of_goal(self._of(kind))

    # Transforms and distances

    def MultiplyTransform(self, transform: ArrayLike) -> None:
        """Move the goal itself, as ``transform * goal`` does.

        Args:
            transform: 4x4, or [w, x, y, z, tx, ty, tz].
        """
        pose = pose_of(checked_transform(transform, "transform"))
        self._values = moved(self._type, self._values, pose)

    def Transform(self, transform: ArrayLike) -> "IkParameterization":
        """Return ``transform * goal``."""
        goal = IkParameterization(self)
        goal.MultiplyTransform(transform)
        return goal

    def __rmul__(self, transform: ArrayLike) -> "IkParameterization":
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
        self._values = moved_inside(self._type, self._values, pose)

    def __mul__(self, transform: ArrayLike) -> "IkParameterization":
        goal = IkParameterization(self)
        goal.MultiplyTransformRight(transform)
        return goal

    def ComputeDistanceSqr(self, other: "IkParameterization") -> float:
        """Return the squared distance to another goal of the same type; angles count in radians, and less for poses.

        Args:
            other: Another goal of the same type.
        """
        a, b = self._values, other._of(self._type)
        if self._type == _Type.Transform6D:
            return _length2(a[4:] - b[4:]) + _ANGLE_WEIGHT * _turn(a[:4], b[:4]) ** 2
        if self._type == _Type.Rotation3D:
            return _turn(a, b) ** 2
        if self._type == _Type.Direction3D:
            return _angle(a, b) ** 2
        if self._type in POINTS:
            return _length2(a - b)
        if self._type in RAYS:
            across: Callable[[Floats], Floats] = _across if self._type == _Type.Ray4D else lambda ray: ray[3:]
            return _length2(across(a) - across(b)) + _angle(a[:3], b[:3]) ** 2
        raise UnsupportedError(f"ComputeDistanceSqr of {self._type.name}", "inverse kinematics of that type")

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


def _numbers(kind: IkParameterizationType, value: Any) -> Floats:  # noqa: ANN401 - as the type asks for
    """Return the numbers of a goal that a user gave as a matrix, a ray or a vector."""
    if kind == _Type.Transform6D:
        return pose_of(checked_transform(value, "value")).numbers()
    if kind in RAYS:
        if not isinstance(value, Ray):
            raise ArgumentError(f"value: is a {type(value).__name__}, and should be a Ray")
        direction = value.dir()
        return np.concatenate([direction / (np.linalg.norm(direction) or 1.0), value.pos()])
    if kind == _Type.TranslationLocalGlobal6D:
        value = np.ravel(checked_numbers(value, "value"))
    count = IkParameterization.GetNumberOfValuesFromType(kind)
    match value:
        case [point, angle] if kind in _ANGLES:
            return checked_vector([angle, *checked_vector(point, 3, "value: point")], count, "value")
        case _:
            return checked_vector(value, count, "value")


def _ray(values: Floats) -> Ray:
    return Ray(values[3:], values[:3])


def _across(values: Floats) -> Floats:
    """Return the point of a ray that is nearest to the origin."""
    direction, point = values[:3], values[3:]
    return point - direction * (direction @ point)


def _length2(vector: Floats) -> float:
    return float(vector @ vector)


def _angle(a: Floats, b: Floats) -> float:
    """Return the angle between two unit vectors [rad]."""
    return math.acos(min(1.0, max(-1.0, float(a @ b))))


def _turn(a: Floats, b: Floats) -> float:
    """Return the angle between two unit quaternions, of which each stands for the same as its negative [rad]."""
    return min(_angle(a, b), _angle(a, -b))

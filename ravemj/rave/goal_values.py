"""One pair of setter and getter for each type of goal of inverse kinematics."""

# ruff: noqa: D102 - the docstrings of the last methods come from a table
# Functions of a table stand for methods.
# pyright: reportPrivateUsage=false

from collections.abc import Callable
from functools import wraps
from typing import Any

from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import Ray
from ravemj.geometry_functions.ik_parameterization import checked_goal, goal_pose, goal_ray, has_point
from ravemj.geometry_functions.ik_types import IkParameterizationType

_Type = IkParameterizationType


_ANGLES = {
    _Type.TranslationXAxisAngle4D: "angle between the direction and the x axis",
    _Type.TranslationYAxisAngle4D: "angle between the direction and the y axis",
    _Type.TranslationZAxisAngle4D: "angle between the direction and the z axis",
    _Type.TranslationXAxisAngleZNorm4D: "heading of the direction about z, from x",
    _Type.TranslationYAxisAngleXNorm4D: "heading of the direction about x, from y",
    _Type.TranslationZAxisAngleYNorm4D: "heading of the direction about y, from z",
}
"""Types of goals that are a point and an angle."""

_SET = """Set the goal to a point and the {angle}.

Args:
    translation: The point [m], shape (3,).
    angle: The angle [rad], in the frame of the arm's base.
"""


def _with_angles(goals: type["GoalValues"]) -> type["GoalValues"]:
    """Give the methods for points with angles, of which only the signatures are written, bodies and docstrings."""
    for kind, angle in _ANGLES.items():
        set_, get = (getattr(goals, f"{verb}{kind.name}") for verb in ("Set", "Get"))
        set_.__doc__, get.__doc__ = _SET.format(angle=angle), "Return the point [m], shape (3,), and the angle [rad]."
        for method, body in zip((set_, get), _point_and_angle(kind), strict=True):
            setattr(goals, method.__name__, wraps(method)(body))
    return goals


def _point_and_angle(kind: IkParameterizationType) -> tuple[Callable[..., None], Callable[..., tuple[Floats, float]]]:
    def set_(self: "GoalValues", translation: ArrayLike, angle: float) -> None:
        self._set(kind, [translation, angle])

    def get(self: "GoalValues") -> tuple[Floats, float]:
        values = self._of(kind)
        return values[1:], float(values[0])

    return set_, get


@_with_angles
class GoalValues(ApiObject):
    """The type of a goal and its numbers, of which there are as many as the type has."""

    _type: IkParameterizationType
    _values: Floats

    def _set(self, kind: IkParameterizationType, value: Any) -> None:  # noqa: ANN401 - as the type asks for
        self._values = checked_goal(kind, value)
        self._type = kind

    def _of(self, kind: IkParameterizationType) -> Floats:
        if self._type != kind:
            raise ArgumentError(f"the goal is of type {self._type.name}, and not {kind.name}")
        return self._values.copy()

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
        """Set the goal to the rotation ``quat``, [w, x, y, z], shape (4,), which is kept as it is."""
        self._set(_Type.Rotation3D, quat)

    def GetRotation3D(self) -> Floats:
        """Return the quaternion [w, x, y, z], shape (4,)."""
        return self._of(_Type.Rotation3D)

    def SetTranslation3D(self, pos: ArrayLike) -> None:
        """Set the goal to the point ``pos`` [m], shape (3,)."""
        self._set(_Type.Translation3D, pos)

    def GetTranslation3D(self) -> Floats:
        """Return the point [m] of a goal that has one, of this type or of another, shape (3,)."""
        return self._values[-3:].copy() if has_point(self._type) else self._of(_Type.Translation3D)

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
        """Set the goal to a ray ``quat`` that the tool lies on, anywhere; its direction is a unit vector."""
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
        """Set the goal to a point of the tool and where it shall be.

        Args:
            localpos: The point in the frame of the tool [m], shape (3,).
            pos: Where it shall be [m], shape (3,).
        """
        self._set(_Type.TranslationLocalGlobal6D, [localpos, pos])

    def GetTranslationLocalGlobal6D(self) -> tuple[Floats, Floats]:
        """Return the point of the tool and where it shall be [m], shape (3,) each."""
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

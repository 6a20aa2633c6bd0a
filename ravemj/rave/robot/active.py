"""Active DOFs: the configuration space of planners and of the ``…Active…`` methods."""

# ruff: noqa: D102 - the docstrings of the last methods come from a table

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import wraps
from inspect import signature
from typing import NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_indices, checked_numbers, checked_vector, finite_vector
from ravemj.core.transforms import Floats, Ints, Vec3, wxyz_jacobian
from ravemj.engine.affine import AffineMotion, translation_columns
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.affine import Z_AXIS, DOFAffine, affine_values, pose_with_values
from ravemj.model.joints import wrapped_angle
from ravemj.rave.enums import CheckLimitsAction
from ravemj.rave.kinbody import KinBody
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.trajectories.bodies import body_groups

Topic = TypeVar("Topic")


@dataclass
class AffineKind:
    """Limits, planning resolution and weights of one type of affine DOFs, arrays of shape (n,)."""

    lower: Floats
    upper: Floats
    max_velocity: Floats
    resolution: Floats
    weight: Floats


class _WithKinds(Protocol):
    affine_kinds: dict[str, AffineKind]


class _AffineKind(NamedTuple):
    """One type of affine DOFs: OpenRAVE's defaults, and words for generated docstrings."""

    size: int
    limit: float
    velocity: float
    resolution: float
    weight: float
    values: str
    unit: str


_KINDS = {
    "Translation": _AffineKind(3, 100, 1.0, 0.001, 2.0, "X, Y and Z", "m"),
    "RotationAxis": _AffineKind(4, 10000, 0.4, 0.01, 2.0, "angle, for x, y, z and other axes", "rad"),
    "Rotation3D": _AffineKind(3, 10000, 0.07, 0.01, 1.0, "rotation vector", "rad"),
    "RotationQuat": _AffineKind(4, 1.0, 1.0, 0.01, 0.4, "quaternion", "1"),
}

_SETTINGS = {
    "Limits": (("lower", "upper"), "lower and upper limits of the base's {values} [{unit}], each of shape ({size},)."),
    "MaxVels": (("max_velocity",), "the velocity limits of the base's {values} [{unit}/s], shape ({size},)."),
    "Resolution": (("resolution",), "the planners' steps of the base's {values} [{unit}], shape ({size},)."),
    "Weights": (("weight",), "the weights of the base's {values} in distances, shape ({size},)."),
}
"""Fields of ``AffineKind``, and words for generated docstrings, by suffix of the method names."""

_ARGUMENTS = {
    "MaxVels": "\n\nArgs:\n    {argument}: Largest velocities.",
    "Resolution": "\n\nArgs:\n    resolution: Step for each value.",
}


def affine_numbers(kinds: Mapping[str, AffineKind], affine: int, axis: Vec3, name: str) -> Floats:
    """Return one setting of the active affine DOFs, shape (n,).

    Args:
        kinds: The settings.
        affine: The active components of the base's pose, bits of ``DOFAffine``.
        axis: The axis of ``DOFAffine.RotationAxis``.
        name: The setting, a field of ``AffineKind``.
    """
    parts = [getattr(kinds["Translation"], name)[translation_columns(affine)]]
    if affine & DOFAffine.RotationAxis:
        # OpenRAVE has four values for rotations about an axis: for x, y, z, and for any other axis.
        number = next((number for number in range(3) if axis[number] == 1.0), 3)
        parts.append(getattr(kinds["RotationAxis"], name)[number : number + 1])
    elif affine & DOFAffine.Rotation3D:
        parts.append(getattr(kinds["Rotation3D"], name))
    elif affine & DOFAffine.RotationQuat:
        parts.append(getattr(kinds["RotationQuat"], name))
    return np.concatenate(parts)


def default_kinds() -> dict[str, AffineKind]:
    """Return OpenRAVE's default settings of affine DOFs, rounded to single precision as in OpenRAVE."""
    defaults = {name: (-values.limit, values.limit, *values[2:5]) for name, values in _KINDS.items()}
    return {
        name: AffineKind(*(np.full(_KINDS[name].size, float(np.float32(value))) for value in values))
        for name, values in defaults.items()
    }


def with_affine_settings(topic: type[Topic]) -> type[Topic]:
    """Class decorator that adds function bodies and docstrings to affine DOF methods, which are signatures only."""
    for kind, about in _KINDS.items():
        for setting, (fields, what) in _SETTINGS.items():
            if (kind, setting) == ("RotationQuat", "Limits"):  # a quaternion times the maximum angle, not two limits
                continue
            words = what.format(**about._asdict())
            get, set_ = (getattr(topic, f"{verb}Affine{kind}{setting}") for verb in ("Get", "Set"))
            get.__doc__, set_.__doc__ = f"Return {words}", f"Set {words}{_argument(setting, set_)}"
            for method, body in ((get, _getter(kind, fields)), (set_, _setter(kind, fields, set_))):
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


def _setter(kind: str, fields: tuple[str, ...], method: Callable[..., None]) -> Callable[..., None]:
    arguments, caller = signature(method), method.__name__

    def set_(self: _WithKinds, *values: ArrayLike, **named: ArrayLike) -> None:
        _, *given = arguments.bind(self, *values, **named).arguments.items()
        settings = self.affine_kinds[kind]
        count = len(settings.lower)
        checked = [checked_vector(row, count, f"{caller}: {argument}") for argument, row in given]
        for field, numbers in zip(fields, checked, strict=True):
            setattr(settings, field, numbers)

    return set_


class ActiveChoice(NamedTuple):
    """The choice of active DOFs.

    Attributes:
        dofs: The DOF indices of the joints in the order of their values, in an array that is never changed; None for
            all DOFs.
        affine: The active components of the base's pose, whose values follow those of the joints: ``DOFAffine`` as a
            plain number, which is faster than the flag.
        axis: The axis of ``DOFAffine.RotationAxis``.
    """

    dofs: Ints | None = None
    affine: int = 0
    axis: Vec3 = Z_AXIS


@with_affine_settings
class ActiveDofs(KinBody):
    """Active DOFs of a robot: some of its joints, then components of its base's pose (affine DOFs)."""

    _often_called = ("CalculateActiveJacobian", "SetActiveDOFValues")

    active_choice: ActiveChoice
    """The active DOFs that ``SetActiveDOFs`` has chosen."""
    affine_kinds: dict[str, AffineKind]
    """Limits, resolutions and weights of the affine DOFs."""
    quaternion_limits: Floats
    """Rotation limit of the base: a quaternion [w, x, y, z] times the maximum angle [rad], shape (4,)."""

    def SetActiveDOFs(self, dofindices: ArrayLike, affine: int = 0, rotationaxis: ArrayLike | None = None) -> None:
        """Choose the DOFs that ``SetActiveDOFValues``, trajectories and planners use.

        Args:
            dofindices: The DOF indices of the joints, in the order in which values are given later.
            affine: The active components of the base's pose, ``DOFAffine`` combined with ``|``. Their values follow
                those of the joints, in the order X, Y, Z, rotation.
            rotationaxis: The axis of ``DOFAffine.RotationAxis`` in the world, shape (3,); by default z.

        Raises:
            ArgumentError: a DOF does not exist, or the axis is zero. The active DOFs do not change.

        Example:
            >>> robot.SetActiveDOFs([1, 0])
            >>> robot.SetActiveDOFValues([0.1, 0.2])  # the second joint, then the first
            >>> robot.SetActiveDOFs([], DOFAffine.X | DOFAffine.Y | DOFAffine.RotationAxis, [0, 0, 1])
            >>> robot.SetActiveDOFValues([1.0, 2.0, 0.5])  # the base drives
        """
        try:
            dofs = checked_indices(dofindices, self.GetDOF(), "SetActiveDOFs: dofindices")
        except IndexError as error:
            raise ArgumentError(str(error)) from None
        axis = Z_AXIS
        if rotationaxis is not None:
            x, y, z = checked_vector(rotationaxis, 3, "SetActiveDOFs: rotationaxis").tolist()
            axis = (x, y, z)
            if affine & DOFAffine.RotationAxis and not any(axis):
                raise ArgumentError("SetActiveDOFs: rotationaxis is 0 0 0, and should have a length")
        self.active_choice = ActiveChoice(dofs, int(DOFAffine(int(affine))), axis)

    def GetActiveDOF(self) -> int:
        """Return the number of active values. Until ``SetActiveDOFs`` is called, it is the number of DOFs."""
        chosen = self.active_choice
        joints = self.GetDOF() if chosen.dofs is None else len(chosen.dofs)
        return joints + len(self._affine_numbers("weight")) if chosen.affine else joints

    def GetActiveDOFIndices(self) -> Ints:
        """Return the DOF indices of the active joints, in the order of their values; affine DOFs have no index."""
        chosen = self.active_choice.dofs
        return np.arange(self.GetDOF()) if chosen is None else chosen.copy()

    GetActiveJointIndices = GetActiveDOFIndices

    def _active_dofs(self) -> list[int]:
        return self.GetActiveDOFIndices().tolist()

    def GetAffineDOF(self) -> int:
        """Return the active components of the base's pose, bits of ``DOFAffine``."""
        return self.active_choice.affine

    def GetAffineDOFIndex(self, index: int) -> int:
        """Return the index of a base pose component among the active values.

        Args:
            index: The component, a single ``DOFAffine``.

        Raises:
            ArgumentError: the component is not active.
        """
        affine = self.active_choice.affine
        if not index & affine:
            raise ArgumentError(f"GetAffineDOFIndex: {DOFAffine(index)!r} is not active")
        before = affine & (int(index) - 1) & int(DOFAffine.Transform)
        return len(self._active_dofs()) + sum(bool(before & part) for part in (1, 2, 4))

    def GetAffineRotationAxis(self) -> Floats:
        """Return the axis of ``DOFAffine.RotationAxis``, shape (3,)."""
        return np.array(self.active_choice.axis)

    def GetActiveDOFValues(self) -> Floats:
        """Return the active values: joints [rad or m], then the base's X, Y, Z [m] and rotation; shape (n,).

        Example:
            >>> robot.SetDOFValues([0.5, -0.5])
            >>> robot.SetActiveDOFs([1])
            >>> robot.GetActiveDOFValues()
            array([-0.5])
        """
        with self._simulation.lock:
            chosen, values = self.active_choice, self._state.kinematics.values()
            joints = values if chosen.dofs is None else values[chosen.dofs]
            if not chosen.affine:
                return joints
            return np.concatenate([joints, affine_values(self._state.pose(), chosen.affine, chosen.axis)])

    def SetActiveDOFValues(self, values: ArrayLike, checklimits: int = CheckLimitsAction.CheckLimits) -> None:
        """Set the active values: joints [rad or m], then the base's X, Y, Z [m] and rotation.

        Args:
            values: The values, shape (n,); further values are ignored. NaN keeps the value of a joint.
            checklimits: What to do with joint values outside the limits, as in ``SetDOFValues``. Values of the base
                are not limited.

        Raises:
            ArgumentError: there are too few values, or one is infinite. The robot does not move.

        Example:
            >>> robot.SetActiveDOFs([1], ravemj.DOFAffine.X)
            >>> robot.SetActiveDOFValues([0.5, 2.0])  # the second joint to 0.5 rad, the base to x = 2 m
        """
        given = checked_numbers(values, "SetActiveDOFValues: values")
        count = self.GetActiveDOF()
        if given.ndim != 1 or len(given) < count:
            message = f"SetActiveDOFValues: values have shape {given.shape}, and should be {count} numbers"
            raise ArgumentError(message)
        choice = self.active_choice
        joints = self.GetDOF() if choice.dofs is None else len(choice.dofs)
        base = checked_vector(given[joints:count], count - joints, "SetActiveDOFValues: base's values")
        with self._simulation.lock:
            if joints:
                self.SetDOFValues(given[:joints], choice.dofs, checklimits)
            if choice.affine:
                self._state.set_pose(pose_with_values(self._state.pose(), base, choice.affine, choice.axis))

    def GetActiveDOFVelocities(self) -> Floats:
        """Return the velocities of the active values: of joints [rad/s or m/s], then of the base; shape (n,)."""
        with self._simulation.lock:
            joints = self.GetDOFVelocities(self._active_dofs())
            return np.concatenate([joints, self._affine_motion().rates(self._state.link_velocities()[0])])

    def SetActiveDOFVelocities(self, velocities: ArrayLike, checklimits: int = CheckLimitsAction.CheckLimits) -> None:
        """Set the velocities of the active values. The other DOFs keep their velocities.

        Args:
            velocities: The velocities of the joints [rad/s or m/s], then those of the active components of the base's
                pose, shape (n,).
            checklimits: What to do with joint velocities outside the limits, as in ``SetDOFVelocities``.

        Raises:
            ArgumentError: the number of velocities is wrong. The velocities stay as they were.
        """
        given = checked_vector(velocities, self.GetActiveDOF(), "SetActiveDOFVelocities")
        joints = self._active_dofs()
        with self._simulation.lock:
            base = self._affine_motion().velocity(given[len(joints) :], self._state.link_velocities()[0])
            rates = self.GetDOFVelocities()
            rates[joints] = given[: len(joints)]
            self.SetDOFVelocities(rates, base[:3], base[3:], checklimits)

    def GetActiveDOFLimits(self) -> tuple[Floats, Floats]:
        """Return the lower and upper limits of the active values, shape (n,) each; the base has ±100 m, ±10000 rad."""
        lower, upper = self.GetDOFLimits(self.GetActiveDOFIndices())
        return self._with_affine(lower, "lower"), self._with_affine(upper, "upper")

    def GetActiveDOFMaxVel(self) -> Floats:
        """Return the velocity limits of the active values [rad/s or m/s], shape (n,)."""
        return self._with_affine(self.GetDOFVelocityLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFMaxAccel(self) -> Floats:
        """Return the acceleration limits of the active values, shape (n,).

        As in OpenRAVE, the numbers of the base are its velocity limits.
        """
        return self._with_affine(self.GetDOFAccelerationLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFMaxJerk(self) -> Floats:
        """Return the jerk limits of the active values, shape (n,); for the base, the velocity limits."""
        return self._with_affine(self.GetDOFJerkLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFHardMaxVel(self) -> Floats:
        """Return the hard velocity limits of the active values, shape (n,); for the base, the velocity limits."""
        return self._with_affine(self.GetDOFHardVelocityLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFHardMaxAccel(self) -> Floats:
        """Return the hard acceleration limits of the active values, shape (n,); for the base, the velocity limits."""
        return self._with_affine(self.GetDOFHardAccelerationLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFHardMaxJerk(self) -> Floats:
        """Return the hard jerk limits of the active values, shape (n,); for the base, the velocity limits."""
        return self._with_affine(self.GetDOFHardJerkLimits(self._active_dofs()), "max_velocity")

    def GetActiveDOFResolutions(self) -> Floats:
        """Return the steps in which planners test the active values for collisions [rad or m], shape (n,)."""
        return self._with_affine(self.GetDOFResolutions(self._active_dofs()), "resolution")

    def GetActiveDOFWeights(self) -> Floats:
        """Return the weights of the active values in distances, shape (n,)."""
        return self._with_affine(self.GetDOFWeights(self._active_dofs()), "weight")

    def _with_affine(self, joints: Floats, name: str) -> Floats:
        return np.concatenate([joints, self._affine_numbers(name)]) if self.active_choice.affine else joints

    def _affine_numbers(self, name: str) -> Floats:
        return affine_numbers(self.affine_kinds, self.active_choice.affine, self.active_choice.axis, name)

    def GetActiveConfigurationSpecification(self, interpolation: str = "") -> ConfigurationSpecification:
        """Return the configuration specification of the active values.

        Args:
            interpolation: The interpolation between waypoints, for instance ``linear``.

        Example:
            >>> trajectory = ravemj.RaveCreateTrajectory(env, "")
            >>> trajectory.Init(robot.GetActiveConfigurationSpecification("linear"))
        """
        groups = body_groups(self._state.scene.name, self._active_dofs(), self.active_choice.affine, interpolation)
        return ConfigurationSpecification.of(groups)

    def SubtractActiveDOFValues(self, values0: ArrayLike, values1: ArrayLike) -> Floats:
        """Return the difference of active values; that of circular joints and of the base's angle is in [-pi, pi].

        Args:
            values0: Active values, shape (n,).
            values1: The active values to subtract, shape (n,).

        Returns:
            ``values0 - values1``, shape (n,).

        Raises:
            ArgumentError: the number of values is wrong.
        """
        count, joints = self.GetActiveDOF(), self._active_dofs()
        minuend, subtrahend = (
            checked_vector(values, count, "SubtractActiveDOFValues") for values in (values0, values1)
        )
        difference = minuend - subtrahend
        split = len(joints)
        difference[:split] = self.SubtractDOFValues(minuend[:split], subtrahend[:split], joints)
        if self.active_choice.affine & DOFAffine.RotationAxis:
            difference[-1:] = wrapped_angle(difference[-1:])
        return difference

    def CalculateActiveJacobian(self, linkindex: int, offset: ArrayLike) -> Floats:
        """Return the Jacobian of a link point's position with respect to the active values.

        Args:
            linkindex: Index of the link.
            offset: The point in the world [m], shape (3,).

        Returns:
            The Jacobian in world axes, shape (3, active dof).
        """
        point = finite_vector(offset, 3, "offset")
        link = self._checked_link(linkindex)
        with self._simulation.lock:
            joints = self._active_columns(self._state.dynamics.translation_jacobian(link, point))
            if not self.active_choice.affine:
                return joints
            return np.hstack([joints, self._affine_motion().translation_jacobian(point)])

    def _active_columns(self, jacobian: Floats) -> Floats:
        chosen = self.active_choice.dofs
        return jacobian if chosen is None else jacobian.take(chosen, 1)

    def CalculateActiveAngularVelocityJacobian(self, linkindex: int) -> Floats:
        """Return the Jacobian of a link's angular velocity with respect to the active velocities.

        Args:
            linkindex: Index of the link.

        Returns:
            The Jacobian in world axes, shape (3, active dof).
        """
        with self._simulation.lock:
            joints = self._active_columns(self.ComputeJacobianAxisAngle(linkindex))
            if not self.active_choice.affine:
                return joints
            return np.hstack([joints, self._affine_motion().rotation_jacobian()])

    def CalculateActiveRotationJacobian(self, linkindex: int, quat: ArrayLike) -> Floats:
        """Return the Jacobian of a quaternion fixed to a link, with respect to the active values.

        Args:
            linkindex: Index of the link.
            quat: The quaternion [w, x, y, z]: the orientation of the link, or of anything fixed to it.

        Returns:
            The Jacobian, shape (4, active dof).
        """
        rates = wxyz_jacobian(checked_vector(quat, 4, "quat").tolist())
        return rates @ self.CalculateActiveAngularVelocityJacobian(linkindex)

    def GetAffineRotationQuatLimits(self) -> Floats:
        """Return the rotation limit of the base: a quaternion [w, x, y, z] times the maximum angle, shape (4,)."""
        return self.quaternion_limits.copy()

    def SetAffineRotationQuatLimits(self, quatangle: ArrayLike) -> None:
        """Set the rotation limit of the base. As in OpenRAVE it has no effect: active limits stay -1 and 1.

        Args:
            quatangle: A quaternion [w, x, y, z] times the largest angle from that rotation [rad], shape (4,).
        """
        self.quaternion_limits = checked_vector(quatangle, 4, "SetAffineRotationQuatLimits: quatangle")

    def _affine_motion(self) -> AffineMotion:
        choice = self.active_choice
        return AffineMotion(self._state.pose(), choice.affine, choice.axis)

    def active_dofs(self) -> tuple[int, ...]:
        """Return the DOF indices of the active joints."""
        return tuple(self._active_dofs())

    def moves_as_a_whole(self) -> bool:
        """Return whether affine DOFs are active, which move the whole robot."""
        return bool(self.active_choice.affine)

    # Settings of the affine DOFs, with bodies and docstrings from the table in ``affine``

    def GetAffineTranslationLimits(self) -> tuple[Floats, Floats]: ...
    def SetAffineTranslationLimits(self, lower: ArrayLike, upper: ArrayLike) -> None: ...
    def GetAffineTranslationMaxVels(self) -> Floats: ...
    def SetAffineTranslationMaxVels(self, vels: ArrayLike) -> None: ...
    def GetAffineTranslationResolution(self) -> Floats: ...
    def SetAffineTranslationResolution(self, resolution: ArrayLike) -> None: ...
    def GetAffineTranslationWeights(self) -> Floats: ...
    def SetAffineTranslationWeights(self, weights: ArrayLike) -> None: ...
    def GetAffineRotationAxisLimits(self) -> tuple[Floats, Floats]: ...
    def SetAffineRotationAxisLimits(self, lower: ArrayLike, upper: ArrayLike) -> None: ...
    def GetAffineRotationAxisMaxVels(self) -> Floats: ...
    def SetAffineRotationAxisMaxVels(self, velocity: ArrayLike) -> None: ...
    def GetAffineRotationAxisResolution(self) -> Floats: ...
    def SetAffineRotationAxisResolution(self, resolution: ArrayLike) -> None: ...
    def GetAffineRotationAxisWeights(self) -> Floats: ...
    def SetAffineRotationAxisWeights(self, weights: ArrayLike) -> None: ...
    def GetAffineRotation3DLimits(self) -> tuple[Floats, Floats]: ...
    def SetAffineRotation3DLimits(self, lower: ArrayLike, upper: ArrayLike) -> None: ...
    def GetAffineRotation3DMaxVels(self) -> Floats: ...
    def SetAffineRotation3DMaxVels(self, velocity: ArrayLike) -> None: ...
    def GetAffineRotation3DResolution(self) -> Floats: ...
    def SetAffineRotation3DResolution(self, resolution: ArrayLike) -> None: ...
    def GetAffineRotation3DWeights(self) -> Floats: ...
    def SetAffineRotation3DWeights(self, weights: ArrayLike) -> None: ...
    def GetAffineRotationQuatMaxVels(self) -> Floats: ...
    def SetAffineRotationQuatMaxVels(self, velocity: ArrayLike) -> None: ...
    def GetAffineRotationQuatResolution(self) -> Floats: ...
    def SetAffineRotationQuatResolution(self, resolution: ArrayLike) -> None: ...
    def GetAffineRotationQuatWeights(self) -> Floats: ...
    def SetAffineRotationQuatWeights(self, weights: ArrayLike) -> None: ...

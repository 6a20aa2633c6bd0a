"""Limits and the like of the affine DOFs."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_vector
from ravemj.core.transforms import Floats
from ravemj.rave.body.base import BodyPart


def _single(value: float) -> float:
    """Round to single precision, in which OpenRAVE writes its defaults."""
    return float(np.float32(value))


@dataclass
class AffineKind:
    """Settings of one kind of affine DOFs, a value for each."""

    lower: Floats
    upper: Floats
    max_velocity: Floats
    resolution: Floats
    weight: Floats


def _kind(size: int, limit: float, velocity: float, resolution: float, weight: float) -> AffineKind:
    values = (-limit, limit, velocity, resolution, weight)
    return AffineKind(*(np.full(size, _single(value)) for value in values))


def default_kinds() -> dict[str, AffineKind]:
    """Return OpenRAVE's defaults."""
    return {
        "Translation": _kind(3, 100, 1.0, 0.001, 2.0),
        "RotationAxis": _kind(4, 10000, 0.4, 0.01, 2.0),
        "Rotation3D": _kind(3, 10000, 0.07, 0.01, 1.0),
        "RotationQuat": _kind(4, 1.0, 1.0, 0.01, 0.4),
    }


class AffineSettings(BodyPart):
    """Limits, resolutions and weights of the parts of the base's pose that can be active."""

    affine_kinds: dict[str, AffineKind]

    def _get_affine(self, kind: str, name: str) -> Floats:
        return getattr(self.affine_kinds[kind], name).copy()

    def _set_affine(self, kind: str, **values: ArrayLike) -> None:
        settings = self.affine_kinds[kind]
        count = len(settings.lower)
        checked = {name: checked_vector(one, count, f"SetAffine{kind}: {name}") for name, one in values.items()}
        for name, numbers in checked.items():
            setattr(settings, name, numbers)

    def GetAffineTranslationLimits(self) -> tuple[Floats, Floats]:
        """Return lower and upper limits of the base's X, Y and Z [m], each of shape (3,)."""
        return self._get_affine("Translation", "lower"), self._get_affine("Translation", "upper")

    def SetAffineTranslationLimits(self, lower: ArrayLike, upper: ArrayLike) -> None:
        """Set lower and upper limits of the base's X, Y and Z [m], each of shape (3,)."""
        self._set_affine("Translation", lower=lower, upper=upper)

    def GetAffineTranslationMaxVels(self) -> Floats:
        """Return the velocity limits of the base's X, Y and Z [m/s], shape (3,)."""
        return self._get_affine("Translation", "max_velocity")

    def SetAffineTranslationMaxVels(self, velocities: ArrayLike) -> None:
        """Set the velocity limits of the base's X, Y and Z [m/s], shape (3,).

        Args:
            velocities: Largest velocities [m/s or rad/s].
        """
        self._set_affine("Translation", max_velocity=velocities)

    def GetAffineTranslationResolution(self) -> Floats:
        """Return the planners' steps of the base's X, Y and Z [m], shape (3,)."""
        return self._get_affine("Translation", "resolution")

    def SetAffineTranslationResolution(self, resolution: ArrayLike) -> None:
        """Set the planners' steps of the base's X, Y and Z [m], shape (3,).

        Args:
            resolution: The step [m or rad].
        """
        self._set_affine("Translation", resolution=resolution)

    def GetAffineTranslationWeights(self) -> Floats:
        """Return the weights of the base's X, Y and Z in distances, shape (3,)."""
        return self._get_affine("Translation", "weight")

    def SetAffineTranslationWeights(self, weights: ArrayLike) -> None:
        """Set the weights of the base's X, Y and Z in distances, shape (3,)."""
        self._set_affine("Translation", weight=weights)

    def GetAffineRotationAxisLimits(self) -> tuple[Floats, Floats]:
        """Return lower and upper limits of the base's angle, for x, y, z and other axes [rad], each of shape (4,)."""
        return self._get_affine("RotationAxis", "lower"), self._get_affine("RotationAxis", "upper")

    def SetAffineRotationAxisLimits(self, lower: ArrayLike, upper: ArrayLike) -> None:
        """Set lower and upper limits of the base's angle, for x, y, z and other axes [rad], each of shape (4,)."""
        self._set_affine("RotationAxis", lower=lower, upper=upper)

    def GetAffineRotationAxisMaxVels(self) -> Floats:
        """Return the velocity limits of the base's angle, for x, y, z and other axes [rad/s], shape (4,)."""
        return self._get_affine("RotationAxis", "max_velocity")

    def SetAffineRotationAxisMaxVels(self, velocities: ArrayLike) -> None:
        """Set the velocity limits of the base's angle, for x, y, z and other axes [rad/s], shape (4,).

        Args:
            velocities: Largest velocities [m/s or rad/s].
        """
        self._set_affine("RotationAxis", max_velocity=velocities)

    def GetAffineRotationAxisResolution(self) -> Floats:
        """Return the planners' steps of the base's angle, for x, y, z and other axes [rad], shape (4,)."""
        return self._get_affine("RotationAxis", "resolution")

    def SetAffineRotationAxisResolution(self, resolution: ArrayLike) -> None:
        """Set the planners' steps of the base's angle, for x, y, z and other axes [rad], shape (4,).

        Args:
            resolution: The step [m or rad].
        """
        self._set_affine("RotationAxis", resolution=resolution)

    def GetAffineRotationAxisWeights(self) -> Floats:
        """Return the weights of the base's angle, for x, y, z and other axes in distances, shape (4,)."""
        return self._get_affine("RotationAxis", "weight")

    def SetAffineRotationAxisWeights(self, weights: ArrayLike) -> None:
        """Set the weights of the base's angle, for x, y, z and other axes in distances, shape (4,)."""
        self._set_affine("RotationAxis", weight=weights)

    def GetAffineRotation3DLimits(self) -> tuple[Floats, Floats]:
        """Return lower and upper limits of the base's rotation vector [rad], each of shape (3,)."""
        return self._get_affine("Rotation3D", "lower"), self._get_affine("Rotation3D", "upper")

    def SetAffineRotation3DLimits(self, lower: ArrayLike, upper: ArrayLike) -> None:
        """Set lower and upper limits of the base's rotation vector [rad], each of shape (3,)."""
        self._set_affine("Rotation3D", lower=lower, upper=upper)

    def GetAffineRotation3DMaxVels(self) -> Floats:
        """Return the velocity limits of the base's rotation vector [rad/s], shape (3,)."""
        return self._get_affine("Rotation3D", "max_velocity")

    def SetAffineRotation3DMaxVels(self, velocities: ArrayLike) -> None:
        """Set the velocity limits of the base's rotation vector [rad/s], shape (3,).

        Args:
            velocities: Largest velocities [m/s or rad/s].
        """
        self._set_affine("Rotation3D", max_velocity=velocities)

    def GetAffineRotation3DResolution(self) -> Floats:
        """Return the planners' steps of the base's rotation vector [rad], shape (3,)."""
        return self._get_affine("Rotation3D", "resolution")

    def SetAffineRotation3DResolution(self, resolution: ArrayLike) -> None:
        """Set the planners' steps of the base's rotation vector [rad], shape (3,).

        Args:
            resolution: Step for each component, shape (3,).
        """
        self._set_affine("Rotation3D", resolution=resolution)

    def GetAffineRotation3DWeights(self) -> Floats:
        """Return the weights of the base's rotation vector in distances, shape (3,)."""
        return self._get_affine("Rotation3D", "weight")

    def SetAffineRotation3DWeights(self, weights: ArrayLike) -> None:
        """Set the weights of the base's rotation vector in distances, shape (3,)."""
        self._set_affine("Rotation3D", weight=weights)

    def GetAffineRotationQuatLimits(self) -> tuple[Floats, Floats]:
        """Return lower and upper limits of the base's quaternion [1], each of shape (4,)."""
        return self._get_affine("RotationQuat", "lower"), self._get_affine("RotationQuat", "upper")

    def SetAffineRotationQuatLimits(self, lower: ArrayLike, upper: ArrayLike) -> None:
        """Set lower and upper limits of the base's quaternion [1], each of shape (4,)."""
        self._set_affine("RotationQuat", lower=lower, upper=upper)

    def GetAffineRotationQuatMaxVels(self) -> Floats:
        """Return the velocity limits of the base's quaternion [1/s], shape (4,)."""
        return self._get_affine("RotationQuat", "max_velocity")

    def SetAffineRotationQuatMaxVels(self, velocities: ArrayLike) -> None:
        """Set the velocity limits of the base's quaternion [1/s], shape (4,).

        Args:
            velocities: Largest velocities [m/s or rad/s].
        """
        self._set_affine("RotationQuat", max_velocity=velocities)

    def GetAffineRotationQuatResolution(self) -> Floats:
        """Return the planners' steps of the base's quaternion [1], shape (4,)."""
        return self._get_affine("RotationQuat", "resolution")

    def SetAffineRotationQuatResolution(self, resolution: ArrayLike) -> None:
        """Set the planners' steps of the base's quaternion [1], shape (4,).

        Args:
            resolution: The step [m or rad].
        """
        self._set_affine("RotationQuat", resolution=resolution)

    def GetAffineRotationQuatWeights(self) -> Floats:
        """Return the weights of the base's quaternion in distances, shape (4,)."""
        return self._get_affine("RotationQuat", "weight")

    def SetAffineRotationQuatWeights(self, weights: ArrayLike) -> None:
        """Set the weights of the base's quaternion in distances, shape (4,)."""
        self._set_affine("RotationQuat", weight=weights)

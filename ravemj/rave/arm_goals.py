"""Goals of an arm: where its tool is, and the joint values that take it elsewhere."""

from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.transforms import Floats, inverse
from ravemj.errors import ErrorCode, UnsupportedError
from ravemj.geometry_functions import Ray, quatFromRotationMatrix
from ravemj.rave.enums import IkParameterizationType
from ravemj.rave.ikparameterization import IkParameterization

if TYPE_CHECKING:
    from ravemj.rave.manipulator import Manipulator

INVERSE_KINEMATICS = "inverse kinematics"


class ArmGoals(ApiObject):
    """Part of the API of a manipulator."""

    @property
    def _arm(self) -> "Manipulator":
        return cast("Manipulator", self)

    def GetIkParameterization(
        self, iktype: "IkParameterizationType | IkParameterization | int", inworld: bool = True
    ) -> IkParameterization:
        """Return where the tool is now, as a goal.

        Args:
            iktype: The type of goal, or a goal of that type.
            inworld: True: in the world. False: in the base link of the arm.
        """
        kind = IkParameterizationType(iktype.GetType() if isinstance(iktype, IkParameterization) else iktype)
        base = self._arm.GetBase()
        T_world_tool = self._arm.GetTransform()
        T_base_world = np.eye(4) if inworld or base is None else inverse(base.GetTransform())
        return IkParameterization(_part(kind, T_base_world @ T_world_tool, self._arm.GetLocalToolDirection()), kind)

    def GetIkSolver(self) -> None:
        """Return the solver of inverse kinematics: None, there is none."""

    def SetIkSolver(self, solver: object) -> bool:
        """Refuse a solver of inverse kinematics; return whether it was taken."""
        del solver
        return False

    def FindIKSolution(self, param: ArrayLike | IkParameterization, *arguments: Any, **options: Any) -> Floats | None:  # noqa: ANN401 - OpenRAVE's overloads
        """Return joint values that take the tool to a goal, in the order of ``GetArmIndices()``, shape (n,).

        Args:
            param: ``T_world_tool``, or an ``IkParameterization``.
            arguments: ``IkFilterOptions``, and what OpenRAVE's other overloads take.
            options: The same by name.

        Raises:
            UnsupportedError: always; there is no solver.
        """
        raise UnsupportedError("FindIKSolution", INVERSE_KINEMATICS, ErrorCode.Failed)

    def FindIKSolutions(self, param: ArrayLike | IkParameterization, *arguments: Any, **options: Any) -> Floats:  # noqa: ANN401 - OpenRAVE's overloads
        """Return joint values that take the tool to a goal, each way in a row, shape (k, n).

        Args:
            param: ``T_world_tool``, or an ``IkParameterization``.
            arguments: ``IkFilterOptions``, and what OpenRAVE's other overloads take.
            options: The same by name.

        Raises:
            UnsupportedError: always; there is no solver.
        """
        raise UnsupportedError("FindIKSolutions", INVERSE_KINEMATICS, ErrorCode.Failed)


def _part(kind: IkParameterizationType, T: Floats, direction: Floats) -> object:
    """Return what a type of goal takes of a tool's pose."""
    pointing = T[:3, :3] @ direction
    parts: dict[IkParameterizationType, object] = {
        IkParameterizationType.Transform6D: T,
        IkParameterizationType.Rotation3D: quatFromRotationMatrix(T),
        IkParameterizationType.Translation3D: T[:3, 3],
        IkParameterizationType.Lookat3D: T[:3, 3],
        IkParameterizationType.Direction3D: pointing,
        IkParameterizationType.Ray4D: Ray(T[:3, 3], pointing),
        IkParameterizationType.TranslationDirection5D: Ray(T[:3, 3], pointing),
        IkParameterizationType.TranslationXY2D: T[:2, 3],
        IkParameterizationType.TranslationXYOrientation3D: np.array([*T[:2, 3], np.arctan2(T[1, 0], T[0, 0])]),
    }
    if kind not in parts:
        raise UnsupportedError(f"GetIkParameterization of {kind.name}", f"{INVERSE_KINEMATICS} of that type")
    return parts[kind]

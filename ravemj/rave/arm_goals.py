"""Where the tool of an arm is, as a goal of inverse kinematics."""

from abc import abstractmethod
from typing import TYPE_CHECKING

import numpy as np

from ravemj.core.transforms import Floats, inverse, pose_of
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.ik_parameterization import goal_of_tool, moved_goal
from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType
from ravemj.model import hashes, scene
from ravemj.rave.specification import ConfigurationSpecification, IkParameterization

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody

_Type = IkParameterizationType


class ArmGoals:
    """Goals that the tool reaches where it is, and what solvers for goals depend on."""

    _robot: "KinBody"
    _state: BodyState

    @property
    @abstractmethod
    def _scene(self) -> scene.Manipulator: ...

    @abstractmethod
    def GetTransform(self) -> Floats:
        """Return ``T_world_tool``."""

    def GetIkParameterization(
        self, iktype: IkParameterizationType | IkParameterization | int, inworld: bool = True
    ) -> IkParameterization:
        """Return where the tool is now, as a goal.

        Args:
            iktype: The type of goal, or a goal of that type, whose point of the tool is kept; so are its custom
                values. Of a point that is looked at, the foot on the ray of the tool is taken.
            inworld: True: in the world. False: in the base link of the arm.
        """
        like = iktype if isinstance(iktype, IkParameterization) else None
        kind = _Type(iktype if like is None else like.GetType())
        if kind not in GOAL_TYPES:
            raise ArgumentError(f"GetIkParameterization: iktype is {kind.name}, and should be a type of goal")
        T_world_base = self._T_world_base()
        T_frame_tool, in_base = self.GetTransform(), not inworld or "Angle" in kind.name
        if in_base:
            T_frame_tool = inverse(T_world_base) @ T_frame_tool
        direction = np.array(self._scene.direction)
        values = goal_of_tool(kind, T_frame_tool, direction, None if like is None else like.GetValues())
        if in_base and inworld:  # angles to the axes of the base
            values = moved_goal(kind, values, pose_of(T_world_base))
        goal = IkParameterization() if like is None else IkParameterization(like)
        goal.SetValues(values, kind)
        return goal

    def GetIkConfigurationSpecification(
        self, iktype: IkParameterizationType | int, interpolation: str = ""
    ) -> ConfigurationSpecification:
        """Return the layout of a goal of this arm in a trajectory.

        Args:
            iktype: The type of goal.
            interpolation: How the values change between waypoints.
        """
        names = self._robot.GetName(), self._scene.name
        return IkParameterization.GetConfigurationSpecificationFromType(iktype, interpolation, *names)

    def GetInverseKinematicsStructureHash(self, iktype: IkParameterizationType | int) -> str:
        """Return a text that is the same for arms that one solver fits: 32 hexadecimal digits.

        Args:
            iktype: The type of goal.
        """
        kind = _Type(iktype)
        with_direction = kind in {_Type.Direction3D, _Type.Ray4D, _Type.TranslationDirection5D}
        tool = kind != _Type.Transform6D
        return hashes.of_inverse_kinematics(
            self._state.scene, self._scene, kind.name, tool=tool, direction=with_direction
        )

    def _T_world_base(self) -> Floats:
        return np.eye(4) if self._scene.base is None else self._state.link_transform(self._scene.base)

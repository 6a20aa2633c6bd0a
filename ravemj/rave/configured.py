"""The configuration of a body as one vector: its joint values, then its pose."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import DOFAffine
from ravemj.rave.body.placement import Placement
from ravemj.rave.enums import CheckLimitsAction
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.trajectories.bodies import body_groups, configuration_values, split_configuration


class Configured(Placement):
    """The configuration of a body as one vector, and its specification."""

    def GetConfigurationSpecification(self, interpolation: str = "") -> ConfigurationSpecification:
        """Return what the numbers of the body's configuration are: its joint values, then its pose.

        Args:
            interpolation: How they change between waypoints, for instance ``linear``.
        """
        groups = body_groups(self.GetName(), range(self.GetDOF()), DOFAffine.Transform, interpolation)
        return ConfigurationSpecification.of(groups)

    def GetConfigurationSpecificationIndices(
        self, indices: ArrayLike, interpolation: str = ""
    ) -> ConfigurationSpecification:
        """Return the specification of the values of some joints.

        Args:
            indices: Which DOFs, in which order.
            interpolation: How they change between waypoints, for instance ``linear``.

        Raises:
            ArgumentError: there is no such DOF.
        """
        chosen = checked_numbers(indices, "indices").astype(np.int_).tolist()
        if any(not 0 <= index < self.GetDOF() for index in chosen):
            raise ArgumentError(f"indices: are {chosen}, and should be from 0 to {self.GetDOF() - 1}")
        return ConfigurationSpecification.of(body_groups(self.GetName(), chosen, 0, interpolation))

    def GetConfigurationValues(self) -> Floats:
        """Return the joint values, then the pose (x, y, z, qw, qx, qy, qz), shape (dof + 7,)."""
        with self._simulation.lock:
            return configuration_values(self.GetDOFValues(), self.GetTransform())

    def SetConfigurationValues(self, values: ArrayLike, checklimits: int = CheckLimitsAction.CheckLimits) -> None:
        """Set the joint values and the pose.

        Args:
            values: As ``GetConfigurationValues`` returns them, shape (dof + 7,).
            checklimits: As for ``SetDOFValues``.

        Raises:
            ArgumentError: there are more or fewer values.
        """
        joint_values, pose = split_configuration(checked_numbers(values, "values"), self.GetDOF())
        self.SetTransformWithDOFValues(pose.matrix(), joint_values, checklimits)

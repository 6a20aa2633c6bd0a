"""The numbers of configurations: read, written, and converted."""

from collections.abc import MutableSequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import also_named
from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats, Ints, Pose
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.geometry_functions import arguments
from ravemj.trajectories import extraction, layout
from ravemj.trajectories.conversion import FindBody, convert_group, converted, nobody
from ravemj.trajectories.groups import Group

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.kinbody import KinBody
    from ravemj.rave.specification import ConfigurationSpecification


class ConfigurationData(ApiObject):
    """The part of ``ConfigurationSpecification`` that works on numbers."""

    _groups: list[Group]

    def ExtractJointValues(
        self, data: ArrayLike, body: "KinBody | None", indices: ArrayLike, timederivative: int = 0
    ) -> Floats | None:
        """Return joint values in a configuration.

        Args:
            data: The configuration.
            body: Whose values; None: those of any body.
            indices: DOF indices.
            timederivative: 1 for velocities, 2 for accelerations and so on.

        Returns:
            One value for each index, 0 for those that are not there; None where there are none of the body.
        """
        values = self._checked(data)
        return extraction.joint_values(
            self._groups, values, _name(body), _indices(indices), checked_order(timederivative)
        )

    def InsertJointValues(
        self,
        data: MutableSequence[float] | Floats,
        values: ArrayLike,
        body: "KinBody | None",
        indices: ArrayLike,
        timederivative: int = 0,
    ) -> bool:
        """Write joint values into a configuration; the others stay. Arguments as for ``ExtractJointValues``.

        Args:
            data: The configuration; it is changed. Shape (dof,).
            values: The numbers.
            body: The body.
            indices: The DOFs that the values are of.
            timederivative: 0 for values, 1 for velocities, 2 for accelerations.

        Returns:
            Whether there are values of the body.
        """
        given, chosen, changed = checked_numbers(values, "values"), _indices(indices), self._checked(data)
        if given.shape != (len(chosen),):
            message = f"values: has shape {given.shape}, and should have shape ({len(chosen)},)"
            raise ArgumentError(message, ErrorCode.Assert)
        order = checked_order(timederivative)
        found = extraction.insert_joint_values(self._groups, changed, given, _name(body), chosen, order)
        data[:] = changed if isinstance(data, np.ndarray) else changed.tolist()
        return found

    def ExtractAffineValues(
        self, data: ArrayLike, body: "KinBody | None", affinedofs: int, timederivative: int = 0
    ) -> Floats | None:
        """Return values of parts of a pose in a configuration.

        Args:
            data: The configuration.
            body: Whose pose; None: that of any body.
            affinedofs: ``DOFAffine`` values, combined.
            timederivative: 1 for velocities, 2 for accelerations and so on.

        Returns:
            Values in the order X, Y, Z, rotation, shape (n,); 0 for those that are not there; None where there are
            none of the body. (OpenRAVE looks for positions under a name that no group has, and finds none.)
        """
        values, order = self._checked(data), checked_order(timederivative)
        return extraction.affine_values(self._groups, values, _name(body), affinedofs, order)

    def ExtractTransform(
        self, transform: ArrayLike | None, data: ArrayLike, body: "KinBody | None", timederivative: int = 0
    ) -> Floats | None:
        """Return a body's pose in a configuration.

        Args:
            transform: What to take from where the configuration has only parts of a pose; None: the identity.
            data: The configuration.
            body: Whose pose; None: that of any body.
            timederivative: Has to be 0; ``ExtractAffineValues`` gives derivatives.

        Returns:
            Shape (4, 4); None where there is nothing of the body.
        """
        if timederivative != 0:
            raise ArgumentError(f"timederivative: is {timederivative}, and should be 0; take ExtractAffineValues")
        start = Pose() if transform is None else arguments.pose(transform, "transform")
        pose = extraction.pose(self._groups, self._checked(data), _name(body), start)
        return None if pose is None else pose.matrix()

    def ExtractDeltaTime(self, data: ArrayLike) -> float | None:
        """Return the time since the last waypoint [s] in the configuration ``data``, shape (dof,), or None."""
        column = extraction.time_column(self._groups)
        return None if column is None else float(self._checked(data)[column])

    def InsertDeltaTime(self, data: MutableSequence[float] | Floats, deltatime: float) -> bool:
        """Write the time since the last waypoint [s] into a configuration; return whether it has a place for it.

        Args:
            data: The configuration; it is changed. Shape (dof,).
            deltatime: Seconds since the configuration before.
        """
        column = extraction.time_column(self._groups)
        if column is None:
            return False
        self._checked(data)
        data[column] = deltatime
        return True

    def ExtractUsedBodies(self, env: "Environment") -> "list[KinBody]":
        """Return the bodies of ``env`` whose values the configuration has."""
        bodies = (env.GetKinBody(name) for name in extraction.used_bodies(self._groups))
        return [body for body in bodies if body is not None]

    @also_named(env="body")
    def ExtractUsedIndices(self, body: "KinBody") -> tuple[Ints, Ints]:
        """Return the DOF indices of ``body`` in the configuration, and the columns of their values."""
        indices, places = extraction.used_indices(self._groups, body.GetName())
        return np.array(indices, dtype=np.int_), np.array(places, dtype=np.int_)

    def ConvertData(
        self,
        targetspec: "ConfigurationSpecification",
        sourcedata: ArrayLike,
        numpoints: int,
        env: "Environment | None",
        filluninitialized: bool = True,
    ) -> Floats:
        """Return configurations in another specification.

        Args:
            targetspec: The other specification.
            sourcedata: The configurations, one behind the other.
            numpoints: How many they are.
            env: Where the bodies are whose present state stands for what the configurations lack.
            filluninitialized: False: zeros stand for it.

        Returns:
            The configurations, one behind the other, shape (numpoints * dof,).
        """
        target = np.zeros(numpoints * targetspec.GetDOF())
        return self._converted(target, targetspec, sourcedata, numpoints, _finder(env) if filluninitialized else None)

    def ConvertDataFromPrevious(
        self,
        targetdata: ArrayLike,
        targetspec: "ConfigurationSpecification",
        sourcedata: ArrayLike,
        numpoints: int,
        env: "Environment | None",
    ) -> Floats:
        """Return configurations in another specification; what they lack is taken from ``targetdata``.

        Args:
            targetdata: Numbers in the layout of the target; they are changed.
            targetspec: The layout of the target.
            sourcedata: Numbers in the layout of this one, shape (numpoints, dof).
            numpoints: How many configurations there are.
            env: Where the bodies are.
        """
        del env
        return self._converted(checked_numbers(targetdata, "targetdata"), targetspec, sourcedata, numpoints, None)

    def _converted(
        self,
        target: Floats,
        targetspec: "ConfigurationSpecification",
        sourcedata: ArrayLike,
        numpoints: int,
        find_body: FindBody | None,
    ) -> Floats:
        source = _rows(sourcedata, numpoints, layout.count(self._groups), "sourcedata")
        rows = _rows(target, numpoints, targetspec.GetDOF(), "targetdata")
        return converted(self._groups, source, targetspec.GetGroups(), rows, find_body).ravel()

    @staticmethod
    def ConvertGroupData(
        gtarget: Group,
        sourcedata: ArrayLike,
        gsource: Group,
        numpoints: int,
        env: "Environment | None",
        filluninitialized: bool = True,
    ) -> Floats:
        """Return the values of a group as those of another group of its kind; see ``ConvertData``.

        Args:
            gtarget: The group to convert to.
            sourcedata: Numbers of the group, shape (numpoints, dof).
            gsource: The group that the data are of.
            numpoints: How many configurations there are.
            env: Where the bodies are.
            filluninitialized: Whether values that the source has not are taken from the environment.
        """
        target = np.zeros((numpoints, gtarget.dof))
        source = _rows(sourcedata, numpoints, gsource.dof, "sourcedata")
        convert_group(gsource, source, gtarget, target, _finder(env) if filluninitialized else None)
        return target.ravel()

    def _checked(self, data: ArrayLike) -> Floats:
        return _rows(data, 1, layout.count(self._groups), "data")[0]


def checked_order(derivative: int, name: str = "timederivative") -> int:
    """Return the order of a derivative, from 0 to 6."""
    if not 0 <= derivative <= 6:
        raise ArgumentError(f"{name}: is {derivative}, and should be from 0 to 6")
    return int(derivative)


def _name(body: "KinBody | None") -> str | None:
    return None if body is None else body.GetName()


def _indices(indices: ArrayLike) -> list[int]:
    return checked_numbers(indices, "indices").astype(np.int_).ravel().tolist()


def _rows(data: ArrayLike, count: int, dof: int, name: str) -> Floats:
    values = checked_numbers(data, name)
    if values.size != count * dof:
        message = f"{name}: has shape {values.shape}, and should have shape ({count * dof},)"
        raise ArgumentError(message, ErrorCode.Assert)
    return values.reshape(count, dof)


def _finder(env: "Environment | None") -> FindBody:
    return nobody if env is None else env.simulation.body

"""What the numbers of a configuration are."""

from collections.abc import MutableSequence, Sequence
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.arrays import checked_numbers
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.geometry_functions import arguments
from ravemj.trajectories import extraction, layout
from ravemj.trajectories.bodies import body_groups
from ravemj.trajectories.conversion import FindBody, convert_group, converted, nobody
from ravemj.trajectories.groups import DELTATIME, Group
from ravemj.trajectories.text import layout_text, read_layout
from ravemj.transforms import Floats, Ints, Pose

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.kinbody import KinBody


class ConfigurationSpecification:
    """What the numbers of a configuration are: named groups of joint values, poses, velocities, times.

    Example:
        >>> spec = robot.GetConfigurationSpecification("linear")
        >>> spec.AddDerivativeGroups(1, True)
        >>> [group.name for group in spec.GetGroups()]
        ['joint_values arm 0 1', 'affine_transform arm 39', 'joint_velocities arm 0 1', 'affine_velocities arm 39', \
'deltatime']
        >>> spec.ExtractJointValues(trajectory.Sample(0.5), robot, [0, 1])
    """

    Group = Group

    def __init__(self, spec: "ConfigurationSpecification | Group | str | None" = None) -> None:
        """Make a specification.

        Args:
            spec: Another one, a group, or XML text, as ``repr`` shows it; None: no groups.
        """
        self._groups: list[Group]
        if isinstance(spec, str):
            self._groups = read_layout(spec)
        elif isinstance(spec, Group):
            self._groups = layout.packed([spec])
        else:
            self._groups = [] if spec is None else spec.GetGroups()

    @classmethod
    def of(cls, groups: Sequence[Group]) -> Self:
        """Make a specification of copies of groups."""
        spec = cls()
        spec._groups = layout.copied(groups)
        return spec

    def GetGroups(self) -> list[Group]:
        """Return the groups; copies, each with ``name``, ``offset``, ``dof`` and ``interpolation``."""
        return layout.copied(self._groups)

    def GetDOF(self) -> int:
        """Return how many numbers a configuration has."""
        return layout.count(self._groups)

    def IsValid(self) -> bool:
        """Return whether each number is in just one group, and each name is used once."""
        return layout.flaw(self._groups) is None

    def Validate(self) -> None:
        """Check the specification.

        Raises:
            ArgumentError: it is not valid; the message says why.
        """
        wrong = layout.flaw(self._groups)
        if wrong is not None:
            raise ArgumentError(wrong, ErrorCode.Assert)

    def GetGroupFromName(self, name: str) -> Group:
        """Return the group of that name, or else the one with the shortest name that starts so; a copy.

        Raises:
            ArgumentError: there is none.
        """
        group = layout.find_prefix(self._groups, name)
        if group is None:
            raise ArgumentError(f"name: no group starts with '{name}'")
        return layout.copied([group])[0]

    def FindCompatibleGroup(self, name: "str | Group", exactmatch: bool = False) -> Group | None:
        """Return the group with values of the same kind and body; a copy, or None.

        Args:
            name: A group's name, or its beginning, for instance ``joint_values arm``.
            exactmatch: Whether the names have to be equal.
        """
        found = layout.find_compatible(self._groups, name if isinstance(name, str) else name.name, exactmatch)
        return None if found is None else layout.copied([found])[0]

    def FindTimeDerivativeGroup(self, name: "str | Group", exactmatch: bool = False) -> Group | None:
        """Return the group with the time derivative of another; a copy, or None. See ``FindCompatibleGroup``."""
        return self._shifted(name, 1, exactmatch)

    def FindTimeIntegralGroup(self, name: "str | Group", exactmatch: bool = False) -> Group | None:
        """Return the group of which another is the time derivative; a copy, or None. See ``FindCompatibleGroup``."""
        return self._shifted(name, -1, exactmatch)

    def _shifted(self, name: "str | Group", steps: int, exactmatch: bool) -> Group | None:
        found = layout.find_shifted(self._groups, name if isinstance(name, str) else name.name, steps, exactmatch)
        return None if found is None else layout.copied([found])[0]

    def AddGroup(self, name: "str | Group", dof: int = 0, interpolation: str = "") -> int:
        """Add a group behind the others, unless it is there.

        Args:
            name: What the values are, for instance ``joint_values arm 0 1``; or a group, of which the rest is taken.
            dof: How many values it has.
            interpolation: How they change between waypoints.

        Returns:
            Its offset.

        Raises:
            ArgumentError: there is another group of that kind for the same body.

        Example:
            >>> spec.AddGroup("joint_values arm 0 1", 2, "linear")
            0
        """
        new = name if isinstance(name, Group) else Group(name, 0, dof, interpolation)
        self._groups = layout.with_group(self._groups, new)
        return next(group.offset for group in self._groups if group.name == new.name)

    def AddDeltaTimeGroup(self) -> int:
        """Add the time since the last waypoint [s], unless it is there; return its offset."""
        return self.AddGroup(DELTATIME, 1)

    def AddDerivativeGroups(self, deriv: int, adddeltatime: bool = False) -> None:
        """Add the derivatives of all positions, with the interpolations that fit to theirs.

        Args:
            deriv: 1 for velocities, 2 for accelerations and so on.
            adddeltatime: Whether to add the time since the last waypoint, too.
        """
        self._groups = layout.with_derivatives(self._groups, _order(deriv, "deriv"), adddeltatime)

    def AddVelocityGroups(self, adddeltatime: bool) -> None:
        """Add velocities: the older name of ``AddDerivativeGroups(1, adddeltatime)``."""
        self.AddDerivativeGroups(1, adddeltatime)

    def RemoveGroups(self, groupname: str, exactmatch: bool = True) -> int:
        """Remove groups, and close the gaps.

        Args:
            groupname: The name of a group.
            exactmatch: False: also groups whose names start so.

        Returns:
            How many are gone.
        """
        before = len(self._groups)
        self._groups = layout.without(self._groups, groupname, exactmatch)
        return before - len(self._groups)

    def ResetGroupOffsets(self) -> None:
        """Put the groups one behind the other, without gaps."""
        self._groups = layout.packed(self._groups)

    def ConvertToVelocitySpecification(self) -> "ConfigurationSpecification":
        """Return a specification with velocities in place of positions."""
        return self.ConvertToDerivativeSpecification(1)

    def ConvertToDerivativeSpecification(self, timederivative: int) -> "ConfigurationSpecification":
        """Return a specification with derivatives in place of positions: 1 for velocities, 2 for accelerations."""
        return self.of(layout.derived(self._groups, _order(timederivative)))

    def GetTimeDerivativeSpecification(self, timederivative: int) -> "ConfigurationSpecification":
        """Return the groups of a time derivative alone: 0 for positions, 1 for velocities and so on."""
        return self.of(layout.of_order(self._groups, _order(timederivative)))

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
        return extraction.joint_values(self._groups, values, _name(body), _indices(indices), _order(timederivative))

    def InsertJointValues(
        self,
        data: MutableSequence[float] | Floats,
        values: ArrayLike,
        body: "KinBody | None",
        indices: ArrayLike,
        timederivative: int = 0,
    ) -> bool:
        """Write joint values into a configuration; the others stay. Arguments as for ``ExtractJointValues``.

        Returns:
            Whether there are values of the body.
        """
        given, chosen, changed = checked_numbers(values, "values"), _indices(indices), self._checked(data)
        if given.shape != (len(chosen),):
            message = f"values: has shape {given.shape}, and should have shape ({len(chosen)},)"
            raise ArgumentError(message, ErrorCode.Assert)
        order = _order(timederivative)
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
            Values in the order X, Y, Z, rotation, 0 for those that are not there; None where there are none of the
            body. (OpenRAVE looks for positions under a name that no group has, and finds none.)
        """
        values, order = self._checked(data), _order(timederivative)
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

    def ExtractIkParameterization(
        self, data: ArrayLike, timederivative: int = 0, robotname: str = "", manipulatorname: str = ""
    ) -> None:
        """Return a goal of inverse kinematics in a configuration.

        Raises:
            NotImplementedError: always; there is no inverse kinematics yet.
        """
        raise NotImplementedError("ExtractIkParameterization needs inverse kinematics (IK), which ravemj does not have")

    def ExtractDeltaTime(self, data: ArrayLike) -> float | None:
        """Return the time since the last waypoint [s], or None where the configuration has none."""
        column = extraction.time_column(self._groups)
        return None if column is None else float(self._checked(data)[column])

    def InsertDeltaTime(self, data: MutableSequence[float] | Floats, deltatime: float) -> bool:
        """Write the time since the last waypoint [s] into a configuration; return whether it has a place for it."""
        column = extraction.time_column(self._groups)
        if column is None:
            return False
        self._checked(data)
        data[column] = deltatime
        return True

    def ExtractUsedBodies(self, env: "Environment") -> "list[KinBody]":
        """Return the bodies of an environment whose values there are."""
        bodies = (env.GetKinBody(name) for name in extraction.used_bodies(self._groups))
        return [body for body in bodies if body is not None]

    def ExtractUsedIndices(self, body: "KinBody") -> tuple[Ints, Ints]:
        """Return the DOF indices of a body that there are, and where in the configuration."""
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
            The configurations, one behind the other.
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
        """Return configurations in another specification; what they lack is taken from ``targetdata``."""
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
        source = _rows(sourcedata, numpoints, self.GetDOF(), "sourcedata")
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
        """Return the values of a group as those of another group of its kind; see ``ConvertData``."""
        target = np.zeros((numpoints, gtarget.dof))
        source = _rows(sourcedata, numpoints, gsource.dof, "sourcedata")
        convert_group(gsource, source, gtarget, target, _finder(env) if filluninitialized else None)
        return target.ravel()

    def SerializeJSON(self) -> dict[str, list[dict[str, Any]]]:
        """Return the groups as dictionaries and lists."""
        return {"groups": [dict(vars(group)) for group in sorted(self._groups, key=lambda group: group.offset)]}

    def DeserializeJSON(self, obj: dict[str, list[dict[str, Any]]]) -> None:
        """Take the groups that ``SerializeJSON`` returned."""
        self._groups = [Group(**group) for group in obj["groups"]]

    def _checked(self, data: ArrayLike) -> Floats:
        return _rows(data, 1, self.GetDOF(), "data")[0]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ConfigurationSpecification):
            return NotImplemented
        return layout.equal(self._groups, other._groups)

    __hash__ = None  # pyright: ignore[reportAssignmentType] - specifications change

    def __add__(self, other: "ConfigurationSpecification") -> "ConfigurationSpecification":
        """Return a specification that holds the values of both; groups of one kind and body become one."""
        return self.of(layout.merged(self._groups, other._groups))

    def __iadd__(self, other: "ConfigurationSpecification") -> Self:
        """Add the values of another specification."""
        self._groups = layout.merged(self._groups, other._groups)
        return self

    def __repr__(self) -> str:
        return f'ConfigurationSpecification("""{layout_text(self._groups)}""")'

    def __str__(self) -> str:
        return f'<configuration dof="{self.GetDOF()}">'


def _order(derivative: int, name: str = "timederivative") -> int:
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
    return nobody if env is None else env.GetKinBody


def RaveGetAffineConfigurationSpecification(
    affinedofs: int, body: "KinBody | None" = None, interpolation: str = ""
) -> ConfigurationSpecification:
    """Return the specification of parts of a pose.

    Args:
        affinedofs: ``DOFAffine`` values, combined.
        body: Whose pose; None: a body called ``__dummy__``.
        interpolation: How the values change between waypoints.
    """
    return ConfigurationSpecification.of(body_groups(_name(body) or "__dummy__", [], affinedofs, interpolation))

"""Configuration specifications: groups of values, their access and conversion."""

from collections.abc import MutableSequence, Sequence
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_numbers, checked_whole_numbers
from ravemj.core.transforms import Floats, Ints, Pose
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.geometry_functions import arguments
from ravemj.geometry_functions.ik_parameterization import goal_size
from ravemj.rave.ikparameterization import IkParameterizationData
from ravemj.trajectories import extraction, layout
from ravemj.trajectories.bodies import body_groups
from ravemj.trajectories.conversion import FindBody, convert_group, converted, nobody
from ravemj.trajectories.groups import DELTATIME, Group, ik_type
from ravemj.trajectories.serialization import layout_text, read_layout

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.kinbody import KinBody


class ConfigurationData(ApiObject):
    """Base of ``ConfigurationSpecification`` with the access to values."""

    _groups: list[Group]

    def ExtractJointValues(
        self, data: ArrayLike, body: "KinBody | None", indices: ArrayLike, timederivative: int = 0
    ) -> Floats | None:
        """Return the joint values in a configuration.

        Args:
            data: The configuration.
            body: The body; None means any.
            indices: DOF indices.
            timederivative: Order of the derivative: 0 for values, 1 for velocities, 2 for accelerations.

        Returns:
            One value for each index, 0 for missing ones; None if the configuration has no values of the body.
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
        """Write joint values into a configuration in place. Arguments as for ``ExtractJointValues``.

        Args:
            data: The configuration; it is changed. Shape (dof,).
            values: The numbers.
            body: The body.
            indices: The DOF indices of the values.
            timederivative: 0 for values, 1 for velocities, 2 for accelerations.

        Returns:
            Whether the configuration has values of the body.
        """
        given, chosen, changed = checked_numbers(values, "values"), _indices(indices), self._checked(data)
        if given.shape != (len(chosen),):
            message = f"values: has shape {given.shape}, and should have shape ({len(chosen)},)"
            raise ArgumentError(message, ErrorCode.Assert)
        order = checked_order(timederivative)
        inserted = extraction.insert_joint_values(self._groups, changed, given, _name(body), chosen, order)
        data[:] = changed if isinstance(data, np.ndarray) else changed.tolist()
        return inserted

    def ExtractAffineValues(
        self, data: ArrayLike, body: "KinBody | None", affinedofs: int, timederivative: int = 0
    ) -> Floats | None:
        """Return pose components in a configuration.

        Args:
            data: The configuration.
            body: The body; None means any.
            affinedofs: ``DOFAffine`` values, combined.
            timederivative: Order of the derivative: 0 for values, 1 for velocities, 2 for accelerations.

        Returns:
            Values in the order X, Y, Z, rotation, shape (n,); 0 for missing ones; None if the configuration has none of
            the body. (OpenRAVE searches positions under a wrong group name, and finds none.)
        """
        values, order = self._checked(data), checked_order(timederivative)
        return extraction.affine_values(self._groups, values, _name(body), affinedofs, order)

    def ExtractTransform(
        self, transform: ArrayLike | None, data: ArrayLike, body: "KinBody | None", timederivative: int = 0
    ) -> Floats | None:
        """Return the pose of a body in a configuration.

        Args:
            transform: Pose that supplies components missing in the configuration; None means the identity.
            data: The configuration.
            body: The body; None means any.
            timederivative: Must be 0; see ``ExtractAffineValues`` for derivatives.

        Returns:
            Shape (4, 4); None if the configuration has no pose of the body.
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
        """Write the time since the last waypoint [s] into a configuration; return whether it has a deltatime group.

        Args:
            data: The configuration; it is changed. Shape (dof,).
            deltatime: Time since the previous waypoint [s].
        """
        column = extraction.time_column(self._groups)
        if column is None:
            return False
        self._checked(data)
        data[column] = deltatime
        return True

    def ExtractUsedBodies(self, env: "Environment") -> "list[KinBody]":
        """Return the bodies of ``env`` that have values in the configuration."""
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
        """Return configurations converted to another specification.

        Args:
            targetspec: The other specification.
            sourcedata: The configurations, concatenated.
            numpoints: The number of configurations.
            env: The environment whose bodies' present state supplies missing values.
            filluninitialized: False fills missing values with zeros.

        Returns:
            The converted configurations, concatenated, shape (numpoints * dof,).
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
        """Return configurations converted to another specification; ``targetdata`` supplies missing values.

        Args:
            targetdata: Values in the target's layout; changed in place.
            targetspec: The layout of the target.
            sourcedata: Values in the layout of this specification, shape (numpoints, dof).
            numpoints: The number of configurations.
            env: The environment of the bodies.
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
        """Return the values of a group converted to another group of its type; see ``ConvertData``.

        Args:
            gtarget: The group to convert to.
            sourcedata: Values of the source group, shape (numpoints, dof).
            gsource: The source group.
            numpoints: The number of configurations.
            env: The environment of the bodies.
            filluninitialized: Whether the environment supplies missing values.
        """
        target = np.zeros((numpoints, gtarget.dof))
        source = _rows(sourcedata, numpoints, gsource.dof, "sourcedata")
        convert_group(gsource, source, gtarget, target, _finder(env) if filluninitialized else None)
        return target.ravel()

    def _checked(self, data: ArrayLike) -> Floats:
        return _rows(data, 1, layout.count(self._groups), "data")[0]


def checked_order(derivative: int, name: str = "timederivative") -> int:
    """Return the order of a derivative, checked to be from 0 to 6."""
    if not 0 <= derivative <= 6:
        raise ArgumentError(f"{name}: is {derivative}, and should be from 0 to 6")
    return int(derivative)


def _name(body: "KinBody | None") -> str | None:
    return None if body is None else body.GetName()


def _indices(indices: ArrayLike) -> list[int]:
    return checked_whole_numbers(indices, "indices").tolist()


def _rows(data: ArrayLike, count: int, dof: int, name: str) -> Floats:
    values = checked_numbers(data, name)
    if values.size != count * dof:
        message = f"{name}: has shape {values.shape}, and should have shape ({count * dof},)"
        raise ArgumentError(message, ErrorCode.Assert)
    return values.reshape(count, dof)


def _finder(env: "Environment | None") -> FindBody:
    return nobody if env is None else env.simulation.body


class ConfigurationSpecification(ConfigurationData):
    """The layout of a configuration: named groups of joint values, poses, velocities and times.

    Example:
        >>> spec = robot.GetConfigurationSpecification("linear")
        >>> spec.AddDerivativeGroups(1, True)
        >>> [group.name for group in spec.GetGroups()]
        ['joint_values arm 0 1', 'affine_transform arm 39', 'joint_velocities arm 0 1', 'affine_velocities arm 39', \
'deltatime']
        >>> spec.ExtractJointValues(trajectory.Sample(0.5), robot, [0, 1])
    """

    Group = Group
    _internal = ("of",)

    @also_named(pyspec="spec", group="spec", xmldata="spec")
    def __init__(self, spec: "ConfigurationSpecification | Group | str | None" = None) -> None:
        """Copy ``spec``: a specification, a group, or XML text as in ``repr``; by default there are no groups."""
        if isinstance(spec, str):
            self._groups = read_layout(spec)
        elif isinstance(spec, Group):
            self._groups = layout.packed([spec])
        else:
            checked = spec and checked_kind(spec, ConfigurationSpecification, "spec")
            self._groups = checked.GetGroups() if checked else []

    @classmethod
    def of(cls, groups: Sequence[Group]) -> Self:
        """Make a specification from copies of groups."""
        spec = cls()
        spec._groups = layout.copied(groups)
        return spec

    def GetGroups(self) -> list[Group]:
        """Return copies of the groups, each with ``name``, ``offset``, ``dof`` and ``interpolation``."""
        return layout.copied(self._groups)

    def GetDOF(self) -> int:
        """Return the number of values of a configuration."""
        return layout.count(self._groups)

    def IsValid(self) -> bool:
        """Return whether each value belongs to exactly one group, and each name is used once."""
        return layout.flaw(self._groups) is None

    def Validate(self) -> None:
        """Check the specification.

        Raises:
            ArgumentError: the specification is not valid; the message says why.
        """
        wrong = layout.flaw(self._groups)
        if wrong is not None:
            raise ArgumentError(wrong, ErrorCode.Assert)

    def GetGroupFromName(self, name: str) -> Group:
        """Return a copy of the group of a name, or else of the group with the shortest name that begins with it.

        Raises:
            ArgumentError: no group begins with the name.
        """
        group = layout.find_prefix(self._groups, name)
        if group is None:
            raise ArgumentError(f"name: no group starts with '{name}'")
        return layout.copied([group])[0]

    def FindCompatibleGroup(self, name: "str | Group", exactmatch: bool = False) -> Group | None:
        """Return a copy of the group with values of the same kind and body, or None.

        Args:
            name: The name of a group or the beginning of one, for instance ``joint_values arm``.
            exactmatch: Whether the names have to be equal.
        """
        group = layout.find_compatible(self._groups, name if isinstance(name, str) else name.name, exactmatch)
        return None if group is None else layout.copied([group])[0]

    def FindTimeDerivativeGroup(self, name: "str | Group", exactmatch: bool = False) -> Group | None:
        """Return a copy of the group with the time derivative of another, or None. See ``FindCompatibleGroup``.

        Args:
            name: A group, or its name.
            exactmatch: Whether body and indices in the names have to be equal as well.
        """
        return self._shifted(name, 1, exactmatch)

    def FindTimeIntegralGroup(self, name: "str | Group", exactmatch: bool = False) -> Group | None:
        """Return a copy of the group that is the time integral of another, or None. See ``FindCompatibleGroup``.

        Args:
            name: A group, or its name.
            exactmatch: Whether body and indices in the names have to be equal as well.
        """
        return self._shifted(name, -1, exactmatch)

    def _shifted(self, name: "str | Group", steps: int, exactmatch: bool) -> Group | None:
        group = layout.find_shifted(self._groups, name if isinstance(name, str) else name.name, steps, exactmatch)
        return None if group is None else layout.copied([group])[0]

    @also_named(group="name")
    def AddGroup(self, name: "str | Group", dof: int = 0, interpolation: str = "") -> int:
        """Append a group, unless the specification has it.

        Args:
            name: The name, which says what the values are, for instance ``joint_values arm 0 1``; or a group, which
                also has the other two arguments.
            dof: The number of values.
            interpolation: The interpolation between waypoints.

        Returns:
            The offset of the group.

        Raises:
            ArgumentError: the specification has another group of that kind for the same body.

        Example:
            >>> spec.AddGroup("joint_values arm 0 1", 2, "linear")
            0
        """
        checked_kind(name, (Group, str), "AddGroup: name", "a Group or its name")
        new = name if isinstance(name, Group) else Group(name, 0, dof, interpolation)
        self._groups = layout.with_group(self._groups, new)
        return next(group.offset for group in self._groups if group.name == new.name)

    def AddDeltaTimeGroup(self) -> int:
        """Append the time since the last waypoint [s], unless the specification has it, and return its offset."""
        return self.AddGroup(DELTATIME, 1)

    def AddDerivativeGroups(self, deriv: int, adddeltatime: bool = False) -> None:
        """Append time derivatives of all positions, with the interpolations that fit those of the positions.

        Args:
            deriv: 1 for velocities, 2 for accelerations and so on.
            adddeltatime: Whether to append the time since the last waypoint as well.
        """
        self._groups = layout.with_derivatives(self._groups, checked_order(deriv, "deriv"), adddeltatime)

    def AddVelocityGroups(self, adddeltatime: bool) -> None:
        """Add velocities; older name of ``AddDerivativeGroups(1, adddeltatime)``."""
        self.AddDerivativeGroups(1, adddeltatime)

    def RemoveGroups(self, groupname: str, exactmatch: bool = True) -> int:
        """Remove groups, and close the gaps.

        Args:
            groupname: The name of a group.
            exactmatch: False also removes groups whose names begin with it.

        Returns:
            The number of removed groups.
        """
        before = len(self._groups)
        self._groups = layout.without(self._groups, groupname, exactmatch)
        return before - len(self._groups)

    def ResetGroupOffsets(self) -> None:
        """Set the offsets so that the groups follow one another without gaps."""
        self._groups = layout.packed(self._groups)

    def ConvertToVelocitySpecification(self) -> "ConfigurationSpecification":
        """Return a specification with velocities in place of positions."""
        return self.ConvertToDerivativeSpecification(1)

    def ConvertToDerivativeSpecification(self, timederivative: int) -> "ConfigurationSpecification":
        """Return a specification with derivatives in place of positions.

        ``timederivative`` is their order: 1 for velocities, 2 for accelerations.
        """
        return self.of(layout.derived(self._groups, checked_order(timederivative)))

    def GetTimeDerivativeSpecification(self, timederivative: int) -> "ConfigurationSpecification":
        """Return the groups of a derivative alone.

        ``timederivative`` is its order: 0 for positions, 1 for velocities, 2 for accelerations.
        """
        return self.of(layout.of_order(self._groups, checked_order(timederivative)))

    def ExtractIkParameterization(
        self, data: ArrayLike, timederivative: int = 0, robotname: str = "", manipulatorname: str = ""
    ) -> "IkParameterization | None":
        """Return the goal of inverse kinematics that a configuration contains.

        Args:
            data: The configuration, shape (dof,).
            timederivative: 0 for the goal, 1 for its velocity, 2 for its acceleration.
            robotname: The robot of the goal; empty for any.
            manipulatorname: The manipulator of the goal; empty for any.

        Returns:
            The first such goal, or None.
        """
        values, order = self._checked(data), checked_order(timederivative)
        group = extraction.ik_group(self._groups, robotname, manipulatorname, order)
        if group is None:
            return None
        goal = IkParameterization()
        goal.SetValues(values[group.columns], ik_type(group))
        return goal

    def SerializeJSON(self) -> dict[str, list[dict[str, Any]]]:
        """Return the groups as dictionaries and lists."""
        return {"groups": [dict(vars(group)) for group in sorted(self._groups, key=lambda group: group.offset)]}

    def DeserializeJSON(self, obj: dict[str, list[dict[str, Any]]]) -> None:
        """Replace the groups by those of ``obj``, a result of ``SerializeJSON``."""
        self._groups = [Group(**group) for group in obj["groups"]]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ConfigurationSpecification):
            return NotImplemented
        return layout.equal(self._groups, other._groups)

    __hash__ = None  # pyright: ignore[reportAssignmentType] - specifications change

    def __add__(self, other: "ConfigurationSpecification") -> "ConfigurationSpecification":
        """Return a specification with the groups of both. Two groups of one kind and body become one."""
        return self.of(layout.merged(self._groups, other._groups))

    def __iadd__(self, other: "ConfigurationSpecification") -> Self:
        """Add the groups of another specification."""
        self._groups = layout.merged(self._groups, other._groups)
        return self

    def __repr__(self) -> str:
        return f'ConfigurationSpecification("""{layout_text(self._groups)}""")'

    def __str__(self) -> str:
        return f'<configuration dof="{self.GetDOF()}">'


class IkParameterization(IkParameterizationData):
    """A goal of inverse kinematics: a pose, a direction, a point or a ray for the tool of an arm.

    The type says what the values are. ``Transform6D``: the pose [w, x, y, z, tx, ty, tz]. ``Rotation3D``: the
    quaternion. ``Translation3D`` and ``Lookat3D``: the point. ``Direction3D``: the direction. ``Ray4D`` and
    ``TranslationDirection5D``: the direction, then the point. ``TranslationXY2D``: x and y.
    ``TranslationXYOrientation3D``: x, y and the angle. ``TranslationLocalGlobal6D``: a point in the tool frame, then
    its goal in the world. Types with ``AxisAngle``: the angle, then the point.

    Args:
        value: The goal, as the type requires: a 4x4 matrix or a pose, a quaternion, a vector, a ``Ray``, a pair of
            points, or a point and an angle. Or an ``IkParameterization`` to copy, or the text of one.
        type: The type of the goal.

    Example:
        >>> goal = IkParameterization(T_world_tool, IkParameterization.Type.Transform6D)
        >>> moved_in_the_world = matrixFromPose([1, 0, 0, 0, 0, 0, 0.1]) * goal
        >>> moved_in_the_tool = goal * matrixFromPose([1, 0, 0, 0, 0, 0, 0.1])
    """

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
            type: The type of the goal.
            interpolation: How the values change between waypoints.
            robotname: Name of the robot; empty: any.
            manipname: Name of the arm; empty: any.
        """
        spec = ConfigurationSpecification()
        name = " ".join(filter(None, ["ikparam_values", str(int(type)), robotname, manipname]))
        spec.AddGroup(name, goal_size(type), interpolation)
        return spec


def RaveGetAffineConfigurationSpecification(
    affinedofs: int, body: "KinBody | None" = None, interpolation: str = ""
) -> ConfigurationSpecification:
    """Return the layout of the components of a pose.

    Args:
        affinedofs: The components, ``DOFAffine`` combined with ``|``.
        body: The body; None stands for a body called ``__dummy__``.
        interpolation: The interpolation between waypoints.
    """
    return ConfigurationSpecification.of(
        body_groups("__dummy__" if body is None else body.GetName(), [], affinedofs, interpolation)
    )

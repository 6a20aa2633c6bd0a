"""Configuration specifications: the layout of the values of a configuration, and of goals of inverse kinematics."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Self

from numpy.typing import ArrayLike

from ravemj.core.arguments import also_named, checked_kind
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.geometry_functions.ik_parameterization import goal_size
from ravemj.rave.configuration_data import ConfigurationData, checked_order
from ravemj.rave.ikparameterization import IkParameterizationData
from ravemj.trajectories import extraction, layout
from ravemj.trajectories.bodies import body_groups
from ravemj.trajectories.groups import DELTATIME, Group, ik_type
from ravemj.trajectories.serialization import layout_text, read_layout

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody


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
        """Copy ``spec``, a specification, a group or XML text, as ``repr`` shows it; by default there are no groups."""
        if isinstance(spec, str):
            self._groups = read_layout(spec)
        elif isinstance(spec, Group):
            self._groups = layout.packed([spec])
        else:
            checked = spec and checked_kind(spec, ConfigurationSpecification, "spec")
            self._groups = checked.GetGroups() if checked else []

    @classmethod
    def of(cls, groups: Sequence[Group]) -> Self:
        """Make a specification of copies of groups."""
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
        found = layout.find_compatible(self._groups, name if isinstance(name, str) else name.name, exactmatch)
        return None if found is None else layout.copied([found])[0]

    def FindTimeDerivativeGroup(self, name: "str | Group", exactmatch: bool = False) -> Group | None:
        """Return a copy of the group with the time derivative of another, or None. See ``FindCompatibleGroup``.

        Args:
            name: A group, or its name.
            exactmatch: Whether the rest of the name has to be the same, too.
        """
        return self._shifted(name, 1, exactmatch)

    def FindTimeIntegralGroup(self, name: "str | Group", exactmatch: bool = False) -> Group | None:
        """Return a copy of the group whose time derivative another group is, or None. See ``FindCompatibleGroup``.

        Args:
            name: A group, or its name.
            exactmatch: Whether the rest of the name has to be the same, too.
        """
        return self._shifted(name, -1, exactmatch)

    def _shifted(self, name: "str | Group", steps: int, exactmatch: bool) -> Group | None:
        found = layout.find_shifted(self._groups, name if isinstance(name, str) else name.name, steps, exactmatch)
        return None if found is None else layout.copied([found])[0]

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
        """Add velocities: the older name of ``AddDerivativeGroups(1, adddeltatime)``."""
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

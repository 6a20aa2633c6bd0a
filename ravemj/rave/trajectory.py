"""Trajectories: configurations over time."""

import math
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import also_named
from ravemj.core.arrays import checked_numbers
from ravemj.core.output import AnyPath, new_file
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.rave.enums import InterfaceType
from ravemj.rave.interface import Interface
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.rave.user_data import Annotations
from ravemj.trajectories.groups import Group
from ravemj.trajectories.serialization import AS_TEXT, Stored, read, to_bytes, to_text
from ravemj.trajectories.waypoints import Waypoints

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

KIND = "GenericTrajectory"
Spec = ConfigurationSpecification | Group


class Trajectory(Interface):
    """Configurations over time; ``RaveCreateTrajectory`` makes it.

    Example:
        >>> spec = robot.GetConfigurationSpecificationIndices([0, 1], "linear")
        >>> spec.AddDeltaTimeGroup()
        2
        >>> trajectory = RaveCreateTrajectory(env, "")
        >>> trajectory.Init(spec)
        >>> trajectory.Insert(0, [0, 0, 0])  # two joints, and the time since the last waypoint
        >>> trajectory.Insert(1, [1.5, -0.5, 2.0])
        >>> robot.SetDOFValues(spec.ExtractJointValues(trajectory.Sample(0.5), robot, [0, 1]))
    """

    _interface_type = InterfaceType.trajectory
    _internal = ("waypoints",)

    def __init__(self, env: "Environment", xmlid: str) -> None:
        self._env = env
        self._xmlid = xmlid
        self.annotations = Annotations()
        self._waypoints: Waypoints | None = None

    def GetXMLId(self) -> str:
        """Return the name of the type, as it was spelled when the trajectory was made."""
        return self._xmlid

    @also_named(group="spec")
    def Init(self, spec: Spec) -> None:
        """Remove all waypoints, and set the specification of new ones.

        Args:
            spec: A specification, or a group; it is copied.

        Example:
            >>> trajectory = ravemj.RaveCreateTrajectory(env, "")
            >>> trajectory.Init(robot.GetActiveConfigurationSpecification())
        """
        if spec is None:  # pyright: ignore[reportUnnecessaryComparison] - users give it
            raise ArgumentError("Init: spec is None, and should be a ConfigurationSpecification")
        self._waypoints = Waypoints(_groups(spec))

    @property
    def waypoints(self) -> Waypoints:
        """The waypoints, below the OpenRAVE API; there are none before ``Init``."""
        if self._waypoints is None:
            raise RavemjError("the trajectory has no specification yet; call Init(spec) first", ErrorCode.Assert)
        return self._waypoints

    def GetConfigurationSpecification(self) -> ConfigurationSpecification:
        """Return the specification of the waypoints; a copy."""
        return ConfigurationSpecification.of([] if self._waypoints is None else self._waypoints.groups)

    def Insert(
        self,
        index: int,
        data: ArrayLike,
        spec: Spec | bool | None = None,
        overwrite: bool = False,
        *,
        group: Group | None = None,
    ) -> None:
        """Insert waypoints.

        Args:
            index: Before which waypoint; ``GetNumWaypoints()`` is behind all.
            data: The waypoints, one behind the other, or one in each row.
            spec: What their numbers are; None: as in the trajectory. What it lacks stays as it is in waypoints that
                are there; in new ones, joints that are missing in a group get their present values, and missing groups
                zeros. True and False stand for ``overwrite``.
            overwrite: Whether to write over the waypoints from ``index`` on; what reaches beyond the last is appended.
            group: A group in place of ``spec``.

        Raises:
            ArgumentError: the number of numbers does not fit, or there is no such waypoint.

        Example:
            >>> spec = robot.GetConfigurationSpecification()
            >>> trajectory.Insert(trajectory.GetNumWaypoints(), robot.GetConfigurationValues(), spec)
        """
        if isinstance(spec, bool | int | np.bool_):
            spec, overwrite = None, bool(spec)
        given = spec if group is None else group
        waypoints, numbers = self.waypoints, checked_numbers(data, "data").ravel()
        groups = waypoints.groups if given is None else _groups(given)
        waypoints.insert(index, numbers, groups, overwrite=overwrite, find_body=self._env.simulation.body)

    def Remove(self, startindex: int, endindex: int) -> None:
        """Remove the waypoints from ``startindex`` to before ``endindex``."""
        self.waypoints.remove(startindex, endindex)

    def GetNumWaypoints(self) -> int:
        """Return the number of waypoints.

        Example:
            >>> for index in range(trajectory.GetNumWaypoints()):
            ...     point = trajectory.GetWaypoint(index)
        """
        return len(self.waypoints)

    @also_named(group="spec")
    def GetWaypoint(self, index: int, spec: Spec | None = None) -> Floats:
        """Return a waypoint; a copy.

        Args:
            index: Which; negative numbers count from the end.
            spec: What its numbers should be; None: as in the trajectory.

        Returns:
            Shape (dof,).

        Example:
            >>> last = trajectory.GetWaypoint(-1)
            >>> values = trajectory.GetWaypoint(-1, robot.GetConfigurationSpecification())
        """
        count = len(self.waypoints)
        if not -count <= index < count:
            raise ArgumentError(f"index: is {index}, and there are {count} waypoints", ErrorCode.Assert)
        start = index % count
        return self.GetWaypoints(start, start + 1, spec)

    @also_named(group="spec")
    def GetWaypoints(self, startindex: int, endindex: int, spec: Spec | None = None) -> Floats:
        """Return the waypoints from ``startindex`` to before ``endindex``, one behind the other, shape (n * dof,).

        Args:
            startindex: The first one.
            endindex: The one behind the last.
            spec: The layout of the answer; None: that of the trajectory.
        """
        return self.GetWaypoints2D(startindex, endindex, spec).ravel()

    @also_named(group="spec")
    def GetWaypoints2D(self, startindex: int, endindex: int, spec: Spec | None = None) -> Floats:
        """Return the waypoints from ``startindex`` to before ``endindex``, shape (n, dof); a copy.

        Args:
            startindex: The first one.
            endindex: The one behind the last.
            spec: The layout of the answer; None: that of the trajectory.
        """
        return self._as(self.waypoints.rows(startindex, endindex), spec)

    @also_named(group="spec")
    def GetAllWaypoints2D(self, spec: Spec | None = None) -> Floats:
        """Return all waypoints, shape (n, dof); a copy.

        Args:
            spec: What their numbers should be; None: as in the trajectory.
        """
        return self.GetWaypoints2D(0, len(self.waypoints), spec)

    def _as(self, rows: Floats, spec: Spec | None) -> Floats:
        return rows if spec is None else self.waypoints.as_layout(rows, _groups(spec), self._env.simulation.body)

    def GetDuration(self) -> float:
        """Return when the last waypoint is [s]; 0 without a group ``deltatime``."""
        return self.waypoints.duration()

    def GetFirstWaypointIndexAfterTime(self, time: float) -> int:
        """Return the first waypoint at a time [s] or later; from the end on, the number of waypoints.

        Raises:
            ArgumentError: there is no group ``deltatime``.
        """
        return self.waypoints.first_after(time)

    @also_named(group="spec")
    def Sample(self, time: float, spec: Spec | None = None) -> Floats:
        """Return the configuration at a time, interpolated as the groups say.

        Args:
            time: Time since the start [s]; from the end on it is the last waypoint.
            spec: What the numbers should be; None: as in the trajectory. What the trajectory lacks is the present
                state of the bodies.

        Returns:
            Shape (dof,). ``deltatime`` is the time since the last waypoint; with ``spec``, as in OpenRAVE, that of the
            next waypoint.

        Raises:
            ArgumentError: the time is negative, there is no group ``deltatime``, no waypoint, or no velocities for an
                interpolation that needs them.

        Example:
            >>> trajectory.Sample(0.5)
        """
        find = self._env.simulation.body
        return self._as(self.waypoints.sample(time, restamped=spec is None, find_body=find)[None], spec)[0]

    @also_named(group="spec")
    def SampleFromPrevious(self, data: ArrayLike, time: float, spec: Spec) -> Floats:
        """Return the configuration at a time; what the trajectory lacks is taken from ``data``. See ``Sample``.

        Args:
            data: Numbers of one configuration, shape (dof,).
            time: Seconds from the start.
            spec: The layout of the data.
        """
        source = self.waypoints.sample(time, restamped=False, find_body=self._env.simulation.body)
        target = ConfigurationSpecification(spec)
        return self.GetConfigurationSpecification().ConvertDataFromPrevious(data, target, source, 1, self._env)

    @also_named(group="spec")
    def SamplePoints2D(self, times: ArrayLike, spec: Spec | None = None) -> Floats:
        """Return the configurations at some times [s], shape (n, dof). See ``Sample``.

        Args:
            times: Seconds from the start, shape (n,).
            spec: The layout of the answer; None: that of the trajectory.
        """
        rows = [self.Sample(float(time), spec) for time in checked_numbers(times, "times").ravel()]
        dof = (self.GetConfigurationSpecification() if spec is None else ConfigurationSpecification(spec)).GetDOF()
        return np.array(rows).reshape(len(rows), dof)

    @also_named(group="spec")
    def SamplePointsSameDeltaTime2D(self, deltatime: float, ensurelastpoint: bool, spec: Spec | None = None) -> Floats:
        """Return the configurations at equal distances of time.

        Args:
            deltatime: The distance [s].
            ensurelastpoint: Whether to return the end, too, where the distances do not reach it.
            spec: As for ``Sample``.

        Returns:
            Shape (n, dof).
        """
        return self.SampleRangeSameDeltaTime2D(deltatime, 0.0, self.GetDuration(), ensurelastpoint, spec)

    @also_named(group="spec", startTime="starttime", stopTime="stoptime")
    def SampleRangeSameDeltaTime2D(
        self, deltatime: float, starttime: float, stoptime: float, ensurelastpoint: bool, spec: Spec | None = None
    ) -> Floats:
        """Return the configurations at equal distances of time, from a time to before another.

        Args:
            deltatime: The distance [s].
            starttime: The first time [s].
            stoptime: The time [s] before which they stop.
            ensurelastpoint: Whether to return the end of the trajectory, too, whatever ``stoptime`` is.
            spec: As for ``Sample``.

        Returns:
            Shape (n, dof).
        """
        if not deltatime > 0 or not stoptime >= starttime:
            raise ArgumentError(f"deltatime: {deltatime} from {starttime} to {stoptime} is no range of times")
        times = starttime + deltatime * np.arange(math.ceil((stoptime - starttime) / deltatime))
        if ensurelastpoint:
            times = np.append(times, self.GetDuration())
        return self.SamplePoints2D(times, spec)

    def Clone(self, ref: "Trajectory", cloningoptions: int = 0) -> None:
        """Take over the specification, the waypoints, the description and the data of users from another trajectory.

        Args:
            ref: The other trajectory.
            cloningoptions: Not used.
        """
        super().Clone(ref, cloningoptions)
        known = ref._waypoints
        self._waypoints = None if known is None else Waypoints(known.groups, known.data)

    def Swap(self, traj: "Trajectory") -> None:
        """Exchange specification and waypoints with another trajectory.

        Args:
            traj: The other trajectory.
        """
        self._waypoints, traj._waypoints = traj._waypoints, self._waypoints

    def serialize(self, options: int | None = 0) -> bytes:
        """Return the trajectory in OpenRAVE's format.

        Args:
            options: 0x8000 for XML.

        Returns:
            Bytes, in UTF-8 for XML.
        """
        stored = Stored(self.waypoints, self.GetDescription())
        return to_text(stored, self._xmlid).encode() if (options or 0) & AS_TEXT else to_bytes(stored)

    def deserialize(self, data: bytes | str) -> Self:
        """Take over what ``serialize`` returned, of either form.

        Args:
            data: What ``serialize`` returned.

        Returns:
            The trajectory itself.

        Raises:
            ArgumentError: that is no trajectory; nothing has changed then.
        """
        self._waypoints, description = read(data)
        self.SetDescription(description)
        return self

    def SaveToFile(self, filename: AnyPath, options: int | None = 0) -> None:
        """Write the trajectory to a file, as ``serialize`` has it.

        Args:
            filename: The file.
            options: 0x8000 for XML, else binary.

        Raises:
            OutputError: the file cannot be written.
        """
        content = self.serialize(options)
        with new_file(filename) as path:
            path.write_bytes(content)

    def LoadFromFile(self, filename: AnyPath) -> None:
        """Take over the trajectory in a file, of either form.

        Args:
            filename: The file.

        Raises:
            openrave_exception: the file cannot be read, or is no trajectory.
        """
        try:
            content = Path(filename).read_bytes()
        except OSError as error:
            raise RavemjError(f"cannot read {os.fspath(filename)}: {(error.strerror or '').lower()}") from None
        self.deserialize(content)

    def __len__(self) -> int:
        return self.GetNumWaypoints()

    def __getitem__(self, index: int | slice) -> Floats:
        """Return a waypoint, shape (dof,), or some of them, shape (n, dof)."""
        return self.GetAllWaypoints2D()[index] if isinstance(index, slice) else self.GetWaypoint(index)

    def __iter__(self) -> Iterator[Floats]:
        return iter(self.GetAllWaypoints2D())

    def __bool__(self) -> bool:
        """Return True: a trajectory without waypoints is one, too."""
        return True

    def __repr__(self) -> str:
        made = f"RaveCreateTrajectory({self._env!r}, {self._xmlid!r})"
        return made if self._waypoints is None else f"{made}.deserialize({self.serialize(AS_TEXT).decode()!r})"

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:  # noqa: ANN401 - IPython's
        """Print the short text in IPython, where ``repr`` would fill the screen."""
        del cycle
        printer.text(str(self))

    def __str__(self) -> str:
        state = "not initialized" if self._waypoints is None else f"waypoints={len(self._waypoints)}"
        return f"<trajectory:{self._xmlid}, {state}>"


def _groups(spec: Spec) -> Sequence[Group]:
    return ConfigurationSpecification(spec).GetGroups()

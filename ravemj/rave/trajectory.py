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
from ravemj.planning.certificates import Certificate
from ravemj.rave.enums import InterfaceType
from ravemj.rave.interface import Interface
from ravemj.rave.specification import ConfigurationSpecification
from ravemj.trajectories.groups import Group
from ravemj.trajectories.serialization import AS_TEXT, Stored, read, to_bytes, to_text
from ravemj.trajectories.waypoints import Waypoints

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

KIND = "GenericTrajectory"
Spec = ConfigurationSpecification | Group


class Trajectory(Interface):
    """A trajectory: configurations over time. ``RaveCreateTrajectory`` makes trajectories.

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
    _internal = ("is_certified", "set_waypoints", "take", "waypoints")

    start_index: int = -1
    """Index of the start configuration at which a motion planned by ``BaseManipulation`` begins; -1 if unknown."""

    goal_index: int = -1
    """Index of the goal that the motion reaches: configurations are counted first, then regions; -1 if unknown."""

    def __init__(self, env: "Environment", xmlid: str) -> None:
        super().__init__(env, xmlid)
        self._waypoints: Waypoints | None = None
        self._certificate: tuple[Waypoints, Certificate] | None = None

    @property
    def certificate(self) -> Certificate | None:
        """Collision certificate of the motion from planning or ``certify``; None if there is none or it is outdated."""
        known = self._certificate
        return known[1] if known is not None and known[0] is self._waypoints else None

    def certify(self) -> Certificate:
        """Prove that the motion is free of collisions at all times, in the present environment.

        The bodies of the trajectory are moved during the proof, and restored afterwards.

        Returns:
            The certificate, which ``certificate`` then returns. The motion is not certified if it has no times, turns a
            base about more than one axis, moves spherical joints, or if a user callback decides about collisions;
            ``reason`` says so.

        Example:
            >>> print(trajectory.certify())
            certified: there are no other bodies
        """
        self._certificate = self.waypoints, self._proved(whole=True)
        return self._certificate[1]

    def is_certified(self) -> bool:
        """Return whether the motion is certified; without a certificate, try to certify it.

        The attempt ends without a certificate at the first part of the motion that cannot be decided, so it may be
        faster than ``certify``.
        """
        certificate = self.certificate or self._proved(whole=False)
        self._certificate = None if certificate.undecided else (self.waypoints, certificate)
        return certificate.certified

    def _proved(self, *, whole: bool) -> Certificate:
        from ravemj.manipulation.certification import certified  # noqa: PLC0415 - rarely wanted

        env = self.GetEnv()
        return certified(env.simulation, self.waypoints, env.GetCollisionChecker, whole=whole)

    @also_named(group="spec")
    def Init(self, spec: Spec) -> None:
        """Remove all waypoints, and set the layout of new ones.

        Args:
            spec: A specification, or a group; it is copied.

        Example:
            >>> trajectory = ravemj.RaveCreateTrajectory(env, "")
            >>> trajectory.Init(robot.GetActiveConfigurationSpecification())
        """
        if spec is None:  # pyright: ignore[reportUnnecessaryComparison] - users give it
            raise ArgumentError("Init: spec is None, and should be a ConfigurationSpecification")
        self._waypoints = Waypoints(_groups(spec))

    def take(self, other: Self) -> None:
        """Copy the waypoints and the certificate of another trajectory."""
        self._waypoints, self._certificate = other._waypoints, other._certificate

    @property
    def waypoints(self) -> Waypoints:
        """The waypoints as ravemj's internal object; it exists after ``Init``."""
        if self._waypoints is None:
            raise RavemjError("the trajectory has no specification yet; call Init(spec) first", ErrorCode.Assert)
        return self._waypoints

    def set_waypoints(self, waypoints: Waypoints, certificate: Certificate | None = None) -> None:
        """Replace layout, waypoints and certificate; None means that the motion has no certificate."""
        self._waypoints = waypoints
        self._certificate = None if certificate is None else (waypoints, certificate)

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
            index: The waypoint before which they are inserted; ``GetNumWaypoints()`` appends them.
            data: The waypoints, one after the other, shape (n * dof,), or one in each row, shape (n, dof).
            spec: The layout of the data; by default that of the trajectory. Values that it lacks stay as they are in
                existing waypoints. In new waypoints, missing joints of a group get their current values, and missing
                groups zeros. True and False stand for ``overwrite``.
            overwrite: Whether to overwrite waypoints from ``index`` on. Data beyond the last waypoint is appended.
            group: A group as the layout, in place of ``spec``.

        Raises:
            ArgumentError: the data does not fill whole waypoints, or the index is out of range.

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
        """Return a copy of a waypoint.

        Args:
            index: The index; negative ones count from the end.
            spec: The layout of the result; by default that of the trajectory.

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
        """Return the waypoints from ``startindex`` to before ``endindex``, one after the other, shape (n * dof,).

        Args:
            startindex: The first waypoint.
            endindex: The index after the last waypoint.
            spec: The layout of the result; by default that of the trajectory.
        """
        return self.GetWaypoints2D(startindex, endindex, spec).ravel()

    @also_named(group="spec")
    def GetWaypoints2D(self, startindex: int, endindex: int, spec: Spec | None = None) -> Floats:
        """Return a copy of the waypoints from ``startindex`` to before ``endindex``, shape (n, dof).

        Args:
            startindex: The first waypoint.
            endindex: The index after the last waypoint.
            spec: The layout of the result; by default that of the trajectory.
        """
        return self._as(self.waypoints.rows(startindex, endindex), spec)

    @also_named(group="spec")
    def GetAllWaypoints2D(self, spec: Spec | None = None) -> Floats:
        """Return a copy of all waypoints, shape (n, dof), in the layout ``spec``, by default that of the trajectory."""
        return self.GetWaypoints2D(0, len(self.waypoints), spec)

    def _as(self, rows: Floats, spec: Spec | None) -> Floats:
        return rows if spec is None else self.waypoints.as_layout(rows, _groups(spec), self._env.simulation.body)

    def GetDuration(self) -> float:
        """Return the time of the last waypoint [s]; 0 without a group ``deltatime``."""
        return self.waypoints.duration()

    def GetFirstWaypointIndexAfterTime(self, time: float) -> int:
        """Return the index of the first waypoint at a ``time`` [s] or later.

        After the last waypoint, it is the number of waypoints.

        Raises:
            ArgumentError: the trajectory has no group ``deltatime``.
        """
        return self.waypoints.first_after(time)

    @also_named(group="spec")
    def Sample(self, time: float, spec: Spec | None = None) -> Floats:
        """Return the configuration at a time, with the interpolation of each group.

        Args:
            time: The time since the start [s]. After the end, the result is the last waypoint.
            spec: The layout of the result; by default that of the trajectory. Values that the trajectory lacks are
                those of the bodies' current configuration.

        Returns:
            The configuration, shape (dof,). Its ``deltatime`` is the time since the last waypoint; with ``spec`` it is
            the ``deltatime`` of the next waypoint, as in OpenRAVE.

        Raises:
            ArgumentError: the time is negative, or the trajectory has no group ``deltatime``, no waypoints, or no
                velocities for an interpolation that needs them.

        Example:
            >>> trajectory.Sample(0.5)
        """
        find = self._env.simulation.body
        return self._as(self.waypoints.sample(time, restamped=spec is None, find_body=find)[None], spec)[0]

    @also_named(group="spec")
    def SampleFromPrevious(self, data: ArrayLike, time: float, spec: Spec) -> Floats:
        """Return the configuration at a time, with ``data`` for values that the trajectory lacks. See ``Sample``.

        Args:
            data: A configuration, shape (dof,).
            time: The time since the start [s].
            spec: The layout of the data and of the result.
        """
        source = self.waypoints.sample(time, restamped=False, find_body=self._env.simulation.body)
        target = ConfigurationSpecification(spec)
        return self.GetConfigurationSpecification().ConvertDataFromPrevious(data, target, source, 1, self._env)

    @also_named(group="spec")
    def SamplePoints2D(self, times: ArrayLike, spec: Spec | None = None) -> Floats:
        """Return the configurations at several times, shape (n, dof). See ``Sample``.

        Args:
            times: The times since the start [s], shape (n,).
            spec: The layout of the result; by default that of the trajectory.
        """
        rows = [self.Sample(float(time), spec) for time in checked_numbers(times, "times").ravel()]
        dof = (self.GetConfigurationSpecification() if spec is None else ConfigurationSpecification(spec)).GetDOF()
        return np.array(rows).reshape(len(rows), dof)

    @also_named(group="spec")
    def SamplePointsSameDeltaTime2D(self, deltatime: float, ensurelastpoint: bool, spec: Spec | None = None) -> Floats:
        """Return configurations at regular times.

        Args:
            deltatime: The time between two configurations [s].
            ensurelastpoint: Whether to append the end of the trajectory.
            spec: As for ``Sample``.

        Returns:
            Shape (n, dof).
        """
        return self.SampleRangeSameDeltaTime2D(deltatime, 0.0, self.GetDuration(), ensurelastpoint, spec)

    @also_named(group="spec", startTime="starttime", stopTime="stoptime")
    def SampleRangeSameDeltaTime2D(
        self, deltatime: float, starttime: float, stoptime: float, ensurelastpoint: bool, spec: Spec | None = None
    ) -> Floats:
        """Return configurations at regular times, from one time to before another.

        Args:
            deltatime: The time between two configurations [s].
            starttime: The first time [s].
            stoptime: The time before which they stop [s].
            ensurelastpoint: Whether to append the end of the trajectory, whatever ``stoptime`` is.
            spec: As for ``Sample``.

        Returns:
            Shape (n, dof).
        """
        if not deltatime > 0 or not stoptime >= starttime:
            message = f"deltatime: is {deltatime}, from starttime {starttime} to stoptime {stoptime}"
            raise ArgumentError(f"{message}; deltatime should be above 0, and stoptime not before starttime")
        times = starttime + deltatime * np.arange(math.ceil((stoptime - starttime) / deltatime))
        if ensurelastpoint:
            times = np.append(times, self.GetDuration())
        return self.SamplePoints2D(times, spec)

    def Clone(self, ref: "Trajectory", cloningoptions: int = 0) -> None:
        """Copy the layout, the waypoints, the description and the user data of another trajectory.

        Args:
            ref: The other trajectory.
            cloningoptions: Not used.
        """
        super().Clone(ref, cloningoptions)
        known = ref._waypoints
        self._waypoints = None if known is None else Waypoints(known.groups, known.data)

    def Swap(self, traj: "Trajectory") -> None:
        """Exchange layout and waypoints with the trajectory ``traj``."""
        self._waypoints, traj._waypoints = traj._waypoints, self._waypoints

    def serialize(self, options: int | None = 0) -> bytes:
        """Return the trajectory in OpenRAVE's format: binary, or XML in UTF-8 if ``options`` are 0x8000."""
        stored = Stored(self.waypoints, self.GetDescription())
        return to_text(stored, self._xmlid).encode() if int(options or 0) & AS_TEXT else to_bytes(stored)

    def deserialize(self, data: bytes | str) -> Self:
        """Replace this trajectory by ``data``, which ``serialize`` returned, and return it.

        Raises:
            ArgumentError: the data is not a trajectory; this one stays as it is.
        """
        self._waypoints, description = read(data)
        self.SetDescription(description)
        return self

    def SaveToFile(self, filename: AnyPath, options: int | None = 0) -> None:
        """Write the trajectory to a file, in the format of ``serialize``.

        Args:
            filename: The file.
            options: 0x8000 for XML; otherwise the file is binary.

        Raises:
            OutputError: the file cannot be written.
        """
        content = self.serialize(options)
        with new_file(filename) as path:
            path.write_bytes(content)

    def LoadFromFile(self, filename: AnyPath) -> None:
        """Replace this trajectory by the one in the file ``filename``, binary or XML.

        Raises:
            openrave_exception: the file cannot be read, or is not a trajectory.
        """
        try:
            content = Path(filename).read_bytes()
        except OSError as error:
            raise RavemjError(f"cannot read {os.fspath(filename)}: {(error.strerror or '').lower()}") from None
        self.deserialize(content)

    def __len__(self) -> int:
        return self.GetNumWaypoints()

    @also_named(indices="index")
    def __getitem__(self, index: int | slice) -> Floats:
        """Return a waypoint, shape (dof,), or for a slice several, shape (n, dof)."""
        return self.GetAllWaypoints2D()[index] if isinstance(index, slice) else self.GetWaypoint(index)

    def __iter__(self) -> Iterator[Floats]:
        return iter(self.GetAllWaypoints2D())

    def __bool__(self) -> bool:
        """Return True, also for a trajectory without waypoints."""
        return True

    def __repr__(self) -> str:
        made = f"RaveCreateTrajectory({self._env!r}, {self._xmlid!r})"
        return made if self._waypoints is None else f"{made}.deserialize({self.serialize(AS_TEXT).decode()!r})"

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:  # noqa: ANN401 - IPython's
        """Print the short text in IPython; ``repr`` is long."""
        del cycle
        printer.text(str(self))

    def __str__(self) -> str:
        state = "not initialized" if self._waypoints is None else f"waypoints={len(self._waypoints)}"
        return f"<trajectory:{self._xmlid}, {state}>"


def _groups(spec: Spec) -> Sequence[Group]:
    return ConfigurationSpecification(spec).GetGroups()

"""Environments: their bodies, the loading of models, and the lock."""

# OpenRAVE's robots keep these settings as private state, which clones copy.
# pyright: reportPrivateUsage=false

import itertools
import os
import pickle
import weakref
import zlib
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Self

from ravemj.core.arguments import also_named
from ravemj.core.blocks import exit_in_c
from ravemj.core.forks import disown, in_child
from ravemj.core.transforms import Floats
from ravemj.core.version import __version__
from ravemj.engine.simulation import Simulation, both_locks
from ravemj.engine.simulation.record import WorldRecord
from ravemj.errors import Diagnostic, Diagnostics, ErrorCode, RavemjError, Source, SourceError, send_warnings
from ravemj.formats.suffixes import format_of
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.model import scene
from ravemj.rave.enums import CloningOptions
from ravemj.rave.env.loading import Loading, checked_attributes
from ravemj.rave.env.saving import Saving
from ravemj.rave.env.viewing import Viewing
from ravemj.rave.iksolver import IkSolver
from ravemj.rave.infos import ConnectedBodyInfo, RobotBaseInfo
from ravemj.rave.interface import checked_environment
from ravemj.rave.logs import RaveGetDebugLevel, RaveSetDebugLevel
from ravemj.rave.robot import Robot
from ravemj.rave.robot.active import ActiveChoice, AffineKind
from ravemj.rave.robot.equipment import ConnectedBodies
from ravemj.rave.sensors import Sensor
from ravemj.rave.units import UnitInfo

if TYPE_CHECKING:
    import mujoco

_numbers = itertools.count(1)
_environments: "weakref.WeakValueDictionary[int, Environment]" = weakref.WeakValueDictionary()


@in_child
def _disown_all() -> None:
    for env in RaveGetEnvironments():
        disown(env, but=("Destroy", "close"))
    _environments.clear()


_QUICK = 1  # zlib's fastest level shrinks meshes to a third, in 17 ms for a PR2


class _RobotRecord(NamedTuple):
    """Settings of a robot that ``Environment.CloneSelf`` copies."""

    active_choice: ActiveChoice
    affine_kinds: dict[str, AffineKind]
    quaternion_limits: Floats
    active_manipulator: str | None
    ik_solvers: dict[str, tuple[str, IkParameterizationType, tuple[int, ...] | None]]
    connected: list[ConnectedBodyInfo]
    own_parts: RobotBaseInfo | None

    @classmethod
    def of(cls, robot: Robot) -> Self:
        solvers = robot.ik_solvers.items()
        return cls(
            robot.active_choice,
            robot.affine_kinds,
            robot.quaternion_limits,
            robot._active_manipulator,
            {arm: (solver.GetXMLId(), solver.kind, solver.given_free) for arm, solver in solvers},
            [body.GetInfo() for body in robot._connected.bodies],
            robot._connected._own_parts,
        )

    def put_into(self, robot: Robot) -> None:
        robot.active_choice, robot.affine_kinds = self.active_choice, self.affine_kinds
        robot.quaternion_limits, robot._active_manipulator = self.quaternion_limits, self.active_manipulator
        robot._connected = ConnectedBodies(robot, self.connected)
        robot._connected._own_parts = self.own_parts
        for arm, (name, kind, free) in self.ik_solvers.items():
            solver = IkSolver(robot.GetEnv(), name, kind, free)
            solver.attach(robot, arm)
            robot.ik_solvers[arm] = solver


class _Record(NamedTuple):
    """State of an environment that ``Environment.CloneSelf`` copies."""

    name: str
    description: str
    units: UnitInfo
    world: WorldRecord
    robots: dict[int, _RobotRecord]
    sensors: list[scene.AttachedSensor]
    options: tuple[int, float, str]
    files: dict[str, Source | None]
    diagnostics: tuple[Diagnostic, ...]


class Environment(Loading, Saving, Viewing):
    """A world with robots and other bodies.

    Example:
        >>> import ravemj
        >>> env = ravemj.Environment()
        >>> env.Load("models/env.xml")
        True
        >>> robot = env.GetRobots()[0]
        >>> robot.SetDOFValues([0.785, 0.785])
        >>> picture = env.render(640, 480)
    """

    _internal = ("simulation", "unpack")

    @also_named(penv="name")
    def __new__(cls, name: "str | int | Environment" = "", options: int = 1) -> Self:
        """Return a new object; if ``name`` is an environment, return that one."""
        return name if isinstance(name, cls) else super().__new__(cls)

    @also_named(penv="name")
    def __init__(self, name: "str | int | Environment" = "", options: int = 1) -> None:
        """Make an empty environment: ``Environment()`` or ``Environment(name)``.

        Args:
            name: The name that ``GetName`` returns. ``Environment(env)`` is that environment itself. A number is
                OpenRAVE's ``options``.
            options: ``EnvironmentCreateOptions``; they have no effect.
        """
        del options
        if name is self:
            return
        super().__init__()
        self._name = name if isinstance(name, str) else ""
        self._number = next(_numbers)
        _environments[self._number] = self

    def GetId(self) -> int:
        """Return the environment's number, as ``repr(env)`` shows it."""
        return self._number

    def SetDebugLevel(self, level: int) -> None:
        """Set the ``level`` of the log of all environments, a ``DebugLevel``; see ``RaveSetDebugLevel``."""
        RaveSetDebugLevel(level)

    def GetDebugLevel(self) -> int:
        """Return the log level, a ``DebugLevel``."""
        return RaveGetDebugLevel()

    def Lock(self, timeout: float | None = None) -> bool | None:
        """Acquire the lock. It is reentrant: each ``Lock`` needs one ``Unlock``.

        Args:
            timeout: Time limit of the wait [s]; by default none.

        Returns:
            With a timeout, whether the lock was acquired; else None.
        """
        if timeout is None:
            self._simulation.lock.hold()
            return None
        return self._simulation.lock.hold(max(0.0, float(timeout)))

    LockPhysics = Lock

    def TryLock(self) -> bool:
        """Try to acquire the lock without waiting; return whether it was acquired."""
        return self._simulation.lock.hold(0.0)

    def Unlock(self) -> None:
        """Release the lock.

        Raises:
            openrave_exception: this thread does not hold it (``EnvironmentNotLocked``).
        """
        try:
            self._simulation.lock.release()
        except RuntimeError:
            raise RavemjError("Unlock: this thread does not hold the lock", ErrorCode.EnvironmentNotLocked) from None

    def __enter__(self) -> Self:
        """Acquire the environment's lock: no other thread reads or changes it meanwhile."""
        lock = self._simulation.lock
        try:
            lock.acquire()
            return self
        except BaseException:
            lock.release_if_held()
            raise

    def _leave(self) -> Callable[..., object]:
        return self._simulation.lock.__exit__

    __exit__ = exit_in_c(_leave)

    def CloneSelf(self, options: int | str = CloningOptions.Bodies, clonedEnvName: Any = None) -> "Environment":  # noqa: ANN401 - either order
        """Return a new environment with copies of the bodies, in the same state.

        Robots keep active DOFs, manipulators and grabbed bodies, and their sensors stay on or off. Simulation time
        stands still in the copy until ``StartSimulation``.

        Args:
            options: What to copy, ``CloningOptions``: ``Bodies`` copies the bodies, ``Sensors`` the sensors that no
                robot carries. Gravity and the view are always copied.
            clonedEnvName: The new environment's name; may also come before the options, as in OpenRAVE.

        Example:
            >>> copy = env.CloneSelf(CloningOptions.Bodies)
            >>> copy.GetRobots()[0].SetDOFValues([1, 1])  # env's robot stays
        """
        if isinstance(options, str):
            options, clonedEnvName = CloningOptions.Bodies if clonedEnvName is None else clonedEnvName, options
        clone = type(self)(clonedEnvName or "")
        clone.StopSimulation()
        clone.Clone(self, options)
        return clone

    def Clone(
        self, reference: "Environment", options: int | str = CloningOptions.Bodies, clonedEnvName: str | None = None
    ) -> None:
        """Replace the bodies and sensors of this environment by copies of those of another.

        Args:
            reference: The environment to copy; nothing happens if it is this environment.
            options: As in ``CloneSelf``.
            clonedEnvName: The new name of this environment; as in ``CloneSelf``.
        """
        if isinstance(options, str):
            options, clonedEnvName = CloningOptions.Bodies, options
        self._name = clonedEnvName or self._name
        for env in (self, checked_environment(reference, "Clone: reference")):
            env._check_alive()
        source = reference.simulation
        if source is self._simulation:
            return
        self.SetUnitInfo(reference.GetUnitInfo())
        with both_locks(source, self._simulation):
            self._remove_all()
            for original, copy in self._simulation.copy(source, bodies=bool(options & CloningOptions.Bodies)).items():
                body, other = self.wrap(copy), reference.wrap(original)
                if isinstance(body, Robot) and isinstance(other, Robot):
                    body.take_choices(other)
            for sensor in reference._sensors if options & CloningOptions.Sensors else ():
                loose = Sensor(self, sensor.description)
                loose.Clone(sensor)
                self.AddSensor(loose)

    def __reduce__(self) -> tuple[Callable[..., object], tuple[type[Self], str, bytes]]:
        """Pickle the state that ``CloneSelf`` copies, and the diagnostics; omit callbacks and user data."""
        self._check_alive()
        with self._simulation.lock:
            robots = [body for body in self.GetBodies() if isinstance(body, Robot)]
            checker = self.GetCollisionChecker()
            record = _Record(
                self.GetName(),
                self.GetDescription(),
                self.GetUnitInfo(),
                WorldRecord.from_simulation(self._simulation),
                {robot.simulation_state.index: _RobotRecord.of(robot) for robot in robots},
                [sensor.description for sensor in self._sensors],
                (checker.GetCollisionOptions(), checker.GetTolerance(), checker.GetGeometryGroup()),
                self._files,
                tuple(self._found),
            )
            content = pickle.dumps(record, pickle.HIGHEST_PROTOCOL)
        return _unpacked, (type(self), __version__, zlib.compress(content, _QUICK))

    def unpack(self, content: bytes) -> None:
        """Restore the content of a pickled environment into this one, which is empty."""
        record: _Record = pickle.loads(zlib.decompress(content))
        self._name = record.name
        self.SetDescription(record.description)
        self.SetUnitInfo(record.units)
        record.world.put_into(self._simulation)
        self._files.update(record.files)
        self._found.update(dict.fromkeys(record.diagnostics))
        for body in self.GetBodies():
            if isinstance(body, Robot):
                record.robots[body.simulation_state.index].put_into(body)
        for description in record.sensors:
            self.AddSensor(Sensor(self._environment, description))
        checker = self.GetCollisionChecker()
        options, tolerance, group = record.options
        checker.SetTolerance(tolerance)
        checker.SetCollisionOptions(options)
        checker.groups.choose(group)

    def Reset(self) -> None:
        """Remove all bodies and sensors."""
        self._remove_all()

    def Destroy(self) -> None:
        """Stop time, close the viewer, remove all bodies; nothing can be added afterwards. A second call does nothing.

        Example:
            >>> env = ravemj.Environment()
            >>> try:
            ...     env.Load("models/env.xml")
            ... finally:
            ...     env.Destroy()
            True
        """
        self.StopSimulation()
        for module in self.GetModules():
            self.Remove(module)
        self.SetViewer("")
        self.Reset()
        self._renderer.close()
        self._is_destroyed = True
        _environments.pop(self._number, None)

    @property
    def simulation(self) -> Simulation:
        """The simulation below the OpenRAVE API: bodies and their MuJoCo model."""
        return self._simulation

    @property
    def mjcf(self) -> str:
        """The environment as MJCF, the text that MuJoCo compiles."""
        return self._simulation.compile().mjcf.text

    def write_mjcf(  # noqa: PLR0913 - keyword arguments
        self,
        path: str | os.PathLike[str],
        *,
        base: Literal["fixed", "free", "openrave"] = "fixed",
        actuators: Literal["position", "velocity", "torque"] | None = None,
        gains: str | os.PathLike[str] | None = None,
        state: str | None = None,
        self_collision: bool = True,
        exclude: Literal["touching", "none"] = "touching",
        decompose: bool = False,
        hull_vertices: int = 0,
        merge_fixed: bool = False,
        sensors: bool = False,
        append: str | os.PathLike[str] | None = None,
        timestep: float | None = None,
    ) -> str:
        """Write all bodies as an MJCF model for simulations, as ``ravemj convert`` does, and return its path.

        Args:
            path: An MJCF file, with meshes in ``assets`` beside it; or a folder (without a suffix), which gets
                ``scene.xml``, too: the model on a floor.
            base: Attachment of the bodies: ``fixed`` welds all to the world; ``openrave`` frees those without a static
                link; ``free`` also frees robots with a static link.
            actuators: The kind of actuator of each DOF; see ``Robot.servo_gains`` for the gains.
            gains: File with gains in place of the computed ones: lines ``joint, kp, kv``.
            state: Group state of the SRDF to start from; None for the one called home, standing or half_sitting, else
                the present joint values.
            self_collision: Whether links of one robot collide.
            exclude: ``touching`` excludes pairs of links that are adjacent or touch at the start; ``none`` excludes no
                pairs.
            decompose: Whether meshes collide as several convex parts, not as one hull; needs ``ravemj[decompose]``.
            hull_vertices: Maximum number of vertices of a collision hull; 0 means no limit.
            merge_fixed: Whether links that cannot move become shapes and sites of the links that carry them.
            sensors: Whether there are sensors of joints, an IMU at the base, and the sensors of the model.
            append: File with a fragment of MJCF whose elements are added.
            timestep: Time step [s], for which gains are computed as well; None means 0.002.

        Raises:
            ArgumentError: an argument is wrong, or the state is not in the SRDF.
            CompileError: MuJoCo refuses the model.
            SourceError: a file of gains or a fragment is broken.
            OutputError: the file cannot be written.

        Example:
            >>> env = ravemj.load(ravemj.model_path("desk_arm"))
            >>> env.write_mjcf("desk_arm.mjcf.xml", actuators="position", state="ready")
            'desk_arm.mjcf.xml'
        """
        from ravemj.engine.export import write  # noqa: PLC0415 - slow to import, and rarely wanted
        from ravemj.engine.translation import TranslationChoices, translated  # noqa: PLC0415

        choices = TranslationChoices(
            base, actuators, gains, state, self_collision, exclude, decompose, hull_vertices, merge_fixed, sensors,
            append, timestep,
        )  # fmt: skip
        self._check_alive()
        model = self.files[0] if self.files else f"{self._name or 'model'}.xml"
        diagnostics = Diagnostics()
        loose = tuple(sensor.description for sensor in self._sensors)
        written = write(path, model, translated(self._simulation, diagnostics, choices, model, loose), self.files)
        send_warnings(diagnostics)
        return str(written)

    @property
    def spec(self) -> "mujoco.MjSpec":
        """MuJoCo's editable form of the environment with its meshes, for cameras and actuators of your own."""
        return self._simulation.compile().complete_spec

    @property
    def model(self) -> "mujoco.MjModel":
        """The compiled MuJoCo model; adding bodies replaces it by a new one."""
        return self._simulation.compiled().model

    @property
    def data(self) -> "mujoco.MjData":
        """The state of the MuJoCo model at the present poses of the bodies."""
        return self._simulation.compiled().data

    def __repr__(self) -> str:
        return f"RaveGetEnvironment({self._number})"

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:  # noqa: ANN401 - IPython's
        """Print a table of the bodies in IPython; ``repr`` names only the environment."""
        from ravemj.rave.tables import environment_text, print_pretty  # noqa: PLC0415 - html is slow to import

        del cycle
        print_pretty(printer, self, environment_text(self))

    def __str__(self) -> str:
        names = ", ".join(body.GetName() for body in self.GetBodies())
        return f"<environment:{self._number}, bodies={names or 'none'}>"


def _unpacked(kind: type[Environment], version: str, content: bytes) -> Environment:
    """Return a pickled environment with simulation time stopped.

    Raises:
        RavemjError: another version of ravemj pickled it.
    """
    if version != __version__:
        message = f"an environment that ravemj {version} pickled cannot be read by ravemj {__version__}"
        raise RavemjError(f"{message}: install the same version in both places", ErrorCode.InvalidState)
    env = kind()
    env.StopSimulation()
    env.unpack(content)
    return env


def RaveGetEnvironment(id: int) -> Environment | None:  # OpenRAVE's name of the argument
    """Return the environment with the number ``id``, as ``repr(env)`` shows it, or None."""
    return _environments.get(id)


def RaveGetEnvironmentId(env: Environment) -> int:
    """Return the number of ``env``, the argument of ``RaveGetEnvironment``."""
    return checked_environment(env, "RaveGetEnvironmentId").GetId()


def RaveGetEnvironments() -> list[Environment]:
    """Return all environments that are in use."""
    return list(_environments.values())


def RaveDestroy() -> None:
    """Destroy all environments; usually the last line of a script."""
    for env in RaveGetEnvironments():
        env.Destroy()


def load(
    path: str | os.PathLike[str], atts: "Mapping[str, str] | None" = None, *, into: Environment | None = None
) -> Environment:
    """Load a model file into a new environment; raise an error if it cannot be loaded.

    Args:
        path: A model file; see ``Environment.Load``.
        atts: Attributes for its body; see ``Environment.Load``.
        into: The environment that the model is added to; by default a new one.

    Returns:
        The environment; ``env.diagnostics`` has the warnings of loading.

    Raises:
        SourceError: the file is missing or broken; the message names file and line, and ``diagnostics`` has the
            warnings before the error.

    Example:
        >>> env = ravemj.load("models/env.xml")
        >>> env.GetRobots()[0].GetDOF()
        2
    """
    from ravemj.formats.readers import read_file  # noqa: PLC0415 - slow to import

    env = Environment() if into is None else into
    given = checked_attributes(atts, "load")
    if format_of(os.fspath(path)) == "json":
        env._load_json(os.fspath(path))
        env.simulation.compiled()
        return env
    reading = read_file(path, given)
    try:
        if reading.failure is not None:
            raise reading.failure
        env._add(reading)
        env.simulation.compile()
    except SourceError as error:
        error.diagnostics = (*reading.diagnostics, *env.simulation.diagnostics)
        if error.cause is not None:
            error.add_note(str(error.cause))
        raise
    return env

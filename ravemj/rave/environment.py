"""The environment: it holds robots and other bodies, loads models, and has the lock."""

import itertools
import os
import weakref
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Self

from ravemj.core.arguments import also_named
from ravemj.core.blocks import exit_in_c
from ravemj.core.forks import disown, in_child
from ravemj.engine.simulation import Simulation, both_locks
from ravemj.errors import ErrorCode, RavemjError, SourceError
from ravemj.rave.enums import CloningOptions
from ravemj.rave.env.json_files import is_json
from ravemj.rave.env.loading import Loading, checked_attributes
from ravemj.rave.env.saving import Saving
from ravemj.rave.env.viewing import Viewing
from ravemj.rave.interface import checked_environment
from ravemj.rave.logs import RaveGetDebugLevel, RaveSetDebugLevel
from ravemj.rave.robot import Robot
from ravemj.rave.sensors import Sensor

if TYPE_CHECKING:
    import mujoco

_numbers = itertools.count(1)
_environments: "weakref.WeakValueDictionary[int, Environment]" = weakref.WeakValueDictionary()


@in_child
def _disown_all() -> None:
    for env in RaveGetEnvironments():
        disown(env, but=("Destroy", "close"))
    _environments.clear()


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

    _internal = ("simulation",)

    @also_named(penv="name")
    def __new__(cls, name: "str | int | Environment" = "", options: int = 1) -> Self:
        """Return a new object, or the environment that stands in the place of a name."""
        return name if isinstance(name, cls) else super().__new__(cls)

    @also_named(penv="name")
    def __init__(self, name: "str | int | Environment" = "", options: int = 1) -> None:
        """Make an empty environment: ``Environment()`` or ``Environment(name)``.

        Args:
            name: What ``GetName`` returns. ``Environment(env)`` is that environment itself. A number is OpenRAVE's
                ``options``.
            options: ``EnvironmentCreateOptions``, without meaning: time begins to pass once it is wanted.
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
        """Return how much is logged, a ``DebugLevel``."""
        return RaveGetDebugLevel()

    def Lock(self, timeout: float | None = None) -> bool | None:
        """Acquire the lock; a thread can acquire it several times, and has to release it as often.

        Args:
            timeout: How long to wait [s]; left out: as long as it takes.

        Returns:
            With a timeout, whether the lock was taken; else None.
        """
        if timeout is None:
            self._simulation.lock.hold()
            return None
        return self._simulation.lock.hold(max(0.0, timeout))

    LockPhysics = Lock

    def TryLock(self) -> bool:
        """Take the lock if it is free, without waiting; return whether it was taken."""
        return self._simulation.lock.hold(0.0)

    def Unlock(self) -> None:
        """Give the lock back.

        Raises:
            openrave_exception: this thread does not hold it (``EnvironmentNotLocked``).
        """
        try:
            self._simulation.lock.release()
        except RuntimeError:
            raise RavemjError("Unlock: this thread does not hold the lock", ErrorCode.EnvironmentNotLocked) from None

    def __enter__(self) -> Self:
        """Hold the environment's lock: no other thread reads or changes it meanwhile."""
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

        Robots keep their active DOFs and manipulators, hold what they held, and their sensors stay on or off.
        Simulation time stands still in the copy until ``StartSimulation``.

        Args:
            options: What to copy, a ``CloningOptions``: bodies only with ``Bodies``, sensors that no robot carries only
                with ``Sensors``; gravity and the view are, whatever it says.
            clonedEnvName: The new environment's name; OpenRAVE has it before the options, which is understood too.

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
            reference: The environment to copy; nothing happens where it is this one.
            options: As in ``CloneSelf``.
            clonedEnvName: What this environment is called from then on; as in ``CloneSelf``.
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
        """The bodies and their MuJoCo model; below the OpenRAVE API."""
        return self._simulation

    @property
    def mjcf(self) -> str:
        """The environment as MJCF, the text that is compiled."""
        return self._simulation.compile().mjcf.text

    @property
    def spec(self) -> "mujoco.MjSpec":
        """MuJoCo's editable form of the environment, for cameras and actuators of your own."""
        return self._simulation.compile().spec

    @property
    def model(self) -> "mujoco.MjModel":
        """The compiled MuJoCo model; a new one after bodies were added."""
        return self._simulation.compiled().model

    @property
    def data(self) -> "mujoco.MjData":
        """The state of the MuJoCo model, as the bodies are now."""
        return self._simulation.compiled().data

    def __repr__(self) -> str:
        return f"RaveGetEnvironment({self._number})"

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:  # noqa: ANN401 - IPython's
        """Print a table of the bodies in IPython, where ``repr`` would name the environment alone."""
        from ravemj.rave.tables import environment_text, print_pretty  # noqa: PLC0415 - html is slow to import

        del cycle
        print_pretty(printer, self, environment_text(self))

    def __str__(self) -> str:
        names = ", ".join(body.GetName() for body in self.GetBodies())
        return f"<environment:{self._number}, bodies={names or 'none'}>"


def RaveGetEnvironment(id: int) -> Environment | None:  # OpenRAVE's name of the argument
    """Return the environment of the number ``id``, as ``repr(env)`` shows it, or None."""
    return _environments.get(id)


def RaveGetEnvironmentId(env: Environment) -> int:
    """Return the number of ``env``, as ``RaveGetEnvironment`` takes it."""
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
    """Load a model file into a new environment, or raise.

    Args:
        path: A model file; see ``Environment.Load``.
        atts: Attributes for its body; see ``Environment.Load``.
        into: The environment that the model is added to; by default a new one.

    Returns:
        The environment; ``env.diagnostics`` has what was found on the way.

    Raises:
        SourceError: the file is missing or broken; the message names file and line, and ``diagnostics`` has what was
            found before.

    Example:
        >>> env = ravemj.load("models/env.xml")
        >>> env.GetRobots()[0].GetDOF()
        2
    """
    from ravemj.formats.readers import read_file  # noqa: PLC0415 - slow to import

    env = Environment() if into is None else into
    given = checked_attributes(atts, "load")
    if is_json(os.fspath(path)):
        env._load_json(os.fspath(path))  # pyright: ignore[reportPrivateUsage]
        env.simulation.compiled()
        return env
    reading = read_file(path, given)
    try:
        if reading.failure is not None:
            raise reading.failure
        env._add(reading)  # pyright: ignore[reportPrivateUsage]
        env.simulation.compile()
    except SourceError as error:
        error.diagnostics = (*reading.diagnostics, *env.simulation.diagnostics)
        if error.cause is not None:
            error.add_note(str(error.cause))
        raise
    return env

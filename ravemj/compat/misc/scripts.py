"""Options, logging and viewers of OpenRAVE's example programs."""

import itertools
import logging
import optparse
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from typing import IO, Any

from ravemj.core.output import AnyPath
from ravemj.errors import RavemjError
from ravemj.rave import logs
from ravemj.rave.collision import CollisionChecker, RaveCreateCollisionChecker
from ravemj.rave.enums import DebugLevel
from ravemj.rave.environment import Environment
from ravemj.rave.registry import RaveCreateTrajectory
from ravemj.rave.trajectory import Trajectory

_LEVELS = {level.name.lower(): level for level in DebugLevel}


def InitOpenRAVELogging(stream: IO[str] | None = None) -> None:
    """Show log messages.

    Args:
        stream: The stream; by default standard output.
    """
    handler = logging.StreamHandler(stream or sys.stdout)
    handler.setFormatter(logging.Formatter("%(name)s: %(funcName)s, %(message)s"))
    logs.log.handlers = [handler]


def SetViewerUserThread(env: Environment, viewername: str, userfn: Callable[[], object]) -> None:
    """Run a function while a viewer shows the environment.

    Args:
        env: The environment.
        viewername: As for ``env.SetViewer``; empty for no viewer.
        userfn: The function.
    """
    if viewername:
        env.SetViewer(viewername)
    userfn()


class OpenRAVEGlobalArguments:
    """Common options of OpenRAVE's example programs.

    Example:
        >>> parser = optparse.OptionParser()
        >>> OpenRAVEGlobalArguments.addOptions(parser)
        >>> options, arguments = parser.parse_args()
        >>> OpenRAVEGlobalArguments.parseAndCreateThreadedUser(options, main)
    """

    @staticmethod
    def addOptions(parser: optparse.OptionParser, testmode: bool = True) -> None:
        """Add the options to a parser.

        Args:
            parser: The parser, which may have other options.
            testmode: Whether ``--testmode`` is one of the options.
        """
        group = optparse.OptionGroup(parser, "OpenRAVE Environment Options")
        group.add_option("--collision", dest="_collision", help="name of the collision checker")
        group.add_option("--physics", dest="_physics", help="name of the physics engine")
        group.add_option("--viewer", dest="_viewer", help="name of the viewer; '' for none")
        group.add_option("--loadplugin", dest="_loadplugins", action="append", default=[], help="is not supported")
        level = "Debug level, one of " + ",".join(_LEVELS)
        group.add_option("--level", "-l", "--log_level", "--debug", "-d", dest="_level", help=level)
        if testmode:
            group.add_option("--testmode", dest="testmode", action="store_true", default=False, help="run by itself")
        parser.add_option_group(group)

    @staticmethod
    def parseGlobalArguments(options: Any) -> None:  # noqa: ANN401 - optparse gives whatever was added
        """Apply the options that do not concern an environment."""
        level = getattr(options, "_level", None)
        if level:
            logs.RaveSetDebugLevel(_LEVELS[level.lower()] if level.lower() in _LEVELS else int(level))

    @staticmethod
    def parseGlobal(options: Any, **kwargs: object) -> None:  # noqa: ANN401 - as above
        """Apply the options that do not concern an environment.

        Args:
            options: What ``optparse`` or ``argparse`` returned.
            kwargs: Not used.
        """
        del kwargs
        OpenRAVEGlobalArguments.parseGlobalArguments(options)

    @staticmethod
    def parseEnvironment(
        options: Any,  # noqa: ANN401 - optparse gives whatever was added
        env: Environment,
        defaultviewer: bool = False,
        returnviewer: bool = False,
        **kwargs: object,
    ) -> str | None:
        """Apply the options to an environment.

        Args:
            options: The first result of ``parser.parse_args()``.
            env: The environment.
            defaultviewer: Whether to attach a viewer if the options name none.
            returnviewer: Whether to return the viewer's name instead of attaching it.
            kwargs: OpenRAVE's; not used.

        Returns:
            The viewer's name if ``returnviewer``, else None.

        Raises:
            openrave_exception: the collision checker or physics engine is unknown.
        """
        OpenRAVEGlobalArguments.parseGlobalArguments(options)
        if getattr(options, "_collision", None):
            env.SetCollisionChecker(_checker(env, options._collision))
        if getattr(options, "_physics", None):
            env.SetPhysicsEngine(options._physics)
        viewer = getattr(options, "_viewer", None)
        if viewer is None:
            viewer = "qtcoin" if defaultviewer else ""
        if returnviewer:
            return viewer
        if viewer:
            env.SetViewer(viewer)
        return None

    @staticmethod
    def parseAndCreate(
        options: Any,  # noqa: ANN401 - optparse gives whatever was added
        createenv: Callable[[], Environment] = Environment,
        defaultviewer: bool = False,
        **kwargs: object,
    ) -> Environment:
        """Return a new environment with the options applied."""
        env = createenv()
        OpenRAVEGlobalArguments.parseEnvironment(options, env, defaultviewer)
        return env

    @staticmethod
    def parseAndCreateThreadedUser(
        options: Any,  # noqa: ANN401 - optparse gives whatever was added
        userfn: Callable[[Environment, Any], object],
        defaultviewer: bool = True,
        returnviewer: bool = False,
        createenv: Callable[[], Environment] = Environment,
    ) -> None:
        """Run ``userfn(env, options)`` in a new environment, with a viewer unless the options say otherwise."""
        del returnviewer
        env = createenv()
        viewer = OpenRAVEGlobalArguments.parseEnvironment(options, env, defaultviewer, returnviewer=True)
        SetViewerUserThread(env, viewer or "", lambda: userfn(env, options))


def _checker(env: Environment, name: str) -> CollisionChecker:
    checker = RaveCreateCollisionChecker(env, name)
    if checker is None:
        raise RavemjError(f"there is no collision checker '{name}'; there are mujoco and ode")
    return checker


def LoadTrajectoryFromFile(env: Environment, trajfile: AnyPath, trajtype: str = "") -> Trajectory | None:
    """Read a trajectory from a file that ``SaveToFile`` wrote, and return it.

    Args:
        env: The environment of the trajectory.
        trajfile: The file.
        trajtype: As for ``RaveCreateTrajectory``.

    Returns:
        The trajectory; None for an unknown type.

    Raises:
        openrave_exception: the file cannot be read, or is not a trajectory.
    """
    trajectory = RaveCreateTrajectory(env, trajtype)
    if trajectory is not None:
        trajectory.LoadFromFile(trajfile)
    return trajectory


def mkdir_recursive(newdir: str) -> None:
    """Create a folder and its missing parents."""
    os.makedirs(newdir, exist_ok=True)


def myproduct(*args: Iterable[object], **kwds: int) -> Iterator[tuple[object, ...]]:
    """Return ``itertools.product`` of the same arguments."""
    return itertools.product(*args, **kwds)

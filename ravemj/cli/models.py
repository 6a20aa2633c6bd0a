"""Loading the model of a command."""

import argparse
import os
import sys
import warnings
from collections.abc import Sequence
from typing import cast

import numpy as np

from ravemj.cli.argument_parser import did_you_mean
from ravemj.cli.checking import FATAL_CODES
from ravemj.cli.console import print_findings
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, Diagnostic, RavemjWarning, SourceError
from ravemj.formats.robot_packages import is_robot_name, robot_file
from ravemj.formats.shipped import SHIPPED_MODELS, model_path
from ravemj.formats.urdf import GUESSES
from ravemj.rave import Environment, Robot, load
from ravemj.trajectories.motion_arguments import first_robot


def load_model(options: argparse.Namespace) -> Environment:
    """Load the model of a command and print the diagnostics.

    Raises:
        SourceError: the file is missing or malformed, or has warnings and ``--strict`` was given.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RavemjWarning)  # they are printed together below
        env = loaded(options)
    findings = [finding for finding in env.diagnostics if finding.severity != "note"]
    fatal = [finding for finding in findings if options.strict or finding.code in FATAL_CODES]
    if fatal:
        raise failure_of(fatal)
    print_findings([*findings, *(finding for finding in env.diagnostics if finding.code == GUESSES)])
    return env


def loaded(options: argparse.Namespace) -> Environment:
    """Load the model of a command, and its additional models.

    Raises:
        SourceError: a model is missing or malformed; the message names the cause.
    """
    env = None
    try:
        for model in (options.model, *getattr(options, "others", [])):
            file, words = model_file(model, download=getattr(options, "download", False)), given(options)
            env = load(file, words | xacro_arguments(model, words.get("args", "")), into=env)
    except SourceError as error:
        raise error if error.cause is None else failure_of([error.cause]) from None
    return cast("Environment", env)


def given(options: argparse.Namespace) -> dict[str, str]:
    """Return the options for a URDF as attributes of ``Environment.Load``."""
    packages: list[str] = getattr(options, "package", None) or []
    arguments: list[str] = getattr(options, "arg", None) or []
    words = {
        "srdf": getattr(options, "srdf", None),
        "state": getattr(options, "state", None),
        "packages": os.pathsep.join(packages),
        "args": " ".join(arguments),
    }
    return {name: word for name, word in words.items() if word}


def named_robot(env: Environment, name: str | None) -> Robot | None:
    """Return the robot of ``--robot``; None if there is no name.

    Raises:
        ArgumentError: the model has no such robot.
    """
    if name is None:
        return None
    robot = env.GetRobot(name)
    if robot is None:
        names = [other.GetName() for other in env.GetRobots()]
        kind = f"'{name}' is a body, not a robot" if env.GetKinBody(name) else f"there is no robot '{name}'"
        raise ArgumentError(f"--robot: {kind}; the model has {', '.join(names) or 'none'}{did_you_mean(name, names)}")
    return robot


def chosen_robots(env: Environment, name: str | None) -> list[Robot]:
    """Return the robot of ``--robot``, by default all robots; raises the errors of ``named_robot``."""
    robot = named_robot(env, name)
    return env.GetRobots() if robot is None else [robot]


def moving_robot(env: Environment, name: str | None) -> Robot:
    """Return the robot of ``--robot``, by default the first robot with joints.

    Raises:
        ArgumentError: the model has no such robot, or the robot has no joints.
    """
    robot = named_robot(env, name) or cast("Robot", env.wrap(first_robot(env.simulation)))
    if not robot.GetDOF():
        raise ArgumentError(f"--robot: '{name}' has no joints to move")
    return robot


def shown_sphere(env: Environment, robot: Robot | None) -> tuple[Floats, float]:
    """Return centre, shape (3,), and radius [m] of a sphere around a robot, by default around everything."""
    if robot is None:
        return env.renderer.bounding_sphere()
    box = robot.ComputeAABB()
    return box.pos(), float(np.linalg.norm(box.extents()))


def hold_bases(env: Environment) -> None:
    """Fix the bases of robots if nothing is static; otherwise everything would fall forever under physics."""
    if not any(link.IsStatic() for body in env.GetBodies() for link in body.GetLinks()):
        for robot in env.GetRobots():
            robot.GetLinks()[0].SetStatic(True)


def model_file(name: str, *, download: bool = False) -> str:
    """Return the model file named by an argument.

    The argument is a path, the name of a shipped model, or the name of a packaged robot, which may be fetched if
    ``download``.

    Raises:
        ArgumentError: the robot is not on this machine and may not be fetched.
        RavemjError: it cannot be fetched.
    """
    if os.path.exists(name):
        return name
    if is_robot_name(name):
        return str(robot_file(name, download=download, say=lambda text: print(text, file=sys.stderr)).path)
    return model_path(name) if name in SHIPPED_MODELS else name


def xacro_arguments(name: str, own: str) -> dict[str, str]:
    """Return the xacro arguments of a packaged robot, then the user's ``own``, as the attribute ``args`` of ``load``.

    The result is empty for other models, and for robots without arguments.
    """
    if os.path.exists(name) or not is_robot_name(name):
        return {}
    words = [f"{key}:={value}" for key, value in robot_file(name).arguments.items()]
    return {"args": " ".join([*words, own]).strip()} if words else {}


def failure_of(findings: Sequence[Diagnostic]) -> SourceError:
    """Return the one-line error for fatal diagnostics; it ends with the code of the first one."""
    first = findings[0]
    more = f" (and {len(findings) - 1} more: see ravemj check)" if len(findings) > 1 else ""
    code = f" [{first.code}]"
    if first.hint:
        return SourceError(f"{first.message}{more}", first.source, f"{first.hint}{code}")
    return SourceError(f"{first.message}{more}{code}", first.source)

"""Shell completion of commands, options, models and parts of models."""

import argparse
import contextlib
import warnings
from typing import TYPE_CHECKING

from argcomplete.completers import FilesCompleter
from argcomplete.shell_integration import shellcode

from ravemj.errors import RavemjError
from ravemj.formats.robot_packages import robot_names
from ravemj.formats.shipped import SHIPPED_MODELS

if TYPE_CHECKING:
    from ravemj.rave import Robot


def completion(options: argparse.Namespace) -> int:
    """Print the setup code for a shell."""
    print(shellcode(["ravemj"], shell=options.shell))
    return 0


def models(prefix: str, **_: object) -> list[str]:
    """Return the completions of a model name: shipped models, robots of packages, and files."""
    known = [name for name in (*SHIPPED_MODELS, *robot_names()) if name.startswith(prefix)]
    return [*known, *FilesCompleter(("xml", "dae", "zae", "urdf", "mjcf"))(prefix)]


def robots(prefix: str, parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Return the completions of a robot name for the model given before."""
    return [robot.GetName() for robot in _robots(parsed_args) if robot.GetName().startswith(prefix)]


def manipulators(prefix: str, parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Return the completions of a manipulator name for the model or robot given before."""
    chosen = [robot for robot in _robots(parsed_args) if parsed_args.robot in {None, robot.GetName()}]
    names = dict.fromkeys(arm.GetName() for robot in chosen for arm in robot.GetManipulators())
    return [name for name in names if name.startswith(prefix)]


def _robots(options: argparse.Namespace) -> "list[Robot]":
    """Return the robots of the model on the command line; empty if it is missing or cannot be read."""
    from ravemj.cli.models import loaded  # noqa: PLC0415 - slow to import

    with warnings.catch_warnings(), contextlib.suppress(RavemjError):
        warnings.simplefilter("ignore")
        return loaded(options).GetRobots() if options.model else []
    return []

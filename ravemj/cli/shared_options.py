"""What the parsers of several commands share."""

import argparse
from importlib import import_module
from typing import TypeAlias

from ravemj.cli.argument_parser import Parser
from ravemj.cli.argument_types import argument, colour, file_name, package, size
from ravemj.formats.shipped import SHIPPED_MODELS
from ravemj.model.look import FLOORS, LIGHTS

Commands: TypeAlias = "argparse._SubParsersAction[Parser]"  # pyright: ignore[reportPrivateUsage]

VIDEOS = ".mp4, .avi, .mpg, .gif, .webp, or a folder for PNG frames"
"""The files that ``-o`` accepts in commands that write videos."""


def command(commands: Commands, run: str, summary: str, *examples: str) -> argparse.ArgumentParser:
    """Add a command.

    Args:
        commands: The parser of all commands.
        run: What does the work, as ``module.function``, whose name is the command's. The module, of ``ravemj.cli``, is
            imported when the command runs: help needs none of them.
        summary: What it does, beginning with a verb in lower case.
        examples: Lines of a shell that use it.
    """
    module, _, name = run.partition(".")

    def work(options: argparse.Namespace) -> int:
        return getattr(import_module(f"ravemj.cli.{module}"), name)(options)

    parser = commands.add_parser(
        name,
        help=summary,
        description=f"{summary[0].upper()}{summary[1:]}.",
        epilog="examples:\n" + "\n".join(f"  {example}" for example in examples),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.set_defaults(run=work)
    return parser


def _complete(argument: argparse.Action, function: str) -> None:
    """Let shells complete an argument with what a function of ``ravemj.cli.completion`` returns."""

    def completer(prefix: str, **known: object) -> list[str]:
        completion = import_module("ravemj.cli.completion")  # only where a shell asks
        return getattr(completion, function)(prefix, **known)

    argument.completer = completer  # pyright: ignore[reportAttributeAccessIssue] - argcomplete's


def complete_models(argument: argparse.Action) -> None:
    """Let shells complete an argument with names and files of models."""
    _complete(argument, "models")


def add_robot(parser: argparse.ArgumentParser, meaning: str) -> None:
    """Add the robot that a command is about."""
    _complete(parser.add_argument("--robot", metavar="NAME", help=meaning), "robots")


def add_manipulator(parser: argparse.ArgumentParser) -> None:
    """Add the manipulator that a command moves."""
    argument = parser.add_argument("--manip", metavar="NAME", help="which manipulator; default: the active one")
    _complete(argument, "manipulators")


def add_model(parser: argparse.ArgumentParser) -> None:
    """Add the model that a command is about."""
    model = parser.add_argument(
        "model",
        type=file_name,
        metavar="MODEL",
        help="OpenRAVE XML, COLLADA or URDF file: an environment, a robot or a kinbody; or a model that comes with "
        f"ravemj: {', '.join(SHIPPED_MODELS)}",
    )
    complete_models(model)
    add_urdf_options(parser)
    parser.add_argument("--strict", action="store_true", help="take warnings about the model for errors")


def add_urdf_options(parser: argparse.ArgumentParser) -> None:
    """Add what can be said about a URDF."""
    group = parser.add_argument_group("robots in URDF")
    group.add_argument(
        "--srdf", type=file_name, metavar="FILE", help="SRDF of the robot; default: the one beside it; none for none"
    )
    group.add_argument("--state", metavar="NAME", help="group state of the SRDF that gives the joint values")
    group.add_argument(
        "--package",
        action="append",
        type=package,
        metavar="NAME=FOLDER",
        help="folder of package://NAME/; may be repeated; default: folders above the URDF, ROS_PACKAGE_PATH, …",
    )
    group.add_argument(
        "--arg", action="append", type=argument, metavar="NAME:=VALUE", help="argument of a xacro; may be repeated"
    )


def add_picture_options(parser: argparse.ArgumentParser, size_help: str) -> None:
    """Add size, camera and background of pictures."""
    parser.add_argument("--size", type=size, default=(640, 480), metavar="WxH", help=size_help)
    parser.add_argument(
        "--camera",
        type=file_name,
        metavar="FILE",
        help="camera as a 4x4 matrix in JSON or text: z forward, y down; default: all in view",
    )
    parser.add_argument(
        "--background",
        type=colour,
        metavar="COLOUR",
        help="background: red, green and blue from 0 to 1, as 0.8,0.85,0.9, or a CSS name or #rrggbb; default: the "
        "model's, or a gradient and a floor",
    )
    add_look_options(parser)


def add_look_options(parser: argparse.ArgumentParser) -> None:
    """Add shadows, floor and lights."""
    parser.add_argument(
        "--shadows",
        action=argparse.BooleanOptionalAction,
        help="whether lights cast shadows; default: in pictures if OpenGL draws them, else if a graphics card draws",
    )
    parser.add_argument(
        "--floor",
        choices=FLOORS,
        default="auto",
        help="floor with a grid, which nothing collides with; auto, the default: where nothing sets a background",
    )
    parser.add_argument(
        "--lights",
        choices=LIGHTS,
        default="both",
        help="lights: those of a studio, the model's own, or both, the default",
    )

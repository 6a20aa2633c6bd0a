"""Options shared by several commands."""

import argparse
from importlib import import_module
from typing import TypeAlias

from ravemj.cli.argument_parser import Parser
from ravemj.cli.argument_types import argument, colour, file_name, package, rate, size, vector
from ravemj.formats.shipped import SHIPPED_MODELS
from ravemj.model.look import FLOORS, LIGHTS

Commands: TypeAlias = "argparse._SubParsersAction[Parser]"  # pyright: ignore[reportPrivateUsage]

VIDEOS = ".mp4, .avi, .mpg, .gif, .webp, or a folder for PNG frames"
"""Targets that ``-o`` accepts in commands that write videos."""


def command(commands: Commands, run: str, summary: str, *examples: str) -> argparse.ArgumentParser:
    """Add a command.

    Args:
        commands: The parser of all commands.
        run: Its function as ``module.function``, named like the command. The module of ``ravemj.cli`` is imported only
            when the command runs, not for help.
        summary: Description that begins with a verb in lower case.
        examples: Example command lines.
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
    """Set the shell completion of an argument to a function of ``ravemj.cli.completion``."""

    def completer(prefix: str, **known: object) -> list[str]:
        completion = import_module("ravemj.cli.completion")  # only where a shell asks
        return getattr(completion, function)(prefix, **known)

    argument.completer = completer  # pyright: ignore[reportAttributeAccessIssue] - argcomplete's


def complete_models(argument: argparse.Action) -> None:
    """Set the shell completion of an argument to names and files of models."""
    _complete(argument, "models")


def add_robot(parser: argparse.ArgumentParser, meaning: str) -> None:
    """Add the option for the robot."""
    _complete(parser.add_argument("--robot", metavar="NAME", help=meaning), "robots")


def add_manipulator(parser: argparse.ArgumentParser) -> None:
    """Add the option for the manipulator."""
    argument = parser.add_argument("--manip", metavar="NAME", help="which manipulator; default: the active one")
    _complete(argument, "manipulators")


def add_start(parser: argparse.ArgumentParser, meaning: str) -> None:
    """Add the option for the start values of a motion."""
    parser.add_argument("--from", dest="start", type=file_name, metavar="FILE", help=meaning)


def add_rename(parser: argparse._ActionsContainer) -> None:  # pyright: ignore[reportPrivateUsage]
    """Add the option for the joint names of the real robot."""
    parser.add_argument(
        "--rename",
        type=file_name,
        metavar="FILE",
        help="names of joints of the real robot: an object in JSON or YAML, from the model's names to the robot's",
    )


def add_model(parser: argparse.ArgumentParser) -> None:
    """Add the argument for the model."""
    model = parser.add_argument(
        "model",
        type=file_name,
        metavar="MODEL",
        help="OpenRAVE XML, COLLADA, URDF or MJCF file: an environment, a robot or a kinbody; or a model that comes "
        f"with ravemj: {', '.join(SHIPPED_MODELS)}; or the name of a robot of a package (extra robots)",
    )
    complete_models(model)
    add_urdf_options(parser)
    parser.add_argument("--strict", action="store_true", help="take warnings about the model for errors")


def add_urdf_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for URDF models."""
    parser.add_argument(
        "--download", action="store_true", help="fetch a robot of robot_descriptions or mujoco-menagerie if need be"
    )
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
    """Add the options for size, camera and background of pictures."""
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
    """Add the options for shadows, floor and lights."""
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


def add_robot_motion_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for motions of robot controllers."""
    group = parser.add_argument_group("motions for robots: .yaml, .json and .ros2.csv")
    group.add_argument(
        "--rate",
        type=rate,
        default=100.0,
        metavar="HZ",
        help="points in a second (100); waypoints: one at each waypoint",
    )
    add_rename(group)
    group.add_argument(
        "--acceleration",
        type=vector,
        metavar="A",
        help="acceleration limits, rad/s^2 or m/s^2: one for all joints of the robot or one for each, separated by "
        "commas; default: the model's",
    )

"""The arguments of the commands, with their help."""

import argparse
import difflib
from collections.abc import Iterable, Sequence
from typing import NoReturn, TypeAlias

from ravemj.cli import check, convert, diff, ik, info, pictures, sessions, view
from ravemj.cli.words import colour, port, positive, size, target, vector
from ravemj.formats.shipped import SHIPPED_MODELS
from ravemj.model.comparison import MESH_TOLERANCE, TOLERANCE


class _Parser(argparse.ArgumentParser):
    """Reports a wrong argument in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: error: {message}; see {self.prog} --help\n")

    def parse_known_args(  # pyright: ignore[reportIncompatibleMethodOverride] - its overloads
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Refuse what a command does not know, so that the message names the command."""
        parsed, unknown = super().parse_known_args(args, namespace or argparse.Namespace())
        if unknown:
            self.error(f"unknown: {' '.join(unknown)}{_did_you_mean(unknown[0], self._option_string_actions)}")
        return parsed, unknown

    def _check_value(self, action: argparse.Action, value: object) -> None:
        """Refuse a value that is no choice, with the nearest one."""
        if action.choices is not None and value not in action.choices:
            choices = [str(choice) for choice in action.choices]
            guess = _did_you_mean(str(value), choices)
            raise argparse.ArgumentError(action, f"'{value}' is none of {', '.join(choices)}{guess}")


def _did_you_mean(word: str, known: Iterable[str]) -> str:
    close = difflib.get_close_matches(word, known, 1)
    return f"; did you mean {close[0]}?" if close else ""


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line; ``run`` of its result is the command's function."""
    from ravemj import __version__  # noqa: PLC0415 - ravemj is being imported when this module is

    parser = _Parser(
        prog="ravemj",
        description="OpenRAVE's models, tutorial, Python API and GUI, on MuJoCo.",
        epilog="ravemj COMMAND --help explains a command, with examples.",
    )
    parser.add_argument("--version", action="version", version=f"ravemj {__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    _add_view(commands)
    _add_play(commands)
    _add_render(commands)
    _add_convert(commands)
    _add_check(commands)
    _add_diff(commands)
    _add_info(commands)
    _add_ik(commands)
    _add_run(commands)
    _add_shell(commands)
    _add_alias(commands)
    _add_doctor(commands)
    return parser


Commands: TypeAlias = "argparse._SubParsersAction[_Parser]"  # pyright: ignore[reportPrivateUsage]


def _command(commands: Commands, name: str, summary: str, *examples: str) -> argparse.ArgumentParser:
    return commands.add_parser(
        name,
        help=summary,
        description=f"{summary[0].upper()}{summary[1:]}.",
        epilog="examples:\n" + "\n".join(f"  {example}" for example in examples),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def _add_model(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "model",
        metavar="MODEL",
        help="OpenRAVE XML or COLLADA file: an environment, a robot or a kinbody; or a model that comes with ravemj: "
        f"{', '.join(SHIPPED_MODELS)}",
    )
    parser.add_argument("--strict", action="store_true", help="take warnings about the model for errors")


def _add_picture_options(parser: argparse.ArgumentParser, size_help: str) -> None:
    parser.add_argument("--size", type=size, default=(640, 480), metavar="WxH", help=size_help)
    parser.add_argument(
        "--camera",
        metavar="FILE",
        help="camera as a 4x4 matrix in JSON or text: z forward, y down; default: all in view",
    )
    parser.add_argument(
        "--background",
        type=colour,
        metavar="COLOUR",
        help="background: red, green and blue from 0 to 1, as 0.8,0.85,0.9, or a CSS name or #rrggbb; default: the "
        "model's, or white",
    )


def _add_view(commands: Commands) -> None:
    parser = _command(
        commands,
        "view",
        "show a model in a window, or as a page in a browser, and move it with the mouse",
        "ravemj view pendulum",
        "ravemj view --web workshop            # prints the address of the page; Ctrl-C ends it",
        "ravemj view --web --port 8080 robot.xml",
    )
    _add_model(parser)
    parser.add_argument("--web", action="store_true", help="a page, also where there is a display for a window")
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="H",
        help="interface that serves the page (127.0.0.1, which only browsers of this machine reach)",
    )
    parser.add_argument("--port", type=port, default=0, metavar="P", help="port of the page; default: one that is free")
    parser.set_defaults(run=view.view)


def _add_play(commands: Commands) -> None:
    parser = _command(
        commands,
        "play",
        "play a motion of a robot: in a window, or into a video",
        "ravemj play pendulum",
        "ravemj play env.xml -o pendulum.mp4 --camera camera.json",
        'ravemj play pendulum -o frames/ --to "1.57,-1.57" --duration 2',
        "ravemj play env.xml -o swing.gif --trajectory swing.csv --fps 25",
    )
    _add_model(parser)
    parser.add_argument(
        "-o",
        "--output",
        type=target,
        metavar="FILE",
        help=".mp4, .gif, .webp, or a folder for PNG frames; without a display: MODEL.mp4",
    )
    goal = parser.add_mutually_exclusive_group()
    goal.add_argument(
        "--to",
        type=vector,
        metavar="Q",
        help="joint values at the end, rad or m, separated by commas; default: the first joint to pi, the others to 0",
    )
    goal.add_argument(
        "--trajectory",
        metavar="FILE",
        help="motion as .csv (header time,<joint>,…; seconds, rad or m) or .npz (arrays time and values)",
    )
    parser.add_argument(
        "--duration", type=positive, metavar="S", help="seconds the motion takes; default: 1, or as the file says"
    )
    parser.add_argument("--fps", type=positive, default=30.0, metavar="N", help="frames in a second (30)")
    _add_picture_options(parser, "size of the video (640x480); windows have a size of their own")
    parser.set_defaults(run=pictures.play)


def _add_render(commands: Commands) -> None:
    parser = _command(
        commands,
        "render",
        "draw a picture of a model",
        "ravemj render workshop -o workshop.png",
        'ravemj render pendulum -o pendulum.png --q "0.785,0.785" --size 1280x720',
    )
    _add_model(parser)
    parser.add_argument("-o", "--output", type=target, required=True, metavar="FILE", help=".png, .jpg or .webp")
    parser.add_argument(
        "--q", type=vector, metavar="Q", help="joint values of the first robot, rad or m, separated by commas"
    )
    _add_picture_options(parser, "size of the picture (640x480)")
    parser.set_defaults(run=pictures.render)


def _add_convert(commands: Commands) -> None:
    parser = _command(
        commands,
        "convert",
        "translate a model to MJCF, MuJoCo's format, to COLLADA, OpenRAVE XML or OpenRAVE's JSON",
        "ravemj convert robot.xml -o robot/      # robot/robot.xml, and assets/ for meshes",
        "ravemj convert puma560 -o puma.mjcf.xml --actuators position",
        "ravemj convert puma560 -o puma560.dae",
        "ravemj convert scara -o scara.robot.xml      # OpenRAVE XML, and meshes/ for meshes",
        "ravemj convert pendulum | less",
    )
    _add_model(parser)
    parser.add_argument(
        "-o",
        "--output",
        type=target,
        default=convert.TO_STANDARD_OUTPUT,
        metavar="TARGET",
        help="a folder (no suffix, or a final /), or the MJCF file itself, with meshes in assets/ beside it; "
        "default: standard output, for models without meshes",
    )
    parser.add_argument(
        "--format",
        choices=["mjcf", "collada", "openrave", "json"],
        help="what to write; default: collada for .dae and .zae, json for .json, openrave for .robot.xml, "
        ".kinbody.xml and .env.xml, else mjcf",
    )
    parser.add_argument(
        "--meshes",
        choices=["stl", "obj"],
        default="stl",
        help="files of the meshes of OpenRAVE XML, in meshes/ beside it (stl)",
    )
    parser.add_argument(
        "--base",
        choices=["fixed", "openrave"],
        default="fixed",
        help="what holds the bodies: fixed hangs all on the world; openrave lets those without a static link fall",
    )
    parser.add_argument(
        "--actuators", choices=["position", "velocity", "torque"], help="give each DOF an actuator; default: none"
    )
    parser.add_argument(
        "--decompose",
        action="store_true",
        help='let meshes collide as several convex parts, not as one hull; needs pip install "ravemj[decompose]"',
    )
    parser.set_defaults(run=convert.convert)


def _add_check(commands: Commands) -> None:
    parser = _command(
        commands,
        "check",
        "find what is wrong in models, and what OpenRAVE passes over in silence",
        "ravemj check env.xml",
        "ravemj check --strict models/*.xml",
        "ravemj check --json robot.xml      # a list of file, line, code, severity, message, hint, included_from",
    )
    parser.add_argument("models", nargs="+", metavar="FILE", help="OpenRAVE XML or COLLADA files")
    parser.add_argument("--strict", action="store_true", help="exit with 1 for warnings, too")
    parser.add_argument("--json", action="store_true", help="print the findings as JSON, each place by itself")
    parser.set_defaults(run=check.check_models)


def _add_diff(commands: Commands) -> None:
    parser = _command(
        commands,
        "diff",
        "compare two models by their numbers; exit with 1 where they differ",
        "ravemj diff puma560 arm.xml",
        "ravemj diff old.robot.xml new.robot.xml --json      # a list of part, quantity, first, second, difference",
    )
    for name in ("first", "second"):
        parser.add_argument(name, metavar=name.upper(), help="OpenRAVE XML or COLLADA file")
    parser.add_argument(
        "--tolerance",
        type=positive,
        default=TOLERANCE,
        metavar="T",
        help=f"largest difference of two numbers that counts as none ({TOLERANCE:g}); corners of meshes have "
        f"{MESH_TOLERANCE:g}",
    )
    parser.add_argument("--json", action="store_true", help="print the differences as JSON")
    parser.set_defaults(run=diff.diff)


def _add_info(commands: Commands) -> None:
    parser = _command(
        commands,
        "info",
        "show the links, joints, manipulators and sensors of a model",
        "ravemj info panda",
        "ravemj info panda --json > panda.json",
    )
    _add_model(parser)
    parser.add_argument("--json", action="store_true", help="print all numbers as JSON")
    parser.set_defaults(run=info.info)


def _add_ik(commands: Commands) -> None:
    parser = _command(
        commands,
        "ik",
        "find the joint values that take the tool of an arm to a goal",
        'ravemj ik puma560 --to "0.3,0.3,0.9,0.7071,0,0.7071,0"',
        'ravemj ik puma560 --to "0.3,0.3,0.9,0.7071,0,0.7071,0" -o arms.png',
        'ravemj ik scara --to "0.3,0.2" --type TranslationXY2D --json',
        "ravemj ik panda --describe",
    )
    _add_model(parser)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument(
        "--to",
        type=vector,
        metavar="GOAL",
        help="the goal in the world: x,y,z, or x,y,z,qw,qx,qy,qz, or the values of another type of goal; m and rad",
    )
    what.add_argument("--describe", action="store_true", help="say how the arm is solved, and how well that was proved")
    parser.add_argument(
        "--type",
        choices=ik.TYPE_NAMES,
        metavar="TYPE",
        help="type of goal, as in OpenRAVE: Translation3D for three values, else Transform6D; "
        f"or {', '.join(name for name in ik.TYPE_NAMES if name not in {'Transform6D', 'Translation3D'})}",
    )
    parser.add_argument("--manip", metavar="NAME", help="which manipulator; default: the active one")
    parser.add_argument(
        "--from",
        dest="start",
        metavar="FILE",
        help="joint values to start from, as JSON: a list, or an object with names of joints; default: the model's",
    )
    parser.add_argument("--json", action="store_true", help="print all solutions as JSON, not the nearest ones alone")
    parser.add_argument(
        "-o", "--output", type=target, metavar="FILE", help="picture with an arm at each solution; .png, .jpg or .webp"
    )
    parser.add_argument("--size", type=size, default=(640, 480), metavar="WxH", help="size of the picture (640x480)")
    parser.set_defaults(run=ik.ik)


def _add_run(commands: Commands) -> None:
    parser = _command(
        commands,
        "run",
        "run a script that imports openravepy, on ravemj",
        "ravemj run myscript.py",
        "ravemj run -i myscript.py      # stays in IPython",
        "ravemj run myscript.py --robot arm.xml",
        "ravemj run --py2 oldscript.py",
    )
    parser.add_argument("-i", "--interactive", action="store_true", help="stay in IPython when the script ends")
    parser.add_argument(
        "--py2", action="store_true", help="the script, and the modules beside it, are written for Python 2"
    )
    parser.add_argument("script", metavar="SCRIPT", help="Python file")
    parser.add_argument("arguments", nargs=argparse.REMAINDER, metavar="...", help="arguments of the script")
    parser.set_defaults(run=sessions.run)


def _add_shell(commands: Commands) -> None:
    parser = _command(commands, "shell", "open IPython with env, robot and viewer of a model", "ravemj shell puma560")
    _add_model(parser)
    parser.set_defaults(run=sessions.shell)


def _add_alias(commands: Commands) -> None:
    parser = _command(
        commands,
        "alias",
        "let scripts that import openravepy run on ravemj by themselves",
        "ravemj alias --install      # then: ipython -i myscript.py, ./myscript.py",
        "ravemj alias --remove",
    )
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument(
        "--install", action="store_true", help="put a package openravepy, which forwards to ravemj, into this Python"
    )
    action.add_argument("--remove", action="store_true", help="take it out again")
    parser.set_defaults(run=sessions.alias)


def _add_doctor(commands: Commands) -> None:
    parser = _command(
        commands, "doctor", "say what can draw pictures here, and how to install what cannot", "ravemj doctor"
    )
    parser.set_defaults(run=pictures.doctor)

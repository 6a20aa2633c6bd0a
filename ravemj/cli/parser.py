"""The arguments of the commands, with their help."""

import argparse

from ravemj.cli.argument_parser import Parser
from ravemj.cli.argument_types import TO_STANDARD_OUTPUT, file_name, port, positive, vector
from ravemj.cli.arm_parsers import add_grasp, add_ik, add_plan
from ravemj.cli.mjcf_options import add_mjcf_options
from ravemj.cli.shared_options import (
    VIDEOS,
    Commands,
    add_look_options,
    add_model,
    add_picture_options,
    add_rename,
    add_robot,
    add_robot_motion_options,
    add_start,
    add_urdf_options,
    command,
    complete_models,
)
from ravemj.cli.sweep_parser import add_sweep
from ravemj.model.comparison import MESH_TOLERANCE, TOLERANCE


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line; parsed arguments have the command's function as ``run``."""
    from ravemj import __version__  # noqa: PLC0415 - ravemj is being imported when this module is

    parser = Parser(
        prog="ravemj",
        description="OpenRAVE's models, tutorial, Python API and GUI, on MuJoCo.",
        epilog="ravemj COMMAND --help explains a command, with examples.",
    )
    parser.add_argument("--version", action="version", version=f"ravemj {__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    _add_view(commands)
    _add_mirror(commands)
    _add_play(commands)
    _add_render(commands)
    _add_convert(commands)
    _add_check(commands)
    _add_diff(commands)
    _add_info(commands)
    add_ik(commands)
    add_plan(commands)
    add_grasp(commands)
    _add_learn(commands)
    add_sweep(commands)
    _add_run(commands)
    _add_shell(commands)
    _add_alias(commands)
    _add_doctor(commands)
    _add_completion(commands)
    return parser


def _add_view(commands: Commands) -> None:
    parser = command(
        commands,
        "view.view",
        "show a model in a window, or as a page in a browser, and move it with the mouse",
        "ravemj view pendulum",
        "ravemj view table.env.xml ur5.urdf    # both together",
        "ravemj view --web workshop            # prints the address of the page; Ctrl-C ends it",
        "ravemj view --web --port 8080 robot.xml",
        "ravemj view --watch robot.xml         # shows it anew whenever a file of it is saved",
        "ravemj view --physics pendulum        # right drags pull it, Space stops time",
    )
    add_model(parser)
    parser.add_argument(
        "others", nargs="*", type=file_name, metavar="MODEL", help="further models, shown together with the first one"
    )
    add_robot(parser, "robot to look at, selected, so that the sliders turn its joints; default: everything in view")
    add_look_options(parser)
    parser.add_argument(
        "--watch",
        action="store_true",
        help="read the model again when one of its files is saved; camera, joint values and selection stay",
    )
    parser.add_argument(
        "--physics",
        action="store_true",
        help="physics from the start; what is not static falls, but robots keep their bases where nothing is static",
    )
    _add_page_options(parser)


def _add_page_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--web", action="store_true", help="a page, also where there is a display for a window")
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="H",
        help="interface that serves the page (127.0.0.1, which only browsers of this machine reach)",
    )
    parser.add_argument("--port", type=port, default=0, metavar="P", help="port of the page; default: one that is free")
    parser.add_argument(
        "--token",
        metavar="T",
        help="secret in the address of the page, 8 letters or more; with --port, an open page survives a restart",
    )
    parser.add_argument(
        "--embed",
        action="append",
        default=[],
        metavar="ORIGIN",
        help="let pages of an origin, such as https://lab.example, show the page in a frame, as those of this machine "
        "may; may be repeated, and RAVEMJ_EMBED adds others",
    )


def _add_mirror(commands: Commands) -> None:
    parser = command(
        commands,
        "mirror.mirror",
        "show a robot as its real one is, from rosbridge or from lines of text; nothing is sent to it",
        "ravemj mirror robot.urdf --rosbridge ws://127.0.0.1:9090",
        "ravemj mirror pendulum --csv swing.csv        # or -: lines of joint=value, or names and then rows of values",
        "ravemj mirror robot.urdf --rosbridge ws://127.0.0.1:9090 --save-state now.json    # for --from of plan and ik",
        "ravemj mirror robot.urdf --rosbridge ws://127.0.0.1:9090 --motion plan.csv        # a ghost moves as planned",
    )
    add_model(parser)
    add_robot(parser, "robot that is shown; default: the first with joints")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--rosbridge", metavar="URL", help="server of rosbridge, ws://HOST:PORT")
    source.add_argument(
        "--csv",
        type=file_name,
        metavar="FILE",
        help="lines of joint=value, or a row of names and then rows of values: a file or device; - is standard input",
    )
    parser.add_argument(
        "--topic", default="/joint_states", metavar="T", help="topic of sensor_msgs/JointState (/joint_states)"
    )
    add_rename(parser)
    parser.add_argument(
        "--record", type=file_name, metavar="FILE", help="write what came as a motion, .csv or .npz, at the end"
    )
    parser.add_argument(
        "--save-state", type=file_name, metavar="FILE", help="write the last state as JSON, for --from, at the end"
    )
    parser.add_argument(
        "--motion",
        dest="trajectory",
        type=file_name,
        metavar="FILE",
        help="motion that a transparent copy of the robot plays, in a form that play --trajectory takes",
    )
    add_look_options(parser)
    _add_page_options(parser)
    parser.set_defaults(physics=False)


def _add_play(commands: Commands) -> None:
    parser = command(
        commands,
        "pictures.play",
        "play a motion of a robot: in a window, or into a video or a page",
        "ravemj play pendulum",
        "ravemj play pendulum -o swing.html    # a page that plays, turns and zooms by itself",
        "ravemj play env.xml -o pendulum.mp4 --camera camera.json",
        'ravemj play pendulum -o frames/ --to "1.57,-1.57" --duration 2',
        "ravemj play env.xml -o swing.gif --trajectory swing.csv --fps 25",
        'ravemj play workshop --robot scara --to "1,-2,0.1,0"',
        "ravemj play robot.urdf --trajectory plan.csv -o plan.json --from measured.json",
    )
    add_model(parser)
    add_robot(parser, "robot that moves; default: the one whose joints a table names, else the first with joints")
    parser.add_argument(
        "-o",
        "--output",
        type=file_name,
        metavar="FILE",
        help=f"page as .html; video as {VIDEOS}; or motion for a robot as .yaml, .json or .ros2.csv; without a "
        "display: MODEL.mp4",
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
        type=file_name,
        metavar="FILE",
        help="motion as .csv (header time,<joint>,…; seconds, rad or m), as .npz (arrays time, values and joints), as "
        "ROS's JointTrajectory (.yaml, .json, .ros2.csv), or as OpenRAVE's file of a trajectory",
    )
    parser.add_argument(
        "--duration", type=positive, metavar="S", help="seconds the motion takes; default: 1, or as the file says"
    )
    parser.add_argument("--fps", type=positive, default=30.0, metavar="N", help="frames in a second (30)")
    add_picture_options(parser, "size of the video (640x480); windows have a size of their own")
    add_robot_motion_options(parser)
    add_start(parser, "measured joint values where a motion for a robot has to begin, to 0.01 rad or m, as JSON")
    parser.add_argument(
        "--moving", action="store_true", help="let a motion for a robot start or end in motion; a table keeps its times"
    )


def _add_render(commands: Commands) -> None:
    parser = command(
        commands,
        "pictures.render",
        "draw a picture of a model, or write a page whose sliders move its joints",
        "ravemj render workshop -o workshop.png",
        "ravemj render panda -o panda.html      # a slider for each joint, in any browser",
        'ravemj render pendulum -o pendulum.png --q "0.785,0.785" --size 1280x720',
    )
    add_model(parser)
    add_robot(parser, "robot to look at, which --q moves; default: everything in view, and the first with joints moves")
    parser.add_argument(
        "-o", "--output", type=file_name, required=True, metavar="FILE", help=".png, .jpg, .webp or .html"
    )
    parser.add_argument(
        "--q", type=vector, metavar="Q", help="joint values of the robot, rad or m, separated by commas"
    )
    add_picture_options(parser, "size of the picture (640x480)")


def _add_convert(commands: Commands) -> None:
    parser = command(
        commands,
        "convert.convert",
        "translate a model to MJCF, MuJoCo's format, to COLLADA, OpenRAVE XML, URDF or OpenRAVE's JSON",
        "ravemj convert robot.xml -o robot/      # robot/robot.xml, and assets/ for meshes",
        "ravemj convert puma560 -o puma.mjcf.xml --actuators position",
        "ravemj convert robot.urdf -o robot/ --actuators position --base free --sensors",
        "ravemj convert puma560 -o puma560.dae",
        "ravemj convert scara -o scara.robot.xml      # OpenRAVE XML, and meshes/ for meshes",
        "ravemj convert pendulum | less",
    )
    add_model(parser)
    parser.add_argument(
        "-o",
        "--output",
        type=file_name,
        default=TO_STANDARD_OUTPUT,
        metavar="TARGET",
        help="a folder (no suffix, or a final /), or the MJCF file itself, with meshes in assets/ beside it; "
        "default: standard output, for models without meshes",
    )
    parser.add_argument(
        "--format",
        choices=["mjcf", "collada", "openrave", "urdf", "json"],
        help="what to write; default: collada for .dae and .zae, json for .json, urdf for .urdf, with an SRDF beside, "
        "openrave for .robot.xml, .kinbody.xml and .env.xml, else mjcf",
    )
    parser.add_argument(
        "--meshes",
        choices=["stl", "obj"],
        default="stl",
        help="files of the meshes of OpenRAVE XML, in meshes/ beside it (stl)",
    )
    add_mjcf_options(parser)


def _add_check(commands: Commands) -> None:
    parser = command(
        commands,
        "check.check",
        "find what is wrong in models, what OpenRAVE passes over in silence, and files outside of the model's folder",
        "ravemj check env.xml",
        "ravemj check --strict models/*.xml",
        "ravemj check robot.urdf --sim          # can it be simulated, and what does it miss?",
        "ravemj check robot.urdf --self --write-srdf robot.srdf",
        "ravemj check --json robot.xml      # a list of file, line, code, severity, message, hint, included_from",
    )
    complete_models(
        parser.add_argument(
            "models", nargs="+", type=file_name, metavar="FILE", help="OpenRAVE XML, COLLADA, URDF or MJCF files"
        )
    )
    add_urdf_options(parser)
    parser.add_argument(
        "--self",
        action="store_true",
        help="list instead the pairs of links that touch where a robot starts, or in more than 95 %% of 1000 random "
        "configurations",
    )
    parser.add_argument(
        "--write-srdf",
        type=file_name,
        metavar="FILE",
        help="write these as disabled pairs: an SRDF, or a copy of the robot's own with them added",
    )
    parser.add_argument(
        "--sim",
        action="store_true",
        help="translate the models as convert does, with position servos unless --actuators says otherwise, let them "
        "hold, step and fall, and say what they miss; exit with 1 if they miss anything",
    )
    add_mjcf_options(parser)
    parser.add_argument("--strict", action="store_true", help="exit with 1 for warnings, too")
    parser.add_argument("--json", action="store_true", help="print the findings as JSON, each place by itself")


def _add_diff(commands: Commands) -> None:
    parser = command(
        commands,
        "diff.diff",
        "compare two models by their numbers; exit with 1 where they differ, with 2 where one cannot be read",
        "ravemj diff puma560 arm.xml",
        "ravemj diff old.robot.xml new.robot.xml --json      # a list of part, quantity, first, second, difference",
    )
    for name in ("first", "second"):
        complete_models(
            parser.add_argument(
                name, type=file_name, metavar=name.upper(), help="OpenRAVE XML, COLLADA, URDF or MJCF file"
            )
        )
    parser.add_argument(
        "--tolerance",
        type=positive,
        default=TOLERANCE,
        metavar="T",
        help=f"largest difference of two numbers that counts as none ({TOLERANCE:g}); corners of meshes have "
        f"{MESH_TOLERANCE:g}",
    )
    parser.add_argument("--json", action="store_true", help="print the differences as JSON")


def _add_info(commands: Commands) -> None:
    parser = command(
        commands,
        "info.info",
        "show the links, joints, manipulators and sensors of a model",
        "ravemj info panda",
        "ravemj info panda --json > panda.json",
        "ravemj info workshop --robot scara",
    )
    add_model(parser)
    add_robot(parser, "robot to show; default: all bodies")
    parser.add_argument("--json", action="store_true", help="print all numbers as JSON")


def _add_learn(commands: Commands) -> None:
    parser = command(
        commands,
        "learn.learn",
        "learn by exercises that check themselves",
        "ravemj learn                             # lists exercises, and which are solved",
        "ravemj learn start robotics              # copies them into a folder; files that are there stay",
        "ravemj learn start robotics --again fk-1 # as it was at first; your own file is kept beside it",
        "ravemj learn check fk-1                  # in the folder; without a name the next one",
        "ravemj learn check --watch               # the next one, whenever a file is saved; Ctrl-C ends it",
        "ravemj learn hint fk-1 --number 2",
        "ravemj learn show fk-1 -o answer.png     # your answer beside the right one",
        "ravemj learn grade students/* --csv      # runs the code of students; it is no sandbox",
    )
    actions = ("list", "start", "check", "hint", "show", "grade")
    parser.add_argument(
        "action", nargs="?", choices=actions, default="list", help=f"{', '.join(actions)}; default: list"
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="exercises; with start and grade folders")
    parser.add_argument("--folder", type=file_name, default=".", metavar="FOLDER", help="folder of exercises (.)")
    parser.add_argument("--course", type=file_name, metavar="FOLDER", help="another course; default: ravemj's own")
    parser.add_argument("--again", metavar="NAME", help="with start: write one exercise again, and keep your file")
    parser.add_argument("--notebooks", action="store_true", help="with start: write the lessons as notebooks")
    parser.add_argument("--watch", action="store_true", help="with check: check again at each save")
    parser.add_argument("--number", type=int, choices=(1, 2, 3), default=1, help="with hint: number of hints (1)")
    parser.add_argument("-o", "--output", type=file_name, metavar="FILE", help="with show: picture, or page as .html")
    parser.add_argument("--web", action="store_true", help="with show: write a page, and open it in the browser")
    parser.add_argument("--csv", action="store_true", help="with grade: print CSV")
    parser.add_argument("--json", action="store_true", help="with grade: print JSON")


def _add_run(commands: Commands) -> None:
    parser = command(
        commands,
        "sessions.run",
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
    parser.add_argument("script", type=file_name, metavar="SCRIPT", help="Python file")
    rest = parser.add_argument("arguments", nargs=argparse.REMAINDER, metavar="...", help="arguments of the script")
    rest.required = False  # Python 3.11 would name it beside a missing SCRIPT


def _add_shell(commands: Commands) -> None:
    parser = command(
        commands, "sessions.shell", "open IPython with env, robot and viewer of a model", "ravemj shell puma560"
    )
    add_model(parser)


def _add_alias(commands: Commands) -> None:
    parser = command(
        commands,
        "sessions.alias",
        "let scripts that import openravepy run on ravemj by themselves",
        "ravemj alias --install      # then: ipython -i myscript.py, ./myscript.py",
        "ravemj alias --remove",
    )
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument(
        "--install", action="store_true", help="put a package openravepy, which forwards to ravemj, into this Python"
    )
    action.add_argument("--remove", action="store_true", help="take it out again")


def _add_doctor(commands: Commands) -> None:
    command(
        commands, "pictures.doctor", "say what can draw pictures here, and how to install what cannot", "ravemj doctor"
    )


def _add_completion(commands: Commands) -> None:
    parser = command(
        commands,
        "completion.completion",
        "print what lets a shell complete commands, options and models",
        "ravemj completion bash > ~/.local/share/bash-completion/completions/ravemj",
        "ravemj completion zsh > ~/.zfunc/_ravemj      # with fpath+=~/.zfunc before compinit in ~/.zshrc",
        "ravemj completion fish > ~/.config/fish/completions/ravemj.fish",
    )
    parser.add_argument("shell", choices=["bash", "zsh", "fish"], metavar="SHELL", help="bash, zsh or fish")

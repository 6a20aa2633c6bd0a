"""Options of commands that translate models to MJCF."""

import argparse

from ravemj.cli.argument_types import file_name, positive


def add_mjcf_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a translation to MJCF."""
    group = parser.add_argument_group("MJCF for simulations")
    group.add_argument(
        "--base",
        choices=["fixed", "free", "openrave"],
        default="fixed",
        help="what holds the bodies: fixed hangs all on the world; openrave lets those without a static link fall; "
        "free lets robots fall, too, if they have one",
    )
    group.add_argument(
        "--actuators",
        choices=["position", "velocity", "torque"],
        help="give each DOF an actuator, with gains from its inertia, load and effort; default: none",
    )
    group.add_argument(
        "--gains",
        type=file_name,
        metavar="FILE",
        help="gains in place of the computed ones: lines 'joint, kp, kv'; joint may be a pattern such as arm_*",
    )
    group.add_argument(
        "--timestep", type=positive, metavar="S", help="time step [s], for which gains are made, too (0.002)"
    )
    group.add_argument(
        "--self-collision", choices=["on", "off"], default="on", help="whether links of one robot collide (on)"
    )
    group.add_argument(
        "--exclude",
        choices=["touching", "none"],
        default="touching",
        help="touching excludes pairs of links that are adjacent, that an SRDF names, or that touch at the start "
        "(default); none excludes none",
    )
    group.add_argument(
        "--decompose",
        action="store_true",
        help='let meshes collide as several convex parts, not as one hull; needs pip install "ravemj[decompose]"',
    )
    group.add_argument(
        "--hull-vertices", type=_corners, default=0, metavar="N", help="most vertices of a collision hull, from 4 on"
    )
    group.add_argument(
        "--merge-fixed",
        action="store_true",
        help="let links that cannot move become shapes and sites of the links that carry them",
    )
    group.add_argument(
        "--sensors",
        action="store_true",
        help="add sensors of joint positions and velocities, an IMU at the base, and the sensors of the model",
    )
    group.add_argument(
        "--append",
        type=file_name,
        metavar="FILE",
        help="an MJCF fragment: <mujoco> with sections whose elements are added",
    )


def _corners(text: str) -> int:
    if not (text.isascii() and text.isdecimal() and 4 <= int(text) < 10**6):
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from 4 on")
    return int(text)

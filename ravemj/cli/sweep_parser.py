"""Arguments of the command ``sweep``."""

import argparse

from ravemj.cli.argument_types import file_name, names, positive, seed, size
from ravemj.cli.shared_options import Commands, add_manipulator, add_model, add_robot, command


def add_sweep(commands: Commands) -> None:
    """Add ``ravemj sweep``."""
    parser = command(
        commands,
        "sweep.sweep",
        "compute something for many items in many processes, into a folder; the same command goes on where it ended",
        "ravemj sweep panda collides --count 20000 --seed 3 --jobs 2 -o labels",
        "ravemj sweep puma560 ik --items goals.npy --collisions -o ik",
        "ravemj sweep workshop plan --robot panda --manip panda_arm --count 3 -o motions",
        "ravemj sweep panda pictures --count 3 --size 320x240 -o pictures",
        "ravemj sweep panda clearance:measure --count 2000 -o gaps    # measure(env, items, random) of clearance.py",
    )
    add_model(parser)
    parser.add_argument(
        "what",
        metavar="WHAT",
        help="collides, poses or pictures of joint values, ik of tool poses, plan of starts and goals; or "
        "MODULE:FUNCTION, a function of an environment, items and a random generator that returns a dict of arrays",
    )
    items = parser.add_mutually_exclusive_group()
    items.add_argument("--items", type=file_name, metavar="FILE", help="items: .npy, .npz or .csv, one in each row")
    items.add_argument(
        "--count", type=count, metavar="N", help="number of items that are drawn within the joint limits"
    )
    parser.add_argument("-o", "--output", type=file_name, metavar="FOLDER", required=True, help="folder of the results")
    add_robot(parser, "robot that the items are of; default: the first one")
    add_manipulator(parser)
    parser.add_argument("--seed", type=seed, metavar="N", help="seed of random numbers (0)")
    parser.add_argument("--type", metavar="TYPE", help="type of the goals of ik, as Translation3D (Transform6D)")
    parser.add_argument("--collisions", action="store_true", help="ik: leave out solutions in collision")
    parser.add_argument("--iterations", type=count, metavar="N", help="plan: most iterations of a search (4000)")
    parser.add_argument("--camera", type=file_name, metavar="FILE", help="pictures: T_world_camera, as for render")
    parser.add_argument("--size", type=size, metavar="WxH", help="pictures: size (640x480)")
    parser.add_argument(
        "--outputs", type=names, metavar="NAMES", help="pictures: some of rgb, depth and links, with commas between"
    )
    workers = parser.add_mutually_exclusive_group()
    workers.add_argument("--jobs", type=count, default=1, metavar="N", help="number of processes (1)")
    workers.add_argument(
        "--executor",
        metavar="MODULE:FUNCTION",
        help="function that returns a concurrent.futures.Executor, whose processes see the folder",
    )
    parser.add_argument(
        "--ahead", type=count, default=256, metavar="N", help="shards that --executor has at a time (256)"
    )
    parser.add_argument("--shard", type=count, metavar="N", help="items in a file; default: as many as take 20 s")
    parser.add_argument("--retries", type=count_from_0, default=1, metavar="N", help="tries more if a process dies (1)")
    parser.add_argument("--timeout", type=positive, metavar="S", help="time limit of a shard, with processes")
    parser.add_argument("--check", action="store_true", help="read all files, and compute damaged ones anew")
    parser.add_argument("--json", action="store_true", help="print a line of JSON for each shard")


def count(text: str) -> int:
    """Parse a whole number, at least 1, such as 1000 or 1e6."""
    return _whole(text, 1)


def count_from_0(text: str) -> int:
    """Parse a whole number, at least 0."""
    return _whole(text, 0)


def _whole(text: str, least: int) -> int:
    try:
        number = float(text)
        if number == int(number) >= least:
            return int(number)
    except (ValueError, OverflowError):
        pass
    raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from {least} on")

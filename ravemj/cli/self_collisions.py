"""Link pairs that collide in nearly all configurations: ``check --self`` lists, ``--write-srdf`` writes them."""

import argparse
import copy
import math
import os
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

import numpy as np

from ravemj.cli.models import load_model
from ravemj.core.graphs import Pair
from ravemj.core.output import check_file, new_file
from ravemj.core.transforms import Floats
from ravemj.engine.collision.queries import touching_pairs
from ravemj.model.scene import KinBody
from ravemj.rave import Robot

SAMPLES = 1000
"""Number of random configurations within the limits."""

ALWAYS = 0.95
"""Fraction of configurations above which a pair counts as always colliding."""


class Touching(NamedTuple):
    """A link pair with spurious collisions: at the start, or in almost all configurations.

    Attributes:
        links: Names of the links.
        at_start: Whether they collide in the initial configuration.
        share: Fraction of the random configurations with a collision.
    """

    links: tuple[str, str]
    at_start: bool
    share: float

    @property
    def reason(self) -> str:
        """Value of the attribute ``reason`` of a disabled pair in MoveIt's SRDF files."""
        return "Always" if self.share > ALWAYS else "Default"


def find(robot: Robot, samples: int = SAMPLES) -> list[Touching]:
    """Return the non-adjacent link pairs that collide at the start or in more than 95 % of configurations.

    The configurations are random within the limits, or [-pi, pi] for circular joints, with a fixed seed.
    """
    names = [link.GetName() for link in robot.GetLinks()]
    at_start = _touching(robot)
    counts: Counter[Pair] = Counter()
    with robot.GetEnv(), robot.CreateRobotStateSaver():
        for values in _configurations(robot.simulation_state.scene, samples):
            robot.SetDOFValues(values)
            counts.update(_touching(robot))
    always = {pair for pair, count in counts.items() if count > ALWAYS * samples}
    return [
        Touching((names[first], names[second]), (first, second) in at_start, counts[first, second] / samples)
        for first, second in sorted(at_start | always)
    ]


def _touching(robot: Robot) -> frozenset[Pair]:
    return touching_pairs(robot.GetEnv().GetCollisionChecker().world(), robot.simulation_state)


def _configurations(body: KinBody, count: int) -> Floats:
    """Return random joint values within the limits, shape (count, dof)."""
    reach = [(-math.pi, math.pi) if axis.circular else (axis.lower, axis.upper) for axis in body.dof_axes]
    lower, upper = np.array(reach).reshape(-1, 2).T
    return np.random.default_rng(0).uniform(lower, upper, (count, len(reach)))


def check(options: argparse.Namespace, model: str) -> int:
    """Print the pairs of each robot of a model, and write them if requested; return their number."""
    if options.write_srdf is not None:
        check_file(options.write_srdf)
    chosen = copy.copy(options)
    chosen.model, chosen.strict = model, False
    env = load_model(chosen)
    total = 0
    for robot in env.GetRobots():
        pairs = find(robot)
        total += len(pairs)
        for pair in pairs:
            where = ["at the start"] if pair.at_start else []
            where.append(f"in {100 * pair.share:.0f} % of {SAMPLES} random configurations")
            print(f"{model}: links '{pair.links[0]}' and '{pair.links[1]}' touch {', and '.join(where)}")
        if not pairs:
            print(f"{model}: no links of '{robot.GetName()}' touch at the start or almost always")
        if options.write_srdf is not None:
            beside = next((file for file in env.files if file.lower().endswith(".srdf")), None)
            _write(options.write_srdf, robot.GetName(), pairs, beside)
            print(f"wrote {options.write_srdf}, with {len(pairs)} disabled pairs")
            break
    return total


def _write(path: str, robot: str, pairs: Sequence[Touching], beside: str | None) -> None:
    """Write an SRDF that disables collisions of pairs: a copy of the one at ``beside`` with additions, or a new one."""
    lines = [
        f"  <disable_collisions link1={quoteattr(pair.links[0])} link2={quoteattr(pair.links[1])} "
        f'reason="{pair.reason}"/>\n'
        for pair in pairs
    ]
    head, tail = f'<?xml version="1.0"?>\n<robot name={quoteattr(robot)}>\n', "</robot>\n"
    if beside is not None and os.path.isfile(beside):
        head, end, tail = Path(beside).read_text(encoding="utf-8").rpartition("</robot>")
        tail = end + tail
    with new_file(path) as place:
        place.write_text(f"{head}{''.join(lines)}{tail}", encoding="utf-8")

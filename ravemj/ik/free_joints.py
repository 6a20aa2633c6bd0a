"""Which joints of a redundant arm stay free by default, and how finely they are sampled: OpenRAVE's rules."""

from collections.abc import Sequence

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.solver import ANGLE_STEP, SLIDE_STEP

_ALONG = 1e-6
_MOST = 4096
"""Samples of more than two joints, about; with OpenRAVE's steps they would fill the memory."""


def default_free(chain: Chain, name: str, dof: int) -> list[int]:
    """Return the joints that are left free where an arm has more than a type of goal fixes.

    They go from the tip down. Of goals with a place and a direction, the last joint is free if it turns about the
    direction, and else those at the base are.

    Args:
        chain: The arm.
        name: The type of goal.
        dof: How many joints it fixes.
    """
    surplus = max(0, chain.dof - dof)
    joints = list(range(chain.dof))
    if name != "TranslationDirection5D":
        return joints[::-1][:surplus]
    pointing = chain.T_base_tool[:3, :3] @ chain.direction
    to_tool = chain.T_base_tool[:3, 3] - chain.points[-1]
    turned = np.abs(np.cross(chain.axes[-1], [pointing, to_tool])).max() < _ALONG and not chain.prismatic[-1]
    return ([joints.pop()] if turned and surplus else [])[:surplus] + joints[: surplus - int(turned)]


def arm_length(chain: Chain) -> float:
    """Return the sum of the distances from joint to joint and on to the tool, while all values are 0 [m]."""
    points = np.vstack([chain.points, chain.T_base_tool[:3, 3]])
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def default_steps(
    chain: Chain, free: Sequence[int], angle: float = ANGLE_STEP, slide: float = SLIDE_STEP
) -> tuple[float, ...]:
    """Return a step for each free joint [rad or m].

    Those of more than two joints are larger where there would be too many samples.

    Args:
        chain: The arm.
        free: The joints.
        angle: The step of revolute joints [rad].
        slide: The step of prismatic ones, in units of the length of the arm.
    """
    length = arm_length(chain) or 1.0
    steps = np.array([slide * length if chain.prismatic[joint] else angle for joint in free])
    if len(free) > 2:
        joints = list(free)
        spans = np.where(chain.circular[joints], 2 * np.pi, (chain.upper - chain.lower)[joints])
        spans = np.where(chain.prismatic[joints], spans, np.minimum(spans, 2 * np.pi))
        steps *= max(1.0, float(np.prod(spans / steps + 1) / _MOST) ** (1 / len(free)))
    return tuple(steps.tolist())

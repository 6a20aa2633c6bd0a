"""Options of motions: each field has OpenRAVE's name, type, default and effect.

The types serve to parse the text of module commands and to check keyword arguments.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, Literal, TypeVar

import numpy as np

from ravemj.core.arrays import checked_vector
from ravemj.errors import ArgumentError
from ravemj.planning.edges import STEP

STEP_LENGTH = float(np.float32(STEP))
"""OpenRAVE's default step length, which is a single-precision number."""


Certify = bool | Literal["required"]
"""Whether to certify that a motion is free of collisions, and whether to reject uncertified motions."""


@dataclass(frozen=True)
class JointMotion:
    """Options of a motion of joints to goals: ``MoveActiveJoints``, ``MoveManipulator``."""

    maxiter: int = 4000
    """Maximum number of iterations of each call of the planner."""
    maxtries: int = 2
    """Number of calls of the planner, each with other random numbers."""
    jitter: float = 0.04
    """Maximum change of each value of a start or goal in collision to make it free [rad or m].

    The motion between the original and the changed configuration is not tested. With a constraint, starts and goals
    are not changed.
    """
    steplength: float = STEP_LENGTH
    """Length of a step of the planner's trees, a weighted distance of configurations."""
    certify: Certify = False
    """Whether to certify that the motion is free of collisions; ``required`` rejects uncertified motions."""


@dataclass(frozen=True)
class ToolMotion(JointMotion):
    """Options of a motion of the tool to goals: ``MoveToHandPosition``."""

    maxtries: int = 3
    jitter: float = 0.03
    seedik: int = 8
    """Number of IK solutions that are goals from the start."""
    goalsamples: int = 40
    """Maximum number of IK solutions that are goals."""
    goalsampleprob: float = 0.1
    """Probability of sampling another IK solution in an iteration."""


@dataclass(frozen=True)
class StraightMotion:
    """Options of a motion of the tool along a straight line: ``MoveHandStraight``."""

    minsteps: int = 0
    """Minimum number of steps."""
    maxsteps: int = 10000
    """Maximum number of steps."""
    stepsize: float = 0.01
    """Distance between consecutive poses of the tool [m]."""
    ignorefirstcollision: float = 0.1
    """Length of the line, from its start, in which collisions are ignored [m]."""


@dataclass(frozen=True)
class UnsyncMotion:
    """Options of a motion to a configuration from which other joints can move: ``MoveUnsyncJoints``."""

    maxtries: int = 1
    """Number of attempts."""
    maxdivision: int = 10
    """Number of tested steps of the other joints' motion."""
    planner: str = "BasicRRT"
    """Name of the planner."""


@dataclass(frozen=True)
class JitterMotion:
    """Options of a motion out of collision: ``JitterActive``."""

    maxiter: int = 5000
    """Maximum number of random configurations."""
    jitter: float = 0.03
    """Maximum change of each value [rad or m]."""


@dataclass(frozen=True)
class GraspMotion:
    """Options of a motion to one of several grasps: ``GraspPlanning``."""

    seedgrasps: int = 20
    """Number of reachable grasps that are goals of one plan."""
    seeddests: int = 5
    """Number of destinations to find for each grasp."""
    seedik: int = 0
    """Number of IK solutions of each grasp that are goals; 0 for all."""
    maxiter: int = 4000
    """Maximum number of iterations of the planner."""
    randomgrasps: bool = True
    """Whether to try the grasps in random order."""
    randomdests: bool = True
    """Whether to try the destinations in random order."""
    approachoffset: float = 0.0
    """Distance from the grasp at which the motion ends [m]."""
    steplength: float = STEP_LENGTH
    """Length of a step of the planner's trees, a weighted distance of configurations."""
    grasptranslationstepmult: float = 0.1
    """Ratio of translational to rotational steps in simulated grasps, for sliders and the approach [m/rad]."""
    graspfinestep: float = 0.001
    """Step of revolute joints from which the contact tolerance of simulated grasps is computed [rad]."""


Kind = TypeVar("Kind", JointMotion, ToolMotion, StraightMotion, UnsyncMotion, JitterMotion, GraspMotion)


def chosen(kind: type[Kind], given: Mapping[str, Any]) -> Kind:
    """Return the options of a motion: given values that are not None, else defaults. Other names are ignored.

    Raises:
        ArgumentError: an option is not finite, or not an integer if it should be.
    """
    rows = [row for row in fields(kind) if given.get(row.name) is not None]
    return kind(**{row.name: _checked(row.name, row.type, given[row.name]) for row in rows})


def _checked(name: str, kind: object, value: Any) -> Any:  # noqa: ANN401 - of the type of its row
    if kind is int:
        number = checked_vector([value], 1, name).item()
        if number % 1:
            raise ArgumentError(f"{name}: is {value}, and should be a whole number")
        return int(number)
    return checked_vector([value], 1, name).item() if kind is float else value

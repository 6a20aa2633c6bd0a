"""Reduction of goals with free pose components to full goals of longer arms.

Free components become *virtual joints* at the tool: a tool that may roll about its direction gets one more joint. If
only directions matter, all axes are moved to the origin. The solutions of the longer arm, without the virtual joints,
are those of the arm.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.closed import ClosedForm, Solutions
from ravemj.ik.derive import Validation, derive
from ravemj.ik.families.snapping import TOLERANCE
from ravemj.ik.tasks import ALONG, Task
from ravemj.ik.vectors import Floats


@dataclass(frozen=True)
class Reduction:
    """Equivalent arm and task with the same solutions.

    Attributes:
        chain: The arm, with virtual joints at its end.
        task: The task of that arm.
        how: A sentence about the reduction.
        virtual: The positions of the virtual joints.
    """

    chain: Chain
    task: Task
    how: str
    virtual: range


def reduction(chain: Chain, task: Task) -> Reduction | None:
    """Return the reduction of a task; None if there is none."""
    if task in (Task.ROTATION, Task.DIRECTION):
        return None if chain.prismatic.any() else _centred(chain, task)
    if task is Task.LOOK_AT:
        return _with_joints(chain, [True], Task.PLACE, "a virtual slide along the direction")
    if task is Task.RAY:
        how = "a virtual slide along the direction and a virtual roll about it"
        return _with_joints(chain, [True, False], Task.TRANSFORM, how)
    if task in ALONG:
        return _with_joints(chain, [False], Task.TRANSFORM, "a virtual roll about the direction")
    return None


def _centred(chain: Chain, task: Task) -> Reduction:
    """Reduce a task without position: move all axes to the origin, so that a direction is a position at distance 1."""
    tool = chain.T_base_tool.copy()
    tool[:3, 3] = tool[:3, :3] @ chain.direction if task is Task.DIRECTION else 0
    centred = replace(chain, points=np.zeros_like(chain.points), T_base_tool=tool)
    how = "all axes moved to one point"
    if task is Task.ROTATION:
        return Reduction(centred, Task.TRANSFORM, how, range(0))
    return _with_joints(centred, [True], Task.PLACE, f"{how}, and a virtual slide along the direction")


def _with_joints(chain: Chain, sliding: list[bool], task: Task, how: str) -> Reduction:
    """Reduce a task by adding virtual joints along or about the tool's direction; ``how`` describes the reduction.

    If the last revolute joints of the arm rotate about the same line, the virtual joints are inserted before them,
    since their motions commute. So a virtual joint follows the arm's other joints directly even if these last ones are
    locked.
    """
    axis, place = chain.T_base_tool[:3, :3] @ chain.direction, chain.T_base_tool[:3, 3]
    at = chain.dof
    while at and not chain.prismatic[at - 1] and _same_line(chain, at - 1, axis, place):
        at -= 1
    span = np.where(sliding, 2 * chain.reach, np.pi)
    count = len(sliding)
    longer = replace(
        chain,
        axes=np.insert(chain.axes, [at] * count, axis, axis=0),
        points=np.insert(chain.points, [at] * count, place, axis=0),
        prismatic=np.insert(chain.prismatic, [at] * count, sliding),
        lower=np.insert(chain.lower, [at] * count, -span),
        upper=np.insert(chain.upper, [at] * count, span),
        circular=np.insert(chain.circular, [at] * count, [False] * count),
    )
    return Reduction(longer, task, how, range(at, at + count))


def _same_line(chain: Chain, joint: int, axis: Floats, place: Floats) -> bool:
    tilt = np.linalg.norm(np.cross(chain.axes[joint], axis))
    away = np.linalg.norm(np.cross(axis, chain.points[joint] - place)) / chain.reach
    return bool(max(tilt, away) < TOLERANCE)


class ReducedForm:
    """Closed-form solver that uses the solver of a longer arm, with the interface of ``ClosedForm``.

    Attributes:
        chain: The arm itself.
        task: The task of the arm.
        inner: The solver of the longer arm.
        how: A sentence about the reduction.
        family: The family of the longer arm.
    """

    def __init__(self, chain: Chain, task: Task, inner: ClosedForm, way: Reduction) -> None:
        self.chain, self.task, self.inner, self.how = chain, task, inner, way.how
        self.family = inner.family
        self._virtual = way.virtual
        self._real = [joint for joint in range(way.chain.dof) if joint not in way.virtual]

    @property
    def locked(self) -> list[int]:
        """The locked joints, whose values are given."""
        return [self._real.index(joint) for joint in self.inner.locked]

    @property
    def branch_names(self) -> list[str]:
        """A name for each branch, including those of virtual joints."""
        return self.inner.branch_names

    def solve(self, poses: Floats, locked: Floats | None = None, *, limits: bool = False) -> Solutions:
        """Return all solutions, regardless of limits; the arguments are those of ``ClosedForm.solve``."""
        del limits  # they are not limits of the longer arm
        goals = poses
        if self.task in (Task.ROTATION, Task.DIRECTION):
            goals = poses.copy()
            goals[..., :3, 3] = 0 if self.task is Task.ROTATION else poses[..., :3, :3] @ self.chain.direction
        solutions = self.inner.solve(goals, locked)
        valid = solutions.valid
        if self.task is Task.LOOK_AT:
            valid = valid & (solutions.values[..., self._virtual[0]] >= 0)  # the look-at point is in front
        elif self.task is Task.DIRECTION:
            valid = valid & (
                np.abs(solutions.values[..., self._virtual[0]]) < 1e-6
            )  # otherwise the direction is opposite
        errors = np.where(solutions.valid & ~valid, 1.0, solutions.errors)
        return Solutions(solutions.values[..., self._real], valid, solutions.merged, errors)


def derive_reduced(
    chain: Chain, task: Task, locked: Sequence[int], *, general: bool
) -> tuple[ReducedForm, Validation] | None:
    """Derive and validate a closed-form solver by a reduction; None if there is none."""
    way = reduction(chain, task)
    if way is None:
        return None
    places = [joint if joint < way.virtual.start else joint + len(way.virtual) for joint in locked]
    derived = derive(way.chain, way.task, places, general=general)
    return None if derived is None else (ReducedForm(chain, task, derived[0], way), derived[1])

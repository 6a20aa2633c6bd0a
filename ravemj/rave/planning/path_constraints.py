"""Path constraints: regions of tools and grabbed bodies, user functions, and their combinations."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.regions import PoseSet
from ravemj.manipulation.bodies import Bodies, Constraint
from ravemj.manipulation.region_errors import Lacking, MovingFrame, all_of, any_of, manifold, region_error
from ravemj.manipulation.tool import ToolConstraint
from ravemj.planning.constrained_edges import Manifold
from ravemj.planning.projection import Error
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.planning.values import CHAIN, Values, hand_of
from ravemj.rave.region import Sets, is_region, present_pose, region_of

if TYPE_CHECKING:
    pass

TOLERANCE = 1e-3
"""Maximum error norm of a configuration on a region constraint [m and rad]."""


def constrain(
    values: Values, given: object, manip: Callable[[], Manipulator], tolerance: float, holding: KinBody | None
) -> None:
    """Add a constraint to a problem: a region, a set with ``contains``, a function, or a combination of these.

    Configurations are projected onto regions; other sets only reject configurations.

    Args:
        values: The problem.
        given: The constraint.
        manip: Returns the manipulator of the tool for regions.
        tolerance: The maximum error norm of a region [m and rad].
        holding: The grabbed body to which regions refer; None for the tool.

    Raises:
        ArgumentError: the constraint has another type, or the tool does not move.
    """
    if not 0 < tolerance < np.inf:
        raise ArgumentError(f"add_constraint: tolerance is {tolerance:g}, and should be more than 0")
    if isinstance(given, Sets) and not given.any:
        for member in given.members:
            constrain(values, member, manip, tolerance, holding)
        return
    if isinstance(given, ToolConstraint):
        add_manifold(values, hand_of(manip().GetRobot().GetEnv(), values, gripper=True).tool.to_constraint(given))
        return
    bodies = values.bodies
    if bodies is None:
        raise ArgumentError("add_constraint: nothing moves yet; call SetRobotActiveJoints(robot) first")
    lacking = _lacking(bodies, given, manip, holding)
    if lacking is None:
        values.conditions.constraints.append(_test(bodies, given, manip, tolerance, holding))
        return
    add_manifold(values, manifold(bodies, lacking, tolerance))


def add_manifold(values: Values, new: Manifold) -> None:
    """Add a manifold to project configurations onto, and replace smoothers, which would leave it, by a retimer."""
    old = values.conditions.manifold
    if old is not None:
        scale, first, second = old.threshold / new.threshold, old.off, new.off

        def off(values: Floats) -> float:
            return math.hypot(first(values), scale * second(values))

        new = Manifold(stacked([old.error, new.error], [1.0, scale]), old.threshold, off)
    values.conditions = replace(values.conditions, manifold=new)
    if values.postprocessing == CHAIN:
        values.postprocessing = "SplineTrajectoryRetimer", ""


def _lacking(
    bodies: Bodies, given: object, manip: Callable[[], Manipulator], holding: KinBody | None
) -> Lacking | None:
    """Return the error function of a constraint set; None if the set only has a membership test.

    Regions refer to the tool or, if given, to the grabbed body ``holding``.
    """
    if isinstance(given, Sets):
        parts = [_lacking(bodies, member, manip, holding) for member in given.members]
        known = [part for part in parts if part is not None]
        return (any_of if given.any else all_of)(known) if len(known) == len(parts) else None
    if not is_region(given):
        return None
    region, arm = region_of(given), manip()
    tool = tool_frame(bodies, arm)
    if tool is None:
        raise ArgumentError(f"add_constraint: none of the joints that move takes '{arm.GetName()}' along")
    frame = None if region.frame is None else moving_frame(bodies, region.frame)
    return region_error(of_tool(region.at_present() if frame is None else region.relative(), arm, holding), tool, frame)


def _test(
    bodies: Bodies, given: object, manip: Callable[[], Manipulator], tolerance: float, holding: KinBody | None
) -> Constraint:
    """Return the membership test of a constraint set; for regions, it tests the bodies' present configuration."""
    if isinstance(given, Sets):
        tests = [_test(bodies, member, manip, tolerance, holding) for member in given.members]
        combine = any if given.any else all
        return lambda values: combine(test(values) for test in tests)
    lacking = _lacking(bodies, given, manip, holding)
    if lacking is not None:
        return lambda values: float(np.linalg.norm(lacking.vector())) <= tolerance
    test = getattr(given, "contains", given)
    if not callable(test):
        wanted = "a Region, a function of a configuration, or an object with a function contains(values)"
        raise ArgumentError(f"add_constraint: constraint is {given!r}, and should be {wanted}")
    return lambda values: bool(test(values))


def of_tool(region: PoseSet, manip: Manipulator, holding: KinBody | None) -> PoseSet:
    """Convert a region of a grabbed body to a region of the tool."""
    if holding is None:
        return region
    T_body_tool = inverse(holding.GetTransform()) @ manip.GetTransform()
    return replace(region, Tw_e=region.Tw_e @ T_body_tool)


def tool_frame(bodies: Bodies, manip: Manipulator) -> MovingFrame | None:
    """Return the tool of a manipulator as a moving frame; None if no planned joint moves it."""
    effector = manip.GetEndEffector()
    if effector is None:
        raise ArgumentError(f"manipulator '{manip.GetName()}' has no end effector")
    state = manip.GetRobot().simulation_state
    return MovingFrame.on_link(bodies, state, effector.GetIndex(), manip.GetLocalToolTransform())


def moving_frame(bodies: Bodies, frame: Link | KinBody) -> MovingFrame | None:
    """Return the frame of a region as a moving frame; None if no planned joint moves it."""
    present_pose(frame, "")
    link = frame if isinstance(frame, Link) else frame.GetLinks()[0]
    T_link_frame = inverse(link.GetTransform()) @ frame.GetTransform()
    return MovingFrame.on_link(bodies, link.GetParent().simulation_state, link.GetIndex(), T_link_frame)


def stacked(errors: Sequence[Error], scales: Sequence[float]) -> Error:
    """Combine several error functions into one, each multiplied by its scale."""

    def error(values: Floats) -> tuple[Floats, Floats]:
        parts = [error_of(values) for error_of in errors]
        rows = [(scale * part, scale * jacobian) for scale, (part, jacobian) in zip(scales, parts, strict=True)]
        return np.concatenate([part for part, _ in rows]), np.concatenate([jacobian for _, jacobian in rows])

    return error

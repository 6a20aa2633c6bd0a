"""Closing directions of gripper fingers, and detection of parallel jaws."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, inverse
from ravemj.engine.collision.queries import moved_links
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.manipulation.grasping import antipodal
from ravemj.model.bounds import links_bounds
from ravemj.model.scene import Manipulator

SQUEEZE = 2e-5
"""Motion of the fingers beyond the first contact, at which all contacts are determined [rad or m]."""

CLEARANCE = 1e-3
"""Gap between open jaws and the object [m]."""

_ROUNDING = 1e-6  # m^2 per rad or m, growth of a spread that counts as none


def closes(arm: Manipulator) -> bool:
    """Return whether a manipulator has gripper joints that close."""
    return any(arm.chucking_direction)


def with_closing_direction(robot: BodyState, arm: Manipulator) -> Manipulator:
    """Return a manipulator with a closing direction; if the file has none, as in URDF, it is found from the fingers.

    A joint closes in the direction in which the links of all fingers approach each other. The caller holds the lock.
    """
    if closes(arm) or not arm.gripper_dofs:
        return arm
    links, saved = sorted(moved_links(robot.scene, arm.gripper_dofs)), robot.configuration()
    signs: list[float] = []
    try:
        values = robot.kinematics.values()
        for dof in arm.gripper_dofs:
            spreads: list[float] = []
            for change in (-SQUEEZE, SQUEEZE):
                moved = values.copy()
                moved[dof] += change
                robot.set_values(moved)
                spreads.append(_spread(robot, links))
            growth = (spreads[1] - spreads[0]) / (2 * SQUEEZE)
            signs.append(float(-np.sign(growth)) if abs(growth) > _ROUNDING else 0.0)
    finally:
        robot.restore(saved)
    return replace(arm, chucking_direction=tuple(signs))


def _spread(robot: BodyState, links: Sequence[int]) -> float:
    """Return the sum of the squared distances of the centres of links from their mean [m^2]."""
    poses = robot.link_transforms()
    boxes = [links_bounds([robot.scene.links[link]], poses[[link]]) for link in links]
    centers = np.array([(np.array(box.low) + np.array(box.high)) / 2 for box in boxes if box is not None])
    return float(((centers - centers.mean(axis=0)) ** 2).sum()) if len(centers) else 0.0


def jaws_of(robot: BodyState, arm: Manipulator) -> antipodal.Jaws:
    """Return the parallel jaws of an open gripper.

    Raises:
        ArgumentError: the fingers do not slide towards each other along one line.
    """
    assert arm.effector is not None
    values, gripper = robot.kinematics.values(), list(arm.gripper_dofs)
    T_world_tool = robot.link_transform(arm.effector) @ arm.T_effector_tool.matrix()
    before = inverse(T_world_tool) @ robot.link_transforms()
    robot.set_values(_moved(values, gripper, arm))
    after = inverse(T_world_tool) @ robot.link_transforms()
    robot.set_values(values)
    motions = after[:, :3, 3] - before[:, :3, 3]
    lengths = np.linalg.norm(motions, axis=1)
    moving = np.flatnonzero((lengths > 0) | (np.abs(after - before)[:, :3, :3] > 0).any(axis=(1, 2)))
    message = f"manipulator '{arm.name}' has no parallel jaws: two fingers that slide towards each other"
    error = ArgumentError(f'{message}; use method="fly"')
    if not len(moving) or (lengths[moving] == 0).any() or np.abs(after - before)[:, :3, :3].max() > SQUEEZE:
        raise error
    axis = motions[moving[0]] / lengths[moving[0]]
    along = motions[moving] @ axis
    if np.abs(np.abs(along) - lengths[moving]).max() > SQUEEZE or not (along > 0).any() or not (along < 0).any():
        raise error
    direction = np.array(arm.direction) - axis * (axis @ np.array(arm.direction))
    if np.linalg.norm(direction) < CLEARANCE:
        raise ArgumentError(f"manipulator '{arm.name}' closes along its direction; correct its <direction>")
    ends = [_reach(robot, moving[along * sign > 0], before, sign * axis) for sign in (1.0, -1.0)]
    low, high = ends[0], -ends[1]
    direction /= np.linalg.norm(direction)
    back, tip = -_reach(robot, moving, before, -direction), _reach(robot, moving, before, direction)
    depth = 0.0 if back <= 0 <= tip else (back + tip) / 2  # a tool in the palm, as in URDF, lies behind the fingers
    return antipodal.Jaws(axis, direction, (low + high) / 2, high - low, depth)


def _moved(values: Floats, gripper: list[int], arm: Manipulator) -> Floats:
    closing = values.copy()
    closing[gripper] += 1e-3 * np.array(arm.chucking_direction)
    return closing


def _reach(robot: BodyState, links: Sequence[int] | NDArray[np.int_], T_tool_links: Floats, axis: Floats) -> float:
    """Return the largest coordinate of links' shapes along an axis in the frame of the tool [m]."""
    side = np.eye(3)[int(np.abs(axis).argmin())]
    side = np.cross(axis, side) / np.linalg.norm(np.cross(axis, side))
    T = np.eye(4)
    T[:3, :3] = np.stack([axis, side, np.cross(axis, side)])
    chosen = [robot.scene.links[link] for link in links]
    bounds = links_bounds(chosen, T @ T_tool_links[np.asarray(links, dtype=int)])
    if bounds is None:
        raise ArgumentError(f"a finger of '{robot.scene.name}' has no shapes; give it geometries")
    return float(bounds.high[0])

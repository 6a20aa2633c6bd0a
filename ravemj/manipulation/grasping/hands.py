"""Grasp simulation for robots of a world: conversion of a robot to a hand, and the contacts of its grasp."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats, Ints, inverse
from ravemj.engine.collision.hand import hand_tests
from ravemj.engine.collision.patches import contact_rows
from ravemj.engine.collision.queries import held_with, moved_links
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.manipulation.grasping.closing import STEPS, Approach, Ball, Closed, Finger, Hand, Steps, Target, close
from ravemj.model.chains import joint_dofs, links_beyond
from ravemj.model.scene import Manipulator


class Grasped(NamedTuple):
    """Result of a grasp simulation with its contacts.

    Attributes:
        closed: Final configuration, or the reason of the failure.
        contacts: Contact points [m] and unit normals out of the target in the world, shape (n, 6); empty on failure.
        links: Index of the link of the robot at each contact, shape (n,).
    """

    closed: Closed
    contacts: Floats
    links: Ints


def hand_of(body: BodyState, manipulator: Manipulator, sides: dict[int, float]) -> Hand:
    """Return a robot as a hand, in its present configuration.

    Args:
        body: The robot.
        manipulator: The manipulator that grasps.
        sides: The sign of the closing motion of each gripper joint, by DOF index, in the order of closing.

    Raises:
        ArgumentError: the manipulator has no effector.
    """
    if manipulator.effector is None:
        raise ArgumentError(f"manipulator '{manipulator.name}' has no effector; give it the link of the tool")
    poses = body.link_transforms()
    T_base_tool = inverse(poses[0]) @ poses[manipulator.effector] @ manipulator.T_effector_tool.matrix()
    ball = _ball(held_with(body))
    center = inverse(poses[0]) @ np.append(ball.center, 1.0)
    return Hand(
        values=body.kinematics.values(),
        T_world_base=poses[0].copy(),
        T_base_tool=T_base_tool,
        fingers=[_finger(body, dof, side) for dof, side in sides.items()],
        links=frozenset(links_beyond(body.scene, manipulator)),
        all_links=frozenset(range(len(poses))),
        ball=Ball(center[:3], ball.radius),
        names=[link.name for link in body.scene.links],
    )


def target_of(body: BodyState) -> Target:
    """Return a body as a target.

    Raises:
        ArgumentError: the body has no shapes.
    """
    return Target(body.link_transform(0).copy(), _ball([body]))


def grasp(
    world: CollisionWorld,
    body: BodyState,
    hand: Hand,
    target: BodyState | None,
    approach: Approach,
    steps: Steps = STEPS,
    *,
    thought: Target | None = None,
) -> Grasped:
    """Simulate a grasp of a target, and return its contacts; afterwards the robot is restored.

    Args:
        world: The world; the caller holds the lock.
        body: The robot.
        hand: The robot as a hand; see ``hand_of``.
        target: The body to grasp; None if only fingers close.
        approach: The approach of the hand.
        steps: Step lengths.
        thought: Assumed target, at a wrong pose, to which the hand moves; None means the true one.
    """
    placed = None if target is None else thought or target_of(target)
    with hand_tests(world, body, target) as tests:
        closed = close(hand, placed, approach, tests, steps)
        if closed.reason is not None or target is None:
            return Grasped(closed, np.zeros((0, 6)), np.zeros(0, dtype=int))
        contacts, links = tests.contacts(hand.links, closed.T_world_base, closed.values)
        return Grasped(closed, contact_rows(contacts), np.array(links, dtype=int))


def _finger(body: BodyState, dof: int, side: float) -> Finger:
    scene = body.scene
    axis, joint = scene.dof_axes[dof], scene.joint_of_dof(dof)
    first = next(dofs for dofs in (joint_dofs(scene, index) for index in range(len(scene.joints))) if dof in dofs)[0]
    limits = (-np.inf, np.inf) if axis.circular else (axis.lower, axis.upper)
    links = moved_links(scene, (dof,))
    return Finger(dof, scene.dof_names[dof], side, limits, links, joint.slides(dof - first))


def _ball(bodies: Sequence[BodyState]) -> Ball:
    """Return a bounding sphere of bodies, in the world."""
    boxes = [body.bounds.at(body.link_transforms(), [True] * len(body.scene.links)) for body in bodies]
    known = [box for box in boxes if box is not None]
    if not known:
        raise ArgumentError(
            f"body '{bodies[0].scene.name}' has no shapes, so that nothing touches it; give it geometries"
        )
    low, high = np.min([box.low for box in known], axis=0), np.max([box.high for box in known], axis=0)
    return Ball((low + high) / 2, float(np.linalg.norm(high - low)) / 2)

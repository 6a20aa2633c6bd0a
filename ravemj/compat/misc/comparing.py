"""Checks that bodies and environments are equal."""

import itertools
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import ArrayLike

from ravemj.model.mimic_texts import mimic_texts
from ravemj.rave.enums import CloningOptions
from ravemj.rave.environment import Environment
from ravemj.rave.kinbody import KinBody
from ravemj.rave.robot import Robot


def CompareBodies(  # noqa: PLR0913, PLR0917 - OpenRAVE's arguments
    body0: KinBody,
    body1: KinBody,
    comparegeometries: bool = True,
    comparesensors: bool = True,
    comparemanipulators: bool = True,
    comparegrabbed: bool = True,
    comparephysics: bool = True,
    computeadjacent: bool = True,
    epsilon: float = 1e-10,
) -> None:
    """Check that two bodies and their poses are equal; joint values are not compared.

    Args:
        body0: A body.
        body1: The other.
        comparegeometries: Whether to compare shapes.
        comparesensors: Whether to compare attached sensors.
        comparemanipulators: Whether to compare manipulators.
        comparegrabbed: Whether to compare the names of grabbed bodies.
        comparephysics: Whether to compare masses and inertias.
        computeadjacent: Whether to compare pairs of adjacent links.
        epsilon: Tolerance of numbers.

    Raises:
        AssertionError: they differ; the text says where.
    """
    _alike(body0.IsRobot(), body1.IsRobot(), "one is a robot")
    _alike(body0.GetDOF(), body1.GetDOF(), "numbers of DOFs")
    _near(body0.GetTransform(), body1.GetTransform(), epsilon, "poses")
    _links(body0, body1, comparegeometries, comparephysics, epsilon)
    _joints(body0, body1, epsilon)
    if computeadjacent:
        _alike(body0.GetAdjacentLinks(), body1.GetAdjacentLinks(), "adjacent links")
    if comparegrabbed:
        first, second = (sorted(grabbed.GetName() for grabbed in body.GetGrabbed()) for body in (body0, body1))
        _alike(first, second, "held bodies")
    if isinstance(body0, Robot) and isinstance(body1, Robot):
        if comparemanipulators:
            _manipulators(body0, body1, epsilon)
        if comparesensors:
            first, second = ([sensor.GetName() for sensor in robot.GetAttachedSensors()] for robot in (body0, body1))
            _alike(first, second, "attached sensors")


def _links(body0: KinBody, body1: KinBody, geometries: bool, physics: bool, epsilon: float) -> None:
    _alike(len(body0.GetLinks()), len(body1.GetLinks()), "numbers of links")
    for link0, link1 in zip(body0.GetLinks(), body1.GetLinks(), strict=True):
        name = f"link '{link0.GetName()}'"
        _alike(link0.GetName(), link1.GetName(), "names of links")
        _alike(link0.IsStatic(), link1.IsStatic(), f"{name}: static")
        if physics:
            _near([link0.GetMass()], [link1.GetMass()], epsilon, f"{name}: masses")
            _near(link0.GetLocalCOM(), link1.GetLocalCOM(), epsilon, f"{name}: centres of mass")
            _near(link0.GetLocalInertia(), link1.GetLocalInertia(), epsilon, f"{name}: inertias")
        if geometries:
            first, second = link0.GetGeometries(), link1.GetGeometries()
            _alike(
                [geometry.GetType() for geometry in first],
                [geometry.GetType() for geometry in second],
                f"{name}: shapes",
            )
            for geometry, other in zip(first, second, strict=True):
                _near(geometry.GetTransform(), other.GetTransform(), epsilon, f"{name}: poses of shapes")
                box0, box1 = geometry.ComputeAABB(np.eye(4)), other.ComputeAABB(np.eye(4))
                _near(box0.extents(), box1.extents(), epsilon, f"{name}: sizes of shapes")


def _joints(body0: KinBody, body1: KinBody, epsilon: float) -> None:
    first, second = ([*body.GetJoints(), *body.GetPassiveJoints()] for body in (body0, body1))
    _alike([joint.GetName() for joint in first], [joint.GetName() for joint in second], "joints")
    equations = [mimic_texts(body.simulation_state.scene) for body in (body0, body1)]
    for joint0, joint1, mimic0, mimic1 in zip(first, second, *equations, strict=True):
        name = f"joint '{joint0.GetName()}'"
        _alike(joint0.GetType(), joint1.GetType(), f"{name}: types")
        _near(joint0.GetLimits(), joint1.GetLimits(), epsilon, f"{name}: limits")
        _near(joint0.GetVelocityLimits(), joint1.GetVelocityLimits(), epsilon, f"{name}: velocity limits")
        _near(joint0.GetAccelerationLimits(), joint1.GetAccelerationLimits(), epsilon, f"{name}: acceleration limits")
        _near(joint0.GetTorqueLimits(), joint1.GetTorqueLimits(), epsilon, f"{name}: torque limits")
        _near(joint0.GetWeights(), joint1.GetWeights(), epsilon, f"{name}: weights")
        _near(joint0.GetResolutions(), joint1.GetResolutions(), epsilon, f"{name}: resolutions")
        _alike(mimic0.get("follows"), mimic1.get("follows"), f"{name}: equations")


def _manipulators(robot0: Robot, robot1: Robot, epsilon: float) -> None:
    first, second = robot0.GetManipulators(), robot1.GetManipulators()
    _alike([arm.GetName() for arm in first], [arm.GetName() for arm in second], "manipulators")
    for arm0, arm1 in zip(first, second, strict=True):
        name = f"manipulator '{arm0.GetName()}'"
        _alike(list(arm0.GetArmIndices()), list(arm1.GetArmIndices()), f"{name}: arms")
        _near(arm0.GetLocalToolTransform(), arm1.GetLocalToolTransform(), epsilon, f"{name}: tools")


def CompareEnvironments(
    env: Environment, env2: Environment, options: int = CloningOptions.Bodies, epsilon: float = 1e-10
) -> None:
    """Check that two environments have equal bodies of the same names and joint values.

    Args:
        env: An environment.
        env2: The other.
        options: What to compare, a ``CloningOptions``; bodies are always compared.
        epsilon: Tolerance of numbers.

    Raises:
        AssertionError: they differ; the text says where.
    """
    del options
    _alike(len(env.GetBodies()), len(env2.GetBodies()), "numbers of bodies")
    for body in env.GetBodies():
        other = env2.GetKinBody(body.GetName())
        assert other is not None, f"only one has a body '{body.GetName()}'"
        CompareBodies(body, other, epsilon=epsilon)
        _near(body.GetDOFValues(), other.GetDOFValues(), epsilon, f"'{body.GetName()}': joint values")


def _alike(first: object, second: object, what: str) -> None:
    assert first == second, f"{what} differ: {first} and {second}"


def _near(first: ArrayLike, second: ArrayLike, epsilon: float, what: str) -> None:
    numbers, other = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    same = numbers.shape == other.shape and np.allclose(numbers, other, rtol=0, atol=epsilon, equal_nan=True)
    assert same, f"{what} differ: {numbers.tolist()} and {other.tolist()}"


def sequence_cross_product(*sequences: Iterable[object]) -> Iterator[tuple[object, ...]]:
    """Return the Cartesian product of sequences, like ``itertools.product``."""
    return itertools.product(*sequences)

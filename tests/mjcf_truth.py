"""Comparison of what ravemj reads of MJCF with MuJoCo's own numbers, link by link and joint by joint."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

import ravemj

Truth = dict[str, Any]


def loaded(path: str | Path) -> ravemj.Environment:
    """Return an environment with a model, whatever it warns of."""
    env = ravemj.Environment()
    env.StopSimulation()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        assert env.Load(path), path
    return env


def check_model(env: ravemj.Environment, truth: Truth) -> None:
    """Compare a loaded model with its numbers in ``tests/data/mjcf``."""
    links = {link.GetName(): link for body in env.GetBodies() for link in body.GetLinks()}
    joints = {joint.GetName(): (body, joint) for body in env.GetBodies() for joint in body.GetJoints()}
    bodies = {name: body for name, body in truth["bodies"].items() if name != "world" and is_named(name)}
    assert not {name for name, body in bodies.items() if not body.get("mocap")} - links.keys()
    for name in bodies.keys() & links.keys():
        _check_inertia(links[name], bodies[name])
    _check_joints(joints, truth)
    first, moved = truth["configs"][0]["poses"], {}
    for body in env.GetBodies():
        root = body.GetLinks()[0]
        is_free = any(one["type"] == "free" and one["body"] == root.GetName() for one in truth["joints"].values())
        if root.GetName() in first and (is_free or truth["bodies"][root.GetName()].get("mocap")):
            moved[body] = matrix(first[root.GetName()]) @ np.linalg.inv(root.GetTransform())
    for config in truth["configs"]:
        assert any(_worst(env, truth, config, axes, moved) < 1e-9 for axes in ("parent", "body"))


def is_named(name: str) -> bool:
    """Return whether the model gives a name; others are the truth's own."""
    return not name.startswith("#")


def matrix(numbers: list[float]) -> np.ndarray:
    """Return a pose x y z, w x y z as a matrix."""
    wxyz = np.array(numbers[3:]) / np.linalg.norm(numbers[3:])
    return ravemj.matrixFromPose([*wxyz, *numbers[:3]])


def _check_inertia(link: ravemj.Link, truth: Truth) -> None:
    assert abs(link.GetMass() - truth["mass"]) <= 1e-8 * max(1, truth["mass"])
    if truth["mass"] > 1e-9:
        np.testing.assert_allclose(link.GetLocalCOM(), truth["com"], rtol=0, atol=1e-8)
        xx, yy, zz, xy, xz, yz = truth["inertia"]
        inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        near = 1e-8 * max(1e-4, float(np.trace(inertia)))
        np.testing.assert_allclose(link.GetLocalInertia(), inertia, rtol=0, atol=near)


def _check_joints(joints: dict[str, tuple[ravemj.KinBody, ravemj.Joint]], truth: Truth) -> None:
    equalities = [one for one in truth.get("equalities", []) if one["active"]]
    followers = {one["follower"] for one in equalities if one["kind"] == "joint"}
    is_loose = any(one["kind"] == "tendon" for one in equalities)
    for name, joint in truth["joints"].items():
        if joint["type"] == "free" or not is_named(name):
            continue
        low, high = joint.get("range", (0, 1)) if joint["type"] != "ball" else (0, 1)
        if name not in joints:
            assert name in followers or is_loose or low >= high, f"joint {name} is missing"
        elif "range" in joint and joint["type"] != "ball" and low < high:
            np.testing.assert_allclose(np.ravel(joints[name][1].GetLimits()), (low, high), rtol=0, atol=1e-9)


def _worst(env: ravemj.Environment, truth: Truth, config: Truth, axes: str, moved: dict) -> float:
    """Return how far poses of links are from the truth in one configuration, relative to those above 1."""
    unsure = _unsure(truth)
    worst = 0.0
    for body in env.GetBodies():
        values = np.array(body.GetDOFValues())
        for joint in body.GetJoints():
            name, dof = joint.GetName(), joint.GetDOFIndex()
            if name not in truth["joints"] or not is_named(name):
                continue
            if truth["joints"][name]["type"] == "ball":
                values[dof : dof + 3] = config.get("balls", {}).get(name, {axes: (0, 0, 0)})[axes]
            else:
                values[dof] = config["values"][name]
        if len(values):
            body.SetDOFValues(values, checklimits=0)
        for link in body.GetLinks():
            pose = config["poses"].get(link.GetName())
            if pose is None or link.GetName() in unsure:
                continue
            error = np.abs(moved.get(body, np.eye(4)) @ link.GetTransform() - matrix(pose))
            worst = max(worst, float(error.max()) / max(1.0, float(np.abs(pose[:3]).max())))
    return worst


def _unsure(truth: Truth) -> set[str]:
    """Return bodies behind nameless joints, whose values the truth does not give."""
    found: set[str] = set()
    for name, body in truth["bodies"].items():
        own = [key for key, one in truth["joints"].items() if one["body"] == name and one["type"] != "free"]
        if name != "world" and (body["parent"] in found or not all(map(is_named, own))):
            found.add(name)
    return found

"""Commands about models: ``convert`` and ``info``, and how all commands load one."""

import argparse
import warnings
from collections.abc import Sequence

from ravemj import scene
from ravemj.cli.console import console, print_findings, table
from ravemj.errors import Diagnostic, RavemjWarning, SourceError
from ravemj.rave import Environment, load

FATAL_CODES = {"bad-number"}
"""Findings that OpenRAVE reads over, and a command does not: nobody means the number that OpenRAVE makes of it."""


def load_model(options: argparse.Namespace) -> Environment:
    """Load the model of a command and print what was found in it.

    Raises:
        SourceError: the file is missing or broken, or has warnings and ``--strict`` was given.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RavemjWarning)  # they are printed below, all at once
        try:
            env = load(options.model)
        except SourceError as error:
            raise error if error.cause is None else failure_of([error.cause]) from None
    fatal = [finding for finding in env.diagnostics if options.strict or finding.code in FATAL_CODES]
    if fatal:
        raise failure_of(fatal)
    print_findings(env.diagnostics)
    return env


def failure_of(findings: Sequence[Diagnostic]) -> SourceError:
    """Return the error of one line that ends a command for some findings."""
    first = findings[0]
    more = f" (and {len(findings) - 1} more: see ravemj check)" if len(findings) > 1 else ""
    return SourceError(f"{first.message} [{first.code}]{more}", first.source, first.hint)


def info(options: argparse.Namespace) -> int:
    """Show the bodies, links and joints of a model."""
    env = load_model(options)
    out = console()
    bodies = [state.scene for state in env.simulation.bodies]
    if not bodies:
        print("the model has no bodies")
    for body in bodies:
        kind = "robot" if body.is_robot else "body"
        mass = sum(link.inertial.mass for link in body.links)
        print(f"{kind} {body.name}: {len(body.links)} links, {len(body.dof_axes)} DOFs, {mass:.6g} kg\n")
        out.print(_links(body))
        if body.joints or body.passive_joints:
            out.print(_joints(body))
    return 0


def _links(body: scene.KinBody) -> object:
    rows = table("Links", "#>", "link", "mass [kg]>", "centre of mass [m]", "shapes", "placed by")
    placed_by = {joint.child: joint.name for joint in (*body.joints, *body.passive_joints) if joint.places_child}
    for index, link in enumerate(body.links):
        shapes = ", ".join(type(geometry.shape).__name__.lower() for geometry in link.geometries)
        com = " ".join(f"{part:.4g}" for part in link.inertial.com)
        rows.add_row(str(index), link.name, f"{link.inertial.mass:.6g}", com, shapes, placed_by.get(index, ""))
    return rows


def _joints(body: scene.KinBody) -> object:
    rows = table("Joints", "DOF>", "joint", "type", "parent", "child", "limits", "max. velocity>", "weight>")
    dof = 0
    for joint in body.joints:
        for axis in joint.axes:
            rows.add_row(str(dof), joint.name, joint.kind, *_ends(body, joint), *_numbers(joint, axis))
            dof += 1
    for joint in body.passive_joints:
        rows.add_row("", joint.name, joint.kind, *_ends(body, joint), *_numbers(joint, joint.axes[0]))
    return rows


def _ends(body: scene.KinBody, joint: scene.Joint) -> tuple[str, str]:
    return body.links[joint.parent].name, body.links[joint.child].name


def _numbers(joint: scene.Joint, axis: scene.Axis) -> tuple[str, str, str]:
    unit = "rad" if joint.kind == "hinge" else "m"
    if axis.circular:
        limits = "circular"
    elif joint.static:
        limits = "fixed"
    else:
        limits = f"{axis.lower:.4g} to {axis.upper:.4g} {unit}"
    return limits, f"{axis.max_velocity:.4g} {unit}/s", f"{axis.weight:.4g}"

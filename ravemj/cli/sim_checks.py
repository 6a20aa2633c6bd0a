"""``check --sim``: whether models can be simulated."""

import argparse
import copy
import json

from ravemj.cli.convert import choices_of
from ravemj.cli.models import load_model
from ravemj.engine.sim_check import Point
from ravemj.engine.sim_check import check as check_points
from ravemj.engine.translation import translated
from ravemj.errors import Diagnostics

_MOST = 8  # reasons that the table has of a point; JSON has all


def check(options: argparse.Namespace) -> int:
    """Print for each model the unfulfilled requirements of simulation; return 1 if there are any."""
    points_by_model = {model: _points(options, model) for model in options.models}
    if options.json:
        print(
            json.dumps(
                {model: [point.as_json() for point in points] for model, points in points_by_model.items()}, indent=2
            )
        )
    else:
        for model, points in points_by_model.items():
            _print_table(model, points)
    return 1 if any(point.missed for points in points_by_model.values() for point in points) else 0


def _points(options: argparse.Namespace, model: str) -> list[Point]:
    chosen = copy.copy(options)
    chosen.model, chosen.strict = model, False
    env = load_model(chosen)
    choices = choices_of(options)
    diagnostics = Diagnostics()
    driven = choices._replace(actuators=choices.actuators or "position")
    translation = translated(env.simulation, diagnostics, driven, env.files[0])
    points = list(check_points(translation))
    weak = [finding.message for finding in diagnostics if finding.code == "weak-motor"]
    for point in points:
        if point.name == "holds":
            point.notes += weak
    return points


def _print_table(model: str, points: list[Point]) -> None:
    print(model)
    width = max(len(point.name) for point in points)
    for point in points:
        print(f"  {'MISSED' if point.missed else 'ok':6}  {point.name:{width}}  {point.value}")
        for mark, reasons in (("!", point.missed), ("-", point.notes)):
            for reason in reasons[:_MOST]:
                print(f"          {mark} {reason}")
            if len(reasons) > _MOST:
                print(f"          {mark} and {len(reasons) - _MOST} more: see --json")

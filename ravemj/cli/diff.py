"""The command ``diff``."""

import argparse
import json
from collections.abc import Sequence
from typing import cast

from ravemj.cli.console import console, print_error, table
from ravemj.cli.models import load_model
from ravemj.errors import RavemjError
from ravemj.model.comparison import Difference, compare
from ravemj.model.scene import Scene

_LONGEST = 60


def diff(options: argparse.Namespace) -> int:
    """Compare two models numerically; return 1 if they differ, and 2 if one cannot be read."""
    try:
        first, second = (_scene(model) for model in (options.first, options.second))
    except RavemjError as error:
        print_error(error)
        return 2
    differences = compare(first, second, options.tolerance)
    if options.json:
        print(json.dumps([_entry(difference) for difference in differences], indent=1, default=str))
    elif differences:
        rows = table(f"{options.first} and {options.second}", "part", "quantity", "first", "second", "difference>")
        for difference in differences:
            error = "" if difference.error is None else f"{difference.error:.3g}"
            values = (_short(difference.first), _short(difference.second))
            rows.add_row(difference.part, difference.quantity, *values, error)
        console().print(rows)
    else:
        print(f"no differences in {len(first.bodies)} {'body' if len(first.bodies) == 1 else 'bodies'}")
    return 1 if differences else 0


def _scene(model: str) -> Scene:
    env = load_model(argparse.Namespace(model=model, strict=False))
    bodies = tuple(state.scene for state in env.simulation.bodies)
    sensors = tuple(sensor.description for sensor in env.GetSensors() if sensor.attached is None)
    return Scene(bodies, env.simulation.view, env.simulation.gravity, sensors)


def _entry(difference: Difference) -> dict[str, object]:
    """Return a difference as JSON data; the keys are stable."""
    return {
        "part": difference.part,
        "quantity": difference.quantity,
        "first": difference.first,
        "second": difference.second,
        "difference": difference.error,
    }


def _short(value: object) -> str:
    """Return a value as short text with few digits."""
    text = _digits(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def _digits(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.10g}"
    if isinstance(value, list | tuple):
        return " ".join(_digits(part) for part in cast("Sequence[object]", value))
    return str(value)

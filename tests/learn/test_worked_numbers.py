"""The worked numbers in the exercises' texts, ``function(arguments)  is result``, are those of the solutions."""

import ast
import re
from pathlib import Path

import numpy as np
import pytest

from ravemj.learn.course import our_course

SOLUTIONS = Path(__file__).parent / "solutions"
EXAMPLE = re.compile(r"^    (\w+\(.*\).*?) +is (?:about )?([^:\n]+)(?::.*)?$", re.MULTILINE)


class _Arrays(ast.NodeTransformer):
    """Makes arrays of lists that are passed to functions, as checks pass them."""

    def visit_Call(self, node):
        array = ast.Attribute(ast.Name("np", ast.Load()), "array", ast.Load())
        node.args = [ast.Call(array, [one], []) if isinstance(one, ast.List) else one for one in node.args]
        return node


def examples():
    for exercise in our_course().exercises:
        if exercise.original.suffix == ".py":
            text = ast.get_docstring(ast.parse(exercise.original.read_text(encoding="utf-8"))) or ""
            for call, result in EXAMPLE.findall(text):
                yield pytest.param(exercise.original.name, call, result, id=f"{exercise.name}: {call}")


@pytest.mark.parametrize(("file", "call", "result"), list(examples()))
def test_worked_numbers_are_right(file, call, result):
    space = {"__name__": "exercise"}
    exec((SOLUTIONS / file).read_text(encoding="utf-8"), space)
    tree = ast.fix_missing_locations(_Arrays().visit(ast.parse(call, mode="eval")))
    found, told = eval(compile(tree, file, "eval"), space), eval(result, {"np": np})
    if file.startswith("ik") and isinstance(told, list):  # rows in any order, angles with any turns
        found, told = (_any_order(one, turns=file != "ik_2.py") for one in (found, told))
    assert np.allclose(found, told, atol=6e-4)


def _any_order(rows, *, turns):
    numbers = [np.concatenate([np.cos(row), np.sin(row)]) if turns else np.asarray(row) for row in rows]
    return sorted((np.round(row, 6) + 0.0).tolist() for row in numbers)

"""Equations with several values: which of them a joint with limits has."""

from itertools import product

from ravemj.model.expressions.calculus import Algebra
from ravemj.model.expressions.functions import FUNCTIONS, nth
from ravemj.model.expressions.nodes import Call, Graph, Node

MOST_NODES = 20_000
"""More than any robot needs, and few enough for hostile text."""


def first_within(nodes: list[Node], lower: float, upper: float) -> Node:
    """Return a node for the first value of an equation that lies within limits; else for its first value.

    That of an equation that is enormous with all its values is its first value.

    Args:
        nodes: The equation, each node after its arguments; a root that it uses twice is the same root in both places.
        lower: The least value.
        upper: The greatest value.
    """
    algebra = Algebra(Graph(nodes))
    several = [node for node in nodes if isinstance(node, Call) and FUNCTIONS[node.function].most_roots > 1]
    choices = list(product(*(range(FUNCTIONS[node.function].most_roots) for node in several)))
    if len(choices) * len(nodes) > MOST_NODES:
        return nodes[-1]
    values = [_chosen(nodes, dict(zip(several, choice, strict=True)), algebra) for choice in choices]
    limits = algebra.number(lower), algebra.number(upper)
    result = values[0]
    for value in reversed(values):
        is_within = algebra.call("and", algebra.call("le", limits[0], value), algebra.call("le", value, limits[1]))
        result = algebra.choose(is_within, value, result)
    return result


def _chosen(nodes: list[Node], choice: dict[Node, int], algebra: Algebra) -> Node:
    """Return the equation with one value of each function that has several."""
    found: dict[Node, Node] = {}
    for node in nodes:
        found[node] = node
        if isinstance(node, Call):
            function = nth(node.function, choice[node]) if node in choice else node.function
            found[node] = algebra.call(function, *(found[argument] for argument in node.arguments))
    return found[nodes[-1]]

"""Items behind what they depend on."""

from hypothesis import given
from hypothesis import strategies as st
from strategies import examples

from ravemj.core.graphs import topological_order

GRAPHS = st.lists(st.lists(st.integers(0, 7), max_size=4), min_size=8, max_size=8)


@given(GRAPHS)
@examples(200)
def test_dependencies_come_first(graph):
    earlier = [[other for other in needs if other < index] for index, needs in enumerate(graph)]
    order = topological_order(reversed(range(8)), earlier.__getitem__)
    assert sorted(order) == list(range(8))
    assert all(order.index(other) < order.index(index) for index in range(8) for other in earlier[index])


@given(GRAPHS)
@examples(200)
def test_circles_end_and_each_item_comes_once(graph):
    assert sorted(topological_order(range(8), graph.__getitem__)) == list(range(8))


def test_the_order_given_stays_where_it_can():
    needs = {3: [1], 2: [5]}
    assert topological_order([4, 3, 2, 1], lambda item: needs.get(item, [])) == [4, 1, 3, 5, 2]


def test_long_chains():
    assert topological_order([0], lambda item: [item + 1] if item < 9999 else []) == list(reversed(range(10_000)))

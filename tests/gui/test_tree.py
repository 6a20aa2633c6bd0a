"""The tree of bodies, links and joints: its rows, and how it and the picture select for each other."""

import pytest
from test_interaction import SIZE, Hand
from test_playback import Panel, chain

import ravemj
from ravemj.gui.interaction import Key, Move, Operate, Resize, Wheel

TWO_AXES = """<Robot name="r"><KinBody>
<Body name="a"/><Body name="b"/><Body name="c"/>
<Joint name="turn" type="hinge2"><Body>a</Body><Body>b</Body><axis1>0 0 1</axis1><axis2>0 1 0</axis2></Joint>
<Joint name="weld" type="hinge" enable="false"><Body>b</Body><Body>c</Body></Joint>
</KinBody></Robot>"""


@pytest.fixture
def hand(env):
    hand = Hand(env)
    hand.press_key("b")
    return hand


def rows(hand):
    return [(node.kind, node.text, node.depth) for node in hand.gui.overlay().tree]


def row(hand, text):
    return next(node.name for node in hand.gui.overlay().tree if node.text == text)


def test_joints_hang_below_their_links_with_the_links_that_they_move(hand):
    assert rows(hand) == [
        ("body", "Pendulum", 0),
        ("link", "Base", 1),
        ("joint", "Joint0", 2),
        ("link", "Arm0", 2),
        ("joint", "Joint1", 3),
        ("link", "Arm1", 3),
    ]
    hand.press_key("b")
    assert rows(hand) == []


def test_the_rows_are_the_same_object_until_bodies_change(hand, env):
    before = hand.gui.overlay().tree
    env.GetRobots()[0].SetDOFValues([0.3, 0.1])
    assert hand.gui.overlay().tree is before
    env.GetRobots()[0].SetName("other")
    assert hand.gui.overlay().tree[0].text == "other"
    env.Remove(env.GetRobots()[0])
    assert rows(hand) == []


def test_a_long_chain_has_all_its_rows():
    env = ravemj.Environment()
    env.LoadData(chain(400))
    hand = Hand(env)
    hand.press_key("b")
    shown = rows(hand)
    assert len(shown) == 1 + 401 + 400
    assert shown[-1] == ("link", "b400", 401)


def test_a_row_selects_body_link_or_joint_and_again_nothing(hand, env):
    robot = env.GetRobots()[0]
    hand.gui.handle(Operate(row(hand, "Arm1")))
    assert (hand.selection.link, hand.selection.dof) == (2, None)
    assert hand.gui.overlay().chosen == ("body 1", "link 1 2")
    assert hand.gui.overlay().style.lit > 0
    hand.gui.handle(Operate(row(hand, "Arm0")))
    assert hand.selection.link == 1
    hand.gui.handle(Operate(row(hand, "Arm0")))
    assert hand.selection is None
    hand.gui.handle(Operate(row(hand, "Joint0")))
    assert hand.selection.dof == robot.GetJoint("Joint0").GetDOFIndex()
    assert hand.gui.overlay().chosen == ("body 1", "link 1 1", "joint 1 0")
    hand.gui.handle(Operate(row(hand, "Pendulum")))
    assert (hand.selection.link, hand.selection.dof) == (0, None)


def test_the_picture_selects_in_the_tree(hand):
    hand.in_interaction().click((SIZE[0] / 2, 500))
    assert hand.gui.overlay().chosen[0] == "body 1"
    assert len(hand.gui.overlay().chosen) == 2
    hand.click((SIZE[0] / 2, 500), ctrl=True)
    assert hand.gui.overlay().chosen[2].startswith("joint 1 ")


def test_a_joint_of_two_axes_takes_turns_and_a_weld_stands_for_the_joint_above():
    env = ravemj.Environment()
    env.LoadData(TWO_AXES)
    hand = Hand(env)
    hand.press_key("b")
    for dof in (0, 1, 0):
        hand.gui.handle(Operate(row(hand, "turn")))
        assert hand.selection.dof == dof
    hand.gui.select(None)
    hand.gui.handle(Operate(row(hand, "weld")))
    assert hand.selection.dof == 0


def test_other_views_learn_what_a_script_selects(hand):
    other = hand.gui.another_view()
    hand.gui.handle(Operate("link 1 1"))
    before = other.appearance
    hand.gui.select(None)
    assert other.appearance != before


def test_who_is_asked_before_something_is_selected_is_asked_here_too(env):
    asked = []
    hand = Hand(env, on_select=lambda hit, ray: asked.append((hit.link, hit.distance > 0)) is not None)
    hand.press_key("b")
    hand.gui.handle(Operate("link 1 2"))
    assert asked == [(2, True)]
    assert hand.selection is None


def test_rows_that_a_search_leaves_in_a_window_are_not_indented(hand):
    assert any(row.text.startswith("  ") for row in hand.gui.controls.rows("")[1:])
    found = hand.gui.controls.rows("a")[1:]
    assert found
    assert not any(row.text.startswith(" ") for row in found)


@pytest.mark.parametrize("name", ["body", "body x", "body 9", "link 1 99", "joint 1 99", "link 1 -1", "tree 1"])
def test_rows_that_are_not_there_select_nothing(hand, name):
    hand.gui.handle(Operate(name))
    assert hand.selection is None


# --- in a window


def test_a_window_draws_the_rows_and_scrolls_them():
    env = ravemj.load("models/puma560.xml")
    env.SetViewer("offscreen")
    panel = Panel(env)
    panel.gui = env.GetViewer().interaction
    panel.gui.handle(Resize(960, 440))
    panel.gui.handle(Key("b"))
    panel.press("link 1 0")
    assert panel.selection.link == 0
    last = panel.gui.overlay().tree[-1].name
    assert last not in {control.name for control in panel.layout.places}
    panel.gui.handle(Move(*panel.middle("link 1 0")))
    panel.gui.handle(Wheel(-100))
    panel.press(last)
    assert panel.selection.link == len(env.GetRobots()[0].GetLinks()) - 1
    shown = [part for part in panel.gui.overlay().panels if part.is_left]
    assert shown[-1].text.strip() == env.GetRobots()[0].GetLinks()[-1].GetName()

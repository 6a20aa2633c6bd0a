"""What is typed into a window's panels: values of joints, and the search in the tree."""

import math

import pytest
from test_interaction import SIZE
from test_playback import Panel, chain

import ravemj
from ravemj.gui.interaction import Button, Key, Leave, Mode, Move, Operate, Press, Resize, Type
from ravemj.gui.viewers.window_overlay import OverlayPainter


class Keyboard(Panel):
    """Types as a keyboard does: keys, and the letters that they make."""

    def type(self, text):
        for letter in text:
            self.gui.handle(Key(letter.lower()))
            self.gui.handle(Type(letter))
            self.gui.handle(Key(letter.lower(), False))

    def enter(self, text):
        self.type(text)
        self.press_key("enter")

    def click_number(self, name):
        x, y, width, height = self.rect(name)
        self.click((x + width + 30, y + height / 2))

    @property
    def rows(self) -> list[str]:
        return [control.text.strip() for control in self.layout.places if control.group == "tree"]


@pytest.fixture
def keyboard(env):
    return opened(env, "joints")


def opened(env, menu) -> Keyboard:
    keyboard = Keyboard(env)
    keyboard.gui.handle(Operate(menu))
    return keyboard


# --- values of joints


def test_enter_sets_the_joint_to_what_was_typed(keyboard, robot):
    keyboard.click_number("dof 1")
    keyboard.type("0.57")
    keyboard.press_key("backspace")
    assert "0.5|" in {panel.text for panel in keyboard.gui.overlay().panels}
    assert not robot.GetDOFValues().any()
    keyboard.press_key("enter")
    assert robot.GetDOFValues().tolist() == [0, 0.5]
    keyboard.press_key("f1")
    assert keyboard.gui.overlay().help, "keys mean again what they mean elsewhere"


def test_values_are_in_the_unit_that_is_shown_and_stop_at_limits():
    env = ravemj.load("models/puma560.xml")
    keyboard, robot = opened(env, "joints"), env.GetRobots()[0]
    keyboard.gui.handle(Operate("units"))
    keyboard.click_number("dof 1")
    keyboard.enter("45")
    assert robot.GetDOFValues()[1] == pytest.approx(math.pi / 4)
    keyboard.click_number("dof 1")
    keyboard.enter("-9e9")
    assert robot.GetDOFValues()[1] == robot.GetDOFLimits()[0][1]


@pytest.mark.parametrize("text", ["", "pi", "1,5", "nan", "-inf", "1e999", "__import__('os')", "²"])
def test_what_is_no_number_is_said_and_changes_nothing(keyboard, robot, text):
    keyboard.click_number("dof 0")
    keyboard.enter(text)
    assert f"'{text}' is no number" in keyboard.gui.overlay().lines
    assert not robot.GetDOFValues().any()
    while f"{text}|" in {panel.text for panel in keyboard.gui.overlay().panels} and text:
        text = text[:-1]
        keyboard.press_key("backspace")
    keyboard.enter("1")
    assert robot.GetDOFValues()[0] == 1


def press_elsewhere(keyboard):
    keyboard.click((50, 150))


def fold(keyboard):
    keyboard.gui.handle(Operate("joints"))


@pytest.mark.parametrize("end", [lambda keyboard: keyboard.press_key("escape"), press_elsewhere, fold])
def test_escape_a_click_elsewhere_and_folding_end_it_without_a_change(keyboard, robot, end):
    keyboard.click_number("dof 0")
    keyboard.type("1")
    end(keyboard)
    assert keyboard.gui.mode is Mode.CAMERA
    keyboard.press_key("enter")
    assert not robot.GetDOFValues().any()
    before = keyboard.view.camera
    keyboard.press_key("5")
    assert keyboard.view.camera is not before


def test_a_number_of_a_body_that_is_gone_is_not_set(keyboard, env, robot):
    keyboard.click_number("dof 0")
    env.Remove(robot)
    keyboard.enter("1")
    env.Add(robot)
    assert not robot.GetDOFValues().any()


def test_letters_wait_while_others_have_the_simulation(keyboard, robot):
    keyboard.click_number("dof 0")
    events = [Key("1"), Type("1"), Key("1", False), Key("enter")]
    waiting = keyboard.gui.handle_view_events(events)
    assert waiting == events
    for event in waiting:
        keyboard.gui.handle(event)
    assert robot.GetDOFValues()[0] == 1


def test_the_pointer_shows_where_can_be_typed(keyboard):
    x, y, width, height = keyboard.rect("dof 0")
    for column, cursor in ((x + width + 30, "text"), (x + 5, "pointer"), (x - 20, "grab")):
        keyboard.gui.handle(Move(column, y + height / 2))
        assert keyboard.gui.overlay().cursor == cursor
    keyboard.gui.handle(Leave())
    assert keyboard.gui.overlay().cursor == "grab"


# --- the search in the tree


def test_what_is_typed_in_the_search_is_what_is_left_of_the_tree(env):
    keyboard = opened(env, "tree")
    assert len(keyboard.rows) == 6
    keyboard.press("search")
    keyboard.type("aRm")
    assert keyboard.rows == ["Arm0", "Arm1"]
    keyboard.type(" 1")
    assert keyboard.rows == ["Arm1"]
    press_elsewhere(keyboard)
    assert keyboard.rows == ["Arm1"], "it stays, so that rows can be clicked on"
    keyboard.press("search")
    keyboard.press_key("escape")
    assert len(keyboard.rows) == 6


def test_enter_selects_what_was_found_one_after_the_other(env):
    keyboard = opened(env, "tree")
    keyboard.press("search")
    keyboard.enter("nothing has this name")
    assert keyboard.selection is None
    for _ in range(30):
        keyboard.press_key("backspace")
    keyboard.type("arm")
    for link in (1, 2, 1):
        keyboard.press_key("enter")
        assert (keyboard.selection.link, keyboard.selection.dof) == (link, None)
    keyboard.enter("1")
    keyboard.press_key("enter")
    assert keyboard.selection.link == 2, "the only one stays selected"
    keyboard.press_key("escape")
    keyboard.press("search")
    keyboard.enter("joint1")
    assert keyboard.selection.dof == 1


def test_what_is_selected_in_the_picture_is_scrolled_to():
    env = ravemj.Environment()
    env.LoadData(chain(60))
    keyboard = opened(env, "tree")
    assert "b50" not in keyboard.rows
    keyboard.gui.handle(Operate("link 1 50"))
    assert keyboard.rows[0] == "b50"
    keyboard.gui.handle(Operate("link 1 51"))
    assert keyboard.rows[0] == "b50", "it is seen already"
    keyboard.press("link 1 51")
    assert keyboard.selection is None


@pytest.mark.parametrize("width", [SIZE[0], 480, 400])
def test_long_names_are_cut_in_the_middle_and_whole_under_the_pointer(width):
    env = ravemj.Environment()
    env.LoadData(
        chain(30).replace("a_joint_with_a_long_name", "a_joint_with_a_name_so_long_that_no_row_has_any_room_for_it")
    )
    keyboard = opened(env, "tree")
    keyboard.gui.handle(Resize(width, SIZE[1]))
    keyboard.press("search")
    keyboard.type("room")
    place, shown = keyboard.middle("joint 1 7"), [panel for panel in keyboard.gui.overlay().panels if panel.is_left]
    assert all(OverlayPainter()._width(panel.text) < panel.rect.width - 8 for panel in shown)
    assert any(".." in panel.text and panel.text.endswith("_7") for panel in shown)
    keyboard.gui.handle(Move(*place))
    assert "Joint a_joint_with_a_name_so_long_that_no_row_has_any_room_for_it_7" in keyboard.gui.overlay().lines


def test_only_the_left_button_begins_to_type(keyboard):
    x, y, width, height = keyboard.rect("dof 0")
    keyboard.gui.handle(Press(x + width + 30, y + height / 2, Button.RIGHT))
    keyboard.enter("1")
    assert not keyboard.env.GetRobots()[0].GetDOFValues().any()

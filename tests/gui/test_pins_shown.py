"""Pinned limbs with real events: in a page of a browser, and in a window of a screen."""

import numpy as np
import pytest
from browsers import NEEDS_A_BROWSER
from browsers import Desk as PageDesk
from command_line import colour_of
from conftest import MODELS
from desk import SIZE
from desk import Desk as WindowDesk
from screens import NEEDS_A_SCREEN
from waiting import await_that

import ravemj
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction.control import Control
from ravemj.gui.interaction.control_layout import ControlLayout

CAMERA = ravemj.transformLookat(lookat=[0, 0, 0.5], camerapos=[1.6, -1.2, 0.9], cameraup=[0, 0, -1])
RIGHT, DOWN = CAMERA[:3, 0], CAMERA[:3, 1]
FEET = "LFoot", "RFoot"
GIVES_IN = "RHand gives in: the pins and the limits let it go no further"


def middle(robot, link) -> np.ndarray:
    return robot.GetLink(link).ComputeAABB().pos()


def head_of_pin(robot, link) -> np.ndarray:
    """The end of the stalk, where the head is a sphere; feet are parallel to the axes."""
    box = robot.GetLink(link).ComputeAABB()
    return box.pos() + np.linalg.norm(box.extents()) * np.array([1.2, 0, 1.2])


class Limbs:
    """The biped in a viewer, driven by a desk; a subclass reads what is there."""

    def __init__(self, desk) -> None:
        self.desk = desk

    def look(self, expression: str) -> np.ndarray:
        """Return an array of the viewer's robot."""
        raise NotImplementedError

    def feet(self) -> np.ndarray:
        return np.array([self.look(f"robot.GetLink({foot!r}).GetTransform()") for foot in FEET])

    def base(self) -> np.ndarray:
        return self.look("robot.GetTransform()")

    def hand(self) -> np.ndarray:
        return self.look("robot.GetLink('RHand').ComputeAABB().pos()")

    def press_key(self) -> None:
        raise NotImplementedError

    def press_button(self) -> None:
        """Press the button Pin."""
        raise NotImplementedError

    def button_is_on(self) -> bool:
        raise NotImplementedError

    def is_pinned(self, foot: str) -> bool:
        """Whether the head of a pin is seen."""
        x, y = self.desk.at(head_of_pin(self.desk.robot, foot))
        return colour_of(self.desk.picture()[y - 1 : y + 2, x - 1 : x + 2]) == "red"

    def pin(self, foot: str) -> None:
        """Press P with the pointer over a foot."""
        self.desk.move(*self.desk.at(middle(self.desk.robot, foot)))
        self.press_key()

    def pull(self, *targets: np.ndarray) -> None:
        """Drag the hand to points, and hold it there."""
        self.desk.press(self.desk.at(self.hand()), keys=self.PULL)
        for target in targets:
            self.desk.move(*self.desk.at(target))

    def let_go(self, target: np.ndarray) -> None:
        self.desk.release(self.desk.at(target), keys=self.PULL)


class Page(Limbs):
    PULL = ("Control", "Shift")

    def look(self, expression: str) -> np.ndarray:
        return np.array(eval(expression, {"robot": self.desk.robot}))

    def press_key(self) -> None:
        self.desk.page.keyboard.press("p")

    def _button(self):
        return self.desk.page.get_by_role("button", name="Pin the selected link")

    def press_button(self) -> None:
        self._button().click()

    def button_is_on(self) -> bool:
        return self._button().get_attribute("data-on") == "true"

    @property
    def lines(self) -> list[str]:
        return self.desk.lines


class Window(Limbs):
    PULL = ("ctrl", "shift")

    def look(self, expression: str) -> np.ndarray:
        return self.desk.array(expression)

    def press_key(self) -> None:
        self.desk.display.tool("key", "p")

    def _controls(self) -> tuple[Control, ...]:
        text = self.desk.ask("[(c.name, c.text, c.is_on, c.group) for c in viewer.interaction.overlay().controls]")
        return tuple(Control(name, name, text, is_on=is_on, group=group) for name, text, is_on, group in eval(text))

    def press_button(self) -> None:
        places = ControlLayout.arrange(self._controls(), SIZE).places
        x, y, width, height = next(rect for control, rect in places.items() if control.name == "pin")
        at = str(round(x + width / 2)), str(round(y + height / 2))
        self.desk.display.tool("mousemove", "--window", self.desk.window, *at)
        self.desk.display.tool("click", "1")

    def button_is_on(self) -> bool:
        return [control.is_on for control in self._controls() if control.name == "pin"] == [True]

    @property
    def lines(self) -> list[str]:
        return list(self.desk.lines)


@pytest.fixture(
    params=[
        pytest.param("page", marks=NEEDS_A_BROWSER),
        pytest.param("window", marks=[*NEEDS_A_SCREEN, pytest.mark.stress]),
    ]
)
def limbs(request, tmp_path):
    """The biped, seen from its right, in interaction mode."""
    if request.param == "page":
        desk = PageDesk(request.getfixturevalue("browser"), lambda: ravemj.load(MODELS / "biped.robot.xml"))
        desk.viewer.SetCamera(CAMERA, 2.0)
        limbs = Page(desk)
    else:
        (tmp_path / "biped.robot.xml").write_bytes((MODELS / "biped.robot.xml").read_bytes())
        desk = WindowDesk(request.getfixturevalue("display"), tmp_path).show("biped.robot.xml", CAMERA)
        limbs = Window(desk)
    desk.core.look_from(Camera(CAMERA), 2.0)
    if request.param == "page":
        desk.await_camera()
    desk.escape()
    yield limbs
    desk.close()


def test_pinned_feet_stay_while_a_hand_is_pulled(limbs):
    """And the base moves; what is out of reach is named in the status line."""
    for foot in FEET:
        assert not limbs.is_pinned(foot)
        limbs.pin(foot)
        await_that(lambda foot=foot: limbs.is_pinned(foot), f"no pin is seen on {foot}")
    feet, base, start = limbs.feet(), limbs.base(), limbs.hand()
    target = start + 0.1 * RIGHT + 0.1 * DOWN
    limbs.pull((start + target) / 2, target)
    await_that(lambda: np.linalg.norm(limbs.hand() - target) < 0.05, "the hand does not come to the pointer")
    assert np.abs(limbs.base() - base).max() > 1e-3
    np.testing.assert_allclose(limbs.feet(), feet, rtol=0, atol=1e-6)
    limbs.let_go(target)

    now = limbs.hand()
    beyond = now - 1.4 * DOWN
    limbs.pull((now + beyond) / 2, beyond)
    await_that(lambda: GIVES_IN in limbs.lines, "nothing says who gives in")
    np.testing.assert_allclose(limbs.feet(), feet, rtol=0, atol=1e-6)
    limbs.let_go(beyond)


@pytest.mark.stress
def test_without_pins_the_base_stays(limbs):
    base, start = limbs.base(), limbs.hand()
    target = start + 0.05 * RIGHT - 0.05 * DOWN
    limbs.pull((start + target) / 2, target)
    await_that(lambda: np.linalg.norm(limbs.hand() - start) > 0.02, "the hand stays")
    np.testing.assert_array_equal(limbs.base(), base)
    limbs.let_go(target)


@pytest.mark.stress
def test_the_button_pins_the_selected_limb_and_takes_the_pin_out(limbs):
    desk = limbs.desk
    desk.click(desk.at(middle(desk.robot, "LFoot")))
    await_that(lambda: any("LFoot" in line or "Biped" in line for line in limbs.lines), "nothing is selected")
    for is_on in (True, False):
        limbs.press_button()
        await_that(lambda is_on=is_on: limbs.button_is_on() is is_on, f"the button does not become {is_on}")
        await_that(lambda is_on=is_on: limbs.is_pinned("LFoot") is is_on, f"the pin is not {is_on}")

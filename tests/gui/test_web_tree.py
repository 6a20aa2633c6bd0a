"""The tree and simulation time on the page, in a real browser, with mouse and keys."""

import pytest
from browsers import NEEDS_A_BROWSER, Desk
from conftest import MODELS
from waiting import await_that

import ravemj

pytestmark = NEEDS_A_BROWSER


@pytest.fixture(scope="module")
def desk(browser):
    desk = Desk(browser, lambda: ravemj.load(MODELS / "env.xml"))
    yield desk
    assert desk.troubles == []
    desk.close()


def row(desk, name):
    return desk.page.get_by_role("treeitem", name=name)


def selected(desk) -> list[str]:
    return desk.page.evaluate("[...document.querySelectorAll('#tree [aria-selected=true]')].map((row) => row.title)")


def test_the_tree_selects_in_the_picture_and_the_picture_in_the_tree(desk):
    desk.page.get_by_role("button", name="Bodies, links and joints").click()
    await_that(lambda: row(desk, "Arm1").is_visible(), "no tree")
    row(desk, "Joint1").click()
    await_that(lambda: desk.viewer.GetSelectedJoint() is not None, "no joint")
    assert desk.viewer.GetSelectedJoint().GetName() == "Joint1"
    await_that(lambda: selected(desk) == ["body Pendulum", "joint Joint1", "link Arm1"], "other rows are marked")
    desk.viewer.interaction.select(None)
    await_that(lambda: selected(desk) == [], "the marks stay")
    search = desk.page.get_by_role("searchbox")
    search.fill("ARM")
    assert not row(desk, "Base").is_visible()
    search.press("ArrowDown")
    desk.page.keyboard.press("ArrowDown")
    desk.page.keyboard.press("Enter")
    await_that(lambda: selected(desk) == ["body Pendulum", "link Arm1"], "the keys choose another row")
    search.fill("")
    assert row(desk, "Base").is_visible()
    desk.page.keyboard.press("Control+A")  # keys are for the search while that has the focus
    desk.page.focus("#view")
    desk.page.keyboard.press("b")
    await_that(lambda: not desk.page.locator("#tree").is_visible(), "the tree stays")


def test_time_is_paused_stepped_and_paced(desk):
    clock = desk.viewer.GetEnv().clock
    assert not desk.page.locator("#time").is_visible()
    desk.viewer.GetEnv().SetPhysicsEngine("mujoco")
    desk.viewer.GetEnv().StartSimulation(0.01)
    await_that(lambda: desk.page.locator("#time").is_visible(), "no controls")
    desk.page.get_by_role("button", name="Stop simulation time").click()
    await_that(lambda: not clock.is_running, "time goes on")
    before = clock.now
    desk.page.get_by_role("button", name="One step of simulation time").click()
    await_that(lambda: clock.now == before + 10_000, "no step")
    desk.page.focus("#view")
    desk.page.keyboard.press("-")
    await_that(lambda: clock.pace == 0.5, "the pace stays")
    desk.page.keyboard.press("Space")
    await_that(lambda: clock.is_running, "time stands still")
    await_that(lambda: desk.page.text_content("#time output").endswith("x"), "the clock does not say how fast it is")
    desk.page.keyboard.press("Space")
    await_that(lambda: not clock.is_running, "time goes on")


def test_a_file_that_is_dropped_is_added(desk):
    shape = '<Geom type="sphere"><radius>0.1</radius></Geom>'
    model = f'<KinBody name="cup"><!-- {"long " * 500}--><Body>{shape}</Body></KinBody>'
    dropped = desk.page.evaluate_handle(
        "xml => { const data = new DataTransfer(); data.items.add(new File([xml], 'my cup.xml')); return data; }", model
    )
    desk.page.dispatch_event("#view", "drop", {"dataTransfer": dropped})
    await_that(lambda: desk.env.GetKinBody("cup") is not None, "it is not added")
    await_that(lambda: "Added my cup.xml" in desk.page.text_content("#text"), "the view does not say so")

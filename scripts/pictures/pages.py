"""Takes pictures of the viewer's page in Chromium: ``python scripts/pictures/pages.py docs/pictures``."""

import shutil
import sys
from pathlib import Path

from playwright.sync_api import Browser, Page, Playwright, sync_playwright

import ravemj
from ravemj.gui.viewers import Viewer

DESK = {"viewport": {"width": 640, "height": 480}}
PHONE = {"viewport": {"width": 360, "height": 600}, "device_scale_factor": 2, "is_mobile": True, "has_touch": True}

SANDBOX = ["--no-sandbox"]
SOFTWARE = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]


def main(folder: Path) -> None:
    """Select a joint on a desk, the robot on a phone and a joint in the tree, with a picture of each."""
    env = ravemj.load("models/env.xml")
    viewer, robot = env.serve_viewer(), env.GetRobots()[0]
    viewer.SetBkgndColor([0.8, 0.85, 0.9])
    viewer.SetCamera([[-0.643, 0.324, -0.694, 0.755], [0.766, 0.272, -0.583, 0.634], [0, -0.906, -0.423, 0.285]])
    robot.SetDOFValues([0.3, 0.7])
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=SANDBOX)
        desk, at = opened(browser, viewer, DESK)
        desk.keyboard.press("Escape")
        desk.mouse.move(*at)
        desk.keyboard.down("Control")
        desk.mouse.click(*at)
        desk.keyboard.up("Control")
        take(desk, folder / "web-joint.png")
        phone, at = opened(browser, viewer, PHONE)
        phone.touchscreen.tap(*at)
        take(phone, folder / "web-phone.png")
        env.Destroy()
        take_tree(browser, folder / "web-tree.png")
        browser.close()
        take_both(playwright, folder)


def take_tree(browser: Browser, path: Path) -> None:
    """Select a joint of an arm in the tree, and take a picture."""
    env = ravemj.load("models/panda.xml")
    viewer = env.serve_viewer()
    viewer.SetBkgndColor([0.8, 0.85, 0.9])
    eye, middle = [1.5, -0.9, 0.8], [0.05, 0.35, 0.45]
    viewer.SetCamera(ravemj.transformLookat(lookat=middle, camerapos=eye, cameraup=[0, 0, -1]), 1.9)
    env.GetRobots()[0].SetDOFValues([0.2, -0.6, 0.1, -2.0, 0.0, 1.5, 0.8], range(7))
    page = browser.new_context(viewport={"width": 960, "height": 640}).new_page()
    page.goto(viewer.url)
    page.wait_for_selector("[data-crisp=true]")
    page.get_by_role("button", name="Interaction mode").click()
    page.keyboard.press("b")
    page.get_by_role("treeitem").nth(8).click()
    take(page, path)
    env.Destroy()


def take_both(playwright: Playwright, folder: Path) -> None:
    """Take a picture of a page that draws by itself, and of one that shows pictures, of the same arm."""
    env = ravemj.load("models/puma560.xml")
    viewer, robot = env.serve_viewer(), env.GetRobots()[0]
    viewer.SetBkgndColor([0.8, 0.85, 0.9])
    robot.SetDOFValues([0.5, -0.7, 0.6], [0, 1, 2])
    T_world_camera = env.renderer.camera_for_stills(4 / 3).T_world_camera
    viewer.SetCamera(T_world_camera @ ravemj.matrixFromPose([1, 0, 0, 0, 0, 0, -0.5]))
    middle = robot.GetLinks()[0].ComputeAABB().pos()
    ((x, y),), _ = viewer.camera.project([middle], DESK["viewport"]["width"], DESK["viewport"]["height"])
    browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=[*SANDBOX, *SOFTWARE])
    for name, query in (("web-drawn", ""), ("web-picture", "?pictures")):
        page = browser.new_context(**DESK).new_page()
        page.goto(viewer.url + query)
        page.wait_for_selector("[data-crisp=true]")
        for key in ("Escape", "l"):  # the frames of the links
            page.keyboard.press(key)
            page.keyboard.up(key)
        page.mouse.click(x, y)
        page.mouse.move(500, 400)
        take(page, folder / f"{name}.png")
        page.mouse.click(x, y)
        page.keyboard.press("l")
        page.context.close()
    browser.close()
    env.Destroy()


def opened(browser: Browser, viewer: Viewer, device: dict) -> tuple[Page, tuple[float, float]]:
    """Open the page; return it, and where the blue arm is on it."""
    page = browser.new_context(**device).new_page()
    page.goto(viewer.url)
    page.wait_for_selector("[data-crisp=true]")
    arm = (viewer.GetEnv().GetRobots()[0].GetLinks()[2].GetTransform() @ [0.15, 0, 0, 1])[:3]
    ((x, y),), _ = viewer.camera.project([arm], device["viewport"]["width"], device["viewport"]["height"])
    return page, (x, y)


def take(page: Page, path: Path) -> None:
    """Save a picture once something is selected and nothing moves any more."""
    page.locator("#text", has_text="Robot").wait_for()
    page.wait_for_selector("[data-mode=interaction][data-crisp=true]")
    page.screenshot(path=path)


if __name__ == "__main__":
    main(Path(sys.argv[1]))

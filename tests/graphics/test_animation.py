"""Motions as pages: what is packed, and what a browser without a network makes of it."""

import base64
import html
import io
import json
import re
import zlib

import numpy as np
import pytest
from browsers import NEEDS_A_BROWSER
from command_line import run
from conftest import MODELS, one_in
from PIL import Image
from waiting import await_that

import ravemj
from ravemj.errors import ArgumentError, OutputError
from ravemj.graphics.rendering import Camera, open_renderer
from ravemj.graphics.webgl.packing import octahedral
from ravemj.graphics.webgl.surfaces import surfaces

TYPES = {"i8": np.int8, "u16": np.uint16, "u32": np.uint32, "f32": np.float32}
ALL_SHAPES = """<Environment><KinBody name="all"><Body>
<Geom type="box"><extents>0.1 0.2 0.3</extents><translation>-1 0 0</translation></Geom>
<Geom type="sphere"><radius>0.25</radius></Geom>
<Geom type="cylinder"><radius>0.1</radius><height>0.8</height><translation>1 0 0</translation>
  <rotationaxis>1 0 0 40</rotationaxis></Geom>
<Geom type="capsule"><radius>0.1</radius><height>0.5</height><translation>0 0.8 0</translation>
  <rotationaxis>0 1 0 50</rotationaxis></Geom>
</Body></KinBody></Environment>"""

ABOVE = [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 1.6], [0, 0, 0, 1]]

NEAR = [[1, 0, 0, 0.05], [0, -1, 0, 0.1], [0, 0, -1, 0.5], [0, 0, 0, 1]]
BLUE = [0, 0, 102]


class Page:
    """What is in a page."""

    def __init__(self, text: str) -> None:
        packed = re.search(r'<script id="scene" type="text/plain">([^<]*)</script>', text)[1]
        content = zlib.decompress(base64.b64decode(packed))
        start = 4 + int.from_bytes(content[:4], "little")
        self.document = json.loads(content[4:start])
        self._arrays = content[start:]

    def array(self, name):
        return np.frombuffer(self._arrays, TYPES[name["type"]], name["count"], name["at"])

    def columns(self, packed):
        whole = np.cumsum(self.array(packed["columns"]).reshape(len(packed["low"]), -1), axis=1, dtype=np.uint16)
        return whole.T * packed["step"] + packed["low"]


def all_shapes() -> ravemj.Environment:
    env = ravemj.Environment()
    env.LoadData(ALL_SHAPES)
    tetrahedron = ravemj.RaveCreateKinBody(env, "")
    corners = np.array([[0.3, 0.3, 0], [0.9, 0.3, 0], [0.3, 0.9, 0], [0.3, 0.3, 0.6]])
    tetrahedron.InitFromTrimesh(ravemj.TriMesh(corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]), True)
    tetrahedron.SetName("tetrahedron")
    env.Add(tetrahedron)
    return env


def swing(env) -> ravemj.Motion:
    return ravemj.Motion.line([0, 0], [1.5, -0.8], duration=1.0)


def test_poses_are_those_of_the_motion(env, robot):
    motion = swing(env)
    page = Page(env.animation(motion, fps=20).html)
    assert page.document["bodies"] == ["world", "Base", "Arm0", "Arm1"]
    assert page.document["moving"]["bodies"] == [2, 3]
    assert page.document["still"]["bodies"] == [0, 1]
    poses = page.columns(page.document["moving"]).reshape(-1, 2, 7)
    assert len(poses) == page.document["frames"] == 21
    assert page.columns(page.document["values"]) == pytest.approx(np.array(list(motion.frames(20))), abs=2e-5)
    for values, row in zip(motion.frames(20), poses, strict=True):
        robot.SetDOFValues(values)
        expected = ravemj.poseFromMatrix(robot.GetLink("Arm1").GetTransform())
        expected *= np.sign(expected[:4] @ row[1, 3:])
        assert row[1] == pytest.approx([*expected[4:], *expected[:4]], abs=5e-5)


def test_quaternions_take_the_short_way_from_frame_to_frame(env):
    """A turn by 3 pi passes the place where quaternions change their signs."""
    page = Page(env.animation(ravemj.Motion.line([0, 0], [3 * np.pi, 0], duration=1.0)).html)
    quaternions = page.columns(page.document["moving"])[:, 3:7]
    assert (np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) > 0.9).all()


def test_normals_survive_as_two_bytes():
    normals = np.random.default_rng(0).normal(size=(1000, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    x, y = octahedral(normals).T / 127
    z = 1 - abs(x) - abs(y)
    signs = np.where(x < 0, -1, 1), np.where(y < 0, -1, 1)
    unfolded = np.where(z < 0, [(1 - abs(y)) * signs[0], (1 - abs(x)) * signs[1]], [x, y])
    again = np.stack([*unfolded, z], axis=1)
    again /= np.linalg.norm(again, axis=1, keepdims=True)
    assert np.degrees(np.arccos(np.clip(np.einsum("ij,ij->i", again, normals), -1, 1))).max() < 1


def test_surfaces_are_closed_and_look_outwards():
    model = all_shapes().simulation.compiled().model
    shown = surfaces(model)
    volumes = []
    for shape in shown.shapes:
        mesh = shown.meshes[shape.mesh]
        corners = (mesh.positions @ shape.T_body_shape[:, :3].T)[mesh.triangles]
        volumes.append(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6)
        faces = np.cross(*np.moveaxis(np.diff(mesh.positions[mesh.triangles], axis=1), 1, 0))
        assert (np.einsum("ij,ikj->ik", faces, mesh.normals[mesh.triangles]) > 0).all()
    capsule = np.pi * 0.01 * 0.5 + 4 / 3 * np.pi * 0.001
    expected = [8 * 0.006, 4 / 3 * np.pi * 0.25**3, np.pi * 0.01 * 0.8, capsule, 0.6**3 / 6]
    assert volumes == pytest.approx(expected, rel=0.02)


def test_shapes_of_one_kind_share_a_mesh():
    env = ravemj.Environment()
    env.Load(str(MODELS / "workshop.env.xml"))
    shown = surfaces(env.simulation.compiled().model)
    assert len(shown.meshes) < len(shown.shapes) / 2


def test_the_robot_stays_at_the_end_and_values_outside_the_limits_stop_there():
    env = ravemj.load(MODELS / "puma560.xml")
    robot = env.GetRobots()[0]
    lower, upper = robot.GetDOFLimits()
    with pytest.warns(ravemj.RavemjWarning, match="stops at the limit"):
        page = env.animation(ravemj.Motion.line(lower, upper + 1, duration=1.0))
    assert robot.GetDOFValues() == pytest.approx(upper)
    document = Page(page.html).document
    assert [joint["name"] for joint in document["joints"]] == [joint.GetName() for joint in robot.GetJoints()]
    assert {joint["unit"] for joint in document["joints"]} == {"rad"}


def test_scenes_without_a_motion_and_without_anything():
    for env in (ravemj.load(MODELS / "env.xml"), ravemj.Environment()):
        document = Page(env.animation().html).document
        assert document["frames"] == 1
        assert document["moving"] == {"bodies": []}


def test_names_cannot_leave_their_places(env, robot, tmp_path):
    robot.SetName("</title><script>alert(1)</script>{{scene}}")
    text = env.save_html(tmp_path / "a.html", swing(env)).read_text()
    assert "alert(1)</script>" not in text
    assert html.escape(robot.GetName()) in text
    assert text.count('id="scene"') == 1
    assert "&lt;script" in env.animation(swing(env))._repr_html_()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"fps": 0}, "frames a second"),
        ({"fps": float("nan")}, "frames a second"),
        ({"camera": np.zeros((4, 4))}, "last row"),
        ({"background": "blue"}, "colour"),
        ({"motion": ravemj.Motion.line([0], [1], duration=1.0)}, "1 joints"),
    ],
)
def test_wrong_arguments_write_nothing(env, tmp_path, arguments, words):
    with pytest.raises(ArgumentError, match=words):
        env.save_html(tmp_path / "a.html", **{"motion": swing(env), **arguments})
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_told_at_once(env, tmp_path):
    with pytest.raises(OutputError, match="there is no folder"):
        env.save_html(tmp_path / "nowhere" / "a.html", swing(env))


def test_a_pendulum_is_a_small_file(env):
    assert len(env.animation(swing(env)).html) < 300_000


class Player:
    """A page of a motion in a browser, and a renderer that knows how it should look."""

    def __init__(self, page) -> None:
        self.page = page

    def at(self, time: float) -> None:
        self.page.evaluate("time => { ravemj.isPlaying = false; ravemj.seek(time); }", time)

    def camera(self) -> Camera:
        rotation, position, fovy = self.page.evaluate("[ravemj.view.rotation, ravemj.view.position, ravemj.view.fovy]")
        T_world_camera = np.eye(4)
        T_world_camera[:3, :3], T_world_camera[:3, 3] = np.reshape(rotation, (3, 3)), position
        return Camera(T_world_camera, fovy=fovy)

    def size(self) -> tuple[int, int]:
        return tuple(self.page.evaluate("[ravemj.canvas.width, ravemj.canvas.height]"))

    def picture(self) -> np.ndarray:
        """Return what is drawn now, crisp."""
        address = self.page.evaluate(
            "() => { ravemj.sharpness.isAtRest = true; ravemj.draw(); return ravemj.canvas.toDataURL(); }"
        )
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(address.partition(",")[2]))).convert("RGB"))


@pytest.fixture(scope="module")
def opened(tmp_path_factory, webgl_browser):
    """Open the file of an environment in a browser without a network."""

    def open_page(text: str, before: str = "", viewport=(320, 291), **context) -> Player:
        path = tmp_path_factory.mktemp("page") / "a.html"
        path.write_text(text, encoding="utf-8")
        context = webgl_browser.new_context(
            viewport=dict(zip(("width", "height"), viewport, strict=True)), offline=True, **context
        )
        context.add_init_script(before)
        page = context.new_page()
        page.troubles, page.requests = [], []
        page.on("pageerror", lambda error: page.troubles.append(str(error)))
        page.on("console", lambda message: page.troubles.append(message.text))
        page.on("request", lambda request: page.requests.append(request.url))
        page.goto(path.as_uri())
        await_that(lambda: page.evaluate("!!window.ravemj || !document.getElementById('error').hidden"))
        return Player(page)

    return open_page


def silhouette(env, camera: Camera, size) -> np.ndarray:
    compiled = env.simulation.compiled()
    with open_renderer(compiled.model, *size, backend="ray") as renderer:
        return renderer.segment(compiled.data, camera) >= 0


def dilated(mask: np.ndarray, pixels: int) -> np.ndarray:
    padded = np.pad(mask, pixels)
    return np.any(
        [
            padded[row : row + mask.shape[0], column : column + mask.shape[1]]
            for row in range(2 * pixels + 1)
            for column in range(2 * pixels + 1)
        ],
        axis=0,
    )


def assert_same_silhouette(player: Player, env) -> None:
    drawn = np.abs(player.picture().astype(int) - BLUE).max(axis=2) > 8
    expected = silhouette(env, player.camera(), drawn.shape[::-1])
    assert expected.mean() > 0.005
    assert not (drawn & ~dilated(expected, 2)).any()
    assert not (expected & ~dilated(drawn, 2)).any()


MOVED = """<Robot name="moved"><KinBody>
<Body name="a"><Geom type="box"><extents>0.1 0.1 0.1</extents></Geom></Body>
<Body name="b"><offsetfrom>a</offsetfrom><translation>0.1 0 0.3</translation><rotationaxis>1 2 3 40</rotationaxis>
  <Geom type="box"><extents>0.1 0.1 0.1</extents></Geom></Body>
<Body name="c"><offsetfrom>b</offsetfrom><translation>0.3 0.1 0</translation>
  <Geom type="box"><extents>0.1 0.1 0.1</extents></Geom></Body>
<Body name="d"><offsetfrom>c</offsetfrom><translation>0 0.2 0</translation>
  <Geom type="box"><extents>0.1 0.1 0.1</extents></Geom></Body>
<Joint name="turn" type="hinge"><Body>a</Body><Body>b</Body><offsetfrom>a</offsetfrom><anchor>0.05 0.02 0.1</anchor>
  <axis>1 1 0</axis><limitsdeg>-50 120</limitsdeg></Joint>
<Joint name="slide" type="slider"><Body>b</Body><Body>c</Body><offsetfrom>b</offsetfrom><axis>0 1 1</axis>
  <limits>-0.1 0.4</limits></Joint>
<Joint name="follow" type="hinge" MIMIC_POS><Body>c</Body><Body>d</Body><offsetfrom>c</offsetfrom><axis>0 0 1</axis>
  <limits>-3 3</limits></Joint>
</KinBody></Robot>"""
"""A base, a hinge, a slider, and a hinge that may follow."""


def moved(equation):
    env = ravemj.Environment()
    env.LoadData(MOVED.replace("MIMIC_POS", f'mimic_pos="{equation}" mimic_vel="|turn 1"' if equation else ""))
    env.GetRobots()[0].SetTransform(ravemj.matrixFromPose([0.5, -0.5, 0.7, 0.1, 1, 2, 3]))
    return env


def test_sliders_have_the_limits_and_values_of_the_joints():
    env = moved("2*turn")
    robot = env.GetRobots()[0]
    robot.SetDOFValues([0.4, 0.1])
    before = robot.GetLinkTransformations()
    sliders = Page(env.animation().html).document["mechanism"]["sliders"]
    assert [(one["name"], one["unit"], one["value"]) for one in sliders] == [("turn", "rad", 0.4), ("slide", "m", 0.1)]
    limits = np.array([(one["low"], one["high"]) for one in sliders])
    np.testing.assert_allclose(limits.T, robot.GetDOFLimits())
    np.testing.assert_array_equal(robot.GetLinkTransformations(), before)


def test_pages_of_motions_have_no_sliders(env):
    assert Page(env.animation(swing(env)).html).document["mechanism"] is None


class TestInABrowser:
    pytestmark = NEEDS_A_BROWSER

    @pytest.mark.filterwarnings("ignore:.*follows several joints")
    @pytest.mark.parametrize("equation", one_in(4, ["sin(turn)+0.5*slide", "", "2*turn-0.3", "turn*turn"]))
    def test_sliders_move_the_links_as_forward_kinematics_does(self, opened, equation):
        env, random = moved(equation), np.random.default_rng(3)
        robot = env.GetRobots()[0]
        robot.SetDOFValues(0.1 * np.ones(robot.GetDOF()))
        page = opened(env.animation().html).page
        exact = 1e-12 if "turn*" not in equation and "sin" not in equation else 2e-4  # from a table of 129 values
        for values in random.uniform(*robot.GetDOFLimits(), (4, robot.GetDOF())):
            for slider, value in zip(page.locator("#values input").all(), values, strict=True):
                slider.evaluate("(box, value) => { box.value = value; box.dispatchEvent(new Event('input')); }", value)
            robot.SetDOFValues(page.evaluate("ravemj.jointValues()"))
            await_that(lambda: not page.evaluate("ravemj.isDue"))
            shown = np.array(page.evaluate("ravemj.renderer.poses"))[-4:].reshape(4, 3, 4)
            np.testing.assert_allclose(shown[1:], np.array(robot.GetLinkTransformations())[1:, :3], atol=exact)
            np.testing.assert_allclose(robot.GetDOFValues(), values, atol=1e-6)

    @pytest.mark.stress
    def test_frames_of_the_links_are_shown(self, opened):
        env = moved("")
        player = opened(env.animation().html)
        player.page.get_by_role("button", name="Frames of the links").click()
        lines = player.page.evaluate("(() => { const { corners } = ravemj.frameLines(); return [...corners]; })()")
        T_world_link = np.array(env.GetRobots()[0].GetLinkTransformations())
        ends = np.array(lines).reshape(4, 3, 2, 3)
        np.testing.assert_allclose(ends[:, :, 0], np.repeat(T_world_link[:, None, :3, 3], 3, axis=1), atol=1e-6)
        axes = ends[:, :, 1] - ends[:, :, 0]
        length = np.linalg.norm(axes[0, 0])
        np.testing.assert_allclose(axes / length, T_world_link[:, :3, :3].transpose(0, 2, 1), atol=1e-5)
        await_that(lambda: player.page.evaluate("ravemj.renderer.groups.get('frames')?.strokes.length") == 1)

    @pytest.mark.parametrize("viewport", one_in(3, [(390, 844), (844, 390), (600, 650)]))
    @pytest.mark.parametrize("camera", one_in(2, [None, NEAR]))
    def test_narrow_pages_show_all_that_a_picture_shows(self, env, robot, opened, viewport, camera):
        robot.SetDOFValues([1.2, 0])
        player = opened(env.animation(camera=camera).html, viewport=viewport)
        width, height = player.size()
        chosen = env.default_camera(4 / 3) if camera is None else Camera.from_matrix(camera)
        smallest = 1 if camera is None else 4 / 3
        wider = max(1, smallest * height / width)
        assert player.camera().fovy == pytest.approx(2 * np.arctan(wider * np.tan(chosen.fovy / 2)))
        tips = [(link @ [0.2, 0, 0, 1])[:3] for link in robot.GetLinkTransformations()[1:]]
        if camera is None:
            pixels, _ = player.camera().project(tips, width, height)
            assert (pixels > 0).all()
            assert (pixels < [width, height]).all()
        player.page.set_viewport_size({"width": 1200, "height": 600})
        await_that(lambda: player.page.evaluate("ravemj.view.fovy") == pytest.approx(chosen.fovy))
        player.page.keyboard.press("Home")
        assert player.page.evaluate("ravemj.view.fovy") == pytest.approx(chosen.fovy)

    def test_it_shows_the_poses_of_the_motion_from_every_side(self, env, robot, opened):
        motion = swing(env)
        player = opened(env.animation(motion, background=[0, 0, 0.4]).html)
        views = ["", "turned(40, 25, 240)", "shifted(30, -10, 240)", "zoomed(0.5)"]
        for time, view in zip((0.0, 0.35, 0.8, 1.0), views, strict=True):
            player.at(time)
            player.page.evaluate(f"ravemj.look(ravemj.view{view and '.' + view})")
            robot.SetDOFValues(motion.sample(time))
            assert_same_silhouette(player, env)
        assert player.page.troubles == []
        assert len(player.page.requests) == 1

    def test_all_shapes_are_where_they_are(self, opened):
        env = all_shapes()
        player = opened(env.animation(background=[0, 0, 0.4]).html)
        assert_same_silhouette(player, env)

    def test_points_lines_and_triangles_are_drawn_where_they_are(self, env, opened):
        env.SetViewer("offscreen")
        shown = [
            env.plot3([[0.3, 0.1, 0.1], [-0.3, 0.1, 0.1]], 9, [[0, 0.6, 0], [0, 0, 0.6]]),
            env.plot3([0.3, -0.2, 0.1], 0.03, [0.6, 0, 0.6], drawstyle=1),
            env.drawlinestrip([[-0.4, -0.3, 0], [0.4, -0.3, 0]], 5, [0, 0.6, 0.6]),
            env.drawtrimesh([[-0.4, 0.2, 0], [-0.2, 0.2, 0], [-0.4, 0.3, 0]], [[0, 1, 2]], [0.6, 0.6, 0]),
        ]
        player = opened(env.animation(camera=ABOVE, background=[1, 1, 1]).html)
        picture = player.picture()
        size = picture.shape[1::-1]
        for point, colour in (
            ([0.3, 0.1, 0.1], [0, 153, 0]),
            ([-0.3, 0.1, 0.1], [0, 0, 153]),
            ([0.3, -0.2, 0.13], [153, 0, 153]),
            ([0.2, -0.3, 0], [0, 153, 153]),
            ([-0.35, 0.22, 0], [153, 153, 0]),
        ):
            x, y = player.camera().project(point, *size)[0][0]
            found = picture[int(y), int(x)].astype(int)
            assert (found[np.array(colour) == 0] < 40).all(), (point, found)
            assert (found[np.array(colour) > 0] > 100).all(), (point, found)
        strip = picture[:, size[0] // 2, 0]
        row = int(player.camera().project([0, -0.3, 0], *size)[0][0, 1])
        assert (1 - strip[row - 6 : row + 7] / 255).sum() == pytest.approx(5, abs=0.5)  # as wide as it says
        del shown

    def test_the_pointer_names_bodies(self, env, robot, opened):
        robot.SetDOFValues([0.5, 0.9])
        player = opened(env.animation(camera=NEAR).html)
        height, width = player.picture().shape[:2]
        compiled = env.simulation.compiled()
        with open_renderer(compiled.model, width, height, backend="ray") as renderer:
            geoms = renderer.segment(compiled.data, player.camera())
        bodies = np.where(geoms < 0, -1, compiled.model.geom_bodyid[geoms])
        inside = [
            (x, y)
            for y in range(5, height - 5, 9)
            for x in range(5, width - 5, 9)
            if np.ptp(bodies[y - 2 : y + 3, x - 2 : x + 3]) == 0
        ]
        found = player.page.evaluate("places => places.map(([x, y]) => ravemj.bodyAt(x, y))", inside)
        assert found == [bodies[y, x] for x, y in inside]
        assert set(found) == {-1, 1, 2, 3}
        y, x = np.argwhere(dilated(bodies != 3, 3) == 0)[0].tolist()
        player.page.evaluate("document.getElementById('values').hidden = true")  # or sliders are under the pointer
        player.page.mouse.move(x, y)
        assert player.page.inner_text("#label") == "Arm1"
        player.page.mouse.move(3, 3)
        assert not player.page.is_visible("#label")

    def test_mouse_keys_and_bar(self, env, opened):
        player = opened(env.animation(swing(env)).html)
        page = player.page
        page.click("#play")
        assert not page.evaluate("ravemj.isPlaying")
        page.evaluate("document.activeElement.blur()")  # as when the page has been opened, before any click
        page.keyboard.press("Space")
        assert page.evaluate("ravemj.isPlaying")
        page.keyboard.press("ArrowRight")
        assert not page.evaluate("ravemj.isPlaying")
        player.at(0.2)  # it may have come to the end, where it rests
        page.keyboard.press("ArrowRight")
        assert page.evaluate("ravemj.time") == pytest.approx(0.2 + 1 / 30)
        page.fill("#time", "0.5")
        assert page.evaluate("ravemj.time") == 0.5
        page.keyboard.press("Tab")
        page.click("#joints")
        await_that(lambda: page.evaluate("document.querySelector('#values').innerText.includes('0.750 rad')"))
        first = player.camera().T_world_camera
        page.mouse.move(60, 60)
        page.mouse.down()
        page.mouse.move(100, 70)
        page.mouse.up()
        turned = player.camera().T_world_camera
        assert not np.allclose(first[:3, :3], turned[:3, :3])
        page.mouse.wheel(0, 120)
        await_that(lambda: page.evaluate("ravemj.view.distance > ravemj.first.distance"))
        page.click("#home")
        assert player.camera().T_world_camera == pytest.approx(first)
        assert page.troubles == []

    @pytest.mark.stress
    def test_two_fingers_zoom(self, env, opened):
        player = opened(env.animation(swing(env)).html, has_touch=True)
        session = player.page.context.new_cdp_session(player.page)
        for kind, places in (("Start", [100]), ("Start", [100, 200]), ("Move", [100, 300]), ("End", [])):
            points = [{"x": x, "y": 100, "id": number} for number, x in enumerate(places)]
            session.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": points})
        await_that(lambda: player.page.evaluate("ravemj.view.distance < ravemj.first.distance"))
        assert player.page.evaluate("ravemj.view.distance / ravemj.first.distance") == pytest.approx(0.5)

    @pytest.mark.stress
    def test_a_context_that_was_lost_and_restored_shows_everything_again(self, env, robot, opened):
        motion = swing(env)
        player = opened(env.animation(motion, background=[0, 0, 0.4]).html)
        player.at(0.6)
        robot.SetDOFValues(motion.sample(0.6))
        player.page.evaluate(
            """async () => {
              const context = ravemj.renderer.gl.getExtension("WEBGL_lose_context");
              const happens = (name) => new Promise((done) => ravemj.canvas.addEventListener(name, done));
              const lost = happens("webglcontextlost"), restored = happens("webglcontextrestored");
              context.loseContext();
              await lost;
              ravemj.draw();
              setTimeout(() => context.restoreContext());
              await restored;
            }"""
        )
        assert_same_silhouette(player, env)
        assert player.page.troubles == []

    @pytest.mark.stress
    def test_pictures_are_coarse_while_they_move_and_crisp_at_rest_where_drawing_takes_long(self, env, opened):
        player = opened(env.animation(swing(env)).html)
        width, height = player.page.evaluate("[ravemj.canvas.clientWidth, ravemj.canvas.clientHeight]")
        await_that(lambda: player.page.evaluate("ravemj.sharpness.crisp > 0"), "no time was measured")
        player.page.evaluate("ravemj.sharpness.readTime = () => {}")
        player.page.evaluate("ravemj.sharpness.moving = LEVELS[4]")
        await_that(lambda: player.size() == (round(0.35 * width), round(0.35 * height)))
        player.page.evaluate("ravemj.isPlaying = false")
        await_that(lambda: player.size() == (width, height), "it does not become crisp")

    @pytest.mark.stress
    def test_without_webgl_the_page_says_so(self, env, opened):
        player = opened(env.animation().html, "HTMLCanvasElement.prototype.getContext = () => null")
        assert "no WebGL2" in player.page.inner_text("#error")


def test_the_command_writes_pages(folder):
    command = ("-m", "ravemj", "play", "env.xml", "-o")
    done = run(folder, *command, "Swing.HTML", "--to", "1,-1", "--duration", "2")
    assert done.stdout.startswith("wrote ")
    assert done.stderr == ""
    assert Page((folder / "Swing.HTML").read_text()).document["frames"] == 61
    failed = run(folder, *command, "nowhere/swing.html")
    assert failed.returncode == 1
    assert "nowhere/swing.html: there is no folder" in failed.stderr

"""Pages that draw by themselves: what they are sent, and what they show of it."""

import json
import struct
import time
import urllib.error
import urllib.request
import warnings
import zlib
from types import SimpleNamespace

import numpy as np
import pytest
from agreement import CORPUS, NEEDS_THE_CORPUS
from browsers import NEEDS_A_BROWSER, WEBGL_FLAGS, Desk, around, launched
from conftest import MODELS
from slow_link import SlowLink
from test_web import FROM_FRONT, SIZE
from test_web import Page as PicturePage
from waiting import PATIENCE, await_that

import ravemj
from ravemj.core.transforms import rows_from_wxyz
from ravemj.graphics.rendering import Camera, open_renderer
from ravemj.gui.viewers.sharpness import REST
from ravemj.gui.viewers.viewer import LOCKED
from ravemj.gui.viewers.web.feed import DRAWINGS, FIGURES, FRAME


@pytest.fixture
def env():
    env = ravemj.load(MODELS / "env.xml")
    env.SetViewer("web")
    env.GetViewer().SetCamera(FROM_FRONT, 1.0)
    yield env
    env.Destroy()


@pytest.fixture
def viewer(env):
    return env.GetViewer()


class Page(PicturePage):
    """What a page that draws does.

    Attributes:
        text: The fields as they are now.
        drawn: What was drawn, by kind: numbers of points, spheres, lines and triangles.
        bytes: How many it was sent.
        poses: Of the bodies that it knows, by number: position and quaternion.
    """

    def __init__(self, viewer, tab="one"):
        self.url = viewer.url
        self.text, self.drawn, self.poses, self.colours, self.camera, self.bytes = {}, {}, {}, {}, None, 0
        self.said = self.acknowledged = 0
        super().__init__(viewer, tab, is_there=False)
        self.send(type="draws", itself=True)
        self.ready()

    def send(self, **message):
        self.said += 1
        super().send(**message)

    def ready(self):
        self.socket.send('{"type": "ready"}')

    def frame(self, timeout=PATIENCE) -> SimpleNamespace:
        """Take messages over up to the next frame, and say that it is shown."""
        while True:
            message = self.socket.recv(timeout)
            self.bytes += len(message)
            if isinstance(message, str):
                self.text |= json.loads(message)
            elif (kind := struct.unpack_from("<I", message)[0]) == FRAME:
                self.ready()
                return self._take(message)
            else:
                content = zlib.decompress(message[4:])
                document = json.loads(content[4 : 4 + int.from_bytes(content[:4], "little")])
                self.drawn[kind] = {name: batch["sizes"]["count"] for name, batch in document["drawings"].items()}

    def _take(self, message) -> SimpleNamespace:
        _, self.acknowledged, bodies, shapes, cameras = struct.unpack_from("<5I", message)
        at = 20

        def part(kind, *shape):
            nonlocal at
            array = np.frombuffer(message, kind, int(np.prod(shape)), at).reshape(shape)
            at += array.nbytes
            return array

        camera = part("<f4", cameras, 9)
        positions, rotations, numbers = part("<f4", bodies, 3), part("<i2", bodies, 4), part("<u4", bodies)
        painted, colours = part("<u4", shapes), part("u1", shapes, 4)
        assert at == len(message)
        self.poses |= dict(zip(numbers.tolist(), np.hstack([positions, rotations / 32767]), strict=True))
        self.colours |= dict(zip(painted.tolist(), colours.tolist(), strict=True))
        if cameras:
            self.camera = camera[0]
        return SimpleNamespace(bodies=numbers.tolist(), shapes=painted.tolist(), length=len(message))

    def settled(self) -> None:
        """Take everything in up to the answer to a message that means nothing."""
        self.send(type="nothing")
        while self.acknowledged != self.said:
            self.frame()

    def scene(self) -> dict:
        """Fetch the surfaces."""
        with urllib.request.urlopen(self.url + self.text["scene"], timeout=PATIENCE) as answer:
            assert "immutable" in answer.headers["Cache-Control"]
            content = zlib.decompress(answer.read())
        return json.loads(content[4 : 4 + int.from_bytes(content[:4], "little")])


class TestWhatIsSent:
    def test_only_the_links_that_moved_and_nothing_at_rest(self, env, viewer):
        robot = env.GetRobots()[0]
        with Page(viewer) as page:
            page.settled()
            assert page.text["lines"] == []
            scene = page.scene()
            assert scene["bodies"] == ["world", "Base", "Arm0", "Arm1"]
            assert set(page.poses) == {shape["body"] for shape in scene["shapes"]} == {1, 2, 3}
            with pytest.raises(TimeoutError):
                page.frame(0.5)
            robot.SetDOFValues([0, 0.5])
            frame = page.frame()
            assert frame.bodies == [3]
            assert frame.length < 50
            for link, body in zip(robot.GetLinks(), (1, 2, 3), strict=True):
                expected, (*position, w, x, y, z) = link.GetTransform(), page.poses[body]
                np.testing.assert_allclose(position, expected[:3, 3], atol=1e-6)
                np.testing.assert_allclose(rows_from_wxyz((w, x, y, z)), expected[:3, :3], atol=1e-4)

    def test_of_controls_only_those_come_that_have_changed(self, env, viewer):
        with Page(viewer) as page:
            page.send(type="operate", name="joints", value=0)
            page.settled()
            names = {control["name"] for control in page.text["controls"]}
            env.GetRobots()[0].SetDOFValues([0, 0.5])
            page.settled()
            assert page.text["changed"] == [{"name": "dof 1", "value": 0.5, "text": "0.500 rad"}]
            assert "dof 1" in names

    def test_tabs_and_reloads_share_a_scene_and_strangers_have_none(self, env, viewer):
        with Page(viewer, "one") as one, Page(viewer, "other") as other:
            one.settled()
            other.settled()
            name = one.text["scene"]
            assert other.text["scene"] == name
            env.GetRobots()[0].GetLinks()[1].GetGeometries()[0].SetDiffuseColor([0, 1, 0])
            one.settled()
            assert env.simulation.compiled().model.ngeom == len(one.colours)
        root = viewer.url.rsplit("/", 2)[0]
        for address in (
            f"{root}/{name}",
            f"{root}/{'x' * 22}/{name}",
            viewer.url + name[:-1] + "?",
            viewer.url + "scene-",
        ):
            with pytest.raises(urllib.error.HTTPError, match="404") as caught:
                urllib.request.urlopen(address, timeout=PATIENCE)
            caught.value.close()

    def test_what_is_drawn_comes_when_it_changes(self, env, viewer):
        with Page(viewer) as page:
            page.settled()
            assert page.drawn == {DRAWINGS: {}, FIGURES: {}}
            points = env.plot3([[0, 0, 1], [0, 0, 2]], 5)
            page.settled()
            assert page.drawn == {DRAWINGS: {"points": 2}, FIGURES: {}}
            page.send(type="key", name="l", pressed=True)  # the frames of the links
            page.settled()
            assert page.drawn[FIGURES]["lines"] >= 9
            page.drawn.clear()
            page.send(type="wheel", steps=1)
            page.settled()
            assert page.drawn == {}
            del points
            page.settled()
            assert page.drawn == {DRAWINGS: {}}

    def test_a_link_that_is_pointed_at_has_another_colour(self, viewer):
        with Page(viewer) as page:
            page.settled()
            before = dict(page.colours)
            page.send(type="key", name="Escape", pressed=True)
            page.send(type="move", x=200, y=160)
            await_that(lambda: (page.settled(), page.colours != before)[1])
            assert page.text["lines"][0].startswith("Arm")
            assert page.text["cursor"] == "pointer"
            page.send(type="leave")
            await_that(lambda: (page.settled(), page.colours == before)[1])

    def test_the_camera_is_answered_with_the_number_of_the_message(self, viewer):
        with Page(viewer) as page:
            page.settled()
            assert page.camera[7:] == pytest.approx([np.pi / 4, 1.0])
            page.send(type="wheel", steps=1)
            page.send(type="move", x=3, y=3)
            page.settled()
            assert page.acknowledged == page.said
            assert page.camera[:3] == pytest.approx([0.9, 0, 0])
            page.send(type="key", name="k", pressed=True)  # a turntable, which pages do not predict
            page.settled()
            assert page.camera[8] == 0

    def test_the_view_moves_while_the_script_has_the_environment(self, env, viewer):
        with Page(viewer) as page:
            page.settled()
            with env:
                page.send(type="wheel", steps=1)
                page.frame()
                assert page.camera[:3] == pytest.approx([0.9, 0, 0])
                await_that(lambda: (page.settled(), LOCKED in page.text["lines"])[1])
            page.settled()
            assert page.text["lines"] == []

    def test_what_a_script_publishes_is_shown_while_it_has_the_environment(self, env, viewer):
        robot = env.GetRobots()[0]
        env.StopSimulation()
        with Page(viewer) as page:
            page.settled()
            seen, values = page.poses[3].copy(), robot.GetDOFValues()
            with env:
                await_that(lambda: env.simulation.published.is_wanted)
                robot.SetDOFValues([0, 0.5])
                env.UpdatePublishedBodies()
                published = robot.GetLink("Arm1").GetTransform()
                robot.SetDOFValues([0, 1])  # nobody has published this
                while page.frame().bodies != [3]:
                    pass
                np.testing.assert_allclose(rows_from_wxyz(page.poses[3][3:]), published[:3, :3], atol=1e-4)
                robot.SetDOFValues(values)
                time.sleep(3 * REST)
            while page.frame().bodies != [3]:
                pass
            np.testing.assert_allclose(page.poses[3], seen, atol=1e-4)

    def test_a_body_is_removed_and_another_comes(self, env, viewer):
        with Page(viewer) as page:
            page.settled()
            env.Remove(env.GetRobots()[0])
            page.settled()
            assert page.scene()["shapes"] == []
            env.Load(str(MODELS / "puma560.xml"))
            page.settled()
            assert len(page.scene()["shapes"]) == env.simulation.compiled().model.ngeom

    def test_a_page_can_take_pictures_again(self, viewer):
        with Page(viewer) as page:
            page.settled()
            page.send(type="draws", itself=False)
            await_that(lambda: "crisp" in json.loads(page.socket.recv(PATIENCE)))
            assert page.socket.recv(PATIENCE)[:2] in (b"\xff\xd8", b"\x89P")

    def test_callbacks_are_handed_pictures_all_the_same(self, env, viewer):
        pictures = []
        handle = viewer.RegisterViewerImageCallback(pictures.append)
        with Page(viewer) as page:
            page.settled()
            await_that(lambda: pictures)
            assert np.array_equal(pictures[-1], viewer.render(*SIZE, shadows=False))
        handle.Close()

    @pytest.mark.parametrize("itself", [None, 1, "yes", [], {}])
    def test_nonsense_is_left_out(self, viewer, itself):
        with Page(viewer) as page:
            page.settled()
            page.send(type="draws", itself=itself)
            page.settled()
            assert page.acknowledged == page.said


def arm() -> ravemj.Environment:
    return ravemj.load(MODELS / "puma560.xml")


def pr2() -> ravemj.Environment:
    with warnings.catch_warnings(action="ignore"):
        return ravemj.load(CORPUS / "models" / "rdiankov+openrave" / "src" / "robots" / "pr2-beta-static.zae")


def meshes() -> ravemj.Environment:
    return ravemj.load(MODELS / "panda.xml")


def workshop() -> ravemj.Environment:
    return ravemj.load(MODELS / "workshop.env.xml")


def transparent() -> ravemj.Environment:
    env = ravemj.load(MODELS / "workshop.env.xml")
    for link in (link for body in env.GetBodies() for link in body.GetLinks()):
        for geometry in link.GetGeometries():
            geometry.SetTransparency(0.5)
    return env


def shift(picture: np.ndarray, expected: np.ndarray) -> np.ndarray:
    """Return how far a picture has to be moved right and down to fit another best (Lucas and Kanade 1981) [pixels]."""
    one, other = picture.mean(axis=2), expected.mean(axis=2)
    down, right = np.gradient((one + other) / 2)
    return np.linalg.lstsq(np.stack([right.ravel(), down.ravel()], axis=1), (one - other).ravel())[0]


def near(mask: np.ndarray) -> np.ndarray:
    """Return which pixels are at most two away from one of a mask."""
    return around(mask[..., None], np.maximum)[..., 0]


class TestWhatIsSeen:
    pytestmark = NEEDS_A_BROWSER

    @pytest.fixture
    def desk(self, webgl_browser, request):
        desk = Desk(webgl_browser, getattr(request, "param", lambda: ravemj.load(MODELS / "env.xml")))
        yield desk
        desk.close()
        assert desk.troubles == []

    def seen(self, desk) -> np.ndarray:
        """Return the picture without what lies over it."""
        desk.page.evaluate("for (const one of document.body.children) one.style.opacity = Number(one === view)")
        return desk.picture()

    @pytest.mark.parametrize(
        "desk", [arm, pytest.param(pr2, marks=[*NEEDS_THE_CORPUS, pytest.mark.stress])], indirect=True
    )
    def test_silhouettes_are_those_of_the_servers_segmentation(self, desk):
        desk.viewer.SetBkgndColor([0.8, 0, 0.8])  # as no link is
        lower, upper = desk.robot.GetDOFLimits()
        for values, zoom in ((np.clip(0, lower, upper), 3.0), (0.4 * lower + 0.3 * upper, 1.6)):
            desk.robot.SetDOFValues(values)
            T_world_camera = np.array(desk.core.view.camera.T_world_camera)
            T_world_camera[:3, 3] = zoom * T_world_camera[:3, 3] + desk.robot.ComputeAABB().pos()
            desk.viewer.SetCamera(T_world_camera, zoom)
            camera, size = Camera(desk.viewer.GetCameraTransform()), (640, 480)
            compiled = desk.env.simulation.compiled()
            with open_renderer(compiled.model, *size, backend="ray") as renderer:
                expected = renderer.segment(compiled.data, camera) >= 0
            assert 0.01 < expected.mean() < 0.9
            await_that(lambda expected=expected: self.is_outline(self.seen(desk), expected), "another silhouette")

    def is_outline(self, picture, expected) -> bool:
        """Return whether what is covered and what is open is so at most two pixels away; at edges, pixels are both."""
        magenta = picture[..., ::2].min(axis=2) - picture[..., 1]  # 204 where nothing is
        covered, is_open = magenta < 196, magenta > 20
        missing = (expected & ~near(covered)) | (~expected & ~near(is_open))
        return not (missing | (~is_open & ~near(expected)) | (~covered & ~near(~expected))).any()

    @pytest.mark.stress
    def test_a_point_lands_within_half_a_pixel(self, desk):
        desk.viewer.SetBkgndColor([1, 1, 1])
        places = np.array([[0.3, 0.3, 0.2], [0.2, -0.25, 0.1], [-0.3, 0.1, -0.1]])
        shown = desk.env.plot3(places, 9, [[1, 0, 1]] * 3)
        ends = desk.core.view.camera.project(places, 640, 480)[0]

        def away():
            picture = self.seen(desk)
            rows, columns = np.nonzero((picture[..., 1] < 60) & (picture[..., 0] > 200) & (picture[..., 2] > 200))
            found = np.stack([columns, rows], axis=1) + 0.5
            nearest = np.linalg.norm(found[:, None] - ends, axis=2)
            near = [found[nearest[:, number] < 10] for number in range(3)]
            return max(
                np.abs(place.mean(axis=0) - end).max() if len(place) else 99
                for place, end in zip(near, ends, strict=True)
            )

        await_that(lambda: away() <= 0.5, "points are elsewhere")
        del shown

    @pytest.mark.stress
    @pytest.mark.parametrize("desk", [meshes, transparent], indirect=True)
    def test_pictures_lie_within_half_a_pixel_of_the_servers(self, desk):
        desk.core.look_from(desk.env.renderer.camera_for_stills(4 / 3))
        desk.viewer.SetCamera(desk.core.view.camera.T_world_camera)
        camera = desk.core.view.camera.T_world_camera
        await_that(lambda: np.allclose(desk.page.evaluate("drawing.serverView.position"), camera[:3, 3], atol=1e-5))
        desk.await_picture()
        picture, expected = self.seen(desk).astype(float), desk.expected().astype(float)
        tiles = [(slice(row, row + 240), slice(column, column + 320)) for row in (0, 240) for column in (0, 320)]
        edges = [np.abs(np.diff(expected[tile], axis=0)).sum() for tile in tiles]
        for tile, edge in zip(tiles, edges, strict=True):
            if edge > 0.1 * max(edges):
                assert np.abs(shift(picture[tile], expected[tile])).max() < 0.5
        moved = np.roll(picture, (1, -1), axis=(0, 1))
        assert shift(moved, picture) == pytest.approx([1, -1], abs=0.5)  # it would be noticed

    def test_drawings_and_what_shines_through_others_look_as_the_servers(self, desk):
        corners = np.array([[0.3, 0.3, 0.2], [0.2, -0.25, 0.1], [-0.3, 0.1, -0.1], [0.3, -0.3, 0.2], [0.1, 0.2, 0.3]])
        shown = [
            desk.env.drawlinestrip(corners, 4, [1, 0, 0]),
            desk.env.drawarrow(corners[0], corners[1], 0.01, [0, 0.5, 0]),
            desk.env.drawtrimesh(corners[[0, 1, 2, 3, 4, 2]], None, [0, 0.5, 0.5, 0.4]),
            desk.env.drawbox([0.1, 0.1, 0.1], [0.1, 0.1, 0.1], [1, 0, 0, 0.5]),
            desk.env.plot3(corners[[0, 4]] - 0.1, 0.05, [[0, 0, 1, 0.5], [1, 1, 0, 1]], 1),
        ]
        desk.await_picture()
        for link in desk.robot.GetLinks():
            link.GetGeometries()[0].SetTransparency(0.5)
        desk.page.keyboard.press("i")  # ellipsoids of inertia, within the links
        await_that(lambda: desk.page.evaluate("drawing.renderer.groups.get('figures').figures.length"))
        desk.await_picture()
        del shown

    @pytest.mark.stress
    @pytest.mark.parametrize("desk", [workshop], indirect=True)
    @pytest.mark.parametrize(
        ("eye", "focus"),
        [
            ((0.55, 2.5, 1.35), (0.2, 0, 0.3)),
            ((1.6, 1.3, 0.2), (0.8, 0, 0.2)),  # low
            ((0.9, 0.6, 0.5), (0.3, -0.3, 0.2)),  # over the floor, which reaches behind the camera
            ((1.0, 6, 4), (0, 0, 0)),
        ],
    )
    def test_lines_that_reach_behind_the_camera_are_hidden_by_bodies(self, desk, eye, focus):
        T_world_camera = ravemj.transformLookat(lookat=focus, camerapos=eye, cameraup=[0, 0, -1])
        desk.core.look_from(Camera(T_world_camera))
        desk.viewer.SetCamera(T_world_camera)
        shown = [
            desk.env.drawlinestrip([[1.05, 3.5, 0.3], [1.05, -3, 0.3]], 3, [0, 1, 0]),
            desk.env.drawlinestrip([np.array(eye) * [1, 1, 0] + [0, 0, 0.45], [*focus[:2], 0.45]], 2, [1, 0, 1]),
            desk.env.plot3(0.05 * np.array(focus) + 0.95 * np.array(eye), 5, [1, 0, 0]),  # in front of all bodies
        ]
        desk.page.evaluate("() => { drawLabels = () => {}; }")
        desk.page.keyboard.press("g")
        await_that(lambda: np.allclose(desk.page.evaluate("drawing.serverView.position"), eye, atol=1e-5))
        desk.await_picture()
        del shown

    @pytest.mark.stress
    def test_nothing_is_cut_off_a_ball(self, desk):
        desk.viewer.SetCamera([[0, 0, -1, 4], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
        ball = desk.env.plot3([[1, 0, 0]], 2, [0, 1, 1], 1)  # around the robot, and far in front of it
        await_that(lambda: desk.page.evaluate("(drawing.renderer.groups.get('drawings') || {marks: []}).marks.length"))
        await_that(lambda: desk.page.evaluate("drawing.serverView.position[0]") == 4)
        await_that(lambda: desk.page.evaluate("drawing.renderer.depths[0] <= 1 && drawing.renderer.depths[1] >= 5"))
        del ball

    def test_styles_look_as_the_servers(self, desk):
        for key in ("v", "t", "w"):  # what collides, transparent, and edges only
            desk.page.keyboard.press(key)
            place = slice(180, 330), slice(250, 390)
            await_that(lambda place=place: self.is_alike(desk.picture()[place], desk.expected()[place]), key)
            desk.page.keyboard.press(key)

    def is_alike(self, picture, expected) -> bool:
        """Return whether pictures have nearly the same colours on average: edges of one pixel are drawn differently."""
        seen, wanted = (np.abs(one - 255).max(axis=2) > 8 for one in (picture, expected))
        colours = [one[mask].mean(axis=0) for one, mask in ((picture, seen), (expected, wanted))]
        return np.abs(colours[0] - colours[1]).max() < 25 and np.mean(seen != wanted) < 0.05

    def test_a_scene_is_fetched_once_from_here_and_from_nowhere_else(self, desk):
        fetched, asked = [], []
        find = desk.viewer.server._find_scene

        def note(name):
            content = find(name)
            if content is not None:
                fetched.append(name)
            return content

        desk.viewer.server._find_scene = note
        desk.context.on("request", lambda request: asked.append(request.url))
        desk.page.reload()
        desk.await_picture()
        other = desk.open_page()
        desk.await_picture(other)
        assert fetched == []
        assert asked
        assert all(url.startswith((desk.viewer.url, "data:")) for url in asked), asked

    @pytest.mark.stress
    def test_behind_a_slow_way_to_the_server_it_needs_few_answers(self, desk, chromium):
        port = desk.viewer.server.port
        with SlowLink(port, rate=3e5, delay=0.03) as link:
            flag = f"--host-resolver-rules=MAP 127.0.0.1:{port} 127.0.0.1:{link.port}"
            with launched(chromium, *WEBGL_FLAGS, flag) as browser:
                page = browser.new_page(viewport={"width": 640, "height": 480})
                page.goto(desk.viewer.url)
                desk.await_picture(page)
                assert link.connections == 3, "other than the page, its surfaces and its messages"
                assert link.received < 40e3

    def test_the_view_turns_before_the_answer_comes(self, desk):
        desk.await_picture()
        desk.page.evaluate("() => { window.late = []; handleMessage = async (...what) => { late.push(what); }; }")
        desk.drag((320, 100), (360, 120), (400, 130))
        desk.wheel(1)
        desk.drag((320, 100), (360, 120), keys=["Shift"])
        desk.await_picture()
        assert desk.page.evaluate("drawing.view.position") == pytest.approx(desk.core.view.camera.position, abs=1e-6)
        assert desk.page.evaluate("drawing.acknowledged < drawing.predictedBy")

    @pytest.mark.stress
    def test_pictures_stand_in_while_webgl_is_lost(self, desk):
        assert not desk.page.is_visible("#source")
        for values in ([0.4, 0.3], [0.9, 0.7]):
            desk.page.evaluate("window.context = drawing.renderer.gl.getExtension('WEBGL_lose_context')")
            desk.page.evaluate("context.loseContext()")
            desk.page.wait_for_selector("#source", state="visible")
            desk.robot.SetDOFValues(values)
            desk.await_picture()
            desk.page.evaluate("context.restoreContext()")
            desk.page.wait_for_selector("#source", state="hidden")
            desk.robot.SetDOFValues(0.5 * np.array(values))
            desk.await_picture()
        desk.page.evaluate("context.loseContext(); setTimeout(() => context.restoreContext())")  # frames are under way
        desk.robot.SetDOFValues([0, 0])
        await_that(lambda: desk.page.evaluate("drawing !== null && drawing.name !== undefined"), "it draws no more")
        desk.await_picture()

    @pytest.mark.stress
    def test_pictures_are_coarse_while_things_move_and_crisp_at_rest_where_drawing_takes_long(self, desk):
        desk.await_picture()
        desk.page.evaluate(
            """() => {
              drawing.sharpness.readTime = () => {};
              drawing.sharpness.moving = LEVELS[3];
              window.sizes = [];
              const draw = drawing.renderer.draw.bind(drawing.renderer);
              drawing.renderer.draw = (...what) => { draw(...what); sizes.push(canvas.width); };
            }"""
        )
        desk.wheel(1)
        await_that(lambda: desk.page.evaluate("sizes.at(-1)") == 640, "it does not become crisp")
        sizes = desk.page.evaluate("sizes")
        assert sizes[0] == 320
        assert sizes == sorted(sizes)  # crisp twice where the server's answer comes late
        assert set(sizes) == {320, 640}
        desk.await_picture()

    @pytest.mark.stress
    def test_it_shows_pictures_if_the_address_asks_for_them(self, desk):
        desk.page.goto(desk.viewer.url + "?pictures")
        desk.await_picture()
        assert desk.page.is_visible("#source")

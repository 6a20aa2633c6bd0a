"""Lights, background, floor and shadows, alike in all that draws."""

import json

import mujoco
import numpy as np
import pytest
from browsers import NEEDS_A_BROWSER
from conftest import one_in
from test_animation import opened  # noqa: F401 - a fixture
from test_rendering_pictures import GL, both, open_as, state_of

import ravemj
from ravemj.graphics.rendering import Camera, Look, open_renderer, three_quarter_view
from ravemj.graphics.rendering.backdrop import FloorLevel, lowest_point
from ravemj.graphics.rendering.style import DRAWN_GROUPS, LookChoices, geom_rgba
from ravemj.graphics.simulation_renderer import Format
from ravemj.graphics.webgl.surfaces import surfaces
from ravemj.model.look import FILL, HORIZON, KEY, SENSOR, SKY, STUDIO, cell_size
from ravemj.rave.recording import Shot, draw_frames, followed_motion

SIZE = 320, 240
MODELS = ("pendulum", "panda", "puma560")
STUDIO_ON_WHITE = Look(lights="studio")
SHAPES = ("cylinder", "capsule", "sphere", "ellipsoid", "box")


def loaded(name):
    env = ravemj.Environment()
    assert env.Load(ravemj.model_path(name))
    return env


@pytest.fixture(params=one_in(3, MODELS))
def env(request):
    env = loaded(request.param)
    yield env
    env.Destroy()


def robot_pixels(env, camera, size=SIZE):
    return env.renderer.segment(camera, Format(*size)) >= 0


def apart(one, other, pixels):
    """Return the mean difference of two pictures over some pixels, as a part of white."""
    return np.abs(one[pixels].astype(float) - other[pixels]).mean() / 255


# --- the light on surfaces


@both
@pytest.mark.parametrize("name", one_in(3, ["panda", "puma560", "scara"]))
@pytest.mark.parametrize("above", [False, True])
def test_the_lit_side_of_each_robot_has_its_colour(how, name, above):
    env = loaded(name)
    compiled = env.simulation.compiled()
    model, data = compiled.model, compiled.data
    camera = env.renderer.camera_from_above() if above else env.default_camera()
    with open_as(how, model, *SIZE) as renderer:
        picture = renderer.render(data, camera, LookChoices().look(None)) / 255.0
        ids = renderer.segment(data, camera)
    columns, rows = camera.ray_parts(*SIZE)
    rays = (columns + rows).reshape(-1, 3)
    hit, depth, normals = np.empty(len(rays), np.int32), np.empty(len(rays)), np.empty((len(rays), 3))
    scene = model, data, camera.position, rays.ravel(), DRAWN_GROUPS, True, -1
    mujoco.mj_multiRay(*scene, hit, depth, normals.ravel(), len(rays), 1e10)
    facing = (-normals @ KEY.direction_in_world(camera.rotation)).reshape(ids.shape)
    lit = (facing > 0.3) & (hit.reshape(ids.shape) == ids) & (ids >= 0)
    rgba = geom_rgba(model)[:, :3]
    channel = rgba.argmax(axis=1)
    parts = picture[lit][np.arange(lit.sum()), channel[ids[lit]]] / rgba[ids[lit], channel[ids[lit]]]
    assert 0.85 <= np.median(parts) <= 1.05
    bodies = model.geom_bodyid[ids[lit]]
    large = [body for body in np.unique(bodies) if (bodies == body).sum() > 400]
    assert large
    for body in large:
        assert 0.8 <= np.median(parts[bodies == body]) <= 1.05, model.body(body).name


@pytest.mark.parametrize("seed", range(5))
def test_no_colour_up_to_95_percent_is_clipped_by_diffuse_light(seed):
    rng = np.random.default_rng(seed)
    rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    rotation *= np.sign(np.linalg.det(rotation))
    normals = rng.normal(size=(4000, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    total = sum(light.ambient for light in STUDIO) + sum(
        light.diffuse * np.maximum(-(normals @ light.direction_in_world(rotation)), 0) for light in STUDIO
    )
    assert 0.95 * total.max() <= 1
    assert total.min() >= 0.5


@both
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("turn", one_in(3, ["30 -60 45", "0 0 0", "70 20 0"]))
def test_highlights_clip_a_fiftieth_of_a_light_link_at_most(how, shape, turn):
    geom = f'<geom type="{shape}" size=".1 .2 .15" euler="{turn}" rgba=".95 .95 .95 1"/>'
    model, data = state_of(geom)
    camera = three_quarter_view(np.zeros(3), 0.3)
    with open_as(how, model) as renderer:
        picture, ids = renderer.render(data, camera, STUDIO_ON_WHITE), renderer.segment(data, camera)
    assert (picture[ids >= 0] == 255).all(axis=1).mean() <= 0.02


@both
def test_a_highlight_shows_that_a_cylinder_is_round(how):
    model, data = state_of('<geom type="cylinder" size=".1 .2" euler="60 20 0" rgba=".3 .3 .3 1"/>')
    camera = three_quarter_view(np.zeros(3), 0.3)
    with open_as(how, model) as renderer:
        picture, ids = renderer.render(data, camera, STUDIO_ON_WHITE), renderer.segment(data, camera)
    brightness = picture[ids >= 0].max(axis=1)
    assert np.percentile(brightness, 98) - np.percentile(brightness, 5) > 25


@pytest.mark.parametrize("up", [False, True])
def test_a_light_with_shadows_comes_from_above(up):
    forward = (0.6, 0.0, 0.8 if up else -0.8)
    T = np.eye(3)
    T[:, 2] = forward
    T[:, 0] = np.cross(forward, (0, 0, 1)) / 0.6
    T[:, 1] = np.cross(T[:, 2], T[:, 0])
    direction = KEY.direction_in_world(T)
    assert direction[2] <= -0.6 + 1e-12
    assert np.linalg.norm(direction) == pytest.approx(1)
    assert up or direction @ forward > 0.6, "it is at the camera's shoulder"


# --- alike


@pytest.mark.parametrize("shadows", [False, True])
def test_stills_frames_and_viewers_look_alike(env, shadows):
    env.SetViewer("offscreen")
    viewer = env.GetViewer()
    camera = env.renderer.camera_for_stills(4 / 3)
    viewer.SetCamera(camera.T_world_camera)
    still = env.render(*SIZE, shadows=shadows)
    viewed = viewer.render(*SIZE, shadows=shadows)
    start = env.GetRobots()[0].GetDOFValues()
    motion = followed_motion(env, ravemj.Motion([0.0], [start]))
    shot = Shot(camera, env.look(), Format(*SIZE, shadows=shadows), 30)
    frame = next(draw_frames(env, motion, shot))
    robot = robot_pixels(env, camera)
    assert robot.mean() > 0.01
    for other in (viewed, frame):
        assert apart(still, other, robot) < 0.02


@pytest.mark.parametrize("how", [GL])
def test_rays_look_like_opengl(env, how):
    compiled, camera, look = env.simulation.compiled(), env.default_camera(), LookChoices().look(None)
    with open_as(how, compiled.model, *SIZE) as gl, open_as("ray", compiled.model, *SIZE) as ray:
        pictures = [renderer.render(compiled.data, camera, look) for renderer in (gl, ray)]
    robot = robot_pixels(env, camera)
    assert apart(*pictures, robot) < 0.05
    assert apart(*pictures, ~robot) < 0.02, "the floor and the background"


class TestInABrowser:
    pytestmark = NEEDS_A_BROWSER

    @pytest.mark.parametrize("shadows", one_in(2, [True, False]))
    def test_a_page_looks_like_a_picture(self, env, opened, shadows):  # noqa: F811
        player = opened(env.animation(shadows=shadows).html)
        picture = player.picture()
        size = picture.shape[1::-1]
        camera = player.camera()
        form = Format(*size, shadows=shadows)
        expected = env.renderer.render(camera, env.look(), form)
        robot = env.renderer.segment(camera, form) >= 0
        assert apart(picture, expected, robot) < 0.05
        assert apart(picture, expected, ~robot) < 0.03
        assert player.page.troubles == []


# --- shadows


@pytest.mark.parametrize("how", [GL])
def test_the_robot_has_a_shadow_on_the_floor(env, how):
    camera = env.renderer.camera_for_stills(4 / 3)
    free = ~robot_pixels(env, camera)
    lit, shaded = (env.render(*SIZE, shadows=shadows).astype(int).sum(axis=2) for shadows in (False, True))
    dark = free & (lit - shaded > 45)
    assert dark.sum() > 0.04 * (~free).sum()
    assert np.abs(lit - shaded)[free & ~dark].mean() < 6
    rows, columns = np.nonzero(dark)
    base = np.argwhere(~free)
    assert rows.max() >= base[:, 0].max() - 40, "it begins where the robot stands"
    assert columns.min() < base[:, 1].max() + 5


@pytest.mark.parametrize("how", [GL])
def test_edges_of_shadows_are_soft(how):
    model, data = state_of('<geom type="box" size=".02 .1 .1" pos="0 0 .4"/>')
    camera = three_quarter_view(np.zeros(3), 0.8)
    with open_as(how, model, 640, 480, shadows=True) as renderer:
        picture, ids = renderer.render(data, camera, Look(None, True, "studio")), renderer.segment(data, camera)
    grey = picture[ids < 0].astype(int).sum(axis=1)
    light, dark = np.median(grey), grey.min()
    between = (grey > dark + 0.2 * (light - dark)) & (grey < dark + 0.8 * (light - dark))
    assert between.sum() > 50


# --- the floor and the background


@both
def test_the_floor_and_the_background_are_no_bodies(how):
    model, data = state_of('<geom size=".1" pos="0 0 .1"/>')
    camera = three_quarter_view(np.zeros(3), 0.5)
    with open_as(how, model) as renderer:
        before = renderer.segment(data, camera), renderer.depth(data, camera)
        picture = renderer.render(data, camera, Look(None, True))
        after = renderer.segment(data, camera), renderer.depth(data, camera)
    assert set(np.unique(after[0])) == {-1, 0}
    assert np.isinf(after[1][after[0] < 0]).all()
    assert all(np.array_equal(one, other) for one, other in zip(before, after, strict=True))
    assert len(np.unique(picture[before[0] < 0], axis=0)) > 20


@both
def test_a_gradient_and_a_grid_only_where_nothing_sets_a_background(how):
    model, data = state_of('<geom size=".1" pos="0 0 .1"/>')
    camera = three_quarter_view(np.zeros(3), 0.5)
    choices = {"auto": LookChoices(), "on": LookChoices(floor="on"), "off": LookChoices(floor="off")}
    with open_as(how, model, samples=0) as renderer:
        free = renderer.segment(data, camera) < 0

        def shades(floor, background):
            picture = renderer.render(data, camera, choices[floor].look(background))
            return len(np.unique(picture[free], axis=0))

        assert shades("auto", (0.8, 0.85, 0.9)) == 1
        assert shades("off", (0.8, 0.85, 0.9)) == 1
        assert shades("on", (0.8, 0.85, 0.9)) > 2, "lines"
        assert shades("off", None) > 2
        assert shades("auto", None) > 20


@both
def test_the_background_is_a_gradient_from_the_horizon_up(how):
    sky = '<asset><texture name="sky" type="skybox" builtin="flat" rgb1="1 1 1" width="32" height="192"/></asset>'
    model, data = state_of('<geom size=".01" pos="0 0 .1"/>', sky)
    T = np.eye(4)
    T[:3, :3] = np.array([[0, 0, -1], [1, 0, 0], [0, -1, 0]])
    T[:3, 3] = 3, 0, 0.1
    with open_as(how, model, 160, 120) as renderer:
        picture = renderer.render(data, Camera(T), Look(None)).astype(int)
    column = picture[:, 10]
    np.testing.assert_allclose(column[60], np.multiply(HORIZON, 255), atol=2)
    assert (np.diff(column[:60, 0]) >= -1).all()
    assert column[0, 0] < column[59, 0] - 15
    assert np.abs(picture[:, 10] - picture[:, -10]).max() <= 2


@pytest.mark.parametrize("seed", range(6))
def test_the_floor_is_at_the_lowest_point(seed):
    rng = np.random.default_rng(seed)
    geoms = ""
    for shape in SHAPES:
        size, turn = " ".join(map(str, rng.uniform(0.05, 0.3, 3))), " ".join(map(str, rng.normal(size=4)))
        place = " ".join(map(str, rng.uniform(-1, 1, 3)))
        geoms += f'<geom type="{shape}" size="{size}" quat="{turn}" pos="{place}"/>'
    points = rng.normal(size=(12, 3))
    vertices = " ".join(map(str, points.ravel()))
    geoms += f'<geom type="mesh" mesh="m" quat="{turn}" pos="0 0 {rng.uniform(-1, 1)}"/>'
    model, data = state_of(geoms, f'<asset><mesh name="m" vertex="{vertices}"/></asset>')
    shown = surfaces(model)
    corners = []
    for shape in shown.shapes:
        mesh = shown.meshes[shape.mesh]
        used = mesh.positions[np.unique(mesh.triangles)]
        corners.append(float((used @ shape.T_body_shape[2, :3] + shape.T_body_shape[2, 3]).min()))
    assert lowest_point(model, data) == pytest.approx(min(corners), abs=3e-3)
    assert lowest_point(model, data) <= min(corners) + 1e-6
    with open_renderer(model, 8, 8, backend="ray") as renderer:
        assert FloorLevel(model).floor(data, Look(None, True)).height == pytest.approx(lowest_point(model, data))
        assert FloorLevel(model).floor(data, Look(None)) is None
        assert renderer.has_shadows is False


def test_the_floor_stands_still_while_joints_move():
    env = loaded("pendulum")
    robot = env.GetRobots()[0]
    model = env.simulation.compiled().model
    heights = []
    for values in ([0, 0], [1.5, 0.3], [3.1, 0]):
        robot.SetDOFValues(values)
        heights.append(FloorLevel(model).floor(env.simulation.compiled().data, env.look()).height)
    assert heights == pytest.approx([heights[0]] * 3)
    assert heights[0] < -0.3


@pytest.mark.parametrize(("radius", "cell"), [(0.5, 0.2), (1, 0.5), (2, 1), (0.03, 0.01), (9, 2), (400, 200)])
def test_cells_are_round_lengths(radius, cell):
    assert cell_size(radius) == pytest.approx(cell)


def test_an_empty_environment_has_a_floor():
    env = ravemj.Environment()
    picture = env.render(160, 120)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 10
    assert (env.render(160, 120, background=[0, 0, 1]) == [0, 0, 255]).all()


# --- what scripts, files and options say


def test_a_script_s_background_is_flat(env):
    env.SetViewer("offscreen")
    viewer = env.GetViewer()
    viewer.SetBkgndColor([0.2, 0.4, 0.6])
    for picture in (env.render(*SIZE), viewer.render(*SIZE)):
        free = ~robot_pixels(env, viewer.camera)
        free &= (picture == picture[0, 0]).all(axis=2)
        assert picture[0, 0].tolist() == [51, 102, 153]
        assert free.mean() > 0.5
    with_floor = viewer.render(*SIZE, floor="on")
    assert len(np.unique(with_floor.reshape(-1, 3), axis=0)) > len(np.unique(picture.reshape(-1, 3), axis=0))


CAMERA = """<Environment>{}<KinBody name="b"><Body type="static"><Geom type="box"><extents>.1 .1 .1</extents>
<diffuseColor>.5 .5 .5</diffuseColor></Geom></Body></KinBody></Environment>"""


@pytest.mark.parametrize(("tag", "background"), [("", 255), ("<bkgndcolor>0 0 1</bkgndcolor>", 0)])
def test_images_of_cameras_do_not_depend_on_the_look(tag, background):
    env = ravemj.Environment()
    env.LoadData(CAMERA.format(tag))
    env.SetViewer("offscreen")
    viewer = env.GetViewer()
    T = np.array([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])
    image = viewer.GetCameraImage(64, 48, T, [60, 60, 32, 24])
    head, side = SENSOR
    towards = -side.direction_in_world(np.eye(3)) @ [1, 0, 0]
    light = head.ambient + head.diffuse + side.diffuse * towards
    assert 255 * 0.5 * light - 1 <= image[24, 32, 0] <= 255 * (0.5 * light + 0.5 * head.specular) + 1
    assert image[2, 2].tolist() == [background, background, 255]
    assert env.GetViewer().render(64, 48)[2, 2].tolist() != [255, 255, 255]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"floor": "maybe"}, "floor: is 'maybe', and should be one of auto, on, off"),
        ({"floor": True}, "floor: is True, and should be one of auto, on, off"),
        ({"lights": "sun"}, "lights: is 'sun', and should be one of studio, model, both"),
        ({"lights": "sensor"}, "lights: is 'sensor', and should be one of studio, model, both"),
    ],
)
def test_unknown_choices(tmp_path, arguments, words):
    env = loaded("pendulum")
    env.SetViewer("offscreen")
    swing = ravemj.Motion.line([0, 0], [1, 0], duration=0.1)
    for call in (
        lambda: env.render(8, 8, **arguments),
        lambda: env.GetViewer().render(8, 8, **arguments),
        lambda: env.animation(swing, **arguments),
        lambda: ravemj.record(env, tmp_path / "swing.gif", swing, **arguments),
    ):
        with pytest.raises(ravemj.ArgumentError, match=words):
            call()
    assert list(tmp_path.iterdir()) == []


@both
def test_lights_of_a_model_add_to_those_of_the_studio(how):
    light = '<light type="directional" dir="-1 0 0" diffuse=".2 0 0" ambient="0 0 0" specular="0 0 0"/>'
    model, data = state_of(light + '<geom type="box" size=".2 .2 .2" rgba=".5 .5 .5 1"/>')
    T = np.array([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])
    with open_as(how, model) as renderer:
        studio, both_, own = (
            renderer.render(data, Camera(T), Look(lights=lights))[60, 80].astype(int)
            for lights in ("studio", "both", "model")
        )
    np.testing.assert_allclose(both_ - studio, [0.1 * 255, 0, 0], atol=2)
    assert own[0] > own[1]


def test_lights_of_pictures_are_no_lights_of_the_model():
    env = loaded("puma560")
    camera = env.default_camera()
    robot = robot_pixels(env, camera)
    studio, both_, own = (env.render(*SIZE, lights=lights, shadows=False) for lights in ("studio", "both", "model"))
    assert np.array_equal(studio, both_), "the file has none"
    assert apart(studio, own, robot) > 0.02


# --- MJCF


def test_the_converted_file_has_the_look():
    env = loaded("puma560")
    model = env.simulation.compiled().model
    lights = {model.light(number).name: model.light(number) for number in range(model.nlight)}
    assert sorted(lights) == ["studio_key", "studio_sky"]
    rotation = three_quarter_view(np.zeros(3), 1.0).rotation
    for name, light in (("key", KEY), ("sky", SKY)):
        found = lights[f"studio_{name}"]
        np.testing.assert_allclose(found.dir, light.direction_in_world(rotation), atol=1e-5)
        np.testing.assert_allclose(found.diffuse, light.diffuse, atol=1e-6)
        assert bool(found.castshadow[0]) == light.casts_shadows
    np.testing.assert_allclose(model.vis.headlight.ambient, FILL.ambient, atol=1e-6)
    np.testing.assert_allclose(model.vis.rgba.haze[:3], HORIZON, atol=1e-6)
    camera = mujoco.MjvCamera()
    mujoco.mjv_defaultFreeCamera(model, camera)
    assert (camera.azimuth, camera.elevation) == pytest.approx((220, -25)), "it begins where pictures are taken from"


@pytest.mark.parametrize("how", [GL])
def test_mujoco_s_own_renderer_shows_the_shadow_of_a_converted_file(tmp_path, how):
    from ravemj.cli import main

    target = tmp_path / "puma.xml"
    assert main(["convert", ravemj.model_path("workshop"), "-o", str(target)]) == 0
    model = mujoco.MjModel.from_xml_path(str(target))
    key = model.light("studio_key")
    away = np.linalg.norm(key.pos - model.stat.center)
    assert model.stat.extent <= away <= 4 * model.stat.extent
    assert key.dir @ (model.stat.center - key.pos) == pytest.approx(away, rel=1e-4)
    runtime = loaded("workshop").simulation.compiled().model
    for name in ("body_pos", "body_quat", "body_inertia", "jnt_axis", "geom_size", "geom_pos"):
        np.testing.assert_allclose(getattr(model, name), getattr(runtime, name), rtol=1e-14, atol=1e-14)  # tidied
    np.testing.assert_array_equal(model.body_mass, runtime.body_mass)


@pytest.mark.stress
def test_the_command_line_lists_the_choices(tmp_path, capsys):
    from ravemj.cli import main

    target = str(tmp_path / "a.png")
    for option, value, choices in (("--floor", "maybe", "auto, on, off"), ("--lights", "sun", "studio, model, both")):
        with pytest.raises(SystemExit):
            main(["render", "pendulum", "-o", target, option, value])
        assert f"{value!r} is none of {choices}" in capsys.readouterr().err
    assert main(["render", "pendulum", "-o", target, "--size", "64x48", "--no-shadows", "--floor", "off"]) == 0
    camera = tmp_path / "camera.json"
    camera.write_text(json.dumps(np.eye(4).tolist()))
    assert main(["render", "pendulum", "-o", target, "--size", "64x48", "--lights", "studio", "--shadows"]) == 0

"""What the pictures show: geometry, colours and identities, by OpenGL and by ray casting."""

import gc
import math
import threading

import mujoco
import numpy as np
import pytest
from conftest import one_in

from ravemj.errors import ArgumentError, RenderingError
from ravemj.graphics.rendering import Camera, bounding_sphere, open_renderer, three_quarter_view
from ravemj.graphics.rendering.contexts import make_with_any_backend
from ravemj.graphics.rendering.style import drawn_geoms, geom_rgba

LIGHT = '<visual><headlight ambient=".4 .4 .4" diffuse=".6 .6 .6" specular=".1 .1 .1"/></visual>'
SKYBOX = '<asset><texture name="background" type="skybox" builtin="flat" rgb1="1 1 1" width="8" height="48"/></asset>'
PENDULUM = """
<body quat="0.7071067811865476 0 0.7071067811865476 0">
  <geom type="cylinder" size=".03 .01" rgba="1 0 0 1"/>
  <body><joint axis="0 0 1"/><geom type="box" pos=".1 0 0" size=".1 .01 .01" rgba="1 0 0 1"/>
    <body pos=".2 0 0"><joint axis="0 0 1"/><geom type="box" pos=".1 0 0" size=".1 .01 .01" rgba="0 0 1 1"/></body>
  </body>
</body>"""
TUTORIAL = Camera.from_matrix([[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
SHAPES = {"box": 3, "sphere": 1, "capsule": 2, "cylinder": 2, "ellipsoid": 3}


def gl_works():
    try:
        renderer = open_renderer(mujoco.MjModel.from_xml_string("<mujoco/>"), 8, 8)
    except RenderingError:  # MUJOCO_GL names one that is not here
        return False
    with renderer:
        return renderer.backend != "ray"


GL = pytest.param("gl", marks=pytest.mark.skipif(not gl_works(), reason="no OpenGL backend works on this machine"))
both = pytest.mark.parametrize("how", [GL, "ray"])


def state_of(geoms, head=LIGHT + SKYBOX, qpos=()):
    model = mujoco.MjModel.from_xml_string(f"<mujoco>{head}<worldbody>{geoms}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    data.qpos[: len(qpos)] = qpos
    mujoco.mj_forward(model, data)
    return model, data


def open_as(how, model, width=160, height=120, **options):
    renderer = open_renderer(model, width, height, backend="ray" if how == "ray" else None, **options)
    assert (renderer.backend == "ray") == (how == "ray")
    return renderer


def random_rotation(rng):
    matrix, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return matrix * np.sign(np.linalg.det(matrix))


def camera_with_roll(rng, distance, fovy):
    T = np.eye(4)
    T[:3, :3] = random_rotation(rng)
    T[:3, 3] = -distance * T[:3, 2]
    return Camera(T, fovy)


# --- where things appear


@both
@pytest.mark.parametrize("seed", one_in(2, range(4)))
def test_spheres_appear_where_the_camera_projects_their_centres(how, seed):
    rng = np.random.default_rng(seed)
    points = rng.uniform(-0.6, 0.6, (14, 3))
    geoms = "".join(f'<geom size=".012" pos="{x} {y} {z}"/>' for x, y, z in points)
    model, data = state_of(geoms)
    camera = camera_with_roll(rng, 2.5, math.radians([45, 30, 60, 90][seed]))
    width, height = [(640, 480), (480, 640), (500, 300), (640, 480)][seed]
    with open_as(how, model, width, height) as renderer:
        ids = renderer.segment(data, camera)
    assert ids.shape == (height, width)
    assert ids.dtype == np.int32
    pixels, _ = camera.project(points, width, height)
    compared = 0
    for geom, (column, row) in enumerate(pixels):
        rows, columns = np.nonzero(ids == geom)
        inside = 5 < column < width - 5 and 5 < row < height - 5
        alone = np.sort(np.linalg.norm(pixels - pixels[geom], axis=1))[1] > 15
        if inside and alone:
            assert abs(columns.mean() + 0.5 - column) < 0.5
            assert abs(rows.mean() + 0.5 - row) < 0.5
            compared += 1
    assert compared >= 6


@both
def test_tutorial_camera_is_neither_mirrored_nor_upside_down(how):
    model, data = state_of(
        '<geom size=".05" pos="0 .2 0" rgba="0 1 0 1"/><geom size=".05" pos="0 0 .2" rgba="0 0 1 1"/>'
    )
    with open_as(how, model) as renderer:
        picture = renderer.render(data, TUTORIAL).astype(int)
    green = np.argwhere(picture[..., 1] - picture[..., 0] > 80).mean(axis=0)
    blue = np.argwhere(picture[..., 2] - picture[..., 0] > 80).mean(axis=0)
    scale = 60 / math.tan(math.radians(22.5)) * 0.2
    np.testing.assert_allclose(green, [59.5, 79.5 + scale], atol=1)  # world +y: right
    np.testing.assert_allclose(blue, [59.5 - scale, 79.5], atol=1)  # world +z: up


@both
def test_positive_joint_angles_of_the_pendulum_swing_to_the_right(how):
    model, data = state_of(PENDULUM, qpos=[math.pi / 4, math.pi / 4])
    with open_as(how, model) as renderer:
        ids = renderer.segment(data, TUTORIAL)
    base, upper, lower = (np.argwhere(ids == geom).mean(axis=0) for geom in range(3))
    assert base[0] < upper[0] < lower[0]
    assert base[1] < upper[1] < lower[1]


def random_scene(rng, count):
    geoms = ""
    for _ in range(count):
        shape = rng.choice(list(SHAPES))
        size = " ".join(map(str, rng.uniform(0.05, 0.3, SHAPES[shape])))
        position = " ".join(map(str, rng.uniform(-0.6, 0.6, 3)))
        turn = " ".join(map(str, rng.normal(size=4)))
        geoms += f'<geom type="{shape}" size="{size}" pos="{position}" quat="{turn}"/>'
    return state_of(geoms)


def near_an_edge(ids, pixels):
    """Mark what is within some pixels of another geom."""
    edge = np.zeros(ids.shape, dtype=bool)
    edge[:, 1:] |= ids[:, 1:] != ids[:, :-1]
    edge[:, :-1] |= ids[:, 1:] != ids[:, :-1]
    edge[1:] |= ids[1:] != ids[:-1]
    edge[:-1] |= ids[1:] != ids[:-1]
    for _ in range(pixels - 1):
        grown = edge.copy()
        grown[1:] |= edge[:-1]
        grown[:-1] |= edge[1:]
        grown[:, 1:] |= edge[:, :-1]
        grown[:, :-1] |= edge[:, 1:]
        edge = grown
    return edge


@pytest.mark.parametrize("how", [GL])
@pytest.mark.parametrize("seed", one_in(4, range(8)))
def test_opengl_and_rays_see_the_same_geoms(how, seed):
    rng = np.random.default_rng(100 + seed)
    model, data = random_scene(rng, 12)
    camera = camera_with_roll(rng, [2.5, 1.5, 0.0, 0.3][seed % 4], math.radians([45, 80][seed % 2]))
    with open_as(how, model, 320, 240) as gl, open_as("ray", model, 320, 240) as ray:
        by_gl, by_ray = gl.segment(data, camera), ray.segment(data, camera)
        depths = [renderer.depth(data, camera) for renderer in (gl, ray)]
    compared = ~(near_an_edge(by_gl, 2) | near_an_edge(by_ray, 2))
    assert compared.mean() > 0.6
    assert (by_gl != by_ray)[compared].sum() == 0
    apart = np.abs(depths[0][compared & (by_ray >= 0)] - depths[1][compared & (by_ray >= 0)])
    assert np.median(apart) < 1e-3, "OpenGL's spheres are polyhedra"
    assert apart.max() < 0.05
    for ids, depth in zip((by_gl, by_ray), depths, strict=True):
        np.testing.assert_array_equal(np.isinf(depth), ids < 0)
    assert len(np.unique(by_gl)) > 1


@both
def test_nothing_is_cut_off_near_or_far(how):
    geoms = '<geom size=".01" pos="0 0 .05"/><geom size="30" pos="0 100 500"/><geom type="box" size="1 1 1"/>'
    model, data = state_of(geoms)
    T = np.eye(4)
    with open_as(how, model) as renderer:  # in the box, looking along +z at both spheres
        ids = renderer.segment(data, Camera(T))
        picture = renderer.render(data, Camera(T))
    assert {0, 1} <= set(np.unique(ids)) <= {-1, 0, 1}
    shown = (picture != 255).any(axis=2)
    assert (shown & (ids < 0)).sum() < 0.2 * shown.sum()
    assert shown[ids >= 0].all()


# --- colours


@both
@pytest.mark.parametrize("samples", [0, 4])
def test_background_is_exact_and_can_change(how, samples):
    model, data = state_of(PENDULUM)
    texture = model.tex_data.copy()
    with open_as(how, model, samples=samples) as renderer:
        for color in ([1, 1, 1], [30 / 255, 60 / 255, 90 / 255], (0.2, 0.5, 0.7), np.zeros(3), [1, 1, 1]):
            picture = renderer.render(data, TUTORIAL, color)
            away = ~near_an_edge(renderer.segment(data, TUTORIAL), 3) & (renderer.segment(data, TUTORIAL) < 0)
            assert np.unique(picture[away], axis=0).tolist() == [[round(255 * part) for part in color]]
            assert picture.shape == (120, 160, 3)
            assert picture.dtype == np.uint8
    assert np.array_equal(model.tex_data, texture)


@both
def test_background_without_a_skybox(how):
    model, data = state_of(PENDULUM, head=LIGHT)
    with open_as(how, model, samples=0) as renderer:
        picture = renderer.render(data, TUTORIAL, (0.2, 0.5, 0.7))
        ids = renderer.segment(data, TUTORIAL)
    assert np.unique(picture[ids < 0], axis=0).tolist() == [[51, 128, 178]]
    assert picture[ids == 1][:, 0].min() > 80


@both
def test_colours_are_true(how):
    model, data = state_of(PENDULUM, qpos=[0.5, 0.5])
    center, radius = bounding_sphere(model, data)
    with open_as(how, model, 320, 240) as renderer:
        for camera in (TUTORIAL, three_quarter_view(center, radius)):
            picture, ids = renderer.render(data, camera), renderer.segment(data, camera)
            for geom, channel in ((0, 0), (1, 0), (2, 2)):
                mean = picture[(ids == geom) & ~near_an_edge(ids, 2)].mean(axis=0)
                others = np.delete(mean, channel)
                assert mean[channel] > 100
                assert (others < 0.2 * mean[channel]).all()
        face = picture_of_face = renderer.render(data, TUTORIAL)[120, 160]
        assert face[0] > 240, picture_of_face


@pytest.mark.parametrize("how", [GL])
def test_rays_are_shaded_like_opengl(how):
    rng = np.random.default_rng(5)
    model, data = random_scene(rng, 10)
    model.geom_rgba[:, :3] = rng.uniform(0.2, 0.9, (model.ngeom, 3))
    model.vis.headlight.specular[:] = 0
    camera = camera_with_roll(rng, 2.5, math.radians(45))
    with open_as(how, model, samples=0) as gl, open_as("ray", model, samples=0) as ray:
        inner = ~(near_an_edge(gl.segment(data, camera), 2) | near_an_edge(ray.segment(data, camera), 2))
        difference = gl.render(data, camera).astype(int) - ray.render(data, camera)
    assert np.abs(difference[inner]).mean() < 2
    assert np.percentile(np.abs(difference[inner]), 99) < 16


@both
def test_a_light_of_the_model_lights_its_side(how):
    head = SKYBOX + '<visual><headlight active="1" ambient=".3 .3 .3" diffuse="0 0 0" specular="0 0 0"/></visual>'
    light = '<light type="directional" dir="{}" diffuse=".7 .7 .7" specular="0 0 0" castshadow="false"/>'
    brightness = []
    for direction in ("-1 0 0", "1 0 0"):
        model, data = state_of(light.format(direction) + '<geom type="box" size=".2 .2 .2"/>', head)
        mujoco.mj_resetData(model, data)
        mujoco.mj_kinematics(model, data)  # the renderer places the lights
        with open_as(how, model) as renderer:
            brightness.append(int(renderer.render(data, TUTORIAL)[60, 80, 0]))
    assert brightness[0] == pytest.approx(0.5 * 255, abs=2)
    assert brightness[1] == pytest.approx(0.3 * 0.5 * 255, abs=2)


@both
def test_what_is_behind_a_transparent_geom_shines_through(how):
    model, data = state_of(
        '<geom type="box" size=".02 .2 .2" pos=".2 0 0" rgba="0 1 0 .3"/>'
        '<geom type="box" size=".02 .1 .1" pos="0 0 0" rgba="1 0 0 1"/>'
    )
    model.vis.headlight.specular[:] = 0
    with open_as(how, model, samples=0) as renderer:
        picture, ids = renderer.render(data, TUTORIAL).astype(int), renderer.segment(data, TUTORIAL)
    front = 1 - 0.7**2
    np.testing.assert_allclose(picture[60, 80], [255 * (1 - front), 255 * front, 0], atol=8)
    np.testing.assert_allclose(picture[60, 104], [255 * (1 - front), 255, 255 * (1 - front)], atol=8)
    assert ids[60, 80] == 0


@both
def test_what_is_hidden_is_hidden(how):
    model, data = state_of(
        '<geom size=".2" rgba="1 0 0 0"/><geom size=".2" group="3" pos="0 .1 0"/><geom size=".2" material="none"/>'
        '<geom size=".05" pos="-.5 0 0" rgba="0 0 1 1"/><site size=".2"/>',
        LIGHT + SKYBOX + '<asset><material name="none" rgba="1 1 1 0"/></asset>',
    )
    with open_as(how, model) as renderer:
        assert np.unique(renderer.segment(data, TUTORIAL)).tolist() == [-1, 3]
        picture = renderer.render(data, TUTORIAL)
        assert (picture[..., 2] > 80).all()
        model.geom_group[3] = 4
        assert (renderer.render(data, TUTORIAL) == 255).all()
    assert model.geom_group.tolist() == [0, 3, 0, 4]


def test_visibility_follows_mujoco():
    model, data = state_of(
        '<geom size=".1" material="red"/><geom size=".1" material="red" rgba="0 1 0 1"/>'
        '<geom size=".1" rgba="1 1 1 0"/><geom size=".1" material="glass"/>'
        '<geom size=".1" material="glass" rgba="1 1 1 0"/><geom size=".1" group="5"/><geom size=".1" group="2"/>',
        '<asset><material name="red" rgba="1 0 0 1"/><material name="glass" rgba="1 1 1 0"/></asset>',
    )
    scene, camera = mujoco.MjvScene(model, 100), mujoco.MjvCamera()
    mujoco.mjv_updateScene(model, data, mujoco.MjvOption(), None, camera, mujoco.mjtCatBit.mjCAT_ALL.value, scene)
    drawn = {geom.objid: geom.rgba for geom in scene.geoms[: scene.ngeom]}
    assert sorted(drawn) == np.flatnonzero(drawn_geoms(model)).tolist()
    for geom, rgba in drawn.items():
        np.testing.assert_allclose(geom_rgba(model)[geom], rgba)


@both
def test_edges_are_smooth_with_samples_and_identities_never(how):
    model, data = state_of('<geom type="box" size=".01 .1 .1" euler="20 0 0" rgba="0 0 0 1"/>')
    with open_as(how, model, samples=0) as hard, open_as(how, model, samples=4) as smooth:
        assert len(np.unique(hard.render(data, TUTORIAL)[..., 0])) <= 8
        assert len(np.unique(smooth.render(data, TUTORIAL)[..., 0])) > len(np.unique(hard.render(data, TUTORIAL)))
        assert np.array_equal(smooth.segment(data, TUTORIAL), hard.segment(data, TUTORIAL))


@both
def test_a_picture_without_samples_can_be_followed_by_one_with_them(how):
    model, data = state_of(PENDULUM)
    with open_as(how, model) as smooth, open_as(how, model, 80, 60, samples=0) as renderer:
        renderer.render(data, TUTORIAL)
        renderer.resize(160, 120, 4)
        assert np.array_equal(renderer.render(data, TUTORIAL), smooth.render(data, TUTORIAL))


@pytest.mark.parametrize("how", [GL])
def test_shadows(how):
    model, data = state_of(
        '<light type="directional" dir=".1 .2 -1" pos="7 8 0" diffuse=".6 .6 .6" castshadow="true"/>'
        '<geom type="box" size="1 1 .01"/><geom size=".1" pos="-.05 -.1 .5"/>',
        SKYBOX + '<visual><headlight active="1" ambient=".2 .2 .2" diffuse="0 0 0" specular="0 0 0"/></visual>',
    )
    T = np.eye(4)
    T[:3, :3] = three_quarter_view([0, 0, 0], 1).rotation
    T[:3, 3] = -2 * T[:3, 2]
    pixel = tuple(Camera(T).project([[0, 0, 0.01]], 160, 120)[0][0].astype(int)[::-1])
    with open_as(how, model) as without, open_as(how, model, shadows=True) as shaded:
        assert without.render(data, Camera(T))[pixel][0] > 1.5 * shaded.render(data, Camera(T))[pixel][0]


# --- renderers as objects


@both
def test_two_sizes_interleaved(how):
    model, data = state_of(PENDULUM)
    other, other_data = state_of('<geom size=".1" rgba="0 1 0 1"/>')
    with open_as(how, model, 64, 48) as small, open_as(how, other, 200, 100) as large:
        first = small.render(data, TUTORIAL)
        second = large.render(other_data, TUTORIAL, (0, 0, 0))
        assert first.shape == (48, 64, 3)
        assert second.shape == (100, 200, 3)
        assert np.array_equal(small.render(data, TUTORIAL), first)
        small.close()
        assert np.array_equal(large.render(other_data, TUTORIAL, (0, 0, 0)), second)


@both
def test_pictures_are_fresh_arrays(how):
    model, data = state_of(PENDULUM)
    with open_as(how, model) as renderer:
        first = renderer.render(data, TUTORIAL)
        copy = first.copy()
        renderer.render(data, TUTORIAL, (0, 0, 0))
        assert np.array_equal(first, copy)
        assert first.flags.c_contiguous
        assert first.flags.writeable


@both
def test_threads(how):
    model, data = state_of(PENDULUM)
    pictures = {}

    def draw():
        with open_as(how, model) as renderer:
            pictures["thread"] = renderer.render(data, TUTORIAL)

    with open_as(how, model) as renderer:
        pictures["main"] = renderer.render(data, TUTORIAL)
        for target in (draw, lambda: pictures.update(borrowed=renderer.render(data, TUTORIAL))):
            thread = threading.Thread(target=target)
            thread.start()
            thread.join()
        pictures["again"] = renderer.render(data, TUTORIAL)
    assert len(pictures) == 4
    assert all(np.array_equal(picture, pictures["main"]) for picture in pictures.values())


@both
def test_the_model_is_left_as_it_was(how):
    model, data = state_of(PENDULUM)
    before = model.vis.global_.offwidth, model.vis.quality.offsamples, model.vis.quality.shadowsize
    with open_as(how, model, 1000, 700, samples=0) as renderer:
        assert renderer.render(data, TUTORIAL).shape == (700, 1000, 3)
    assert (model.vis.global_.offwidth, model.vis.quality.offsamples, model.vis.quality.shadowsize) == before


@both
def test_closed_renderers_say_so(how):
    model, data = state_of(PENDULUM)
    renderer = open_as(how, model)
    renderer.close()
    renderer.close()
    for call in (renderer.render, renderer.segment):
        with pytest.raises(RenderingError, match="closed"):
            call(data, TUTORIAL)


@pytest.mark.stress
@pytest.mark.parametrize("how", [GL])
def test_renderers_that_are_collected_while_another_draws(how, monkeypatch):
    """Garbage in a circle is finalized in any order; the context first left the rest to whatever was current."""
    from ravemj.graphics.rendering.gl_scene import GlScene

    class Owner:
        def __init__(self, renderer):
            self.renderer, self.self = renderer, self

    model, data = state_of(PENDULUM)
    with open_as(how, model) as renderer:
        expected = renderer.render(data, TUTORIAL)
        Owner(open_as(how, model)).renderer.render(data, TUTORIAL)
        draw = GlScene.draw
        with monkeypatch.context() as patch:
            patch.setattr(GlScene, "draw", lambda *arguments: (draw(*arguments), gc.collect()))
            first = renderer.render(data, TUTORIAL)
        assert np.array_equal(first, expected)
        assert np.array_equal(renderer.render(data, TUTORIAL), expected)


@both
def test_data_of_another_model(how):
    model, _ = state_of(PENDULUM)
    _, data = state_of('<geom size=".1"/>')
    with open_as(how, model) as renderer, pytest.raises(ArgumentError, match="another model: 1 bodies and 1 geoms"):
        renderer.render(data, TUTORIAL)


@both
@pytest.mark.parametrize("color", [(1, 1), "white", (0, 0, 1.5), (0, 0, math.nan), None])
def test_bad_backgrounds(how, color):
    model, data = state_of(PENDULUM)
    with open_as(how, model) as renderer, pytest.raises(ArgumentError, match="three numbers from 0 to 1"):
        renderer.render(data, TUTORIAL, color)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"width": 0, "height": 5}, "0 x 5"),
        ({"width": 5, "height": 5, "samples": 3}, "samples is 3"),
        ({"width": 5, "height": 5, "backend": "vulkan"}, "'vulkan', expected one of egl, osmesa, glfw, ray"),
    ],
)
def test_bad_arguments(arguments, words):
    with pytest.raises(ArgumentError, match=words):
        open_renderer(mujoco.MjModel.from_xml_string("<mujoco/>"), **arguments)


@both
def test_an_empty_scene_is_all_background(how):
    model, data = state_of("")
    with open_as(how, model) as renderer:
        assert (renderer.render(data, TUTORIAL, (0, 0, 0)) == 0).all()
        assert (renderer.segment(data, TUTORIAL) == -1).all()


def test_ray_bands_do_not_show():
    model, data = state_of(PENDULUM)
    with open_as("ray", model, 700, 500, samples=0) as renderer:
        assert 700 * 500 > 1 << 16
        ids, picture = renderer.segment(data, TUTORIAL), renderer.render(data, TUTORIAL)
    assert np.array_equal(ids >= 0, (picture != 255).any(axis=2))


def test_rays_where_no_context_can_be_made(monkeypatch):
    def refuse(_):
        raise OSError("no driver")

    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr("ravemj.graphics.rendering.contexts.OffscreenContext", refuse)
    assert make_with_any_backend(lambda context: context) is None
    with open_renderer(mujoco.MjModel.from_xml_string("<mujoco/>"), 8, 8) as renderer:
        assert renderer.backend == "ray"

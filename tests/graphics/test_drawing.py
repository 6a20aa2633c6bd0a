"""Drawings in pictures, by OpenGL and by ray casting, against the projection of their points."""

import math

import numpy as np
import pytest
from conftest import one_in
from test_rendering_pictures import GL, LIGHT, SKYBOX, both, camera_with_roll, near_an_edge, open_as, state_of

from ravemj.graphics.rendering import Camera, Pinhole
from ravemj.model import drawing
from ravemj.model.drawing import NOTHING, Drawings

WIDTH, HEIGHT = 160, 120
AHEAD = Camera(np.eye(4))  # at the origin, along z
RED, GREEN, BLUE = np.column_stack([np.eye(3), np.ones(3)])
EMPTY = LIGHT + SKYBOX


def many(rgba, count):
    return np.tile(rgba, (count, 1))


def picture_of(how, shapes, camera=AHEAD, geoms="", background=(1, 1, 1), samples=0, **options):
    model, data = state_of(geoms, EMPTY)
    with open_as(how, model, WIDTH, HEIGHT, samples=samples, **options) as renderer:
        return renderer.render(data, camera, background, shapes)


def mask_of(picture):
    """Return where a picture is not white."""
    return (picture != 255).any(axis=2)


def centres():
    return np.stack(np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5), axis=2)


# --- where figures are


@both
@pytest.mark.parametrize("seed", one_in(3, range(3)))
@pytest.mark.parametrize("size", [1, 4, 7.0])
def test_points_are_squares_of_that_many_pixels_where_the_camera_projects_them(how, seed, size):
    rng = np.random.default_rng(seed)
    positions = rng.uniform(-0.5, 0.5, (15, 3))
    camera = camera_with_roll(rng, 2.0, math.radians(45))
    picture = picture_of(how, drawing.points(positions, size, many(BLUE, 15)), camera)
    pixels, _ = camera.project(positions, WIDTH, HEIGHT)
    away = np.abs(centres()[:, :, None] - pixels).max(axis=3).min(axis=2)
    assert (picture[away < size / 2 - 0.5] == [0, 0, 255]).all()
    assert (picture[away > size / 2 + 0.75] == 255).all()
    assert mask_of(picture).sum() >= 8


@both
@pytest.mark.parametrize("seed", one_in(3, range(3)))
@pytest.mark.parametrize("width", [1, 3, 6])
def test_lines_have_constant_width_along_their_projection(how, seed, width):
    rng = np.random.default_rng(seed)
    positions = rng.uniform(-0.5, 0.5, (6, 3))
    camera = camera_with_roll(rng, 2.0, math.radians(45))
    picture = picture_of(how, drawing.line_list(positions, width, many(GREEN, 6)), camera, samples=4)
    starts, ends = camera.project(positions, WIDTH, HEIGHT)[0].reshape(3, 2, 2).transpose(1, 0, 2)
    along = (ends - starts) / np.linalg.norm(ends - starts, axis=1, keepdims=True)
    relative = centres()[:, :, None] - starts
    behind_end = np.einsum("ijkl,kl->ijk", centres()[:, :, None] - ends, along)
    before_start = -np.einsum("ijkl,kl->ijk", relative, along)
    outside = np.maximum(behind_end, before_start)
    aside = np.abs(relative[..., 0] * along[:, 1] - relative[..., 1] * along[:, 0])
    covered = ((aside < width / 2 - 0.75) & (outside < -0.75)).any(axis=2)
    free = ((aside > width / 2 + 1) | (outside > 1)).all(axis=2)
    assert (picture[covered] == [0, 255, 0]).all()
    assert (picture[free] == 255).all()
    assert mask_of(picture).sum() > 40
    if width > 1:
        assert covered.sum() > 40


@both
def test_lines_keep_their_width_far_away_and_are_cut_off_behind_the_eye(how):
    for depth in (1.0, 50.0):
        line = drawing.line_strip(np.array([[-1, 0, 1], [1, 0, 1]]) * depth, 4, many(RED, 2))
        assert (mask_of(picture_of(how, line)).sum(axis=0)[60:100] == 4).all()
    through = drawing.line_strip(np.array([[0.1, 0, -5], [0.1, 0, 5]]), 2, many(RED, 2))
    shown = mask_of(picture_of(how, through))
    pixels, _ = AHEAD.project([[0.1, 0, 5]], WIDTH, HEIGHT)
    columns = np.flatnonzero(shown.any(axis=0))
    assert columns[0] == pytest.approx(pixels[0, 0], abs=1)
    assert columns[-1] == WIDTH - 1


@both
@pytest.mark.parametrize("center", [(0, 0, 2), (0.7, -0.4, 1.6), (0.2, 0.3, 0.4)])
def test_spheres_have_a_radius_in_metres(how, center):
    radius = 0.25
    shown = mask_of(picture_of(how, drawing.spheres(np.array([center]), radius, many(RED, 1))))
    rays = sum(AHEAD.ray_parts(WIDTH, HEIGHT))
    rays /= np.linalg.norm(rays, axis=2, keepdims=True)
    distance = np.linalg.norm(np.cross(rays, center), axis=2)
    assert shown[distance < 0.97 * radius].all()
    assert not shown[distance > 1.02 * radius].any()


@both
@pytest.mark.parametrize("seed", range(6))
def test_triangles_show_from_both_sides(how, seed):
    rng = np.random.default_rng(seed)
    corners = rng.uniform([-0.6, -0.6, 1.4], [0.6, 0.6, 2.6], (3, 3))
    picture = picture_of(how, drawing.mesh(corners, np.array([[0, 1, 2]]), many(RED, 3)))
    pixels, _ = AHEAD.project(corners, WIDTH, HEIGHT)
    sides = []
    for start, end in zip(pixels, np.roll(pixels, -1, axis=0), strict=True):
        normal = np.array([start[1] - end[1], end[0] - start[0]]) / np.linalg.norm(end - start)
        sides.append((centres() - start) @ normal)
    inside = np.maximum(np.min(sides, axis=0), -np.max(sides, axis=0))
    assert mask_of(picture)[inside > 0.5].all()
    assert not mask_of(picture)[inside < -0.5].any()
    lit = picture[inside > 1]
    assert (lit[:, 0] >= 0.39 * 255).all()  # more than the shade
    assert (lit[:, 1:] == 0).all()


@both
def test_a_triangle_around_the_eye_is_seen(how):
    corners = np.array([[-3, 1, -3], [3, 1, -3], [0, 1, 6.0]])
    shown = mask_of(picture_of(how, drawing.mesh(corners, np.array([[0, 1, 2]]), many(RED, 3))))
    pixels, _ = AHEAD.project(corners[2:], WIDTH, HEIGHT)
    row = round(pixels[0, 1])
    assert shown[row + 3 :, WIDTH // 2].all()
    assert not shown[: row - 2].any()


@both
def test_boxes_and_arrows_are_where_they_should(how):
    looking_down = Camera.from_matrix([[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 10]])
    shown = mask_of(picture_of(how, drawing.box(np.array([1, 1, 0]), np.array([1, 0.5, 0.1]), RED), looking_down))
    rows, columns = np.nonzero(shown)
    low, high = looking_down.project([[0, 0.5, 0.1], [2, 1.5, 0.1]], WIDTH, HEIGHT)[0]
    np.testing.assert_allclose([columns.min(), columns.max() + 1], [low[0], high[0]], atol=1)
    np.testing.assert_allclose([rows.min(), rows.max() + 1], [high[1], low[1]], atol=1)

    start, end = np.array([-2, 0, 0]), np.array([2, 0, 0])
    shown = mask_of(picture_of(how, drawing.arrow(start, end, 0.2, RED), looking_down))
    ends = looking_down.project([start, end], WIDTH, HEIGHT)[0][:, 0]
    columns = np.flatnonzero(shown.any(axis=0))
    np.testing.assert_allclose([columns[0], columns[-1] + 1], ends, atol=2)
    thickness = shown.sum(axis=0) / (HEIGHT / 2 / math.tan(math.radians(22.5)) / 10)  # [m]
    np.testing.assert_allclose(thickness[columns[2:50]], 0.4, atol=0.1)
    widest = columns[np.argmax(thickness[columns])]
    assert widest == pytest.approx(ends[0] + 0.9 * (ends[1] - ends[0]), abs=2)
    assert thickness[widest] == pytest.approx(0.8, abs=0.15)


@both
def test_planes_show_their_texture(how):
    texture = np.ones((3, 2, 4))
    texture[:, :, :3] = np.array([[[1, 0, 0], [0, 1, 0]], [[0, 0, 1], [1, 1, 0]], [[0, 1, 1], [1, 0, 1]]])
    frame = np.eye(4)
    frame[:3, 3] = [0.1, 0.2, 2]  # its x to the right in the picture, its y down
    picture = picture_of(how, drawing.plane(frame, np.array([0.4, 0.3]), texture))
    for row, column in np.ndindex(3, 2):
        at = frame[:3, 3] + [0.4 * (column - 0.5), 0.2 * (row - 1), 0]
        (x, y), *_ = AHEAD.project([at], WIDTH, HEIGHT)[0]
        color = picture[int(y), int(x)] / 255
        np.testing.assert_allclose(color, texture[row, column, :3], atol=0.1)


@both
def test_cameras_with_a_calibration(how):
    positions = np.array([[0.2, 0.1, 1.0], [-0.3, 0.4, 2.0], [-0.1, -0.2, 0.8]])
    fx, fy, cx, cy = 150.0, 90.0, 60.0, 75.0
    camera = Camera(np.eye(4), calibration=Pinhole(fx, fy, cx, cy))
    geoms = "".join('<geom size=".02" pos="{} {} {}" rgba="0 0 1 1"/>'.format(*at) for at in positions)
    model, data = state_of(geoms, EMPTY)
    with open_as(how, model, WIDTH, HEIGHT, samples=0) as renderer:
        ids = renderer.segment(data, camera)
        picture = renderer.render(data, camera, primitives=drawing.points(positions * 0.9, 3, many(RED, 3)))
        same = Camera(np.eye(4), calibration=AHEAD.pinhole(WIDTH, HEIGHT))
        assert np.array_equal(renderer.render(data, same), renderer.render(data, AHEAD))
    for geom, (x, y, z) in enumerate(positions):
        column, row = fx * x / z + cx, fy * y / z + cy
        rows, columns = np.nonzero(ids == geom)
        assert columns.mean() + 0.5 == pytest.approx(column, abs=0.7)
        assert rows.mean() + 0.5 == pytest.approx(row, abs=0.7)
        assert picture[int(row), int(column)].tolist() == [255, 0, 0]


@both
def test_far_and_near_drawings_are_not_cut_off(how):
    shapes = [drawing.points(np.array([[0.4 * depth, 0, depth]]), 5, many(RED, 1)) for depth in (1e-3, 1.0, 1e4)]
    for shape in shapes:
        assert mask_of(picture_of(how, shape, geoms='<geom size=".01" pos="0 0 -1"/>')).sum() == pytest.approx(
            25, abs=6
        )


# --- what hides what


@both
def test_drawings_and_bodies_hide_each_other(how):
    wall = '<geom type="box" size="1 1 .1" pos="0 0 2" rgba="0 0 1 1"/>'
    shapes = [
        drawing.points(np.array([[-0.3, 0, 1.5], [0.3, 0, 2.5]]), 9, many(RED, 2)),
        drawing.line_list(
            np.array([[0, -0.3, 1.5], [0.1, -0.3, 1.5], [0, 0.3, 2.5], [0.1, 0.3, 2.5]]), 6, many(RED, 4)
        ),
        drawing.spheres(np.array([[-0.3, -0.3, 1.5], [0.3, 0.3, 2.5]]), 0.06, many(RED, 2)),
    ]
    for shape in shapes:
        drawn = picture_of(how, shape).astype(int)
        hidden = picture_of(how, shape, geoms=wall).astype(int)
        red_before, red_after = ((image[..., 0] > 60) & (image[..., 1] < 60) for image in (drawn, hidden))
        assert red_before[:, :].sum() > red_after.sum() > 0.3 * red_before.sum()
    model, data = state_of(wall, EMPTY)
    with open_as(how, model, WIDTH, HEIGHT) as renderer:
        before = renderer.segment(data, AHEAD)
        renderer.render(data, AHEAD, primitives=shapes[0])
        assert np.array_equal(renderer.segment(data, AHEAD), before)


@both
@pytest.mark.parametrize("shadows", one_in(2, [False, True]))
def test_alpha_mixes_with_what_is_behind(how, shadows):
    light = '<light type="directional" dir="0 0 1" diffuse="0 0 0" specular="0 0 0" castshadow="true"/>'
    geoms = light + '<geom size=".01" pos="0 0 -1"/>'  # far from where it is looked at
    half_red = np.array([1, 0, 0, 0.4])
    at = np.array([[0, 0, 2.0]])
    figures = [
        drawing.points(at, 9, many(half_red, 1)),
        drawing.line_strip(np.array([[-1, 0, 2], [1, 0, 2.0]]), 9, many(half_red, 2)),
        drawing.spheres(at, 0.3, many(half_red, 1)),
        drawing.mesh(np.array([[-1, -1, 2], [3, -1, 2], [-1, 3, 2.0]]), np.array([[0, 1, 2]]), many(half_red, 3)),
    ]
    for figure in figures:
        picture = picture_of(how, figure, geoms=geoms, background=(0, 0, 1), shadows=shadows)
        color = picture[HEIGHT // 2, WIDTH // 2]
        np.testing.assert_allclose(color, [0.4 * 255, 0, 0.6 * 255], atol=14)
    wall = drawing.points(np.array([[0, 0, 3.0]]), 30, many(GREEN, 1))
    drawings = Drawings()
    for shape in (figures[0], wall):
        drawings.add(shape)
    color = picture_of(how, drawings.primitives(), geoms=geoms, shadows=shadows)[HEIGHT // 2, WIDTH // 2]
    np.testing.assert_allclose(color, [0.4 * 255, 0.6 * 255, 0], atol=4)
    pink = drawing.points(np.array([[0, 0, 2.0]]), 9, many(np.array([1, 0.5, 0.5, 1]), 1))
    color = picture_of(how, pink, geoms=geoms, shadows=shadows)[HEIGHT // 2, WIDTH // 2]
    np.testing.assert_allclose(color, [255, 128, 128], atol=2)


@both
def test_drawings_shine_through_transparent_bodies(how):
    glass = '<geom type="box" size="1 1 .1" pos="0 0 1.5" rgba="0 0 1 .2"/>'
    picture = picture_of(how, drawing.points(np.array([[0, 0, 2.0]]), 9, many(RED, 1)), geoms=glass)
    color, beside = picture[HEIGHT // 2, WIDTH // 2].astype(int), picture[HEIGHT // 2, WIDTH // 2 + 20].astype(int)
    assert color[0] > 130
    assert color[1] < 30
    assert (beside[:2] > 130).all()


@both
def test_a_model_without_a_background_texture(how):
    model, data = state_of('<geom size=".1" pos="0 0 -1"/>', LIGHT)
    with open_as(how, model, WIDTH, HEIGHT, samples=0) as renderer:
        picture = renderer.render(data, AHEAD, (0, 1, 0), drawing.points(np.array([[0, 0, 2.0]]), 8, many(RED, 1)))
    colors, counts = np.unique(picture.reshape(-1, 3), axis=0, return_counts=True)
    assert colors.tolist() == [[0, 255, 0], [255, 0, 0]]
    assert counts[1] == 64


@pytest.mark.parametrize("how", [GL])
def test_drawings_cast_no_shadows(how):
    floor = (
        '<light type="directional" dir="0 0 1" pos="0 0 -5" diffuse=".6 .6 .6" castshadow="true"/>'
        '<geom type="box" size="1 1 .01" pos="0 0 3"/>'
    )
    shapes = drawing.mesh(np.array([[0.2, -3, 1], [4, 0, 1], [0.2, 3, 1.0]]), np.array([[0, 1, 2]]), many(RED, 3))
    beside = np.s_[:, : WIDTH // 2]
    with_it, without = (picture_of(how, each, geoms=floor, shadows=True)[beside] for each in (shapes, NOTHING))
    assert np.abs(with_it.astype(int) - without).max() < 8


# --- both renderers, and many figures


def everything(rng):
    drawings = Drawings()
    positions = rng.uniform(-0.5, 0.5, (12, 3))
    colors = np.column_stack([rng.uniform(size=(12, 3)), np.ones(12)])
    drawings.add(drawing.points(positions, 5, colors))
    drawings.add(drawing.spheres(positions[:4] + 0.1, 0.08, colors[:4]))
    drawings.add(drawing.line_strip(positions[::-1], 3, colors))
    drawings.add(drawing.arrow(positions[0], positions[1], 0.02, colors[0]))
    drawings.add(drawing.box(positions[2], np.array([0.1, 0.2, 0.05]), colors[1]))
    drawings.add(drawing.mesh(positions, np.array([[3, 4, 5], [6, 7, 8]]), colors))
    drawings.add(drawing.plane(np.eye(4), np.array([0.3, 0.2]), rng.uniform(0, 1, (4, 5, 4))))
    return drawings.primitives()


@pytest.mark.parametrize("how", [GL])
@pytest.mark.parametrize("seed", range(4))
def test_opengl_and_rays_draw_the_same(how, seed):
    rng = np.random.default_rng(seed)
    shapes, camera = everything(rng), camera_with_roll(rng, 1.8, math.radians(45))
    geoms = '<geom size=".3" pos=".2 .1 0"/>'
    one, other = (picture_of(each, shapes, camera, geoms, samples=4).astype(int) for each in (how, "ray"))
    differs = np.abs(one - other).max(axis=2) > 60
    assert differs.mean() < 0.01


@both
def test_tens_of_thousands_of_points(how):
    columns, rows = (part.reshape(-1) for part in np.meshgrid(np.arange(2, 638, 4), np.arange(2, 478, 4)))
    count = len(rows)
    assert count > 18_000
    fx, fy, cx, cy = AHEAD.pinhole(640, 480)
    rng = np.random.default_rng(1)
    depth = rng.uniform(1.5, 2.5, count)
    positions = np.column_stack([(columns + 0.5 - cx) / fx, (rows + 0.5 - cy) / fy, np.ones(count)]) * depth[:, None]
    colors = np.column_stack([np.ones(count), rng.uniform(0, 0.4, (count, 2)), np.ones(count)])
    model, data = state_of("", EMPTY)
    with open_as(how, model, 640, 480, samples=0) as renderer:
        picture = renderer.render(data, AHEAD, primitives=drawing.points(positions, 3, colors))
    np.testing.assert_allclose(picture[rows, columns], 255 * colors[:, :3], atol=1)
    assert (picture[rows + 2, columns + 2] == 255).all()


@pytest.mark.parametrize("how", [GL])
def test_a_limit_of_opengl_is_said(how, caplog, monkeypatch):
    monkeypatch.setattr("ravemj.graphics.rendering.gl_scene._MAX_FIGURES", 1500)
    columns = np.linspace(-0.5, 0.5, 3000)
    shapes = drawing.points(np.column_stack([columns, 0 * columns, 0 * columns + 2]), 1, many(RED, 3000))
    shown = mask_of(picture_of(how, shapes))
    assert [record.getMessage() for record in caplog.records if record.levelname == "WARNING"] == [
        "3000 figures are drawn, and OpenGL shows 1500 of them"
    ]
    assert shown[:, : WIDTH // 2].any()
    assert not shown[:, WIDTH // 2 + 2 :].any()


@both
def test_edges_of_drawings_are_smooth_with_samples(how):
    line = drawing.line_strip(np.array([[-1, -0.2, 2], [1, 0.3, 2.0]]), 3, many(np.array([0, 0, 0, 1]), 2))
    hard, smooth = (picture_of(how, line, samples=samples) for samples in (0, 4))
    assert np.unique(hard).tolist() == [0, 255]
    assert len(np.unique(smooth)) > 2
    assert np.array_equal(hard[~near_an_edge(mask_of(hard), 2)], smooth[~near_an_edge(mask_of(hard), 2)])


# --- the figures themselves


def test_colours_of_lines_run_from_end_to_end():
    lines = drawing.line_strip(np.array([[0, 0, 0], [8, 0, 0], [9, 0, 0.0]]), 1, np.stack([RED, BLUE, BLUE])).lines
    assert lines.corners[0, 0].tolist() == [0, 0, 0]
    assert lines.corners[15, 1].tolist() == [8, 0, 0]
    reds = lines.rgba[:16, 0]
    assert (np.diff(reds) < 0).all()
    assert reds.mean() == 0.5
    assert (lines.rgba[16:] == BLUE).all()
    alike = drawing.line_strip(np.zeros((3, 3)), 1, np.linspace(0, 0.1, 12).reshape(3, 4)).lines
    assert len(alike.sizes) == 2
    one_color = drawing.line_list(np.zeros((5, 3)), 1, many(RED, 5)).lines
    assert len(one_color.sizes) == 2


def test_boxes_and_arrows_are_closed():
    for shape, volume in (
        (drawing.box(np.array([1, 2, 3.0]), np.array([1, 2, 3.0]), RED), 48.0),
        (drawing.arrow(np.array([0, 1, 0.0]), np.array([0, 1, 2.0]), 0.1, RED), None),
    ):
        corners = shape.triangles.corners
        edges = [frozenset(map(tuple, (c[i], c[i - 1]))) for c in corners.round(9).tolist() for i in range(3)]
        assert all(edges.count(edge) == 2 for edge in set(edges))
        center = corners.mean(axis=(0, 1))
        found = np.abs(np.linalg.det(corners - center)).sum() / 6
        if volume is not None:
            assert found == pytest.approx(volume)
    assert len(drawing.arrow(np.ones(3), np.ones(3), 0.1, RED)) == 0


def test_fine_textures_are_averaged():
    rng = np.random.default_rng(0)
    texture = rng.uniform(size=(130, 256, 4))
    cells = drawing.plane(np.eye(4), np.array([1, 1.0]), texture).triangles.rgba[::2].reshape(64, 64, 4)
    np.testing.assert_allclose(cells[0, 3], texture[:2, 12:16].mean(axis=(0, 1)))
    np.testing.assert_allclose(cells[-1, -1], texture[127:, 252:].mean(axis=(0, 1)))


def test_what_is_on_show_is_the_same_object_until_something_changes():
    drawings = Drawings()
    assert drawings.primitives() is NOTHING
    key, shown = drawings.add(drawing.points(np.zeros((1, 3)), 3, many(RED, 1)))
    first = drawings.primitives()
    assert drawings.primitives() is first
    move = np.eye(4)
    move[:3, 3] = 1, 2, 3
    shown.place(move)
    assert drawings.primitives() is not first
    assert drawings.primitives().points.corners.tolist() == [[[1, 2, 3]]]
    shown.show(False)
    assert len(drawings.primitives()) == 0
    shown.show(True)
    assert drawings.primitives().points.corners.tolist() == [[[1, 2, 3]]]
    drawings.remove(key)
    drawings.remove(key)
    assert len(drawings.primitives()) == 0
    shown.place(np.eye(4))
    assert len(drawings.primitives()) == 0

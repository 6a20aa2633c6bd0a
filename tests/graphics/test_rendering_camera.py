"""Cameras: the convention, what is accepted and refused, projection, default views, files."""

import json
import math

import mujoco
import numpy as np
import pytest

from ravemj.errors import ArgumentError, SourceError
from ravemj.graphics.rendering import Camera, bounding_sphere, three_quarter_view, view_from_above
from ravemj.graphics.rendering.camera_file import read_camera

TUTORIAL = [[0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]]
SAVED = [
    [-0.67725463, -0.23636616, -0.69673023, 0.40368351],
    [0.73512462, -0.25638653, -0.62759472, 0.43931767],
    [-0.03029783, -0.93722835, 0.34740989, 0.42627937],
    [0, 0, 0, 1],
]


def rotation_about(axis, angle):
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


def test_numbers_come_back_exactly_as_given():
    rng = np.random.default_rng(1)
    T = np.eye(4)
    T[:3, :3] = rotation_about(rng.normal(size=3), 1.234)
    T[:3, 3] = rng.normal(size=3)
    given = T.copy()
    camera = Camera.from_matrix(T)
    T[:] = 0
    assert np.array_equal(camera.T_world_camera, given)
    with pytest.raises(ValueError, match="read-only"):
        camera.T_world_camera[0, 0] = 1


def test_minus_zero_becomes_zero():
    matrix = np.array(TUTORIAL, dtype=float)
    matrix[matrix == 0] = -0.0
    matrix[3] = [0, 0, 0, 1]
    assert not np.signbit(Camera.from_matrix(matrix).T_world_camera[matrix == 0]).any()


@pytest.mark.parametrize(
    "given",
    [TUTORIAL, TUTORIAL[:3], np.array(TUTORIAL), [0.5, -0.5, -0.5, 0.5, 1, 0, 0]],
    ids=["4x4", "3x4", "array", "pose"],
)
def test_accepted_forms(given):
    np.testing.assert_allclose(Camera.from_matrix(given).T_world_camera, TUTORIAL, atol=1e-15)


def changed(row, column, value):
    matrix = [list(map(float, line)) for line in TUTORIAL]
    matrix[row][column] = value
    return matrix


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (np.eye(3), r"expected a 4x4 .* found an array of shape \(3, 3\)"),
        (3.0, "found an array of shape"),
        ([[1, 2], [3]], "not an array of numbers"),
        ("front", "not an array of numbers"),
        (changed(0, 2, -1.1), r"not a rotation: R\^T R is off by 0.21"),
        (changed(0, 3, math.nan), "expected finite numbers, found nan"),
        (changed(1, 3, math.inf), "expected finite numbers, found inf"),
        (changed(3, 0, 1), "expected 0 0 0 1 as the last row, found 1 0 0 1"),
        (changed(1, 0, -1), "reflection"),
        ([0, 0, 0, 0, 1, 2, 3], "quaternion of length 0"),
        ([math.nan, 0, 0, 0, 1, 2, 3], "quaternion of length nan"),
        ([2, 0, 0, 0, 1, 2, 3], "quaternion of length 2"),
    ],
)
def test_bad_cameras_are_refused_in_one_line(given, words):
    with pytest.raises(ArgumentError, match=words) as caught:
        Camera.from_matrix(given)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("fovy", [0.0, -1.0, math.pi, math.nan])
def test_bad_field_of_view(fovy):
    with pytest.raises(ArgumentError, match="field of view"):
        Camera(np.eye(4), fovy)


def test_rounded_matrices_are_taken_and_used_as_the_nearest_rotation():
    camera = Camera.from_matrix(np.round(SAVED, 3))
    assert np.array_equal(camera.T_world_camera, np.round(SAVED, 3))
    np.testing.assert_allclose(camera.rotation.T @ camera.rotation, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(camera.rotation, np.array(SAVED)[:3, :3], atol=2e-3)


def test_tutorial_camera_looks_back_at_the_origin_with_y_right_and_z_up():
    camera = Camera.from_matrix(TUTORIAL)
    pixels, depth = camera.project([[0, 0, 0], [0, 0.1, 0], [0, 0, 0.1], [2, 0, 0]], 640, 480)
    focal = 240 / math.tan(math.radians(22.5))
    np.testing.assert_allclose(pixels[:3], [[320, 240], [320 + 0.1 * focal, 240], [320, 240 - 0.1 * focal]])
    np.testing.assert_allclose(depth, [1, 1, 1, -1])
    assert np.isnan(pixels[3]).all()


@pytest.mark.parametrize("size", [(640, 480), (33, 70)])
def test_rays_project_to_the_centres_of_their_pixels(size):
    width, height = size
    camera = Camera.from_matrix(SAVED, math.radians(60))
    rays = sum(camera.ray_parts(width, height))
    assert rays.shape == (height, width, 3)
    pixels, depth = camera.project(camera.position + 2.5 * rays.reshape(-1, 3), width, height)
    rows, columns = np.mgrid[:height, :width] + 0.5
    np.testing.assert_allclose(pixels, np.stack([columns, rows], axis=-1).reshape(-1, 2), atol=1e-9)
    np.testing.assert_allclose(depth, 2.5)


def test_view_from_above():
    camera = view_from_above([1, 2, 3], 0.5)
    right_up = camera.project([[1, 2, 3], [1.1, 2, 3], [1, 2.1, 3]], 100, 100)[0]
    np.testing.assert_allclose(right_up[0], [50, 50])
    assert right_up[1, 0] > 51
    assert right_up[1, 1] == pytest.approx(50)
    assert right_up[2, 0] == pytest.approx(50)
    assert right_up[2, 1] < 49


@pytest.mark.parametrize("view", [view_from_above, three_quarter_view])
def test_default_views_just_hold_the_sphere(view):
    center, radius = np.array([0.3, -0.2, 0.1]), 0.7
    camera = view(center, radius)
    towards = (center - camera.position) @ camera.rotation
    np.testing.assert_allclose(towards[:2], 0, atol=1e-12)
    assert math.asin(radius / towards[2]) == pytest.approx(camera.fovy / 2)
    assert np.isfinite(view(center, 0.0).T_world_camera).all()


def test_three_quarter_view_has_z_up():
    camera = three_quarter_view([0, 0, 0], 1)
    pixels = camera.project([[0, 0, 0], [0, 0, 0.1]], 100, 100)[0]
    np.testing.assert_allclose(pixels[0], [50, 50])
    assert pixels[1, 0] == pytest.approx(50)
    assert pixels[1, 1] < 50


def state_of(geoms):
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{geoms}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def test_bounding_sphere_of_a_turned_box():
    center, radius = bounding_sphere(*state_of('<geom type="box" size="1 2 3" pos="5 0 0" euler="0 0 90"/>'))
    np.testing.assert_allclose(center, [5, 0, 0], atol=1e-9)
    assert radius == pytest.approx(math.sqrt(14))


def test_bounding_sphere_of_spheres_leaves_out_what_is_not_drawn():
    center, radius = bounding_sphere(
        *state_of(
            '<geom size=".1" pos="1 0 0"/><geom size=".1" pos="-1 0 0"/><geom type="plane" size="9 9 1"/>'
            '<geom size="1" pos="5 5 5" rgba="1 1 1 0"/><geom size="1" pos="5 5 5" group="3"/>'
        )
    )
    np.testing.assert_allclose(center, 0, atol=1e-12)
    assert radius == pytest.approx(1.1)


def test_bounding_sphere_of_nothing():
    center, radius = bounding_sphere(*state_of('<geom type="plane" size="9 9 1"/>'))
    assert center.tolist() == [0, 0, 0]
    assert radius == 1


@pytest.mark.parametrize(
    "text",
    [
        json.dumps(SAVED),
        json.dumps({"camera": SAVED, "note": "seen from the right"}),
        "\n".join(" ".join(map(repr, row)) for row in SAVED),
        "# saved view\n" + str(SAVED).replace("], [", "],\n ["),
        repr(np.array(SAVED)).replace("0.40368351", "0.40368351  "),
        json.dumps(SAVED[:3]),
    ],
    ids=["json", "object", "rows", "list", "numpy", "3x4"],
)
def test_read_camera(tmp_path, text):
    path = tmp_path / "view.json"
    path.write_text(text)
    np.testing.assert_allclose(read_camera(path).T_world_camera, SAVED, atol=1e-12)


def test_numbers_are_read_to_the_last_digit(tmp_path):
    path = tmp_path / "view.json"
    camera = Camera.from_matrix(np.array(SAVED[:3]) * [1, 1, 1, 1 / 3], fovy=1 / 3)
    path.write_text(json.dumps({"camera": camera.T_world_camera.tolist(), "fovy": camera.fovy}))
    again = read_camera(path)
    assert np.array_equal(again.T_world_camera, camera.T_world_camera)
    assert again.fovy == camera.fovy


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "view.json"),
        ("1 0 0\nfront view\n", "view.json:2: error: the camera holds 'front'"),
        ('{"T": []}', 'without the entry "camera"'),
        ('{"camera": [[1, 2], [3]]}', "not an array of numbers"),
        (json.dumps({"camera": SAVED, "fovy": "wide"}), '"fovy" is "wide"'),
        ("[" * 2000, "found an array of shape"),
        ("1 2 3 4 5", r"found an array of shape \(5,\)"),
        (json.dumps([[2 * x for x in row[:3]] + row[3:] for row in SAVED[:3]]), "not a rotation"),
    ],
)
def test_bad_camera_files(tmp_path, text, words):
    path = tmp_path / "view.json"
    path.write_text(text)
    with pytest.raises(SourceError, match=words) as caught:
        read_camera(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_missing_and_binary_camera_files(tmp_path):
    with pytest.raises(SourceError, match=r"none\.json.*no such file"):
        read_camera(tmp_path / "none.json")
    (tmp_path / "picture.png").write_bytes(b"\x89PNG\xff\xfe")
    with pytest.raises(SourceError, match="not a text file"):
        read_camera(tmp_path / "picture.png")

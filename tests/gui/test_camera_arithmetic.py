"""The arithmetic of cameras, which Python and pages both have: one table of moves, run through both."""

import json
import math
from importlib import resources

import numpy as np
import pytest
from browsers import NEEDS_A_BROWSER

from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction.viewpoint import Viewpoint

SIZE = WIDTH, HEIGHT = 800, 400
AHEAD = np.eye(3)  # image right is x, image down is y, the viewing direction is z
ASLANT = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]])
QUARTER, THIRD = HEIGHT / 2, HEIGHT / 3  # the height is half a turn
ABOUT_Y = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
ABOUT_X = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
DIAGONAL = [[0.5, -0.5, math.sqrt(0.5)], [-0.5, 0.5, math.sqrt(0.5)], [-math.sqrt(0.5), -math.sqrt(0.5), 0]]
# A camera with a field of view of 90 degrees at (1, 2, 3), and a focus 2 m ahead of it: focal length 200 points.
# method, arguments, first rotation -> rotation, position, distance
MOVES = [
    ("turned", (QUARTER, 0), AHEAD, ABOUT_Y, (-1, 2, 5), 2),
    ("turned", (0, QUARTER), AHEAD, ABOUT_X, (1, 0, 5), 2),
    ("turned", (QUARTER / math.sqrt(2), QUARTER / math.sqrt(2)), AHEAD, DIAGONAL, None, 2),
    ("turned", (0, 0), ASLANT, ASLANT, (1, 2, 3), 2),
    ("turned", (2 * HEIGHT, 0), ASLANT, ASLANT, (1, 2, 3), 2),
    ("turned", (QUARTER, 0), ASLANT, ASLANT @ ABOUT_Y, None, 2),
    ("turned", (0, -3 * QUARTER), ASLANT, ASLANT @ ABOUT_X, None, 2),
    ("turned", (3 * THIRD, 0), AHEAD, np.diag([-1, 1, -1]), (1, 2, 7), 2),
    ("shifted", (100, 50), AHEAD, AHEAD, (0, 1.5, 3), 2),
    ("shifted", (100, 50), ASLANT, ASLANT, (0.7, 1, 2.6), 2),
    ("zoomed", (math.log(2),), AHEAD, AHEAD, (1, 2, 1), 4),
    ("zoomed", (-math.log(4),), ASLANT, ASLANT, (2.2, 2, 2.1), 0.5),
    ("zoomed", (1000,), AHEAD, AHEAD, None, 2 * math.exp(10)),
    ("zoomed", (-1000,), AHEAD, AHEAD, None, 1e-3),
]
# a point of the world -> points of the picture
POINTS = [((1, 2, 5), (400, 200)), ((2, 2.5, 7), (450, 225)), ((0, 2, 3.5), (0, 200))]

SCRIPT = """({ moves, points, position, size: [width, height] }) => {
  const start = (rotation) => new View({ rotation: rotation.flat(), position, fovy: Math.PI / 2, distance: 2 });
  const seen = start([[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
  return {
    moves: moves.map(([method, numbers, rotation]) => start(rotation)[method](...numbers, height)),
    points: points.map((point) => seen.projected(point, width, height)),
    behind: seen.projected([1, 2, 2.9], width, height),
  };
}"""


def view(rotation, position=(1, 2, 3)) -> Viewpoint:
    T_world_camera = np.eye(4)
    T_world_camera[:3, :3], T_world_camera[:3, 3] = rotation, position
    return Viewpoint(Camera(T_world_camera, fovy=math.pi / 2), 2.0, SIZE)


def assert_moved(rotation, position, distance, move) -> None:
    method, numbers, first, expected_rotation, expected_position, expected_distance = move
    message = f"{method}{numbers} from {np.asarray(first).tolist()}"
    np.testing.assert_allclose(rotation, expected_rotation, atol=1e-12, err_msg=message)
    assert distance == pytest.approx(expected_distance, rel=1e-12), message
    if expected_position is None:  # turning and zooming keep the focus
        focus = np.array([1, 2, 3]) + 2 * np.asarray(first)[:, 2]
        expected_position = focus - distance * np.asarray(rotation)[:, 2]
    np.testing.assert_allclose(position, expected_position, atol=1e-9, err_msg=message)


@pytest.mark.parametrize("move", MOVES, ids=lambda move: move[0])
def test_python_moves_a_camera_by_the_table(move):
    method, numbers, rotation, *_ = move
    moved = getattr(view(rotation), method)(*numbers)
    assert_moved(moved.camera.rotation, moved.camera.position, moved.distance, move)


def test_python_projects_by_the_table():
    pixels, _ = view(AHEAD).camera.project([point for point, _ in POINTS], *SIZE)
    np.testing.assert_allclose(pixels, [pixel for _, pixel in POINTS], atol=1e-9)


class TestPage:
    pytestmark = NEEDS_A_BROWSER

    def test_pages_move_a_camera_and_project_by_the_table(self, browser):
        script = resources.files("ravemj.graphics.webgl").joinpath("page", "camera.js").read_text(encoding="utf-8")
        moves = [(method, numbers, np.asarray(first).tolist()) for method, numbers, first, *_ in MOVES]
        given = {"moves": moves, "points": [point for point, _ in POINTS], "position": (1, 2, 3), "size": SIZE}
        answers = browser.new_page().evaluate(f"{script}\n({SCRIPT})({json.dumps(given)})")
        for move, answer in zip(MOVES, answers["moves"], strict=True):
            assert_moved(np.reshape(answer["rotation"], (3, 3)), answer["position"], answer["distance"], move)
        np.testing.assert_allclose(answers["points"], [pixel for _, pixel in POINTS], atol=1e-9)
        assert answers["behind"] is None

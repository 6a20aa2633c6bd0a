"""Shapes as triangles."""

import numpy as np
import pytest

from ravemj.core.transforms import Pose
from ravemj.model import scene

SHAPES = {
    "box": (scene.Box((0.1, 0.2, 0.3)), 8 * 0.1 * 0.2 * 0.3),
    "sphere": (scene.Sphere(0.5), 4 / 3 * np.pi * 0.5**3),
    "cylinder": (scene.Cylinder(0.3, 1.4), np.pi * 0.3**2 * 1.4),
    "capsule": (scene.Capsule(0.3, 1.4), np.pi * 0.3**2 * 1.4 + 4 / 3 * np.pi * 0.3**3),
}


def volume(mesh):
    first, second, third = mesh.vertices[mesh.triangles].transpose(1, 0, 2)
    return np.einsum("ij,ij->i", first, np.cross(second, third)).sum() / 6


@pytest.mark.parametrize("name", SHAPES)
def test_closed_outward_and_of_about_the_volume(name):
    shape, exact = SHAPES[name]
    mesh = shape.triangulated()
    edges = mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    there = {tuple(edge) for edge in edges.tolist()}
    assert len(there) == len(edges)
    assert there == {(second, first) for first, second in there}
    assert 0.97 * exact < volume(mesh) <= exact * (1 + 1e-12)


def test_round_corners_lie_on_the_surface():
    np.testing.assert_allclose(np.linalg.norm(scene.Sphere(0.5).triangulated().vertices, axis=1), 0.5, rtol=1e-12)
    capsule = scene.Capsule(0.3, 1.0).triangulated().vertices
    beyond = np.clip(np.abs(capsule[:, 2]) - 0.5, 0, None)
    np.testing.assert_allclose(np.hypot(np.hypot(capsule[:, 0], capsule[:, 1]), beyond), 0.3, rtol=1e-12)


def test_a_container_is_hollow():
    mesh = scene.Container((1, 1, 1), (0.8, 0.8, 0.9)).triangulated()
    assert np.abs(mesh.vertices[:, :2]).max() == 0.5
    assert (mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()) == (0, 1)
    assert len(mesh.triangles) == 5 * 12


def test_moved_and_merged():
    box = scene.Box((1, 1, 1)).triangulated()
    both = scene.Mesh.merged([box, box.moved(Pose((5, 0, 0)).matrix())])
    assert volume(both) == pytest.approx(16)
    assert both.vertices.max(axis=0).tolist() == [6, 1, 1]
    assert len(scene.Mesh.merged([]).vertices) == len(scene.NoShape().triangulated().triangles) == 0

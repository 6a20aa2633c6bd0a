"""What MuJoCo makes of meshes."""

import importlib
import importlib.util

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import examples

from ravemj.errors import RavemjError
from ravemj.formats.meshes import area, collision_form, decompose, decomposition, volume, write_obj
from ravemj.formats.meshes.inventor import primitives
from ravemj.formats.meshes.parts import corners_of, weld
from ravemj.formats.meshes.triangulation import clip_ears, clipped, fans
from ravemj.model.scene import Mesh

SQUARE = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
TRIANGLE = Mesh(SQUARE.vertices[:3], np.array([[0, 1, 2]]))
LINE = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]), np.array([[0, 1, 2], [1, 2, 3]]))
EMPTY = Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))


def box(x, y, z):
    return weld(primitives.box(np.array([x, y, z])))


def turned(mesh, by=0.3):
    """Turn a mesh about an odd axis, so that single precision spoils its flatness."""
    axis = np.array([1.0, 2.0, 3.0]) / np.sqrt(14)
    cross = np.cross(np.eye(3), axis)
    matrix = np.eye(3) + np.sin(by) * cross + (1 - np.cos(by)) * cross @ cross
    return Mesh((mesh.vertices @ matrix.T).astype(np.float32), mesh.triangles)


def compiled(mesh, collides):
    """Load a mesh in MuJoCo."""
    contact = "" if collides else 'contype="0" conaffinity="0"'
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><asset><mesh name="m" file="m.obj" inertia="shell"/></asset><worldbody><body>'
        f'<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><freejoint/>'
        f'<geom type="mesh" mesh="m" {contact}/></body></worldbody></mujoco>',
        {"m.obj": write_obj(mesh).encode()},
    )


@pytest.mark.parametrize(
    ("mesh", "form"),
    [
        (box(1, 1, 1), "hull"),
        (box(1e-3, 1e-3, 1e-3), "hull"),
        (box(1, 1, 1e-4), "hull"),
        (turned(box(1, 2, 1e-3)), "hull"),
        (SQUARE, "visual"),
        (turned(SQUARE), "visual"),
        (Mesh(SQUARE.vertices + np.array([0, 0, 500]), SQUARE.triangles), "visual"),
        (TRIANGLE, "visual"),
        (LINE, "none"),
        (EMPTY, "none"),
    ],
)
def test_collision_form(mesh, form):
    assert collision_form(mesh) == form
    if form != "none":
        assert compiled(mesh, collides=form == "hull").mesh_facenum[0] == len(mesh.triangles)


def test_collision_form_looks_at_all_triangles_and_at_used_vertices_only():
    solid = box(1, 1, 1)
    degenerate = np.zeros((1000, 3), int)
    assert collision_form(Mesh(solid.vertices, np.concatenate([degenerate, solid.triangles]))) == "hull"
    assert collision_form(Mesh(solid.vertices, degenerate)) == "none"
    unused = np.concatenate([[[0.0, 0, 9]], SQUARE.vertices])
    assert collision_form(Mesh(unused, SQUARE.triangles + 1)) == "visual"


def test_what_is_none_does_not_load():
    for mesh in (LINE, EMPTY):
        with pytest.raises(ValueError, match=r"mesh|vert|face"):
            compiled(mesh, collides=False)


def test_obj_keeps_every_single_precision_number():
    rng = np.random.default_rng(1)
    mesh = weld((rng.normal(size=(50, 3, 3)) * 10.0 ** rng.integers(-6, 6, size=(50, 1, 1))).astype(np.float32))
    lines = [line.split() for line in write_obj(mesh).splitlines()]
    vertices = np.array([line[1:] for line in lines if line[0] == "v"], np.float32)
    assert (vertices == mesh.vertices.astype(np.float32)).all()
    assert (np.array([line[1:] for line in lines if line[0] == "f"], int) - 1 == mesh.triangles).all()


def test_mujoco_loads_what_was_written():
    mesh = turned(box(0.1, 0.2, 0.3))
    model = compiled(mesh, collides=True)
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.mesh_quat[0])
    points = model.mesh_vert @ rotation.reshape(3, 3).T + model.mesh_pos[0]
    assert np.allclose(points[model.mesh_face], corners_of(mesh), atol=1e-7)


def test_a_mesh_keeps_arrays_that_nobody_can_write_to():
    vertices, triangles = np.eye(3), np.array([[0, 1, 2]])
    mesh = Mesh(vertices, triangles)
    vertices[0], triangles[0] = 9, 0
    assert (mesh.vertices == np.eye(3)).all()
    assert (mesh.triangles == [[0, 1, 2]]).all()
    again = Mesh(mesh.vertices, mesh.triangles)
    assert again.vertices is mesh.vertices
    assert again.triangles is mesh.triangles
    seen = vertices.view()
    seen.flags.writeable = False
    mesh = Mesh(seen, triangles.tolist())
    vertices[0] = 8
    assert (mesh.vertices[0] == 9).all()
    for wrong in (np.asfortranarray(np.eye(3)), np.eye(3, dtype=np.float32), np.eye(3).ravel()):
        wrong.flags.writeable = False
        mesh = Mesh(wrong, triangles)
        assert (mesh.vertices.shape, mesh.vertices.dtype) == ((3, 3), np.float64)
        assert mesh.vertices.flags.c_contiguous
        assert not mesh.vertices.flags.writeable


def test_volume_and_area():
    mesh = box(1, 2, 3)
    assert volume(mesh) == pytest.approx(6)
    assert volume(Mesh(mesh.vertices * [-1, 1, 1], mesh.triangles)) == pytest.approx(-6)
    assert area(mesh) == pytest.approx(22)
    assert (volume(EMPTY), area(EMPTY)) == (0, 0)


def test_welding_joins_equal_corners_only():
    corners = corners_of(box(1, 2, 3))
    mesh = weld(corners)
    assert len(mesh.vertices) == 8
    assert (corners_of(mesh) == corners).all()
    assert (
        corners_of(weld(np.array([[[0.0, 0, 0], [-0.0, 0, 0], [1e-30, 0, 0]]])))[0, :, 0] == [0, 0, np.float32(1e-30)]
    ).all()
    assert len(weld(np.zeros((0, 3, 3))).vertices) == 0


@examples(60)
@given(
    st.lists(st.floats(0.2, 1), min_size=4, max_size=40),
    st.sampled_from([np.eye(3), np.eye(3)[[1, 2, 0]], -np.eye(3)[[0, 2, 1]]]),
)
def test_ears_of_star_shaped_polygons(radii, axes):
    angles = 2 * np.pi * np.arange(len(radii)) / len(radii)
    polygon = np.stack([radii * np.cos(angles), radii * np.sin(angles), np.full(len(radii), 3.0)], axis=1) @ axes
    cut = polygon[clip_ears(polygon)]
    assert len(cut) == len(polygon) - 2
    normals = np.cross(cut[:, 1] - cut[:, 0], cut[:, 2] - cut[:, 0])
    whole = np.cross(polygon, np.roll(polygon, -1, axis=0)).sum(axis=0)
    assert np.allclose(
        normals.sum(axis=0), np.cross(polygon - polygon[0], np.roll(polygon, -1, axis=0) - polygon[0]).sum(axis=0)
    )
    assert np.linalg.norm(normals, axis=1).sum() == pytest.approx(np.linalg.norm(normals.sum(axis=0)))
    assert whole.shape == (3,)


def test_bent_polygons_are_cut_from_the_last_corner():
    """As ear clipping does it, which starts with the first corner; only quadrilaterals have a rule of their own."""
    hexagon = np.array([[2, 0, 0], [1, 2, 1], [-1, 2, 0], [-2, 0, 1], [-1, -2, 0], [1, -2, 1]], float)
    cut = clipped(hexagon, np.array([0]), np.array([6]))
    assert cut.tolist() == [[5, 0, 1], [5, 1, 2], [5, 2, 3], [5, 3, 4]]
    assert [set(one) for one in clip_ears(hexagon).tolist()] == [set(one) for one in cut.tolist()]


@examples(60)
@given(st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=1, max_size=30))
def test_any_polygon_is_cut_somehow(points):
    polygon = np.array(points, float)
    assert len(clip_ears(polygon)) <= max(len(points) - 2, 0)
    starts, sizes = np.array([0]), np.array([len(points)])
    assert len(clipped(polygon, starts, sizes)) <= len(fans(starts, sizes))


needs_coacd = pytest.mark.skipif(importlib.util.find_spec("coacd") is None, reason="coacd is not installed")


@needs_coacd
def test_a_concave_mesh_becomes_convex_pieces(tmp_path, monkeypatch):
    monkeypatch.setenv("RAVEMJ_CACHE", str(tmp_path))
    ell = weld(
        np.concatenate(
            [primitives.box(np.array([3.0, 1, 1])), primitives.box(np.array([1.0, 1, 3])) + np.array([1.0, 0, 2])]
        )
    )
    pieces = decompose(ell, max_pieces=2)
    assert len(pieces) == 2
    assert all(collision_form(piece) == "hull" for piece in pieces)
    assert sum(map(volume, pieces)) == pytest.approx(6, rel=0.2)
    monkeypatch.setattr(decomposition, "_pieces", None)
    assert decompose(ell, max_pieces=2) == pieces  # from the cache


@pytest.mark.parametrize("width", [1e-3, 0.3, 30.0, 3e3, 3e5, 3e7])
def test_mujoco_loads_needles_or_they_are_left_out(width):
    far = 4294967295.0
    mesh = Mesh(
        np.array([[0.0, 0, 0], [0.4, 0, 0], [far, width, far], [0, 0, width]]),
        np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
    )
    if width < 100:
        assert collision_form(mesh) == "none"
    if collision_form(mesh) != "none":
        text = '<mujoco><asset><mesh name="a" file="a.obj" inertia="shell"/></asset><worldbody/></mujoco>'
        mujoco.MjModel.from_xml_string(text, {"a.obj": write_obj(mesh).encode()})


def test_flat_meshes_are_not_cut(monkeypatch):
    monkeypatch.setattr(decomposition, "_pieces", None)
    assert decompose(SQUARE) == (SQUARE,)


def test_without_coacd_the_extra_is_named(monkeypatch):
    monkeypatch.setenv("RAVEMJ_CACHE", "off")
    monkeypatch.setattr(importlib, "import_module", lambda name: (_ for _ in ()).throw(ImportError(name)))
    with pytest.raises(RavemjError, match=r"pip install \"ravemj\[decompose\]\""):
        decompose(box(1, 1, 1))

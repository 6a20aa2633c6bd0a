"""What is shown of a model besides its looks: frames, axes, masses, contacts, names, and other ways to draw."""

import numpy as np
import pytest

import ravemj
from ravemj.graphics.rendering import Style, open_renderer, three_quarter_view
from ravemj.gui.interaction.figures import figures, names

ARM = """
<Robot name="arm"><KinBody>
  <Body name="base" type="dynamic"><Geom type="box"><extents>0.1 0.1 0.1</extents></Geom>
    <Mass type="custom"><total>2</total><com>0 0 0.05</com><inertia>0.4 0 0 0 0.5 0 0 0 0.3</inertia></Mass></Body>
  <Body name="upper" type="dynamic"><offsetfrom>base</offsetfrom>
    <Geom type="box"><extents>0.05 0.05 0.3</extents><Translation>0 0 0.4</Translation></Geom></Body>
  <Joint name="turn" type="hinge"><Body>base</Body><Body>upper</Body><offsetfrom>base</offsetfrom>
    <axis>0 0 1</axis><limitsdeg>-30 60</limitsdeg></Joint>
</KinBody></Robot>
"""


@pytest.fixture
def arm():
    env = ravemj.Environment()
    assert env.LoadData(f"<Environment>{ARM}</Environment>")
    env.GetRobots()[0].SetTransform([1, 0, 0, 0, 1, 2, 3])
    return env


def shown(env, name, radius=1.0):
    with env:
        return figures(env.simulation, frozenset([name]), radius)


def test_frames_are_at_the_links_with_their_axes_in_red_green_blue(arm):
    arm.GetRobots()[0].SetDOFValues([0.5])
    for link, figure in zip(arm.GetRobots()[0].GetLinks(), shown(arm, "frames"), strict=True):
        T = link.GetTransform()
        ends, rgba = figure.lines.corners, figure.lines.rgba
        np.testing.assert_allclose(ends[:, 0], np.tile(T[:3, 3], (3, 1)), atol=1e-12)
        ways = ends[:, 1] - ends[:, 0]
        np.testing.assert_allclose(ways / np.linalg.norm(ways, axis=1)[:, None], T[:3, :3].T, atol=1e-12)
        assert rgba[:, :3].argmax(axis=1).tolist() == [0, 1, 2]


def test_joint_axes_have_the_range_of_their_limits(arm):
    robot = arm.GetRobots()[0]
    for value in (0.0, 0.4):
        robot.SetDOFValues([value])
        (figure,) = shown(arm, "axes")
        axis = figure.lines.corners[0]
        np.testing.assert_allclose(axis[:, :2], [[1, 2], [1, 2]], atol=1e-12)
        sector = figure.triangles.corners
        now = figure.lines.corners[1, 1] - [1, 2, 3]
        ways = sector[:, 1:].reshape(-1, 3) - [1, 2, 3]
        angles = np.arctan2(np.cross(now, ways)[:, 2], ways @ now)
        assert np.degrees(angles.min()) == pytest.approx(-30 - np.degrees(value))
        assert np.degrees(angles.max()) == pytest.approx(60 - np.degrees(value))


def test_masses_are_at_their_centres_and_ellipsoids_have_the_links_inertia(arm):
    spheres, *ellipsoids = shown(arm, "masses")
    np.testing.assert_allclose(spheres.spheres.corners[0, 0], [1, 2, 3.05], atol=1e-12)
    corners = ellipsoids[0].triangles.corners
    half = np.abs(corners - [1, 2, 3.05]).max(axis=(0, 1))
    squares = half**2
    moments = 2 / 5 * (squares.sum() - squares)  # of an even solid of 2 kg
    np.testing.assert_allclose(moments, [0.4, 0.5, 0.3], rtol=0.03)


def test_contacts_are_where_things_touch(arm):
    box = ravemj.RaveCreateKinBody(arm, "")
    box.InitFromBoxes(np.array([[0, 0, 0, 0.1, 0.1, 0.1]]), True)
    box.SetName("box")
    arm.Add(box)
    box.SetTransform([1, 0, 0, 0, 1.19, 2, 3])
    (figure,) = shown(arm, "contacts")
    points = figure.spheres.corners.reshape(-1, 3)
    assert len(points)
    np.testing.assert_allclose(points[:, 0], 1.095, atol=0.01)
    box.SetTransform([1, 0, 0, 0, 3, 2, 3])
    assert shown(arm, "contacts") == []


def test_names_are_at_the_links(arm):
    labels = {label.text: label.point for label in names(arm.simulation)}
    np.testing.assert_allclose(labels["base"], [1, 2, 3.05], atol=1e-12)
    assert set(labels) == {"base", "upper"}


@pytest.mark.parametrize("model", ["puma560", "panda", "scara"])
def test_everything_can_be_shown_of_real_robots(model):
    from ravemj.formats.shipped import model_path

    env = ravemj.load(model_path(model))
    for name in ("frames", "axes", "masses", "contacts"):
        for figure in shown(env, name):
            for batch in figure.batches:
                assert np.isfinite(batch.corners).all()
    env.Destroy()


# --- ways to draw, in pixels

SEEN_AND_COLLIDING = """
<mujoco><visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
<asset><texture name="background" type="skybox" builtin="flat" width="8" height="48" rgb1="1 1 1" rgb2="1 1 1"/>
<mesh name="ell" vertex="0 0 0  1 0 0  0 1 0  0 0 .2  1 1 .2"/></asset>
<worldbody><body name="one"><geom type="box" size=".3 .3 .3" rgba=".5 0 0 1" group="2"/>
<geom type="sphere" size=".3" rgba="0 0 .5 1" group="3"/></body></worldbody></mujoco>
"""


def test_styles_are_seen():
    import mujoco

    model = mujoco.MjModel.from_xml_string(SEEN_AND_COLLIDING)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    camera = three_quarter_view([0, 0, 0], 0.6)
    with open_renderer(model, 120, 120) as renderer:
        if renderer.backend == "ray":
            pytest.skip("styles need OpenGL, which does not work here")
        middle = {
            style: renderer.render(data, camera, style=style)[60, 60].astype(int)
            for style in (Style(), Style(collision=True), Style(lit=1), Style(transparent=True))
        }
        lines = renderer.render(data, camera, style=Style(wireframe=True))
        again = renderer.render(data, camera)[60, 60]
    plain = middle[Style()]
    assert plain[0] > 60 > plain[2]
    assert np.array_equal(plain, again), "a style is for one picture"
    assert middle[Style(collision=True)][2] > 60 > middle[Style(collision=True)][0]
    assert middle[Style(lit=1)][2] > plain[2] + 50
    assert middle[Style(transparent=True)][2] > 100, "white is seen through it"
    white = (lines > 250).all(axis=2).mean()
    assert 0.7 < white < 0.999

"""A model that is read again while it is shown."""

import os
from argparse import Namespace

import numpy as np
import pytest

import ravemj
from ravemj.cli.reloading import Reloader
from ravemj.gui.interaction import Key, Operate, Press, Release
from ravemj.gui.interaction.joint_handle import JointHandle

ARM = """<Environment><Robot name="arm" file="arm.kinbody.xml"/></Environment>"""
BODY = """<KinBody>
  <Body name="base" type="dynamic"><Geom type="box"><extents>0.1 0.1 0.1</extents></Geom></Body>
  <Body name="upper" type="dynamic"><offsetfrom>base</offsetfrom>
    <Geom type="box"><extents>0.05 {width} 0.3</extents><Translation>0 0 0.4</Translation></Geom></Body>
  <Joint name="turn" type="hinge"><Body>base</Body><Body>upper</Body><offsetfrom>base</offsetfrom>
    <axis>1 0 0</axis><limitsdeg>-90 {limit}</limitsdeg></Joint>
</KinBody>"""


class Shown:
    def __init__(self, folder, *, watches=True):
        self.part = folder / "arm.kinbody.xml"
        self.save(BODY.format(width=0.05, limit=90))
        (folder / "env.xml").write_text(ARM)
        self.env = ravemj.load(folder / "env.xml")
        self.env.SetViewer("offscreen")
        self.viewer = self.env.GetViewer()
        self.gui = self.viewer.interaction
        self.viewer.SetCamera([[0, 0, -1, 3], [1, 0, 0, 0], [0, -1, 0, 0.3], [0, 0, 0, 1]])
        self.reloader = Reloader(self.env, self.viewer, Namespace(model=str(folder / "env.xml"), watch=watches))

    def save(self, text):
        before = self.part.stat().st_mtime_ns if self.part.exists() else 0
        self.part.write_text(text)
        os.utime(self.part, ns=(before + 10**9, before + 10**9))

    @property
    def width(self):
        return self.env.GetRobots()[0].GetLinks()[1].GetGeometries()[0].GetBoxExtents()[1]

    @property
    def lines(self):
        return self.gui.overlay().lines


@pytest.fixture
def shown(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shown = Shown(tmp_path)
    yield shown
    shown.env.Destroy()


def test_a_file_that_is_included_is_saved_and_camera_values_and_selection_stay(shown):
    camera = shown.viewer.GetCameraTransform()
    shown.env.GetRobots()[0].SetDOFValues([0.5])
    shown.gui.handle(Key("escape"))
    ((x, y),), _ = shown.gui.view.camera.project([[0.1, 0, 0]], *shown.gui.view.size)
    upper = shown.env.GetRobots()[0].GetLinks()[1].GetTransform() @ [0.05, 0, 0.4, 1]
    ((x, y),), _ = shown.gui.view.camera.project([upper[:3]], *shown.gui.view.size)
    shown.gui.handle(Press(x, y, ctrl=True))
    shown.gui.handle(Release(x, y))
    assert shown.viewer.GetSelectedJoint().GetName() == "turn"
    shown.reloader.update()
    assert shown.width == pytest.approx(0.05)
    shown.save(BODY.format(width=0.08, limit=90))
    shown.reloader.update()
    assert shown.width == pytest.approx(0.08)
    assert np.array_equal(shown.viewer.GetCameraTransform(), camera)
    np.testing.assert_allclose(shown.env.GetRobots()[0].GetDOFValues(), [0.5])
    assert shown.viewer.GetSelectedJoint().GetName() == "turn"
    assert shown.viewer.GetSelectedJoint().GetParent() == shown.env.GetRobots()[0]
    assert JointHandle.at(shown.gui.selection.body, 0).radius > 0
    assert any("again" in line for line in shown.lines)


def test_values_stop_at_new_limits(shown):
    shown.env.GetRobots()[0].SetDOFValues([1.5])
    shown.save(BODY.format(width=0.05, limit=30))
    shown.reloader.update()
    np.testing.assert_allclose(shown.env.GetRobots()[0].GetDOFValues(), [np.radians(30)])


def test_an_error_is_shown_with_file_and_line_until_it_is_mended(shown):
    shown.save(BODY.format(width=0.08, limit=90).replace("</KinBody>", "</KinBdy>"))
    shown.reloader.update()
    assert shown.width == pytest.approx(0.05), "the last good model stays"
    (error,) = shown.lines
    assert "arm.kinbody.xml:7" in error or "arm.kinbody.xml:8" in error, error
    shown.gui.advance(1e12)
    assert shown.lines == (error,)
    shown.save(BODY.format(width=0.07, limit=90))
    shown.reloader.update()
    assert shown.width == pytest.approx(0.07)
    assert error not in shown.lines


def test_a_file_that_is_gone_for_a_moment_is_an_error_for_a_moment(shown):
    text = shown.part.read_text()
    shown.part.unlink()
    shown.reloader.update()
    assert "arm.kinbody.xml" in shown.lines[0]
    assert shown.env.GetRobots()
    shown.save(text)
    shown.reloader.update()
    assert not any("arm.kinbody.xml" in line for line in shown.lines)


def test_a_selection_that_is_gone_is_forgotten(shown):
    shown.gui.handle(Key("escape"))
    ((x, y),), _ = shown.gui.view.camera.project([[0.1, 0, 0]], *shown.gui.view.size)
    shown.gui.handle(Press(x, y))
    shown.gui.handle(Release(x, y))
    assert shown.viewer.GetSelectedBody().GetName() == "arm"
    shown.save(BODY.format(width=0.05, limit=90).replace('"base"', '"foot"').replace(">base<", ">foot<"))
    shown.reloader.update()
    assert shown.viewer.GetSelectedBody() is None
    assert [link.GetName() for link in shown.env.GetRobots()[0].GetLinks()] == ["foot", "upper"]


def test_with_physics_the_base_is_held_again(shown):
    shown.env.SetPhysicsEngine("mujoco")
    shown.save(BODY.format(width=0.02, limit=90))
    shown.reloader.update()
    assert shown.width == 0.02
    assert [link.IsStatic() for link in shown.env.GetRobots()[0].GetLinks()] == [True, False]


def test_a_key_reads_it_again_and_nothing_else_does_without_watching(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shown = Shown(tmp_path, watches=False)
    shown.save(BODY.format(width=0.08, limit=90))
    shown.reloader.update()
    assert shown.width == pytest.approx(0.05)
    shown.gui.another_view().handle(Key("r"))
    shown.reloader.update()
    assert shown.width == pytest.approx(0.08)
    shown.env.Destroy()


def test_elsewhere_the_key_says_who_does_it(env):
    env.SetViewer("offscreen")
    gui = env.GetViewer().interaction
    gui.handle(Operate("reload"))
    assert "ravemj view" in gui.overlay().lines[0]

"""Which backend draws: found without environment variables, explained where it fails, quiet at the end."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import REPOSITORY, one_in
from waiting import PATIENCE

from ravemj.errors import RenderingError
from ravemj.graphics.rendering import open_renderer
from ravemj.graphics.rendering.contexts import GL_BACKENDS, remedy, requested_backend
from ravemj.graphics.rendering.doctor import probe, probe_backends

DRAW = """
import sys
import mujoco
import numpy as np
from ravemj.graphics.rendering import Camera, open_renderer

def draw(backend=None, close=True):
    model = mujoco.MjModel.from_xml_string('<mujoco><worldbody><geom size=".1"/></worldbody></mujoco>')
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    T = np.eye(4)
    T[2, 3] = -1
    renderer = open_renderer(model, 32, 24, backend=backend)
    assert renderer.segment(data, Camera(T))[12, 16] == 0
    assert renderer.render(data, Camera(T)).shape == (24, 32, 3)
    if close:
        renderer.close()
    return renderer

"""
HIDE = """
import ctypes
real = ctypes.CDLL
class Hidden(real):
    def __init__(self, name, *arguments, **options):
        if name and any(word in str(name) for word in {words!r}):
            raise OSError(f"{{name}}: cannot open shared object file")
        super().__init__(name, *arguments, **options)
ctypes.CDLL = Hidden
ctypes.cdll = ctypes.LibraryLoader(Hidden)
"""


@pytest.fixture(scope="module")
def reports():
    return {report.name: report for report in probe_backends()}


def python(code, **variables):
    """Run code in a fresh process without display and MUJOCO_GL, and insist on silence on stderr."""
    dropped = ("MUJOCO_GL", "PYOPENGL_PLATFORM", "DISPLAY", "WAYLAND_DISPLAY")
    environment = {name: value for name, value in os.environ.items() if name not in dropped}
    environment |= {"PYTHONPATH": str(REPOSITORY), **variables}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert done.stderr == ""
    assert done.returncode == 0
    return done.stdout.strip()


def needs(reports, *names):
    for name in names:
        if not reports[name].works:
            pytest.skip(f"{name} does not work on this machine: {reports[name].detail}")


def test_reports_cover_every_backend_and_explain(reports):
    assert list(reports) == [*GL_BACKENDS, "ray"]
    assert reports["ray"].works
    for report in reports.values():
        assert report.detail
        assert "\n" not in report.detail
        assert bool(report.install) != report.works


@pytest.mark.parametrize("close", one_in(2, [True, False]))
@pytest.mark.parametrize("backend", GL_BACKENDS)
def test_each_backend_after_the_import_of_mujoco(reports, backend, close):
    needs(reports, backend)
    display = {name: os.environ[name] for name in ("DISPLAY", "WAYLAND_DISPLAY") if name in os.environ}
    code = f"import mujoco\n{DRAW}\nkept = draw({backend!r}, close={close})\nprint(kept.backend)"
    assert python(code, **(display if backend == "glfw" else {})) == backend


def test_egl_is_the_first_choice_and_leaves_no_trace_for_children(reports):
    needs(reports, "egl")
    code = DRAW + "import os\nprint(draw().backend, draw().backend, os.environ.get('PYOPENGL_PLATFORM'))"
    assert python(code) == "egl egl None"


def test_osmesa_where_libegl_is_missing(reports):
    needs(reports, "osmesa")
    assert python(HIDE.format(words=["EGL"]) + DRAW + "print(draw().backend)") == "osmesa"


@pytest.mark.stress
@pytest.mark.parametrize(
    "broken",
    one_in(2, [{"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}, {"LIBGL_DRIVERS_PATH": "/nonexistent"}]),
    ids=["no vendor", "no driver"],
)
def test_osmesa_where_egl_is_there_and_does_not_work(reports, broken):
    needs(reports, "egl", "osmesa")
    before = python(DRAW + "try:\n    draw('egl')\nexcept Exception as error:\n    print(error)", **broken)
    if not before:
        pytest.skip("this driver cannot be broken by an environment variable")
    assert before.startswith("cannot draw with egl: EGL ")
    assert "apt-get install libegl1 libgl1" in before
    assert python(DRAW + "print(draw().backend)", **broken) == "osmesa"


def test_rays_where_no_library_is(reports):
    hidden = HIDE.format(words=["EGL", "OSMesa", "libGL", "OpenGL"])
    assert python(hidden + DRAW + "print(draw().backend)") == "ray"


def test_mujoco_gl_can_forbid_opengl():
    code = DRAW + "print(draw().backend, 'libEGL' in open('/proc/self/maps').read())"
    if not Path("/proc/self/maps").exists():
        pytest.skip("this system has no /proc/self/maps")
    assert python(code, MUJOCO_GL="disable") == "ray False"


@pytest.mark.parametrize("backend", ["egl", "osmesa"])
def test_mujoco_gl_names_the_backend(reports, backend):
    needs(reports, backend)
    assert python(DRAW + "print(draw().backend)", MUJOCO_GL=backend) == backend


def test_mujoco_gl_that_does_not_work_is_an_error():
    code = DRAW + "try:\n    draw()\nexcept Exception as error:\n    print(type(error).__name__, error)"
    said = python(code, MUJOCO_GL="glfw")
    assert said.startswith("RenderingError cannot draw with glfw: there is no display")
    assert "xvfb" in said


def test_unknown_mujoco_gl(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "vulkan")
    with pytest.raises(RenderingError, match="MUJOCO_GL is 'vulkan', expected egl"):
        requested_backend()
    for value in ("off", "0", " Disabled "):
        monkeypatch.setenv("MUJOCO_GL", value)
        assert requested_backend() == "ray"


def test_import_loads_no_opengl():
    if not Path("/proc/self/maps").exists():
        pytest.skip("this system has no /proc/self/maps")
    code = "import ravemj.graphics.rendering\nmaps = open('/proc/self/maps').read()\n"
    code += "print([name for name in ('libEGL', 'libOSMesa', 'libGL.so', 'libOpenGL') if name in maps])"
    assert python(code) == "[]"


def test_osmesa_after_egl_is_refused_in_words(reports):
    needs(reports, "egl", "osmesa")
    code = DRAW + "draw('egl')\ntry:\n    draw('osmesa')\nexcept Exception as error:\n    print(error)"
    assert python(code) == "osmesa cannot draw in a process that egl draws in already"


def test_renderer_that_is_collected(reports):
    needs(reports, "egl")
    assert python(DRAW + "import gc\ndraw(close=False)\ngc.collect()\nprint(draw(close=False).backend)") == "egl"


def test_the_log_names_what_draws(caplog):
    import mujoco

    with caplog.at_level("INFO", logger="ravemj"):
        open_renderer(mujoco.MjModel.from_xml_string("<mujoco/>"), 8, 6, backend="ray").close()
    assert "pictures of 8 x 6 are drawn by ray" in caplog.text


def test_probes_survive_a_driver_that_ends_the_process(monkeypatch):
    monkeypatch.setattr("ravemj.graphics.rendering.doctor._CHILD", "import os\nos.abort()")
    egl = probe("egl")
    assert not egl.works
    assert egl.detail == "the driver ended the process (SIGABRT)"
    assert egl.install


@pytest.mark.parametrize("device", ["3", "x", ""])
def test_a_number_of_no_gpu_gets_no_advice_to_install(monkeypatch, device):
    monkeypatch.setenv("MUJOCO_EGL_DEVICE_ID", device)
    assert remedy("egl") == "unset MUJOCO_EGL_DEVICE_ID, or set it to the number of a GPU"
    assert "libosmesa6" in remedy("osmesa")
    monkeypatch.delenv("MUJOCO_EGL_DEVICE_ID")
    assert "libegl1" in remedy("egl")


def test_probes_wait_only_so_long(monkeypatch):
    monkeypatch.setattr("ravemj.graphics.rendering.doctor._CHILD", "import time\ntime.sleep(60)")
    monkeypatch.setattr("ravemj.graphics.rendering.doctor._TIMEOUT", 0.2)
    assert probe("egl").detail == "no answer within 0.2 s"

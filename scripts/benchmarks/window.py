"""Windows: how soon they show something, what they cost while nothing changes, and what they leave to the script."""

import statistics
import sys

from benchmarks.measure import MODEL, Row, run_python
from ravemj.gui.viewers import has_display

_PROCESSES = 3
_MOST_IDLE = 3.0
"""How much of a processor a window may use while nothing changes [%]."""

_OURS = """
import sys, time
import ravemj
begin = time.perf_counter()
env = ravemj.load(sys.argv[1])
env.SetViewer("window")
env.GetViewer().EnvironmentSync()
print(time.perf_counter() - begin)
"""

_BARE = """
import sys, time
import glfw, mujoco, ravemj
text = ravemj.load(sys.argv[1]).mjcf
begin = time.perf_counter()
model = mujoco.MjModel.from_xml_string(text)
data = mujoco.MjData(model)
mujoco.mj_kinematics(model, data)
glfw.init()
glfw.window_hint(glfw.SAMPLES, 4)
window = glfw.create_window(960, 720, "bare", None, None)
glfw.make_context_current(window)
scene = mujoco.MjvScene(model, 1000)
context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
every = mujoco.mjtCatBit.mjCAT_ALL.value
mujoco.mjv_updateScene(model, data, mujoco.MjvOption(), None, mujoco.MjvCamera(), every, scene)
mujoco.mjr_render(mujoco.MjrRect(0, 0, 960, 720), scene, context)
glfw.swap_buffers(window)
print(time.perf_counter() - begin)
"""

_BESIDE = """
import sys, time
import ravemj

def run(seconds):
    count, start = 0, time.monotonic()
    while time.monotonic() < start + seconds:
        robot.SetDOFValues([0.01 * count, 0])
        count += 1
        time.sleep(0.01)
    return count / seconds

env = ravemj.load(sys.argv[1])
robot = env.GetRobots()[0]
alone = run(2)
env.SetViewer("window")
env.GetViewer().EnvironmentSync()
time.sleep(1)
used, begin = time.process_time(), time.monotonic()
time.sleep(3)
idle = (time.process_time() - used) / (time.monotonic() - begin)
print(run(3), alone, 100 * idle)
"""


def rows() -> list[Row]:
    """Compare with a bare window, and with a script that has none; nothing, with a line, where there is no display."""
    if not has_display():
        print("bench: window is skipped, as there is no display", file=sys.stderr)
        return []
    series = [[_numbers(text)[0] for text in (_OURS, _BARE)] for _ in range(_PROCESSES)]
    ours, bare = (1e3 * statistics.median(seconds) for seconds in zip(*series, strict=True))
    beside = [_numbers(_BESIDE) for _ in range(3)]
    rate, alone, idle = (statistics.median(numbers) for numbers in zip(*beside, strict=True))
    return [
        Row("from load to the first frame in a window : bare GLFW and MuJoCo, model as text", "ms", ours, bare, 1.5),
        Row("processor of an idle window : limit", "%", idle, _MOST_IDLE, 1.0),
        Row("SetDOFValues every 10 ms beside a window : without one", "Hz", rate, alone, 0.6, more_is_better=True),
    ]


def _numbers(text: str) -> list[float]:
    return [float(word) for word in run_python("-c", text, str(MODEL)).split()]

"""From a model file to a compiled model."""

import tempfile

import mujoco

import ravemj
from benchmarks.measure import MODEL, Row, microseconds, take_turns
from ravemj.engine.simulation import Compiled
from ravemj.errors import Diagnostics
from ravemj.formats import mjcf
from ravemj.formats.readers import read_file


def rows() -> list[Row]:
    """Compare ``ravemj.load``, which compiles as well, with MuJoCo on the MJCF that it makes."""
    text = ravemj.load(MODEL).mjcf
    model = mujoco.MjModel.from_xml_string(text)
    scene = read_file(MODEL).scene
    floor = microseconds(lambda: mujoco.MjModel.from_xml_string(text))
    whole, stated, bare, bare_stated = take_turns(
        [
            microseconds(lambda: ravemj.load(MODEL)),
            microseconds(lambda: ravemj.load(MODEL).data),
            floor,
            microseconds(lambda: mujoco.MjData(mujoco.MjModel.from_xml_string(text))),
        ],
        300,
    )
    read, write, compiled, make_data, bare_again = take_turns(
        [
            microseconds(lambda: read_file(MODEL)),
            microseconds(lambda: mjcf.write(scene, Diagnostics())),
            microseconds(lambda: Compiled(scene, Diagnostics()).data),
            microseconds(lambda: mujoco.MjData(model)),
            floor,
        ],
        200,
    )
    gains, convert, from_files = _converting()
    return [
        Row("load, translate, compile env.xml : MjModel.from_xml_string", "µs", whole, bare, 3.5),
        Row("  the same with the state : MjModel.from_xml_string, MjData", "µs", stated, bare_stated, 3.5),
        Row("  reading alone", "µs", read, bare_again),
        Row("  writing MJCF alone", "µs", write, bare_again),
        Row("  writing MJCF, MjSpec, MjModel, MjData", "µs", compiled, bare_again),
        Row("  MjData alone, which the floor does not make", "µs", make_data, bare_again),
        Row("load, write_mjcf of the SCARA with servos : MjModel.from_xml_path", "µs", convert, from_files),
        Row("  gains of its servos alone", "µs", gains, from_files),
    ]


def _converting() -> list[float]:
    """Return the times of gains, of a conversion with meshes, and of MuJoCo with the result."""
    path = ravemj.model_path("scara")
    robot = ravemj.load(path).GetRobots()[0]
    with tempfile.TemporaryDirectory() as folder:
        made = ravemj.load(path).write_mjcf(f"{folder}/scara", actuators="position")
        return take_turns(
            [
                microseconds(robot.servo_gains),
                microseconds(lambda: ravemj.load(path).write_mjcf(f"{folder}/scara", actuators="position")),
                microseconds(lambda: mujoco.MjModel.from_xml_path(made)),
            ],
            20,
        )

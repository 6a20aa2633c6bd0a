"""From a model file to a compiled model."""

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
    return [
        Row("load, translate, compile env.xml : MjModel.from_xml_string", "µs", whole, bare, 3.5),
        Row("  the same with the state : MjModel.from_xml_string, MjData", "µs", stated, bare_stated, 3.5),
        Row("  reading alone", "µs", read, bare_again),
        Row("  writing MJCF alone", "µs", write, bare_again),
        Row("  writing MJCF, MjSpec, MjModel, MjData", "µs", compiled, bare_again),
        Row("  MjData alone, which the floor does not make", "µs", make_data, bare_again),
    ]

"""A simulated grasp beside queries of a prototype, which took 75 moves and collision checks for sliders on a box."""

import time

import numpy as np

import ravemj
from benchmarks.measure import Row, take_turns
from ravemj.rave.planning.grasper import GraspParameters, simulate

_CHECKS = 75
"""Queries ``SetDOFValues`` and ``CheckCollision`` that a grasp of the prototype took as long as."""

_SCENE = """<Environment><Robot name="hand"><KinBody>
<Body name="palm"><Geom type="box"><extents>.06 .02 .01</extents></Geom></Body>
<Body name="l"><Translation>-.045 0 .04</Translation><Geom type="box"><extents>.005 .01 .03</extents></Geom></Body>
<Body name="r"><Translation>.045 0 .04</Translation><Geom type="box"><extents>.005 .01 .03</extents></Geom></Body>
<Joint name="jl" type="slider"><Body>palm</Body><Body>l</Body><axis>1 0 0</axis><limits>0 .04</limits></Joint>
<Joint name="jr" type="slider"><Body>palm</Body><Body>r</Body><axis>-1 0 0</axis><limits>0 .04</limits></Joint>
</KinBody><Manipulator name="grip"><base>palm</base><effector>palm</effector><joints>jl jr</joints>
<closingdirection>1 1</closingdirection><Translation>0 0 .04</Translation></Manipulator></Robot>
<KinBody name="box"><Body name="b"><Geom type="box"><extents>.02 .03 .02</extents></Geom></Body></KinBody>
</Environment>"""


def rows(rounds: int = 9, count: int = 20) -> list[Row]:
    """Simulate grasps of a box by two sliders, in turns with the queries."""
    env = ravemj.Environment()
    env.LoadData(_SCENE)
    robot, box = env.GetRobot("hand"), env.GetKinBody("box")
    assert robot is not None and box is not None, "the scene has both"  # noqa: PT018 - no test
    parameters, random = GraspParameters(target=box), np.random.default_rng(0)

    def grasp() -> float:
        begin = time.process_time()
        for _ in range(count):
            simulate(robot, parameters, {0: 1.0, 1: 1.0}, random)
        return (time.process_time() - begin) / count

    def queries() -> float:
        begin = time.process_time()
        for number in range(count * _CHECKS):
            robot.SetDOFValues([0.001 * (number % 9), 0.01])
            env.CheckCollision(robot, box)
        return (time.process_time() - begin) / count

    ours, floor = take_turns([grasp, queries], rounds)
    return [Row("a grasp of a box : 75 queries", "ms", 1e3 * ours, 1e3 * floor, 1.25, note="quality apart")]

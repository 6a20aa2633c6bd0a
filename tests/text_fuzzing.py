"""Damaged and random trajectories and parameters of planners, and the calls that scripts make with them.

``TextFuzzer`` makes them from a seed: number n of a seed is always the same. ``TextTrial`` lets nothing pass but
OpenRAVE's exception, and what ravemj says that it cannot do.
"""

import base64
import functools
import json
import math
import random
import warnings
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

import numpy as np
from fuzzing import Files, Outcome
from waiting import PATIENCE, time_limit

import ravemj
from ravemj import Planner, Trajectory, planningutils

PIECES = (
    "0 -1 1e400 nan inf 1e21 " + "9" * 400 + " \0 \u00e9 <group/> </data> <data> <configuration> dof='0' offset='7' "
    'deltatime iswaypoint "linear" affine_transform ikparam_values ]]> <!-- &amp; &x; _nmaxiterations _fsteplength'
).split(" ")
PARAMETERS = (
    "<_nmaxiterations>10</_nmaxiterations><_fsteplength>0.1</_fsteplength><hastimestamps>0</hastimestamps>"
    "<interpolation>linear</interpolation><pointtolerance>0.2</pointtolerance><multidofinterp>2</multidofinterp>"
)
PLANNERS = [
    "", "LinearTrajectoryRetimer", "ParabolicTrajectoryRetimer", "CubicTrajectoryRetimer", "CubicTrajectoryRetimer2",
    "QuinticTrajectoryRetimer", "LinearSmoother", "ParabolicSmoother", "CubicSmoother", "birrt", "nosuch",
]  # fmt: skip
GROUPS = [
    ("joint_values Pendulum 0 1", 2), ("joint_values Pendulum 1", 1), ("joint_velocities Pendulum 0 1", 2),
    ("joint_accelerations Pendulum 0 1", 2), ("joint_jerks Pendulum 0 1", 2), ("affine_transform Pendulum 7", 3),
    ("affine_transform Pendulum 32", 4), ("affine_velocities Pendulum 7", 3), ("deltatime", 1), ("iswaypoint", 1),
    ("ikparam_values 1728053249", 7), ("mine", 2), ("grab Pendulum 0", 1), ("joint_values nosuch 0", 1),
    ("joint_values Pendulum 9", 1), ("affine_transform Pendulum -1", 3), ("joint_torques Pendulum 0 1", 2),
]  # fmt: skip
INTERPOLATIONS = ["", "linear", "quadratic", "cubic", "quartic", "quintic", "sextic", "next", "previous", "nosuch"]
NUMBERS = ["0", "0.1", "0.5", "1", "-0.3", "2", "10", "1e-9", "1e300", "nan", "-1e400", "1e-320"]
TAGS = [
    "_nmaxiterations", "_fsteplength", "_nrandomgeneratorseed", "_vconfigvelocitylimit", "_vconfigaccelerationlimit",
    "_vconfigjerklimit", "_vconfiglowerlimit", "_vinitialconfig", "_vgoalconfig", "_vconfigresolution", "hastimestamps",
    "hasvelocities", "outputaccelchanges", "verifyinitialpath", "interpolation", "_nmaxplanningtime", "nosuch",
]  # fmt: skip


def damaged(text: str, chance: random.Random) -> str:
    """Cut, repeat or replace up to four parts of a text."""
    for _ in range(chance.randint(1, 4)):
        place, end = sorted(chance.randrange(len(text) + 1) for _ in range(2))
        match chance.randrange(4):
            case 0:
                text = text[:place] + text[min(end, place + 12) :]
            case 1:
                text = text[:place] + chance.choice(PIECES) + text[place:]
            case 2:
                text = text[:place] + text[place:end] * 2 + text[end:]
            case _:
                text = text[:place] + chr(chance.randrange(1, 0x250)) + text[place + 1 :]
    return text


def damaged_bytes(data: bytes, chance: random.Random) -> bytes:
    """Cut data or change up to four bytes."""
    content = bytearray(data[: chance.randrange(len(data) + 1)] if chance.random() < 0.3 else data)
    for _ in range(chance.randint(1, 4) if content else 0):
        content[chance.randrange(len(content))] = chance.randrange(256)
    return bytes(content)


def random_parameters(chance: random.Random) -> str:
    """Return parameters of planners with random numbers; some are damaged."""
    values = [*NUMBERS[:8] * 3, *NUMBERS, "1 1", "linear", "quadratic", "", "x"]
    tags = [(tag, chance.choice(values)) for tag in chance.sample(TAGS, chance.randint(0, 4))]
    endless = {("_nmaxiterations", "1e300"), ("_nmaxplanningtime", "1e300")}  # done, but not today
    text = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags if (tag, value) not in endless)
    return damaged(text or PARAMETERS, chance) if chance.random() < 0.2 else text


def random_trajectory(chance: random.Random) -> str:
    """Return a trajectory of random groups and numbers; some are damaged."""
    chosen = [GROUPS[0], *chance.sample(GROUPS[1:], chance.randint(0, 4))] if chance.random() < 0.8 else []
    chosen = chosen or chance.sample(GROUPS, chance.randint(0, 3))
    if chance.random() < 0.6 and ("deltatime", 1) not in chosen:
        chosen.append(("deltatime", 1))
    chance.shuffle(chosen)
    offset, groups = 0, ""
    for name, dof in chosen:
        interpolation = chance.choice(INTERPOLATIONS[:6] if chance.random() < 0.8 else INTERPOLATIONS)
        groups += f'<group name={quoteattr(name)} offset="{offset}" dof="{dof}" interpolation="{interpolation}"/>\n'
        offset += dof
    count = chance.choice([0, 1, 2, 2, 3, 5])
    numbers = [chance.choice(NUMBERS[:7] if chance.random() < 0.98 else NUMBERS) for _ in range(count * offset)]
    text = (
        f'<trajectory type="GenericTrajectory">\n<configuration>\n{groups}</configuration>\n'
        f'<data count="{count}">\n{" ".join(numbers)}</data>\n</trajectory>\n'
    )
    return damaged(text, chance) if chance.random() < 0.2 else text


CALLS = {
    "sample": lambda t, robot, chance: t.Sample(chance.choice([0, 0.1, t.GetDuration(), 1e9, -1, math.nan])),
    "rows": lambda t, robot, chance: t.GetAllWaypoints2D(robot.GetActiveConfigurationSpecification()),
    "retime": lambda t, robot, chance: planningutils.RetimeTrajectory(
        t, chance.random() < 0.3, 1, 1, chance.choice(PLANNERS), random_parameters(chance)
    ),
    "retime active": lambda t, robot, chance: planningutils.RetimeActiveDOFTrajectory(
        t, robot, chance.random() < 0.3, chance.choice([1, 0.5, 0, -1, math.inf]), 1, chance.choice(PLANNERS),
        random_parameters(chance),
    ),
    "retime affine": lambda t, robot, chance: planningutils.RetimeAffineTrajectory(
        t, [1] * chance.randint(1, 5), [1] * chance.randint(1, 5), False, chance.choice(PLANNERS)
    ),
    "smooth": lambda t, robot, chance: planningutils.SmoothActiveDOFTrajectory(
        t, robot, plannername=chance.choice(PLANNERS), plannerparameters="<_nmaxiterations>3</_nmaxiterations>"
        + random_parameters(chance)
    ),
    "reverse": lambda t, robot, chance: planningutils.ReverseTrajectory(t),
    "derivatives": lambda t, robot, chance: planningutils.ComputeTrajectoryDerivatives(t, chance.randint(0, 3)),
    "segment": lambda t, robot, chance: planningutils.SegmentTrajectory(t, chance.choice([0, 0.1, 9]), chance.random()),
    "merge": lambda t, robot, chance: planningutils.MergeTrajectories([t] * chance.randint(0, 2)),
    "convert": lambda t, robot, chance: planningutils.ConvertTrajectorySpecification(
        t, robot.GetConfigurationSpecification(chance.choice(INTERPOLATIONS))
    ),
    "extend": lambda t, robot, chance: planningutils.InsertActiveDOFWaypointWithRetiming(
        chance.choice([0, t.GetNumWaypoints(), 1, -1]), [0.1, 0.2], [0, 0], t, robot, 1, 1, chance.choice(PLANNERS)
    ),
    "verify": lambda t, robot, chance: planningutils.VerifyTrajectory(problem(robot, chance), t, 0.01),
    "remove": lambda t, robot, chance: t.Remove(0, chance.choice([0, 1, 9])),
    "path": lambda t, robot, chance: robot.GetController().SetPath(t),
    "again": lambda t, robot, chance: Trajectory(t.GetEnv(), "").deserialize(t.serialize(0)),
}  # fmt: skip


def problem(robot, chance: random.Random) -> Planner.PlannerParameters:
    """Return parameters of a planner with random numbers."""
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetGoalConfig(chance.choice([[0.1, 0.2], [0, 0], [9, 9], [0.1], [math.nan, 0]]))
    params.SetExtraParameters("<_nmaxiterations>20</_nmaxiterations>" + random_parameters(chance))
    return params


def plan(traj, robot, chance: random.Random) -> None:
    """Run any planner on a trajectory."""
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), chance.choice(PLANNERS))
    if planner is not None:
        planner.InitPlan(robot, problem(robot, chance))
        planner.PlanPath(traj)


CALLS["plan"] = plan


class TextFuzzer:
    """Makes trajectories and the calls that are made with them.

    Attributes:
        seeds: Nothing; what is made depends on seed and number alone.
    """

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self.seeds: list[Files] = []

    def make(self, number: int) -> Files:
        """Return a trajectory as base64 and the names of calls."""
        chance = random.Random(f"{self._seed}/{number}")
        content = random_trajectory(chance).encode()
        calls = chance.choices(list(CALLS), k=chance.randint(1, 4))
        known = {"content": base64.b64encode(content).decode(), "calls": calls, "seed": f"{self._seed}/{number}"}
        return {"main.json": json.dumps(known).encode()}


@functools.cache
def arm():
    """Return the robot of all trials."""
    env = ravemj.Environment()
    env.StopSimulation()  # it lives on, and so would the thread of its time
    env.Load(ravemj.model_path("pendulum"))
    return env.GetRobots()[0]


@dataclass(frozen=True)
class TextTrial:
    """Reading of a trajectory, and some calls with it.

    Attributes:
        seconds: Longest time that it may take.
    """

    seconds: float = PATIENCE

    def run(self, files: Files) -> Outcome:
        """Read a trajectory and make the calls.

        Raises:
            BaseException: anything but OpenRAVE's exception and ``NotImplementedError`` goes through.
        """
        known = json.loads(files["main.json"])
        chance, robot, done = random.Random(known["seed"] + "/calls"), arm(), []
        robot.SetDOFValues(np.zeros(2))
        with time_limit(self.seconds), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            made = Trajectory(robot.GetEnv(), "")
            for name in ["read", *known["calls"]]:
                try:
                    if name == "read":
                        made.deserialize(base64.b64decode(known["content"]))
                    else:
                        CALLS[name](made, robot, chance)
                    done.append(name)
                except (ravemj.openrave_exception, NotImplementedError) as error:
                    assert str(error)  # noqa: PT017 - of many calls
                    if name == "read":
                        break
        return Outcome(links=len(done) > 1, signature=frozenset(done))

"""Plans with sscbirrt, in the environment in which it is installed; ``beside_sscbirrt`` starts it and sends tasks.

Lines of JSON come in: a task, then seeds. A line goes out for each seed: whether a path was found, process time [ms],
and which of its planners ran.
"""

import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import mujoco
import numpy as np
from sscbirrt import CBiRRTConfig  # pyright: ignore - in an environment of its own
from sscbirrt.mujoco import Arm, plan  # pyright: ignore
from tsr import TSR  # pyright: ignore


def main() -> None:
    """Answer each seed."""
    task = json.loads(sys.stdin.readline())
    model = mujoco.MjModel.from_xml_string(task["mjcf"])
    data = mujoco.MjData(model)
    data.qpos[: len(task["qpos"])] = task["qpos"]  # those of held bodies follow
    mujoco.mj_forward(model, data)
    with TemporaryDirectory() as folder:
        path = Path(folder, "arm.xml")
        path.write_text(task["arm"], encoding="utf-8")
        arm = Arm(model, task["joints"], "tool", mjcf=path)
    goals, constraints = ([_region(region) for region in task[role]] for role in ("goals", "constraints"))
    config = CBiRRTConfig(timeout=task["seconds"], smooth_path=False)
    for line in sys.stdin:
        begin = time.process_time()
        result = plan(
            model,
            data,
            arm,
            goal=goals,
            constraint=constraints or None,
            holding=task["holding"] or None,
            config=config,
            seed=json.loads(line),
        )
        print(json.dumps([result.success, (time.process_time() - begin) * 1e3, result.backend]), flush=True)


def _region(region: dict[str, list[list[float]]]) -> object:
    return TSR(**{name: np.array(rows) for name, rows in region.items()})


if __name__ == "__main__":
    main()

"""OpenRAVE's models, tutorial, Python API and GUI, on MuJoCo.

>>> import ravemj
>>> env = ravemj.load(ravemj.model_path("pendulum"))
>>> robot = env.GetRobots()[0]
>>> robot.SetDOFValues([0.785, 0.785])
>>> picture = env.render(640, 480)

``CamelCase`` names are OpenRAVE's, with OpenRAVE's meaning; ``snake_case`` names are ravemj's own.
"""

import os
import sys

try:
    # First, so that Ctrl-C ends commands from here on.
    import ravemj.core.signals  # noqa: F401  # pyright: ignore[reportUnusedImport]
except KeyboardInterrupt:
    if os.path.basename(sys.argv[0]) in ("ravemj", "ravemj.exe", "-m"):  # the command, before that is imported
        os._exit(130)
    raise

# isort: split

import importlib
from typing import TYPE_CHECKING

from ravemj import geometry_functions, rave
from ravemj.compat import names
from ravemj.compat.names import load_ipython_extension as load_ipython_extension  # for %load_ext ravemj
from ravemj.core.api_object import published as _published
from ravemj.core.version import __version__
from ravemj.errors import (
    ArgumentError,
    CompileError,
    Diagnostic,
    OutputError,
    RavemjError,
    RavemjWarning,
    RenderingError,
    Source,
    SourceError,
    UnsupportedError,
)
from ravemj.geometry_functions import *  # noqa: F403 - as its __all__ lists them

if TYPE_CHECKING:
    from ravemj.compat import databases, interfaces, misc, planningutils
    from ravemj.core.threads import set_batch_threads
    from ravemj.formats.shipped import model_path
    from ravemj.gui.viewers import Viewer
    from ravemj.manipulation.grasping.search import Grasp, Grasps
    from ravemj.planning.certificates import Certificate, CertifiedSpan
    from ravemj.rave import *  # noqa: F403 - as its __all__ lists them
    from ravemj.rave.grasping import draw_grasp, grasps
    from ravemj.rave.recording import record
    from ravemj.sweeps import Sweep, SweepError, sweep
    from ravemj.trajectories.joint_trajectory import JointTrajectory
    from ravemj.trajectories.joint_trajectory_files import read_joint_trajectory, write_joint_trajectory
    from ravemj.trajectories.motion import Motion
    from ravemj.trajectories.motion_reading import read_motion
    from ravemj.trajectories.motion_writing import write_motion

__all__ = [
    "ArgumentError",
    "Certificate",
    "CertifiedSpan",
    "CompileError",
    "Diagnostic",
    "Grasp",
    "Grasps",
    "JointTrajectory",
    "Motion",
    "OutputError",
    "RavemjError",
    "RavemjWarning",
    "RenderingError",
    "Source",
    "SourceError",
    "Sweep",
    "SweepError",
    "UnsupportedError",
    "Viewer",
    "__version__",
    "databases",
    "draw_grasp",
    "grasps",
    "interfaces",
    "misc",
    "model_path",
    "planningutils",
    "read_joint_trajectory",
    "read_motion",
    "record",
    "set_batch_threads",
    "sweep",
    "write_joint_trajectory",
    "write_motion",
]
__all__ += geometry_functions.__all__
__all__ += rave.__all__  # pyright: ignore[reportUnsupportedDunderAll] - it takes all that is imported above

for _error in (ArgumentError, CompileError, OutputError, RavemjError, RenderingError, SourceError, UnsupportedError):
    _published(_error, __name__)

_LATE = dict.fromkeys(rave.__all__, "ravemj.rave") | {
    "Certificate": "ravemj.planning.certificates",
    "CertifiedSpan": "ravemj.planning.certificates",
    "Grasp": "ravemj.manipulation.grasping.search",
    "Grasps": "ravemj.manipulation.grasping.search",
    "JointTrajectory": "ravemj.trajectories.joint_trajectory",
    "Motion": "ravemj.trajectories.motion",
    "Sweep": "ravemj.sweeps",
    "SweepError": "ravemj.sweeps",
    "Viewer": "ravemj.gui.viewers",
    "draw_grasp": "ravemj.rave.grasping",
    "grasps": "ravemj.rave.grasping",
    "read_joint_trajectory": "ravemj.trajectories.joint_trajectory_files",
    "read_motion": "ravemj.trajectories.motion_reading",
    "model_path": "ravemj.formats.shipped",
    "record": "ravemj.rave.recording",
    "set_batch_threads": "ravemj.core.threads",
    "sweep": "ravemj.sweeps",
    "write_joint_trajectory": "ravemj.trajectories.joint_trajectory_files",
    "write_motion": "ravemj.trajectories.motion_writing",
}


def __getattr__(name: str) -> object:
    """Import a name when it is first used, so that ``import ravemj`` is fast and does not import MuJoCo."""
    if name in names.PUBLIC:
        return importlib.import_module(f"ravemj.{name}")
    if name not in _LATE:
        raise AttributeError(f"module 'ravemj' has no attribute '{name}'")
    value = _published(getattr(importlib.import_module(_LATE[name]), name), "ravemj")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names, for tab completion."""
    return __all__

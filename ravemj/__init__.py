"""OpenRAVE's models, tutorial, Python API and GUI, on MuJoCo.

>>> import ravemj
>>> env = ravemj.load("models/env.xml")
>>> robot = env.GetRobots()[0]
>>> robot.SetDOFValues([0.785, 0.785])
>>> picture = env.render(640, 480)

``CamelCase`` names are OpenRAVE's, with OpenRAVE's meaning; ``snake_case`` names are ravemj's own.
"""

import ravemj._mujoco  # noqa: F401  # pyright: ignore[reportUnusedImport] - before all that imports mujoco
from ravemj import geometry_functions, rave
from ravemj.errors import (
    ArgumentError,
    CompileError,
    Diagnostic,
    ErrorCode,
    OutputError,
    RavemjError,
    RavemjWarning,
    RenderingError,
    Source,
    SourceError,
)
from ravemj.extension import load_ipython_extension
from ravemj.geometry_functions import *  # noqa: F403 - as its __all__ lists them
from ravemj.motion import Motion, read_motion
from ravemj.rave import *  # noqa: F403 - the OpenRAVE API, as its __all__ lists it
from ravemj.recording import record
from ravemj.viewers import Viewer

__version__ = "0.1.0"

OpenRAVEException = openrave_exception = RavemjError

__all__ = [
    "ArgumentError",
    "CompileError",
    "Diagnostic",
    "ErrorCode",
    "Motion",
    "OpenRAVEException",
    "OutputError",
    "RavemjError",
    "RavemjWarning",
    "RenderingError",
    "Source",
    "SourceError",
    "Viewer",
    "__version__",
    "load_ipython_extension",
    "openrave_exception",
    "read_motion",
    "record",
]
__all__ += geometry_functions.__all__
__all__ += rave.__all__


def __dir__() -> list[str]:
    """Return what completion shows: the names that are meant for users."""
    return __all__

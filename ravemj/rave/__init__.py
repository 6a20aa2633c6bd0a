"""The OpenRAVE API: familiar objects over a ``Simulation``.

``CamelCase`` methods are OpenRAVE's, with OpenRAVE's meaning, argument names and defaults; ``snake_case`` on the same
objects is ravemj's own.
"""

from ravemj.rave.environment import Environment, RaveGetEnvironment, load
from ravemj.rave.joint import Joint
from ravemj.rave.kinbody import CheckLimitsAction, KinBody, Robot
from ravemj.rave.link import Link

__all__ = ["CheckLimitsAction", "Environment", "Joint", "KinBody", "Link", "RaveGetEnvironment", "Robot", "load"]

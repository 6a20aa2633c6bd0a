"""Whole-body inverse kinematics: several tasks at once, as quadratic programs over small displacements.

A task is an error and a Jacobian (``tasks``). A displacement reduces the errors of all tasks within bounds
(``bounds``): weighted against one another by MuJoCo's solver for boxes (``box_qp``), or in strict priorities by
``daqp`` (``levels``). ``descent`` takes steps, exact in the contacts, until nothing improves.
"""

from ravemj.ik.whole_body.bounds import MotionLimits
from ravemj.ik.whole_body.descent import Descent, DescentResult, Mechanism
from ravemj.ik.whole_body.tasks import Inequality, TaskRows, WeightedTask

__all__ = ["Descent", "DescentResult", "Inequality", "Mechanism", "MotionLimits", "TaskRows", "WeightedTask"]

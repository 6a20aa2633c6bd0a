"""Planners and their parameters, under OpenRAVE's names.

``bodies`` is what moves, ``parameters`` the problem, ``planner`` the base of all planners, ``path_planners``,
``retimers`` and ``smoothers`` their kinds, and ``names`` makes them.
"""

from ravemj.rave.planning.names import RaveCreatePlanner
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.planner import Planner
from ravemj.rave.planning.status import PlannerProgress, PlannerStatus, PlanningError

__all__ = ["Planner", "PlannerParameters", "PlannerProgress", "PlannerStatus", "PlanningError", "RaveCreatePlanner"]

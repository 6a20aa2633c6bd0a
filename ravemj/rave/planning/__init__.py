"""Planners and their parameters, under OpenRAVE's names.

``parameters`` and ``values`` describe a planning problem. ``planner`` is the base class of all planners;
``path_planners``, ``hand_planners`` and ``processing`` contain them, and ``names`` makes a planner by name.
"""

from ravemj.rave.planning.names import RaveCreatePlanner
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.planner import Planner, PlannerProgress, PlannerStatus, PlanningError

__all__ = ["Planner", "PlannerParameters", "PlannerProgress", "PlannerStatus", "PlanningError", "RaveCreatePlanner"]

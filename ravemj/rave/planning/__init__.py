"""Planners and their parameters, under OpenRAVE's names.

``parameters`` states a planning problem and ``bodies`` the bodies that it moves. ``planner`` is the base class of all
planners; ``path_planners``, ``hand_planners``, ``retimers`` and ``smoothers`` hold its kinds, and ``names`` makes a
planner from its name.
"""

from ravemj.rave.planning.names import RaveCreatePlanner
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.planner import Planner, PlannerProgress, PlannerStatus, PlanningError

__all__ = ["Planner", "PlannerParameters", "PlannerProgress", "PlannerStatus", "PlanningError", "RaveCreatePlanner"]

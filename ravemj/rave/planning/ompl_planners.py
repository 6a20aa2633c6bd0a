"""The planners of OMPL, under the names of OpenRAVE's plugin or_ompl: ``OMPL_RRTConnect`` and so on."""

import logging
from dataclasses import replace

from ravemj.errors import ArgumentError
from ravemj.planning.ompl_search import OmplError, planner_classes, search_with_ompl
from ravemj.planning.problem import Problem
from ravemj.planning.rrt import Search
from ravemj.rave.planning.path_planners import PathPlanner
from ravemj.rave.planning.status import PlannerStatus
from ravemj.rave.planning.values import Values
from ravemj.rave.trajectory import Trajectory

_LOG = logging.getLogger("ravemj")

PREFIX = "ompl_"
"""The prefix of the names, in lower case."""


def is_ompl_planner(name: str) -> bool:
    """Return whether OMPL has a planner of a name. If OMPL is not installed, log how to install it."""
    classes = planner_classes()
    if classes is None:
        _LOG.warning("planner '%s' needs OMPL; install it: pip install \"ravemj[planning]\"", name)
        return False
    return name.lower().removeprefix(PREFIX) in classes


class OmplPlanner(PathPlanner):
    """A path planner of OMPL.

    Extra parameters of the planner are XML elements, such as ``<range>0.5</range>`` or ``<goal_bias>0.1</goal_bias>``.
    ``<time_limit>`` is the time it may take [s], as with or_ompl. Planners that look for the best path use all of their
    time or iterations.
    """

    def run(self, values: Values, traj: Trajectory) -> PlannerStatus:
        """Find a path, and process it."""
        try:
            return super().run(values, traj)
        except OmplError as error:
            return self._failed(str(error))

    def _check(self, values: Values) -> None:
        if values.conditions.manifold is not None:
            raise ArgumentError(f"{self._xmlid} knows no constraints of the tool; birrt does")
        super()._check(values)

    def _search(self, problem: Problem, values: Values) -> Search:
        classes = planner_classes()
        assert classes is not None, "there would be no planner"
        planner = classes[self._xmlid.lower().removeprefix(PREFIX)]
        budget, tags = problem.budget, values.tags
        if "time_limit" in tags:
            budget = replace(budget, seconds=values.tag("time_limit", 0.0))
        seed = int(problem.random.integers(2**31))
        return search_with_ompl(planner, problem.edges, problem.starts, problem.goals, budget, seed, tags)

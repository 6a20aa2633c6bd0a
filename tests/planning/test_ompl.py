"""The planners of OMPL, and what is said where it is not installed."""

import gc
import importlib.util
import weakref

import numpy as np
import pytest
from test_planners import ARM, box, env, parameters, planned, robot

import ravemj
from ravemj import PlannerStatus, planningutils
from ravemj.planning import ompl_search
from ravemj.planning.edges import Edges
from ravemj.planning.rrt import Budget, End
from ravemj.planning.space import Coordinates, Space

__all__ = ["env", "robot"]  # fixtures

needs_ompl = pytest.mark.skipif(
    importlib.util.find_spec("ompl") is None, reason='OMPL is not installed: pip install "ravemj[planning]"'
)


@needs_ompl
@pytest.mark.parametrize("name", ["OMPL_RRTConnect", "ompl_rrtstar", "OMPL_BITstar", "OMPL_PRM", "OMPL_KPIECE1"])
def test_plans_of_ompl_keep_limits_and_collisions_at_every_moment(robot, name):
    params = parameters(robot)
    params.SetMaxPlanningTime(100)  # which those that look for the best path use up
    params.SetExtraParameters("<range>0.4</range>")
    status, trajectory = planned(robot, params, name)
    assert status == PlannerStatus.HasSolution, status
    planningutils.VerifyTrajectory(None, trajectory, 0.01)
    spec = robot.GetActiveConfigurationSpecification()
    assert trajectory.GetWaypoint(0, spec).tolist() == [-1.2, 0.2]
    assert trajectory.GetWaypoint(-1, spec).tolist() == [1.2, 0.2]
    assert robot.GetDOFValues() == pytest.approx([-1.2, 0.2])


@needs_ompl
def test_circular_joints_are_circles_for_ompl():
    circular = ARM.replace('name="one" type="hinge"', 'name="one" type="hinge" circular="true"')
    env = ravemj.Environment()
    env.LoadData(circular.replace("<limitsrad>-2.8 2.8</limitsrad>", ""))
    box(env, "post", [0.55, 0, 0.15, 0.05, 0.05, 0.2])
    robot = env.GetRobot("arm")
    robot.SetDOFValues([2.5, 0])
    params = parameters(robot, goal=[-2.5, 0])
    params.SetPostProcessing("", "")
    status, trajectory = planned(robot, params, "OMPL_RRTConnect")
    assert status == PlannerStatus.HasSolution
    turned = np.cos(trajectory.GetAllWaypoints2D()[:, 0])
    assert turned.max() < 0  # the long way passes the post, and 0
    status, _ = planned(robot, params, "OMPL_KPIECE1")
    assert "OMPL: No projection" in status.description


@needs_ompl
def test_what_goes_wrong_with_ompl_is_said(robot):
    params = parameters(robot)
    params.SetExtraParameters("<range>far</range>")
    assert "<range>: OMPL's RRTConnect does not take 'far'" in planned(robot, params, "OMPL_RRTConnect")[0].description
    params.SetExtraParameters("<time_limit>long</time_limit>")
    with pytest.raises(ravemj.openrave_exception, match="<time_limit>: 'long' should be a number"):
        planned(robot, params, "OMPL_RRTConnect")
    params.add_constraint(lambda values: abs(values[0]) > 0.1)  # a wall
    for name in ("OMPL_RRTConnect", "OMPL_PRM"):
        params.SetExtraParameters("<time_limit>0.05</time_limit>")
        assert "the time was used up after " in planned(robot, params, name)[0].description
        params.SetExtraParameters("<_nmaxiterations>20</_nmaxiterations>")
        assert "the iterations were used up after " in planned(robot, params, name)[0].description
    assert ravemj.RaveCreatePlanner(robot.GetEnv(), "OMPL_nosuch") is None


@needs_ompl
@pytest.mark.parametrize("name", ["rrtconnect", "prm"])
def test_what_a_test_raises_comes_through_ompl_and_nothing_is_kept(name):
    space = Space(Coordinates(np.zeros(2, dtype=bool)), -np.ones(2), np.ones(2), np.ones(2), 0.05 * np.ones(2))
    ends = [np.array([-0.5, 0.0])], [np.array([0.5, 0.0])]
    planner = ompl_search.planner_classes()[name]

    def interrupted(values):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ompl_search.search_with_ompl(planner, Edges(space, interrupted), *ends, Budget(1000), 0, {})
    edges = Edges(space, lambda values: abs(values[0]) > 0.1 or values[1] > 0.8)
    paths = [ompl_search.search_with_ompl(planner, edges, *ends, Budget(1000), 3, {}) for _ in range(2)]
    assert paths[0].end is End.found
    if name != "prm":  # which looks at the clock
        assert paths[0].path.tolist() == paths[1].path.tolist(), "one seed, one path"
    alive = weakref.ref(edges)
    del edges
    gc.collect()
    assert alive() is None


@needs_ompl
def test_modules_plan_with_ompl(robot):
    helper = ravemj.interfaces.BaseManipulation(robot, plannername="OMPL_RRTConnect")
    trajectory = helper.MoveActiveJoints([1.2, 0.2], execute=False, outputtrajobj=True)
    planningutils.VerifyTrajectory(None, trajectory, 0.01)
    assert helper._base.planner == "OMPL_RRTConnect"  # noqa: SLF001 - no public name tells


def test_without_ompl_there_is_no_such_planner_and_a_warning_names_the_extra(robot, monkeypatch, caplog):
    def missing(name):
        raise ImportError(name)

    ompl_search.planner_classes.cache_clear()
    make = ravemj.RaveCreatePlanner  # which is imported when it is first asked for
    monkeypatch.setattr("importlib.import_module", missing)
    assert make(robot.GetEnv(), "OMPL_RRTConnect") is None
    assert 'pip install "ravemj[planning]"' in caplog.text
    ompl_search.planner_classes.cache_clear()

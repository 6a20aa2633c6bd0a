"""OpenRAVE's functions that make bodies and trajectories."""

from ravemj.model.scene import KinBody as SceneBody
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.environment import Environment
from ravemj.rave.interface import asked_for
from ravemj.rave.kinbody import KinBody
from ravemj.rave.robot import Robot
from ravemj.rave.trajectory import KIND, Trajectory


def RaveCreateKinBody(env: Environment, name: str = "") -> KinBody | None:
    """Make a body without links; ``InitFromBoxes`` and the like fill it, ``env.Add`` adds it.

    Args:
        env: The environment that it is for.
        name: OpenRAVE's name of the kind of body, which is empty.

    Returns:
        The body; None for an unknown kind.

    Example:
        >>> body = ravemj.RaveCreateKinBody(env, "")
        >>> body.InitFromBoxes([[0, 0, 0, 0.1, 0.2, 0.3]])
        True
        >>> body.SetName("box")
        >>> env.Add(body)
    """
    return None if asked_for(env, name, "RaveCreateKinBody")[0] else _empty(env, is_robot=False)


def RaveCreateRobot(env: Environment, name: str = "") -> Robot | None:
    """Make a robot without links; see ``RaveCreateKinBody``.

    Args:
        env: The environment that it is for.
        name: OpenRAVE's name of the kind of robot: empty or ``GenericRobot``.

    Returns:
        The robot; None for an unknown kind.
    """
    kind = asked_for(env, name, "RaveCreateRobot")[0].lower()
    robot = _empty(env, is_robot=True) if kind in {"", "genericrobot"} else None
    return robot if isinstance(robot, Robot) else None


def _empty(env: Environment, *, is_robot: bool) -> KinBody:
    scene = SceneBody(name="", is_robot=is_robot, links=(), joints=(), passive_joints=(), source=FROM_SCRIPT)
    return env.wrap(env.simulation.create(scene))


def RaveCreateTrajectory(env: Environment, name: str = "") -> Trajectory | None:
    """Make a trajectory.

    Args:
        env: The environment with the robots that the trajectory may refer to.
        name: ``GenericTrajectory``, the only type, in any letter case; empty: that one.

    Returns:
        The trajectory, or None where there is no such type.

    Example:
        >>> trajectory = RaveCreateTrajectory(env, "")
        >>> trajectory.Init(robot.GetConfigurationSpecification("linear"))
    """
    xmlid = asked_for(env, name, "RaveCreateTrajectory")[0] or KIND
    return Trajectory(env, xmlid) if xmlid.lower() == KIND.lower() else None

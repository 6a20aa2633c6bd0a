"""Objects that scripts hold, and the calls of their methods with one argument, which tests make with wrong values."""

import inspect

import ravemj

KINDS = {
    "robot": lambda env, robot: robot,
    "link": lambda env, robot: robot.GetLinks()[1],
    "joint": lambda env, robot: robot.GetJoints()[0],
    "geometry": lambda env, robot: robot.GetLinks()[1].GetGeometries()[0],
    "manipulator": lambda env, robot: robot.GetManipulators()[0],
    "checker": lambda env, robot: env.GetCollisionChecker(),
    "engine": lambda env, robot: ravemj.RaveCreatePhysicsEngine(env, "ode"),
    "controller": lambda env, robot: ravemj.RaveCreateController(env, "IdealController"),
    "sensor": lambda env, robot: ravemj.RaveCreateSensor(env, "BaseLaser2D"),
    "trajectory": lambda env, robot: ravemj.RaveCreateTrajectory(env, ""),
    "module": lambda env, robot: ravemj.RaveCreateModule(env, "BaseManipulation"),
}
"""What scripts hold and call, in an environment with a robot."""


def calls_with_one_argument(thing):
    """Return each method that takes one argument alone, and the name of that argument."""
    for method in dir(thing):
        found = inspect.getattr_static(type(thing), method, None)
        if method[0] == "_" or not inspect.isfunction(found):
            continue
        arguments = list(inspect.signature(found).parameters.values())[1:]
        required = [one.name for one in arguments if one.default is one.empty and one.kind is one.POSITIONAL_OR_KEYWORD]
        named = [one.name for one in arguments if one.kind in (one.POSITIONAL_OR_KEYWORD, one.KEYWORD_ONLY)]
        yield from ((method, argument) for argument in named if set(required) <= {argument})


def calls_with_several_arguments(thing):
    """Return the name and the required arguments of each function with more than one of them."""
    for name in dir(thing):
        function = getattr(thing, name, None)
        if name[0] == "_" or not (inspect.isfunction(function) or inspect.ismethod(function)):
            continue
        arguments = inspect.signature(function).parameters.values()
        required = [one.name for one in arguments if one.default is one.empty and one.kind is one.POSITIONAL_OR_KEYWORD]
        if len(required) > 1:
            yield name, required

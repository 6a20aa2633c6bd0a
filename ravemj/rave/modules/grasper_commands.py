"""Text commands of the module ``Grasper``."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ravemj.core.transforms import Floats, Ints, pose_of
from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.manipulation.grasping.hulls import hull
from ravemj.rave.modules.base_manipulation import Options
from ravemj.rave.modules.commands import Reader, Tokens, flag, read_options, some, text
from ravemj.rave.modules.grasper import Candidates, Found, GraspRequest, GraspSimulation, Sweep
from ravemj.rave.planning.grasper import GraspParameters
from ravemj.rave.planning.planner import PlanningError

_PARAMETERS: Mapping[str, Reader] = {
    "direction": lambda tokens: tokens.numbers(3),
    "roll": Tokens.number,
    "position": lambda tokens: tokens.numbers(3),
    "centeroffset": lambda tokens: tokens.numbers(3),
    "manipulatordirection": lambda tokens: tokens.numbers(3),
    "standoff": Tokens.number,
    "vintersectplane": lambda tokens: tokens.numbers(4),
    "transformrobot": flag,
    "onlycontacttarget": flag,
    "graspingnoise": Tokens.number,
    "coarsestep": Tokens.number,
    "finestep": Tokens.number,
    "translationstepmult": Tokens.number,
}


def _optional_flag(tokens: Tokens) -> bool:
    """Return whether an option is on: followed by 1, or by no flag at all."""
    return flag(tokens) if tokens and tokens.words[0] in {"0", "1"} else True


def _grasp(grasper: GraspSimulation, arguments: str) -> str:
    """Move the hand to a target, close its fingers, and return the contacts."""
    avoided: list[str] = []
    manip = grasper.robot.GetActiveManipulator()
    gripper, active = manip.GetGripperDOF() if manip else 0, len(grasper.robot.GetActiveDOFIndices())
    readers: dict[str, Reader] = {
        **_PARAMETERS,
        **_TARGET,
        **dict.fromkeys(("stablecontacts", "forceclosure", "tightgrasp", "execute"), flag),
        **dict.fromkeys(("outputfinal", "getlinkcollisions", "avoidcontact", "notrans"), _optional_flag),
        **dict.fromkeys(("collision", "writetraj"), text),
        "avoidlink": lambda tokens: avoided.append(tokens.next()),
        "friction": Tokens.number,
        "chuckingdirection": lambda tokens: tokens.numbers(gripper),
        "ordereddofindices": lambda tokens: [tokens.integer() for _ in range(active)],
    }
    options = read_options(arguments, readers)
    request = GraspRequest(
        parameters=_parameters(grasper, options, avoided),
        chuckingdirection=options.get("chuckingdirection"),
        **some(options, "friction", "forceclosure", "stablecontacts"),
    )
    answer = grasper.grasp(request)
    if "writetraj" in options:
        grasper.trajectory_of(answer.path).SaveToFile(options["writetraj"])
    if options.get("execute", True):
        grasper.execute_grasp(answer)
    reply = _rows(answer.contacts, answer.links if options.get("getlinkcollisions") else None)
    if options.get("outputfinal"):
        reply += _text(pose_of(answer.end.T_world_base).numbers()) + _text(answer.end.values)
    return reply + (f"{answer.mindist!r} {answer.volume!r}" if request.forceclosure else "")


def _grasp_threaded(grasper: GraspSimulation, arguments: str) -> str:
    """Try all combinations of rays, rolls, preshapes, standoffs and directions, and return the accepted grasps."""
    manip = grasper.robot.GetActiveManipulator()
    gripper = manip.GetGripperDOF() if manip else 0
    readers: dict[str, Reader] = {
        **{name: reader for name, reader in _PARAMETERS.items() if name not in {"direction", "position", "roll"}},
        **_TARGET,
        **dict.fromkeys(("numthreads", "startindex", "maxgrasps"), Tokens.integer),
        **dict.fromkeys(("tightgrasp", "checkik"), flag),
        "collision": text,
        "friction": Tokens.number,
        "approachrays": lambda tokens: tokens.rows(6),
        "rolls": Tokens.list,
        "standoffs": Tokens.list,
        "preshapes": lambda tokens: tokens.numbers(tokens.count() * gripper).reshape(-1, gripper),
        "manipulatordirections": lambda tokens: tokens.rows(3),
        "forceclosure": lambda tokens: (flag(tokens), tokens.number()),
        "graspingnoise": lambda tokens: (tokens.number(), tokens.integer()),
    }
    options = read_options(arguments, readers)
    closure, threshold = options.get("forceclosure", (False, 0.0))
    noise, tries = options.pop("graspingnoise", (0.0, 0))
    candidates = candidates_of(grasper, options)
    request = GraspRequest(
        parameters=_parameters(grasper, {**options, "graspingnoise": noise}, []),
        friction=options.get("friction", 0.4),
        forceclosure=closure,
    )
    sweep = Sweep(
        options.get("startindex", 0),
        options.get("maxgrasps", 0),
        threshold if closure else None,
        tries,
        options.get("checkik", False),
    )
    following, grasps = grasper.sweep(candidates, request, sweep, options.get("numthreads", 1))
    return f"{following} {len(grasps)} " + "".join(map(_found_text, grasps))


def candidates_of(grasper: GraspSimulation, options: Options) -> Candidates:
    """Return the grasp candidates of options; missing preshapes and directions are the robot's present ones."""
    manip = grasper.robot.GetActiveManipulator()
    if manip is None:
        raise ArgumentError("GraspThreaded: the robot has no active manipulator")
    directions = options.get("manipulatordirections")
    preshapes = options.get("preshapes")
    return Candidates(
        rays=options.get("approachrays", np.zeros((0, 6))),
        rolls=options.get("rolls", [0.0]),
        preshapes=preshapes if preshapes is not None else manip.GetGripperDOFValues()[None],
        standoffs=options.get("standoffs", [0.0]),
        directions=np.array([manip.description.direction]) if directions is None or not len(directions) else directions,
    )


def _found_text(grasp: Found) -> str:
    parameters, answer = grasp.parameters, grasp.answer
    assert parameters.manipulatordirection is not None, "candidates have one"
    rows = [parameters.position, parameters.direction, [parameters.roll, parameters.standoff]]
    rows += [parameters.manipulatordirection, [answer.mindist or 0.0, answer.volume or 0.0], grasp.preshape]
    rows += [pose_of(answer.end.T_world_base).numbers(), answer.end.values]
    numbers = _text(np.concatenate([np.asarray(row, dtype=float) for row in rows]))
    return f"{numbers}{len(answer.contacts)} {_text(answer.contacts.ravel())}"


def _convex_hull(grasper: GraspSimulation, arguments: str) -> str | None:
    """Return planes, faces, triangles and the volume of the convex hull of points."""
    del grasper
    wanted = ("returnplanes", "returnfaces", "returntriangles", "returnvolume")
    readers: dict[str, Reader] = dict.fromkeys(wanted, flag)
    options = read_options(arguments, {**readers, "points": _points})
    points = options.get("points", np.zeros((0, 3)))
    planes, faces, triangles = (options.get(name, True) for name in wanted[:3])
    convex_hull = hull(points) if len(points) else None
    if convex_hull is None or (triangles and points.shape[1] != 3):
        return None
    reply = f"{len(convex_hull.planes)} {_text(convex_hull.planes.ravel())}" if planes else ""
    if faces:
        reply += f"{len(convex_hull.faces)} " + "".join(f"{len(face)} {_integers(face)}" for face in convex_hull.faces)
    if triangles:
        reply += f"{len(convex_hull.triangles)} {_integers(convex_hull.triangles.ravel().tolist())}"
    return reply + (repr(convex_hull.volume) if options.get("returnvolume") else "")


def _points(tokens: Tokens) -> Floats:
    count, dim = tokens.count(), tokens.count()
    return tokens.numbers(count * dim).reshape(count, dim)


def _get_stable_contacts(grasper: GraspSimulation, arguments: str) -> str:
    """Return the contacts that closing fingers press against other bodies."""
    readers: dict[str, Reader] = {"direction": lambda tokens: tokens.numbers(3), "friction": Tokens.number}
    options = read_options(arguments, {**readers, "getlinkcollisions": _optional_flag})
    if not options.get("friction", 0.0) > 0:
        raise PlanningError("GetStableContacts: friction should be more than 0")
    contacts, links = grasper.stable_contacts(options.get("direction", np.zeros(3)), options["friction"])
    return _rows(contacts, links if options.get("getlinkcollisions") else None)


def _compute_distance_map(grasper: GraspSimulation, arguments: str) -> str:
    """Raise an error: random distance maps are not supported, since no script uses them."""
    del grasper, arguments
    raise UnsupportedError(
        "Grasper.ComputeDistanceMap", "random maps of distances; cast rays with env.CheckCollisionRays"
    )


GRASPER_COMMANDS: Mapping[str, Callable[[GraspSimulation, str], str | None]] = {
    "Grasp": _grasp,
    "GraspThreaded": _grasp_threaded,
    "ConvexHull": _convex_hull,
    "GetStableContacts": _get_stable_contacts,
    "ComputeDistanceMap": _compute_distance_map,
}
"""The commands of ``Grasper``."""

_TARGET: Mapping[str, Reader] = {"target": text, "body": text, "bodyid": Tokens.integer}


def _parameters(grasper: GraspSimulation, options: Options, avoided: list[str]) -> GraspParameters:
    given = some(options, *_PARAMETERS, "avoidcontact", "ordereddofindices")
    if "centeroffset" in given:
        given["position"] = given.pop("centeroffset")
    if options.get("notrans"):
        given["transformrobot"] = False
    links = {link.GetName(): link.GetIndex() for link in grasper.robot.GetLinks()}
    unknown = [name for name in avoided if name not in links]
    if unknown:
        raise ArgumentError(f"avoidlink: robot '{grasper.robot.GetName()}' has no link '{unknown[0]}'")
    name = options.get("target", options.get("body"))
    target = None if name is None else grasper.env.GetKinBody(name)
    if "bodyid" in options:
        name, target = str(options["bodyid"]), grasper.env.GetBodyFromEnvironmentBodyIndex(options["bodyid"])
    if name is not None and target is None:
        raise PlanningError(f"there is no body '{name}'")
    return GraspParameters(**given, target=target, avoidlinks=tuple(links[name] for name in avoided))


def _rows(contacts: Floats, links: Ints | None) -> str:
    """Return a line for each contact, with the index of its link if given."""
    ends = ["" for _ in contacts] if links is None else [str(link) for link in links.tolist()]
    return "".join(f"{_text(row)}{end}\n" for row, end in zip(contacts, ends, strict=True))


def _text(numbers: Floats) -> str:
    return "".join(f"{number!r} " for number in numbers.tolist())


def _integers(numbers: Sequence[int]) -> str:
    return "".join(f"{number} " for number in numbers)

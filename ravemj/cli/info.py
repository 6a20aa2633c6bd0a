"""The command ``info``."""

import argparse
import json
from collections import Counter
from collections.abc import Iterator, Sequence

from ravemj.cli.console import console, table
from ravemj.cli.models import load_model, named_robot
from ravemj.cli.summary import dof_starts, sensor_summary, summarize
from ravemj.model.scene import AttachedSensor, Intrinsics, Joint, KinBody, Link, Manipulator


def info(options: argparse.Namespace) -> int:
    """Show the parts of the bodies of a model."""
    env = load_model(options)
    robot = named_robot(env, options.robot)
    bodies = [body.simulation_state.scene for body in (env.GetBodies() if robot is None else [robot])]
    loose = [sensor for sensor in env.GetSensors() if sensor.attached is None and robot is None]
    sensors = [sensor.description for sensor in loose]
    if options.json:
        content = {"bodies": list(map(summarize, bodies)), "sensors": list(map(sensor_summary, sensors))}
        print(json.dumps({"gravity": env.simulation.gravity, **content}, indent=1))
        return 0
    if not bodies:
        print("the model has no bodies")
    out = console()
    for index, body in enumerate(bodies):
        print("\n" * (index > 0) + _headline(body) + "\n")
        print("\n".join(_KinematicTree(body, out.width).lines()), flush=True)
        for rows in _tables(body):
            out.print()
            out.print(rows)
    if sensors:
        out.print()
        out.print(_loose_sensors(sensors))
    return 0


def _headline(body: KinBody) -> str:
    kind = "robot" if body.is_robot else "body"
    links, dof = len(body.links), len(body.dof_axes)
    mass = sum(link.inertial.mass for link in body.links)
    return f"{kind} {body.name}: {links} link{'s' * (links != 1)}, {dof} DOF{'s' * (dof != 1)}, {mass:.6g} kg"


class _KinematicTree:
    """Text of a body's kinematic tree: each link below its parent, with the joint between them."""

    def __init__(self, body: KinBody, width: int) -> None:
        self._body = body
        self._width = width
        self._first_dofs = [*dof_starts(body), *(None for _ in body.passive_joints)]
        self._joints = body.all_joints
        self._placing = {joint.child: index for index, joint in enumerate(self._joints) if joint.places_child}
        self._children: dict[int, list[int]] = {}
        for child, number in self._placing.items():
            self._children.setdefault(self._joints[number].parent, []).append(child)

    def lines(self) -> Iterator[str]:
        roots = [index for index in range(len(self._body.links)) if index not in self._placing]
        pending = [(root, "", "") for root in reversed(roots)]
        while pending:
            link, first, rest = pending.pop()
            children = self._children.get(link, [])
            yield from self._entry(link, first, rest + ("│ " if children else "  "))
            branches = [(child, f"{rest}├╴", f"{rest}│ ") for child in sorted(children)]
            if branches:
                branches[-1] = (branches[-1][0], f"{rest}└╴", f"{rest}  ")
            pending += reversed(branches)
        for joint in self._joints:
            if not joint.places_child:
                yield f"{joint.name} closes a loop between {' and '.join(_ends(self._body, joint))}"

    def _entry(self, index: int, first: str, rest: str) -> Iterator[str]:
        """Yield a link and its joint in one or two lines, which start with the tree lines ``first`` and ``rest``."""
        link = self._body.links[index]
        name = f"{first}{link.name}  {_number(link.inertial.mass)} kg{', static' if link.static else ''}"
        number = self._placing.get(index)
        if number is None:
            yield name
            return
        joint = f"← {self._joint(number)}"
        if len(name) + len(joint) + 2 <= self._width:
            yield f"{name}  {joint}"
        else:
            yield name
            yield f"{rest}{joint}"

    def _joint(self, index: int) -> str:
        joint, dof = self._joints[index], self._first_dofs[index]
        parts = [joint.kind]
        if dof is not None:
            last = dof + len(joint.axes) - 1
            parts.append(f"DOF {dof}" if last == dof else f"DOFs {dof} to {last}")
        if joint.mimic is not None:
            parts.append(f"follows {joint.mimic.position or 'nothing'}")
        elif joint.static:
            parts.append("fixed")
        else:
            parts.extend(_limits(joint, place) for place in range(len(joint.axes)))
        return f"{joint.name}: {', '.join(parts)}"


def _tables(body: KinBody) -> Iterator[object]:
    yield _links(body.links)
    if body.joints:
        yield _dofs(body)
    if body.passive_joints:
        yield _passive_joints(body)
    if body.manipulators:
        yield _manipulators(body.links, body.manipulators)
    if body.configurations:
        yield _configurations(body)
    if body.sensors:
        yield _sensors(body.links, body.sensors)


def _links(links: Sequence[Link]) -> object:
    rows = table("Links", "#>", "link", "mass [kg]>", "centre of mass [m]", "shapes")
    for index, link in enumerate(links):
        shapes = Counter(type(geometry.shape).__name__.lower() for geometry in link.geometries)
        named = ", ".join(name if count == 1 else f"{count} {name}" for name, count in shapes.items())
        com = " ".join(map(_number, link.inertial.com))
        rows.add_row(str(index), link.name, f"{link.inertial.mass:.6g}", com, named)
    return rows


def _dofs(body: KinBody) -> object:
    rows = table("DOFs", "DOF>", "joint", "limits", "value>", "velocity>", "accel.>", "torque>", "weight>")
    rows.caption = "velocity, acceleration and torque are limits; SI units"
    rows.caption_justify = "left"
    for joint, first in zip(body.joints, dof_starts(body), strict=True):
        for dof, axis in enumerate(joint.axes, first):
            numbers = (axis.value, axis.max_velocity, axis.max_acceleration, axis.max_torque, axis.weight)
            limits = "fixed" if joint.static else _limits(joint, dof - first)
            rows.add_row(str(dof), joint.name, limits, *map(_number, numbers))
    return rows


def _passive_joints(body: KinBody) -> object:
    rows = table("Passive joints", "joint", "type", "parent", "child", "value>", "follows")
    for joint in body.passive_joints:
        follows = "fixed" if joint.static else "" if joint.mimic is None else joint.mimic.position
        rows.add_row(joint.name, joint.kind, *_ends(body, joint), _number(joint.axes[0].value), follows)
    return rows


def _manipulators(links: Sequence[Link], manipulators: Sequence[Manipulator]) -> object:
    rows = table("Manipulators", "manipulator", "base", "effector", "arm DOFs", "gripper DOFs", "closing")
    for manipulator in manipulators:
        ends = (_link_name(links, index) for index in (manipulator.base, manipulator.effector))
        dofs = (_ranges(manipulator.arm_dofs), _ranges(manipulator.gripper_dofs))
        rows.add_row(manipulator.name, *ends, *dofs, " ".join(map(_number, manipulator.chucking_direction)))
    return rows


def _configurations(body: KinBody) -> object:
    rows = table("Named configurations", "--state", "values [rad, m]")
    for named in body.configurations:
        rows.add_row(named.name, ", ".join(f"{joint} {_number(value)}" for joint, value in named.values))
    return rows


def _sensors(links: Sequence[Link], sensors: Sequence[AttachedSensor]) -> object:
    rows = table("Sensors", "sensor", "link", "type", "intrinsics [pixels]")
    for sensor in sensors:
        rows.add_row(sensor.name, _link_name(links, sensor.link), sensor.type or "", _intrinsics(sensor.camera))
    return rows


def _loose_sensors(sensors: Sequence[AttachedSensor]) -> object:
    rows = table("Sensors that no robot carries", "sensor", "position [m]", "type", "intrinsics [pixels]")
    for sensor in sensors:
        position = " ".join(map(_number, sensor.T_link_sensor.position))
        rows.add_row(sensor.name, position, sensor.type or "", _intrinsics(sensor.camera))
    return rows


def _intrinsics(camera: Intrinsics | None) -> str:
    if camera is None:
        return ""
    centre = f"{_number(camera.cx)} {_number(camera.cy)}"
    return f"{camera.width}x{camera.height}, f {_number(camera.fx)} {_number(camera.fy)}, c {centre}"


def _ends(body: KinBody, joint: Joint) -> tuple[str, str]:
    return body.links[joint.parent].name, body.links[joint.child].name


def _link_name(links: Sequence[Link], index: int | None) -> str:
    return "none" if index is None else links[index].name


def _limits(joint: Joint, place: int) -> str:
    axis = joint.axes[place]
    unit = "m" if joint.slides(place) else "rad"
    return "circular" if axis.circular else f"{_number(axis.lower)} to {_number(axis.upper)} {unit}"


def _number(value: float) -> str:
    return f"{value + 0.0:.4g}"


def _ranges(numbers: Sequence[int]) -> str:
    """Format increasing numbers with ranges: 0 1 2 3 7 as ``0-3 7``."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return " ".join(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs)

"""Drawings for the display options: frames, joint axes, inertias, contacts, link names, the floor grid."""

import math
from collections.abc import Callable

import numpy as np

from ravemj.core.transforms import Floats, Ints, rows_from_wxyz
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.gui.interaction.joint_handle import joint_frame
from ravemj.gui.interaction.overlay import Label
from ravemj.model import drawing
from ravemj.model.drawing import Primitives
from ravemj.model.inertia import principal_frame, principal_moments
from ravemj.model.scene import Inertial

_FRAME, _AXIS, _CONTACT = 0.08, 0.12, 0.012
"""Lengths of the axes of frames and joints, and the radius of contacts [radii of the scene]."""

_FORCE, _LONGEST_FORCE = 0.15, 1.0
"""Length of the arrow for a force equal to the mean weight of a link, and maximum length [radii of the scene]."""

_SMALLEST_MASS = 1e-9
"""Minimum mass of links with an inertia ellipsoid [kg]."""

_RGB = np.array([[0.85, 0.15, 0.15, 1.0], [0.1, 0.6, 0.15, 1.0], [0.15, 0.3, 0.9, 1.0]])
_JOINT = np.array([0.95, 0.55, 0.0, 1.0])
_RANGE = np.array([0.95, 0.55, 0.0, 0.25])
_NOW = np.array([0.2, 0.1, 0.0, 1.0])
_MASS = np.array([0.75, 0.1, 0.75, 1.0])
_INERTIA = np.array([0.75, 0.1, 0.75, 0.3])
_CONTACTS = np.array([0.95, 0.1, 0.1, 1.0])
_PUSH = np.array([0.95, 0.75, 0.05, 1.0])
_WIDTH = 2.5
_ARC_STEP = np.radians(6)

_FLOOR_REACH = 2.0
"""Half the side of the floor grid, as a multiple of the scene's radius."""

_STEPS = (0.1, 1.0, 10.0, 100.0, 1000.0)
"""Possible distances between lines of the floor grid [m]."""

_MOST_LINES = 24
"""Maximum number of lines from the middle of the floor grid to a side."""

_BELOW = 1e-3
"""Depth of the grid below z = 0, as a multiple of the scene's radius, so that floors hide it without flicker."""

_LINES, _MARKS = (0.62, 0.62, 0.65, 0.5), (0.45, 0.45, 0.5, 0.9)
_AXIS_WIDTH = 3.0

_Part = Callable[[Simulation, float], list[Primitives]]


def figures(simulation: Simulation, shown: frozenset[str], radius: float) -> list[Primitives]:
    """Return the drawings of the active display options, sized for a scene of a radius [m].

    The options are names of ``shortcuts.DISPLAY``. The caller has locked the simulation.
    """
    return [figure for name, part in _PARTS.items() if name in shown for figure in part(simulation, radius)]


def names(simulation: Simulation) -> tuple[Label, ...]:
    """Return labels with the names of all links, at their centres of mass."""
    return tuple(
        Label(place, link.name)
        for body in simulation.bodies
        for link, place in zip(body.scene.links, _centers(body), strict=True)
    )


def _frames(simulation: Simulation, radius: float) -> list[Primitives]:
    figure = _axes(_FRAME * radius, _WIDTH)
    return [figure.placed(T) for body in simulation.bodies for T in body.link_transforms()]


def _axes(length: float, width: float) -> Primitives:
    """Return the x, y and z axes of a frame, in red, green and blue."""
    ends = np.concatenate([[np.zeros(3), axis] for axis in length * np.eye(3)])
    return drawing.line_list(ends, width, np.repeat(_RGB, 2, axis=0))


def _joints(simulation: Simulation, radius: float) -> list[Primitives]:
    return [
        _joint(body, dof, _AXIS * radius)
        for body in simulation.bodies
        if body.index
        for dof in range(len(body.scene.dof_axes))
    ]


def _joint(body: BodyState, dof: int, length: float) -> Primitives:
    """Return a drawing of a joint axis; for revolute joints, also the sector of the limits and the present value."""
    joint, T_world_axis = joint_frame(body, dof)
    axis, value = body.scene.dof_axes[dof], float(body.kinematics.values()[dof])
    ends = np.array([[0.0, 0.0, -length], [0.0, 0.0, length]])
    parts = [drawing.line_list(ends, _WIDTH, np.tile(_JOINT, (2, 1)))]
    if joint.kind == "slider":
        ends = np.array([[0.0, 0.0, axis.lower - value], [0.0, 0.0, axis.upper - value]])
        if np.isfinite(ends).all() and np.ptp(ends) < 100 * length:
            parts = [drawing.line_list(ends, _WIDTH, np.tile(_JOINT, (2, 1)))]
    elif not axis.circular and axis.upper - axis.lower < 2 * np.pi:
        angles = np.linspace(axis.lower - value, axis.upper - value, int((axis.upper - axis.lower) / _ARC_STEP) + 2)
        rim = 0.6 * length * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
        triangles = np.array([[0, number, number + 1] for number in range(1, len(rim))])
        sector = np.concatenate([np.zeros((1, 3)), rim])
        parts.append(drawing.mesh(sector, triangles, np.tile(_RANGE, (len(sector), 1))))
        now = np.array([[0.0, 0.0, 0.0], [0.6 * length, 0.0, 0.0]])
        parts.append(drawing.line_list(now, _WIDTH, np.tile(_NOW, (2, 1))))
    return drawing.merge(parts).placed(T_world_axis)


def _masses(simulation: Simulation, radius: float) -> list[Primitives]:
    drawings: list[Primitives] = []
    for body in simulation.bodies:
        massive = [link.inertial.mass > _SMALLEST_MASS for link in body.scene.links]
        centers = _centers(body)[massive]
        drawings.append(drawing.spheres(centers, 0.5 * _CONTACT * radius, np.tile(_MASS, (len(centers), 1))))
        if all(link.static for link in body.scene.links):  # a floor's ellipsoid would hide everything on it
            continue
        for link, T_world_link in zip(body.scene.links, body.link_transforms(), strict=True):
            if link.inertial.mass > _SMALLEST_MASS:
                drawings.append(_ellipsoid(link.inertial).placed(T_world_link))
    return drawings


def _ellipsoid(inertial: Inertial) -> Primitives:
    """Return the homogeneous ellipsoid of a link's mass and moments of inertia, in the link frame."""
    moments = principal_moments(inertial)
    squares = 2.5 / inertial.mass * (moments.sum() - 2 * moments)
    half = np.sqrt(np.maximum(squares, 0.0))
    frame = principal_frame(inertial)
    T_link_mass = np.eye(4)
    T_link_mass[:3, :3] = rows_from_wxyz(frame.wxyz)
    T_link_mass[:3, 3] = frame.position
    return drawing.mesh(_SPHERE * half, _FACETS, np.tile(_INERTIA, (len(_SPHERE), 1))).placed(T_link_mass)


def _sphere() -> tuple[Floats, Ints]:
    columns, rows = 16, 9
    turn, height = np.meshgrid(np.linspace(0, 2 * np.pi, columns + 1), np.linspace(-np.pi / 2, np.pi / 2, rows))
    points = np.stack([np.cos(height) * np.cos(turn), np.cos(height) * np.sin(turn), np.sin(height)], axis=-1)
    corner = np.arange((rows - 1) * (columns + 1)).reshape(rows - 1, -1)[:, :-1].reshape(-1)
    above = corner + columns + 1
    lower, upper = np.stack([corner, corner + 1, above], axis=1), np.stack([corner + 1, above + 1, above], axis=1)
    return points.reshape(-1, 3), np.concatenate([lower, upper])


_SPHERE, _FACETS = _sphere()


def _contacts(simulation: Simulation, radius: float) -> list[Primitives]:
    """Return a sphere at the deepest point of each contact between bodies; with physics, the contact forces as well."""
    physics = simulation.physics
    if physics is not None:
        return _forces(*physics.contacts(), physics.mean_weight(), radius)
    from ravemj.engine.collision.patches import patches  # noqa: PLC0415 - slow to import
    from ravemj.engine.collision.world import cross  # noqa: PLC0415

    world = simulation.collisions()
    points: list[Floats] = []
    for number, body in enumerate(simulation.bodies):
        earlier = [world.geoms_of_body(other) for other in simulation.bodies[:number]]
        if earlier:
            pairs = world.make_pairs(*cross(world.geoms_of_body(body), np.concatenate(earlier)))
            points += [contact.position for some in patches(world, [*world.hits(pairs)]) for contact in some]
    return _points(np.array(points).reshape(-1, 3), radius)


def _points(points: Floats, radius: float) -> list[Primitives]:
    return [drawing.spheres(points, _CONTACT * radius, np.tile(_CONTACTS, (len(points), 1)))] if len(points) else []


def _forces(points: Floats, forces: Floats, weight: float, radius: float) -> list[Primitives]:
    """Return spheres at contacts, and arrows of forces, scaled by ``weight`` or, if it is 0, by the largest force."""
    sizes = np.linalg.norm(forces, axis=1)
    unit = weight or float(sizes.max(initial=0.0))
    arrows: list[Primitives] = []
    for point, force, size in zip(points, forces, sizes, strict=True):
        if size > 0:
            length = radius * min(_FORCE * size / unit, _LONGEST_FORCE)
            arrows.append(drawing.arrow(point, point + length / size * force, 0.3 * _CONTACT * radius, _PUSH))
    return [*_points(points, radius), *arrows]


def _centers(body: BodyState) -> Floats:
    """Return the centres of mass of all links in the world [m], shape (links, 3)."""
    T_world_links = body.link_transforms()
    return np.einsum("nij,nj->ni", T_world_links[:, :3, :3], body.inertias.coms) + T_world_links[:, :3, 3]


_PARTS: dict[str, _Part] = {"frames": _frames, "axes": _joints, "masses": _masses, "contacts": _contacts}


# --- the floor


def floor_grid(center: Floats, radius: float) -> Primitives:
    """Return a grid on the floor around a sphere (centre and radius [m]), and the world's axes at the origin."""
    step, reach = _step_and_reach(center, radius)
    places = step * np.arange(-round(reach / step), round(reach / step) + 1)
    ends = np.array([[(place, -reach), (place, reach)] for place in places])
    lines = np.concatenate([ends, ends[:, :, ::-1]]).reshape(-1, 2)
    is_mark = np.isclose(np.remainder(np.abs(places) / step + 0.5, 10), 0.5)
    rgba = np.where(is_mark[:, None], _MARKS, _LINES)
    positions = np.column_stack([lines, np.full(len(lines), -_BELOW * radius)])
    floor = drawing.line_list(positions, 1.0, np.repeat(np.concatenate([rgba, rgba]), 2, axis=0))
    return drawing.merge([floor, _axes(min(max(0.5 * radius, step), reach), _AXIS_WIDTH)])


def floor_labels(center: Floats, radius: float) -> tuple[Label, ...]:
    """Return the labels of the grid: metres along x and y, and the names of the axes."""
    step, reach = _step_and_reach(center, radius)
    apart = max(10 * step, math.ceil(0.25 * reach)) if reach >= 1 else 0.5
    labels = [
        Label(place * axis, f"{place:g} m")
        for axis in np.eye(3)[:2]
        for place in np.arange(apart, reach + 1e-9, apart).tolist()
    ]
    length = min(max(0.5 * radius, step), reach)
    return *labels, *(Label(length * axis, name) for axis, name in zip(np.eye(3), "xyz", strict=True))


def _step_and_reach(center: Floats, radius: float) -> tuple[float, float]:
    """Return the line spacing of the floor grid and half its side, a whole multiple of the spacing [m]."""
    wanted = _FLOOR_REACH * radius + float(np.abs(center[:2]).max())
    step = next((step for step in _STEPS if wanted / step <= _MOST_LINES), _STEPS[-1])
    return step, step * min(max(math.ceil(wanted / step), 1), _MOST_LINES)

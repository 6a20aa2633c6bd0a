"""Models written by ravemj: bodies are restored from texts in ``<custom>``, unless the MJCF was edited.

Each text contains one body in full precision. Each value that is also in the MJCF is compared with the writer's output
for the body: if they differ, the MJCF was edited and takes precedence.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.graphs import Pair, ordered_pair
from ravemj.core.transforms import Pose, rotate
from ravemj.engine.mjcf_reading.joints import FREE
from ravemj.engine.mjcf_reading.numbers import as_written, pose, vector
from ravemj.engine.mjcf_reading.trees import TreeReader
from ravemj.errors import Diagnostics
from ravemj.formats.mjcf.document import joint_axis, joint_position
from ravemj.formats.mjcf.geoms import MjcfGeomWriter
from ravemj.formats.mjcf.inertia import legal_inertial
from ravemj.formats.mjcf.lines import Attribute, XmlLines
from ravemj.formats.mjcf.merging import Merging
from ravemj.formats.mjcf.records import PREFIX, SCENE, UNKNOWN, StoredNames, read_body, read_scene
from ravemj.model.builder import LinkBuilder
from ravemj.model.joints import poses_at
from ravemj.model.mimic import Equations, NamedJoint, resolve
from ravemj.model.scene import UNLIMITED, Axis, Geometry, Inertial, Joint, KinBody, Link, Scene

_NEAR = 1e-9
_COLOUR_NEAR = 1e-6


def own_bodies(
    reader: TreeReader, touching: Sequence[Pair], diagnostics: Diagnostics
) -> list[tuple[KinBody, set[int]]]:
    """Return the bodies in the model's texts, each with MuJoCo's indices of its root bodies.

    ``touching`` are the pairs of MuJoCo bodies that touch at the start: excluding them does not make links adjacent.
    """
    bodies: list[tuple[KinBody, set[int]]] = []
    for text in reader.compiled.spec.texts:
        if not text.name.startswith(PREFIX):
            continue
        source = reader.compiled.document.source(text.name, "text")
        try:
            body, names = read_body(text.data, reader.shapes.mesh_of_name, source)
            own = _OwnBody(reader, body, names, touching)
            own.check_fit()
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            message = f"the text '{text.name}' is left out, and the body is read without it: {error}"
            diagnostics.warn("damaged-text", message, source, "convert the model anew")
            continue
        bodies.append((own.read(), own.roots))
    return bodies


def own_scene(reader: TreeReader, diagnostics: Diagnostics) -> tuple[Scene | None, tuple[Pair, ...]]:
    """Return scene properties and pairs of MuJoCo bodies that touch at the start, from a ``<text>`` of the MJCF."""
    for text in reader.compiled.spec.texts:
        if text.name == SCENE:
            source = reader.compiled.document.source(text.name, "text")
            try:
                content, named = read_scene(text.data, source)
                return content, tuple(ordered_pair(*(reader.number_of(name) for name in pair)) for pair in named)
            except (ValueError, KeyError, TypeError, AttributeError) as error:
                diagnostics.warn("damaged-text", f"the text '{text.name}' is left out: {error}", source)
    return None, ()


def _near(first: ArrayLike, second: ArrayLike, tolerance: float = _NEAR) -> bool:
    numbers, other = np.asarray(first, np.float64), np.asarray(second, np.float64)
    if numbers.shape != other.shape:
        return False
    return bool((np.abs(numbers - other) <= tolerance * max(1.0, float(np.abs(numbers).max(initial=0.0)))).all())


def _same_pose(first: Pose, second: Pose) -> bool:
    return _near(first.matrix(), second.matrix())


class _GeomRecorder(XmlLines):
    """MJCF writer that records the attributes of geoms instead of writing them."""

    def __init__(self) -> None:
        super().__init__()
        self.geoms: list[dict[str, Attribute | None]] = []

    def element(self, tag: str, source: object = None, /, **attributes: Attribute | None) -> None:
        del tag, source
        self.geoms.append(attributes)


class _OwnBody:
    """Body that ravemj stored as text in an MJCF file, to be compared with the MJCF, which users may have edited.

    Attributes:
        roots: MuJoCo's indices of its root bodies.
    """

    def __init__(self, reader: TreeReader, body: KinBody, names: StoredNames, touching: Sequence[Pair]) -> None:
        self._reader, self._model = reader, reader.compiled.model
        self._body, self._names = body, names
        self._touching = set(touching)
        self._bodies = [reader.number_of(name) for name in names.links]
        self._merging = Merging(body, names.joints, merges=False)
        self._placing = self._merging.placing
        self.roots = {number for link, number in enumerate(self._bodies) if link not in self._placing}

    def check_fit(self) -> None:
        """Compare the kinematic tree with the MJCF.

        Raises:
            ValueError: bodies or joints differ.
        """
        model, joints = self._model, self._body.all_joints
        for link, number in enumerate(self._bodies):
            joint = self._placing.get(link)
            parent = 0 if joint is None else self._bodies[joints[joint].parent]
            if int(model.body_parentid[number]) != parent:
                raise ValueError(f"'{self._names.links[link]}' hangs on another body")
            expected = () if joint is None else self._names.joints[joint]
            first, count = int(model.body_jntadr[number]), int(model.body_jntnum[number])
            moving = [joint_id for joint_id in range(first, first + count) if model.jnt_type[joint_id] != FREE]
            if [model.joint(joint_id).name for joint_id in moving] != list(expected):
                raise ValueError(f"'{self._names.links[link]}' has other joints")
        below = {number for number in range(1, model.nbody) if int(model.body_rootid[number]) in self.roots}
        if below != set(self._bodies):
            raise ValueError("there are other bodies")

    def read(self) -> KinBody:
        """Return the body with the user's edits of the MJCF applied."""
        joints = [self._joint(number, joint) for number, joint in enumerate(self._body.all_joints)]
        links = [self._link(index, link) for index, link in enumerate(self._body.links)]
        count = len(self._body.joints)
        body = replace(
            self._body,
            links=tuple(links),
            joints=tuple(joints[:count]),
            passive_joints=tuple(joints[count:]),
            adjacent=self._adjacent(),
        )
        body = _with_expressions(self._with_tools(body))
        moved = any(
            not _same_pose(joint.T_parent_child, other.T_parent_child)
            or not _near([*joint.anchor, *joint.axes[0].direction], [*other.anchor, *other.axes[0].direction])
            for joint, other in zip(self._body.all_joints, joints, strict=True)
        ) or any(
            link.T_world_link is not other.T_world_link for link, other in zip(self._body.links, links, strict=True)
        )
        if moved:
            poses = poses_at(body, [[axis.value for axis in joint.axes] for joint in joints])
            placed = (replace(link, T_world_link=there) for link, there in zip(body.links, poses, strict=True))
            body = replace(body, links=tuple(placed))
        return body

    def _pose(self, link: int) -> Pose:
        """Return the pose of a link in its parent from the MJCF."""
        return self._reader.pose(self._bodies[link])

    def _link(self, index: int, link: Link) -> Link:
        number = self._bodies[index]
        inertial = self._inertial(link, self._reader.inertial(number))
        geometries = self._geometries(index, link)
        source = self._names.origin(index, self._reader.source(number))
        link = replace(link, inertial=inertial, geometries=geometries, source=source)
        if index not in self._placing and not _same_pose(link.T_world_link, self._pose(index)):
            link = replace(link, T_world_link=self._pose(index))
        return link

    def _inertial(self, link: Link, compiled: Inertial) -> Inertial:
        own = link.inertial
        if own is UNKNOWN:
            return compiled
        legal = legal_inertial(own)
        scale = max(float(np.abs(legal.inertia).max()), 1e-12)
        is_same = _near(legal.com, compiled.com) and abs(legal.mass - compiled.mass) <= _NEAR * max(legal.mass, 1e-12)
        return (
            own if is_same and _near(np.array(legal.inertia) / scale, np.array(compiled.inertia) / scale) else compiled
        )

    def _geometries(self, index: int, link: Link) -> tuple[Geometry, ...]:
        """Return a link's shapes: those of ravemj's text if they match the geoms, else shapes made from the geoms."""
        model, number = self._model, self._bodies[index]
        first, count = int(model.body_geomadr[number]), int(model.body_geomnum[number])
        if self._names.decomposed:
            is_same = index < len(self._names.geoms) and count == self._names.geoms[index]
        else:
            out, writer = _GeomRecorder(), MjcfGeomWriter(Diagnostics())
            for geometry in link.geometries:
                writer.write(geometry, out)
            geoms = zip(out.geoms, range(first, first + count), strict=False)
            is_same = len(out.geoms) == count and all(self._is_geom(solid, geom) for solid, geom in geoms)
        if is_same:
            return link.geometries
        built = LinkBuilder(link.name, link.source)
        self._reader.shapes.add(built, number)
        return tuple(built.geometries)

    def _is_geom(self, attributes: dict[str, Attribute | None], geom: int) -> bool:
        """Return whether a geom of the MJCF has the attributes that ravemj would write."""
        shapes, kind = self._reader.shapes, str(attributes["type"])
        if kind != shapes.kind(geom) or attributes.get("mesh") != shapes.mesh_name(geom):
            return False
        size = attributes.get("size", ())
        if isinstance(size, tuple) and not _near(size, self._model.geom_size[geom][: len(size)]):
            return False
        position, wxyz = attributes.get("pos", (0.0, 0.0, 0.0)), attributes.get("quat", (1.0, 0.0, 0.0, 0.0))
        there = shapes.pose_of(geom)
        expected = Pose(vector(_floats(position)), _wxyz(wxyz))
        rgba = self._model.geom_rgba[geom]
        return _same_pose(expected, there) and _near(_floats(attributes["rgba"]), rgba, _COLOUR_NEAR)

    def _joint(self, number: int, joint: Joint) -> Joint:
        """Return a joint with the user's edits applied; unchanged if it carries no link in the kinematic tree."""
        if not joint.places_child or self._placing.get(joint.child) != number:
            return joint
        T_parent_child, names = self._pose(joint.child), self._names.joints[number]
        if not names:
            is_same = _same_pose(self._merging.pose_in_parent(joint.child), T_parent_child)
            return joint if is_same else replace(joint, T_parent_child=T_parent_child, anchor=T_parent_child.position)
        position, axes = joint_position(joint), [joint_axis(joint, index) for index in range(len(joint.axes))]
        if not _same_pose(joint.T_parent_child, T_parent_child):
            moved = T_parent_child @ joint.T_parent_child.inverse()
            turned = (replace(axis, direction=rotate(moved.wxyz, axis.direction)) for axis in joint.axes)
            anchor = T_parent_child.apply(position)
            joint = replace(joint, T_parent_child=T_parent_child, anchor=anchor, axes=tuple(turned))
        first = self._model.joint(names[0]).id
        written = vector(self._reader.written_joint(first).pos)
        if not _near(position, written):
            joint = replace(joint, anchor=joint.T_parent_child.apply(written))
        if joint.is_ball:
            return joint
        changed = [self._axis(joint, index, axes[index], name) for index, name in enumerate(names)]
        return replace(joint, axes=(*changed, *joint.axes[len(changed) :]))

    def _axis(self, joint: Joint, index: int, direction: tuple[float, ...], name: str) -> Axis:
        model, axis = self._model, joint.axes[index]
        number = model.joint(name).id
        there = vector(as_written(self._reader.written_joint(number).axis, model.jnt_axis[number]))
        if not _near(np.array(direction) / np.linalg.norm(direction), there):
            axis = replace(axis, direction=rotate(joint.T_parent_child.wxyz, there))
        was_limited = not axis.circular and axis.lower < axis.upper
        lower, upper = model.jnt_range[number].tolist() if model.jnt_limited[number] else (-UNLIMITED, UNLIMITED)
        if was_limited != bool(model.jnt_limited[number]) or (
            was_limited and not _near((axis.lower, axis.upper), (lower, upper))
        ):
            circular = not model.jnt_limited[number] and not joint.slides(index)
            axis = replace(axis, lower=lower, upper=upper, circular=circular)
        reference = float(model.qpos0[model.jnt_qposadr[number]])
        torque = float(np.abs(model.jnt_actfrcrange[number]).max()) if model.jnt_actfrclimited[number] else 0.0
        if not _near(axis.reference, reference):
            axis = replace(axis, reference=reference)
        return axis if _near(axis.max_torque, torque) else replace(axis, max_torque=torque)

    def _adjacent(self) -> tuple[Pair, ...]:
        """Return the adjacent link pairs, updated by ``<exclude>`` elements added and removed in the MJCF."""
        links = {number: link for link, number in enumerate(self._bodies)}
        expected = {ordered_pair(*(self._reader.number_of(name) for name in pair)) for pair in self._names.excludes}
        pairs = {ordered_pair(*divmod(int(signature), 1 << 16)) for signature in self._model.exclude_signature}
        inside = {pair for pair in pairs if pair[0] in links and pair[1] in links}
        added = sorted(ordered_pair(*(links[link] for link in pair)) for pair in inside - expected - self._touching)
        lost = {ordered_pair(*(links[link] for link in pair)) for pair in expected - inside}
        return (*(pair for pair in self._body.adjacent if ordered_pair(*pair) not in lost), *added)

    def _with_tools(self, body: KinBody) -> KinBody:
        """Return a body whose tools are at their sites in the MJCF."""
        sites = {site.name: site for site in self._reader.compiled.spec.sites}
        arms = list(body.manipulators)
        for index, arm in enumerate(arms):
            site = sites.get(arm.name)
            if site is None or arm.effector is None:
                continue
            model, number = self._model, site.id
            there = pose((site.pos, site.quat), (model.site_pos[number], model.site_quat[number]))
            is_on = int(model.site_bodyid[number]) == self._bodies[arm.effector]
            if is_on and not _same_pose(arm.T_effector_tool, there):
                arms[index] = replace(arm, T_effector_tool=there)
        return replace(body, manipulators=tuple(arms))


def _floats(value: Attribute | None) -> tuple[float, ...]:
    return value if isinstance(value, tuple) else ()


def _wxyz(value: Attribute | None) -> tuple[float, float, float, float]:
    w, x, y, z = _floats(value)
    return w, x, y, z


def _with_expressions(body: KinBody) -> KinBody:
    """Return a body with the expressions of its mimic joints restored."""
    active = len(body.joints)
    if all(joint.mimic is None for joint in body.all_joints):
        return body
    named = [
        NamedJoint(
            joint.name,
            len(joint.axes) if index < active else 0,
            None if joint.mimic is None else Equations(*_texts(joint)),
            joint.source,
        )
        for index, joint in enumerate(body.all_joints)
    ]
    mimics = resolve(named, Diagnostics())
    joints = [replace(joint, mimic=mimics.get(index)) for index, joint in enumerate(body.all_joints)]
    return replace(body, joints=tuple(joints[:active]), passive_joints=tuple(joints[active:]))


def _texts(joint: Joint) -> tuple[str, str, str]:
    mimic = joint.mimic
    return ("", "", "") if mimic is None else (mimic.position, mimic.velocity, mimic.acceleration)

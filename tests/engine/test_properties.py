"""What holds for every model: the same meaning in every spelling, and the motion that OpenRAVE's format describes."""

import dataclasses
import math
import warnings

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given
from strategies import (
    WELD,
    BodyModel,
    GeomModel,
    JointModel,
    LinkModel,
    Move,
    RandomChoices,
    ScopeModel,
    Spelling,
    Taste,
    Transform,
    body_node,
    choices,
    document,
    draw_geom,
    examples,
    number,
    rotation_matrix,
    scene_node,
    scenes,
    split,
    xml,
)

import ravemj
from ravemj.core.transforms import Pose
from ravemj.formats.openrave_xml import Reading, read
from ravemj.model.expressions import Expression
from ravemj.model.scene import Mesh


@pytest.fixture
def write(tmp_path):
    def write(content: str | bytes, name: str = "model.xml") -> str:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return str(path)

    return write


def load(scene) -> list[ravemj.KinBody]:
    """Return the bodies of a scene. Warnings are not what is tested here."""
    env = ravemj.Environment()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        assert env.LoadData(xml(scene_node(scene)))
        env.simulation.compiled()  # which warns as well
    return env.GetBodies()


def content(value):
    """Return a scene or a part of it as plain nested values, without the places in files."""
    if isinstance(value, Pose):
        return value.matrix().ravel().tolist()
    if isinstance(value, Mesh):
        return value.vertices.ravel().tolist(), value.triangles.ravel().tolist()
    if isinstance(value, Expression):
        return str(value)
    if dataclasses.is_dataclass(value):
        names = [field.name for field in dataclasses.fields(value) if field.name != "source"]
        return type(value).__name__, [(name, content(getattr(value, name))) for name in names]
    if isinstance(value, tuple | list):
        return [content(part) for part in value]
    return value


def assert_same(first, second, tolerance=0.0):
    if isinstance(first, list | tuple):
        assert len(first) == len(second), (first, second)
        for one, other in zip(first, second, strict=True):
            assert_same(one, other, tolerance)
    elif isinstance(first, float):
        close = math.isclose(first, second, rel_tol=tolerance, abs_tol=tolerance)
        assert close or (math.isnan(first) and math.isnan(second)), (first, second)
    else:
        assert first == second


def read_well(path: str) -> Reading:
    reading = read(path)
    assert reading.failure is None
    assert [finding for finding in reading.diagnostics if finding.severity == "error"] == []
    return reading


class TestSpelling:
    @examples(150)
    @given(scenes(), choices())
    def test_looks_mean_nothing(self, write, scene, choices):
        node = scene_node(scene)
        plain = read_well(write(xml(node)))
        other = read_well(write(document(node, choices), "disguised.xml"))
        assert_same(content(plain.scene), content(other.scene))

    @examples(100)
    @given(scenes(), choices())
    def test_parts_may_stand_in_files_of_their_own(self, write, scene, choices):
        node = scene_node(scene)
        plain = read_well(write(xml(node)))
        files = split(node, choices)
        paths = [write(text, f"split/{name}") for name, text in files.items()]
        other = read_well(paths[0])
        assert_same(content(plain.scene), content(other.scene))
        codes = [[finding.code for finding in reading.diagnostics] for reading in (plain, other)]
        assert codes[0] == codes[1]

    @examples(100)
    @given(scenes())
    def test_rotations_and_units(self, write, scene):
        """Rounding differs, and no more.

        A link that was moved against another after their joint may show a half turn, of which rounding decides the
        sign, so there is none here.
        """
        assume(all(Kinematics(body).settled for body in scene.bodies))
        spellings = [Spelling("axis"), Spelling("matrix"), Spelling("quaternion", degrees=True)]
        first, *others = [read_well(write(xml(scene_node(scene, spelling)))) for spelling in spellings]
        for other in others:
            assert_same(content(first.scene), content(other.scene), 1e-9)

    @examples(50)
    @given(scenes(), choices())
    def test_parts_know_the_line_that_they_stand_on(self, write, scene, choices):
        files = {write(text, f"lines/{name}"): text for name, text in split(scene_node(scene), choices, 30).items()}
        lines = {path: text.split("\n") for path, text in files.items()}
        for body in read_well(next(iter(files))).scene.bodies:
            geometries = [geometry for link in body.links for geometry in link.geometries]
            parts = [(f"<{'Robot' if body.is_robot else 'KinBody'}", body)]
            parts += [("<Body", link) for link in body.links] + [("<Geom", geometry) for geometry in geometries]
            parts += [("<Joint", joint) for joint in (*body.joints, *body.passive_joints)]
            parts += [("<Manipulator", arm) for arm in body.manipulators]
            parts += [("<AttachedSensor", sensor) for sensor in body.sensors]
            for tag, part in parts:
                assert tag in lines[part.source.file.replace("/./", "/")][part.source.line - 1]


class TestModel:
    @examples(100)
    @given(scenes(Taste(bodies=4)))
    def test_every_scene_compiles(self, scene):
        bodies = load(scene)
        simulation = bodies[0].GetEnv().simulation
        compiled = simulation.compiled()
        model = compiled.model
        links = [name for names in compiled.mjcf.names for name in names.links]
        joints = [name for names in compiled.mjcf.names for joint in names.joints for name in joint]
        assert sorted(links) == sorted(model.body(index).name for index in range(1, model.nbody))
        assert sorted(joints) == sorted(model.joint(index).name for index in range(model.njnt))
        assert len(set(links)) == len(links) == sum(len(body.links) for body in scene.bodies)
        assert len(compiled.mjcf.sources) == compiled.mjcf.text.count("\n")

    @examples(60)
    @given(choices())
    def test_masses_are_those_of_mujoco(self, write, choices):
        """``mimicgeom`` with a density is what MuJoCo computes from geoms of that density."""
        geoms = [geom for geom in (draw_geom(choices) for _ in range(8)) if geom.kind in {"box", "sphere", "cylinder"}]
        assume(geoms)
        density = float(np.float32(number(choices, 1, 5000)))
        mass = "<Mass type='mimicgeom'><density>%r</density></Mass>" % density  # noqa: UP031
        text = "".join(xml(node) for node in _geom_nodes(geoms))
        reading = read_well(write(f"<KinBody name='b'><Body name='a'>{text}{mass}</Body></KinBody>"))
        inertial = reading.scene.bodies[0].links[0].inertial
        parts = "".join(_mujoco_geom(geom, density) for geom in geoms)
        model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody><body>{parts}</body></worldbody></mujoco>")
        turned = np.zeros(9)
        mujoco.mju_quat2Mat(turned, model.body_iquat[1])
        turned = turned.reshape(3, 3)
        assert inertial.mass == pytest.approx(model.body_mass[1], rel=1e-9)
        np.testing.assert_allclose(inertial.com, model.body_ipos[1], atol=1e-9)
        expected = turned @ np.diag(model.body_inertia[1]) @ turned.T
        np.testing.assert_allclose(inertial.inertia, expected, rtol=1e-7, atol=1e-7 * np.abs(expected).max())


def _geom_nodes(geoms: list[GeomModel]):
    scope = ScopeModel(False, (), (LinkModel("a", (), geoms=tuple(geoms)),))
    return body_node(BodyModel("b", scope)).children[0].children


def _mujoco_geom(geom: GeomModel, density: float) -> str:
    pose = pose_of(geom.transform, np.ones(3))
    numbers = geom.numbers
    if geom.kind == "box":
        (tag, size), *_ = numbers.items()
        size = np.array(size) / (2 if tag == "fullextents" else 1)
    elif geom.kind == "sphere":
        size = np.array(numbers["radius"])
    else:
        size = np.array([*numbers["radius"], numbers["height"][0] / 2])
        pose[:3, :3] = pose[:3, :3] @ rotation_matrix((1, 0, 0), 90)  # along y
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, pose[:3, :3].ravel())
    values = {"size": size, "pos": pose[:3, 3], "quat": quat}
    text = " ".join(f'{name}="{" ".join(map(repr, value.tolist()))}"' for name, value in values.items())
    return f'<geom type="{geom.kind}" density="{density!r}" {text}/>'


# ---------------------------------------------------------------------------------------------------- kinematics


def pose_of(transform: Transform, scale: np.ndarray) -> np.ndarray:
    """Translations add up and are never turned; rotations multiply from the left."""
    pose = np.eye(4)
    for step in transform:
        if isinstance(step, Move):
            pose[:3, 3] += scale * step.vector
        else:
            pose[:3, :3] = rotation_matrix(step.axis, step.degrees) @ pose[:3, :3]
    return pose


def shift(vector: np.ndarray) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, 3] = vector
    return pose


def turn(axis: np.ndarray, angle: float) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, :3] = rotation_matrix(axis, np.degrees(angle))
    return pose


@dataclasses.dataclass
class Attached:
    """A joint between the poses that its links had at its end tag."""

    model: JointModel
    first: int
    second: int
    T_first_second: np.ndarray
    T_first_frame: np.ndarray

    def swapped(self) -> "Attached":
        """Return the joint as OpenRAVE has it where the second link is nearer to link 0: its axes point back.

        So the links of a joint with one axis move as if it were not swapped, others do not: a rotation vector is in
        the axes of the nearer link, and the first of two axes is fixed to it.
        """
        inverse = np.linalg.inv(self.T_first_second)
        axes = [np.array(axis) for axis in self.model.axes]
        if not axes:  # the z axis of the listed first link
            axes = [self.T_first_frame[:3, :3].T @ [0, 0, 1]]
        model = dataclasses.replace(self.model, axes=tuple(-axis for axis in axes))
        return Attached(model, self.second, self.first, inverse, inverse @ self.T_first_frame)

    def motion(self, values: np.ndarray) -> np.ndarray:
        """Return the pose of the second link in the first one."""
        model, frame = self.model, self.T_first_frame
        axes = [frame[:3, :3] @ axis for axis in model.axes] or [np.array([0, 0, 1.0])]
        if model.kind == "slider":
            return shift(axes[0] / np.linalg.norm(axes[0]) * (values[0] - model.initial)) @ self.T_first_second
        if model.kind == "spherical":
            turned = turn(values, np.linalg.norm(values))
        else:
            turned = np.linalg.multi_dot(
                [np.eye(4), np.eye(4), *(turn(a, q - model.initial) for a, q in zip(axes, values, strict=True))]
            )
        anchor = (frame @ [*(model.anchor or (0, 0, 0)), 1])[:3]
        return shift(anchor) @ turned @ shift(-anchor) @ self.T_first_second

    @property
    def limits(self) -> np.ndarray:
        default = {"hinge": np.pi, "hinge2": np.pi, "slider": 10.0, "spherical": 100.0}[self.model.kind]
        if self.model.circular:
            return np.array([[-10000.0, 10000.0]])
        return np.array(self.model.limits or [(-default, default)] * len(WELD[self.model.kind]))


class Kinematics:
    """The meaning of a body by the rules of the format, as plain products of matrices."""

    def __init__(self, body: BodyModel) -> None:
        self.names: list[str] = []
        self.poses: list[np.ndarray] = []
        self.static: list[bool] = []
        self.joints: list[Attached] = []
        self._enter(body.scope, np.ones(3))
        self.active = [joint for joint in self.joints if joint.model.active]

    def _enter(self, scope: ScopeModel, scale: np.ndarray) -> None:
        scale = scale * (scope.scale or 1.0)
        before = len(self.poses)
        for item in scope.items:
            if isinstance(item, ScopeModel):
                self._enter(item, scale)
            elif isinstance(item, LinkModel):
                self.poses.append(self._frame(item.offset_from) @ pose_of(item.transform, scale))
                self.names.append(item.name)
                self.static.append(item.static)
            else:
                first, second = self.names.index(item.first), self.names.index(item.second)
                if not item.axes and first and self.static[second] and not self.static[first]:
                    first, second = second, first  # at once, so the axis that nobody gave is z of the other link
                inverse = np.linalg.inv(self.poses[first])
                frame = inverse @ self._frame(item.offset_from)
                self.joints.append(Attached(item, first, second, inverse @ self.poses[second], frame))
        whole = pose_of(scope.transform, scale)
        self.poses[before:] = [whole @ pose for pose in self.poses[before:]]

    def _frame(self, name: str) -> np.ndarray:
        return self.poses[self.names.index(name)] if name else np.eye(4)

    @property
    def settled(self) -> bool:
        """Whether no link was moved against another after their joint."""
        ends = (np.linalg.inv(self.poses[joint.first]) @ self.poses[joint.second] for joint in self.joints)
        return all(np.allclose(end, joint.T_first_second) for end, joint in zip(ends, self.joints, strict=True))

    def rest(self, joint: Attached) -> np.ndarray:
        """Return the values of a joint that nobody sets."""
        if joint.model.limits == WELD[joint.model.kind]:
            return np.zeros(len(joint.limits))
        return np.clip(np.full(len(joint.limits), joint.model.initial), *joint.limits.T)

    def values(self, dof_values: np.ndarray) -> dict[str, np.ndarray]:
        """Return the values of all joints by name."""
        values: dict[str, np.ndarray] = {}
        for joint in self.active:
            count = len(joint.limits)
            values[joint.model.name], dof_values = dof_values[:count], dof_values[count:]
        values |= {j.model.name: self.rest(j) for j in self.joints if not j.model.active and j.model.mimic is None}
        while len(values) < len(self.joints):
            for joint in self.joints:
                mimic = joint.model.mimic
                if mimic is not None and all(name in values for _, name, _ in mimic.terms):
                    value = mimic.value({name: values[name][0] for _, name, _ in mimic.terms})
                    values[joint.model.name] = np.clip([value], *joint.limits.T)
        return values

    def place(self, dof_values: np.ndarray) -> np.ndarray:
        """Return the poses of all links: from link 0 outwards over the joints."""
        placed = {0: self.poses[0]}
        values = self.values(dof_values) if self.active else {}
        for _ in self.joints if self.active else ():
            for joint in self.joints:
                reaches = joint if joint.first in placed else joint.swapped()
                if reaches.first in placed and reaches.second not in placed:
                    placed[reaches.second] = placed[reaches.first] @ reaches.motion(values[joint.model.name])
        return np.array([placed.get(index, pose) for index, pose in enumerate(self.poses)])


def draw_values(body: ravemj.KinBody, kinematics: Kinematics, choices: RandomChoices, part: float = 1.0) -> np.ndarray:
    """Draw joint values inside the limits, in the given part of them around the middle."""
    values: list[float] = []
    for joint in kinematics.active:
        for lower, upper in np.clip(joint.limits, -10, 10) if joint.model.kind != "spherical" else [(-1.7, 1.7)] * 3:
            middle, half = (lower + upper) / 2, (upper - lower) / 2 * part
            values.append(middle + half * number(choices, -1, 1))
    assert len(values) == body.GetDOF()
    return np.array(values)


def poses_of_others(bodies: list[ravemj.KinBody], body: ravemj.KinBody) -> np.ndarray:
    return np.array([pose for other in bodies if other != body for pose in other.GetLinkTransformations()])


class TestKinematics:
    @examples(150)
    @given(scenes(), choices())
    def test_places_the_links(self, scene, choices):
        for body, model in zip(load(scene), scene.bodies, strict=True):
            kinematics = Kinematics(model)
            if kinematics.settled:
                rest = [value for joint in kinematics.active for value in kinematics.rest(joint)]
                np.testing.assert_allclose(body.GetDOFValues(), rest, atol=1e-9)
            loaded = body.GetDOFValues()
            np.testing.assert_allclose(body.GetLinkTransformations(), kinematics.place(loaded), atol=1e-10)
            for _ in range(2):
                values = draw_values(body, kinematics, choices)
                body.SetDOFValues(values)
                np.testing.assert_allclose(body.GetLinkTransformations(), kinematics.place(values), atol=1e-10)

    @examples(60)
    @given(scenes(), choices())
    def test_set_and_get(self, scene, choices):
        """The values that were set are there, followers follow, and one body does not move another."""
        bodies = load(scene)
        for body, model in zip(bodies, scene.bodies, strict=True):
            kinematics = Kinematics(model)
            before = poses_of_others(bodies, body)
            values = draw_values(body, kinematics, choices)
            body.SetDOFValues(values)
            np.testing.assert_allclose(body.GetDOFValues(), values, rtol=0, atol=1e-12)
            expected = kinematics.values(values)
            for joint in (*body.GetJoints(), *body.GetPassiveJoints()) if kinematics.active else ():
                name = joint.GetName().removeprefix(model.prefix)
                np.testing.assert_allclose(joint.GetValues(), expected[name], rtol=0, atol=1e-9)
            if body.GetDOF():
                dof = choices.integer(0, body.GetDOF() - 1)
                body.SetDOFValues([values[dof] / 2 + body.GetDOFValues()[dof] / 2], [dof])
                np.testing.assert_allclose(body.GetDOFValues(), values, rtol=0, atol=1e-12)
            np.testing.assert_array_equal(poses_of_others(bodies, body), before)


def test_nothing_follows_without_a_dof(write):
    bodies = "<Body name='A'/><Body name='B'/><Body name='C'/>"
    joints = "<Joint name='j' enable='false'><Body>A</Body><Body>B</Body></Joint>"
    joints += "<Joint name='k' mimic_pos='j+1'><Body>A</Body><Body>C</Body></Joint>"
    (body,) = ravemj.load(write(f"<KinBody name='b'>{bodies}{joints}</KinBody>")).GetBodies()
    expected = [link.T_world_link.matrix() for link in body.simulation_state.scene.links]
    np.testing.assert_allclose(body.GetLinkTransformations(), expected, atol=1e-12)


def test_a_first_link_that_hangs_on_another_goes_where_it_is_put(write):
    """Without a DOF, OpenRAVE directs no joint: the first link may be the child of a weld."""
    joint = "<Joint name='j' enable='false'><Body>B</Body><Body>A</Body><limits>0 0</limits></Joint>"
    link = "<Body name='B'><Translation>0 0 1</Translation></Body>"
    (body,) = ravemj.load(write(f"<KinBody name='b'><Body name='A'/>{link}{joint}</KinBody>")).GetBodies()
    goal = ravemj.matrixFromPose([0.5, 0.5, -0.5, 0.5, 1, -2, 3])
    apart = np.linalg.inv(body.GetTransform()) @ body.GetLinks()[1].GetTransform()
    body.SetTransform(goal)
    body.SetDOFValues([])
    np.testing.assert_allclose(body.GetTransform(), goal, atol=1e-12)
    np.testing.assert_allclose(body.GetLinks()[1].GetTransform(), goal @ apart, atol=1e-12)


SMOOTH = Taste(bodies=1, trees=True)
"""Models whose links all move smoothly with the DOFs, where no follower is at a limit."""


def is_determined(body):
    """Return whether the DOFs say how all joints move, without which there is no inverse dynamics."""
    return all(joint.IsStatic() or joint.IsMimic() for joint in body.GetPassiveJoints())


def draw_smooth(body: ravemj.KinBody, kinematics: Kinematics, choices: RandomChoices) -> np.ndarray:
    values = draw_values(body, kinematics, choices, 0.4)
    by_name = kinematics.values(values)
    for joint in kinematics.joints:
        if joint.model.mimic is not None and not joint.model.circular:
            lower, upper = joint.limits[0]
            assume(lower + 0.1 < by_name[joint.model.name][0] < upper - 0.1)
    return values


class TestDerivatives:
    @examples(60)
    @given(scenes(SMOOTH), choices())
    def test_jacobians(self, scene, choices):
        (body,), (model,) = load(scene), scene.bodies
        kinematics = Kinematics(model)
        values = draw_smooth(body, kinematics, choices)
        body.SetDOFValues(values)
        step = 1e-6
        pairs = [(kinematics.place(values + d), kinematics.place(values - d)) for d in np.eye(len(values)) * step]
        now = kinematics.place(values)
        for link, pose in enumerate(now):
            point = pose @ [0.3, -0.2, 0.1, 1]
            moved = [(after[link] - before[link]) @ [0.3, -0.2, 0.1, 1] / (2 * step) for after, before in pairs]
            turned = [spin(before[link], after[link]) / (2 * step) for after, before in pairs]
            translation = body.ComputeJacobianTranslation(link, point[:3])
            rotation = body.ComputeJacobianAxisAngle(link)
            np.testing.assert_allclose(translation, np.reshape(moved, (-1, 4))[:, :3].T, atol=1e-7)
            np.testing.assert_allclose(rotation, np.reshape(turned, (-1, 3)).T, atol=1e-7)

    @examples(60)
    @given(scenes(Taste(bodies=1, links=4, trees=True)), choices())
    def test_inverse_dynamics(self, scene, choices):
        """Virtual work: force times velocity of each centre of mass, and change of spin times turning rate."""
        (body,), (model,) = load(scene), scene.bodies
        kinematics = Kinematics(model)
        values = draw_smooth(body, kinematics, choices)
        rates, growths = (np.array([number(choices, -1, 1) for _ in values]) for _ in range(2))
        body.SetDOFValues(values)
        body.SetDOFVelocities(rates, [0, 0, 0], [0, 0, 0], ravemj.CheckLimitsAction.Nothing)
        assume(is_determined(body))
        torques = body.ComputeInverseDynamics(growths)
        gravity = body.GetEnv().GetPhysicsEngine().GetGravity()
        step, small = 1e-3, 1e-5
        times = step * np.arange(-3, 4)
        path = [kinematics.place(values + rates * t + growths * t * t / 2) for t in times]
        ways = [(kinematics.place(values + d), kinematics.place(values - d)) for d in np.eye(len(values)) * small]
        expected = np.zeros(len(values))
        for index, link in enumerate(body.GetLinks()):
            com = np.array([*link.GetLocalCOM(), 1])
            poses = [poses[index] for poses in path]
            centres = [(pose @ com)[:3] for pose in poses]
            force = link.GetMass() * (np.dot(SECOND, centres) / step**2 - gravity)
            spins = [
                turned @ link.GetLocalInertia() @ turned.T @ spin(before, after) / (2 * step)
                for before, turned, after in zip(poses, [p[:3, :3] for p in poses[1:]], poses[2:], strict=False)
            ]
            moment = np.dot(FIRST, spins) / step
            for dof, (after, before) in enumerate(ways):
                moved = ((after[index] - before[index]) @ com)[:3]
                expected[dof] += (force @ moved + moment @ spin(before[index], after[index])) / (2 * small)
        scale = max(1.0, np.abs(expected).max(initial=0.0))
        np.testing.assert_allclose(torques, expected, rtol=0, atol=1e-5 * scale)


FIRST = np.array([1, -8, 0, 8, -1]) / 12
SECOND = np.array([2, -27, 270, -490, 270, -27, 2]) / 180


def spin(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Return the rotation vector, in world axes, that leads from one pose to another; for small angles."""
    turned = after[:3, :3] @ before[:3, :3].T
    vector = np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]]) / 2
    sine = np.linalg.norm(vector)
    return vector * (np.arcsin(min(sine, 1.0)) / sine if sine > 1e-12 else 1.0)

"""Random trees of links, each written in several ways that mean the same, and in ways that change one thing.

No answers are needed: what means the same must read the same, and a body that is scaled, moved or renamed must change
in just that.
"""

import math
from dataclasses import dataclass, replace
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from strategies import Choices, RandomChoices, chance, choices, examples, number, one_of, vector

from ravemj.core.transforms import Pose, rotate, rows_from_wxyz, scale, wxyz_from_axis_angle
from ravemj.errors import Diagnostics
from ravemj.formats.collada.writer import write as collada_document
from ravemj.formats.openrave_xml import read
from ravemj.formats.readers import read_data
from ravemj.model.comparison import compare
from ravemj.model.scene import Scene


@dataclass(frozen=True)
class Part:
    """A link, and the joint to its parent: anchor and axis in the frame of the link; angles in degrees."""

    parent: int
    position: tuple[float, float, float]
    axis: tuple[float, float, float]
    angle: float
    kind: str
    anchor: tuple[float, float, float]
    direction: tuple[float, float, float]
    limits: tuple[float, float]
    initial: float
    mass: float
    com: tuple[float, float, float]
    extents: tuple[float, float, float]

    @property
    def pose(self) -> Pose:
        """Where it is in its parent."""
        return Pose(self.position, wxyz_from_axis_angle(self.axis, math.radians(self.angle)))


def draw_part(choices: Choices, index: int) -> Part:
    kind = one_of(choices, ["hinge", "slider"])
    lower = number(choices, -170, 0)
    return Part(
        parent=choices.integer(0, index - 1) if index else -1,
        position=vector(choices, 2),
        axis=one_of(choices, [(0.0, 0.0, 1.0), (1.0, -2.0, 0.5)]),
        angle=number(choices, -180, 180),
        kind=kind,
        anchor=vector(choices, 1) if kind == "hinge" else (0.0, 0.0, 0.0),
        direction=one_of(choices, [(0.0, 1.0, 0.0), (0.3, -1.0, 2.0), (-1.0, 0.0, 0.0)]),
        limits=(lower, lower + number(choices, 1, 170)),
        initial=number(choices, -3, 3) if chance(choices, 40) else 0.0,
        mass=number(choices, 0.1, 5),
        com=vector(choices, 1),
        extents=one_of(choices, [(0.1, 0.2, 0.3), (1.0, 0.05, 0.5)]),
    )


def draw_parts(choices: Choices) -> list[Part]:
    return [draw_part(choices, index) for index in range(choices.integer(2, 7))]


def text(values) -> str:
    return " ".join(map(repr, map(float, values)))


def placed(parts: list[Part]) -> list[Pose]:
    """Return the poses of the links in the body."""
    poses: list[Pose] = []
    for part in parts:
        poses.append(poses[part.parent] @ part.pose if poses else part.pose)
    return poses


def content(part: Part) -> str:
    return (
        f'<Geom type="box"><extents>{text(part.extents)}</extents></Geom>'
        f'<Mass type="custom"><total>{part.mass!r}</total><com>{text(part.com)}</com></Mass>'
    )


def absolute(index: int, pose: Pose, part: Part) -> str:
    """Return a Body with a pose of its own, as a quaternion."""
    return (
        f'<Body name="l{index}"><Translation>{text(pose.position)}</Translation><Quat>{text(pose.wxyz)}</Quat>'
        f"{content(part)}</Body>"
    )


def chained(index: int, part: Part) -> str:
    """Return a Body with a pose in its parent, as an axis and an angle."""
    offset = f"<offsetfrom>l{part.parent}</offsetfrom>" if index else ""
    rotation = f"<RotationAxis>{text((*part.axis, part.angle))}</RotationAxis>"
    translation = f"<Translation>{text(part.position)}</Translation>"
    return f'<Body name="l{index}">{content(part)}{rotation}{translation}{offset}</Body>'


def joint(index: int, part: Part, pose: Pose | None) -> str:
    """Return a Joint in the frame of its link, in degrees; with a pose of the link in that of the body, in radians."""
    frame, anchor, direction = f"<offsetfrom>l{index}</offsetfrom>", part.anchor, part.direction
    limits = f"<limitsdeg>{text(part.limits)}</limitsdeg>"
    if pose is not None:
        anchor, direction = pose.apply(anchor), rotate(pose.wxyz, direction)
        frame = ""
        if part.kind == "hinge":
            limits = f"<limits>{text(map(math.radians, part.limits))}</limits>"
    return (
        f'<Joint name="j{index}" type="{part.kind}"><Body>l{part.parent}</Body><Body>l{index}</Body>{frame}'
        f"<anchor>{text(anchor)}</anchor><axis>{text(direction)}</axis>{limits}<initial>{part.initial!r}</initial></Joint>"
    )


def flat(parts: list[Part], *, absolutely: bool) -> str:
    poses = placed(parts)
    if absolutely:
        links = [absolute(index, pose, part) for index, (pose, part) in enumerate(zip(poses, parts, strict=True))]
    else:
        links = [chained(index, part) for index, part in enumerate(parts)]
    # a slider's anchor is that of its frame, so its frame has to be the same
    joints = [
        joint(index, part, poses[index] if absolutely and part.kind == "hinge" else None)
        for index, part in enumerate(parts)
        if index
    ]
    return "".join(links + joints)


def nested(parts: list[Part], moved: Pose, split: int) -> str:
    """Return the links from some place on in a KinBody of their own, which a transform of its own moves."""
    poses = placed(parts)
    inner = [absolute(i, moved.inverse() @ poses[i], parts[i]) for i in range(split, len(parts))]
    links = "".join(absolute(i, poses[i], parts[i]) for i in range(split))
    scope = f"<Translation>{text(moved.position)}</Translation><Quat>{text(moved.wxyz)}</Quat>"
    joints = "".join(joint(index, part, None) for index, part in enumerate(parts) if index)
    return f"{links}<KinBody>{scope}{''.join(inner)}</KinBody>{joints}"


def disguised(choices: Choices, xml: str) -> str:
    """Return elements in other letters, their children in another order, and a comment in the middle of their text."""
    root = ElementTree.fromstring(f"<KinBody>{xml}</KinBody>")
    for element in [*root.iter()][1:]:
        bodies = iter(element.findall("Body"))  # the first and the second of a joint
        mixed = sorted(element, key=lambda _: choices.integer(0, 9))
        element[:] = [next(bodies) if child.tag == "Body" else child for child in mixed]
        head, space, tail = (element.text or "").partition(" ")
        if space:
            comment = ElementTree.Comment("1 2 3")
            element.text, comment.tail = head + space, tail
            element.append(comment)
    letters = one_of(choices, [str.upper, str.lower, str.swapcase])
    for element in root.iter():
        if isinstance(element.tag, str):
            element.tag = letters(element.tag)
            element.attrib = {letters(name): value for name, value in element.attrib.items()}
    return "".join(ElementTree.tostring(child, encoding="unicode") for child in root)


def respelled(choices: Choices, element: ElementTree.Element, *, slides: bool) -> list[ElementTree.Element]:
    """Return elements that mean what one element means; ``slides`` tells whether it is of a slider."""
    words = (element.text or "").split()
    numbers = [] if element.tag in {"Body", "offsetfrom"} else [float(word) for word in words]

    def child(tag: str, *values: float) -> ElementTree.Element:
        made = ElementTree.Element(tag)
        made.text = text(values)
        return made

    if element.tag == "Geom":
        element.tag = one_of(choices, ["Geom", "Geometry"])
    elif element.tag == "extents":
        tag = one_of(choices, ["extents", "halfextents", "fullextents"])
        return [child(tag, *scale(tuple(numbers), 2.0 if tag == "fullextents" else 1.0))]
    elif element.tag == "Translation":
        share = number(choices, -1, 2)
        return [child("Translation", *scale(tuple(numbers), part)) for part in (share, 1 - share)]
    elif element.tag == "limitsdeg" and (slides or chance(choices, 50)):
        return [child(one_of(choices, ["limits", "limitsrad"]), *(numbers if slides else map(math.radians, numbers)))]
    elif element.tag == "RotationAxis":
        *axis, angle = numbers
        turn = wxyz_from_axis_angle(tuple(axis), math.radians(angle))
        matrix = [entry for row in rows_from_wxyz(turn) for entry in row]
        halves = [child("RotationAxis", *scale(tuple(axis), 3.0), angle / 2) for _ in range(2)]
        return one_of(choices, [halves, [child("Quat", *turn)], [child("RotationMat", *matrix)]])
    return [element]


def body(xml: str):
    reading = read_data(xml)
    assert reading.failure is None
    (found,) = reading.scene.bodies
    return found


def structure(found) -> list[object]:
    joints = [(one.name, one.kind, one.parent, one.child, one.places_child, len(one.axes)) for one in found.joints]
    return [*(link.name for link in found.links), *(len(link.geometries) for link in found.links), *joints]


def poses_of(found) -> np.ndarray:
    return np.array([link.T_world_link.matrix() for link in found.links])


def numbers_of(found) -> dict[str, np.ndarray]:
    """Return everything that is no pose of a link in the world."""
    rigid = [(link.inertial.mass, *link.inertial.com, *np.ravel(link.inertial.inertia)) for link in found.links]
    boxes = [part for link in found.links for part in link.geometries]
    shapes = [(*part.shape.half_extents, *part.T_link_geometry.position) for part in boxes]
    axes = [
        (*one.anchor, *axis.direction, axis.reference, axis.value, axis.lower, axis.upper)
        for one in found.joints
        for axis in one.axes
    ]
    return {"rigid": np.array(rigid), "shapes": np.array(shapes), "axes": np.array(axes)}


def assert_same(found, wanted, atol=1e-9) -> None:
    assert structure(found) == structure(wanted)
    np.testing.assert_allclose(poses_of(found), poses_of(wanted), atol=atol)
    assert_numbers(found, numbers_of(wanted), atol)


def assert_numbers(found, wanted: dict[str, np.ndarray], atol=1e-9) -> None:
    numbers = numbers_of(found)
    for name, values in wanted.items():
        np.testing.assert_allclose(numbers[name], values, atol=atol, err_msg=name)


@pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")
class TestWhatMeansTheSame:
    @given(choices())
    @examples(200)
    def test_chains_of_offsets_and_poses_of_their_own(self, choices):
        parts = draw_parts(choices)
        chains, poses = (body(f'<KinBody name="k">{flat(parts, absolutely=way)}</KinBody>') for way in (False, True))
        assert_same(poses, chains)

    @given(choices())
    @examples(200)
    def test_nested_and_flat(self, choices):
        parts = draw_parts(choices)
        moved = draw_part(choices, 0).pose
        xml = nested(parts, moved, choices.integer(1, len(parts) - 1))
        wanted = body(f'<KinBody name="k">{flat(parts, absolutely=True)}</KinBody>')
        assert_same(body(f'<KinBody name="k">{xml}</KinBody>'), wanted)

    @given(choices())
    @examples(200)
    def test_a_robot_of_several_bodies_and_one_body(self, choices):
        parts = draw_parts(choices)
        poses = placed(parts)
        split = choices.integer(1, len(parts) - 1)
        pieces = [absolute(index, pose, part) for index, (pose, part) in enumerate(zip(poses, parts, strict=True))]
        joints = "".join(joint(index, part, None) for index, part in enumerate(parts) if index)
        robot = (
            f'<Robot name="k"><KinBody>{"".join(pieces[:split])}</KinBody>'
            f"<Robot><KinBody>{''.join(pieces[split:])}</KinBody></Robot><KinBody>{joints}</KinBody></Robot>"
        )
        found = body(robot)
        assert found.is_robot
        assert_same(found, body(f'<KinBody name="k">{flat(parts, absolutely=True)}</KinBody>'))

    @given(choices())
    @examples(100)
    def test_openrave_xml_and_collada(self, choices):
        """Both say the same of a robot, with its adjacent links, its arm and a joint that follows another."""
        parts = draw_parts(choices)
        last = len(parts) - 1
        xml = flat(parts, absolutely=chance(choices, 50)) + f"<adjacent>l0 l{last}</adjacent>"
        if last > 1 and {parts[1].kind, parts[last].kind} == {"hinge"}:
            xml = xml.replace(f'name="j{last}"', f'name="j{last}" mimic_pos="0.5*j1+0.1" mimic_vel="|j1 0.5"')
        arm = f'<Manipulator name="m"><base>l0</base><effector>l{last}</effector><Translation>1 2 3</Translation>'
        wanted = read_data(f'<Robot name="k"><KinBody>{xml}</KinBody>{arm}</Manipulator></Robot>')
        found = read_data(collada_document(wanted.scene, Diagnostics()))
        assert (wanted.failure, found.failure) == (None, None)
        assert compare(wanted.scene, found.scene) == []

    @given(choices())
    @examples(120)
    def test_masses_of_shapes_and_their_numbers(self, choices):
        """The mass of a box by its density is the custom mass with the same numbers."""
        parts = draw_parts(choices)
        boxes, custom = (flat(parts, absolutely=True) for _ in range(2))
        for part in parts:
            x, y, z = part.extents
            total = 8 * x * y * z * part.mass
            written = content(part)[content(part).index("<Mass") :]
            boxes = boxes.replace(written, f'<Mass type="mimicgeom"><density>{part.mass!r}</density></Mass>', 1)
            moments = [total / 3 * (a * a + b * b) for a, b in ((y, z), (x, z), (x, y))]
            inertia = text([moments[0], 0, 0, 0, moments[1], 0, 0, 0, moments[2]])
            numbers = f"<total>{total!r}</total><inertia>{inertia}</inertia>"
            custom = custom.replace(written, f'<Mass type="custom">{numbers}</Mass>', 1)
        found, wanted = (body(f'<KinBody name="k">{xml}</KinBody>') for xml in (boxes, custom))
        assert_same(found, wanted, atol=1e-6)  # OpenRAVE reads totals in single precision

    @given(choices())
    @examples(60)
    def test_other_letters_another_order_and_comments(self, choices):
        xml = flat(draw_parts(choices), absolutely=chance(choices, 50))
        plain, found = (body(f'<KinBody name="k">{text}</KinBody>') for text in (xml, disguised(choices, xml)))
        assert_same(found, plain, atol=0)

    @given(choices())
    @examples(60)
    def test_a_mass_of_the_kinbody_and_one_of_each_body(self, choices):
        """The default counts for the Bodies behind it, until another one, and in no other KinBody."""
        parts = draw_parts(choices)
        split = choices.integer(0, len(parts) - 1)
        kinds = [one_of(choices, ["mimicgeom", "sphere", "box"]) for _ in range(2)]
        first, then = (f'<Mass type="{kind}"><density>{number(choices, 1, 9)!r}</density></Mass>' for kind in kinds)
        pieces = [
            absolute(index, pose, part) for index, (pose, part) in enumerate(zip(placed(parts), parts, strict=True))
        ]
        bare = [piece[: piece.index("<Mass")] + "</Body>" for piece in pieces]
        masses = [first] * split + [then] * (len(parts) - split)
        own = [piece.replace("</Body>", f"{mass}</Body>") for piece, mass in zip(bare, masses, strict=True)]
        other = '<KinBody><Mass type="sphere"><density>100</density></Mass></KinBody>'
        default = "".join([other, first, *bare[:split], other, then, *bare[split:]])
        found, wanted = (body(f'<KinBody name="k">{xml}</KinBody>') for xml in (default, "".join(own)))
        assert_same(found, wanted, atol=0)

    @given(choices=choices())
    @examples(60)
    def test_included_and_written_out(self, choices, tmp_path_factory):
        """A file that a KinBody includes, with a prefix, and the same text with the prefix in each name."""
        parts = draw_parts(choices)
        folder = tmp_path_factory.mktemp("parts")
        xml = flat(parts, absolutely=False)
        (folder / "inner.xml").write_text(f"<KinBody>{xml}</KinBody>")
        (folder / "outer.xml").write_text('<Robot name="k"><KinBody file="inner.xml" prefix="p_"/></Robot>')
        named = xml.replace('name="l', 'name="p_l').replace('name="j', 'name="p_j')
        named = named.replace("<Body>l", "<Body>p_l").replace("<offsetfrom>l", "<offsetfrom>p_l")
        (found,) = read(folder / "outer.xml").scene.bodies
        assert_same(found, body(f'<Robot name="k"><KinBody>{named}</KinBody></Robot>'))

    @given(choices())
    @examples(100)
    def test_offsets_from_any_link_above(self, choices):
        """Poses, anchors and axes are relative to any link, which need not be at the joint."""
        parts = draw_parts(choices)
        poses = placed(parts)
        xml = ""
        for index, (part, pose) in enumerate(zip(parts, poses, strict=True)):
            other = choices.integer(0, index - 1) if index else 0
            offset = f"<offsetfrom>l{other}</offsetfrom>" if index else ""
            relative = poses[other].inverse() @ pose if index else pose
            xml += absolute(index, relative, part).replace("</Body>", f"{offset}</Body>")
        for index, part in enumerate(parts[1:], 1):
            other = choices.integer(0, len(parts) - 1) if part.kind == "hinge" else index
            frame = f"<offsetfrom>l{other}</offsetfrom>"
            xml += joint(index, part, poses[other].inverse() @ poses[index]).replace("<anchor>", f"{frame}<anchor>")
        wanted = body(f'<KinBody name="k">{flat(parts, absolutely=True)}</KinBody>')
        assert_same(body(f'<KinBody name="k">{xml}</KinBody>'), wanted)

    @given(choices())
    @examples(100)
    def test_scaled_and_multiplied(self, choices):
        """A factor multiplies translations and centres of mass, through nested elements, and no shapes and anchors."""
        parts = draw_parts(choices)
        inner, outer = (one_of(choices, [0.5, 2.0, 3.0]) for _ in range(2))
        factor = inner * outer
        xml = f'<KinBody scalegeometry="{inner}">{flat(parts, absolutely=False)}</KinBody>'
        larger = [replace(part, position=scale(part.position, factor), com=scale(part.com, factor)) for part in parts]
        wanted = body(f'<KinBody name="k">{flat(larger, absolutely=False)}</KinBody>')
        assert_same(body(f'<KinBody name="k" scalegeometry="{outer} {outer} {outer}">{xml}</KinBody>'), wanted)

    @given(choices())
    @examples(100)
    def test_other_tags_and_units_of_numbers(self, choices):
        root = ElementTree.fromstring(f"<KinBody>{flat(draw_parts(choices), absolutely=False)}</KinBody>")
        plain = "".join(ElementTree.tostring(child, encoding="unicode") for child in root)
        for parent in [*root.iter()]:
            for place, child in reversed([*enumerate(parent)]):
                parent[place : place + 1] = respelled(choices, child, slides=parent.get("type") == "slider")
        other = "".join(ElementTree.tostring(child, encoding="unicode") for child in root)
        found, wanted = (body(f'<KinBody name="k">{xml}</KinBody>') for xml in (other, plain))
        assert_same(found, wanted)

    @given(choices())
    @examples(60)
    def test_joints_that_follow_under_a_prefix(self, choices):
        """The equation of a Robot with a prefix, that with the names spelled out, and the attribute of old files."""
        parts = draw_parts(choices)
        follower = choices.integer(1, len(parts) - 1)
        slope, offset = number(choices, -2, 2), number(choices, -0.1, 0.1)
        xml = flat(parts, absolutely=chance(choices, 50)) + '<Body name="end"/>'
        name = f'name="j{follower}"'
        equations = [
            f'mimic_pos="{slope:.6f}*lead+{offset:.6f}" mimic_vel="|lead {slope!r}"',
            f'mimic_pos="{slope:.6f}*p_lead+{offset:.6f}" mimic_vel="|p_lead {slope!r}"',
            f'mimic="lead {slope!r} {offset!r}"',
        ]
        lead = '<Joint name="lead"><Body>l0</Body><Body>end</Body><axis>0 0 1</axis></Joint>'
        one, spelled, old = (xml.replace(name, f"{name} {equation}") + lead for equation in equations)
        for tag in ('name="', "<Body>", "<offsetfrom>"):
            for first in ("l", "j", "end"):
                spelled = spelled.replace(f"{tag}{first}", f"{tag}p_{first}")
        wanted = body(f'<Robot name="k"><KinBody>{spelled}</KinBody></Robot>')
        for text in (one, old):
            found = body(f'<Robot name="k" prefix="p_"><KinBody>{text}</KinBody></Robot>')
            assert [part.name for part in found.all_joints] == [part.name for part in wanted.all_joints]
            assert_same(found, wanted)
            values = [[axis.value for part in one.passive_joints for axis in part.axes] for one in (found, wanted)]
            np.testing.assert_allclose(*values, atol=1e-5)  # the old attribute has six digits

    @given(choices=choices())
    @examples(60)
    def test_environments_and_their_units(self, choices, tmp_path_factory):
        """Environments may nest and include one another, and a unit scales nothing."""
        folder = tmp_path_factory.mktemp("parts")
        xml = f'<KinBody name="k">{flat(draw_parts(choices), absolutely=False)}</KinBody>'
        wrapped = xml
        for depth in range(choices.integer(1, 4)):
            unit = one_of(choices, ["", "<unit>mm 0.001</unit>"])
            if chance(choices, 50):
                (folder / f"{depth}.xml").write_text(wrapped)
                kind = "Environment" if wrapped.startswith("<E") else 'KinBody name="k"'
                wrapped = f'<{kind} file="{depth}.xml"/>'
            wrapped = f"<Environment>{unit}{wrapped}</Environment>"
        (folder / "outer.xml").write_text(wrapped)
        (found,) = read(folder / "outer.xml").scene.bodies
        assert_same(found, body(xml), atol=0)


@pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")
class TestWhatChangesOneThing:
    @given(choices())
    @examples(150)
    def test_a_transform_moves_the_whole_body(self, choices):
        parts = draw_parts(choices)
        moved = draw_part(choices, 0).pose
        xml = flat(parts, absolutely=chance(choices, 50))
        scope = f"<Translation>{text(moved.position)}</Translation><Quat>{text(moved.wxyz)}</Quat>"
        still, found = body(f'<KinBody name="k">{xml}</KinBody>'), body(f'<KinBody name="k">{xml}{scope}</KinBody>')
        assert structure(found) == structure(still)
        np.testing.assert_allclose(poses_of(found), moved.matrix() @ poses_of(still), atol=1e-9)
        assert_numbers(found, numbers_of(still))

    @given(choices())
    @examples(150)
    def test_a_prefix_changes_names_alone(self, choices):
        xml = flat(draw_parts(choices), absolutely=False)
        plain, found = (body(f'<KinBody name="k"{prefix}>{xml}</KinBody>') for prefix in ("", ' prefix="p_"'))
        assert [link.name for link in found.links] == [f"p_{link.name}" for link in plain.links]
        assert [one.name for one in found.joints] == [f"p_{one.name}" for one in plain.joints]
        np.testing.assert_array_equal(poses_of(found), poses_of(plain))
        for name, values in numbers_of(plain).items():
            np.testing.assert_array_equal(numbers_of(found)[name], values, err_msg=name)

    @given(choices())
    @examples(100)
    def test_another_name_is_all_that_it_changes(self, choices):
        xml = flat(draw_parts(choices), absolutely=True)
        plain, found = (body(f'<KinBody name="{name}">{xml}</KinBody>') for name in ("k", "other"))
        assert compare(Scene((plain,)), Scene((replace(found, name="k"),))) == []
        assert found.name == "other"

    @given(choices())
    @examples(60)
    def test_a_unit_of_collada_scales_lengths(self, choices):
        plain = body(f'<KinBody name="k">{flat(draw_parts(choices), absolutely=True)}</KinBody>')
        document = collada_document(Scene((plain,)), Diagnostics())
        unit = one_of(choices, [0.5, 3.0])
        (found,) = read_data(document.replace('meter="1"', f'meter="{unit}"')).scene.bodies
        assert structure(found) == structure(plain)
        wanted = poses_of(plain)
        wanted[:, :3, 3] *= unit
        np.testing.assert_allclose(poses_of(found), wanted, atol=1e-9)
        numbers = numbers_of(plain)
        numbers["rigid"][:, 1:4] *= unit
        numbers["shapes"] *= unit
        del numbers["axes"]
        assert_numbers(found, numbers)
        for one, other in zip(found.joints, plain.joints, strict=True):
            factor = unit if one.slides() else 1.0
            for name in ("lower", "upper", "value", "max_velocity"):
                assert getattr(one.axes[0], name) == pytest.approx(factor * getattr(other.axes[0], name), abs=1e-9)

    @given(choices())
    @examples(150)
    def test_a_factor_scales_positions_and_centres_of_mass(self, choices):
        links = "".join(chained(index, part) for index, part in enumerate(draw_parts(choices)))
        factor = one_of(choices, [2.0, 0.5])
        scales = ("", f' scalegeometry="{factor}"')
        plain, found = (body(f'<KinBody name="k"{scale}>{links}</KinBody>') for scale in scales)
        wanted = poses_of(plain)
        wanted[:, :3, 3] *= factor
        np.testing.assert_allclose(poses_of(found), wanted, atol=1e-9)
        rigid = numbers_of(plain)["rigid"]
        rigid[:, 1:4] *= factor
        np.testing.assert_allclose(numbers_of(found)["rigid"], rigid, atol=1e-9)
        np.testing.assert_array_equal(numbers_of(found)["shapes"], numbers_of(plain)["shapes"])


@pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")
@pytest.mark.parametrize("change", [{"position": (1.0, 2.0, 3.0)}, {"com": (9.0, 0.0, 0.0)}, {"limits": (-1.0, 1.0)}])
def test_the_comparison_sees_a_difference(change):
    parts = draw_parts(RandomChoices(1))
    others = [*parts[:-1], replace(parts[-1], **change)]
    one, other = (body(f'<KinBody name="k">{flat(some, absolutely=True)}</KinBody>') for some in (parts, others))
    with pytest.raises(AssertionError):
        assert_same(one, other)

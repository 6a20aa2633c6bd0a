"""Which pairs of links plain MuJoCo tests against each other: those that OpenRAVE tests, as far as it can."""

from itertools import combinations

import mujoco
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import Choices, chance, choices, examples, one_of

from ravemj.errors import Diagnostics
from ravemj.formats import mjcf
from ravemj.formats.mjcf import Options
from ravemj.formats.openrave_xml import read
from ravemj.model.chains import adjacent_pairs
from ravemj.model.scene import Scene

KINDS = {"hinge": "", "weld": "<limits>0 0</limits>", "loose": ""}


def link(index: int, radius: float = 1.0, kind: str = "dynamic") -> str:
    shape = f'<Geom type="sphere"><radius>{radius}</radius></Geom>' if radius else ""
    return f'<Body name="l{index}" type="{kind}"><Translation>{index / 100} 0 0</Translation>{shape}</Body>'


def joint(index: int, first: int, second: int, kind: str = "hinge") -> str:
    enabled = "false" if kind == "loose" else "true"
    links = f"<Body>l{first}</Body><Body>l{second}</Body>"
    return f'<Joint name="j{index}" enable="{enabled}">{links}<Axis>0 0 1</Axis>{KINDS[kind]}</Joint>'


def draw_model(choices: Choices, *, joined: bool) -> str:
    count = choices.integer(2, 8)
    statics = ["static" if chance(choices, 10) else "dynamic" for _ in range(count)]
    parts = [link(i, 0.0 if chance(choices, 10) else 1.0, statics[i]) for i in range(count)]
    for number in range(choices.integer(0, count + 1)):
        first, second = choices.integer(0, count - 2), choices.integer(1, count - 1)
        if first < second:
            parts.append(joint(number, first, second, one_of(choices, list(KINDS))))
    return body(parts, choices, joined=joined)


def draw_trees(choices: Choices) -> str:
    """Draw a body that needs no two roots in one tree, and no joint that MuJoCo does not have."""
    count = choices.integer(2, 8)
    parts = [link(i, 0.0 if chance(choices, 10) else 1.0) for i in range(count)]
    for child in range(1, count):
        if chance(choices, 80):
            parts.append(joint(child, choices.integer(0, child - 1), child, one_of(choices, ["hinge", "weld"])))
    return body(parts, choices)


def body(parts: list[str], choices: Choices, *, joined: bool = True) -> str:
    count = sum(part.startswith("<Body") for part in parts)
    for _ in range(choices.integer(0, 2)):
        parts.append(f"<adjacent>l{choices.integer(0, count - 1)} l{choices.integer(0, count - 1)}</adjacent>")
    return f'<KinBody name="k" makejoinedlinksadjacent="{joined:d}">{"".join(parts)}</KinBody>'


@pytest.fixture
def scene(tmp_path):
    def scene(content: str) -> Scene:
        (tmp_path / "model.xml").write_text(content)
        reading = read(tmp_path / "model.xml")
        assert reading.failure is None
        return reading.scene

    return scene


def touching(scene: Scene, options: Options) -> set[tuple[int, int]]:
    """Return the pairs of links between which MuJoCo finds contacts, where all of them overlap."""
    written = mjcf.write(scene, Diagnostics(), options)
    model = mujoco.MjModel.from_xml_string(written.text)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_collision(model, data)
    names = written.names[0].links
    links = [names.index(model.body(body).name) if body else -1 for body in model.geom_bodyid]
    return {(min(pair), max(pair)) for pair in ([links[geom] for geom in contact.geom] for contact in data.contact)}


def excluded(scene: Scene, options: Options) -> list[str]:
    text = mjcf.write(scene, Diagnostics(), options).text
    return [line.strip() for line in text.splitlines() if "<exclude" in line]


@given(choices(), st.booleans(), st.booleans())
@examples(150)
def test_what_openrave_never_tests_is_not_tested(scene, choices, joined, free):
    model = scene(draw_model(choices, joined=joined))
    bare = touching(model, Options(free_bases=free, excludes=False))
    adjacent = adjacent_pairs(model.bodies[0])
    assert touching(model, Options(free_bases=free)) == bare - adjacent
    assert len(excluded(model, Options(free_bases=free))) == len(bare & adjacent), "each exclude is needed"
    assert excluded(model, Options(free_bases=free, excludes=False)) == []


@given(choices(), st.booleans())
@examples(100)
def test_what_openrave_tests_is_tested(scene, choices, free):
    model = scene(draw_trees(choices))
    (body,) = model.bodies
    pairs = set(combinations(range(len(body.links)), 2)) - adjacent_pairs(body)
    assert touching(model, Options(free_bases=free)) == pairs


@pytest.mark.parametrize(
    ("content", "count"),
    [
        ("".join(link(i) for i in range(30)), 0),
        ("".join(link(i) for i in range(30)) + "".join(joint(i, i, i + 1) for i in range(29)), 1),
        ("".join(link(i) for i in range(30)) + "".join(joint(i, i, i + 1, "weld") for i in range(29)), 0),
        ("".join(link(i) for i in range(30)) + "".join(joint(i, 0, i) for i in range(1, 30)), 29),
        ("".join(link(i) for i in range(30)) + joint(0, 0, 1), 29),
    ],
    ids=["furniture", "chain", "welded", "star", "furniture and a door"],
)
def test_few_are_named(scene, content, count):
    assert len(excluded(scene(f'<KinBody name="k">{content}</KinBody>'), Options())) == count

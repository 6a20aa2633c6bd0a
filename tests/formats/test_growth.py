"""Work on large models grows with the number of their parts, not with its square."""

import contextlib
import io
import re

import numpy as np
import pytest
from conftest import DATA
from steps import steps

import ravemj
from ravemj.cli import main
from ravemj.core.graphs import ShortestPaths
from ravemj.errors import Diagnostics
from ravemj.formats import mjcf
from ravemj.formats.collada import writer as collada
from ravemj.formats.openrave_xml import writer
from ravemj.formats.readers import read_data, read_file
from ravemj.model.chains import adjacent_pairs, separate_pairs
from ravemj.model.comparison import compare

pytestmark = pytest.mark.usefixtures("no_cache")

BOX = '<Geom type="box"><extents>0.1 0.1 0.1</extents></Geom>'
FEW, MANY, MOST = 60, 400, 2.3
"""Parts of the smaller model, the same where each costs little beside other work, and the largest ratio of the work for
twice as many, which is 4 where it grows with the square."""


def joint(number, first, second, attributes=""):
    return f'<Joint name="j{number}" type="hinge"{attributes}><Body>b{first}</Body><Body>b{second}</Body></Joint>'


def robot(count, joints, shape=BOX):
    links = "".join(f'<Body name="b{number}" type="dynamic">{shape}</Body>' for number in range(count))
    return f'<Robot name="r"><KinBody>{links}{"".join(joints)}</KinBody></Robot>'


def star(count):
    return robot(count, (joint(number, 0, number) for number in range(1, count)))


def chain(count):
    return robot(count, (joint(number, count - number, count - number - 1) for number in range(1, count)))


def loops(count):
    arms = [joint(number, 0, number) for number in range(1, count)]
    return robot(count, arms + [joint(f"x{number}", number, number + 1) for number in range(1, count - 1)], "")


def followers(count):
    return robot(count, (joint(k, 0, k, f' mimic_pos="j1*{k}"' * (k > 1)) for k in range(1, count)))


def arms(count):
    arm = "<base>b0</base><effector>b1</effector>"
    manipulators = "".join(f'<Manipulator name="m{number}">{arm}</Manipulator>' for number in range(count))
    return robot(count, (joint(k, k - 1, k) for k in range(1, count))).replace("</Robot>", f"{manipulators}</Robot>")


def unknown_tags(count):
    return robot(1, (), "".join(f"<tag{count}_{number}/>" for number in range(count)))


def bodies(count):
    texts = (f'<KinBody name="k{k}"><Body name="b">{BOX}</Body></KinBody>' for k in range(count))
    return f"<Environment>{''.join(texts)}</Environment>"


def groups(count):
    """Return an arm, one of whose shapes has its triangles in groups with a material each."""
    text = (DATA / "collada" / "arm.dae").read_text()
    for pattern in ("<triangles .*?</triangles>", "<instance_material .*?/>"):
        start, end = re.search(pattern, text, re.DOTALL).span()
        many = (text[start:end].replace('"paint"', f'"paint{number}"') for number in range(count))
        text = text[:start] + "".join(many) + text[end:]
    return text


def in_collada(text):
    return collada.write(read_data(text).scene, Diagnostics())


def read(text):
    return mjcf.write(read_data(text).scene, Diagnostics())


def difference(text):
    return compare(read_data(text).scene, read_data(text).scene)


def save_xml(text):
    return writer.write(read_data(text).scene, Diagnostics())


_IDS = (
    "star chain loops followers arms unknown_tags bodies groups collada_star collada_bodies "
    "star_in_collada loops_in_collada star_in_xml"
)


@pytest.mark.stress
@pytest.mark.parametrize(
    ("make", "work"),
    [
        (star, read),
        (chain, read),
        (loops, read),
        (followers, read),
        (arms, read_data),
        (unknown_tags, read),
        (bodies, read),
        (groups, read),
        (lambda count: in_collada(star(count)), read),
        (lambda count: in_collada(bodies(count)), read),
        (star, in_collada),
        (loops, in_collada),
        (star, save_xml),
    ],
    ids=_IDS.split(),
)
def test_reading_and_writing(make, work):
    few = MANY if make in (groups, bodies) else FEW
    small, large = make(few), make(2 * few)
    work(make(few - 1))  # imports and caches
    assert steps(lambda: work(large)) < MOST * steps(lambda: work(small))


@pytest.mark.stress
@pytest.mark.parametrize("make", [star, chain, bodies])
def test_info(make, tmp_path):
    def info(count):
        with contextlib.redirect_stdout(io.StringIO()):
            assert main(["info", str(tmp_path / f"{count}.xml")]) == 0

    for count in (FEW, 2 * FEW):
        (tmp_path / f"{count}.xml").write_text(make(count))
    assert steps(lambda: info(2 * FEW), "info.py") < MOST * steps(lambda: info(FEW), "info.py")


@pytest.mark.stress
@pytest.mark.parametrize("suffix", [".json", ".dae"])
def test_environments(suffix, tmp_path):
    """Load, rename and remove many bodies of one name, and a body of many links."""

    def work(count):
        env = ravemj.Environment()
        env.Load(str(tmp_path / f"{count}{suffix}"))
        for number in range(count):
            body = ravemj.RaveCreateKinBody(env, "")
            body.InitFromBoxes(np.array([[number, 0, 0, 0.1, 0.1, 0.1]]))
            body.SetName("box")
            env.Add(body, True)
        for body in env.GetBodies():
            env.Remove(body)

    for count in (FEW, 2 * FEW):
        env = ravemj.Environment()
        env.LoadData(star(count))
        env.Save(str(tmp_path / f"{count}{suffix}"))
    work(FEW)
    assert steps(lambda: work(2 * FEW)) < MOST * steps(lambda: work(FEW))


@pytest.mark.stress
def test_a_body_of_very_many_links(tmp_path):
    (tmp_path / "star.xml").write_text(star(10_000))
    (body,) = read_file(tmp_path / "star.xml").scene.bodies
    assert len(body.links) == 10_000
    assert all(joint.parent == 0 and joint.places_child for joint in body.joints)
    assert len(ShortestPaths(10_000, [(0, k) for k in range(1, 10_000)]).path(9998, 9999)) == 2


def test_links_that_nothing_connects_are_all_adjacent():
    (body,) = read_data(robot(10_000, ())).scene.bodies
    assert separate_pairs(body) == []
    (small,) = read_data(robot(5, ())).scene.bodies
    assert len(adjacent_pairs(small)) == 10

"""Damaged URDF and SRDF: a robot or an error with a place, after little work, and nothing read from elsewhere."""

import random
import re

import pytest
from conftest import MODELS, one_in
from fuzzing import Trial, damage

URDF = (MODELS / "desk_arm" / "urdf" / "desk_arm.urdf").read_bytes()
SRDF = (MODELS / "desk_arm" / "srdf" / "desk_arm.srdf").read_bytes()
MESH = (MODELS / "desk_arm" / "meshes" / "finger.obj").read_bytes()

BATCHES, BATCH = 8, 250
DEEP = 10
"""One in so many robots is compiled and moved, too."""

VALUES = [
    b"", b" ", b"nan", b"inf", b"-1", b"0", b"1e400", b"1e300", b"-1e-300", b"0 0 0", b"1 0", b"1 2 3 4", b"x" * 5000,
    b"floating", b"planar", b"fixed", b"continuous", b"prismatic", b"arm", b"base", b"tcp", b"jaw", b"other_jaw",
    b"package://", b"package://../x", b"package://desk_arm/../../../etc/hostname", b"file:///etc/hostname", b"..",
    b"http://example.com/a.stl", b"/dev/zero", b"/etc/hostname", b"model://%00/x.stl", b"a/b", b"pi", b"a*b+(c",
    b"&#233;",
]  # fmt: skip
TAGS = [b"link", b"joint", b"mimic", b"visual", b"collision", b"group", b"chain", b"material", b"mesh", b"Link", b"x:y"]
_ELEMENT = re.compile(rb"<(\w+)[^<>]*/>|<(joint|link|visual|collision|inertial|group)\b[^<>]*>.*?</\2>", re.DOTALL)
_VALUE = re.compile(rb'"([^"]*)"')
_TAG = re.compile(rb"(?<=<)\w+(?=[ />])")


def mutated(text: bytes, source: random.Random) -> bytes:
    """Return a document with some values, tags and elements exchanged, removed, repeated or moved."""
    for _ in range(source.randint(1, 6)):
        kind = source.choice([_VALUE, _VALUE, _VALUE, _TAG, _ELEMENT, _ELEMENT])
        places = [match.span(1) if kind is _VALUE else match.span() for match in kind.finditer(text)]
        if not places:
            break
        (begin, end), (first, last) = source.choice(places), source.choice(places)
        other = text[first:last]
        if kind is _ELEMENT:
            new = source.choice([b"", other, text[begin:end] + other, text[begin:end] * 2])
        else:
            new = source.choice([other, source.choice(VALUES if kind is _VALUE else TAGS)])
        text = text[:begin] + new + text[end:]
    return damage(text, source) if source.random() < 0.1 else text


@pytest.mark.stress
@pytest.mark.parametrize("batch", one_in(2, range(BATCHES)))
def test_mutations(batch, tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("RAVEMJ_CACHE", "off")
    loaded, crashes = 0, []
    for number in range(batch * BATCH, (batch + 1) * BATCH):
        source = random.Random(number)
        urdf, srdf = source.choice([(mutated(URDF, source), SRDF), (URDF, mutated(SRDF, source))])
        files = {"main.urdf": urdf, "main.srdf": srdf, "desk_arm/meshes/finger.obj": MESH}
        try:
            outcome = Trial(deep=number % DEEP == 0).run(files)
        except Exception as error:  # the number says how to make it again
            crashes.append((number, repr(error)[:200]))
            continue
        loaded += outcome.links > 0
    assert crashes == []
    assert loaded >= BATCH / 4, "too few robots are read to their end"
    assert capfd.readouterr().err == ""
    assert not list(tmp_path.iterdir())

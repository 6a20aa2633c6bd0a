"""Damaged COLLADA documents: a scene or a ``RavemjError``, after little work."""

import copy
import random
import re
import warnings
import zipfile
from contextlib import suppress

import pytest
from conftest import DATA, one_in
from fuzzing import NUMBERS
from lxml import etree
from waiting import time_limit

from ravemj.engine.simulation import Simulation
from ravemj.errors import Diagnostics, RavemjError, RavemjWarning
from ravemj.formats import mjcf
from ravemj.formats.readers import read_data, read_file

ARM = DATA / "collada" / "arm.dae"
BATCHES, BATCH = 4, 500
DEEP = 10
"""One in so many documents is compiled too."""
PLACE = re.compile("<!-- .* -->")
"""The lines of the file, as the MJCF has them."""


class Mutator:
    """Changes a few things in a document, as a seed says."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.root = etree.parse(ARM, etree.XMLParser(remove_comments=True)).getroot()
        self.elements = [item for item in self.root.iter() if item is not self.root]
        changes = [
            self.number,
            self.number,
            self.attribute,
            self.attribute,
            self.drop,
            self.twice,
            self.move,
            self.name,
            self.reference,
            self.reference,
        ]
        for _ in range(self.random.randint(1, 6)):
            self.random.choice(changes)()

    def element(self):
        return self.random.choice([item for item in self.elements if item.getparent() is not None])

    def number(self) -> None:
        element = self.random.choice([item for item in self.elements if item.text and item.text.strip()])
        words = element.text.split()
        words[self.random.randrange(len(words))] = self.random.choice(NUMBERS)
        element.text = " ".join(words[: self.random.choice([len(words), len(words), 1])])

    def attribute(self) -> None:
        element = self.random.choice([item for item in self.elements if item.attrib])
        others = [value for item in self.elements for value in item.attrib.values()]
        name = self.random.choice(list(element.attrib))
        element.set(name, self.random.choice([*others, "", "#", "/", ".", "arm_motion/m_model/x", "x.dae#y"]))

    def reference(self) -> None:
        """Let something refer to what another thing of its kind refers to."""
        element = self.random.choice([item for item in self.elements if item.attrib or "/" in (item.text or "")])
        others = [item for item in self.elements if item.tag == element.tag]
        name = self.random.choice([*element.attrib, None])
        if name is None:
            element.text = self.random.choice(others).text
        else:
            element.set(name, self.random.choice(others).get(name, ""))

    def drop(self) -> None:
        element = self.element()
        element.getparent().remove(element)

    def twice(self) -> None:
        element = self.element()
        element.addnext(copy.deepcopy(element))

    def move(self) -> None:
        element, target = self.element(), self.element()
        if element not in [target, *target.iterancestors()]:
            target.append(element)

    def name(self) -> None:
        element = self.element()
        element.tag = self.random.choice(self.elements).tag


def meaning(data: bytes, deep: bool = False) -> tuple[int, str, list[str]]:
    """Read and translate a document; return how many links it has, what becomes of it, and what is said about it."""
    with time_limit(), warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", RavemjWarning)
        reading = read_data(data)
        text = mjcf.write(reading.scene, Diagnostics()).text
        if deep:
            simulation = Simulation()
            for body in reading.scene.bodies:
                simulation.add(body)
            with suppress(RavemjError):
                simulation.compiled()
        links = sum(len(body.links) for body in reading.scene.bodies)
        return links, PLACE.sub("", text), [str(finding) for finding in reading.diagnostics]


@pytest.mark.stress
@pytest.mark.parametrize("batch", one_in(BATCHES, range(BATCHES)))
def test_documents(batch, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("RAVEMJ_CACHE", "off")
    whole = meaning(ARM.read_bytes())
    reached, crashes = 0, []
    for seed in range(batch * BATCH, (batch + 1) * BATCH):
        data = etree.tostring(Mutator(seed).root)
        try:
            found = meaning(data, seed % DEEP == 0)
            reached += found[0] > 0 and found[1:] != whole[1:]
        except Exception as error:  # the seed says how to make it again
            crashes.append((seed, repr(error)[:200]))
    assert crashes == []
    assert reached >= BATCH / 2, "too few documents have links, and mean something else than the whole one"


def test_damaged_archives(tmp_path):
    path = tmp_path / "arm.zae"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(ARM, "arm.dae")
    whole = path.read_bytes()
    chosen = random.Random(0)
    for _ in range(200):
        data = bytearray(whole)
        for _ in range(chosen.randint(1, 4)):
            data[chosen.randrange(len(data))] = chosen.randrange(256)
        path.write_bytes(data[: chosen.choice([len(data), chosen.randrange(len(data))])])
        reading = read_file(path)
        assert reading.failure is None or str(reading.failure)

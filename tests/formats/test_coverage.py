"""The pages that are made: they are up to date, and what they say is so."""

import re
import shlex

import api_coverage
import format_coverage as coverage
import pytest
from api_names import BEHIND, PYMANOID, SCRIPTS
from conftest import REPOSITORY

from ravemj.cli import reference
from ravemj.cli.parser import make_parser
from ravemj.formats.readers import read_file

WAYS_IN = {
    "Environment": "<Environment>{}</Environment>",
    "PhysicsEngine": '<Environment><PhysicsEngine type="ode">{}</PhysicsEngine></Environment>',
    "Robot": '<Robot name="r">{}</Robot>',
    "KinBody": '<KinBody name="k">{}</KinBody>',
    "Body": '<KinBody name="k"><Body name="b">{}</Body></KinBody>',
    "Geom": '<KinBody name="k"><Body name="b"><Geom>{}</Geom></Body></KinBody>',
    "Mass": '<KinBody name="k"><Body name="b"><Mass>{}</Mass></Body></KinBody>',
    "Mass of a KinBody": '<KinBody name="k"><Mass>{}</Mass></KinBody>',
    "Manipulator": '<Robot name="r"><Manipulator name="m">{}</Manipulator></Robot>',
    "AttachedSensor": '<Robot name="r"><AttachedSensor name="s">{}</AttachedSensor></Robot>',
    "Sensor": '<Environment><Sensor name="s" type="BaseCamera">{}</Sensor></Environment>',
}
"""Where an element's children stand; joints and actuators are refused without their bodies."""


@pytest.mark.parametrize(("page", "made"), [("coverage.md", coverage.markdown), ("cli.md", reference.markdown)])
def test_the_page_is_up_to_date(page, made):
    assert (REPOSITORY / "docs" / page).read_text(encoding="utf-8") == made(), "run scripts/docs"


def test_the_page_of_the_api_is_up_to_date():
    page = (REPOSITORY / "docs" / "api-coverage.md").read_text(encoding="utf-8")
    assert page == api_coverage.markdown(), "run python scripts/pages/api_coverage.py > docs/api-coverage.md"


def test_names_of_the_api_are_found_where_they_are():
    assert len(set(SCRIPTS)) == 250
    assert set(BEHIND) <= {*SCRIPTS, *PYMANOID}
    found = {name: [tuple(place) for place in api_coverage.find(name)] for name in ("with_robot", "plot4", *SCRIPTS)}
    assert found["with_robot"] == [("KinBody", "")]
    assert found["plot4"] == []
    assert found["GetRobots"] == [("Environment", "")]
    assert found["DrawAxes"] == [("misc", "")]
    assert found["BaseManipulation"] == [("interfaces", "")]
    assert found["RetimeTrajectory"] == [("planningutils", "")]
    assert found["ReachabilityModel"] == [("databases.kinematicreachability", "maps of what arms reach")]
    assert {"Link", "KinBody", "Manipulator"} <= {owner for owner, _ in found["GetTransform"]}


@pytest.mark.parametrize("section", coverage.sections(), ids=lambda section: section.element)
def test_everything_that_is_known_has_a_meaning_and_is_either_read_or_left_out(section):
    for table in (section.tags, section.attributes, section.left_out, section.left_out_attributes):
        assert all(table.values())
    assert not set(section.tags) & set(section.left_out)
    assert not set(section.attributes) & set(section.left_out_attributes)


@pytest.mark.parametrize(
    "section",
    [section for section in coverage.sections() if section.element in WAYS_IN],  # others have to be complete
    ids=lambda section: section.element,
)
def test_children_are_treated_as_the_page_says(section, tmp_path):
    path = tmp_path / "model.xml"
    children = [(tag, "ignored-tag") for tag in section.left_out if not tag.startswith("(")]
    children += [("nonsense", "ignored-tag" if section.element == "PhysicsEngine" else "unknown-tag")]
    for tag, code in children:
        path.write_text(WAYS_IN[section.element].format(f"<{tag}/>"))
        found = [finding.code for finding in read_file(path).diagnostics if f"<{tag}>" in finding.message]
        assert found == [code], tag
    for tag in section.tags:
        path.write_text(WAYS_IN[section.element].format(f"<{tag}/>"))
        reading = read_file(path)
        assert not [finding for finding in reading.diagnostics if finding.code in {"ignored-tag", "unknown-tag"}], tag


@pytest.mark.parametrize(
    ("element", "code", "text"),
    [
        ("Geom", "unsupported-geometry", '<KinBody name="k"><Body name="b"><Geom type="{}"/></Body></KinBody>'),
        ("Mass", "unknown-type", '<KinBody name="k"><Body name="b"><Mass type="{}"/></Body></KinBody>'),
        (
            "Sensor",
            "unknown-interface",
            '<Robot name="r"><AttachedSensor><Sensor type="{}"/></AttachedSensor></Robot>',
        ),
    ],
)
def test_types_are_known_as_the_page_says(element, code, text, tmp_path):
    path = tmp_path / "model.xml"
    meaning = next(one for one in coverage.sections() if one.element == element).attributes["type"]
    types = meaning.partition(";")[0].split(", ")
    assert len(types) > 3
    for kind in [*types, "nonsense"]:
        path.write_text(text.format(kind))
        found = [finding for finding in read_file(path).diagnostics if finding.code == code]
        assert bool(found) == (kind == "nonsense"), kind


def test_the_examples_of_all_commands_are_understood():
    page = reference.markdown()
    examples = [line for block in re.findall(r"```console\n(.*?)```", page, re.DOTALL) for line in block.splitlines()]
    assert len(examples) > 15
    for example in examples:
        words = shlex.split(re.split(r" [|>] ", example)[0], comments=True)
        assert words[0] == "ravemj"
        make_parser().parse_args(words[1:])


def test_the_page_names_every_option_of_every_command():
    page = reference.markdown()
    for option in ("--decompose", "--strict", "--json", "--actuators {position,velocity,torque}", "--fps N"):
        assert f"`{option}`" in page

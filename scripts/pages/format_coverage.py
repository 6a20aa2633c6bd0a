"""What is read of OpenRAVE's XML and what is left out, from the reader's own tables: ``docs/coverage.md``."""

import sys
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from ravemj.formats.meshes import MESH_SUFFIXES
from ravemj.formats.openrave_xml import actuator, environment, geom, joint, kinbody, link, mass, robot, sensor
from ravemj.formats.openrave_xml.tags import Tag
from ravemj.model.scene import SENSOR_KINDS

Meanings = Mapping[str, str]

_NONE: Meanings = MappingProxyType({})

_HEAD = """\
# Coverage of OpenRAVE's XML

<!-- scripts/docs makes this page from the tables of the reader; a test compares. -->

These are all tags and attributes that OpenRAVE knows. A tag that is *read* has OpenRAVE's effect. One that is *left
out* has none, for the reason given, and is reported as a warning (`ignored-tag`, `ignored-attribute`). Tags and
attributes in no table are unknown to OpenRAVE, too; ravemj skips them with a warning (`unknown-tag`,
`unknown-attribute`). Their letter case does not matter. `ravemj check FILE` lists all warnings about a file.
"""


class Section(NamedTuple):
    """An element of the format; all tables give a meaning, or a reason why something is left out.

    Attributes:
        element: Its tag.
        place: What it is, and where it stands.
        tags: Children that are read.
        attributes: Attributes that are read.
        left_out: Children that are known and left out; those in parentheses are no single tags.
        left_out_attributes: Attributes that are known and left out.
    """

    element: str
    place: str
    tags: Meanings
    attributes: Meanings
    left_out: Meanings = _NONE
    left_out_attributes: Meanings = _NONE


def sections() -> list[Section]:
    """Return all elements of the format."""
    in_scopes = "in Environment, Robot and KinBody, or the root"
    return [
        _section(
            "Environment",
            "the root, or nested",
            environment.ENVIRONMENT_TAGS,
            environment.ENVIRONMENT_ATTRIBUTES,
            environment.ENVIRONMENT_IGNORED,
        ),
        Section(
            "PhysicsEngine",
            "in Environment",
            {"odeproperties": "its `gravity`: x y z [m/s²]"},
            environment.PHYSICS_ATTRIBUTES,
            {"(what else is in it, and in odeproperties)": environment.NO_PHYSICS},
        ),
        _section(
            "Robot",
            "in Environment and Robot, or the root",
            kinbody.ROBOT_TAGS,
            kinbody.SCOPE_ATTRIBUTES,
            kinbody.ROBOT_IGNORED,
        ),
        _section("KinBody", in_scopes, kinbody.KINBODY_TAGS, kinbody.SCOPE_ATTRIBUTES, kinbody.KINBODY_IGNORED),
        _section("Body", "a link, in KinBody", link.LINK_TAGS, link.LINK_ATTRIBUTES, {}, link.LINK_IGNORED_ATTRIBUTES),
        _section("Geom", "a shape, in Body", geom.GEOM_TAGS, geom.GEOM_ATTRIBUTES, geom.GEOM_IGNORED),
        _section("Mass", "in Body", mass.MASS_TAGS, mass.MASS_ATTRIBUTES),
        _section("Mass of a KinBody", "in KinBody", mass.DEFAULT_MASS_TAGS, mass.DEFAULT_MASS_ATTRIBUTES),
        _section("Joint", "in KinBody", joint.JOINT_TAGS, joint.JOINT_ATTRIBUTES, joint.JOINT_IGNORED),
        _section(
            "Actuator",
            "in Joint",
            actuator.ACTUATOR_TAGS,
            actuator.ACTUATOR_ATTRIBUTES,
            actuator.ACTUATOR_IGNORED,
        ),
        _section(
            "Manipulator",
            "in Robot",
            robot.MANIPULATOR_TAGS,
            robot.MANIPULATOR_ATTRIBUTES,
            robot.MANIPULATOR_IGNORED,
        ),
        _section("AttachedSensor", "in Robot", robot.SENSOR_TAGS, robot.SENSOR_ATTRIBUTES, robot.SENSOR_IGNORED),
        _section(
            "Sensor",
            "in AttachedSensor and Environment, or the root; in an AttachedSensor, that has the pose",
            {**sensor.COMMON_TAGS, **sensor.PLACEMENT_TAGS},
            sensor.DEVICE_ATTRIBUTES,
            sensor.COMMON_IGNORED,
            sensor.DEVICE_IGNORED_ATTRIBUTES,
        ),
        *(
            _section(
                kind.name,
                "what only such a Sensor holds",
                sensor.device_tags(kind),
                {},
                sensor.device_ignored(kind),
            )
            for kind in SENSOR_KINDS.values()
        ),
    ]


def _section(
    element: str,
    place: str,
    tags: Mapping[str, Tag[Any]],
    attributes: Meanings,
    ignored: Meanings = _NONE,
    ignored_attributes: Meanings = _NONE,
) -> Section:
    """Return an element as the reader's tables have it."""
    read = {name: tag.meaning for name, tag in tags.items() if not tag.left_out}
    left_out = {name: tag.meaning for name, tag in tags.items() if tag.left_out}
    return Section(element, place, read, attributes, {**left_out, **ignored}, ignored_attributes)


def markdown() -> str:
    """Return the page."""
    return "\n".join([_HEAD, *map(_table, sections()), _meshes()])


def _table(section: Section) -> str:
    rows = [f"## {section.element}\n\n{section.place[0].upper()}{section.place[1:]}.\n"]
    rows += ["| attribute or child | status | meaning or reason |", "|---|---|---|"]
    rows += [f'| `{name}="…"` | read | {meaning} |' for name, meaning in sorted(section.attributes.items())]
    rows += [f'| `{name}="…"` | left out | {reason} |' for name, reason in section.left_out_attributes.items()]
    rows += [f"| `<{tag}>` | read | {meaning} |" for tag, meaning in section.tags.items()]
    rows += [f"| {_child(tag)} | left out | {reason} |" for tag, reason in section.left_out.items()]
    return "\n".join(rows) + "\n"


def _child(tag: str) -> str:
    return tag[1:-1] if tag.startswith("(") else f"`<{tag}>`"


def _meshes() -> str:
    suffixes = ", ".join(f"`{suffix}`" for suffix in sorted(MESH_SUFFIXES))
    return f"## Mesh files\n\nRead: {suffixes}. Others are reported as `broken-mesh`.\n"


if __name__ == "__main__":
    sys.stdout.write(markdown())

"""What is read of OpenRAVE's XML and what is left out, from the reader's own tables: ``docs/coverage.md``."""

import sys
from collections.abc import Collection, Mapping
from types import MappingProxyType
from typing import NamedTuple

from format_notes import NOTES

from ravemj.formats.meshes import MESH_SUFFIXES
from ravemj.formats.openrave_xml import actuator, environment, geom, joint, kinbody, link, mass, robot, sensor

Reasons = Mapping[str, str]

_NONE: Reasons = MappingProxyType({})

_HEAD = """\
# What is read of OpenRAVE's XML

Made by `scripts/docs` from the tables by which the reader itself decides; a test compares.

*read*: it has OpenRAVE's effect. *left out*: OpenRAVE knows it, and here it has no effect, for the reason given;
loading says so with the code `ignored-tag` or `ignored-attribute`. What is in no table OpenRAVE does not know either:
loading says so with `unknown-tag` or `unknown-attribute` and skips it. The letter case of tags and attributes does not
matter. `ravemj check FILE` lists what applies to a file.
"""


class Section(NamedTuple):
    """An element of the format.

    Attributes:
        element: Its tag.
        place: What it is, and where it stands.
        tags: Children that are read.
        attributes: Attributes that are read.
        left_out: Children that are known and left out, with the reason; those in parentheses are no single tags.
        left_out_attributes: Attributes that are known and left out, with the reason.
    """

    element: str
    place: str
    tags: Collection[str]
    attributes: Collection[str]
    left_out: Reasons = _NONE
    left_out_attributes: Reasons = _NONE


def sections() -> list[Section]:
    """Return all elements of the format."""
    in_scopes = "in Environment, Robot and KinBody, or the root"
    return [
        _environment(),
        Section(
            "PhysicsEngine",
            "in Environment",
            ["odeproperties"],
            ["type"],
            {"(what else is in it, and in odeproperties)": environment.NO_PHYSICS},
        ),
        _robot(),
        Section("KinBody", in_scopes, kinbody.KINBODY_TAGS, kinbody.SCOPE_ATTRIBUTES, kinbody.KINBODY_IGNORED),
        Section(
            "Body",
            "a link, in KinBody",
            link.LINK_TAGS,
            link.LINK_ATTRIBUTES,
            {},
            link.LINK_IGNORED_ATTRIBUTES,
        ),
        Section("Geom", "a shape, in Body", geom.GEOM_TAGS, geom.GEOM_ATTRIBUTES, geom.GEOM_IGNORED),
        Section("Mass", "in Body", mass.MASS_TAGS, mass.MASS_ATTRIBUTES),
        Section("Mass of a KinBody", "in KinBody", mass.DEFAULT_MASS_TAGS, mass.MASS_ATTRIBUTES),
        Section("Joint", "in KinBody", joint.JOINT_TAGS, joint.JOINT_ATTRIBUTES, joint.JOINT_IGNORED),
        Section("Actuator", "in Joint", actuator.ACTUATOR_TAGS, ["type"], actuator.ACTUATOR_IGNORED),
        Section(
            "Manipulator",
            "in Robot",
            robot.MANIPULATOR_TAGS,
            robot.MANIPULATOR_ATTRIBUTES,
            robot.MANIPULATOR_IGNORED,
        ),
        Section("AttachedSensor", "in Robot", robot.SENSOR_TAGS, robot.SENSOR_ATTRIBUTES, robot.SENSOR_IGNORED),
        _sensor(),
    ]


def _environment() -> Section:
    """Take apart what belongs to the model and the interfaces that are only reported."""
    reason = "it has no effect on the model; an unknown class is reported as an error"
    interfaces = dict.fromkeys(environment.INTERFACES, reason)
    read = [tag for tag in environment.ENVIRONMENT_TAGS if tag not in interfaces]
    left_out = {**environment.ENVIRONMENT_IGNORED, **interfaces}
    return Section("Environment", "the root, or nested", read, environment.ENVIRONMENT_ATTRIBUTES, left_out)


def _robot() -> Section:
    read = [tag for tag in kinbody.ROBOT_TAGS if tag != "controller"]
    left_out = {
        "controller": "it has no effect on the model; behind joints it ends the reading, as in OpenRAVE",
        **kinbody.ROBOT_IGNORED,
    }
    return Section("Robot", "in Environment and Robot, or the root", read, kinbody.SCOPE_ATTRIBUTES, left_out)


def _sensor() -> Section:
    left_out = {**sensor.CAMERA_IGNORED, "(what is in sensors other than cameras)": sensor.NO_DEVICE}
    place = "in AttachedSensor, or the root of an included file"
    return Section(
        "Sensor", place, sensor.CAMERA_TAGS, sensor.DEVICE_ATTRIBUTES, left_out, sensor.DEVICE_IGNORED_ATTRIBUTES
    )


def markdown() -> str:
    """Return the page."""
    return "\n".join([_HEAD, *map(_table, sections()), _meshes()])


def _table(section: Section) -> str:
    notes = NOTES[section.element]
    rows = [f"## {section.element}\n\n{section.place[0].upper()}{section.place[1:]}.\n"]
    rows += ["| attribute or child | | meaning or reason |", "|---|---|---|"]
    rows += [f'| `{name}="…"` | read | {notes.get(f"@{name}", "")} |' for name in sorted(section.attributes)]
    rows += [f'| `{name}="…"` | left out | {reason} |' for name, reason in section.left_out_attributes.items()]
    rows += [f"| `<{tag}>` | read | {notes.get(tag, '')} |" for tag in section.tags]
    rows += [f"| {_child(tag)} | left out | {reason} |" for tag, reason in section.left_out.items()]
    return "\n".join(rows) + "\n"


def _child(tag: str) -> str:
    return tag[1:-1] if tag.startswith("(") else f"`<{tag}>`"


def _meshes() -> str:
    suffixes = ", ".join(f"`{suffix}`" for suffix in sorted(MESH_SUFFIXES))
    return f"## Mesh files\n\nRead: {suffixes}. Others are reported as `broken-mesh`.\n"


if __name__ == "__main__":
    sys.stdout.write(markdown())

"""Writer of COLLADA 1.5 with OpenRAVE's extras.

It writes what ``scenes`` reads, structured like the output of OpenRAVE's writer: bodies are articulated systems of
motion and kinematics, joints are written at 0 and moved by bound values, masses are rigid bodies. What OpenRAVE's
extras cannot represent is written to ravemj's own extras (``supplement``), which other programs skip.
"""

from collections.abc import Mapping

from ravemj.errors import Diagnostics
from ravemj.formats.collada.body_writer import BodyWriter
from ravemj.formats.collada.external import ExternalBody, write_reference
from ravemj.formats.collada.geometry_writer import GeometryWriter
from ravemj.formats.collada.sections import Sections
from ravemj.formats.collada.sensor import write_loose
from ravemj.formats.xml_text import XmlText
from ravemj.model.scene import Scene

NAMESPACE = "http://www.collada.org/2008/03/COLLADASchema"

_NO_TIME = "1970-01-01T00:00:00Z"
"""Creation time, which COLLADA requires; constant, so that equal scenes give equal files."""


def write(scene: Scene, diagnostics: Diagnostics, external: Mapping[str, ExternalBody] | None = None) -> str:
    """Write a scene.

    Args:
        scene: The scene; its view is not written.
        diagnostics: Receives a warning for everything that the format cannot represent.
        external: By name, the bodies to write as references to other files.

    Raises:
        OutputError: A name or a number cannot be written.
    """
    geometry = GeometryWriter(diagnostics)
    sections = Sections(geometry)
    for number, body in enumerate(scene.bodies):
        reference = None if external is None else external.get(body.name)
        if reference is None:
            BodyWriter(sections, diagnostics, body, number).write()
        else:
            write_reference(sections, body, number, reference)
    write_loose(sections.kinematics_scene, sections.sensors, scene.sensors)
    out = XmlText()
    with out.inside("COLLADA", xmlns=NAMESPACE, version="1.5.0"):
        _write_asset(out, scene.description)
        _write_library(out, "visual_scene", sections.nodes, "vscene")
        for kind, content in (
            ("geometries", geometry.geometries),
            ("effects", geometry.effects),
            ("materials", geometry.materials),
            ("kinematics_models", sections.kinematics_models),
            ("articulated_systems", sections.systems),
        ):
            with out.inside(f"library_{kind}"):
                out.append(content)
        _write_library(out, "kinematics_scene", sections.kinematics_scene, "kscene")
        if scene.gravity is not None:
            with sections.physics_scene.inside("technique_common"):
                sections.physics_scene.element("gravity", scene.gravity)
        _write_library(out, "physics_scene", sections.physics_scene, "pscene")
        with out.inside("library_physics_models"):
            out.append(sections.physics_models)
        with out.inside("scene"):
            out.element("instance_physics_scene", url="#pscene")
            out.element("instance_visual_scene", url="#vscene")
            with out.inside("instance_kinematics_scene", url="#kscene"):
                out.append(sections.bindings)
        for kind, content in (("sensors", sections.sensors), ("actuators", sections.actuators)):
            with out.inside("extra", id=kind, type=f"library_{kind}"), out.inside("technique", profile="OpenRAVE"):
                out.append(content)
    return out.document()


def _write_asset(out: XmlText, description: str) -> None:
    with out.inside("asset"):
        out.element_inside("contributor", "authoring_tool", "ravemj")
        out.element("created", _NO_TIME)
        out.element("modified", _NO_TIME)
        if description:
            out.element("subject", description)
        out.element("unit", name="meter", meter=1)
        out.element("up_axis", "Z_UP")


def _write_library(out: XmlText, kind: str, content: XmlText, name: str) -> None:
    with out.inside(f"library_{kind}s"), out.inside(kind, id=name):
        out.append(content)

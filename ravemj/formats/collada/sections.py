"""The libraries of a document under construction."""

from dataclasses import dataclass, field

from ravemj.formats.collada.geometry_writer import GeometryWriter
from ravemj.formats.xml_text import XmlText


@dataclass
class Sections:
    """The libraries of a document, filled body by body.

    Attributes:
        bindings: The bindings of kinematics to nodes and values.
        models: Number of kinematics models.
    """

    geometry: GeometryWriter
    nodes: XmlText = field(default_factory=lambda: XmlText(3))
    kinematics_models: XmlText = field(default_factory=lambda: XmlText(2))
    systems: XmlText = field(default_factory=lambda: XmlText(2))
    kinematics_scene: XmlText = field(default_factory=lambda: XmlText(3))
    physics_models: XmlText = field(default_factory=lambda: XmlText(2))
    physics_scene: XmlText = field(default_factory=lambda: XmlText(3))
    bindings: XmlText = field(default_factory=lambda: XmlText(3))
    sensors: XmlText = field(default_factory=lambda: XmlText(3))
    actuators: XmlText = field(default_factory=lambda: XmlText(3))
    models: int = 0

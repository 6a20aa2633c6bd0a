"""What our own ``<extra>`` elements attach to links and joints: parameters, groups of shapes, held bodies."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ravemj.errors import SourceError
from ravemj.formats.collada.geometry import GeometryReader
from ravemj.formats.collada.library import Library
from ravemj.formats.collada.polar import rigid_part
from ravemj.formats.collada.references import References
from ravemj.formats.collada.supplement import own_techniques
from ravemj.formats.collada.visual import transform_of
from ravemj.formats.meshes.collada.document import Element, children
from ravemj.formats.parameters import with_parameter
from ravemj.model.builder import BodyBuilder, GrabBuilder, JointBuilder, LinkBuilder

Part = TypeVar("Part")


@dataclass(slots=True)
class AttachedReader:
    """Reads what is attached to the parts of a body, which paths name.

    Attributes:
        library: The documents.
        references: Resolves paths.
        geometry: Reads shapes.
        links: The links of the body, by their elements.
        joints: Its joints, by their elements.
    """

    library: Library
    references: References
    geometry: GeometryReader
    links: Mapping[Element, LinkBuilder]
    joints: Mapping[Element, JointBuilder]

    def read(self, system: Element, body: BodyBuilder) -> None:
        """Read all that an articulated system says.

        Raises:
            SourceError: A number in it is none.
        """
        for technique in own_techniques(system):
            for element in children(technique, "parameter"):
                self._read_parameter(element)
            for element in children(technique, "group"):
                link = self._found(element.get("of"), technique, self.links)
                if link is not None:
                    link.add_to_group(element.get("name") or "", self.geometry.read_instances(element, np.eye(4)))
            for element in children(technique, "grabbed"):
                link = self._found(element.get("link"), technique, self.links)
                if link is not None:
                    self._read_grab(element, technique, body, link)

    def _read_parameter(self, element: Element) -> None:
        owner = self._found(element.get("of"), element, {**self.links, **self.joints})
        if owner is None:
            return
        name, kind = element.get("name") or "", element.get("type") or ""
        try:
            owner.parameters = with_parameter(owner.parameters, name, kind, element.text or "")
        except ValueError as error:
            raise SourceError(f"the parameter '{name}' cannot be read: {error}", self.library.source(element)) from None

    def _read_grab(self, element: Element, technique: Element, body: BodyBuilder, link: LinkBuilder) -> None:
        source = self.library.source(element)
        T_link_body = rigid_part(transform_of(self.library, element), source)
        found = (self._found(path, technique, self.links) for path in (element.get("ignored") or "").split())
        ignored = tuple(one for one in found if one is not None)
        body.grabs.append(GrabBuilder(element.get("body") or "", link, T_link_body, ignored))

    def _found(self, path: str | None, scope: Element, parts: Mapping[Element, Part]) -> Part | None:
        found = self.references.resolve(path or "", scope)
        return None if found is None else parts.get(found.element)

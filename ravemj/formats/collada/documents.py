"""Cache of the COLLADA documents to which elements of one model refer."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ravemj.formats.limits import ParsingBudget

if TYPE_CHECKING:  # lxml is slow to import
    from ravemj.formats.collada.archive import Archive
    from ravemj.formats.meshes.collada.document import ColladaDocument


@dataclass(slots=True)
class Documents:
    """Cache of parsed documents and opened archives, so that each file is read once.

    Attributes:
        budget: Counts all XML documents of the model, including other formats.
        parsed: Documents by path.
        archives: Archives by path.
        places: Archive (or None) of each document, and its name in the archive.
    """

    budget: ParsingBudget = field(default_factory=ParsingBudget)
    parsed: "dict[str, ColladaDocument]" = field(default_factory=dict[str, "ColladaDocument"])
    archives: "dict[str, Archive]" = field(default_factory=dict[str, "Archive"])
    places: "dict[str, tuple[Archive | None, str]]" = field(default_factory=dict[str, "tuple[Archive | None, str]"])

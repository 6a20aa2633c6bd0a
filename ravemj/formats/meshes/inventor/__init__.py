"""Reader of Inventor 1.0 to 2.1 (text and binary), VRML 1.0 and VRML97.

OpenRAVE loads these files through Coin, with all triangles flattened into one mesh and the last material. So does this
reader: ``ascii`` or ``binary`` parse nodes, ``old`` or ``vrml97`` handle each node type, ``traversal`` collects
triangles.
"""

from ravemj.formats.meshes.files import FileContent
from ravemj.formats.meshes.inventor import ascii as text_format
from ravemj.formats.meshes.inventor import binary, old, vrml97
from ravemj.formats.meshes.inventor.nodes import InventorDocument, InventorNode
from ravemj.formats.meshes.inventor.traversal import Traversal, TraversalState
from ravemj.formats.meshes.parts import MeshPart, check_finite, weld


def read_inventor(file: FileContent) -> tuple[MeshPart, ...]:
    """Read an Inventor or VRML file; the header, not the suffix, selects the dialect.

    Returns:
        One part, white if it has no material; none if there are no triangles.

    Raises:
        SourceError: The file is malformed or too large.
    """
    trees: dict[str, list[InventorNode]] = {}

    def draw(traversal: Traversal, opened: FileContent, state: TraversalState) -> TraversalState:
        if opened.path not in trees:
            trees[opened.path] = _nodes(opened)
        handlers = vrml97.HANDLERS if opened.data.startswith(b"#VRML V2") else old.HANDLERS
        return traversal.nodes(trees[opened.path], handlers, state)

    traversal = Traversal(file, draw)
    draw(traversal, file, TraversalState())
    corners = traversal.corners()
    check_finite(corners, file.source)
    return (MeshPart(weld(corners), *traversal.material),) if len(corners) else ()


def _nodes(file: FileContent) -> list[InventorNode]:
    header = file.data[:80].partition(b"\n")[0]
    if header.startswith(b"#Inventor V") and b"binary" in header:
        return binary.parse(InventorDocument(file.path), file.data)
    document = InventorDocument(file.path, file.data.decode("latin-1"))  # a character a byte, never wrong
    if not file.data.startswith((b"#Inventor V", b"#VRML V")):
        document.fail("neither Inventor nor VRML: the file has to begin with #Inventor or #VRML", 0)
    return text_format.parse(document)

"""Draws docs/pictures/rooms.svg: which folder of ravemj/ imports which, read from the code."""

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "ravemj"
PICTURE = ROOT / "docs" / "pictures" / "rooms.svg"

_CELL = 24
"""Side of a cell [px]."""

_LEFT, _TOP = 170, 150
"""Space for the names of rows and columns [px]."""

_STYLE = "text { font: 14px sans-serif; fill: #333 } rect { fill: #f0f2f5 } .own { fill: #c8ced8 } .used { fill: #26b }"


def rooms() -> list[str]:
    """Return the rooms in the order of the table in docs/architecture.md, from the ground up."""
    lines = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8").splitlines()
    return [line.split("`")[1] for line in lines if line.startswith("| `")]


def blocks(node: ast.AST) -> list[ast.AST]:
    """Return the statements right below a statement, without expressions, which are most of the nodes."""
    fields = ("body", "orelse", "handlers", "finalbody", "cases")
    return [child for field in fields for child in getattr(node, field, [])]


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """Yield all statements below a node."""
    for child in blocks(node):
        yield child
        yield from statements(child)


def imported_rooms(room: str) -> set[str]:
    """Return the rooms whose modules those of a room import, in functions and for type checkers too."""
    files = [PACKAGE / f"{room}.py", *(PACKAGE / room).rglob("*.py")]
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in files if path.is_file()]
    nodes = [node for tree in trees for node in statements(tree)]
    names = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    names += [node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.module]
    return {parts[1] for parts in (name.split(".") for name in names) if parts[0] == "ravemj" and len(parts) > 1}


def drawn() -> str:
    """Return the matrix as SVG: the room of a row imports the room of a column if their cell is blue."""
    names = rooms()
    size = _CELL * len(names)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_LEFT + size + 10}" height="{_TOP + size + 10}">',
        f"<style>{_STYLE}</style>",
    ]
    for row, name in enumerate(names):
        y, used = _TOP + row * _CELL, imported_rooms(name)
        parts.append(f'<text x="{_LEFT - 8}" y="{y + 17}" text-anchor="end">{name}</text>')
        parts.append(f'<text transform="translate({_LEFT + row * _CELL + 17} {_TOP - 8}) rotate(-90)">{name}</text>')
        for column, other in enumerate(names):
            kind = "own" if row == column else "used" if other in used else "none"
            x, side = _LEFT + column * _CELL, _CELL - 2
            parts.append(f'<rect class="{kind}" x="{x}" y="{y}" width="{side}" height="{side}"/>')
    return "\n".join([*parts, "</svg>"]) + "\n"


if __name__ == "__main__":
    PICTURE.write_text(drawn(), encoding="utf-8")

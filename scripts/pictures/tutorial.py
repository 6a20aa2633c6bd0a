"""The tutorials as notebooks, and their pictures: ``python scripts/pictures/tutorial.py docs``.

Blocks of the pages are cells: ``python`` and ``ipython`` code, ``sh`` commands; one with a file name beside
its language is saved as that file. ``text`` after one of them is what it prints. All other text is Markdown.

Notebooks hold all their pictures: those that a cell makes are its output, others are attached to their text.
"""

import json
import re
import shutil
import sys
import tempfile
from base64 import b64encode
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ravemj.graphics.shown_path import ShownPath

PAGES = ("tutorial", "tip", "obstacle", "pick", "humanoids")
"""Names of the tutorials in ``docs/``; the pictures of each begin with its name."""

_BLOCK = re.compile(r"^```(python|ipython|sh|xml (?=\S)|text) *(\S*)\n(.*?)^```\n", re.MULTILINE | re.DOTALL)
_COLOUR = re.compile(r"\x1b\[[\d;]*m|\r")
_LINK = re.compile(r"\]\((?!https?:|#|pictures/)(?=[^)]+\))")
_FRAME = re.compile(r"^<iframe .*</iframe>\n*", re.MULTILINE)  # notebooks show none

_PICTURE = re.compile(r"!\[[^\]]*\]\(pictures/([\w.-]+)\)\n*")
_MAKES = r'(?:\.save\(|ravemj\.record\(.*)"{}"'  # a line that makes a picture
_SAVES = re.compile(r'^( *)(.*)\.save\("[\w-]+\.png"\)$|^\w+ = (ravemj\.record\(.*\))$', re.MULTILINE)

Cell = dict[str, Any]


def main(folder: Path) -> None:
    """Write the notebooks, run them, and keep the pictures that they save."""
    (folder / "notebooks").mkdir(exist_ok=True)
    for name in PAGES:
        page = (folder / f"{name}.md").read_text()
        with tempfile.TemporaryDirectory() as place:
            outputs(as_json(cells_of(page)), Path(place))
            for picture in Path(place).glob(f"{name}-*.*"):
                shutil.copy(picture, folder / ("motions" if picture.suffix == ".html" else "pictures"))
        (folder / "notebooks" / f"{name}.ipynb").write_text(notebook(page, folder / "pictures"))


def notebook(page: str, pictures: Path) -> str:
    """Return the notebook that a page makes, as JSON, with the pictures of a folder."""
    cells = cells_of(page)
    for name in [match[1] for match in _PICTURE.finditer(page)]:
        makers = [cell for cell in cells if re.search(_MAKES.format(re.escape(name)), cell["source"], re.MULTILINE)]
        for cell in cells if not makers else ():
            _attach(cell, pictures / name)
        for cell in makers:
            _add_output(cell, pictures / name)
    for cell in cells:
        cell["source"] = _PICTURE.sub("", cell["source"]).strip()
        if cell["cell_type"] == "code":
            cell["source"] = _SAVES.sub(r"\1display(\2\3)", cell["source"])
    return as_json([cell for cell in cells if cell["source"]])


def _attach(cell: Cell, picture: Path) -> None:
    """Put a picture into a cell whose text shows it."""
    if f"pictures/{picture.name}" in cell["source"]:
        cell["source"] = cell["source"].replace(f"pictures/{picture.name}", f"attachment:{picture.name}")
        cell.setdefault("attachments", {})[picture.name] = {_kind(picture): _base64(picture)}


def _add_output(cell: Cell, picture: Path) -> None:
    """Give a cell a picture as its output, before or behind what it prints."""
    content = {_kind(picture): _base64(picture)}
    if picture.suffix != ".png":
        content = {"text/html": ShownPath(picture)._repr_html_()}
    is_last = f'"{picture.name}"' in cell["source"].split("\n")[-1]
    shown = {"data": content, "metadata": {}, "output_type": "display_data"}
    cell["outputs"].insert(len(cell["outputs"]) if is_last else 0, shown)


def _kind(picture: Path) -> str:
    return f"image/{picture.suffix[1:]}"


def _base64(picture: Path) -> str:
    return b64encode(picture.read_bytes()).decode()


def as_json(cells: list[Cell]) -> str:
    """Return the notebook of some cells."""
    cells = [{**cell, "id": f"cell-{number:02}"} for number, cell in enumerate(cells, 1)]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    content = {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def cells_of(page: str) -> list[Cell]:
    """Return the cells of a page without numbers; what a block prints belongs to the cell before it."""
    return list(_cells(page))


def _cells(page: str) -> Iterator[Cell]:
    code: Cell | None = None
    end = 0
    for block in _BLOCK.finditer(page):
        language, file, content = block[1].strip(), block[2], block[3].rstrip("\n")
        prose = page[end : block.start()].strip()
        end = block.end()
        if language == "text" and code is not None:
            assert not prose, f"what is printed follows its block at once, and not: {prose}"
            code["outputs"] = [{"name": "stdout", "output_type": "stream", "text": f"{content}\n"}]
            continue
        if code is not None:
            yield code
        if prose:
            yield _markdown(prose)
        code = _code(language, file, content)
    if code is not None:
        yield code
    yield _markdown(page[end:].strip())


def _code(language: str, file: str, content: str) -> Cell:
    if file:
        content = f"%%writefile {file}\n{content}"
    elif language == "sh":
        content = "\n".join(f"!{line}" for line in content.splitlines())
    return {"cell_type": "code", "execution_count": None, "metadata": {}, "outputs": [], "source": content}


def _markdown(prose: str) -> Cell:
    source = _LINK.sub("](../", _FRAME.sub("", prose))
    return {"cell_type": "markdown", "metadata": {}, "source": source}


def outputs(text: str, folder: Path) -> list[tuple[str, str]]:
    """Run a notebook in a folder with a Jupyter kernel of its own.

    Returns:
        What each code cell prints or answers, and what the notebook says that it does.
    """
    import nbformat  # noqa: PLC0415 - only who runs it needs it
    from nbclient import NotebookClient  # noqa: PLC0415

    said = nbformat.reads(text, as_version=4)
    run = nbformat.reads(text, as_version=4)
    NotebookClient(run, timeout=120, resources={"metadata": {"path": str(folder)}}).execute()
    pairs = zip(run.cells, said.cells, strict=True)
    return [(_printed(now), _printed(then)) for now, then in pairs if now.cell_type == "code"]


def _printed(cell: Any) -> str:  # noqa: ANN401 - nbformat's
    """Return standard output, then the answer, of one cell; files that are written say nothing."""
    if cell.source.startswith("%%writefile"):
        return ""
    streams = [output.text for output in cell.outputs if output.get("name") == "stdout"]
    answers = [output.data["text/plain"] for output in cell.outputs if output.output_type == "execute_result"]
    lines = _COLOUR.sub("", "".join([*streams, *answers])).splitlines()
    return "\n".join(line.rstrip() for line in lines).strip("\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))

"""The site: every name has its place in the reference, and the reference has every method."""

import ast
import re

import pytest
import rooms
from conftest import REPOSITORY

import ravemj

DOCS = REPOSITORY / "docs"
CONF = """
import sys

sys.path.insert(0, {extensions!r})
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "reference"]
autodoc_typehints = "none"
"""


def test_every_name_is_in_the_reference():
    words = set(re.findall(r"\w+", "\n".join(page.read_text() for page in (DOCS / "api").glob("*.md"))))
    assert not set(ravemj.__all__) - words - {"__version__"}


@pytest.mark.filterwarnings("ignore")  # Sphinx's own
def test_a_class_shows_all_its_parts_with_the_types_of_the_source(tmp_path):
    """The page of robots alone, built as a site."""
    sphinx = pytest.importorskip("sphinx.application", reason="pages are built with scripts/docs --html")
    (tmp_path / "index.md").write_text((DOCS / "api" / "robot.md").read_text())
    (tmp_path / "conf.py").write_text(CONF.format(extensions=str(DOCS / "extensions")))
    built = tmp_path / "built"
    sphinx.Sphinx(tmp_path, tmp_path, built, built, "html", status=None, warning=None).build()
    page = (built / "index.html").read_text()
    for name in ("GetActiveDOF", "SetActiveDOFs", "GetManipulators", "SetController"):
        assert f'id="ravemj.Robot.{name}"' in page, name
    assert "ravemj.Robot.GetDOFValues" not in page  # on the page of bodies
    text = re.sub(r"<[^>]+>", "", page)
    assert re.search(r"SetActiveDOFValues\(\s*values: ArrayLike, checklimits: int = CheckLimitsAction", text)
    assert "_SupportsArray" not in text


def defined(path) -> set[str]:
    """Return the classes, functions and methods of a module, methods behind their class."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    kinds = ast.ClassDef | ast.FunctionDef
    names = {node.name for node in body if isinstance(node, kinds)}
    classes = [node for node in body if isinstance(node, ast.ClassDef)]
    return names | {f"{node.name}.{inner.name}" for node in classes for inner in node.body if isinstance(inner, kinds)}


def test_the_functions_that_a_call_goes_through_are_there():
    named = re.findall(r"`([\w/]+\.py)`: `([\w.]+)`", (DOCS / "calls.md").read_text(encoding="utf-8"))
    assert len(named) > 20
    assert [pair for pair in named if pair[1] not in defined(REPOSITORY / "ravemj" / pair[0])] == []


def test_the_picture_of_the_rooms_is_that_of_the_code():
    assert rooms.PICTURE.read_text(encoding="utf-8") == rooms.drawn(), "python scripts/pages/rooms.py draws it"

"""The site: every name has its place in the reference, and the reference has every method."""

import re
from pathlib import Path

import pytest

import ravemj

DOCS = Path(__file__).resolve().parent.parent / "docs"
CONF = """
import sys

sys.path.insert(0, {extensions!r})
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "reference"]
autodoc_typehints = "none"
"""


def test_every_name_is_in_the_reference():
    words = set(re.findall(r"\w+", "\n".join(page.read_text() for page in (DOCS / "api").glob("*.md"))))
    assert not set(ravemj.__all__) - words - {"__version__"}


@pytest.fixture(scope="module")
def robot_page(tmp_path_factory) -> str:
    """The page of robots alone, as HTML."""
    sphinx = pytest.importorskip("sphinx.application", reason="pages are built with scripts/docs --html")
    folder = tmp_path_factory.mktemp("pages")
    (folder / "index.md").write_text((DOCS / "api" / "robot.md").read_text())
    (folder / "conf.py").write_text(CONF.format(extensions=str(DOCS / "extensions")))
    built = folder / "built"
    sphinx.Sphinx(folder, folder, built, built, "html", status=None, warning=None).build()
    return (built / "index.html").read_text()


@pytest.mark.filterwarnings("ignore")  # of Sphinx's own
def test_a_class_shows_what_it_inherits_from_its_parts_and_not_from_others(robot_page):
    for name in ("GetActiveDOF", "SetActiveDOFs", "GetManipulators", "SetController"):
        assert f'id="ravemj.Robot.{name}"' in robot_page, name
    assert "ravemj.Robot.GetDOFValues" not in robot_page  # on the page of bodies


@pytest.mark.filterwarnings("ignore")
def test_signatures_are_those_of_the_source(robot_page):
    text = re.sub(r"<[^>]+>", "", robot_page)
    assert re.search(r"SetActiveDOFValues\(\s*values: ArrayLike, checklimits: int = CheckLimitsAction", text)
    assert "_SupportsArray" not in text

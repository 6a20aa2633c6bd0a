"""The site: every name has its place in the reference, and the reference has every method."""

import re

import pytest
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

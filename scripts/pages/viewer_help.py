"""Writes the table of gestures and keys into docs/viewer.md."""

import re
from pathlib import Path

from ravemj.gui.interaction.shortcuts import as_markdown

PAGE = Path(__file__).parents[2] / "docs" / "viewer.md"


def main() -> None:
    """Replace the first table of the page."""
    text = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(re.sub(r"\| to \| do \|\n(\|.*\n)+", lambda _: as_markdown(), text, count=1), encoding="utf-8")


if __name__ == "__main__":
    main()

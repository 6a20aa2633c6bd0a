"""The figures of the course: for each model that a lesson shows, a page with a slider for each joint."""

import re
from pathlib import Path

from sphinx.application import Sphinx

import ravemj

_FIGURE = re.compile(r'<iframe src="\.\./\.\./move-(\w+)\.html"')


def _write(app: Sphinx, error: Exception | None) -> None:
    if error is not None or app.builder.format != "html":
        return
    pages = (Path(app.srcdir) / "course").glob("*/index.md")
    for model in {name for page in pages for name in _FIGURE.findall(page.read_text(encoding="utf-8"))}:
        env = ravemj.load(ravemj.model_path(model))
        env.save_html(Path(app.outdir) / f"move-{model}.html")
        env.Destroy()


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the figures at the end of a build."""
    app.connect("build-finished", _write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

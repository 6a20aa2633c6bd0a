"""The page as one HTML document with its styles and scripts, so that a browser fetches it in one round trip."""

import base64
import hashlib
import re
from importlib import resources
from importlib.resources.abc import Traversable

_FOLDERS = tuple(resources.files(package) / "page" for package in ("ravemj.gui.viewers.web", "ravemj.graphics.webgl"))
_LINKS = re.compile(
    r"""<link rel="stylesheet" href="(?P<style>\w+\.css)">|<script src="(?P<script>\w+\.js)"></script>"""
)


def document(scene: str, *, is_lasting: bool) -> tuple[bytes, str]:
    """Return the page with inlined styles and scripts, and the Content-Security-Policy that permits only these.

    Args:
        scene: Name of the geometry that the page fetches while it connects; empty if it is not known yet.
        is_lasting: Whether the page should try to reconnect, since a later server may have the same address.
    """
    hashes: dict[str, list[str]] = {"style": [], "script": []}

    def inline(link: re.Match[str]) -> str:
        kind = str(link.lastgroup)
        text = _file(link[kind]).read_text(encoding="utf-8")
        digest = hashlib.sha256(text.encode()).digest()
        hashes[kind].append(f"'sha256-{base64.b64encode(digest).decode()}'")
        return f"<{kind}>{text}</{kind}>"

    page = _LINKS.sub(inline, _file("page.html").read_text(encoding="utf-8"))
    policy = (
        f"default-src 'none'; script-src {' '.join(hashes['script'])}; style-src {' '.join(hashes['style'])}; "
        "connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'"
    )
    page = page.replace('data-scene=""', f'data-scene="{scene}"', 1)
    return page.replace('data-lasting=""', f'data-lasting="{"yes" if is_lasting else ""}"', 1).encode(), policy


def _file(name: str) -> Traversable:
    return next(folder / name for folder in _FOLDERS if (folder / name).is_file())

"""Origins of pages that may show the viewer's page in a frame."""

import os
import re
from collections.abc import Iterable

from ravemj.errors import ArgumentError

VARIABLE = "RAVEMJ_EMBED"
"""Environment variable with additional origins, separated by blanks or commas."""

_ALWAYS = (
    "'self'",
    *(f"{scheme}://{name}:*" for name in ("localhost", "127.0.0.1") for scheme in ("http", "https")),
    "vscode-webview:",
)
_ORIGIN = re.compile(
    r"https?://(?:\*\.)?[a-z0-9](?:[a-z0-9-]*[a-z0-9])?(?:\.[a-z0-9](?:[a-z0-9-]*[a-z0-9])?)*"
    r"(?::(?P<port>\*|[1-9]\d{0,4}))?",
    re.IGNORECASE,
)
_LAST_PORT = 65535


def checked_origins(origins: str | Iterable[str], name: str = "embed") -> list[str]:
    """Check and return origins; ``*`` may replace the first label of the host, and the port.

    Args:
        origins: One or several origins.
        name: Name of the argument in errors.

    Raises:
        ArgumentError: one of them is not an origin.
    """
    checked = [origins] if isinstance(origins, str) else list(origins)
    for origin in checked:
        match = _ORIGIN.fullmatch(origin)
        port = match["port"] if match else None
        if match is None or (port not in (None, "*") and int(port) > _LAST_PORT):
            raise ArgumentError(
                f"{name}: is {origin!r}, and should be an origin, a scheme and a host without a path, "
                "such as https://lab.example:8443"
            )
    return checked


def origins_of_environment() -> list[str]:
    """Return the origins in the variable ``RAVEMJ_EMBED``.

    Raises:
        ArgumentError: one of them is not an origin.
    """
    return checked_origins(os.environ.get(VARIABLE, "").replace(",", " ").split(), VARIABLE)


def frame_ancestors(origins: Iterable[str]) -> str:
    """Return the directive of a Content-Security-Policy that permits these origins to embed the page."""
    return " ".join(("frame-ancestors", *dict.fromkeys((*_ALWAYS, *origins))))

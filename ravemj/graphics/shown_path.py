"""Paths of videos that notebooks display."""

from base64 import b64encode
from html import escape
from pathlib import Path

_TYPES = {".gif": "image/gif", ".webp": "image/webp", ".png": "image/png", ".mp4": "video/mp4"}
_MOST_BYTES = 10_000_000
"""Maximum size of a file to embed in a notebook; larger ones would make it slow, so that only the path is shown."""


class ShownPath(type(Path())):
    """The path of a video. As the result of a notebook cell it embeds the video."""

    def _repr_html_(self) -> str | None:
        """Return HTML for notebooks; None if the file is missing, too large, or of a type that browsers cannot show."""
        kind = _TYPES.get(self.suffix.lower())
        if kind is None or not self.is_file() or self.stat().st_size > _MOST_BYTES:
            return None
        source = f"data:{kind};base64,{b64encode(self.read_bytes()).decode()}"
        if kind.startswith("video"):
            return f'<video src="{source}" controls autoplay muted loop style="max-width: 100%"></video>'
        return f'<img src="{source}" alt="{escape(self.stem)}" style="max-width: 100%">'

    def __repr__(self) -> str:
        return repr(Path(self))

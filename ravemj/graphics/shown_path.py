"""Paths of videos, which notebooks show."""

from base64 import b64encode
from html import escape
from pathlib import Path

_TYPES = {".gif": "image/gif", ".webp": "image/webp", ".png": "image/png", ".mp4": "video/mp4"}
_MOST_BYTES = 10_000_000
"""A larger video would make a notebook slow; its path is shown instead."""


class ShownPath(type(Path())):
    """The path of a video. As the last line of a notebook's cell it shows the video, which is then in the notebook."""

    def _repr_html_(self) -> str | None:
        """Return what notebooks show; None for what browsers do not play, for large files and for missing ones."""
        kind = _TYPES.get(self.suffix.lower())
        if kind is None or not self.is_file() or self.stat().st_size > _MOST_BYTES:
            return None
        source = f"data:{kind};base64,{b64encode(self.read_bytes()).decode()}"
        if kind.startswith("video"):
            return f'<video src="{source}" controls autoplay muted loop style="max-width: 100%"></video>'
        return f'<img src="{source}" alt="{escape(self.stem)}" style="max-width: 100%">'

    def __repr__(self) -> str:
        return repr(Path(self))

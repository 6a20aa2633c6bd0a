"""Recognition of MJCF by its first tag: MuJoCo accepts text that strict XML parsers refuse."""

import re

_BEFORE = re.compile(rb"(?:\xef\xbb\xbf)?(?:\s++|<\?.*?\?>|<!--.*?-->|<!DOCTYPE[^>\[]*+>)*+", re.DOTALL)
_ROOT = re.compile(rb"<(?:mujoco|mujocoinclude)[\s/>]")


def is_mjcf(content: bytes) -> bool:
    """Return whether a file is MJCF, or a part of such a model."""
    start = _BEFORE.match(content)
    return _ROOT.match(content, start.end() if start else 0) is not None

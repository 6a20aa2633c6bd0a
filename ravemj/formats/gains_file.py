"""Files with servo gains: one line for each joint, or for a pattern of names."""

import fnmatch
import math
from collections.abc import Iterable
from typing import NamedTuple

from ravemj.core.output import AnyPath
from ravemj.errors import Source, SourceError
from ravemj.formats.openrave_xml.tree import content_of


class GivenGains(NamedTuple):
    """User-defined gains of joints.

    Attributes:
        pattern: Name of a joint, or a pattern with ``*`` and ``?``.
        kp: Stiffness [N m/rad or N/m].
        kv: Damping [N m s/rad or N s/m].
        source: Its line.
    """

    pattern: str
    kp: float
    kv: float
    source: Source


def read_gains(path: AnyPath) -> list[GivenGains]:
    """Read a file with lines ``joint, kp, kv``; ``#`` starts a comment.

    Raises:
        SourceError: it cannot be read, or a line is not of this form.
    """
    text = content_of(str(path)).decode("utf-8", "replace")
    gains: list[GivenGains] = []
    for number, line in enumerate(text.splitlines(), 1):
        source = Source(str(path), number)
        words = line.split("#")[0].rsplit("," if "," in line else None, 2)
        if not words or not "".join(words).strip():
            continue
        try:
            name, kp, kv = words[0].strip(), float(words[1]), float(words[2])
        except (ValueError, IndexError):
            raise SourceError(f"'{line.strip()}' is not 'joint, kp, kv'", source, "as in: elbow*, 300, 20") from None
        if not (math.isfinite(kp) and math.isfinite(kv) and kp > 0 and kv >= 0):
            raise SourceError(f"the gains {kp:g} and {kv:g} of '{name}' are not positive numbers", source)
        gains.append(GivenGains(name, kp, kv, source))
    return gains


def gains_of(name: str, given: Iterable[GivenGains]) -> GivenGains | None:
    """Return the last gains whose pattern matches the name of a joint, or None."""
    matching = [gains for gains in given if gains.pattern == name or fnmatch.fnmatchcase(name, gains.pattern)]
    return matching[-1] if matching else None


def check_used(given: Iterable[GivenGains], names: Iterable[str]) -> None:
    """Check that each pattern matches a joint.

    Raises:
        SourceError: a pattern matches none.
    """
    known = list(names)
    for gains in given:
        if not any(name == gains.pattern or fnmatch.fnmatchcase(name, gains.pattern) for name in known):
            hint = f"there are: {', '.join(known) or 'none'}"
            raise SourceError(f"no joint is called '{gains.pattern}'", gains.source, hint)

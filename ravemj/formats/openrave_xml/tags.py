"""Tables of tags: the reader function and the meaning of each tag.

The same tables drive the reader and make ``docs/coverage.md``. A tag that is in no table is unknown.
"""

from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

from ravemj.formats.openrave_xml.tree import Element

Target_contra = TypeVar("Target_contra", contravariant=True)

IGNORED = "OpenRAVE reads it and makes nothing of it"
NO_EFFECT_HERE = "it has no effect on the model"


class Tag(NamedTuple, Generic[Target_contra]):
    """A child element that the reader knows.

    Attributes:
        read: Function that reads the element into its parent's object.
        meaning: What the element means, or why it is left out, in a few words.
        left_out: Whether it has no effect on the model.
        once: Whether only the last one of an element counts, among all tags with this ``read``; or of this name.
    """

    read: Callable[[Target_contra, Element], None]
    meaning: str
    left_out: bool = False
    once: bool | str = False


def reasons(reason: str, *names: str) -> dict[str, str]:
    """Return a table that gives one reason for each name."""
    return dict.fromkeys(names, reason)

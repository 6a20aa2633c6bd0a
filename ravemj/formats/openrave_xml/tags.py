"""Tables of tags: the reader function and the meaning of each tag.

The reader and ``docs/coverage.md`` are based on these tables. A tag that is in no table is unknown.
"""

from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

from ravemj.formats.openrave_xml.tree import Element

Target_contra = TypeVar("Target_contra", contravariant=True)

IGNORED = "OpenRAVE reads it and makes nothing of it"
NO_EFFECT_HERE = "it has no effect on the model"


class Tag(NamedTuple, Generic[Target_contra]):
    """A child element that the reader supports.

    Attributes:
        read: Function that reads the element into its parent's object.
        meaning: Meaning of the element, or the reason why it is ignored, in a few words.
        left_out: Whether it has no effect on the model.
        once: True if only the last of all elements with this ``read`` is used; a name if only the last of all elements
            with this name as ``once`` is used.
    """

    read: Callable[[Target_contra, Element], None]
    meaning: str
    left_out: bool = False
    once: bool | str = False


def reasons(reason: str, *names: str) -> dict[str, str]:
    """Return a table that gives one reason for each name."""
    return dict.fromkeys(names, reason)

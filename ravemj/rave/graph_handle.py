"""Handles of drawings."""

from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform
from ravemj.core.handles import Handle
from ravemj.model.drawing import Drawings, Primitives


class GraphHandle(Handle):
    """The handle of a drawing, which vanishes with the last reference to it: keep it while the drawing should show.

    Example:
        >>> handle = env.plot3([0, 0, 1], 8)
        >>> handle.SetShow(False)
        >>> handle = None  # gone
    """

    def __init__(self, drawings: Drawings, primitives: Primitives, text: str = "") -> None:
        key, self._drawing = drawings.add(primitives, text)
        super().__init__(drawings.remove, key)

    def SetTransform(self, transform: ArrayLike) -> None:
        """Place the drawing.

        Args:
            transform: ``T_world_drawing``, where the frame goes in which the drawing was made: 4x4 or 3x4, or a pose
                [w, x, y, z, tx, ty, tz]. Every call starts from what was drawn first.

        Raises:
            ArgumentError: this is no rigid transform.
        """
        self._drawing.place(checked_transform(transform, "SetTransform: transform"))

    def SetShow(self, show: bool) -> None:
        """Show the drawing, or hide it if ``show`` is False."""
        self._drawing.show(bool(show))

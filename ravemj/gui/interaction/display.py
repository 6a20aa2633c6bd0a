"""What is shown besides the bodies as they look."""

from collections.abc import Iterable


class Display:
    """What is switched on of a viewer; all of its views share it.

    Attributes:
        shown: Names of what is shown, of ``shortcuts``.
        changes: How often that has changed.
        wants_reload: Whether people have asked to read the model again; None where nobody would do it.
    """

    def __init__(self, shown: Iterable[str] = ()) -> None:
        self.shown = frozenset(shown)
        self.changes = 0
        self.wants_reload: bool | None = None

    def show(self, name: str, shown: bool = True) -> None:
        """Switch something on, or off."""
        self.shown = self.shown | {name} if shown else self.shown - {name}
        self.changes += 1

    def toggle(self, name: str) -> None:
        """Switch something on if it is off, and off if it is on."""
        self.show(name, name not in self.shown)

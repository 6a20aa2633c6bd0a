"""What is logged about those who send nonsense."""

import logging

_LOG = logging.getLogger("ravemj")


class Rejections:
    """Logs each kind of trouble once, so that nobody can fill the log."""

    def __init__(self) -> None:
        self._known: set[str] = set()

    def __call__(self, kind: str, detail: object = "") -> None:
        """Log a kind of trouble, unless it was logged before.

        Args:
            kind: One of a few texts of ours.
            detail: What others sent; the log shows the beginning of its ``repr``.
        """
        if kind not in self._known:
            self._known.add(kind)
            _LOG.warning("viewer's page: %s%s (further cases are not logged)", kind, detail and f": {detail!r:.80}")

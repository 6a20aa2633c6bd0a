"""Progress bar on standard error."""

import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager


@contextmanager
def progress_bar(task: str, total: float, unit: str = "") -> Generator[Callable[[float], None]]:
    """Show a progress bar if standard error is a terminal.

    Args:
        task: Description of the task.
        total: Total amount of work.
        unit: The unit of ``total``.

    Yields:
        A function that sets the amount of finished work.
    """
    if not sys.stderr.isatty():
        yield lambda done: None
        return
    from rich import progress as bars  # noqa: PLC0415 - slow to import
    from rich.console import Console  # noqa: PLC0415

    columns = (
        bars.TextColumn("{task.description}"),
        bars.BarColumn(),
        bars.MofNCompleteColumn(),
        bars.TextColumn(unit),
        bars.TimeRemainingColumn(),
    )
    with bars.Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        number = bar.add_task(task, total=total)
        yield lambda done: bar.update(number, completed=done)

"""Console output of the commands: errors, warnings, tables and progress."""

import contextlib
import os
import re
import sys
import warnings
from collections.abc import Callable, Generator, Iterable, Sequence
from typing import TYPE_CHECKING, TextIO

from ravemj.core.progress import progress_bar
from ravemj.core.signals import on_signal
from ravemj.errors import Diagnostic, RavemjError, RavemjWarning, Source, SourceError

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

_LEAST_WIDTH = 100
_PLACES = 4
_WITHOUT_BAR = b"\r\x1b[2K\x1b[?25h"  # erases a line of a terminal, and shows the cursor again


def print_error(error: RavemjError) -> None:
    """Print an error in one line."""
    text = str(error) if isinstance(error, SourceError) else f"ravemj: error: {error.message}"
    print(" ".join(text.split()), file=sys.stderr)


def print_findings(findings: Iterable[Diagnostic], file: TextIO | None = None) -> None:
    """Print diagnostics; diagnostics that differ only in sources or names share a line.

    Args:
        findings: The diagnostics.
        file: Output stream; None: standard error.
    """
    groups: dict[tuple[str, str], list[Diagnostic]] = {}
    for finding in findings:
        text = finding.message if finding.severity == "error" else re.sub("'[^']*'", "''", finding.message)
        groups.setdefault((finding.code, text), []).append(finding)
    for first, *others in groups.values():
        places = list(dict.fromkeys(_place(other.source, first.source) for other in others))
        line = f"{first}{_more(len(others), places)}"
        print(" ".join(line.split()), file=file or sys.stderr)


def _more(count: int, places: Sequence[str]) -> str:
    """Return a text such as `` (and 3 more: …)`` with the sources of further diagnostics; empty if there are none."""
    if not count:
        return ""
    rest = ["…"] if len(places) > _PLACES else []
    return f" (and {count} more: {', '.join([*places[:_PLACES], *rest])})"


def _place(source: Source, first: Source) -> str:
    return f"line {source.line}" if source.file == first.file else str(source)


@contextlib.contextmanager
def show_warnings_in_one_line() -> Generator[None]:
    """Print each warning of ravemj once, in one line with file and line number, as compilers do."""
    with warnings.catch_warnings():
        warnings.simplefilter("default", RavemjWarning)
        before = warnings.showwarning

        def show(message: Warning | str, category: type[Warning], *place: object) -> None:
            if isinstance(message, RavemjWarning):
                print(message, file=sys.stderr)
            else:
                before(message, category, *place)  # pyright: ignore[reportArgumentType]

        warnings.showwarning = show
        yield


def table(title: str, *columns: str) -> "Table":
    """Return an empty table; columns whose name ends with ``>`` are numbers."""
    from rich import box  # noqa: PLC0415 - slow to import
    from rich.table import Table  # noqa: PLC0415

    made = Table(title=title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for column in columns:
        made.add_column(column.rstrip(">"), justify="right" if column.endswith(">") else "left", overflow="fold")
    return made


def console() -> "Console":
    """Return rich's console for standard output; for files and pipes it is wide enough for tables."""
    from rich.console import Console  # noqa: PLC0415 - slow to import

    made = Console(highlight=False, markup=False)  # names may have brackets
    if not made.is_terminal:
        made.width = max(made.width, _LEAST_WIDTH)
    return made


@contextlib.contextmanager
def progress(task: str, total: float, unit: str = "frames") -> Generator[Callable[[float], None]]:
    """Show a ``progress_bar``, and remove it if a signal ends the command."""
    restoring = (
        on_signal(lambda: os.write(sys.stderr.fileno(), _WITHOUT_BAR))
        if sys.stderr.isatty()
        else contextlib.nullcontext()
    )
    with restoring, progress_bar(task, total, unit) as update:
        yield update

"""Sources (places in files), diagnostics and exceptions.

::

    RavemjError                 also called openrave_exception
    ├── SourceError             .source .hint: a file that cannot be read as a model
    │   ├── LimitError          the model is too large to be read
    │   └── CompileError        MuJoCo refuses the translated model
    ├── ArgumentError           a wrong argument of a call
    ├── OutputError             also an OSError: a file that cannot be written
    ├── RenderingError          no picture can be drawn
    └── UnsupportedError        also a NotImplementedError: ravemj lacks .capability

    RavemjWarning               .code .diagnostic: read, but perhaps not as its author intended
"""

import os
import re
import sys
import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import Literal, NamedTuple


class ErrorCode(IntEnum):
    """OpenRAVE's error codes; ``openrave_exception.GetCode()`` returns their names."""

    Failed = 0
    InvalidArguments = 1
    EnvironmentNotLocked = 2
    CommandNotSupported = 3
    Assert = 4
    InvalidPlugin = 5
    InvalidInterfaceHash = 6
    NotImplemented = 7
    InconsistentConstraints = 8
    NotInitialized = 9
    InvalidState = 10
    Timeout = 11
    InvalidURI = 12
    BodyNameConflict = 13
    SensorNameConflict = 14
    BodyIdConflict = 15

    __str__ = Enum.__str__  # class and name, as those of OpenRAVE

    @classmethod
    def _missing_(cls, value: object) -> None:
        raise ValueError(f"ErrorCode: value: is {value!r}, and should be from 0 to {max(cls):d}")


class Source(NamedTuple):
    """Position in a file.

    Attributes:
        file: Path of the file, as given by the user or the including file.
        line: Line number, from 1; 0 means the whole file.
        included_from: Position of the element that included the file; None for the loaded file.
    """

    file: str
    line: int = 0
    included_from: "Source | None" = None

    def __str__(self) -> str:
        return f"{self.file}:{self.line}" if self.line else self.file

    def chain(self) -> str:
        """Return this position and those of the elements that included it, innermost first, as text."""
        if self.included_from is None:
            return str(self)
        return f"{self} (included from {self.included_from.chain()})"


class Origin(Source):
    """Position in a file from which a model was converted; ``included_from`` is in the converted file."""


class RavemjError(Exception):
    """Base class of ravemj's exceptions; OpenRAVE scripts know it as ``openrave_exception``."""

    _code = ErrorCode.Failed

    def __init__(self, message: str, code: ErrorCode | None = None) -> None:
        super().__init__(message)
        self._message = message
        if code is not None:
            self._code = code

    @property
    def message(self) -> str:
        """Description of the error."""
        return self._message

    @property
    def errortype(self) -> ErrorCode:  # OpenRAVE's name
        """OpenRAVE's code for this kind of error."""
        return self._code

    def __str__(self) -> str:
        return f"{self.message} ({self._code.name})"

    def GetCode(self) -> str:  # noqa: N802 - OpenRAVE's name
        """Return the name of OpenRAVE's code for this kind of error, for instance ``InvalidArguments``."""
        return self._code.name


_LONG_QUOTATION = re.compile("'([^']{80})[^']{2,}'")
_LONGEST = 2000  # characters of a message


def shortened(message: str) -> str:
    """Return a message with long quotations shortened, since a damaged file may cause megabytes."""
    message = _LONG_QUOTATION.sub(r"'\1…'", message)
    return message if len(message) <= _LONGEST else f"{message[: _LONGEST // 2]} … {message[-_LONGEST // 2 :]}"


_CAUSES = {"missing-file", "broken-file", "unsupported-file", "bad-number"}


class SourceError(RavemjError):
    """A file cannot be read as a model.

    Attributes:
        source: The position in the file.
        hint: Advice for the author of the file; may be empty.
        diagnostics: Earlier diagnostics of the reading, which may explain the failure.
    """

    def __init__(self, message: str, source: Source, hint: str = "") -> None:
        super().__init__(shortened(message))
        self.source = source
        self.hint = shortened(hint)
        self.diagnostics: tuple[Diagnostic, ...] = ()

    def __str__(self) -> str:
        return describe("error", self.message, self.source, self.hint)

    @property
    def cause(self) -> "Diagnostic | None":
        """The diagnostic of a file or a number that explains the failure, at its source or in a file included there."""
        here = self.source[:2]
        explaining = (finding for finding in self.diagnostics if finding.code in _CAUSES)
        return next((finding for finding in explaining if here in _places(finding.source)), None)


class LimitError(SourceError):
    """A model is larger than ravemj reads; the message states its size and the limit."""


class UnnamedError(SourceError):
    """A body has no name; OpenRAVE's ``LoadData`` then raises, but returns False for other errors (gap-18)."""


class ManipulatorError(SourceError):
    """A joint of a manipulator does not move its effector; the robot is loaded nevertheless (gap-10, gap-39)."""


class CompileError(SourceError):
    """MuJoCo rejects the translated model; ``source`` is the element that causes it."""


class ArgumentError(RavemjError):
    """An argument has a wrong length, value or type."""

    _code = ErrorCode.InvalidArguments


class OutputError(RavemjError, OSError):
    """A file or folder cannot be written."""

    def __str__(self) -> str:
        return self.message


class RenderingError(RavemjError):
    """No picture can be drawn; the message states causes and remedies."""

    def __str__(self) -> str:
        return self.message


class UnsupportedError(RavemjError, NotImplementedError):
    """A script uses a name of OpenRAVE that ravemj does not support.

    Attributes:
        capability: The missing feature, for instance ``inverse kinematics``.
    """

    _code = ErrorCode.NotImplemented

    def __init__(self, name: str, capability: str, code: ErrorCode | None = None) -> None:
        super().__init__(f"{name}: ravemj does no {capability} yet", code)
        self.capability = capability


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """A problem found in a file that could be read nevertheless.

    Attributes:
        severity: ``error`` if OpenRAVE's ``Load`` returns False although the bodies exist; ``note`` for information
            that only commands print.
        code: Stable name of the kind of problem, for instance ``unknown-tag``.
        message: The problem, and how it was handled.
        source: The position in the file.
        hint: Advice for the author of the file; may be empty.
    """

    severity: Literal["error", "warning", "note"]
    code: str
    message: str
    source: Source
    hint: str = ""

    def __str__(self) -> str:
        return describe(f"{self.severity}[{self.code}]", self.message, self.source, self.hint)


class RavemjWarning(UserWarning):
    """Diagnostics of one code, sent through Python's ``warnings``; filter on this class.

    Attributes:
        diagnostic: The first one.
        diagnostics: All of this code from one reading, including the first one.
    """

    def __init__(self, diagnostic: Diagnostic, *others: Diagnostic) -> None:
        super().__init__(f"{diagnostic}{_and_others(diagnostic, others)}")
        self.diagnostic = diagnostic
        self.diagnostics = (diagnostic, *others)

    @property
    def code(self) -> str:
        """Stable name of the kind of problem."""
        return self.diagnostic.code


class Diagnostics:
    """The diagnostics of one reading or translation, in order of time."""

    def __init__(self) -> None:
        self._found: list[Diagnostic] = []

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def add(self, diagnostic: Diagnostic) -> None:
        """Append a diagnostic."""
        self._found.append(diagnostic)

    def warn(self, code: str, message: str, source: Source, hint: str = "") -> None:
        """Record a problem that OpenRAVE ignores or only logs."""
        self._found.append(Diagnostic("warning", code, shortened(message), source, shortened(hint)))

    def note(self, code: str, message: str, source: Source, hint: str = "") -> None:
        """Record useful information that requires no change."""
        self._found.append(Diagnostic("note", code, shortened(message), source, shortened(hint)))

    def error(self, code: str, message: str, source: Source, hint: str = "") -> None:
        """Record a problem for which OpenRAVE's ``Load`` returns False, although it continues."""
        self._found.append(Diagnostic("error", code, shortened(message), source, shortened(hint)))


def _places(source: Source | None) -> Iterator[tuple[str, int]]:
    """Yield file and line of a position and of the elements that included it."""
    while source is not None:
        yield source.file, source.line
        source = source.included_from


def describe(kind: str, message: str, source: Source, hint: str) -> str:
    """Format a diagnostic like compilers: ``file:line: kind: message``."""
    tail = f"; {hint}" if hint else ""
    included = f" (included from {source.included_from.chain()})" if source.included_from else ""
    return f"{source}: {kind}: {message}{tail}{included}"


def _and_others(first: Diagnostic, others: Sequence[Diagnostic]) -> str:
    """Return a text about further diagnostics: their number, the first sources, and the command that lists all."""
    if not others:
        return ""
    file = first.source.file
    sources = [other.source for other in others]
    listed = list(dict.fromkeys(f"line {at.line}" if at.file == file else str(at) for at in sources))
    shown = ", ".join([*listed[:_PLACES], *(["…"] if len(listed) > _PLACES else [])])
    loaded = first.source
    while loaded.included_from is not None:
        loaded = loaded.included_from
    return f" (and {len(others)} more [{first.code}]: {shown}; `ravemj check {loaded.file}` lists them all)"


def send_warnings(diagnostics: Iterable[Diagnostic]) -> None:
    """Send diagnostics other than notes through Python's ``warnings``, one warning for each code."""
    by_code: dict[str, list[Diagnostic]] = {}
    for diagnostic in diagnostics:
        if diagnostic.severity == "note":
            continue
        by_code.setdefault(diagnostic.code, []).append(diagnostic)
    for findings in by_code.values():
        send_warning(*findings)


def send_warning(diagnostic: Diagnostic, *others: Diagnostic) -> None:
    """Send diagnostics of one code through Python's ``warnings``; the warning points at the user's line.

    The registry with which ``warnings`` shows each text once is kept here, with a limited size: a million values
    outside limits would be a million texts.
    """
    frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage] - what warnings.warn does
    while frame.f_code.co_filename.startswith(_PACKAGE) and frame.f_back is not None:
        frame = frame.f_back
    if len(_shown) > _MOST_SHOWN:
        _shown.clear()
    place = frame.f_code.co_filename, frame.f_lineno, frame.f_globals.get("__name__")
    warnings.warn_explicit(RavemjWarning(diagnostic, *others), None, *place, registry=_shown)  # pyright: ignore


_PACKAGE = os.path.join(os.path.dirname(__file__), "")  # where no line of a user stands
_PLACES = 3
_MOST_SHOWN = 1000
_shown: dict[str | tuple[str, type[Warning], int], int] = {}

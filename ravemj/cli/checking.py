"""Findings about a model file: those of the reader and of the translation, and more."""

import os
import warnings
from collections.abc import Iterator
from typing import Literal, NamedTuple

from ravemj.errors import Diagnostic, RavemjError, RavemjWarning, Source, SourceError, describe
from ravemj.model.builder import DEFAULT_INERTIAL
from ravemj.model.scene import KinBody
from ravemj.rave import load

Severity = Literal["error", "warning", "note"]

FATAL_CODES = {"bad-number"}
"""Codes of findings that OpenRAVE overlooks and commands refuse: nobody means the number that OpenRAVE reads there."""


class Finding(NamedTuple):
    """Something about a model file that its author wants to know.

    Attributes:
        severity: ``error`` where the model does not load as it is written; ``note`` for what is only good to know.
        code: Stable name of the kind of finding; ``fatal`` for what ends the reading.
        message: What was found and what is made of it.
        source: The place in the file.
        hint: What to do about it; may be empty.
    """

    severity: Severity
    code: str
    message: str
    source: Source
    hint: str = ""

    def __str__(self) -> str:
        return describe(f"{self.severity}[{self.code}]", self.message, self.source, self.hint)


def check(path: str | os.PathLike[str]) -> list[Finding]:
    """Return all findings about a model file, in the order in which they are met.

    Args:
        path: An OpenRAVE XML file. Its mistakes become findings, never exceptions.

    Example:
        >>> from ravemj.cli.checking import check
        >>> check("models/env.xml")
        []
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RavemjWarning)
            env = load(path)
    except SourceError as error:
        return [*map(_finding, error.diagnostics), _fatal(error)]
    except RavemjError as error:
        return [Finding("error", "fatal", error.message, Source(os.fspath(path)))]
    notes = [note for body in env.simulation.bodies for note in _default_masses(body.scene)]
    return [*map(_finding, env.diagnostics), *notes]


def _finding(found: Diagnostic) -> Finding:
    severity = "error" if found.code in FATAL_CODES else found.severity
    return Finding(severity, found.code, found.message, found.source, found.hint)


def _fatal(error: SourceError) -> Finding:
    cause = error.cause
    hint = error.hint if cause is None else f"that comes of the {cause.code} above"
    return Finding("error", "fatal", error.message, error.source, hint)


def _default_masses(body: KinBody) -> Iterator[Finding]:
    """Yield a note for each moving link that has OpenRAVE's mass, since the file gives none."""
    for link in body.links:
        if link.inertial is DEFAULT_INERTIAL and not link.static:
            message = "a Body without a <Mass> weighs 1 kg, with the inertia of a sphere of 1 m"
            hint = 'write <Mass type="mimicgeom"> with its <density>'
            yield Finding("note", "default-mass", message, link.source, hint)

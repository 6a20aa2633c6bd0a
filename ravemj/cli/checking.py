"""Collection of all diagnostics of a model file: of reading, of the translation to MJCF, and of further checks."""

import os
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import replace

from ravemj.errors import Diagnostic, RavemjError, RavemjWarning, Source, SourceError
from ravemj.formats.file_access import is_inside
from ravemj.formats.urdf.xacro import SUFFIX as XACRO
from ravemj.model.builder import DEFAULT_INERTIAL
from ravemj.model.scene import KinBody
from ravemj.rave import load

FATAL_CODES = {"bad-number"}
"""Codes of diagnostics that commands treat as errors, although OpenRAVE tolerates them: a number was misread."""


def check(path: str | os.PathLike[str], given: Mapping[str, str] | None = None) -> list[Diagnostic]:
    """Return all diagnostics of a model file, in order of occurrence.

    Args:
        path: A model file. Its mistakes become diagnostics, never exceptions.
        given: Attributes by name, such as ``prefix``, as the argument ``atts`` of ``Environment.Load``.

    Example:
        >>> from ravemj.cli.checking import check
        >>> check("models/env.xml")
        []
    """
    if os.fspath(path).lower().endswith(XACRO):
        hint = "write the URDF with ravemj[xacro] or ROS (xacro FILE > robot.urdf), and check that"
        return [Diagnostic("error", "fatal", "a xacro is not expanded here", Source(os.fspath(path)), hint)]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RavemjWarning)
            env = load(path, given)
    except SourceError as error:
        return [*map(_finding, error.diagnostics), _fatal(error)]
    except RavemjError as error:
        return [Diagnostic("error", "fatal", error.message, Source(os.fspath(path)))]
    notes = [note for body in env.simulation.bodies for note in _default_masses(body.scene)]
    return [*map(_finding, env.diagnostics), *_outside_files(path, env.named_files), *notes]


def _finding(diagnostic: Diagnostic) -> Diagnostic:
    return replace(diagnostic, severity="error") if diagnostic.code in FATAL_CODES else diagnostic


def _fatal(error: SourceError) -> Diagnostic:
    cause = error.cause
    hint = error.hint if cause is None else f"that comes of the {cause.code} above"
    return Diagnostic("error", "fatal", error.message, error.source, hint)


def _outside_files(path: str | os.PathLike[str], named: Mapping[str, Source]) -> Iterator[Diagnostic]:
    """Yield a note for each referenced file outside the model's folder, as it may be missing on other machines."""
    folder = os.path.dirname(os.path.abspath(path))
    if os.fspath(path).lower().endswith(".urdf"):
        folder = os.path.dirname(folder)  # packages have a folder for URDF, and others beside it for meshes
    for file, source in named.items():
        if not is_inside(os.path.abspath(file), folder):
            message = f"the model reads '{os.path.normpath(file)}', outside of its folder"
            yield Diagnostic(
                "note", "outside-file", message, source, "copy it into that folder if the model is to move"
            )


def _default_masses(body: KinBody) -> Iterator[Diagnostic]:
    """Yield a note for each moving link with OpenRAVE's default mass because the file gives none."""
    for link in body.links:
        if link.inertial is DEFAULT_INERTIAL and not link.static:
            message = "a Body without a <Mass> weighs 1 kg, with the inertia of a sphere of 1 m"
            hint = 'write <Mass type="mimicgeom"> with its <density>'
            yield Diagnostic("note", "default-mass", message, link.source, hint)

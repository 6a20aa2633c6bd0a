"""The command ``convert``."""

import argparse
import os
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path

from ravemj.cli.argument_types import TO_STANDARD_OUTPUT
from ravemj.cli.console import print_findings
from ravemj.cli.models import failure_of, load_model
from ravemj.engine.export import is_folder, marked, translate, write_file, write_folder
from ravemj.errors import Diagnostic, Diagnostics, OutputError, RavemjWarning
from ravemj.formats.mjcf import Options
from ravemj.rave import Environment
from ravemj.rave.env.saving import SUFFIXES

_MJCF_ENDS = (".xml", ".mjcf")


def convert(options: argparse.Namespace) -> int:
    """Translate a model to MJCF, or write it as COLLADA, OpenRAVE XML or JSON."""
    kind = options.format or _format_of(options.output)
    env = load_model(options)
    if kind != "mjcf":
        return _save(env, options, kind)
    found = Diagnostics()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RavemjWarning)
        mjcf = translate(
            env.simulation, found, Options(options.base == "openrave", options.actuators, options.decompose)
        )
    _report([finding for finding in found if finding not in env.diagnostics], options)
    if options.output == TO_STANDARD_OUTPUT:
        if mjcf.assets:
            raise OutputError("the model has meshes, which standard output cannot take; write -o FOLDER")
        sys.stdout.buffer.write(marked(mjcf.text, options.model).encode())  # UTF-8, as in a file, on any terminal
        return 0
    write = write_folder if is_folder(options.output) else write_file
    written = write(options.output, options.model, mjcf, env.files)
    print(f"wrote {os.fspath(written)}{_meshes(len(mjcf.assets))}")
    return 0


def _format_of(output: str) -> str:
    """Return the format that the name of a target stands for.

    Raises:
        OutputError: the name has another suffix.
    """
    if output != TO_STANDARD_OUTPUT and not is_folder(output):
        known = {end: form for form, ends in {**SUFFIXES, "mjcf": _MJCF_ENDS}.items() for end in ends}
        form = next((form for end, form in known.items() if output.lower().endswith(end)), None)
        if form is None:
            ends = ", ".join(end for end in known if end.count(".") == 1)
            reason = f"'{Path(output).suffix}' is none of {ends}, a folder (no suffix or a final /)"
            raise OutputError(f"cannot write {output}: {reason}; --format chooses a format for any name")
        return form
    return "mjcf"


def _save(env: Environment, options: argparse.Namespace, kind: str) -> int:
    """Write a model in one of OpenRAVE's formats."""
    if options.output == TO_STANDARD_OUTPUT:
        raise OutputError(f"a model in the format {kind} needs a file; write -o FILE")
    if options.base != "fixed" or options.actuators or options.decompose:
        raise OutputError("--base, --actuators and --decompose are for MJCF; leave them out")
    if any(Path(file).exists() and Path(options.output).resolve() == Path(file).resolve() for file in env.files):
        raise OutputError(f"cannot write {options.output}: the model was read from it")
    found = Diagnostics()
    env.write(options.output, env.SelectionOptions.Everything, {"format": kind, "meshes": options.meshes}, found)
    _report([*found], options)
    print(f"wrote {options.output}")
    return 0


def _report(findings: Sequence[Diagnostic], options: argparse.Namespace) -> None:
    """Print findings; with ``--strict`` they are errors."""
    if findings and options.strict:
        raise failure_of(findings)
    print_findings(findings)


def _meshes(count: int) -> str:
    if not count:
        return ""
    return f" and {count} mesh{'es' if count > 1 else ''} in assets/ beside it"

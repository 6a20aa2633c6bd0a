"""The command ``convert``."""

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from ravemj.cli.argument_types import TO_STANDARD_OUTPUT
from ravemj.cli.console import print_findings
from ravemj.cli.models import failure_of, load_model
from ravemj.engine import sim_check
from ravemj.engine.export import is_folder, marked, write
from ravemj.engine.translation import TranslationChoices, translated
from ravemj.errors import Diagnostic, Diagnostics, OutputError
from ravemj.formats.suffixes import SUFFIXES, format_of
from ravemj.rave import Environment


def convert(options: argparse.Namespace) -> int:
    """Translate a model to MJCF, or write it as COLLADA, OpenRAVE XML or JSON."""
    kind = options.format or _format_of(options.output)
    env = load_model(options)
    if kind != "mjcf":
        return _save(env, options, kind)
    findings = Diagnostics()
    loose = tuple(sensor.description for sensor in env.GetSensors() if sensor.attached is None)
    translation = translated(env.simulation, findings, choices_of(options), env.files[0], loose)
    _report([finding for finding in findings if finding not in env.diagnostics], options)
    mjcf = translation.mjcf
    if options.output == TO_STANDARD_OUTPUT:
        if mjcf.assets:
            raise OutputError("the model has meshes, which standard output cannot take; write -o FOLDER")
        sys.stdout.buffer.write(marked(mjcf.text, options.model).encode())  # UTF-8, as in a file, on any terminal
        return 0
    written = write(options.output, options.model, translation, env.files)
    print(f"wrote {os.fspath(written)}{_meshes(len(mjcf.assets))}")
    summary = sim_check.summary(translation)
    if summary:
        print(summary)
    return 0


def choices_of(options: argparse.Namespace) -> TranslationChoices:
    """Return the options of a translation to MJCF, given the options of a command."""
    return TranslationChoices(
        base=options.base,
        actuators=options.actuators,
        gains=options.gains,
        state=options.state,
        self_collision=options.self_collision == "on",
        exclude=options.exclude,
        decompose=options.decompose,
        hull_vertices=options.hull_vertices,
        merge_fixed=options.merge_fixed,
        sensors=options.sensors,
        append=options.append,
        timestep=options.timestep,
    )


def _format_of(output: str) -> str:
    """Return an output file's format by its suffix, MJCF for standard output and folders; raise if unknown."""
    if output == TO_STANDARD_OUTPUT or is_folder(output):
        return "mjcf"
    form = format_of(output)
    if form is None:
        ends = ", ".join(end for ends in SUFFIXES.values() for end in ends if end.count(".") == 1)
        reason = f"'{Path(output).suffix}' is none of {ends}, a folder (no suffix or a final /)"
        raise OutputError(f"cannot write {output}: {reason}; --format chooses a format for any name")
    return form


def _save(env: Environment, options: argparse.Namespace, kind: str) -> int:
    """Write a model in a format of OpenRAVE, not MJCF; return the exit code."""
    if options.output == TO_STANDARD_OUTPUT:
        raise OutputError(f"a model in the format {kind} needs a file; write -o FILE")
    if choices_of(options)._replace(state=None) != TranslationChoices():
        raise OutputError("--base, --actuators, --decompose and the like are for MJCF; leave them out")
    if any(Path(file).exists() and Path(options.output).resolve() == Path(file).resolve() for file in env.files):
        raise OutputError(f"cannot write {options.output}: the model was read from it")
    findings = Diagnostics()
    env.write(options.output, env.SelectionOptions.Everything, {"format": kind, "meshes": options.meshes}, findings)
    _report([*findings], options)
    print(f"wrote {options.output}")
    return 0


def _report(findings: Sequence[Diagnostic], options: argparse.Namespace) -> None:
    """Print diagnostics; with ``--strict``, raise them as errors instead."""
    if findings and options.strict:
        raise failure_of(findings)
    print_findings(findings)


def _meshes(count: int) -> str:
    if not count:
        return ""
    return f" and {count} mesh{'es' if count > 1 else ''} in assets/ beside it"

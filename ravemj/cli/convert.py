"""The command ``convert``."""

import argparse
import os
import sys
import warnings

from ravemj.cli.console import print_findings
from ravemj.cli.models import failure_of, load_model
from ravemj.engine.export import is_folder, marked, translate, write_file, write_folder
from ravemj.errors import Diagnostics, OutputError, RavemjWarning
from ravemj.formats.mjcf import Options

TO_STANDARD_OUTPUT = "-"


def convert(options: argparse.Namespace) -> int:
    """Translate a model to MJCF."""
    env = load_model(options)
    found = Diagnostics()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RavemjWarning)
        mjcf = translate(
            env.simulation, found, Options(options.base == "openrave", options.actuators, options.decompose)
        )
    more = [finding for finding in found if finding not in env.diagnostics]
    if more and options.strict:
        raise failure_of(more)
    print_findings(more)
    if options.output == TO_STANDARD_OUTPUT:
        if mjcf.assets:
            raise OutputError("the model has meshes, which standard output cannot take; write -o FOLDER")
        sys.stdout.buffer.write(marked(mjcf.text, options.model).encode())  # UTF-8, as in a file, on any terminal
        return 0
    write = write_folder if is_folder(options.output) else write_file
    written = write(options.output, options.model, mjcf, env.files)
    print(f"wrote {os.fspath(written)}{_meshes(len(mjcf.assets))}")
    return 0


def _meshes(count: int) -> str:
    if not count:
        return ""
    return f" and {count} mesh{'es' if count > 1 else ''} in assets/ beside it"

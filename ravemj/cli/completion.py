"""Completion of commands, options and models in shells."""

import argparse

from argcomplete.completers import FilesCompleter
from argcomplete.shell_integration import shellcode

from ravemj.formats.shipped import SHIPPED_MODELS


def completion(options: argparse.Namespace) -> int:
    """Print what a shell has to run."""
    print(shellcode(["ravemj"], shell=options.shell))
    return 0


def models(prefix: str, **_: object) -> list[str]:
    """Return the completions of the name of a model: models that come with ravemj, and files."""
    shipped = [name for name in SHIPPED_MODELS if name.startswith(prefix)]
    return [*shipped, *FilesCompleter(("xml", "dae", "zae"))(prefix)]

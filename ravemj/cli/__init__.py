"""The command line: ``ravemj COMMAND …``.

Results go to standard output, everything else to standard error. Exit codes: 0 done, 1 the input is bad or the output
cannot be written, 2 the command was not understood, 130 interrupted.
"""

import logging
import os
import re
import sys
from collections.abc import Sequence

from ravemj.cli.console import print_error, show_warnings_in_one_line
from ravemj.cli.parser import make_parser
from ravemj.errors import OutputError, RavemjError

__all__ = ["main"]

_VECTOR_OPTIONS = {"--to", "--q", "--background"}
_INTERRUPTED = 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command.

    Args:
        arguments: Words of the command line behind ``ravemj``; None: those of this process.

    Returns:
        The exit code.
    """
    logging.basicConfig(format="ravemj: %(message)s")
    options = make_parser().parse_args(_joined(sys.argv[1:] if arguments is None else arguments))
    try:
        with show_warnings_in_one_line():
            status = options.run(options)
        sys.stdout.flush()  # here, where its failure can be told
        return status
    except RavemjError as error:
        print_error(error)
        return 1
    except KeyboardInterrupt:
        print("ravemj: interrupted", file=sys.stderr)
        return _INTERRUPTED
    except OSError as error:
        _explain(error)
        return 1


def _explain(error: OSError) -> None:
    """Print an error of the operating system; one without a file is that of standard output."""
    reason = (error.strerror or str(error)).lower()
    if error.filename is not None:
        print_error(RavemjError(f"{error.filename}: {reason}"))
        return
    # Send the rest nowhere, so that Python does not complain at its end.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if not isinstance(error, BrokenPipeError):  # else the reader of our output is gone, for instance ``head``
        print_error(OutputError(f"cannot write standard output: {reason}"))


def _joined(words: Sequence[str]) -> list[str]:
    """Write ``--to -1,0`` as ``--to=-1,0``, since argparse takes what starts with a dash for an option."""
    joined: list[str] = []
    for word in words:
        if joined and joined[-1] in _VECTOR_OPTIONS and re.match(r"-([\d.]|inf|nan)", word, re.IGNORECASE):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined

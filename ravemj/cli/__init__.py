"""The command line: ``ravemj COMMAND …``.

Results go to standard output, everything else to standard error. Exit codes: 0 done, 1 the input is bad or the output
cannot be written, 2 the command was not understood, 128 + n ended by signal n: 130 by Ctrl-C.
"""

import errno
import logging
import os
import re
import signal
import sys
from collections.abc import Sequence

from ravemj.cli.console import print_error, show_warnings_in_one_line
from ravemj.cli.parser import make_parser
from ravemj.cli.streams import prepare_streams
from ravemj.core import signals
from ravemj.errors import OutputError, RavemjError

__all__ = ["main"]

_VECTOR_OPTIONS = {"--to", "--pose", "--q", "--background"}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command.

    Args:
        arguments: Words of the command line behind ``ravemj``; None: those of this process, whose standard streams are
            made ready for it.

    Returns:
        The exit code.
    """
    if arguments is None:
        prepare_streams()
    logging.basicConfig(format="ravemj: %(message)s")
    try:
        with show_warnings_in_one_line():
            return _run(sys.argv[1:] if arguments is None else arguments)
    except RavemjError as error:
        print_error(error)
        return 1
    except KeyboardInterrupt:
        print(signals.message(signal.SIGINT), file=sys.stderr)
        return 128 + signal.SIGINT
    except signals.Terminated as end:
        print(signals.message(end.number), file=sys.stderr)
        raise
    except OSError as error:
        _explain(error)
        return 1


def _run(arguments: Sequence[str]) -> int:
    parser = make_parser()
    if "_ARGCOMPLETE" in os.environ:  # a shell asks how the words go on, and takes no further output
        from argcomplete import autocomplete  # noqa: PLC0415 - only then

        autocomplete(parser)
    if not arguments:
        parser.print_help(sys.stderr)
        return 2
    try:
        options = parser.parse_args(_joined(arguments))
        return options.run(options)
    finally:
        signals.heed_signals()  # again, where the command has left them to a script
        sys.stdout.flush()  # here, where its failure can be told


def _explain(error: OSError) -> None:
    """Print an error of the operating system; one without a file is that of standard output."""
    reason = (error.strerror or str(error)).lower()
    if error.filename is not None:
        print_error(RavemjError(f"{error.filename}: {reason}"))
        return
    # Send the rest nowhere, so that Python does not complain at its end.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if not isinstance(error, BrokenPipeError):  # else the reader of our output is gone, for instance ``head``
        reason = "it is closed" if error.errno == errno.EBADF else reason
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

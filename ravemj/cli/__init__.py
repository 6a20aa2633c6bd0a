"""The command line: ``ravemj COMMAND …``.

Results go to standard output, everything else to standard error. Exit codes: 0 success, 1 invalid input or unwritable
output, 2 invalid command line, 128 + n termination by signal n, for instance 130 by Ctrl-C.
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
        arguments: Arguments after ``ravemj``; None: those of this process, whose standard streams are configured then.

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
    if "_ARGCOMPLETE" in os.environ:  # a request of shell completion, which accepts no other output
        from argcomplete import autocomplete  # noqa: PLC0415 - only then

        autocomplete(parser)
    if not arguments:
        parser.print_help(sys.stderr)
        return 2
    try:
        options = parser.parse_args(_joined(arguments))
        return options.run(options)
    finally:
        signals.heed_signals()  # again, since a script may have replaced the handlers
        sys.stdout.flush()  # here, where its failure can be reported


def _explain(error: OSError) -> None:
    """Print the message of an operating system error; if it names no file, it concerns standard output."""
    reason = (error.strerror or str(error)).lower()
    if error.filename is not None:
        print_error(RavemjError(f"{error.filename}: {reason}"))
        return
    # Send the rest nowhere, so that Python does not complain at its end.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if not isinstance(error, BrokenPipeError):  # else the reader of our output has exited, for instance ``head``
        reason = "it is closed" if error.errno == errno.EBADF else reason
        print_error(OutputError(f"cannot write standard output: {reason}"))


def _joined(words: Sequence[str]) -> list[str]:
    """Join ``--to -1,0`` to ``--to=-1,0``, since argparse interprets values with a leading dash as options."""
    joined: list[str] = []
    for word in words:
        if joined and joined[-1] in _VECTOR_OPTIONS and re.match(r"-([\d.]|inf|nan)", word, re.IGNORECASE):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined

"""The page of all commands, from their own help: ``docs/cli.md``."""

# argparse has no public way to look into a parser.
# pyright: reportPrivateUsage=false

import argparse
import sys
from collections.abc import Iterator
from typing import cast

from ravemj.cli.parser import make_parser

_HEAD = """\
# The command line

`scripts/docs` makes this page from the output of `ravemj COMMAND --help`; a test compares.

Commands write results to standard output and everything else to standard error, in ASCII where an encoding lacks
characters. Exit codes: 0 done; 1 the input is bad, or the output cannot be written; 2 the command was not understood;
128 + n a signal ended the command, as 130 for Ctrl-C and 143 for SIGTERM. Each mistake in a model is one line with file
and line number; `--strict` treats warnings as errors.

Files and folders that commands write appear whole or not at all. Until they are whole they are called
`.ravemj-….tmp`. If a process is killed, the next one that writes into the folder removes what it left.

| command | |
|---|---|
"""


def markdown() -> str:
    """Return the page."""
    commands = cast("argparse._SubParsersAction[argparse.ArgumentParser]", make_parser()._actions[-1])
    summaries = {choice.dest: choice.help or "" for choice in commands._choices_actions}
    index = [f"| [`{name}`](#ravemj-{name}) | {_cell(summary)} |\n" for name, summary in summaries.items()]
    pages = [_page(name, commands.choices[name]) for name in summaries]
    return _HEAD + "".join(index) + "".join(pages)


def _page(name: str, parser: argparse.ArgumentParser) -> str:
    words = [_metavar(action) for action in parser._actions if not action.option_strings]
    usage = " ".join(["ravemj", name, "[OPTION …]", *words])
    rows = [f"| {_label(action)} | {_cell(action.help or '')} |" for action in _arguments(parser)]
    table = ["| argument | |", "|---|---|", *rows, ""] if rows else []
    examples = [line.removeprefix("  ") for line in (parser.epilog or "").splitlines()[1:]]
    return "\n".join(
        [
            f"\n## ravemj {name}\n",
            f"{parser.description}\n",
            f"`{usage}`\n" if rows else f"`ravemj {name}`\n",
            *table,
            "```console",
            *examples,
            "```\n",
        ]
    )


def _arguments(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    return (action for action in parser._actions if not isinstance(action, argparse._HelpAction))


def _label(action: argparse.Action) -> str:
    if not action.option_strings:
        return f"`{_metavar(action)}`"
    value = "" if action.nargs == 0 else f" {_metavar(action)}"
    needed = ", needed" if action.required else ""
    return f"{', '.join(f'`{option}{value}`' for option in action.option_strings)}{needed}"


def _metavar(action: argparse.Action) -> str:
    if isinstance(action.metavar, str):
        return action.metavar + (" …" if action.nargs == "+" else "")
    return "{" + ",".join(map(str, action.choices or ())) + "}"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;")


if __name__ == "__main__":
    sys.stdout.write(markdown())

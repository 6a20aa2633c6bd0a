"""Generator of the command reference ``docs/cli.md`` from the help texts."""

# argparse has no public way to look into a parser.
# pyright: reportPrivateUsage=false

import argparse
import sys
from collections.abc import Iterator
from typing import cast

from ravemj.cli.parser import make_parser

_HEAD = """\
# The command line

<!-- scripts/docs makes this page from the help of the commands; a test compares. -->

`ravemj COMMAND --help` shows the same in a terminal.

| command | what it does |
|---|---|
"""


_RULES = """
Commands write results to standard output and everything else to standard error, in ASCII if the encoding of the
terminal lacks characters. Each mistake in a model is one line with file and line number; `--strict` treats warnings as
errors.

| exit code | meaning |
|---|---|
| 0 | the command has done its work |
| 1 | the input is wrong, or the output cannot be written |
| 2 | the command line is wrong |
| 128 + n | signal n has ended the command: 130 for Ctrl-C, 143 for SIGTERM |

A file or folder that a command writes appears as a whole or not at all. Meanwhile its name is `.ravemj-….tmp`. If a
process is killed, the next one that writes into the same folder removes such a file.
"""


def markdown() -> str:
    """Return the page as Markdown."""
    commands = cast("argparse._SubParsersAction[argparse.ArgumentParser]", make_parser()._actions[-1])
    summaries = {choice.dest: choice.help or "" for choice in commands._choices_actions}
    index = [f"| [`{name}`](#ravemj-{name}) | {_cell(summary)} |\n" for name, summary in summaries.items()]
    pages = [_page(name, commands.choices[name]) for name in summaries]
    return _HEAD + "".join(index) + _RULES + "".join(pages)


def _page(name: str, parser: argparse.ArgumentParser) -> str:
    words = [_metavar(action) for action in parser._actions if not action.option_strings]
    usage = " ".join(["ravemj", name, "[OPTION …]", *words])
    rows = [f"| {_label(action)} | {_cell(action.help or '')} |" for action in _arguments(parser)]
    table = ["| argument | meaning |", "|---|---|", *rows, ""] if rows else []
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
        return (
            f"[{action.metavar} …]" if action.nargs == "*" else action.metavar + (" …" if action.nargs == "+" else "")
        )
    return "{" + ",".join(map(str, action.choices or ())) + "}"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;")


if __name__ == "__main__":
    sys.stdout.write(markdown())

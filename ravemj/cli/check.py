"""The command ``check``."""

import argparse
import json
import os
import re
from collections import Counter
from collections.abc import Iterable, Sequence

from ravemj.checking import Finding, check
from ravemj.errors import Source

_PLACES = 4


def check_models(options: argparse.Namespace) -> int:
    """Report what is wrong or odd in models."""
    found: dict[tuple[object, ...], Finding] = {}  # a file that several models include is reported once
    for model in options.models:
        fresh = {key: finding for finding in check(model) if (key := _key(finding)) not in found}
        found.update(fresh)
        if not options.json:
            _print(fresh.values())
    counts = Counter(finding.severity for finding in found.values())
    if options.json:
        print(json.dumps([_entry(finding) for finding in found.values()], indent=2))
    else:
        files = _number(len(options.models), "file")
        print(f"{_number(counts['error'], 'error')}, {_number(counts['warning'], 'warning')} in {files}")
    return 1 if counts["error"] or (options.strict and counts["warning"]) else 0


def _key(finding: Finding) -> tuple[object, ...]:
    """Return what two reports of the same thing have in common, however the file was reached."""
    return os.path.realpath(finding.source.file), finding.source.line, finding.code, finding.message


def _print(findings: Iterable[Finding]) -> None:
    """Print findings, one line for those that say the same of several places or names."""
    groups: dict[tuple[str, str], list[Finding]] = {}
    for finding in findings:
        text = finding.message if finding.severity == "error" else re.sub("'[^']*'", "''", finding.message)
        groups.setdefault((finding.code, text), []).append(finding)
    for first, *others in groups.values():
        print(" ".join(f"{first}{_also(first, others)}".split()))


def _also(first: Finding, others: Sequence[Finding]) -> str:
    """Say how many others there are, and where."""
    if not others:
        return ""
    places = list(dict.fromkeys(_place(other.source, first.source) for other in others))
    more = [] if len(places) <= _PLACES else ["…"]
    return f" (and {len(others)} more: {', '.join([*places[:_PLACES], *more])})"


def _place(source: Source, first: Source) -> str:
    return f"line {source.line}" if source.file == first.file else str(source)


def _number(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _entry(finding: Finding) -> dict[str, object]:
    """Return a finding as JSON has it; these keys stay."""
    return {
        "file": finding.source.file,
        "line": finding.source.line or None,
        "code": finding.code,
        "severity": finding.severity,
        "message": finding.message,
        "hint": finding.hint or None,
        "included_from": _json_source(finding.source.included_from),
    }


def _json_source(source: Source | None) -> dict[str, object] | None:
    if source is None:
        return None
    return {"file": source.file, "line": source.line, "included_from": _json_source(source.included_from)}

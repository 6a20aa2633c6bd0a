"""The command ``check``."""

import argparse
import json
import os
import sys
from collections import Counter

from ravemj.cli import checking
from ravemj.cli.console import print_findings
from ravemj.cli.models import given, model_file
from ravemj.errors import Diagnostic, Source


def check(options: argparse.Namespace) -> int:
    """Report errors and warnings about models."""
    if options.self or options.write_srdf is not None:
        from ravemj.cli.self_collisions import check as check_self  # noqa: PLC0415 - rarely wanted

        touching = sum(check_self(options, model) for model in options.models)
        return 1 if touching and options.strict else 0
    if options.sim:
        from ravemj.cli.sim_checks import check as check_sim  # noqa: PLC0415 - rarely wanted

        return check_sim(options)
    reported: dict[tuple[object, ...], Diagnostic] = {}  # a file that several models include is reported once
    for model in options.models:
        findings = checking.check(model_file(model), given(options))
        fresh = {key: finding for finding in findings if (key := _key(finding)) not in reported}
        reported.update(fresh)
        if not options.json:
            print_findings(fresh.values(), sys.stdout)
    counts = Counter(finding.severity for finding in reported.values())
    if options.json:
        print(json.dumps([_entry(finding) for finding in reported.values()], indent=2))
    else:
        files = _number(len(options.models), "file")
        print(f"{_number(counts['error'], 'error')}, {_number(counts['warning'], 'warning')} in {files}")
    return 1 if counts["error"] or (options.strict and counts["warning"]) else 0


def _key(finding: Diagnostic) -> tuple[object, ...]:
    """Return a key that is equal for diagnostics of the same problem, however the file's path is written."""
    return os.path.realpath(finding.source.file), finding.source.line, finding.code, finding.message


def _number(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _entry(finding: Diagnostic) -> dict[str, object]:
    """Return a diagnostic as JSON data; the keys are stable."""
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

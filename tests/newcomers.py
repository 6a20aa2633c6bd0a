"""What newcomers read around a run: what this machine cannot test, before; what came of it, after.

``conftest`` hands these hooks to pytest.
"""

from collections import Counter
from collections.abc import Iterator

import pytest
from agreement import NEEDS_THE_CORPUS
from browsers import NEEDS_A_BROWSER
from screens import NEEDS_A_SCREEN

from ravemj.graphics.rendering.contexts import GL_BACKENDS, RAY, requested_backend
from ravemj.graphics.rendering.doctor import probe


def pytest_report_header() -> list[str]:
    """Say what this machine cannot test, and why."""
    parts = {"windows": NEEDS_A_SCREEN, "pages in browsers": NEEDS_A_BROWSER, "published models": NEEDS_THE_CORPUS}
    gaps = {name: next(_reasons(marks), "") for name, marks in parts.items()}
    lines = [f"cannot test {name} here: {reason}" for name, reason in {"OpenGL": _no_gl(), **gaps}.items() if reason]
    return lines or ["everything can be tested here"]


def _reasons(marks: list[pytest.MarkDecorator]) -> Iterator[str]:
    return (mark.kwargs["reason"] for mark in marks if mark.name == "skipif" and mark.args[0])


def _no_gl() -> str:
    """Say why no backend draws with OpenGL, so that rays do; nothing where one does."""
    if requested_backend() == RAY:
        return "MUJOCO_GL chooses rays"
    reports = []
    for backend in GL_BACKENDS:
        reports.append(probe(backend))
        if reports[-1].works:
            return ""
    return f"{reports[0].detail}, so rays draw: {reports[0].install}"


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_terminal_summary(terminalreporter, exitstatus, config):
    """Say why tests were skipped and, last, what came of a run of all."""
    stats = {name: len(reports) for name, reports in terminalreporter.stats.items()}
    skipped = terminalreporter.stats.get("skipped", ())
    reasons = Counter(report.longrepr[2].removeprefix("Skipped: ") for report in skipped)
    if reasons:
        terminalreporter.section("skipped tests, by reason")
    for reason, count in reasons.most_common():
        terminalreporter.line(f"{count:5} {reason}")
    yield
    options = config.option
    is_whole = config.args_source is config.ArgsSource.TESTPATHS and options.markexpr == "not stress"
    if not is_whole or options.keyword:
        return
    passed, failed = stats.get("passed", 0), stats.get("failed", 0) + stats.get("error", 0)
    if exitstatus == pytest.ExitCode.OK and passed:
        but = f"; {reasons.total():,} were skipped, for the reasons above" if reasons else ""
        terminalreporter.line(f"ravemj works here: {passed:,} tests passed{but}.", green=True)
    if exitstatus == pytest.ExitCode.TESTS_FAILED:
        terminalreporter.line(
            f"ravemj does not work here as it should: {failed:,} of {passed + failed:,} tests failed. "
            "Please report the lines above that begin with FAILED or ERROR, and what .venv/bin/ravemj doctor prints.",
            red=True,
        )

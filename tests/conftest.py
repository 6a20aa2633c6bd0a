"""What all tests share."""

import logging
import os
import signal
from collections.abc import Sequence
from pathlib import Path

import pytest
from browsers import browser, chromium, webgl_browser  # noqa: F401 - fixtures
from hypothesis import HealthCheck, settings
from newcomers import pytest_report_header, pytest_terminal_summary  # noqa: F401 - hooks
from screens import display, folder  # noqa: F401 - fixtures
from strategies import DEV, PROFILE

import ravemj
from ravemj.rave import logs

TESTS = Path(__file__).resolve().parent
DATA = TESTS / "data"
REPOSITORY = TESTS.parent
MODELS = REPOSITORY / "models"

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # a shell's background jobs ignore Ctrl-C
    signal.signal(signal.SIGINT, signal.default_int_handler)

# Examples may take as long as a busy machine needs, and are the same each time but with HYPOTHESIS_PROFILE=dev.
settings.register_profile(
    "patient",
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    derandomize=not DEV,
    max_examples=100 if PROFILE else 25,  # as ``examples(100)`` has
)
settings.load_profile("patient")


def one_in(count: int, values: Sequence[object]) -> list[object]:
    """Return the parameters of a long test: one in so many runs always, the others run with ``-m stress``."""
    marks = [pytest.mark.stress]
    return [pytest.param(value, marks=marks if place % count else []) for place, value in enumerate(values)]


@pytest.fixture
def models() -> Path:
    return MODELS


@pytest.fixture
def env() -> ravemj.Environment:
    """The tutorial's double pendulum."""
    return ravemj.load(MODELS / "env.xml")


@pytest.fixture
def robot(env) -> ravemj.Robot:
    return env.GetRobots()[0]


@pytest.fixture
def no_cache(monkeypatch):
    """Meshes are read from their files."""
    monkeypatch.setenv("RAVEMJ_CACHE", "off")


@pytest.fixture(autouse=True, scope="session")
def _home(tmp_path_factory):
    """``RaveInitialize`` makes OpenRAVE's folder, here and in processes of tests: not in the user's home."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("OPENRAVE_HOME", str(tmp_path_factory.mktemp("openrave") / "home"))
        yield


@pytest.fixture(autouse=True)
def _usual_messages(monkeypatch):
    """``RaveSetDebugLevel`` sets the level of messages for the whole process."""
    monkeypatch.setattr(logs, "_level", logs.RaveGetDebugLevel())
    loggers = [logging.getLogger(name) for name in ("openravepy", "ravemj")]
    levels = [logger.level for logger in loggers]
    yield
    for logger, level in zip(loggers, levels, strict=True):
        logger.setLevel(level)


@pytest.fixture(autouse=True)
def _no_data_folder(monkeypatch):
    """Models are found by their paths, whatever this machine has in OPENRAVE_DATA."""
    monkeypatch.delenv("OPENRAVE_DATA", raising=False)
    assert "OPENRAVE_DATA" not in os.environ

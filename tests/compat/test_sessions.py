"""Sessions: the tutorial's script by every way of starting it, IPython, and the package that stands for openravepy."""

import os
import re
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pexpect
import pytest
from command_line import (
    PACKAGE_ROOT,
    PATIENCE,
    PRINTED_BY_THE_SCRIPT,
    TUTORIAL,
    TUTORIAL_CAMERA,
    environment,
    finish,
    on_terminal,
    plain,
    ravemj_command,
    run,
)
from conftest import MODELS, one_in

import ravemj

PRINTED_CAMERA_OF_THE_TUTORIAL = [
    [-0.67725463, 0.23636616, -0.69674759, 0.40368351],
    [0.73512462, 0.25638653, -0.62758086, 0.43931767],
    [0.03029782, -0.93722835, -0.34739755, 0.42627937],
    [0.0, 0.0, 0.0, 1.0],
]


@pytest.fixture
def folder(tmp_path) -> Path:
    """The tutorial's folder."""
    for path in TUTORIAL.iterdir():
        copy = tmp_path / path.name
        copy.write_bytes(path.read_bytes())
    (tmp_path / "myscript.py").chmod(0o755)
    return tmp_path


def answer(terminal: pexpect.spawn, number: int, question: str) -> str:
    """Ask IPython something at its prompt of that number, and return its answer."""
    terminal.expect(rf"In \[{number}\]: ")
    terminal.sendline(question)
    terminal.expect(rf"Out\[{number}\]: (.*?)\r?\n")
    return plain(terminal.match[1]).strip()


def leave(terminal: pexpect.spawn, number: int) -> tuple[str, int | None]:
    """Leave IPython; return what was printed after that, and the exit code."""
    terminal.expect(rf"In \[{number}\]: ")
    terminal.sendline("exit()")
    return finish(terminal)


# The tutorial's script


def test_the_files_are_the_tutorials_and_those_of_the_models():
    models = MODELS
    for name in ("env.xml", "double-pendulum.xml"):
        assert (TUTORIAL / name).read_bytes() == (models / name).read_bytes()
    assert "import openravepy\n" in (TUTORIAL / "myscript.py").read_text()


def test_run_prints_what_the_tutorial_promises(folder):
    done = ravemj_command(folder, "run", "myscript.py")
    assert (done.returncode, done.stdout, done.stderr) == (0, PRINTED_BY_THE_SCRIPT, "")


@pytest.mark.parametrize("matrix", [TUTORIAL_CAMERA, PRINTED_CAMERA_OF_THE_TUTORIAL])
def test_cameras_come_back_as_they_were_set(env, matrix):
    env.SetViewer("offscreen")
    viewer = env.GetViewer()
    viewer.SetCamera(-np.negative(matrix) * 1.0)  # every 0 becomes -0. on the way
    found = viewer.GetCameraTransform()
    assert np.abs(found - matrix).max() <= 1e-12
    assert not np.signbit(found[found == 0]).any()
    viewer.SetCamera(found)
    assert np.array_equal(viewer.GetCameraTransform(), found)
    assert "-0." not in re.sub(r"-0\.\d*[1-9]", "", str(found))


def test_setviewer_without_a_display_attaches_one_that_draws(env, monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    assert env.GetViewer() is None
    assert env.SetViewer("qtcoin") is True
    first = env.GetViewer()
    assert first.GetName() == "qtcoin"
    assert first.render(64, 48).std() > 1
    assert env.SetViewer("qtosg") is True
    assert env.GetViewer() is not first
    assert env.SetViewer("") is False
    assert env.GetViewer() is None


def test_run_stays_in_ipython(folder):
    terminal = on_terminal(folder, "-m", "ravemj", "run", "-i", "myscript.py")
    assert answer(terminal, 1, "robot.GetDOF()") == "2"
    assert (
        answer(terminal, 2, "import openravepy; openravepy.__name__, __name__")
        == "('ravemj.compat.openravepy', '__main__')"
    )
    assert answer(terminal, 3, "robot.GetDOFValues().round(6).tolist()") == "[3.141593, 0.0]"
    assert leave(terminal, 4)[1] == 0


@pytest.mark.stress
def test_run_lets_scripts_open_ipython(folder):
    text = (folder / "myscript.py").read_text() + "    import IPython\n    IPython.embed()\n    print('after')\n"
    (folder / "embedding.py").write_text(text)
    terminal = on_terminal(folder, "-m", "ravemj", "run", "embedding.py")
    assert answer(terminal, 1, "robot.GetDOF()") == "2"
    assert answer(terminal, 2, "viewer.GetCameraTransform()[0, 2]").startswith(("-1.0", "np.float64(-1.0)"))
    printed, code = leave(terminal, 3)
    assert code == 0
    assert "after" in printed


def test_shell_has_env_robot_and_viewer(folder):
    terminal = on_terminal(folder, "-m", "ravemj", "shell", "env.xml")
    question = "robot.SetDOFValues([1, 2]); robot.GetDOFValues().tolist(), viewer.GetName(), env.GetRobots() == [robot]"
    assert answer(terminal, 1, question) == "([1.0, 2.0], 'qtcoin', True)"
    terminal.expect(r"In \[2\]: ")
    terminal.sendline("env.SetViewer?")
    terminal.expect("Attach a viewer")
    printed, code = leave(terminal, 3)
    assert code == 0
    assert "Traceback" not in printed


@pytest.mark.stress
def test_shell_completes_at_a_real_prompt(folder):
    terminal = on_terminal(folder, "-m", "ravemj", "shell", "env.xml", simple=False, PROMPT_TOOLKIT_NO_CPR="1")
    terminal.expect("In .*1.*: ")
    terminal.send("viewer.Set\t")
    for name in ("SetBkgndColor", "SetCamera"):
        terminal.expect(name)
    terminal.send("\x15exit\r")
    assert finish(terminal)[1] == 0


def test_a_script_runs_as_python_runs_it(folder):
    sub = folder / "sub"
    sub.mkdir()
    (sub / "helper.py").write_text("VALUE = 5\n")
    (sub / "script.py").write_text(
        "import sys, helper\nimport openravepy.errors\nfrom openravepy import *\nimport ravemj\n"
        "print(helper.VALUE, sys.argv, __name__, __file__, openravepy is ravemj.compat.openravepy)\n"
        "print(Environment is ravemj.Environment)\n"
        "sys.exit('bye')\n"
    )
    done = ravemj_command(folder, "run", "sub/script.py", "-i", "--to", "x")
    assert done.returncode == 1
    assert done.stdout == "5 ['sub/script.py', '-i', '--to', 'x'] __main__ sub/script.py True\nTrue\n"
    assert done.stderr == "bye\n"


def test_a_script_shows_its_own_traceback_and_nothing_of_ours(folder):
    (folder / "wrong.py").write_text("def f():\n    raise KeyError('mine')\n\n\nf()\n")
    done = ravemj_command(folder, "run", "wrong.py")
    assert done.returncode == 1
    files = re.findall(r'File "(.*?)", line (\d+)', done.stderr)
    assert files == [("wrong.py", "5"), ("wrong.py", "2")]
    assert done.stderr.endswith("KeyError: 'mine'\n")
    (folder / "syntax.py").write_text("\ndef f(:\n")
    done = ravemj_command(folder, "run", "syntax.py")
    assert done.returncode == 1
    assert re.findall(r'File "(.*?)", line (\d+)', done.stderr) == [("syntax.py", "2")]


# IPython


def test_load_ext_gives_openravepy_to_a_session(folder):
    lines = [
        "import ravemj, sys",
        "before = __import__('importlib.util').util.find_spec('openravepy')",
        "get_ipython().run_line_magic('load_ext', 'ravemj')",
        "get_ipython().run_line_magic('reload_ext', 'ravemj')",
        "get_ipython().run_line_magic('run', 'myscript.py')",
        "import openravepy",
        "print(before, openravepy is ravemj.compat.openravepy, robot.GetDOF())",
    ]
    done = run(folder, "-m", "IPython", "--no-banner", "--colors=NoColor", "-c", "\n".join(lines))
    assert done.stderr == ""
    assert plain(done.stdout) == f"{PRINTED_BY_THE_SCRIPT}None True 2\n"
    assert done.returncode == 0


@pytest.fixture(scope="module")
def objects():
    env = ravemj.load(TUTORIAL / "env.xml")
    env.SetViewer("offscreen")
    robot = env.GetRobots()[0]
    yield {
        "env": env,
        "robot": robot,
        "viewer": env.GetViewer(),
        "link": robot.GetLinks()[1],
        "joint": robot.GetJoints()[0],
        "geometry": robot.GetLinks()[0].GetGeometries()[0],
        "controller": robot.GetController(),
        "engine": env.GetPhysicsEngine(),
        "checker": env.GetCollisionChecker(),
        "report": ravemj.CollisionReport(),
        "spec": robot.GetConfigurationSpecification(),
        "trajectory": ravemj.RaveCreateTrajectory(env, ""),
        "saver": robot.CreateRobotStateSaver(),
        "handle": env.plot3([0, 0, 1], 5),
        "fresh": ravemj.load(TUTORIAL / "env.xml"),
        "ravemj": ravemj,
    }
    env.Destroy()


@pytest.fixture(scope="module")
def shell(objects, tmp_path_factory):
    before = os.environ.get("IPYTHONDIR")
    os.environ["IPYTHONDIR"] = str(tmp_path_factory.mktemp("ipython"))
    from IPython.core.interactiveshell import InteractiveShell

    made = InteractiveShell(user_ns=dict(objects))
    made.history_manager.enabled = False
    yield made
    made.history_manager.end_session()
    os.environ.pop("IPYTHONDIR")
    if before is not None:
        os.environ["IPYTHONDIR"] = before


COMPLETED = "env robot viewer link joint geometry controller engine checker report spec trajectory saver handle"


@pytest.mark.parametrize("jedi", [True, False])
@pytest.mark.parametrize("name", one_in(3, COMPLETED.split()))
def test_completion_lists_what_a_user_may_call(shell, objects, name, jedi):
    found = completions(shell, f"{name}.", jedi)
    assert found, "nothing is completed"
    assert not [word for word in found if word.startswith("_")]
    public = {word for word in dir(objects[name]) if not word.startswith("_")}
    assert found == public
    wanted = {
        "env": {"Load", "SetViewer", "GetViewer", "GetRobots"},
        "robot": {"GetDOF", "GetDOFValues", "SetDOFValues", "GetLinks", "GetJoints"},
        "viewer": {"SetCamera", "GetCameraTransform", "SetBkgndColor"},
        "link": {"GetName", "GetTransform", "GetMass"},
        "joint": {"GetName", "GetValue", "GetLimits"},
    }
    assert wanted.get(name, set()) <= found


@pytest.mark.parametrize("jedi", [True, False])
def test_completion_neither_compiles_nor_draws(shell, objects, jedi, monkeypatch):
    env = objects["fresh"]
    env.simulation.forget_model()
    monkeypatch.setattr(env.simulation, "compiled", lambda: pytest.fail("completion compiles"))
    monkeypatch.setattr(env.renderer, "render", lambda *rest: pytest.fail("completion draws"))
    assert "model" in completions(shell, "fresh.", jedi)
    assert "render" in completions(shell, "fresh.re", jedi)


def test_completion_of_the_package_lists_what_it_exports(shell):
    assert not completions(shell, "ravemj.", False) - set(ravemj.__all__)


def completions(shell, text: str, jedi: bool) -> set[str]:
    from IPython.core.completer import provisionalcompleter

    shell.Completer.use_jedi = jedi
    with provisionalcompleter():
        return {completion.text.removeprefix(".") for completion in shell.Completer.completions(text, len(text))}


def test_question_mark_shows_the_docstring(shell, capsys):
    shell.run_cell("env.SetViewer?")
    printed = plain(capsys.readouterr().out)
    for text in (
        "env.SetViewer(viewername: str, showviewer: bool = True) -> bool",
        "Attach a viewer",
        "Args:",
        "Returns:",
        '>>> env.SetViewer("qtcoin")',
        "'qtcoin'",
    ):
        assert text in printed
    shell.run_cell("robot?")
    assert "GetRobots()" in plain(capsys.readouterr().out)


# What ``alias --install`` puts into an environment


class Venv:
    """A virtual environment with this environment's packages and ravemj, and without the network."""

    def __init__(self, folder: Path) -> None:
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True, capture_output=True)
        self.bin = folder / "bin"
        (self.packages,) = (folder / "lib").glob("python*/site-packages")
        outer = [sysconfig.get_path("purelib"), str(PACKAGE_ROOT)]
        (self.packages / "outer.pth").write_text("\n".join(outer))
        self.alias = self.packages / "openravepy"
        ipython = self.bin / "ipython"
        ipython.write_text(f"#!{self.bin / 'python'}\nimport IPython, sys\nsys.exit(IPython.start_ipython())\n")
        ipython.chmod(0o755)

    def variables(self, folder: Path) -> dict[str, str]:
        made = environment(folder, PATH=f"{self.bin}{os.pathsep}{os.environ['PATH']}")
        del made["PYTHONPATH"]
        return made

    def run(self, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            words,
            cwd=folder,
            env=self.variables(folder),
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            stdin=subprocess.DEVNULL,
            check=False,
        )

    def ravemj(self, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
        return self.run(folder, str(self.bin / "python"), "-m", "ravemj", *words)

    def python(self, folder: Path, text: str) -> subprocess.CompletedProcess[str]:
        return self.run(folder, str(self.bin / "python"), "-c", text)


@pytest.fixture(scope="module")
def venv(tmp_path_factory):
    return Venv(tmp_path_factory.mktemp("venv") / "venv")


@pytest.mark.stress
def test_alias_installs_runs_old_scripts_and_is_removed(venv, folder):
    without = venv.python(folder, "import ravemj, ravemj.cli\nimport openravepy")
    assert without.stderr.endswith("ModuleNotFoundError: No module named 'openravepy'\n"), "importing ravemj shadows"

    installed = venv.ravemj(folder, "alias", "--install")
    assert (installed.returncode, installed.stderr) == (0, "")
    assert str(venv.alias) in installed.stdout
    assert [path.name for path in venv.alias.iterdir()] == ["__init__.py"]
    again = venv.ravemj(folder, "alias", "--install")
    assert (again.returncode, again.stdout, again.stderr) == (0, installed.stdout, "")

    lazy = "import sys, ravemj\nassert 'openravepy' not in sys.modules\n"
    text = (
        lazy + "import openravepy, openravepy.errors\nprint(openravepy is ravemj.compat.openravepy)\n"
        "print(openravepy.errors is ravemj.errors)"
    )
    done = venv.python(folder, text)
    assert (done.stdout, done.stderr) == ("True\nTrue\n", "")

    script = venv.run(folder, "./myscript.py")
    assert (script.returncode, script.stdout, script.stderr) == (0, PRINTED_BY_THE_SCRIPT, "")

    terminal = pexpect.spawn(
        str(venv.bin / "ipython"),
        ["--no-banner", "-i", "myscript.py"],
        cwd=str(folder),
        env=venv.variables(folder),
        encoding="utf-8",
        timeout=PATIENCE,
        echo=False,
    )
    assert answer(terminal, 1, "robot.GetDOF()") == "2"
    assert leave(terminal, 2)[1] == 0

    removed = venv.ravemj(folder, "alias", "--remove")
    assert (removed.returncode, removed.stderr) == (0, "")
    assert str(venv.alias) in removed.stdout
    assert not venv.alias.exists()
    assert venv.python(folder, "import openravepy").returncode == 1
    assert venv.ravemj(folder, "alias", "--remove").returncode == 0


@pytest.mark.stress
@pytest.mark.parametrize("place", one_in(3, ["package", "module", "elsewhere"]))
def test_alias_leaves_a_real_openravepy_alone(venv, folder, place):
    outside = folder / "elsewhere"
    files = {
        "package": venv.alias / "__init__.py",
        "module": venv.packages / "openravepy.py",
        "elsewhere": outside / "openravepy" / "__init__.py",
    }
    file = files[place]
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("real = True\n")
    path_file = venv.packages / "elsewhere.pth"
    if place == "elsewhere":
        path_file.write_text(str(outside))
    try:
        for option in ("--install", "--remove"):
            done = venv.ravemj(folder, "alias", option)
            assert file.read_text() == "real = True\n"
            if option == "--install" or place == "package":
                assert (done.returncode, done.stdout) == (1, "")
                assert re.fullmatch(r"ravemj: error: .*openravepy.*\n", done.stderr)
        assert place == "package" or not venv.alias.exists()
        assert venv.python(folder, "import ravemj, openravepy; print(openravepy.real)").stdout == "True\n"
    finally:
        file.unlink()
        path_file.unlink(missing_ok=True)
        if venv.alias.exists():
            venv.alias.rmdir()

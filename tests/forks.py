"""Starts commands as forks of a process that has imported everything, in milliseconds where a new one takes a second.

A fork has a folder, variables, standard output and standard error of its own, and ends as ``python -m MODULE`` ends.
The process that forks never draws, so that each fork has an OpenGL context of its own too.
"""

import atexit
import gc
import json
import os
import runpy
import signal
import socket
import subprocess
import sys
import warnings
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryFile

IMPORTED = [
    "ravemj.cli.check",
    "ravemj.cli.convert",
    "ravemj.cli.diff",
    "ravemj.cli.grasp_page",
    "ravemj.cli.ik",
    "ravemj.cli.info",
    "ravemj.cli.learn",
    "ravemj.cli.mirror",
    "ravemj.cli.pictures",
    "ravemj.cli.plan",
    "ravemj.cli.sessions",
    "ravemj.cli.sweep",
    "ravemj.cli.view",
    "ravemj.compat.openravepy",
    "ravemj.formats.collada.scenes",
    "ravemj.formats.readers",
    "av",
    "fissix",
    "imageio.plugins.pillow",
    "imageio.v3",
    "IPython",
    "PIL.Image",
    "rich.console",
    "rich.table",
]


class Forks:
    """The process that forks, from the first request to the end of the tests.

    Args:
        variables: Its environment: what modules read when they are imported, forks cannot change.
        patience: How long a fork may take [s].
        imported: Names of the modules that it imports.
    """

    def __init__(self, variables: Mapping[str, str], patience: float, imported: Sequence[str] = IMPORTED) -> None:
        self._variables, self._patience, self._imported = variables, patience, imported
        self._process: subprocess.Popen[bytes] | None = None
        atexit.register(self._end)

    def run(
        self, module: str, arguments: Sequence[str], folder: Path, variables: Mapping[str, str]
    ) -> subprocess.CompletedProcess[str]:
        """Run ``python -m MODULE ARGUMENTS`` in a folder and return what came of it."""
        if self._process is None:
            self._start()
        request = json.dumps([module, arguments, str(folder), variables]).encode() + b"\n"
        with TemporaryFile("w+") as stdout, TemporaryFile("w+") as stderr:
            try:
                socket.send_fds(self._socket, [request], [stdout.fileno(), stderr.fileno()])
                status = int(self._socket.recv(16))
            except TimeoutError:
                self._end()
                raise
            texts = [(file.seek(0), file.read())[1] for file in (stdout, stderr)]
        return subprocess.CompletedProcess([module, *arguments], status, *texts)

    def _start(self) -> None:
        self._socket, other = socket.socketpair()
        self._socket.settimeout(self._patience)
        with other:
            self._process = subprocess.Popen(
                [sys.executable, __file__, str(other.fileno()), *self._imported],
                env=self._variables,
                pass_fds=[other.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                start_new_session=True,
            )

    def _end(self) -> None:
        if self._process is not None:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
            self._process = None
            self._socket.close()


def _serve(requests: socket.socket) -> None:
    """Fork for each request; return in forks only."""
    while True:
        content, files, _, _ = socket.recv_fds(requests, 1 << 16, 2)
        if not content:
            sys.exit()  # the tests are over
        while not content.endswith(b"\n"):
            content += requests.recv(1 << 16)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # the threads that numpy has started sleep
            child = os.fork()
        if child == 0:
            break
        for file in files:
            os.close(file)
        requests.send(str(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])).encode())
    requests.close()
    for number, file in enumerate(files, 1):
        os.dup2(file, number)
        os.close(file)
    module, arguments, folder, variables = json.loads(content)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(variables)
    sys.path[0] = folder
    sys.argv[1:] = arguments
    runpy.run_module(module, run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    for name in sys.argv[2:]:
        import_module(name)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # shells let what runs in the background ignore it
    gc.freeze()  # else the end of each fork goes through all of it
    _serve(socket.socket(fileno=int(sys.argv[1])))

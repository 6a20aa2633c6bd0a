"""Models, joint graphs and scripts made by chance, each with OpenRAVE's answer.

``data/random/differs.txt`` lists the inputs that ravemj answers otherwise, with the reason. Whoever mends one takes it
off the list; ``PYTHONPATH=tests python tests/rave/test_random.py`` writes the list anew, with the places of new
differences as reasons.
"""

import importlib.util
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
import types
from collections.abc import Sequence
from pathlib import Path

import pytest
from conftest import DATA, REPOSITORY, one_in
from waiting import PATIENCE

INPUTS = DATA / "random"
LIST = INPUTS / "differs.txt"
KINDS = ("xml", "graph", "api")
ARCHIVES = (*KINDS, *(f"{kind}-2" for kind in KINDS))
MISTAKES = {
    r"ComputeInverseDynamics(\[\])+$": "OpenRAVE divides forces of sliders by 2 pi and leaves out what followers need",
    r"GetLinkAccelerations(\[\])+$": "OpenRAVE leaves out what accelerates followers",
}
"""Places where numbers of scripts may differ, and why; the same are left out of the API scripts."""
PARTS = 24
"""One part of each archive runs by default, all of them with ``-m stress``."""


def listed() -> dict[str, str]:
    """Return the reasons by the names of the inputs."""
    return dict(line.split(": ", 1) for line in LIST.read_text(encoding="utf-8").splitlines())


def differing(archives: Sequence[str], parts: Sequence[int], folder: Path) -> tuple[list[str], dict[str, list[str]]]:
    """Run some parts of archives; return the names of the inputs, and the differences of those that differ."""
    names, inputs = list[str](), list[Path]()
    for archive in archives:
        unpacked = folder / archive
        with tarfile.open(INPUTS / f"{archive}.tar.xz") as packed:
            for member in filter(tarfile.TarInfo.isfile, packed):  # ``extractall`` differs from Python to Python
                content = packed.extractfile(member)
                assert content is not None
                (unpacked / member.name).parent.mkdir(parents=True, exist_ok=True)
                (unpacked / member.name).write_bytes(content.read())
        every = sorted(path.name for path in unpacked.iterdir())
        chosen = [name for part in parts for name in every[part::PARTS]]
        names += chosen
        inputs += [next((unpacked / name).glob("case.[px]*[yl]")) for name in chosen]
    (folder / "list.txt").write_text("".join(f"{path}\t{path}.ours.json\n" for path in inputs))
    worker = [sys.executable, INPUTS / "check.py", "--worker", "ravemj", "--list", folder / "list.txt"]
    subprocess.run([*worker, "--limit", str(PATIENCE)], check=True, env={**os.environ, **ENVIRONMENT})
    compare, found = _program().compare, dict[str, list[str]]()
    for name, path in zip(names, inputs, strict=True):
        theirs, ours = (json.loads(Path(f"{path}.{who}.json").read_text()) for who in ("openravepy", "ours"))
        differences = [(place, text) for place, text in compare(theirs, ours) if not _is_mistake(place)]
        if differences:
            found[name] = [f"{place}: {text}" for place, text in differences]
    return names, found


def _is_mistake(place: str) -> bool:
    return any(re.match(mistake, place) for mistake in MISTAKES)


def _program() -> types.ModuleType:
    spec = importlib.util.spec_from_file_location("random_check", INPUTS / "check.py")
    assert spec is not None
    assert spec.loader is not None
    program = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(program)
    return program


ENVIRONMENT = {"PYTHONPATH": str(REPOSITORY), "PYTHONWARNINGS": "ignore"}


@pytest.mark.parametrize("part", one_in(PARTS, range(PARTS)))
def test_only_those_on_the_list_differ(part, tmp_path):
    """One process runs a part of each archive: it takes seconds to begin, and then moments for each input."""
    names, found = differing(ARCHIVES, [part], tmp_path)
    reasons = listed()
    new = {name: differences[:3] for name, differences in found.items() if name not in reasons}
    assert new == {}
    mended = [name for name in names if name in reasons and name not in found]
    assert mended == [], "take these off the list: PYTHONPATH=tests python tests/rave/test_random.py"


def test_the_list_is_of_these_inputs():
    assert {name.split("-")[0] for name in listed()} <= set(KINDS)
    assert all(listed().values())


def main() -> None:
    """Write the list anew."""
    reasons, lines = listed() if LIST.exists() else {}, list[str]()
    for archive in ARCHIVES:
        with tempfile.TemporaryDirectory() as folder:
            names, found = differing([archive], range(PARTS), Path(folder))
        print(f"{archive}: {len(names) - len(found)} of {len(names)} agree")
        for name in sorted(found):
            places = "; ".join(dict.fromkeys(text.split(": ")[0] for text in found[name]))
            lines.append(f"{name}: {reasons.get(name, places)}\n")
    LIST.write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()

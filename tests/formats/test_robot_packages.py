"""Robots by name: packages that are made up, with and without a cached copy; nothing is fetched here."""

import json
import os
import sys
from pathlib import Path

import pytest
from command_line import PACKAGE_ROOT, run

import ravemj
from ravemj.formats import robot_packages

ARM = """<mujoco><worldbody><body name="base"><body name="arm"><joint name="turn" axis="0 0 1"/>
<geom size="0.1"/></body></body></worldbody></mujoco>"""

REPOSITORIES = """
from dataclasses import dataclass
@dataclass
class Repository:
    cache_path: str
    commit: str
    url: str
REPOSITORIES = {"arms": Repository(url="https://example.org/arms.git", commit="abc", cache_path="arms")}
"""
MODULE = """
from os import getenv as _getenv
from os import path as _path
from ._cache import clone_to_cache as _clone_to_cache
REPOSITORY_PATH: str = _clone_to_cache("arms", commit=_getenv("ROBOT_DESCRIPTION_COMMIT", None))
PACKAGE_PATH: str = _path.join(REPOSITORY_PATH, "toy")
MJCF_PATH: str = _path.join(PACKAGE_PATH, "toy.xml")
"""
MENAGERIE = """
import os, pathlib
class Robot:
    default_model = "toy"
    def xml(self, entry):
        return pathlib.Path(os.environ["MENAGERIE_CACHE_DIR"], "toy.xml")
class Cache:
    def is_cached(self, robot):
        return robot.xml("toy").exists()
def get(name):
    return Robot()
"""


@pytest.fixture
def packages(tmp_path, monkeypatch) -> Path:
    """Two packages with a robot each, and a folder for their caches; importing a robot ends in an error."""
    described = tmp_path / "site" / "robot_descriptions"
    described.mkdir(parents=True)
    (described / "__init__.py").write_text("")
    (described / "_cache.py").write_text("def clone_to_cache(name, commit=None): raise OSError('no network')")
    (described / "_repositories.py").write_text(REPOSITORIES)
    (described / "toy_description.py").write_text(MODULE)
    xacro = MODULE.replace("MJCF_PATH", "XACRO_PATH").replace("toy.xml", "toy.urdf.xacro")
    (described / "other_description.py").write_text(xacro + 'XACRO_ARGS = {"kind": "long"}\n')
    menagerie = tmp_path / "site" / "mujoco_menagerie"
    menagerie.mkdir()
    (menagerie / "__init__.py").write_text(MENAGERIE)
    (menagerie / "registry.json").write_text(json.dumps({"robots": {"maker_toy": {"download_size": 2_500_000}}}))
    monkeypatch.syspath_prepend(tmp_path / "site")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "site"))
    monkeypatch.setenv("ROBOT_DESCRIPTIONS_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("MENAGERIE_CACHE_DIR", str(tmp_path / "cache"))
    for name in [name for name in sys.modules if name.partition(".")[0] in {"robot_descriptions", "mujoco_menagerie"}]:
        monkeypatch.delitem(sys.modules, name)
    (tmp_path / "cache" / "arms" / "toy").mkdir(parents=True)
    return tmp_path


def test_names_are_looked_up_without_importing(packages):
    assert robot_packages.robot_names() == ["maker_toy", "other_description", "toy_description"]
    assert "robot_descriptions" not in sys.modules


def test_a_cached_robot_is_found_without_importing(packages):
    path = packages / "cache" / "arms" / "toy" / "toy.xml"
    path.write_text(ARM)
    assert ravemj.model_path("toy_description") == str(path)
    assert "robot_descriptions" not in sys.modules
    assert ravemj.load(ravemj.model_path("toy_description")).GetRobots()[0].GetDOF() == 1


def test_nothing_is_fetched_unless_it_is_asked_for(packages):
    with pytest.raises(ravemj.ArgumentError, match=r"with --download .* from https://example.org/arms\.git"):
        ravemj.model_path("toy_description")
    assert "robot_descriptions.toy_description" not in sys.modules


def test_without_a_network_it_is_one_line(packages):
    with pytest.raises(ravemj.RavemjError, match=r"cannot fetch 'toy_description' from .*: no network") as caught:
        ravemj.model_path("toy_description", download=True)
    assert "\n" not in str(caught.value)


def test_arguments_of_a_xacro_come_along(packages):
    path = packages / "cache" / "arms" / "toy" / "toy.urdf.xacro"
    path.write_text("<robot/>")
    assert robot_packages.robot_file("other_description").arguments == {"kind": "long"}


def test_robots_of_the_menagerie(packages):
    with pytest.raises(ravemj.ArgumentError, match=r"mujoco_menagerie, 2\.5 MB"):
        ravemj.model_path("maker_toy")
    (packages / "cache" / "toy.xml").write_text(ARM)
    assert ravemj.model_path("maker_toy") == str(packages / "cache" / "toy.xml")


def test_a_name_that_is_nearly_right(packages):
    with pytest.raises(ravemj.ArgumentError, match="did you mean toy_description"):
        robot_packages.robot_file("toi_description")
    with pytest.raises(ravemj.SourceError, match="did you mean toy_description"):
        ravemj.load("toi_description")


def test_commands_take_names(packages):
    def info(*options: str):
        path = os.pathsep.join((str(PACKAGE_ROOT), str(packages / "site")))
        return run(packages, "-m", "ravemj", "info", "toy_description", *options, variables={"PYTHONPATH": path})

    result = info()
    assert result.returncode == 1
    assert "with --download" in result.stderr
    assert "Traceback" not in result.stderr
    result = info("--download")
    assert result.returncode == 1
    assert result.stderr.startswith("fetching 'toy_description' from https://example.org/arms.git")
    assert "no network" in result.stderr
    (packages / "cache" / "arms" / "toy" / "toy.xml").write_text(ARM)
    assert "turn: hinge" in info().stdout


def test_without_the_packages_the_extra_is_named(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    with pytest.raises(ravemj.SourceError, match=r"ravemj\[robots\]"):
        ravemj.load("ur5e_description")
    with pytest.raises(ravemj.ArgumentError, match=r"ravemj\[robots\]"):
        ravemj.model_path("ur5e_description")

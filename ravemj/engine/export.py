"""Models as MJCF files that need nothing else: the text, with its meshes in the folder ``assets`` beside it."""

import glob
import os
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np

from ravemj.core.output import AnyPath, added_files, new_file, new_folder
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import Compiled, Simulation
from ravemj.errors import Diagnostics, OutputError
from ravemj.formats.mjcf import Mjcf, Options
from ravemj.formats.mjcf.document import ASSETS
from ravemj.formats.mjcf.lines import Lines, attribute_text, comment_text
from ravemj.model.look import STUDIO_PREFIX
from ravemj.model.scene import Scene

START = "loaded"
"""Name of the keyframe with the joint values that the model was loaded with."""

_LIGHT_DISTANCE = 2.0
"""Distance of lights from the middle of a model, in its extents."""

_MARK = "<!-- made by ravemj"
_MESHES = "mesh-*.obj"


def translate(simulation: Simulation, diagnostics: Diagnostics, options: Options) -> Mjcf:
    """Translate the bodies of a simulation, with its gravity, and see that MuJoCo takes the result.

    Where joints are not at their zero, the keyframe ``loaded`` has their values.

    Raises:
        CompileError: MuJoCo refuses the model.
        RavemjError: meshes are to be cut, and CoACD is not installed.
    """
    scene = Scene(tuple(body.scene for body in simulation.bodies), simulation.view, simulation.gravity)
    compiled = Compiled(scene, diagnostics, options)
    mjcf = replace(compiled.mjcf, text=_with_placed_lights(compiled.mjcf.text, compiled.model))
    start = _qpos(compiled.model, simulation.compiled())
    if np.array_equal(start, compiled.model.qpos0):
        return mjcf
    keyframe = Lines(indent=1)
    keyframe.open("keyframe")
    keyframe.element("key", name=START, qpos=tuple(start.tolist()))
    keyframe.close("keyframe")
    head, end = mjcf.text.rsplit("</mujoco>", 1)
    return replace(mjcf, text="\n".join([f"{head}{keyframe.text[0]}", *keyframe.text[1:], f"</mujoco>{end}"]))


def _with_placed_lights(text: str, model: mujoco.MjModel) -> str:
    """Place the directional lights so that the shadow maps of MuJoCo's viewers, which begin there, have all bodies."""
    for number in range(model.nlight):
        light = model.light(number)
        if light.name.startswith(STUDIO_PREFIX):
            position = model.stat.center - _LIGHT_DISTANCE * model.stat.extent * light.dir
            attribute = attribute_text(tuple(position.round(6).tolist()))
            text = text.replace(f'<light name="{light.name}"', f'<light name="{light.name}" pos="{attribute}"', 1)
    return text


def _qpos(model: mujoco.MjModel, current: Compiled) -> Floats:
    """Return the positions of all joints of a model: those of the current one where it has the joint."""
    qpos = model.qpos0.copy()
    for number in range(current.model.njnt):
        joint = current.model.joint(number)
        first, width = model.joint(joint.name).qposadr[0], len(joint.qpos0)
        qpos[first : first + width] = current.data.joint(number).qpos
    return qpos


def marked(text: str, model: AnyPath) -> str:
    """Return an MJCF document with a first line that says what it was made from."""
    return f"{_MARK} from {comment_text(Path(model).name)} -->\n{text}"


def is_folder(path: AnyPath) -> bool:
    """Return whether a target names a folder: it is one, or it has no suffix or a final slash."""
    text = os.fspath(path)
    return text.endswith(("/", os.sep)) or os.path.isdir(text) or not os.path.splitext(text)[1]


def write_folder(path: AnyPath, model: AnyPath, mjcf: Mjcf, read: Collection[str]) -> Path:
    """Write a folder with the MJCF file and its meshes, whole or not at all; return the path of the MJCF file.

    Args:
        path: The folder; one that is there already is empty or holds an older translation of the same file.
        model: The file that the model was read from; its name becomes that of the MJCF file.
        mjcf: The translated model.
        read: Files that must stay as they are.

    Raises:
        OutputError: it cannot be written, or something else is there.
    """
    name = f"{Path(model).stem}.xml"
    _check_former(path, Path(path, name))
    _check_untouched(path, [file for file in read if Path(path).resolve() in Path(file).resolve().parents])
    with new_folder(path, glob.escape(name), f"{ASSETS}/{_MESHES}") as folder:
        (folder / name).write_text(marked(mjcf.text, model), encoding="utf-8")
        if mjcf.assets:
            (folder / ASSETS).mkdir()
            _write_meshes(folder / ASSETS, mjcf)
    return Path(path, name)


def write_file(path: AnyPath, model: AnyPath, mjcf: Mjcf, read: Collection[str]) -> Path:
    """Write an MJCF file, and its meshes into ``assets`` beside it, whole or not at all; return its path.

    Arguments as for ``write_folder``.

    Raises:
        OutputError: it cannot be written, or it is a file that was read.
    """
    assets = Path(path).parent / ASSETS
    targets = [Path(path), *(assets / file for file in mjcf.assets)]
    _check_untouched(path, [file for file in read if any(_is_same(file, target) for target in targets)])
    with new_file(path) as file:
        file.write_text(marked(mjcf.text, model), encoding="utf-8")
        if mjcf.assets:
            with added_files(assets) as folder:
                _write_meshes(folder, mjcf)
    return Path(path)


def _write_meshes(folder: Path, mjcf: Mjcf) -> None:
    for name, content in mjcf.assets.items():
        (folder / name).write_text(content, encoding="utf-8")


def _check_former(path: AnyPath, file: Path) -> None:
    """Check that an MJCF file that is to be replaced is one of ours."""
    try:
        is_ours = _is_ours(file)
    except OSError:  # nothing is there, or what comes next will say what is wrong
        return
    if not is_ours:
        raise OutputError(f"cannot replace {os.fspath(path)}: ravemj did not make {file.name} in it")


def _is_ours(file: Path) -> bool:
    with open(file, encoding="utf-8", errors="replace") as old:
        return old.read(len(_MARK)) == _MARK


def _check_untouched(path: AnyPath, lost: Collection[AnyPath]) -> None:
    """Check that nothing that the model was read from gets lost."""
    if lost:
        names = ", ".join(str(Path(file)) for file in lost)
        raise OutputError(f"cannot write {os.fspath(path)}: the model was read from {names}")


def _is_same(file: AnyPath, target: Path) -> bool:
    return target.exists() and os.path.exists(file) and os.path.samefile(file, target)

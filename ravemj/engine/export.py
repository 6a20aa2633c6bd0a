"""Self-contained MJCF files: the text, with its meshes in the folder ``assets`` beside it.

A folder also contains a scene with the model on a floor.
"""

import glob
import os
from collections.abc import Collection
from pathlib import Path

from ravemj.core.output import AnyPath, added_files, new_file, new_folder
from ravemj.engine import scene_file
from ravemj.engine.translation import Translation
from ravemj.errors import OutputError
from ravemj.formats.mjcf import Mjcf
from ravemj.formats.mjcf.document import ASSETS
from ravemj.formats.mjcf.lines import comment_text

_MARK = "<!-- made by ravemj"
_MESHES = "mesh-*.obj"


def marked(text: str, model: AnyPath) -> str:
    """Prepend a line with the source of the model to an MJCF document."""
    return f"{_former_mark(model) or f'{_MARK} from {comment_text(Path(model).name)} -->'}\n{text}"


def _former_mark(model: AnyPath) -> str:
    """Return the first line of a model that was written by ravemj; empty for other models."""
    try:
        with open(model, encoding="utf-8", errors="replace") as file:
            line = file.readline().rstrip("\n")
    except OSError:  # a text, or the name of a model
        return ""
    return line if line.startswith(_MARK) else ""


def is_folder(path: AnyPath) -> bool:
    """Return whether a path names a folder: an existing folder, a name without suffix, or with a final slash."""
    text = os.fspath(path)
    return text.endswith(("/", os.sep)) or os.path.isdir(text) or not os.path.splitext(text)[1]


def write(path: AnyPath, model: AnyPath, translation: Translation, read: Collection[str]) -> Path:
    """Write a translated model as an MJCF file or, if it has a scene with a floor, as a folder; return the MJCF file.

    Args:
        path: The file or folder. An existing folder must be empty or contain an older translation of the model.
        model: The file that the model was read from; in a folder, the MJCF file gets its name.
        translation: The translated model.
        read: Files that must not be overwritten.

    Raises:
        OutputError: the target cannot be written, is another kind of folder, or is a file that was read.
    """
    if not is_folder(path):
        return write_file(path, model, translation.mjcf, read)
    name = f"{Path(model).stem}.xml"
    if name == scene_file.NAME:
        hint = "name a file, as in -o FOLDER/model.xml"
        raise OutputError(f"cannot write {os.fspath(path)}: the model is called scene, as the file beside it; {hint}")
    return write_folder(path, model, translation.mjcf, read, scene_file.scene_text(translation, name))


def write_folder(path: AnyPath, model: AnyPath, mjcf: Mjcf, read: Collection[str], scene: str) -> Path:
    """Write a folder with the MJCF file, a scene and meshes atomically; return the path of the MJCF file.

    Arguments as for ``write``; ``scene`` is the document that puts the model on a floor.

    Raises:
        OutputError: the folder cannot be written, has other content than an older translation, or contains a file that
            was read.
    """
    name = f"{Path(model).stem}.xml"
    for file in (name, scene_file.NAME):
        _check_former(path, Path(path, file))
    _check_untouched(path, [file for file in read if Path(path).resolve() in Path(file).resolve().parents])
    with new_folder(path, glob.escape(name), scene_file.NAME, f"{ASSETS}/{_MESHES}") as folder:
        (folder / name).write_text(marked(mjcf.text, model), encoding="utf-8")
        (folder / scene_file.NAME).write_text(marked(scene, model), encoding="utf-8")
        if mjcf.assets:
            (folder / ASSETS).mkdir()
            _write_meshes(folder / ASSETS, mjcf)
    return Path(path, name)


def write_file(path: AnyPath, model: AnyPath, mjcf: Mjcf, read: Collection[str]) -> Path:
    """Write an MJCF file, and its meshes into ``assets`` beside it, atomically; return its path.

    Arguments as for ``write``.

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
    """Raise an OutputError if the MJCF file to be replaced was not written by ravemj."""
    try:
        is_ours = _is_ours(file)
    except OSError:  # it does not exist, or the next step reports the error
        return
    if not is_ours:
        raise OutputError(f"cannot replace {os.fspath(path)}: ravemj did not make {file.name} in it")


def _is_ours(file: Path) -> bool:
    with open(file, encoding="utf-8", errors="replace") as old:
        return old.read(len(_MARK)) == _MARK


def _check_untouched(path: AnyPath, lost: Collection[AnyPath]) -> None:
    """Raise an OutputError if writing to ``path`` would overwrite the files ``lost``, from which the model was read."""
    if lost:
        names = ", ".join(str(Path(file)) for file in lost)
        raise OutputError(f"cannot write {os.fspath(path)}: the model was read from {names}")


def _is_same(file: AnyPath, target: Path) -> bool:
    return target.exists() and os.path.exists(file) and os.path.samefile(file, target)

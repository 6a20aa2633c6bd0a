"""Compilation of MJCF by MuJoCo without pictures and simulation options, and MuJoCo's errors with positions."""

import os
import re
import warnings
from dataclasses import dataclass

import mujoco

from ravemj.engine.mjcf_reading.document import MjcfDocument, base_name
from ravemj.errors import Source, SourceError
from ravemj.formats.limits import MOST_NUMBERS, check_count

_LINE = re.compile(r"line (?:number=)?(\d+)", re.IGNORECASE)
_NAME = re.compile(r"[Ee]lement name '([^']*)'")
_ELEMENT = re.compile(r"^Element '([^']*)'", re.MULTILINE)
_FILE = re.compile(r"(?:file|resource)[^']*'([^']*)'")
_NOISE = re.compile(r"(?:XML )?(?:Error|error): ?|Element (?:name )?'[^']*'(?:, id -?\d+)?(?:, line \d+)?\n?")
_TEXTURES = 10


@dataclass(frozen=True)
class CompiledModel:
    """Model compiled by MuJoCo.

    Values are those of ``model``; ``spec`` has names, classes, and values as written.

    Attributes:
        document: The model's text.
        spec: MuJoCo's editable form.
        model: The compiled form.
        complaints: MuJoCo's warnings.
    """

    document: MjcfDocument
    spec: mujoco.MjSpec
    model: mujoco.MjModel
    complaints: tuple[str, ...]


def compile_document(document: MjcfDocument) -> CompiledModel:
    """Compile a model. No body is fused, and no geom is discarded.

    Raises:
        SourceError: MuJoCo refuses it.
    """
    with warnings.catch_warnings(record=True) as complaints:
        warnings.simplefilter("always")
        try:
            if os.path.isfile(document.path):
                spec = mujoco.MjSpec.from_file(document.path)
            else:
                spec = mujoco.MjSpec.from_string(document.text)
            _strip(spec, document)
            model = spec.compile()
        except (ValueError, RuntimeError, mujoco.FatalError) as error:
            raise _refusal(str(error), document) from None
    return CompiledModel(document, spec, model, tuple(str(complaint.message) for complaint in complaints))


def _strip(spec: mujoco.MjSpec, document: MjcfDocument) -> None:
    """Remove expensive elements that do not affect bodies."""
    spec.compiler.fusestatic = False
    spec.compiler.discardvisual = False
    spec.memory = -1
    spec.njmax = spec.nconmax = -1
    for hfield in spec.hfields:
        check_count(hfield.nrow * hfield.ncol, MOST_NUMBERS, "numbers in a height field", document.tags[0].source)
    for material in spec.materials:
        material.textures = [""] * _TEXTURES
    for part in (*spec.textures, *spec.skins):
        spec.delete(part)


def _refusal(message: str, document: MjcfDocument) -> SourceError:
    reason = " ".join(_NOISE.sub(" ", message).split()).rstrip(".")
    return SourceError(f"MuJoCo refuses the model: {reason}", _place(message, document), _hint(document))


def _place(message: str, document: MjcfDocument) -> Source:
    file = _FILE.search(message)
    tag = document.files.get(base_name(file[1])) if file else None
    if tag is not None:
        return tag.source
    name, element, line = _NAME.search(message), _ELEMENT.search(message), _LINE.search(message)
    number = int(line[1]) if line else 0
    here = [tag.source for tag in document.tags if tag.source.line == number]
    if name is not None and name[1]:
        named = [tag for tag in document.tags if tag.attributes.get("name") == name[1]]
        exact = [tag.source for tag in named if tag.source.line == number]
        places = exact or [tag.source for tag in named]
        if places:
            return places[0]
    if element is not None:
        exact = [tag.source for tag in document.tags if tag.source.line == number and tag.name == element[1]]
        here = exact or here
    return here[0] if here else Source(document.path, number)


def _hint(document: MjcfDocument) -> str:
    hint = document.includer_hint()
    return hint if hint.endswith("which includes it") else ""

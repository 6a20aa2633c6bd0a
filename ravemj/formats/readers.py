"""Selection of the reader by the kind of a file."""

import difflib
import functools
import os
from collections.abc import Callable
from dataclasses import replace
from urllib.parse import unquote

from ravemj.errors import Diagnostics, Source, SourceError
from ravemj.formats import collada
from ravemj.formats.data_folders import find
from ravemj.formats.file_access import FileAccess
from ravemj.formats.mjcf.recognition import is_mjcf
from ravemj.formats.openrave_xml import Reading, read
from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.given import NOTHING, Attributes, check_given, give, given_scale
from ravemj.formats.openrave_xml.other_files import add_mesh, is_mesh, uniform
from ravemj.formats.openrave_xml.tree import content_of
from ravemj.formats.robot_packages import INSTALL, robot_names
from ravemj.formats.shipped import SHIPPED_MODELS
from ravemj.formats.urdf.xacro import expand, is_xacro
from ravemj.model.builder import BodyBuilder
from ravemj.model.scene import AttachedSensor, KinBody, Scene

_COLLADA, _HEAD = b"<COLLADA", 1000  # the root element, and the number of bytes to search for it
_TEXT = "data"  # name of a text in messages, as if it were a file in the working folder
_LIKENESS = 0.7  # similarity from which on a missing file is taken for a misspelt model name


def read_file(
    path: str | os.PathLike[str], given: Attributes = NOTHING, metre: float = 1.0, access: FileAccess | None = None
) -> Reading:
    """Read a model file from the working folder or a folder of ``OPENRAVE_DATA``.

    Args:
        path: An OpenRAVE XML file, a COLLADA file, or a mesh file, which becomes a static body. ``robot.dae#arm``
            selects the id ``arm`` in a COLLADA file.
        given: Additional attributes of the bodies, such as a prefix; see ``openrave_xml.given``.
        metre: Length of a metre in the unit of the scene. Only lengths of COLLADA files, which declare a unit, are
            converted; gravity and other files are not, as in OpenRAVE.
        access: The files that may be read; by default those of a model that its user opens.

    Returns:
        The result; its ``failure`` is the error that ended the reading, if any.
    """
    place, wanted = _without_scheme(os.fspath(path)), ""
    existing = find(place, "")
    if existing is None:
        place, wanted = collada.split_uri(place)
        existing = find(place, "")
    if existing is None:
        failure = missing(os.fspath(path))
    elif not os.path.isfile(existing):
        kind = "folder" if os.path.isdir(existing) else "device or pipe"
        failure = SourceError(f"this is a {kind}, not a model file", Source(existing))
    elif is_mesh(existing):
        return _read_mesh_file(existing, given, access or FileAccess.opened(existing))
    else:
        return _read_model(existing, wanted, given, metre, access or FileAccess.opened(existing))
    return Reading(Scene(), Diagnostics(), failure)


def _read_model(path: str, wanted: str, given: Attributes, metre: float, access: FileAccess) -> Reading:
    """Read an XML model; COLLADA is recognized with any suffix, since ``Environment.Save`` accepts any."""
    if not path.lower().endswith(collada.SUFFIXES):
        try:
            content = content_of(path)
        except SourceError as error:
            return Reading(Scene(), Diagnostics(), error, {path: None})
        if is_xacro(path, content):
            return _read_xacro(path, given, access)
        if is_mjcf(content):
            return _read_mjcf(path, content, given, access)
        if _COLLADA not in content[:_HEAD]:
            return read(path, given, content, access)
    uri = f"{path}#{wanted}" if wanted else path
    read_content = functools.partial(collada.read_file, uri, access)
    return _read_collada(path, given, metre, access, lambda scale: read_content(scale=scale))


def _read_mjcf(path: str, content: bytes, given: Attributes, access: FileAccess) -> Reading:
    """Read MJCF by the engine: only MuJoCo can compile it."""
    from ravemj.engine.mjcf_reading import read_mjcf  # noqa: PLC0415 - it needs MuJoCo

    return read_mjcf(path, content, given, access)


def _read_xacro(path: str, given: Attributes, access: FileAccess) -> Reading:
    """Read the URDF to which a xacro file expands; line numbers in messages are those of the expanded text."""
    try:
        content = expand(path, given, access)
    except SourceError as error:
        return Reading(Scene(), access.diagnostics, error, {path: None})
    reading = read(path, given, content, access)
    if reading.failure is not None:
        reading.failure.hint = "; ".join(filter(None, (reading.failure.hint, "the line is that of the expanded xacro")))
    return reading


def missing(path: str) -> SourceError:
    """Return the error for a missing file."""
    similar = difflib.get_close_matches(path, [*SHIPPED_MODELS, *robot_names()], 1, _LIKENESS)
    hint = "check the path, or set OPENRAVE_DATA"
    if similar:
        name = similar[0]
        whose = "which comes with ravemj" if name in SHIPPED_MODELS else "a robot of an installed package"
        hint += f"; did you mean {name}, {whose}? In Python: ravemj.model_path('{name}')"
    elif path.endswith("_description") and not robot_names():
        hint = INSTALL
    return SourceError("there is no such file", Source(path), hint)


def read_data(data: str | bytes, given: Attributes = NOTHING, metre: float = 1.0) -> Reading:
    """Read an OpenRAVE XML or COLLADA document from memory; arguments as for ``read_file``.

    Files that it names are searched in the working folder.
    """
    content, access = data if isinstance(data, bytes) else data.encode(), FileAccess.opened(_TEXT)
    if is_mjcf(content):
        return _read_mjcf(_TEXT, content, given, access)
    if _COLLADA not in content[:_HEAD]:
        reading = read(_TEXT, given, content, access)
        return replace(reading, named_files=access.files)
    return _read_collada(_TEXT, given, metre, access, lambda scale: collada.read_text(content, _TEXT, access, scale))


def _read_collada(
    path: str, given: Attributes, metre: float, access: FileAccess, read_content: "Callable[[float], collada.Content]"
) -> Reading:
    context, source = Context(access), Source(path)
    check_given(given, source, context)
    bodies: list[KinBody] = []
    sensors: list[AttachedSensor] = []
    gravity = failure = None
    description = ""
    try:
        content = read_content(metre * uniform(given_scale(given), source, context))
        gravity, description = content.gravity, content.description
        if not content.bodies and not content.others and not content.sensors:
            raise SourceError("there is no body in it", source)
        if not content.bodies and content.others:
            message = "without a kinematics scene, OpenRAVE loads no body of it into an environment"
            context.diagnostics.error("no-kinematics", message, source, "read it with ReadKinBodyURI")
        built_bodies, names = (*content.bodies, *content.others), _NameSuffixes()
        give(given, built_bodies)
        for built in built_bodies:
            built.name = names.give(built.name or "body")
            bodies.append(built.freeze(context.diagnostics))
            if built.refusal is not None:
                raise built.refusal
        sensors = content.sensors
    except SourceError as error:
        failure = error
    except ArithmeticError:
        failure = SourceError("a number in the file is too large or too small to compute with", source)
    scene = Scene(tuple(bodies), None, gravity, tuple(sensors), description)
    return Reading(scene, context.diagnostics, failure, access.files, renames=True)


class _NameSuffixes:
    """Names of a file's bodies, each with the next numeric suffix for a duplicate."""

    def __init__(self) -> None:
        self._next: dict[str, int] = {}

    def give(self, name: str) -> str:
        """Reserve and return a unique name: the given one, with a numeric suffix if it is in use."""
        unused = name
        while unused in self._next:
            unused = f"{name}{self._next[name]}"
            self._next[name] += 1
        self._next[unused] = 0
        return unused


def _without_scheme(uri: str) -> str:
    """Return the path of a ``file:`` or ``openrave:`` URI; other names are unchanged."""
    scheme, separator, rest = uri.partition(":")
    if not separator or scheme.lower() not in {"file", "openrave"}:
        return uri
    path = rest.removeprefix("//") if scheme.lower() == "file" else rest.lstrip("/")
    return unquote(path)


def _read_mesh_file(path: str, given: Attributes, access: FileAccess) -> Reading:
    """Read a mesh file as a static body with the file's name."""
    context = Context(access)
    source = Source(path)
    check_given(given, source, context)
    body = BodyBuilder(is_robot=False, source=source)
    add_mesh(body, path, given_scale(given), source, context)
    give(given, [body])
    scene = Scene((body.freeze(context.diagnostics),))
    return Reading(scene, context.diagnostics, None, access.files, renames=True)

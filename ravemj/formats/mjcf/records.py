"""Bodies as JSON in a ``<custom>`` text of MJCF: lossless storage of what MJCF cannot express.

A record becomes a dictionary of its fields that differ from the defaults. Poses are seven numbers, x y z and a
quaternion w x y z; meshes are names of ``<mesh>`` elements. Redundant data are left out: sources, expressions of mimic
joints, and masses that the MJCF has unchanged.
"""

import json
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass, replace
from functools import cache
from typing import NamedTuple, cast

import numpy as np

from ravemj.core.transforms import Pose
from ravemj.errors import Origin, Source
from ravemj.formats.mjcf.inertia import legal_inertial
from ravemj.formats.mjcf.lines import attribute_text
from ravemj.formats.mjcf.tidy import tidy_vector
from ravemj.model import scene
from ravemj.model.expressions import Expression
from ravemj.model.scene.record import Record

PREFIX = "ravemj/"
"""Prefix of the names of ``<text>`` elements that contain bodies."""

SCENE = "ravemj"
"""Name of the ``<text>`` element that contains everything except bodies."""

_KINDS: dict[str, type] = {
    kind.__name__: kind
    for kind in (
        *(row.shape for row in scene.SHAPE_TYPES),
        *(type(row.device) for row in scene.SENSOR_KINDS.values()),
    )
}
"""Shape and sensor classes by name. The JSON contains the name, since a field may hold any of them."""

_LEFT_OUT = {"source", "expression", "render_file", "collision_file"}


class StoredNames(NamedTuple):
    """Names of the parts of a body in the MJCF, and further data that show whether it was edited.

    Attributes:
        links: Name of each link.
        joints: Names of the MuJoCo joints of each joint.
        geoms: Number of geoms of each link.
        excludes: Pairs of names that are excluded.
        decomposed: Whether meshes are several convex parts.
        places: File and line of each link in the user's model file, as in the MJCF's comment about the link.
    """

    links: tuple[str, ...]
    joints: tuple[tuple[str, ...], ...]
    geoms: tuple[int, ...] = ()
    excludes: tuple[tuple[str, str], ...] = ()
    decomposed: bool = False
    places: tuple[str, ...] = ()

    def origin(self, link: int, here: Source) -> Source:
        """Return the position of a link in the user's model file or, if that is unknown, in the MJCF: ``here``."""
        if link >= len(self.places):
            return here
        file, _, line = self.places[link].rpartition(":")
        return Origin(file, int(line), here) if line.isdecimal() else Origin(self.places[link], 0, here)


def body_text(body: scene.KinBody, names: StoredNames, mesh_name: Callable[[scene.Mesh], str | None]) -> str:
    """Return a body as JSON; ``mesh_name`` declares a mesh and returns its name, or None if MuJoCo cannot load it."""
    links = tuple(_without_inertial(link) for link in body.links)
    stored = _RecordWriter(mesh_name).encode(replace(body, links=links))
    return json.dumps({"body": stored, "names": names._asdict()}, separators=(",", ":"), sort_keys=True)


def scene_text(content: scene.Scene, touching: Sequence[tuple[str, str]]) -> str:
    """Return everything in a scene except bodies as JSON, with the pairs excluded because they touch at the start."""
    stored = _RecordWriter(lambda _: None).encode(replace(content, bodies=()))
    return json.dumps({"scene": stored, "touching": touching}, separators=(",", ":"), sort_keys=True)


def read_body(text: str, meshes: Callable[[str], scene.Mesh], source: Source) -> tuple[scene.KinBody, StoredNames]:
    """Read a body, without expressions of mimic joints; omitted masses are ``UNKNOWN``.

    ``meshes`` returns a mesh by the name of its ``<mesh>`` element.

    Raises:
        ValueError: the text is damaged.
    """
    stored = _loaded(text)
    reader = _RecordReader(meshes, source)
    body = reader.decode(scene.KinBody, stored["body"])
    names = reader.decode(StoredNames, stored["names"])
    if not isinstance(body, scene.KinBody) or not isinstance(names, StoredNames):
        raise ValueError("it holds no body")
    if len(names.links) != len(body.links) or len(names.joints) != len(body.all_joints):
        raise ValueError("it has names of other parts")
    return body, names


def read_scene(text: str, source: Source) -> tuple[scene.Scene, tuple[tuple[str, str], ...]]:
    """Read everything in a scene except bodies, and the pairs of links, by name, that touch at the start.

    Raises:
        ValueError: the text is damaged.
    """

    def no_mesh(name: str) -> scene.Mesh:
        raise ValueError(f"it names the mesh {name}")

    stored, reader = _loaded(text), _RecordReader(no_mesh, source)
    content = reader.decode(scene.Scene, stored["scene"])
    touching = reader.decode(tuple[tuple[str, str], ...], stored["touching"])
    return cast("scene.Scene", content), cast("tuple[tuple[str, str], ...]", touching)


def _loaded(text: str) -> dict[str, object]:
    try:
        stored: object = json.loads(text)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    if not isinstance(stored, dict):
        raise ValueError("it is no JSON object")
    return cast("dict[str, object]", stored)


UNKNOWN = scene.Inertial(0.0, (0.0, 0.0, 0.0), ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
"""Placeholder of mass properties that are to be read from the MJCF."""


def _without_inertial(link: scene.Link) -> scene.Link:
    """Return a link without its mass properties if the MJCF contains them exactly, else the link unchanged."""
    own = link.inertial
    com = attribute_text(own.com)
    is_plain = legal_inertial(own) is own and own.axes is None and not own.undefined and tidy_vector(com) == com
    return replace(link, inertial=UNKNOWN) if is_plain else link


class _RecordWriter:
    def __init__(self, mesh_name: Callable[[scene.Mesh], str | None]) -> None:
        self._mesh_name = mesh_name

    def encode(self, value: object) -> object:
        """Convert a record, pose, mesh, container or plain value to JSON types."""
        if isinstance(value, scene.Mesh):
            name = self._mesh_name(value)
            return name or {"vertices": value.vertices.tolist(), "triangles": value.triangles.tolist()}
        if isinstance(value, Pose):
            return [*value.position, *value.wxyz]
        if isinstance(value, Record) and is_dataclass(value):
            stored: dict[str, object] = {}
            if type(value).__name__ in _KINDS:
                stored["class"] = type(value).__name__
            for field in fields(value):
                part: object = getattr(value, field.name)
                is_said = part is UNKNOWN or field.name in _LEFT_OUT
                if not is_said and (field.default is MISSING or part != field.default):
                    stored[field.name] = self.encode(part)
            return stored
        if isinstance(value, tuple):
            return [self.encode(part) for part in cast("tuple[object, ...]", value)]
        return value


class _RecordReader:
    def __init__(self, meshes: Callable[[str], scene.Mesh], source: Source) -> None:
        self._meshes = meshes
        self._source = source

    def decode(self, kind: object, value: object) -> object:
        """Convert JSON types to a value of the type ``kind``; raise ValueError if ``value`` does not fit."""
        if kind is scene.Mesh:
            return self._mesh(value)
        if kind is Pose:
            x, y, z, *wxyz = _numbers(value, 7)
            return Pose((x, y, z), (wxyz[0], wxyz[1], wxyz[2], wxyz[3]))
        if isinstance(kind, type) and typing.get_origin(kind) is None and issubclass(kind, (Record, StoredNames)):
            return self._record(kind, value)
        return self._composed(kind, value)

    def _composed(self, kind: object, value: object) -> object:
        """Convert JSON types to a tuple, union, literal or plain value."""
        origin, arguments = typing.get_origin(kind), typing.get_args(kind)
        if origin is types.UnionType or origin is typing.Union:
            return self._any_of(arguments, value)
        if origin is tuple:
            return self._tuple(arguments, value)
        if origin is not typing.Literal:
            return _plain(kind, value)
        if value not in arguments:
            raise ValueError(f"{value!r} is none of {arguments}")
        return value

    def _mesh(self, value: object) -> scene.Mesh:
        if isinstance(value, str):
            return self._meshes(value)
        if not isinstance(value, dict):
            raise ValueError("a mesh is neither a name nor numbers")
        numbers = cast("dict[str, list[list[float]]]", value)
        return scene.Mesh(np.array(numbers["vertices"], np.float64), np.array(numbers["triangles"], np.int_))

    def _any_of(self, kinds: tuple[object, ...], value: object) -> object:
        if value is None and types.NoneType in kinds:
            return None
        classes = [kind for kind in kinds if kind is not types.NoneType]
        return self.decode(classes[0], value)

    def _tuple(self, kinds: tuple[object, ...], value: object) -> tuple[object, ...]:
        if not isinstance(value, list):
            raise ValueError(f"{value!r} is no list")
        parts = cast("list[object]", value)
        if len(kinds) == 2 and kinds[1] is ...:
            return tuple(self.decode(kinds[0], part) for part in parts)
        if len(kinds) != len(parts):
            raise ValueError(f"there are {len(parts)} values in place of {len(kinds)}")
        return tuple(self.decode(kind, part) for kind, part in zip(kinds, parts, strict=True))

    def _record(self, kind: type, value: object) -> object:
        if not isinstance(value, dict):
            raise ValueError(f"{value!r} is no {kind.__name__}")
        stored = cast("dict[str, object]", value)
        actual = _KINDS.get(str(stored.get("class")), kind)
        hints = _hints(actual)
        known = {name: self.decode(hints[name], part) for name, part in stored.items() if name in hints}
        if "source" in hints:
            known["source"] = self._source
        if "expression" in hints:
            known["expression"] = None
        if "inertial" in hints:
            known.setdefault("inertial", UNKNOWN)
        try:
            return actual(**known)
        except TypeError as error:
            raise ValueError(str(error)) from None


@cache
def _hints(kind: type) -> Mapping[str, object]:
    return typing.get_type_hints(kind, {**vars(typing), "Expression": Expression})


def _plain(kind: object, value: object) -> object:
    if kind is float and isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    if isinstance(kind, type) and type(value) is kind:
        return value
    raise ValueError(f"{value!r} is no {kind}")


def _numbers(value: object, count: int) -> list[float]:
    parts = cast("list[object]", value) if isinstance(value, list) else []
    if len(parts) != count:
        raise ValueError(f"{value!r} are not {count} numbers")
    return [cast("float", _plain(float, part)) for part in parts]

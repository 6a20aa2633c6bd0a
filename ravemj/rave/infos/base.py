"""Base classes of infos, and OpenRAVE's JSON format of their fields.

The fields of infos declare their keys with ``json_field``. Writing and reading both multiply lengths by a given scale.
Poses are [w, x, y, z, tx, ty, tz], and arrays are lists.
"""

# Fields have the names that OpenRAVE gives them, and users may put any value into them.
# pyright: reportUnknownArgumentType=false, reportUnknownVariableType=false, reportUnknownMemberType=false
# pyright: reportUnknownLambdaType=false
# As above.
# pyright: reportUnknownArgumentType=false, reportUnknownVariableType=false, reportPrivateUsage=false

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import MISSING, Field, dataclass, field, fields
from enum import Enum
from functools import partial
from typing import Any, ClassVar, NamedTuple, Protocol, Self, TypeVar, cast, dataclass_transform

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers, checked_transform
from ravemj.core.signatures import show_as_written
from ravemj.core.transforms import Pose, Vec3, pose_of
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import matrixFromPose
from ravemj.model.scene import Parameters
from ravemj.rave.trimesh import TriMesh

Json = dict[str, Any]


class Described(Protocol):
    """Protocol of objects that convert themselves to JSON and back: infos."""

    def SerializeJSON(self, unitScale: float = 1.0, options: object = None) -> Json:
        """Return the object as JSON."""
        ...

    def DeserializeJSON(self, obj: Json, unitScale: float = 1.0, options: object = None) -> None:
        """Set the fields from JSON."""
        ...


class Form(NamedTuple):
    """Conversion of a field to JSON and back.

    Attributes:
        write: A function of the field and the scale that returns the JSON value.
        read: A function of the JSON value, the scale and the current field that returns the new field.
    """

    write: Callable[[Any, float], Any]
    read: Callable[[Any, float, Any], Any]


class Entry(NamedTuple):
    """JSON key and its field.

    Attributes:
        key: The key.
        field: The name of the field.
        form: The conversion.
        optional: Whether the key is omitted if the field is None or has its default value.
        of: The attribute of the described scene object that holds the same value; empty if it is not needed.
    """

    key: str
    field: str
    form: Form
    optional: bool = False
    of: str = ""


def plain(value: Any) -> Any:  # noqa: ANN401 - what JSON can hold
    """Convert a value to lists, dicts, numbers and strings."""
    if isinstance(value, Enum):
        return plain(value.value)
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, str | bytes) or not isinstance(value, Iterable):
        return value
    return [plain(item) for item in value]


def lengths(power: int = 1) -> Form:
    """Return the conversion of numbers with the unit m^power."""

    def scaled(values: Any, scale: float) -> Any:  # noqa: ANN401 - a number or an array
        return plain(np.asarray(values, dtype=float) * scale**power)

    return Form(scaled, lambda value, scale, present: _array(scaled(value, scale)))


def _array(value: Any) -> Any:  # noqa: ANN401 - what JSON holds
    """Return a list of numbers as an array, and anything else unchanged."""
    is_numbers = isinstance(value, list) and value and all(type(item) in {int, float} for item in value)
    return np.array(value, dtype=float) if is_numbers else value


def _write_pose(transform: Any, scale: float) -> list[float]:  # noqa: ANN401 - what users put into the field
    numbers = pose_of(checked_transform(transform, "transform")).numbers()
    numbers[4:] *= scale
    return numbers.tolist()


def _read_pose(numbers: Sequence[float], scale: float, present: object) -> Any:  # noqa: ANN401 - an array
    del present
    pose = np.array(numbers, dtype=float)
    if pose.shape != (7,):
        raise ArgumentError(f"transform: is {plain(numbers)}, and should be seven numbers [w, x, y, z, tx, ty, tz]")
    pose[4:] *= scale
    return matrixFromPose(pose)


def _read_parameters(items: Sequence[Json], key: str, present: Mapping[str, Any]) -> Json:
    arrays = dict(present)
    for item in items:
        name = item.get("id", item.get("key"))
        if not name:
            raise ArgumentError(f"parameters: {item} has no id")
        if item.get("__deleted__"):
            arrays.pop(name, None)
        else:
            arrays[name] = _array(item[key])
    return arrays


def parameters(key: str) -> Form:
    """Return the conversion of named values: a list of dicts, each with ``id`` and the value under ``key``."""
    return Form(
        lambda values, scale: [{"id": name, key: plain(value)} for name, value in values.items()],
        lambda items, scale, present: _read_parameters(items, key, present),
    )


def info(kind: Callable[[], Described]) -> Form:
    """Return the conversion of a field with an info or None."""

    def read(value: Json | None, scale: float, present: Described | None) -> Described | None:
        if value is None:
            return None
        changed = present or kind()
        changed.DeserializeJSON(value, scale)
        return changed

    return Form(lambda value, scale: None if value is None else value.SerializeJSON(scale), read)


def infos(kind: Callable[[], Described], robot: Callable[[], Described] | None = None) -> Form:
    """Return the conversion of a list of infos.

    Reading updates the info with the same id, or else the same name. If there is none, it adds an info. An item with
    ``__deleted__`` removes its info.

    Args:
        kind: The class of the infos.
        robot: The class for items with ``isRobot``, if it differs.
    """

    def read(items: Sequence[Json], scale: float, present: Sequence[Described]) -> list[Described]:
        called, read_before = _Called(present), dict[int, Described]()
        for item in items:
            if not isinstance(item, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance] - what files hold
                raise TypeError(f"is {item!r}, and should be an object")
            known = called.first(item)
            if known is not None:
                called.remove(known)
            if item.get("__deleted__"):
                continue
            if id(known) in read_before:
                raise ValueError(f"two are called '{item.get('id') or item['name']}'; give each a name of its own")
            changed = known or (robot if robot and item.get("isRobot") else kind)()
            read_before[id(changed)] = changed
            changed.DeserializeJSON(item, scale)
            called.add(changed)
        return called.listed()

    return Form(lambda values, scale: [described.SerializeJSON(scale) for described in values], read)


class _Called:
    """List of infos with look-up by id and name."""

    def __init__(self, infos: Sequence[Described]) -> None:
        self._place_of: dict[int, int] = {}  # includes removed infos that may be added again, by identity
        self._at: dict[int, Described] = {}
        self._called: dict[tuple[str, object], set[int]] = {}
        for info in infos:
            self.add(info)

    def add(self, info: Described) -> None:
        """Add an info at the end, or at its previous position if it was removed."""
        place = self._place_of.setdefault(id(info), len(self._place_of))
        self._at[place] = info
        for key in _calls("_", vars(info)):
            self._called.setdefault(key, set()).add(place)

    def remove(self, info: Described) -> None:
        """Remove an info, whose id and name have not changed since it was added."""
        place = self._place_of[id(info)]
        del self._at[place]
        for key in _calls("_", vars(info)):
            self._called[key].discard(place)

    def first(self, item: Json) -> Described | None:
        """Return the first info with the id or name of a JSON object; None if there is none."""
        places = [place for key in _calls("", item) for place in self._called.get(key, ())]
        return self._at[min(places)] if places else None

    def listed(self) -> list[Described]:
        return [info for _, info in sorted(self._at.items(), key=lambda item: item[0])]


def _calls(prefix: str, fields: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    """Yield the fields ``id`` and ``name`` that are not empty; in ``fields``, ``prefix`` precedes these keys."""
    for name in ("id", "name"):
        value = fields.get(prefix + name)
        if value and isinstance(value, str):
            yield name, value


def named(names: Mapping[Any, str]) -> Form:
    """Return the conversion of an enumeration; ``names`` are the JSON words of its members."""
    values = {word: value for value, word in reversed(list(names.items()))}  # the first of two equal words wins

    def read(word: str, scale: float, present: object) -> Any:  # noqa: ANN401 - a member of the enumeration
        del scale, present
        if word not in values:
            raise ArgumentError(f"there is no type '{word}'; there are {', '.join(filter(None, values))}")
        return values[word]

    return Form(lambda value, scale: names[value], read)


def _text(value: Any) -> str | None:  # noqa: ANN401 - whatever JSON holds
    if value is not None and not isinstance(value, str):
        raise TypeError(f"is {value!r}, and should be a text")
    if value is not None:
        value.encode()  # raises an error for unpaired surrogates, which neither files nor terminals accept
    return value


PLAIN = Form(lambda value, scale: plain(value), lambda value, scale, present: _array(value))
TEXT = Form(lambda value, scale: "" if value is None else str(value), lambda value, scale, present: _text(value))
POSE = Form(_write_pose, _read_pose)
LENGTHS = lengths()


T = TypeVar("T")


class FieldOfClass:
    """Class attribute for a field without default value, so that ``dir(Class)`` and scripts find it there."""


def json_field(
    key: str, form: Form = PLAIN, *, default: T, optional: bool = False, of: str = "", kw_only: bool = False
) -> T:
    """Declare a field of an info and its key in JSON.

    Args:
        key: The key; empty for a field without a fixed key in JSON.
        form: The conversion to JSON and back.
        default: The default value; each new info gets a copy.
        optional: Whether the key is omitted if the field is None or has its default value.
        of: The attribute of the described scene object that holds the same value; empty if it is not needed.
        kw_only: Whether the constructor accepts the field only by keyword.
    """
    metadata = {"entry": Entry(key, "", form, optional, of)}
    if isinstance(default, Hashable):
        return field(default=default, metadata=metadata, kw_only=kw_only)
    copied = getattr(default, "copy", partial(deepcopy, default))  # lists, dicts and arrays copy themselves faster
    return field(default_factory=copied, metadata=metadata, kw_only=kw_only)


@dataclass_transform(eq_default=False, field_specifiers=(json_field, field))
def info_class(cls: type[T]) -> type[T]:
    """Class decorator: a dataclass whose fields are also class attributes, with a table of their JSON keys.

    The key of a field with a plain default is its name in camel case; names with a leading underscore have none.
    """
    made: Any = dataclass(eq=False, repr=False)(cls)
    for field_ in fields(made):
        if not hasattr(made, field_.name):
            setattr(made, field_.name, FieldOfClass())
    entries = [
        (field_.name, field_.metadata.get("entry", Entry(_camel(field_.name), "", PLAIN))) for field_ in fields(made)
    ]
    made._entries = tuple(entry._replace(field=name) for name, entry in entries if entry.key)
    if "_called" not in vars(cls):
        made._called = cls.__name__
    show_as_written(made)
    return made


def _camel(name: str) -> str:
    """Return the JSON key of a field: ``gearRatio`` for ``gear_ratio``, empty for ``_name``."""
    first, *rest = name.split("_")
    return first and first + "".join(word.capitalize() for word in rest)


@info_class
class Info(ApiObject):
    """Base class of infos. Infos are equal if their fields are; ``repr`` is an expression that creates the info."""

    _called: ClassVar[str]
    """Name of the class for ``repr`` and error messages; by default ``__name__``."""
    _entries: ClassVar[tuple[Entry, ...]]
    """Conversions of all fields to JSON keys."""
    _internal: ClassVar[tuple[str, ...]] = (
        *("of", "geometry", "draw", "link", "adjacent", "joint", "motor", "manipulator", "sensor", "camera"),
        *("named_values", "transform", "values_by_axis", "same_structure", "parameters", "with_parameters"),
    )

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(
            _same(getattr(self, field_.name), getattr(other, field_.name)) for field_ in fields(self) if field_.compare
        )

    __hash__ = None  # pyright: ignore[reportAssignmentType] - fields change

    def __repr__(self) -> str:
        shown = {field_.name: getattr(self, field_.name) for field_ in fields(self) if field_.repr}
        new = {field_.name: _default(field_) for field_ in fields(self)}
        changed = [f"{name}={_written(value)}" for name, value in shown.items() if not _same(value, new[name])]
        return f"{self._called}({', '.join(changed)})"

    def SerializeJSON(self, unitScale: float = 1.0, options: object = None) -> Json:
        """Return the info in OpenRAVE's JSON format: dicts, lists, numbers and texts.

        Args:
            unitScale: Multiplies all lengths.
            options: Not used.
        """
        del options
        new = type(self)()
        written = Json()
        for key, name, form, optional, _ in self._json():
            value = getattr(self, name)
            if not (optional and (_same(value, getattr(new, name)) or value is None)):
                written[key] = form.write(value, unitScale)
        return written

    def DeserializeJSON(self, obj: Json, unitScale: float = 1.0, options: object = None) -> None:
        """Set fields from OpenRAVE's JSON format. Fields whose keys are missing keep their values.

        Args:
            obj: A result of ``SerializeJSON``, or a part of one.
            unitScale: Multiplies all lengths.
            options: Not used.

        Raises:
            ArgumentError: a value has the wrong type or shape.
        """
        del options
        checked_kind(obj, Mapping, f"{self._called}.DeserializeJSON: obj", "a dict")
        for key, name, form, *_ in (entry for entry in self._json(obj) if entry.key in obj):
            try:
                setattr(self, name, form.read(obj[key], unitScale, getattr(self, name)))
            except KeyError as error:
                raise ArgumentError(f"{self._called}.DeserializeJSON: {key}: {error} is missing") from None
            except (ValueError, TypeError, AttributeError) as error:
                raise ArgumentError(f"{self._called}.DeserializeJSON: {key}: {error}") from None

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        """Return the conversions of fields to JSON keys; ``obj`` is the JSON to be read, or None for writing."""
        del obj
        return self._entries

    def __dir__(self) -> list[str]:
        shown = {field_.name for field_ in fields(self) if field_.repr}
        return sorted({*super().__dir__(), *shown})


@info_class
class IdentifiedInfo(Info):
    """Info with an id."""

    _id: str | None = json_field("id", TEXT, default=None, kw_only=True)


@info_class
class ParameterFields(IdentifiedInfo):
    """Parameters that users attach to links and joints: numbers, integers and strings by name."""

    _mapFloatParameters: Mapping[str, ArrayLike] = json_field(
        "floatParameters", parameters("values"), default={}, optional=True
    )
    _mapIntParameters: Mapping[str, ArrayLike] = json_field(
        "intParameters", parameters("values"), default={}, optional=True
    )
    _mapStringParameters: Mapping[str, str] = json_field(
        "stringParameters", parameters("value"), default={}, optional=True
    )

    def with_parameters(self, parameters: Parameters) -> Self:
        """Set the fields from parameters; return this object."""
        self._mapFloatParameters = {name: np.array(values) for name, values in parameters.floats}
        self._mapIntParameters = {name: np.array(values, dtype=np.int_) for name, values in parameters.integers}
        self._mapStringParameters = dict(parameters.texts)
        return self

    def parameters(self) -> Parameters:
        """Return the fields as parameters."""
        floats = {name: checked_numbers(values, name).ravel() for name, values in self._mapFloatParameters.items()}
        integers = {name: checked_numbers(values, name).ravel() for name, values in self._mapIntParameters.items()}
        return Parameters(
            tuple((name, tuple(values.tolist())) for name, values in floats.items()),
            tuple((name, tuple(values.astype(np.int_).tolist())) for name, values in integers.items()),
            tuple((name, str(text)) for name, text in self._mapStringParameters.items()),
        )


def vector(values: ArrayLike, name: str) -> Vec3:
    """Return the first three numbers of a field.

    Raises:
        ArgumentError: there are fewer than three numbers, or one is not finite.
    """
    numbers = checked_numbers(values, name).ravel()
    if len(numbers) < 3 or not np.isfinite(numbers[:3]).all():
        raise ArgumentError(f"{name}: is {numbers.tolist()}, and should be three finite numbers")
    x, y, z = numbers[:3].tolist()
    return (x, y, z)


def pose(values: ArrayLike, name: str) -> Pose:
    """Return the pose of a field: 4x4, 3x4 or [w, x, y, z, tx, ty, tz]."""
    return pose_of(checked_transform(values, name))


def _default(field_: Field[Any]) -> object:
    return field_.default if field_.default_factory is MISSING else field_.default_factory()


_ROUNDING = 1e-14
"""Tolerance of equal matrices after a conversion of their rotations to quaternions, as in JSON."""


def _same(first: Any, second: Any) -> bool:  # noqa: ANN401 - whatever users put into fields
    """Return whether two values are equal, with a tolerance for arrays; lists are compared by element."""
    if isinstance(first, TriMesh) and isinstance(second, TriMesh):
        return _same(first.toDict(), second.toDict())
    if isinstance(first, Mapping) and isinstance(second, Mapping):
        return first.keys() == second.keys() and all(_same(first[key], second[key]) for key in first)
    if isinstance(first, np.ndarray) or isinstance(second, np.ndarray):
        numbers = np.asarray(cast("Any", first)), np.asarray(cast("Any", second))
        return numbers[0].shape == numbers[1].shape and np.allclose(*numbers, rtol=0.0, atol=_ROUNDING)
    if isinstance(first, list | tuple) and isinstance(second, list | tuple):
        return len(first) == len(second) and all(map(_same, first, second))
    if first in (None, "") and second in (None, ""):
        return True  # in OpenRAVE's JSON a missing string is empty
    return bool(first == second)


def _written(value: object) -> str:
    """Return a Python expression for a value that needs no imports; arrays are written as lists."""
    if isinstance(value, Enum):
        return f"{type(value).__name__}.{value.name}"
    if isinstance(value, np.ndarray | np.generic):
        return repr(value.tolist())
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key!r}: {_written(item)}' for key, item in value.items())}}}"
    if isinstance(value, Sequence) and not isinstance(value, str | bytes):
        return f"[{', '.join(map(_written, value))}]"
    return repr(value)

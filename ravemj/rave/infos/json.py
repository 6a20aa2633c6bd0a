"""OpenRAVE's JSON format of infos: which key holds which field, and in which form.

The fields of infos declare their keys, see ``base``. Writing and reading both multiply lengths by a given scale. Poses
are [w, x, y, z, tx, ty, tz], and arrays are lists.
"""

# Fields have the names that OpenRAVE gives them, and users put anything into them.
# pyright: reportUnknownArgumentType=false, reportUnknownVariableType=false, reportUnknownMemberType=false
# pyright: reportUnknownLambdaType=false

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from enum import Enum
from typing import Any, NamedTuple, Protocol

import numpy as np

from ravemj.core.arrays import checked_transform
from ravemj.core.transforms import pose_of
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import matrixFromPose

Json = dict[str, Any]


class Described(Protocol):
    """An object that converts itself to JSON and back: an info."""

    def SerializeJSON(self, unitScale: float = 1.0, options: object = None) -> Json:
        """Return the object as JSON."""
        ...

    def DeserializeJSON(self, obj: Json, unitScale: float = 1.0, options: object = None) -> None:
        """Set the fields from JSON."""
        ...


class Form(NamedTuple):
    """The conversion of a field to JSON and back.

    Attributes:
        write: A function of the field and the scale that returns the JSON value.
        read: A function of the JSON value, the scale and the current field that returns the new field.
    """

    write: Callable[[Any, float], Any]
    read: Callable[[Any, float, Any], Any]


class Entry(NamedTuple):
    """A JSON key and its field.

    Attributes:
        key: The key.
        field: The name of the field.
        form: The conversion.
        optional: Whether the key is left out if the field is None or has its default value.
        of: The attribute of the described object that holds the same value, for classes that look it up.
    """

    key: str
    field: str
    form: Form
    optional: bool = False
    of: str = ""


def plain(value: Any) -> Any:  # noqa: ANN401 - what JSON can hold
    """Return a value made of lists, dicts, numbers and texts."""
    if isinstance(value, Enum):
        return plain(value.value)
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in value.items()}
    if isinstance(value, str | bytes) or not isinstance(value, Iterable):
        return value
    return [plain(one) for one in value]


def lengths(power: int = 1) -> Form:
    """Return the form of numbers with the unit m^power."""

    def scaled(values: Any, scale: float) -> Any:  # noqa: ANN401 - a number or an array
        return plain(np.asarray(values, dtype=float) * scale**power)

    return Form(scaled, lambda value, scale, present: _array(scaled(value, scale)))


def _array(value: Any) -> Any:  # noqa: ANN401 - what JSON holds
    """Return a list of numbers as an array, and anything else unchanged."""
    is_numbers = isinstance(value, list) and value and all(type(one) in {int, float} for one in value)
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
    found = dict(present)
    for item in items:
        name = item.get("id", item.get("key"))
        if not name:
            raise ArgumentError(f"parameters: {item} has no id")
        if item.get("__deleted__"):
            found.pop(name, None)
        else:
            found[name] = _array(item[key])
    return found


def parameters(key: str) -> Form:
    """Return the form of named values: a list of dicts, each with ``id`` and with the value under ``key``."""
    return Form(
        lambda values, scale: [{"id": name, key: plain(value)} for name, value in values.items()],
        lambda items, scale, present: _read_parameters(items, key, present),
    )


def info(kind: Callable[[], Described]) -> Form:
    """Return the form of a field that holds one info or None."""

    def read(value: Json | None, scale: float, present: Described | None) -> Described | None:
        if value is None:
            return None
        changed = present or kind()
        changed.DeserializeJSON(value, scale)
        return changed

    return Form(lambda value, scale: None if value is None else value.SerializeJSON(scale), read)


def infos(kind: Callable[[], Described], robot: Callable[[], Described] | None = None) -> Form:
    """Return the form of a list of infos.

    Reading changes the info of the list that has the same id, or else the same name. Without one, it adds an info. An
    item with ``__deleted__`` removes its info.

    Args:
        kind: The class of the infos.
        robot: The class for items with ``isRobot``, if it is another one.
    """

    def read(items: Sequence[Json], scale: float, present: Sequence[Described]) -> list[Described]:
        found, read_before = _Called(present), dict[int, Described]()
        for item in items:
            if not isinstance(item, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance] - what files hold
                raise TypeError(f"is {item!r}, and should be an object")
            known = found.first(item)
            if known is not None:
                found.remove(known)
            if item.get("__deleted__"):
                continue
            if id(known) in read_before:
                raise ValueError(f"two are called '{item.get('id') or item['name']}'; give each a name of its own")
            changed = known or (robot if robot and item.get("isRobot") else kind)()
            read_before[id(changed)] = changed
            changed.DeserializeJSON(item, scale)
            found.add(changed)
        return found.listed()

    return Form(lambda values, scale: [one.SerializeJSON(scale) for one in values], read)


class _Called:
    """A list of infos, found by their ids and names."""

    def __init__(self, infos: Sequence[Described]) -> None:
        self._place_of: dict[int, int] = {}  # also of infos that were removed and may come back, by identity
        self._at: dict[int, Described] = {}
        self._called: dict[tuple[str, object], set[int]] = {}
        for info in infos:
            self.add(info)

    def add(self, info: Described) -> None:
        """Add an info at the end, or where it was before."""
        place = self._place_of.setdefault(id(info), len(self._place_of))
        self._at[place] = info
        for key in _calls("_", vars(info)):
            self._called.setdefault(key, set()).add(place)

    def remove(self, info: Described) -> None:
        """Remove an info, which has the id and the name that it had when it was added."""
        place = self._place_of[id(info)]
        del self._at[place]
        for key in _calls("_", vars(info)):
            self._called[key].discard(place)

    def first(self, item: Json) -> Described | None:
        """Return the first info that has the id or the name of an item."""
        places = [place for key in _calls("", item) for place in self._called.get(key, ())]
        return self._at[min(places)] if places else None

    def listed(self) -> list[Described]:
        """Return the infos in their order."""
        return [info for _, info in sorted(self._at.items(), key=lambda item: item[0])]


def _calls(prefix: str, fields: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    """Yield the id and the name among some fields, unless they are empty."""
    for name in ("id", "name"):
        value = fields.get(prefix + name)
        if value and isinstance(value, str):
            yield name, value


def named(names: Mapping[Any, str]) -> Form:
    """Return the form of an enumeration; ``names`` are the words that JSON has for its members."""
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
        value.encode()  # raises at halves of surrogate pairs, which no file and no terminal takes
    return value


PLAIN = Form(lambda value, scale: plain(value), lambda value, scale, present: _array(value))
TEXT = Form(lambda value, scale: "" if value is None else str(value), lambda value, scale, present: _text(value))
POSE = Form(_write_pose, _read_pose)
LENGTHS = lengths()

"""Damaged archives and mesh files: sizes, offsets, counts and references that lie.

``FileFuzzer`` makes them from a seed, as ``fuzzing.Fuzzer`` makes documents: number n of a seed is always the same.
"""

import base64
import copy
import io
import json
import random
import re
import struct
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from fuzzing import Files

DATA = Path(__file__).resolve().parent / "data"
ARM = (DATA / "collada" / "arm.dae").read_bytes()
SEEDS = {suffix: (DATA / "meshes" / f"wedge.{suffix}").read_bytes() for suffix in ("off", "ply", "stl")}
LARGE = [0, 1, 2, 3, 0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0xFFFFFFF0, 0xFFFFFFFF]
COUNTS = [-1, 0, 1, 2, 3, 4, 5, 9, 1000, 10**6, 30_000_000, 2**31, 2**32 - 1, 2**63, 10**25, 0.5, 3e7, 1e300]
OTHERS = [None, True, "", "x", [], {}, [0, 0], "data:,", "data:application/octet-stream;base64,AAAA"]

_LOCAL, _CENTRAL, _END = b"PK\3\4", b"PK\1\2", b"PK\5\6"
_NO_TIME = (1980, 1, 1, 0, 0, 0)
_NUMBER = re.compile(rb"\d+")


class FileFuzzer:
    """Makes damaged files.

    Attributes:
        seeds: Nothing; what is damaged is always the same.
    """

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self.seeds: list[Files] = []

    def make(self, number: int) -> Files:
        """Return a damaged file of some kind by its name."""
        source = random.Random(f"{self._seed}/{number}")
        kind, make = source.choice([("zae", archive), ("zae", archive), ("gltf", gltf), ("glb", glb), *_TEXTS])
        return {f"main.{kind}": make(source)}


def archive(source: random.Random) -> bytes:
    """Return a ``.zae`` archive with a document or two, most of them damaged."""
    document = source.choice(
        [ARM, b"<COLLADA/>", _references(source), b"<COLLADA>" + b"<a/>" * 10 ** source.randint(1, 6)]
    )
    members = {"arm.dae": document, f"{source.choice(['x', 'sub/x', '../x', '/x'])}.dae": ARM[: source.randrange(9999)]}
    named = source.choice(["arm.dae", "./arm.dae", "sub/x.dae", "../x.dae", "", "manifest.xml", "x.zae", "%00"])
    members["manifest.xml"] = source.choice([b"", b"<dae_root>%s</dae_root>" % named.encode(), b"<a>" * 300])
    members["x.zae"] = b"PK\5\6" + bytes(18)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as opened:
        for name in source.sample(list(members), source.randint(1, len(members))):
            method = source.choice(
                [zipfile.ZIP_DEFLATED] * 5 + [zipfile.ZIP_STORED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA]
            )
            opened.writestr(zipfile.ZipInfo(name, _NO_TIME), members[name], method)
    data = bytearray(stream.getvalue())
    for _ in range(source.choice([0, 1, 1, 2, 3, 6])):
        source.choice([_change_header, _change_header, _change_byte, _repeat_entries, _cut, _prepend])(data, source)
    return bytes(data)


def _references(source: random.Random) -> bytes:
    """Return a document whose nodes double, or lead to other members."""
    others = ["#n0", "x.dae#n1", "sub/x.dae#x", "../x.dae", "arm.dae#n1", "/etc/hostname#n1", "x.zae#n1"]
    nodes = "".join(
        f'<node id="n{k}"><instance_node url="{source.choice([f"#n{k - 1}"] * 5 + others)}"/>'
        f'<instance_node url="#n{k - 1}"/></node>'
        for k in range(1, source.randint(2, 40))
    )
    scene = '<visual_scene id="s"><instance_node url="#n1"/></visual_scene>'
    return f'<COLLADA><node id="n0"/>{nodes}{scene}<scene><instance_visual_scene url="#s"/></scene></COLLADA>'.encode()


def _change_header(data: bytearray, source: random.Random) -> None:
    """Change a size, an offset, a flag or another field of a header."""
    places = [found.start() for mark in (_LOCAL, _CENTRAL, _END) for found in re.finditer(re.escape(mark), data)]
    if places:
        at = source.choice(places) + source.choice([4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30, 32, 34, 42])
        width = source.choice([2, 4])
        data[at : at + width] = (source.choice(LARGE) & (256**width - 1)).to_bytes(width, "little")


def _change_byte(data: bytearray, source: random.Random) -> None:
    data[source.randrange(len(data))] = source.randrange(256)


def _repeat_entries(data: bytearray, source: random.Random) -> None:
    """Let several entries of the directory lead to one member."""
    start, end = data.find(_CENTRAL), data.rfind(_END)
    times = source.choice([2, 3, 100, 3000])
    if 0 <= start < end and times * (end - start) < 10**6:
        data[start:end] = data[start:end] * times
        if source.random() < 0.8:
            count = min(times * len(re.findall(re.escape(_CENTRAL), data[start:end])), 0xFFFF)
            end = data.rfind(_END)
            data[end + 8 : end + 16] = struct.pack("<HHI", count, count, end - start)


def _cut(data: bytearray, source: random.Random) -> None:
    start, length = source.randrange(len(data)), source.choice([1, 4, 30, 200, len(data)])
    if length < len(data) or start > 10:
        del data[start : start + length]
    data += b"PK"  # never empty


def _prepend(data: bytearray, source: random.Random) -> None:
    data[:0] = bytes(source.choice([1, 4, 1000]))


def gltf(source: random.Random) -> bytes:
    """Return glTF whose numbers and references are changed."""
    content = _scene(source)
    for _ in range(source.choice([0, 1, 1, 2, 3, 5])):
        _change_value(content, source)
    return json.dumps(content).encode()


def glb(source: random.Random) -> bytes:
    """Return the same as one binary file, the lengths in which may be wrong."""
    text = gltf(source)
    text += b" " * (-len(text) % 4)
    binary = struct.pack("<12f", *range(12)) * source.choice([0, 1, 10])
    lengths = [28 + len(text) + len(binary), len(text), len(binary)]
    if source.random() < 0.3:
        lengths[source.randrange(3)] = source.choice(LARGE)
    head = struct.pack("<4sIIII", b"glTF", source.choice([2, 2, 2, 1]), *lengths[:2], 0x4E4F534A)
    return head + text + struct.pack("<II", lengths[2], 0x004E4942) + binary


def _scene(source: random.Random) -> dict[str, Any]:
    points = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) * source.choice([1, 2, 100])
    uri = "data:application/octet-stream;base64," + base64.b64encode(points).decode()
    count = len(points) // 12
    positions = {"bufferView": 0, "byteOffset": 0, "componentType": 5126, "count": count, "type": "VEC3"}
    indices = {"bufferView": 1, "componentType": source.choice([5121, 5123, 5125]), "count": 3, "type": "SCALAR"}
    primitive = {"attributes": {"POSITION": 0}, "indices": 1, "mode": 4, "material": 0}
    nodes = [{"mesh": 0, "children": [], "scale": [1, 1, 1]}, {"children": [0], "translation": [0, 0, 1]}]
    return {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": uri, "byteLength": len(points)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(points), "byteStride": 12},
            {"buffer": 0, "byteLength": 12},
        ],
        "accessors": [positions, indices],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}],
        "meshes": [{"primitives": [primitive] * source.choice([1, 1, 3])}],
        "nodes": nodes,
        "scenes": [{"nodes": [1]}],
        "scene": 0,
    }


def _change_value(content: dict[str, Any], source: random.Random) -> None:
    """Replace, remove or repeat a value somewhere in a tree."""
    holder, key = source.choice(list(_places(content)))
    kind = source.random()
    if kind < 0.6:
        holder[key] = source.choice(COUNTS)
    elif kind < 0.75:
        holder[key] = copy.deepcopy(source.choice(OTHERS))
    elif kind < 0.85:
        del holder[key]
    elif isinstance(holder[key], list):
        holder[key] = holder[key] * source.choice([2, 1000])
    elif isinstance(holder, list):
        holder.extend([holder[key]] * source.choice([1, 1000]))


def _places(value: Any) -> Iterator[tuple[Any, Any]]:
    """Yield the places of all values in a tree: what holds them, and the key or index."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in list(items):
        yield value, key
        yield from _places(inner)


def _with_counts(content: bytes) -> Callable[[random.Random], bytes]:
    """Return a maker of a text or binary file with other numbers near its beginning."""

    def make(source: random.Random) -> bytes:
        numbers = [found for found in _NUMBER.finditer(content[:300])]
        data = bytearray(content)
        for found in sorted(source.sample(numbers, source.choice([1, 1, 2])), key=lambda found: -found.start()):
            data[found.start() : found.end()] = str(source.choice(COUNTS)).encode()
        if source.random() < 0.2:
            _change_byte(data, source)
        return bytes(data)

    return make


def _stl(source: random.Random) -> bytes:
    """Return binary STL with another number of facets than it says."""
    count = source.choice([0, 1, 2, 5])
    return (
        bytes(80) + source.choice([count, *LARGE]).to_bytes(4, "little") + bytes(50 * count + source.choice([0, 0, 1]))
    )


_TEXTS = [*((suffix, _with_counts(content)) for suffix, content in SEEDS.items() if suffix != "stl"), ("stl", _stl)]

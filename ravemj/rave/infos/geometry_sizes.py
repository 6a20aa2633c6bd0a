"""Getters and setters for the sizes of a ``GeometryInfo``, and its JSON format."""

# JSON and users put anything into the fields that the functions of forms take.
# pyright: reportUnknownLambdaType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownMemberType=false

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_vector
from ravemj.core.enumerations import NamedInt
from ravemj.core.transforms import Floats
from ravemj.model import scene
from ravemj.rave.enums import GeometryType
from ravemj.rave.infos.base import IdentifiedInfo
from ravemj.rave.infos.json import LENGTHS, POSE, Entry, Form, Json, named
from ravemj.rave.trimesh import TriMesh

VECTORS = ("_vGeomData", "_vGeomData2", "_vGeomData3", "_vGeomData4")
"""The fields of sizes that are vectors, in their order; sizes that are numbers share the first."""


class SideWallType(NamedInt):
    """The side of a cage that a wall stands on: towards negative or positive x or y."""

    NX = 0
    PX = 1
    NY = 2
    PY = 3


@dataclass
class SideWall:
    """A wall of a cage.

    Attributes:
        transf: ``T_cage_wall``, shape (4, 4).
        vExtents: The half extents of the wall [m], shape (3,).
        type: The side of the cage.
    """

    transf: ArrayLike = ((1.0, 0, 0, 0), (0, 1.0, 0, 0), (0, 0, 1.0, 0), (0, 0, 0, 1.0))
    vExtents: ArrayLike = (0.0, 0.0, 0.0)
    type: SideWallType = SideWallType.NX


@dataclass
class AxialSlice:
    """The radius of a shape of revolution at one height.

    Attributes:
        zOffset: The height [m].
        radius: The radius [m].
    """

    zOffset: float = 0.0
    radius: float = 0.0


class GeometrySizes(IdentifiedInfo):
    """The sizes of a shape by name. As in OpenRAVE, getters read the same numbers, whatever the type is."""

    _type: GeometryType
    _t: ArrayLike
    _vGeomData: ArrayLike
    _vGeomData2: ArrayLike
    _vRenderScale: ArrayLike
    _vCollisionScale: ArrayLike

    def GetBoxHalfExtents(self) -> Floats:
        """Return half the edge lengths of a box [m], shape (3,)."""
        return _first(self._vGeomData)

    def SetBoxHalfExtents(self, halfExtents: ArrayLike) -> None:
        """Set ``halfExtents``, half the edge lengths of a box [m], shape (3,)."""
        self._vGeomData = checked_vector(halfExtents, 3, "SetBoxHalfExtents: halfExtents")

    def GetContainerOuterExtents(self) -> Floats:
        """Return the outer edge lengths of a container [m], shape (3,)."""
        return _first(self._vGeomData)

    def SetContainerOuterExtents(self, outerExtents: ArrayLike) -> None:
        """Set ``outerExtents``, the outer edge lengths of a container [m], shape (3,)."""
        self._vGeomData = checked_vector(outerExtents, 3, "SetContainerOuterExtents: outerExtents")

    def GetContainerInnerExtents(self) -> Floats:
        """Return the edge lengths of a container's interior [m], shape (3,)."""
        return _first(self._vGeomData2)

    def SetContainerInnerExtents(self, innerExtents: ArrayLike) -> None:
        """Set ``innerExtents``, the edge lengths of a container's interior [m], shape (3,)."""
        self._vGeomData2 = checked_vector(innerExtents, 3, "SetContainerInnerExtents: innerExtents")

    def GetCageBaseHalfExtents(self) -> Floats:
        """Return half the edge lengths of a cage's base [m], shape (3,)."""
        return _first(self._vGeomData)

    def SetCageBaseHalfExtents(self, halfExtents: ArrayLike) -> None:
        """Set ``halfExtents``, half the edge lengths of a cage's base [m], shape (3,)."""
        self._vGeomData = checked_vector(halfExtents, 3, "SetCageBaseHalfExtents: halfExtents")

    def GetSphereRadius(self) -> float:
        """Return the radius of a sphere [m]."""
        return float(_first(self._vGeomData)[0])

    def GetCylinderRadius(self) -> float:
        """Return the radius of a cylinder [m]."""
        return float(_first(self._vGeomData)[0])

    def GetCylinderHeight(self) -> float:
        """Return the full height of a cylinder [m]."""
        return float(_first(self._vGeomData)[1])

    def GetCapsuleRadius(self) -> float:
        """Return the radius of a capsule [m]."""
        return float(_first(self._vGeomData)[0])

    def GetCapsuleHeight(self) -> float:
        """Return the height of a capsule's cylindrical part [m]."""
        return float(_first(self._vGeomData)[1])

    def GetConicalFrustumTopRadius(self) -> float:
        """Return the radius of the upper end of a conical frustum [m]."""
        return float(_first(self._vGeomData)[0])

    def GetConicalFrustumBottomRadius(self) -> float:
        """Return the radius of the lower end of a conical frustum [m]."""
        return float(_first(self._vGeomData)[1])

    def GetConicalFrustumHeight(self) -> float:
        """Return the height of a conical frustum [m]."""
        return float(_first(self._vGeomData)[2])

    def GetPrismHeight(self) -> float:
        """Return the full height of a prism [m]."""
        return float(_first(self._vGeomData)[0])

    def ComputeInnerEmptyVolume(self) -> tuple[Floats | None, Floats | None]:
        """Return the empty box inside a container.

        Returns:
            ``T_link_box`` of the box's centre, shape (4, 4), and the half extents [m], shape (3,); None and None for
            other types of shapes.
        """
        if GeometryType(self._type) != GeometryType.Container:
            return None, None
        outer, inner = self.GetContainerOuterExtents(), self.GetContainerInnerExtents()
        T_link_box = np.array(self._t, dtype=float)
        # The frame of a container is at the centre of its bottom, and the empty box reaches up to its rim.
        T_link_box[:3, 3] += T_link_box[:3, 2] * (outer[2] - inner[2] / 2)
        return T_link_box, inner / 2

    def ConvertUnitScale(self, unitScale: float) -> None:
        """Multiply all lengths by ``unitScale``."""
        self.DeserializeJSON(self.SerializeJSON(unitScale))
        self._vRenderScale = np.asarray(self._vRenderScale, dtype=float) * unitScale
        self._vCollisionScale = np.asarray(self._vCollisionScale, dtype=float) * unitScale

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        kind = GeometryType(self._type) if obj is None or "type" not in obj else TYPE_FORM.read(obj["type"], 1.0, None)
        return (*self._entries, *_SIZES_JSON.get(kind, ()))


def _first(numbers: ArrayLike) -> Floats:
    """Return the first three numbers, with zeros for those that are missing."""
    return np.array([*np.ravel(np.asarray(numbers, dtype=float)), 0.0, 0.0, 0.0])[:3]


TYPE_FORM = named({kind: kind.name.lower() for kind in GeometryType} | {GeometryType.None_: ""})
"""The form of types of shapes."""

_EXTENTS = Form(
    lambda numbers, scale: (_first(numbers) * scale).tolist(),
    lambda value, scale, present: np.array([*value, 0.0], dtype=float) * scale,
)


def _number(place: int) -> Form:
    """Return the JSON form of one number of a field with several."""

    def read(value: float, scale: float, present: Any) -> Floats:  # noqa: ANN401 - what users put into the field
        numbers = np.array([*_first(present), 0.0])
        numbers[place] = value * scale
        return numbers

    return Form(lambda numbers, scale: float(_first(numbers)[place] * scale), read)


_MESH = Form(
    lambda mesh, scale: _mesh_json(mesh or TriMesh(), scale),
    lambda value, scale, present: TriMesh(
        np.reshape(value["vertices"], (-1, 3)) * scale, np.reshape(value["indices"], (-1, 3))
    ),
)
_CROSS_SECTION = Form(
    lambda corners, scale: (np.ravel(corners) * scale).tolist(),
    lambda value, scale, present: np.reshape(value, (-1, 2)) * scale,
)
_WALLS = Form(
    lambda walls, scale: [
        {
            "transf": POSE.write(one.transf, scale),
            "vExtents": LENGTHS.write(one.vExtents, scale),
            "type": SideWallType(one.type).name.lower(),
        }
        for one in walls
    ],
    lambda items, scale, present: [
        SideWall(
            POSE.read(one["transf"], scale, None),
            LENGTHS.read(one["vExtents"], scale, None),
            SideWallType[one["type"].upper()],
        )
        for one in items
    ],
)
_SLICES = Form(
    lambda slices, scale: [number * scale for one in slices for number in (one.zOffset, one.radius)],
    lambda value, scale, present: [AxialSlice(z * scale, r * scale) for z, r in np.reshape(value, (-1, 2)).tolist()],
)


def _of_sizes(shape: type[scene.Shape]) -> Iterator[Entry]:
    """Yield the keys of a shape, named like its sizes; see ``GeometryInfo`` for the fields that hold them."""
    vectors, places = iter(VECTORS), itertools.count()
    for name, kind, optional in shape.sizes():
        first, *others = name.split("_")
        key = first + "".join(map(str.title, others))
        if kind is float:
            yield Entry(key, VECTORS[0], _number(next(places)), optional)
        elif kind is scene.Mesh:
            yield Entry(key, "_meshcollision", _MESH, optional)
        elif kind == scene.CrossSection:
            yield Entry(key, "_vCrossSection", _CROSS_SECTION, optional)
        else:
            yield Entry(key, next(vectors), _EXTENTS, optional)


_SIZES_JSON = {GeometryType[one.name]: tuple(_of_sizes(one.shape)) for one in scene.SHAPE_TYPES} | {
    GeometryType.ConicalFrustum: (
        Entry("topRadius", "_vGeomData", _number(0)),
        Entry("bottomRadius", "_vGeomData", _number(1)),
        Entry("height", "_vGeomData", _number(2)),
    ),
    GeometryType.Axial: (Entry("axial", "_vAxialSlices", _SLICES),),
    GeometryType.Cage: (
        Entry("baseExtents", "_vGeomData", _EXTENTS),
        Entry("innerSizeX", "_vGeomData2", _number(0)),
        Entry("innerSizeY", "_vGeomData2", _number(1)),
        Entry("innerSizeZ", "_vGeomData2", _number(2)),
        Entry("sideWalls", "_vSideWalls", _WALLS, optional=True),
    ),
}
"""The keys of sizes in JSON. No shape has one of the last three types; only infos know them."""


def _mesh_json(mesh: TriMesh, scale: float) -> Json:
    vertices, indices = (np.zeros(0) if part is None else np.asarray(part) for part in (mesh.vertices, mesh.indices))
    return {"vertices": (vertices.ravel() * scale).tolist(), "indices": indices.ravel().astype(int).tolist()}

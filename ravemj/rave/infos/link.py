"""Description of a link."""

# JSON and users may put any value into the fields that the functions of forms get.
# pyright: reportUnknownLambdaType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownMemberType=false

# The fields have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Sequence
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_vector
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.model import scene
from ravemj.model.inertia import inertial_about, principal_frame, principal_moments
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.infos.base import POSE, TEXT, Form, ParameterFields, info_class, infos, json_field, lengths, pose
from ravemj.rave.infos.geometry import GeometryInfo

if TYPE_CHECKING:
    from ravemj.model.builder import LinkBuilder


_SHAPES = infos(GeometryInfo)
_GROUPS = Form(
    lambda groups, scale: {name: _SHAPES.write(group, scale) for name, group in groups.items()},
    lambda value, scale, present: {name: _SHAPES.read(group, scale, []) for name, group in value.items()},
)


@info_class
class LinkInfo(ParameterFields):
    """Description of a link.

    Attributes:
        _name: The name.
        _t: ``T_world_link``, shape (4, 4).
        _mass: The mass [kg].
        _tMassFrame: ``T_link_mass``, shape (4, 4): the centre of mass and the principal axes of inertia.
        _vinertiamoments: The principal moments of inertia [kg m^2], shape (3,).
        _vgeometryinfos: The collision geometries, a list of ``GeometryInfo``.
        _mapExtraGeometries: Other groups of geometries by name, each a list of ``GeometryInfo``.
        _vForcedAdjacentLinks: The names of links that collision checks never test against this one.
        _mapFloatParameters: The user's numbers by name; ``_mapIntParameters`` and ``_mapStringParameters`` likewise.
        _bStatic: Whether the link is marked as static.
        _bIsEnabled: Whether the link takes part in collision checks.
        _bVisible: False hides all geometries.
    """

    _called = "KinBody.LinkInfo"

    _name: str | None = json_field("name", TEXT, default=None)
    _t: ArrayLike = json_field("transform", POSE, default=np.eye(4))
    _mass: float = json_field("mass", default=1e-10)
    _tMassFrame: ArrayLike = json_field("massTransform", POSE, default=np.eye(4))
    _vinertiamoments: ArrayLike = json_field("inertiaMoments", lengths(2), default=np.ones(3))
    _vgeometryinfos: Sequence[GeometryInfo] = json_field("geometries", _SHAPES, default=[], optional=True)
    _mapExtraGeometries: dict[str, Sequence[GeometryInfo]] = json_field(
        "extraGeometries", _GROUPS, default={}, optional=True
    )
    _vForcedAdjacentLinks: Sequence[str] = json_field("forcedAdjacentLinks", default=[], optional=True)
    _bStatic: bool = json_field("isStatic", default=False)
    _bIsEnabled: bool = json_field("isEnabled", default=True)
    _bVisible: bool = True
    _bIgnoreSelfCollision: bool = json_field("isSelfCollisionIgnored", default=False, optional=True)

    @classmethod
    def of(cls, body: scene.KinBody, index: int, T_world_link: Floats, *, enabled: bool) -> Self:
        """Return the description of an existing link at its current pose."""
        link = body.links[index]
        pairs = [pair for pair in body.adjacent if pair[0] == index]
        return cls(
            _name=link.name,
            _t=T_world_link,
            _mass=link.inertial.mass,
            _tMassFrame=principal_frame(link.inertial).matrix(),
            _vinertiamoments=principal_moments(link.inertial),
            _vgeometryinfos=[GeometryInfo.of(geometry) for geometry in link.geometries],
            _mapExtraGeometries={
                name: [GeometryInfo.of(geometry) for geometry in group]
                for name, group in link.groups
                if name != scene.OWN_SHAPES
            },
            _vForcedAdjacentLinks=[body.links[other].name for _, other in pairs],
            _bStatic=link.static,
            _bIsEnabled=enabled,
            _bVisible=any(geometry.visible for geometry in link.geometries) or not link.geometries,
            _bIgnoreSelfCollision=link.self_collision_ignored,
        ).with_parameters(link.parameters)

    def link(self) -> "LinkBuilder":
        """Make the link that the fields describe.

        Raises:
            RavemjError: the name is not set, or a field has wrong numbers.
        """
        if self._name is None:
            raise ArgumentError("LinkInfo._name: is None, and should name the link")
        (mass,) = checked_vector([self._mass], 1, "LinkInfo._mass").tolist()
        T_link_mass = pose(self._tMassFrame, "LinkInfo._tMassFrame")
        moments = checked_vector(self._vinertiamoments, 3, "LinkInfo._vinertiamoments")
        from ravemj.model.builder import LinkBuilder  # noqa: PLC0415 - slow to import

        return LinkBuilder(
            name=self._name,
            source=FROM_SCRIPT,
            pose=pose(self._t, "LinkInfo._t"),
            geometries=list(geometries_of(self._vgeometryinfos, visible=self._bVisible)),
            inertial=inertial_about(mass, T_link_mass, moments),
            static=bool(self._bStatic),
            enabled=bool(self._bIsEnabled),
            groups=tuple((name, geometries_of(infos)) for name, infos in self._mapExtraGeometries.items()),
            parameters=self.parameters(),
            self_collision_ignored=bool(self._bIgnoreSelfCollision),
        )

    def adjacent(self, names: Sequence[str]) -> list[int]:
        """Return the indices in ``names`` of the links that collision checks never test against this one."""
        return [names.index(name) for name in self._vForcedAdjacentLinks if name in names]


def geometries_of(infos: Sequence[GeometryInfo], *, visible: bool = True) -> tuple[scene.Geometry, ...]:
    """Make the geometries that infos describe.

    Args:
        infos: The descriptions.
        visible: False hides them, as a hidden link does.

    Raises:
        ArgumentError: an object is not a ``GeometryInfo``, or its fields are invalid.
    """
    geometries: list[scene.Geometry] = []
    for info in infos:
        if not isinstance(info, GeometryInfo):  # pyright: ignore[reportUnnecessaryIsInstance] - what users hand in
            raise ArgumentError(f"a geometry is of type {type(info).__name__}, and should be GeometryInfo")
        geometries.append(info.geometry(visible=visible))
    return tuple(geometries)

"""Parameters of a joint axis: limits, velocities, weights and resolutions, from up to three elements."""

import math
from typing import NamedTuple

from ravemj.core.transforms import Vec3, not_subnormal
from ravemj.formats.collada.library import Library
from ravemj.formats.meshes.collada.document import Element, child, children, local_name, numbers, words
from ravemj.model.scene import UNLIMITED, Axis

_RADIANS = {"OpenRAVE Collada Writer", "URDF Collada Writer"}
"""Authoring tools that write joint speeds and values in radians, although COLLADA requires degrees."""

_UNLIMITED_SLIDE = 1e6  # OpenRAVE's limit of sliders without limits
_DEGREE = math.pi / 180


class AxisReader(NamedTuple):
    """Reader of one axis.

    Attributes:
        library: The documents.
        element: The ``<revolute>`` or ``<prismatic>``.
        kinematics: The ``<axis_info>`` of the kinematics system, or None.
        motion: The ``<axis_info>`` of the motion system, or None.
    """

    library: Library
    element: Element
    kinematics: Element | None = None
    motion: Element | None = None

    @property
    def is_revolute(self) -> bool:
        """Whether the axis is revolute; False for prismatic."""
        return local_name(self.element) == "revolute"

    @property
    def is_active(self) -> bool:
        """Whether the axis has a DOF."""
        return self.library.truth(child(self.kinematics, "active"), True)

    @property
    def direction(self) -> Vec3:
        """The unit vector in the joint's frame; z if the file has none."""
        values = numbers(child(self.element, "axis"))[:3].tolist()
        if len(values) < 3:
            return (0.0, 0.0, 1.0)
        x, y, z = not_subnormal((values[0], values[1], values[2]))
        length = math.hypot(x, y, z)
        return (x / length, y / length, z / length) if 0 < length < math.inf else (0.0, 0.0, 1.0)

    @property
    def wrap(self) -> float:
        """Centre of the full turn to which OpenRAVE wraps values [rad]: the middle of limits that exceed ±pi, or 0."""
        written = self._written_limits()
        return sum(written) / 2 if written and max(map(abs, written)) > math.pi else 0.0

    @property
    def dof_index(self) -> float:
        """The DOF index written by OpenRAVE's writer; infinity for none."""
        for element in children(self.kinematics, "index"):
            value = self.library.number(element) if element.get("semantic") == "OpenRAVE" else None
            if value is not None and value >= 0:
                return value
        return math.inf

    def value(self, written: float | None) -> float:
        """Convert the axis value in a binding to rad or m; 0 if it is missing or not finite."""
        return 0.0 if written is None or not math.isfinite(written) else written * self._speed_unit()

    def read(self, direction: Vec3) -> Axis:
        """Return the axis, given its unit vector in the frame of the parent link."""
        lower, upper, circular = self._limits()
        return Axis(
            direction,
            lower=lower,
            upper=upper,
            circular=circular,
            weight=self._parameter("planning_weight", 1.0),
            resolution=self._parameter("discretization_resolution", 0.02),
            max_velocity=self._rate("speed", 0.5 if self.is_revolute else 0.01),
            max_acceleration=self._rate("acceleration", 50.0),
        )

    def _limits(self) -> tuple[float, float, bool]:
        """Return the lower and upper limit of the axis [rad or m], and whether it is circular."""
        if self.library.truth(child(self.kinematics, "locked"), False):
            return 0.0, 0.0, False
        if self.is_revolute and self.library.truth(self._newparam("circular"), False):
            return -UNLIMITED, UNLIMITED, True
        written = self._written_limits()
        if written is not None:
            lower, upper = written
            return (0.0, 0.0, False) if lower >= upper else (lower, upper, False)
        if self.is_revolute:
            return -UNLIMITED, UNLIMITED, True
        return -_UNLIMITED_SLIDE, _UNLIMITED_SLIDE, False

    def _written_limits(self) -> tuple[float, float] | None:
        """Return the limits [rad or m] of the kinematics system or else of the axis; None if neither has any."""
        unit = self._unit(_DEGREE)
        for owner in (self.kinematics, self.element):
            limits = child(owner, "limits")
            if limits is not None and owner is not None:
                lower, upper = (self.library.number(child(limits, name), owner) for name in ("min", "max"))
                if lower is not None and upper is not None and not math.isnan(lower + upper):
                    return lower * unit, upper * unit
        return None

    def _newparam(self, sid: str) -> Element | None:
        return next((item for item in children(self.kinematics, "newparam") if item.get("sid") == sid), None)

    def _parameter(self, sid: str, default: float) -> float:
        values = numbers(child(self._newparam(sid), "float"))
        return float(values[0]) if len(values) else default

    def _rate(self, name: str, default: float) -> float:
        value = None if self.motion is None else self.library.number(child(self.motion, name), self.motion)
        return default if value is None or not math.isfinite(value) else abs(value * self._speed_unit())

    def _unit(self, angle: float) -> float:
        """Return the factor from the file's values to metres or radians; ``angle`` is the unit of angles [rad]."""
        return angle if self.is_revolute else self.library.metres(self.element)

    def _speed_unit(self) -> float:
        """Return the factor from the file's speeds and joint values to rad or m; see `_RADIANS`."""
        contributors = children(child(self.library.document_of(self.element).root, "asset"), "contributor")
        tools = (" ".join(words(child(item, "authoring_tool"))) for item in contributors)
        return self._unit(1.0 if any(tool in _RADIANS for tool in tools) else _DEGREE)

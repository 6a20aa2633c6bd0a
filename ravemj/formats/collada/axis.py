"""The parameters of an axis: limits, velocities, weights and resolutions, from up to three elements."""

import math
from dataclasses import dataclass

from ravemj.core.transforms import Vec3
from ravemj.formats.collada.library import Library
from ravemj.formats.collada.references import References
from ravemj.formats.meshes.collada.document import Element, child, children, local_name, numbers, words
from ravemj.model.scene import UNLIMITED, Axis

_RADIANS = {"OpenRAVE Collada Writer", "URDF Collada Writer"}
"""Tools that write speeds and values of joints in radians, where the standard says degrees."""

_UNLIMITED_SLIDE = 1e6
_DEFAULT_VELOCITIES = {"revolute": 0.5, "prismatic": 0.01}  # [rad/s, m/s]


@dataclass(frozen=True, slots=True)
class AxisInfo:
    """The elements that say something about an axis.

    Attributes:
        kinematics: The ``<axis_info>`` of the kinematics system, or None.
        motion: That of the motion system, or None.
    """

    kinematics: Element | None = None
    motion: Element | None = None


class AxisReader:
    """Reads axes."""

    def __init__(self, library: Library, references: References) -> None:
        self._library = library
        self._references = references

    def is_active(self, info: AxisInfo) -> bool:
        """Tell whether an axis has a DOF."""
        return self._references.truth(child(info.kinematics, "active"), True)

    def value(self, element: Element, written: float | None) -> float:
        """Return the value that a binding gives to an axis [rad or m]."""
        if written is None or not math.isfinite(written):
            return 0.0
        return written * self._factor(element, 1.0 if self._in_radians(element) else math.pi / 180)

    def read(self, element: Element, direction: Vec3, info: AxisInfo) -> Axis:
        """Return an axis.

        Args:
            element: The ``<revolute>`` or ``<prismatic>``.
            direction: Its unit vector in the frame of the parent link.
            info: What else says something about it.
        """
        lower, upper, circular = self._limits(element, info)
        speed_factor = self._factor(element, 1.0 if self._in_radians(element) else math.pi / 180)
        return Axis(
            direction,
            lower=lower,
            upper=upper,
            circular=circular,
            weight=self._parameter(info.kinematics, "planning_weight", 1.0),
            resolution=self._parameter(info.kinematics, "discretization_resolution", 0.02),
            max_velocity=self._rate(info.motion, "speed", speed_factor, _DEFAULT_VELOCITIES[local_name(element)]),
            max_acceleration=self._rate(info.motion, "acceleration", speed_factor, 50.0),
        )

    def wrap(self, element: Element, info: AxisInfo) -> float:
        """Return the middle of limits beyond half a turn, about which OpenRAVE counts turns [rad]; 0 within them."""
        written = self._written_limits(element, info)
        return sum(written) / 2 if written and max(map(abs, written)) > math.pi else 0.0

    def dof_index(self, info: AxisInfo) -> float:
        """Return the DOF that OpenRAVE's writer gave to an axis; infinity for none."""
        for element in children(info.kinematics, "index"):
            value = self._references.number(element) if element.get("semantic") == "OpenRAVE" else None
            if value is not None and value >= 0:
                return value
        return math.inf

    def _limits(self, element: Element, info: AxisInfo) -> tuple[float, float, bool]:
        """Return the limits, and whether the axis turns without end."""
        revolute = local_name(element) == "revolute"
        if self._references.truth(child(info.kinematics, "locked"), False):
            return 0.0, 0.0, False
        if revolute and self._is_circular(info.kinematics):
            return -UNLIMITED, UNLIMITED, True
        written = self._written_limits(element, info)
        if written is not None:
            lower, upper = sorted(written)
            return (0.0, 0.0, False) if lower == upper else (lower, upper, False)
        if revolute:
            return -UNLIMITED, UNLIMITED, True
        return -_UNLIMITED_SLIDE, _UNLIMITED_SLIDE, False

    def _written_limits(self, element: Element, info: AxisInfo) -> tuple[float, float] | None:
        """Return the limits as written: those of the system, or else those of the axis itself [rad or m]."""
        factor = self._factor(element, math.pi / 180)
        for owner in (info.kinematics, element):
            limits = child(owner, "limits")
            if limits is not None and owner is not None:
                lower, upper = (self._references.number(child(limits, name), owner) for name in ("min", "max"))
                if lower is not None and upper is not None and not math.isnan(lower + upper):
                    return lower * factor, upper * factor
        return None

    def _is_circular(self, info: Element | None) -> bool:
        found = (item for item in children(info, "newparam") if item.get("sid") == "circular")
        return self._references.truth(next(found, None), False)

    def _parameter(self, info: Element | None, name: str, default: float) -> float:
        found = (item for item in children(info, "newparam") if item.get("sid") == name)
        values = numbers(child(next(found, None), "float"))
        return float(values[0]) if len(values) else default

    def _rate(self, info: Element | None, name: str, factor: float, default: float) -> float:
        value = None if info is None else self._references.number(child(info, name), info)
        return default if value is None or not math.isfinite(value) else abs(value * factor)

    def _factor(self, element: Element, angle: float) -> float:
        """Return what a number of this axis has to be multiplied by."""
        return angle if local_name(element) == "revolute" else self._library.metres(element)

    def _in_radians(self, element: Element) -> bool:
        root = self._library.document_of(element).root
        contributors = children(child(root, "asset"), "contributor")
        return any(" ".join(words(child(item, "authoring_tool"))) in _RADIANS for item in contributors)

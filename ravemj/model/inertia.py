"""Mass properties: of several links as arrays, and from a tensor to principal axes and back."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ravemj.core.transforms import UNIT_WXYZ, Floats, Pose, Vec3, Wxyz, rows_from_wxyz, wxyz_from_rows
from ravemj.model.scene import Inertial, Link


@dataclass(frozen=True, slots=True)
class Inertias:
    """Mass properties of the links.

    Attributes:
        masses: Masses [kg], shape (links,).
        coms: Centres of mass in the links' frames [m], shape (links, 3).
        tensors: Inertia about them, in axes parallel to the links' [kg m^2], shape (links, 3, 3).
    """

    masses: Floats
    coms: Floats
    tensors: Floats

    @classmethod
    def of(cls, links: Sequence[Link]) -> "Inertias":
        """Return those of the links of a scene."""
        count = len(links)
        return cls(
            np.array([link.inertial.mass for link in links], dtype=np.float64),
            np.array([link.inertial.com for link in links], dtype=np.float64).reshape(count, 3),
            np.array([link.inertial.inertia for link in links], dtype=np.float64).reshape(count, 3, 3),
        )

    def center_of_mass(self, T_a_links: Floats) -> Floats:
        """Return the common centre of mass of links [m] in frame a, shape (3,); NaN where nothing has a mass.

        ``T_a_links`` are their poses, shape (links, 4, 4).
        """
        coms = np.einsum("nij,nj->ni", T_a_links[:, :3, :3], self.coms) + T_a_links[:, :3, 3]
        mass = self.masses.sum()
        return self.masses @ coms / mass if mass else np.full(3, np.nan)


_ROUNDING = 1e-12
"""What is left of the zeros in a tensor, relative to its moments, when its axes were turned by quarters."""


def principal_frame(inertial: Inertial) -> Pose:
    """Return the frame of the principal axes at the centre of mass, in the link."""
    return Pose(inertial.com, _axes(inertial))


def principal_moments(inertial: Inertial) -> Floats:
    """Return the moments of inertia about the axes of ``principal_frame`` [kg m^2], shape (3,)."""
    rotation = np.array(rows_from_wxyz(_axes(inertial)))
    return np.diag(rotation.T @ np.array(inertial.inertia) @ rotation).copy()


def inertial_about(mass: float, T_link_mass: Pose, moments: Floats) -> Inertial:
    """Return the mass properties with given moments about the axes of a frame at the centre of mass."""
    rotation = np.array(rows_from_wxyz(T_link_mass.wxyz))
    xx, xy, xz, _, yy, yz, _, _, zz = ((rotation * moments) @ rotation.T).ravel().tolist()
    rows: tuple[Vec3, Vec3, Vec3] = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    return Inertial(mass, T_link_mass.position, rows, T_link_mass.wxyz)


def _axes(inertial: Inertial) -> Wxyz:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertial.inertia
    if inertial.axes is not None:
        return inertial.axes
    if not np.isfinite(inertial.inertia).all():  # of enormous shapes; no axes are better than others
        return UNIT_WXYZ
    if max(abs(xy), abs(xz), abs(yz)) <= _ROUNDING * max(abs(xx), abs(yy), abs(zz)):
        return UNIT_WXYZ  # a cylinder's axes in XML, turned a quarter, are those of its link but for rounding
    _, axes = np.linalg.eigh(np.array(inertial.inertia))
    axes[:, 0] *= np.linalg.det(axes)  # a rotation, not a reflection
    return wxyz_from_rows(axes.tolist())

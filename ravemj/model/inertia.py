"""Mass properties: arrays for several links, and conversion between tensors and principal axes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ravemj.core.transforms import UNIT_WXYZ, Floats, Pose, Vec3, Wxyz, rows_from_wxyz, wxyz_from_rows
from ravemj.model.scene import Inertial, Link


@dataclass(frozen=True, slots=True)
class Inertias:
    """Mass properties of several links.

    Attributes:
        masses: Masses [kg], shape (links,).
        coms: Centres of mass in the links' frames [m], shape (links, 3).
        tensors: Inertia about the centres of mass, in axes parallel to the links' [kg m^2], shape (links, 3, 3).
    """

    masses: Floats
    coms: Floats
    tensors: Floats

    @classmethod
    def from_links(cls, links: Sequence[Link]) -> "Inertias":
        """Return the mass properties of links as arrays."""
        count = len(links)
        return cls(
            np.array([link.inertial.mass for link in links], dtype=np.float64),
            np.array([link.inertial.com for link in links], dtype=np.float64).reshape(count, 3),
            np.array([link.inertial.inertia for link in links], dtype=np.float64).reshape(count, 3, 3),
        )

    def center_of_mass(self, T_a_links: Floats) -> Floats:
        """Return the total centre of mass of links [m] in frame a, shape (3,); NaN if the mass is 0.

        ``T_a_links`` are the poses of the links, shape (links, 4, 4).
        """
        coms = np.einsum("nij,nj->ni", T_a_links[:, :3, :3], self.coms) + T_a_links[:, :3, 3]
        mass = self.masses.sum()
        return self.masses @ coms / mass if mass else np.full(3, np.nan)


_ROUNDING = 1e-12
"""Relative size below which tensor entries count as 0, since rotations by quarter turns cause such rounding errors."""


def principal_frame(inertial: Inertial) -> Pose:
    """Return the frame of the principal axes at the centre of mass, in the link frame."""
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


def joined_inertial(parts: Sequence[tuple[Pose, Inertial]]) -> Inertial:
    """Return the mass properties of rigidly connected parts, each at its pose ``T_link_part`` in a common frame."""
    masses = np.array([inertial.mass for _, inertial in parts])
    coms = np.array([pose.apply(inertial.com) for pose, inertial in parts])
    com = masses @ coms / masses.sum() if masses.sum() else coms[0]
    total = np.zeros((3, 3))
    for mass, arm, (pose, inertial) in zip(masses, coms - com, parts, strict=True):
        rotation = np.array(rows_from_wxyz(pose.wxyz))
        total += rotation @ np.array(inertial.inertia) @ rotation.T
        total += mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))  # Steiner's theorem
    xx, xy, xz, _, yy, yz, _, _, zz = total.ravel().tolist()
    x, y, z = com.tolist()
    return Inertial(float(masses.sum()), (x, y, z), ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))


def _axes(inertial: Inertial) -> Wxyz:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertial.inertia
    if inertial.axes is not None:
        return inertial.axes
    if not np.isfinite(inertial.inertia).all():  # of huge shapes, whose axes are arbitrary
        return UNIT_WXYZ
    if max(abs(xy), abs(xz), abs(yz)) <= _ROUNDING * max(abs(xx), abs(yy), abs(zz)):
        return UNIT_WXYZ  # a cylinder's axes in XML, turned a quarter, are those of its link but for rounding
    _, axes = np.linalg.eigh(np.array(inertial.inertia))
    axes[:, 0] *= np.linalg.det(axes)  # a rotation, not a reflection
    return wxyz_from_rows(axes.tolist())

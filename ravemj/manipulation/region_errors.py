"""Errors and Jacobians of tools, links and grabbed bodies relative to regions, for projection."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.regions import PoseSet
from ravemj.manipulation.bodies import Bodies
from ravemj.model.chains import dofs_moving
from ravemj.planning.constrained_edges import Manifold
from ravemj.planning.projection import Error


class Lacking(NamedTuple):
    """Error of the present configuration against a constraint.

    Attributes:
        vector: Returns the error, shape (k,).
        full: Returns the error and its Jacobian with respect to the configuration of the bodies, shape (k, n).
    """

    vector: Callable[[], Floats]
    full: Callable[[], tuple[Floats, Floats]]


class MovingFrame(NamedTuple):
    """Frame on a body that a planner moves.

    Attributes:
        bodies: The moving bodies.
        body: The body.
        link: The index of its link.
        T_link_frame: The frame in the link, shape (4, 4).
    """

    bodies: Bodies
    body: BodyState
    link: int
    T_link_frame: Floats

    @classmethod
    def on_link(cls, bodies: Bodies, body: BodyState, link: int, T_link_frame: Floats) -> "MovingFrame | None":
        """Return a frame fixed to a link that a planner moves; None if the link does not move.

        If a moving body grabs the body of the link, the frame is fixed to the grabbing link.

        Raises:
            ArgumentError: the base of the body moves, too.
        """
        parts = [part for part in bodies.parts if part.body is body]
        if any(not part.dofs for part in parts):
            raise ArgumentError(f"regions: the base of '{body.scene.name}' moves, and only joints can be projected")
        if parts:
            moved = dofs_moving(body.scene, link).intersection(dof for part in parts for dof in part.dofs)
            return cls(bodies, body, link, T_link_frame) if moved else None
        for holder in bodies.bodies:
            for grab in holder.grabs:
                if grab.body is body:
                    T_world_frame = body.link_transform(link) @ T_link_frame
                    T_holder_frame = inverse(holder.link_transform(grab.link)) @ T_world_frame
                    return cls.on_link(bodies, holder, grab.link, T_holder_frame)
        return None

    def pose(self) -> Floats:
        """Return ``T_world_frame``, shape (4, 4)."""
        return self.body.link_transform(self.link) @ self.T_link_frame

    def velocities(self, point: Floats) -> Floats:
        """Return the Jacobian of a world point (3,) fixed to the frame, then of the frame's rotation, shape (6, n)."""
        jacobian = np.zeros((6, self.bodies.dof))
        dynamics = self.body.dynamics
        moves, turns = dynamics.translation_jacobian(self.link, point), dynamics.rotation_jacobian(self.link)
        for part in self.bodies.parts:
            if part.body is self.body:
                jacobian[:3, part.columns] = moves.take(part.dofs, 1)
                jacobian[3:, part.columns] = turns.take(part.dofs, 1)
        return jacobian


def region_error(region: PoseSet, tool: MovingFrame, frame: MovingFrame | None) -> Lacking:
    """Return the error of a tool relative to a region.

    Args:
        region: The region: in the world, or in the moving frame.
        tool: The tool.
        frame: The frame of the region if it depends on the configuration, else None.
    """
    Te_w = inverse(region.Tw_e)

    def relative() -> tuple[Floats, Floats, Floats]:
        T_world_end = tool.pose() @ Te_w
        T_world_w = region.T0_w if frame is None else frame.pose() @ region.T0_w
        T_w_world = inverse(T_world_w)
        return T_w_world @ T_world_end, T_world_end, T_w_world

    def full() -> tuple[Floats, Floats]:
        D, T_world_end, T_w_world = relative()
        error, rates = region.error(D)
        point, rotation = T_world_end[:3, 3], T_w_world[:3, :3]
        jacobian = tool.velocities(point)
        if frame is not None:
            jacobian -= frame.velocities(point)
        return error, rates @ np.vstack([rotation @ jacobian[:3], rotation @ jacobian[3:]])

    return Lacking(lambda: region.beyond(relative()[0]), full)


def all_of(errors: Sequence[Lacking]) -> Lacking:
    """Return the combined error of several constraints."""

    def full() -> tuple[Floats, Floats]:
        parts = [error.full() for error in errors]
        return np.concatenate([part for part, _ in parts]), np.concatenate([jacobian for _, jacobian in parts])

    return Lacking(lambda: np.concatenate([error.vector() for error in errors]), full)


def any_of(errors: Sequence[Lacking]) -> Lacking:
    """Return the error of the nearest of several constraints."""

    def vector() -> Floats:
        return min((error.vector() for error in errors), key=_squared)

    def full() -> tuple[Floats, Floats]:
        return min(errors, key=lambda error: _squared(error.vector())).full()

    return Lacking(vector, full)


def _squared(vector: Floats) -> float:
    return float(vector.dot(vector))


def at_values(bodies: Bodies, lacking: Lacking) -> Error:
    """Return a function that moves the bodies to a configuration and returns the error and Jacobian there."""

    def error(values: Floats) -> tuple[Floats, Floats]:
        bodies.move(values)
        return lacking.full()

    return error


def manifold(bodies: Bodies, lacking: Lacking, threshold: float) -> Manifold:
    """Return the manifold of a constraint with an error threshold."""

    def off(values: Floats) -> float:
        bodies.move(values)
        return _squared(lacking.vector()) ** 0.5

    return Manifold(at_values(bodies, lacking), threshold, off)

"""Approach rays of the target of a grasp table."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.manipulation.grasping import rays
from ravemj.rave.kinbody import KinBody
from ravemj.rave.manipulator import Manipulator


class ApproachRays(DatabaseGenerator):
    """Approach rays of ``target``."""

    manip: Manipulator
    target: KinBody

    def computeBoxApproachRays(
        self, delta: float = 0.02, normalanglerange: float = 0, directiondelta: float = 0.4
    ) -> Floats:
        """Return approach rays from grids on the sides of the target's box.

        Args:
            delta: Distance of the grid lines [m].
            normalanglerange: Largest angle from the normals [rad].
            directiondelta: Angle between directions around a normal [rad].

        Returns:
            Points on the target and outward normals, in the target's frame, shape (n, 6).
        """
        return self._box_hits(lambda center, half: rays.box_rays(center, half, delta), normalanglerange, directiondelta)

    def computeSphereApproachRays(
        self, delta: float = 0.1, normalanglerange: float = 0, directiondelta: float = 0.4
    ) -> Floats:
        """Return approach rays from all directions to the center of the target's box.

        Args:
            delta: Angle between neighbours [rad].
            normalanglerange: Largest angle from the normals [rad].
            directiondelta: Angle between directions around a normal [rad].

        Returns:
            As `computeBoxApproachRays`.
        """

        def sphere(center: Floats, half: Floats) -> rays.Rays:
            return rays.sphere_rays(center, 2 * float(np.linalg.norm(half)) + rays.MARGIN, delta)

        return self._box_hits(sphere, normalanglerange, directiondelta)

    def ComputeCircleApproachRays(
        self,
        center: ArrayLike,
        normalaxis: ArrayLike,
        delta: float = 0.1,
        normalanglerange: float = 0,
        directiondelta: float = 0.4,
    ) -> Floats:
        """Return approach rays from a circle around the target to a center.

        Args:
            center: Center of the circle in the target's frame, shape (3,).
            normalaxis: Axis of the circle, shape (3,).
            delta: Angle between neighbours [rad].
            normalanglerange: Largest angle from the normals [rad].
            directiondelta: Angle between directions around a normal [rad].

        Returns:
            As `computeBoxApproachRays`.
        """

        def circle(middle: Floats, half: Floats) -> rays.Rays:
            radius = 2 * float(np.linalg.norm(half)) + float(np.linalg.norm(middle - np.asarray(center, float)))
            return rays.circle_rays(center, normalaxis, radius, delta)

        return self._box_hits(circle, normalanglerange, directiondelta)

    def computePlaneApproachRays(
        self,
        center: ArrayLike,
        sidex: ArrayLike,
        sidey: ArrayLike,
        delta: float = 0.02,
        normalanglerange: float = 0,
        directiondelta: float = 0.4,
    ) -> Floats:
        """Return approach rays that start on a rectangular grid and run along ``sidex`` x ``sidey`` to the target.

        Args:
            center: Center of the rectangle in the world, shape (3,).
            sidex: Half of one side, shape (3,) [m].
            sidey: Half of the other side, shape (3,) [m].
            delta: Distance of the grid lines [m].
            normalanglerange: Largest angle from the normals [rad].
            directiondelta: Angle between directions around a normal [rad].

        Returns:
            As `computeBoxApproachRays`, but in the world, as OpenRAVE does, for the target's current pose.
        """
        self._check_shapes()
        return self._hits(rays.plane_rays(center, sidex, sidey, delta), normalanglerange, directiondelta)

    def _box_hits(self, cast: Callable[[Floats, Floats], rays.Rays], angle: float, delta: float) -> Floats:
        self._check_shapes()
        with self.target:
            self.target.SetTransform(np.eye(4))
            box = self.target.ComputeAABB()
            return self._hits(cast(box.pos(), box.extents()), angle, delta)

    def _hits(self, cast: rays.Rays, angle: float, delta: float) -> Floats:
        hit, points = self.env.CheckCollisionRays(cast.numbers(), self.target)
        return rays.spread(points[hit], angle, delta)

    def _check_shapes(self) -> None:
        if not any(link.GetGeometries() for link in self.target.GetLinks()):
            raise ArgumentError(
                f"GraspingModel: target '{self.target.GetName()}' has no geometries, so nothing can be grasped; "
                "give its links shapes, or choose another target"
            )
